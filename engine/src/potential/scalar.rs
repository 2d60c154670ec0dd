//! The scalar auxiliary variable of a nonlinear force, and what it owes.

/// Ratio of `C` to the largest depth so far. *Converged*: under 8, a heavy beater on a cymbal's centre at 13 m/s takes `psi`
/// to zero, and the plate then returns it faster than it came. Ordinary strokes do not change from 1.5 up.
const HEADROOM: f64 = 12.0;

/// Smallest `C`, J: under the energy of anything that can be heard.
pub(super) const LEAST_SHIFT: f64 = 1e-14;

/// Time in which an unneeded `C` falls by `e`, s.
const SHIFT_TIME: f64 = 0.05;

/// `psi` and `C`.
pub(super) struct Scalar {
    /// The root of J.
    pub(super) psi: f64,
    /// `C`, J.
    pub(super) shift: f64,
    /// Energy, J, that modes are still to get because another tip presses; negative if they are to give it, as what is scattered.
    pub(super) owed: f64,
}

impl Scalar {
    pub(super) const REST: Scalar = Scalar { psi: 0.0, shift: LEAST_SHIFT, owed: 0.0 };

    /// Energy held and owed, J.
    pub(super) fn energy(&self) -> f64 {
        0.5 * self.psi * self.psi - self.shift + self.owed
    }

    /// Takes up a change of the potential, J, and owes it.
    pub(super) fn rise_by(&mut self, more: f64) {
        let held = self.psi * self.psi;
        // `psi` may have strayed below what is no longer there.
        self.psi = self.psi.signum() * (held + 2.0 * more).max(LEAST_SHIFT).sqrt();
        self.owed += 0.5 * (held - self.psi * self.psi);
    }

    /// Keeps `C` above the depth (J), and lets it fall where it is higher than needed; `stretch` is the time passed, s.
    pub(super) fn shift_to(&mut self, depth: f64, stretch: f64) {
        let sunk = self.shift * (1.0 - stretch / SHIFT_TIME).max(0.0);
        // Not so far that psi would vanish.
        let least = self.shift - 0.25 * self.psi * self.psi;
        let shift = sunk.max(least).max(HEADROOM * depth).max(LEAST_SHIFT);
        self.psi = self.psi.signum() * (self.psi * self.psi + 2.0 * (shift - self.shift)).max(0.0).sqrt();
        self.shift = shift;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_another_tip_changes_is_owed_to_the_joule() {
        for (psi, more) in [(0.2, 0.03), (0.2, -0.015), (-0.2, 0.03), (0.2, -0.5), (0.0, 0.01)] {
            let mut scalar = Scalar { psi, shift: 1e-3, owed: 2e-3 };
            let before = scalar.energy();
            scalar.rise_by(more);
            assert!((scalar.energy() - before).abs() < 1e-15, "{psi} {more}");
            let held = 0.5 * (scalar.psi * scalar.psi - psi * psi);
            // As much as `psi` holds goes, no more.
            assert!((held - more.max(-0.5 * psi * psi)).abs() < 1e-12, "{psi} {more}: {held}");
        }
    }
}
