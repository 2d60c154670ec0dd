//! How much forces at the holes and under strikers move the plate at each other's places.

use crate::modal::{InputVector, ModalBody};
use crate::surface::contacts::STRIKER_PLACES;

use super::motion::Rivet;
use super::spec::MOST;

/// One-sample compliances, m/N.
pub struct Mutual {
    /// Between rivets, of the modes and their own masses, m/N.
    pub rivets: [[f64; MOST]; MOST],
    /// The sum of each row, m/N.
    pub summed: [f64; MOST],
    /// Between strikers' points and rivets, m/N, `[point][rivet]`.
    pub strikers: [[f64; MOST]; STRIKER_PLACES],
}

impl Mutual {
    /// Not connected yet.
    pub const NONE: Mutual =
        Mutual { rivets: [[0.0; MOST]; MOST], summed: [0.0; MOST], strikers: [[0.0; MOST]; STRIKER_PLACES] };

    /// Follows the modes, which all holes have been connected with.
    pub fn connect(&mut self, rivets: &[Rivet], modal: &ModalBody) {
        for (i, one) in rivets.iter().enumerate() {
            for (j, other) in rivets[..=i].iter().enumerate() {
                let mut mutual = modal.compliance(&other.port, &one.port);
                if i == j {
                    mutual += one.mass.compliance();
                }
                (self.rivets[i][j], self.rivets[j][i]) = (mutual, mutual);
            }
        }
        self.summed = self.rivets.map(|row| row.iter().sum());
    }

    /// Follows a striker's point.
    pub fn connect_striker(&mut self, point: usize, rivets: &[Rivet], modal: &ModalBody, port: &InputVector) {
        for (mutual, rivet) in self.strikers[point].iter_mut().zip(rivets) {
            *mutual = modal.compliance(port, &rivet.port);
        }
    }
}
