//! What a project stores of the plugin, changed from outside: eight bytes of length, then JSON with an object of fields.

use anyhow::{Context, Result, ensure};
use overhear::kit_document::KitDocument;
use overhear::kit_file;
use serde_json::{Map, Value};

use super::instance::Instance;

/// Bytes of a state that say how long its text is.
const LENGTH: usize = 8;

/// Field that holds the kit: the text of a kit file.
const KIT_FIELD: &str = "kit";

/// A state with its fields changed.
///
/// # Errors
/// If it is none of this plugin's; what `change` returns.
pub fn with_fields(
    state: &[u8],
    change: impl FnOnce(&mut Map<String, Value>) -> Result<()>,
) -> Result<Vec<u8>> {
    let mut state = read(state)?;
    change(part(&mut state, "fields")?)?;
    written(&state)
}

/// A part of a state.
fn part<'a>(state: &'a mut Value, name: &str) -> Result<&'a mut Map<String, Value>> {
    state.get_mut(name).and_then(Value::as_object_mut).with_context(|| format!("the state has no {name}"))
}

fn written(state: &Value) -> Result<Vec<u8>> {
    let text = serde_json::to_vec(state)?;
    Ok([&(text.len() as u64).to_le_bytes()[..], &text].concat())
}

fn read(state: &[u8]) -> Result<Value> {
    let text = state.get(LENGTH..).context("the plugin's state is too short")?;
    serde_json::from_slice(text).context("the plugin's state is not JSON")
}

/// Gives an instance a kit other than the standard one, as a project would in which no parameter has been moved: all are at
/// the kit's defaults.
///
/// # Errors
/// If it does not take it over.
pub fn set_kit(instance: &mut Instance, kit: &KitDocument) -> Result<()> {
    let text = kit_file::write(kit);
    let mut state = read(&instance.save_state()?)?;
    part(&mut state, "params")?.clear();
    part(&mut state, "fields")?.insert(KIT_FIELD.to_owned(), text.clone().into());
    instance.load_state(&written(&state)?)?;
    // A plugin that knows no kits drops the field, one that cannot play this kit keeps its own.
    let kept = read(&instance.save_state()?)?;
    ensure!(kept["fields"][KIT_FIELD] == text, "it does not keep it");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_field_is_put_into_a_state_that_has_fields() {
        let state = json!({"fields": {"view": "[0]"}});
        let bytes = |state: &Value| [&[0; LENGTH][..], &serde_json::to_vec(state).unwrap()].concat();
        let change = |fields: &mut Map<String, Value>| {
            fields.insert("kit".to_owned(), "piccolo".into());
            Ok(())
        };
        let changed = with_fields(&bytes(&state), change).unwrap();
        assert_eq!(changed[..LENGTH], (changed.len() as u64 - 8).to_le_bytes());
        let changed = read(&changed).unwrap();
        assert_eq!(
            (&changed["fields"]["view"], &changed["fields"]["kit"]),
            (&json!("[0]"), &json!("piccolo"))
        );
        assert!(with_fields(&bytes(&json!({})), change).is_err());
        assert!(with_fields(&[1, 2], change).is_err());
    }
}
