use std::f64::consts::TAU;

use super::inaudible_modes::InaudibleModes;
use super::*;

fn single(frequency_hz: f64, sigma: f64, mass: f64, rate: f64) -> (ModalBody, InputVector) {
    let mode = Mode { omega: TAU * frequency_hz, sigma, mass };
    let body = ModalBody::new(vec![mode], rate);
    let mut input = InputVector::new(1);
    input.shape_mut()[0] = 1.0;
    body.connect(&mut input);
    (body, input)
}

/// Phase of the state, rad, and its size.
fn polar(body: &ModalBody) -> (f64, f64) {
    let (re, im) = (f64::from(body.state.re[0]), f64::from(body.state.im[0]));
    (im.atan2(re), re.hypot(im))
}

/// Frequency (Hz) and decay (1/s) of a free mode over `seconds`, from its phase and size.
fn measured(body: &mut ModalBody, seconds: f64) -> (f64, f64) {
    let steps = (seconds / body.dt).round() as u64;
    body.state.re[0] = 1.0;
    let (start, _) = polar(body);
    let expected = body.modes[0].omega_d() * body.dt;
    // The phase is followed by counting: each sample it moves by about the expected angle.
    let mut phase = start;
    for _ in 0..steps {
        body.step();
        let (now, _) = polar(body);
        let turns = ((phase + expected - now) / TAU).round();
        phase = now + turns * TAU;
    }
    let time = steps as f64 * body.dt;
    ((phase - start) / (TAU * time), -polar(body).1.ln() / time)
}

#[test]
fn frequency_over_eight_seconds_is_within_a_twentieth_of_a_cent() {
    for rate in [44_100.0, 96_000.0] {
        for frequency in [10.0, 33.3, 100.0, 1000.0, 0.2 * rate, 0.25 * rate, 0.45 * rate] {
            let (mut body, _) = single(frequency, 0.7, 0.1, rate);
            let (got, _) = measured(&mut body, 8.0);
            let asked = body.modes[0].omega_d() / TAU;
            let cents = 1200.0 * (got / asked).log2();
            assert!(cents.abs() < 0.05, "{frequency} Hz at {rate}: {cents} cents");
        }
    }
}

#[test]
fn decay_is_within_a_thousandth() {
    for rate in [44_100.0, 192_000.0] {
        for (frequency, sigma) in
            [(20.0, 0.6), (100.0, 1.2), (440.0, 5.0), (3000.0, 40.0), (7919.0, 1.0), (18_371.0, 2.0)]
        {
            let (mut body, _) = single(frequency, sigma, 0.1, rate);
            let (_, got) = measured(&mut body, (4.0 / sigma).min(8.0));
            assert!((got / sigma - 1.0).abs() < 1e-3, "{frequency} Hz at {rate}: {got} for {sigma}");
        }
    }
}

#[test]
fn a_held_force_bends_every_mode_by_its_static_deflection() {
    for rate in [44_100.0, 96_000.0] {
        for frequency in [10.0, 100.0, 3000.0, 0.3 * rate, 0.449 * rate] {
            // Damped enough to settle within the test.
            let sigma = 0.02 * TAU * frequency;
            let (mut body, input) = single(frequency, sigma, 0.2, rate);
            for _ in 0..(20.0 / sigma * rate) as usize + 100 {
                body.step();
                body.push(&input, 3.0);
            }
            let exact = 3.0 / (0.2 * (TAU * frequency).powi(2));
            let ratio = f64::from(body.displacement(0)) / exact;
            assert!((ratio - 1.0).abs() < 1e-3, "{frequency} Hz at {rate}: {ratio}");
        }
    }
}

#[test]
fn the_work_of_a_held_force_is_the_energy_gained() {
    let (mut body, input) = single(180.0, 0.0, 0.05, 44_100.0);
    let mut work = 0.0;
    for sample in 0..400 {
        let force = 20.0 * (f64::from(sample) * 0.05).sin();
        let before = body.displacement_at(&input);
        body.step();
        body.push(&input, force as f32);
        work += force * (body.displacement_at(&input) - before);
    }
    assert!((work / body.energy() - 1.0).abs() < 1e-4, "{work} against {}", body.energy());
}

#[test]
fn a_body_bent_but_still_is_silent() {
    let (mut body, input) = single(300.0, 60.0, 0.05, 44_100.0);
    let mut weights = ReceiverWeights::new(vec![[0.7, -0.4]]);
    body.tune(&mut weights);
    let [direct, ..] = weights.direct_at(&body, &input);
    let mut loudest = 0.0_f32;
    for sample in 0..44_100 {
        body.step();
        body.push(&input, 5.0);
        let pressure = body.listen(&weights)[0] + 5.0 * direct;
        loudest = loudest.max(pressure.abs());
        if sample > 22_050 {
            assert!(pressure.abs() < 1e-5 * loudest, "{pressure} of {loudest}");
        }
    }
}

#[test]
fn modes_above_half_the_rate_are_silent() {
    let (mut body, input) = single(23_000.0, 1.0, 0.1, 44_100.0);
    assert_eq!(body.compliance(&input, &input), 0.0);
    body.push(&input, 10.0);
    body.step();
    assert!(body.is_still());
    let (mut body, input) = single(21_000.0, 1.0, 0.1, 44_100.0);
    body.push(&input, 10.0);
    body.step();
    assert!(!body.is_still());
}

#[test]
fn retuning_keeps_displacement_and_velocity() {
    let (mut body, input) = single(120.0, 3.0, 0.1, 48_000.0);
    for _ in 0..50 {
        body.step();
        body.push(&input, 30.0);
    }
    let before = (body.displacement(0), body.velocity(0));
    body.retune(1.7);
    let after = (body.displacement(0), body.velocity(0));
    assert_eq!(before.0, after.0);
    assert!((before.1 / after.1 - 1.0).abs() < 1e-6);
    assert!((body.modes()[0].omega / (TAU * 204.0) - 1.0).abs() < 1e-12);
}

/// A body of many ringing modes, and its receiver weights.
fn choir(kernels: Kernels) -> (ModalBody, ReceiverWeights) {
    let modes: Vec<Mode> = (0..333)
        .map(|k| Mode { omega: 200.0 * (1.0 + 1.7 * k as f64), sigma: 1.0 + 0.1 * k as f64, mass: 0.1 })
        .collect();
    let transfer = (0..modes.len()).map(|k| [(k as f64).sin(), (k as f64 * 0.3).cos()]).collect();
    let mut body = ModalBody::new(modes, 44_100.0);
    body.set_kernels(kernels);
    let mut input = InputVector::new(body.len());
    for (k, shape) in input.shape_mut().iter_mut().take(333).enumerate() {
        *shape = (0.9 * k as f32).cos();
    }
    body.connect(&mut input);
    let mut weights = ReceiverWeights::new(transfer);
    body.tune(&mut weights);
    body.push(&input, 50.0);
    (body, weights)
}

/// What [`choir`] does, in `f64`, by the closed form.
fn choir_by_closed_form(samples: usize) -> Vec<f64> {
    let dt = 1.0 / 44_100.0;
    (1..=samples)
        .map(|n| {
            (0..333)
                .map(|k| {
                    let k = f64::from(k);
                    let (omega, sigma): (f64, f64) = (200.0 * (1.0 + 1.7 * k), 1.0 + 0.1 * k);
                    let force = 50.0 * f64::from((0.9 * k as f32).cos());
                    let lambda = nalgebra::Complex::new(-sigma, (omega * omega - sigma * sigma).sqrt());
                    let start = ((lambda * dt).exp() - 1.0) / (lambda * 0.1 * lambda.im) * force;
                    let transfer = nalgebra::Complex::new(k.sin(), (k * 0.3).cos());
                    (transfer * lambda * lambda * start * (lambda * dt * n as f64).exp()).im
                })
                .sum()
        })
        .collect()
}

#[test]
fn every_kernel_follows_the_closed_form() {
    let exact = choir_by_closed_form(32 * 20);
    let peak = exact.iter().fold(0.0_f64, |peak, x| peak.max(x.abs()));
    for kernels in [Kernels::baseline(), Kernels::detect()] {
        let (mut body, weights) = choir(kernels);
        let mut out = vec![0.0; exact.len()];
        out.chunks_mut(32).for_each(|block| ring(&mut body, &weights, block));
        for (got, want) in out.iter().zip(&exact) {
            assert!((f64::from(*got) - want).abs() < 2e-5 * peak, "{}: {got} {want}", kernels.name());
        }
    }
}

#[test]
fn ringing_does_not_depend_on_how_time_is_cut() {
    let (mut whole, weights) = choir(Kernels::detect());
    let (mut cut, _) = choir(Kernels::detect());
    let (mut stepped, _) = choir(Kernels::detect());
    let (mut a, mut b) = (vec![0.0; 96], vec![0.0; 96]);
    a.chunks_mut(32).for_each(|block| ring(&mut whole, &weights, block));
    b.chunks_mut(7).for_each(|block| ring(&mut cut, &weights, block));
    (0..96).for_each(|_| stepped.step());
    assert_eq!(a, b);
    assert_eq!(whole.state.im.as_slice(), cut.state.im.as_slice());
    assert_eq!(whole.state.im.as_slice(), stepped.state.im.as_slice());
    assert!((stepped.listen(&weights)[0] - a[95]).abs() < 1e-4 * a[95].abs().max(1.0));
}

#[test]
fn quiet_modes_become_exactly_zero() {
    let (mut body, _) = single(500.0, 30.0, 0.1, 44_100.0);
    body.state.im[0] = 1e-18;
    for _ in 0..44_100 {
        body.step();
        body.flush_quiet();
    }
    assert!(body.is_still());
}

#[test]
fn modes_that_sleep_early_are_missed_by_less_than_the_bound() {
    let (mut early, weights) = choir(Kernels::detect());
    let (mut late, _) = choir(Kernels::detect());
    let mut inaudible = InaudibleModes::new(early.len());
    early.update_thresholds(&mut inaudible, &weights, 0, None);
    let (mut missed, mut sooner) = (0.0_f32, 0);
    for _ in 0..60_000 {
        let (mut a, mut b) = ([0.0; 32], [0.0; 32]);
        ring(&mut early, &weights, &mut a);
        ring(&mut late, &weights, &mut b);
        early.flush_inaudible(&inaudible);
        late.flush_quiet();
        missed = a.iter().zip(b).fold(missed, |most, (a, b)| most.max((a - b).abs()));
        sooner += usize::from(early.is_still() && !late.is_still());
    }
    assert!(missed > 0.0 && missed < 2e-5, "{missed} Pa");
    assert!(sooner > 100, "sooner still in {sooner} blocks");
    assert!(late.is_still());
}

/// Pressure at the near receiver.
fn ring(body: &mut ModalBody, weights: &ReceiverWeights, out: &mut [f32]) {
    let mut rows = [[0.0; simd::MAX_RUN]; RECEIVERS];
    let samples = out.len();
    let mut runs = rows.each_mut().map(|row| &mut row[..samples]);
    runs[0] = out;
    body.ring(0, weights, runs);
}

#[test]
fn the_energies_of_the_octaves_are_the_energy() {
    use crate::snapshot::{FIRST_OCTAVE, OCTAVES};
    for octave in [0, 4, OCTAVES - 1] {
        let hertz = 1.4 * FIRST_OCTAVE * f64::from(1 << octave);
        let (mut body, input) = single(hertz, 1.0, 0.2, 96_000.0);
        (0..20).for_each(|_| {
            body.push(&input, 3.0);
            body.step();
        });
        let octaves = body.energy_by_octave();
        assert!((f64::from(octaves[octave]) / body.energy() - 1.0).abs() < 1e-6 && body.energy() > 0.0);
        assert_eq!(octaves.iter().filter(|&&energy| energy > 0.0).count(), 1);
    }
}

#[test]
fn a_mode_damped_past_critical_sounds_through_either_part_of_a_transfer_alike() {
    let loudest = |transfer: [f64; 2], sigma: f64| {
        let (mut body, input) = single(107.0, sigma, 0.15, 44_100.0);
        let mut receiver = ReceiverWeights::new(vec![transfer]);
        body.tune(&mut receiver);
        (0..4410).fold(0.0_f32, |loudest, i| {
            body.step();
            if i < 40 {
                body.push(&input, 50.0);
            }
            loudest.max(body.listen(&receiver)[0].abs())
        })
    };
    for sigma in [3.0, 100.0, 600.0, 816.0, 3000.0] {
        let [real, imaginary] = [[1.0, 0.0], [0.0, 1.0]].map(|transfer| loudest(transfer, sigma));
        assert!((0.3..3.0).contains(&(imaginary / real)), "{sigma} 1/s: {imaginary} for {real}");
    }
}
