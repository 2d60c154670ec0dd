//! The performer: turns notes and parameters into strikes and controls of the kit.
//!
//! Every musical decision of the plugin is made here and none in the glue to the framework, so
//! that whoever drives a performer with the same notes, values and sample times, be it a host or
//! a command line, hears the same samples.

use std::sync::Arc;

use no_denormals::no_denormals;
use overhear_engine::error::SpecError;
use overhear_engine::hi_hat::foot::SPEED;
use overhear_engine::kit::{Control, Crew, Kit, Microphone, Stereo};
use overhear_engine::layout::{Layout, Pair};
use overhear_engine::piece::{Piece, PieceId};
use overhear_engine::snapshot::KitSnapshot;
use overhear_engine::strike::{Strike, Striker};

use crate::building::{BuildPlan, Pace};
use crate::midi::assignments::Assignments;
use crate::midi::maps::NoteMap;
use crate::midi::playing::{ChokeRule, Grip, Playing};
use crate::midi_map::Foot;
use crate::parameters::{Drives, Manner, PARAMETERS};
use crate::placing;
use crate::presets::Program;

pub use crate::midi::playing::velocity_from_midi;

/// Pieces of the kit.
const PIECES: usize = PieceId::KIT.len();

/// Most semitones of a bend, either way; the pieces' own ranges are narrower.
const MOST_BEND: f32 = 48.0;

/// A kit and who plays it.
pub struct Performer {
    kit: Kit,
    /// Where the overheads and the room's pair stand unless parameters move them.
    usual: [Pair; 2],
    /// Values as asked for, `[parameter]`: hosts repeat all of them with every buffer.
    asked: [f32; PARAMETERS.len()],
    /// Plain values, `[parameter]`.
    values: [f32; PARAMETERS.len()],
    playing: Playing,
    /// Semitones by which notes bend the pitch of what they struck, `[piece]`.
    bends: [f64; PIECES],
    /// Whether anything was played or rendered since the start or the latest reset.
    started: bool,
}

impl Performer {
    /// A performer at a kit that has no pieces yet, every parameter at its default; the sample rate is in Hz.
    pub fn new(sample_rate: f64) -> Performer {
        Performer::with_assignments(sample_rate, Arc::default())
    }

    /// As [`new`](Self::new) at a sample rate in Hz, with the user's assignments of notes.
    pub fn with_assignments(sample_rate: f64, assignments: Arc<Assignments>) -> Performer {
        Performer::at(Kit::new(sample_rate), assignments)
    }

    /// As [`new`](Self::new) at a sample rate in Hz, at a kit that stands so.
    pub fn with_layout(sample_rate: f64, layout: &Layout) -> Performer {
        Performer::at(Kit::with_layout(sample_rate, layout), Arc::default())
    }

    fn at(kit: Kit, assignments: Arc<Assignments>) -> Performer {
        let usual = [kit.layout().overheads, kit.layout().room];
        let mut performer = Performer {
            kit,
            usual,
            asked: [f32::NAN; PARAMETERS.len()],
            values: [f32::NAN; PARAMETERS.len()],
            playing: Playing::new(assignments),
            bends: [0.0; PIECES],
            started: false,
        };
        for (index, parameter) in PARAMETERS.iter().enumerate() {
            performer.set_parameter(index, parameter.default);
        }
        performer
    }

    /// Builds and installs every piece of the kit as a host plays it, on this thread. Takes seconds.
    ///
    /// # Errors
    /// [`SpecError`] if the sample rate (Hz) is out of range.
    pub fn install_kit(&mut self, sample_rate: f64) -> Result<(), SpecError> {
        self.install_kit_for(sample_rate, Pace::RealTime)
    }

    /// The same for a host that plays or bounces, at a sample rate in Hz.
    ///
    /// # Errors
    /// As [`install_kit`](Self::install_kit).
    pub fn install_kit_for(&mut self, sample_rate: f64, pace: Pace) -> Result<(), SpecError> {
        let plan = BuildPlan::of(|index| self.values[index], pace);
        for id in PieceId::KIT {
            self.install(Box::new(Piece::new(id, &plan.options(id, sample_rate))?));
        }
        Ok(())
    }

    /// Lets others render pieces, or nobody, from the next run on; returns who did so far, to be dropped elsewhere. Meant for
    /// a kit that [is whole](Self::is_whole).
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn hire(&mut self, crew: Option<Box<dyn Crew>>) -> Option<Box<dyn Crew>> {
        self.kit.hire(crew)
    }

    /// Whether no worker holds a piece: all have come back from the latest run.
    pub fn is_whole(&self) -> bool {
        self.kit.is_whole()
    }

    /// Puts a piece in its place and returns what stood there, to be dropped elsewhere.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn install(&mut self, piece: Box<Piece>) -> Option<Box<Piece>> {
        flushed(|| self.kit.install(piece))
    }

    /// Hands back a replaced piece that has faded out, to be dropped elsewhere; one a call.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn retire(&mut self) -> Option<Box<Piece>> {
        self.kit.retire()
    }

    /// Plays a note at the next sample: velocity 0 to 1, channel 0 to 15. Says whether it strikes.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn note_on(&mut self, note: u8, velocity: f32, channel: u8) -> bool {
        let foot = self.playing.foot(note, velocity, channel);
        if let Some((foot, speed)) = foot {
            self.step(foot, speed);
        }
        let Some(played) = self.playing.note_on(note, velocity, channel) else {
            return foot.is_some();
        };
        self.start();
        // A bend belongs to the note that made it.
        self.bend_piece(played.piece, 0.0);
        flushed(|| {
            if played.releases {
                self.kit.choke(played.piece, 0.0);
            }
            self.kit.strike(played.piece, &played.strike);
        });
        true
    }

    /// Strikes a piece at the next sample as a hand asks, with the striker that its parameter says.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn strike(&mut self, piece: PieceId, strike: &Strike) {
        let Some(slot) = piece.slot() else { return };
        let striker = self.playing.style.strikers[slot].unwrap_or(strike.striker);
        self.start();
        flushed(|| {
            self.kit.choke(piece, 0.0);
            self.kit.strike(piece, &Strike { striker, ..*strike });
        });
    }

    /// Where the next note's stroke lands, 0 (centre) to 1 (rim), if it has a place to choose; `None` where controllers and
    /// the map say.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn aim(&mut self, place: Option<f32>) {
        self.playing.aim(place);
    }

    /// Bends the pitch of the piece that a note strikes, semitones, within the piece's range and until its next stroke.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn bend(&mut self, note: u8, semitones: f32, channel: u8) {
        if let Some(piece) = self.playing.bent(note, channel).filter(|_| !semitones.is_nan()) {
            self.bend_piece(piece, f64::from(semitones.clamp(-MOST_BEND, MOST_BEND)));
        }
    }

    fn bend_piece(&mut self, piece: PieceId, semitones: f64) {
        let bend = piece.slot().and_then(|slot| self.bends.get_mut(slot));
        if bend.is_some_and(|bend| std::mem::replace(bend, semitones) != semitones) {
            self.tune(piece);
        }
    }

    /// Brings a piece to the pitch that its parameter and its bend come to.
    fn tune(&mut self, piece: PieceId) {
        let bend = piece.slot().map_or(0.0, |slot| self.bends[slot]);
        for (parameter, value) in PARAMETERS.iter().zip(self.values) {
            let value = f64::from(value);
            let tuning = match parameter.drives {
                Drives::Control(Control::Tuning(of)) if of == piece => value * libm::exp2(bend / 12.0),
                Drives::Semitones(of) if of == piece => libm::exp2((value + bend) / 12.0),
                _ => continue,
            };
            flushed(|| self.kit.set(Control::Tuning(piece), tuning));
        }
    }

    /// Moves the hi-hat's pedal for a note.
    fn step(&mut self, foot: Foot, speed: f64) {
        if foot == Foot::Chick || foot == Foot::Splash {
            self.start();
        }
        flushed(|| match foot {
            // As fast as can be: a drummer's foot would have been there before the stroke.
            Foot::Brought(pedal) => self.kit.press_pedal(pedal, SPEED.2),
            Foot::Chick => self.kit.stamp_pedal(speed),
            Foot::Splash => self.kit.splash_pedal(speed),
        });
    }

    /// Ends a note: chokes its cymbal if the rule says so.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn note_off(&mut self, note: u8, channel: u8) {
        let grip = self.playing.note_off(note, channel);
        self.grip(grip);
    }

    /// Chokes the cymbal of a note, whatever the rule, until its next stroke.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn choke(&mut self, note: u8, channel: u8) {
        let grip = self.playing.choke(note, channel);
        self.grip(grip);
    }

    /// Presses on the cymbal of a note, 0 to 1, if the rule says so.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn pressure(&mut self, note: u8, pressure: f32, channel: u8) {
        let grip = self.playing.pressure(note, pressure, channel);
        self.grip(grip);
    }

    /// Moves a MIDI controller to a value, 0 to 1.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn control_change(&mut self, controller: u8, value: f32, channel: u8) {
        self.playing.control_change(controller, value, channel);
        if let Some(pedal) = self.playing.pedal(controller, value, channel) {
            flushed(|| self.kit.set(Control::Pedal, pedal));
        }
    }

    /// Loads a preset for a program change, unless the parameters or the channel say otherwise.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn program_change(&mut self, program: &Program, channel: u8) {
        if !self.playing.changes_program(channel) {
            return;
        }
        for &(index, value) in &program.values {
            self.set_parameter(index, value);
        }
        if let Some(notes) = &program.notes {
            self.playing.assign(notes);
        }
    }

    fn grip(&mut self, grip: Option<Grip>) {
        if let Some(Grip { piece, strength }) = grip {
            self.start();
            flushed(|| self.kit.choke(piece, strength));
        }
    }

    /// Moves a parameter, by its index in [`PARAMETERS`], to a plain value from the next sample
    /// on; before the first note and sample it is there at once. The value is
    /// [snapped](crate::parameters::Parameter::snap); an unchanged one and an unknown index do
    /// nothing.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn set_parameter(&mut self, index: usize, value: f32) {
        let Some(parameter) = PARAMETERS.get(index) else {
            return;
        };
        if std::mem::replace(&mut self.asked[index], value) == value {
            return;
        }
        let value = parameter.snap(value);
        if value == self.values[index] {
            return;
        }
        self.values[index] = value;
        let value = f64::from(value);
        match parameter.drives {
            Drives::Control(Control::Tuning(piece)) | Drives::Semitones(piece) => self.tune(piece),
            Drives::Control(control) => flushed(|| self.kit.set(control, value)),
            Drives::Percent(control) => flushed(|| self.kit.set(control, value / 100.0)),
            Drives::Stand(pair, _) => self.place(pair),
            Drives::Playing(manner) => self.set_manner(manner, value),
            // The builder reads it; new pieces will arrive.
            Drives::Building(_) => {}
        }
    }

    /// Puts a pair of microphones where the parameters want it.
    fn place(&mut self, pair: Microphone) {
        let usual = if pair == Microphone::Room { self.usual[1] } else { self.usual[0] };
        let places = placing::places(usual, pair, &|index| self.values.get(index).copied());
        let layout = self.kit.layout();
        let present = if pair == Microphone::Room { layout.room } else { layout.overheads };
        // What stays where it is must not fade over.
        if places != present {
            flushed(|| self.kit.place(pair, places));
        }
    }

    fn set_manner(&mut self, manner: Manner, value: f64) {
        let style = &mut self.playing.style;
        let place = value as usize;
        match manner {
            Manner::Dynamics => style.dynamics = value,
            Manner::Curve => style.curve = value,
            Manner::PlaceSpread => style.place_spread = value / 100.0,
            Manner::SpeedSpread => style.speed_spread = value,
            Manner::Map => style.map = NoteMap::ALL.get(place).copied().unwrap_or_default(),
            Manner::Channel => style.channel = place.checked_sub(1).map(|channel| channel as u8),
            Manner::Chokes => style.chokes = ChokeRule::ALL.get(place).copied().unwrap_or_default(),
            Manner::FollowsPosition => style.follows_position = value >= 0.5,
            Manner::FollowsPrograms => style.follows_programs = value >= 0.5,
            Manner::Offset(piece) => {
                if let Some(slot) = piece.slot() {
                    style.offsets[slot] = value;
                }
            }
            Manner::Striker(piece) => {
                if let Some(slot) = piece.slot() {
                    style.strikers[slot] = place.checked_sub(1).and_then(|at| Striker::ALL.get(at).copied());
                }
            }
        }
    }

    /// The piece that a note strikes, if it sounds.
    pub fn piece_of(&self, note: u8) -> Option<PieceId> {
        self.playing.stroke(note).map(|stroke| stroke.piece)
    }

    /// The present value of a parameter, in its unit, by its index in [`PARAMETERS`].
    pub fn parameter(&self, index: usize) -> Option<f32> {
        self.values.get(index).copied()
    }

    /// Renders both outputs, full scale 1, overwriting them. Any length, both the same; the cut
    /// into calls does not change the samples.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        self.start();
        flushed(|| self.kit.render(left, right));
    }

    /// [`render`](Self::render), and each piece to an output of its own, in the order of [`PieceId::KIT`]; see
    /// [`Kit::render_outputs`].
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render_outputs(&mut self, main: Stereo<'_>, pieces: &mut [Stereo<'_>]) {
        self.start();
        flushed(|| self.kit.render_outputs(main, pieces));
    }

    /// Whether every piece has been installed.
    pub fn is_complete(&self) -> bool {
        self.kit.is_complete()
    }

    /// Puts every piece to rest; parameters keep their values.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn reset(&mut self) {
        if !self.playing.plays_pedal() {
            // Where notes have left it is forgotten, where a foot is is not.
            let pedal = PARAMETERS.iter().position(|it| it.drives == Drives::Control(Control::Pedal));
            let value = pedal.map_or(0.0, |index| f64::from(self.values[index]));
            flushed(|| self.kit.set(Control::Pedal, value));
        }
        PieceId::KIT.into_iter().for_each(|piece| self.bend_piece(piece, 0.0));
        flushed(|| {
            // Whatever hand was on a cymbal is gone with the note it belonged to.
            PieceId::KIT.into_iter().for_each(|piece| self.kit.choke(piece, 0.0));
            self.kit.reset();
        });
        self.playing.reset();
        self.started = false;
    }

    /// Lets what was set before the first sample be there from the first sample: hosts send a
    /// project's values as late as with the first buffer, and the sound must not glide to them.
    fn start(&mut self) {
        if !self.started {
            self.started = true;
            flushed(|| self.kit.finish_controls());
        }
    }

    /// Describes the kit to whoever draws it, and starts the peaks anew.
    ///
    /// # Real-time
    /// A copy, no allocation.
    pub fn snapshot(&mut self, into: &mut KitSnapshot) {
        self.kit.snapshot(into);
    }
}

/// Runs the engine with denormal numbers flushed to zero and puts the thread's mode back.
///
/// Hosts call with either mode; a tail that fades through denormals must neither cost a hundred
/// times as much in one of them nor sound different.
#[allow(unsafe_code)]
pub(crate) fn flushed<T>(engine: impl FnOnce() -> T) -> T {
    // SAFETY: only the flush-to-zero and denormals-are-zero modes change, and only in here; no
    // code in the engine relies on denormals, and the former mode returns before any other code
    // runs.
    unsafe { no_denormals(engine) }
}

#[cfg(test)]
mod tests;
