//! A struck surface: a body, a contact system, attachments.
//!
//! Displacement and force are positive along the stroke, into the surface.
//!
//! ```text
//! exciters (strikers, wires) --> contacts --> body: modes, nonlinear force --> receivers --> pressure
//!                                  |  |              |                            |
//!                                  |  +-------- attachments: rim, wires, second cymbal, rivets
//!                                  +--> observers (high bands, direct sound) -----+
//! ```
//!
//! The [body] has modes, mode shapes and receivers. The [contacts] hold all contact points and solve for their forces.
//! [Attachments](attachment) are parts that only some bodies have. [Observers](observer) receive the forces and do not act back, but that a stretched head
//! hands energy to its high band.
//! This file has the work of a block and of a stroke; `sample` has that of a sample.

pub mod attachment;
pub mod body;
pub mod contacts;
pub mod direct_sound;
pub mod exciter;
pub mod film_band;
pub mod incident_field;
pub mod observer;
pub mod oscillator;
mod pitch_glide;
pub mod local_compliance;
pub mod rim;
pub mod rivets;
mod sample;
pub mod stick_sound;
mod strike_log;
mod striking;
pub mod swing;
pub mod wires;

use std::any::Any;

use crate::contact::Material;
use crate::high_band::HighBand;
use crate::modal::smoothing::Smoothing;
use crate::modal::{ModalBody, Mode, RECEIVERS};
use crate::plate::{Bell, PlateSpec};
use crate::potential::{HEADS, NonlinearForce, Potential};
use crate::receiver::{POINTS, Receivers};
use crate::rim::Rim;
use crate::shapes::ShapeTable;
use crate::snapshot::{StrikeSnapshot, WireSnapshot};
use crate::transport::{Transport, TransportSpec};

use attachment::{Attachment, Site};
use body::{SoundingBody, StruckBody};
use contacts::{Contacts, MAX_STRIKERS, STRIKER_PLACES};
use direct_sound::DirectSound;
use incident_field::{IncidentPressure, Volume};
use local_compliance::LocalHeadCompliance;
use observer::ForceObservers;
use rim::AttachedRim;
use stick_sound::StickSound;
use strike_log::StrikeLog;
use swing::Swing;
use wires::SnareWires;

/// Parts of a surface.
pub struct SurfaceParts {
    /// `[mode]`.
    pub modes: Vec<Mode>,
    /// Shapes of the modes.
    pub shapes: ShapeTable,
    /// Transfer of each mode from its acceleration to the near receiver, Pa s2/m, `[mode]`; see [`ReceiverWeights::new`](crate::modal::ReceiverWeights::new).
    pub transfer: Vec<[f64; 2]>,
    /// Material under tips.
    pub material: Material,
    /// Whether contacts of all strikers are lossless.
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
    /// Material under tips.
    material: Material,
    /// Its bell, if it has one, and its radius, m.
    bell: Option<(Bell, f64)>,
    /// Local compliance, if the surface is a head.
    local_compliance: Option<LocalHeadCompliance>,
    log: StrikeLog,
    /// Steps by changed modes.
    smoothing: Smoothing,
    /// Its swing, if it hangs.
    swing: Option<Swing>,
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
            bell: None,
            local_compliance: None,
            log: StrikeLog::default(),
            smoothing: Smoothing::default(),
            swing: None,
        }
    }

    /// Lets the body swing. Allocates.
    pub fn set_swing(&mut self, swing: Swing) {
        self.swing = Some(swing);
    }

    /// Puts a bell on the body, whose radius (m) is given too.
    pub fn set_bell(&mut self, bell: Bell, radius: f64) {
        self.bell = Some((bell, radius));
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

    /// Changes the attachment of a kind, if there is one, together with the parts it acts on.
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

    /// Tunes the potential to a pitch, Hz. As [`Potential::retune`].
    pub fn tune_potential(&mut self, pitch_hz: f64) {
        self.body.tune_potential(pitch_hz);
    }

    /// Lets modes from `first` on follow the tension of the heads that the potential stretches; their stiffness per tension is
    /// dimensionless, `[mode - first][head]`. Allocates.
    pub fn set_glide(&mut self, first: usize, stiffness: Vec<[f64; HEADS]>) {
        self.body.set_glide(first, stiffness);
    }

    /// Lets energy be carried through the modes above those that the potential acts on, once a block. Allocates.
    pub fn set_transport(&mut self, spec: TransportSpec) {
        self.body.set_transport(spec);
    }

    /// The transport of energy above the coupled modes, if there is one.
    pub fn transport(&self) -> Option<&Transport> {
        self.body.transport()
    }

    /// The transport of energy above the coupled modes, to be set.
    pub fn transport_mut(&mut self) -> Option<&mut Transport> {
        self.body.transport_mut()
    }

    /// Lets a high band observe the forces of contact points from `first` on: 0 for those of strikers. Allocates.
    pub fn observe(&mut self, first: usize, band: HighBand) {
        self.observers.add(first, band);
    }

    /// Adds the direct sound of strikers on a plate, at a sample rate (Hz). Allocates.
    pub fn hear_directly(&mut self, plate: &PlateSpec, receivers: &Receivers, sample_rate: f64) {
        self.observers.hear_directly(DirectSound::new(plate, STRIKER_PLACES, receivers, sample_rate));
    }

    /// Adds the sound of sticks on a surface of a radius (m), at a sample rate (Hz). Allocates.
    pub fn hear_sticks(&mut self, radius: f64, receivers: &Receivers, sample_rate: f64) {
        self.observers.hear_sticks(StickSound::new(radius, receivers, sample_rate));
    }

    /// The high bands, in the order in which they were added.
    pub fn high_bands(&self) -> impl Iterator<Item = &HighBand> {
        self.observers.bands()
    }

    /// The high bands, to be retuned with the body.
    pub fn high_bands_mut(&mut self) -> impl Iterator<Item = &mut HighBand> {
        self.observers.bands_mut()
    }

    /// Adds the local compliance of a head; it acts on contacts that begin from now on.
    pub fn set_local_compliance(&mut self, head: LocalHeadCompliance) {
        self.local_compliance = Some(head);
    }

    /// The rim and its modes as they are, if there is one.
    pub fn rim(&self) -> Option<&Rim> {
        self.attachment().map(AttachedRim::rim)
    }

    /// State of the wires since the latest stroke.
    pub fn wires(&self) -> WireSnapshot {
        let wires = self.attachment::<SnareWires>();
        wires.map_or_else(WireSnapshot::default, |wires| wires.snapshot(&self.contacts))
    }

    /// The nonlinear force, if there is one.
    pub fn nonlinear_force(&self) -> Option<&NonlinearForce> {
        self.body.nonlinear_force()
    }

    /// The nonlinear force, to be set.
    pub fn nonlinear_force_mut(&mut self) -> Option<&mut NonlinearForce> {
        self.body.nonlinear_force_mut()
    }

    /// Evaluates the nonlinear force once in `stride` samples; for comparisons.
    pub fn set_stride(&mut self, stride: u32) {
        self.body.set_stride(stride);
    }

    /// Energy of the modes, the nonlinear force and the attachments, J.
    pub fn energy(&self) -> f64 {
        let attached = self.attachments.iter().map(|attachment| attachment.energy(&self.contacts));
        attached.fold(self.body.energy(), |sum, energy| sum + energy)
    }

    /// Energy of the motion, J.
    pub fn motion(&self) -> f64 {
        let attached = self.attachments.iter().map(|attachment| attachment.motion(&self.contacts));
        attached.fold(self.body.motion(), |sum, energy| sum + energy)
    }

    /// True energy of the nonlinear force, J, and the relative error of its scalar variable; slow, for tests.
    pub fn true_potential(&mut self) -> (f64, f64) {
        self.body.true_potential()
    }

    /// The modes and their motion.
    pub fn body(&self) -> &ModalBody {
        self.body.modal()
    }

    /// The modes and their motion, for tests and tools.
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

    /// Measurements of the latest stroke's contact.
    pub fn last_strike(&self) -> StrikeSnapshot {
        self.log.last
    }

    /// Strikers that were removed before they had left, as there are at most [`MAX_STRIKERS`] at a time.
    pub fn hurried_strikers(&self) -> u32 {
        self.log.hurried
    }

    /// Changes the modes while they ring; `mode(k, old)` gives the new one.
    ///
    /// # Real-time
    /// Linear in the number of modes, some 20 ns each.
    pub fn retune(&mut self, mode: impl Fn(usize, &Mode) -> Mode) {
        let before = self.body.sound().listen();
        self.body.modal_mut().set_modes(mode);
        self.follow();
        self.smoothing.step(before, self.body.sound().listen());
    }

    /// Adds an air load: sound from elsewhere acts on the drum, and it radiates to others. Allocates.
    pub fn set_listener(&mut self) {
        self.body.enter_air();
    }

    /// By how much each mode compresses the drum, `[mode]`. [`set_transfers`](Self::set_transfers) must be called after.
    pub fn set_volumes(&mut self, volumes: impl Iterator<Item = Volume>) {
        self.body.set_volumes(volumes);
    }

    /// Changes the transfers to the near receiver, as in [`SurfaceParts::transfer`], and to the far ones, given at a metre, Pa s2/m,
    /// `[point][mode]`. They act at once.
    ///
    /// # Real-time
    /// No allocation; linear in the number of modes.
    pub fn set_transfers(&mut self, transfers: [impl Iterator<Item = [f64; 2]>; POINTS]) {
        self.body.set_transfers(transfers);
        self.follow();
    }

    /// Whether sound from elsewhere acts on it.
    pub fn listens(&self) -> bool {
        self.body.is_in_air()
    }

    /// Whether there are parked wires that can be woken.
    pub fn has_parked_wires(&self) -> bool {
        self.attachments.iter().any(|attachment| attachment.is_parked())
    }

    /// Wakes parked attachments.
    pub fn wake(&mut self) {
        let Surface { body, contacts, attachments, observers, .. } = self;
        for attachment in attachments {
            attachment.wake(Site { body: &mut *body, contacts: &mut *contacts, observers: &mut *observers });
        }
        self.connect_stale();
    }

    /// Updates everything that depends on the modes or the transfers.
    fn follow(&mut self) {
        self.body.follow();
        self.swing.iter_mut().for_each(Swing::follow);
        self.attachments.iter_mut().for_each(|attachment| attachment.follow(&self.body));
        for n in 0..self.contacts.present().len() {
            self.connect(self.contacts.present()[n]);
        }
    }

    /// Renders the pressure at each receiver, Pa, into `out`, under the incident pressure: near, far at a metre in each direction, and the
    /// omnidirectional part at a metre, which other pieces receive. At most [`MAX_RUN`](crate::modal::simd::MAX_RUN) samples.
    ///
    /// # Real-time
    /// Linear in modes times samples. A few times as much during contacts; more while the nonlinear force acts.
    pub fn render_in_air(
        &mut self,
        mut out: [&mut [f32]; RECEIVERS],
        incident: Option<IncidentPressure<'_>>,
    ) {
        let Some(mut swing) = self.swing.take() else { return self.render_run(out, incident) };
        let (samples, mut done) = (out[0].len(), 0);
        while done < samples {
            let run = swing.run(samples - done);
            let heard = incident.map(|incident| &incident[done..done + run]);
            self.render_run(out.each_mut().map(|out| &mut out[done..done + run]), heard);
            swing.advance(run, &mut self.body);
            done += run;
        }
        self.swing = Some(swing);
    }

    /// Renders a run in which receiver weights stay as they are.
    fn render_run(&mut self, mut out: [&mut [f32]; RECEIVERS], incident: Option<IncidentPressure<'_>>) {
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
        self.smoothing.add_to(&mut out);
        self.observers.render(&mut out);
    }

    /// Energy of the strikers and their contacts, J.
    pub fn striker_energy(&self) -> f64 {
        self.contacts.energy(0..MAX_STRIKERS)
    }

    /// Kinetic energy of all strikers at their arrival since the last reset, J.
    pub fn brought_energy(&self) -> f64 {
        self.log.brought
    }

    /// Energy of all strikers at their departure since the last reset, J.
    pub fn departed_energy(&self) -> f64 {
        self.log.departed
    }

    /// Energy that went from the modes to the high band of the struck head since the last reset, J.
    pub fn scattered_energy(&self) -> f64 {
        self.observers.bands().next().map_or(0.0, HighBand::scattered)
    }

    /// Zeroes what has decayed. Returns whether all values are finite; if not, everything is reset.
    ///
    /// # Real-time
    /// Linear in the number of modes; meant for once a block.
    pub fn settle(&mut self) -> bool {
        // Contacts may drive modes by less in a block than the threshold of zeroing.
        let driven = self.attachments.iter().any(|attachment| attachment.drives_body());
        self.body.settle(self.contacts.is_empty() && !driven && !self.contacts.is_lossless());
        let Surface { body, contacts, attachments, observers, .. } = self;
        let finite = observers.settle()
            && body.modal().is_finite()
            && contacts.is_finite()
            && attachments.iter_mut().all(|attachment| attachment.settle(body, contacts));
        if !finite {
            self.reset();
        }
        if let Some(impulse) = self.body.carry() {
            self.smoothing.hold(impulse);
        }
        self.observers.bands_mut().take(1).for_each(|struck| self.body.scatter_into(struck));
        let tensions = self.body.glide();
        self.observers.bands_mut().zip(tensions).for_each(|(band, tension)| band.glide(tension));
        let struck = self.is_struck();
        if !struck && self.body.is_inside_out() {
            // Turned back, as by a drummer. The rest of its motion is cut off.
            self.rest();
        }
        if !struck {
            self.park();
        }
        if let Some(swing) = &mut self.swing {
            let attached = self.attachments.iter().find_map(|attachment| attachment.tilt());
            swing.begin_block(self.body.sound_mut(), attached);
        }
        finite
    }

    /// Parks attachments that are inaudible.
    fn park(&mut self) {
        for i in 0..self.attachments.len() {
            if self.attachments[i].parks_below().is_some_and(|limit| self.energy() < limit) {
                self.attachments[i].park(&mut self.contacts);
            }
        }
    }

    /// Whether nothing moves and no exciter is present.
    pub fn is_still(&self) -> bool {
        self.observers.is_still()
            && self.attachments.iter().all(|attachment| attachment.is_still())
            && self.contacts.is_empty()
            && self.body.modal().is_still()
            && self.smoothing.is_over()
    }

    /// Whether strikers are present.
    pub fn is_struck(&self) -> bool {
        self.contacts.is_struck()
    }

    /// [`reset`](Self::reset) that keeps the counted energies.
    pub fn rest(&mut self) {
        let counted = (self.log.brought, self.log.departed);
        self.reset();
        (self.log.brought, self.log.departed) = counted;
    }

    /// Puts everything to rest and removes all strikers.
    pub fn reset(&mut self) {
        self.body.reset();
        self.smoothing = Smoothing::default();
        self.observers.reset();
        self.contacts.reset();
        self.attachments.iter_mut().for_each(|attachment| attachment.reset(&mut self.contacts));
        if self.swing.as_mut().is_some_and(|swing| swing.reset(self.body.sound_mut())) {
            self.follow();
        }
        (self.log.brought, self.log.departed) = (0.0, 0.0);
    }
}

#[cfg(test)]
mod tests;
