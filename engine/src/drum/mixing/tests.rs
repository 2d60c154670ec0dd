use std::f64::consts::TAU;

use super::*;
use crate::drum::lugs::LugsSpec;
use crate::drum::spec::DrumSpec;
use crate::drum::tension_field::TensionFieldSpec;
use crate::math::bessel;
use crate::math::eigen;
use crate::mode_mixture::blocks::BLOCK;
use crate::reference;

const DRAWN: TensionFieldSpec = TensionFieldSpec { rms: 0.05, correlation: 0.3, seed: 7 };
const FIELD: Unevenness = Unevenness { field: Some(DRAWN), lugs: None };

/// A rack tom with modes up to a frequency (Hz).
fn tom(modes_to_hz: f64) -> DrumModes {
    let mut spec: DrumSpec = reference::drum("rack-tom");
    spec.batter.modes_to_hz = modes_to_hz;
    spec.resonant = spec.resonant.map(|head| crate::drum::ResonantSpec { modes_to_hz, ..head });
    spec.tension_field = Some(DRAWN);
    DrumModes::new(&spec).unwrap()
}

fn axis(m: u32) -> f64 {
    0.3 * f64::from(m)
}

fn mixed(even: &[EvenMode], drum: &DrumModes) -> usize {
    even.iter().filter(|mode| mode.pair < drum.kept).count()
}

/// What the fields add to the stiffness between two modes, each pair by itself.
fn coupling(problem: &Problem, i: usize, j: usize) -> f64 {
    let mut rows = [vec![0.0; problem.weights.len()], vec![0.0; problem.weights.len()]];
    problem.coupling(i, j, &problem.overlaps(i, j, &mut rows))
}

#[test]
fn a_coupling_is_the_sum_over_the_heads_of_tension_times_slopes() {
    let lugs = LugsSpec { count: 6, rms: 0.05, seed: 2 };
    let hoop = reference::drum("rack-tom").hoop.unwrap();
    for uneven in [FIELD, Unevenness { field: None, lugs: Some((lugs, hoop)) }] {
        compare_couplings(&uneven);
    }
}

fn compare_couplings(uneven: &Unevenness) {
    let drum = tom(900.0);
    let even = even_modes(&drum);
    let even = &even[mixed(&even, &drum)..];
    let problem = Problem::new(&drum, uneven, even, axis);
    // Slopes by differences on a fine grid of each head, with the field drawn at its radii.
    let (rings, spokes) = (160, 160);
    let radii: Vec<f64> = (0..rings).map(|i| (f64::from(i) + 0.5) / f64::from(rings)).collect();
    let weights: Vec<f64> = radii.iter().map(|r| 2.0 * r / f64::from(rings)).collect();
    let step = 1e-4;
    let direct = |i: usize, j: usize| -> f64 {
        let heads = [Some(&drum.heads.batter), drum.heads.resonant.as_ref()];
        let mut sum = 0.0;
        for (far, head) in heads.into_iter().flatten().enumerate() {
            let field = TensionField::of_head(uneven, head.membrane.spec(), far as u32, &radii, &weights);
            let shape = |k: usize, r: f64, theta: f64| -> f64 {
                let mode = &drum.modes[even[k].pair];
                let (first, count) = head.order(mode.m);
                let skip = if far == 1 { drum.heads.batter.order(mode.m).1 } else { 0 };
                let parts = (0..count).map(|n| {
                    let head_mode = &head.membrane.modes()[first + n];
                    mode.reference.vector[skip + n] * head_mode.norm * bessel::j(mode.m, head_mode.zero * r)
                });
                let turn = f64::from(mode.m) * (theta - axis(mode.m));
                let around = if even[k].member == Member::Cosine { turn.cos() } else { turn.sin() };
                around * parts.sum::<f64>()
            };
            let slopes = |k: usize, r: f64, theta: f64| {
                let along = shape(k, r + step, theta) - shape(k, r - step, theta);
                let across = shape(k, r, theta + step) - shape(k, r, theta - step);
                [along / (2.0 * step), across / (2.0 * step * r)]
            };
            for (at, (&r, weight)) in radii.iter().zip(&weights).enumerate() {
                for spoke in 0..spokes {
                    let theta = TAU * f64::from(spoke) / f64::from(spokes);
                    let [a, b] = [slopes(i, r, theta), slopes(j, r, theta)];
                    let product = a[0] * b[0] + a[1] * b[1];
                    let harmonics = field.harmonics.iter().enumerate();
                    let tension: f64 = harmonics
                        .map(|(l, harmonic)| {
                            let (sin, cos) = (l as f64 * theta).sin_cos();
                            harmonic.tension[0][at] * cos + harmonic.tension[1][at] * sin
                        })
                        .sum();
                    sum += PI * head.tensions[MIDDLE] * weight * tension * product / f64::from(spokes);
                }
            }
        }
        sum
    };
    let scale = problem.mode(0).omega.powi(2);
    for (i, j) in [(0, 0), (0, 1), (2, 5), (3, 9), (7, 8)] {
        let (here, there) = (coupling(&problem, i, j), direct(i, j));
        assert!((here - there).abs() < 2e-4 * scale, "{i} {j}: {here} for {there} of {scale}");
        assert!((here - coupling(&problem, j, i)).abs() < 1e-9 * scale);
    }
}

#[test]
fn blocks_come_to_what_one_large_problem_does() {
    let drum = tom(1900.0);
    let even = even_modes(&drum);
    let even = &even[mixed(&even, &drum)..];
    assert!(even.len() > BLOCK + BLOCK / 2, "{} modes", even.len());
    let problem = Problem::new(&drum, &FIELD, even, axis);
    let even_omegas: Vec<f64> = (0..problem.mixed.len()).map(|i| problem.mode(i).omega).collect();
    let (omegas, rows) = blocks::solve(&even_omegas, |modes| problem.couplings(modes));
    let full = DMatrix::from_fn(even.len(), even.len(), |i, j| {
        coupling(&problem, i, j) + if i == j { problem.mode(i).omega.powi(2) } else { 0.0 }
    });
    let solved = eigen::symmetric(full);
    let cents: Vec<f64> = omegas
        .iter()
        .zip(&solved.values)
        .map(|(omega, square)| 1200.0 * (omega / square.sqrt()).log2())
        .collect();
    let rms = (cents.iter().map(|cents| cents * cents).sum::<f64>() / cents.len() as f64).sqrt();
    assert!(rms < 3.0, "{rms} cents");
    // Rotations: rows are of unit length and, but for what was trimmed, at right angles.
    for (k, (first, row)) in rows.iter().enumerate() {
        assert!((row.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-12);
        for (other_first, other) in &rows[..k] {
            let low = (*first).max(*other_first);
            let high = (first + row.len()).min(other_first + other.len());
            let product: f64 = (low..high).map(|i| row[i - first] * other[i - other_first]).sum();
            assert!(product.abs() < 0.05, "{k}: {product}");
        }
    }
}

#[test]
fn mixed_modes_follow_the_pitch_and_have_names_of_their_own() {
    let drum = tom(900.0);
    let mixed = MixedModes::new(&drum, &FIELD, axis);
    let mut names = mixed.names.clone();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), mixed.len());
    let pitches = drum.heads.scale.pitches();
    let [low, high] = [0, MIDDLE].map(|pitch| drum.heads.scale.place(pitches[pitch]));
    let ratio = pitches[MIDDLE] / pitches[0];
    for k in 0..mixed.len() {
        let (a, b) = (mixed.at(k, &low), mixed.at(k, &high));
        assert!(b.omega / a.omega > 1.0 && b.omega / a.omega < 1.15 * ratio, "{k}: {a:?} {b:?}");
        assert!(a.mass > 0.0 && a.sigma > 0.0 && a.batter + a.resonant <= 1.001);
    }
}

#[test]
fn a_mixture_bends_the_heads_by_the_squares_of_its_shares() {
    let drum = tom(900.0);
    let (even, mixed) = (even_modes(&drum), MixedModes::new(&drum, &FIELD, axis));
    let pitches = drum.heads.scale.pitches();
    // At pitches of the table and between two of them, where a mode of the air passes some of the heads'.
    for (pitch, each, all) in [(MIDDLE, 1e-5, 1e-5), (0, 1e-5, 1e-5), (3, 0.2, 0.02)] {
        let place = drum.heads.scale.place(pitches[pitch]);
        let (mut off, mut whole) = (0.0, 0.0);
        for k in 0..mixed.len() {
            let mut sums = [0.0; HEADS + 1];
            for (part, share) in mixed.mixture.parts(k) {
                let Bending { squares, held } = Bending::of(&drum, &drum.modes[even[part].pair], &place);
                let parts = [squares[0], squares[1], held];
                sums.iter_mut().zip(parts).for_each(|(sum, part)| *sum += share * share * part);
            }
            let Bending { squares, held } = mixed.bending(k, &place);
            for (ours, sum) in [squares[0], squares[1], held].into_iter().zip(sums) {
                assert!((ours - sum).abs() < each * sums[0].max(sums[1]), "{pitch}, {k}: {ours} for {sum}");
                off += (ours - sum).abs();
                whole += sum;
            }
        }
        assert!(off < all * whole, "{pitch}: {off} of {whole}");
    }
}
