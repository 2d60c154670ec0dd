//! From MIDI to strokes: what every note plays, and how controllers change it.
//!
//! ```text
//! note ──▶ calibration ──▶ the user's assignment ──▶ the instrument's map ──▶ reference note ──▶ stroke
//!            (one per note)         (General MIDI, Roland,     (the kit's table)
//!                                    Yamaha, Alesis, plain)
//! ```
//!
//! The [reference](crate::midi_map) table belongs to the kit and says what can be played on it: of the standard kit, the General
//! MIDI drum map and a few notes beyond it. The [`maps`] of other instruments and the user's own [`assignments`] name
//! reference notes, so that a stroke is described in one place only. [`playing`] adds velocity, position, unevenness and chokes;
//! [`calibration`] says what a player's pads and pedal mean by what they send, [`learning`] finds it out, and
//! [`document`] prints it all.

pub mod assignments;
pub mod calibration;
pub mod document;
pub mod expressions;
pub mod figures;
pub mod learning;
pub mod maps;
pub mod playing;
