//! A preset's file: reading it, with the line of whatever is wrong, and writing it.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::{FORMAT, Preset, PresetError};
use crate::midi::assignments::{Assignment, NOTES};
use crate::parameters::{PARAMETERS, find};

/// What is wrong, and where in the text.
type Fault = (Range<usize>, String);

impl Preset {
    /// Reads the text of a file called `file` in errors.
    ///
    /// # Errors
    /// [`PresetError::Line`] naming the first line that is wrong.
    pub fn parse(file: &str, text: &str) -> Result<Preset, PresetError> {
        read(text).map_err(|(at, reason)| {
            let before = &text.as_bytes()[..at.start.min(text.len())];
            let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
            PresetError::Line { file: file.to_owned(), line, reason }
        })
    }

    /// The text of a file that [`parse`](Self::parse) reads back as the same preset.
    pub fn to_text(&self) -> String {
        let mut text = format!("format = {FORMAT}\nabout = {}\n", toml::Value::String(self.about.clone()));
        text.push_str("\n[parameters]\n");
        for (index, value) in &self.values {
            let Some(parameter) = PARAMETERS.get(*index) else { continue };
            // The shortest decimal of the step that was meant.
            let shown = parameter.text(*value);
            let exact = if parameter.from_text(&shown).is_some_and(|back| parameter.snap(back) == *value) {
                shown
            } else {
                value.to_string()
            };
            let plain = parameter.choices.is_empty() && !exact.ends_with("inf");
            let exact = if plain { exact } else { format!("{exact:?}") };
            let _ = writeln!(text, "{} = {exact}", parameter.name);
        }
        if let Some(notes) = &self.notes {
            text.push_str("\n[notes]\n");
            for (note, assignment) in notes {
                match assignment {
                    Assignment::Mapped => {}
                    Assignment::Silent => text.push_str(&format!("{note} = \"silent\"\n")),
                    Assignment::Plays(plays) => text.push_str(&format!("{note} = {plays}\n")),
                }
            }
        }
        text
    }
}

fn read(text: &str) -> Result<Preset, Fault> {
    let table = DeTable::parse(text).map_err(|error| {
        (error.span().unwrap_or_default(), error.message().lines().collect::<Vec<_>>().join(" "))
    })?;
    let mut preset = Preset::default();
    let mut format = None;
    for (key, value) in table.get_ref() {
        let (at, content) = (value.span(), value.get_ref());
        match (key.get_ref().as_ref(), content) {
            ("format", DeValue::Integer(number)) => {
                if number.to_string() != FORMAT.to_string() {
                    return Err((at, format!("format is {number}, accepted: {FORMAT}")));
                }
                format = Some(());
            }
            ("about", DeValue::String(about)) => preset.about = about.to_string(),
            ("parameters", DeValue::Table(parameters)) => preset.values = values(parameters)?,
            ("notes", DeValue::Table(entries)) => preset.notes = Some(notes(entries)?),
            (name @ ("format" | "about" | "parameters" | "notes"), other) => {
                return Err((at, format!("{name} is a {}", other.type_str())));
            }
            (name, _) => {
                let accepted = "format, about, [parameters], [notes]";
                return Err((key.span(), format!("`{name}` is not known, accepted: {accepted}")));
            }
        }
    }
    format.map(|()| preset).ok_or_else(|| (0..0, format!("there is no format, accepted: format = {FORMAT}")))
}

fn values(table: &DeTable<'_>) -> Result<BTreeMap<usize, f32>, Fault> {
    let entries = table.iter().map(|(key, value)| {
        let (index, parameter) = find(key.get_ref()).map_err(|error| (key.span(), error.to_string()))?;
        let text = scalar(value.get_ref()).ok_or_else(|| {
            (value.span(), format!("{} is a {}", parameter.name, value.get_ref().type_str()))
        })?;
        let plain = parameter.parse(&text).map_err(|error| (value.span(), error.to_string()))?;
        Ok((index, plain))
    });
    entries.collect()
}

fn notes(table: &DeTable<'_>) -> Result<BTreeMap<u8, Assignment>, Fault> {
    let entries = table.iter().map(|(key, value)| {
        let note = key.get_ref().parse().ok().filter(|&note: &u8| usize::from(note) < NOTES);
        let note = note
            .ok_or_else(|| (key.span(), format!("`{}` is not a note, accepted: 0 to 127", key.get_ref())))?;
        let assignment = scalar(value.get_ref()).and_then(|text| Assignment::from_text(&text));
        let reason = || format!("note {note} plays nothing known, accepted: a reference note, or \"silent\"");
        Ok((note, assignment.ok_or_else(|| (value.span(), reason()))?))
    });
    entries.collect()
}

/// A number or a text, as text.
fn scalar(value: &DeValue<'_>) -> Option<String> {
    match value {
        DeValue::String(text) => Some(text.to_string()),
        DeValue::Integer(number) => Some(number.to_string()),
        DeValue::Float(number) => Some(number.to_string()),
        _ => None,
    }
}
