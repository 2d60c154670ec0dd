//! What a parameter is, and what it moves.

use overhear_engine::kit::{Control, Microphone};
use overhear_engine::slot::Slot;
#[cfg(doc)]
use {
    crate::midi::{maps::NoteMap, playing::ChokeRule},
    overhear_engine::piece::Quality,
};

use super::error::ParameterError;

/// What a parameter moves of the piece in its slot. What a kind of piece does not have is inert: it reads `-` and does
/// nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SlotParameter {
    /// Pitch, semitones from the piece's own.
    Tune,
    /// Muffling, 0 to 1.
    Muffle,
    /// Level in every microphone, dB.
    Level,
    /// Place in the stereo, percent.
    Pan,
    /// Added to the place of strokes, share of the radius.
    Position,
    /// What is swung: 0 for what the note says, then by its place in [`Striker::ALL`] from 1 on.
    ///
    /// [`Striker::ALL`]: overhear_engine::strike::Striker::ALL
    Stick,
    /// Force that presses snare wires on, N; of a drum with wires.
    Preload,
    /// Whether snare wires lie on; of a drum with wires.
    Wires,
    /// The pedal, 0 (up) to 1 (down); of a hi-hat.
    Pedal,
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
    pub(super) fn parse(&self, name: &str, text: &str) -> Result<f32, ParameterError> {
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

    /// Steps from the smallest value to the largest, of a switch, a list or a small number: hosts step through these and
    /// glide through all others. Each step is as wide as the others on a knob's travel.
    pub fn steps(&self) -> Option<u32> {
        let counts = matches!(self.drives, Drives::Building(Construction::Workers));
        (counts || !self.choices.is_empty()).then_some((self.max - self.min) as u32)
    }

    /// What CLAP hosts have for a plain value: the number of its step from 0, or its share of the range.
    pub fn in_clap(&self, value: f32) -> f64 {
        let share = f64::from(self.normalized(value));
        self.steps().map_or(share, |steps| (share * f64::from(steps)).round())
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
