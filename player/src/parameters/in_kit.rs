//! Parameters as a kit names and shows them: `kick_tune`, `55.00 Hz`.
//!
//! A drum's tuning is stored and automated in semitones from its own pitch, like a cymbal's, and shown and typed in Hz.

use overhear_engine::kit_spec::{Kind, KitSpec};
use overhear_engine::slot::Slot;

use super::error::ParameterError;
use super::list::{COUNT, SLOT_COUNT, parameters, slot_index, slot_parameter};
use super::parameter::SlotParameter;
use super::slot::name_in;
use super::table::{FORMER_NAMES, TABLE};

/// What a parameter reads that does nothing.
const INERT: &str = "-";

/// Unit of a drum's pitch.
const HERTZ: &str = " Hz";

/// Name of a parameter in a kit: `kick_tune`, or `slot_10_tune` of an empty slot; of no parameter nothing.
pub fn name(index: usize, kit: &KitSpec) -> String {
    match slot_parameter(index) {
        Some((slot, what)) => name_in(slot, what, kit),
        None => parameters().get(index).map_or_else(String::new, |parameter| parameter.name.to_owned()),
    }
}

/// The parameter of a name in a kit, by its place in the table. `slot_2_tune` is understood of any slot, and so are names of
/// earlier versions.
///
/// # Errors
/// [`ParameterError::Unknown`] listing every name.
pub fn find(name: &str, kit: &KitSpec) -> Result<usize, ParameterError> {
    let present =
        FORMER_NAMES.iter().find(|(former, _)| *former == name).map_or(name, |(_, present)| present);
    let global = TABLE.iter().position(|parameter| parameter.name == present);
    global.map(|at| SLOT_COUNT + at).or_else(|| find_in_slots(name, kit)).ok_or_else(|| {
        let known = (0..COUNT).filter(|&index| is_live(index, kit)).map(|index| self::name(index, kit));
        let accepted = known.collect::<Vec<_>>().join(", ");
        ParameterError::Unknown { name: name.to_owned(), accepted }
    })
}

fn find_in_slots(name: &str, kit: &KitSpec) -> Option<usize> {
    let (stem, end) = name.rsplit_once('_')?;
    let what =
        SlotParameter::ALL.into_iter().find(|what| what.name() == end || what.former_name() == Some(end))?;
    let named = kit.slots().find(|(_, piece)| piece.name.replace('-', "_") == stem).map(|(slot, _)| slot);
    let numbered = || Slot::new(stem.strip_prefix("slot_")?.parse::<usize>().ok()?.checked_sub(1)?);
    named.or_else(numbered).map(|slot| slot_index(slot, what))
}

/// Reads a `name=value` into a place in the table and a value in that parameter's unit.
///
/// # Errors
/// [`ParameterError`] if the form, the name or the value is wrong, or the parameter does nothing in this kit.
pub fn parse_assignment(text: &str, kit: &KitSpec) -> Result<(usize, f32), ParameterError> {
    let Some((name, value)) = text.split_once('=') else {
        let example = format!("{}=-inf", self::name(SLOT_COUNT, kit));
        return Err(ParameterError::Syntax { given: text.to_owned(), example });
    };
    let index = find(name.trim(), kit)?;
    Ok((index, parse_value(index, value, kit)?))
}

/// Value of a parameter before anybody moves it, in its unit; of no parameter 0.
pub fn default_value(index: usize, kit: &KitSpec) -> f32 {
    let Some(parameter) = parameters().get(index) else { return 0.0 };
    let own = slot_parameter(index).and_then(|(slot, what)| {
        let piece = kit.piece(slot).filter(|piece| what.acts_on(piece))?;
        Some(what.default_on(piece).unwrap_or(what.usual()))
    });
    own.map_or(parameter.default, |value| parameter.snap(value))
}

/// Whether a parameter does anything: its slot has a piece, and the piece such a control.
pub fn is_live(index: usize, kit: &KitSpec) -> bool {
    match slot_parameter(index) {
        Some((slot, what)) => kit.piece(slot).is_some_and(|piece| what.acts_on(piece)),
        None => index < COUNT,
    }
}

/// Smallest and largest value as shown and typed, and their unit.
pub fn range(index: usize, kit: &KitSpec) -> (f32, f32, &'static str) {
    match (pitch(index, kit), parameters().get(index)) {
        (Some(pitch), _) => (pitch.low as f32, pitch.high as f32, HERTZ),
        (None, Some(parameter)) => (parameter.min, parameter.max, parameter.unit),
        (None, None) => (0.0, 0.0, ""),
    }
}

/// A value as shown, with its unit: `55.00 Hz` of a drum's tuning, `-` of what does nothing.
pub fn text(index: usize, value: f32, kit: &KitSpec) -> String {
    match parameters().get(index) {
        Some(_) if !is_live(index, kit) => INERT.to_owned(),
        Some(parameter) => match pitch(index, kit) {
            Some(pitch) => format!("{:.2}{HERTZ}", pitch.hertz(value)),
            // A name has no unit.
            None if parameter.choice(value).is_some() => parameter.text(value),
            None => format!("{}{}", parameter.text(value), parameter.unit),
        },
        None => String::new(),
    }
}

/// A value typed by hand, with or without its unit: what [`text`] shows is understood. The range is not checked.
pub fn from_text(index: usize, text: &str, kit: &KitSpec) -> Option<f32> {
    let parameter = parameters().get(index)?;
    if text.trim() == INERT && !is_live(index, kit) {
        return Some(default_value(index, kit));
    }
    match pitch(index, kit) {
        Some(pitch) if !text.trim_end().ends_with(parameter.unit.trim()) => {
            Some(pitch.semitones(hertz_of(text)?) as f32)
        }
        _ => parameter.from_text(text),
    }
}

/// Reads a value in the unit of its range, or a drum's tuning in semitones if it says so (`3 st`).
///
/// # Errors
/// [`ParameterError`] with the value and the accepted range, or why the parameter does nothing.
pub fn parse_value(index: usize, text: &str, kit: &KitSpec) -> Result<f32, ParameterError> {
    let name = name(index, kit);
    let Some(parameter) = parameters().get(index).filter(|_| is_live(index, kit)) else {
        return Err(ParameterError::Inert { reason: why_inert(index, kit), name });
    };
    let typed_in_hertz = |_: &Pitch| !text.trim_end().ends_with(parameter.unit.trim());
    let Some(pitch) = pitch(index, kit).filter(typed_in_hertz) else { return parameter.parse(&name, text) };
    let (min, max, unit) = (pitch.low as f32, pitch.high as f32, HERTZ);
    match hertz_of(text) {
        None => Err(ParameterError::NotANumber { name, given: text.to_owned(), min, max, unit }),
        Some(value) if (pitch.low..=pitch.high).contains(&value) => {
            Ok(parameter.snap(pitch.semitones(value) as f32))
        }
        Some(value) => Err(ParameterError::OutOfRange { name, value, min, max, unit }),
    }
}

fn why_inert(index: usize, kit: &KitSpec) -> String {
    match slot_parameter(index).and_then(|(slot, _)| kit.piece(slot)) {
        Some(piece) => format!("`{}` has no such control", piece.name),
        None => "the slot is empty".to_owned(),
    }
}

/// A number of Hz with or without the unit.
fn hertz_of(text: &str) -> Option<f64> {
    let number = text.trim().trim_end_matches(HERTZ.trim()).trim_end();
    number.parse().ok().filter(|value: &f64| value.is_finite())
}

/// A drum's own pitch and the range that its tuning parameter reaches, Hz.
struct Pitch {
    low: f64,
    own: f64,
    high: f64,
}

/// The pitch that a parameter moves; none if it tunes no drum.
fn pitch(index: usize, kit: &KitSpec) -> Option<Pitch> {
    let (slot, SlotParameter::Tune) = slot_parameter(index)? else { return None };
    let instrument = &kit.piece(slot)?.instrument;
    if instrument.kind() != Kind::Drum {
        return None;
    }
    let ([low, own, high], parameter) = (instrument.tunings(), parameters().get(index)?);
    let [least, most] = [parameter.min, parameter.max].map(|st| own * libm::exp2(f64::from(st) / 12.0));
    Some(Pitch { low: low.max(least), own, high: high.min(most) })
}

impl Pitch {
    /// So many semitones from its own, as far as it can be tuned, Hz.
    fn hertz(&self, semitones: f32) -> f64 {
        (self.own * libm::exp2(f64::from(semitones) / 12.0)).clamp(self.low, self.high)
    }

    /// Semitones of a pitch (Hz) from its own.
    fn semitones(&self, hertz: f64) -> f64 {
        12.0 * libm::log2(hertz / self.own)
    }
}
