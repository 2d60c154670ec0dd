//! What controllers, feet and hands beside strokes do.

use overhear_engine::hi_hat::TOUCHING;
use overhear_engine::slot::{SLOTS, Slot};

use super::{
    FINE_VELOCITY_CONTROLLER, FOOT, Grip, Handled, PEDAL_CONTROLLER, Playing, THROW_OFF_CONTROLLER,
    position_of,
};
use crate::midi_map::{Foot, Meaning};

impl Playing {
    /// The velocity (0 to 1) that a note's pad means by one that arrives; none of a double trigger and of crosstalk.
    ///
    /// # Real-time
    /// Look-ups; no allocation, no lock.
    pub fn triggered(&mut self, note: u8, velocity: f32, channel: u8) -> Option<f32> {
        if !(velocity > 0.0 && self.hears(channel)) {
            return Some(velocity);
        }
        let calibration = self.assignments.calibration();
        let pad = calibration.pad(note);
        let sounds = self.triggers.strike(note, velocity, &pad, calibration.crosstalk());
        sounds.then(|| pad.velocity(velocity))
    }

    /// What a note of a velocity (0 to 1) comes to that is no stroke, if it is one of those.
    ///
    /// # Real-time
    /// Table look-ups; no allocation, no lock.
    pub fn handled(&mut self, note: u8, velocity: f32, channel: u8) -> Option<Handled> {
        let heard = velocity > 0.0 && self.hears(channel);
        match self.document.notes.row(self.reference(note).filter(|_| heard)?)?.meaning {
            Meaning::Chokes(slot) => {
                let grip = self.grip(slot)?;
                Some(Handled::Grips(Grip { strength: f64::from(velocity.min(1.0)), ..grip }))
            }
            Meaning::Throws(slot, on) => {
                self.state.thrown[slot.index()] = Some(on);
                Some(Handled::Throws(slot, on))
            }
            _ => None,
        }
    }

    /// Throws the wires of all drums on or off, as a controller's value (0 to 1) says, if it is the one for that.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn throw(&mut self, controller: u8, value: f32, channel: u8) -> Option<bool> {
        let heard = controller == THROW_OFF_CONTROLLER && self.hears(channel) && !value.is_nan();
        let on = heard.then_some(value >= 64.0 / 127.0)?;
        self.state.thrown = [Some(on); SLOTS];
        Some(on)
    }

    /// Whether wires were thrown on or off by a note or a controller, in a slot.
    pub fn thrown(&self, slot: Slot) -> Option<bool> {
        self.state.thrown[slot.index()]
    }

    /// Every note ends: hands that were moved are where they were.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn end_notes(&mut self) {
        self.state.hands = [None; SLOTS];
    }

    /// Moves the hand on a note's piece: the next strokes with a place to choose land there, 0 (centre) to 1 (rim), until the note
    /// ends.
    ///
    /// # Real-time
    /// Table look-ups; no allocation, no lock.
    pub fn move_hand(&mut self, note: u8, place: f32, channel: u8) {
        if let Some(slot) = self.bent(note, channel).filter(|_| !place.is_nan()) {
            self.state.hands[slot.index()] = Some((note, f64::from(place.clamp(0.0, 1.0))));
        }
    }

    /// What a note of a velocity (0 to 1) does with the pedal of the hi-hat in a slot, if it does, and the speed of the
    /// foot, m/s.
    ///
    /// A stroke names closed or open cymbals. Where a controller plays the pedal, the foot is where the controller says if that
    /// is closed or open as the note names it, otherwise where the note says. A note that only moves the pedal then does
    /// nothing.
    ///
    /// # Real-time
    /// Table look-ups; no allocation, no lock.
    pub fn foot(&self, note: u8, velocity: f32, channel: u8) -> Option<(Slot, Foot, f64)> {
        let heard = velocity > 0.0 && self.hears(channel);
        let (slot, foot) = self.document.notes.foot(self.reference(note).filter(|_| heard)?)?;
        let speed = FOOT.0 * libm::pow(FOOT.1 / FOOT.0, f64::from(velocity.min(1.0)));
        let foot = match (foot, self.state.pedal) {
            (Foot::Position(named), Some(controlled)) => {
                self.stroke(note)?;
                // The note says whether the rims touch, the controller by how much.
                let agree = (named > TOUCHING) == (controlled > TOUCHING);
                Foot::Position(if agree { controlled } else { named })
            }
            _ => foot,
        };
        Some((slot, foot, speed))
    }

    /// Where a controller brings the pedals of all hi-hats, 0 (up) to 1 (down), if it is the one for that.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn pedal(&mut self, controller: u8, value: f32, channel: u8) -> Option<f64> {
        let calibrated = self.assignments.calibration().pedal();
        let heard = controller == PEDAL_CONTROLLER && self.hears(channel) && !value.is_nan();
        if !heard || calibrated.stuck {
            return None;
        }
        let value = value.clamp(0.0, 1.0);
        let noise = f32::from(calibrated.noise) / 127.0;
        // A foot at rest must not stir the hats.
        if noise > 0.0 && self.state.reading.is_some_and(|reading| (reading - value).abs() <= noise) {
            return None;
        }
        self.state.reading = Some(value);
        let place = Some(calibrated.place(value));
        self.state.pedal = place.or(self.state.pedal);
        place
    }

    /// Where a controller has the hi-hats' pedals, 0 (up) to 1 (down), if one plays them.
    pub fn pedal_at(&self) -> Option<f64> {
        self.state.pedal
    }

    /// Takes in a controller's value, 0 to 1.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn control_change(&mut self, controller: u8, value: f32, channel: u8) {
        if !self.hears(channel) || value.is_nan() {
            return;
        }
        let value = value.clamp(0.0, 1.0);
        match controller {
            FINE_VELOCITY_CONTROLLER => {
                if let Some(fine) = self.state.fine.get_mut(usize::from(channel)) {
                    // 127 steps between two velocities of 7 bits, 128 of which make one.
                    *fine = value * 127.0 / 128.0 / 127.0;
                }
            }
            _ => {
                let place = position_of(controller).and_then(|at| self.state.positions.get_mut(at));
                place.into_iter().for_each(|place| *place = Some(f64::from(value)));
            }
        }
    }
}
