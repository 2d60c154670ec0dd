//! One piece of the kit: a drum or a cymbal, and what can be asked of it.

mod controls;

pub use crate::build_context::{BuildContext, BuildOptions, Idealization, Quality};
pub use crate::mode::{Member, ModeInfo, ModeKind};

use std::ops::RangeInclusive;

use crate::block::{BLOCK, FOLLOWED};
use crate::contour::Contour;
use crate::cymbal::Cymbal;
use crate::drum::Drum;
use crate::error::SpecError;
use crate::hi_hat::HiHat;
use crate::instrument::Instrument;
use crate::kit_spec::{InstrumentSpec, Kind, PieceBuild};
use crate::layout::Placement;
use crate::microphones::CloseMicrophone;
use crate::modal::RECEIVERS;
use crate::slot::Slot;
use crate::snapshot::{FIELD_MODES, FieldShapes, ModeSnapshot, PieceSnapshot, StrikeSnapshot};
use crate::strike::Strike;
use crate::surface::Surface;
use crate::surface::incident_field::{AUDIBLE, IncidentPressure};

/// Sample rates that a piece can be built for, Hz.
pub const SAMPLE_RATES: RangeInclusive<f64> = 22_050.0..=1_536_000.0;

/// Sound below this is silence, Pa: 100 dB under full scale.
const SILENT: f32 = 2e-4;

/// A piece with less energy of motion than this that has been silent for so long falls asleep, J and s. A piece with static
/// deflection but no motion may sleep.
const STILL: f64 = 1e-10;
const DOZE: f64 = 0.05;

/// Blocks from one time that the modes of a sleeping piece follow its controls to the next: a picture's time.
const LOOKED_AT: usize = 32;

/// When the modes follow the controls.
struct Turn {
    /// Blocks until they do, and those at the beginning of a movement: the pieces of a kit take turns.
    wait: usize,
    first: usize,
    /// Blocks asleep, modulo [`LOOKED_AT`], and its number in the kit.
    slept: usize,
}

impl Turn {
    fn of(slot: Slot) -> Turn {
        let first = slot.index() % FOLLOWED;
        Turn { wait: first, first, slept: slot.index() }
    }

    /// Whether they follow now; asked once a block, `moved` being whether a control has moved since they did.
    fn is_due(&mut self, moved: bool) -> bool {
        if !moved {
            self.wait = self.first;
            return false;
        }
        let due = self.wait == 0;
        self.wait = if due { FOLLOWED - 1 } else { self.wait - 1 };
        due
    }
}

/// A close microphone, and what it makes of sound.
struct CloseChannel {
    microphone: CloseMicrophone,
    contour: Option<Contour>,
}

impl CloseChannel {
    /// Takes pressure to what the microphone gives.
    fn hear(&mut self, sound: &mut [f32]) {
        self.contour.iter_mut().for_each(|contour| contour.hear(sound));
    }

    /// Forgets what it has heard.
    fn reset(&mut self) {
        self.contour.iter_mut().for_each(Contour::reset);
    }
}

/// A built piece that can be struck and heard.
pub struct Piece {
    slot: Slot,
    kind: Kind,
    instrument: Box<dyn Instrument>,
    sample_rate: f64,
    /// Samples into the present block.
    phase: usize,
    /// Samples since the controls were last let glide.
    unglided: usize,
    turn: Turn,
    /// Nothing moves and nothing is about: there is nothing to render.
    asleep: bool,
    quarantines: u32,
    placement: Placement,
    close: CloseChannel,
    /// Lowest, own and highest tuning.
    tunings: [f64; 3],
    /// Largest sound since the block began, Pa, and samples for which it has been next to nothing.
    loudest: f32,
    quiet: usize,
}

/// Builds what a description is of.
fn build(spec: &InstrumentSpec, context: &BuildContext) -> Result<Box<dyn Instrument>, SpecError> {
    Ok(match spec {
        InstrumentSpec::Drum(drum) => Box::new(Drum::new(drum, context)?),
        InstrumentSpec::Cymbal(cymbal) => Box::new(Cymbal::new(cymbal, context)?),
        InstrumentSpec::HiHat(hat) => Box::new(HiHat::new(hat, context)?),
    })
}

impl Piece {
    /// Builds the piece of a slot. Allocates and takes up to a second.
    ///
    /// # Errors
    /// [`SpecError`] if the options or a number of the description are out of range.
    pub fn new(slot: Slot, build: &PieceBuild, options: &BuildOptions) -> Result<Piece, SpecError> {
        SpecError::check(
            "sample rate (Hz)",
            options.sample_rate,
            *SAMPLE_RATES.start(),
            *SAMPLE_RATES.end(),
        )?;
        Ok(Piece {
            slot,
            kind: build.spec.instrument.kind(),
            instrument: self::build(&build.spec.instrument, &build.context(*options))?,
            sample_rate: options.sample_rate,
            phase: 0,
            unglided: 0,
            turn: Turn::of(slot),
            asleep: true,
            quarantines: 0,
            placement: build.spec.placement(),
            close: CloseChannel {
                microphone: build.spec.close.of(build.spec.instrument.radius()),
                contour: build.spec.close.contour().map(|spec| Contour::new(&spec, options.sample_rate)),
            },
            tunings: build.spec.instrument.tunings(),
            loudest: 0.0,
            quiet: 0,
        })
    }

    /// The slot it was built for.
    pub fn slot(&self) -> Slot {
        self.slot
    }

    /// Which kind of instrument it is.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// Where it stands.
    pub fn placement(&self) -> &Placement {
        &self.placement
    }

    /// Lowest, own and highest of [`set_tuning`](Self::set_tuning): Hz of a drum, ratio of a cymbal.
    pub fn tunings(&self) -> [f64; 3] {
        self.tunings
    }

    /// Strikes at the next sample. Speed and radius are clamped; a stroke with a number that is not
    /// finite is not played.
    ///
    /// # Real-time
    /// No allocation, no lock; cost is linear in the number of modes.
    pub fn strike(&mut self, strike: &Strike) {
        if !strike.is_finite() {
            return;
        }
        self.wake();
        self.instrument.strike(strike);
    }

    /// Renders what the close microphone gives, sound pressure far away as at a metre, and what other pieces hear as at a
    /// metre, Pa, overwriting `out`, while sound from elsewhere arrives. At most to the end of the piece's block; how time
    /// is cut into calls does not change a sample.
    ///
    /// An inaudible piece falls asleep. A sleeping piece wakes when sound above [`AUDIBLE`] reaches it.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render_in_air(
        &mut self,
        mut out: [&mut [f32]; RECEIVERS],
        incident: Option<IncidentPressure<'_>>,
    ) {
        if self.phase == 0 {
            self.doze();
            self.begin_block();
        }
        let samples = out[0].len();
        debug_assert!(samples <= BLOCK - self.phase);
        let incident = incident.filter(|_| self.instrument.surface().listens());
        let shut = self.asleep || self.instrument.surface().has_parked_wires();
        let loud =
            |incident: IncidentPressure<'_>| incident.iter().position(|pressure| pressure.abs() > AUDIBLE);
        let wakes = incident.filter(|_| shut).and_then(loud);
        let before = wakes.unwrap_or(samples);
        self.render_stretch(out.each_mut().map(|out| &mut out[..before]), incident, 0);
        if wakes.is_some() {
            self.hear();
            self.render_stretch(out.each_mut().map(|out| &mut out[before..]), incident, before);
        }
        if self.asleep {
            self.close.reset();
        } else {
            self.close.hear(out[0]);
        }
        self.loudest = out.iter().flat_map(|out| out.iter()).fold(self.loudest, |size, x| size.max(x.abs()));
        self.phase = (self.phase + samples) % BLOCK;
        self.unglided += samples;
    }

    /// Renders from sample `from` of what arrives on.
    fn render_stretch(
        &mut self,
        out: [&mut [f32]; RECEIVERS],
        incident: Option<IncidentPressure<'_>>,
        from: usize,
    ) {
        if self.asleep {
            out.into_iter().for_each(|out| out.fill(0.0));
            return;
        }
        let to = from + out[0].len();
        self.instrument.surface_mut().render_in_air(out, incident.map(|incident| &incident[from..to]));
    }

    /// Wakes by sound.
    fn hear(&mut self) {
        self.wake();
        self.quiet = 0;
        self.instrument.follow_shapes();
        self.instrument.surface_mut().wake();
    }

    /// Falls asleep if it has been silent for a while and almost nothing moves.
    fn doze(&mut self) {
        let silent = std::mem::take(&mut self.loudest) < SILENT;
        let surface = self.instrument.surface();
        if self.asleep || !silent || surface.is_struck() || surface.motion() > STILL {
            self.quiet = 0;
            return;
        }
        self.quiet += BLOCK;
        if self.quiet as f64 >= DOZE * self.sample_rate {
            self.quiet = 0;
            self.instrument.surface_mut().rest();
            self.asleep = true;
        }
    }

    /// Asleep for another block: the modes follow the controls now and then, for whoever looks at them.
    fn sleep_on(&mut self) {
        self.turn.slept = (self.turn.slept + 1) % LOOKED_AT;
        if self.turn.slept == 0 {
            self.instrument.follow_controls();
        }
    }

    /// Wakes, with the modes where the controls are.
    fn wake(&mut self) {
        if std::mem::take(&mut self.asleep) {
            self.turn = Turn::of(self.slot);
            self.instrument.follow_controls();
        }
    }

    /// Its close microphone.
    pub fn close(&self) -> &CloseMicrophone {
        &self.close.microphone
    }

    /// Begins a block: follows controls, makes silence exact, catches values that are not finite.
    fn begin_block(&mut self) {
        self.glide();
        if self.asleep {
            self.sleep_on();
            return;
        }
        if self.turn.is_due(self.instrument.has_moved()) || self.instrument.is_urgent() {
            self.instrument.follow_controls();
        }
        if !self.instrument.surface_mut().settle() {
            self.quarantines = self.quarantines.saturating_add(1);
            self.close.reset();
        }
        self.asleep = self.instrument.surface().is_still();
    }

    /// Whether the piece is asleep: it is silent until a stroke or loud sound wakes it.
    pub fn is_asleep(&self) -> bool {
        self.asleep
    }

    /// Samples to the end of the piece's block: the most that [`render_in_air`](Self::render_in_air) takes at once.
    pub fn run_left(&self) -> usize {
        BLOCK - self.phase
    }

    /// Puts the piece's block grid at `phase` samples into a block, as its kit's is.
    pub fn align(&mut self, phase: usize) {
        self.phase = phase % BLOCK;
    }

    /// Puts the piece to rest and at the start of a block.
    pub fn reset(&mut self) {
        self.instrument.surface_mut().reset();
        self.close.reset();
        self.asleep = true;
        (self.loudest, self.quiet) = (0.0, 0);
        self.finish_controls();
        self.phase = 0;
        self.unglided = 0;
        self.turn = Turn::of(self.slot);
    }

    /// What the latest stroke's contact measured.
    pub fn last_strike(&self) -> StrikeSnapshot {
        self.instrument.surface().last_strike()
    }

    /// Vibration energy of the piece itself, J.
    pub fn energy(&self) -> f64 {
        self.instrument.surface().energy()
    }

    /// Kinetic energy of the strikers about and energy held in their contacts, J.
    pub fn striker_energy(&self) -> f64 {
        self.instrument.surface().striker_energy()
    }

    /// Kinetic energy that strikers have come with since the last reset, J.
    pub fn brought_energy(&self) -> f64 {
        self.instrument.surface().brought_energy()
    }

    /// Energy that strikers have taken away with them since the last reset, J.
    pub fn departed_energy(&self) -> f64 {
        self.instrument.surface().departed_energy()
    }

    /// Energy that went from the modes to the high band of the struck head since the last reset, J.
    pub fn scattered_energy(&self) -> f64 {
        self.instrument.surface().scattered_energy()
    }

    /// Times the piece was put back to rest because a value was not finite.
    pub fn quarantines(&self) -> u32 {
        self.quarantines
    }

    /// Every mode with the present tuning and muffling, lowest first. Allocates.
    pub fn modes(&self) -> Vec<ModeInfo> {
        self.instrument.modes()
    }

    /// Tension of each stretched body, N/m: `("batter", 2729.0)`. Empty for cymbals. Allocates.
    pub fn tensions(&self) -> Vec<(&'static str, f64)> {
        self.instrument.tensions()
    }

    /// The surface that is struck, for tests and tools that look closely.
    pub fn surface_mut(&mut self) -> &mut Surface {
        // It may be set going.
        self.wake();
        self.instrument.surface_mut()
    }

    /// Mode shapes for the displacement field. Allocates.
    pub fn field_shapes(&self) -> FieldShapes {
        let surface = self.instrument.surface();
        let mut all = vec![0.0_f32; surface.body().len()];
        let points = FieldShapes::grid();
        let shapes = points
            .iter()
            .map(|&[x, y]| {
                // Angle 0 is toward the player, who looks along y.
                let (radius, angle) = (f64::from(x.hypot(y)), f64::from(x.atan2(-y)));
                surface.shapes().fill(radius, angle, &mut all);
                std::array::from_fn(|k| all.get(k).copied().unwrap_or(0.0))
            })
            .collect();
        let body = surface.body().len().min(FIELD_MODES);
        let orders = self.modes().iter().take(body).map(|mode| [mode.m, mode.n]).collect();
        let tension = self.tensions().first().map_or(0.0, |&(_, tension)| tension as f32);
        FieldShapes { points, shapes, orders, tension }
    }

    /// Fills in what is known of the piece but for its peak, which the mix measures.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn snapshot(&self, into: &mut PieceSnapshot) {
        let body = self.instrument.surface().body();
        into.ready = true;
        into.energy = self.energy() as f32;
        into.octaves = body.energy_by_octave();
        into.stretch = self.instrument.surface().nonlinear_force().map_or(0.0, |force| force.energy() as f32);
        into.strike = self.last_strike();
        into.wires = self.wires();
        into.rims = self.rims();
        into.quarantines = self.quarantines;
        into.hurried_strikers = self.instrument.surface().hurried_strikers();
        for (k, q) in into.displacement.iter_mut().enumerate() {
            *q = if k < body.len() { body.displacement(k) } else { 0.0 };
        }
        for (mode, now) in into.modes.iter_mut().zip(body.modes()) {
            *mode = ModeSnapshot { omega: now.omega as f32, sigma: now.sigma as f32 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_follow_in_turns_that_depend_on_nothing_before_a_movement() {
        let turns = [0, 1, 5].map(|index| {
            let mut turn = Turn::of(Slot::ALL[index]);
            let mut due = |rest: usize| -> Vec<usize> {
                (0..rest).for_each(|_| assert!(!turn.is_due(false)));
                (0..50).filter(|_| turn.is_due(true)).collect()
            };
            let first = due(0);
            assert!(first.windows(2).all(|pair| pair[1] - pair[0] == FOLLOWED), "{first:?}");
            for rest in 1..10 {
                assert_eq!(due(rest), first);
            }
            first[0]
        });
        assert_eq!(turns, [0, 1, 1]);
    }
}
