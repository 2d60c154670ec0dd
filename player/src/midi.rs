//! From MIDI to strokes: what every note plays, and how controllers change it.
//!
//! ```text
//! note ──▶ the user's assignment ──▶ the instrument's map ──▶ reference note ──▶ stroke
//!            (one per note)         (General MIDI, Roland,     (the kit's table)
//!                                    Yamaha, Alesis, plain)
//! ```
//!
//! The [reference](crate::midi_map) table belongs to the kit and says what can be played on it: of the standard kit, the General
//! MIDI drum map and a few notes beyond it. The [`maps`] of other instruments and the user's own [`assignments`] name
//! reference notes, so that a stroke is described in one place only. [`playing`] adds velocity, position, unevenness and chokes;
//! [`document`] prints it all.

pub mod assignments;
pub mod document;
pub mod maps;
pub mod playing;
