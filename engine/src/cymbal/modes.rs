//! The modes of a cymbal as built, and what damps each.

use crate::damping::{LossLaw, Muffler, Thermoelastic};
use crate::modal::Mode;
use crate::mode::{Member, ModeKind};
use crate::shapes::ShapeTable;

use super::alloy::Alloy;
use super::hand::Hand;

/// One mode of the body, as built.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BuiltMode {
    /// Nodal diameters.
    pub m: u32,
    /// Nodal circles.
    pub n: u32,
    /// Which of a pair.
    pub member: Member,
    /// A shell mode is complete; a motion of the plate as a whole is rigid.
    pub kind: ModeKind,
    /// Undamped angular frequency at tuning 1, with the member's detuning, rad/s.
    pub omega: f64,
    /// Radiation resistance over twice the mass at tuning 1, 1/s.
    pub radiated: f64,
    /// Decay rate that the mount adds, 1/s.
    pub mounted: f64,
    /// Decay rate at full muffling, 1/s.
    pub muffling: f64,
    /// Decay rate in a firm hand, 1/s.
    pub choking: f64,
    /// Area of the monopole that would radiate its power, m2.
    pub monopole_area: f64,
}

/// A cymbal's modes, in the order of the body's.
pub struct CymbalModes {
    /// `[mode]`.
    pub modes: Vec<BuiltMode>,
    /// The metal, which loses by internal friction.
    pub alloy: Alloy,
    /// What it loses by heat.
    pub heat: Thermoelastic,
    /// All other losses inside.
    pub loss: LossLaw,
    /// Of the plate, kg.
    pub mass: f64,
}

impl CymbalModes {
    /// Mode `k` without losses, at a ratio of its frequency; rigid motions keep theirs.
    pub fn bare(&self, k: usize, tuning: f64) -> Mode {
        let built = &self.modes[k];
        let omega = match built.kind {
            ModeKind::Rigid => built.omega,
            _ => built.omega * tuning,
        };
        Mode { omega, sigma: 0.0, mass: self.mass }
    }

    /// Decay rate of mode `k` at an angular frequency (rad/s), with nothing laid on it, 1/s.
    pub fn sigma(&self, k: usize, omega: f64) -> f64 {
        let built = &self.modes[k];
        match built.kind {
            ModeKind::Rigid => built.mounted,
            _ => {
                let inside = self.loss.sigma(omega) + self.alloy.friction(omega) + self.heat.sigma(omega);
                inside + built.radiated + built.mounted
            }
        }
    }

    /// Works out what the muffler and a hand take from each mode, given its shapes.
    pub(super) fn damp(&mut self, muffler: &Muffler, shapes: &ShapeTable) {
        let mut shape = vec![0.0_f32; self.modes.len()];
        // A cymbal takes no other muffler.
        if let Muffler::Gel { sigma, radius, angle } = *muffler {
            shapes.fill(radius, angle, &mut shape);
            for (mode, &shape) in self.modes.iter_mut().zip(&shape) {
                mode.muffling = sigma * f64::from(shape).powi(2);
            }
        }
        for (share, radius, angle) in Hand::places() {
            shapes.fill(radius, angle, &mut shape);
            for (mode, &shape) in self.modes.iter_mut().zip(&shape) {
                mode.choking += share * f64::from(shape).powi(2);
            }
        }
    }
}
