//! What a project stores, and its parts as text.

use std::collections::BTreeMap;

use tracing::warn;

use crate::kit_document::KitDocument;
use crate::kit_file::{self, KitFileError};
use crate::midi::assignments::{Assignment, NOTES};
use crate::midi::calibration::Learned;

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

/// Field that holds the calibration of pads and pedal; see
/// [`Learned::to_text`]. Left out while nothing is learned.
pub const CALIBRATION_FIELD: &str = "calibration";

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
    fields
        .get(KIT_FIELD)
        .map_or_else(|| Ok(KitDocument::standard()), |text| kit_file::read_stored(KIT_NAME, text))
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

/// Reads a calibration; what is not understood is logged and left out.
pub fn calibration(text: &str) -> Learned {
    let (learned, unknown) = Learned::from_text(text);
    for word in unknown {
        warn!("The state has a calibration {word:?}, which is not understood: ignored");
    }
    learned
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
