use nalgebra::Complex;

use super::sounding_plate::SoundingPlate;
use super::*;
use crate::air_load::SPEED_OF_SOUND;
use crate::block::{BLOCK, FOLLOWED};
use crate::build_context::BuildOptions;
use crate::modal::RECEIVERS;
use crate::plate::PlateTables;
use crate::plate::free_disc::FreeDisc;
use crate::radiation::Radiator;
use crate::receiver::POINTS;
use crate::reference;
use crate::strike::{Strike, Striker};
use crate::surface::direct_sound::DirectSound;

const RATE: f64 = 44_100.0;

/// A cymbal that is struck, held by a moving hand that then closes firmly, and let go: its sound and its energy after each
/// block. The modes follow the hand once in `every` blocks.
fn choked(name: &str, every: usize) -> (Vec<f32>, Vec<f64>) {
    let context = reference::standard(name).context(BuildOptions::new(RATE));
    let mut cymbal = Cymbal::new(&reference::cymbal(name), &context).unwrap();
    cymbal.strike(&Strike { striker: Striker::Stick, speed: 5.0, radius: 0.9, angle: 0.3 });
    let (mut sound, mut energy) = (Vec::new(), Vec::new());
    for block in 0..1000 {
        let time = block as f64 * BLOCK as f64 / RATE;
        cymbal.choke(match time {
            0.1..0.3 => 0.15 * (1.0 - (30.0 * time).cos()),
            0.3..0.45 => 1.0,
            _ => 0.0,
        });
        if block % every == 0 {
            cymbal.follow_controls();
        }
        assert!(cymbal.surface_mut().settle());
        let mut out = [[0.0; BLOCK]; RECEIVERS];
        cymbal.surface_mut().render_in_air(out.each_mut().map(|out| &mut out[..]), None);
        cymbal.advance_controls(BLOCK as f64 / RATE);
        sound.extend(out[0]);
        energy.push(cymbal.surface().energy());
    }
    (sound, energy)
}

#[test]
fn a_hand_that_the_modes_follow_in_turns_sounds_as_one_that_they_follow_in_every_block() {
    for name in ["crash", "ride", "splash"] {
        let [(oracle, kept), (sound, energy)] = [1, FOLLOWED].map(|every| choked(name, every));
        // Level of every 20 ms, down to 60 dB under the loudest.
        let levels = |sound: &[f32]| -> Vec<f64> {
            let windows = sound.chunks_exact(882);
            windows.map(|window| window.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>()).collect()
        };
        let (wanted, got) = (levels(&oracle), levels(&sound));
        let loudest = wanted.iter().copied().fold(0.0, f64::max);
        let heard = wanted.iter().zip(&got).filter(|(wanted, _)| **wanted > 1e-6 * loudest);
        let apart = heard.map(|(wanted, got)| 10.0 * (got / wanted).log10().abs()).fold(0.0, f64::max);
        let largest = oracle.iter().fold(0.0_f32, |most, x| most.max(x.abs()));
        let off = oracle.iter().zip(&sound).fold(0.0_f32, |most, (a, b)| most.max((a - b).abs())) / largest;
        let late = |e: &[f64]| e[700];
        println!(
            "{name}: samples differ by {off:.1e} of the loudest, 20 ms by {apart:.3} dB, {:.2e} J of {:.2e} J are left",
            late(&energy),
            late(&kept)
        );
        // A swing stops wherever the modes follow, and goes on from there; the highs of a splash that stretches part in phase.
        assert!(off < 0.15, "{name}: {off}");
        // Nobody hears a quarter of a decibel of 20 ms.
        assert!(apart < 0.25, "{name}: {apart} dB");
        // Nothing comes from a hand: displacement and velocity stay what they are when the modes follow.
        for energy in [&energy, &kept] {
            let rises = energy[150..].windows(2).map(|pair| (pair[1] - pair[0]).max(0.0)).sum::<f64>();
            assert!(rises <= 1e-6 * energy[150], "{name}: {rises} J of {} J", energy[150]);
        }
    }
}

#[test]
fn felts_damp_the_bounce_as_it_is_damped_and_all_else_less_and_less() {
    let stand = reference::cymbal("crash").stand.unwrap();
    let bounce = TAU * stand.bounce_hz;
    assert!((felt_loss(&stand, bounce) / (bounce / (2.0 * stand.q)) - 1.0).abs() < 1e-12);
    // An octave up the stiffness is 2^(2/pi atan(1/3)) = 1.152 times as large, the loss 1.152 / 2 times.
    let octave = felt_loss(&stand, 2.0 * bounce) / felt_loss(&stand, bounce);
    assert!((octave - 0.5762).abs() < 1e-3, "{octave}");
}

/// What the modes' transfers, each known where the mode rings, leave of the sound of a force on a plate at `radius` and angle 0: over that of an
/// endless sheet, mean over a sixth of the frequencies about `hz`, `[point]`.
///
/// The oracle: every mode's own transfer at the frequency of the force.
fn lacking(name: &str, radius: f64, hz: f64) -> [Complex<f64>; POINTS] {
    let context = reference::standard(name).context(BuildOptions::new(RATE));
    let spec = reference::cymbal(name);
    let plate = CymbalPlate::new(&spec, None, &context).unwrap();
    let SoundingPlate { plate: known, radiated, .. } = &**plate.known();
    let (orders, extent) = known.table_extent(21_000.0);
    let tables = PlateTables::new(orders, extent);
    let finest = known.flat.iter().flatten().map(|flat| flat.root).fold(0.0, f64::max);
    let nodes = 40 + (0.7 * (finest + extent)) as usize;
    let points = context.receivers.points();
    let disc = FreeDisc::new(known.spec.radius(), points, nodes);
    let shapes = known.radial_shapes(&tables, disc.radii());
    let at = plate.shapes_at(radius);
    let heave = vec![1.0; nodes];
    let rock: Vec<f64> = disc.radii().iter().map(|r| 2.0 * r).collect();
    let rigid = [(0, &heave[..], 1.0), (1, &rock[..], 2.0 * radius)];
    let none = [[0.0; 2]; POINTS];
    let mut sums = [Complex::new(0.0, 0.0); POINTS];
    const PARTS: [f64; 4] = [0.87, 0.96, 1.04, 1.13];
    for omega in PARTS.map(|part| TAU * hz * part) {
        let rigid = rigid.iter().map(|&(m, radial, here)| (m, radial, 1.0, 1.0, here, &none));
        let bent = known.shells.iter().zip(radiated).enumerate().map(|(k, (shell, radiated))| {
            let radial = &shapes[k * nodes..][..nodes];
            (shell.m, radial, known.wave_number(shell), shell.omega, at[k], &radiated.transfers)
        });
        // Far above they neither weigh nor ring.
        for (m, radial, root, own, here, transfers) in rigid.chain(bent).filter(|mode| mode.3 < 2.0 * omega) {
            let now = disc.radiate(&Radiator { m, radial, omega }, root).transfers;
            let yields =
                here / spec.mass / Complex::new(1.0 - (own / omega).powi(2), 0.04 * (own / omega).powi(2));
            for (i, point) in points.iter().enumerate() {
                let missing = [0, 1].map(|part| now[i][part] - transfers[i][part]);
                let toward = (f64::from(m) * point.azimuth).cos();
                // Heard from the place itself, not from the centre.
                let late = omega / SPEED_OF_SOUND
                    * (point.distance_to(radius * known.spec.radius(), 0.0) - point.distance);
                sums[i] += yields * toward * Complex::new(missing[0], missing[1]) * Complex::cis(late)
                    / PARTS.len() as f64;
            }
        }
    }
    sums
}

#[test]
fn the_direct_sound_is_what_the_modes_lack() {
    const FINE: f64 = 192_000.0;
    let mut all = Vec::new();
    for (name, hzs) in [("ride", [800.0, 1500.0, 3000.0]), ("splash", [1500.0, 3000.0, 6000.0])] {
        let context = reference::standard(name).context(BuildOptions::new(RATE));
        let spec = reference::cymbal(name);
        let mut direct = DirectSound::new(&spec.plate(), 1, &context.receivers, FINE);
        for radius in [0.3, 0.45, 0.6, 0.75, 0.85, 0.93] {
            direct.put(0, radius, 0.0);
            direct.reset();
            let mut heard = vec![[0.0; POINTS]; 2048];
            for (block, heard) in heard.chunks_mut(32).enumerate() {
                if block == 0 {
                    direct.push(0, 0, 1.0);
                }
                let mut out = [[0.0; 32]; RECEIVERS];
                direct.render(&mut out.each_mut().map(|out| &mut out[..]));
                for (i, heard) in heard.iter_mut().enumerate() {
                    *heard = std::array::from_fn(|point| out[point][i]);
                }
            }
            for hz in hzs {
                let exact = lacking(name, radius, hz);
                for (point, exact) in exact.iter().enumerate() {
                    let turn = |i: usize| Complex::cis(-TAU * hz * i as f64 / FINE);
                    let terms = heard.iter().enumerate();
                    let sum: Complex<f64> = terms.map(|(i, heard)| turn(i) * f64::from(heard[point])).sum();
                    let scale = context.receivers.scales()[point];
                    let ratio = sum / (exact * scale);
                    println!(
                        "{name} {radius} {hz} Hz, point {point}: {:.2} at {:.2} rad",
                        ratio.norm(),
                        ratio.arg()
                    );
                    all.push((20.0 * ratio.norm().log10(), ratio.arg()));
                }
            }
        }
    }
    let count = all.len() as f64;
    let mean = all.iter().map(|(db, _)| db).sum::<f64>() / count;
    let spread = (all.iter().map(|(db, _)| (db - mean).powi(2)).sum::<f64>() / count).sqrt();
    let turned = (all.iter().map(|(_, arg)| arg * arg).sum::<f64>() / count).sqrt();
    println!("{mean:.2} dB, spread {spread:.2} dB, {turned:.2} rad");
    assert!(mean.abs() < 2.5 && spread < 3.5 && turned < 0.4, "{mean} {spread} {turned}");
}
