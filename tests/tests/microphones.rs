//! Microphones hear what their place gives them.

use std::f64::consts::PI;

use overhear_engine::air::SPEED_OF_SOUND;
use overhear_engine::kit::{Control, Kit, Microphone, OUTPUTS, Stereo};
use overhear_engine::listening::ListeningPoint;
use overhear_engine::piece::{BuildOptions, PieceId};
use overhear_engine::strike::{Strike, Striker};
use overhear_tests::{Spectrum, build, decibels, stroke};

const RACK_TOM: usize = 2;
const OVERHEADS: usize = PieceId::KIT.len();
const ROOM: usize = OVERHEADS + 1;

/// A kit with one piece, struck; every microphone's left output.
fn play(id: PieceId, options: &BuildOptions, strike: &Strike, height: f64, frames: usize) -> Vec<Vec<f32>> {
    let mut kit = Kit::new(options.sample_rate);
    assert!(kit.install(Box::new(build(id, options))).is_none());
    let [x, y, z] = kit.layout().pieces[id.slot().expect("of the kit")].centre;
    for pair in [Microphone::Overheads, Microphone::Room] {
        kit.place(pair, [[x, y + height, z]; 2]);
        kit.set(Control::Balance(pair), 0.0);
    }
    kit.finish_controls();
    kit.strike(id, strike);
    let mut buffers = vec![[vec![0.0_f32; frames], vec![0.0_f32; frames]]; OUTPUTS + 1];
    let mut outputs: Vec<Stereo<'_>> =
        buffers.iter_mut().map(|pair| pair.each_mut().map(|side| &mut side[..])).collect();
    let (main, microphones) = outputs.split_at_mut(1);
    kit.render_outputs(main[0].each_mut().map(|side| &mut **side), microphones);
    buffers.into_iter().skip(1).map(|[left, _]| left).collect()
}

/// A rack tom's stroke at every output, the pairs and the close microphone so far (m) from its middle.
fn heard(distance: f64, rate: f64) -> Vec<Vec<f32>> {
    let close = Some(ListeningPoint { distance, inclination: 0.3, azimuth: 0.4 });
    let options = BuildOptions { close, ..BuildOptions::new(rate) };
    let strike = stroke(Striker::Stick, 4.0, 0.5, 0.3);
    play(PieceId::RackTom, &options, &strike, distance, (0.03 * rate) as usize)
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

#[test]
fn a_microphone_34_3_cm_farther_hears_a_millisecond_later_and_one_twice_as_far_half_at_every_rate() {
    for rate in [44_100.0, 48_000.0, 96_000.0] {
        let [one, later_than_one, two, four, later_than_four, eight] =
            [0.6, 0.943, 1.2, 4.0, 4.343, 8.0].map(|distance| heard(distance, rate));
        // The pairs until the room's first echoes, of the floor, arrive. A drum is no point, and its
        // other head is farther: a close microphone hears that up to some metres. Ways of a broken number of samples lose some
        // of a stroke's first highs, the most at 44.1 kHz.
        let pairs = (0.6, [&one, &later_than_one, &two], 0.005, 0.03);
        let alone = (4.0, [&four, &later_than_four, &eight], 0.03, 0.03);
        for (output, name, of) in
            [(RACK_TOM, "close", alone), (OVERHEADS, "overheads", pairs), (ROOM, "room", pairs)]
        {
            let (distance, [near, later, half], seconds, tolerance) = of;
            let until = (seconds * rate) as usize;
            let millisecond = 1e-3 * rate;
            let moved = |extra: f64| {
                difference(
                    &near[output],
                    &later[output],
                    millisecond + extra,
                    distance / (distance + 0.343),
                    until,
                )
            };
            let delay = distance / SPEED_OF_SOUND * rate;
            let doubled = difference(&near[output], &half[output], delay, 0.5, until);
            println!("{name} at {rate} Hz: {:.4} off, twice as far {doubled:.4} off", moved(0.0));
            assert!(moved(0.0) < tolerance && doubled < tolerance, "{name} at {rate} Hz");
            assert!(moved(1.0) > 3.0 * moved(0.0) && moved(-1.0) > 3.0 * moved(0.0), "{name} at {rate} Hz");
        }
    }
}

/// Level of a line over all between 20 Hz and 1 kHz, dB.
fn line(sound: &[f32], rate: f64, hz: f64) -> f64 {
    let from = (0.05 * rate) as usize;
    let spectrum = Spectrum::hann(&sound[from..], rate);
    decibels(spectrum.band(hz - 3.0, hz + 3.0).sqrt(), spectrum.band(20.0, 1000.0).sqrt())
}

#[test]
fn a_close_microphone_hears_modes_that_overheads_and_room_do_not() {
    const RATE: f64 = 44_100.0;
    for (id, striker) in [(PieceId::RackTom, Striker::Stick), (PieceId::FloorTom, Striker::Stick)] {
        let options = BuildOptions { unsplit: true, ..BuildOptions::in_kit(id, RATE) };
        let modes = build(id, &options).modes();
        let strike = stroke(striker, 4.0, 0.6, 2.5);
        let sound = play(id, &options, &strike, 1.0, RATE as usize);
        let close = id.slot().expect("of the kit");
        for (m, least) in [(2, 6.0), (3, 15.0)] {
            let of_batter = modes.iter().find(|mode| (mode.body, mode.m, mode.n) == ("batter", m, 1));
            let hz = of_batter.expect("a mode").frequency_hz;
            let levels = [close, OVERHEADS, ROOM].map(|output| line(&sound[output], RATE, hz));
            println!("{id:?} ({m}, 1), {hz:.0} Hz: close, overheads, room {levels:.1?} dB of the whole");
            assert!(levels[0] > levels[1] + least && levels[0] > levels[2] + least, "{id:?}: {levels:?}");
        }
    }
}
