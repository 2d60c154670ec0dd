//! Strokes, controls, pedals and moved microphones of a kit that plays.

use crate::hi_hat::SPLASHING;
use crate::hi_hat::foot::SPEED;
use crate::layout::Pair;
use crate::piece::Piece;
use crate::slot::Slot;
use crate::strike::Strike;

use super::Kit;
use super::control::{Control, Microphone};

impl Kit {
    /// Moves the overheads or the room pair to `places`, m, not farther than [`FARTHEST`](crate::layout::FARTHEST) from any
    /// piece. The sound cross-fades within some hundredths of a second. A close microphone stays where its piece was built for.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn place(&mut self, microphones: Microphone, places: Pair) {
        if places.iter().flatten().all(|x| x.is_finite()) {
            match microphones {
                Microphone::Close(_) => {}
                Microphone::Overheads => self.air.place_pair(0, places),
                Microphone::Room => self.air.place_pair(1, places),
            }
        }
    }

    fn mut_piece(&mut self, slot: Slot) -> Option<&mut Box<Piece>> {
        self.jobs[slot.index()].as_mut()?.piece.as_mut()
    }

    /// Strikes a piece at the next sample. A stroke on a piece not yet built is dropped and counted.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn strike(&mut self, slot: Slot, strike: &Strike) {
        match self.mut_piece(slot) {
            Some(piece) => piece.strike(strike),
            None => self.dropped_strikes = self.dropped_strikes.saturating_add(1),
        }
    }

    /// Chokes a cymbal or damps a head by hand, from 0 (free) to 1 (firmly held); see [`Piece::choke`]. A NaN is ignored.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn choke(&mut self, slot: Slot, strength: f64) {
        if let Some(piece) = self.mut_piece(slot).filter(|_| !strength.is_nan()) {
            piece.choke(strength);
        }
    }

    /// Sets a control from the next sample on; a value outside its range becomes the nearest end. A NaN
    /// is ignored, and so is a control that the slot's piece does not have.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn set(&mut self, control: Control, value: f64) {
        if value.is_nan() {
            return;
        }
        let on = value >= 0.5;
        match control {
            Control::Master => self.mixer.set_master(value),
            Control::Level(slot) => self.mixer.set_level(slot, value),
            Control::Pan(slot) => self.mixer.set_balance(Microphone::Close(slot), value),
            Control::Balance(microphone) => self.mixer.set_balance(microphone, value),
            Control::MicrophoneLevel(microphone) => self.mixer.set_strip_level(microphone, value),
            Control::CloseLevel => self.mixer.set_close(value),
            Control::Mute(microphone) => self.mixer.mute(microphone, on),
            Control::Solo(microphone) => self.mixer.solo(microphone, on),
            Control::SafetyClip => self.mixer.set_clip(on),
            Control::SympatheticCoupling => self.couple(on, self.sympathy),
            Control::Sympathy => self.couple(self.coupled, value.clamp(0.0, 1.0) as f32),
            Control::Pedal(slot) => self.press_pedal(slot, value, SPEED.1),
            Control::Preload(slot)
            | Control::Wires(slot)
            | Control::Tuning(slot)
            | Control::Muffling(slot) => self.adjust(slot, control, value),
        }
    }

    /// Sets a control of a piece and of those that will replace it.
    fn adjust(&mut self, slot: Slot, control: Control, value: f64) {
        let retained = &mut self.retained[slot.index()];
        let piece = self.jobs[slot.index()].as_mut().and_then(|job| job.piece.as_mut());
        match control {
            Control::Preload(_) => {
                retained.preload = value;
                piece.into_iter().for_each(|piece| piece.set_preload(value));
            }
            Control::Wires(_) => {
                retained.wires = value >= 0.5;
                piece.into_iter().for_each(|piece| piece.throw_wires(value >= 0.5));
            }
            Control::Muffling(_) => {
                retained.muffling = value;
                piece.into_iter().for_each(|piece| piece.set_muffling(value));
            }
            _ => {
                retained.tuning = value;
                piece.into_iter().for_each(|piece| piece.set_tuning(value));
            }
        }
    }

    fn couple(&mut self, coupled: bool, sympathy: f32) {
        (self.coupled, self.sympathy) = (coupled, sympathy);
        self.coupling.set(if coupled { sympathy } else { 0.0 });
    }

    /// Moves a slot's pedal by `step`. `left` gives the position where it ends, 0 to 1, from the one before; a piece that is
    /// installed later starts there.
    fn step_on(&mut self, slot: Slot, left: impl FnOnce(f64) -> f64, step: impl FnOnce(&mut Piece)) {
        let retained = &mut self.retained[slot.index()];
        retained.pedal = left(retained.pedal);
        if let Some(piece) = self.mut_piece(slot) {
            step(piece);
        }
    }

    /// Moves a hi-hat's pedal to a position, 0 (up) to 1 (down), at up to a speed (m/s); see
    /// [`Piece::press_pedal`]. A NaN is ignored.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn press_pedal(&mut self, slot: Slot, pedal: f64, speed: f64) {
        if !pedal.is_nan() {
            self.step_on(slot, |_| pedal, |hat| hat.press_pedal(pedal, speed));
        }
    }

    /// Brings a hi-hat's pedal to a position, 0 (up) to 1 (down), as a foot that was sent there before; see
    /// [`Piece::arrive_pedal`]. A NaN is ignored.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn arrive_pedal(&mut self, slot: Slot, pedal: f64) {
        if !pedal.is_nan() {
            self.step_on(slot, |_| pedal, |hat| hat.arrive_pedal(pedal));
        }
    }

    /// Stamps on a hi-hat's pedal, at a speed (m/s); see [`Piece::stamp_pedal`].
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn stamp_pedal(&mut self, slot: Slot, speed: f64) {
        self.step_on(slot, |_| 1.0, |hat| hat.stamp_pedal(speed));
    }

    /// Splashes with a hi-hat's pedal, at up to a speed (m/s); see [`Piece::splash_pedal`].
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn splash_pedal(&mut self, slot: Slot, speed: f64) {
        self.step_on(slot, |pedal| pedal.min(SPLASHING), |hat| hat.splash_pedal(speed));
    }

    /// Ends all glides of controls, to set the kit up before it sounds.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn finish_controls(&mut self) {
        self.mixer.jump();
        self.coupling.jump();
        self.air.jump();
        for piece in self.jobs.iter_mut().flatten().filter_map(|job| job.piece.as_mut()) {
            piece.finish_controls();
        }
    }
}
