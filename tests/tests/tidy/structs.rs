//! Sizes of the engine's structs: what has many fields is several things.

use syn::{Fields, Item};

use super::{none, sources};

/// Fewest fields that need a reason.
const MANY: usize = 15;

/// Structs of so many fields, and why each is one.
const MANY_FOR_A_REASON: [(&str, &str); 2] = [
    ("ContactPoint", "place, law, state and present sample of one point are read together in the same loop"),
    ("DrumSpec", "the description of a drum: a field for each entry of its table in a kit file"),
];

/// Every struct of a source with its number of fields, those inside of modules too.
fn structs(items: &[Item], found: &mut Vec<(String, usize)>) {
    for item in items {
        match item {
            Item::Struct(item) => {
                let count = match &item.fields {
                    Fields::Named(fields) => fields.named.len(),
                    Fields::Unnamed(fields) => fields.unnamed.len(),
                    Fields::Unit => 0,
                };
                found.push((item.ident.to_string(), count));
            }
            Item::Mod(item) => item.content.iter().for_each(|(_, items)| structs(items, found)),
            _ => {}
        }
    }
}

#[test]
fn no_struct_of_the_engine_has_fifteen_fields_without_a_reason() {
    let mut found = Vec::new();
    for (path, text) in sources() {
        if path.starts_with("engine/src/") {
            structs(&syn::parse_file(&text).expect("a source").items, &mut found);
        }
    }
    assert!(found.len() > 100, "{} structs", found.len());
    let many = found.iter().filter(|(_, count)| *count >= MANY);
    let (known, new): (Vec<_>, Vec<_>) =
        many.partition(|(name, _)| MANY_FOR_A_REASON.iter().any(|(known, _)| known == name));
    assert_eq!(known.len(), MANY_FOR_A_REASON.len(), "a reason is left over");
    none(new.into_iter().map(|(name, count)| format!("{name} has {count} fields")).collect());
}
