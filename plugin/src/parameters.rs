//! The parameters: one table that the host, the editor, presets and `--set` all read.
//!
//! Ids are stored in projects and presets and hashed by hosts: once released, an id, its meaning
//! and the order of the table never change. New parameters are appended.
//!
//! Values are single precision multiples of [`Parameter::step`]. Hosts carry a value as a share
//! of the range and lose its last bits; rounding to a step finds them again, so that a project, a
//! preset and a command line that ask for the same value get the same samples.

use overhear_engine::kit::{Control, Microphone};
use overhear_engine::piece::PieceId;
#[cfg(doc)]
use {
    crate::midi::{maps::NoteMap, playing::ChokeRule},
    overhear_engine::{piece::Quality, strike::Striker},
};

mod document;
mod error;
mod table;

pub use document::document;
pub use error::ParameterError;
pub use table::PARAMETERS;

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
    /// A control of the engine, in the control's own unit.
    Control(Control),
    /// A control of the engine, in hundredths of its own unit.
    Percent(Control),
    /// The tuning of a cymbal, given in semitones where the engine takes a ratio.
    Semitones(PieceId),
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
    PlaceSpread,
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
    /// Added to the place of strokes on a piece, share of the radius.
    Offset(PieceId),
    /// What is swung at a piece: 0 for what the map says, then by its place in [`Striker::ALL`] from 1 on.
    Striker(PieceId),
}

/// What of [`BuildOptions`](overhear_engine::piece::BuildOptions) a parameter sets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Construction {
    /// Quality while playing, by its place in [`Quality::ALL`].
    Quality,
    /// Quality while a host renders faster or slower than real time: 0 for that of playing, then as above from 1 on.
    OfflineQuality,
    /// Pitch of a drum's resonant head over the batter head's.
    ResonantRatio(PieceId),
    /// Threads that render pieces beside the host's own.
    Workers,
}

/// One parameter. Plain values are in [`unit`](Self::unit)s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Frozen id in states and hosts: at most 6 ASCII characters, as longer ones may collide once
    /// hashed.
    pub id: &'static str,
    /// Name on command lines and in presets, in snake case.
    pub name: &'static str,
    /// Name on screen within its [`group`](Self::group).
    pub label: &'static str,
    /// Group on screen: the piece, or `Kit`.
    pub group: &'static str,
    /// Unit as printed after a value; empty for a plain number.
    pub unit: &'static str,
    /// Smallest value.
    pub min: f32,
    /// Largest value.
    pub max: f32,
    /// Value of a fresh instance.
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

impl Construction {
    /// Whether it is about the machine: the same instrument, computed more or less closely, or by more cores.
    pub fn is_effort(self) -> bool {
        matches!(self, Construction::Quality | Construction::OfflineQuality | Construction::Workers)
    }
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

    /// Reads the value of a `name=value`, in the parameter's unit.
    ///
    /// # Errors
    /// [`ParameterError`] with the value and the accepted range.
    pub fn parse(&self, text: &str) -> Result<f32, ParameterError> {
        let Parameter { name, min, max, unit, .. } = *self;
        let value = self.from_text(text).ok_or_else(|| ParameterError::NotANumber {
            name,
            given: text.to_owned(),
            min,
            max,
            unit,
        })?;
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
            Drives::Control(
                Control::Level(_) | Control::MicrophoneLevel(_) | Control::CloseLevel | Control::Master
            )
        )
    }
}

/// The parameter of that long name, with its index in [`PARAMETERS`].
///
/// # Errors
/// [`ParameterError::Unknown`] listing every name.
pub fn find(name: &str) -> Result<(usize, &'static Parameter), ParameterError> {
    PARAMETERS.iter().enumerate().find(|(_, parameter)| parameter.name == name).ok_or_else(|| {
        let names: Vec<_> = PARAMETERS.iter().map(|parameter| parameter.name).collect();
        ParameterError::Unknown { name: name.to_owned(), accepted: names.join(", ") }
    })
}

/// Reads a `name=value` into an index in [`PARAMETERS`] and a value in that parameter's unit.
///
/// # Errors
/// [`ParameterError`] if the form, the name or the value is wrong.
pub fn parse_assignment(text: &str) -> Result<(usize, f32), ParameterError> {
    let syntax = || ParameterError::Syntax { given: text.to_owned() };
    let (name, value) = text.split_once('=').ok_or_else(syntax)?;
    let (index, parameter) = find(name.trim())?;
    Ok((index, parameter.parse(value)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use overhear_engine::piece::Piece;

    /// Changing this list breaks every project that was ever saved.
    const FROZEN_IDS: [&str; 86] = [
        "kktune", "kkmuff", "kklevl", "sntune", "snmuff", "snlevl", "rttune", "rtmuff", "rtlevl", "fttune",
        "ftmuff", "ftlevl", "crtune", "crmuff", "crlevl", "rdtune", "rdmuff", "rdlevl", "sptune", "spmuff",
        "splevl", "master", "dynam", "snprel", "snwire", "tptune", "tpmuff", "tplevl", "kkpan", "snpan",
        "rtpan", "ftpan", "crpan", "rdpan", "sppan", "tppan", "kkplac", "snplac", "rtplac", "ftplac",
        "crplac", "rdplac", "spplac", "tpplac", "kkstik", "snstik", "rtstik", "ftstik", "crstik", "rdstik",
        "spstik", "tpstik", "velcur", "humpla", "humspd", "notmap", "midchn", "chokes", "poscc", "qualit",
        "offqua", "kkreso", "snreso", "rtreso", "ftreso", "cllevl", "ohlevl", "rmlevl", "hear", "sympat",
        "clip", "hhtune", "hhmuff", "hhlevl", "hhpan", "hhplac", "hhstik", "hhpedl", "workrs", "progch",
        "ohup", "ohaway", "ohwide", "rmup", "rmaway", "rmwide",
    ];

    #[test]
    fn ids_hash_as_the_framework_documents() {
        assert_eq!((host_id(""), host_id("a"), host_id("ab")), (0, 97, 97 * 31 + 98));
        assert_eq!(host_id("kktune") >> 31, 0);
    }

    #[test]
    fn ids_and_their_order_are_frozen() {
        assert_eq!(PARAMETERS.map(|parameter| parameter.id), FROZEN_IDS);
    }

    #[test]
    fn ids_are_short_and_ids_and_names_unique() {
        for (index, parameter) in PARAMETERS.iter().enumerate() {
            assert!(parameter.id.is_ascii() && (1..=6).contains(&parameter.id.len()));
            for other in &PARAMETERS[..index] {
                assert_ne!(parameter.id, other.id);
                assert_ne!(parameter.name, other.name);
            }
        }
    }

    #[test]
    fn tunings_span_what_the_engine_accepts_about_the_pieces_own_pitch() {
        for parameter in &PARAMETERS {
            let Parameter { min, centre, max, default, .. } = *parameter;
            let (piece, spanned): (_, [f32; 3]) = match parameter.drives {
                Drives::Control(Control::Tuning(piece)) => (piece, [min, centre, max]),
                Drives::Semitones(piece) => (piece, [min, centre, max].map(|st| (st / 12.0).exp2())),
                _ => continue,
            };
            assert!((min..=max).contains(&default), "{piece:?}");
            let (min, own, max) = Piece::tuning_range(piece);
            assert_eq!(spanned, [min, own, max].map(|value| value as f32), "{piece:?}");
        }
    }

    #[test]
    fn every_piece_can_be_tuned_muffled_and_levelled() {
        for piece in PieceId::KIT {
            let name = piece.name().replace('-', "_");
            for what in ["tune", "muffle", "level"] {
                assert!(find(&format!("{name}_{what}")).is_ok(), "{name}_{what}");
            }
        }
    }

    #[test]
    fn a_value_that_went_through_a_host_comes_back_the_same() {
        for parameter in &PARAMETERS {
            for part in 0..=1000 {
                let span = parameter.max - parameter.min;
                let value = parameter.snap(parameter.min + span * part as f32 / 1000.0);
                let share = parameter.normalized(value).powf(1.0 / parameter.skew());
                let back = parameter.snap(parameter.min + span * share);
                assert_eq!(value, back, "{}", parameter.name);
                assert_eq!(parameter.snap(value), value, "{}", parameter.name);
            }
        }
    }

    #[test]
    fn text_and_value_agree_both_ways() {
        for parameter in &PARAMETERS {
            for value in [parameter.min, parameter.default, parameter.centre, parameter.max] {
                // A switch has no middle.
                let value = parameter.snap(value);
                let text = format!("{}{}", parameter.text(value), parameter.unit);
                assert_eq!(parameter.from_text(&text), Some(value), "{text}");
            }
        }
    }

    #[test]
    fn errors_name_the_value_and_what_is_accepted() {
        let error = |text: &str| parse_assignment(text).unwrap_err().to_string();
        assert_eq!(error("kick_tune=20"), "kick_tune is 20, accepted: 35 to 90 Hz");
        assert_eq!(error("ride_tune=-12.5"), "ride_tune is -12.5, accepted: -12 to 12 st");
        assert_eq!(error("kick_muffle=much"), "kick_muffle is `much`, accepted: 0 to 1");
        assert_eq!(error("kick_muffle=NaN"), "kick_muffle is `NaN`, accepted: 0 to 1");
        assert!(error("kick_muffle").contains("`kick_muffle` is not of the form name=value"));
        assert!(error("triangle_tune=1").contains("accepted: kick_tune, kick_muffle"));
    }

    #[test]
    fn assignments_take_plain_units() {
        assert_eq!(parse_assignment("kick_tune=60"), Ok((0, 60.0)));
        assert_eq!(parse_assignment("kick_muffle=.5"), Ok((1, 0.5)));
        assert_eq!(parse_assignment(" crash_tune = -3 st"), Ok((12, -3.0)));
        assert_eq!(parse_assignment("master_level=-inf"), Ok((21, -60.0)));
    }
}
