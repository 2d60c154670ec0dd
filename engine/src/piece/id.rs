//! The pieces there are.

/// Which piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum PieceId {
    /// 22 x 18 in bass drum.
    Kick,
    /// 14 x 5.5 in snare drum.
    Snare,
    /// 12 x 9 in rack tom.
    RackTom,
    /// 16 x 16 in floor tom.
    FloorTom,
    /// 16 in crash cymbal.
    Crash,
    /// 20 in ride cymbal.
    Ride,
    /// 10 in splash cymbal.
    Splash,
    /// 26 in timpani.
    Timpani,
    /// 14 in hi-hat.
    HiHat,
}

impl PieceId {
    /// The pieces of the kit, in the order of every per-piece table.
    pub const KIT: [PieceId; 9] = [
        PieceId::Kick,
        PieceId::Snare,
        PieceId::RackTom,
        PieceId::FloorTom,
        PieceId::Crash,
        PieceId::Ride,
        PieceId::Splash,
        PieceId::Timpani,
        PieceId::HiHat,
    ];

    /// Every piece that can be built.
    pub const ALL: [PieceId; 9] = PieceId::KIT;

    /// The same, what takes longest to build first, so that nobody who builds side by side waits for the last. *Measured*.
    pub const LONGEST_FIRST: [PieceId; 9] = [
        PieceId::Kick,
        PieceId::Timpani,
        PieceId::Ride,
        PieceId::FloorTom,
        PieceId::HiHat,
        PieceId::Crash,
        PieceId::RackTom,
        PieceId::Snare,
        PieceId::Splash,
    ];

    /// Place in [`PieceId::KIT`], if the piece belongs to the kit.
    pub fn slot(self) -> Option<usize> {
        PieceId::KIT.iter().position(|&id| id == self)
    }

    /// The name used on command lines, in presets and on screen.
    pub fn name(self) -> &'static str {
        match self {
            PieceId::Kick => "kick",
            PieceId::Snare => "snare",
            PieceId::RackTom => "rack-tom",
            PieceId::FloorTom => "floor-tom",
            PieceId::Crash => "crash",
            PieceId::Ride => "ride",
            PieceId::Splash => "splash",
            PieceId::Timpani => "timpani",
            PieceId::HiHat => "hi-hat",
        }
    }

    /// The piece of that [`name`](Self::name), if there is one.
    pub fn from_name(name: &str) -> Option<PieceId> {
        PieceId::ALL.into_iter().find(|id| id.name() == name)
    }

    /// Whether the piece is a drum (it has a pitch to tune); the others are cymbals.
    pub fn is_drum(self) -> bool {
        !matches!(self, PieceId::Crash | PieceId::Ride | PieceId::Splash | PieceId::HiHat)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_built_longest_first_is_the_whole_kit() {
        let mut pieces = PieceId::LONGEST_FIRST;
        pieces.sort();
        let mut kit = PieceId::KIT;
        kit.sort();
        assert_eq!(pieces, kit);
    }
}
