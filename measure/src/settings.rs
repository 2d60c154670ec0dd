//! What is moved before a stroke, and which piece is meant.

use anyhow::Result;
use overhear_engine::kit::{Control, Kit};
use overhear_engine::kit_spec::{KitSpec, PieceSpec};
use overhear_engine::slot::Slot;

use crate::bad_input;

/// A parameter moved: its index and its value in its unit.
pub type Setting = (usize, f32);

/// A setting of a piece on its own: a control of the kit, in the engine's units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PieceSetting {
    /// Which.
    pub control: Control,
    /// In the control's own unit.
    pub value: f64,
}

impl PieceSetting {
    /// Moves it on a kit.
    pub fn apply(self, kit: &mut Kit) {
        kit.set(self.control, self.value);
    }
}

/// The slot and the piece of that name.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) naming every piece of the kit.
pub fn piece<'a>(kit: &'a KitSpec, name: &str) -> Result<(Slot, &'a PieceSpec)> {
    kit.find(name).ok_or_else(|| {
        let names: Vec<_> = kit.pieces.iter().map(|piece| &*piece.name).collect();
        bad_input!("no piece of the kit is called `{name}`, accepted: {}", names.join(", "))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_piece_that_the_kit_has_not_is_answered_with_those_it_has() {
        let kit = KitSpec::standard();
        assert_eq!(piece(&kit, "crash").unwrap().1.title, "Crash");
        let error = piece(&kit, "gong").unwrap_err().to_string();
        assert!(kit.pieces.iter().all(|piece| error.contains(&piece.name)), "{error}");
    }
}
