//! Arrangement: everything of a kit that is neither a piece nor a control, to be exchanged while it plays.

use super::room::Tail;
use crate::kit_spec::KitSpec;
use crate::kit_spec::room::RoomSpec;
use crate::layout::Layout;
use crate::piece::Piece;
use crate::slot::SLOTS;

/// Where everything is to stand and in which room, worked out beforehand: built by any thread, taken over by the kit's own,
/// dropped by any other.
pub struct Arrangement {
    pub(super) layout: Layout,
    pub(super) room: RoomSpec,
    pub(super) tail: Tail,
    /// Pieces of slots that become empty, once they are inaudible.
    pub(super) removed: [Option<Box<Piece>>; SLOTS],
}

impl Arrangement {
    /// That of a description, at the kit's sample rate, Hz. Allocates.
    pub fn new(sample_rate: f64, spec: &KitSpec) -> Arrangement {
        Arrangement {
            layout: spec.layout(),
            room: spec.room,
            tail: Tail::new(&spec.room, sample_rate),
            removed: Default::default(),
        }
    }
}
