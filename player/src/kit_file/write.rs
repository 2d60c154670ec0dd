//! A kit as the text of a complete file.

use std::fmt::Write as _;

use toml::{Table, Value};

use crate::kit_document::KitDocument;

use super::format::FORMAT;
use super::notes;
use super::text::{entry, fields, table};

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
