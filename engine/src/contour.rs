//! Contour of a drum's close microphone: how far its response is from flat.
//!
//! Model: a dip in the lower midrange and a peak of presence, each a peaking filter of second order. Dynamic microphones have presence built
//! in, by cavity, membrane or a network; those made for kick drums the dip as well, so that what a kick has between its fundamental and the
//! beater's click falls back.
//!
//! Limits: on the axis; a real one's pattern, its rise by proximity and what it loses above 10 kHz are left out.
//!
//! Source: Bristow-Johnson, Cookbook formulae for audio equalizer biquad filter coefficients.

use biquad::{Biquad, Coefficients, DirectForm2Transposed, ToHertz, Type};
use serde::{Deserialize, Serialize};

use crate::numbers::{Numbers, Visitor};

/// How a microphone's response differs from a flat one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContourSpec {
    /// Middle of the dip, Hz, 100 to 2000.
    pub dip_hz: f64,
    /// Gain there, dB, -20 to 0.
    pub dip_db: f64,
    /// Middle of the peak, Hz, 2000 to 8000.
    pub presence_hz: f64,
    /// Gain there, dB, 0 to 12.
    pub presence_db: f64,
}

impl Numbers for ContourSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("dip_hz", &mut self.dip_hz, 100.0..=2000.0);
        visitor.number("dip_db", &mut self.dip_db, -20.0..=0.0);
        visitor.number("presence_hz", &mut self.presence_hz, 2000.0..=8000.0);
        visitor.number("presence_db", &mut self.presence_db, 0.0..=12.0);
    }
}

impl ContourSpec {
    /// Of a microphone for kick drums. *Literature*: published responses lie between flat ones and one that is 15 dB lower at 750 Hz than at its
    /// peaks at 60 Hz, 4 and 10 kHz, others dip at 250 to 300 Hz and rise at 3 to 4 kHz; these numbers lie in the middle (*judgement*).
    pub const KICK: ContourSpec =
        ContourSpec { dip_hz: 500.0, dip_db: -7.0, presence_hz: 4000.0, presence_db: 5.0 };

    /// Of a microphone that is clipped to the rims of snares and toms. *Literature*: the usual dynamic ones are flat from 150 Hz to 1 or 2 kHz and rise to 4 to
    /// 6 dB about 5 kHz; these numbers lie in the middle (*judgement*). The dip is none.
    pub const RIM: ContourSpec =
        ContourSpec { dip_hz: 500.0, dip_db: 0.0, presence_hz: 5000.0, presence_db: 5.0 };
}

/// Widths of dip and peak, middle frequency over the band at half the gain in dB: two octaves and one and a half. *Judgement*, as the
/// frequencies are.
const QUALITY: [f64; 2] = [0.7, 1.0];

/// Most of the sample rate that a filter's middle may be.
const HIGHEST: f64 = 0.45;

/// The contour as it is heard through.
pub struct Contour {
    filters: [DirectForm2Transposed<f64>; 2],
}

impl Contour {
    /// At a sample rate, Hz; at rest.
    pub fn new(spec: &ContourSpec, sample_rate: f64) -> Contour {
        let bands = [(spec.dip_hz, spec.dip_db), (spec.presence_hz, spec.presence_db)];
        let filters = std::array::from_fn(|i| {
            let (hz, db) = bands[i];
            let middle = hz.min(HIGHEST * sample_rate).hz();
            let found =
                Coefficients::<f64>::from_params(Type::PeakingEQ(db), sample_rate.hz(), middle, QUALITY[i]);
            // It cannot fail: the middle lies below half the sample rate, and the quality is positive.
            DirectForm2Transposed::new(found.unwrap_or(FLAT))
        });
        Contour { filters }
    }

    /// Takes pressure to what the microphone gives of it, as pressure, Pa.
    pub fn hear(&mut self, sound: &mut [f32]) {
        for x in sound {
            let through = self.filters.iter_mut().fold(f64::from(*x), |x, filter| filter.run(x));
            *x = through as f32;
        }
    }

    /// Forgets what it has heard.
    pub fn reset(&mut self) {
        self.filters.iter_mut().for_each(|filter| filter.reset_state());
    }
}

/// A filter that changes nothing.
const FLAT: Coefficients<f64> = Coefficients { a1: 0.0, a2: 0.0, b0: 1.0, b1: 0.0, b2: 0.0 };

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// Gain at a frequency, dB, of a steady sine.
    fn gain(spec: &ContourSpec, hz: f64, rate: f64) -> f64 {
        let mut sound: Vec<f32> =
            (0..rate as usize).map(|i| (TAU * hz * i as f64 / rate).sin() as f32).collect();
        Contour::new(spec, rate).hear(&mut sound);
        let late = &sound[sound.len() / 2..];
        let square = late.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>() / late.len() as f64;
        10.0 * (2.0 * square).log10()
    }

    #[test]
    fn it_dips_and_peaks_where_it_should_and_leaves_the_fundamental() {
        for rate in [44_100.0, 48_000.0, 96_000.0, 192_000.0] {
            let kick = [(50.0, 0.0, 0.2), (500.0, -7.0, 0.3), (4000.0, 5.0, 0.3)];
            let rim = [(50.0, 0.0, 0.1), (500.0, 0.0, 0.2), (5000.0, 5.0, 0.3)];
            for (spec, heard) in [(ContourSpec::KICK, kick), (ContourSpec::RIM, rim)] {
                for (hz, wanted, within) in heard {
                    let got = gain(&spec, hz, rate);
                    assert!((got - wanted).abs() < within, "{rate} Hz: {got} dB at {hz} Hz");
                }
            }
        }
    }

    #[test]
    fn a_low_sample_rate_leaves_it_finite() {
        let kick = ContourSpec { presence_hz: 8000.0, ..ContourSpec::KICK };
        assert!(gain(&kick, 50.0, 8000.0).abs() < 0.2);
    }

    #[test]
    fn what_was_heard_is_forgotten() {
        let mut contour = Contour::new(&ContourSpec::KICK, 48_000.0);
        contour.hear(&mut [1.0; 16]);
        contour.reset();
        let mut silence = [0.0; 16];
        contour.hear(&mut silence);
        assert_eq!(silence, [0.0; 16]);
    }
}
