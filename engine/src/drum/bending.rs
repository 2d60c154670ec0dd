//! How the modes of a drum bend its heads: by their shares in the heads' own modes, and the wavenumbers of these.

use crate::drum::heads::TunedHead;
use crate::drum::modes::DrumModes;
use crate::drum::tuned::{PitchPosition, TunedMode};
use crate::potential::HEADS;

/// Sums over the shares of a mode, per square of its displacement.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bending {
    /// Of squares of shares times wavenumbers: `S` of the [stretch](super::stretch) by this mode alone, 1/m2, `[head]`.
    pub squares: [f64; HEADS],
    /// Of squares of the struck head's shares, dimensionless.
    pub held: f64,
}

impl Bending {
    /// Of a mode (or a member of a pair) of the even drum.
    pub fn of(drum: &DrumModes, mode: &TunedMode, place: &PitchPosition) -> Bending {
        let mut bending = Bending::default();
        for (far, head) in heads(drum).enumerate() {
            for (share, wave) in shares(drum, (head, far > 0), mode, place) {
                bending.squares[far] += (share * wave).powi(2);
                bending.held += if far == 0 { share * share } else { 0.0 };
            }
        }
        bending
    }

    /// The wavenumber on the struck head, 1/m: the root of the mean square, weighted by the shares.
    pub fn wave(&self) -> f64 {
        if self.held > 0.0 { (self.squares[0] / self.held).sqrt() } else { 0.0 }
    }
}

/// The heads, the struck one first.
pub fn heads(drum: &DrumModes) -> impl Iterator<Item = &TunedHead> {
    [Some(&drum.heads.batter), drum.heads.resonant.as_ref()].into_iter().flatten()
}

/// Shares of a drum's mode in those of a head (which may be the far one), dimensionless, and the wavenumbers of these, 1/m.
pub fn shares(
    drum: &DrumModes,
    (head, far): (&TunedHead, bool),
    mode: &TunedMode,
    place: &PitchPosition,
) -> impl Iterator<Item = (f64, f64)> {
    let (first, count) = head.order(mode.m);
    let skip = if far { drum.heads.batter.order(mode.m).1 } else { 0 };
    let radius = head.membrane.spec().radius;
    let modes = head.membrane.modes()[first..first + count].iter().enumerate();
    modes.map(move |(i, bare)| (mode.share(skip + i, place), bare.zero / radius))
}
