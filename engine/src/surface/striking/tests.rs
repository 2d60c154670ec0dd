use std::f64::consts::{PI, TAU};

use super::*;
use crate::build_context::BuildOptions;
use crate::damping::LossLaw;
use crate::drum::Drum;
use crate::instrument::Instrument as _;
use crate::math::bessel;
use crate::modal::RECEIVERS;
use crate::reference;
use crate::strike::Striker;
use crate::surface::exciter::Exciter;
use crate::surface::local_compliance::LocalHeadCompliance;
use crate::surface::oscillator::Oscillator;

const RATE: f64 = 48e3;
const SAMPLES: usize = 480;

/// Every mode that a force at a place (share of the radius) moves, of a film held at its rim, each of unit shape there.
fn all_modes(film: &LocalHeadCompliance, loss: &LossLaw, place: f64, to_hz: f64) -> Vec<Oscillator> {
    let LocalHeadCompliance { tension, density, rigidity, .. } = *film;
    let omega = |k: f64| k * ((tension + rigidity * k * k) / density).sqrt();
    let mut modes = Vec::new();
    for m in 0.. {
        let waves = |zero: &f64| omega(zero / film.radius) < TAU * to_hz;
        let zeros: Vec<f64> = bessel::zeros(m, 200).into_iter().take_while(waves).collect();
        if zeros.is_empty() {
            return modes;
        }
        for zero in zeros {
            let around = if m == 0 { TAU } else { PI };
            let mass = 0.5 * density * around * (film.radius * libm::jn(m as i32 + 1, zero)).powi(2);
            let shape = libm::jn(m as i32, zero * place);
            if shape.abs() > 1e-9 {
                let omega = omega(zero / film.radius);
                let sigma = loss.sigma(omega);
                modes.push(Oscillator::sprung(mass / (shape * shape), omega, sigma, 1.0 / RATE));
            }
        }
    }
    modes
}

/// Energy of a force (N, `[sample]`) in bands of half an octave from 1.4 to 11 kHz, dB.
fn bands(force: &[f64]) -> Vec<f64> {
    (0..6)
        .map(|band| {
            let low = 1400.0 * 2.0_f64.powf(0.5 * f64::from(band));
            let lines = (0..24).map(|i| low * 2.0_f64.powf((f64::from(i) + 0.5) / 48.0));
            let energy: f64 = lines
                .map(|hz| {
                    let turn = |i: usize| TAU * hz * i as f64 / RATE;
                    let sum = |part: fn(f64) -> f64| -> f64 {
                        force.iter().enumerate().map(|(i, force)| force * part(turn(i))).sum()
                    };
                    sum(f64::cos).powi(2) + sum(f64::sin).powi(2)
                })
                .sum();
            10.0 * energy.log10()
        })
        .collect()
}

/// A stick strikes the standard kit's rack tom: the drum afterwards, and the force (N) of every sample.
fn struck(speed: f64, place: f64) -> (Drum, Vec<f64>) {
    let build = reference::standard("rack-tom");
    let spec = build.spec.drum().unwrap();
    let mut drum = Drum::new(spec, &build.context(BuildOptions::new(RATE))).unwrap();
    drum.strike(&Strike { speed, radius: place, angle: 0.0, striker: Striker::Stick });
    let mut forces = vec![0.0; SAMPLES];
    for force in &mut forces {
        let mut out = [[0.0; 1]; RECEIVERS];
        drum.surface_mut().render_in_air(out.each_mut().map(|receiver| &mut receiver[..]), None);
        *force = drum.surface().contacts.points[0].force;
    }
    (drum, forces)
}

#[test]
fn strokes_are_as_strong_and_as_short_as_on_a_film_by_foeppls_equations() {
    // The whole equations in the plane, triangles of 1 mm (`EXPERIMENTS.md`): speed, m/s, largest force, N, contact, ms.
    for (speed, peak, contact) in [(1.5, 9.3, 7.70), (3.0, 21.9, 6.91), (5.0, 42.8, 6.04), (8.0, 81.9, 5.30)]
    {
        let (_, force) = struck(speed, 0.3);
        let largest = force.iter().copied().fold(0.0, f64::max);
        let touches = force.iter().filter(|&&force| force > 0.0).count() as f64 * 1e3 / RATE;
        assert!((largest / peak - 1.0).abs() < 0.05, "{speed} m/s: {largest:.1} N, whole equations {peak} N");
        assert!(
            (touches / contact - 1.0).abs() < 0.08,
            "{speed} m/s: {touches:.2} ms, whole equations {contact} ms"
        );
    }
}

#[test]
fn a_soft_stroke_meets_a_film_as_all_its_modes_one_by_one_would() {
    let (place, speed) = (0.3, 1.0);
    let (drum, ours) = struck(speed, place);
    let loss = reference::standard("rack-tom").spec.drum().unwrap().batter.loss;
    let film = drum.surface().local_compliance.unwrap();
    let mut modes = all_modes(&film, &loss, place, 30e3);
    assert!(modes.len() > 2000, "{}", modes.len());
    let dt = 1.0 / RATE;
    let mut stick = Exciter::absent(dt);
    let weights = stick.take(&Striker::Stick.spec(), speed, &drum.surface().contacts.beams, (true, dt));
    // A contact as stiff as wood on film is under some newtons.
    let contact = 1e-6;
    let compliance: f64 = contact
        + stick.compliance(&weights, &weights)
        + modes.iter().map(Oscillator::compliance).sum::<f64>();
    let oracle: Vec<f64> = (0..SAMPLES)
        .map(|_| {
            stick.step();
            modes.iter_mut().for_each(Oscillator::step);
            let overlap = stick.position(&weights) - modes.iter().map(|mode| mode.q).sum::<f64>();
            let force = (overlap / compliance).max(0.0);
            stick.push(&weights, force);
            modes.iter_mut().for_each(|mode| mode.push(force));
            force
        })
        .collect();

    for (band, (ours, oracle)) in bands(&ours).into_iter().zip(bands(&oracle)).enumerate() {
        assert!((ours - oracle).abs() < 2.0, "band {band}: {ours:.1} dB, all modes {oracle:.1} dB");
    }
}
