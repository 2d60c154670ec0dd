//! An older report, to set a new one beside.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::Result;
use serde::Deserialize;
use serde_json::Value;

use crate::bad_input;

/// Costs of an older report, calibrations, by name.
pub type Before = BTreeMap<String, f64>;

/// Compared fields of a report.
#[derive(Deserialize)]
struct Older {
    /// Of the standard kit only.
    groove: Option<Cost>,
    all_at_once: Cost,
    /// Of kits with cymbals.
    cymbals_ringing: Option<Cost>,
    cymbals_choked: Option<Cost>,
    idle: Cost,
    pieces: BTreeMap<String, Value>,
}

#[derive(Deserialize)]
struct Cost {
    calibrations: f64,
}

/// Reads a report written with `--json`.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) naming the file and what is wrong with it.
pub fn read(path: &Path) -> Result<Before> {
    let text = std::fs::read_to_string(path).map_err(|error| bad_input!("{}: {error}", path.display()))?;
    parse(&text).map_err(|error| bad_input!("{} is no report of `bench --json`: {error}", path.display()))
}

/// Takes the costs out of a report.
///
/// # Errors
/// Its fields that are missing or not numbers.
pub fn parse(text: &str) -> serde_json::Result<Before> {
    let Older { groove, all_at_once, cymbals_ringing, cymbals_choked, idle, pieces } =
        serde_json::from_str(text)?;
    let mut before = Before::from([
        ("all-at-once".to_owned(), all_at_once.calibrations),
        ("idle".to_owned(), idle.calibrations),
    ]);
    let others =
        [("groove", groove), ("cymbals ringing", cymbals_ringing), ("cymbals choked", cymbals_choked)];
    before.extend(others.into_iter().filter_map(|(name, cost)| Some((name.to_owned(), cost?.calibrations))));
    for (name, tiers) in pieces {
        flatten(&name, &tiers, &mut before);
    }
    Ok(before)
}

/// Takes up `calibrations` wherever it stands: a piece has it, or has tiers that do.
fn flatten(name: &str, value: &Value, before: &mut Before) {
    let Some(object) = value.as_object() else { return };
    if let Some(cost) = object.get("calibrations").and_then(Value::as_f64) {
        before.insert(name.to_owned(), cost);
    }
    for (tier, value) in object.get("tiers").and_then(Value::as_object).into_iter().flatten() {
        flatten(&format!("{name} {tier}"), value, before);
    }
}
