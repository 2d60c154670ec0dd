//! What is measured on a stroke, under the names of the JSON.

use overhear_engine::snapshot::StrikeSnapshot;
use serde::{Serialize, Serializer};

use super::stroke::{Request, Sound};
use crate::analysis::{self, OCTAVES};
use crate::spectra::OnsetSpectrum;

/// How much of the sound's beginning the strongest bin and the centroid are taken from, s.
const ONSET: f64 = 1.0;

/// One stroke, measured. The fields are the keys of the JSON and stay; what the stroke did not
/// give is null.
#[derive(Debug, Clone, Serialize)]
pub struct Measurement {
    /// Name of the piece.
    pub piece: String,
    /// Sample rate, Hz.
    pub sample_rate_hz: f64,
    /// Speed of the striker, m/s.
    pub speed_m_s: f64,
    /// Place, share of the radius.
    pub at: f64,
    /// Direction of the place, degrees.
    pub angle_deg: f64,
    /// Name of the striker.
    pub striker: &'static str,
    /// From the first touch to the last, ms.
    pub contact_ms: Option<f64>,
    /// Largest force, N.
    pub peak_force_n: Option<f64>,
    /// Force integrated over time, N s.
    pub impulse_n_s: Option<f64>,
    /// Speed of the striker away from the piece, m/s.
    pub leaving_speed_m_s: Option<f64>,
    /// Separate touches.
    pub touches: Option<u32>,
    /// How much higher the strongest partial starts than it ends, cents.
    pub glide_cents: Option<f64>,
    /// The strongest partial, Hz.
    pub strongest_hz: Option<f64>,
    /// Mean frequency, Hz.
    pub centroid_hz: Option<f64>,
    /// Peak, dB of 20 Pa.
    pub peak_dbfs: Option<f64>,
    /// Root mean square of the whole, dB of 20 Pa.
    pub rms_dbfs: Option<f64>,
    /// Mean, full scale 1.
    pub mean: Option<f64>,
    /// Decay time by 60 dB in each octave, s: `{"31.5": .., "63": ..}`.
    pub t60_s: Decays,
    /// Landings of all groups of snare wires in the rendered time.
    pub wire_landings: u32,
    /// When a group last left the head, s after the stroke.
    pub wire_last_lift_s: Option<f64>,
    /// Landings of a hi-hat's rims on each other in the rendered time.
    pub rim_landings: u32,
    /// When a place of the rims last lifted off the other, s after the stroke.
    pub rim_last_lift_s: Option<f64>,
    /// Kinetic energy of the arriving striker, J.
    pub striker_energy_in_j: f64,
    /// Energy that the striker took away: its motion, its bending, the head right under it, J.
    pub striker_energy_out_j: f64,
    /// Greatest energy of the piece, J.
    pub energy_peak_j: f64,
    /// Energy of the piece at the end, J.
    pub energy_end_j: f64,
}

impl Measurement {
    /// Measures a rendered stroke.
    pub fn new(request: &Request, sound: &Sound) -> Measurement {
        let rate = request.options.sample_rate;
        let samples = &sound.samples;
        let spectrum = OnsetSpectrum::of_onset(samples, rate, ONSET);
        let strongest = spectrum.strongest();
        // A stroke without a contact has no measurement.
        let touched = (sound.contact.touches > 0).then_some(sound.contact);
        let measured = |figure: fn(&StrikeSnapshot) -> f32| {
            touched.map(|contact| exact(figure(&contact))).filter(|figure| figure.is_finite())
        };
        Measurement {
            piece: request.kit.pieces.first().map(|piece| piece.name.clone()).unwrap_or_default(),
            sample_rate_hz: rate,
            speed_m_s: request.strike.speed,
            at: request.strike.radius,
            angle_deg: request.strike.angle.to_degrees(),
            striker: request.strike.striker.name(),
            contact_ms: measured(|contact| contact.contact_time * 1000.0),
            peak_force_n: measured(|contact| contact.peak_force),
            impulse_n_s: measured(|contact| contact.impulse),
            leaving_speed_m_s: measured(|contact| contact.leaving_speed),
            touches: touched.map(|contact| contact.touches),
            glide_cents: strongest.zip(touched).and_then(|(near, contact)| glide(sound, near, &contact)),
            strongest_hz: strongest,
            centroid_hz: spectrum.centroid(),
            peak_dbfs: analysis::to_dbfs(analysis::peak(samples)),
            rms_dbfs: analysis::rms(samples).and_then(analysis::to_dbfs),
            mean: analysis::mean(samples).filter(|mean| mean.is_finite()),
            t60_s: Decays(analysis::octave_decays(samples, rate)),
            wire_landings: sound.wires.landings,
            wire_last_lift_s: (sound.wires.last_lift > 0.0).then(|| exact(sound.wires.last_lift)),
            rim_landings: sound.rims.landings,
            rim_last_lift_s: (sound.rims.last_lift > 0.0).then(|| exact(sound.rims.last_lift)),
            striker_energy_in_j: sound.striker_energy,
            striker_energy_out_j: sound.striker_energy_out,
            energy_peak_j: sound.energy_peak,
            energy_end_j: sound.energy_end,
        }
    }
}

/// Glide of the partial near a frequency (Hz), if it is one of a drum's lowest modes.
fn glide(sound: &Sound, near: f64, contact: &StrikeSnapshot) -> Option<f64> {
    // Where the motion's samples are too far apart, higher partials are mistaken for lower ones.
    let seen = near < sound.motion.rate / 3.0;
    let free_from = f64::from(contact.contact_time);
    seen.then(|| analysis::glide_cents(&sound.motion, near, free_from)).flatten()
}

/// The decimal number a single-precision figure stands for.
fn exact(figure: f32) -> f64 {
    figure.to_string().parse().unwrap_or(f64::from(figure))
}

/// Decay times by octave, s, in the order of [`OCTAVES`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decays(pub [Option<f64>; OCTAVES.len()]);

impl Serialize for Decays {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(OCTAVES.iter().map(ToString::to_string).zip(&self.0))
    }
}
