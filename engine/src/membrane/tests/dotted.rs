//! Heads with a dot, against finite differences along the radius.

use nalgebra::DMatrix;

use super::super::dot::DotSpec;
use super::super::*;
use crate::contact::Material;
use crate::damping::LossLaw;

const CELLS: usize = 400;

fn spec(youngs_modulus: f64, dot: Option<DotSpec>) -> MembraneSpec {
    MembraneSpec {
        radius: 0.1778,
        thickness: 0.254e-3,
        plies: 1,
        material: Material { youngs_modulus, ..Material::FILM },
        loss: LossLaw::NONE,
        edge: None,
        dot,
        mesh: None,
    }
}

fn dot(thickness: f64) -> DotSpec {
    DotSpec { diameter: 0.36 * 2.0 * 0.1778, thickness, loss: LossLaw::NONE }
}

/// Angular frequencies of order `m` in vacuum (rad/s), lowest first: the energies `T |grad w|^2`, `D (laplace w)^2` and `s w'^2` on cells
/// of the radius.
fn by_differences(spec: &MembraneSpec, m: u32, tension: f64) -> Vec<f64> {
    let (a, cells) = (spec.radius, CELLS as f64);
    let step = a / cells;
    let middle = |i: usize| (i as f64 + 0.5) * step;
    let laplace = DMatrix::from_fn(CELLS, CELLS, |i, k| {
        let (inner, outer) = (i as f64 * step, (i as f64 + 1.0) * step);
        let flux = match (i, k) {
            // At the rim, half a cell away, it does not move.
            _ if i == k && i + 1 == CELLS => -inner - 2.0 * outer,
            _ if i == k => -inner - outer,
            _ if k == i + 1 => outer,
            _ if i == k + 1 => inner,
            _ => 0.0,
        };
        let around = if i == k { (f64::from(m) / middle(i)).powi(2) } else { 0.0 };
        flux / (middle(i) * step * step) - around
    });
    let added = spec.added_by_dot().unwrap();
    let covered = |i: usize| middle(i) < added.reach * a;
    let rigidity = |i: usize| spec.flexural_rigidity() + if covered(i) { added.rigidity } else { 0.0 };
    let mass = |i: usize| spec.area_density() + if covered(i) { added.density } else { 0.0 };
    let stiff = DMatrix::from_fn(CELLS, CELLS, |i, k| middle(i) * rigidity(i) * laplace[(i, k)]);
    let bent = laplace.transpose() * stiff;
    let reduced = DMatrix::from_fn(CELLS, CELLS, |i, k| {
        let pulled = -tension * middle(i) * laplace[(i, k)];
        (pulled + bent[(i, k)]) / (mass(i) * middle(i) * mass(k) * middle(k)).sqrt()
    });
    eigen::symmetric(reduced).values.into_iter().map(|square| square.sqrt()).collect()
}

/// The same from the head's own modes and what the dot adds between them.
fn by_modes(spec: &MembraneSpec, m: u32, tension: f64) -> Vec<f64> {
    let range = ModeRange { reference_tension: tension, limit_hz: 4000.0 };
    let head = Membrane::new(*spec, Surroundings::Vacuum, &range).unwrap();
    let modes: Vec<_> = head.modes().iter().filter(|mode| mode.m == m).collect();
    let matrix = |of: &dyn Fn(usize, usize) -> f64| DMatrix::from_fn(modes.len(), modes.len(), of);
    let own = spec.area_density() * spec.area();
    let mass = matrix(&|i, k| head.added(modes[i], modes[k]).0 + if i == k { own } else { 0.0 });
    let stiffness = matrix(&|i, k| {
        head.added(modes[i], modes[k]).1 + if i == k { head.restoring(modes[i], tension) } else { 0.0 }
    });
    let root = mass.cholesky().unwrap().l();
    let half = root.solve_lower_triangular(&stiffness).unwrap();
    let reduced = root.solve_lower_triangular(&half.transpose()).unwrap();
    eigen::symmetric(reduced).values.into_iter().map(|square| square.sqrt()).collect()
}

#[test]
fn a_dot_moves_modes_as_finite_differences_have_it() {
    // Bending makes what the head does at the dot's edge finer than the modes that it is made of.
    for (youngs_modulus, within) in [(1.0, 5e-4), (4.5e9, 2e-3)] {
        let spec = spec(youngs_modulus, Some(dot(0.254e-3)));
        for m in 0..3 {
            let (exact, solved) = (by_differences(&spec, m, 3000.0), by_modes(&spec, m, 3000.0));
            for n in 0..5 {
                let error = solved[n] / exact[n] - 1.0;
                assert!(error.abs() < within, "E {youngs_modulus}, ({m}, {}): {error:.5}", n + 1);
            }
        }
    }
}

#[test]
fn a_dotted_head_is_tuned_by_the_modes_that_the_dot_makes() {
    let spec = spec(4.5e9, Some(dot(0.254e-3)));
    let range = ModeRange { reference_tension: 3000.0, limit_hz: 4000.0 };
    let head = Membrane::new(spec, Surroundings::Vacuum, &range).unwrap();
    for (m, n) in [(0, 1), (1, 1), (0, 2)] {
        let omega = by_modes(&spec, m, 3000.0)[n as usize - 1];
        let tension = head.tension_for(m, n, omega / std::f64::consts::TAU).unwrap();
        assert!((tension / 3000.0 - 1.0).abs() < 1e-9, "({m}, {n}): {tension}");
    }
    // It needs more than without.
    let bare = Membrane::new(MembraneSpec { dot: None, ..spec }, Surroundings::Vacuum, &range).unwrap();
    let [heavy, light] = [&head, &bare].map(|head| head.tension_for(0, 1, 200.0).unwrap());
    assert!(heavy > 1.2 * light && heavy < 1.8 * light, "{heavy} {light}");
}

#[test]
fn what_a_dot_adds_is_never_negative_and_nothing_where_it_is_thin() {
    let head = |dot| {
        let range = ModeRange { reference_tension: 3000.0, limit_hz: 3000.0 };
        Membrane::new(spec(4.5e9, dot), Surroundings::Air, &range).unwrap()
    };
    let dotted = head(Some(dot(0.254e-3)));
    for m in [0, 1, 5] {
        let modes: Vec<_> = dotted.modes().iter().filter(|mode| mode.m == m).collect();
        let matrix = DMatrix::from_fn(modes.len(), modes.len(), |i, k| dotted.added(modes[i], modes[k]).0);
        let values = eigen::symmetric(matrix).values;
        let most = values.last().copied().unwrap();
        assert!(values[0] > -1e-12 * most && most > 0.0, "{values:?}");
    }
    let (thin, none) = (head(Some(dot(1e-12))), head(None));
    for (one, other) in thin.modes().iter().zip(none.modes()) {
        let [one, other] = [thin.ringing(one, 3000.0), none.ringing(other, 3000.0)];
        assert!((one.omega / other.omega - 1.0).abs() < 1e-7);
    }
}
