//! The text of a kit file as a table under SI names, and where each entry of it stands.

use std::collections::BTreeMap;

use toml::de::{DeArray, DeTable, DeValue};
use toml::{Table, Value};

use super::error::{Fault, quoted};
use super::units::{self, Unit};

/// What a text says.
pub(super) struct Source {
    /// All entries in the file's order, fields in SI units under their SI names.
    pub(super) table: Table,
    /// Where they stand.
    pub(super) origins: Origins,
}

/// Where entries stand in the text, by their paths in SI names.
#[derive(Default)]
pub(super) struct Origins(BTreeMap<String, Origin>);

/// Where an entry stands.
struct Origin {
    at: usize,
    /// Its path as the file writes it.
    path: String,
    /// The unit of its number or numbers, if it is not SI.
    unit: Option<Unit>,
    /// Its text, if it is a scalar.
    literal: Option<String>,
}

/// A field as the file names it.
pub(super) struct Located<'a> {
    /// Byte of the text at which it, or what it should be in, stands.
    pub(super) at: usize,
    /// Its path.
    pub(super) path: String,
    /// The unit of its number, if it is not SI.
    pub(super) unit: Option<Unit>,
    /// Its own text, if it is a scalar in the file.
    pub(super) literal: Option<&'a str>,
}

impl Origins {
    /// Whether the file has that entry.
    pub(super) fn has(&self, path: &str) -> bool {
        self.0.contains_key(path)
    }

    /// Finds a field, or, of one that the file does not have, the innermost of its tables that it has.
    pub(super) fn locate(&self, path: &str) -> Located<'_> {
        let mut known = path;
        loop {
            if let Some(Origin { at, path: written, unit, literal }) = self.0.get(known) {
                let literal = literal.as_deref().filter(|_| known.len() == path.len());
                let path = format!("{written}{}", &path[known.len()..]);
                return Located { at: *at, path, unit: *unit, literal };
            }
            let Some((parent, _)) = known.rsplit_once('.') else {
                return Located { at: 0, path: path.to_owned(), unit: None, literal: None };
            };
            known = parent;
        }
    }
}

impl Source {
    /// Reads a text.
    pub(super) fn parse(text: &str) -> Result<Source, Fault> {
        let table = DeTable::parse(text).map_err(|error| {
            let message = error.message().lines().collect::<Vec<_>>().join(", ");
            Fault {
                at: error.span().map(|span| span.start),
                reason: format!("this is not valid TOML: {message}"),
            }
        })?;
        Source::of(text, table.get_ref())
    }

    /// Reads a table of a text.
    pub(super) fn of(text: &str, table: &DeTable<'_>) -> Result<Source, Fault> {
        let mut reader = Reader { text, origins: Origins::default() };
        let table = reader.table(table, &Path::default())?;
        Ok(Source { table, origins: reader.origins })
    }
}

/// Entries deeper than this have no meaning; keeps the paths of a hostile file short.
const DEEPEST: usize = 8;

/// The path of a table: in SI names, and as written.
#[derive(Default)]
struct Path {
    si: String,
    written: String,
    depth: usize,
    /// The unit of the numbers in an array.
    unit: Option<Unit>,
}

impl Path {
    fn with(&self, si: &str, written: &str, unit: Option<Unit>) -> Path {
        let join =
            |path: &str, key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        Path { si: join(&self.si, si), written: join(&self.written, written), depth: self.depth + 1, unit }
    }

    /// Whether the keys of this table are names of fields, rather than of parts of the file or of pieces.
    fn holds_fields(&self) -> bool {
        match self.si.split('.').next() {
            Some("pieces") => self.depth >= 2,
            Some("microphones" | "room" | "piece") => true,
            // Parts of the library, by name.
            Some("heads" | "walls" | "hoops" | "alloys" | "wires") => self.depth >= 2,
            _ => false,
        }
    }
}

struct Reader<'a> {
    text: &'a str,
    origins: Origins,
}

impl Reader<'_> {
    fn table(&mut self, table: &DeTable<'_>, path: &Path) -> Result<Table, Fault> {
        let mut entries: Vec<_> = table.iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        let mut read = Table::new();
        for (key, value) in entries {
            let name: &str = key.get_ref();
            let other = if path.holds_fields() { units::si_name(name) } else { None };
            let (si, unit) = other.map_or((name.to_owned(), None), |(si, unit)| (si, Some(unit)));
            let inner = path.with(&si, name, unit);
            if inner.depth > DEEPEST {
                return Err(Fault::new(key.span().start, format!("{} is nested too deep", inner.written)));
            }
            if read.contains_key(&si) {
                let reason = format!(
                    "is given together with {}, accepted: one of them",
                    self.origins.locate(&inner.si).path
                );
                return Err(Fault::new(key.span().start, format!("{} {reason}", inner.written)));
            }
            // A table is where its name stands; `value.span()` of one would be that of a header.
            let at = match value.get_ref() {
                DeValue::Table(_) | DeValue::Array(_) => key.span().start,
                _ => value.span().start,
            };
            let value = self.value(value.get_ref(), value.span(), at, &inner)?;
            read.insert(si, value);
        }
        Ok(read)
    }

    fn value(
        &mut self,
        value: &DeValue<'_>,
        span: std::ops::Range<usize>,
        at: usize,
        path: &Path,
    ) -> Result<Value, Fault> {
        let scalar = !matches!(value, DeValue::Table(_) | DeValue::Array(_));
        let literal = scalar.then(|| self.text.get(span).unwrap_or_default().to_owned());
        let origin = Origin { at, path: path.written.clone(), unit: path.unit, literal };
        self.origins.0.insert(path.si.clone(), origin);
        Ok(match value {
            DeValue::String(text) => Value::String(text.to_string()),
            DeValue::Boolean(yes) => Value::Boolean(*yes),
            DeValue::Integer(number) => match i64::from_str_radix(number.as_str(), number.radix()) {
                Ok(whole) => {
                    path.unit.map_or(Value::Integer(whole), |unit| Value::Float(unit.to_si(whole as f64)))
                }
                // Beyond what a whole number can be: too large for anything.
                Err(_) => Value::Float(if number.as_str().starts_with('-') { f64::MIN } else { f64::MAX }),
            },
            DeValue::Float(number) => {
                let number: f64 = number.as_str().parse().unwrap_or(f64::NAN);
                Value::Float(path.unit.map_or(number, |unit| unit.to_si(number)))
            }
            DeValue::Array(array) => Value::Array(self.array(array, path)?),
            DeValue::Table(table) => Value::Table(self.table(table, path)?),
            DeValue::Datetime(date) => {
                let reason =
                    format!("{} is {}, a date, accepted: none", path.written, quoted(&date.to_string()));
                return Err(Fault::new(at, reason));
            }
        })
    }

    fn array(&mut self, array: &DeArray<'_>, path: &Path) -> Result<Vec<Value>, Fault> {
        let mut read = Vec::with_capacity(array.len());
        for (index, value) in array.iter().enumerate() {
            let index = index.to_string();
            let inner = path.with(&index, &index, path.unit);
            if inner.depth > DEEPEST {
                return Err(Fault::new(value.span().start, format!("{} is nested too deep", inner.written)));
            }
            read.push(self.value(value.get_ref(), value.span(), value.span().start, &inner)?);
        }
        Ok(read)
    }
}
