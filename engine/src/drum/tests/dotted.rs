//! Drums whose heads have a dot.

use super::super::modes::DrumModes;
use super::super::{Drum, DrumSpec, HeadSpec};
use crate::build_context::BuildOptions;
use crate::damping::LossLaw;
use crate::instrument::Instrument as _;
use crate::membrane::dot::DotSpec;
use crate::modal::RECEIVERS;
use crate::reference;
use crate::strike::{Strike, Striker};

/// The standard snare, evenly stretched.
fn even() -> DrumSpec {
    DrumSpec { tension_field: None, ..reference::drum("snare") }
}

/// The snare with a dot of that thickness (m) on its batter.
fn dotted(thickness: f64) -> DrumSpec {
    let snare = even();
    let loss = LossLaw { constant: 0.0, per_khz: 6.0 };
    let dot = Some(DotSpec { diameter: 0.127, thickness, loss });
    DrumSpec { batter: HeadSpec { dot, ..snare.batter }, ..snare }
}

#[test]
fn a_dot_next_to_nothing_is_no_dot() {
    let plain = DrumModes::new(&even()).unwrap();
    let spec = dotted(1e-10);
    let dot = spec.batter.dot.map(|dot| DotSpec { loss: LossLaw::NONE, ..dot });
    let with = DrumModes::new(&DrumSpec { batter: HeadSpec { dot, ..spec.batter }, ..spec }).unwrap();
    let place = plain.heads.scale.place(220.0);
    let mut compared = 0;
    // Above, each has modes next to them that are left out, not the same.
    let limit = 0.5 * std::f64::consts::TAU * spec.batter.modes_to_hz;
    for mode in plain.modes.iter().take_while(|mode| mode.at(&place).omega < limit) {
        let at = mode.at(&place);
        let near = |other: &&crate::drum::tuned::TunedMode| {
            other.m == mode.m && (other.at(&place).omega / at.omega - 1.0).abs() < 3e-4
        };
        let other = with.modes.iter().find(near).map(|other| other.at(&place));
        let other = other.unwrap_or_else(|| panic!("{} {}", mode.m, at.omega));
        assert!((other.sigma / at.sigma - 1.0).abs() < 1e-2, "{other:?} {at:?}");
        compared += 1;
    }
    assert!(compared > 15, "{compared}");
}

#[test]
fn a_dotted_drum_keeps_its_pitch_by_more_tension_and_its_modes_keep_their_energy() {
    let [plain, with] = [even(), dotted(0.25e-3)].map(|spec| DrumModes::new(&spec).unwrap());
    let place = plain.heads.scale.place(220.0);
    let [light, heavy] = [&plain, &with].map(|drum| drum.heads.batter.tension(&place));
    assert!(heavy > 1.2 * light, "{light} {heavy}");
    let tensions = [&plain, &with].map(|drum| drum.heads.resonant.as_ref().unwrap().tension(&place));
    assert!((tensions[0] / tensions[1] - 1.0).abs() < 1e-9, "{tensions:?}");
    for mode in &with.modes {
        let reference = &mode.reference;
        let share: f64 = reference.share.iter().sum();
        assert!(
            reference.sigma > 0.0 && reference.share.iter().all(|&share| share >= 0.0) && share <= 1.0 + 1e-9
        );
        let shares: f64 = reference.shares.iter().sum();
        assert!((shares - 1.0).abs() < 0.2, "{shares}");
    }
}

#[test]
fn a_lossless_dotted_drum_keeps_what_a_stroke_brings() {
    let standard = reference::standard("snare");
    let spec = DrumSpec { wires: None, hoop: None, high_band: false, ..dotted(0.25e-3) };
    let mut context = standard.context(BuildOptions::new(48e3));
    context.ideal.lossless = true;
    let mut drum = Drum::new(&spec, &context).unwrap();
    for radius in [0.0, 0.3, 0.5] {
        drum.strike(&Strike { speed: 3.0, radius, angle: 0.0, striker: Striker::Stick });
        let mut ring = |samples: usize| {
            let mut out = [[0.0; 32]; RECEIVERS];
            (0..samples / 32).for_each(|_| {
                drum.surface_mut().render_in_air(out.each_mut().map(|receiver| &mut receiver[..]), None);
            });
            drum.surface().energy()
        };
        let (early, late) = (ring(9600), ring(48_000));
        assert!(early > 0.0 && (late / early - 1.0).abs() < 1e-3, "{radius}: {early} {late}");
    }
}
