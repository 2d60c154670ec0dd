//! Drums whose shell has a vent.

use std::f64::consts::{PI, TAU};

use super::super::modes::DrumModes;
use super::super::{DrumSpec, HeadSpec, ResonantSpec, ShellSpec, modes_key};
use crate::air_load::{DENSITY, SPEED_OF_SOUND};
use crate::drum::coupled::{CoupledMode, SLOWEST};
use crate::drum::heads::{BareHeads, MIDDLE};
use crate::error::SpecError;
use crate::reference;

const RADIUS: f64 = 0.15;
/// Thickness of the standard kit's shells, m.
const WALL: f64 = 0.006;

/// A small, tight bass drum with a port and a vent of those diameters, m.
fn drum(port_diameter: Option<f64>, vent: Option<f64>) -> DrumSpec {
    let kick = reference::drum("kick");
    let [lowest_pitch_hz, pitch_hz, highest_pitch_hz] = [200.0, 200.0, 210.0];
    DrumSpec {
        diameter: 2.0 * RADIUS,
        pitch_hz,
        lowest_pitch_hz,
        highest_pitch_hz,
        batter: HeadSpec { modes_to_hz: 1500.0, ..kick.batter },
        resonant: kick.resonant.map(|head| ResonantSpec { port_diameter, ..head }),
        shell: kick.shell.map(|shell| shell.vented(vent)),
        tension_field: None,
        lugs: None,
        ..kick
    }
}

/// Every mode without nodal diameters in the middle of the range, lowest first, and what the heads and the air give at the lowest
/// pitch, m3/Pa.
fn solved(spec: &DrumSpec, pitch: usize) -> (Vec<CoupledMode>, f64) {
    let bare = BareHeads::new(spec).unwrap();
    let tables = bare.tables();
    let heads = bare.tuned(spec, &tables);
    let modes = heads.solve(spec, 0, &tables[0], heads.air(spec, 0).as_ref(), pitch);
    let both = [Some(&heads.batter), heads.resonant.as_ref()].into_iter().flatten();
    let given: f64 = both.map(|head| PI * spec.radius().powi(4) / (8.0 * head.tensions[pitch])).sum();
    let air = spec.cavity().unwrap().volume / (DENSITY * SPEED_OF_SOUND * SPEED_OF_SOUND);
    (modes, air + given)
}

/// Mass of the air in a vent per volume squared, kg/m4.
fn inertia(b: f64) -> f64 {
    DENSITY * (WALL + 16.0 / (3.0 * PI) * b) / (PI * b * b)
}

#[test]
fn a_vent_is_helmholtzs_resonator_with_walls_that_give() {
    for b in [0.003, 0.0127] {
        let (modes, given) = solved(&drum(None, Some(2.0 * b)), 0);
        let exact = 1.0 / (inertia(b) * given).sqrt();
        assert!((modes[0].omega / exact - 1.0).abs() < 0.03, "{} {}", modes[0].omega / TAU, exact / TAU);
    }
    let (closed, _) = solved(&drum(None, None), 0);
    let (vented, _) = solved(&drum(None, Some(0.0254)), 0);
    assert_eq!(vented.len(), closed.len() + 1);
    assert!(closed[0].omega > 2.0 * vented[0].omega);
}

#[test]
fn a_port_and_a_vent_are_one_wider_way_out() {
    let (port, vent) = (0.012, 0.009);
    let (modes, given) = solved(&drum(Some(2.0 * port), Some(2.0 * vent)), 0);
    let exact = ((2.0 * port / DENSITY + 1.0 / inertia(vent)) / given).sqrt();
    assert!((modes[0].omega / exact - 1.0).abs() < 0.03, "{} {}", modes[0].omega / TAU, exact / TAU);
    // In the lowest mode both move the same way, by the reciprocals of their masses; their air follows the heads' shares.
    let heads = modes[0].vector.len() - 2 - cavity_modes(&drum(None, None));
    let [through_port, through_vent] = [0, 1].map(|k| modes[0].vector[modes[0].vector.len() - 2 + k]);
    let ratio = through_port / through_vent;
    // Less than that through the port, which is at the end of a column of air, some hundredths of its own mass.
    let by = ratio / (inertia(vent) * 2.0 * port / DENSITY);
    assert!(by < 1.0 && by > 0.95, "{by}");
    assert!((modes[0].outlet / (through_port + through_vent) - 1.0).abs() < 1e-12);
    let kinetic: f64 = modes[0].shares[heads..][..2].iter().sum();
    assert!(kinetic > 0.5 && kinetic < 1.0, "{kinetic}");
    // In by one and out by the other is no mode: nothing pushes back.
    let (ported, _) = solved(&drum(Some(2.0 * port), None), 0);
    assert_eq!(modes.len(), ported.len());
}

/// Modes of the enclosed air without nodal diameters that are not the uniform spring.
fn cavity_modes(spec: &DrumSpec) -> usize {
    let heads = BareHeads::new(spec).unwrap().tuned(spec, &[]);
    heads.air(spec, 0).unwrap().modes.iter().filter(|mode| mode.omega > 0.0).count()
}

#[test]
fn half_way_along_nothing_is_pushed_by_what_is_odd_along_the_drum() {
    let spec = drum(None, Some(0.02));
    // Heads that are the same: motions along the drum and motions against each other do not mix.
    let resonant = spec.resonant.map(|head| ResonantSpec {
        pitch_ratio: 1.0,
        thickness: spec.batter.thickness,
        plies: spec.batter.plies,
        material: spec.batter.material,
        loss: spec.batter.loss,
        modes_to_hz: spec.batter.modes_to_hz,
        dot: spec.batter.dot,
        ..head
    });
    let spec = DrumSpec { resonant, ..spec };
    let tight = DrumSpec { shell: spec.shell.map(|shell| shell.vented(None)), ..spec };
    let ([vented, tight], mut along, mut against) = ([spec, tight].map(|spec| solved(&spec, MIDDLE).0), 0, 0);
    for mode in tight.iter().filter(|mode| mode.omega < TAU * 1200.0) {
        let near = vented.iter().map(|other| (other.omega / mode.omega - 1.0).abs());
        let near = near.fold(f64::INFINITY, f64::min);
        let heads = mode.vector[0] * mode.vector[heads_of_one(&tight[0], &spec)];
        // The batter's first mode into the drum and the other's out of it: along.
        if heads > 0.0 {
            assert!(near < 1e-9, "{} {near}", mode.omega / TAU);
            along += 1;
        } else {
            assert!(near > 1e-7, "{} {near}", mode.omega / TAU);
            against += 1;
        }
    }
    assert!(along > 3 && against > 3, "{along} {against}");
    // The order's own numbers: one half wave pushes on a hole in the wall by nothing, two by as much as none, the other way.
    let heads = BareHeads::new(&spec).unwrap().tuned(&spec, &[]);
    let air = heads.air(&spec, 0).unwrap();
    let push = |half_waves: u32| {
        let mode = air.modes.iter().find(|mode| mode.circles == 0 && mode.half_waves == half_waves).unwrap();
        mode.holes[0] / (PI * RADIUS * RADIUS)
    };
    let pushes = [0, 1, 2, 3].map(push);
    assert!(
        pushes.iter().zip([-1.0, 0.0, 1.0, 0.0]).all(|(a, b): (&f64, f64)| (a - b).abs() < 1e-12),
        "{pushes:?}"
    );
    assert!(air.modes.iter().filter(|mode| mode.circles > 0).all(|mode| mode.holes == [0.0; 2]));
}

/// Head modes of the batter.
fn heads_of_one(mode: &CoupledMode, spec: &DrumSpec) -> usize {
    (mode.vector.len() - cavity_modes(spec)) / 2
}

#[test]
fn a_vent_takes_from_what_presses_the_air() {
    let tom = reference::drum("rack-tom");
    let vented = DrumSpec { shell: tom.shell.map(|shell| shell.vented(Some(0.0127))), ..tom };
    let [tight, vented] = [tom, vented].map(|spec| DrumModes::new(&spec).unwrap());
    let place = tight.heads.scale.place(tom.pitch_hz);
    let first = |drum: &DrumModes, name: usize| {
        let mode = drum.modes.iter().find(|mode| mode.m == 0 && mode.name == name).unwrap();
        mode.at(&place)
    };
    let [before, after] = [&tight, &vented].map(|drum| first(drum, 0));
    // Far above their own resonance the air in the vent comes in as the heads press: the mode is higher by little, and pays for the jet.
    assert!(after.sigma > before.sigma, "{before:?} {after:?}");
    assert!((1.0..1.01).contains(&(after.omega / before.omega)), "{before:?} {after:?}");
    let others = |drum: &DrumModes| -> Vec<(f64, f64)> {
        let others = drum.modes.iter().filter(|mode| mode.m > 0);
        others.map(|mode| (mode.at(&place).omega, mode.at(&place).sigma)).collect()
    };
    assert_eq!(others(&tight), others(&vented));
}

#[test]
fn an_open_shell_has_no_vent_and_a_kettle_may_have_one() {
    let tom = reference::drum("rack-tom");
    let shell = tom.shell.map(|shell| shell.vented(Some(0.0127)));
    let vented = DrumSpec { shell, ..tom };
    assert_eq!(vented.check(), Ok(()));
    assert_eq!(vented.opened().check(), Ok(()));
    let error = DrumSpec { resonant: None, ..vented }.check().unwrap_err();
    let words = error.to_string();
    assert!(words.contains("shell.vent_diameter_m") && words.contains("resonant head"), "{words}");
    for wrong in [0.0019, 0.0501] {
        let shell = tom.shell.map(|shell| shell.vented(Some(wrong)));
        let error = DrumSpec { shell, ..tom }.check().unwrap_err();
        let SpecError::OutOfRange { field, min, max, .. } = error else { panic!("{error}") };
        assert_eq!((field.as_str(), min, max), ("shell.vent_diameter_m", 0.002, 0.05));
    }
    let timpani = reference::drum("timpani");
    let vent = DrumSpec { shell: timpani.shell.map(|shell| shell.vented(Some(0.025))), ..timpani };
    assert_eq!(vent.check(), Ok(()));
    let [tight, vented] = [timpani, vent].map(|spec| DrumModes::new(&spec).unwrap());
    let place = tight.heads.scale.place(timpani.pitch_hz);
    let lowest = |drum: &DrumModes| drum.modes.iter().find(|mode| mode.m == 0).unwrap().at(&place).omega;
    // Its air is a mode of its own below the head's, unless that is below hearing.
    assert!(lowest(&vented) < lowest(&tight), "{} {}", lowest(&vented), lowest(&tight));
}

#[test]
fn drums_that_differ_by_a_vent_have_keys_of_their_own() {
    let key = |vent| postcard::to_stdvec(&modes_key(&drum(None, vent))).unwrap();
    assert!(key(None) != key(Some(0.0127)) && key(Some(0.0127)) != key(Some(0.01)));
    // And one with neither is what it was: no hole, nothing more to solve for.
    let cavity = drum(None, None).cavity().unwrap();
    assert_eq!(cavity.holes, [None; 2]);
    let Some(ShellSpec::Cylinder { vent_diameter, .. }) = reference::drum("kick").shell else { panic!() };
    assert_eq!(vent_diameter, None);
}

#[test]
fn air_that_is_too_slow_to_be_a_mode_at_some_pitches_is_followed_through_them() {
    let followed = |diameter: f64| {
        let vent = drum(None, Some(diameter));
        let spec = DrumSpec { lowest_pitch_hz: 60.0, pitch_hz: 100.0, highest_pitch_hz: 240.0, ..vent };
        let drum = DrumModes::new(&spec).unwrap();
        let lowest = drum.modes.iter().find(|mode| mode.m == 0).unwrap();
        [60.0, 100.0, 240.0].map(|hz| lowest.at(&drum.heads.scale.place(hz)).omega)
    };
    let mut passing = 0;
    for tenths in (20..60).step_by(3) {
        let [low, middle, high] = followed(1e-4 * f64::from(tenths));
        if low < SLOWEST && high > SLOWEST {
            // Slack heads give more.
            assert!(low < middle && middle < high && high < 3.0 * low, "{tenths}: {low} {middle} {high}");
            passing += 1;
        }
    }
    assert!(passing > 0);
}
