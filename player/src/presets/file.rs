//! A preset's file: reading it, with the line of whatever is wrong, and writing it.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::ops::Range;
use std::sync::Arc;

use overhear_engine::kit_spec::KitSpec;
use toml::de::{DeTable, DeValue};

use super::error::PresetError;
use super::preset::{Carried, FORMAT, Preset, STANDARD};
use crate::kit_document::KitDocument;
use crate::kit_file;
use crate::midi::assignments::{Assignment, NOTES};
use crate::parameters::{find, name, parameters, parse_value, text};

/// What is wrong, and where in the text.
type Fault = (Range<usize>, String);

/// What a file can say.
const ACCEPTED: &str = "format, about, [parameters], [notes], [kit]";

impl Preset {
    /// Reads the text of a file called `file` in errors.
    ///
    /// # Errors
    /// [`PresetError::AtLine`] or [`PresetError::Kit`] naming the first line that is wrong.
    pub fn parse(file: &str, text: &str) -> Result<Preset, PresetError> {
        let fail = |(at, reason): Fault| {
            let before = &text.as_bytes()[..at.start.min(text.len())];
            let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
            PresetError::AtLine { file: file.to_owned(), line, reason }
        };
        let table = DeTable::parse(text).map_err(|error| {
            let reason = error.message().lines().collect::<Vec<_>>().join(" ");
            fail((error.span().unwrap_or_default(), reason))
        })?;
        let table = table.get_ref();
        check_format(table).map_err(fail)?;
        let carried = carried(file, text, table)?;
        read(table, carried).map_err(fail)
    }

    /// The text of a file that [`parse`](Self::parse) reads back as the same preset.
    pub fn to_text(&self) -> String {
        let mut text = format!("format = {FORMAT}\nabout = {}\n", toml::Value::String(self.about.clone()));
        text.push_str("\n[parameters]\n");
        for (index, value) in &self.values {
            let kit = self.own_kit();
            let _ = writeln!(text, "{} = {}", name(*index, kit), exact(*index, *value, kit));
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
        if let Some(Carried { table, .. }) = &self.carried {
            let part = toml::Table::from_iter([("kit".to_owned(), toml::Value::Table(table.clone()))]);
            let _ = write!(text, "\n{part}");
        }
        text
    }
}

/// A value as a file says it: the shortest of what is shown, a plain number, and the value in the parameter's own unit, that
/// is read back as the same.
fn exact(index: usize, value: f32, kit: &KitSpec) -> String {
    let Some(parameter) = parameters().get(index) else { return String::new() };
    let shown = text(index, value, kit);
    let number = shown.split(' ').next().unwrap_or_default();
    let candidates = [number.to_owned(), value.to_string(), format!("{value}{}", parameter.unit)];
    let same = |text: &&String| parse_value(index, text, kit) == Ok(value);
    let exact = candidates.iter().find(same).map_or(shown.as_str(), String::as_str);
    // What is no number is a text.
    let is_number = exact.parse::<f32>().is_ok_and(f32::is_finite);
    if is_number && parameter.choices.is_empty() { exact.to_owned() } else { format!("{exact:?}") }
}

fn check_format(table: &DeTable<'_>) -> Result<(), Fault> {
    match table.iter().find(|(key, _)| key.get_ref() == "format") {
        None => Err((0..0, format!("there is no format, accepted: format = {FORMAT}"))),
        Some((_, value)) => match value.get_ref() {
            DeValue::Integer(number) if number.to_string() == FORMAT.to_string() => Ok(()),
            DeValue::Integer(number) => {
                Err((value.span(), format!("format is {number}, accepted: {FORMAT}")))
            }
            other => Err((value.span(), format!("format is a {}", other.type_str()))),
        },
    }
}

/// The kit in a file, if it has one.
fn carried(file: &str, text: &str, table: &DeTable<'_>) -> Result<Option<Carried>, PresetError> {
    let Some((_, value)) = table.iter().find(|(key, _)| key.get_ref() == "kit") else { return Ok(None) };
    // Of any other type it is refused with the rest of the file.
    let DeValue::Table(part) = value.get_ref() else { return Ok(None) };
    let document = Arc::new(kit_file::read_part(file, text, part)?);
    let mut whole: toml::Table = text.parse().unwrap_or_default();
    let table = match whole.remove("kit") {
        Some(toml::Value::Table(table)) => table,
        _ => toml::Table::new(),
    };
    Ok(Some(Carried { table, document }))
}

fn read(table: &DeTable<'_>, carried: Option<Carried>) -> Result<Preset, Fault> {
    let document = carried.as_ref().map_or(&*STANDARD, |carried| &*carried.document);
    let mut preset = Preset::default();
    for (key, value) in table {
        let (at, content) = (value.span(), value.get_ref());
        match (key.get_ref().as_ref(), content) {
            ("format", DeValue::Integer(_)) | ("kit", DeValue::Table(_)) => {}
            ("about", DeValue::String(about)) => preset.about = about.to_string(),
            ("parameters", DeValue::Table(parameters)) => preset.values = values(parameters, &document.kit)?,
            ("notes", DeValue::Table(entries)) => preset.notes = Some(notes(entries, document)?),
            (name @ ("format" | "about" | "parameters" | "notes" | "kit"), other) => {
                return Err((at, format!("{name} is a {}", other.type_str())));
            }
            (name, _) => return Err((key.span(), format!("`{name}` is not known, accepted: {ACCEPTED}"))),
        }
    }
    Ok(Preset { carried, ..preset })
}

fn values(table: &DeTable<'_>, kit: &KitSpec) -> Result<BTreeMap<usize, f32>, Fault> {
    let entries = table.iter().map(|(key, value)| {
        let index = find(key.get_ref(), kit).map_err(|error| (key.span(), error.to_string()))?;
        let text = scalar(value.get_ref()).ok_or_else(|| {
            (value.span(), format!("{} is a {}", name(index, kit), value.get_ref().type_str()))
        })?;
        let plain = parse_value(index, &text, kit).map_err(|error| (value.span(), error.to_string()))?;
        Ok((index, plain))
    });
    entries.collect()
}

fn notes(table: &DeTable<'_>, document: &KitDocument) -> Result<BTreeMap<u8, Assignment>, Fault> {
    let entries = table.iter().map(|(key, value)| {
        let note = key.get_ref().parse().ok().filter(|&note: &u8| usize::from(note) < NOTES);
        let note = note
            .ok_or_else(|| (key.span(), format!("`{}` is not a note, accepted: 0 to 127", key.get_ref())))?;
        let is_known = |assignment: &Assignment| match assignment {
            Assignment::Plays(plays) => document.notes.row(*plays).is_some(),
            Assignment::Silent | Assignment::Mapped => true,
        };
        let assignment =
            scalar(value.get_ref()).and_then(|text| Assignment::from_text(&text)).filter(is_known);
        let reason =
            || format!("note {note} plays nothing known, accepted: a note of the kit, or \"silent\"");
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
