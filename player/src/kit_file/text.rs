//! Parts of a kit as tables, and their entries as text.

use std::fmt::Write as _;

use overhear_engine::kit_spec::PieceSpec;
use serde::Serialize;
use toml::{Table, Value};

use super::units::{self, GIGAPASCAL, GRAM, INCH, MILLIMETRE};

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
