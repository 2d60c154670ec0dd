use std::f64::consts::PI;

use super::*;
use crate::math::bessel;

#[test]
fn on_the_axis_a_piston_has_its_closed_form() {
    // p = rho c v (1 - e^(-i k (s - z))) e^(-i k z), s the distance to the rim.
    let (a, z) = (0.2, 0.35);
    let point = ReceiverPosition { distance: z, inclination: 0.0, azimuth: 0.0 };
    let rayleigh = Rayleigh::new(a, point, 48);
    let ones = vec![1.0; 48];
    for omega in [300.0, 3000.0, 30_000.0] {
        let [re, im] = rayleigh.transfer(&Radiator { m: 0, radial: &ones, omega });
        let k = omega / SPEED_OF_SOUND;
        let (sin, cos) = (k * (a.hypot(z) - z)).sin_cos();
        // Over acceleration: divide by i omega.
        let scale = DENSITY * SPEED_OF_SOUND / omega;
        let (want_re, want_im) = (-scale * sin, scale * (1.0 - cos));
        let size = want_re.hypot(want_im);
        assert!((re - want_re).abs() < 1e-6 * size, "{omega}: {re} {want_re}");
        assert!((im - want_im).abs() < 1e-6 * size, "{omega}: {im} {want_im}");
    }
}

#[test]
fn far_away_only_the_volume_counts_at_low_frequency() {
    let point = ReceiverPosition { distance: 50.0, inclination: 0.5, azimuth: 0.0 };
    let rayleigh = Rayleigh::new(0.2, point, 32);
    let radial: Vec<f64> = rayleigh.radii().iter().map(|r| 1.0 - r * r).collect();
    let [re, im] = rayleigh.transfer(&Radiator { m: 0, radial: &radial, omega: 100.0 });
    let volume = 0.5 * PI * 0.04;
    assert!((re / (-DENSITY * volume / (TAU * 50.0)) - 1.0).abs() < 1e-3);
    assert!(im.abs() < 0.02 * re.abs());
    let [side, _] = rayleigh.transfer(&Radiator { m: 3, radial: &radial, omega: 100.0 });
    assert!(side.abs() < 1e-4 * re.abs());
}

/// The integral as it is written, over a fine polar grid of midpoints; the delay from the centre taken out.
fn summed(radius: f64, point: &ReceiverPosition, m: u32, shape: impl Fn(f64) -> f64, omega: f64) -> [f64; 2] {
    const RINGS: usize = 500;
    const SPOKES: usize = 720;
    let k = omega / SPEED_OF_SOUND;
    let place = {
        let [height, offset] = point.height_and_offset();
        [offset * point.azimuth.cos(), offset * point.azimuth.sin(), height]
    };
    let (mut re, mut im) = (0.0, 0.0);
    for ring in 0..RINGS {
        let r = radius * (ring as f64 + 0.5) / RINGS as f64;
        for spoke in 0..SPOKES {
            let angle = TAU * spoke as f64 / SPOKES as f64;
            let from = [r * angle.cos(), r * angle.sin(), 0.0];
            let d = from.iter().zip(&place).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
            let area = r * (radius / RINGS as f64) * (TAU / SPOKES as f64);
            // The member that is largest toward the point.
            let moved = shape(r / radius) * (f64::from(m) * (angle - point.azimuth)).cos();
            let (sin, cos) = (k * (point.distance - d)).sin_cos();
            re += area * moved * cos / d;
            im += area * moved * sin / d;
        }
    }
    [re, im].map(|part| -DENSITY / TAU * part)
}

#[test]
fn transfers_are_the_rayleigh_integral_summed_point_by_point_from_a_few_centimetres_to_a_room_away() {
    let points = [
        ReceiverPosition::over(0.05, 0.10, 2.0),
        ReceiverPosition::over(0.07, 0.14, -1.0),
        ReceiverPosition::over(0.08, 0.0, 0.0),
        ReceiverPosition { distance: 0.5, inclination: 0.6, azimuth: 0.4 },
        ReceiverPosition::far(1.45, -3.0),
    ];
    for (radius, hz) in [(0.152, 140.0), (0.178, 900.0), (0.279, 60.0), (0.279, 1500.0)] {
        for point in &points {
            let rayleigh = Rayleigh::new(radius, *point, 40);
            for (m, n) in [(0, 1), (0, 4), (1, 1), (2, 2), (4, 1), (7, 2)] {
                let zero = bessel::zero(m, n);
                let shape = |r: f64| libm::jn(m as i32, zero * r);
                let radial: Vec<f64> = rayleigh.radii().iter().map(|&r| shape(r)).collect();
                let omega = TAU * hz;
                let [re, im] = rayleigh.transfer(&Radiator { m, radial: &radial, omega });
                let [want_re, want_im] = summed(radius, point, m, shape, omega);
                // What is as far below the whole face as this is rounding and no sound.
                let face = DENSITY * radius * radius / point.distance;
                let off = (re - want_re).hypot(im - want_im);
                assert!(
                    off < 2e-4 * want_re.hypot(want_im) + 1e-6 * face,
                    "({m}, {n}) at {hz} Hz, {point:?}: {re} {im} for {want_re} {want_im}"
                );
            }
        }
    }
}

#[test]
fn far_away_a_mode_with_nodal_diameters_fades_as_the_power_of_the_angle_and_the_frequency() {
    // Of the far field, `2 pi i^m int J_m(k r sin) R r dr`, the leading term is `(k a sin)^m`.
    let heard = |m: u32, sin: f64, omega: f64| {
        let point = ReceiverPosition { distance: 200.0, inclination: sin.asin(), azimuth: 0.0 };
        let rayleigh = Rayleigh::new(0.15, point, 32);
        let zero = bessel::zero(m, 1);
        let radial: Vec<f64> = rayleigh.radii().iter().map(|&r| libm::jn(m as i32, zero * r)).collect();
        let [re, im] = rayleigh.transfer(&Radiator { m, radial: &radial, omega });
        re.hypot(im)
    };
    for m in [1, 2, 4] {
        let power = 2.0_f64.powi(m as i32);
        let [low, high, aside] =
            [(0.3, 300.0), (0.3, 600.0), (0.6, 300.0)].map(|(sin, omega)| heard(m, sin, omega));
        assert!((high / low / power - 1.0).abs() < 0.02, "{m}: {}", high / low);
        assert!((aside / low / power - 1.0).abs() < 0.02, "{m}: {}", aside / low);
    }
    assert!(heard(4, 0.6, 600.0) < 1e-4 * heard(0, 0.6, 600.0));
}

#[test]
fn a_disc_fills_the_half_space_right_over_it_and_half_of_it_at_its_rim() {
    let on_axis = ReceiverPosition { distance: 0.5, inclination: 0.0, azimuth: 0.0 };
    assert!((on_axis.fills(0.2) - (1.0 - 0.5 / 0.29_f64.sqrt())).abs() < 1e-9);
    assert!((ReceiverPosition::over(0.02, 0.1, 0.0).fills(0.2) - 0.86).abs() < 0.02);
    assert!((ReceiverPosition::over(0.02, 0.2, 0.0).fills(0.2) - 0.46).abs() < 0.03);
    // Far off, its area as it is seen over 2 pi.
    let far = ReceiverPosition { distance: 10.0, inclination: 1.0, azimuth: 0.0 };
    assert!((far.fills(0.2) / (0.5 * 0.04 * far.inclination.cos() / 100.0) - 1.0).abs() < 0.01);
}
