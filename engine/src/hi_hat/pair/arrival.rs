//! State of a foot on its way to where a note wants it. The model is that of `hi_hat/arriving.rs`.

use crate::hi_hat::foot::Step;
use crate::hi_hat::rigid::Weights;

/// Longest time from the note to the end of the foot's way, s: that of a foot that opens. *Converged*: in a third of it the
/// release of closed cymbals is as loud as a soft stroke. It is less than the 5 ms in which a note has to sound as it is named.
pub const ARRIVAL: f64 = 3e-3;

/// Most equilibria on the way. *Converged*: with 6, opening after a soft stroke is 8 dB louder, by the steps alone.
const STEPS: u32 = 24;

/// A foot on its way to where a note wants it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Arrival {
    /// Goal of the rod, m.
    pub(crate) end: f64,
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
    /// What the foot does then.
    pub(crate) step: Option<Step>,
}

impl Arrival {
    /// To `end` (m), and the step from there; a sample lasts `dt` s.
    pub(crate) fn new((end, step): (f64, Option<Step>), dt: f64) -> Arrival {
        let samples = (ARRIVAL / dt).round().max(1.0);
        let steps = (samples as u32).min(STEPS);
        Arrival {
            end,
            whole: steps,
            steps,
            samples: (samples / f64::from(steps)).round() as u32,
            left: 0,
            rod: 0.0,
            shift: [[0.0; 3]; 2],
            places: [[0.0; 3]; 2],
            deviation: [[0.0; 3]; 2],
            step,
        }
    }
}
