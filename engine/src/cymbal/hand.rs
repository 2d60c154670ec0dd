//! A hand that chokes a cymbal.

use crate::fitted;

/// A hand that grips the edge on the player's side, thumb above and fingers below.
pub struct Hand;

impl Hand {
    /// Decay rate of a mode of unit mean square in the palm, 1/s. *By ear*: a choked crash is gone in
    /// a fifth of a second.
    const SIGMA: f64 = fitted::HAND_SIGMA;
    /// Where the palm lies: shares of the radius, rad.
    const RADII: [f64; 3] = [0.8, 0.9, 0.98];
    const ANGLES: [f64; 5] = [-0.24, -0.12, 0.0, 0.12, 0.24];
    /// Dashpots all over the palm: decay rate of a mode of unit square shape there (1/s), radius and angle.
    pub fn places() -> impl Iterator<Item = (f64, f64, f64)> {
        let share = Hand::SIGMA / (Hand::RADII.len() * Hand::ANGLES.len()) as f64;
        Hand::RADII.into_iter().flat_map(move |radius| Hand::ANGLES.map(|angle| (share, radius, angle)))
    }
}
