//! The manual's page of notes and controllers, written from the tables.

use std::fmt::Write as _;

use super::maps::NoteMap;
use super::playing::{FINE_VELOCITY_CONTROLLER, PEDAL_CONTROLLER, position_controller};
use crate::midi_map::{BEYOND, MAP, Meaning, Row};
use crate::presets::FACTORY;
use overhear_engine::piece::PieceId;

/// The page, in Markdown. `cargo xtask docs` writes it; a test compares.
pub fn document() -> String {
    let mut page = String::from(
        "# MIDI\n\n\
         Written from the tables in `plugin/src/midi_map.rs` and `plugin/src/midi/` by `cargo xtask docs`; do \
         not edit.\n\n## Notes\n\n\
         The reference notes are the General MIDI drum map and a few beyond it. Maps of other instruments and \
         your own assignments (`[notes]` in presets, the panel in the editor) name reference notes.\n\n\
         | note | name | struck | place | with |\n|---|---|---|---|---|\n",
    );
    for row in MAP.iter().chain(&BEYOND) {
        page.push_str(&reference_row(row));
    }
    page.push_str("\nAll other notes are silent.\n");
    for (map, name) in NoteMap::ALL.into_iter().zip(NoteMap::NAMES) {
        let Some(pads) = map.pads() else { continue };
        let _ = write!(page, "\n## Map `{name}`\n\n| note | pad | plays |\n|---|---|---|\n");
        let mut pads = pads.to_vec();
        pads.sort_by_key(|pad| pad.note);
        for pad in pads {
            let _ = writeln!(page, "| {} | {} | {} |", pad.note, pad.name, pad.plays);
        }
    }
    page.push_str(&controllers());
    page.push_str(&programs());
    page
}

fn reference_row(row: &Row) -> String {
    let Row { note, name, meaning } = row;
    match meaning {
        Meaning::Strikes(stroke) => {
            let (piece, with) = (stroke.piece.name(), stroke.striker.name());
            format!("| {note} | {name} | {piece} | {:.2} of the radius | {with} |\n", stroke.radius)
        }
        Meaning::Steps(_) => format!("| {note} | {name} | hi-hat | the pedal | a foot |\n"),
        Meaning::Silent(reason) => format!("| {note} | {name} | silent: {reason} | | |\n"),
    }
}

fn programs() -> String {
    let mut text = String::from("\n## Program changes\n\n| program | preset |\n|---|---|\n");
    for (number, (name, _)) in FACTORY.iter().enumerate() {
        let _ = writeln!(text, "| {number} | {name} |");
    }
    let _ = writeln!(
        text,
        "| from {} | your own presets by name, as `cargo xtask presets list` shows them |\n\n\
         Numbers count from 0. A program change moves every parameter that the preset sets at its sample, unless \
         `program_changes` is off or the channel is not heard; the host is told. Your own presets are numbered when \
         an instance is first activated. CLAP hosts only: VST3 has no program changes among its events, and the program \
         without a host ignores them.",
        FACTORY.len()
    );
    text
}

fn controllers() -> String {
    let mut text = String::from("\n## Controllers and pressure\n\n| message | what it does |\n|---|---|\n");
    let _ = writeln!(
        text,
        "| CC {PEDAL_CONTROLLER} | the hi-hat's pedal: 0 up, 127 down; from the first one on notes leave it where it is |"
    );
    for controller in 16..=19 {
        let pieces = PieceId::KIT.into_iter().filter(|&piece| position_controller(piece) == Some(controller));
        let pieces: Vec<&str> = pieces.map(PieceId::name).collect();
        let _ = writeln!(
            text,
            "| CC {controller} | place of the next strokes on {}: 0 the centre (a cymbal's bow by the bell), 127 the \
             rim |",
            pieces.join(", "),
        );
    }
    let _ = writeln!(
        text,
        "| CC {FINE_VELOCITY_CONTROLLER} | lower seven bits of the next note's velocity on its channel |"
    );
    text.push_str(
        "| poly pressure | a hand on the cymbal of that note, as firmly as the pressure, if `chokes` says so |\n\
         | note off | a hand on the cymbal until its next stroke, if `chokes` says so |\n\
         | choke (CLAP) | the same, always |\n\
         | brightness of a note | place of its stroke, as with the controllers above, when it comes with the note |\n\
         | tuning of a note | bends what the note strikes by so many semitones, within the piece's range and until its \
         next stroke |\n\n\
         Controllers move strokes with a tip on a head or a bow; cross-sticks, rimshots, bells and edges stay \
         where they are. They hold until the next value or until the host resets the plugin.\n",
    );
    text
}
