//! The clock: CPU time of a workload and of the calibration loop, in turns.

use cpu_time::ThreadTime;
use overhear_engine::kit::BLOCK;

use super::calibration::{Calibration, SLICES};
use super::workload::Workload;
use crate::progress::Progress;

/// Quantiles of the time of a block that are reported.
pub(super) const QUANTILES: [(&str, f64); 5] =
    [("50", 0.5), ("90", 0.9), ("99", 0.99), ("99.9", 0.999), ("100", 1.0)];

/// Cost of a scene, over the runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// CPU seconds per second of sound, median.
    pub share: f64,
    /// The same over the CPU seconds of the calibration loop, median of the runs' ratios.
    pub calibrations: f64,
    /// Least and greatest of those ratios.
    pub spread: [f64; 2],
    /// CPU seconds of the whole loop, median.
    pub calibration_s: f64,
    /// CPU time of the longest block, s: the least over the runs.
    pub longest_s: f64,
}

/// CPU time of every block of a scene in their order, the least over the runs, s.
///
/// Each run renders the same; what a block took longer in one was the machine's doing.
#[derive(Debug, Clone, Default)]
pub struct Blocks(Vec<f64>);

/// CPU time of a host's buffers, of what they last, shortest first.
#[derive(Debug, Clone, Default)]
pub struct Buffers(Vec<f64>);

impl Buffers {
    /// Of so many blocks each, in several scenes; the rate is in Hz.
    pub fn of(scenes: &[Blocks], blocks: usize, rate: f64) -> Buffers {
        let buffers = scenes.iter().flat_map(|scene| scene.0.chunks_exact(blocks));
        let times = buffers.map(|times| times.iter().sum::<f64>()).collect();
        Buffers::timed(times, (blocks * BLOCK) as f64 / rate)
    }

    /// Of buffers that took so long, s, and last as long as a deadline, s.
    pub fn timed(times: Vec<f64>, deadline: f64) -> Buffers {
        let mut shares: Vec<f64> = times.into_iter().map(|time| time / deadline).collect();
        shares.sort_by(f64::total_cmp);
        Buffers(shares)
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// How many take longer than they last.
    pub fn late(&self) -> usize {
        self.0.iter().filter(|&&share| share > 1.0).count()
    }

    /// The share of the deadline that so many buffers stay within.
    pub fn within(&self, quantile: f64) -> f64 {
        let last = self.0.len().saturating_sub(1);
        self.0.get((quantile * last as f64).round() as usize).copied().unwrap_or(0.0)
    }
}

/// Plays a workload so many times, once more beforehand to warm the caches.
pub fn runs(workload: &mut Workload, runs: usize, progress: &mut Progress) -> (Cost, Blocks) {
    let mut calibration = Calibration::new();
    let seconds = workload.scene().seconds();
    let mut shares = Vec::new();
    let mut ratios = Vec::new();
    let mut loops = Vec::new();
    let mut least: Vec<f64> = Vec::new();
    for run in 0..=runs {
        let (times, unit) = once(workload, &mut calibration);
        if run == 0 {
            least = vec![f64::INFINITY; times.len()];
            continue;
        }
        least.iter_mut().zip(&times).for_each(|(least, &time)| *least = least.min(time));
        let share = times.iter().sum::<f64>() / seconds;
        shares.push(share);
        ratios.push(share / unit);
        loops.push(unit);
        progress.advance(1);
    }
    let [share, calibration_s] = [&mut shares, &mut loops].map(|values| median(values));
    let calibrations = median(&mut ratios);
    // `median` has sorted them.
    let spread = [ratios[0], ratios[ratios.len() - 1]];
    let longest_s = least.iter().copied().fold(0.0, f64::max);
    (Cost { share, calibrations, spread, calibration_s, longest_s }, Blocks(least))
}

/// One run: CPU time of every block, and of the whole calibration loop, s.
fn once(workload: &mut Workload, calibration: &mut Calibration) -> (Vec<f64>, f64) {
    workload.rewind();
    let blocks = workload.blocks();
    let slice = blocks.div_ceil(SLICES as usize);
    let mut times = Vec::with_capacity(blocks);
    let (mut unit, mut slices) = (0.0, 0);
    while times.len() < blocks {
        unit += calibration.slice();
        slices += 1;
        for _ in 0..slice.min(blocks - times.len()) {
            let start = ThreadTime::now();
            workload.block();
            times.push(start.elapsed().as_secs_f64());
        }
    }
    (times, unit * f64::from(SLICES) / f64::from(slices))
}

/// The median; sorts.
fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 { values[middle] } else { 0.5 * (values[middle - 1] + values[middle]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_of_an_even_number_lies_between_the_middle_two() {
        assert_eq!(median(&mut [4.0, 1.0, 3.0, 2.0]), 2.5);
        assert_eq!(median(&mut [5.0, 1.0, 3.0]), 3.0);
    }

    #[test]
    fn quantiles_are_of_sorted_buffers() {
        let scenes = [Blocks(vec![3.0, 1.0]), Blocks(vec![2.0])];
        let rate = BLOCK as f64;
        let blocks = Buffers::of(&scenes, 1, rate);
        assert_eq!([0.0, 0.5, 1.0].map(|q| blocks.within(q)), [1.0, 2.0, 3.0]);
        // Two blocks last twice as long; a rest that is too short for a buffer is dropped.
        assert_eq!(Buffers::of(&scenes, 2, rate).within(1.0), 2.0);
        // One that takes all of its time is not late.
        assert_eq!([blocks.late(), blocks.count()], [2, 3]);
    }
}
