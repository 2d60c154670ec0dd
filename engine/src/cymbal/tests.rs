use super::*;
use crate::block::{BLOCK, FOLLOWED};
use crate::build_context::BuildOptions;
use crate::modal::RECEIVERS;
use crate::reference;
use crate::strike::{Strike, Striker};

const RATE: f64 = 44_100.0;

/// A cymbal that is struck, held by a moving hand that then closes firmly, and let go: its sound and its energy after each
/// block. The modes follow the hand once in `every` blocks.
fn choked(name: &str, every: usize) -> (Vec<f32>, Vec<f64>) {
    let context = reference::standard(name).context(BuildOptions::new(RATE));
    let mut cymbal = Cymbal::new(&reference::cymbal(name), &context).unwrap();
    cymbal.strike(&Strike { striker: Striker::Stick, speed: 5.0, radius: 0.9, angle: 0.3 });
    let (mut sound, mut energy) = (Vec::new(), Vec::new());
    for block in 0..1000 {
        let time = block as f64 * BLOCK as f64 / RATE;
        cymbal.choke(match time {
            0.1..0.3 => 0.15 * (1.0 - (30.0 * time).cos()),
            0.3..0.45 => 1.0,
            _ => 0.0,
        });
        if block % every == 0 {
            cymbal.follow_controls();
        }
        assert!(cymbal.surface_mut().settle());
        let mut out = [[0.0; BLOCK]; RECEIVERS];
        cymbal.surface_mut().render_in_air(out.each_mut().map(|out| &mut out[..]), None);
        cymbal.advance_controls(BLOCK as f64 / RATE);
        sound.extend(out[0]);
        energy.push(cymbal.surface().energy());
    }
    (sound, energy)
}

#[test]
fn a_hand_that_the_modes_follow_in_turns_sounds_as_one_that_they_follow_in_every_block() {
    for name in ["crash", "ride", "splash"] {
        let [(oracle, kept), (sound, energy)] = [1, FOLLOWED].map(|every| choked(name, every));
        // Level of every 20 ms, down to 60 dB under the loudest.
        let levels = |sound: &[f32]| -> Vec<f64> {
            let windows = sound.chunks_exact(882);
            windows.map(|window| window.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>()).collect()
        };
        let (wanted, got) = (levels(&oracle), levels(&sound));
        let loudest = wanted.iter().copied().fold(0.0, f64::max);
        let heard = wanted.iter().zip(&got).filter(|(wanted, _)| **wanted > 1e-6 * loudest);
        let apart = heard.map(|(wanted, got)| 10.0 * (got / wanted).log10().abs()).fold(0.0, f64::max);
        let largest = oracle.iter().fold(0.0_f32, |most, x| most.max(x.abs()));
        let off = oracle.iter().zip(&sound).fold(0.0_f32, |most, (a, b)| most.max((a - b).abs())) / largest;
        let late = |e: &[f64]| e[700];
        println!(
            "{name}: samples differ by {off:.1e} of the loudest, 20 ms by {apart:.3} dB, {:.2e} J of {:.2e} J are left",
            late(&energy),
            late(&kept)
        );
        // A swing stops wherever the modes follow, and goes on from there; the highs of a splash that stretches part in phase.
        assert!(off < 0.15, "{name}: {off}");
        // Nobody hears a quarter of a decibel of 20 ms.
        assert!(apart < 0.25, "{name}: {apart} dB");
        // Nothing comes from a hand: displacement and velocity stay what they are when the modes follow. What the sum of all
        // rises is above zero is the exchange of the nonlinear force, under the oracle as well.
        let rises = |energy: &[f64]| -> f64 {
            energy[150..].windows(2).map(|pair| (pair[1] - pair[0]).max(0.0)).sum::<f64>() / energy[150]
        };
        println!("{name}: energy rises by {:.1e}, the oracle's by {:.1e}", rises(&energy), rises(&kept));
        assert!(rises(&energy) <= 1e-5 + 1.25 * rises(&kept), "{name}");
    }
}

#[test]
fn felts_damp_the_bounce_as_it_is_damped_and_all_else_less_and_less() {
    let stand = reference::cymbal("crash").stand.unwrap();
    let bounce = TAU * stand.bounce_hz;
    assert!((felt_loss(&stand, bounce) / (bounce / (2.0 * stand.q)) - 1.0).abs() < 1e-12);
    // An octave up the stiffness is 2^(2/pi atan(1/3)) = 1.152 times as large, the loss 1.152 / 2 times.
    let octave = felt_loss(&stand, 2.0 * bounce) / felt_loss(&stand, bounce);
    assert!((octave - 0.5762).abs() < 1e-3, "{octave}");
}
