//! Decay times in octave bands.
//!
//! A band is cut out by multiplying the spectrum of the whole sound with a window that is flat
//! inside the octave and has raised-cosine edges, which shifts no energy in time. Schroeder's
//! backward integral (JASA 1965) of its square is fitted by a straight line from -5 to -25 dB, and
//! the slope extended to 60 dB, as ISO 3382 has it for T20. The energy that would have come after
//! the end of the sound is estimated from the slope and added, until the slope stays.

use realfft::RealFftPlanner;

/// Centres of the bands, Hz.
pub const OCTAVES: [f64; 10] = [31.5, 63.0, 125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0, 16_000.0];

/// Start of the fitted stretch, dB below the whole.
const FROM_DB: f64 = -5.0;

/// End of the fitted stretch, dB below the whole.
const TO_DB: f64 = -25.0;

/// A band with less than this share of the sound's energy holds its neighbours' skirts.
const LEAST_SHARE: f64 = 1e-8;

/// The filter alone gives a click about 4.5 (measured): less than this is the filter, not the sound.
const LEAST_BANDWIDTH_TIMES_T60: f64 = 6.0;

/// What is gone sooner is the click of the stroke and rings in no body, s.
const LEAST_T60: f64 = 0.005;

/// Decay time by 60 dB of each of [`OCTAVES`], s; nothing where the band holds too little or has
/// not decayed far enough when the sound ends.
pub fn octave_decays(samples: &[f32], rate: f64) -> [Option<f64>; OCTAVES.len()] {
    let size = (2 * samples.len()).max(16).next_power_of_two();
    let mut planner = RealFftPlanner::<f64>::new();
    let (forward, inverse) = (planner.plan_fft_forward(size), planner.plan_fft_inverse(size));
    let mut input = forward.make_input_vec();
    for (place, &sample) in input.iter_mut().zip(samples) {
        *place = f64::from(sample);
    }
    let total: f64 = input.iter().map(|sample| sample * sample).sum();
    let mut spectrum = forward.make_output_vec();
    if forward.process(&mut input, &mut spectrum).is_err() || total <= 0.0 || !total.is_finite() {
        return [None; OCTAVES.len()];
    }
    OCTAVES.map(|centre| {
        // A band cut by the end of the spectrum is not that octave.
        if centre * std::f64::consts::SQRT_2 > rate / 2.0 {
            return None;
        }
        let mut band = inverse.make_input_vec();
        for (bin, (place, &value)) in band.iter_mut().zip(&spectrum).enumerate() {
            *place = value * octave_window(bin as f64 * rate / size as f64 / centre);
        }
        let mut output = inverse.make_output_vec();
        inverse.process(&mut band, &mut output).ok()?;
        let scale = 1.0 / size as f64;
        let energy: Vec<f64> =
            output[..samples.len()].iter().map(|sample| (sample * scale).powi(2)).collect();
        if energy.iter().sum::<f64>() < LEAST_SHARE * total {
            return None;
        }
        let t60 = decay_time(&energy, rate)?;
        let bandwidth = centre / std::f64::consts::SQRT_2;
        (t60 >= LEAST_T60.max(LEAST_BANDWIDTH_TIMES_T60 / bandwidth)).then_some(t60)
    })
}

/// Transmission at a frequency given as a ratio to the band's centre: half at the octave's edges.
fn octave_window(ratio: f64) -> f64 {
    if ratio <= 0.0 {
        return 0.0;
    }
    // A third of an octave of slope on either side of each edge.
    let beyond_edge = (ratio.log2().abs() - 0.5) * 3.0;
    0.5 - 0.5 * (std::f64::consts::FRAC_PI_2 * beyond_edge.clamp(-1.0, 1.0)).sin()
}

/// Decay time of a band's instantaneous energy.
fn decay_time(energy: &[f64], rate: f64) -> Option<f64> {
    let mut remaining = energy.to_vec();
    let mut sum = 0.0;
    for value in remaining.iter_mut().rev() {
        sum += *value;
        *value = sum;
    }
    // The level over the last twentieth says how loud the sound breaks off.
    let last = energy.len() / 20;
    let end_power = energy[energy.len() - last.max(1)..].iter().sum::<f64>() / last.max(1) as f64;
    let mut lost = 0.0;
    let mut t60 = None;
    for _ in 0..8 {
        t60 = Some(slope(&remaining, lost, rate)?);
        let sigma = 6.9078 / t60?;
        // An exponential of that power goes on for 1 / (2 sigma).
        lost = end_power * rate / (2.0 * sigma);
    }
    // What is missing must lie below what was fitted.
    let floor = 10f64.powf(TO_DB / 10.0);
    (lost < floor * (remaining[0] + lost)).then_some(t60?)
}

/// Decay time from the line through the remaining energy between the two levels.
fn slope(remaining: &[f64], lost: f64, rate: f64) -> Option<f64> {
    let whole = remaining.first()? + lost;
    let (mut n, mut x, mut y, mut xx, mut xy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (index, &energy) in remaining.iter().enumerate() {
        let level = 10.0 * ((energy + lost) / whole).log10();
        if level > FROM_DB {
            continue;
        }
        if level < TO_DB {
            let slope = (n * xy - x * y) / (n * xx - x * x);
            return (n >= 8.0 && slope < 0.0).then(|| -60.0 / slope);
        }
        let time = index as f64 / rate;
        n += 1.0;
        x += time;
        y += level;
        xx += time * time;
        xy += time * level;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 48_000.0;

    fn ringing(partials: &[(f64, f64)], seconds: f64) -> Vec<f32> {
        (0..(seconds * RATE) as usize)
            .map(|n| {
                let t = n as f64 / RATE;
                let sum = partials.iter().map(|&(frequency, t60)| {
                    (-6.9078 * t / t60).exp() * (std::f64::consts::TAU * frequency * t).sin()
                });
                (0.2 * sum.sum::<f64>()) as f32
            })
            .collect()
    }

    #[test]
    fn each_octave_gives_the_decay_of_what_rings_in_it() {
        let partials =
            [(31.5, 2.0), (63.0, 1.5), (250.0, 0.8), (1000.0, 0.5), (4000.0, 0.2), (16_000.0, 0.1)];
        let decays = octave_decays(&ringing(&partials, 3.0), RATE);
        for (centre, t60) in partials {
            let band = OCTAVES.iter().position(|octave| *octave == centre).unwrap();
            let found = decays[band].unwrap();
            assert!((found / t60 - 1.0).abs() < 0.03, "{centre} Hz: {found} for {t60}");
        }
    }

    #[test]
    fn a_sound_cut_before_its_decay_is_corrected_or_refused() {
        let cut = |seconds| octave_decays(&ringing(&[(1000.0, 3.0)], seconds), RATE)[5];
        // 40 dB of 60 heard.
        assert!((cut(2.0).unwrap() / 3.0 - 1.0).abs() < 0.02);
        // 20 dB of 60 heard.
        assert_eq!(cut(1.0), None);
    }

    #[test]
    fn empty_bands_silence_and_steady_sounds_have_no_decay() {
        let decays = octave_decays(&ringing(&[(1000.0, 0.5)], 2.0), RATE);
        assert!(decays[5].is_some());
        assert_eq!((decays[1], decays[9]), (None, None));
        assert_eq!(octave_decays(&[0.0; 4800], RATE), [None; 10]);
        assert_eq!(octave_decays(&[], RATE), [None; 10]);
        assert_eq!(octave_decays(&ringing(&[(1000.0, 1e9)], 1.0), RATE), [None; 10]);
    }

    #[test]
    fn bands_beyond_nyquist_are_left_out() {
        let noise: Vec<f32> = (0..22_050).map(|n| ((n * n) % 17) as f32 - 8.0).collect();
        assert_eq!(octave_decays(&noise, 22_050.0)[9], None);
    }
}
