//! Spectra of finished sounds, all in double precision: the only place that transforms one.
//!
//! | | of | for |
//! |---|---|---|
//! | [`PowerSpectrum`] | a stretch as it is, or under a Hann window | energy of bands, single lines |
//! | [`OnsetSpectrum`] | the beginning of a struck sound, padded fourfold | strongest partials, centroid |
//! | [`Transform`] | a whole sound, padded twofold | cutting bands out without shifting them in time |
//! | [`Frames`] | short frames under a Hann window | spectrograms, density of peaks |
//! | [`third_octaves`] | a whole sound, by a filter each | how alike two sounds are |

mod frames;
mod onset;
mod power;
pub mod third_octaves;
mod transform;

use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

pub use frames::Frames;
pub use onset::OnsetSpectrum;
pub use power::PowerSpectrum;
pub use transform::{Transform, slope};

/// The forward transform of real samples, `[bin]`, from 0 Hz to half the sample rate.
fn forward(mut samples: Vec<f64>) -> Vec<Complex<f64>> {
    let fft = RealFftPlanner::<f64>::new().plan_fft_forward(samples.len());
    let mut bins = fft.make_output_vec();
    // The plan has the length of the samples and made the bins itself: their lengths fit.
    let transformed = fft.process(&mut samples, &mut bins);
    debug_assert!(transformed.is_ok());
    bins
}

/// How far the vertex of the parabola through three neighbouring logarithms lies from the middle one, in their spacing:
/// 0 if they have no maximum.
fn vertex([before, at, after]: [f64; 3]) -> f64 {
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
