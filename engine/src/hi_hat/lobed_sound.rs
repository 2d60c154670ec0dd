//! Sources of sound about a disc that have every frequency: what is heard of them as filters.
//!
//! Model: the pressure of a source over its acceleration, `H`, is a real number close by where it is slow, grows with the frequency, and falls
//! where the disc is wider than the waves, in lobes. What drives it (strokes, rims that land, felts, air) has every frequency, so that one number does not
//! do as it does for a mode. Each `H` is the filter
//!
//! ```text
//! H(s) = (slow + middle y + fast y^2) / (1 + y)^3,   y = s a / (2 c)
//! ```
//!
//! with `slow` the limit at zero frequency; `middle` and `fast` such that the squares of the relative errors are least from
//! `k a = 0.2` to 1.6, or to 3.2. *Derived*.
//!
//! Limits: of the lobes it has a mean fall only.

use nalgebra::Complex;

use crate::air_load::SPEED_OF_SOUND;
use crate::modal::Pressure;
use crate::receiver::POINTS;

/// Pole of the filters, in units of the speed of sound over the radius: where a disc is as wide as a third of a wave. *Judgement*.
const POLE: f64 = 2.0;

/// Where the filters of slow sources are matched, `k a`, dimensionless: 60 to 500 Hz for a hi-hat.
pub const TO_SLOW: [f64; 5] = [0.2, 0.4, 0.7, 1.0, 1.6];

/// And those of faster ones, `k a`, dimensionless: to 1 kHz.
pub const TO_FAST: [f64; 6] = [0.2, 0.4, 0.7, 1.0, 1.6, 3.2];

/// An acceleration that is not heard, m/s2: 20 decades under a soft stroke's. What follows one would become denormal. *Derived*.
const FAINT: f64 = 1e-20;

/// How `N` sources are heard.
#[derive(Debug, Clone, Copy)]
pub struct LobedSound<const N: usize> {
    /// At each receiver, pressure over acceleration.
    slow: [[f64; N]; POINTS],
    middle: [[f64; N]; POINTS],
    fast: [[f64; N]; POINTS],
    /// Share of the distance to the present acceleration that the filters go in a sample.
    share: f64,
    /// Accelerations behind one, two and three poles.
    smoothed: [[f64; N]; 3],
}

impl<const N: usize> LobedSound<N> {
    /// Sources about a disc of a radius (m), at a sample time of `dt` (s). `heard(source, u)` is the pressure of one over its acceleration at each
    /// receiver, `[re, im]`, at `k a = u`; filters are matched at the `u` given.
    pub fn new(
        radius: f64,
        dt: f64,
        matched: &[f64],
        heard: impl Fn(usize, f64) -> [[f64; 2]; POINTS],
    ) -> LobedSound<N> {
        let none = [[0.0; N]; POINTS];
        let share = -(-POLE * SPEED_OF_SOUND / radius * dt).exp_m1();
        let mut sound = LobedSound { slow: none, middle: none, fast: none, share, smoothed: [[0.0; N]; 3] };
        for source in 0..N {
            let still = heard(source, 1e-3);
            let moving: Vec<_> = matched.iter().map(|&u| (u, heard(source, u))).collect();
            for (at, still) in still.iter().enumerate() {
                let slow = still[0];
                // H (1 + i x)^3 = slow + i x middle - x^2 fast: the real and the imaginary part are each linear in one of them.
                let (mut middle, mut fast) = ([0.0; 2], [0.0; 2]);
                for (u, moving) in &moving {
                    let (x, [re, im]) = (u / POLE, moving[at]);
                    let whole = Complex::new(re, im) * Complex::new(1.0, x).powi(3);
                    // What is not heard there at all has no error either.
                    let weight = whole.norm_sqr().max(f64::MIN_POSITIVE).recip();
                    middle = [middle[0] + weight * x * whole.im, middle[1] + weight * x * x];
                    fast = [fast[0] + weight * x * x * (slow - whole.re), fast[1] + weight * x.powi(4)];
                }
                sound.slow[at][source] = slow;
                sound.middle[at][source] = middle[0] / middle[1];
                sound.fast[at][source] = fast[0] / fast[1];
            }
        }
        sound
    }

    /// Pressure at each receiver under the accelerations of a sample, Pa.
    pub fn hear(&mut self, accelerations: &[f64; N]) -> Pressure {
        let mut heard = Pressure::default();
        for (source, &now) in accelerations.iter().enumerate() {
            let mut behind = now;
            for smoothed in &mut self.smoothed {
                smoothed[source] += self.share * (behind - smoothed[source]);
                if smoothed[source].abs() < FAINT {
                    smoothed[source] = 0.0;
                }
                behind = smoothed[source];
            }
            let [once, twice, thrice] = self.smoothed.map(|smoothed| smoothed[source]);
            let (middle, high) = (twice - thrice, once - 2.0 * twice + thrice);
            for (at, heard) in heard.iter_mut().take(POINTS).enumerate() {
                let low = self.slow[at][source] * thrice;
                *heard += (low + self.middle[at][source] * middle + self.fast[at][source] * high) as f32;
            }
        }
        heard
    }

    /// Pressure at each receiver while nothing moves any more, Pa.
    pub fn ring_out(&mut self) -> Pressure {
        if self.smoothed == [[0.0; N]; 3] {
            return Pressure::default();
        }
        self.hear(&[0.0; N])
    }

    /// As if nothing had ever moved.
    pub fn reset(&mut self) {
        self.smoothed = [[0.0; N]; 3];
    }
}
