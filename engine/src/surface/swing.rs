//! A body that swings while it rings: its lobes turn past the receivers.
//!
//! Model: the body's rock is a motion of the body as a whole; its two modes give the tilt, or what the body is
//! [attached](super::attachment) to. What each mode shows of itself toward a receiver is that of the direction in which the receiver
//! lies from the tilted body.
//!
//! Scheme: transfers are worked out once in a cycle of some blocks, a part in each block, for the tilt at its beginning. In the next
//! cycle the weights go there in steps of some samples. A cycle lasts as long as the body, at the speed of the last one, needs for
//! a small turn. Where the body turns faster than that, as after a stroke, the cycle begins anew.

use crate::block::BLOCK;
use crate::modal::sway::Sway;
use crate::receiver::POINTS;

use super::body::{SoundingBody, StruckBody};

/// Turn in a cycle, rad. *Derived*: lobes at 10 kHz are 0.1 rad wide on a crash and 0.15 on a splash; between weights 0.02 rad apart a
/// straight line is within 5 % of such a lobe.
const TURN: f64 = 0.02;

/// A turn since its beginning that ends a cycle before its time, if a new one is over sooner, rad. *Judgement*: a swing that gains speed
/// evenly, as gravity makes it, is not cut short; one that begins by a stroke in a long cycle need not wait for its end.
const ASTRAY: f64 = 1.5 * TURN;

/// How long a cycle lasts, s, at least and at most. At least *derived*: a crash turns by 3 rad/s at most, by 0.01 rad in so long, a splash
/// by 0.04. At most *derived*: a fifteenth of a splash's period, in which a straight line is within a fiftieth of the swing.
const CYCLE: [f64; 2] = [0.003, 0.024];

/// Samples of a step of the weights. *Derived*: with the shortest, images at 5.5 kHz from a mode at 10 kHz lie 40 dB under it.
const STEPS: [usize; 2] = [16, 8];

/// Fewest steps of a cycle but for the shortest. *Derived*: of so many, each turns by no more than the shortest at 3 rad/s.
const FEWEST: usize = 37;

/// Change of the tilt that nobody hears, rad. *Derived*: a hundredth of a lobe at 10 kHz.
const UNHEARD: f64 = 1e-3;

/// How a body is heard from a direction.
pub trait Directivity: Send {
    /// Turns to a tilt (rad): of the side at angle 0 into the surface, and of that at a right angle to it.
    ///
    /// # Real-time
    /// Some microseconds.
    fn turn(&mut self, tilt: [f64; 2]);

    /// Does so much of the work for the transfers of all modes: part `part` of `parts`.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    fn work(&mut self, part: usize, parts: usize);

    /// The transfers to each point at the tilt turned to, Pa s2/m, `[mode]`, once all work is done.
    fn write(&self, transfers: [&mut [[f64; 2]]; POINTS]);

    /// The transfers at rest, likewise.
    fn write_rest(&self, transfers: [&mut [[f64; 2]]; POINTS]);
}

/// Blocks of a cycle of a body that turns by so much (rad) in a block, between the fewest and the most.
fn cycle_of(turn: f64, [fewest, most]: [usize; 2]) -> usize {
    ((TURN / turn.max(f64::MIN_POSITIVE)).min(most as f64) as usize).max(fewest)
}

/// Samples of a step in a cycle of so many blocks.
fn step_of(cycle: usize) -> usize {
    let shortest = STEPS[STEPS.len() - 1];
    STEPS.into_iter().find(|step| cycle * BLOCK / step >= FEWEST).unwrap_or(shortest)
}

/// The rock of a body among its modes.
#[derive(Debug, Clone, Copy)]
pub struct Rock {
    /// The modes about either axis.
    pub modes: [usize; 2],
    /// Tilt in rad by a displacement of these modes in m.
    pub tilt_per_metre: f64,
}

/// The swing of a body.
pub struct Swing {
    directivity: Box<dyn Directivity>,
    /// None where the rock is an attachment's.
    rock: Option<Rock>,
    sway: Sway,
    /// Tilt that the cycle works for.
    tilt: [f64; 2],
    /// Block of the cycle, if one runs, and how many it has.
    block: Option<usize>,
    cycle: usize,
    /// Fewest and most blocks of one.
    cycles: [usize; 2],
    /// Samples of a step of the weights.
    step: usize,
    /// Samples into the present block.
    sample: usize,
    /// Whether the weights have left those of rest.
    moved: bool,
}

impl Swing {
    /// A swing of a body at rest with so many modes, of which the first are `coupled`, at a sample rate (Hz). Allocates.
    pub fn new(
        directivity: Box<dyn Directivity>,
        rock: Option<Rock>,
        (modes, coupled): (usize, usize),
        sample_rate: f64,
    ) -> Swing {
        let cycles = CYCLE.map(|seconds| ((seconds * sample_rate / BLOCK as f64).round() as usize).max(2));
        let sway = Sway::new(modes, coupled);
        Swing {
            directivity,
            rock,
            sway,
            tilt: [0.0; 2],
            block: None,
            cycle: cycles[0],
            cycles,
            step: STEPS[0],
            sample: 0,
            moved: false,
        }
    }

    /// The present tilt by the body's own modes, rad.
    fn tilt(&self, body: &SoundingBody) -> [f64; 2] {
        let of = |rock: Rock| {
            rock.modes.map(|mode| rock.tilt_per_metre * f64::from(body.modal.displacement(mode)))
        };
        self.rock.map_or([0.0; 2], of)
    }

    /// Begins a block of a body that what it is attached to tilts, or else its own modes (rad).
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn begin_block(&mut self, body: &mut SoundingBody, attached: Option<[f64; 2]>) {
        self.sample = 0;
        let tilt = attached.unwrap_or_else(|| self.tilt(body));
        match self.block {
            Some(block) if self.is_astray(tilt, block + 1) => {
                self.cycle = cycle_of(self.turned_to(tilt) / (block + 1) as f64, self.cycles);
                self.begin_cycle(tilt);
            }
            Some(block) if block + 1 < self.cycle => {
                self.directivity.work(block + 1, self.cycle);
                self.block = Some(block + 1);
            }
            Some(_) => {
                self.cycle = cycle_of(self.turned_to(tilt) / self.cycle as f64, self.cycles);
                let Swing { directivity, sway, .. } = self;
                directivity.write(sway.transfers_mut());
                body.modal.aim(sway, 0..body.modal.len());
                self.step = step_of(self.cycle);
                body.modal.set_out(sway, &mut body.receiver, self.cycle * BLOCK / self.step);
                self.moved = true;
                self.begin_cycle(tilt);
            }
            None => {
                self.cycle = cycle_of(self.turned_to(tilt), self.cycles);
                self.begin_cycle(tilt);
            }
        }
    }

    /// How far a tilt is from the one that is known, rad.
    fn turned_to(&self, tilt: [f64; 2]) -> f64 {
        tilt.iter().zip(self.tilt).map(|(tilt, known)| (tilt - known).abs()).fold(0.0, f64::max)
    }

    /// Whether so many blocks into a cycle a new one is worth what has been worked out.
    fn is_astray(&self, tilt: [f64; 2], blocks: usize) -> bool {
        let turned = self.turned_to(tilt);
        turned > ASTRAY && blocks + cycle_of(turned / blocks as f64, self.cycles) < self.cycle
    }

    fn begin_cycle(&mut self, tilt: [f64; 2]) {
        self.block = None;
        if self.turned_to(tilt) > UNHEARD {
            self.tilt = tilt;
            self.directivity.turn(tilt);
            self.directivity.work(0, self.cycle);
            self.block = Some(0);
        }
    }

    /// Samples until the weights move, of so many; they move after.
    pub fn run(&self, samples: usize) -> usize {
        if self.sway.moves() { samples.min(self.step - self.sample % self.step) } else { samples }
    }

    /// So many samples have been rendered.
    pub fn advance(&mut self, samples: usize, body: &mut StruckBody) {
        self.sample += samples;
        if self.sample.is_multiple_of(self.step) {
            body.sway(&mut self.sway);
        }
    }

    /// The weights were worked out anew from the latest transfers.
    pub fn follow(&mut self) {
        self.sway.stop();
    }

    /// Hangs at rest again. True if the transfers have changed, which everything that depends on them must follow.
    pub fn reset(&mut self, body: &mut SoundingBody) -> bool {
        self.sway.stop();
        (self.tilt, self.block, self.sample) = ([0.0; 2], None, 0);
        self.cycle = self.cycles[0];
        if !std::mem::take(&mut self.moved) {
            return false;
        }
        self.directivity.write_rest(self.sway.transfers_mut());
        for (receiver, transfers) in self.sway.transfers_mut().into_iter().enumerate() {
            body.receiver.transfer_mut(receiver).copy_from_slice(transfers);
        }
        true
    }
}

#[cfg(test)]
mod tests;
