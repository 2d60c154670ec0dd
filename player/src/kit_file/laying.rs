//! Tables laid over each other.

use toml::{Table, Value};

/// What takes away a part that a piece can do without.
pub(super) const NONE: &str = "none";

/// Changes a table field by field. A text `none` takes an entry away; a table of another kind replaces the former.
pub(super) fn lay_over(table: &mut Table, changes: Table) {
    let kind = |table: &Table| table.get("kind").cloned();
    if let (Some(own), Some(other)) = (kind(table), kind(&changes))
        && own != other
    {
        table.clear();
    }
    for (key, change) in changes {
        let is_text = key == "title" || matches!(table.get(&key), Some(Value::String(_)));
        match change {
            Value::String(text) if text == NONE && !is_text => drop(table.remove(&key)),
            Value::Table(changes) => {
                let mut part = match table.remove(&key) {
                    Some(Value::Table(part)) => part,
                    _ => Table::new(),
                };
                lay_over(&mut part, changes);
                table.insert(key, Value::Table(part));
            }
            change => drop(table.insert(key, change)),
        }
    }
}
