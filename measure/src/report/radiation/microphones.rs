//! What microphones hear of one piece of the kit from where they stand.

use std::f64::consts::PI;

use crate::spectra::PowerSpectrum;
use crate::{alone, build, decibels, kit_of, reference, spec, stroke};
use overhear_engine::air_load::SPEED_OF_SOUND;
use overhear_engine::kit::{Control, Microphone, OUTPUTS, Stereo};
use overhear_engine::kit_spec::PieceSpec;
use overhear_engine::piece::BuildOptions;
use overhear_engine::receiver::ReceiverPosition;
use overhear_engine::slot::SLOTS;
use overhear_engine::strike::{Strike, Striker};

use crate::hear::ALONE;
use crate::report::page::bodies::{FIXED_DISC, PLAYED};

/// Outputs of a kit of one piece: its own, the overheads', the room's.
pub const CLOSE: usize = ALONE.index();
/// See [`CLOSE`].
pub const OVERHEADS: usize = SLOTS;
/// See [`CLOSE`].
pub const ROOM: usize = OVERHEADS + 1;

/// Reverberation time of a room in which only direct sound counts, s.
const DEAD: f64 = 0.05;

/// A kit of one piece in a dead room, struck, both pairs so far (m) over its middle: every microphone's left output.
fn play(piece: &PieceSpec, rate: f64, strike: &Strike, height: f64, frames: usize) -> Vec<Vec<f32>> {
    let mut spec = alone(piece);
    spec.room.time = DEAD;
    let mut kit = kit_of(&spec, rate);
    let [x, y, z] = piece.place.centre;
    for pair in [Microphone::Overheads, Microphone::Room] {
        kit.place(pair, [[x, y + height, z]; 2]);
        kit.set(Control::Balance(pair), 0.0);
    }
    kit.finish_controls();
    kit.strike(ALONE, strike);
    let mut buffers = vec![[vec![0.0_f32; frames], vec![0.0_f32; frames]]; OUTPUTS + 1];
    let mut outputs: Vec<Stereo<'_>> =
        buffers.iter_mut().map(|pair| pair.each_mut().map(|side| &mut side[..])).collect();
    let (main, microphones) = outputs.split_at_mut(1);
    kit.render_outputs(main[0].each_mut().map(|side| &mut **side), microphones);
    buffers.into_iter().skip(1).map(|[left, _]| left).collect()
}

/// The rack tom of the standard kit, and the same with a fixed disc under the stick, whose strokes are less bright; both at
/// the same microphones.
pub fn rack_toms() -> [(PieceSpec, &'static str); 2] {
    let played = spec("rack-tom");
    let fixed_disc = PieceSpec { close: played.close, ..reference::fixed_disc_rack_tom() };
    [(played, PLAYED), (fixed_disc, FIXED_DISC)]
}

/// A stroke on a drum at every output, the pairs and the close microphone so far (m) from its middle.
pub fn heard(drum: &PieceSpec, distance: f64, rate: f64) -> Vec<Vec<f32>> {
    let point = ReceiverPosition { distance, inclination: 0.3, azimuth: 0.4 };
    let close = drum.close.moved_to(point, drum.instrument.radius());
    let drum = PieceSpec { close, ..drum.clone() };
    let strike = stroke(Striker::Stick, 4.0, 0.5, 0.3);
    play(&drum, rate, &strike, distance, (0.03 * rate) as usize)
}

/// A sound between its samples (Shannon, under a window).
fn between(sound: &[f32], at: f64) -> f64 {
    const REACH: i64 = 24;
    let near = at.floor() as i64;
    let terms = (near - REACH + 1..=near + REACH).map(|i| {
        let x = PI * (at - i as f64);
        let sinc = if x.abs() < 1e-9 { 1.0 } else { x.sin() / x };
        let window = (0.5 * x / REACH as f64).cos().max(0.0).powi(2);
        let sample = usize::try_from(i).ok().and_then(|i| sound.get(i)).copied().unwrap_or(0.0);
        f64::from(sample) * sinc * window
    });
    terms.sum()
}

/// How far `later` is from `weaker` times what `sound` was so many samples before, until some time, share of its size.
fn difference(sound: &[f32], later: &[f32], delay: f64, weaker: f64, until: usize) -> f64 {
    let (mut off, mut size) = (0.0, 0.0);
    for (i, &x) in later[..until].iter().enumerate() {
        let expected = weaker * between(sound, i as f64 - delay);
        off += (f64::from(x) - expected).powi(2);
        size += expected * expected;
    }
    (off / size).sqrt()
}

/// How far what is heard farther off is from what was heard nearer, delayed and weaker by the distance; shares of its size.
#[derive(Debug, Clone, Copy)]
pub struct Farther {
    /// 34.3 cm farther: a millisecond later.
    pub later: f64,
    /// The same, if a sample less or more is expected: the lesser of the two, to tell that the measure sees one.
    pub a_sample_off: f64,
    /// Twice as far: half.
    pub doubled: f64,
}

/// Moves a microphone of a drum away from a distance (m) and compares the sound of the first `seconds`.
pub fn farther(drum: &PieceSpec, output: usize, (distance, seconds): (f64, f64), rate: f64) -> Farther {
    let [near, later, half] = [distance, distance + 0.343, 2.0 * distance]
        .map(|distance| heard(drum, distance, rate).swap_remove(output));
    let until = (seconds * rate) as usize;
    let moved =
        |extra: f64| difference(&near, &later, 1e-3 * rate + extra, distance / (distance + 0.343), until);
    Farther {
        later: moved(0.0),
        a_sample_off: moved(1.0).min(moved(-1.0)),
        doubled: difference(&near, &half, distance / SPEED_OF_SOUND * rate, 0.5, until),
    }
}

/// Level of a line over all between 20 Hz and 1 kHz, dB.
fn line(sound: &[f32], rate: f64, hz: f64) -> f64 {
    let from = (0.05 * rate) as usize;
    let spectrum = PowerSpectrum::hann(&sound[from..], rate);
    decibels(spectrum.band(hz - 3.0, hz + 3.0).sqrt(), spectrum.band(20.0, 1000.0).sqrt())
}

/// How much of the whole the modes (2,1) and (3,1) of a drum made perfectly round are in its close microphone, in the
/// overheads a metre above it and in the room's pair there, dB.
///
/// # Panics
/// If it has no such modes.
pub fn near_field(drum: &PieceSpec, rate: f64) -> [[f64; 3]; 2] {
    let drum = drum.clone().round();
    let modes = build(&drum, &BuildOptions::new(rate)).modes();
    let strike = stroke(Striker::Stick, 4.0, 0.6, 2.5);
    let sound = play(&drum, rate, &strike, 1.0, rate as usize);
    [2, 3].map(|m| {
        let of_batter = modes.iter().find(|mode| (mode.body, mode.m, mode.n) == ("batter", m, 1));
        let hz = of_batter.expect("a mode").frequency_hz;
        [CLOSE, OVERHEADS, ROOM].map(|output| line(&sound[output], rate, hz))
    })
}
