//! Every public number states its unit.
//!
//! A public item whose signature has an `f32` or `f64` names a unit in its docs, or says that there is none. The test
//! only finds a word of a list; readers judge whether it is the right one.

use super::{none, sources};

/// Units, and what a number is that has none.
const WORDS: &str = "Hz kHz m mm cm m2 m3 m4 kg g s s2 ms J W N N/m m/N Pa MPa GPa Pa/m3 m3/Pa kg/m4 m3/s dB dBFS m/s m2/s2 rad rad/s \
    rad2/s2 s2/m s/m kg/s 1/s 1/m MB K kg/m2 kg/m3 N/m2 cents octaves octave semitones samples sample points point pixels \
    seconds metres degrees calibrations unit units scale share shares ratio ratios relative factor factors exponent % 1 \
    dimensionless";

/// What is about numbers as such: Bessel functions, rows of modes, vectors, axes.
const PURE: &[&str] = &[
    "engine/src/math/",
    "engine/src/modal/simd",
    "plugin/src/editor/kit_view/vector.rs",
    "measure/src/report/plot.rs",
];

/// A documented item: its docs, those of the type it belongs to, and what it looks like.
struct Item {
    line: usize,
    docs: String,
    owner: String,
    signature: String,
}

/// The public items of a source that have numbers in them, those of its tests left out.
fn items(text: &str) -> Vec<Item> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let lines = &lines[..lines.iter().position(|line| *line == "#[cfg(test)]").unwrap_or(lines.len())];
    let (mut found, mut docs, mut owner) = (Vec::new(), String::new(), String::new());
    for (number, line) in lines.iter().enumerate() {
        if let Some(doc) = line.strip_prefix("///") {
            docs.push_str(doc);
            continue;
        }
        if line.starts_with("#[") {
            continue;
        }
        let mut words = line.split_whitespace().filter(|word| !["const", "unsafe"].contains(word));
        let (public, kind) = (words.next() == Some("pub"), words.next().unwrap_or_default());
        let opens = |kind: &str| ["struct", "enum", "trait"].contains(&kind);
        if opens(kind) || opens(line.split(' ').next().unwrap_or_default()) {
            owner = std::mem::take(&mut docs);
        } else if public && !["use", "mod"].contains(&kind) {
            let end = lines[number..].iter().position(|line| line.ends_with(['{', ';', ',', '}']));
            let signature = lines[number..=number + end.unwrap_or(0)].join(" ");
            let owner = if kind.ends_with(':') { owner.clone() } else { String::new() };
            // What a macro defines has its docs from where the macro is used.
            let is_of_macro = signature.contains('$');
            if !is_of_macro && (signature.contains("f32") || signature.contains("f64")) {
                found.push(Item { line: number + 1, docs: docs.clone(), owner, signature });
            }
        }
        docs.clear();
    }
    found
}

/// Whether docs have a word of the list.
fn names_a_unit(docs: &str) -> bool {
    // A sentence may begin with what is no symbol.
    let same = |unit: &str, word: &str| unit == word || unit.len() > 4 && unit.eq_ignore_ascii_case(word);
    let known = |word: &str| WORDS.split_whitespace().any(|unit| same(unit, word));
    docs.split(|c: char| c.is_whitespace() || ",;:.()[]`".contains(c)).any(known)
}

#[test]
fn every_public_number_says_its_unit() {
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for (path, text) in sources() {
        if PURE.iter().any(|pure| path.starts_with(pure))
            || path.ends_with("tests.rs")
            || path.starts_with("tests/")
        {
            continue;
        }
        for item in items(&text) {
            seen += 1;
            if !names_a_unit(&item.docs) && !names_a_unit(&item.owner) {
                wrong.push(format!("{path}:{}: {}\n    {}", item.line, item.signature, item.docs));
            }
        }
    }
    assert!(seen > 500, "{seen} items with numbers");
    none(wrong);
}

#[test]
fn what_says_nothing_is_found() {
    let source = "/// A thing.\npub struct Thing {\n    /// How long.\n    pub length: f64,\n    /// How heavy, kg.\n    pub mass: f64,\n}\n";
    let items = items(source);
    assert_eq!(items.len(), 2);
    assert!(!names_a_unit(&items[0].docs) && !names_a_unit(&items[0].owner) && names_a_unit(&items[1].docs));
}
