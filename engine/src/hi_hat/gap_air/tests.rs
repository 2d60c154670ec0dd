//! What the air in the gap keeps, loses and sounds.

use super::*;
use crate::build_context::BuildOptions;
use crate::hi_hat::rigid::Mount;
use crate::hi_hat::rim_points;
use crate::modal::Mode;
use crate::random_field;
use crate::reference;
use std::f64::consts::TAU;

const RATE: f64 = 44_100.0;

/// The air of the hi-hat that is played, between two shells of one mode without nodal diameters and one pair with two.
fn air(lossless: bool) -> (GapAir, [ModalBody; 2], [Rigid; 2]) {
    let spec = reference::hi_hat();
    let plates = [spec.top.plate(), spec.bottom.plate()];
    let context = reference::standard("hi-hat").context(BuildOptions::new(RATE));
    let volumes = || {
        vec![
            Volume { mode: 0, m: 0, areas: [0.05, 0.0] },
            Volume { mode: 1, m: 2, areas: [0.01, 0.0] },
            Volume { mode: 2, m: 2, areas: [0.0, 0.01] },
        ]
    };
    let receivers = &context.receivers;
    let mut air =
        GapAir::new(plates.each_ref(), &[volumes(), volumes()], spec.edge, lossless, receivers, 1.0 / RATE);
    let shells = plates.map(|plate| {
        let mode = |hz: f64| Mode { omega: TAU * hz, sigma: 0.0, mass: plate.mass };
        ModalBody::new([400.0, 60.0, 62.0].map(mode).to_vec(), RATE)
    });
    let weights = ReceiverWeights::new(vec![[0.0; 2]; 3]);
    air.follow(shells.each_ref().map(|shell| (shell, &weights)));
    let mount = Mount { bounce_hz: 50.0, rock_hz: 2.0, q: 1e9, rock_q: None, damping: 0.0, reach: 0.1 };
    let rigid = plates.map(|plate| Rigid::new((plate.mass, plate.radius()), &mount, true, 1.0 / RATE));
    (air, shells, rigid)
}

fn energy(air: &GapAir, shells: &[ModalBody; 2], rigid: &[Rigid; 2]) -> f64 {
    let shells: f64 = shells.iter().map(ModalBody::energy).sum();
    air.energy() + shells + rigid.iter().map(|rigid| rigid.energy(0.0)).sum::<f64>()
}

/// Gaps that jump about, some closed.
fn gaps(seed: u32) -> [f64; POINTS] {
    std::array::from_fn(|j| 1e-3 * random_field::normal(seed, j as u32, 0, 0)[0])
}

#[test]
fn whatever_the_gap_does_energy_is_kept_without_losses_and_falls_with_them() {
    for lossless in [true, false] {
        let (mut air, mut shells, mut rigid) = air(lossless);
        rigid[0].set_speed([0.5, 0.2, -0.1]);
        let start = energy(&air, &shells, &rigid);
        let mut before = start;
        for sample in 0..20_000 {
            if sample % 8 == 0 {
                air.follow_gaps(&gaps(sample / 8), sample % 40 == 0);
            }
            rigid.iter_mut().for_each(Rigid::step);
            shells.iter_mut().for_each(ModalBody::step);
            air.step(shells.each_mut(), &mut rigid);
            let now = energy(&air, &shells, &rigid);
            // Single precision of the shells.
            assert!(now < before + 1e-7 * start, "sample {sample}: {before} J, then {now} J");
            before = now;
        }
        let left = before / start;
        assert!(if lossless { (left - 1.0).abs() < 1e-4 } else { left < 0.5 }, "{left}");
    }
}

#[test]
fn between_still_cymbals_it_is_helmholtz_s_resonator() {
    let (mut air, ..) = air(true);
    let gap = 1e-3;
    air.follow_gaps(&[gap; POINTS], true);
    let Outlet { compliance, inertance, .. } = air.outlets.at(GapPosition::of(gap));
    let want = (inertance * compliance[0]).sqrt().recip() / TAU;
    air.pressed[0] = 1.0;
    let (mut turns, mut before) = (0, 1.0);
    for _ in 0..RATE as usize {
        air.flow_on(&{ air.pressed });
        turns += i32::from(before < 0.0 && air.pressed[0] >= 0.0);
        before = air.pressed[0];
    }
    assert!((f64::from(turns) / want - 1.0).abs() < 0.01, "{turns} Hz, {want}");
    assert!((300.0..600.0).contains(&want), "{want} Hz");
    assert!((air.energy() - 0.5).abs() < 1e-9);
}

#[test]
fn slow_cymbals_press_all_out_and_nothing_is_heard_of_it() {
    let (mut air, mut shells, mut rigid) = air(false);
    air.follow_gaps(&[5e-3; POINTS], true);
    let mut loudest = [0.0_f32; 2];
    for sample in 0..44_100 {
        // A heave of 2 Hz, and a step of it.
        let speed = 0.1 * (TAU * 2.0 * f64::from(sample) / RATE).sin();
        rigid[0].set_speed([speed + if sample >= 33_000 { 0.1 } else { 0.0 }, 0.0, 0.0]);
        let heard = air.step(shells.each_mut(), &mut rigid)[0].abs();
        let loudest = &mut loudest[usize::from(sample >= 33_000)];
        *loudest = loudest.max(heard);
    }
    assert!(loudest[0] < 0.01 * loudest[1], "{loudest:?} Pa");
}

#[test]
fn an_uneven_gap_lets_modes_with_nodal_diameters_sound_as_a_monopole() {
    let monopole = |gaps: [f64; POINTS]| {
        let (mut air, mut shells, mut rigid) = air(false);
        air.follow_gaps(&gaps, true);
        let mut kick = crate::modal::InputVector::new(3);
        kick.shape_mut()[1] = 1.0;
        shells[0].connect(&mut kick);
        shells[0].push(&kick, 1.0);
        let mut sum = 0.0;
        for _ in 0..4410 {
            shells.iter_mut().for_each(ModalBody::step);
            air.step(shells.each_mut(), &mut rigid);
            sum += air.sources[0] * air.sources[0];
        }
        sum
    };
    let uneven = std::array::from_fn(|j| 1e-3 * (1.0 + 0.9 * (2.0 * rim_points::angle(j)).cos()));
    let [even, uneven] = [monopole([1e-3; POINTS]), monopole(uneven)];
    // Sectors take their turns one after the other, which is not quite even.
    assert!(even < 0.01 * uneven, "{even:e}, {uneven:e}");
}
