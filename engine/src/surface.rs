//! A round surface that is struck and heard: a body, a contact system, attachments.
//!
//! Displacement and force are positive along the stroke, into the surface.
//!
//! ```text
//! exciters (strikers, wires) --> contacts --> body: modes, nonlinear force --> receivers --> pressure
//!                                  |  |              |                            |
//!                                  |  +-------- attachments: rim, wires, second cymbal
//!                                  +--> observers (high bands) -------------------+
//! ```
//!
//! The [body] knows modes, shapes and receivers; the [contacts] know what touches where and solve for the forces;
//! [attachments](attachment) are what some bodies have and others have not; [observers](observer) hear the forces
//! and are not felt. Here is what is done once a block and once a stroke; one sample is in `sample`.

pub mod attachment;
pub mod body;
pub mod contacts;
pub mod exciter;
pub mod incident_field;
pub mod observer;
pub mod oscillator;
pub mod local_compliance;
pub mod rim;
mod sample;
mod strike_log;
mod striking;
pub mod wires;

use std::any::Any;

use crate::contact::Material;
use crate::high_band::HighBand;
use crate::modal::{ModalBody, Mode, RECEIVERS};
use crate::potential::{NonlinearForce, Potential};
use crate::rim::Rim;
use crate::shapes::ShapeTable;
use crate::snapshot::{StrikeSnapshot, WireSnapshot};

use attachment::{Attachment, Site};
use body::{SoundingBody, StruckBody};
use contacts::{Contacts, MAX_STRIKERS};
use incident_field::IncidentPressure;
use local_compliance::LocalHeadCompliance;
use observer::ForceObservers;
use rim::AttachedRim;
use strike_log::StrikeLog;
use wires::SnareWires;

/// What a surface is made from.
pub struct SurfaceParts {
    /// `[mode]`.
    pub modes: Vec<Mode>,
    /// Shapes of the modes.
    pub shapes: ShapeTable,
    /// How each mode is heard, Pa s2/m of its acceleration, `[mode]`; see [`ReceiverWeights::new`](crate::modal::ReceiverWeights::new).
    pub transfer: Vec<[f64; 2]>,
    /// What the tip meets.
    pub material: Material,
    /// Whether contacts give back all they take, whatever the striker.
    pub lossless: bool,
    /// Hz.
    pub sample_rate: f64,
}

/// A struck body and everything that touches it.
pub struct Surface {
    body: StruckBody,
    contacts: Contacts,
    attachments: Vec<Box<dyn Attachment>>,
    observers: ForceObservers,
    /// What tips meet.
    material: Material,
    /// The head right under a tip, if the surface is one.
    local_compliance: Option<LocalHeadCompliance>,
    log: StrikeLog,
}

impl Surface {
    /// A surface at rest, nothing attached. Allocates.
    pub fn new(parts: SurfaceParts) -> Surface {
        let (modes, rate) = (parts.modes.len(), parts.sample_rate);
        let sound = SoundingBody::new(parts.modes, parts.transfer, rate);
        Surface {
            body: StruckBody::new(sound, parts.shapes, rate),
            contacts: Contacts::new(modes, parts.lossless, 1.0 / rate),
            attachments: Vec::new(),
            observers: ForceObservers::default(),
            material: parts.material,
            local_compliance: None,
            log: StrikeLog::default(),
        }
    }

    /// Attaches something. Allocates.
    pub fn attach(&mut self, mut attachment: impl Attachment) {
        let Surface { body, contacts, observers, .. } = self;
        attachment.attached(Site { body, contacts, observers });
        self.attachments.push(Box::new(attachment));
    }

    /// The index of the attachment of a kind.
    fn index_of<A: Attachment>(&self) -> Option<usize> {
        self.attachments.iter().position(|attachment| (&**attachment as &dyn Any).is::<A>())
    }

    /// The attachment of a kind, if there is one.
    pub fn attachment<A: Attachment>(&self) -> Option<&A> {
        self.attachments.iter().find_map(|attachment| (&**attachment as &dyn Any).downcast_ref())
    }

    /// The attachment of a kind, if there is one, to be set up by tests.
    pub fn attachment_mut<A: Attachment>(&mut self) -> Option<&mut A> {
        self.attachments.iter_mut().find_map(|attachment| (&mut **attachment as &mut dyn Any).downcast_mut())
    }

    /// Changes the attachment of a kind, if there is one, where it is attached.
    ///
    /// # Real-time
    /// No allocation; linear in the number of modes if points were moved.
    pub fn with<A: Attachment>(&mut self, change: impl FnOnce(&mut A, Site<'_>)) {
        let Surface { body, contacts, attachments, observers, .. } = self;
        let mut kinds = attachments.iter_mut().map(|attachment| &mut **attachment as &mut dyn Any);
        if let Some(attachment) = kinds.find_map(|attachment| attachment.downcast_mut()) {
            change(attachment, Site { body, contacts, observers });
            self.connect_stale();
        }
    }

    /// Lets a potential act on the first `modes`, evaluated once in `stride` samples. Allocates.
    pub fn set_potential(&mut self, potential: Box<dyn Potential>, modes: usize, stride: u32) {
        self.body.set_potential(potential, modes, stride);
    }

    /// Lets a high band observe the forces of contact points from `first` on: 0 for those of strikers. Allocates.
    pub fn observe(&mut self, first: usize, band: HighBand) {
        self.observers.add(first, band);
    }

    /// The high bands, in the order in which they were added.
    pub fn high_bands(&self) -> impl Iterator<Item = &HighBand> {
        self.observers.bands()
    }

    /// The high bands, to be retuned with the body.
    pub fn high_bands_mut(&mut self) -> impl Iterator<Item = &mut HighBand> {
        self.observers.bands_mut()
    }

    /// Makes the surface a head that yields under a tip beyond its modes; acts on whatever touches from now on.
    pub fn set_local_compliance(&mut self, head: LocalHeadCompliance) {
        self.local_compliance = Some(head);
    }

    /// The rim and its modes as they are, if there is one.
    pub fn rim(&self) -> Option<&Rim> {
        self.attachment().map(AttachedRim::rim)
    }

    /// What the wires have done since the latest stroke.
    pub fn wires(&self) -> WireSnapshot {
        let wires = self.attachment::<SnareWires>();
        wires.map_or_else(WireSnapshot::default, |wires| wires.snapshot(&self.contacts))
    }

    /// What the body does beyond its modes, if it does.
    pub fn nonlinear_force(&self) -> Option<&NonlinearForce> {
        self.body.nonlinear_force()
    }

    /// What the body does beyond its modes, to be set.
    pub fn nonlinear_force_mut(&mut self) -> Option<&mut NonlinearForce> {
        self.body.nonlinear_force_mut()
    }

    /// Evaluates what the body does beyond its modes once in `stride` samples; for comparisons.
    pub fn set_stride(&mut self, stride: u32) {
        self.body.set_stride(stride);
    }

    /// Energy of the body, J: of its modes, what it holds beyond them, and its attachments.
    pub fn energy(&self) -> f64 {
        let attached = self.attachments.iter().map(|attachment| attachment.energy(&self.contacts));
        attached.fold(self.body.energy(), |sum, energy| sum + energy)
    }

    /// Energy of the motion, J.
    pub fn motion(&self) -> f64 {
        let attached = self.attachments.iter().map(|attachment| attachment.motion(&self.contacts));
        attached.fold(self.body.motion(), |sum, energy| sum + energy)
    }

    /// True energy of the body beyond its modes, J, and the relative error of the variable that
    /// stands for it; slow, for tests.
    pub fn true_potential(&mut self) -> (f64, f64) {
        self.body.true_potential()
    }

    /// The modes and their motion.
    pub fn body(&self) -> &ModalBody {
        self.body.modal()
    }

    /// The modes and their motion, to be looked at or set up by tests and tools.
    pub fn body_mut(&mut self) -> &mut ModalBody {
        self.body.modal_mut()
    }

    /// Shapes of the modes.
    pub fn shapes(&self) -> &ShapeTable {
        self.body.shapes()
    }

    /// Shapes of the modes, to be changed with them.
    pub fn shapes_mut(&mut self) -> &mut ShapeTable {
        self.body.shapes_mut()
    }

    /// What the latest stroke's contact measured.
    pub fn last_strike(&self) -> StrikeSnapshot {
        self.log.last
    }

    /// Strikers that were taken away before they had left, for there are places for [`MAX_STRIKERS`] at a time.
    pub fn hurried_strikers(&self) -> u32 {
        self.log.hurried
    }

    /// Changes the modes while they ring; `mode(k, old)` gives the new one.
    ///
    /// # Real-time
    /// Linear in the number of modes, about 100 ns each.
    pub fn retune(&mut self, mode: impl Fn(usize, &Mode) -> Mode) {
        let body = self.body.modal_mut();
        for k in 0..body.len() {
            let new = mode(k, &body.modes()[k]);
            body.set_mode(k, new);
        }
        self.follow();
    }

    /// Lets the air press on the drum, and be pressed by it. Allocates.
    pub fn set_listener(&mut self) {
        self.body.enter_air();
    }

    /// Volume by which each mode makes the drum smaller, per modal displacement, m2, and the share of its sound that goes
    /// all around by that, `[mode]`; what is left goes as it goes far away. [`set_transfers`](Self::set_transfers)
    /// must be called after.
    pub fn set_volumes(&mut self, volumes: impl Iterator<Item = (f64, f64)>) {
        self.body.set_volumes(volumes);
    }

    /// Changes how each mode is heard from near, as in [`SurfaceParts::transfer`], and from far away, as at a metre;
    /// what rings is heard so at once.
    ///
    /// # Real-time
    /// No allocation; linear in the number of modes.
    pub fn set_transfers(
        &mut self,
        near: impl Iterator<Item = [f64; 2]>,
        far: impl Iterator<Item = [f64; 2]>,
    ) {
        self.body.set_transfers(near, far);
        self.follow();
    }

    /// Whether the air presses on it at all.
    pub fn listens(&self) -> bool {
        self.body.is_in_air()
    }

    /// Whether wires lie still that could be moved.
    pub fn has_parked_wires(&self) -> bool {
        self.attachments.iter().any(|attachment| attachment.is_parked())
    }

    /// Lets attachments that lie still move again.
    pub fn wake(&mut self) {
        let Surface { body, contacts, attachments, observers, .. } = self;
        for attachment in attachments {
            attachment.wake(Site { body: &mut *body, contacts: &mut *contacts, observers: &mut *observers });
        }
        self.connect_stale();
    }

    /// Lets wires that lie still move again.
    pub fn hear(&mut self) {
        self.wake();
    }

    /// Tells everything that hangs on the modes, or on how they are heard, that they have changed.
    fn follow(&mut self) {
        self.body.follow();
        self.attachments.iter_mut().for_each(|attachment| attachment.follow(&self.body));
        for n in 0..self.contacts.present().len() {
            self.connect(self.contacts.present()[n]);
        }
    }

    /// Renders sound pressure at each ear, Pa, overwriting `out`, while sound from elsewhere arrives: at the listening
    /// point, far away as at a metre, and as far as it goes all around, what other pieces hear. At most
    /// [`MAX_RUN`](crate::modal::simd::MAX_RUN) samples.
    ///
    /// # Real-time
    /// Linear in modes times samples; a few times dearer while something touches, and by the cost
    /// of the potential while that acts.
    pub fn render_in_air(
        &mut self,
        mut out: [&mut [f32]; RECEIVERS],
        incident: Option<IncidentPressure<'_>>,
    ) {
        let mut done = 0;
        let engaged = self.attachments.iter().any(|attachment| attachment.is_engaged());
        while (!self.contacts.is_empty() || engaged) && done < out[0].len() {
            let heard = self.step(done, incident);
            out.iter_mut().zip(heard).for_each(|(out, heard)| out[done] = heard);
            done += 1;
        }
        self.body.ring(out.each_mut().map(|out| &mut out[done..]), incident, done);
        for attachment in &mut self.attachments {
            attachment.ring(out.each_mut().map(|out| &mut **out), done);
        }
        let [near, far, _] = out;
        self.observers.bands_mut().for_each(|band| band.render(near, far));
    }

    /// Energy of the strikers and of what their contacts hold, J.
    pub fn striker_energy(&self) -> f64 {
        self.contacts.energy(0..MAX_STRIKERS)
    }

    /// Kinetic energy that strikers have come with since the last reset, J.
    pub fn brought_energy(&self) -> f64 {
        self.log.brought
    }

    /// Energy that strikers have taken away with them since the last reset, J.
    pub fn departed_energy(&self) -> f64 {
        self.log.departed
    }

    /// Zeroes what has decayed to nothing; reports whether all is finite, and rests it if not.
    ///
    /// # Real-time
    /// Linear in the number of modes; meant for once a block.
    pub fn settle(&mut self) -> bool {
        // What touches may drive modes, by less in a block than what could be forgotten.
        let driven = self.attachments.iter().any(|attachment| attachment.drives_body());
        self.body.settle(self.contacts.is_empty() && !driven && !self.contacts.is_lossless());
        let Surface { body, contacts, attachments, observers, .. } = self;
        let finite = observers.bands_mut().all(HighBand::settle)
            && body.modal().is_finite()
            && contacts.is_finite()
            && attachments.iter_mut().all(|attachment| attachment.settle(body, contacts));
        if !finite {
            self.reset();
        }
        let struck = self.is_struck();
        if !struck && self.body.is_inside_out() {
            // Turned back, as a drummer would; what it still trembles by is cut off.
            self.rest();
        }
        if !struck {
            self.park();
        }
        finite
    }

    /// Parks attachments that nothing is heard of.
    fn park(&mut self) {
        for i in 0..self.attachments.len() {
            if self.attachments[i].parks_below().is_some_and(|limit| self.energy() < limit) {
                self.attachments[i].park(&mut self.contacts);
            }
        }
    }

    /// Whether nothing moves and nothing is about.
    pub fn is_still(&self) -> bool {
        self.observers.bands().all(HighBand::is_still)
            && self.attachments.iter().all(|attachment| attachment.is_still())
            && self.contacts.is_empty()
            && self.body.modal().is_still()
    }

    /// Whether strikers are about.
    pub fn is_struck(&self) -> bool {
        self.contacts.is_struck()
    }

    /// Puts everything to rest as [`reset`](Self::reset) does; what was counted stays.
    pub fn rest(&mut self) {
        let counted = (self.log.brought, self.log.departed);
        self.reset();
        (self.log.brought, self.log.departed) = counted;
    }

    /// Puts everything to rest; strikers are gone.
    pub fn reset(&mut self) {
        self.body.reset();
        self.observers.bands_mut().for_each(HighBand::reset);
        self.contacts.reset();
        self.attachments.iter_mut().for_each(|attachment| attachment.reset(&mut self.contacts));
        (self.log.brought, self.log.departed) = (0.0, 0.0);
    }
}

#[cfg(test)]
mod tests;
