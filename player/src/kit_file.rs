//! Kit files: a kit and its notes as TOML that people can read and write.
//!
//! ```toml
//! format = 1
//! starts_from = "standard"     # or "nothing"; what the file does not say is as in the standard kit
//! remove = ["timpani"]         # pieces of the start that are left out
//!
//! [pieces.snare]               # a piece of the start is changed field by field
//! diameter_in = 13             # lengths in _m, _cm, _mm or _in, masses in _kg or _g, ...
//! batter.thickness_mm = 0.3
//! hoop = "none"                # takes a part away
//!
//! [pieces.crash-2]             # a piece that the start does not have
//! like = "crash"               # starts as a copy of that one; else it has to be complete
//! diameter_in = 18
//! mass_kg = 1.35
//! notes = [57]                 # MIDI notes that strike it
//! ```
//!
//! The fields are those of [`KitSpec`], under the names that Serde gives them: there is no second list of them here.
//! [`read`] lays a file over what it starts from, reads the result, and checks it; whatever is wrong is one line with the
//! field as the file names it, its value, and what is accepted. [`write()`] makes a complete file that is read back to the last
//! bit.
//!
//! Slots: pieces of the start keep their order, removed ones leave no hole, new ones follow in the file's order. A `slot` from
//! 1 to the number of pieces puts a piece there, and those without one fill the rest in order.

mod catalogue;
mod drafts;
mod error;
mod format;
mod laying;
mod located;
mod notes;
pub mod parts;
mod pieces;
mod source;
mod text;
mod typed;
mod units;
mod write;

use std::collections::BTreeSet;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use overhear_engine::error::SpecError;
use overhear_engine::kit_spec::{Defaults, KitSpec, PieceSpec, places};
use overhear_engine::slot::SLOTS;
use toml::de::DeTable;
use toml::{Table, Value};
use tracing::warn;

use crate::kit_document::KitDocument;

use drafts::Layers;
use error::{Fault, quoted};
use source::{Origins, Source};

pub use error::KitFileError;
pub use format::{FORMAT, LARGEST};

/// What a file can start from.
const STANDARD: &str = "standard";
const NOTHING: &str = "nothing";

/// What a file can say.
const KEYS: [&str; 9] =
    ["format", "about", "starts_from", "remove", "level_db", "pieces", "microphones", "room", "silent"];

/// Longest line on what a file holds, characters.
const LONGEST_ABOUT: usize = 400;

/// How far a file can move the level of its whole kit, dB.
const LEVEL_DB: std::ops::RangeInclusive<f64> = -40.0..=20.0;

/// Reads the text of a kit file, complete or partial, called `file_name` in errors.
///
/// # Errors
/// [`KitFileError`] with the line, the field, its value and what is accepted, for the first thing that is wrong.
pub fn read(file_name: &str, text: &str) -> Result<KitDocument, KitFileError> {
    if text.len() > LARGEST {
        return Err(KitFileError::too_large(file_name));
    }
    let read = Source::parse(text).and_then(|source| document(source, Places::Given));
    read.map_err(|fault| KitFileError::at(file_name, text.as_bytes(), fault.at, &fault.reason))
}

/// Reads what [`write()`] wrote and a project has stored, also where pieces stand inside one another, as a former version wrote
/// it: the later ones are moved to the nearest place that is free.
///
/// # Errors
/// As of [`read`], but for places.
pub fn read_stored(name: &str, text: &str) -> Result<KitDocument, KitFileError> {
    if text.len() > LARGEST {
        return Err(KitFileError::too_large(name));
    }
    let read = Source::parse(text).and_then(|source| document(source, Places::Stored));
    read.map_err(|fault| KitFileError::at(name, text.as_bytes(), fault.at, &fault.reason))
}

/// Reads a kit file that is a table inside another file of that name and text, as [`read_stored`] does.
///
/// # Errors
/// As of [`read_stored`]; lines are those of the whole text.
pub fn read_part(file_name: &str, text: &str, table: &DeTable<'_>) -> Result<KitDocument, KitFileError> {
    let read = Source::of(text, table).and_then(|source| document(source, Places::Stored));
    read.map_err(|fault| KitFileError::at(file_name, text.as_bytes(), fault.at, &fault.reason))
}

/// Reads a kit file.
///
/// # Errors
/// [`KitFileError`] if the file cannot be read, or as of [`read`].
pub fn load(path: &Path) -> Result<KitDocument, KitFileError> {
    let name = path.display().to_string();
    let mut bytes = Vec::new();
    // No more than can be accepted: a path may be that of a device without an end.
    File::open(path)
        .and_then(|file| file.take(LARGEST as u64 + 1).read_to_end(&mut bytes))
        .map_err(|error| KitFileError::whole(&name, &format!("cannot be read: {error}")))?;
    if bytes.len() > LARGEST {
        return Err(KitFileError::too_large(&name));
    }
    match std::str::from_utf8(&bytes) {
        Ok(text) => read(&name, text),
        Err(error) => {
            let reason = "this is not text, accepted: TOML in UTF-8";
            Err(KitFileError::at(&name, &bytes, Some(error.valid_up_to()), reason))
        }
    }
}

/// The text of a complete file, which [`read`] reads back as the same document, to the last bit.
pub fn write(document: &KitDocument) -> String {
    write::write(document)
}

/// The text of a new file for a kit of a name: a partial file that shows the commonest changes in comments.
pub fn fresh(name: &str) -> String {
    let name: String = name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    include_str!("kit_file/fresh.toml").replace("{name}", &name)
}

/// The files of the library by name, in the order in which they are shown: instruments, and whole kits.
pub(crate) fn library() -> [&'static [(&'static str, &'static str)]; 2] {
    [catalogue::INSTRUMENTS, catalogue::KITS]
}

/// The piece of the standard kit that an instrument of the library is like, directly or through others.
pub(crate) fn library_model(name: &str) -> Option<String> {
    let mut likeness = catalogue::likeness(name)?;
    while let Some(next) = catalogue::likeness(&likeness) {
        likeness = next;
    }
    Some(likeness)
}

/// The parts of a kind (`heads`, `walls`, `hoops`, `alloys`, `wires`) that the library has, by name.
pub(crate) fn library_parts(kind: &str) -> &'static Table {
    catalogue::parts(kind)
}

/// What is done with pieces that stand inside others.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Places {
    /// Those that the file puts there are refused. A cymbal that it only says is like another one is moved.
    Given,
    /// They are moved.
    Stored,
}

fn document(Source { table, origins }: Source, places: Places) -> Result<KitDocument, Fault> {
    let start = head(&table, &origins)?;
    check_about(&table, &origins)?;
    let empty = Table::new();
    let pieces = part(&table, "pieces", &origins)?.unwrap_or(&empty);
    let kit = start.as_ref().map(|start| &start.kit);
    let drafts = Layers { start: kit, removed: removed(&table, kit, &origins)?, pieces, origins: &origins }
        .drafts()?;
    let mut pieces =
        drafts.iter().map(|draft| pieces::read(draft, &origins)).collect::<Result<Vec<_>, _>>()?;
    let level_db = level(&table, &pieces, &origins)?;
    pieces.iter_mut().for_each(|piece| piece.defaults.level_db += level_db);
    // More are refused below.
    for (at, draft) in drafts.iter().enumerate().take(SLOTS) {
        let put = draft.beside.get("like").is_none()
            || pieces[at].drum().is_some()
            || origins.has(&format!("pieces.{}.place.centre_m", draft.name));
        if places == Places::Stored || !put {
            make_room(&mut pieces, at);
        }
    }
    let kit = KitSpec {
        pieces,
        microphones: whole(&table, "microphones", kit.map(|kit| text::table(&kit.microphones)), &origins)?,
        room: whole(&table, "room", kit.map(|kit| text::table(&kit.room)), &origins)?,
    };
    kit.check().map_err(|error| Fault::of_spec(&error, &origins))?;
    let reader = notes::Reader { start: start.as_ref(), kit: &kit, drafts: &drafts, origins: &origins };
    let notes = reader.read(table.get("silent"))?;
    Ok(KitDocument { kit, notes })
}

/// Moves a piece that stands inside one before it to the nearest place that is free; it stays where there is none.
fn make_room(pieces: &mut [PieceSpec], at: usize) {
    if !pieces[..at].iter().any(|other| places::inside(&pieces[at], other)) {
        return;
    }
    let others = pieces.iter().enumerate().filter(|(of, _)| *of != at).map(|(_, other)| other);
    if let Some(free) = places::free_place(&pieces[at], others) {
        warn!("The {} stood inside another piece: it is moved to {free:?} m", pieces[at].name);
        pieces[at].place.centre = free;
    }
}

/// Checks what the file is, and tells what it starts from.
fn head(table: &Table, origins: &Origins) -> Result<Option<KitDocument>, Fault> {
    match table.get("format") {
        Some(Value::Integer(FORMAT)) => {}
        Some(_) => {
            let given = origins.locate("format").literal.map_or_else(|| "no number".to_owned(), quoted);
            return Err(Fault::of("format", origins, &format!("is {given}, accepted: {FORMAT}")));
        }
        None => return Err(Fault::new(0, format!("format is missing, accepted: format = {FORMAT}"))),
    }
    if let Some(key) = table.keys().find(|key| !KEYS.contains(&key.as_str())) {
        return Err(Fault::of(key, origins, &format!("is not known, accepted: {}", KEYS.join(", "))));
    }
    match table.get("starts_from") {
        None => Ok(Some(KitDocument::standard())),
        Some(Value::String(from)) if from == STANDARD => Ok(Some(KitDocument::standard())),
        Some(Value::String(from)) if from == NOTHING => Ok(None),
        Some(_) => {
            let given = origins.locate("starts_from").literal.map_or_else(|| "no text".to_owned(), quoted);
            let reason = format!("is {given}, accepted: \"{STANDARD}\", \"{NOTHING}\"");
            Err(Fault::of("starts_from", origins, &reason))
        }
    }
}

/// What the file adds to the level of every piece, dB: as much as leaves each within its own range.
fn level(table: &Table, pieces: &[PieceSpec], origins: &Origins) -> Result<f64, Fault> {
    let Some(value) = table.get("level_db") else { return Ok(0.0) };
    let level_db: f64 = typed::read(value, "level_db", &[], origins)?;
    let refused = |error: SpecError| Fault::of_spec(&error, origins);
    SpecError::check("level_db", level_db, *LEVEL_DB.start(), *LEVEL_DB.end()).map_err(refused)?;
    let beyond = |piece: &&PieceSpec| {
        let own = piece.defaults.level_db;
        Defaults::LEVEL_DB.contains(&own) && !Defaults::LEVEL_DB.contains(&(own + level_db))
    };
    if let Some(piece) = pieces.iter().find(beyond) {
        let (name, own) = (&piece.name, piece.defaults.level_db);
        let [least, most] = [Defaults::LEVEL_DB.start() - own, Defaults::LEVEL_DB.end() - own];
        let reason = format!(
            "is {level_db}, which puts `{name}` at {} dB, accepted with it: {least} to {most}",
            own + level_db
        );
        return Err(Fault::of("level_db", origins, &reason));
    }
    Ok(level_db)
}

/// Checks the line on what the file holds, if there is one.
fn check_about(table: &Table, origins: &Origins) -> Result<(), Fault> {
    match table.get("about") {
        None => Ok(()),
        Some(Value::String(about)) if (1..=LONGEST_ABOUT).contains(&about.chars().count()) => Ok(()),
        Some(_) => {
            let reason = format!("is not accepted, accepted: a text of 1 to {LONGEST_ABOUT} characters");
            Err(Fault::of("about", origins, &reason))
        }
    }
}

/// The pieces of the start that the file leaves out.
fn removed(table: &Table, start: Option<&KitSpec>, origins: &Origins) -> Result<BTreeSet<String>, Fault> {
    let names = match table.get("remove") {
        None => return Ok(BTreeSet::new()),
        Some(Value::Array(names)) => names,
        Some(_) => {
            return Err(Fault::of(
                "remove",
                origins,
                "is not an array, accepted: an array of names of pieces",
            ));
        }
    };
    let known: Vec<&str> = start.into_iter().flat_map(|kit| &kit.pieces).map(|piece| &*piece.name).collect();
    let name = |(index, name): (usize, &Value)| match name {
        Value::String(name) if known.contains(&name.as_str()) => Ok(name.clone()),
        name => {
            let given = name.as_str().map_or_else(|| "no text".to_owned(), quoted);
            let accepted =
                if known.is_empty() { "none, the file starts from nothing" } else { &known.join(", ") };
            let reason = format!("is {given}, accepted: {accepted}");
            Err(Fault::of(&format!("remove.{index}"), origins, &reason))
        }
    };
    names.iter().enumerate().map(name).collect()
}

/// A table of the file, if it has it.
fn part<'a>(table: &'a Table, key: &str, origins: &Origins) -> Result<Option<&'a Table>, Fault> {
    match table.get(key) {
        None => Ok(None),
        Some(Value::Table(part)) => Ok(Some(part)),
        Some(_) => Err(Fault::of(key, origins, "is not a table, accepted: a table")),
    }
}

/// A part of the kit with the file's changes.
fn whole<T: serde::de::DeserializeOwned>(
    table: &Table,
    key: &str,
    start: Option<Table>,
    origins: &Origins,
) -> Result<T, Fault> {
    let mut fields = start.unwrap_or_default();
    if let Some(changes) = part(table, key, origins)? {
        laying::lay_over(&mut fields, changes.clone());
    }
    typed::read(&Value::Table(fields), key, &[], origins)
}

#[cfg(test)]
mod tests;
