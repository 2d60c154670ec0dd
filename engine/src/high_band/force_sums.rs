//! Forces at places that are more than half a wave apart, as the sections of snare wires are.
//!
//! A slice takes the force of every place with a weight of its own, and of either sign by chance. How much energy all slices take depends on
//! the squares of the weights only. So a slice gets the root mean square of its weights over the places as its only weight, and takes one
//! of [`TURNS`] sums of the forces, with the signs of Walsh functions: over all sums the products of different places' forces cancel exactly.
//! Neighbouring slices take different sums, as with chance weights: if they took the same, the chance spectrum of the force would be heard in that of the
//! head, and noise would become a comb. The slices are interleaved for that, as [`REST`] of them in a row take the same sum.
//!
//! A run then costs as much as with a single place.

use super::point_band::PointBand;
use super::slices::Slice;
use crate::modal::simd::{MAX_RUN, REST};
use crate::modal::{InputVector, ModalBody, RECEIVERS, ReceiverWeights};
use crate::receiver::POINTS;

/// Sums that take turns: more than there are places.
const TURNS: usize = 16;

/// Most places: every one has a Walsh function of its own, beside the constant one.
pub(super) const MOST: usize = TURNS - 1;

/// Sums of the forces at all places.
pub(super) struct ForceSums {
    port: InputVector,
    /// Pressure at each point at once per unit of each sum, Pa/N.
    direct: [[f32; POINTS]; TURNS],
    /// N, `[turn][sample]`.
    forces: [f32; TURNS * MAX_RUN],
    /// Whether places or slices have changed since the port followed them.
    pub(super) stale: bool,
}

/// Slices in an order in which neighbours take different sums. Those that begin an octave stay in front of those of the next.
pub(super) fn interleaved(slices: Vec<Slice>) -> Vec<Slice> {
    let mut all = Vec::with_capacity(slices.len());
    for some in slices.chunks(TURNS * REST) {
        let turns = some.len().div_ceil(REST);
        (0..turns).for_each(|turn| all.extend(some.iter().skip(turn).step_by(turns)));
    }
    all
}

/// Whether the sum of a turn takes the force of a place with the other sign.
fn is_negative(turn: usize, place: usize) -> bool {
    (turn & (place + 1)).count_ones() % 2 == 1
}

impl ForceSums {
    /// Of so many slices. Allocates.
    pub(super) fn new(slices: usize) -> ForceSums {
        ForceSums {
            port: InputVector::new(slices),
            direct: [[0.0; POINTS]; TURNS],
            forces: [0.0; TURNS * MAX_RUN],
            stale: true,
        }
    }

    /// Follows the places and the slices.
    ///
    /// # Real-time
    /// Linear in slices times places.
    fn follow(&mut self, places: &[PointBand], body: &ModalBody, pickup: &ReceiverWeights) {
        self.stale = false;
        let share = 1.0 / places.len() as f32;
        let shape = self.port.shape_mut();
        body.kernels().vectorized(
            #[inline(always)]
            || {
                shape.fill(0.0);
                for place in places {
                    let rows = shape.iter_mut().zip(place.port.shape());
                    rows.for_each(|(square, shape)| *square += share * shape * shape);
                }
                shape.iter_mut().for_each(|shape| *shape = shape.sqrt());
            },
        );
        body.connect(&mut self.port);
        self.direct = pickup.direct_in_turns(body, &self.port);
    }

    /// Advances the slices through a run under the forces at the places, and listens.
    pub(super) fn ring(
        &mut self,
        places: &[PointBand],
        (body, pickup): (&mut ModalBody, &ReceiverWeights),
        heard: &mut [&mut [f32]; RECEIVERS],
    ) {
        if self.stale {
            self.follow(places, body, pickup);
        }
        let samples = heard[0].len();
        let forces = &mut self.forces[..TURNS * samples];
        for (turn, sums) in forces.chunks_exact_mut(samples).enumerate() {
            sums.fill(0.0);
            for (i, place) in places.iter().enumerate().filter(|(_, place)| place.pressed) {
                let sign = if is_negative(turn, i) { -1.0 } else { 1.0 };
                sums.iter_mut().zip(&place.forces).for_each(|(sum, force)| *sum += sign * force);
            }
        }
        body.ring_in_turns((&self.port, forces, TURNS), pickup, heard.each_mut().map(|row| &mut **row));
        for (sums, direct) in forces.chunks_exact(samples).zip(&self.direct) {
            for (heard, direct) in heard.iter_mut().zip(direct) {
                heard.iter_mut().zip(sums).for_each(|(heard, sum)| *heard += direct * sum);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_different_places_cancel_over_all_turns() {
        let sign = |turn, place| if is_negative(turn, place) { -1 } else { 1 };
        for a in 0..MOST {
            for b in 0..MOST {
                let sum: i32 = (0..TURNS).map(|turn| sign(turn, a) * sign(turn, b)).sum();
                assert_eq!(sum, if a == b { TURNS as i32 } else { 0 }, "{a} {b}");
            }
        }
    }
}
