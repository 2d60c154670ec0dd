//! The pieces of a kit file laid over those that it starts from.

use std::collections::BTreeSet;

use overhear_engine::kit_spec::{KitSpec, PieceSpec};
use overhear_engine::slot::SLOTS;
use toml::{Table, Value};

use super::catalogue;
use super::error::{Fault, quoted};
use super::laying::lay_over;
use super::source::Origins;
use super::text;
use super::typed;

/// What a file says about a piece beside what it is: not part of its description.
pub(super) const BESIDE: [&str; 4] = ["like", "slot", "notes", "position_controller"];

/// A piece with the file's changes, not yet read as a description.
pub(super) struct Draft {
    /// Its name.
    pub(super) name: String,
    /// Its fields under their SI names.
    pub(super) fields: Table,
    /// Whether it is a piece of the start, still of the same kind: so it keeps its notes.
    pub(super) is_kept: bool,
    /// What the file says beside: entries of [`BESIDE`].
    pub(super) beside: Table,
}

/// Pieces to be laid over each other.
pub(super) struct Layers<'a> {
    /// The kit that the file starts from, if it does.
    pub(super) start: Option<&'a KitSpec>,
    /// Names of its pieces that are left out.
    pub(super) removed: BTreeSet<String>,
    /// What the file says about pieces.
    pub(super) pieces: &'a Table,
    /// Where it says so.
    pub(super) origins: &'a Origins,
}

impl Layers<'_> {
    /// All pieces in the order of their slots.
    pub(super) fn drafts(&self) -> Result<Vec<Draft>, Fault> {
        let mut names: Vec<&str> = self.start.map_or(Vec::new(), |kit| {
            kit.pieces.iter().map(|piece| &*piece.name).filter(|name| self.kept(name).is_some()).collect()
        });
        let new: Vec<&str> =
            self.pieces.keys().map(String::as_str).filter(|name| self.kept(name).is_none()).collect();
        names.extend(new);
        if !(1..=SLOTS).contains(&names.len()) {
            let first_too_many = names.get(SLOTS).map(|name| format!("pieces.{name}"));
            let at = self.origins.locate(&first_too_many.unwrap_or_else(|| "remove".to_owned())).at;
            return Err(Fault::new(at, format!("pieces are {}, accepted: 1 to {SLOTS}", names.len())));
        }
        let drafts = names.into_iter().map(|name| self.draft(name)).collect::<Result<_, _>>()?;
        self.ordered(drafts)
    }

    /// The piece of the start of that name, if it is not left out.
    fn kept(&self, name: &str) -> Option<&PieceSpec> {
        self.start_of(name).filter(|_| !self.removed.contains(name))
    }

    fn start_of(&self, name: &str) -> Option<&PieceSpec> {
        self.start?.pieces.iter().find(|piece| piece.name == name)
    }

    fn draft(&self, name: &str) -> Result<Draft, Fault> {
        let mut beside = Table::new();
        if let Some(table) = self.pieces.get(name).and_then(Value::as_table) {
            let said = BESIDE.into_iter().filter_map(|key| Some((key.to_owned(), table.get(key)?.clone())));
            beside.extend(said);
        }
        let fields = self.fields(name, &mut vec![name])?;
        let is_kept =
            self.kept(name).is_some_and(|piece| text::fields(piece).get("kind") == fields.get("kind"));
        Ok(Draft { name: name.to_owned(), fields, is_kept, beside })
    }

    /// The fields of a piece; `way` leads from whose `like` it is to itself.
    fn fields<'b>(&'b self, name: &'b str, way: &mut Vec<&'b str>) -> Result<Table, Fault> {
        let path = format!("pieces.{name}");
        let changes = match self.pieces.get(name) {
            None => None,
            Some(Value::Table(table)) => Some(table),
            Some(_) => return Err(Fault::of(&path, self.origins, "is not a table, accepted: a table")),
        };
        let mut fields = match (self.kept(name), changes.and_then(|changes| changes.get("like"))) {
            (Some(piece), Some(like)) => self.exchanged(piece, like)?,
            (Some(piece), None) => text::fields(piece),
            (None, Some(like)) => self.likeness(name, like, way)?,
            (None, None) => Table::new(),
        };
        let mut changes = changes.cloned().unwrap_or_default();
        BESIDE.iter().for_each(|key| drop(changes.remove(*key)));
        catalogue::fill_in(&mut changes).map_err(|missing| {
            let path = format!("{path}.{}", missing.path);
            Fault::of(&path, self.origins, &missing.reason)
        })?;
        lay_over(&mut fields, changes);
        Ok(fields)
    }

    /// The fields of an instrument of the library in the place of a piece of the start: it stands, is heard from the side and
    /// is called as that piece is.
    fn exchanged(&self, piece: &PieceSpec, like: &Value) -> Result<Table, Fault> {
        let Some(mut fields) = like.as_str().and_then(catalogue::fields) else {
            let given = like.as_str().map_or_else(|| "no text".to_owned(), quoted);
            let reason = format!(
                "is {given}, accepted: an instrument of the library, to take the place of {}; a copy of another piece needs a new name",
                quoted(&piece.name)
            );
            return Err(Fault::of(&format!("pieces.{}.like", piece.name), self.origins, &reason));
        };
        let mut own = text::fields(piece);
        let pan = own.get("defaults").and_then(|defaults| defaults.get("pan")).cloned();
        own.retain(|key, _| matches!(key, "place" | "title"));
        fields.extend(own);
        if let (Some(Value::Table(defaults)), Some(pan)) = (fields.get_mut("defaults"), pan) {
            defaults.insert("pan".to_owned(), pan);
        }
        Ok(fields)
    }

    /// The fields that a piece takes over from the one it is like.
    fn likeness<'b>(&'b self, name: &str, like: &'b Value, way: &mut Vec<&'b str>) -> Result<Table, Fault> {
        let path = format!("pieces.{name}.like");
        let refuse = |reason: String| Err(Fault::of(&path, self.origins, &reason));
        let Value::String(other) = like else {
            return refuse("is not a string, accepted: the name of a piece".to_owned());
        };
        // Its own name means what the start has, which the file leaves out.
        let is_here = other != name && (self.pieces.contains_key(other) || self.kept(other).is_some());
        let start = self.start_of(other).map(text::fields);
        let mut fields = match start.or_else(|| catalogue::fields(other).filter(|_| !is_here)) {
            _ if is_here && way.contains(&&**other) => {
                return refuse(format!("is {}, which is itself a copy of `{name}`", quoted(other)));
            }
            _ if is_here => {
                way.push(other);
                let fields = self.fields(other, way)?;
                way.pop();
                fields
            }
            Some(fields) => fields,
            None => {
                let start = self.start.into_iter().flat_map(|kit| &kit.pieces).map(|piece| &piece.name);
                let known: BTreeSet<&str> = start
                    .chain(self.pieces.keys())
                    .map(String::as_str)
                    .filter(|known| *known != name)
                    .collect();
                let known: Vec<&str> = known.into_iter().collect();
                return refuse(format!(
                    "is {}, accepted: {}, or an instrument of the library",
                    quoted(other),
                    known.join(", ")
                ));
            }
        };
        fields.remove("title");
        Ok(fields)
    }

    /// Those that name their slot go there, the others fill the rest in order.
    fn ordered(&self, drafts: Vec<Draft>) -> Result<Vec<Draft>, Fault> {
        let count = drafts.len();
        let mut slots: Vec<Option<Draft>> = (0..count).map(|_| None).collect();
        let mut others = Vec::new();
        for draft in drafts {
            let Some(slot) = draft.beside.get("slot") else {
                others.push(draft);
                continue;
            };
            let path = format!("pieces.{}.slot", draft.name);
            let number: u32 = typed::read(slot, &path, &[], self.origins)?;
            let Some(place) = slots.get_mut((number as usize).wrapping_sub(1)) else {
                let reason = format!("is {number}, accepted: 1 to {count}, as many as there are pieces");
                return Err(Fault::of(&path, self.origins, &reason));
            };
            if let Some(other) = place {
                let reason =
                    format!("is {number}, which pieces.{} has, accepted: a slot of its own", other.name);
                return Err(Fault::of(&path, self.origins, &reason));
            }
            *place = Some(draft);
        }
        let mut others = others.into_iter();
        Ok(slots.into_iter().filter_map(|draft| draft.or_else(|| others.next())).collect())
    }
}
