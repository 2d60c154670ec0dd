//! What a head that stretches scatters into the waves above its modes.
//!
//! Model: by Foeppl's equations a film is tenser in a dent than about it, and waves of all lengths hand energy to each other there. What the
//! slices get of the kinetic energy `E` of the modes that stretch the heads, by an energy `U`, follows a law that is not derived:
//!
//! ```text
//! dE/dt = -R (c / a) E p(k a)      p(z) dz = 2 / z_c^2 exp(-z / z_c) dN,    dN = z / 2 dz
//! z_c^-2 = U_0 / (Z^2 U) + (b / a)^2       U_0 = pi a^2 T^2 / (E_Y h)
//! ```
//!
//! `c / a` is how often a wave runs along the radius in a second, `E_Y` Young's modulus. Of `dN` waves about `z = k a` each gets the same; over all waves, those of the modes too, the
//! shares add up to one. They reach up to some `z_c`, which the stretch decides, over that by the tension `T` by itself, `U_0`; a tip's patch of the radius `b` makes no waves that are
//! much shorter. A head that is held stretched, however much, scatters nothing.
//! Once a block the slices are kicked, each by a random sign. What they get is taken from the modes
//! ([`NonlinearForce::take`](crate::potential::NonlinearForce::take)), to rounding; what the law would give to modes, they keep.
//!
//! Evidence: the whole of Foeppl's equations in the plane, on a rack tom struck at 0.3 of its radius, to which `R` and `Z` are fitted (test
//! `the_waves_above_the_modes_get_what_foeppls_equations_give_them`). That energies fall as `exp(-z / z_c)`, with such a `z_c`, is what axisymmetric
//! equations show of a tom and a kick struck in the middle at 4 to 9 m/s: 10 to 21 and 14 to 39.
//!
//! Limits: of films struck in the middle the law is off, from 3 to 6 kHz by -7 dB (a tom at 9 m/s), -5 (a kick at 9 m/s) and +8 (at 5 m/s): there
//! waves come back together. The far head's stretch counts as the struck one's.
//!
//! Source: the equations as in Timoshenko & Woinowsky-Krieger, Theory of Plates and Shells, ch. 13; the law is ours.

use fastrand::Rng;

use crate::block::BLOCK;
use crate::fitted;
use crate::modal::bands::BandWeights;
use crate::modal::{ModalBody, Row, zero_row};

use super::slices::{HighBandSpec, Slice};

/// Less than this in a block is nothing, J: 80 dB under a soft stroke.
const NOTHING: f64 = 1e-10;

/// Nothing is scattered if even the longest wave of the slices has so many times `z_c`: they would get less than 2e-6 of it.
const SHORTEST: f64 = 16.0;

/// Most of the kinetic energy that is scattered in a block, its share; no head of a kit comes near.
const MOST: f64 = 0.1;

/// Squarings of `1 - x / 2^7`, which make `exp(-x)` of it within 1 dB down to -46 dB.
const SQUARINGS: u32 = 7;

/// Scattering into the slices of one head.
pub(super) struct Scattering {
    /// `R`, dimensionless.
    rate: f64,
    /// The root of the modes that each slice stands for, and its `k a`, `[slice]`.
    counts: Row,
    waves: Row,
    /// The root of the energy of each slice's kick, the root of J.
    kicks: Row,
    weights: BandWeights,
    /// Whether the weights are those of the modes.
    is_weighed: bool,
    /// `U_0 / T^2`, m3/N.
    compliance: f64,
    /// `b / a` of the tip that came last.
    patch: f64,
    /// Radius of the head, m, and length of a block, s.
    radius: f64,
    interval: f64,
    /// Given to the slices since the last reset, J.
    given: f64,
    signs: Rng,
    seed: u64,
}

impl Scattering {
    /// Nothing scattered yet into slices, which `body` has. Allocates.
    pub(super) fn new(spec: &HighBandSpec, slices: &[Slice], body: &ModalBody) -> Scattering {
        let row = |of: fn(&Slice) -> f64| {
            let mut row = zero_row(slices.len());
            row.iter_mut().zip(slices).for_each(|(value, slice)| *value = of(slice) as f32);
            row
        };
        let (head, seed) = (&spec.head, u64::from(spec.seed));
        Scattering {
            rate: fitted::SCATTERING,
            counts: row(|slice| slice.count.sqrt()),
            waves: row(|slice| slice.zero),
            kicks: row(|_| 0.0),
            weights: BandWeights::unheard(body),
            is_weighed: true,
            compliance: head.area() / (head.material.youngs_modulus * head.thickness),
            patch: 0.0,
            radius: head.radius,
            interval: BLOCK as f64 / spec.sample_rate,
            given: 0.0,
            signs: Rng::with_seed(seed),
            seed,
        }
    }

    /// Sets `R`, dimensionless; 0 for no scattering.
    pub(super) fn set_rate(&mut self, rate: f64) {
        self.rate = rate;
    }

    /// The modes have changed.
    pub(super) fn follow(&mut self) {
        self.is_weighed = false;
    }

    /// A tip comes that presses on a patch of this radius, m.
    pub(super) fn meet(&mut self, patch: f64) {
        self.patch = patch / self.radius;
    }

    /// Draws the same signs again, as after a reset.
    pub(super) fn rewind(&mut self) {
        self.signs = Rng::with_seed(self.seed);
    }

    /// As new.
    pub(super) fn reset(&mut self) {
        self.rewind();
        self.given = 0.0;
    }

    /// Given to the slices since the last reset, J.
    pub(super) fn given(&self) -> f64 {
        self.given
    }

    /// Gives the slices what a head of a tension (N/m), stretched by an energy (J), scatters in a block of the kinetic energy (J) of its modes.
    /// Returns it, J.
    ///
    /// # Real-time
    /// Linear in the number of slices; nothing if it is next to nothing.
    pub(super) fn scatter(
        &mut self,
        (stretched, kinetic): (f64, f64),
        tension: f64,
        body: &mut ModalBody,
    ) -> f64 {
        let Some((lowest, &first)) = body.modes().first().zip(self.waves.first()) else { return 0.0 };
        let first = f64::from(first);
        let share = (self.rate * lowest.omega / first * self.interval).min(MOST);
        let reach = self.reach(stretched, tension);
        if share * kinetic < NOTHING || first > SHORTEST * reach {
            return 0.0;
        }
        let given = self.kick(share * kinetic, reach, body);
        self.given += given;
        given
    }

    /// `z_c`, dimensionless.
    fn reach(&self, stretched: f64, tension: f64) -> f64 {
        let by_tension = self.compliance * tension * tension;
        let free = fitted::SCATTERING_REACH.powi(2) * stretched.max(0.0) / by_tension;
        (free.recip() + self.patch * self.patch).sqrt().recip()
    }

    /// Gives the slices their share of an energy (J) that reaches up to `z_c`. Returns it, J.
    fn kick(&mut self, energy: f64, reach: f64, body: &mut ModalBody) -> f64 {
        let Scattering { counts, waves, kicks, weights, is_weighed, signs, .. } = self;
        if !std::mem::replace(is_weighed, true) {
            body.weigh_energies(weights);
        }
        // Of the root of the energies.
        let unit = ((2.0 * energy).sqrt() / reach) as f32;
        let step = (0.5 / (reach * f64::from(1_u32 << SQUARINGS))) as f32;
        body.kernels().vectorized(
            #[inline(always)]
            || {
                for (kick, (count, wave)) in kicks.iter_mut().zip(counts.iter().zip(waves.iter())) {
                    let mut fall = (1.0 - wave * step).max(0.0);
                    for _ in 0..SQUARINGS {
                        fall *= fall;
                    }
                    *kick = unit * count * fall;
                }
            },
        );
        let wanted = f64::from(body.kernels().dot(kicks, kicks));
        let all = 0..body.len();
        let before = body.band_energy(all.clone(), weights).kinetic;
        body.kick_each(kicks, weights, signs);
        let after = body.band_energy(all.clone(), weights).kinetic;
        if after <= 0.0 {
            return 0.0;
        }
        // Slices that move already get more or less by chance: their sum is to be what was wanted.
        let factor = ((before + wanted) / after).sqrt() as f32;
        body.scale_band(all, factor);
        after * f64::from(factor).powi(2) - before
    }
}

#[cfg(test)]
mod tests;
