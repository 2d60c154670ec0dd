//! The instrument with an output for every slot and each pair of microphones.

use overhear_cli::host::{Bundle, Event, Instance, What};
use overhear_cli::player::Blocks;
use overhear_cli::plugin_folders::Format;
use overhear_engine::kit::OUTPUTS;
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::slot::Slot;

use crate::score::{assert_same, notes, through_plugin};
use crate::vst3::through_pedalboard;
use crate::{alone, as_hosts_have_it, bundle_path, instance, setting};

const RATE: f64 = 48_000.0;

const FRAMES: usize = 4096;

/// An instance of it.
pub fn multi() -> Instance {
    let bundle = Bundle::load(&bundle_path(Format::Clap)).expect("a CLAP bundle");
    bundle.instantiate_id(overhear::MULTI_CLAP_ID).expect("an instance")
}

/// Strikes snare and ride in the middle of a buffer with so many outputs.
fn struck(instance: &mut Instance, outputs: usize) -> Vec<[Vec<f32>; 2]> {
    let events = [(100, 38), (700, 51)]
        .map(|(offset, key)| Event { offset, what: What::NoteOn { channel: 9, key, velocity: 0.9 } });
    instance
        .run(RATE, 1..=FRAMES as u32, |processor| {
            let mut sound = vec![[vec![f32::NAN; FRAMES], vec![f32::NAN; FRAMES]]; outputs];
            let mut ports: Vec<_> =
                sound.iter_mut().map(|port| port.each_mut().map(|channel| channel.as_mut_slice())).collect();
            processor.process_ports(&events, &mut ports)?;
            Ok(sound)
        })
        .unwrap()
}

#[test]
fn its_outputs_are_the_mix_every_slot_by_the_standard_kit_s_piece_and_the_pairs_of_microphones() {
    let _turn = alone();
    let (outputs, kit) = (multi().audio_outputs().unwrap(), KitSpec::standard());
    assert_eq!(outputs.len(), 1 + OUTPUTS);
    assert!(outputs.iter().all(|port| port.channels == 2));
    let titles = Slot::ALL.map(|slot| match kit.piece(slot) {
        Some(piece) => piece.title.clone(),
        None => format!("Slot {}", slot.index() + 1),
    });
    let pairs = ["Overheads", "Room"].map(str::to_owned);
    for (port, title) in outputs[1..].iter().zip(titles.into_iter().chain(pairs)) {
        assert_eq!(port.name, title);
    }
}

#[test]
fn every_piece_is_at_its_own_output_and_all_together_are_the_mix() {
    let _turn = alone();
    let mut instance = multi();
    // Pieces that hear each other all sound.
    let off = as_hosts_have_it(setting("sympathetic_resonance=off"));
    instance.set_parameters(&[off]).unwrap();
    let (sound, kit) = (struck(&mut instance, 1 + OUTPUTS), KitSpec::standard());
    for (slot, output) in Slot::ALL.into_iter().zip(&sound[1..]) {
        let heard = output.iter().flatten().any(|sample| *sample != 0.0);
        let name = kit.piece(slot).map_or("", |piece| &piece.name);
        assert_eq!(heard, ["snare", "ride"].contains(&name), "{slot:?}: {name}");
    }
    for pair in &sound[OUTPUTS - 1..] {
        assert!(pair.iter().flatten().any(|sample| *sample != 0.0), "a pair of microphones hears nothing");
    }
    assert!(
        sound[0].iter().flatten().all(|sample| *sample == 0.0),
        "what has an output is not at the main one"
    );
    is_the_mix(&sound, &struck(&mut instance, 1)[0]);
}

/// All outputs together are the mix: a host that sums them plays it once.
#[track_caller]
fn is_the_mix(sound: &[[Vec<f32>; 2]], mix: &[Vec<f32>; 2]) {
    for (channel, mix) in mix.iter().enumerate() {
        for (at, mixed) in mix.iter().enumerate() {
            let sum: f32 = sound.iter().map(|output| output[channel][at]).sum();
            assert!((sum - mixed).abs() < 1e-5, "sample {at}: {sum} for {mixed}");
        }
    }
}

#[test]
fn fewer_outputs_than_declared_leave_the_rest_at_the_main_one() {
    let _turn = alone();
    let mut instance = multi();
    let whole = struck(&mut instance, 1 + OUTPUTS);
    let mix = struck(&mut instance, 1).remove(0);
    assert_same(&mix, &struck(&mut crate::instance(), 1)[0], "the main output alone");
    for outputs in [2, 5, OUTPUTS] {
        let sound = struck(&mut instance, outputs);
        assert!(sound[1..] == whole[1..outputs], "{outputs} outputs");
        is_the_mix(&sound, &mix);
    }
}

#[test]
fn its_mix_is_that_of_the_stereo_instrument() {
    let _turn = alone();
    let score = notes(RATE);
    let mix = through_plugin(&mut instance(), &score, RATE, Blocks::Random);
    // The player gives one output only.
    assert_same(&through_plugin(&mut multi(), &score, RATE, Blocks::Random), &mix, "the mix");
}

#[test]
fn vst3_with_inactive_outputs_gives_the_samples_of_clap() {
    let _turn = alone();
    let score = notes(RATE);
    let mut instance = multi();
    // Pedalboard says that it renders to a file.
    instance.set_offline().unwrap();
    let clap = through_plugin(&mut instance, &score, RATE, Blocks::Fixed(512));
    let vst3 = through_pedalboard("multi", overhear::MULTI_NAME, None, &score, RATE, 512);
    assert_same(&vst3, &clap, "beside inactive outputs");
}
