mod dotted;
mod vented;
mod woven;

use super::*;
use crate::block::BLOCK;
use crate::build_context::BuildOptions;
use crate::mode::ModeKind;
use crate::reference;

const RATE: f64 = 44_100.0;

#[test]
fn a_hand_changes_losses_and_no_frequency() {
    let context = reference::standard("rack-tom").context(BuildOptions::new(RATE));
    let mut drum = Drum::new(&reference::drum("rack-tom"), &context).unwrap();
    let retunings = |drum: &Drum| drum.surface.body().retunings();
    let losses = |drum: &Drum| drum.surface.body().modes().iter().map(|mode| mode.sigma).sum::<f64>();
    let (before, open) = (retunings(&drum), losses(&drum));
    // As a player's pressure does: another firmness in every block.
    for block in 0..400 {
        drum.choke(f64::from(block) / 200.0);
        drum.follow_controls();
        drum.advance_controls(BLOCK as f64 / RATE);
    }
    assert_eq!(retunings(&drum), before);
    assert!(losses(&drum) > 1.5 * open, "{} {open}", losses(&drum));
    drum.choke(0.0);
    drum.finish_controls();
    assert_eq!(losses(&drum), open);
    drum.set_tuning(1.1 * reference::drum("rack-tom").pitches()[1]);
    drum.finish_controls();
    assert!(retunings(&drum) > before);
}

#[test]
fn a_hand_lies_under_a_cross_stick_and_has_left_before_the_next_stroke() {
    let context = reference::standard("snare").context(BuildOptions::new(RATE));
    let mut drum = Drum::new(&reference::drum("snare"), &context).unwrap();
    let strike = |striker| Strike { speed: 2.0, radius: 0.3, angle: 0.0, striker };
    let mut losses_after = |striker| {
        drum.strike(&strike(striker));
        drum.surface.body().modes().iter().map(|mode| mode.sigma).sum::<f64>()
    };
    let open = losses_after(Striker::Stick);
    let under = losses_after(Striker::CrossStick);
    assert!(under > 1.2 * open, "{under} {open}");
    assert_eq!(losses_after(Striker::CrossStick), under);
    assert_eq!(losses_after(Striker::RimShot), open);
}

#[test]
fn a_pillow_takes_from_every_mode_at_every_pitch() {
    let spec = reference::drum("kick");
    let context = reference::standard("kick").context(BuildOptions::new(RATE));
    let mut drum = Drum::new(&spec, &context).unwrap();
    let [low, _, high] = spec.pitches();
    let sigmas =
        |drum: &Drum| -> Vec<f64> { drum.surface.body().modes().iter().map(|mode| mode.sigma).collect() };
    for step in 0..=60 {
        drum.set_tuning(low * (high / low).powf(f64::from(step) / 60.0));
        drum.set_muffling(0.0);
        drum.finish_controls();
        let open = sigmas(&drum);
        drum.set_muffling(1.0);
        drum.finish_controls();
        let gains = sigmas(&drum).iter().zip(&open).filter(|(muffled, open)| muffled < open).count();
        assert_eq!(gains, 0, "step {step}");
    }
}

#[test]
fn losses_go_on_where_the_complete_modes_end() {
    for name in ["kick", "snare", "rack-tom", "floor-tom"] {
        let context = reference::standard(name).context(BuildOptions::new(RATE));
        let drum = Drum::new(&reference::drum(name), &context).unwrap();
        let modes = drum.modes();
        let slices = modes.iter().filter(|mode| mode.kind == ModeKind::Sampled);
        let top = slices.clone().map(|mode| mode.frequency_hz).fold(f64::INFINITY, f64::min);
        let batter = modes.iter().filter(|mode| mode.kind == ModeKind::Complete && mode.body == "batter");
        // Modes that share their motion with the other head lose what it loses: half of a snare's just
        // below the slices, a few of the others'. The lower quartile keeps to the batter.
        let quartile = |modes: Vec<&ModeInfo>, from: f64, to: f64| {
            let some = modes.into_iter().filter(|mode| (from..to).contains(&mode.frequency_hz));
            let mut rates: Vec<f64> = some.map(|mode| SIGMA_T60 / mode.t60).collect();
            rates.sort_by(f64::total_cmp);
            rates[rates.len() / 4]
        };
        let below = quartile(batter.collect(), top / 1.26, top);
        let above = quartile(slices.collect(), top, 1.26 * top);
        println!("{name}: {below:.1} 1/s below {top:.0} Hz, {above:.1} above");
        // Films lose more by their frequency, a fifth.
        assert!((0.8..1.35).contains(&(above / below)), "{name}: {below} 1/s below {top} Hz, {above} above");
    }
}
