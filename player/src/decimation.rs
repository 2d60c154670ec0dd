//! Hosts at sample rates too low for the engine: the kit is rendered at a whole multiple of such a rate, filtered and decimated.

use std::f64::consts::PI;

use overhear_engine::kit::{OUTPUTS, Stereo, limit};
use overhear_engine::piece::SAMPLE_RATES;

use crate::performer::Performer;

/// Lowest sample rate of a host, Hz: the lowest that validators try is 1,234.
pub const LOWEST_RATE: f64 = 1000.0;

/// Samples of the host's that the filter spans. *Judgement*: with the window used here, 90 dB of what would fold back below .35 of
/// the rate is kept away.
const SPAN: usize = 32;

/// Samples of the host's that are rendered at a time.
const CHUNK: usize = 32;

/// The channels of the main output and all others.
const CHANNELS: usize = 2 * (1 + OUTPUTS);

/// How many samples the engine renders for one of a host's at a sample rate (Hz): 1 wherever it can run at that rate.
/// `None` below [`LOWEST_RATE`] and above the engine's highest rate.
pub fn factor(host_rate: f64) -> Option<usize> {
    let within = (LOWEST_RATE..=*SAMPLE_RATES.end()).contains(&host_rate);
    within.then(|| (SAMPLE_RATES.start() / host_rate).ceil().max(1.0) as usize)
}

/// What is between the engine and a host at a rate below the engine's lowest.
#[derive(Debug)]
pub struct Decimation {
    factor: usize,
    /// The low-pass filter at the engine's rate, of sum 1.
    taps: Vec<f32>,
    /// For each channel what the filter still spans, then what is rendered.
    channels: Vec<Vec<f32>>,
}

impl Decimation {
    /// A filter at rest for a [`factor`]; `None` for 1, which needs none. Allocates.
    pub fn new(factor: usize) -> Option<Decimation> {
        let length = SPAN * factor;
        let taps = low_pass(factor);
        let channels = vec![vec![0.0; length - factor + CHUNK * factor]; CHANNELS];
        (factor > 1).then_some(Decimation { factor, taps, channels })
    }

    /// Renders the performer's next samples at the host's rate, delayed by half the filter, which is 16 samples. How a buffer
    /// is cut does not change them.
    ///
    /// # Real-time
    /// No allocation, no lock. The work is in proportion to the outputs that are there.
    pub fn render_outputs(
        &mut self,
        performer: &mut Performer,
        mut main: Stereo<'_>,
        outputs: &mut [Stereo<'_>],
    ) {
        let length = main[0].len().min(main[1].len());
        let mut now = 0;
        while now < length {
            let until = length.min(now + CHUNK);
            self.fill(performer, until - now, outputs);
            let (first, rest) = self.channels.split_at_mut(2);
            let heard = main.iter_mut().map(|channel| &mut **channel);
            let others = outputs.iter_mut().flatten().map(|channel| &mut **channel);
            for (channel, heard) in first.iter_mut().zip(heard).chain(rest.iter_mut().zip(others)) {
                if let Some(heard) = heard.get_mut(now..until) {
                    decimate(&self.taps, self.factor, channel, heard);
                }
            }
            now = until;
        }
    }

    /// Silence, as after an activation.
    pub fn reset(&mut self) {
        self.channels.iter_mut().for_each(|channel| channel.fill(0.0));
    }

    /// Renders so many of the host's samples behind what the filter spans; outputs that are empty stay so.
    fn fill(&mut self, performer: &mut Performer, samples: usize, outputs: &[Stereo<'_>]) {
        let from = (SPAN - 1) * self.factor;
        let stretch = from..from + samples * self.factor;
        let mut pairs = self.channels.chunks_exact_mut(2).map(|pair| {
            let [left, right] = pair else { return Stereo::default() };
            [left, right].map(|channel| channel.get_mut(stretch.clone()).unwrap_or_default())
        });
        let main = pairs.next().unwrap_or_default();
        let mut others: [Stereo<'_>; OUTPUTS] = std::array::from_fn(|at| {
            let used = outputs.get(at).is_some_and(|[left, right]| !left.is_empty() && !right.is_empty());
            pairs.next().filter(|_| used).unwrap_or_default()
        });
        performer.render_outputs(main, &mut others);
    }
}

/// Filters and decimates what was rendered into a channel, then moves what the filter still spans to its beginning.
fn decimate(taps: &[f32], factor: usize, channel: &mut [f32], heard: &mut [f32]) {
    let windows = channel.windows(taps.len()).step_by(factor);
    for (heard, window) in heard.iter_mut().zip(windows) {
        *heard = window.iter().zip(taps).map(|(sample, tap)| sample * tap).sum();
        // The filter overshoots where the engine's ceiling bends the sound.
        limit(heard);
    }
    let done = heard.len() * factor;
    channel.copy_within(done..done + taps.len() - factor, 0);
}

/// A low-pass filter of linear phase up to .45 of the host's rate: a sinc under a Blackman window.
fn low_pass(factor: usize) -> Vec<f32> {
    let length = SPAN * factor;
    let cutoff = 0.45 / factor as f64;
    let taps: Vec<f64> = (0..length)
        .map(|index| {
            let turn = 2.0 * PI * (index as f64 + 0.5) / length as f64;
            let window = 0.42 - 0.5 * turn.cos() + 0.08 * (2.0 * turn).cos();
            let time = 2.0 * PI * cutoff * (index as f64 + 0.5 - 0.5 * length as f64);
            window * if time == 0.0 { 1.0 } else { time.sin() / time }
        })
        .collect();
    let sum: f64 = taps.iter().sum();
    taps.iter().map(|tap| (tap / sum) as f32).collect()
}

#[cfg(test)]
mod tests;
