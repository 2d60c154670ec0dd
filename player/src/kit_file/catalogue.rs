//! The library's instruments and parts as tables, which kit files take over with `like`.
//!
//! Both lie beside the sources, in `player/library`: an instrument is a file of its own with the fields of a piece under
//! `[piece]`, parts are one file for each kind of part. An instrument is `like` a piece of the standard kit or another
//! instrument, a part of it is `like` a part of the library.

mod texts;

use std::collections::BTreeMap;
use std::sync::OnceLock;

use overhear_engine::kit_spec::KitSpec;
use toml::{Table, Value};

use super::error::quoted;
use super::laying::{NONE, lay_over};
use super::source::Source;
use super::text;

pub(super) use texts::{INSTRUMENTS, KITS};

/// As many instruments at most are each like the next.
pub(super) const LONGEST_CHAIN: usize = 4;

/// Tables of a piece that can be like a part, and the kind of part.
const KINDS: [(&str, &str); 6] = [
    ("batter", "heads"),
    ("resonant", "heads"),
    ("wall", "walls"),
    ("hoop", "hoops"),
    ("alloy", "alloys"),
    ("wires", "wires"),
];

/// Fields that some parts of a kind have; those that have not take them away from what they are laid over.
const OPTIONAL: [(&str, &[&str]); 1] = [("heads", &["dot", "mesh"])];

/// A part that a table is like, but the library does not have.
pub(super) struct Missing {
    /// Path of the `like` within the table.
    pub(super) path: String,
    /// What it is, and what is accepted.
    pub(super) reason: String,
}

/// The file of an instrument. All are read at once, the first time.
pub(super) fn file(name: &str) -> Option<&'static Table> {
    static FILES: OnceLock<BTreeMap<&'static str, Table>> = OnceLock::new();
    let read = |(name, text): &(&'static str, &str)| Some((*name, Source::parse(text).ok()?.table));
    FILES.get_or_init(|| INSTRUMENTS.iter().filter_map(read).collect()).get(name)
}

/// The piece or the instrument that an instrument is like.
pub(super) fn likeness(name: &str) -> Option<String> {
    Some(file(name)?.get("piece")?.get("like")?.as_str()?.to_owned())
}

/// All fields of an instrument, those that say where it stands included.
pub(super) fn fields(name: &str) -> Option<Table> {
    let mut own = file(name)?.get("piece")?.as_table()?.clone();
    let mut fields = match own.remove("like") {
        Some(Value::String(other)) => {
            let standard = KitSpec::standard();
            let piece = standard.find(&other).map(|(_, piece)| text::fields(piece));
            piece.or_else(|| self::fields(&other))?
        }
        _ => Table::new(),
    };
    fill_in(&mut own).ok()?;
    lay_over(&mut fields, own);
    Some(fields)
}

/// Takes over what tables within a table are like: parts of the library.
pub(super) fn fill_in(table: &mut Table) -> Result<(), Missing> {
    for (key, value) in table.iter_mut() {
        let Value::Table(inner) = value else { continue };
        fill_in(inner).map_err(|missing| Missing { path: format!("{key}.{}", missing.path), ..missing })?;
        let kind = KINDS.iter().find(|(own, _)| own == key).map(|(_, kind)| *kind);
        let Some((kind, like)) = kind.and_then(|kind| Some((kind, inner.remove("like")?))) else { continue };
        let part = like.as_str().and_then(|like| self::part(kind, like));
        let Some(mut fields) = part else {
            let given = like.as_str().map_or_else(|| "no text".to_owned(), quoted);
            let known: Vec<&str> = parts(kind).keys().map(String::as_str).collect();
            let reason = format!("is {given}, accepted: {}", known.join(", "));
            return Err(Missing { path: format!("{key}.like"), reason });
        };
        lay_over(&mut fields, std::mem::take(inner));
        *inner = fields;
    }
    Ok(())
}

/// What a part of a kind lays over a table.
pub(super) fn part(kind: &str, name: &str) -> Option<Table> {
    let mut fields = parts(kind).get(name)?.as_table()?.clone();
    fields.remove("about");
    let optional = OPTIONAL.iter().filter(|(own, _)| *own == kind).flat_map(|(_, keys)| *keys);
    for key in optional {
        fields.entry(*key).or_insert_with(|| Value::String(NONE.to_owned()));
    }
    Some(fields)
}

/// The parts of a kind by their names: `heads`, `walls`, `hoops`, `alloys`, `wires`.
pub(super) fn parts(kind: &str) -> &'static Table {
    static PARTS: OnceLock<BTreeMap<&'static str, Table>> = OnceLock::new();
    static NONE: OnceLock<Table> = OnceLock::new();
    let read = |(kind, text): &(&'static str, &str)| {
        let Some(Value::Table(parts)) = Source::parse(text).ok()?.table.remove(*kind) else { return None };
        Some((*kind, parts))
    };
    let parts = PARTS.get_or_init(|| texts::PARTS.iter().filter_map(read).collect());
    parts.get(kind).unwrap_or_else(|| NONE.get_or_init(Table::new))
}
