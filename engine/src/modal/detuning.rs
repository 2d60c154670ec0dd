//! Modes that are detuned for a while: phases that wander, and frequencies that follow a head's tension.
//!
//! Wandering phases: a mode turns by a small angle a sample more than its equation says, or less. If the side is drawn anew after every
//! interval `T`, a shift of the frequency by `s` (rad/s) lets the phase walk at random: after a time `t` its mean square is
//! `s^2 T t`, and a line becomes a Lorentzian whose coherence falls by `exp(-D t)`, `D = s^2 T / 2`. Displacement and velocity have
//! no steps, and no energy changes.
//!
//! Only [`ModalBody::ring`] is detuned. Where forces of contacts act, by [`ModalBody::step`], the modes turn by their equation, as
//! otherwise the work of a force would not be what the modes get.

use fastrand::Rng;

use super::ModalBody;
use super::coefs::DetunedTurns;

/// Signs drawn at once.
const SIGNS: usize = 32;

/// Largest tangent of half an angle a sample by which a mode is shifted.
const LARGEST_TANGENT: f32 = 0.5;

impl ModalBody {
    /// Lets modes be detuned. Allocates.
    pub fn allow_detuning(&mut self) {
        self.detuning = Some(DetunedTurns::new(self.len()));
    }

    /// Shifts the frequencies of all modes from `first` on by `shift` (rad/s, small against every frequency), each up or down by a
    /// random sign, until this is called again or [ended](Self::end_detuning). A change of modes ends it.
    /// Without effect unless [allowed](Self::allow_detuning).
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn detune(&mut self, first: usize, shift: f64, signs: &mut Rng) {
        let Some(detuning) = &mut self.detuning else { return };
        let angle = shift * self.dt;
        let half = libm::sin(0.5 * angle);
        // Of the added rotation, less one.
        let (added, side) = ((-2.0 * half * half) as f32, libm::sin(angle) as f32);
        let coefs = &self.coefs;
        detuning.is_active = true;
        detuning.turn_re[..first].copy_from_slice(&coefs.turn_re[..first]);
        detuning.turn_im[..first].copy_from_slice(&coefs.turn_im[..first]);
        let to = (&mut detuning.turn_re[first..], &mut detuning.turn_im[first..]);
        let from = (&coefs.turn_re[first..], &coefs.turn_im[first..]);
        self.kernels.vectorized(
            #[inline(always)]
            || {
                let to = to.0.chunks_mut(SIGNS).zip(to.1.chunks_mut(SIGNS));
                let from = from.0.chunks(SIGNS).zip(from.1.chunks(SIGNS));
                for ((to_re, to_im), (re, im)) in to.zip(from) {
                    let bits = signs.u32(..);
                    for (i, (to_re, to_im)) in to_re.iter_mut().zip(to_im).enumerate() {
                        let (re, im) = (re[i], im[i]);
                        let side = f32::from_bits(side.to_bits() ^ (bits >> i << 31));
                        *to_re = re + ((1.0 + re) * added - im * side);
                        *to_im = im + ((1.0 + re) * side + im * added);
                    }
                }
            },
        );
    }

    /// Shifts the frequencies of all modes from `first` on, each by its own (rad/s,
    /// `[mode - first]`), until this is called again or [ended](Self::end_detuning). A change of modes ends it. Without effect unless
    /// [allowed](Self::allow_detuning).
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn shift_frequencies(&mut self, first: usize, shifts: &[f32]) {
        let Some(detuning) = &mut self.detuning else { return };
        let half_dt = (0.5 * self.dt) as f32;
        let coefs = &self.coefs;
        detuning.is_active = true;
        detuning.turn_re[..first].copy_from_slice(&coefs.turn_re[..first]);
        detuning.turn_im[..first].copy_from_slice(&coefs.turn_im[..first]);
        let to = (&mut detuning.turn_re[first..], &mut detuning.turn_im[first..]);
        let from = (&coefs.turn_re[first..], &coefs.turn_im[first..]);
        self.kernels.vectorized(
            #[inline(always)]
            || {
                let to = to.0.iter_mut().zip(to.1).zip(from.0.iter().zip(from.1));
                for (((to_re, to_im), (&re, &im)), shift) in to.zip(shifts) {
                    // Cayley's form of a rotation: of unit length whatever the angle, which it gives to third order.
                    let tangent = (half_dt * shift).clamp(-LARGEST_TANGENT, LARGEST_TANGENT);
                    let side = 2.0 * tangent / (1.0 + tangent * tangent);
                    let added = -tangent * side;
                    *to_re = re + ((1.0 + re) * added - im * side);
                    *to_im = im + ((1.0 + re) * side + im * added);
                }
            },
        );
    }

    /// Lets all modes turn by their equation again.
    pub fn end_detuning(&mut self) {
        self.detuning.iter_mut().for_each(|detuning| detuning.is_active = false);
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::modal::{Mode, RECEIVERS, ReceiverWeights};

    const RATE: f64 = 44_100.0;
    const RUN: usize = 32;

    /// Lossless modes from 2 kHz on, 9 Hz apart, that ring, the first of them far below.
    fn body() -> (ModalBody, ReceiverWeights) {
        let mode = |k: usize| {
            let hz = if k == 0 { 300.0 } else { 2000.0 + 9.0 * k as f64 };
            Mode { omega: TAU * hz, sigma: 0.0, mass: 0.7 }
        };
        let mut body = ModalBody::new((0..400).map(mode).collect(), RATE);
        body.allow_detuning();
        body.set_displacements(&vec![1e-6; 400]);
        let mut weights = ReceiverWeights::new(vec![[0.0; 2]; 400]);
        body.tune(&mut weights);
        (body, weights)
    }

    fn ring(body: &mut ModalBody, weights: &ReceiverWeights) {
        let mut out = [[0.0_f32; RUN]; RECEIVERS];
        body.ring(0, weights, out.each_mut().map(|out| &mut out[..]));
    }

    #[test]
    fn phases_walk_at_random_by_the_law_and_energy_stays() {
        let (mut body, weights) = body();
        let (mut still, _) = self::body();
        let energy = body.energy();
        let interval = RUN as f64 / RATE;
        let diffusion = 12.0;
        let shift = (2.0 * diffusion / interval).sqrt();
        let mut signs = Rng::with_seed(1);
        let blocks = 80;
        for _ in 0..blocks {
            body.detune(1, shift, &mut signs);
            ring(&mut body, &weights);
            ring(&mut still, &weights);
        }
        assert!((body.energy() / energy - 1.0).abs() < 1e-5, "{} J of {energy} J", body.energy());
        assert_eq!(body.displacement(0), still.displacement(0));
        // Coherence with what was not detuned: the mean of the cosine of the phase between them.
        let phase = |body: &ModalBody, k: usize| {
            let (re, im) = (body.state.re[k], body.state.im[k]);
            f64::from(im).atan2(f64::from(re))
        };
        let sum: f64 = (1..400).map(|k| (phase(&body, k) - phase(&still, k)).cos()).sum();
        let (coherence, wanted) = (sum / 399.0, (-diffusion * f64::from(blocks) * interval).exp());
        // 399 phases tell it to some hundredths.
        assert!((coherence - wanted).abs() < 0.08, "{coherence} for {wanted}");
    }

    #[test]
    fn shifted_modes_ring_higher_by_as_much_and_keep_their_energy() {
        let (mut body, weights) = body();
        let (mut still, _) = self::body();
        let energy = body.energy();
        // Each by 2 % of its frequency, but the first.
        let shifts: Vec<f32> = body.modes()[1..].iter().map(|mode| 0.02 * mode.omega as f32).collect();
        body.shift_frequencies(1, &shifts);
        ring(&mut body, &weights);
        ring(&mut still, &weights);
        assert!((body.energy() / energy - 1.0).abs() < 1e-5, "{} J of {energy} J", body.energy());
        assert_eq!(body.displacement(0), still.displacement(0));
        let phase =
            |body: &ModalBody, k: usize| f64::from(body.state.im[k]).atan2(f64::from(body.state.re[k]));
        for k in [1, 100, 399] {
            let wanted = 0.02 * body.modes()[k].omega * RUN as f64 / RATE;
            let ahead = (phase(&body, k) - phase(&still, k) - wanted).rem_euclid(TAU);
            assert!(ahead.min(TAU - ahead) < 1e-3 * wanted, "mode {k}: {ahead} rad off {wanted}");
        }
    }

    #[test]
    fn a_step_and_a_body_whose_detuning_has_ended_turn_by_the_equation() {
        let (mut body, weights) = body();
        let (mut still, _) = self::body();
        body.detune(0, 300.0, &mut Rng::with_seed(2));
        for _ in 0..RUN {
            body.step();
            still.step();
        }
        assert_eq!(body.displacements(), still.displacements());
        body.end_detuning();
        ring(&mut body, &weights);
        ring(&mut still, &weights);
        assert_eq!(body.displacements(), still.displacements());
    }
}
