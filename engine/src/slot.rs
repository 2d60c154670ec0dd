//! Places in a kit: what controls, parameters, outputs and notes refer to.

/// Pieces that a kit can have.
pub const SLOTS: usize = 16;

/// A place in a kit: the position of a piece among the kit's pieces, from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Slot(u8);

impl Slot {
    /// Every slot, in order.
    pub const ALL: [Slot; SLOTS] = {
        let mut all = [Slot(0); SLOTS];
        let mut index = 0;
        while index < SLOTS {
            all[index] = Slot(index as u8);
            index += 1;
        }
        all
    };

    /// The slot of an index below [`SLOTS`].
    pub const fn new(index: usize) -> Option<Slot> {
        if index < SLOTS { Some(Slot(index as u8)) } else { None }
    }

    /// Its index, below [`SLOTS`].
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}
