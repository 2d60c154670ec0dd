//! Expressions of notes while they sound.

use nice_plug::wrapper::vst3::vst3::Steinberg::Vst::{NoteExpressionValueEvent, PolyPressureEvent};

use super::calls::Listed;
use super::*;
use crate::entry::clap::tests::expressions::{ALL, ID, Told, expressed};

/// The same as the other format has it, by its place among [`ALL`].
fn translated(place: usize, (_, value, sample): Told) -> Event {
    let expression = |kind: u32, value: f64| {
        let told = NoteExpressionValueEvent { typeId: kind, noteId: ID, value };
        event(
            sample,
            EventTypes_::kNoteExpressionValueEvent as u16,
            Event__type0 { noteExpressionValue: told },
        )
    };
    match place {
        0 => expression(0, value / 4.0),
        1 => expression(1, value),
        2 => expression(2, 0.5 + value / 240.0),
        3 => expression(5, value),
        _ => {
            let pressed = PolyPressureEvent { channel: 9, pitch: 38, pressure: value as f32, noteId: ID };
            event(sample, EventTypes_::kPolyPressureEvent as u16, Event__type0 { polyPressure: pressed })
        }
    }
}

#[test]
fn every_expression_sounds_as_in_the_other_format() {
    let plain = expressed(None, false);
    for (place, told) in ALL.into_iter().enumerate() {
        let note = NoteOnEvent { channel: 9, pitch: 38, tuning: 0.0, velocity: 0.8, length: 0, noteId: ID };
        let note = event(0, EventTypes_::kNoteOnEvent as u16, Event__type0 { noteOn: note });
        let list = ComWrapper::new(Listed(vec![note, translated(place, told)]));
        let events = list.to_com_ptr::<IEventList>().unwrap();
        // Outputs that are left out are in the main one.
        let vst3 = played(&multi(), events.as_ptr(), 1, |_, _| {}).remove(0);
        let clap = expressed(Some(told), false);
        let apart = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f32>();
        for side in 0..CHANNELS {
            let [difference, moved] = [&vst3[side], &plain[side]].map(|other| apart(other, &clap[side]));
            // Without the expression all of `moved` would be left.
            assert!(moved > 0.0 && difference <= 0.01 * moved, "{told:?}: {difference} of {moved}");
        }
    }
}
