//! What is told of a mode: its kind, its member of a pair, its numbers.

/// What kind of mode a row of [`Piece::modes`](crate::piece::Piece::modes) is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModeKind {
    /// A mode of the surface itself.
    Complete,
    /// One mode that stands for a slice of many.
    Sampled,
    /// A mode of the enclosed air.
    Cavity,
    /// The body moving as a whole on its stand.
    Rigid,
}

/// Which of the two modes of one order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Member {
    /// Shape proportional to `cos(m theta)`; the only one for `m = 0`.
    Cosine,
    /// Shape proportional to `sin(m theta)`.
    Sine,
}

impl Member {
    /// Shares of `cos(m theta)` and `sin(m theta)` in this member of a pair of `m` nodal diameters whose axes lie at `axis` (rad).
    pub fn around(self, m: u32, axis: f64) -> [f64; 2] {
        let (sin, cos) = (f64::from(m) * axis).sin_cos();
        match self {
            Member::Cosine => [cos, sin],
            Member::Sine => [-sin, cos],
        }
    }
}

/// One mode of a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeInfo {
    /// What vibrates: `batter`, `plate`, `stand`, ...
    pub body: &'static str,
    /// Nodal diameters.
    pub m: u32,
    /// Nodal circles; a membrane's rim counts, a plate's does not.
    pub n: u32,
    /// Member of the pair.
    pub member: Member,
    /// Damped frequency, Hz.
    pub frequency_hz: f64,
    /// Time to decay by 60 dB, s; infinite without losses.
    pub t60: f64,
    /// Modal mass with the air it carries, kg.
    pub modal_mass: f64,
    /// Radiated weight: area of the monopole that would radiate the mode's power, m2.
    pub radiation: f64,
    /// Kind of mode.
    pub kind: ModeKind,
}
