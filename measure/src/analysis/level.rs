//! Levels of a sound, full scale 1.

/// Greatest magnitude, full scale 1.
pub fn peak(samples: &[f32]) -> f64 {
    samples.iter().fold(0.0, |peak: f64, &sample| peak.max(f64::from(sample).abs()))
}

/// Root of the mean square; nothing for no samples.
pub fn rms(samples: &[f32]) -> Option<f64> {
    let sum: f64 = samples.iter().map(|&sample| f64::from(sample).powi(2)).sum();
    (!samples.is_empty()).then(|| (sum / samples.len() as f64).sqrt())
}

/// Mean: the offset. Nothing for no samples.
pub fn mean(samples: &[f32]) -> Option<f64> {
    let sum: f64 = samples.iter().map(|&sample| f64::from(sample)).sum();
    (!samples.is_empty()).then(|| sum / samples.len() as f64)
}

/// A magnitude in dB of full scale; nothing for silence.
pub fn to_dbfs(magnitude: f64) -> Option<f64> {
    (magnitude > 0.0).then(|| 20.0 * magnitude.log10())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_of_full_scale_has_rms_3_db_below_its_peak() {
        let sine: Vec<f32> =
            (0..48_000).map(|n| (f64::from(n) * std::f64::consts::TAU / 48.0).sin() as f32).collect();
        assert!((peak(&sine) - 1.0).abs() < 1e-6);
        assert!((to_dbfs(rms(&sine).unwrap()).unwrap() + 3.0103).abs() < 1e-3);
        assert!(mean(&sine).unwrap().abs() < 1e-7);
    }

    #[test]
    fn silence_and_nothing_have_no_level() {
        assert_eq!((to_dbfs(peak(&[0.0; 4])), rms(&[]), mean(&[])), (None, None, None));
    }
}
