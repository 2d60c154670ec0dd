//! One coordinate of an exciter: a mass, free or on a spring.
//!
//! Model: `M (q'' + 2 sigma q' + omega^2 q) = F`. A force held over the sample is integrated exactly,
//! as in a [modal body](crate::modal), so that its work in the sample is exactly `F (q_after - q_before)`;
//! here in `f64` and with `omega = 0` allowed, the free mass.

/// What moves by less has come to rest, m and m/s: 50 decades under a soft stroke, and what is computed from its square is no denormal
/// number. *Derived*.
const QUIET: f64 = 1e-60;

/// A mass on a spring, or free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oscillator {
    /// Displacement, m.
    pub q: f64,
    /// Velocity, m/s.
    pub v: f64,
    mass: f64,
    omega: f64,
    /// A sample without force: `[q, v] <- [[a, b], [c, d]] [q, v]`.
    turn: [[f64; 2]; 2],
    /// Effect of a unit force held for one sample on `q` and `v`.
    hold: [f64; 2],
}

impl Oscillator {
    /// A free mass (kg).
    pub fn free(mass: f64, dt: f64) -> Oscillator {
        let (turn, hold) = ([[1.0, dt], [0.0, 1.0]], [0.5 * dt * dt / mass, dt / mass]);
        Oscillator { q: 0.0, v: 0.0, mass, omega: 0.0, turn, hold }
    }

    /// A mass (kg) on a spring: angular frequency (rad/s, above 0) and decay rate (1/s, below it).
    pub fn sprung(mass: f64, omega: f64, sigma: f64, dt: f64) -> Oscillator {
        let sigma = sigma.min(0.999 * omega);
        let omega_d = (omega * omega - sigma * sigma).sqrt();
        let decay = (-sigma * dt).exp();
        let (sin, cos) = (omega_d * dt).sin_cos();
        let (s, c) = (decay * sin / omega_d, decay * cos);
        let turn = [[c + sigma * s, s], [-omega * omega * s, c - sigma * s]];
        // 1 - turn[0][0] without cancellation, for slow springs.
        let half = (0.5 * omega_d * dt).sin();
        let bent = -(-sigma * dt).exp_m1() + 2.0 * decay * half * half - sigma * s;
        let hold = [bent / (mass * omega * omega), s / mass];
        Oscillator { q: 0.0, v: 0.0, mass, omega, turn, hold }
    }

    /// Moves as another from now on.
    pub fn become_like(&mut self, other: Oscillator) {
        *self = Oscillator { q: self.q, v: self.v, ..other };
    }

    /// Of its spring, N/m; zero of a free mass.
    pub fn stiffness(&self) -> f64 {
        self.mass * self.omega * self.omega
    }

    /// One-sample compliance: displacement at the end of a sample by a unit force held over it, m/N.
    pub fn compliance(&self) -> f64 {
        self.hold[0]
    }

    /// Advances a sample without force.
    pub fn step(&mut self) {
        let (q, v) = (self.q, self.v);
        self.q = self.turn[0][0] * q + self.turn[0][1] * v;
        self.v = self.turn[1][0] * q + self.turn[1][1] * v;
        if self.q.abs().max(self.v.abs()) < QUIET {
            self.rest();
        }
    }

    /// Adds the effect of a force (N) held over the sample just stepped.
    pub fn push(&mut self, force: f64) {
        self.q += self.hold[0] * force;
        self.v += self.hold[1] * force;
    }

    /// Energy of motion alone, J.
    pub fn motion(&self) -> f64 {
        0.5 * self.mass * self.v * self.v
    }

    /// Energy of motion and of the spring, J.
    pub fn energy(&self) -> f64 {
        0.5 * self.mass * (self.v * self.v + (self.omega * self.q).powi(2))
    }

    /// Puts it to rest where its spring is slack.
    pub fn rest(&mut self) {
        (self.q, self.v) = (0.0, 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_held_force_does_exactly_the_work_it_should_and_bends_it_statically() {
        let dt = 1.0 / 48_000.0;
        for (omega, mass) in [(0.0, 0.016), (450.0, 7.5e-4), (60_000.0, 1e-5)] {
            let mut it = if omega == 0.0 {
                Oscillator::free(mass, dt)
            } else {
                Oscillator::sprung(mass, omega, 0.0, dt)
            };
            it.v = 1.0;
            let mut work = 0.0;
            let start = it.energy();
            for i in 0..5000 {
                let (force, before) = (f64::from(i % 7) - 3.5, it.q);
                it.step();
                it.push(force);
                work += force * (it.q - before);
            }
            let error = it.energy() - start - work;
            assert!(error.abs() < 1e-9 * (start + work.abs()), "{omega}: {error}");
        }
        let mut damped = Oscillator::sprung(7.5e-4, 450.0, 56.0, dt);
        for _ in 0..96_000 {
            damped.step();
            damped.push(0.3);
        }
        let bent = 0.3 / (7.5e-4 * 450.0 * 450.0);
        assert!((damped.q / bent - 1.0).abs() < 1e-9);
    }
}
