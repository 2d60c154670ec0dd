//! What rivets are: how many, where, how heavy, how loose.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::error::SpecError;
use crate::numbers::{Numbers, Visitor};

/// Most rivets of one cymbal.
pub const MOST: usize = 12;

/// A description of rivets in holes near the rim of a cymbal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RivetsSpec {
    /// How many, 1 to 12.
    pub number: u32,
    /// Where the holes are, a share of the cymbal's radius, 0.3 to 0.98.
    pub radius: f64,
    /// Arc that they are spread over from the first to the last, rad, 0.01 to 6.2; without it they are spread evenly all around.
    #[serde(rename = "arc_rad", default, skip_serializing_if = "Option::is_none")]
    pub arc: Option<f64>,
    /// Toward where the middle of the arc is, or the first of all around, from the player's side on, rad, -2 pi to 2 pi.
    #[serde(rename = "toward_rad")]
    pub toward: f64,
    /// Mass of each, kg, 0.0003 to 0.005.
    #[serde(rename = "mass_kg")]
    pub mass: f64,
    /// How far each can rise, m, 0.0005 to 0.01.
    #[serde(rename = "play_m")]
    pub play: f64,
}

impl Numbers for RivetsSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("radius", &mut self.radius, 0.3..=0.98);
        if let Some(arc) = &mut self.arc {
            visitor.number("arc_rad", arc, 0.01..=6.2);
        }
        visitor.number("toward_rad", &mut self.toward, -TAU..=TAU);
        visitor.number("mass_kg", &mut self.mass, 3e-4..=5e-3);
        visitor.number("play_m", &mut self.play, 5e-4..=0.01);
    }
}

impl RivetsSpec {
    /// Checks how many there are.
    ///
    /// # Errors
    /// [`SpecError`] naming the number if there are none or too many.
    pub fn check(&self) -> Result<(), SpecError> {
        SpecError::check("number", f64::from(self.number), 1.0, MOST as f64).map(|_| ())
    }

    /// Angle of each hole, rad.
    pub fn angles(&self) -> impl Iterator<Item = f64> + use<> {
        let &RivetsSpec { number, arc, toward, .. } = self;
        (0..number).map(move |i| {
            let along = match arc {
                None => f64::from(i) * TAU / f64::from(number),
                Some(_) if number == 1 => 0.0,
                Some(arc) => arc * (f64::from(i) / f64::from(number - 1) - 0.5),
            };
            toward + along
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_are_all_around_or_along_an_arc() {
        let spec = RivetsSpec { number: 3, radius: 0.9, arc: None, toward: 1.0, mass: 1e-3, play: 2e-3 };
        let around: Vec<f64> = spec.angles().collect();
        assert!(
            around
                .iter()
                .zip([1.0, 1.0 + TAU / 3.0, 1.0 + 2.0 * TAU / 3.0])
                .all(|(a, b)| (a - b).abs() < 1e-12)
        );
        let cluster: Vec<f64> = RivetsSpec { arc: Some(0.4), ..spec }.angles().collect();
        assert!(cluster.iter().zip([0.8, 1.0, 1.2]).all(|(a, b)| (a - b).abs() < 1e-12), "{cluster:?}");
        let single: Vec<f64> = RivetsSpec { arc: Some(0.4), number: 1, ..spec }.angles().collect();
        assert_eq!(single, [1.0]);
        for (number, accepted) in [(0, false), (1, true), (12, true), (13, false)] {
            assert_eq!(RivetsSpec { number, ..spec }.check().is_ok(), accepted, "{number}");
        }
    }
}
