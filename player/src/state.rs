//! What a project stores, and how states of other versions and broken ones are read.
//!
//! The shell parses a project's bytes and hands over the values and fields; what cannot be parsed is refused there and
//! the instance plays on as it was. What parses is put in order here before it is loaded: every
//! parameter gets a value, so that a state always sounds the same, whatever was set before. A state
//! whose kit cannot be read is refused as a whole: all that it says is about that kit.

mod former;

use std::collections::BTreeMap;

use overhear_engine::kit_spec::KitSpec;
use tracing::{error, warn};

use crate::kit_document::KitDocument;
use crate::kit_file::{self, KitFileError};
use crate::midi::assignments::{Assignment, NOTES};
use crate::parameters::{BYPASS_ID, Parameter, default_value, name, parameters};

/// Version of the meaning of what is stored; counts up when a migration is needed.
pub const SCHEMA: u32 = 2;

/// Field that holds [`SCHEMA`].
pub const SCHEMA_FIELD: &str = "schema";

/// Field that holds the window's logical size.
pub const WINDOW_FIELD: &str = "window";

/// Field of how the editor looks at the kit.
pub const VIEW_FIELD: &str = "view";

/// Field that holds the user's assignments: `38=49 40=silent`.
pub const NOTES_FIELD: &str = "notes";

/// Field that holds the text of the kit file. Left out while the kit is the standard one.
pub const KIT_FIELD: &str = "kit";

/// What a kit file in a state is called in errors.
const KIT_NAME: &str = "the state's kit";

/// The kit as stored in [`KIT_FIELD`]; nothing of the standard kit.
pub fn kit_text(document: &KitDocument) -> Option<String> {
    (*document != KitDocument::standard()).then(|| kit_file::write(document))
}

/// The kit in a state's fields: the standard one, if they have none.
///
/// # Errors
/// [`KitFileError`] if it cannot be read.
pub fn kit(fields: &BTreeMap<String, String>) -> Result<KitDocument, KitFileError> {
    fields.get(KIT_FIELD).map_or_else(|| Ok(KitDocument::standard()), |text| kit_file::read(KIT_NAME, text))
}

/// Assignments as stored in [`NOTES_FIELD`], lowest note first.
pub fn notes_text(changed: &BTreeMap<u8, Assignment>) -> String {
    let texts =
        changed.iter().filter_map(|(note, assignment)| Some(format!("{note}={}", assignment.to_text()?)));
    texts.collect::<Vec<_>>().join(" ")
}

/// Reads what [`notes_text`] writes; what is not understood is logged and left out.
pub fn notes(text: &str) -> BTreeMap<u8, Assignment> {
    let entries = text.split_whitespace().filter_map(|entry| {
        let assignment = entry.split_once('=').and_then(|(note, plays)| {
            let note = note.parse().ok().filter(|&note: &u8| usize::from(note) < NOTES)?;
            Some((note, Assignment::from_text(plays)?))
        });
        if assignment.is_none() {
            warn!("The state has an assignment {entry:?}, which is not understood: ignored");
        }
        assignment
    });
    entries.collect()
}

/// A value of a parameter as a project stores it.
#[derive(Debug, Clone, PartialEq)]
pub enum StoredValue {
    /// In the parameter's unit.
    Number(f32),
    /// On or off.
    Switch(bool),
    /// Of a type that no parameter has, as text.
    Other(String),
}

/// What a project stores.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct State {
    /// Values by their parameters' ids.
    pub values: BTreeMap<String, StoredValue>,
    /// Everything else, by name.
    pub fields: BTreeMap<String, String>,
}

impl State {
    /// Completes and corrects a state before it is loaded.
    ///
    /// Parameters that are missing, as in a state older than them, or that are not numbers get the kit's
    /// default; others are brought into range; unknown ones are dropped. A state of an older schema is translated, one that
    /// is newer than this build is read as far as it is understood. Everything but plain absence is logged. Of a state whose
    /// kit cannot be read nothing is left: it changes nothing.
    pub fn put_in_order(&mut self) {
        put_in_order(self);
    }
}

fn put_in_order(state: &mut State) {
    match state.fields.get(SCHEMA_FIELD).map(|text| text.parse::<u32>()) {
        Some(Ok(SCHEMA)) => {}
        Some(Ok(schema)) if schema > SCHEMA => warn!(
            "The state has schema {schema}, this build knows up to {SCHEMA}: \
             what is new in it is ignored"
        ),
        Some(Ok(_)) => former::translate(state),
        Some(Err(_)) | None => {
            warn!("The state has no schema: read as the first");
            former::translate(state);
        }
    }
    let document = match kit(&state.fields) {
        Ok(document) => document,
        Err(error) => {
            error!("The state is not loaded: {error}");
            state.values.clear();
            state.fields.clear();
            return;
        }
    };
    state.fields.insert(SCHEMA_FIELD.to_owned(), SCHEMA.to_string());
    let stored = std::mem::take(&mut state.values);
    for id in stored.keys() {
        if id != BYPASS_ID && !parameters().iter().any(|parameter| parameter.id == id) {
            warn!("The state has a parameter {id:?}, which is not known: ignored");
        }
    }
    state.values = parameters()
        .iter()
        .enumerate()
        .map(|(index, parameter)| {
            let value = value_of(index, parameter, stored.get(parameter.id), &document.kit);
            (parameter.id.to_owned(), StoredValue::Number(value))
        })
        .chain([(BYPASS_ID.to_owned(), StoredValue::Switch(bypassed(stored.get(BYPASS_ID))))])
        .collect();
}

/// Whether a state is one of a bypassed instance. A host that does not store its bypass leaves it off.
fn bypassed(stored: Option<&StoredValue>) -> bool {
    match stored {
        None => false,
        Some(StoredValue::Switch(bypassed)) => *bypassed,
        Some(other) => {
            warn!("The state has {BYPASS_ID} as {other:?}, neither true nor false: set to false");
            false
        }
    }
}

fn value_of(index: usize, parameter: &Parameter, stored: Option<&StoredValue>, kit: &KitSpec) -> f32 {
    let (Parameter { min, max, unit, .. }, default) = (*parameter, default_value(index, kit));
    match stored {
        None => default,
        Some(StoredValue::Number(value)) if (min..=max).contains(value) => parameter.snap(*value),
        Some(StoredValue::Number(value)) => {
            let name = name(index, kit);
            warn!("The state has {name} at {value}, accepted: {min} to {max}{unit}");
            if value.is_nan() { default } else { parameter.snap(*value) }
        }
        Some(other) => {
            let name = name(index, kit);
            warn!("The state has {name} as {other:?}, not a number: set to {default}{unit}");
            default
        }
    }
}

#[cfg(test)]
mod tests;
