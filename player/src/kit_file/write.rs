//! A kit as the text of a complete file.

use std::fmt::Write as _;

use overhear_engine::kit_spec::PieceSpec;
use serde::Serialize;
use toml::{Table, Value};

use crate::kit_document::KitDocument;

use super::units::{self, GIGAPASCAL, GRAM, INCH, MILLIMETRE};
use super::{FORMAT, notes};

/// Longest table that is written in a line, characters.
const LONGEST_LINE: usize = 100;

const HEADER: &str = "\
# A kit file of Overhear: pieces, notes, microphones, room. The manual's page on kit files describes every field.
#
# Names end with their unit: _m, _cm, _mm or _in for lengths, _kg or _g for masses, and so on.
# Directions: x to the drummer's right, y up, z toward the audience; the origin is on the floor under the kit.
";

/// The text of a complete file.
pub(super) fn write(document: &KitDocument) -> String {
    let KitDocument { kit, notes } = document;
    let mut text = format!("{HEADER}\nformat = {FORMAT}\nstarts_from = \"nothing\"\n");
    for (slot, piece) in kit.slots() {
        let mut fields = fields(piece);
        let header = Header { path: format!("pieces.{}", piece.name) };
        // What is read first comes first.
        let first =
            ["kind", "title"].into_iter().filter_map(|key| Some((key.to_owned(), fields.remove(key)?)));
        let first: Table =
            first.chain([("slot".to_owned(), Value::Integer(slot.index() as i64 + 1))]).collect();
        let _ = writeln!(text, "\n[{}]", header.path);
        header.entries(&mut text, first);
        notes::write(&mut text, notes, slot);
        header.entries(&mut text, fields);
    }
    let _ = writeln!(text, "\n[microphones]");
    Header { path: "microphones".to_owned() }.entries(&mut text, table(&kit.microphones));
    let _ = writeln!(text, "\n[room]");
    Header { path: "room".to_owned() }.entries(&mut text, table(&kit.room));
    notes::write_silent(&mut text, notes);
    text
}

/// A piece's fields under their SI names: what it is beside where it stands.
pub(super) fn fields(piece: &PieceSpec) -> Table {
    let mut outer = table(piece);
    // The name is that of the table.
    outer.remove("name");
    let mut fields = match outer.remove("instrument") {
        Some(Value::Table(instrument)) => instrument,
        _ => Table::new(),
    };
    fields.extend(outer);
    fields
}

/// Plain data as a table.
pub(super) fn table(data: &impl Serialize) -> Table {
    // Fails only for data that no table can hold: keys that are no text, whole numbers beyond an i64.
    Table::try_from(data).unwrap_or_default()
}

/// Where entries are written: under the header of that path.
struct Header {
    path: String,
}

impl Header {
    /// Writes what fits into a line, then the other tables under headers of their own.
    fn entries(&self, text: &mut String, table: Table) {
        let mut tables = Vec::new();
        for (key, value) in table {
            match value {
                Value::Table(inner) if !is_short(&key, &inner) => tables.push((key, inner)),
                value => {
                    let _ = writeln!(text, "{}", entry(&key, &value));
                }
            }
        }
        for (key, inner) in tables {
            let header = Header { path: format!("{}.{key}", self.path) };
            let _ = writeln!(text, "\n[{}]", header.path);
            header.entries(text, inner);
        }
    }
}

/// Whether a table is written in a line.
fn is_short(key: &str, table: &Table) -> bool {
    let has_tables = table.values().any(|value| matches!(value, Value::Table(_)));
    !has_tables && entry(key, &Value::Table(table.clone())).len() <= LONGEST_LINE
}

/// A field with its value, in the unit that makes it short.
pub(super) fn entry(key: &str, value: &Value) -> String {
    if let Value::Float(x) = value
        && let Some((name, short)) = friendly(key, *x)
    {
        return format!("{name} = {}", number(short));
    }
    format!("{key} = {}", plain(value))
}

/// Another unit in which a number is short, if the number comes back from it exactly.
fn friendly(key: &str, x: f64) -> Option<(String, f64)> {
    /// Shorter and lighter than this, m and kg, is said in millimetres and grams.
    const SMALL: f64 = 0.1;
    let in_inches = ["diameter", "depth"].iter().any(|stem| key.starts_with(stem));
    [INCH, MILLIMETRE, GRAM, GIGAPASCAL].into_iter().find_map(|unit| {
        let name = units::name_in(key, unit)?;
        let fits = match unit {
            INCH => in_inches,
            GIGAPASCAL => true,
            _ => x.abs() < SMALL && x != 0.0,
        };
        Some((name, unit.exactly(x).filter(|_| fits)?))
    })
}

fn plain(value: &Value) -> String {
    match value {
        Value::Float(x) => number(*x),
        Value::String(text) => string(text),
        Value::Array(array) => format!("[{}]", array.iter().map(plain).collect::<Vec<_>>().join(", ")),
        Value::Table(table) => {
            let entries: Vec<String> = table.iter().map(|(key, value)| entry(key, value)).collect();
            format!("{{ {} }}", entries.join(", "))
        }
        other => other.to_string(),
    }
}

/// The shortest decimal that is read back as the same number; a whole number without a point.
pub(super) fn number(x: f64) -> String {
    /// Beyond this the digits of a whole number are not its own.
    const WHOLE: f64 = 1e15;
    let is_whole = x == x.trunc() && x.abs() < WHOLE && !(x == 0.0 && x.is_sign_negative());
    match x {
        _ if is_whole => (x as i64).to_string(),
        _ if x.is_nan() => "nan".to_owned(),
        _ => format!("{x:?}"),
    }
}

/// A text in quotes.
pub(super) fn string(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(quoted, "\\u{:04X}", u32::from(c));
            }
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}
