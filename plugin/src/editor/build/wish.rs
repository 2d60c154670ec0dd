//! What a hand wants of the kit, and where that is done.

use overhear_engine::slot::Slot;
use overhear_player::kit_edits::features::Feature;
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
    Switch(Feature, bool),
    /// Another one of what chance makes.
    DrawAgain(Feature),
    /// To the right and toward the audience, m.
    Move(Slot, [f64; 2]),
    SaveKit(String),
    SavePiece(String),
    Open(String),
    AddFile(String),
}

/// A field of the piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Field {
    Size(Size),
    Part(Part),
    Feature(Feature),
}

impl Wish {
    /// The field that it was said at, if it was at one.
    pub fn field(&self) -> Option<Field> {
        match self {
            Wish::Resize(size, _) => Some(Field::Size(*size)),
            Wish::Fit(part, _) => Some(Field::Part(*part)),
            Wish::Switch(feature, _) | Wish::DrawAgain(feature) => Some(Field::Feature(*feature)),
            _ => None,
        }
    }
}

/// What a wish came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    pub words: String,
    /// Whether it was refused.
    pub refused: bool,
    /// The field that it is about.
    pub field: Option<Field>,
    /// The nearest size that works, SI units.
    pub nearest: Option<f64>,
}
