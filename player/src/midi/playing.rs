//! How notes and controllers become strokes and chokes.
//!
//! Velocity is a stick speed, spaced in logarithms from [`SOFTEST`] to the dynamics, under a curve. Position
//! controllers, the position and stick parameters and unevenness of the hand are added to what the kit's notes say.
//! Nothing here touches the engine: what comes out is a [`Played`] note or a [`Grip`] for the performer to pass on.

mod arm;
mod controllers;
mod triggers;

use std::collections::BTreeMap;
use std::sync::Arc;

use fastrand::Rng;
use overhear_engine::kit_spec::Kind;
use overhear_engine::slot::{SLOTS, Slot};
use overhear_engine::strike::{Strike, Striker};

use super::assignments::{Assignment, Assignments};
use super::figures::Figure;
use super::maps::NoteMap;
use crate::kit_document::KitDocument;
use crate::midi_map::{POSITION_CONTROLLERS, Stroke, reach};
use arm::{Arm, Limb};
use triggers::Triggers;

/// Stick speed of the softest note, m/s. *By ear*: the faintest tap a pad reports.
pub const SOFTEST: f64 = 0.4;

/// Default stick speed of a note at full velocity, m/s. *Literature*: Dahl, Acta Acustica 90, 2004
/// (tips of four drummers' sticks: pp about 1 m/s, mf 3 to 4, ff 8 to 12). With it and [`CURVE`], velocities of 25, 72 and 112 are
/// 1.0, 3.3 and 7.5 m/s.
pub const FULL_SPEED: f64 = 10.0;
/// Default exponent of the curve, dimensionless.
pub const CURVE: f64 = 0.75;

/// Default mean distance of strokes from where they are aimed, share of the radius: a centimetre on a snare drum. *Assumed*.
pub const POSITION_SPREAD: f64 = 0.05;
/// Default mean deviation of strokes from their speed, dB. *Fitted* to recordings that repeat a stroke, whose levels scatter by 0.3 to
/// 1.2 dB (`docs/playing.md`); with 1.0 those of notes scatter by 1.2 to 2.0 dB, with 0.5 by 0.6 to 1.3.
pub const SPEED_SPREAD: f64 = 0.5;

/// Velocity of the softest note: 1 of MIDI's 127.
const LEAST_VELOCITY: f64 = 1.0 / 127.0;

/// MIDI channels.
const CHANNELS: usize = 16;

/// Controller of the pedals of all hi-hats.
pub const PEDAL_CONTROLLER: u8 = 4;

/// Slowest and fastest foot on the hi-hat's pedal, m/s. *Fitted* to chicks of two public sets (GMRockKit, The Open Source Drumkit), beside closed
/// strokes of the same: 3 to 4 dB softer in the median, 3 to 7 at their loudest, 1 dB softer to 5 louder at their softest; with 2 m/s they were 5 to 15 dB louder.
const FOOT: (f64, f64) = (0.1, 0.9);

/// Controller that carries the lower seven bits of the next note's velocity (MMA CA-031).
pub const FINE_VELOCITY_CONTROLLER: u8 = 88;

/// Controller of the force of snare wires' strainers: from the weakest to the strongest.
pub const STRAINER_CONTROLLER: u8 = 20;

/// Controller of snare wires' throw-offs: off below 64.
pub const THROW_OFF_CONTROLLER: u8 = 80;

/// Silences everything at once.
pub const SOUND_OFF_CONTROLLER: u8 = 120;

/// Ends all notes; what was struck has no other end, so it does the same.
pub const NOTES_OFF_CONTROLLER: u8 = 123;

/// Every controller that acts.
pub const CONTROLLERS: [u8; 10] = [
    PEDAL_CONTROLLER,
    16,
    17,
    18,
    19,
    FINE_VELOCITY_CONTROLLER,
    SOUND_OFF_CONTROLLER,
    NOTES_OFF_CONTROLLER,
    STRAINER_CONTROLLER,
    THROW_OFF_CONTROLLER,
];

/// A MIDI velocity, 0 to 127, as a share of full velocity.
pub fn velocity_from_midi(velocity: u8) -> f32 {
    f32::from(velocity) / 127.0
}

/// Stick speed, m/s, of a velocity (0 to 1), given the speed at full velocity and the exponent of the curve.
///
/// With a curve of 1 equal steps of velocity are equal ratios of speed, as loudness is heard; above 1 soft notes
/// become softer, below 1 louder. The ends stay where they are.
pub fn stick_speed(velocity: f32, full: f64, curve: f64) -> f64 {
    let share = (f64::from(velocity) - LEAST_VELOCITY) / (1.0 - LEAST_VELOCITY);
    SOFTEST * libm::pow(full / SOFTEST, libm::pow(share.clamp(0.0, 1.0), curve))
}

/// Place of a position controller among them.
fn position_of(controller: u8) -> Option<usize> {
    POSITION_CONTROLLERS.contains(&controller).then(|| usize::from(controller - POSITION_CONTROLLERS.start()))
}

/// Which events let a hand grip a cymbal; pressure also lays one on a head.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ChokeRule {
    /// None.
    Off,
    /// Pressure on a note, as pads with an edge switch send it.
    #[default]
    Pressure,
    /// The end of a note.
    NoteOff,
    /// Both.
    Both,
}

impl ChokeRule {
    /// Every rule, in the order of the parameter that chooses one.
    pub const ALL: [ChokeRule; 4] =
        [ChokeRule::Off, ChokeRule::Pressure, ChokeRule::NoteOff, ChokeRule::Both];

    /// Names on screen and in presets, in the order of [`ALL`](Self::ALL).
    pub const NAMES: [&'static str; 4] = ["off", "pressure", "note-off", "both"];
}

/// A hand on a cymbal or on a head.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grip {
    /// Slot of the cymbal, or of the drum whose head it lies on.
    pub slot: Slot,
    /// How firmly, from 0 (let go) to 1.
    pub strength: f64,
}

/// What a note comes to that is no stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Handled {
    /// A hand grips a cymbal.
    Grips(Grip),
    /// Snare wires were thrown: those of this slot, on or off.
    Throws(Slot, bool),
}

/// What a note comes to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Played {
    /// Slot of the piece.
    pub slot: Slot,
    /// The stroke.
    pub strike: Strike,
    /// Whether a hand that gripped the piece at the end of an earlier note lets go first.
    pub releases: bool,
    /// Whether the drum's wires lie on at the stroke; none where the parameter says.
    pub wires: Option<bool>,
    /// What the stroke is the beginning of, if it is no single one.
    pub figure: Option<Figure>,
}

/// What the parameters say of playing.
#[derive(Debug, Clone, Copy)]
pub struct Style {
    /// Stick speed at full velocity, m/s.
    pub dynamics: f64,
    /// Exponent of the velocity curve.
    pub curve: f64,
    /// Mean distance of a stroke from where it is aimed, share of the radius.
    pub position_spread: f64,
    /// Mean difference of a stroke's speed from what is asked, dB.
    pub speed_spread: f64,
    /// The map of the instrument that is played.
    pub map: NoteMap,
    /// The only channel heard, 0 to 15, or all.
    pub channel: Option<u8>,
    /// What chokes cymbals.
    pub chokes: ChokeRule,
    /// Whether controllers 16 to 19 move the place of strokes.
    pub follows_position: bool,
    /// Whether program changes load presets.
    pub follows_programs: bool,
    /// Added to the place of every stroke, share of the radius, `[slot]`.
    pub offsets: [f64; SLOTS],
    /// What is swung instead of what the note says, `[slot]`.
    pub strikers: [Option<Striker>; SLOTS],
}

impl Default for Style {
    fn default() -> Self {
        Style {
            dynamics: FULL_SPEED,
            curve: CURVE,
            position_spread: POSITION_SPREAD,
            speed_spread: SPEED_SPREAD,
            map: NoteMap::default(),
            channel: None,
            chokes: ChokeRule::default(),
            follows_position: true,
            follows_programs: true,
            offsets: [0.0; SLOTS],
            strikers: [None; SLOTS],
        }
    }
}

/// What controllers and notes have left behind.
#[derive(Debug, Clone, Copy)]
struct PlayingState {
    /// Latest values of the position controllers, 0 to 1.
    positions: [Option<f64>; 4],
    /// Where the next stroke lands, 0 to 1, if its note says.
    aim: Option<f64>,
    /// Where a hand was moved while its note lasts: the note and the place, 0 to 1, `[slot]`.
    hands: [Option<(u8, f64)>; SLOTS],
    /// Velocity to add to the next note, `[channel]`.
    fine: [f32; CHANNELS],
    /// Gripped by the end of a note, until the next stroke, `[slot]`.
    gripped: [bool; SLOTS],
    /// Where a controller has the hi-hats' pedals, 0 (up) to 1 (down), if one plays them.
    pedal: Option<f64>,
    /// The pedal's latest reading that was no noise, 0 to 1.
    reading: Option<f32>,
    /// Whether a note or a controller has thrown wires on or off, `[slot]`.
    thrown: [Option<bool>; SLOTS],
    /// Where the random numbers stand from which the unevenness of strokes is drawn.
    seed: u64,
    /// Strokes of hands so far.
    by_hand: u64,
}

impl PlayingState {
    const REST: PlayingState = PlayingState {
        positions: [None; 4],
        aim: None,
        hands: [None; SLOTS],
        fine: [0.0; CHANNELS],
        gripped: [false; SLOTS],
        pedal: None,
        reading: None,
        thrown: [None; SLOTS],
        seed: 0,
        by_hand: 0,
    };
}

/// A player: the style, the kit with its notes, the user's assignments, and what the controllers say.
pub struct Playing {
    /// What the parameters say.
    pub style: Style,
    document: Arc<KitDocument>,
    assignments: Arc<Assignments>,
    state: PlayingState,
    triggers: Triggers,
}

impl Playing {
    /// A player of the default style at a kit.
    pub fn new(document: Arc<KitDocument>, assignments: Arc<Assignments>) -> Playing {
        let triggers = Triggers::default();
        Playing { style: Style::default(), document, assignments, state: PlayingState::REST, triggers }
    }

    /// The kit that is played.
    pub fn document(&self) -> &Arc<KitDocument> {
        &self.document
    }

    /// Goes over to another kit, and returns the one played so far, to be dropped elsewhere.
    ///
    /// # Real-time
    /// No allocation, no lock, nothing dropped.
    pub fn change_kit(&mut self, document: Arc<KitDocument>) -> Arc<KitDocument> {
        // Whoever holds on to a cymbal holds on to one of the former kit.
        self.state.gripped = [false; SLOTS];
        std::mem::replace(&mut self.document, document)
    }

    /// Forgets what controllers and notes have left behind.
    ///
    /// # Real-time
    /// No allocation.
    pub fn reset(&mut self) {
        // A foot stays where it is when the transport stops.
        let PlayingState { pedal, reading, .. } = self.state;
        self.state = PlayingState { pedal, reading, ..PlayingState::REST };
        self.triggers.forget();
    }

    /// Lets samples at a rate (Hz) pass: double triggers are told by the time between notes.
    ///
    /// # Real-time
    /// An addition.
    pub fn advance(&mut self, samples: usize, rate: f64) {
        self.triggers.advance(samples, rate);
    }

    /// What a note of a velocity (0 to 1) comes to, if it sounds. Takes part in learning.
    ///
    /// A velocity of nothing is MIDI's other way to end a note and is silent.
    ///
    /// # Real-time
    /// Table look-ups; no allocation, no lock.
    pub fn note_on(&mut self, note: u8, velocity: f32, channel: u8) -> Option<Played> {
        // Written so that a velocity that is not a number is silent as well.
        let sounds = velocity > 0.0;
        let aim = self.state.aim.take();
        if !sounds || !self.hears(channel) {
            return None;
        }
        self.assignments.heard(note);
        let fine = self.state.fine.get_mut(usize::from(channel)).map_or(0.0, std::mem::take);
        let named = self.reference(note)?;
        let stroke = *self.document.notes.stroke(named)?;
        let (wires, figure) =
            self.document.notes.row(named).map_or((None, None), |row| (row.wires, row.figure));
        let slot = stroke.slot.index();
        let aimed = self.aimed(&stroke, aim) + self.style.offsets[slot];
        let limb = self.next_limb(stroke.striker);
        let striker = self.style.strikers[slot].unwrap_or(stroke.striker);
        let share = limb.speed_share(striker);
        let speed = stick_speed(velocity + fine, share * self.style.dynamics, self.style.curve);
        let mut rng = Rng::with_seed(self.state.seed);
        let arm = Arm::new(limb, &mut rng);
        self.state.seed = rng.get_seed();
        // A hand that strays past a drum's rim lands on the head: on the very rim it does not move.
        let farthest = if self.kind(stroke.slot) == Some(Kind::Drum) { reach(Kind::Drum).1 } else { 1.0 };
        let (radius, angle) =
            arm.placed((aimed.clamp(0.0, farthest), stroke.angle), self.style.position_spread);
        let radius = radius.min(farthest);
        let strike =
            Strike { speed: speed * arm.uneven_speed(self.style.speed_spread), radius, angle, striker };
        let releases = std::mem::take(&mut self.state.gripped[slot]);
        let wires = wires.or(self.state.thrown[slot]);
        Some(Played { slot: stroke.slot, strike, releases, wires, figure })
    }

    /// Where the next note's stroke lands, 0 (centre) to 1 (rim), if it has a place to choose.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn aim(&mut self, place: Option<f32>) {
        self.state.aim = place.filter(|place| !place.is_nan()).map(|place| f64::from(place.clamp(0.0, 1.0)));
    }

    /// Slot of the piece whose pitch a note on a channel bends.
    pub fn bent(&self, note: u8, channel: u8) -> Option<Slot> {
        Some(self.stroke(note).filter(|_| self.hears(channel))?.slot)
    }

    /// What the end of a note comes to.
    ///
    /// # Real-time
    /// Table look-ups; no allocation, no lock.
    pub fn note_off(&mut self, note: u8, channel: u8) -> Option<Grip> {
        if self.hears(channel) {
            self.state
                .hands
                .iter_mut()
                .filter(|hand| hand.is_some_and(|(of, _)| of == note))
                .for_each(|hand| *hand = None);
        }
        if self.chokes_at_note_off() { self.choke(note, channel) } else { None }
    }

    /// Whether the end of a note chokes its cymbal.
    pub fn chokes_at_note_off(&self) -> bool {
        matches!(self.style.chokes, ChokeRule::NoteOff | ChokeRule::Both)
    }

    /// A hand on the cymbal of a slot until its next stroke, if one stands there.
    pub fn grip(&mut self, slot: Slot) -> Option<Grip> {
        if self.kind(slot)? == Kind::Drum {
            return None;
        }
        self.state.gripped[slot.index()] = true;
        Some(Grip { slot, strength: 1.0 })
    }

    /// No hand is on a cymbal any more.
    pub fn let_go(&mut self) {
        self.state.gripped = [false; SLOTS];
    }

    /// What a host's own choke of a note comes to, whatever the rule: until the next stroke.
    ///
    /// # Real-time
    /// Table look-ups; no allocation, no lock.
    pub fn choke(&mut self, note: u8, channel: u8) -> Option<Grip> {
        let slot = self.cymbal(note, channel)?;
        self.grip(slot)
    }

    /// What pressure on a note (0 to 1) comes to: a hand that holds for as long as it presses.
    ///
    /// # Real-time
    /// Table look-ups; no allocation, no lock.
    pub fn pressure(&mut self, note: u8, pressure: f32, channel: u8) -> Option<Grip> {
        let chokes = matches!(self.style.chokes, ChokeRule::Pressure | ChokeRule::Both);
        if !chokes || pressure.is_nan() {
            return None;
        }
        let slot = self.stroke(note).filter(|_| self.hears(channel))?.slot;
        Some(Grip { slot, strength: f64::from(pressure.clamp(0.0, 1.0)) })
    }

    /// Whether a program change on a channel loads a preset.
    pub fn changes_program(&self, channel: u8) -> bool {
        self.style.follows_programs && self.hears(channel)
    }

    /// Puts these assignments in place of the user's.
    ///
    /// # Real-time
    /// A store for each note; no allocation, no lock.
    pub fn assign(&self, notes: &BTreeMap<u8, Assignment>) {
        self.assignments.replace(notes);
    }

    /// The note of the kit's table that a note plays, if any.
    fn reference(&self, note: u8) -> Option<u8> {
        match self.assignments.of(note) {
            Assignment::Mapped => self.style.map.plays(note),
            Assignment::Silent => None,
            Assignment::Plays(reference) => Some(reference),
        }
    }

    /// The stroke of a note, if it sounds.
    pub fn stroke(&self, note: u8) -> Option<&Stroke> {
        self.document.notes.stroke(self.reference(note)?)
    }

    /// Whether a channel, 0 to 15, is heard.
    pub fn hears(&self, channel: u8) -> bool {
        self.style.channel.is_none_or(|only| only == channel)
    }

    fn kind(&self, slot: Slot) -> Option<Kind> {
        self.document.kit.piece(slot).map(|piece| piece.instrument.kind())
    }

    fn cymbal(&self, note: u8, channel: u8) -> Option<Slot> {
        let slot = self.stroke(note).filter(|_| self.hears(channel))?.slot;
        (self.kind(slot)? != Kind::Drum).then_some(slot)
    }

    /// Distance from the centre: where the note itself says, or the controller, once it has said anything, or the note.
    ///
    /// Strokes on a bell or on an edge are what they are wherever the hand is.
    fn aimed(&self, stroke: &Stroke, aim: Option<f64>) -> f64 {
        let Some(kind) = self.kind(stroke.slot) else { return stroke.radius };
        let controller = self.document.notes.position_controller(stroke.slot);
        let controlled = controller
            .filter(|_| self.style.follows_position)
            .and_then(|controller| *self.state.positions.get(position_of(controller)?)?);
        let moved = self.state.hands[stroke.slot.index()].map(|(_, place)| place);
        let position = aim.or(moved).or(controlled).filter(|_| stroke.moves_with_hand(kind));
        position.map_or(stroke.radius, |place| {
            let (inner, outer) = reach(kind);
            inner + (outer - inner) * place
        })
    }

    /// Lets the next stroke be made by the hand that made the latest: its stick bounces.
    ///
    /// # Real-time
    /// A subtraction.
    pub fn hold_hand(&mut self) {
        self.state.by_hand = self.state.by_hand.wrapping_sub(1);
    }

    /// The limb of the present stroke: hands alternate.
    fn next_limb(&mut self, striker: Striker) -> Limb {
        if matches!(striker, Striker::FeltBeater | Striker::PlasticBeater) {
            return Limb::Foot;
        }
        self.state.by_hand = self.state.by_hand.wrapping_add(1);
        if self.state.by_hand % 2 == 1 { Limb::Right } else { Limb::Left }
    }
}

#[cfg(test)]
mod tests;
