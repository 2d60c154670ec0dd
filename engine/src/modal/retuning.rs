//! Changes of a body's modes while they move.

use super::coefs::{Constants, TOGETHER};
use super::{ModalBody, Mode};

impl ModalBody {
    /// Changes all modes while they move: `mode(k, old)` gives the new one. As [`set_mode`](Self::set_mode) for each, to the
    /// bit.
    ///
    /// # Real-time
    /// No allocation; some 10 ns a mode.
    pub fn set_modes(&mut self, mode: impl Fn(usize, &Mode) -> Mode) {
        self.end_detuning();
        let kernels = self.kernels;
        let mut retuned = false;
        for first in (0..self.modes.len()).step_by(TOGETHER) {
            let modes = TOGETHER.min(self.modes.len() - first);
            let old = Constants::<TOGETHER>::of(&self.modes[first..first + modes]);
            for k in first..first + modes {
                let new = mode(k, &self.modes[k]);
                retuned |= new.omega != self.modes[k].omega || new.mass != self.modes[k].mass;
                self.modes[k] = new;
            }
            kernels.vectorized(
                #[inline(always)]
                || self.change(first, modes, &old),
            );
        }
        self.retunings += u64::from(retuned);
    }

    /// Changes mode `k` while it moves; displacement and velocity stay what they are.
    ///
    /// Input vectors must be [connected](Self::connect) and receiver weights [tuned](Self::tune) again.
    ///
    /// # Real-time
    /// No allocation; about 50 ns.
    pub fn set_mode(&mut self, k: usize, mode: Mode) {
        self.end_detuning();
        let old = Constants::<1>::of(&self.modes[k..=k]);
        self.modes[k] = mode;
        self.retunings += 1;
        self.change(k, 1, &old);
    }

    /// Times that a frequency or a mass has changed: what does not depend on losses need not follow more often.
    pub fn retunings(&self) -> u64 {
        self.retunings
    }

    /// Brings state and coefficients of some modes, of which `old` are the former constants, to their present ones.
    #[inline(always)]
    fn change<const N: usize>(&mut self, first: usize, modes: usize, old: &Constants<N>) {
        let new = Constants::<N>::of(&self.modes[first..first + modes]);
        let range = first..first + modes;
        let (re, im) = (&mut self.state.re[range.clone()], &self.state.im[range]);
        for (i, (re, im)) in re.iter_mut().zip(im).enumerate() {
            let (old, new) = (old.mode(i), new.mode(i));
            let displacement = f64::from(*im);
            let velocity = old.omega_d() * f64::from(*re) - old.sigma * displacement;
            *re = ((velocity + new.sigma * displacement) / new.omega_d()) as f32;
        }
        self.coefs.update(first, modes, &new, self.dt);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_together_are_changed_as_one_by_one() {
        let modes: Vec<Mode> =
            (0..37).map(|k| Mode { omega: 500.0 * f64::from(k + 1), sigma: 3.0, mass: 0.2 }).collect();
        let new = |k: usize, old: &Mode| Mode { omega: 1.1 * old.omega, sigma: k as f64, ..*old };
        let [mut together, mut alone] = [(); 2].map(|()| {
            let mut body = ModalBody::new(modes.clone(), 44_100.0);
            body.state.re.iter_mut().take(37).enumerate().for_each(|(k, re)| *re = (k as f32).sin());
            body.state.im.iter_mut().take(37).enumerate().for_each(|(k, im)| *im = (k as f32).cos());
            body
        });
        together.set_modes(new);
        for k in 0..modes.len() {
            let mode = new(k, &alone.modes[k]);
            alone.set_mode(k, mode);
        }
        together.step();
        alone.step();
        assert_eq!(together.state.re[..], alone.state.re[..]);
        assert_eq!(together.state.im[..], alone.state.im[..]);
        assert_eq!(together.coefs.hold_im[..], alone.coefs.hold_im[..]);
        assert!(together.state.re[37..].iter().all(|&re| re == 0.0));
        let before = together.retunings();
        together.set_modes(|_, old| Mode { sigma: 2.0 * old.sigma, ..*old });
        assert_eq!(together.retunings(), before);
    }
}
