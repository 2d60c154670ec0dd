//! The [rim](Rim) as an attachment: a modal body of its own that the shafts of sticks meet.

use crate::modal::simd::MAX_RUN;
use crate::modal::{Mode, Pressure, RECEIVERS};
use crate::receiver::POINTS;
use crate::rim::Rim;

use super::attachment::{Attachment, Site};
use super::body::{FreeStep, SoundingBody, StruckBody};
use super::contacts::Contacts;

/// A rim and its motion.
pub struct AttachedRim {
    rim: Rim,
    sound: SoundingBody,
}

impl AttachedRim {
    /// A rim at rest; sample rate in Hz. Allocates.
    pub fn new(rim: Rim, sample_rate: f64) -> AttachedRim {
        let modes: Vec<Mode> = rim.modes.iter().map(|mode| mode.mode).collect();
        let near = rim.modes.iter().map(|mode| mode.transfers[0]).collect();
        let mut sound = SoundingBody::new(modes, near, sample_rate);
        for point in 1..POINTS {
            let transfers = sound.receiver.transfer_mut(point).iter_mut();
            transfers.zip(&rim.modes).for_each(|(transfer, mode)| *transfer = mode.transfers[point]);
        }
        sound.follow();
        AttachedRim { rim, sound }
    }

    /// The rim and its modes as they are.
    pub fn rim(&self) -> &Rim {
        &self.rim
    }
}

impl Attachment for AttachedRim {
    fn attached(&mut self, site: Site<'_>) {
        site.contacts.set_shaft_modes(self.rim.modes.len());
    }

    fn ground(&self) -> Option<&SoundingBody> {
        Some(&self.sound)
    }

    fn ground_mut(&mut self) -> Option<&mut SoundingBody> {
        Some(&mut self.sound)
    }

    fn step(&mut self, _body: &StruckBody, _free: &FreeStep) {
        self.sound.modal.step();
    }

    fn listen(&self) -> Pressure {
        self.sound.listen()
    }

    fn ring(&mut self, out: [&mut [f32]; RECEIVERS], from: usize) {
        if self.sound.modal.is_still() {
            return;
        }
        let samples = out[0].len() - from;
        let mut heard = [[0.0; MAX_RUN]; RECEIVERS];
        let rows = heard.each_mut().map(|row| &mut row[..samples]);
        self.sound.modal.ring(0, &self.sound.receiver, rows);
        for (out, heard) in out.into_iter().zip(&heard) {
            out[from..].iter_mut().zip(heard).for_each(|(sum, x)| *sum += x);
        }
    }

    fn energy(&self, _contacts: &Contacts) -> f64 {
        self.sound.modal.energy()
    }

    fn motion(&self, _contacts: &Contacts) -> f64 {
        self.sound.modal.motion()
    }

    fn settle(&mut self, _body: &mut StruckBody, _contacts: &mut Contacts) -> bool {
        self.sound.modal.flush_quiet();
        self.sound.modal.is_finite()
    }

    fn is_still(&self) -> bool {
        self.sound.modal.is_still()
    }

    fn reset(&mut self, _contacts: &mut Contacts) {
        self.sound.modal.reset();
    }
}
