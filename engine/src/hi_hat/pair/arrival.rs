//! State of a foot on its way to where a note wants it. The model is that of `hi_hat/arriving.rs`.

use crate::hi_hat::rigid::Weights;

/// Longest time from the note to the end of the foot's way, s: that of a foot that opens. *Converged*: in a third of it the
/// release of closed cymbals is as loud as a soft stroke. It is less than the 5 ms in which a note has to sound as it is named.
pub const ARRIVAL: f64 = 3e-3;

/// Time in which the ringing is taken away, s. *Converged*: steps between samples are a third of those of the ringing at most, and
/// in 0.4 ms the stroke is 3 to 4 dB softer.
const CALMING: f64 = 2.5e-4;

/// Share of the amplitude that it leaves. *Converged*: with 0.05 what is left of an open hi-hat's ringing is thrown about by rims
/// that close in a quarter of a millisecond, and is as loud as a soft stroke; with this it is 5 dB softer, or more.
const LEFT: f64 = 0.02;

/// Time of the way on which the rims touch, s, for a foot that closes. *Converged*: in 1 ms the stick lands on cymbals that
/// still close, and the first 2 ms are 1 to 7 dB softer; in 0.1 ms the landing of the rims is 5 dB louder.
const CLOSING: f64 = 2.5e-4;

/// Most equilibria on the way. *Converged*: with 6, opening after a soft stroke is 8 dB louder, by the steps alone.
const STEPS: u32 = 24;

/// A foot on its way to where a note wants it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Arrival {
    /// Goal of the rod, m.
    pub(crate) end: f64,
    /// Samples left in which the ringing is taken away, and the share of it that each leaves.
    pub(crate) calming: u32,
    pub(crate) share: f32,
    /// Steps of the way, those that have not begun, samples of each, and samples left of the present one.
    pub(crate) whole: u32,
    pub(crate) steps: u32,
    pub(crate) samples: u32,
    pub(crate) left: u32,
    /// Change in a sample: of the rod, and of heave and tilts of both cymbals, m.
    pub(crate) rod: f64,
    pub(crate) shift: [Weights; 2],
    /// Heave and tilts in equilibrium at the end of the present step, m.
    pub(crate) places: [Weights; 2],
    /// Distance from equilibrium at the start, which every step reduces by the same amount, m.
    pub(crate) deviation: [Weights; 2],
}

impl Arrival {
    /// To `end` (m), which `closes` cymbals that ring apart or does not; a sample lasts `dt` s.
    pub(crate) fn new(end: f64, closes: bool, dt: f64) -> Arrival {
        let calming = (CALMING / dt).round().max(1.0);
        let samples = (if closes { CLOSING } else { ARRIVAL } / dt).round().max(1.0);
        let steps = (samples as u32).min(STEPS);
        Arrival {
            end,
            calming: if closes { calming as u32 } else { 0 },
            share: libm::pow(LEFT, 1.0 / calming) as f32,
            whole: steps,
            steps,
            samples: (samples / f64::from(steps)).round() as u32,
            left: 0,
            rod: 0.0,
            shift: [[0.0; 3]; 2],
            places: [[0.0; 3]; 2],
            deviation: [[0.0; 3]; 2],
        }
    }

    /// Share of all ringing that is to be left in the next sample, if some is taken away.
    pub(crate) fn calms(&self) -> Option<f32> {
        (self.calming > 0).then_some(self.share)
    }
}
