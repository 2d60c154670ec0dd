//! A place that the high band is pressed on at.

use crate::modal::simd::MAX_RUN;
use crate::modal::{InputVector, ModalBody, Pressure, ReceiverWeights};
use crate::receiver::POINTS;

/// A place that is pressed on, and how hard over the present run.
pub(super) struct PointBand {
    pub(super) port: InputVector,
    /// Pressure at once per unit force, Pa/N: the slices' at each point, unless they take sums of forces; an endless sheet's; what of that the complete set lacks.
    pub(super) direct: [f32; POINTS],
    pub(super) sheet: f32,
    pub(super) lacking: f32,
    /// The slow part of the force, N.
    pub(super) slow: f32,
    pub(super) forces: [f32; MAX_RUN],
    pub(super) pressed: bool,
}

impl PointBand {
    /// Of so many slices, pressed on by nothing. Allocates.
    pub(super) fn new(slices: usize) -> PointBand {
        PointBand {
            port: InputVector::new(slices),
            direct: [0.0; POINTS],
            sheet: 0.0,
            lacking: 0.0,
            slow: 0.0,
            forces: [0.0; MAX_RUN],
            pressed: false,
        }
    }

    /// Follows its shapes or the slices.
    pub(super) fn connect(&mut self, body: &ModalBody, pickup: &ReceiverWeights) {
        body.connect(&mut self.port);
        self.direct = at_points(pickup.direct_at(body, &self.port));
    }

    /// Adds what follows the forces of the run at once.
    pub(super) fn add_direct(&mut self, follow: f32, gains: &[f32; POINTS], out: &mut [&mut [f32]]) {
        for (sample, force) in self.forces.iter().enumerate().take(out[0].len()) {
            self.slow += follow * (force - self.slow);
            let lacking = self.lacking * (force - self.slow);
            for ((out, direct), gain) in out.iter_mut().zip(&self.direct).zip(gains) {
                out[sample] += direct * force + gain * lacking;
            }
        }
    }
}

/// Of the pressure at each receiver that at the points.
fn at_points(pressure: Pressure) -> [f32; POINTS] {
    std::array::from_fn(|point| pressure[point])
}
