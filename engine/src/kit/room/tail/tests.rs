use std::f64::consts::TAU;

use super::*;
use crate::kit_spec::room::OCTAVE_HZ;

const RATE: f64 = 44_100.0;

/// What both sides hear of an impulse.
fn impulse(room: &RoomSpec, rate: f64, seconds: f64) -> [Vec<f64>; 2] {
    let mut tail = Tail::new(room, rate);
    let mut response = [Vec::new(), Vec::new()];
    while (response[0].len() as f64) < seconds * rate {
        let mut sound = SILENT_RUN;
        sound[0] = f32::from(u8::from(response[0].is_empty()));
        let mut sides = [SILENT_RUN; 2];
        let [left, right] = &mut sides;
        tail.render([&sound; 2], [left, right]);
        for (response, side) in response.iter_mut().zip(sides) {
            response.extend(side.map(f64::from));
        }
    }
    response
}

/// An octave of a sound: two band passes of second order on end, whose middle passes as it is.
fn octave(sound: &[f64], hz: f64, rate: f64) -> Vec<f64> {
    let angle = TAU * hz / rate;
    let alpha = angle.sin() / (2.0 * 1.8);
    let pass = |sound: &[f64]| {
        let (mut x, mut y) = ([0.0; 2], [0.0; 2]);
        let next = |&now: &f64| {
            let out =
                (alpha * (now - x[1]) + 2.0 * angle.cos() * y[0] - (1.0 - alpha) * y[1]) / (1.0 + alpha);
            (x, y) = ([now, x[0]], [out, y[0]]);
            out
        };
        sound.iter().map(next).collect::<Vec<f64>>()
    };
    pass(&pass(sound))
}

fn energy(sound: &[f64]) -> f64 {
    sound.iter().map(|x| x * x).sum()
}

fn between(sound: &[f64], seconds: std::ops::Range<f64>, rate: f64) -> &[f64] {
    &sound[(seconds.start * rate) as usize..(seconds.end * rate) as usize]
}

/// Reverberation time, s, over 40 dB from 60 ms on: the slope of the energy that is still to come.
fn time_of(sound: &[f64], rate: f64) -> f64 {
    let mut left = 0.0;
    let mut to_come: Vec<f64> = sound.iter().rev().map(|x| (left += x * x, left).1).collect();
    to_come.reverse();
    let from = (0.06 * rate) as usize;
    let to = from + to_come[from..].iter().position(|x| *x < 1e-4 * to_come[from]).unwrap();
    60.0 / 40.0 * (to - from) as f64 / rate
}

#[test]
fn the_tail_is_as_long_and_as_loud_as_sabines_room_in_every_octave() {
    let long =
        RoomSpec { time: 1.0, octaves: [0.7, 0.8, 0.9, 1.0, 1.1, 1.0, 0.8, 0.6, 0.4], ..RoomSpec::STANDARD };
    let large = RoomSpec { corners: [[-6.0, 0.0, -7.0], [6.0, 5.0, 7.0]], time: 0.8, ..RoomSpec::STANDARD };
    for (room, rate) in
        [(RoomSpec::STANDARD, RATE), (RoomSpec::STANDARD, 96_000.0), (long, RATE), (large, RATE)]
    {
        let response = impulse(&room, rate, 3.0 * room.time + 0.3);
        let unit: Vec<f64> = std::iter::once(1.0).chain(std::iter::repeat_n(0.0, 8_192)).collect();
        for (hz, time) in OCTAVE_HZ.into_iter().zip(room.times()) {
            let sabine = 16.0 * PI / (0.161 * room.volume() / time) * energy(&octave(&unit, hz, rate));
            let sides = response.each_ref().map(|side| octave(side, hz, rate));
            let both = |measure: &dyn Fn(&[f64]) -> f64| 0.5 * (measure(&sides[0]) + measure(&sides[1]));
            let whole = 10.0 * (both(&energy) / sabine).log10();
            // From six mean free times on, as if all of it had come out at once.
            let late = 6.0 * room.mean_way() / SPEED_OF_SOUND;
            let expected = sabine * 10.0_f64.powf(-6.0 * late / time);
            let end = response[0].len() as f64 / rate - 1e-3;
            let late = both(&|side| energy(between(side, late..end, rate)));
            let late = 10.0 * (late / expected).log10();
            let measured = both(&|side| time_of(side, rate));
            println!(
                "{rate} {hz:5} Hz: {measured:.3} s of {time:.3}, whole {whole:+.1} dB, late {late:+.1} dB"
            );
            assert!((measured / time - 1.0).abs() < 0.12, "{hz} Hz: {measured} s for {time}");
            assert!(whole.abs() < 3.0, "{hz} Hz: {whole} dB");
            // Two octaves have few modes; the highest one is weakened at the ends of the lines alone.
            let within = if (200.0..10_000.0).contains(&hz) { 1.8 } else { 6.0 };
            assert!(late.abs() < within, "{hz} Hz: {late} dB");
        }
    }
}

/// Share of samples beyond their standard deviation, over that of Gaussian noise, in 20 ms about a moment.
fn echo_density(sound: &[f64], at: f64) -> f64 {
    const GAUSSIAN: f64 = 0.317_310_5;
    let window = between(sound, at - 0.01..at + 0.01, RATE);
    let deviation = (energy(window) / window.len() as f64).sqrt();
    window.iter().filter(|x| x.abs() > deviation).count() as f64 / window.len() as f64 / GAUSSIAN
}

#[test]
fn after_fifty_milliseconds_no_echo_is_told_from_the_next() {
    for side in impulse(&RoomSpec::STANDARD, RATE, 0.4) {
        let density: Vec<f64> = (1..30).map(|k| echo_density(&side, 0.01 * f64::from(k))).collect();
        println!("{density:.2?}");
        let dense = density.iter().position(|&x| x > 0.9).unwrap();
        assert!(dense < 5 && density[dense..].iter().all(|&x| x > 0.8), "{density:?}");
    }
}

/// Standard deviation of the fine spectrum, dB, of a third of an octave in 250 ms.
fn fine_spectrum(sound: &[f64], hz: f64) -> f64 {
    let count = sound.len() as f64;
    let step = RATE / count;
    let (first, last) = ((hz / 1.1225 / step) as u32, (hz * 1.1225 / step) as u32);
    let lines: Vec<f64> = (first..=last)
        .map(|k| {
            // Goertzel, with Hann's window.
            let angle = TAU * f64::from(k) / count;
            let turn = 2.0 * angle.cos();
            let (mut a, mut b) = (0.0, 0.0);
            for (i, x) in sound.iter().enumerate() {
                (a, b) = (x * (0.5 - 0.5 * (TAU * i as f64 / count).cos()) + turn * a - b, a);
            }
            10.0 * (a * a + b * b - turn * a * b).log10()
        })
        .collect();
    let mut sorted = lines.clone();
    sorted.sort_by(f64::total_cmp);
    let median = sorted[sorted.len() / 2];
    let off: Vec<f64> = lines.iter().map(|x| (x - median).max(-12.0)).collect();
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    (off.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / off.len() as f64).sqrt()
}

#[test]
fn the_tail_is_no_comb_but_as_dense_as_noise_in_every_third_octave() {
    let response = impulse(&RoomSpec::STANDARD, RATE, 0.6);
    let (mut draw, mut noise) = (fastrand::Rng::with_seed(1), Vec::new());
    for i in 0..response[0].len() {
        let fallen = 10.0_f64.powf(-3.0 * i as f64 / RATE / RoomSpec::STANDARD.time);
        noise.push(fallen * (2.0 * draw.f64() - 1.0));
    }
    let spread = |sound: &[f64], hz| {
        let windows = [0.03, 0.12, 0.21].map(|at| fine_spectrum(between(sound, at..at + 0.25, RATE), hz));
        windows.iter().sum::<f64>() / 3.0
    };
    let mut worst = 0.0_f64;
    for third in -5..=11 {
        let hz = 1_000.0 * (f64::from(third) / 3.0).exp2();
        let tail = 0.5 * (spread(&response[0], hz) + spread(&response[1], hz));
        println!("{hz:6.0} Hz: {tail:.2} dB, noise {:.2} dB", spread(&noise, hz));
        worst = worst.max(tail);
    }
    assert!(worst < 5.6, "{worst} dB");
}

#[test]
fn no_rhythm_is_left_in_the_tail() {
    for side in impulse(&RoomSpec::STANDARD, RATE, 0.4) {
        let window = between(&side, 0.05..0.25, RATE);
        // As loud throughout as at its beginning.
        let window: Vec<f64> = window
            .iter()
            .enumerate()
            .map(|(i, x)| x * 10.0_f64.powf(3.0 * i as f64 / RATE / RoomSpec::STANDARD.time))
            .collect();
        let like = |lag: usize| window.iter().zip(&window[lag..]).map(|(a, b)| a * b).sum::<f64>();
        let same = like(0);
        let most = (40..4_000).map(|lag| (like(lag) / same).abs()).fold(0.0, f64::max);
        println!("most like itself: {most:.3}");
        assert!(most < 0.12, "{most}");
    }
}

#[test]
fn left_and_right_hear_different_tails() {
    let [left, right] = impulse(&RoomSpec::STANDARD, RATE, 0.5);
    let both: f64 = left.iter().zip(&right).map(|(a, b)| a * b).sum();
    let alike = both / (energy(&left) * energy(&right)).sqrt();
    println!("correlation {alike:.3}");
    assert!(alike.abs() < 0.1, "{alike}");
}

#[test]
fn at_every_rate_and_in_every_room_there_are_enough_modes_per_hertz() {
    let tiny = RoomSpec { corners: [[-1.0, 0.0, -1.0], [1.0, 2.0, 1.0]], ..RoomSpec::STANDARD };
    for room in [RoomSpec::STANDARD, tiny] {
        for rate in [8_000.0, 44_100.0, 48_000.0, 88_200.0, 96_000.0, 192_000.0] {
            let tail = Tail::new(&room, rate);
            let lengths: Vec<usize> = [&tail.long, &tail.short]
                .iter()
                .flat_map(|lines| lines.lines.iter().map(|x| x.len()))
                .collect();
            let density = lengths.iter().sum::<usize>() as f64 / rate;
            println!("{rate}: {density:.3} modes per hertz");
            assert!(density > 0.6, "{density}");
            for (i, &a) in lengths.iter().enumerate() {
                assert!(a >= BLOCK && is_prime(a) && a % 2 == 1 && !lengths[..i].contains(&a), "{lengths:?}");
            }
        }
    }
}

#[test]
fn the_matrix_keeps_energy() {
    let mut runs = [SILENT_RUN; LINES];
    runs.iter_mut().flatten().enumerate().for_each(|(i, x)| *x = (i as f32 * 0.7).sin());
    let sum = |runs: &Runs| runs.iter().flatten().map(|&x| f64::from(x).powi(2)).sum::<f64>();
    let before = sum(&runs);
    hadamard(&mut runs);
    assert!((sum(&runs) / before / (SCALE * SCALE) - 1.0).abs() < 1e-6);
}

#[test]
fn the_tail_is_the_same_however_time_is_cut_and_ends_in_exact_silence() {
    let cuts = [[32_usize; 4], [1, 31, 7, 25], [3, 5, 32, 24]];
    let response = cuts.map(|cuts| {
        let mut tail = Tail::new(&RoomSpec::STANDARD, RATE);
        let (mut response, mut cut) = (Vec::new(), cuts.into_iter().cycle());
        while response.len() < 40_000 {
            let samples = cut.next().unwrap();
            let at = response.len();
            let sound: Vec<f32> =
                (at..at + samples).map(|i| if i < 500 { (i as f32).sin() } else { 0.0 }).collect();
            let mut sides = [SILENT_RUN; 2];
            let [left, right] = &mut sides;
            tail.render([&sound; 2], [&mut left[..samples], &mut right[..samples]]);
            response.extend_from_slice(&sides[0][..samples]);
        }
        response.truncate(40_000);
        // Silent some time later, and then exactly.
        let mut blocks = 0;
        while !tail.is_silent() {
            tail.render([&SILENT_RUN; 2], [&mut SILENT_RUN.clone(), &mut SILENT_RUN.clone()]);
            tail.settle();
            blocks += 1;
            assert!(blocks < 2_000);
        }
        assert!(tail.long.are_quiet(f32::MIN_POSITIVE) && tail.weakening.last == [0.0; LINES]);
        response
    });
    let bits = response.map(|response| response.into_iter().map(f32::to_bits).collect::<Vec<_>>());
    assert!(bits[0] == bits[1] && bits[0] == bits[2]);
}
