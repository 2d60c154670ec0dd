//! Propagation of sound from each piece to the drums' heads and the microphones.
//!
//! Model: a piece radiates its far field in the directions of both overheads, given at a metre. The other pieces receive the
//! [omnidirectional part](crate::surface::incident_field) of a drum. The delay is the path length over the speed of sound, and
//! the pressure falls as one over the path length. Pieces neither shade nor reflect each other.
//!
//! Every way to the room's microphones takes one of the two: the direct one and those by the side walls that of their own side,
//! those by the other surfaces one and the other by turns. High modes radiate another chance sum of theirs in every direction, so that the
//! reflections of a wide-band sound do not add up to a comb.
//!
//! Limits: two directions stand for all. That is right for a drum's low modes, which radiate evenly, and in the mean over many high
//! ones. To the side, cymbals, which are dipoles, radiate too much.

use super::arrangement::Arrangement;
use super::delay_line::{DelayLine, DelayTap, MovingDelayTap};
use super::gain::GainRuns;
use super::mixer::{Mixer, PAIRS};
use super::render_job::RenderJob;
use super::room::{self, Tail};
use crate::air_load::SPEED_OF_SOUND;
use crate::block::{BLOCK, SILENT_RUN};
use crate::kit_spec::Kind;
use crate::kit_spec::room::RoomSpec;
use crate::layout::{CLOSE, Layout, Pair, Placement, distance};
use crate::microphones::CloseMicrophone;
use crate::modal::RECEIVERS;
use crate::piece::Piece;
use crate::receiver::{DIRECTIONS, POINTS};
use crate::slot::{SLOTS, Slot};

/// Faces of a surface of the room.
const IMAGES: usize = 6;

/// Pressure at a pair of microphones over a run, Pa.
pub(super) type PairRun = [[f32; BLOCK]; 2];

/// Direction that stands for the way by a surface of the room to the microphone of a side.
fn toward(image: usize, side: usize) -> usize {
    if image < 2 { image } else { (image + side) % DIRECTIONS }
}

const _: () = assert!(DIRECTIONS == 2, "a direction for each overhead");

/// Delay lines and taps of a kit.
pub(super) struct Propagation {
    sample_rate: f64,
    layout: Layout,
    room: RoomSpec,
    /// Sound of each piece: near field, far field in each direction, and to other pieces.
    lines: [[DelayLine; RECEIVERS]; SLOTS],
    /// From the other pieces: `[receiver][source]`.
    between: Box<[[DelayTap; SLOTS]; SLOTS]>,
    /// To the close microphone.
    close: [DelayTap; SLOTS],
    /// Distance from each piece at which its sound has no delay in the mix, m.
    time_zero: [f64; SLOTS],
    /// `[pair][side][piece]`.
    pairs: Box<[[[MovingDelayTap; SLOTS]; 2]; PAIRS]>,
    /// `[side][piece][image]`, of the room pair.
    images: Box<[[[MovingDelayTap; IMAGES]; SLOTS]; 2]>,
    tail: Tail,
    /// Slots with drums: they receive the others, and radiate their omnidirectional part to them.
    drums: [bool; SLOTS],
    min_delay: usize,
}

impl Propagation {
    /// Still air in a room. Allocates.
    pub(super) fn new(sample_rate: f64, layout: &Layout, room: &RoomSpec) -> Propagation {
        let still = DelayTap::new(0.0, 0.0, sample_rate);
        let moving = MovingDelayTap::new(still, sample_rate);
        let mut air = Propagation {
            sample_rate,
            layout: *layout,
            room: *room,
            lines: std::array::from_fn(|_| std::array::from_fn(|_| DelayLine::new(sample_rate))),
            between: Box::new([[still; SLOTS]; SLOTS]),
            close: [DelayTap::new(0.0, 1.0, sample_rate); SLOTS],
            time_zero: [CLOSE; SLOTS],
            pairs: Box::new([[[moving; SLOTS]; 2]; PAIRS]),
            images: Box::new([[[moving; IMAGES]; SLOTS]; 2]),
            tail: Tail::new(room, sample_rate),
            drums: [false; SLOTS],
            min_delay: BLOCK,
        };
        air.update_paths();
        air.place_pair(0, layout.overheads);
        air.place_pair(1, layout.room);
        air.jump();
        air
    }

    /// Updates the paths between the pieces.
    fn update_paths(&mut self) {
        let mut shortest = None;
        for (to, from) in Slot::ALL.into_iter().flat_map(|to| Slot::ALL.map(|from| (to, from))) {
            if let Some(path) = self.layout.path_length(from, to).filter(|_| from != to) {
                let tap = DelayTap::to_piece(path, self.sample_rate);
                self.between[to.index()][from.index()] = tap;
                // Only drums have a radius, and only they receive.
                if self.layout.pieces[to.index()].is_some_and(|piece| piece.radius > 0.0) {
                    shortest = Some(shortest.map_or(tap.reach(), |least: usize| least.min(tap.reach())));
                }
            }
        }
        self.min_delay = shortest.unwrap_or(BLOCK).max(1);
    }

    /// Takes over all positions, and the room.
    pub(super) fn arrange(&mut self, arrangement: &mut Arrangement) {
        if arrangement.room != self.room {
            std::mem::swap(&mut self.room, &mut arrangement.room);
            std::mem::swap(&mut self.tail, &mut arrangement.tail);
        }
        std::mem::swap(&mut self.layout, &mut arrangement.layout);
        self.update_paths();
        self.place_pair(0, self.layout.overheads);
        self.place_pair(1, self.layout.room);
    }

    /// Takes over the position of a slot's piece.
    pub(super) fn place_slot(&mut self, slot: Slot, piece: &Piece) {
        let at = slot.index();
        self.drums[at] = piece.kind() == Kind::Drum;
        if self.layout.pieces[at] != Some(*piece.placement()) {
            self.layout.pieces[at] = Some(*piece.placement());
            self.update_paths();
            self.place_at(at);
        }
        self.place_close(at, piece.close());
    }

    /// Updates the paths from a piece to both pairs of microphones.
    fn place_at(&mut self, piece: usize) {
        let [overheads, room] = [self.layout.overheads, self.layout.room];
        self.place_piece(piece, 0, overheads);
        self.place_piece(piece, 1, room);
        if self.lines[piece].iter().all(DelayLine::is_silent) {
            self.jump_piece(piece);
        }
    }

    /// The shortest delay between two pieces that are coupled, less the length of the interpolation, samples.
    pub(super) fn min_delay(&self) -> usize {
        self.min_delay
    }

    /// Takes over the close microphone that a piece was built for. Sound in its delay line moves with it at once.
    fn place_close(&mut self, piece: usize, microphone: &CloseMicrophone) {
        let CloseMicrophone { point, time_zero, gain } = *microphone;
        // The attenuation by distance is part of the piece's own sound.
        let late = (point.distance - time_zero).max(0.0) / SPEED_OF_SOUND;
        self.close[piece] = DelayTap::new(late, f64::from(gain), self.sample_rate);
        if std::mem::replace(&mut self.time_zero[piece], time_zero) == time_zero {
            return;
        }
        // The delay to the pairs grows by as much as time zero is nearer to the piece.
        self.place_at(piece);
    }

    /// Moves a pair of microphones; the sound cross-fades.
    pub(super) fn place_pair(&mut self, pair: usize, places: Pair) {
        (0..SLOTS).for_each(|piece| self.place_piece(piece, pair, places));
        if pair == 1 {
            self.layout.room = places;
        } else {
            self.layout.overheads = places;
        }
    }

    /// Updates the paths from a piece to a pair of microphones.
    fn place_piece(&mut self, piece: usize, pair: usize, places: Pair) {
        let Some(Placement { centre, .. }) = self.layout.pieces[piece] else { return };
        let (rate, lead) = (self.sample_rate, self.time_zero[piece]);
        for (side, place) in places.iter().enumerate() {
            self.pairs[pair][side][piece].set(DelayTap::along(distance(&centre, place), lead, rate));
            if pair == 1 {
                let images = room::images(&self.room, &centre);
                for (tap, (image, share)) in self.images[side][piece].iter_mut().zip(images) {
                    tap.set(DelayTap::along(distance(&image, place), lead, rate).weakened(share as f32));
                }
            }
        }
    }

    /// Positions of pieces and microphones.
    pub(super) fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Ends all cross-fades.
    pub(super) fn jump(&mut self) {
        let pairs = self.pairs.iter_mut().flatten().flatten();
        pairs.chain(self.images.iter_mut().flatten().flatten()).for_each(MovingDelayTap::jump);
    }

    /// Ends the cross-fades of one piece.
    fn jump_piece(&mut self, piece: usize) {
        let pairs = self.pairs.iter_mut().flatten().map(|side| &mut side[piece]);
        let images = self.images.iter_mut().flat_map(|side| &mut side[piece]);
        pairs.chain(images).for_each(MovingDelayTap::jump);
    }

    /// Writes the sound of the others into a job, times `amount`.
    pub(super) fn arrive(&self, receiver: usize, clock: u64, amount: &[f32; BLOCK], job: &mut RenderJob) {
        job.receives = false;
        for (from, lines) in self.lines.iter().enumerate() {
            // Cymbals receive nothing, so their far field serves for all.
            let line = &lines[if self.drums[from] { POINTS } else { 1 }];
            if from == receiver || line.is_silent() {
                continue;
            }
            if !std::mem::replace(&mut job.receives, true) {
                job.incident = SILENT_RUN;
            }
            line.hear(clock, &self.between[receiver][from], &mut job.incident[..job.run]);
        }
        if job.receives {
            job.incident.iter_mut().zip(amount).for_each(|(pressure, amount)| *pressure *= amount);
        }
    }

    /// Takes up the sound of a piece.
    pub(super) fn send(&mut self, piece: usize, clock: u64, job: &RenderJob) {
        for (line, sound) in self.lines[piece].iter_mut().zip(&job.sound) {
            line.send(clock, &sound[..job.run]);
        }
    }

    /// Takes up silence from a piece.
    pub(super) fn send_silence(&mut self, piece: usize, clock: u64, samples: usize) {
        self.lines[piece].iter_mut().for_each(|line| line.send(clock, &SILENT_RUN[..samples]));
    }

    /// A piece at its close microphone.
    pub(super) fn close(&self, piece: usize, clock: u64, out: &mut [f32]) {
        let line = &self.lines[piece][0];
        if !line.is_silent() {
            line.hear(clock, &self.close[piece], out);
        }
    }

    /// All pieces at a pair of microphones, each at its level; silence if the pair is off.
    pub(super) fn pair(
        &mut self,
        pair: usize,
        clock: u64,
        samples: usize,
        levels: &GainRuns,
        mixer: &Mixer,
    ) -> PairRun {
        let mut sides = [SILENT_RUN; 2];
        if mixer.is_shut(pair) {
            // Cross-fades have ended when the pair is on again.
            self.pairs[pair].iter_mut().flatten().for_each(MovingDelayTap::jump);
            return sides;
        }
        for (piece, lines) in self.lines.iter().enumerate() {
            if lines[1..POINTS].iter().all(DelayLine::is_silent) {
                continue;
            }
            for (side, total) in sides.iter_mut().enumerate() {
                let mut sound = SILENT_RUN;
                let sound = &mut sound[..samples];
                self.pairs[pair][side][piece].hear(&lines[1 + side], clock, sound);
                if pair == 1 {
                    for (image, tap) in self.images[side][piece].iter_mut().enumerate() {
                        tap.hear(&lines[1 + toward(image, side)], clock, sound);
                    }
                }
                for ((sum, sound), level) in total.iter_mut().zip(sound).zip(&levels[piece]) {
                    *sum += level * *sound;
                }
            }
        }
        sides
    }

    /// Adds the room's tail of `sent`, the far field at a metre in each direction, Pa.
    pub(super) fn tail(&mut self, sent: [&[f32]; DIRECTIONS], out: &mut PairRun) {
        let [left, right] = out.each_mut().map(|side| &mut side[..sent[0].len()]);
        self.tail.render(sent, [left, right]);
    }

    /// Makes silence exact. Called now and then, on the kit's clock.
    pub(super) fn settle(&mut self) {
        self.tail.settle();
    }

    /// Whether the delay lines of a slot are silent.
    pub(super) fn is_slot_silent(&self, slot: usize) -> bool {
        self.lines[slot].iter().all(DelayLine::is_silent)
    }

    /// Whether all delay lines and the room are silent.
    pub(super) fn is_silent(&self) -> bool {
        self.tail.is_silent() && self.lines.iter().flatten().all(DelayLine::is_silent)
    }

    /// Silences all delay lines and ends all cross-fades.
    pub(super) fn reset(&mut self) {
        self.lines.iter_mut().flatten().for_each(DelayLine::reset);
        self.tail.reset();
        self.jump();
    }
}
