//! The air of the kit: what every piece sends out, how it reaches the drums' heads and the microphones.
//!
//! Model: a piece sends out what it is heard as far away, in the direction of the overheads, as at a metre; and, of a drum to
//! the others, what goes [all around](crate::surface::incident_field). Everywhere it arrives after the way over the speed of
//! sound, weakened as one over the way. Pieces neither shade nor mirror each other.
//!
//! Limits: one direction stands for all. That is right for a drum's low modes, which go all around; high modes
//! and cymbals, which are dipoles, are given to the side what they send up.

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
use crate::slot::{SLOTS, Slot};

/// Faces of a surface of the room.
const IMAGES: usize = 6;

/// What a pair of microphones hears over a run, Pa.
pub(super) type PairRun = [[f32; BLOCK]; 2];

/// The kit's air.
pub(super) struct Propagation {
    sample_rate: f64,
    layout: Layout,
    room: RoomSpec,
    /// What each piece sends out: to its close microphone, far away, and to other pieces.
    lines: [[DelayLine; RECEIVERS]; SLOTS],
    /// Of each piece, from the others: `[listener][source]`.
    heard: Box<[[DelayTap; SLOTS]; SLOTS]>,
    /// To the close microphone.
    close: [DelayTap; SLOTS],
    /// Distance from each piece at which its sound is time zero of the mix, m.
    time_zero: [f64; SLOTS],
    /// `[pair][side][piece]`.
    pairs: Box<[[[MovingDelayTap; SLOTS]; 2]; PAIRS]>,
    /// `[side][piece][image]`, of the room pair.
    images: Box<[[[MovingDelayTap; IMAGES]; SLOTS]; 2]>,
    tail: Tail,
    /// Which slots hold drums: they hear the others, and are heard by what goes all around.
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
            heard: Box::new([[still; SLOTS]; SLOTS]),
            close: [DelayTap::new(0.0, 1.0, sample_rate); SLOTS],
            time_zero: [CLOSE; SLOTS],
            pairs: Box::new([[[moving; SLOTS]; 2]; PAIRS]),
            images: Box::new([[[moving; IMAGES]; SLOTS]; 2]),
            tail: Tail::new(room, sample_rate),
            drums: [false; SLOTS],
            min_delay: BLOCK,
        };
        air.lay_ways();
        air.place_pair(0, layout.overheads);
        air.place_pair(1, layout.room);
        air.jump();
        air
    }

    /// Works out the ways between the pieces.
    fn lay_ways(&mut self) {
        let mut shortest = None;
        for (to, from) in Slot::ALL.into_iter().flat_map(|to| Slot::ALL.map(|from| (to, from))) {
            if let Some(way) = self.layout.path_length(from, to).filter(|_| from != to) {
                let tap = DelayTap::along(way, 0.0, self.sample_rate);
                self.heard[to.index()][from.index()] = tap;
                // Only drums have a radius, and only they listen.
                if self.layout.pieces[to.index()].is_some_and(|piece| piece.radius > 0.0) {
                    shortest = Some(shortest.map_or(tap.reach(), |least: usize| least.min(tap.reach())));
                }
            }
        }
        self.min_delay = shortest.unwrap_or(BLOCK).max(1);
    }

    /// Takes over where everything stands, and the room.
    pub(super) fn arrange(&mut self, arrangement: &mut Arrangement) {
        if arrangement.room != self.room {
            std::mem::swap(&mut self.room, &mut arrangement.room);
            std::mem::swap(&mut self.tail, &mut arrangement.tail);
        }
        std::mem::swap(&mut self.layout, &mut arrangement.layout);
        self.lay_ways();
        self.place_pair(0, self.layout.overheads);
        self.place_pair(1, self.layout.room);
    }

    /// Puts the piece of a slot somewhere.
    pub(super) fn place_slot(&mut self, slot: Slot, piece: &Piece) {
        let at = slot.index();
        self.drums[at] = piece.kind() == Kind::Drum;
        if self.layout.pieces[at] != Some(*piece.placement()) {
            self.layout.pieces[at] = Some(*piece.placement());
            self.lay_ways();
            self.place_at(at);
        }
        self.place_close(at, piece.close());
    }

    /// Lets both pairs of microphones hear a piece from where it stands.
    fn place_at(&mut self, piece: usize) {
        let [overheads, room] = [self.layout.overheads, self.layout.room];
        self.place_piece(piece, 0, overheads);
        self.place_piece(piece, 1, room);
        if self.lines[piece].iter().all(DelayLine::is_silent) {
            self.jump_piece(piece);
        }
    }

    /// The shortest way between two pieces that hear each other, less what reading it needs, samples.
    pub(super) fn min_delay(&self) -> usize {
        self.min_delay
    }

    /// Puts a close microphone where its piece was built to be heard. What is on the way to it is heard there at once.
    fn place_close(&mut self, piece: usize, microphone: &CloseMicrophone) {
        let CloseMicrophone { point, time_zero, gain } = *microphone;
        // What distance does to the level is in the piece's own sound.
        let late = (point.distance - time_zero).max(0.0) / SPEED_OF_SOUND;
        self.close[piece] = DelayTap::new(late, f64::from(gain), self.sample_rate);
        if std::mem::replace(&mut self.time_zero[piece], time_zero) == time_zero {
            return;
        }
        // The pairs hear it by as much later as it is time zero from nearer by.
        self.place_at(piece);
    }

    /// Puts a pair of microphones somewhere; what is heard fades over.
    pub(super) fn place_pair(&mut self, pair: usize, places: Pair) {
        (0..SLOTS).for_each(|piece| self.place_piece(piece, pair, places));
        if pair == 1 {
            self.layout.room = places;
        } else {
            self.layout.overheads = places;
        }
    }

    /// Lets a pair of microphones hear a piece from there.
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

    /// Where everything stands.
    pub(super) fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Moved microphones arrive at once.
    pub(super) fn jump(&mut self) {
        let pairs = self.pairs.iter_mut().flatten().flatten();
        pairs.chain(self.images.iter_mut().flatten().flatten()).for_each(MovingDelayTap::jump);
    }

    /// Of one piece alone.
    fn jump_piece(&mut self, piece: usize) {
        let pairs = self.pairs.iter_mut().flatten().map(|side| &mut side[piece]);
        let images = self.images.iter_mut().flat_map(|side| &mut side[piece]);
        pairs.chain(images).for_each(MovingDelayTap::jump);
    }

    /// Lets a piece hear the others over its run, so much of them.
    pub(super) fn arrive(&self, listener: usize, clock: u64, amount: &[f32; BLOCK], post: &mut RenderJob) {
        post.hears = false;
        for (from, lines) in self.lines.iter().enumerate() {
            // A cymbal sends the same everywhere: nobody's hearing comes back to it.
            let line = &lines[if self.drums[from] { 2 } else { 1 }];
            if from == listener || line.is_silent() {
                continue;
            }
            if !std::mem::replace(&mut post.hears, true) {
                post.incident = SILENT_RUN;
            }
            line.hear(clock, &self.heard[listener][from], &mut post.incident[..post.run]);
        }
        if post.hears {
            post.incident.iter_mut().zip(amount).for_each(|(pressure, amount)| *pressure *= amount);
        }
    }

    /// Takes up what a piece sends out.
    pub(super) fn send(&mut self, piece: usize, clock: u64, post: &RenderJob) {
        for (line, sound) in self.lines[piece].iter_mut().zip(&post.sound) {
            line.send(clock, &sound[..post.run]);
        }
    }

    /// Nothing came from a piece.
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

    /// All pieces at a pair of microphones, each at its level; nothing if nobody listens.
    pub(super) fn pair(
        &mut self,
        pair: usize,
        clock: u64,
        samples: usize,
        levels: &GainRuns,
        desk: &Mixer,
    ) -> PairRun {
        let mut heard = [SILENT_RUN; 2];
        if desk.is_shut(pair) {
            // What moves has arrived when somebody listens again.
            self.pairs[pair].iter_mut().flatten().for_each(MovingDelayTap::jump);
            return heard;
        }
        for (piece, lines) in self.lines.iter().enumerate() {
            if lines[1].is_silent() {
                continue;
            }
            for (side, heard) in heard.iter_mut().enumerate() {
                let mut sound = SILENT_RUN;
                let sound = &mut sound[..samples];
                self.pairs[pair][side][piece].hear(&lines[1], clock, sound);
                if pair == 1 {
                    self.images[side][piece].iter_mut().for_each(|tap| tap.hear(&lines[1], clock, sound));
                }
                for ((sum, sound), level) in heard.iter_mut().zip(sound).zip(&levels[piece]) {
                    *sum += level * *sound;
                }
            }
        }
        heard
    }

    /// Adds the room's tail of what is sent out now, far away as at a metre.
    pub(super) fn tail(&mut self, sent: &[f32], out: &mut PairRun) {
        let [left, right] = out.each_mut().map(|side| &mut side[..sent.len()]);
        self.tail.render(sent, [left, right]);
    }

    /// Makes silence exact; meant for now and then, on the kit's clock.
    pub(super) fn settle(&mut self) {
        self.tail.settle();
    }

    /// Whether nothing of a slot is under way.
    pub(super) fn is_slot_silent(&self, slot: usize) -> bool {
        self.lines[slot].iter().all(DelayLine::is_silent)
    }

    /// Whether nothing is under way anywhere.
    pub(super) fn is_silent(&self) -> bool {
        self.tail.is_silent() && self.lines.iter().flatten().all(DelayLine::is_silent)
    }

    /// Still again; moved microphones have arrived.
    pub(super) fn reset(&mut self) {
        self.lines.iter_mut().flatten().for_each(DelayLine::reset);
        self.tail.reset();
        self.jump();
    }
}
