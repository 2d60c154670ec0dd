//! Drums whose batter is a mesh.

use super::super::modes::DrumModes;
use super::super::{DrumSpec, HeadSpec};
use crate::error::SpecError;
use crate::membrane::mesh::MeshSpec;
use crate::reference;

/// The rack tom's shell under a batter of that flow resistance (Pa s/m), without another head.
fn woven(flow_resistance: f64) -> DrumSpec {
    let tom = reference::drum("rack-tom");
    let mesh = Some(MeshSpec { flow_resistance, open: 0.4 });
    DrumSpec { batter: HeadSpec { mesh, ..tom.batter }, resonant: None, tension_field: None, ..tom }
}

#[test]
fn a_mesh_sends_out_a_hundredth_and_loses_to_its_flow() {
    let [tight, open] = [1000.0, 2.0].map(|flow| DrumModes::new(&woven(flow)).unwrap());
    let place = tight.heads.scale.place(reference::drum("rack-tom").pitch_hz);
    for order in [0, 1] {
        let first = |drum: &DrumModes| drum.modes.iter().find(|mode| mode.m == order).cloned().unwrap();
        let (tight, open) = (first(&tight), first(&open));
        let level = 20.0 * (open.monopole_area(&place) / tight.monopole_area(&place)).log10();
        assert!((-45.0..-20.0).contains(&level), "order {order}: {level}");
    }
    // At rest in its flow the weave loses R / (2 s) beside what the film does.
    let spec = woven(2.0);
    let flow = 0.5 * 2.0 / spec.membrane(&spec.batter).area_density();
    let still = DrumSpec { edge: None, ..spec };
    let lowest = DrumModes::new(&still).unwrap().modes[0].at(&place);
    let film = still.batter.loss.sigma(lowest.omega);
    assert!((lowest.sigma / (film + flow) - 1.0).abs() < 0.1, "{} {film} {flow}", lowest.sigma);
}

#[test]
fn what_escapes_a_mesh_leaves_the_shell_below() {
    let drum = DrumModes::new(&woven(2.0)).unwrap();
    let place = drum.heads.scale.place(reference::drum("rack-tom").pitch_hz);
    let lowest = drum.modes.iter().find(|mode| mode.m == 0).unwrap();
    let head = &drum.heads.batter.membrane;
    let slip = head.slip(&head.modes()[0], lowest.at(&place).omega);
    // Per unit displacement of the head, as a piston as wide: what of it the air follows.
    let film = head.volume(&head.modes()[0]) / head.spec().area();
    let left = lowest.outlet(&place);
    assert!((left.abs() / (film.abs() * slip.velocity) - 1.0).abs() < 0.02, "{left} {film} {slip:?}");
}

#[test]
fn nothing_is_stretched_below_a_mesh() {
    let tom = reference::drum("rack-tom");
    let below = DrumSpec { resonant: tom.resonant, ..woven(2.0) };
    let Err(SpecError::Refused { field, .. }) = below.check() else { panic!("it was accepted") };
    assert_eq!(field, "resonant");
    woven(2.0).check().unwrap();
}
