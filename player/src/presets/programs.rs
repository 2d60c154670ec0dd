//! Presets by number, as MIDI's program changes call them.

use std::collections::BTreeMap;

use overhear_engine::kit_spec::KitSpec;

use super::library::Library;
use super::preset::Preset;
use crate::midi::assignments::Assignment;

/// Programs that MIDI can name.
const MOST: usize = 128;

/// A preset at a kit, ready for the audio thread. A kit that the preset carries is not part of it: that would have to be built.
#[derive(Debug, Clone, PartialEq)]
pub struct Program {
    /// Values in the parameters' units by place in the table; parameters that are not here stay as they are.
    pub values: Vec<(usize, f32)>,
    /// Assignments of notes, if it says anything about them.
    pub notes: Option<BTreeMap<u8, Assignment>>,
}

impl Program {
    /// What loading a preset sets at a kit.
    pub fn of(preset: &Preset, kit: &KitSpec) -> Program {
        Program { values: preset.values_at(kit), notes: preset.notes.clone() }
    }
}

/// The presets of a library in its order: the built-in ones, then the user's by name.
#[derive(Debug, Clone, Default)]
pub struct Programs {
    /// None where a preset could not be read: it keeps its number and changes nothing.
    presets: Vec<Option<Preset>>,
    /// The same at the present kit.
    programs: Vec<Option<Program>>,
}

impl Programs {
    /// Reads every preset, for a kit.
    pub fn of(library: &Library, kit: &KitSpec) -> Programs {
        let entries = library.list().into_iter().take(MOST);
        let presets = entries.map(|entry| library.load(&entry.name).ok()).collect();
        Programs { presets, programs: Vec::new() }.at(kit)
    }

    /// The same presets at another kit.
    #[must_use]
    pub fn at(&self, kit: &KitSpec) -> Programs {
        let presets = self.presets.clone();
        let programs = presets.iter().map(|preset| Some(Program::of(preset.as_ref()?, kit))).collect();
        Programs { presets, programs }
    }

    /// The program of a number, from 0.
    ///
    /// # Real-time
    /// A look-up.
    pub fn get(&self, number: u8) -> Option<&Program> {
        self.programs.get(usize::from(number))?.as_ref()
    }
}
