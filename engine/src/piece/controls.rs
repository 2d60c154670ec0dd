//! What can be asked of a piece while it rings: all of it glides from the sample on at which it is asked.

use super::Piece;
use crate::hi_hat::pair::Pair;
use crate::snapshot::{RimSnapshot, WireSnapshot};

impl Piece {
    /// Asks for a pitch: of the named mode of a drum, Hz; of a cymbal, a ratio to its own.
    ///
    /// Acts while it rings, gliding over a few milliseconds from this sample on; clamped to the range.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn set_tuning(&mut self, tuning: f64) {
        self.glide();
        self.instrument.set_tuning(tuning);
    }

    /// Asks for muffling, from 0 to 1: none, and all there is. Acts while it rings, as the tuning does.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn set_muffling(&mut self, amount: f64) {
        self.glide();
        self.instrument.set_muffling(amount);
    }

    /// Lets a hand take hold of a cymbal or lie on a drum's batter head, firmly at 1, or let go of it, 0. Closes over some 25 ms from
    /// this sample on; takes energy and gives none.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn choke(&mut self, strength: f64) {
        self.glide();
        self.instrument.choke(strength);
    }

    /// Brings a hi-hat's pedal to a place, 0 (up, open) to 1 (down, clamped), from the next sample on, at up to a
    /// speed (m/s, see [`SPEED`](crate::hi_hat::foot::SPEED)). Other pieces have no such pedal.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn press_pedal(&mut self, pedal: f64, speed: f64) {
        if self.instrument.pedal_mut().is_some() {
            self.wake();
        }
        if let Some(own) = self.instrument.pedal_mut() {
            own.press(pedal, speed);
        }
    }

    /// Brings a hi-hat's pedal to a place, 0 (up, open) to 1 (down, clamped), within
    /// [`ARRIVAL`](crate::hi_hat::ARRIVAL), as a foot that was sent there before; cymbals at rest are there at once.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn arrive_pedal(&mut self, pedal: f64) {
        if self.instrument.pedal_mut().is_some() {
            self.wake();
        }
        if let Some(own) = self.instrument.pedal_mut() {
            own.arrive(pedal);
        }
    }

    /// Stamps on a hi-hat's pedal: brings it down at a speed (m/s, see [`SPEED`](crate::hi_hat::foot::SPEED)), from a little above where rims meet,
    /// wherever it was.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn stamp_pedal(&mut self, speed: f64) {
        if self.instrument.pedal_mut().is_some() {
            self.wake();
        }
        if let Some(own) = self.instrument.pedal_mut() {
            own.stamp(speed);
        }
    }

    /// Splashes with a hi-hat's pedal: brings the rims together at a speed (m/s) in the same way and lets them go at once.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn splash_pedal(&mut self, speed: f64) {
        if self.instrument.pedal_mut().is_some() {
            self.wake();
        }
        if let Some(own) = self.instrument.pedal_mut() {
            own.splash(speed);
        }
    }

    /// Throws snare wires on (from where the head is now) or off, at the next sample. Pieces without wires
    /// have none to throw.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn throw_wires(&mut self, on: bool) {
        self.glide();
        self.instrument.throw_wires(on);
    }

    /// Asks for a force that presses the snare wires on, all of them together, N; see
    /// [`PRELOAD`](crate::surface::wires::PRELOAD) for the range. Acts while they buzz, gliding.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn set_preload(&mut self, newtons: f64) {
        self.glide();
        self.instrument.set_preload(newtons);
    }

    /// What the snare wires have done since the latest stroke.
    pub fn wires(&self) -> WireSnapshot {
        self.instrument.surface().wires()
    }

    /// What a hi-hat's rims have done since the latest stroke.
    pub fn rims(&self) -> RimSnapshot {
        self.instrument.surface().attachment().map_or_else(RimSnapshot::default, Pair::landings)
    }

    /// Lets tuning and muffling arrive at once instead of gliding.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn finish_controls(&mut self) {
        self.instrument.finish_controls();
    }

    /// Lets the controls glide up to now, so that what is asked next starts here, not at a block.
    pub(super) fn glide(&mut self) {
        let seconds = std::mem::take(&mut self.unglided) as f64 / self.sample_rate;
        self.instrument.advance_controls(seconds);
    }
}
