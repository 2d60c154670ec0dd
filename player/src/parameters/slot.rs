//! The parameters that every slot of a kit has.

use overhear_engine::kit::SILENT_DB;
use overhear_engine::kit_spec::{Kind, KitSpec, PieceSpec};
use overhear_engine::slot::Slot;
use overhear_engine::surface::wires::PRELOAD;

use super::parameter::{Drives, Parameter, SlotParameter};

impl SlotParameter {
    /// Every parameter of a slot, in the order of the table.
    pub const ALL: [SlotParameter; 9] = [
        SlotParameter::Tune,
        SlotParameter::Muffle,
        SlotParameter::Level,
        SlotParameter::Pan,
        SlotParameter::Position,
        SlotParameter::Stick,
        SlotParameter::Preload,
        SlotParameter::Wires,
        SlotParameter::Pedal,
    ];

    /// End of the parameter's name, behind the piece's: `tune` of `kick_tune`.
    pub const fn name(self) -> &'static str {
        match self {
            SlotParameter::Tune => "tune",
            SlotParameter::Muffle => "muffle",
            SlotParameter::Level => "level",
            SlotParameter::Pan => "pan",
            SlotParameter::Position => "position",
            SlotParameter::Stick => "stick",
            SlotParameter::Preload => "preload",
            SlotParameter::Wires => "wires",
            SlotParameter::Pedal => "pedal",
        }
    }

    /// End of the name that it once had, still understood.
    pub(super) const fn former_name(self) -> Option<&'static str> {
        match self {
            SlotParameter::Position => Some("place"),
            SlotParameter::Stick => Some("striker"),
            _ => None,
        }
    }

    /// Name on screen.
    pub const fn label(self) -> &'static str {
        match self {
            SlotParameter::Tune => "Tune",
            SlotParameter::Muffle => "Muffle",
            SlotParameter::Level => "Level",
            SlotParameter::Pan => "Pan",
            SlotParameter::Position => "Position",
            SlotParameter::Stick => "Stick",
            SlotParameter::Preload => "Preload",
            SlotParameter::Wires => "Wires",
            SlotParameter::Pedal => "Pedal",
        }
    }

    /// End of the id, behind the slot's two digits. Frozen.
    const fn key(self) -> &'static str {
        match self {
            SlotParameter::Tune => "tune",
            SlotParameter::Muffle => "muff",
            SlotParameter::Level => "levl",
            SlotParameter::Pan => "pan_",
            SlotParameter::Position => "posn",
            SlotParameter::Stick => "stik",
            SlotParameter::Preload => "prel",
            SlotParameter::Wires => "wire",
            SlotParameter::Pedal => "pedl",
        }
    }

    /// Whether a piece has such a control.
    pub fn acts_on(self, piece: &PieceSpec) -> bool {
        match self {
            SlotParameter::Preload | SlotParameter::Wires => {
                piece.drum().is_some_and(|drum| drum.wires.is_some())
            }
            SlotParameter::Pedal => piece.instrument.kind() == Kind::HiHat,
            _ => true,
        }
    }

    /// Value on a piece before anybody moves it, if the piece says.
    pub(super) fn default_on(self, piece: &PieceSpec) -> Option<f32> {
        match self {
            SlotParameter::Muffle => Some(piece.defaults.muffle as f32),
            SlotParameter::Level => Some(piece.defaults.level_db as f32),
            SlotParameter::Pan => Some((100.0 * piece.defaults.pan) as f32),
            SlotParameter::Preload => piece.defaults.preload.map(|preload| preload as f32),
            _ => None,
        }
    }

    /// Value where a piece has such a control and says nothing of it.
    pub(super) fn usual(self) -> f32 {
        self.shape().default
    }

    /// The parameter of a slot, named and set as in a kit. Its texts stay for the life of the process.
    pub(super) fn in_slot(self, slot: Slot, kit: &KitSpec) -> Parameter {
        let (shape, piece) = (self.shape(), kit.piece(slot));
        let title = piece.map_or_else(|| format!("Slot {}", number(slot)), |piece| piece.title.clone());
        let own = piece.and_then(|piece| self.default_on(piece));
        // Where a piece says nothing of it, it is where the first one is that does.
        let elsewhere = || kit.slots().find_map(|(_, piece)| self.default_on(piece));
        let alike = own.or_else(|| elsewhere().filter(|_| self == SlotParameter::Preload));
        Parameter {
            id: format!("{:02}{}", number(slot), self.key()).leak(),
            name: name_in(slot, self, kit).leak(),
            label: self.label(),
            group: title.leak(),
            default: shape.snap(alike.unwrap_or(shape.default)),
            drives: Drives::Slot(slot, self),
            ..shape
        }
    }

    /// What is the same in every slot.
    fn shape(self) -> Parameter {
        let unit_range = Parameter { step: 0.001, decimals: 3, ..Parameter::SWITCH };
        match self {
            SlotParameter::Tune => Parameter {
                unit: " st",
                min: -12.0,
                max: 12.0,
                centre: 0.0,
                // About a tenth of a cent. Multiples of a power of two are exact: as many semitones as are asked for.
                step: 1.0 / 1024.0,
                decimals: 2,
                ..Parameter::SWITCH
            },
            SlotParameter::Level => Parameter {
                unit: " dB",
                min: SILENT_DB as f32,
                max: 12.0,
                // As on a mixing desk's fader: half its travel for the last 12 dB and the reserve.
                centre: -12.0,
                step: 0.01,
                decimals: 2,
                ..Parameter::SWITCH
            },
            SlotParameter::Pan => {
                Parameter { unit: " %", min: -100.0, max: 100.0, centre: 0.0, ..Parameter::SWITCH }
            }
            SlotParameter::Position => Parameter { min: -1.0, centre: 0.0, step: 0.005, ..unit_range },
            SlotParameter::Stick => {
                let max = (STICKS.len() - 1) as f32;
                Parameter { max, centre: max / 2.0, choices: &STICKS, ..Parameter::SWITCH }
            }
            SlotParameter::Preload => Parameter {
                unit: " N",
                min: *PRELOAD.start() as f32,
                max: *PRELOAD.end() as f32,
                // As much knob for the loose half of what drummers use as for the tight one.
                centre: 0.15,
                // Of the steps about as fine as this, the largest of which 0.03, 0.15 and 1.5 are exact multiples
                // in single precision.
                step: 1.0 / 1100.0,
                decimals: 3,
                ..Parameter::SWITCH
            },
            SlotParameter::Wires => Parameter { default: 1.0, choices: &["off", "on"], ..Parameter::SWITCH },
            SlotParameter::Muffle | SlotParameter::Pedal => unit_range,
        }
    }
}

impl Parameter {
    /// From 0 to 1 in one step, without names.
    pub(super) const SWITCH: Parameter = Parameter {
        id: "",
        name: "",
        label: "",
        group: "",
        unit: "",
        min: 0.0,
        max: 1.0,
        default: 0.0,
        centre: 0.5,
        step: 1.0,
        decimals: 0,
        drives: Drives::Slot(Slot::ALL[0], SlotParameter::Tune),
        choices: &[],
    };
}

/// Texts of the stick parameters: what the note says, then every striker in the engine's order.
const STICKS: [&str; 11] = [
    "as mapped",
    "stick",
    "shoulder",
    "nylon",
    "felt-beater",
    "plastic-beater",
    "timpani-mallet",
    "hard-mallet",
    "yarn-mallet",
    "rimshot",
    "cross-stick",
];

/// Number of a slot as players count: from 1.
pub fn number(slot: Slot) -> usize {
    slot.index() + 1
}

/// Name of a slot's parameter: by its piece, or by the slot's number if it is empty.
pub(super) fn name_in(slot: Slot, what: SlotParameter, kit: &KitSpec) -> String {
    match kit.piece(slot) {
        Some(piece) => format!("{}_{}", piece.name.replace('-', "_"), what.name()),
        None => format!("slot_{}_{}", number(slot), what.name()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use overhear_engine::strike::Striker;

    #[test]
    fn sticks_are_those_of_the_engine_in_its_order() {
        assert_eq!(STICKS[1..], Striker::ALL.map(Striker::name));
    }
}
