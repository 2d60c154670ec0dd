//! Claims about whole plates.

use std::f64::consts::PI;

use super::free_disc::FreeDisc;
use super::*;
use crate::math::quadrature::GaussLegendre;
use crate::radiation::Radiator;
use crate::receiver::{POINTS, ReceiverPosition};
use crate::reference::{self, cap_crash, cap_ride, cap_splash};

fn hz(plate: &PlateModes, m: u32, n: u32) -> f64 {
    let shell = plate.shells.iter().find(|shell| (shell.m, shell.n) == (m, n));
    shell.unwrap().omega / TAU
}

fn flat_hz(spec: &PlateSpec, m: u32, n: u32) -> f64 {
    hz(&PlateModes::new(&PlateSpec { rise: 0.0, ..*spec }, 2000.0).unwrap(), m, n)
}

fn assert_close(got: f64, want: f64, share: f64) {
    assert!((got / want - 1.0).abs() < share, "{got} for {want}");
}

#[test]
fn doming_the_cap_crash_raises_its_modes_as_published() {
    let spec = cap_crash();
    let crash = PlateModes::new(&spec, 2000.0).unwrap();
    assert_close(spec.ring_omega() / TAU, 546.0, 0.002);
    for ((m, n), flat, shell) in [((2, 0), 21.8, 22.9), ((3, 0), 50.8, 54.4), ((0, 1), 37.9, 547.4)] {
        assert_close(flat_hz(&spec, m, n), flat, 0.005);
        assert_close(hz(&crash, m, n), shell, 0.005);
    }
    assert_close(hz(&crash, 10, 0), 530.0, 0.005);
}

#[test]
fn the_lowest_axisymmetric_mode_of_the_cap_ride_and_the_cap_splash_rises_to_the_ring_frequency() {
    for (spec, flat, shell) in [(cap_ride(), 35.3, 489.4), (cap_splash(), 56.5, 841.4)] {
        assert_close(flat_hz(&spec, 0, 1), flat, 0.005);
        assert_close(hz(&PlateModes::new(&spec, 2000.0).unwrap(), 0, 1), shell, 0.005);
    }
}

#[test]
fn a_dome_that_vanishes_leaves_the_flat_plate() {
    let spec = PlateSpec { rise: 1e-7, ..cap_ride() };
    let plate = PlateModes::new(&spec, 8000.0).unwrap();
    for shell in &plate.shells {
        let flat = plate.flat_of(shell).iter().find(|flat| flat.n == shell.n).unwrap();
        assert_close(shell.omega, spec.flat_omega() * flat.root * flat.root, 1e-8);
    }
}

#[test]
fn far_above_the_ring_frequency_a_cap_is_a_plate_stiffened_by_it() {
    let plate = PlateModes::new(&cap_crash(), 20_000.0).unwrap();
    let ring = plate.spec.ring_omega();
    for shell in plate.shells.iter().filter(|shell| shell.n > 2) {
        let flat = plate.flat_of(shell).iter().find(|flat| flat.n == shell.n).unwrap();
        let omega = plate.spec.flat_omega() * flat.root * flat.root;
        assert_close(shell.omega, omega.hypot(ring), 0.01);
    }
}

#[test]
fn more_flat_modes_would_move_no_frequency_by_0_01_percent() {
    for spec in [cap_crash(), cap_ride(), cap_splash()] {
        let coarse = PlateModes::new(&spec, 2000.0).unwrap();
        let fine = PlateModes::new(&spec, 24_000.0).unwrap();
        for (a, b) in coarse.shells.iter().zip(&fine.shells) {
            assert_eq!((a.m, a.n), (b.m, b.n));
            assert_close(a.omega, b.omega, 1e-4);
        }
    }
}

#[test]
fn more_functions_of_both_kinds_would_move_a_belled_plates_lowest_frequency_by_0_1_percent_and_others_less() {
    let spec = reference::cymbal("crash").plate();
    let coarse = PlateModes::new(&spec, 21_000.0).unwrap();
    let fine = PlateModes::new(&spec, 31_500.0).unwrap();
    for shell in &coarse.shells {
        let share = if (shell.m, shell.n) == (0, 1) { 1.5e-3 } else { 5e-4 };
        assert_close(shell.omega / TAU, hz(&fine, shell.m, shell.n), share);
    }
}

/// A crash's.
const BELL: Bell = Bell { radius: 0.055, rise: 0.020 };

#[test]
fn a_caps_mode_carries_the_circles_of_the_flat_mode_that_dominates_it() {
    for spec in [cap_crash(), cap_ride(), cap_splash()] {
        let plate = PlateModes::new(&spec, 20_000.0).unwrap();
        for shell in &plate.shells {
            let share = |&p: &usize| shell.expansion[p].abs();
            let largest = (0..shell.expansion.len()).max_by(|a, b| share(a).total_cmp(&share(b)));
            let flat = plate.flat_of(shell)[largest.unwrap()];
            assert_eq!(flat.n, shell.n, "m {}, {} Hz", shell.m, shell.omega / TAU);
        }
    }
}

#[test]
fn shell_shapes_have_unit_mean_square_and_are_read_from_tables_within_1e_6() {
    let plate = PlateModes::new(&cap_splash(), 20_000.0).unwrap();
    let (max_order, x_max) = plate.table_extent(20_000.0);
    let tables = PlateTables::new(max_order, x_max);
    let rule = GaussLegendre::unit(96);
    let shapes = plate.radial_shapes(&tables, &rule.nodes);
    for (shell, shape) in plate.shells.iter().zip(shapes.chunks_exact(rule.nodes.len())) {
        let weights = rule.nodes.iter().zip(&rule.weights);
        let square: f64 = shape.iter().zip(weights).map(|(w, (r, dr))| w * w * r * dr).sum();
        let mean = radial::angular_norm(shell.m) / PI * square;
        assert!((mean - 1.0).abs() < 1e-6, "({}, {}): {mean}", shell.m, shell.n);
        for i in [0, 40, 95] {
            let exact = plate.radial_shape(shell, rule.nodes[i]);
            assert!((shape[i] - exact).abs() < 1e-6, "({}, {})", shell.m, shell.n);
        }
    }
}

#[test]
fn a_crash_radiates_little_below_coincidence_and_its_whole_area_above() {
    let plate = PlateModes::new(&reference::cymbal("crash").plate(), 24_000.0).unwrap();
    let (max_order, x_max) = plate.table_extent(24_000.0);
    let point = ReceiverPosition { distance: 0.5, inclination: 0.6, azimuth: 0.0 };
    let disc = FreeDisc::new(plate.spec.radius(), [point; POINTS], 140);
    let shapes = plate.radial_shapes(&PlateTables::new(max_order, x_max), disc.radii());
    let shells = plate.shells.iter().zip(shapes.chunks_exact(disc.radii().len()));
    let resistance = |(shell, radial): (&ShellMode, &[f64])| {
        let wave = Radiator { m: shell.m, radial, omega: shell.omega };
        disc.radiate(&wave, plate.wave_number(shell)).resistance
    };
    let resistances: Vec<f64> = shells.map(resistance).collect();
    let whole = 2.0 * air_load::DENSITY * air_load::SPEED_OF_SOUND * PI * plate.spec.radius().powi(2);
    let mean = |from: f64, to: f64| {
        let inside = |shell: &ShellMode| (from..to).contains(&(shell.omega / TAU));
        let modes = plate.shells.iter().zip(&resistances);
        let shares = modes.filter(|(shell, _)| inside(shell)).map(|(_, r)| r / whole);
        let shares: Vec<f64> = shares.collect();
        shares.iter().sum::<f64>() / shares.len() as f64
    };
    assert!(mean(1000.0, 4000.0) < 0.1, "{}", mean(1000.0, 4000.0));
    assert!(mean(22_000.0, 24_000.0) > 0.9, "{}", mean(22_000.0, 24_000.0));
    assert!(resistances.iter().all(|&resistance| resistance >= 0.0));
}

#[test]
fn an_uneven_plate_as_even_as_a_cap_has_the_caps_modes() {
    let cap = PlateModes::new(&cap_crash(), 6000.0).unwrap();
    // So small a bell is none, but takes the other way.
    let spec = PlateSpec { bell: Some(Bell { radius: 0.03, rise: 0.0 }), ..cap_crash() };
    let uneven = PlateModes::new(&spec, 6000.0).unwrap();
    for shell in &cap.shells {
        let other = uneven.shells.iter().find(|other| (other.m, other.n) == (shell.m, shell.n)).unwrap();
        assert_close(other.omega, shell.omega, 1e-4);
        for r in [0.2, 0.6, 1.0] {
            let (got, want) = (uneven.radial_shape(other, r), cap.radial_shape(shell, r));
            assert!((got.abs() - want.abs()).abs() < 2e-3, "({}, {}): {got} {want}", shell.m, shell.n);
        }
    }
}

#[test]
fn a_taper_and_a_bell_leave_unit_mean_square_over_the_metal_and_no_rigid_momentum() {
    let spec = PlateSpec { bell: Some(BELL), taper: 0.5, ..cap_crash() };
    let plate = PlateModes::new(&spec, 6000.0).unwrap();
    let rule = GaussLegendre::unit(120);
    for m in 0..6 {
        let shells: Vec<&ShellMode> = plate.shells.iter().filter(|shell| shell.m == m).collect();
        let mean = |of: &dyn Fn(f64) -> f64| {
            let metal = |r: f64| spec.relative_thickness(r) * of(r) * r;
            radial::angular_norm(m) / PI * rule.integrate(metal)
        };
        for (i, a) in shells.iter().enumerate() {
            for b in &shells[..=i] {
                let product = mean(&|r| plate.radial_shape(a, r) * plate.radial_shape(b, r));
                let want = if a.n == b.n { 1.0 } else { 0.0 };
                assert!((product - want).abs() < 1e-6, "{m}: {} with {}: {product}", a.n, b.n);
            }
            if m < 2 {
                let momentum = mean(&|r| r.powi(m as i32) * plate.radial_shape(a, r));
                assert!(momentum.abs() < 1e-6, "({m}, {}): {momentum}", a.n);
            }
        }
    }
}

#[test]
fn no_order_of_the_kits_plates_and_no_circle_is_missing() {
    let cymbals = ["crash", "ride", "splash"].map(reference::cymbal);
    let hats = reference::hi_hat();
    for cymbal in cymbals.into_iter().chain([hats.top, hats.bottom]) {
        let plate = PlateModes::new(&cymbal.plate(), 21_000.0).unwrap();
        let highest = plate.shells.iter().map(|shell| shell.m).max().unwrap();
        assert!(highest >= 40, "{highest}");
        for m in 0..=highest {
            let circles = plate.shells.iter().filter(|shell| shell.m == m).map(|shell| shell.n);
            let first = if m < 2 { 1 } else { 0 };
            assert!(circles.clone().eq((first..).take(circles.count())), "order {m}");
            assert!(plate.shells.iter().any(|shell| shell.m == m), "order {m}");
        }
    }
}

#[test]
fn waves_along_a_thin_rim_are_slower() {
    let spec = PlateSpec { rise: 0.0, ..cap_crash() };
    let even = PlateModes::new(&spec, 2000.0).unwrap();
    let tapered = PlateModes::new(&PlateSpec { taper: 0.5, ..spec }, 2000.0).unwrap();
    // They are as fast as the rim is thick, 0.75 of the mean, and reach inward less the more nodes they have.
    let ratio = |m| hz(&tapered, m, 0) / hz(&even, m, 0);
    assert!((0.75..0.9).contains(&ratio(14)) && ratio(14) < ratio(6) && ratio(6) < ratio(3));
}

#[test]
fn a_bell_holds_what_bends_the_middle() {
    let cap = PlateModes::new(&cap_crash(), 8000.0).unwrap();
    let belled = PlateModes::new(&PlateSpec { bell: Some(BELL), ..cap_crash() }, 8000.0).unwrap();
    for n in 4..8 {
        let ratio = hz(&belled, 0, n) / hz(&cap, 0, n);
        assert!((1.2..1.6).contains(&ratio), "(0, {n}): {ratio}");
    }
    // What moves the rim alone does not feel it.
    assert_close(hz(&belled, 10, 0), hz(&cap, 10, 0), 1e-3);
}

#[test]
fn a_limit_out_of_range_is_refused() {
    let refused = PlateModes::new(&cap_crash(), 10.0).unwrap_err().to_string();
    assert!(refused.starts_with("highest mode (Hz) is 10"), "{refused}");
}
