use std::sync::Arc;

use super::*;
use crate::building::Pace;
use crate::kit_document::KitDocument;
use crate::midi::assignments::Assignments;

/// What a filter lets through of a sine at a frequency given as a share of the host's rate.
fn gain(factor: usize, share: f64) -> f64 {
    let step = 2.0 * PI * share / factor as f64;
    let [mut real, mut imaginary] = [0.0; 2];
    for (index, tap) in low_pass(factor).into_iter().enumerate() {
        real += f64::from(tap) * (step * index as f64).cos();
        imaginary += f64::from(tap) * (step * index as f64).sin();
    }
    real.hypot(imaginary)
}

#[test]
fn what_folds_back_is_kept_away_and_what_is_heard_is_not() {
    for factor in [2, 3, 18, 23] {
        for step in 0..100 {
            let (heard, folded) = (0.36 * f64::from(step) / 100.0, 0.54 + 0.05 * f64::from(step));
            assert!((gain(factor, heard) - 1.0).abs() < 2e-3, "{factor}: {heard} {}", gain(factor, heard));
            if folded < factor as f64 / 2.0 {
                let most = if folded < 0.65 { 1e-3 } else { 3e-5 };
                assert!(gain(factor, folded) < most, "{factor}: {folded} {}", gain(factor, folded));
            }
        }
    }
}

#[test]
fn the_engine_runs_at_the_lowest_multiple_it_can() {
    for (rate, expected) in [
        (48_000.0, Some(1)),
        (22_050.0, Some(1)),
        (22_049.0, Some(2)),
        (8000.0, Some(3)),
        (1234.5678, Some(18)),
        (1000.0, Some(23)),
        (999.0, None),
        (768_000.0, Some(1)),
        (1_536_000.0, Some(1)),
        (1_536_001.0, None),
        (0.0, None),
        (-8000.0, None),
        (f64::NAN, None),
        (f64::INFINITY, None),
    ] {
        assert_eq!(factor(rate), expected, "{rate} Hz");
    }
    assert!(Decimation::new(1).is_none());
}

#[test]
fn the_filter_does_not_overshoot_the_ceiling() {
    let (factor, taps) = (3, low_pass(3));
    let mut channel = vec![0.0; (SPAN - 1 + CHUNK) * factor];
    // The worst that a filter can be given.
    channel.iter_mut().zip(&taps).for_each(|(sample, tap)| *sample = 4.0 * tap.signum());
    let mut heard = [0.0; CHUNK];
    decimate(&taps, factor, &mut channel, &mut heard);
    let loudest = heard.iter().fold(0.0_f32, |most, sample| most.max(sample.abs()));
    assert!(loudest > 2.0 && loudest < 4.0, "{loudest}");
}

/// A stroke on the floor tom at 8 kHz, a quarter of a second in buffers of a length, and the same at 24 kHz.
fn stroke(buffer: usize) -> (Vec<f32>, Vec<f32>) {
    let factor = factor(8000.0).unwrap();
    let document = KitDocument::standard();
    let performer = || {
        let mut performer = Performer::new(24_000.0, &document, Arc::new(Assignments::default()));
        performer.install_kit(24_000.0, Pace::RealTime).unwrap();
        performer.note_on(41, 0.8, 0);
        performer
    };
    let mut decimation = Decimation::new(factor).unwrap();
    let (mut low, mut right) = (vec![0.0; 2000], vec![0.0; 2000]);
    let mut playing = performer();
    for (left, right) in low.chunks_mut(buffer).zip(right.chunks_mut(buffer)) {
        decimation.render_outputs(&mut playing, [left, right], &mut []);
    }
    let (mut high, mut right) = (vec![0.0; 6000], vec![0.0; 6000]);
    performer().render(&mut high, &mut right);
    (low, high)
}

#[test]
fn a_tom_at_a_low_rate_is_the_tom_whatever_the_buffers() {
    let (low, high) = stroke(2000);
    // The filter passes what a tom has below 3 kHz and delays it by half its length.
    let delay = SPAN * 3 / 2;
    let energy = |of: &mut dyn Iterator<Item = f32>| of.map(|x| f64::from(x).powi(2)).sum::<f64>();
    let parted = energy(&mut (100..1900).map(|at| {
        let between = (3 * at + 2 - delay, 3 * at + 3 - delay);
        low[at] - 0.5 * (high[between.0] + high[between.1])
    }));
    let whole = energy(&mut low.iter().copied());
    assert!(whole > 1e-3 && parted < 0.02 * whole, "{parted} of {whole}");
    for buffer in [1, 7, 32, 33, 500] {
        assert_eq!(stroke(buffer).0, low, "buffers of {buffer}");
    }
}
