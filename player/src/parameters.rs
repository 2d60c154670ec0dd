//! The parameters: one table that the host, the editor, presets and `--set` all read.
//!
//! First come those of the 16 slots of a kit, as many for each slot, whatever stands there; then those of the whole kit. What
//! needs building (sizes, heads, metals) is no parameter but in the kit.
//!
//! Ids are stored in projects and presets and hashed by hosts: once released, an id, its meaning
//! and the order of the table never change. New parameters are appended.
//!
//! Values are single precision multiples of [`Parameter::step`]. Hosts carry a value as a share
//! of the range and lose its last bits; rounding to a step finds them again, so that a project, a
//! preset and a command line that ask for the same value get the same samples.

use std::sync::LazyLock;

use overhear_engine::kit::{Control, Microphone};
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::slot::{SLOTS, Slot};
#[cfg(doc)]
use {
    crate::midi::{maps::NoteMap, playing::ChokeRule},
    overhear_engine::piece::Quality,
};

mod document;
mod error;
mod in_kit;
mod slot;
mod table;

pub use document::{about, document};
pub use error::ParameterError;
pub use in_kit::{
    default_value, find, from_text, is_live, name, parse_assignment, parse_value, range, slot_index,
    slot_parameter, text,
};
pub use slot::{SlotParameter, number};

/// Parameters that belong to a slot: they come first, slot by slot.
pub const SLOT_COUNT: usize = SLOTS * SlotParameter::ALL.len();

/// All parameters.
pub const COUNT: usize = SLOT_COUNT + table::GLOBALS;

/// Every parameter, in the order hosts see, named and set as in the standard kit. The order is frozen: append only.
///
/// # Real-time
/// A look at a pointer, once it has been called anywhere before.
pub fn parameters() -> &'static [Parameter; COUNT] {
    static PARAMETERS: LazyLock<[Parameter; COUNT]> = LazyLock::new(|| {
        let kit = KitSpec::standard();
        std::array::from_fn(|index| match slot_parameter(index) {
            Some((slot, what)) => what.in_slot(slot, &kit),
            None => table::TABLE[index - SLOT_COUNT],
        })
    });
    &PARAMETERS
}

/// Id of the host's bypass. Frozen. No parameter of the table: presets and command lines have nothing to bypass.
pub const BYPASS_ID: &str = "bypass";

/// Group in which hosts list the bypass.
pub const BYPASS_GROUP: &str = "Kit";

/// Number by which hosts know a parameter's id: the hash of the framework.
pub fn host_id(id: &str) -> u32 {
    let hash = id.bytes().fold(0_u32, |hash, byte| hash.wrapping_mul(31).wrapping_add(u32::from(byte)));
    // The highest bit belongs to the host in VST3.
    hash & !(1 << 31)
}

/// What a parameter moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drives {
    /// Something of the piece in a slot.
    Slot(Slot, SlotParameter),
    /// A control of the engine, in the control's own unit.
    Control(Control),
    /// Where a pair of microphones stands, from where it does by default.
    Stand(Microphone, Stand),
    /// How notes become strokes.
    Playing(Manner),
    /// How pieces are built: acts once they have been built anew.
    Building(Construction),
}

/// What of where a pair of microphones stands a parameter moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stand {
    /// Up, cm.
    Height,
    /// Away from the drummer, cm.
    Depth,
    /// How far the two are apart, percent.
    Width,
}

/// What of [`Style`](crate::midi::playing::Style) a parameter moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Manner {
    /// Stick speed at full velocity, m/s.
    Dynamics,
    /// Exponent of the velocity curve.
    Curve,
    /// Mean distance from where a stroke is aimed, hundredths of the radius.
    PositionSpread,
    /// Mean difference of speed, dB.
    SpeedSpread,
    /// The map of the instrument played, by its place in [`NoteMap::ALL`].
    Map,
    /// The only MIDI channel heard, 1 to 16, or 0 for all.
    Channel,
    /// What chokes cymbals, by its place in [`ChokeRule::ALL`].
    Chokes,
    /// Whether controllers move the place of strokes.
    FollowsPosition,
    /// Whether program changes load presets.
    FollowsPrograms,
}

/// What of building a parameter sets: how closely the same instrument is computed, and by how many cores.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Construction {
    /// Quality while playing, by its place in [`Quality::ALL`].
    Quality,
    /// Quality while a host renders faster or slower than real time: 0 for that of playing, then as above from 1 on.
    OfflineQuality,
    /// Threads that render pieces beside the host's own.
    Workers,
}

/// One parameter. Plain values are in [`unit`](Self::unit)s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Frozen id in states and hosts: at most 6 ASCII characters, as longer ones may collide once
    /// hashed.
    pub id: &'static str,
    /// Name on command lines and in presets, in snake case; of a slot's, in the standard kit.
    pub name: &'static str,
    /// Name on screen within its [`group`](Self::group).
    pub label: &'static str,
    /// Group on screen: the piece that the standard kit has in the slot, `Slot 10` where it has none, or `Kit`.
    pub group: &'static str,
    /// Unit as printed after a value; empty for a plain number.
    pub unit: &'static str,
    /// Smallest value.
    pub min: f32,
    /// Largest value.
    pub max: f32,
    /// Value of a fresh instance, with the standard kit.
    pub default: f32,
    /// Value in the middle of a knob's travel; sets its skew.
    pub centre: f32,
    /// Every value is a multiple of this.
    pub step: f32,
    /// Digits worth printing after the point.
    pub decimals: usize,
    /// What it moves.
    pub drives: Drives,
    /// Names of the values from [`min`](Self::min) on, if they have names.
    pub choices: &'static [&'static str],
}

impl Parameter {
    /// The nearest value, in its unit, that the parameter can take: within the range and a multiple of the
    /// step. A value that is not a number gives the default.
    pub fn snap(&self, value: f32) -> f32 {
        if value.is_nan() {
            return self.default;
        }
        ((value / self.step).round() * self.step).clamp(self.min, self.max)
    }

    /// Exponent of the knob's travel that puts [`centre`](Self::centre) in its middle.
    pub fn skew(&self) -> f32 {
        0.5f32.ln() / ((self.centre - self.min) / (self.max - self.min)).ln()
    }

    /// Place of a plain value on the knob's travel, 0 to 1: what hosts store and automate.
    pub fn normalized(&self, value: f32) -> f32 {
        ((value - self.min) / (self.max - self.min)).clamp(0.0, 1.0).powf(self.skew())
    }

    /// A value in the parameter's unit as shown, without that unit: `-inf` for a level that is silent.
    pub fn text(&self, value: f32) -> String {
        if self.is_level() && value <= self.min {
            return "-inf".to_owned();
        }
        if let Some(choice) = self.choice(value) {
            return choice.to_owned();
        }
        let text = format!("{value:.*}", self.decimals);
        // Values that round to zero from below.
        if text.trim_start_matches(['-', '0', '.']).is_empty() {
            text.trim_start_matches('-').to_owned()
        } else {
            text
        }
    }

    /// A value in the parameter's unit, typed with or without it; the range is not checked.
    pub fn from_text(&self, text: &str) -> Option<f32> {
        let number = text.trim().trim_end_matches(self.unit.trim()).trim_end();
        if self.is_level() && number == "-inf" {
            return Some(self.min);
        }
        if let Some(index) = self.choices.iter().position(|choice| choice.eq_ignore_ascii_case(number)) {
            return Some(self.min + index as f32);
        }
        number.parse().ok().filter(|value: &f32| value.is_finite())
    }

    /// Reads a value in the parameter's unit, for a parameter of that name.
    ///
    /// # Errors
    /// [`ParameterError`] with the value and the accepted range.
    fn parse(&self, name: &str, text: &str) -> Result<f32, ParameterError> {
        let (Parameter { min, max, unit, .. }, name) = (*self, name.to_owned());
        let Some(value) = self.from_text(text) else {
            return Err(ParameterError::NotANumber { name, given: text.to_owned(), min, max, unit });
        };
        if (min..=max).contains(&value) {
            Ok(self.snap(value))
        } else {
            // Through text, so that 0.1 is reported as 0.1 and not as its nearest binary.
            let value = value.to_string().parse().unwrap_or(f64::from(value));
            Err(ParameterError::OutOfRange { name, value, min, max, unit })
        }
    }

    /// The name of a value, if values have names and no unit.
    pub fn choice(&self, value: f32) -> Option<&'static str> {
        let index = self.snap(value) - self.min;
        self.choices.get(index as usize).copied()
    }

    /// Whether hosts may move it while it sounds: all but those that ask for pieces to be built.
    pub fn is_automatable(&self) -> bool {
        !matches!(self.drives, Drives::Building(_))
    }

    fn is_level(&self) -> bool {
        matches!(
            self.drives,
            Drives::Slot(_, SlotParameter::Level)
                | Drives::Control(Control::MicrophoneLevel(_) | Control::CloseLevel | Control::Master)
        )
    }
}

#[cfg(test)]
mod tests;
