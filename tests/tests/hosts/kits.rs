//! A kit of fourteen pieces in hosts: each piece at its own output, and the same bits again from what a project stores.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use overhear::kit_document::KitDocument;
use overhear::kit_file;
use overhear_cli::host::{Event, Instance, Processor, What, set_kit, with_fields};
use overhear_cli::player::{Blocks, Message, Setup, Source, Take};
use overhear_cli::plugin_folders::Format;
use overhear_engine::kit::OUTPUTS;
use overhear_engine::slot::Slot;

use crate::multi::multi;
use crate::score::{Happening, Score, Sound, assert_same, notes, on_a_kit, peak, through_plugin};
use crate::vst3::{Moves, Scratch, preset_file, through_pedalboard, through_vst3};
use crate::{Stop, alone, as_hosts_have_it, bundle_path, here, instance, setting};

const RATE: f64 = 48_000.0;

const FRAMES: usize = 4096;

fn fourteen() -> KitDocument {
    let document = kit_file::load(&here("../assets/kits/fourteen.toml")).expect("a kit");
    assert_eq!(document.kit.pieces.len(), 14);
    document
}

/// The note that stands for each piece of a kit.
fn ordinary_notes(document: &KitDocument) -> Vec<(Slot, u8)> {
    let note = |slot| document.notes.ordinary(slot).expect("a note for every piece");
    document.kit.slots().map(|(slot, _)| (slot, note(slot))).collect()
}

/// Every piece by itself, then all that the standard score has.
fn score(document: &KitDocument) -> Score {
    let each = ordinary_notes(document).into_iter().enumerate();
    let mut score: Score =
        each.map(|(at, (_, note))| (1_501 * at as u64, Happening::Note(note, 100))).collect();
    score.extend(notes(RATE));
    score.sort_by_key(|(sample, _)| *sample);
    score
}

/// Plays all pieces at once into every output, the main one first.
fn all_outputs(instance: &mut Instance, document: &KitDocument) -> Vec<Sound> {
    let notes = ordinary_notes(document).into_iter();
    let event = |(_, key)| Event { offset: 33, what: What::NoteOn { channel: 9, key, velocity: 0.8 } };
    let events: Vec<_> = notes.map(event).collect();
    instance.run(RATE, 1..=FRAMES as u32, |processor| heard(processor, &events)).expect("it plays")
}

fn heard(processor: &mut Processor, events: &[Event]) -> anyhow::Result<Vec<Sound>> {
    let mut sound = vec![[vec![f32::NAN; FRAMES], vec![f32::NAN; FRAMES]]; 1 + OUTPUTS];
    let mut ports: Vec<_> =
        sound.iter_mut().map(|port| port.each_mut().map(|channel| channel.as_mut_slice())).collect();
    processor.process_ports(events, &mut ports)?;
    Ok(sound)
}

#[test]
fn each_of_fourteen_pieces_is_heard_at_its_own_output_alone() {
    let _turn = alone();
    let document = fourteen();
    let mut instance = multi();
    set_kit(&mut instance, &document).unwrap();
    // Pieces that hear each other all sound.
    instance.set_parameters(&[as_hosts_have_it(setting("sympathetic_resonance=off"))]).unwrap();
    let play = |processor: &mut Processor| {
        for (struck, key) in ordinary_notes(&document) {
            processor.reset();
            let event = Event { offset: 7, what: What::NoteOn { channel: 9, key, velocity: 0.8 } };
            let sound = heard(processor, &[event])?;
            for (slot, output) in Slot::ALL.into_iter().zip(&sound[1..]) {
                assert_eq!(peak(output) > 0.0, slot == struck, "note {key} at the output of {slot:?}");
                assert!(slot != struck || peak(output) > 1e-3, "note {key}: {}", peak(output));
            }
        }
        Ok(())
    };
    instance.run(RATE, 1..=FRAMES as u32, play).unwrap();
}

#[test]
fn a_kit_of_fourteen_that_is_saved_and_opened_again_sounds_the_same_to_the_bit() {
    let _turn = alone();
    let document = fourteen();
    let mut saved = multi();
    set_kit(&mut saved, &document).unwrap();
    let moved = saved.parameters().unwrap()[0].id;
    saved.set_parameters(&[(moved, 0.6)]).unwrap();
    let state = saved.save_state().unwrap();
    let sound = all_outputs(&mut saved, &document);
    for slot in 0..document.kit.pieces.len() {
        assert!(peak(&sound[1 + slot]) > 1e-3, "slot {slot} is silent");
    }
    let mut opened = multi();
    opened.load_state(&state).unwrap();
    for (at, (found, expected)) in all_outputs(&mut opened, &document).iter().zip(&sound).enumerate() {
        assert_same(found, expected, &format!("output {at}"));
    }
    assert_eq!(opened.save_state().unwrap(), state);
    // And where another kit has played before.
    let mut other = multi();
    all_outputs(&mut other, &KitDocument::standard());
    other.load_state(&state).unwrap();
    for (at, (found, expected)) in all_outputs(&mut other, &document).iter().zip(&sound).enumerate() {
        assert_same(found, expected, &format!("output {at}, after another kit"));
    }
}

#[test]
fn fourteen_pieces_give_the_engine_s_samples_at_every_buffer_size() {
    let _turn = alone();
    let document = fourteen();
    let score = score(&document);
    let expected = on_a_kit(&document, &score, RATE);
    assert!(peak(&expected) > 0.01, "the engine is silent");
    let mut instance = instance();
    set_kit(&mut instance, &document).unwrap();
    for blocks in [Blocks::Fixed(17), Blocks::Fixed(512), Blocks::Random] {
        assert_same(&through_plugin(&mut instance, &score, RATE, blocks), &expected, &format!("{blocks:?}"));
    }
}

#[test]
fn a_file_rendered_on_fourteen_pieces_is_the_same_by_the_engine_and_by_clap() {
    let _turn = alone();
    let kit = fourteen();
    let hit = |(sample, what): (u64, Happening)| match what {
        Happening::Note(key, velocity) => Message::note(sample, 9, key, velocity),
        Happening::Parameter(..) => unreachable!("notes only"),
    };
    let take = Take { messages: score(&kit).into_iter().map(hit).collect(), frames: 24_000 };
    let setup = Setup { rate: RATE as u32, settings: vec![setting("dynamics=5")], kit };
    let render = |source: Source| {
        let mut sound = [Vec::new(), Vec::new()];
        let play = source.perform(&setup, |player| {
            take.play(player, Blocks::Fixed(512), |left, right| {
                sound[0].extend_from_slice(left);
                sound[1].extend_from_slice(right);
                Ok(())
            })
        });
        play.expect("it plays");
        sound
    };
    let engine = render(Source::Engine);
    assert!(peak(&engine) > 0.01);
    assert_same(&render(Source::Clap(bundle_path(Format::Clap))), &engine, "by CLAP");
}

#[test]
fn vst3_gives_the_samples_of_clap_on_fourteen_pieces_and_again_from_its_own_state() {
    let _turn = alone();
    let document = fourteen();
    let score = score(&document);
    let mut clap = instance();
    set_kit(&mut clap, &document).unwrap();
    let [preset, state] = ["fourteen.vstpreset", "fourteen.state"].map(Scratch::new);
    std::fs::write(&preset.0, preset_file(*b"OverhearDrumKit1", &clap.save_state().unwrap())).unwrap();
    let expected = through_plugin(&mut clap, &score, RATE, Blocks::Fixed(512));
    let moves = Moves { preset: Some(&preset.0), save: Some(&state.0), ..Moves::default() };
    assert_same(&through_vst3("fourteen", &score, &moves, RATE, 512), &expected, "from a preset");
    let moves = Moves { load: Some(&state.0), ..Moves::default() };
    assert_same(&through_vst3("fourteen-again", &score, &moves, RATE, 512), &expected, "from a state");
}

#[test]
fn vst3_with_inactive_outputs_gives_the_samples_of_clap_on_fourteen_pieces() {
    let _turn = alone();
    let document = fourteen();
    let score = score(&document);
    let mut clap = multi();
    set_kit(&mut clap, &document).unwrap();
    // Pedalboard says that it renders to a file.
    clap.set_offline().unwrap();
    let preset = Scratch::new("fourteen-multi.vstpreset");
    std::fs::write(&preset.0, preset_file(*b"OverhearDrumKitM", &clap.save_state().unwrap())).unwrap();
    let expected = through_plugin(&mut clap, &score, RATE, Blocks::Fixed(512));
    let name = overhear::MULTI_NAME;
    let found = through_pedalboard("fourteen-multi", name, Some(&preset.0), &score, RATE, 512);
    assert_same(&found, &expected, "beside inactive outputs");
}

#[test]
fn a_state_whose_kit_is_broken_changes_nothing() {
    let _turn = alone();
    let mut instance = instance();
    set_kit(&mut instance, &fourteen()).unwrap();
    let state = instance.save_state().unwrap();
    for broken in ["", "format = 9", "format = 1\n[pieces.kick]\ndiameter_in = 99\n", "nothing like a kit"] {
        let change = |fields: &mut serde_json::Map<String, serde_json::Value>| {
            fields.insert("kit".to_owned(), broken.into());
            fields.insert("notes".to_owned(), "38=49".into());
            Ok(())
        };
        // Whether a host is told is the framework's affair.
        let _ = instance.load_state(&with_fields(&state, change).unwrap());
        assert_eq!(instance.save_state().unwrap(), state, "{broken:?}");
    }
}

#[test]
fn kits_that_come_and_go_while_it_plays_end_in_the_last_one() {
    let _turn = alone();
    let document = fourteen();
    let mut kits = [multi(), multi()];
    set_kit(&mut kits[0], &document).unwrap();
    let states = kits.map(|mut instance| instance.save_state().unwrap());
    let mut instance = multi();
    let stop = AtomicBool::new(false);
    let fourteenth = Slot::ALL[13].index();
    let play = |processor: &mut Processor| {
        let (mut blocks, mut finite) = (0_usize, true);
        let notes = ordinary_notes(&document);
        while !stop.load(Ordering::Acquire) {
            let (_, key) = notes[blocks % notes.len()];
            let event = Event { offset: 5, what: What::NoteOn { channel: 9, key, velocity: 0.7 } };
            let sound = heard(processor, &[event])?;
            finite &= sound.iter().flatten().flatten().all(|sample| sample.is_finite());
            blocks += 1;
        }
        processor.reset();
        let (_, key) = notes[fourteenth];
        let event = Event { offset: 5, what: What::NoteOn { channel: 9, key, velocity: 0.7 } };
        let last = heard(processor, &[event])?;
        Ok((blocks, finite, peak(&last[1 + fourteenth])))
    };
    let change = |instance: &mut Instance| {
        let _stop = Stop(&stop);
        for round in 0..5 {
            instance.load_state(&states[round % 2])?;
            let begun = Instant::now();
            while begun.elapsed() < Duration::from_millis([1500, 50, 700][round % 3]) {
                instance.answer();
                std::thread::sleep(Duration::from_millis(5));
            }
        }
        // Until all pieces have been built.
        std::thread::sleep(Duration::from_secs(10));
        Ok(())
    };
    let (blocks, finite, last) = instance.run_beside(RATE, 1..=FRAMES as u32, play, change).unwrap();
    assert!(finite && blocks > 10, "{blocks} blocks");
    assert!(last > 1e-3, "the last piece is silent");
    assert_eq!(instance.save_state().unwrap(), states[0]);
}
