//! Share of a sound's energy that is in lines.
//!
//! The power spectrum of 250 ms under a raised cosine, from 30 ms after the stroke on. A bin is in a line where it stands more
//! than 7 dB over the median of the 240 Hz around it. The figure is the share of the energy in such bins of each third octave from 1
//! to 10 kHz, averaged over the ten. Of noise it is about 0.2, of modes far apart 1; recorded drums have 0.17 to 0.22.

use super::one_shot::OneShot;
use crate::spectra::Frames;

/// Where the window begins after the stroke, and how long it is, s.
const START: f64 = 0.03;
const LENGTH: f64 = 0.25;

/// How far a line stands over the median, as a ratio of powers (7 dB).
const OVER: f64 = 5.012;

/// Half the width of what the median is taken of, Hz.
const AROUND_HZ: f64 = 120.0;

/// The lowest frequency, Hz, and the number of third octaves from there (ten to a decade).
const FROM_HZ: f64 = 1000.0;
const THIRDS: i32 = 10;

/// The share, 0 to 1; `None` of a sound that is too short or silent.
pub fn line_share(shot: &OneShot) -> Option<f64> {
    let length = (LENGTH * shot.rate).round() as usize;
    let (sound, start) = (shot.sound(), (START * shot.rate) as usize);
    if start + length > sound.len() {
        return None;
    }
    let powers: Vec<f64> = Frames::new(length).powers(sound, start as isize).collect();
    let bin_hz = shot.rate / length as f64;
    let reach = (AROUND_HZ / bin_hz).round() as usize;
    let shares = (0..THIRDS).map(|third| {
        let edge = |k: i32| (FROM_HZ * 10.0_f64.powf(f64::from(k) / 10.0) / bin_hz) as usize;
        let (mut all, mut lines) = (0.0, 0.0);
        for bin in edge(third)..edge(third + 1).min(powers.len()) {
            let around = &powers[bin.saturating_sub(reach)..(bin + reach + 1).min(powers.len())];
            let power = powers[bin];
            all += power;
            lines += if power > OVER * median(around) { power } else { 0.0 };
        }
        (all > 0.0).then(|| lines / all)
    });
    let shares = shares.collect::<Option<Vec<f64>>>()?;
    Some(shares.iter().sum::<f64>() / shares.len() as f64)
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    let middle = sorted.len() / 2;
    *sorted.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Chance;

    const RATE: f64 = 48_000.0;

    fn share(sample: impl FnMut(usize) -> f32) -> f64 {
        let samples: Vec<f32> = (0..24_000).map(sample).collect();
        line_share(&OneShot::new(&samples, RATE).unwrap()).unwrap()
    }

    #[test]
    fn noise_has_a_fifth_in_lines_whether_it_decays_or_not() {
        let mut chance = Chance::new(3);
        let steady = share(|_| chance.between(-1.0, 1.0) as f32);
        let decaying = share(|n| (chance.between(-1.0, 1.0) * (-(n as f64) / 4_800.0).exp()) as f32);
        assert!((0.1..0.3).contains(&steady) && (0.1..0.3).contains(&decaying), "{steady} {decaying}");
    }

    #[test]
    fn sines_150_hz_apart_are_nothing_but_lines() {
        let sines = share(|n| {
            let sine = |k: f64| (std::f64::consts::TAU * (150.0 * k + 0.3) * n as f64 / RATE).sin();
            (2..80).map(f64::from).map(sine).sum::<f64>() as f32
        });
        assert!(sines > 0.95, "{sines}");
    }

    #[test]
    fn a_short_sound_has_no_share() {
        let samples = vec![1.0; 4_800];
        assert_eq!(line_share(&OneShot::new(&samples, RATE).unwrap()), None);
    }
}
