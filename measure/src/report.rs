//! Pages of measured figures: tables in Markdown and their plots.
//!
//! Each page is a module: it measures, and hands back a [`Page`]. The same sources give the same pages, byte by byte, on
//! one machine. Every figure says what it was measured on: the standard kit, or a named reference. What pages measure is
//! open to the tests, which hold the same figures to the same bounds.

pub mod cascade;
pub mod contact;
pub mod cymbal;
pub mod drums;
pub mod glide;
pub mod heads;
pub mod hi_hat;
pub mod hi_hat_notes;
pub mod kit;
mod mechanisms;
pub mod modal;
pub mod page;
mod plate;
pub mod plot;
pub mod radiation;
mod realism;
pub mod snare;

use anyhow::Result;

pub use page::{Claim, Page, Sheet};

/// Measures a page.
pub type Measure = fn() -> Result<Page>;

/// Every page that depends on the sources alone, in reading order: its name and what measures it.
pub const PAGES: [(&str, Measure); 15] = [
    ("modal", modal::page),
    ("contact", contact::page),
    ("heads", heads::page),
    ("glide", glide::page),
    ("drums", drums::page),
    ("snare", snare::page),
    ("mechanisms", mechanisms::page),
    ("plate", plate::page),
    ("cymbal", cymbal::page),
    ("cascade", cascade::page),
    ("hi-hat", hi_hat::page),
    ("hi-hat-notes", hi_hat_notes::page),
    ("radiation", radiation::page),
    ("kit", kit::page),
    ("realism", realism::page),
];
