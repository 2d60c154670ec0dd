//! What a project stores, and how states of other versions and broken ones are read.
//!
//! The framework writes `{version, params, fields}` as JSON. What it cannot parse it refuses and
//! the instance plays on as it was. What parses is put in order here before it is loaded: every
//! parameter gets a value, so that a state always sounds the same, whatever was set before.

use std::collections::BTreeMap;

use nice_plug::plugin::{ParamValue, PluginState};
use nice_plug::prelude::*;

use crate::midi::assignments::{Assignment, NOTES};
use crate::parameters::{BYPASS_ID, PARAMETERS, Parameter};

/// Version of the meaning of what is stored; counts up when a migration is needed.
pub const SCHEMA: u32 = 1;

/// Field that holds [`SCHEMA`].
pub const SCHEMA_FIELD: &str = "schema";

/// Field that holds the window's logical size.
pub const WINDOW_FIELD: &str = "window";

/// Field of how the editor looks at the kit.
pub const VIEW_FIELD: &str = "view";

/// Field that holds the user's assignments: `38=49 40=silent`.
pub const NOTES_FIELD: &str = "notes";

/// Assignments as stored in [`NOTES_FIELD`], lowest note first.
pub fn notes_text(changed: &BTreeMap<u8, Assignment>) -> String {
    let texts =
        changed.iter().filter_map(|(note, assignment)| Some(format!("{note}={}", assignment.to_text()?)));
    texts.collect::<Vec<_>>().join(" ")
}

/// Reads what [`notes_text`] writes; what is not understood is logged and left out.
pub fn notes(text: &str) -> BTreeMap<u8, Assignment> {
    let entries = text.split_whitespace().filter_map(|entry| {
        let assignment = entry.split_once('=').and_then(|(note, plays)| {
            let note = note.parse().ok().filter(|&note: &u8| usize::from(note) < NOTES)?;
            Some((note, Assignment::from_text(plays)?))
        });
        if assignment.is_none() {
            nice_warn!("The state has an assignment {entry:?}, which is not understood: ignored");
        }
        assignment
    });
    entries.collect()
}

/// Completes and corrects a state before it is loaded.
///
/// Parameters that are missing, as in a state older than them, or that are not numbers get their
/// default; others are brought into range; unknown ones are dropped. A state newer than this
/// build is read as far as it is understood. Everything but plain absence is logged.
pub fn put_in_order(state: &mut PluginState) {
    match state.fields.get(SCHEMA_FIELD).map(|text| text.parse::<u32>()) {
        Some(Ok(schema)) if schema <= SCHEMA => {}
        Some(Ok(schema)) => nice_warn!(
            "The state has schema {schema}, this build knows up to {SCHEMA}: \
             what is new in it is ignored"
        ),
        Some(Err(_)) | None => nice_warn!("The state has no schema: read as {SCHEMA}"),
    }
    let stored = std::mem::take(&mut state.params);
    for id in stored.keys() {
        if id != BYPASS_ID && !PARAMETERS.iter().any(|parameter| parameter.id == id) {
            nice_warn!("The state has a parameter {id:?}, which is not known: ignored");
        }
    }
    state.params = PARAMETERS
        .iter()
        .map(|parameter| {
            let value = value_of(parameter, stored.get(parameter.id));
            (parameter.id.to_owned(), ParamValue::F32(value))
        })
        .chain([(BYPASS_ID.to_owned(), ParamValue::Bool(bypassed(stored.get(BYPASS_ID))))])
        .collect();
}

/// Whether a state is one of a bypassed instance. A host that does not store its bypass leaves it off.
fn bypassed(stored: Option<&ParamValue>) -> bool {
    match stored {
        None => false,
        Some(ParamValue::Bool(bypassed)) => *bypassed,
        Some(other) => {
            nice_warn!("The state has {BYPASS_ID} as {other:?}, neither true nor false: set to false");
            false
        }
    }
}

fn value_of(parameter: &Parameter, stored: Option<&ParamValue>) -> f32 {
    let Parameter { name, min, max, default, unit, .. } = *parameter;
    match stored {
        None => default,
        Some(ParamValue::F32(value)) if (min..=max).contains(value) => parameter.snap(*value),
        Some(ParamValue::F32(value)) => {
            nice_warn!("The state has {name} at {value}, accepted: {min} to {max}{unit}");
            parameter.snap(*value)
        }
        Some(other) => {
            nice_warn!("The state has {name} as {other:?}, not a number: set to {default}{unit}");
            default
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ordered(json_params: &[(&str, ParamValue)]) -> BTreeMap<String, f32> {
        let params = json_params.iter().map(|(id, value)| (id.to_string(), value.clone()));
        let mut state =
            PluginState { version: String::new(), params: params.collect(), fields: BTreeMap::new() };
        put_in_order(&mut state);
        let plain = |(id, value)| match value {
            ParamValue::F32(value) => (id, value),
            ParamValue::Bool(value) => (id, f32::from(value)),
            other => panic!("{id} is {other:?}"),
        };
        state.params.into_iter().map(plain).collect()
    }

    #[test]
    fn a_state_without_parameters_is_all_defaults() {
        let values = ordered(&[]);
        assert_eq!(values.len(), PARAMETERS.len() + 1);
        assert_eq!(values[BYPASS_ID], 0.0);
        assert!(PARAMETERS.iter().all(|parameter| values[parameter.id] == parameter.default));
    }

    #[test]
    fn stored_values_are_kept_and_missing_ones_reset() {
        let values = ordered(&[("kktune", ParamValue::F32(61.5))]);
        assert_eq!((values["kktune"], values["snmuff"]), (61.5, 0.0));
    }

    #[test]
    fn broken_values_are_put_right_and_unknown_ones_dropped() {
        let values = ordered(&[
            ("kktune", ParamValue::F32(1e9)),
            ("snmuff", ParamValue::F32(f32::NAN)),
            ("kklevl", ParamValue::String("loud".into())),
            ("sntune", ParamValue::F32(f32::NEG_INFINITY)),
            ("nobody", ParamValue::F32(1.0)),
            (BYPASS_ID, ParamValue::F32(1.0)),
        ]);
        assert_eq!((values["kktune"], values["snmuff"]), (90.0, 0.0));
        assert_eq!((values["kklevl"], values["sntune"]), (0.0, 140.0));
        assert!(!values.contains_key("nobody"));
        assert_eq!(values[BYPASS_ID], 0.0);
        assert_eq!(ordered(&[(BYPASS_ID, ParamValue::Bool(true))])[BYPASS_ID], 1.0);
    }

    #[test]
    fn assignments_are_stored_and_broken_ones_left_out() {
        let changed = BTreeMap::from([(38, Assignment::Plays(49)), (40, Assignment::Silent)]);
        assert_eq!(notes_text(&changed), "38=49 40=silent");
        assert_eq!(notes(&notes_text(&changed)), changed);
        assert_eq!(notes("38=49 x 300=38 41=loud 40=silent =  200=38"), changed);
        assert!(notes("").is_empty());
    }

    /// What a project stores, changed at random; the sequence is the same every time (xorshift, Marsaglia 2003).
    #[test]
    fn a_hundred_thousand_mutated_states_are_put_in_order_or_refused() {
        let params = PARAMETERS.iter().map(|p| (p.id.to_owned(), ParamValue::F32(p.default))).collect();
        let fields = [(SCHEMA_FIELD, "1"), (WINDOW_FIELD, "[980,640]"), (NOTES_FIELD, "38=49 40=silent")];
        let fields = fields.map(|(name, value)| (name.to_owned(), value.to_owned())).into();
        let state = PluginState { version: "0.1.0".into(), params, fields };
        let bytes = serde_json::to_vec(&state).unwrap();
        let host = crate::host_parameters::HostParameters::default();
        let (mut seed, mut read) = (1_u64, 0);
        let mut next = |below: usize| {
            seed ^= seed << 13;
            seed ^= seed >> 7;
            seed ^= seed << 17;
            (seed >> 33) as usize % below
        };
        for _ in 0..100_000 {
            let mut mutated = bytes.clone();
            for _ in 0..=next(3) {
                let at = next(mutated.len());
                match next(5) {
                    0 => mutated.truncate(at.max(1)),
                    1 => mutated[at] = next(256) as u8,
                    2 => mutated[at] = b"0123456789.-eE\"[]{},:ntf"[next(24)],
                    3 => mutated.insert(at, b"0123456789.-eE\"[]{},:ntf"[next(24)]),
                    _ => {
                        mutated.remove(at);
                        mutated.push(b' ');
                    }
                }
            }
            let Ok(mut state) = serde_json::from_slice::<PluginState>(&mutated) else { continue };
            read += 1;
            put_in_order(&mut state);
            assert_eq!(state.params.len(), PARAMETERS.len() + 1);
            for parameter in &PARAMETERS {
                let ParamValue::F32(value) = state.params[parameter.id] else { panic!("{}", parameter.id) };
                assert!((parameter.min..=parameter.max).contains(&value), "{}: {value}", parameter.id);
            }
            host.deserialize_fields(&state.fields);
            assert!(host.assignments().changed().len() < NOTES);
        }
        assert!(read > 5_000, "only {read} could be read at all");
    }
}
