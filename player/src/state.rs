//! What a project stores, and how states of other versions and broken ones are read.
//!
//! The shell parses a project's bytes and hands over the values and fields; what cannot be parsed is refused there and
//! the instance plays on as it was. What parses is put in order here before it is loaded: every
//! parameter gets a value, so that a state always sounds the same, whatever was set before. A state
//! whose kit cannot be read is refused as a whole: all that it says is about that kit.

mod former;
mod stored;

use overhear_engine::kit_spec::KitSpec;
use tracing::{error, warn};

use crate::parameters::{BYPASS_ID, Parameter, default_value, name, parameters};

pub use stored::{
    CALIBRATION_FIELD, KIT_FIELD, NOTES_FIELD, SCHEMA, SCHEMA_FIELD, State, StoredValue, VIEW_FIELD,
    WINDOW_FIELD, calibration, kit, kit_text, notes, notes_text,
};

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
