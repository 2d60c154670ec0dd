use std::f64::consts::TAU;

use super::*;
use crate::modal::Mode;

const RATE: f64 = 44_100.0;

/// A body at a sample rate: two rigid motions, modes to 2 kHz that count as coupled, and modes above, 12 Hz apart; a crash's inertia.
fn body_at(sigma: f64, rate: f64) -> (ModalBody, TransportSpec) {
    let mode = |hz: f64| Mode { omega: TAU * hz, sigma, mass: 1.1 };
    let mut modes = vec![mode(5.0), mode(20.0)];
    modes.extend((0..1400).map(|k| mode(250.0 + 12.0 * f64::from(k))));
    let coupled = modes.iter().filter(|mode| mode.omega < TAU * 2000.0).count();
    let spec = TransportSpec { rigid: 2, coupled, inertia: 1.08e-6, interval: 32.0 / rate };
    (ModalBody::new(modes, rate), spec)
}

fn body(sigma: f64) -> (ModalBody, TransportSpec) {
    body_at(sigma, RATE)
}

/// Nobody hears it.
fn unheard(body: &ModalBody) -> ReceiverWeights {
    ReceiverWeights::new(vec![[0.0; 2]; body.len()])
}

fn transport(spec: TransportSpec, body: &ModalBody) -> Transport {
    Transport::new(spec, body, &unheard(body)).unwrap()
}

/// Gives each mode up to a frequency (Hz) an energy (J), at phases that differ.
fn ring(body: &mut ModalBody, to_hz: f64, energy: f64) {
    let displacements: Vec<f32> = body
        .modes()
        .iter()
        .enumerate()
        .map(|(k, mode)| {
            let size = (2.0 * energy / mode.mass).sqrt() / mode.omega;
            if k >= 2 && mode.omega < TAU * to_hz { (size * (1.0 + (k as f64).sin())) as f32 } else { 0.0 }
        })
        .collect();
    body.set_displacements(&displacements);
}

fn run(body: &mut ModalBody, transport: &mut Transport, blocks: usize) {
    for _ in 0..blocks {
        (0..32).for_each(|_| body.step());
        transport.carry(body);
    }
}

/// Energy per mode of modes from one frequency to another, J.
fn mean(body: &ModalBody, [from, to]: [f64; 2]) -> f64 {
    let weights = BandWeights::new(body, &unheard(body));
    let at = |hz: f64| body.modes().iter().position(|mode| mode.omega >= TAU * hz).unwrap();
    let modes = at(from)..at(to);
    let count = modes.len() as f64;
    body.band_energy(modes, &weights).whole / count
}

#[test]
fn without_losses_all_energy_is_kept_and_spreads_upward_until_modes_are_equal() {
    let (mut body, spec) = body(0.0);
    let mut transport = transport(spec, &body);
    ring(&mut body, 2000.0, 2e-3);
    let before = body.energy();
    let mut last = 0.0;
    for _ in 0..10 {
        run(&mut body, &mut transport, 60);
        let balance = transport.balance();
        let all = body.energy() + balance.pending;
        assert!((all / before - 1.0).abs() < 1e-4, "{all} J of {before} J");
        assert!(balance.surplus().abs() < 1e-9 * balance.drained, "{balance:?}");
        assert!(balance.spent == 0.0 && balance.drained > last);
        last = balance.drained;
    }
    // The top of the coupled modes is drained; whoever couples them fills it again.
    let means = [[1420.0, 2000.0], [2000.0, 2800.0], [4000.0, 5600.0], [8000.0, 11_000.0]];
    let levels = means.map(|band| mean(&body, band));
    assert!(levels.is_sorted_by(|low, high| low > high), "{levels:?}");
    assert!(levels[1] > 0.5 * levels[0] && levels[3] > 0.0, "{levels:?}");
}

#[test]
fn no_step_creates_energy_and_nobody_pays_more_than_it_has() {
    let (mut body, spec) = body(3.0);
    let mut transport = transport(spec, &body);
    // A hundred times the constant, and strokes that leave bands empty and full.
    transport.set_rate(100.0 * fitted::ENERGY_TRANSPORT);
    let mut came = 0.0;
    for stroke in 0..50 {
        let before = body.energy();
        ring(&mut body, if stroke % 2 == 0 { 900.0 } else { 15_000.0 }, 1e-3);
        came += body.energy() - before;
        for _ in 0..20 {
            (0..32).for_each(|_| body.step());
            let before = body.energy() + transport.pending();
            transport.carry(&mut body);
            let after = body.energy() + transport.pending();
            assert!(after <= before * (1.0 + 1e-3), "{after} J after {before} J");
            assert!(transport.bands.iter().all(|band| band.pending >= 0.0));
        }
    }
    let balance = transport.balance();
    println!("{balance:?}, {came} J came");
    assert!(body.is_finite() && body.energy() <= came);
    let moved = balance.drained.abs() + balance.injected.abs();
    assert!(balance.surplus().abs() < 1e-6 * moved, "{balance:?}");
}

#[test]
fn soft_strokes_move_nothing_and_rest_gives_up_what_waits() {
    let (mut body, spec) = body(3.0);
    let mut transport = transport(spec, &body);
    ring(&mut body, 2000.0, 1e-7);
    run(&mut body, &mut transport, 100);
    assert_eq!(transport.balance(), TransportBalance::default());
    ring(&mut body, 2000.0, 1e-2);
    run(&mut body, &mut transport, 1);
    transport.rest(&mut body);
    let balance = transport.balance();
    assert!(balance.pending == 0.0 && balance.surplus().abs() <= 1e-9 * balance.drained, "{balance:?}");
    transport.reset();
    assert_eq!(transport.balance(), TransportBalance::default());
}

#[test]
fn after_a_reset_the_same_bits_come_again() {
    let (mut body, spec) = body(3.0);
    let mut transport = transport(spec, &body);
    let mut once = || {
        body.reset();
        transport.reset();
        ring(&mut body, 2000.0, 1e-3);
        run(&mut body, &mut transport, 100);
        body.displacements().to_vec()
    };
    assert_eq!(once(), once());
}

#[test]
fn the_implicit_step_is_that_of_a_dense_solution() {
    let (mut body, spec) = body(0.0);
    let mut transport = transport(spec, &body);
    ring(&mut body, 6000.0, 3e-3);
    (0..20).for_each(|_| transport.measure(&body));
    transport.conduct(2.0);
    transport.solve();
    // Backward Euler by many sweeps of Gauss and Seidel.
    let count = transport.bands.len();
    let mut energies = vec![0.0_f64; count];
    let through = |at: usize| transport.bands.get(at).map_or(0.0, |band| band.through);
    for _ in 0..20_000 {
        for at in 0..count {
            let band = &transport.bands[at];
            let (under, above) = (through(at), through(at + 1));
            let below = if at > 0 { under * energies[at - 1] } else { 0.0 };
            let over = if at + 1 < count { above * energies[at + 1] } else { 0.0 };
            energies[at] = (band.energy.whole + below + over) / (band.modes.len() as f64 + under + above);
        }
    }
    for (band, energy) in transport.bands.iter().zip(&energies) {
        assert!((band.mean / energy - 1.0).abs() < 1e-6, "{} {energy}", band.mean);
    }
}

#[test]
fn a_plate_that_is_tuned_up_carries_as_much_in_as_many_of_its_periods() {
    let carried = |tuning: f64| {
        let (mut body, spec) = body_at(0.0, RATE * tuning);
        let mut transport = transport(spec, &body);
        body.retune(tuning);
        transport.follow(&body, &unheard(&body));
        ring(&mut body, 2000.0 * tuning, 1e-3 * tuning * tuning);
        run(&mut body, &mut transport, 40);
        transport.balance().drained / (tuning * tuning)
    };
    let (low, high) = (carried(1.0), carried(1.25));
    assert!(low > 0.0 && (high / low - 1.0).abs() < 0.1, "{low} {high}");
}
