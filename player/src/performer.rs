//! The performer: turns notes and parameters into strikes and controls of the kit.
//!
//! It knows slots and kinds of pieces and what the kit's [document](KitDocument) says of them. The document can be
//! [changed](Performer::change_kit) while it plays: parameters keep their values, pieces arrive one by one.
//!
//! Every musical decision of the plugin is made here and none in the glue to the framework, so
//! that whoever drives a performer with the same notes, values and sample times, be it a host or
//! a command line, hears the same samples.

mod controls;
mod expressions;
mod figures;
mod sounding;

use std::sync::Arc;

use overhear_engine::error::SpecError;
use overhear_engine::kit::{Arrangement, Control, Kit, Microphone, RenderWorkers, Routing, Stereo};
use overhear_engine::kit_spec::Kind;
use overhear_engine::piece::Piece;
use overhear_engine::slot::{SLOTS, Slot};
use overhear_engine::snapshot::KitSnapshot;
use overhear_engine::strike::Strike;

use crate::building::{BuildPlan, Pace};
use crate::denormals::flushed;
use crate::kit_document::KitDocument;
use crate::midi::assignments::Assignments;
use crate::midi::expressions::Expressions;
use crate::midi::figures::Running;
use crate::midi::playing::{Grip, Handled, Played, Playing};
use crate::midi_map::Foot;
use crate::parameters::{
    COUNT, SLOT_COUNT, SlotParameter, default_value, is_live, slot_index, slot_parameter,
};
use crate::presets::Program;

use sounding::{Silencing, tail};

pub use crate::midi::playing::velocity_from_midi;

/// Another kit for a performer, worked out beforehand: made by any thread, taken over by the audio thread, dropped by any
/// other.
pub struct Setup {
    document: Arc<KitDocument>,
    arrangement: Box<Arrangement>,
}

impl Setup {
    /// That of a document, at the performer's sample rate, Hz. Allocates.
    pub fn new(sample_rate: f64, document: Arc<KitDocument>) -> Setup {
        let arrangement = Box::new(Arrangement::new(sample_rate, &document.kit));
        Setup { document, arrangement }
    }

    /// Whether the kit has a piece in a slot.
    pub fn has(&self, slot: Slot) -> bool {
        self.document.kit.piece(slot).is_some()
    }
}

/// A kit and who plays it.
pub struct Performer {
    kit: Kit,
    /// Values as asked for, `[parameter]`: hosts repeat all of them with every buffer.
    asked: [f32; COUNT],
    /// Plain values, `[parameter]`.
    values: [f32; COUNT],
    playing: Playing,
    /// Tuning of the pieces that stand there, before anybody moves it, `[slot]`: Hz of a drum, ratio of a cymbal.
    own: [f64; SLOTS],
    /// What expressions of notes do to what they struck, `[slot]`.
    expressions: [Expressions; SLOTS],
    /// Whether anything was played or rendered since the start or the latest reset.
    started: bool,
    /// Whether snare wires lie on, as the kit was told last, `[slot]`.
    wires: [bool; SLOTS],
    /// Rolls and flams that are being played, `[slot]`.
    figures: [Option<Running>; SLOTS],
    /// Sample rate, Hz.
    sample_rate: f64,
    /// The fade of everything that sounds.
    silencing: Silencing,
    /// What outputs of their own are to the mix.
    routing: Routing,
}

impl Performer {
    /// A performer at a kit that has no pieces yet, every parameter at the kit's default, with the user's assignments of
    /// notes; the sample rate is in Hz.
    pub fn new(sample_rate: f64, document: &KitDocument, assignments: Arc<Assignments>) -> Performer {
        let own = Slot::ALL.map(|slot| {
            let piece = document.kit.piece(slot);
            piece.map_or(1.0, |piece| piece.instrument.tunings()[1])
        });
        let mut performer = Performer {
            kit: Kit::new(sample_rate, &document.kit),
            asked: [f32::NAN; COUNT],
            values: [f32::NAN; COUNT],
            playing: Playing::new(Arc::new(document.clone()), assignments),
            own,
            expressions: [Expressions::NONE; SLOTS],
            started: false,
            wires: [true; SLOTS],
            figures: [None; SLOTS],
            sample_rate,
            silencing: Silencing::new(sample_rate),
            routing: Routing::default(),
        };
        for index in 0..COUNT {
            performer.set_parameter(index, default_value(index, &document.kit));
        }
        performer
    }

    /// The kit that is played, and its notes.
    pub fn document(&self) -> &KitDocument {
        self.playing.document()
    }

    /// Builds and installs every piece of the kit as a host that plays or bounces has it; see [`BuildPlan::pieces`].
    ///
    /// # Errors
    /// [`SpecError`] if the sample rate (Hz) is out of range.
    pub fn install_kit(&mut self, sample_rate: f64, pace: Pace) -> Result<(), SpecError> {
        let plan = BuildPlan::of(self.playing.document().clone(), |index| self.values[index], pace);
        for piece in plan.pieces(sample_rate)? {
            self.install(Box::new(piece));
        }
        Ok(())
    }

    /// Goes over to another kit: its notes, places and room are there at once; its pieces are to be installed. Pieces of slots
    /// that it leaves empty fade out, all others play on until others take their place. Parameters keep their values. What is
    /// not needed any more comes back, to be dropped elsewhere.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn change_kit(&mut self, setup: Setup) -> Setup {
        let former = self.playing.change_kit(setup.document);
        let arrangement = flushed(|| self.kit.arrange(setup.arrangement));
        self.expressions = [Expressions::NONE; SLOTS];
        for index in 0..SLOT_COUNT {
            // A foot on a hi-hat stays where it is.
            let is_pedal = matches!(slot_parameter(index), Some((_, SlotParameter::Pedal)));
            if !(is_pedal && is_live(index, &former.kit)) {
                self.apply(index);
            }
        }
        if let Some(pedal) = self.playing.pedal_at() {
            self.press_pedals(pedal);
        }
        self.place(Microphone::Overheads);
        self.place(Microphone::Room);
        Setup { document: former, arrangement }
    }

    /// Lets others render pieces, or nobody, from the next run on; returns who did so far, to be dropped elsewhere. Meant for
    /// a kit that [is whole](Self::is_whole).
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn attach(&mut self, workers: Option<Box<dyn RenderWorkers>>) -> Option<Box<dyn RenderWorkers>> {
        self.kit.attach(workers)
    }

    /// Whether no worker holds a piece: all have come back from the latest run.
    pub fn is_whole(&self) -> bool {
        self.kit.is_whole()
    }

    /// Puts a piece in its slot and returns what stood there, to be dropped elsewhere. It starts at the pitch that the slot's
    /// parameter asks of such a piece.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn install(&mut self, piece: Box<Piece>) -> Option<Box<Piece>> {
        let (slot, [_, own, _]) = (piece.slot(), piece.tunings());
        self.own[slot.index()] = own;
        let tuning = self.tuning(slot);
        flushed(|| self.kit.install_tuned(piece, tuning))
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
        let Some(velocity) = self.playing.triggered(note, velocity, channel) else { return false };
        match self.playing.handled(note, velocity, channel) {
            Some(Handled::Grips(grip)) => self.grip(Some(grip)),
            Some(Handled::Throws(slot, on)) => self.throw(slot, on),
            None => {}
        }
        let foot = self.playing.foot(note, velocity, channel);
        if let Some((slot, foot, speed)) = foot {
            self.step(slot, foot, speed);
        }
        let Some(played) = self.playing.note_on(note, velocity, channel) else {
            return foot.is_some();
        };
        let played = self.begin_figure(played, (note, velocity, channel));
        self.play(&played);
        true
    }

    /// Plays a stroke at the next sample.
    fn play(&mut self, played: &Played) {
        self.finish_silence();
        self.start();
        // What was done to a note belongs to it.
        self.express(played.slot, Expressions::NONE);
        self.throw(played.slot, played.wires.unwrap_or_else(|| self.wires_by_parameter(played.slot)));
        flushed(|| {
            if played.releases {
                self.kit.choke(played.slot, 0.0);
            }
            self.kit.strike(played.slot, &played.strike);
        });
    }

    /// Strikes the piece of a slot at the next sample as a hand asks, with what its parameter says.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn strike(&mut self, slot: Slot, strike: &Strike) {
        let striker = self.playing.style.strikers[slot.index()].unwrap_or(strike.striker);
        self.finish_silence();
        self.start();
        flushed(|| {
            self.kit.choke(slot, 0.0);
            self.kit.strike(slot, &Strike { striker, ..*strike });
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

    /// Moves a hi-hat's pedal for a note.
    fn step(&mut self, slot: Slot, foot: Foot, speed: f64) {
        if foot == Foot::Chick || foot == Foot::Splash {
            self.finish_silence();
            self.start();
        }
        flushed(|| match foot {
            // A drummer's foot is there before the stroke.
            Foot::Position(pedal) => self.kit.arrive_pedal(slot, pedal),
            Foot::Chick => self.kit.stamp_pedal(slot, speed),
            Foot::Splash => self.kit.splash_pedal(slot, speed),
        });
    }

    /// The slots that have a hi-hat.
    fn hi_hats(&self) -> [Option<Slot>; SLOTS] {
        let kit = &self.playing.document().kit;
        Slot::ALL
            .map(|slot| kit.piece(slot).filter(|piece| piece.instrument.kind() == Kind::HiHat).map(|_| slot))
    }

    /// Ends a note: chokes its cymbal if the rule says so.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn note_off(&mut self, note: u8, channel: u8) {
        self.end_figures(note, channel);
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

    /// Chokes every cymbal, whatever the rule, each until its next stroke.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn choke_all(&mut self) {
        for slot in Slot::ALL {
            let grip = self.playing.grip(slot);
            self.grip(grip);
        }
    }

    /// Ends every note: chokes all cymbals if the rule says so.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn notes_off(&mut self) {
        self.playing.end_notes();
        self.figures = [None; SLOTS];
        if self.playing.chokes_at_note_off() {
            self.choke_all();
        }
    }

    /// A channel that is heard, 0 to 15: for whoever means any.
    pub fn any_channel(&self) -> u8 {
        self.playing.style.channel.unwrap_or(0)
    }

    /// Whether a channel, 0 to 15, is heard.
    pub fn hears(&self, channel: u8) -> bool {
        self.playing.hears(channel)
    }

    /// Presses on the cymbal of a note, 0 to 1, if the rule says so.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn pressure(&mut self, note: u8, pressure: f32, channel: u8) {
        let grip = self.playing.pressure(note, pressure, channel);
        self.grip(grip);
    }

    /// Whether a program change on a channel loads a preset.
    pub fn changes_program(&self, channel: u8) -> bool {
        self.playing.changes_program(channel)
    }

    /// Loads the values and the assignments of a preset for a program change, unless the parameters or the channel say
    /// otherwise.
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
        if let Some(Grip { slot, strength }) = grip {
            self.start();
            flushed(|| self.kit.choke(slot, strength));
        }
    }

    /// The slot whose piece a note strikes, if it sounds.
    pub fn slot_of(&self, note: u8) -> Option<Slot> {
        self.playing.stroke(note).map(|stroke| stroke.slot)
    }

    /// The present value of a parameter, in its unit, by its place in the [table](crate::parameters::parameters).
    pub fn parameter(&self, index: usize) -> Option<f32> {
        self.values.get(index).copied()
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
        // Whatever a fade was to end is put to rest below.
        self.silencing.end();
        if self.playing.pedal_at().is_none() {
            // Where notes have left it is forgotten, where a foot is is not.
            for slot in self.hi_hats().into_iter().flatten() {
                let value = f64::from(self.values[slot_index(slot, SlotParameter::Pedal)]);
                flushed(|| self.kit.set(Control::Pedal(slot), value));
            }
        }
        Slot::ALL.into_iter().for_each(|slot| self.express(slot, Expressions::NONE));
        flushed(|| {
            // Whatever hand was on a cymbal is gone with the note it belonged to.
            Slot::ALL.into_iter().for_each(|slot| self.kit.choke(slot, 0.0));
            self.kit.reset();
        });
        self.playing.reset();
        self.figures = [None; SLOTS];
        for slot in Slot::ALL {
            self.apply(slot_index(slot, SlotParameter::Preload));
            self.throw(slot, self.wires_by_parameter(slot));
        }
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

    /// Renders both outputs, full scale 1, overwriting them. Any length, both the same; the cut
    /// into calls does not change the samples.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        self.render_outputs([left, right], &mut []);
    }

    /// [`render`](Self::render), and each slot's piece and the pairs of microphones to outputs of their own; see
    /// [`Kit::render_routed`].
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render_outputs(&mut self, main: Stereo<'_>, outputs: &mut [Stereo<'_>]) {
        if self.figures.iter().all(Option::is_none) {
            self.render_stretch(main, outputs);
        } else {
            self.render_figures(main, outputs);
        }
    }

    /// Renders what no figure's stroke cuts.
    fn render_stretch(&mut self, mut main: Stereo<'_>, outputs: &mut [Stereo<'_>]) {
        self.start();
        self.playing.advance(main[0].len().min(main[1].len()), self.sample_rate);
        let faded = self.silencing.head(&mut main, outputs, |main, outputs| {
            flushed(|| self.kit.render_routed(self.routing, main, outputs));
        });
        if faded > 0 && !self.silencing.is_running() {
            self.end_all();
        }
        tail(faded, main, outputs, |main, outputs| {
            flushed(|| self.kit.render_routed(self.routing, main, outputs));
        });
    }

    /// Says what outputs of their own are to the mix, from the next sample on: copies at first.
    pub fn route(&mut self, routing: Routing) {
        self.routing = routing;
    }

    /// Fades all that sounds within ten milliseconds and puts every piece to rest; feet and parameters stay where they are.
    fn silence(&mut self) {
        self.figures = [None; SLOTS];
        if self.started {
            self.silencing.begin();
        }
    }

    /// Ends a fade at once, if one runs: what is struck now must not fade.
    fn finish_silence(&mut self) {
        if self.silencing.end() {
            self.end_all();
        }
    }

    /// Puts every piece to rest.
    fn end_all(&mut self) {
        Slot::ALL.into_iter().for_each(|slot| self.express(slot, Expressions::NONE));
        self.playing.let_go();
        flushed(|| {
            Slot::ALL.into_iter().for_each(|slot| self.kit.choke(slot, 0.0));
            self.kit.reset();
        });
    }

    /// Writes a snapshot of the kit, and restarts the peaks.
    ///
    /// # Real-time
    /// A copy, no allocation.
    pub fn snapshot(&mut self, into: &mut KitSnapshot) {
        self.kit.snapshot(into);
    }
}

#[cfg(test)]
mod tests;
