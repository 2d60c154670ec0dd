mod dotted;
mod woven;

use super::*;
use crate::contact::Material;
use crate::damping::{EdgeSpec, LossLaw};

fn timpani() -> MembraneSpec {
    MembraneSpec {
        radius: 0.3302,
        thickness: 0.19e-3,
        plies: 1,
        material: Material::FILM,
        loss: LossLaw::NONE,
        edge: None,
        dot: None,
        mesh: None,
    }
}

fn range(tension: f64) -> ModeRange {
    ModeRange { reference_tension: tension, limit_hz: 1500.0 }
}

fn frequency(membrane: &Membrane, m: u32, n: u32, tension: f64) -> f64 {
    let mode = membrane.modes().iter().find(|mode| (mode.m, mode.n) == (m, n)).unwrap();
    membrane.ringing(mode, tension).omega / std::f64::consts::TAU
}

#[test]
fn second_mode_of_an_ideal_membrane_is_1_593_times_the_first() {
    let spec = MembraneSpec { thickness: 0.02e-3, ..timpani() };
    let membrane = Membrane::new(spec, Surroundings::Vacuum, &range(2729.0)).unwrap();
    let ratio = frequency(&membrane, 1, 1, 2729.0) / frequency(&membrane, 0, 1, 2729.0);
    assert!((ratio - 1.593_340_5).abs() < 1e-5, "{ratio}");
}

#[test]
fn timpani_head_in_air_has_the_measured_ratios() {
    let membrane = Membrane::new(timpani(), Surroundings::Air, &range(2729.0)).unwrap();
    assert!((timpani().area_density() * timpani().area() - 0.0904).abs() < 1e-4);
    let principal = frequency(&membrane, 1, 1, 2729.0);
    for (m, computed, measured) in [(2, 1.470, 1.48), (3, 1.922, 1.92), (4, 2.363, 2.36), (5, 2.797, 2.78)] {
        let ratio = frequency(&membrane, m, 1, 2729.0) / principal;
        assert!((ratio / computed - 1.0).abs() < 0.002, "({m},1): {ratio} for {computed}");
        assert!((ratio / measured - 1.0).abs() < 0.01, "({m},1): {ratio} for {measured}");
    }
}

#[test]
fn the_tension_for_a_pitch_gives_that_pitch() {
    let membrane = Membrane::new(timpani(), Surroundings::Air, &range(2729.0)).unwrap();
    for pitch in [110.0, 130.8, 160.0] {
        let tension = membrane.tension_for(1, 1, pitch).unwrap();
        assert!((frequency(&membrane, 1, 1, tension) / pitch - 1.0).abs() < 1e-9);
    }
}

#[test]
fn a_mount_takes_from_modes_that_pull_on_the_whole_drum_alone() {
    let ringing = |mount| {
        let edge = EdgeSpec { resistance: 400.0, corner_hz: 200.0, mount };
        let spec = MembraneSpec { edge: Some(edge), ..timpani() };
        let membrane = Membrane::new(spec, Surroundings::Air, &range(2729.0)).unwrap();
        membrane.modes().iter().map(|mode| (mode.m, membrane.ringing(mode, 2729.0).sigma)).collect::<Vec<_>>()
    };
    for ((m, free), (_, held)) in ringing(0.0).into_iter().zip(ringing(7.0)) {
        let expected = if m <= 1 { 7.0 } else { 0.0 };
        assert!((held - free - expected).abs() < 1e-9, "order {m}: {free} to {held} 1/s");
    }
}

#[test]
fn an_edge_takes_the_same_from_every_mode_above_its_corner() {
    let edge = EdgeSpec { resistance: 400.0, corner_hz: 200.0, mount: 0.0 };
    let spec = MembraneSpec { thickness: 0.02e-3, edge: Some(edge), ..timpani() };
    let membrane = Membrane::new(spec, Surroundings::Vacuum, &range(2729.0)).unwrap();
    for mode in membrane.modes() {
        let ringing = membrane.ringing(mode, 2729.0);
        // sigma = T Re Y / a, but for the little that the film's stiffness adds to the frequency.
        let law = 2729.0 * edge.mobility(ringing.omega) / spec.radius;
        assert!((ringing.sigma / law - 1.0).abs() < 1e-3, "({}, {}): {ringing:?} {law}", mode.m, mode.n);
        // Rellich: the mean square slope around the rim is k^2.
        let around = if mode.m == 0 { 1.0 } else { 0.5 };
        let k = mode.zero / spec.radius;
        assert!((around * membrane.rim_slope(mode).powi(2) / (k * k) - 1.0).abs() < 1e-12);
        let step = 1e-5;
        let shape = membrane.radial_shapes(&[1.0 - step]);
        let at = membrane.modes().iter().position(|other| other == mode).unwrap();
        let slope = -shape[at] / (step * spec.radius);
        assert!((slope / membrane.rim_slope(mode) - 1.0).abs() < 1e-2, "{slope}");
    }
}
