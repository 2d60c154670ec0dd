//! Presets by number, as MIDI's program changes call them.

use std::collections::BTreeMap;

use super::{Library, Preset};
use crate::midi::assignments::Assignment;
use crate::parameters::PARAMETERS;

/// Programs that MIDI can name.
const MOST: usize = 128;

/// A preset, ready for the audio thread.
#[derive(Debug, Clone, PartialEq)]
pub struct Program {
    /// Values in the parameters' units by place in [`PARAMETERS`]; parameters that are not here stay as they are.
    pub values: Vec<(usize, f32)>,
    /// Assignments of notes, if it says anything about them.
    pub notes: Option<BTreeMap<u8, Assignment>>,
}

impl Program {
    /// What loading a preset sets.
    pub fn of(preset: &Preset) -> Program {
        let values = (0..PARAMETERS.len()).filter_map(|index| Some((index, preset.value(index)?))).collect();
        Program { values, notes: preset.notes.clone() }
    }
}

/// The presets of a library in its order: the built-in ones, then the user's by name.
#[derive(Debug, Clone, Default)]
pub struct Programs(Vec<Option<Program>>);

impl Programs {
    /// Reads every preset. One that cannot be read keeps its number and changes nothing.
    pub fn of(library: &Library) -> Programs {
        let entries = library.list().into_iter().take(MOST);
        Programs(
            entries.map(|entry| library.load(&entry.name).ok().map(|preset| Program::of(&preset))).collect(),
        )
    }

    /// The program of a number, from 0.
    ///
    /// # Real-time
    /// A look-up.
    pub fn get(&self, number: u8) -> Option<&Program> {
        self.0.get(usize::from(number))?.as_ref()
    }
}
