//! An entry of a piece's notes as the file has it.

use overhear_engine::slot::Slot;
use overhear_engine::strike::Striker;
use serde::Deserialize;
use toml::Value;

use crate::midi::figures::Figure;
use crate::midi_map::{Foot, Meaning};

use super::super::error::{Fault, quoted};
use super::super::laying::NONE;
use super::super::source::Origins;
use super::super::typed;

/// An entry; what it leaves out is taken from elsewhere.
#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct Entry {
    pub(super) note: u32,
    pub(super) name: Option<String>,
    pub(super) at: Option<f64>,
    pub(super) angle_rad: Option<f64>,
    pub(super) stick: Option<String>,
    pub(super) ordinary: Option<bool>,
    /// Whether snare wires lie on at the stroke.
    pub(super) wires: Option<bool>,
    /// What the stroke is the beginning of: the name of a figure.
    pub(super) figure: Option<String>,
    /// What a hand does instead of a stroke: one of [`HANDS`].
    pub(super) hand: Option<String>,
    /// Where the pedal is brought before a stroke: a number, or nowhere.
    #[serde(skip)]
    pub(super) pedal: Option<Option<f64>>,
    /// What the foot does instead of a stroke: a name, or a number.
    #[serde(skip)]
    pub(super) foot: Option<Foot>,
}

/// Keys that are read apart, as their values are texts or numbers.
const PEDAL: [&str; 2] = ["pedal", "foot"];

/// How a pedal that is brought down is written.
pub(super) const CHICK: &str = "chick";
pub(super) const SPLASH: &str = "splash";

/// What a hand does to the piece in a slot.
type Hand = fn(Slot) -> Meaning;

/// What hands do that is no stroke, as it is written.
pub(super) const HANDS: [(&str, Hand); 3] = [
    ("choke", Meaning::Chokes),
    ("wires-on", |slot| Meaning::Throws(slot, true)),
    ("wires-off", |slot| Meaning::Throws(slot, false)),
];

impl Entry {
    /// Reads an entry: a note, or a table.
    pub(super) fn read(value: &Value, path: &str, origins: &Origins) -> Result<Entry, Fault> {
        let mut own = match value {
            Value::Table(table) => table.clone(),
            Value::Integer(_) => {
                let note = typed::read(value, path, &[], origins)?;
                return Ok(Entry { note, ..Entry::default() });
            }
            _ => {
                return Err(Fault::of(
                    path,
                    origins,
                    "is not a note, accepted: 0 to 127, or a table with a note",
                ));
            }
        };
        let [pedal, foot] = PEDAL.map(|key| own.remove(key));
        let number = |value: &Value, key: &str| typed::read(value, &format!("{path}.{key}"), &[], origins);
        let pedal = match pedal {
            Some(Value::String(none)) if none == NONE => Some(None),
            Some(value) => Some(Some(number(&value, "pedal")?)),
            None => None,
        };
        let foot = match foot {
            Some(Value::String(text)) if text == CHICK => Some(Foot::Chick),
            Some(Value::String(text)) if text == SPLASH => Some(Foot::Splash),
            Some(Value::String(text)) => {
                let reason = format!("is {}, accepted: {CHICK}, {SPLASH}, or 0 to 1", quoted(&text));
                return Err(Fault::of(&format!("{path}.foot"), origins, &reason));
            }
            Some(value) => Some(Foot::Position(number(&value, "foot")?)),
            None => None,
        };
        let entry: Entry = typed::read(&Value::Table(own), path, &PEDAL, origins)?;
        Ok(Entry { pedal, foot, ..entry })
    }

    /// Whether the entry says something of a stroke.
    pub(super) fn is_stroke(&self) -> bool {
        let places =
            [self.at.is_some(), self.angle_rad.is_some(), self.stick.is_some(), self.pedal.is_some()];
        places.contains(&true) || self.wires.is_some() || self.figure.is_some()
    }

    /// What the stroke is the beginning of, if the entry says so.
    pub(super) fn figure(&self, path: &str, origins: &Origins) -> Result<Option<Figure>, Fault> {
        let Some(figure) = &self.figure else { return Ok(None) };
        Figure::from_name(figure).map(Some).ok_or_else(|| {
            let figures = Figure::ALL.map(|(_, name)| name).join(", ");
            let reason = format!("is {}, accepted: {figures}", quoted(figure));
            Fault::of(&format!("{path}.figure"), origins, &reason)
        })
    }

    /// What is swung, if the entry says so.
    pub(super) fn striker(&self, path: &str, origins: &Origins) -> Result<Option<Striker>, Fault> {
        let Some(stick) = &self.stick else { return Ok(None) };
        Striker::from_name(stick).map(Some).ok_or_else(|| {
            let sticks = Striker::ALL.map(Striker::name).join(", ");
            let reason = format!("is {}, accepted: {sticks}", quoted(stick));
            Fault::of(&format!("{path}.stick"), origins, &reason)
        })
    }
}
