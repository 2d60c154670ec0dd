//! A cymbal: a domed plate with a bell on a stand, struck and heard.
//!
//! Model: the shell modes of the plate, up to the edge of hearing, and the plate's rigid motions on its
//! stand, a bounce and a rock. Bent by more than its thickness the plate stretches, which couples the
//! modes up to a frequency that the quality chooses ([`VonKarman`](crate::von_karman::VonKarman)); above, they stay linear. The
//! rigid motions are too slow to be heard. The plate stands in free air ([`FreeDisc`](crate::plate::free_disc::FreeDisc)).

use std::f64::consts::{FRAC_2_PI, TAU};

pub mod alloy;
pub mod assembly;
pub mod hammering;
pub mod hand;
pub mod lobes;
pub mod mixed_potential;
pub mod mixing;
pub mod modes;
pub mod sounding_plate;
pub mod spec;

use crate::build_context::BuildContext;
use crate::damping::SIGMA_T60;
use crate::error::SpecError;
use crate::glide::Glide;
use crate::grip::Grip;
use crate::instrument::Instrument;
use crate::modal::Mode;
use crate::mode::{ModeInfo, ModeKind};
use crate::plate::ShellMode;
use crate::surface::Surface;

pub use alloy::Alloy;
use assembly::{CymbalPlate, Ordered, RigidMotion};
use modes::CymbalModes;
pub use spec::{CymbalSpec, Stand};

/// A cymbal that can be struck.
pub struct Cymbal {
    surface: Surface,
    modes: CymbalModes,
    lossless: bool,
    tuning: Glide,
    muffling: Glide,
    /// How firmly a hand holds it, 0 to 1.
    hand: Grip,
    /// Whether a control has moved since the modes last followed.
    stale: bool,
}

/// The plate's motions on its stand: a bounce and a rock.
fn rigid(stand: &Stand) -> [RigidMotion; 2] {
    let motion = |m, shape, hz: f64, q: f64| {
        let omega = TAU * hz;
        RigidMotion { m, shape, omega, sigma: omega / (2.0 * q) }
    };
    [motion(0, |_| 1.0, stand.bounce_hz, stand.q), motion(1, |r| 2.0 * r, stand.rock_hz, stand.rock_q)]
}

/// Root mean square radius of the ring of felt that carries a cymbal, m: felts are 35 to 40 mm wide, with a hole of 10.
/// *Trade sizes*.
pub const FELT_RADIUS: f64 = 0.014;

/// Decay rate (1/s) that the stand's felts give to a mode of unit shape at them, at an angular frequency (rad/s).
///
/// The felts are the spring on which the plate bounces, `k = M omega_b^2` at the bounce, with a loss factor of `1 / q`,
/// *assumed* to be the same at every frequency. With such a loss the stiffness grows as `omega^alpha`, `alpha = 2 / pi atan(1 / q)` (Kramers & Kronig).
/// A mode of the mass `M` loses `k / (2 M q omega)`; at the bounce itself that is the bounce's own decay rate.
fn felt_loss(stand: &Stand, omega: f64) -> f64 {
    let bounce = TAU * stand.bounce_hz;
    let alpha = FRAC_2_PI * stand.q.recip().atan();
    let stiffness = bounce * bounce * (omega / bounce).powf(alpha);
    stiffness / (2.0 * stand.q * omega)
}

impl Cymbal {
    /// Builds a cymbal. Allocates; takes some tenths of a second.
    ///
    /// # Errors
    /// [`SpecError`] if a number is out of range.
    pub fn new(spec: &CymbalSpec, context: &BuildContext) -> Result<Cymbal, SpecError> {
        spec.check()?;
        let stand = spec.stand.ok_or_else(|| SpecError::refused("stand", "is missing, accepted: a stand"))?;
        let plate = CymbalPlate::new(spec, assembly::coupled_hz(context), context)?;
        // By frequency: those that are coupled come first.
        let shells = plate.shells().iter().enumerate();
        let order: Vec<Ordered> =
            shells.map(|(shell, mode)| Ordered { shell, is_coupled: plate.is_coupled(mode) }).collect();
        let (modes, shapes) = {
            let at_felt = plate.shapes_at(FELT_RADIUS / spec.plate().radius());
            let felt = |row: usize, shell: &ShellMode| {
                let around = if shell.m == 0 { 1.0 } else { 0.5 };
                felt_loss(&stand, shell.omega) * around * at_felt[row].powi(2)
            };
            plate.assemble(&rigid(&stand), &order, felt)
        };
        let (low, tuning, high) = CymbalSpec::TUNING;
        let mut cymbal = Cymbal {
            surface: shapes.into_surface(spec, &modes, context),
            modes,
            lossless: context.ideal.lossless,
            tuning: Glide::new(tuning, low, high),
            muffling: Glide::new(0.0, 0.0, 1.0),
            hand: Grip::new(),
            stale: true,
        };
        cymbal.follow_controls();
        Ok(cymbal)
    }
}

impl Instrument for Cymbal {
    fn surface(&self) -> &Surface {
        &self.surface
    }

    fn surface_mut(&mut self) -> &mut Surface {
        &mut self.surface
    }

    fn set_tuning(&mut self, ratio: f64) {
        self.stale |= self.tuning.set(ratio);
    }

    fn set_muffling(&mut self, amount: f64) {
        self.stale |= self.muffling.set(amount);
    }

    fn choke(&mut self, strength: f64) {
        self.hand.set(strength);
    }

    fn advance_controls(&mut self, seconds: f64) {
        let moved = [&mut self.tuning, &mut self.muffling].map(|glide| glide.advance(seconds));
        self.stale |= moved.contains(&true);
        self.hand.advance(seconds);
    }

    fn has_moved(&self) -> bool {
        self.stale || self.hand.has_moved()
    }

    fn follow_controls(&mut self) {
        if !self.has_moved() {
            return;
        }
        self.stale = false;
        let (tuning, muffling, hand) = (self.tuning.value(), self.muffling.value(), self.hand.follow());
        let (modes, lossless) = (&self.modes, self.lossless);
        self.surface.retune(|k, _| {
            let (bare, built) = (modes.bare(k, tuning), &modes.modes[k]);
            let own = modes.sigma(k, bare.omega);
            let sigma = if lossless { 0.0 } else { own + muffling * built.muffling + hand * built.choking };
            Mode { sigma, ..bare }
        });
        // A stiffer metal resists stretching as it resists bending.
        if let Some(force) = self.surface.nonlinear_force_mut() {
            force.set_stiffness(tuning * tuning);
        }
    }

    fn finish_controls(&mut self) {
        let moved = [&mut self.tuning, &mut self.muffling].map(Glide::jump);
        self.stale |= moved.contains(&true) | self.hand.jump();
        self.follow_controls();
    }

    fn modes(&self) -> Vec<ModeInfo> {
        let rows = self.surface.body().modes().iter().zip(&self.modes.modes);
        rows.map(|(mode, built)| ModeInfo {
            body: if built.kind == ModeKind::Rigid { "stand" } else { "plate" },
            m: built.m,
            n: built.n,
            member: built.member,
            frequency_hz: mode.omega_d() / TAU,
            t60: SIGMA_T60 / mode.sigma,
            modal_mass: self.modes.mass,
            radiation: built.monopole_area,
            kind: built.kind,
        })
        .collect()
    }
}

#[cfg(test)]
mod tests;
