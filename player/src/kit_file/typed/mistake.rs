//! What does not fit a typed value: its path, what it is, and what is accepted.

use std::fmt;

use serde::de::{self, Expected, Unexpected};
use toml::{Table, Value};

use super::super::error::{Fault, quoted, shortened};
use super::super::source::Origins;
use super::super::units::with_units;

/// What does not fit, and where.
#[derive(Debug)]
pub(crate) struct Mistake {
    /// Keys from the innermost outward.
    keys: Vec<String>,
    what: What,
}

#[derive(Debug)]
enum What {
    /// A key that a table does not have.
    Unknown(String, &'static [&'static str]),
    /// A key that a table must have.
    Missing(&'static str),
    /// A name that is none of these.
    Variant(String, &'static [&'static str]),
    /// A value of another kind, and the kind that is accepted.
    Kind(String, String),
    /// What else is said.
    Other(String),
}

impl Mistake {
    /// The same inside an entry of that key.
    pub(super) fn inside(mut self, key: impl Into<String>) -> Mistake {
        self.keys.push(key.into());
        self
    }

    /// The fault in a value that stands at a path, where further fields are accepted, too.
    pub(super) fn located(self, value: &Value, path: &str, further: &[&str], origins: &Origins) -> Fault {
        let further = if self.keys.is_empty() { further } else { &[] };
        let (mut path, mut inner) = (path.to_owned(), Some(value));
        for key in self.keys.iter().rev() {
            path = format!("{path}.{key}");
            inner = inner.and_then(|value| match value {
                Value::Array(array) => array.get(key.parse::<usize>().ok()?),
                value => value.get(key),
            });
        }
        match self.what {
            What::Unknown(key, known) => {
                let known: Vec<String> = further.iter().chain(known).map(|name| with_units(name)).collect();
                let reason = format!("is not known, accepted: {}", known.join(", "));
                Fault::of(&format!("{path}.{key}"), origins, &reason)
            }
            What::Missing(key) => {
                let missing = format!("{path}.{key}");
                if origins.has(&missing) {
                    return Fault::of(&missing, origins, "is \"none\", accepted: only for optional parts");
                }
                let reason = format!("is missing, accepted: {}", with_units(key));
                Fault::new(origins.locate(&path).at, format!("{missing} {reason}"))
            }
            What::Variant(name, known) => {
                let reason = format!("is {}, accepted: {}", quoted(&name), known.join(", "));
                Fault::of(&path, origins, &reason)
            }
            What::Kind(found, accepted) => {
                if let Some(Value::Table(table)) = inner
                    && let Some(key) = culprit(table, &found)
                {
                    path = format!("{path}.{key}");
                }
                let literal = origins.locate(&path).literal.map(shortened);
                let reason = format!("is {}, accepted: {accepted}", literal.unwrap_or(found));
                Fault::of(&path, origins, &reason)
            }
            What::Other(reason) => Fault::of(&path, origins, &format!("is not accepted: {reason}")),
        }
    }
}

/// The entry of a table that is what was found. Serde reads a table with a `kind` into a buffer first and forgets where in it
/// a value stood; such tables hold no others.
fn culprit<'a>(table: &'a Table, found: &str) -> Option<&'a String> {
    let is = |(key, value): &(&String, &Value)| *key != "kind" && found_of(&unexpected(value)) == found;
    table.iter().find(is).map(|(key, _)| key)
}

/// A value as Serde names it.
pub(super) fn unexpected(value: &Value) -> Unexpected<'_> {
    match value {
        Value::String(text) => Unexpected::Str(text),
        Value::Integer(whole) => Unexpected::Signed(*whole),
        Value::Float(number) => Unexpected::Float(*number),
        Value::Boolean(yes) => Unexpected::Bool(*yes),
        Value::Datetime(_) => Unexpected::Other("a date"),
        Value::Array(_) => Unexpected::Seq,
        Value::Table(_) => Unexpected::Map,
    }
}

fn found_of(found: &Unexpected<'_>) -> String {
    match found {
        Unexpected::Bool(yes) => yes.to_string(),
        Unexpected::Unsigned(whole) => whole.to_string(),
        Unexpected::Signed(whole) => whole.to_string(),
        Unexpected::Float(number) => number.to_string(),
        Unexpected::Str(text) => quoted(text),
        Unexpected::Seq => "an array".to_owned(),
        Unexpected::Map => "a table".to_owned(),
        other => other.to_string(),
    }
}

/// What Serde expects, in the words of a kit file.
fn accepted_of(expected: &dyn Expected) -> String {
    let expected = expected.to_string();
    match &*expected {
        "f64" | "f32" => "a number",
        "u8" | "u16" | "u32" | "u64" => "an integer, 0 or more",
        "a boolean" => "true or false",
        "a string" | "string or map" | "variant identifier" => "a text",
        other if other.starts_with("struct") => "a table",
        other if other.starts_with("internally tagged enum") => "a table with a kind",
        other if other.starts_with("enum") => "a name",
        other => other,
    }
    .to_owned()
}

impl fmt::Display for Mistake {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{:?} at {:?}", self.what, self.keys)
    }
}

impl std::error::Error for Mistake {}

impl From<What> for Mistake {
    fn from(what: What) -> Mistake {
        Mistake { keys: Vec::new(), what }
    }
}

impl de::Error for Mistake {
    fn custom<T: fmt::Display>(message: T) -> Mistake {
        What::Other(message.to_string()).into()
    }

    fn invalid_type(found: Unexpected<'_>, expected: &dyn Expected) -> Mistake {
        What::Kind(found_of(&found), accepted_of(expected)).into()
    }

    fn invalid_value(found: Unexpected<'_>, expected: &dyn Expected) -> Mistake {
        What::Kind(found_of(&found), accepted_of(expected)).into()
    }

    fn invalid_length(length: usize, expected: &dyn Expected) -> Mistake {
        What::Kind(format!("an array of {length}"), accepted_of(expected)).into()
    }

    fn unknown_variant(variant: &str, expected: &'static [&'static str]) -> Mistake {
        What::Variant(variant.to_owned(), expected).into()
    }

    fn unknown_field(field: &str, expected: &'static [&'static str]) -> Mistake {
        What::Unknown(field.to_owned(), expected).into()
    }

    fn missing_field(field: &'static str) -> Mistake {
        What::Missing(field).into()
    }
}
