//! States of the first schema, in which the kit was fixed.
//!
//! Its parameters were those of nine pieces, each with ids of its own; drums were tuned in Hz, and the pitch of a drum's
//! resonant head over the batter head's was a parameter. That is in the kit now.

use overhear_engine::kit_spec::{InstrumentSpec, Kind, KitSpec};
use overhear_engine::slot::Slot;
use tracing::warn;

use super::stored::{KIT_FIELD, State, StoredValue, kit_text};
use crate::kit_document::KitDocument;
use crate::parameters::{SlotParameter, parameters, range, slot_index};

/// First two letters of a piece's ids, and the piece.
const PIECES: [(&str, &str); 9] = [
    ("kk", "kick"),
    ("sn", "snare"),
    ("rt", "rack-tom"),
    ("ft", "floor-tom"),
    ("cr", "crash"),
    ("rd", "ride"),
    ("sp", "splash"),
    ("tp", "timpani"),
    ("hh", "hi-hat"),
];

/// Ends of ids and what they moved.
const ENDS: [(&str, SlotParameter); 9] = [
    ("tune", SlotParameter::Tune),
    ("muff", SlotParameter::Muffle),
    ("levl", SlotParameter::Level),
    ("pan", SlotParameter::Pan),
    ("plac", SlotParameter::Position),
    ("stik", SlotParameter::Stick),
    ("prel", SlotParameter::Preload),
    ("wire", SlotParameter::Wires),
    ("pedl", SlotParameter::Pedal),
];

/// End of the ids of resonant heads' pitches.
const RESONANT: &str = "reso";

/// Smallest and largest pitch of a resonant head over the batter head's that there was.
const RATIOS: (f32, f32) = (0.5, 2.0);

/// Gives everything the place that it has now. What belongs to no piece has kept its id and its meaning.
pub fn translate(state: &mut State) {
    let mut document = KitDocument::standard();
    let stored = std::mem::take(&mut state.values);
    for (id, value) in stored {
        let Some((slot, end)) = piece_of(&id, &document.kit) else {
            state.values.insert(id, value);
            continue;
        };
        match moved(end) {
            Some(what) => {
                let value =
                    if what == SlotParameter::Tune { tuned(&document.kit, slot, &id, value) } else { value };
                state.values.insert(parameters()[slot_index(slot, what)].id.to_owned(), value);
            }
            None => set_resonant(&mut document.kit, slot, &id, &value),
        }
    }
    if let Some(text) = kit_text(&document) {
        state.fields.insert(KIT_FIELD.to_owned(), text);
    }
}

/// Slot of the piece that an id is of, and the id's end.
fn piece_of<'a>(id: &'a str, kit: &KitSpec) -> Option<(Slot, &'a str)> {
    let (start, end) = id.split_at_checked(2)?;
    let (_, piece) = PIECES.iter().find(|(known, _)| *known == start)?;
    let (slot, _) = kit.find(piece)?;
    (end == RESONANT || moved(end).is_some()).then_some((slot, end))
}

fn moved(end: &str) -> Option<SlotParameter> {
    ENDS.iter().find(|(known, _)| *known == end).map(|(_, what)| *what)
}

/// A tuning in semitones from the piece's own; that of a drum was in Hz.
fn tuned(kit: &KitSpec, slot: Slot, id: &str, value: StoredValue) -> StoredValue {
    let (Some(piece), StoredValue::Number(hertz)) = (kit.piece(slot), &value) else { return value };
    let [_, own, _] = piece.instrument.tunings();
    if piece.instrument.kind() != Kind::Drum {
        return value;
    }
    let (low, high, _) = range(slot_index(slot, SlotParameter::Tune), kit);
    let ([low, high], hertz) = ([low, high].map(f64::from), f64::from(*hertz));
    if !(low..=high).contains(&hertz) {
        warn!("The state has {id} at {hertz}, accepted: {low} to {high} Hz");
    }
    StoredValue::Number((12.0 * libm::log2(hertz.clamp(low, high) / own)) as f32)
}

/// Puts the pitch of a resonant head into the kit, unless it is the head's own.
fn set_resonant(kit: &mut KitSpec, slot: Slot, id: &str, value: &StoredValue) {
    let resonant = match kit.pieces.get_mut(slot.index()).map(|piece| &mut piece.instrument) {
        Some(InstrumentSpec::Drum(drum)) => drum.resonant.as_mut(),
        _ => None,
    };
    let (Some(resonant), StoredValue::Number(ratio)) = (resonant, value) else {
        warn!("The state has {id} as {value:?}: ignored");
        return;
    };
    let (least, most) = RATIOS;
    if ratio.is_nan() || *ratio == resonant.pitch_ratio as f32 {
        return;
    }
    if !(least..=most).contains(ratio) {
        warn!("The state has {id} at {ratio}, accepted: {least} to {most}");
    }
    resonant.pitch_ratio = f64::from(ratio.clamp(least, most));
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::super::{kit, put_in_order};
    use super::*;

    /// A state of the first schema with these values, as it is now.
    fn translated(values: &[(&str, f32)]) -> (BTreeMap<String, StoredValue>, KitDocument) {
        let values =
            values.iter().map(|(id, value)| ((*id).to_owned(), StoredValue::Number(*value))).collect();
        let fields = [(super::super::SCHEMA_FIELD.to_owned(), "1".to_owned())].into();
        let mut state = State { values, fields };
        put_in_order(&mut state);
        let document = kit(&state.fields).unwrap();
        (state.values, document)
    }

    #[test]
    fn everything_is_where_it_belongs_now() {
        let (values, document) = translated(&[
            ("kkmuff", 0.25),
            ("snprel", 0.15),
            ("snwire", 0.0),
            ("crtune", -3.0),
            ("rtplac", 0.1),
            ("ridestik", 1.0),
            ("rdstik", 3.0),
            ("hhpedl", 0.5),
            ("tppan", 20.0),
            ("master", -7.0),
            ("humpla", 2.0),
            ("workrs", 1.0),
        ]);
        for (id, value) in [
            ("01muff", 0.25),
            ("02prel", 0.15),
            ("02wire", 0.0),
            ("05tune", -3.0),
            ("03posn", 0.1),
            ("06stik", 3.0),
            ("09pedl", 0.5),
            ("08pan_", 20.0),
            ("master", -7.0),
            ("humpla", 2.0),
            ("workrs", 1.0),
        ] {
            let StoredValue::Number(found) = values[id] else { panic!("{id}") };
            assert!((found - value).abs() < 1e-6, "{id}: {found}");
        }
        assert_eq!(values.len(), crate::parameters::COUNT + 1);
        assert_eq!(document, KitDocument::standard());
    }

    #[test]
    fn drums_keep_their_pitch() {
        let kit = KitSpec::standard();
        for (start, name) in PIECES {
            let (slot, piece) = kit.find(name).unwrap();
            if piece.instrument.kind() != Kind::Drum {
                continue;
            }
            let [low, own, high] = piece.instrument.tunings();
            // As far as the parameter goes.
            let [low, high] = [low.max(0.5 * own), high.min(2.0 * own)];
            let now = |hertz: f64| {
                let (values, _) = translated(&[(&format!("{start}tune"), hertz as f32)]);
                let id = parameters()[slot_index(slot, SlotParameter::Tune)].id;
                let StoredValue::Number(semitones) = values[id] else { panic!("{id}") };
                own * f64::from(semitones / 12.0).exp2()
            };
            assert_eq!(now(own), own, "{name}");
            for hertz in [low, 0.5 * (low + own), 0.5 * (own + high), high] {
                assert!((now(hertz) / hertz - 1.0).abs() < 3e-5, "{name}: {} for {hertz}", now(hertz));
            }
            // What lay outside was brought to the end of the range.
            assert!((now(1e9) / high - 1.0).abs() < 3e-5 && (now(0.0) / low - 1.0).abs() < 3e-5, "{name}");
            assert_eq!(now(f64::NAN), own, "{name}");
        }
    }

    #[test]
    fn pitches_of_resonant_heads_are_in_the_kit() {
        let (_, document) = translated(&[("rtreso", 1.3), ("snreso", 1.5), ("kkreso", f32::NAN)]);
        let mut expected = KitDocument::standard();
        if let InstrumentSpec::Drum(drum) = &mut expected.kit.pieces[2].instrument {
            drum.resonant.as_mut().unwrap().pitch_ratio = f64::from(1.3_f32);
        }
        assert_eq!(document, expected, "at its default a head has its own ratio to the last bit");
    }
}
