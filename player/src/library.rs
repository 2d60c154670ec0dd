//! The library: instruments and whole kits that come with Overhear.
//!
//! They are kit files (`player/library/kits`) and files of single pieces (`player/library/pieces`), which take heads, shells, hoops,
//! alloys and wires from lists of parts (`player/library/parts`). A kit file takes an instrument over with `like`; see [`kit_file`].

use std::sync::OnceLock;

use overhear_engine::kit_spec::{KitSpec, PieceSpec};
use toml::Table;

use crate::kit_document::KitDocument;
use crate::kit_file::{self, KitFileError};

/// An instrument of the library.
#[derive(Debug, Clone, PartialEq)]
pub struct Instrument {
    /// What kit files call it: `like = "kick-24x18"`.
    pub name: &'static str,
    /// What it is among drums and cymbals: `bass drum`, `snare drum`, `tom` ...
    pub family: String,
    /// A line on what it is.
    pub about: String,
}

/// A whole kit of the library.
#[derive(Debug, Clone, PartialEq)]
pub struct WholeKit {
    /// Its name: `jazz-18`.
    pub name: &'static str,
    /// A line on what it is.
    pub about: String,
    /// Its kit file.
    pub text: &'static str,
}

/// A text field of a file, empty if it has none.
fn field(file: &Table, key: &str) -> String {
    file.get(key).and_then(toml::Value::as_str).unwrap_or_default().to_owned()
}

/// Every instrument, in the order of families; read from their files the first time.
pub fn instruments() -> impl Iterator<Item = Instrument> {
    static READ: OnceLock<Vec<Instrument>> = OnceLock::new();
    let read = |&(name, text): &(&'static str, &str)| {
        let file: Table = text.parse().unwrap_or_default();
        Instrument { name, family: field(&file, "family"), about: field(&file, "about") }
    };
    let [instruments, _] = kit_file::library();
    READ.get_or_init(|| instruments.iter().map(read).collect()).iter().cloned()
}

/// Every whole kit; read from their files the first time.
pub fn kits() -> impl Iterator<Item = WholeKit> {
    static READ: OnceLock<Vec<WholeKit>> = OnceLock::new();
    let read = |&(name, text): &(&'static str, &'static str)| {
        let file: Table = text.parse().unwrap_or_default();
        WholeKit { name, about: field(&file, "about"), text }
    };
    let [_, kits] = kit_file::library();
    READ.get_or_init(|| kits.iter().map(read).collect()).iter().cloned()
}

/// The instrument of a name.
pub fn instrument(name: &str) -> Option<Instrument> {
    instruments().find(|instrument| instrument.name == name)
}

/// The whole kit of a name.
pub fn whole_kit(name: &str) -> Option<WholeKit> {
    kits().find(|kit| kit.name == name)
}

/// The manual's page of the library, in Markdown. `cargo xtask docs` writes it; a test compares.
pub fn document() -> String {
    let mut page = String::from(
        "# Library\n\n\
         `cargo xtask docs` writes this page from the files in `player/library/`; do not edit it.\n\n\
         A kit file takes an instrument over with `like = \"NAME\"`, as a new piece or in the place of one of the standard kit; \
         `--kit NAME` plays a whole kit, and `overhear kit new mine.toml --from NAME` begins a file with one. \
         See [kit files](kit-files.md).\n\n## Whole kits\n\nThe beginning of the groove on each, and the loudness (LUFS) and the peak (dBFS) of the \
         whole of it, as `cargo xtask demo --all-kits` plays and measures it.\n\n\
         | name | | listen | | loudness | peak |\n|---|---|---|---|---|---|\n",
    );
    for kit in kits() {
        let (name, about) = (kit.name, &kit.about);
        let [loudness, peak] = kit
            .measured()
            .map_or([const { String::new() }; 2], |measured| measured.map(|it| format!("{it:.1}")));
        page.push_str(&format!(
            "| `{name}` | {about} | [{name}.mp3](sounds/kits/{name}.mp3) | [picture](pictures/kits/{name}.png) | {loudness} | {peak} |\n"
        ));
    }
    let mut family = String::new();
    for instrument in instruments() {
        if instrument.family != family {
            let mut letters = instrument.family.chars();
            let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
            page.push_str(&format!("\n## {first}{}\n\n| name | |\n|---|---|\n", letters.as_str()));
            family.clone_from(&instrument.family);
        }
        page.push_str(&format!("| `{}` | {} |\n", instrument.name, instrument.about));
    }
    for (kind, used) in [
        ("heads", "`batter.like` and `resonant.like` of drums"),
        ("walls", "`shell.wall.like` of drums"),
        ("hoops", "`hoop.like` of drums"),
        ("wires", "`wires.like` of drums"),
        ("alloys", "`alloy.like` of cymbals"),
    ] {
        page.push_str(&format!("\n## Parts: {kind}\n\nTaken over by {used}.\n\n| name | |\n|---|---|\n"));
        for (name, part) in kit_file::library_parts(kind) {
            page.push_str(&format!(
                "| `{name}` | {} |\n",
                part.as_table().map_or_else(String::new, |part| field(part, "about"))
            ));
        }
    }
    page
}

impl Instrument {
    /// The piece, with the place, level and pan that its family has in the standard kit.
    ///
    /// # Errors
    /// [`KitFileError`] if its file is not accepted, which a test excludes.
    pub fn piece(&self) -> Result<PieceSpec, KitFileError> {
        let standard = KitSpec::standard();
        let others: Vec<String> = standard.pieces.iter().map(|piece| format!("{:?}", piece.name)).collect();
        let name = self.name;
        let text =
            format!("format = 1\nremove = [{}]\n[pieces.{name}]\nlike = \"{name}\"\n", others.join(", "));
        let document = kit_file::read(name, &text)?;
        let mut pieces = document.kit.pieces;
        // A kit that was read has a piece at least.
        Ok(pieces.swap_remove(0))
    }
}

/// What `cargo xtask demo --all-kits` measured of the groove on every whole kit.
const LOUDNESS: &str = include_str!("../library/loudness.toml");

impl WholeKit {
    /// How loud the groove is on it (LUFS), and its peak (dBFS), as last measured.
    pub fn measured(&self) -> Option<[f64; 2]> {
        let table: Table = LOUDNESS.parse().ok()?;
        let kit = table.get(self.name)?;
        let figure = |name: &str| kit.get(name).and_then(toml::Value::as_float);
        Some([figure("lufs")?, figure("peak_dbfs")?])
    }

    /// The kit.
    ///
    /// # Errors
    /// [`KitFileError`] if its file is not accepted, which a test excludes.
    pub fn document(&self) -> Result<KitDocument, KitFileError> {
        kit_file::read(self.name, self.text)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_instrument_and_every_kit_is_accepted_described_and_distinct() {
        let (mut names, mut abouts, mut pieces) = (BTreeSet::new(), BTreeSet::new(), Vec::<PieceSpec>::new());
        for instrument in instruments() {
            let piece = instrument.piece().unwrap_or_else(|error| panic!("{}: {error}", instrument.name));
            let kit = KitSpec { pieces: vec![piece.clone()], ..KitSpec::standard() };
            kit.check().unwrap_or_else(|error| panic!("{}: {error}", instrument.name));
            assert!(!instrument.family.is_empty() && instrument.about.len() > 20, "{instrument:?}");
            let twin = pieces.iter().find(|other| other.instrument == piece.instrument);
            assert_eq!(twin.map(|twin| &twin.name), None, "{}", instrument.name);
            assert!(names.insert(instrument.name) && abouts.insert(instrument.about));
            pieces.push(piece);
        }
        assert!(pieces.len() >= 60, "{} instruments", pieces.len());
        let mut kits: Vec<KitDocument> = Vec::new();
        for kit in super::kits() {
            let document = kit.document().unwrap_or_else(|error| panic!("{}: {error}", kit.name));
            assert!(kit.about.len() > 20 && abouts.insert(kit.about), "{}", kit.name);
            assert!(!kits.contains(&document), "{}", kit.name);
            kits.push(document);
        }
        assert_eq!(kits.len(), 12);
    }
}
