//! A piece of a kit file as a description.

use overhear_engine::cymbal::CymbalSpec;
use overhear_engine::drum::DrumSpec;
use overhear_engine::hi_hat::HiHatSpec;
use overhear_engine::kit_spec::{Defaults, InstrumentSpec, PieceSpec, PlaceSpec};
use overhear_engine::microphones::CloseSpec;
use overhear_engine::piece::Idealization;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use toml::{Table, Value};

use super::drafts::{BESIDE, Draft};
use super::error::Fault;
use super::source::Origins;
use super::typed;

/// What a piece has whatever its kind.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Common {
    title: Option<String>,
    place: PlaceSpec,
    close: CloseSpec,
    defaults: Defaults,
    #[serde(default)]
    ideal: Idealization,
}

/// The fields of [`Common`].
pub(super) const COMMON: [&str; 5] = ["title", "place", "close", "defaults", "ideal"];

/// Reads the description of a piece; [`KitSpec::check`](overhear_engine::kit_spec::KitSpec::check) is still to come.
pub(super) fn read(draft: &Draft, origins: &Origins) -> Result<PieceSpec, Fault> {
    let path = format!("pieces.{}", draft.name);
    let mut own = draft.fields.clone();
    let common = COMMON.into_iter().filter_map(|key| Some((key.to_owned(), own.remove(key)?)));
    let common = Value::Table(common.collect());
    // What is unknown or has no kind is told before what is missing.
    let instrument = instrument(own, &path, origins)?;
    let Common { title, place, close, defaults, ideal } = typed::read(&common, &path, &[], origins)?;
    let title = title.unwrap_or_else(|| title_of(&draft.name));
    Ok(PieceSpec { name: draft.name.clone(), title, instrument, place, close, defaults, ideal })
}

fn instrument(mut own: Table, path: &str, origins: &Origins) -> Result<InstrumentSpec, Fault> {
    let fields = |own: Table| (Value::Table(own), path, origins);
    match own.get("kind").and_then(Value::as_str) {
        None if !own.contains_key("kind") => {
            let reason =
                "kind is missing, accepted: a kind with all its fields, or `like` with the name of a piece";
            Err(Fault::new(origins.locate(path).at, format!("{path}.{reason}")))
        }
        // One by one, as Serde forgets where it is in a value whose kind it has to look for.
        Some("drum") => {
            own.remove("kind");
            of_kind::<DrumSpec>(fields(own)).map(InstrumentSpec::Drum)
        }
        Some("cymbal") => {
            own.remove("kind");
            of_kind::<CymbalSpec>(fields(own)).map(InstrumentSpec::Cymbal)
        }
        Some("hi-hat") => {
            own.remove("kind");
            of_kind::<HiHatSpec>(fields(own)).map(InstrumentSpec::HiHat)
        }
        _ => of_kind::<InstrumentSpec>(fields(own)),
    }
}

fn of_kind<T: DeserializeOwned>((value, path, origins): (Value, &str, &Origins)) -> Result<T, Fault> {
    let further: Vec<&str> = ["kind"].into_iter().chain(COMMON).chain(BESIDE).collect();
    typed::read(&value, path, &further, origins)
}

/// The title of a piece that has none in the file: its name as a heading, `Crash 2` of `crash-2`.
fn title_of(name: &str) -> String {
    let spaced = name.replace('-', " ");
    let mut letters = spaced.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
