//! The one transform of real samples, and where a maximum lies between its bins.

use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

/// The forward transform of real samples, `[bin]`, from 0 Hz to half the sample rate.
pub(super) fn forward(mut samples: Vec<f64>) -> Vec<Complex<f64>> {
    let fft = RealFftPlanner::<f64>::new().plan_fft_forward(samples.len());
    let mut bins = fft.make_output_vec();
    // The plan has the length of the samples and made the bins itself: their lengths fit.
    let transformed = fft.process(&mut samples, &mut bins);
    debug_assert!(transformed.is_ok());
    bins
}

/// How far the vertex of the parabola through three neighbouring logarithms lies from the middle one, in their spacing:
/// 0 if they have no maximum.
pub(super) fn vertex([before, at, after]: [f64; 3]) -> f64 {
    let curvature = before - 2.0 * at + after;
    if curvature < 0.0 { (0.5 * (before - after) / curvature).clamp(-0.5, 0.5) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn the_transform_of_a_cosine_is_half_its_size_times_its_length_in_one_bin() {
        let cosine = (0..64).map(|n| 3.0 * (TAU * 5.0 * f64::from(n) / 64.0).cos()).collect();
        for (bin, value) in forward(cosine).iter().enumerate() {
            let wanted = if bin == 5 { 96.0 } else { 0.0 };
            assert!((value - wanted).norm() < 1e-12, "{bin}: {value}");
        }
    }

    #[test]
    fn the_vertex_of_a_parabola_is_found() {
        let parabola = |at: f64| [-1.0, 0.0, 1.0].map(|x: f64| 2.0 - 3.0 * (x - at).powi(2));
        for at in [-0.4, 0.0, 0.25] {
            assert!((vertex(parabola(at)) - at).abs() < 1e-12);
        }
        assert_eq!(vertex([1.0, 0.0, 1.0]), 0.0);
    }
}
