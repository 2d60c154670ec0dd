//! The instrument with an output for every piece.

use overhear::parameters::{find, host_id};
use overhear_engine::piece::PieceId;
use xtask::host::{Bundle, Event, Instance, What};
use xtask::player::Blocks;
use xtask::workspace::Format;

use crate::score::{assert_same, notes, through_plugin};
use crate::vst3::through_pedalboard;
use crate::{alone, bundle_path, instance};

const RATE: f64 = 48_000.0;

const FRAMES: usize = 4096;

fn multi() -> Instance {
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
fn its_outputs_are_the_mix_and_every_piece_by_name() {
    let _turn = alone();
    let outputs = multi().audio_outputs().unwrap();
    assert_eq!(outputs.len(), 1 + PieceId::KIT.len());
    assert!(outputs.iter().all(|port| port.channels == 2));
    for (port, piece) in outputs[1..].iter().zip(PieceId::KIT) {
        assert_eq!(port.name.to_lowercase().replace(' ', "-"), piece.name());
    }
}

#[test]
fn every_piece_is_at_its_own_output_and_all_are_the_mix() {
    let _turn = alone();
    let mut instance = multi();
    // The mix has the overheads and the room besides, and pieces that hear each other all sound.
    let off = ["overheads_level", "room_level", "hearing"].map(|name| {
        let (_, parameter) = find(name).unwrap();
        (host_id(parameter.id), f64::from(parameter.normalized(parameter.min)))
    });
    instance.set_parameters(&off).unwrap();
    let sound = struck(&mut instance, 1 + PieceId::KIT.len());
    for (piece, output) in PieceId::KIT.into_iter().zip(&sound[1..]) {
        let heard = output.iter().flatten().any(|sample| *sample != 0.0);
        assert_eq!(heard, matches!(piece, PieceId::Snare | PieceId::Ride), "{piece:?}");
    }
    // The master stands between the pieces and the mix, at -4 dB.
    let master = 10.0_f32.powf(-4.0 / 20.0);
    for (channel, mix) in sound[0].iter().enumerate() {
        for (at, mixed) in mix.iter().enumerate() {
            let sum: f32 = sound[1..].iter().map(|output| output[channel][at]).sum();
            assert!((sum * master - mixed).abs() < 1e-5, "sample {at}: {sum} in {mixed}");
        }
    }
}

#[test]
fn fewer_outputs_than_declared_change_nothing_at_those_there_are() {
    let _turn = alone();
    let mut instance = multi();
    let whole = struck(&mut instance, 1 + PieceId::KIT.len());
    for outputs in [1, 2, 5] {
        assert!(struck(&mut instance, outputs)[..] == whole[..outputs], "{outputs} outputs");
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
    let vst3 = through_pedalboard("multi", overhear::MULTI_NAME, &score, RATE, 512);
    assert_same(&vst3, &clap, "beside inactive outputs");
}
