//! What a piece asks of the instrument inside it, whatever that is.
//!
//! An instrument is one struck [`Surface`] and the controls that change it while it rings. Controls glide: they are
//! [asked for](Instrument::set_tuning), [advance](Instrument::advance_controls) as samples pass, and the modes
//! [follow](Instrument::follow_controls) once a block. What an instrument does not have it ignores.

use crate::mode::ModeInfo;
use crate::strike::Strike;
use crate::surface::Surface;

/// A drum, a cymbal, a hi-hat.
///
/// # Real-time
/// But for [`modes`](Self::modes) and [`tensions`](Self::tensions) nothing allocates or locks.
pub trait Instrument: Send {
    /// What is struck and heard, and all that is about it.
    fn surface(&self) -> &Surface;

    /// What is struck and heard, and all that is about it.
    fn surface_mut(&mut self) -> &mut Surface;

    /// Strikes at the next sample.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    fn strike(&mut self, strike: &Strike) {
        self.follow_shapes();
        self.surface_mut().strike(strike);
    }

    /// Brings what only strokes and arriving sound need to where the controls are.
    ///
    /// # Real-time
    /// Nothing while the controls rest; linear in the number of modes after they have moved.
    fn follow_shapes(&mut self) {}

    /// Asks for a tuning: Hz of a drum's named mode, a ratio of all frequencies to a cymbal's own.
    fn set_tuning(&mut self, tuning: f64);

    /// Asks for muffling, 0 to 1.
    fn set_muffling(&mut self, amount: f64);

    /// Lets a hand take hold of it, from 0 (lets go) to 1 (firmly).
    fn choke(&mut self, _strength: f64) {}

    /// Whether a control has moved since the modes followed.
    fn has_moved(&self) -> bool;

    /// Whether the modes are to follow at once, not in their turn.
    fn is_urgent(&self) -> bool {
        false
    }

    /// Throws snare wires on or off.
    fn throw_wires(&mut self, _on: bool) {}

    /// Asks for a force that presses snare wires on, N.
    fn set_preload(&mut self, _newtons: f64) {}

    /// Its pedal, if it has one.
    fn pedal_mut(&mut self) -> Option<&mut dyn Pedal> {
        None
    }

    /// Lets the controls glide for `seconds`.
    fn advance_controls(&mut self, seconds: f64);

    /// Brings the modes to where the controls are.
    ///
    /// # Real-time
    /// Nothing while they rest; linear in the number of modes while they move.
    fn follow_controls(&mut self);

    /// Lets the controls arrive at once.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    fn finish_controls(&mut self);

    /// Every mode as it is now. Allocates.
    fn modes(&self) -> Vec<ModeInfo>;

    /// Tension of each stretched body, N/m. Allocates.
    fn tensions(&self) -> Vec<(&'static str, f64)> {
        Vec::new()
    }
}

/// A pedal: a place from 0 (up) to 1 (down) that moves with a speed, m/s.
pub trait Pedal {
    /// Brings it to a place at up to a speed (m/s).
    ///
    /// # Real-time
    /// Linear in the number of modes.
    fn press(&mut self, pedal: f64, speed: f64);

    /// Brings it to a place within [`ARRIVAL`](crate::hi_hat::ARRIVAL), as a foot that was sent there before.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    fn arrive(&mut self, pedal: f64);

    /// Brings it down at a speed (m/s), from a little above where rims meet, wherever it was.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    fn stamp(&mut self, speed: f64);

    /// Brings the rims together at a speed (m/s) in the same way and lets them go at once.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    fn splash(&mut self, speed: f64);
}
