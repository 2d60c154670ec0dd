//! The measurement as a table for people.

use std::fmt;

use super::Measurement;
use crate::analysis::OCTAVES;

/// A figure, or a dash for what could not be measured.
fn figure(value: Option<f64>, decimals: usize, unit: &str) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.decimals$} {unit}"))
}

impl fmt::Display for Measurement {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(
            f,
            "{} struck by {} at {} m/s, {} of the radius, {:.0} degrees, {} Hz\n",
            self.piece, self.striker, self.speed_m_s, self.at, self.angle_deg, self.sample_rate_hz,
        )?;
        let touches = self.touches.map_or_else(|| "-".to_owned(), |touches| touches.to_string());
        let energies = format!(
            "{:.4} J in, {:.4} J at most, {:.3e} J at the end",
            self.striker_energy_in_j, self.energy_peak_j, self.energy_end_j,
        );
        for (name, value) in [
            ("contact", figure(self.contact_ms, 3, "ms")),
            ("touches", touches),
            ("peak force", figure(self.peak_force_n, 1, "N")),
            ("impulse", figure(self.impulse_n_s, 4, "N s")),
            ("leaving speed", figure(self.leaving_speed_m_s, 2, "m/s")),
            ("energy", energies),
            ("strongest", figure(self.strongest_hz, 2, "Hz")),
            ("glide", figure(self.glide_cents, 1, "cents")),
            ("centroid", figure(self.centroid_hz, 0, "Hz")),
            ("peak", figure(self.peak_dbfs, 1, "dBFS")),
            ("rms", figure(self.rms_dbfs, 1, "dBFS")),
            ("mean", self.mean.map_or_else(|| "-".to_owned(), |mean| format!("{mean:.2e}"))),
        ] {
            writeln!(f, "{name:<14} {value}")?;
        }
        writeln!(f, "\n{:>9}  T60", "octave")?;
        for (octave, decay) in OCTAVES.iter().zip(self.t60_s.0) {
            writeln!(f, "{octave:>6} Hz  {}", figure(decay, 3, "s"))?;
        }
        Ok(())
    }
}
