//! A band of a head's waves as a tip feels it: less and less, the deeper its dent.
//!
//! Model: by Foeppl's equations for a point that presses on an endless film of the tension `T` and the stretching stiffness `E h` with the
//! force `F`, the radial tension at the distance `r` is, within a tenth,
//!
//! ```text
//! N = n T,   n = (1 + 9/8 (s / r)^2)^(1/3),   s = F sqrt(E h / 2) / (2 pi T^1.5)
//! ```
//!
//! Waves of wavenumber `k` meet the tension at `r = 1 / k`. Their frequency is that of the film far away, but a point in the dent gives way
//! to them as one on a film of the tension `N` does: by `g^2` of what it would,
//!
//! ```text
//! g^2 = (1 + d) / (n + d),   d = D k^2 / T
//! ```
//!
//! with the flexural rigidity `D`, which a dent does not change. The waves together are an [oscillator](super::oscillator) `q`; the point
//! moves by a lever, `y' = g q'`, and the oscillator feels `g F`: the same power on either side, whatever `g` is. The force that bends the
//! film is read off the oscillator's spring of the stiffness `K`, `F = K q / g`, so that with `x = 9/8 (k s K q / F)^2`
//!
//! ```text
//! n^3 = 1 + x (n + d) / (1 + d)
//! ```
//!
//! A stroke's first touch meets a slack film, its middle one that is tense.
//!
//! Limits: held still, the point gives way by up to twice what the equations say, since what is right for waves on a dent is not right for the
//! dent itself.
//!
//! Source: Timoshenko & Woinowsky-Krieger, Theory of Plates and Shells, ch. 13 (large deflections); the tension about a point and the lever are
//! derived here.

use super::oscillator::Oscillator;

/// A band of waves under a tip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmBand {
    waves: Oscillator,
    /// `x / q^2`, 1/m2, and `d`, dimensionless.
    hardening: f64,
    bent: f64,
    /// Displacement of the point, m.
    moved: f64,
    /// `g` in the present sample.
    lever: f64,
    /// s.
    dt: f64,
}

impl FilmBand {
    /// Waves that are as they are under any force.
    pub fn linear(waves: Oscillator) -> FilmBand {
        FilmBand { waves, hardening: 0.0, bent: 0.0, moved: 0.0, lever: 1.0, dt: 0.0 }
    }

    /// Waves at rest, with `k s` under a newton (dimensionless) and `d`; a sample lasts `dt` (s).
    pub fn new(waves: Oscillator, stretched: f64, bent: f64, dt: f64) -> FilmBand {
        let hardening = 1.125 * (stretched * waves.stiffness()).powi(2);
        FilmBand { hardening, bent, dt, ..FilmBand::linear(waves) }
    }

    /// Whether the film is never tense: then the lever is 1.
    fn is_slack(&self) -> bool {
        self.hardening == 0.0
    }

    /// Displacement of the point by these waves, m.
    pub fn moved(&self) -> f64 {
        if self.is_slack() { self.waves.q } else { self.moved }
    }

    /// One-sample compliance: displacement at the end of a sample by a unit force held over it, m/N.
    pub fn compliance(&self) -> f64 {
        if self.is_slack() {
            return self.waves.compliance();
        }
        self.lever * self.lever * self.waves.compliance()
    }

    /// Advances a sample without force; the lever is that of the middle of it.
    pub fn step(&mut self) {
        if self.is_slack() {
            return self.waves.step();
        }
        let before = self.waves.q;
        let middle = before + 0.5 * self.dt * self.waves.v;
        self.lever = lever(self.hardening * middle * middle, self.bent);
        self.waves.step();
        self.moved += self.lever * (self.waves.q - before);
    }

    /// Adds the effect of a force (N) held over the sample just stepped.
    pub fn push(&mut self, force: f64) {
        if self.is_slack() {
            return self.waves.push(force);
        }
        self.moved += self.compliance() * force;
        self.waves.push(self.lever * force);
    }

    /// Energy of the waves, J.
    pub fn energy(&self) -> f64 {
        self.waves.energy()
    }
}

/// `g` for an `x` and a `d`, dimensionless.
fn lever(x: f64, d: f64) -> f64 {
    // From above, where Newton's steps go down to the root: `n` is at most `sqrt(1 + x)`, what it is without `d`.
    let mut n = (1.0 + x * ((1.0 + x).sqrt() + d) / (1.0 + d)).cbrt();
    for _ in 0..NEWTON {
        n -= (n * n * n - 1.0 - x * (n + d) / (1.0 + d)) / (3.0 * n * n - x / (1.0 + d));
    }
    ((1.0 + d) / (n + d)).sqrt()
}

/// Newton's steps. *Converged*: the lever is met within 0.5 % up to a hundred times the head's tension, within 3 % up to a thousand times.
const NEWTON: usize = 2;

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 1e-6;

    #[test]
    fn the_lever_follows_from_the_tension_about_the_dent() {
        for (x, within) in
            [(0.0, 1e-9), (1e-3, 1e-6), (0.1, 1e-4), (1.0, 1e-3), (30.0, 2e-3), (1e4, 5e-3), (1e6, 0.03)]
        {
            for d in [0.0, 0.1, 1.0, 10.0, 300.0] {
                let g = lever(x, d);
                let n = (1.0 + d) / (g * g) - d;
                // By bisection.
                let (mut low, mut high) = (1.0, 1.0 + x);
                for _ in 0..200 {
                    let middle: f64 = 0.5 * (low + high);
                    let above = middle.powi(3) > 1.0 + x * (middle + d) / (1.0 + d);
                    if above { high = middle } else { low = middle }
                }
                let exact = ((1.0 + d) / (low + d)).sqrt();
                assert!((g / exact - 1.0).abs() <= within, "{x} {d}: {g} {exact}, n {n} {low}");
            }
        }
    }

    #[test]
    fn the_waves_take_exactly_the_work_that_is_done_at_the_point() {
        let mut band = FilmBand::new(Oscillator::sprung(1e-3, 2e4, 0.0, DT), 0.3, 0.5, DT);
        let (mut work, mut least) = (0.0, 1.0_f64);
        for i in 0..20_000 {
            let force = 40.0 * (1e3 * DT * f64::from(i)).sin() + f64::from(i % 7) - 3.0;
            let before = band.moved();
            band.step();
            band.push(force);
            work += force * (band.moved() - before);
            least = least.min(band.lever);
            assert!((band.energy() - work).abs() < 1e-12 * (1.0 + work.abs()), "{i}: {work}");
        }
        assert!(least < 0.5, "{least}");
    }

    #[test]
    fn a_wave_on_a_dent_moves_the_point_by_the_levers_square() {
        // A force that is held and a weak one that swings, far above the band: its mass alone answers.
        let swing = |held: f64| {
            let mut band = FilmBand::new(Oscillator::sprung(1e-3, 2e3, 1.9e3, DT), 0.3, 0.5, DT);
            let (omega, mut most) = (1e5, 0.0_f64);
            for i in 0..40_000 {
                let before = band.moved();
                band.step();
                band.push(held + 1e-3 * (omega * DT * f64::from(i)).sin());
                most = if i < 30_000 { 0.0 } else { most.max((band.moved() - before) / DT) };
            }
            (most, band.lever)
        };
        let (slack, whole) = swing(0.0);
        let (tense, lever) = swing(30.0);
        assert!((whole - 1.0).abs() < 1e-3 && lever < 0.6, "{whole} {lever}");
        assert!((tense / slack / (lever * lever) - 1.0).abs() < 0.05, "{slack} {tense} {lever}");
    }
}
