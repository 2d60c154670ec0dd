mod dotted;
mod vented;
mod woven;

use super::*;
use crate::block::BLOCK;
use crate::build_context::BuildOptions;
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
