//! A project's state as the framework parses it, put in order by the player.

use nice_plug::plugin::{ParamValue, PluginState};
use overhear_player::state::{State, StoredValue};

/// Completes and corrects a state before it is loaded; see [`State::put_in_order`].
pub fn put_in_order(state: &mut PluginState) {
    let values = std::mem::take(&mut state.params).into_iter().map(|(id, value)| (id, plain(value)));
    let mut plain = State { values: values.collect(), fields: std::mem::take(&mut state.fields) };
    plain.put_in_order();
    state.params = plain.values.into_iter().map(|(id, value)| (id, stored(value))).collect();
    state.fields = plain.fields;
}

/// A value of the framework's as the player knows it.
fn plain(value: ParamValue) -> StoredValue {
    match value {
        ParamValue::F32(number) => StoredValue::Number(number),
        ParamValue::Bool(on) => StoredValue::Switch(on),
        ParamValue::I32(number) => StoredValue::Other(number.to_string()),
        ParamValue::String(text) => StoredValue::Other(text),
    }
}

/// A value of the player's as the framework stores it.
fn stored(value: StoredValue) -> ParamValue {
    match value {
        StoredValue::Number(number) => ParamValue::F32(number),
        StoredValue::Switch(on) => ParamValue::Bool(on),
        StoredValue::Other(text) => ParamValue::String(text),
    }
}

#[cfg(test)]
mod tests;
