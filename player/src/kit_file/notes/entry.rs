//! An entry of a piece's notes as the file has it.

use overhear_engine::strike::Striker;
use serde::Deserialize;
use toml::Value;

use crate::midi_map::Foot;

use super::super::drafts::NONE;
use super::super::error::{Fault, quoted};
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
