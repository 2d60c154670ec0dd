//! A preset, and the built-in ones.

use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock};

use overhear_engine::kit_spec::KitSpec;

use crate::kit_document::KitDocument;
use crate::kit_file;
use crate::midi::assignments::Assignment;
use crate::parameters::{
    COUNT, Drives, Manner, Parameter, default_value, is_live, parameters, slot_index, slot_parameter,
};

/// Number of the format that is written and read.
pub const FORMAT: i64 = 2;

/// Name of the preset that has everything at its default.
pub const DEFAULT: &str = "default";

/// The built-in presets: name and file.
pub const FACTORY: [(&str, &str); 8] = [
    (DEFAULT, "format = 2\nabout = \"Everything as it comes.\"\n"),
    ("studio", include_str!("../../presets/studio.toml")),
    ("jazz", include_str!("../../presets/jazz.toml")),
    ("rock", include_str!("../../presets/rock.toml")),
    ("funk", include_str!("../../presets/funk.toml")),
    ("mallets", include_str!("../../presets/mallets.toml")),
    ("orchestra", include_str!("../../presets/orchestra.toml")),
    ("lo-fi", include_str!("../../presets/lo-fi.toml")),
];

/// A preset.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Preset {
    /// What it is for, in a line.
    pub about: String,
    /// Values in the parameters' units by place in the table for the preset's [kit](Self::kit); others are at their default
    /// or stay.
    pub values: BTreeMap<usize, f32>,
    /// Assignments of notes, if it says anything about them.
    pub notes: Option<BTreeMap<u8, Assignment>>,
    pub(super) carried: Option<Carried>,
}

/// A kit in a preset.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Carried {
    /// As the file has it.
    pub(super) table: toml::Table,
    /// What it says.
    pub(super) document: Arc<KitDocument>,
}

impl Preset {
    /// A preset of a kit and the present values, in the parameters' units, without what belongs to the player. The standard
    /// kit is not carried.
    pub fn of(values: impl Fn(usize) -> f32, document: &Arc<KitDocument>, about: &str) -> Preset {
        let differs = |(index, parameter): (usize, &Parameter)| {
            let value = parameter.snap(values(index));
            let moved = value != default_value(index, &document.kit) && is_live(index, &document.kit);
            (moved && !is_set_up(parameter)).then_some((index, value))
        };
        let values = parameters().iter().enumerate().filter_map(differs).collect();
        let carried = (**document != *STANDARD).then(|| {
            // What is written there can be read.
            let table = kit_file::write(document).parse().unwrap_or_default();
            Carried { table, document: document.clone() }
        });
        Preset { about: about.to_owned(), values, notes: None, carried }
    }

    /// The kit that it carries, to be put in the place of the present one.
    pub fn kit(&self) -> Option<&Arc<KitDocument>> {
        self.carried.as_ref().map(|carried| &carried.document)
    }

    /// The kit by whose names its parameters are called.
    pub(super) fn own_kit(&self) -> &KitSpec {
        self.carried.as_ref().map_or(&STANDARD.kit, |carried| &carried.document.kit)
    }

    /// The value, in the parameter's unit, that it takes when the preset is loaded at a kit; `None` if it stays as it is. The
    /// kit is that of the preset, if it carries one and that is loaded too.
    pub fn value(&self, index: usize, kit: &KitSpec) -> Option<f32> {
        let parameter = parameters().get(index).filter(|_| is_live(index, kit))?;
        let default = (!is_set_up(parameter)).then(|| default_value(index, kit));
        self.place_of(index, kit).and_then(|own| self.values.get(&own).copied()).or(default)
    }

    /// A parameter of a kit as the preset's own kit has it: that of the piece of the same name.
    fn place_of(&self, index: usize, kit: &KitSpec) -> Option<usize> {
        let Some((slot, what)) = slot_parameter(index) else { return Some(index) };
        let (own, _) = self.own_kit().find(&kit.piece(slot)?.name)?;
        Some(slot_index(own, what))
    }

    /// Every value that loading the preset at a kit sets, by place in the table, each in its parameter's unit.
    pub fn values_at(&self, kit: &KitSpec) -> Vec<(usize, f32)> {
        (0..COUNT).filter_map(|index| Some((index, self.value(index, kit)?))).collect()
    }
}

/// The kit of presets that carry none.
pub(super) static STANDARD: LazyLock<KitDocument> = LazyLock::new(KitDocument::standard);

/// Whether a parameter belongs to the player's set-up rather than to the sound: presets leave it unless they name it.
pub fn is_set_up(parameter: &Parameter) -> bool {
    use Manner::{Channel, Chokes, Curve, FollowsPosition, FollowsPrograms, Map};
    match parameter.drives {
        Drives::Playing(Map | Channel | Chokes | FollowsPosition | FollowsPrograms | Curve) => true,
        // About the machine: the same instrument, computed more or less closely, or by more cores.
        Drives::Building(_) => true,
        _ => false,
    }
}
