use std::f64::consts::TAU;

use super::*;
use crate::cymbal::spec::CymbalSpec;
use crate::plate::PlateSpec;
use crate::reference;
use crate::split::Splitting;

const HAMMERING: HammeringSpec = HammeringSpec { rms: 0.05, correlation: 0.3, seed: 7 };

/// A plate's modes up to a frequency (Hz), with tables of their shapes.
fn plate(spec: &PlateSpec, limit_hz: f64) -> (PlateModes, PlateTables) {
    let modes = PlateModes::new(spec, limit_hz).unwrap();
    let (orders, extent) = modes.table_extent(limit_hz);
    (modes, PlateTables::new(orders, extent))
}

/// All plain modes from a frequency (Hz) on.
fn plain(plate: &PlateModes, from_hz: f64) -> Vec<PlainMode> {
    let shells = plate.shells.iter().enumerate().filter(|(_, shell)| shell.omega > TAU * from_hz);
    let members = |(at, shell): (usize, &crate::plate::ShellMode)| {
        let (m, n, omega) = (shell.m, shell.n, shell.omega);
        Splitting::ROUND.members(m, n).map(move |(member, _)| PlainMode {
            shell: at,
            m,
            member,
            axis: 0.3 * f64::from(m + n),
            omega,
        })
    };
    shells.flat_map(members).collect()
}

#[test]
fn a_plate_that_is_thicker_everywhere_is_higher_by_as_much() {
    // A flat plate has `omega` in proportion to its thickness.
    let flat = PlateSpec { rise: 0.0, bell: None, taper: 1.0, ..reference::cap_crash() };
    let (modes, tables) = plate(&flat, 1500.0);
    let plain = plain(&modes, 100.0);
    let mut problem = Problem::new(&modes, &tables, &HAMMERING, &plain);
    for (l, harmonic) in problem.field.harmonics.iter_mut().enumerate() {
        harmonic[0].fill(if l == 0 { 0.01 } else { 0.0 });
        harmonic[1].fill(0.0);
    }
    let couplings = problem.couplings(0..plain.len());
    for i in 0..plain.len() {
        for j in 0..plain.len() {
            let share = couplings[(i, j)] / (plain[i].omega * plain[j].omega);
            let want = if i == j { 0.02 } else { 0.0 };
            assert!((share - want).abs() < 1e-6, "{:?} {:?}: {share}", plain[i], plain[j]);
        }
    }
}

#[test]
fn a_coupling_is_the_integral_of_bending_and_inertia_over_the_metal() {
    let spec = PlateSpec { taper: 0.7, ..reference::cap_crash() };
    let (modes, tables) = plate(&spec, 700.0);
    let plain = plain(&modes, 300.0);
    let problem = Problem::new(&modes, &tables, &HAMMERING, &plain);
    // By differences of the shapes on a grid in Cartesian coordinates, with the field drawn at each of its radii.
    let (rings, spokes) = (240, 96);
    let radii: Vec<f64> = (0..rings).map(|i| (f64::from(i) + 0.5) / f64::from(rings)).collect();
    let metal: Vec<f64> =
        radii.iter().map(|&r| 2.0 * r / f64::from(rings) * spec.relative_thickness(r)).collect();
    let field = ThicknessField::new(&HAMMERING, &radii, &metal);
    let shape = |k: usize, x: f64, y: f64| -> f64 {
        let mode = &plain[k];
        let turn = f64::from(mode.m) * (y.atan2(x) - mode.axis);
        let around = if mode.member == Member::Cosine { turn.cos() } else { turn.sin() };
        around * modes.radial_shape(&modes.shells[mode.shell], x.hypot(y))
    };
    let step = 2e-3;
    // `w`, `w_xx`, `w_yy` and `w_xy`.
    let bent = |k: usize, x: f64, y: f64| -> [f64; 4] {
        let at = |i: f64, j: f64| shape(k, x + i * step, y + j * step);
        let square = step * step;
        let middle = at(0.0, 0.0);
        let xx = (at(1.0, 0.0) - 2.0 * middle + at(-1.0, 0.0)) / square;
        let yy = (at(0.0, 1.0) - 2.0 * middle + at(0.0, -1.0)) / square;
        let xy = (at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0)) / (4.0 * square);
        [middle, xx, yy, xy]
    };
    let unit = spec.flat_omega().powi(2);
    let rest = 1.0 - spec.poisson_ratio;
    let direct = |i: usize, j: usize| -> f64 {
        let mass = plain[i].omega * plain[j].omega;
        let mut sum = 0.0;
        for (at, &r) in radii.iter().enumerate() {
            let (t, area) = (spec.relative_thickness(r), 2.0 * r / f64::from(rings * spokes));
            for spoke in 0..spokes {
                let theta = TAU * f64::from(spoke) / f64::from(spokes);
                let harmonics = field.harmonics.iter().enumerate();
                let eta: f64 = harmonics
                    .map(|(l, [cos, sin])| {
                        let (s, c) = (l as f64 * theta).sin_cos();
                        cos[at] * c + sin[at] * s
                    })
                    .sum();
                let (y, x) = theta.sin_cos();
                let [[p, p_xx, p_yy, p_xy], [q, q_xx, q_yy, q_xy]] = [i, j].map(|k| bent(k, r * x, r * y));
                let even = (p_xx + p_yy) * (q_xx + q_yy);
                let bracket = p_xx * q_yy + p_yy * q_xx - 2.0 * p_xy * q_xy;
                let bending = 3.0 * unit * t.powi(3) * (even - rest * bracket);
                sum += area * eta * (bending - mass * t * p * q);
            }
        }
        sum
    };
    let couplings = problem.couplings(0..plain.len());
    let pairs = [(0, 0), (0, 1), (1, 2), (3, 5), (2, 7), (6, 6), (4, 9), (8, 3)];
    for (i, j) in pairs {
        let scale = plain[i].omega * plain[j].omega * HAMMERING.rms;
        let (found, want) = (couplings[(i, j)] / scale, direct(i, j) / scale);
        assert!((found - want).abs() < 0.01, "{:?} {:?}: {found} {want}", plain[i], plain[j]);
    }
    let largest = pairs.iter().map(|&at| couplings[at].abs() / plain[at.0].omega.powi(2)).fold(0.0, f64::max);
    assert!(largest > 0.2 * HAMMERING.rms, "{largest}");
}

#[test]
fn hammered_modes_are_rotations_of_plain_ones() {
    let (modes, tables) = plate(&reference::cap_crash(), 3000.0);
    let plain = plain(&modes, 1500.0);
    let hammered = HammeredModes::new(&modes, &tables, &HAMMERING, 5, &plain);
    assert_eq!(hammered.mixture.modes(), 5 + plain.len());
    assert!(hammered.omegas.is_sorted());
    let mut most = 0.0_f64;
    for k in 0..plain.len() {
        assert!((hammered.mean(k, |_| 1.0) - 1.0).abs() < 1e-5, "mode {k}");
        most += hammered.mixture.parts(k).map(|(_, share)| share.powi(4)).sum::<f64>() / plain.len() as f64;
    }
    // Every mode is a mixture of several: one over how many.
    assert!((0.02..0.5).contains(&most), "{most}");
    // The mean of the squares of the frequencies is that of the plain modes but for the first order.
    let square = |omegas: &mut dyn Iterator<Item = f64>| omegas.map(|omega| omega * omega).sum::<f64>();
    let ratio =
        square(&mut hammered.omegas.iter().copied()) / square(&mut plain.iter().map(|mode| mode.omega));
    assert!((ratio - 1.0).abs() < HAMMERING.rms, "{ratio}");
}

#[test]
fn the_strongest_hammering_leaves_every_mode_stiff() {
    // A small thick plate: a block of its modes reaches from the lowest up to ten kilohertz.
    let small =
        CymbalSpec { diameter: 0.18, mass: 0.25, bell: None, bow: 0.01, ..reference::cymbal("splash") };
    let (modes, tables) = plate(&small.plate(), 21_000.0);
    let plain = plain(&modes, MIXED_FROM_HZ);
    for seed in 0..4 {
        let strongest = HammeringSpec { rms: 0.1, correlation: 0.1, seed };
        let hammered = HammeredModes::new(&modes, &tables, &strongest, 0, &plain);
        let least = hammered.omegas[0] / plain[0].omega;
        assert!(least > 0.85, "seed {seed}: {least}");
    }
}
