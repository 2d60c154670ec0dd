//! The mixing desk: a strip for every microphone.
//!
//! ```text
//! close of a piece --> level of the piece --> strip --> pan ----+--> output of the piece
//! overheads, room: all pieces, each at its level --> strip --> balance --> output of the pair
//!                                                               +--> master --> clip --> ceiling --> left, right
//! ```
//!
//! By [`Routing::Instead`] a strip with an output of its own leaves the mix, and goes through a master and a ceiling of the
//! same kind on its way there.

use super::control::Microphone;
use super::gain::{Gain, GainRun, Pan, gain};
use crate::block::BLOCK;
use crate::fitted;
use crate::kit_spec::KitSpec;
use crate::level::FULL_SCALE;
use crate::slot::{SLOTS, Slot};

/// Strips: close ones by slot, then the pairs.
pub(super) const STRIPS: usize = SLOTS + PAIRS;

/// Pairs of microphones: overheads, room.
pub(super) const PAIRS: usize = 2;

/// Full scale above which the safety clip bends. *By ear*: 1.4 dB are left to it.
const KNEE: f32 = fitted::CLIP_KNEE as f32;

/// Two outputs of one length: left, right; full scale is 1.
pub type Stereo<'a> = [&'a mut [f32]; 2];

/// What outputs of their own are to the mix.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Routing {
    /// Copies, before the master: the mix has everything.
    #[default]
    Copies,
    /// Instead of it, after the master: what has an output is not in the mix, and all outputs together are the whole.
    Instead,
}

/// Full scale above which the ceiling bends, +6 dBFS, and the ceiling, +12 dBFS. *By ear*: no music comes near, and what
/// does would hurt.
const CEILING: (f32, f32) = (2.0, 4.0);

/// One strip.
struct Strip {
    level: f32,
    muted: bool,
    solo: bool,
    gain: Gain,
    pan: Pan,
    /// Largest sample since the last snapshot.
    peak: f32,
}

/// The desk.
pub(super) struct Mixer {
    strips: [Strip; STRIPS],
    close: f32,
    /// Of each piece in every microphone.
    levels: [Gain; SLOTS],
    master: Gain,
    clips: bool,
    clipped: u64,
    limited: u64,
    peak: [f32; 2],
}

/// Place of a microphone's strip.
fn strip(microphone: Microphone) -> usize {
    match microphone {
        Microphone::Close(slot) => slot.index(),
        Microphone::Overheads => SLOTS,
        Microphone::Room => SLOTS + 1,
    }
}

impl Mixer {
    pub(super) fn new(sample_rate: f64, kit: &KitSpec) -> Mixer {
        let strips = std::array::from_fn(|i| {
            let side = kit.pieces.get(i).map_or(0.0, |piece| piece.defaults.pan);
            let mut pan = Pan::new(sample_rate, side);
            if i >= SLOTS {
                pan.set_balance(0.0);
                pan.jump();
            }
            Strip { level: 1.0, muted: false, solo: false, gain: Gain::new(sample_rate), pan, peak: 0.0 }
        });
        let mut desk = Mixer {
            strips,
            close: 1.0,
            levels: [Gain::new(sample_rate); SLOTS],
            master: Gain::new(sample_rate),
            clips: false,
            clipped: 0,
            limited: 0,
            peak: [0.0; 2],
        };
        for (slot, piece) in kit.slots() {
            desk.set_level(slot, piece.defaults.level_db);
        }
        desk.jump();
        desk
    }

    pub(super) fn set_master(&mut self, db: f64) {
        self.master.set(gain(db));
    }

    pub(super) fn set_level(&mut self, slot: Slot, db: f64) {
        self.levels[slot.index()].set(gain(db));
    }

    pub(super) fn set_close(&mut self, db: f64) {
        self.close = gain(db);
        self.follow();
    }

    pub(super) fn set_clip(&mut self, on: bool) {
        self.clips = on;
    }

    pub(super) fn set_balance(&mut self, microphone: Microphone, side: f64) {
        let at = strip(microphone);
        match microphone {
            Microphone::Close(_) => self.strips[at].pan.set(side),
            Microphone::Overheads | Microphone::Room => self.strips[at].pan.set_balance(side),
        }
    }

    pub(super) fn set_strip_level(&mut self, microphone: Microphone, db: f64) {
        self.change(microphone, |strip| strip.level = gain(db));
    }

    pub(super) fn mute(&mut self, microphone: Microphone, on: bool) {
        self.change(microphone, |strip| strip.muted = on);
    }

    pub(super) fn solo(&mut self, microphone: Microphone, on: bool) {
        self.change(microphone, |strip| strip.solo = on);
    }

    fn change(&mut self, microphone: Microphone, change: impl FnOnce(&mut Strip)) {
        change(&mut self.strips[strip(microphone)]);
        self.follow();
    }

    /// Works out where every strip's gain goes.
    fn follow(&mut self) {
        let alone = self.strips.iter().any(|strip| strip.solo);
        for (i, strip) in self.strips.iter_mut().enumerate() {
            let open = !strip.muted && (strip.solo || !alone);
            let group = if i < SLOTS { self.close } else { 1.0 };
            strip.gain.set(if open { strip.level * group } else { 0.0 });
        }
    }

    pub(super) fn jump(&mut self) {
        self.strips.iter_mut().for_each(|strip| {
            strip.gain.jump();
            strip.pan.jump();
        });
        self.levels.iter_mut().for_each(Gain::jump);
        self.master.jump();
    }

    /// Whether a pair is silent in the mix, whatever it receives.
    pub(super) fn is_shut(&self, pair: usize) -> bool {
        self.strips[SLOTS + pair].gain.is_shut()
    }

    /// Each piece's level over a run.
    pub(super) fn levels(&mut self, samples: usize) -> [GainRun; SLOTS] {
        self.levels.each_mut().map(|level| level.run(samples))
    }

    /// The master's gain over a run.
    pub(super) fn master(&mut self, samples: usize) -> GainRun {
        self.master.run(samples)
    }

    /// Sends a strip's sound (Pa, already at the pieces' levels) to the mix and to its own output.
    pub(super) fn add(&mut self, at: usize, sound: [&[f32]; 2], bus: &mut Bus<'_>, own: Option<Stereo<'_>>) {
        let Bus { mix, master, routing } = bus;
        let strip = &mut self.strips[at];
        let samples = mix[0].len();
        let gains = strip.gain.run(samples);
        let pans = strip.pan.run(samples);
        let mut own = own.map(|own| own.map(|side| (side.len() == samples).then_some(side)));
        for side in 0..2 {
            let mut share = [0.0; BLOCK];
            let share = &mut share[..samples];
            for (((share, sound), gain), pan) in
                share.iter_mut().zip(sound[side]).zip(&gains).zip(&pans[side])
            {
                *share = pan * (sound * (gain / FULL_SCALE));
            }
            strip.peak = share.iter().fold(strip.peak, |peak, x| peak.max(x.abs()));
            let own = own.as_mut().and_then(|own| own[side].as_mut());
            match (own, *routing) {
                (Some(own), Routing::Instead) => {
                    for ((own, share), gain) in own.iter_mut().zip(&*share).zip(&*master) {
                        *own = share * gain;
                        self.limited = self.limited.saturating_add(u64::from(limit(own)));
                    }
                    continue;
                }
                (Some(own), Routing::Copies) => own.copy_from_slice(share),
                (None, _) => {}
            }
            mix[side].iter_mut().zip(&*share).for_each(|(sum, share)| *sum += share);
        }
    }

    /// Whether every gain has arrived: then silence is mixed by leaving it as it is.
    pub(super) fn rests(&self) -> bool {
        self.master.rests()
            && self.levels.iter().all(Gain::rests)
            && self.strips.iter().all(|strip| strip.gain.rests() && strip.pan.rests())
    }

    /// Brings the mix to its level.
    pub(super) fn finish(&mut self, bus: &mut Bus<'_>) {
        for (side, peak) in bus.mix.iter_mut().zip(&mut self.peak) {
            for (sample, gain) in side.iter_mut().zip(&bus.master) {
                *sample *= gain;
                if self.clips && sample.abs() > KNEE {
                    *sample = clip(*sample);
                    self.clipped = self.clipped.saturating_add(1);
                }
                self.limited = self.limited.saturating_add(u64::from(limit(sample)));
                *peak = peak.max(sample.abs());
            }
        }
    }

    /// Samples that the clip has bent since the start.
    pub(super) fn clipped(&self) -> u64 {
        self.clipped
    }

    /// Samples that the ceiling has bent since the start.
    pub(super) fn limited(&self) -> u64 {
        self.limited
    }

    /// Largest samples of the outputs since the last call, and of a strip.
    pub(super) fn take_peak(&mut self) -> [f32; 2] {
        std::mem::take(&mut self.peak)
    }

    pub(super) fn take_strip_peak(&mut self, at: usize) -> f32 {
        std::mem::take(&mut self.strips[at].peak)
    }

    /// Silence.
    pub(super) fn reset(&mut self) {
        self.jump();
        self.peak = [0.0; 2];
        self.strips.iter_mut().for_each(|strip| strip.peak = 0.0);
    }
}

/// Where the strips of one run go.
pub(super) struct Bus<'a> {
    /// The mix.
    pub(super) mix: Stereo<'a>,
    /// The master's gain.
    pub(super) master: GainRun,
    /// What outputs of their own are to the mix.
    pub(super) routing: Routing,
}

/// Keeps a sample under the ceiling of 12 dBFS, and says whether it had to be bent: smooth, and no bit changes below 6 dBFS.
///
/// # Real-time
/// A comparison.
pub fn limit(sample: &mut f32) -> bool {
    let (knee, top) = CEILING;
    let magnitude = sample.abs();
    let bends = magnitude > knee;
    if bends {
        let beyond = (magnitude - knee) / (top - knee);
        *sample = sample.signum() * (top - (top - knee) / (1.0 + beyond));
    }
    bends
}

/// Bends what is beyond the knee toward full scale: smooth there, never past it.
fn clip(x: f32) -> f32 {
    let beyond = (x.abs() - KNEE) / (1.0 - KNEE);
    x.signum() * (KNEE + (1.0 - KNEE) * beyond / (1.0 + beyond))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ceiling_changes_no_bit_below_6_dbfs_and_lets_nothing_beyond_12() {
        let mut before = 0.0;
        for i in 0..100_000 {
            let loud = 1e-3 * i as f32;
            let (mut high, mut low) = (loud, -loud);
            assert_eq!((limit(&mut high), limit(&mut low)), (loud > CEILING.0, loud > CEILING.0));
            assert!(high == -low && high >= before && high <= CEILING.1, "{loud} becomes {high}");
            assert!(loud > CEILING.0 || high.to_bits() == loud.to_bits());
            before = high;
        }
        let mut endless = f32::INFINITY;
        assert!(limit(&mut endless) && endless == CEILING.1);
    }

    #[test]
    fn the_clip_is_smooth_monotone_and_never_passes_full_scale() {
        let mut before = 0.0;
        for i in 0..4_000 {
            let x = 0.8 + 0.001 * i as f32;
            let y = if x > KNEE { clip(x) } else { x };
            assert!(y >= before && y < 1.0 && clip(-x.max(KNEE)) == -clip(x.max(KNEE)));
            assert!(i == 0 || y - before < 1.01e-3);
            before = y;
        }
    }
}
