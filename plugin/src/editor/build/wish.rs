//! What a hand wants of the kit.

use overhear_engine::slot::Slot;
use overhear_player::kit_edits::sizes::Size;
use overhear_player::kit_file::parts::Part;

/// What a hand wants.
#[derive(Debug, Clone, PartialEq)]
pub enum Wish {
    Add(&'static str),
    Exchange(&'static str),
    Duplicate,
    Remove,
    Kit(&'static str),
    Resize(Size, f64),
    Fit(Part, Option<&'static str>),
    /// To the right and toward the audience, m.
    Move(Slot, [f64; 2]),
    SaveKit(String),
    SavePiece(String),
    Open(String),
    AddFile(String),
}
