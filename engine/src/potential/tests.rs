use std::f64::consts::TAU;
use std::sync::{Arc, Mutex};

use super::*;
use crate::contact::Material;
use crate::modal::Mode;
use crate::mode::Member;
use crate::shapes::{ShapeIndex, ShapeTable};
use crate::strike::{Strike, Striker};
use crate::surface::{Surface, SurfaceParts};

/// What the stretching of a string or head is like: `U = (sum k q^2)^2 / 4`.
struct Quartic(Vec<f64>);

impl Potential for Quartic {
    fn evaluate(&mut self, displacement: &[f32], gradient: &mut [f32]) -> Evaluation {
        let terms = self.0.iter().zip(displacement);
        let stretch: f64 = terms.map(|(k, &q)| k * f64::from(q) * f64::from(q)).sum();
        gradient.fill(0.0);
        for ((g, k), &q) in gradient.iter_mut().zip(&self.0).zip(displacement) {
            *g = (stretch * k * f64::from(q)) as f32;
        }
        Evaluation { energy: 0.25 * stretch * stretch, depth: 0.0 }
    }
}

const MODES: usize = 20;

/// A lossless surface of some modes; `stiffness` of its potential, J/m^4.
fn surface(stiffness: f64, stride: u32) -> Surface {
    let omega = |k: usize| TAU * 70.0 * (1.0 + 0.83 * k as f64);
    let modes: Vec<Mode> = (0..MODES).map(|k| Mode { omega: omega(k), sigma: 0.0, mass: 0.05 }).collect();
    let radial: Vec<f64> = (0..MODES)
        .flat_map(|k| ShapeTable::radii().into_iter().map(move |r| 1.4 * (2.1 * k as f64 * r).cos()))
        .collect();
    let index = |k| ShapeIndex { radial: k, rows: 1, m: 0, member: Member::Cosine, axis: 0.0 };
    let mut surface = Surface::new(SurfaceParts {
        modes,
        shapes: ShapeTable::new(&radial, (0..MODES).map(index).collect()),
        transfer: vec![[1.0, 0.0]; MODES],
        material: Material::FILM,
        lossless: true,
        sample_rate: 44_100.0,
    });
    let weights = (0..MODES).map(|k| stiffness.sqrt() * (1.0 + k as f64)).collect();
    surface.set_potential(Box::new(Quartic(weights)), MODES, stride);
    surface
}

/// A surface of one mode, the same everywhere.
fn one_mode(mode: Mode) -> Surface {
    let index = ShapeIndex { radial: 0, rows: 1, m: 0, member: Member::Cosine, axis: 0.0 };
    Surface::new(SurfaceParts {
        modes: vec![mode],
        shapes: ShapeTable::new(&vec![1.0; ShapeTable::radii().len()], vec![index]),
        transfer: vec![[1.0, 0.0]],
        material: Material::FILM,
        lossless: false,
        sample_rate: 44_100.0,
    })
}

fn hit(speed: f64) -> Strike {
    Strike { speed, radius: 0.3, angle: 0.0, striker: Striker::Stick }
}

/// Renders what is heard from near.
fn render(surface: &mut Surface, out: &mut [f32]) {
    let mut rows = [[0.0; 32]; RECEIVERS];
    let samples = out.len();
    let mut runs = rows.each_mut().map(|row| &mut row[..samples]);
    runs[0] = out;
    surface.render_in_air(runs, None);
}

fn run(surface: &mut Surface, samples: usize) -> Vec<f32> {
    let mut out = vec![0.0; samples];
    out.chunks_mut(32).for_each(|block| {
        render(surface, block);
        surface.settle();
    });
    out
}

/// Stiff enough that the hardest strokes here double the lowest frequency.
const STIFF: f64 = 3e9;

#[test]
fn a_striker_and_a_stretching_surface_keep_their_energy_together() {
    for stride in [1, 2] {
        for speed in [0.5, 5.0, 25.0] {
            let mut surface = surface(STIFF, stride);
            surface.strike(&hit(speed));
            let brought = surface.striker_energy();
            for _ in 0..30 {
                run(&mut surface, 32);
                let all = surface.energy() + surface.striker_energy() + surface.departed_energy();
                assert!(
                    (all / brought - 1.0).abs() < 2e-4,
                    "{speed} m/s, stride {stride}: {all} of {brought}"
                );
            }
        }
    }
}

#[test]
fn the_true_energy_is_kept_for_seconds() {
    let mut surface = surface(STIFF, 1);
    surface.strike(&hit(10.0));
    run(&mut surface, 22_050);
    let start = surface.body().energy() + surface.true_potential().0;
    for _ in 0..10 {
        run(&mut surface, 22_048);
        let now = surface.body().energy() + surface.true_potential().0;
        assert!((now / start - 1.0).abs() < 1e-3, "{now} of {start}");
    }
}

#[test]
fn a_bent_body_without_a_potential_and_one_with_none_left_sound_alike() {
    let (mut with, mut without) = (surface(1e-6, 1), surface(1e-6, 1));
    without.nonlinear_force_mut().unwrap().set_stiffness(0.0);
    for surface in [&mut with, &mut without] {
        surface.strike(&hit(3.0));
    }
    let (a, b) = (run(&mut with, 20_000), run(&mut without, 20_000));
    let peak = b.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-3 * peak));
    assert!(!with.nonlinear_force().unwrap().is_active());
}

#[test]
fn how_time_is_cut_changes_no_sample() {
    let (mut whole, mut cut) = (surface(STIFF, 2), surface(STIFF, 2));
    for surface in [&mut whole, &mut cut] {
        surface.strike(&hit(8.0));
    }
    let (mut a, mut b) = (vec![0.0; 19_200], vec![0.0; 19_200]);
    for (a, b) in a.chunks_mut(32).zip(b.chunks_mut(32)) {
        render(&mut whole, a);
        b.chunks_mut(5).for_each(|part| render(&mut cut, part));
        whole.settle();
        cut.settle();
    }
    assert_eq!(a, b);
}

#[test]
fn a_harder_stroke_raises_the_pitch() {
    // Crossings of zero of the lowest mode in a second.
    let crossings = |speed| {
        let mut surface = surface(STIFF, 1);
        surface.strike(&hit(speed));
        let mut last = 0.0;
        let mut count = 0;
        for _ in 0..44_100 {
            run(&mut surface, 1);
            let now = surface.body().displacement(0);
            count += u32::from(now * last < 0.0);
            last = now;
        }
        count
    };
    let (soft, hard) = (crossings(0.1), crossings(20.0));
    assert!(hard > soft + soft / 20, "{soft}, {hard}");
}

/// What the stretching of a dome is like: `U = P^2 + 2 P l`, `P` quadratic, `l` linear.
struct Dome(f64);

impl Potential for Dome {
    fn evaluate(&mut self, displacement: &[f32], gradient: &mut [f32]) -> Evaluation {
        let q = |k: usize| f64::from(displacement[k]);
        let weight = |k: usize| self.0 * (1.0 + k as f64) * 30.0;
        let p: f64 = (0..MODES).map(|k| weight(k) * q(k) * q(k)).sum();
        let l: f64 = (0..MODES).map(|k| self.0 * q(k)).sum();
        gradient.fill(0.0);
        for (k, g) in gradient.iter_mut().enumerate().take(MODES) {
            *g = (4.0 * (p + l) * weight(k) * q(k) + 2.0 * p * self.0) as f32;
        }
        Evaluation { energy: p * p + 2.0 * p * l, depth: l * l }
    }
}

#[test]
fn a_stretching_surface_has_no_offset() {
    for (dome, stride) in [(3.0, 1), (10.0, 1), (10.0, 2), (20.0, 1)] {
        let mut surface = surface(0.0, 1);
        surface.set_potential(Box::new(Dome(dome)), MODES, stride);
        surface.strike(&hit(10.0));
        run(&mut surface, 22_050);
        let sound = run(&mut surface, 220_500);
        // Faded in and out, so that no part of a period counts.
        let turn = TAU / sound.len() as f64;
        let fade = |i: usize| 1.0 - (turn * (i as f64 + 0.5)).cos();
        let faded = sound.iter().enumerate().map(|(i, &x)| fade(i) * f64::from(x));
        let mean = faded.sum::<f64>() / sound.len() as f64;
        let peak = sound.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
        assert!(mean.abs() < 5e-5 * f64::from(peak), "dome {dome}, stride {stride}: {mean} of {peak}");
    }
}

/// A dome of one mode that rests at `a`, turned inside out, as well as at 0: `U + k q^2 / 2 = k q^2 (1 - q / a)^2 / 2`.
struct TwoPlaces {
    stiffness: f64,
    /// Where it rests inside out, m.
    turned: f64,
    /// Where it is.
    place: Arc<Mutex<f64>>,
}

impl Potential for TwoPlaces {
    fn evaluate(&mut self, displacement: &[f32], gradient: &mut [f32]) -> Evaluation {
        let (k, a, q) = (self.stiffness, self.turned, f64::from(displacement[0]));
        gradient.fill(0.0);
        gradient[0] = (k * q * q * (2.0 * q / a - 3.0) / a) as f32;
        *self.place.lock().unwrap() = q;
        let below = |q: f64| k * q * q * q * (1.0 - 0.5 * q / a) / a;
        Evaluation { energy: -below(q), depth: below(q.abs().min(1.5 * a)) }
    }
}

#[test]
fn what_was_beaten_inside_out_comes_back_to_rest() {
    let (mass, omega) = (0.05, TAU * 30.0);
    // Deep, and so shallow that little energy holds it there.
    for at in [0.15, 0.02] {
        let mut turned = 0;
        for speed in [1.0, 8.0, 12.0, 16.0, 20.0, 24.0].map(|speed| speed * at / 0.15) {
            let mut surface = one_mode(Mode { omega, sigma: 15.0, mass });
            let place = Arc::default();
            let dome = TwoPlaces { stiffness: mass * omega * omega, turned: at, place: Arc::clone(&place) };
            surface.set_potential(Box::new(dome), 1, 1);
            surface.strike(&hit(speed));
            let most = (0..20).map(|_| {
                run(&mut surface, 4_410);
                *place.lock().unwrap()
            });
            turned += u32::from(most.fold(0.0, f64::max) > 0.99 * at);
            // Without that of the potential: together they are zero inside out.
            let left = surface.body().energy();
            assert!(left < 1e-20, "{speed} m/s, {at} m: {left} J");
        }
        assert!((1..6).contains(&turned), "{at} m: {turned} turned inside out");
    }
}
