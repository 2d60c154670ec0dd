//! Heads that are woven.

use super::*;
use crate::membrane::mesh::MeshSpec;

fn woven(flow_resistance: Option<f64>) -> Membrane {
    let mesh = flow_resistance.map(|flow_resistance| MeshSpec { flow_resistance, open: 0.4 });
    let spec = MembraneSpec { loss: LossLaw::NONE, mesh, ..timpani() };
    Membrane::new(spec, Surroundings::Air, &range(2729.0)).unwrap()
}

#[test]
fn a_weave_without_holes_is_a_film() {
    let (film, weave) = (woven(None), woven(Some(1e9)));
    for (one, other) in film.modes().iter().zip(weave.modes()) {
        let slip = weave.slip(other, 600.0);
        assert!((slip.velocity - 1.0).abs() < 1e-6 && slip.lag.abs() < 1e-6, "{slip:?}");
        let (one, other) = (film.ringing(one, 2729.0), weave.ringing(other, 2729.0));
        assert!((one.omega / other.omega - 1.0).abs() < 1e-9);
        assert!(one.sigma == 0.0 && other.sigma < 1e-3, "{}", other.sigma);
    }
}

#[test]
fn a_weave_of_holes_rings_as_in_vacuum_and_loses_by_the_flow_alone() {
    const FLOW: f64 = 0.5;
    let vacuum = Membrane::new(timpani(), Surroundings::Vacuum, &range(2729.0)).unwrap();
    let open = woven(Some(FLOW));
    let sigma = 0.5 * FLOW / timpani().area_density();
    for (m, n) in [(0, 1), (1, 1), (2, 1), (0, 2)] {
        let apart = frequency(&open, m, n, 2729.0) / frequency(&vacuum, m, n, 2729.0) - 1.0;
        // The air between the threads weighs half a gram on a square metre.
        assert!((-4e-3..1e-6).contains(&apart), "{m} {n}: {apart}");
        let mode = open.modes().iter().find(|mode| (mode.m, mode.n) == (m, n)).unwrap();
        let found = open.ringing(mode, 2729.0).sigma;
        assert!((found / sigma - 1.0).abs() < 0.02, "{m} {n}: {found} {sigma}");
    }
}

#[test]
fn a_weave_is_tuned_as_a_film_is() {
    let open = woven(Some(8.0));
    let tension = open.tension_for(0, 1, 120.0).unwrap();
    assert!((frequency(&open, 0, 1, tension) / 120.0 - 1.0).abs() < 1e-9);
}
