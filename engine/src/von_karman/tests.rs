use std::f64::consts::TAU;

use super::oracle::{Oracle, wash};
use super::*;
use crate::plate::PlateSpec;

fn built(spec: &PlateSpec) -> (PlateModes, PlateTables) {
    let plate = PlateModes::new(spec, 8000.0).unwrap();
    let (orders, extent) = plate.table_extent(8000.0);
    (plate, PlateTables::new(orders, extent))
}

fn below(plate: &PlateModes, hz: f64) -> usize {
    plate.shells.iter().take_while(|shell| shell.omega < TAU * hz).count()
}

/// The pairs one after another, each about an axis of its own.
fn pairs(plate: &PlateModes, count: usize) -> (Vec<CoupledPair>, usize) {
    let mut mode = 3;
    let pairs = (0..count)
        .map(|shell| {
            let axis = 0.7 * shell as f64;
            let pair = CoupledPair { shell, mode, axis };
            mode += if plate.shells[shell].m == 0 { 1 } else { 2 };
            pair
        })
        .collect();
    (pairs, mode)
}

/// Amplitudes about each pair's own axis, in the order of the body.
fn to_body(plate: &PlateModes, pairs: &[CoupledPair], q: &[[f64; 2]], modes: usize) -> Vec<f32> {
    let mut out = vec![0.0; modes.next_multiple_of(LANES)];
    for (pair, &[c, s]) in pairs.iter().zip(q) {
        let m = plate.shells[pair.shell].m;
        let (sin, cos) = (f64::from(m) * pair.axis).sin_cos();
        out[pair.mode] = (c * cos + s * sin) as f32;
        if m > 0 {
            out[pair.mode + 1] = (s * cos - c * sin) as f32;
        }
    }
    out
}

fn random_state(plate: &PlateModes, count: usize, size: f64, seed: u64) -> Vec<[f64; 2]> {
    let omegas: Vec<f64> = plate.shells[..count].iter().map(|shell| shell.omega).collect();
    let mut q = wash(&omegas, size, seed);
    q.iter_mut().zip(&plate.shells).filter(|(_, shell)| shell.m == 0).for_each(|(q, _)| q[1] = 0.0);
    q
}

fn finest(plate: &PlateModes, count: usize) -> f64 {
    let root = |shell: &crate::plate::ShellMode| {
        plate.flat_of(shell).iter().find(|flat| flat.n == shell.n).unwrap().root
    };
    plate.shells[..count].iter().map(root).fold(0.0, f64::max)
}

#[test]
fn energy_and_gradient_are_those_of_direct_quadrature_of_the_bracket() {
    for (spec, hz) in [(PlateSpec::CRASH, 2000.0), (PlateSpec::RIDE, 1000.0), (PlateSpec::SPLASH, 2000.0)] {
        let (plate, tables) = built(&spec);
        let count = below(&plate, hz);
        let (pairs, modes) = pairs(&plate, count);
        let mut fast = VonKarman::new(&plate, &tables, &pairs);
        let oracle = Oracle::new(&plate, &tables, count, finest(&plate, count), (48, 100));
        for seed in 1..3 {
            let q = random_state(&plate, count, 3e-4, seed);
            let want = oracle.evaluate(&q);
            let mut gradient = vec![0.0; modes.next_multiple_of(LANES)];
            let got = fast.evaluate(&to_body(&plate, &pairs, &q, modes), &mut gradient);
            let scale = want.energy.abs().max(want.linear);
            assert!((got.energy - want.energy).abs() < 3e-4 * scale, "{} {}", got.energy, want.energy);
            assert!((got.depth - want.linear).abs() < 1e-4 * want.linear, "{} {}", got.depth, want.linear);
            let wanted = to_body(&plate, &pairs, &want.gradient, modes);
            let size: f32 = wanted.iter().map(|g| g * g).sum::<f32>().sqrt();
            let error: f32 = wanted.iter().zip(&gradient).map(|(a, b)| (a - b).powi(2)).sum::<f32>().sqrt();
            assert!(error < 1e-3 * size, "{error} of {size}");
        }
    }
}

#[test]
fn the_oracles_gradient_is_its_energys_to_1e_6() {
    let (plate, tables) = built(&PlateSpec::CRASH);
    let count = below(&plate, 700.0);
    let oracle = Oracle::new(&plate, &tables, count, 14.0, (24, 48));
    let q = random_state(&plate, count, 3e-4, 5);
    let gradient = oracle.evaluate(&q).gradient;
    let size = gradient.iter().flatten().map(|g| g * g).sum::<f64>().sqrt();
    for i in 0..count {
        for member in 0..if plate.shells[i].m == 0 { 1 } else { 2 } {
            // A quartic: the difference of fourth order is exact but for rounding.
            let at = |steps: f64| {
                let mut moved = q.clone();
                moved[i][member] += steps * 1e-5;
                oracle.evaluate(&moved).energy
            };
            let slope = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * 1e-5);
            assert!(
                (slope - gradient[i][member]).abs() < 1e-6 * size,
                "{i}: {slope} {}",
                gradient[i][member]
            );
        }
    }
}

#[test]
#[ignore = "a measurement"]
fn cost() {
    for (name, spec) in
        [("crash", PlateSpec::CRASH), ("ride", PlateSpec::RIDE), ("splash", PlateSpec::SPLASH)]
    {
        let (plate, tables) = built(&spec);
        for hz in [1000.0, 2000.0, 4000.0, 7900.0] {
            let count = below(&plate, hz);
            let (pairs, modes) = pairs(&plate, count);
            let start = std::time::Instant::now();
            let mut fast = VonKarman::new(&plate, &tables, &pairs);
            let build = start.elapsed();
            let q = to_body(&plate, &pairs, &random_state(&plate, count, 3e-4, 1), modes);
            let mut gradient = vec![0.0; modes.next_multiple_of(LANES)];
            let mut best = f64::MAX;
            for _ in 0..20 {
                let start = std::time::Instant::now();
                for _ in 0..50 {
                    std::hint::black_box(fast.evaluate(&q, &mut gradient));
                }
                best = best.min(start.elapsed().as_secs_f64() / 50.0);
            }
            println!(
                "{name} {hz} Hz: {count} pairs, {} lanes, {} angles, {:.2} us, build {build:?}",
                fast.lanes,
                fast.bends.angles(),
                best * 1e6
            );
        }
    }
    // The calibration loop.
    let mut best = f64::MAX;
    for _ in 0..3 {
        let mut x = std::hint::black_box(vec![0.5_f32; 4096]);
        let start = std::time::Instant::now();
        let (a, b) = (std::hint::black_box(0.9999_f32), std::hint::black_box(1e-4_f32));
        for _ in 0..1 << 18 {
            for x in &mut x {
                *x = *x * a + b;
            }
            std::hint::black_box(&mut x);
        }
        best = best.min(start.elapsed().as_secs_f64());
    }
    println!("calibration {best:.4} s");
}
