//! A struck body by itself: modes, mode shapes, receiver weights, and all forces except those of contacts.
//!
//! These are the nonlinear force and the incident pressure.

use crate::high_band::HighBand;
use crate::modal::inaudible_modes::InaudibleModes;
use crate::modal::simd::Kernels;
use crate::modal::sway::Sway;
use crate::modal::{InputVector, ModalBody, Mode, Pressure, RECEIVERS, ReceiverWeights};
use crate::potential::{HEADS, NonlinearForce, Potential};
use crate::receiver::POINTS;
use crate::shapes::ShapeTable;
use crate::transport::{Transport, TransportSpec};

use super::incident_field::{AirLoad, IncidentPressure, Volume};
use super::pitch_glide::PitchGlide;

/// Adds at every receiver, Pa.
pub fn add(sum: &mut Pressure, more: Pressure) {
    sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
}

/// A modal body and its receiver weights.
pub struct SoundingBody {
    /// The modes and their motion.
    pub modal: ModalBody,
    /// Receiver weights of the modes.
    pub receiver: ReceiverWeights,
}

impl SoundingBody {
    /// A body at rest; `transfer` as in [`ReceiverWeights::new`], Pa s2/m; sample rate in Hz. Allocates.
    pub fn new(modes: Vec<Mode>, transfer: Vec<[f64; 2]>, sample_rate: f64) -> SoundingBody {
        let mut body = SoundingBody {
            modal: ModalBody::new(modes, sample_rate),
            receiver: ReceiverWeights::new(transfer),
        };
        body.follow();
        body
    }

    /// Follows a change of the modes or of the transfers.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn follow(&mut self) {
        self.modal.tune(&mut self.receiver);
    }

    /// Present pressure at each receiver, without the part proportional to forces, Pa.
    pub fn listen(&self) -> Pressure {
        self.modal.listen(&self.receiver)
    }
}

/// Result of a sample without contact forces.
#[derive(Debug, Clone, Copy)]
pub struct FreeStep {
    /// `psibar` of the [nonlinear force](crate::potential), the root of J. Times the coupling of a point it is the displacement
    /// of that point by the force.
    pub mean: f64,
    /// Its dimensionless `2 + G`; 1 if it does not act.
    pub divisor: f64,
    /// Whether couplings with the nonlinear force have changed.
    pub recoupled: bool,
    /// Pressure proportional to the incident pressure, Pa.
    pub heard: Pressure,
}

/// A body that can be struck.
pub struct StruckBody {
    sound: SoundingBody,
    /// Thresholds below which its modes are zeroed.
    inaudible: InaudibleModes,
    shapes: ShapeTable,
    /// The nonlinear force, if it has one.
    nonlinear_force: Option<NonlinearForce>,
    /// The transport of energy above the modes that the nonlinear force couples, if there is one.
    transport: Option<Transport>,
    /// Modes that follow the tension of stretched heads, if it has heads.
    glide: Option<PitchGlide>,
    /// The load of the surrounding air, if sound from elsewhere acts on it.
    air: Option<AirLoad>,
    /// Hz.
    sample_rate: f64,
}

impl StruckBody {
    /// A body at rest without nonlinear force and air load; sample rate in Hz. Allocates.
    pub fn new(sound: SoundingBody, shapes: ShapeTable, sample_rate: f64) -> StruckBody {
        let inaudible = InaudibleModes::new(sound.modal.len());
        StruckBody {
            sound,
            inaudible,
            shapes,
            nonlinear_force: None,
            transport: None,
            glide: None,
            air: None,
            sample_rate,
        }
    }

    /// The modes and their receiver weights.
    pub fn sound(&self) -> &SoundingBody {
        &self.sound
    }

    /// The modes and their receiver weights, to be moved.
    pub fn sound_mut(&mut self) -> &mut SoundingBody {
        &mut self.sound
    }

    /// Moves the receiver weights by a step.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn sway(&mut self, sway: &mut Sway) {
        let SoundingBody { modal, receiver } = &mut self.sound;
        if modal.sway(sway, receiver) {
            self.nonlinear_force.iter_mut().for_each(|force| force.sway(modal, sway));
        }
    }

    /// The modes and their motion.
    pub fn modal(&self) -> &ModalBody {
        &self.sound.modal
    }

    /// The modes and their motion, to be pushed.
    pub fn modal_mut(&mut self) -> &mut ModalBody {
        &mut self.sound.modal
    }

    /// Receiver weights of the modes.
    pub fn receiver(&self) -> &ReceiverWeights {
        &self.sound.receiver
    }

    /// Shapes of the modes.
    pub fn shapes(&self) -> &ShapeTable {
        &self.shapes
    }

    /// Shapes of the modes, to be changed with them.
    pub fn shapes_mut(&mut self) -> &mut ShapeTable {
        &mut self.shapes
    }

    /// The kernels in use.
    pub fn kernels(&self) -> Kernels {
        self.sound.modal.kernels()
    }

    /// The nonlinear force, if it has one.
    pub fn nonlinear_force(&self) -> Option<&NonlinearForce> {
        self.nonlinear_force.as_ref()
    }

    /// The nonlinear force, to be set.
    pub fn nonlinear_force_mut(&mut self) -> Option<&mut NonlinearForce> {
        self.nonlinear_force.as_mut()
    }

    /// The transport of energy above the coupled modes, if there is one.
    pub fn transport(&self) -> Option<&Transport> {
        self.transport.as_ref()
    }

    /// The transport of energy above the coupled modes, to be set.
    pub fn transport_mut(&mut self) -> Option<&mut Transport> {
        self.transport.as_mut()
    }

    /// The nonlinear force while it acts.
    pub fn acting_force(&self) -> Option<&NonlinearForce> {
        self.nonlinear_force.as_ref().filter(|force| force.is_active())
    }

    /// Whether sound from elsewhere acts on it.
    pub fn is_in_air(&self) -> bool {
        self.air.is_some()
    }

    /// Lets a potential act on the first `modes`, evaluated once in `stride` samples. Allocates.
    pub(super) fn set_potential(&mut self, potential: Box<dyn Potential>, modes: usize, stride: u32) {
        let force = NonlinearForce::new(potential, modes, stride, &self.sound.modal, self.sample_rate);
        self.nonlinear_force = Some(force);
        self.update_thresholds();
    }

    /// A tip comes so far from the centre (share of the radius) and meets the modes with these shapes, `[mode]`: the nonlinear force acts.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub(super) fn meet(&mut self, radius: f64, shapes: &[f32]) {
        self.nonlinear_force.iter_mut().for_each(|force| force.press(radius, shapes, &self.sound.modal));
    }

    /// Tunes the potential to a pitch, Hz.
    ///
    /// # Real-time
    /// As [`Potential::retune`].
    pub(super) fn tune_potential(&mut self, pitch_hz: f64) {
        self.nonlinear_force.iter_mut().for_each(|force| force.retune(pitch_hz, &self.sound.modal));
    }

    /// Lets energy be carried above the coupled modes. Allocates.
    pub(super) fn set_transport(&mut self, spec: TransportSpec) {
        self.transport = Transport::new(spec, &self.sound.modal, &self.sound.receiver);
        if self.transport.is_some() {
            self.sound.modal.allow_detuning();
        }
    }

    /// Lets modes above those that the potential acts on follow the tension of the heads; see [`PitchGlide::new`]. Allocates.
    pub(super) fn set_glide(&mut self, first: usize, stiffness: Vec<[f64; HEADS]>) {
        self.glide = Some(PitchGlide::new(first, stiffness, &mut self.sound.modal));
    }

    /// Evaluates the nonlinear force once in `stride` samples; for comparisons.
    pub(super) fn set_stride(&mut self, stride: u32) {
        if let Some(force) = &mut self.nonlinear_force {
            force.set_stride(stride);
            force.follow(&self.sound.modal);
        }
    }

    /// Adds an air load: sound from elsewhere acts on the body, and it radiates to others. Allocates.
    pub(super) fn enter_air(&mut self) {
        self.air = Some(AirLoad::new(self.sound.modal.len()));
        self.sound.receiver.attend(self.sound.modal.len());
    }

    /// By how much each mode compresses the body.
    pub(super) fn set_volumes(&mut self, volumes: impl Iterator<Item = Volume>) {
        if let Some(air) = &mut self.air {
            air.set_volumes(volumes);
        }
    }

    /// Changes the transfers to the receiver at each point; [`follow`](Self::follow) must be called after.
    pub(super) fn set_transfers(&mut self, transfers: [impl Iterator<Item = [f64; 2]>; POINTS]) {
        let receiver = &mut self.sound.receiver;
        for (at, transfers) in transfers.into_iter().enumerate() {
            let places = receiver.transfer_mut(at).iter_mut();
            places.zip(transfers).for_each(|(place, transfer)| *place = transfer);
        }
        self.air.iter().for_each(|air| air.send(receiver));
    }

    /// Updates the thresholds of modes that neither the air nor the nonlinear force drives.
    fn update_thresholds(&mut self) {
        let coupled = self.nonlinear_force.as_ref().map_or(0, |force| force.coupled_modes().length());
        let driven = self.air.as_ref().map(AirLoad::port);
        self.sound.modal.update_thresholds(&mut self.inaudible, &self.sound.receiver, coupled, driven);
    }

    /// Follows a change of the modes or of the transfers.
    pub(super) fn follow(&mut self) {
        self.sound.follow();
        self.update_thresholds();
        let SoundingBody { modal, receiver } = &self.sound;
        self.nonlinear_force.iter_mut().for_each(|force| force.follow(modal));
        self.transport.iter_mut().for_each(|transport| transport.follow(modal, receiver));
        self.glide.iter_mut().for_each(|glide| glide.follow(modal));
        self.air.iter_mut().for_each(|air| air.follow(modal, receiver));
    }

    /// Steps under the air and the nonlinear force alone.
    pub(super) fn step(&mut self, sample: usize, incident: Option<IncidentPressure<'_>>) -> FreeStep {
        let SoundingBody { modal, receiver } = &mut self.sound;
        let Some(force) = self.nonlinear_force.as_mut().filter(|force| force.is_active()) else {
            modal.step();
            let heard = self.press(incident, sample);
            return FreeStep { mean: 0.0, divisor: 1.0, recoupled: true, heard };
        };
        let recoupled = force.begin(modal, receiver);
        modal.step();
        let heard = self.press(incident, sample);
        let Some(force) = &mut self.nonlinear_force else {
            return FreeStep { mean: 0.0, divisor: 1.0, recoupled, heard };
        };
        FreeStep { mean: force.free(&self.sound.modal), divisor: force.divisor(), recoupled, heard }
    }

    /// Adds the incident pressure of a sample to the modes, which have stepped. Returns the pressure proportional to it, Pa.
    fn press(&mut self, incident: Option<IncidentPressure<'_>>, sample: usize) -> Pressure {
        let pressure = incident.map_or(0.0, |incident| incident[sample]);
        match &self.air {
            Some(air) if pressure != 0.0 => {
                self.sound.modal.push(air.port(), pressure);
                air.echo(pressure)
            }
            _ => Pressure::default(),
        }
    }

    /// Applies the nonlinear force; `pressed` is the sum of the contact forces times their couplings. Returns the pressure
    /// proportional to the force, Pa.
    pub(super) fn finish(&mut self, pressed: f64) -> Pressure {
        match self.nonlinear_force.as_mut().filter(|force| force.is_active()) {
            Some(force) => force.finish(&mut self.sound.modal, pressed),
            None => Pressure::default(),
        }
    }

    /// Renders while nothing touches, from sample `from` of the incident pressure on.
    pub(super) fn ring(
        &mut self,
        mut out: [&mut [f32]; RECEIVERS],
        incident: Option<IncidentPressure<'_>>,
        from: usize,
    ) {
        let SoundingBody { modal, receiver } = &mut self.sound;
        let pressed = self.air.as_ref().zip(incident);
        let drive = pressed.and_then(|(air, incident)| air.drive(incident, from));
        match &mut self.nonlinear_force {
            Some(force) if force.is_active() => {
                let first = force.coupled_modes().length();
                modal.ring_driven(first, drive.into_iter(), receiver, out.each_mut().map(|out| &mut **out));
                force.ring(modal, receiver, drive, &mut out);
            }
            _ => modal.ring_driven(0, drive.into_iter(), receiver, out.each_mut().map(|out| &mut **out)),
        }
        if let Some((air, incident)) = pressed {
            for (i, &pressure) in incident[from..].iter().enumerate() {
                out.iter_mut().zip(air.echo(pressure)).for_each(|(out, echo)| out[i] += echo);
            }
        }
    }

    /// Coupling of an input vector with the nonlinear force; 0 without one.
    pub(super) fn coupling(&self, port: &InputVector) -> f64 {
        self.nonlinear_force.as_ref().map_or(0.0, |force| force.coupling(&self.sound.modal, port))
    }

    /// Energy of the modes, the nonlinear force and the transport, J.
    pub(super) fn energy(&self) -> f64 {
        self.sound.modal.energy()
            + self.nonlinear_force.as_ref().map_or(0.0, NonlinearForce::energy)
            + self.transport.as_ref().map_or(0.0, Transport::pending)
    }

    /// Energy of the motion, J; that of the nonlinear force counts as motion.
    pub(super) fn motion(&self) -> f64 {
        self.sound.modal.motion() + self.nonlinear_force.as_ref().map_or(0.0, |force| force.energy().abs())
    }

    /// True energy of the nonlinear force, J, and the relative error of its scalar variable.
    pub(super) fn true_potential(&mut self) -> (f64, f64) {
        self.nonlinear_force.as_mut().map_or((0.0, 0.0), |force| force.true_energy(&self.sound.modal))
    }

    /// Zeroes modes that have decayed: inaudible ones if only the air drives the body, else only those that are nearly zero.
    pub(super) fn settle(&mut self, left_alone: bool) {
        match left_alone {
            true => self.sound.modal.flush_inaudible(&self.inaudible),
            false => self.sound.modal.flush_quiet(),
        }
        self.nonlinear_force.iter_mut().for_each(NonlinearForce::settle);
    }

    /// Carries the energy of a block above the coupled modes. Returns the sound of that over the block, Pa at each receiver, if any
    /// mode has changed.
    pub(super) fn carry(&mut self) -> Option<Pressure> {
        let transport = self.transport.as_mut()?;
        if !self.nonlinear_force.as_ref().is_some_and(NonlinearForce::is_active) {
            transport.rest(&mut self.sound.modal);
            return None;
        }
        transport.carry(&mut self.sound.modal)
    }

    /// Lets the high band of the struck head take what the stretching modes scatter into it.
    pub(super) fn scatter_into(&mut self, band: &mut HighBand) {
        if let Some(force) = self.nonlinear_force.as_mut().filter(|force| force.is_active()) {
            // What the modes still owe is theirs no more.
            let kinetic = force.kinetic_energy(&self.sound.modal) - force.debt();
            force.take(band.scatter(force.energy(), kinetic.max(0.0)));
        }
    }

    /// Lets modes follow the tension of the heads over the next block. Returns what is added to each head's, N/m.
    pub(super) fn glide(&mut self) -> [f64; HEADS] {
        let (Some(force), Some(glide)) = (&mut self.nonlinear_force, &mut self.glide) else {
            return [0.0; HEADS];
        };
        let tensions = force.take_tensions();
        glide.shift(tensions, &mut self.sound.modal);
        tensions
    }

    /// Whether it rests inside out.
    pub(super) fn is_inside_out(&self) -> bool {
        self.nonlinear_force.as_ref().is_some_and(NonlinearForce::is_inside_out)
    }

    /// Puts it to rest.
    pub fn reset(&mut self) {
        self.sound.modal.reset();
        self.nonlinear_force.iter_mut().for_each(NonlinearForce::reset);
        self.transport.iter_mut().for_each(Transport::reset);
    }
}
