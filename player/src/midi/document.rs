//! The manual's page of notes and controllers, written from the tables.

use std::fmt::Write as _;

use super::maps::NoteMap;
use super::playing::{
    FINE_VELOCITY_CONTROLLER, NOTES_OFF_CONTROLLER, PEDAL_CONTROLLER, SOUND_OFF_CONTROLLER,
    STRAINER_CONTROLLER, THROW_OFF_CONTROLLER,
};
use crate::kit_document::KitDocument;
use crate::midi_map::{Meaning, POSITION_CONTROLLERS, Row};
use crate::presets::FACTORY;

/// The page, in Markdown. `cargo xtask docs` writes it; a test compares.
pub fn document() -> String {
    let document = KitDocument::standard();
    let mut page = String::from(
        "# MIDI\n\n\
         `cargo xtask docs` writes this page from the tables in `player/src/midi_map.rs` and `player/src/midi/`; do \
         not edit it.\n\n## Notes\n\n\
         A kit defines what its notes play. The standard kit plays the General MIDI drum map and a few additional notes. \
         Maps of other instruments and your own assignments (`[notes]` in presets, the MIDI page of the editor) refer to \
         notes of the kit.\n\n\
         | note | name | piece | position | stick |\n|---|---|---|---|---|\n",
    );
    for (note, row) in document.notes.rows() {
        page.push_str(&reference_row(&document, note, row));
    }
    page.push_str("\nAll other notes are silent.\n");
    page.push_str(MAPS);
    for (map, name) in NoteMap::ALL.into_iter().zip(NoteMap::NAMES) {
        let Some(pads) = map.pads() else { continue };
        let _ = write!(page, "\n## Map `{name}`\n\n| note | pad | plays |\n|---|---|---|\n");
        let mut pads = pads.to_vec();
        pads.sort_by_key(|pad| pad.note);
        for pad in pads {
            let _ = writeln!(page, "| {} | {} | {} |", pad.note, pad.name, pad.plays);
        }
    }
    page.push_str(&controllers(&document));
    page.push_str(CALIBRATION);
    page.push_str(&programs());
    page
}

fn reference_row(document: &KitDocument, note: u8, row: &Row) -> String {
    let Row { name, meaning, .. } = row;
    let piece = |slot| document.kit.piece(slot).map_or("", |piece| &piece.name);
    match meaning {
        Meaning::Strikes(stroke) => {
            let (piece, with) = (piece(stroke.slot), stroke.striker.name());
            format!("| {note} | {name} | {piece} | {:.2} of the radius | {with} |\n", stroke.radius)
        }
        Meaning::Steps(slot, _) => format!("| {note} | {name} | {} | the pedal | a foot |\n", piece(*slot)),
        Meaning::Chokes(slot) => format!("| {note} | {name} | {} | a hand on the edge | |\n", piece(*slot)),
        Meaning::Throws(slot, on) => {
            let throw = if *on { "on" } else { "off" };
            format!("| {note} | {name} | {} | wires thrown {throw} | |\n", piece(*slot))
        }
        Meaning::Silent => format!("| {note} | {name} | silent: the kit has no such instrument | | |\n"),
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
         Numbers count from 0. A program change sets every parameter of the preset at its sample, unless \
         `program_changes` is off or the channel is not played; the host is notified. A kit in the preset is ignored, \
         because it would have to be built. Your own presets are numbered when \
         an instance is first activated. Only CLAP hosts send program changes: VST3 has none among its events, and the \
         standalone program ignores them.",
        FACTORY.len()
    );
    text
}

fn controllers(document: &KitDocument) -> String {
    let mut text = String::from("\n## Controllers and pressure\n\n| message | what it does |\n|---|---|\n");
    let _ = writeln!(
        text,
        "| CC {PEDAL_CONTROLLER} | the pedal of every hi-hat: 0 up, 127 down; closed and open notes take its position where it agrees with the note, and otherwise the note's |"
    );
    for controller in POSITION_CONTROLLERS {
        let moved = |slot| document.notes.position_controller(slot) == Some(controller);
        let pieces = document.kit.slots().filter(|(slot, _)| moved(*slot));
        let pieces: Vec<&str> = pieces.map(|(_, piece)| &*piece.name).collect();
        let _ = writeln!(
            text,
            "| CC {controller} | position of the next strokes on {}: 0 is the centre (on a cymbal the bow next to the \
             bell), 127 the rim |",
            pieces.join(", "),
        );
    }
    let _ = writeln!(
        text,
        "| CC {FINE_VELOCITY_CONTROLLER} | lower seven bits of the next note's velocity on its channel |"
    );
    let _ = writeln!(
        text,
        "| CC {STRAINER_CONTROLLER} | force of the strainer that presses snare wires on, from the weakest to the strongest, until the \
         parameter moves |\n| CC {THROW_OFF_CONTROLLER} | throw-off of the snare wires: off below 64 |"
    );
    let _ = writeln!(
        text,
        "| CC {SOUND_OFF_CONTROLLER}, CC {NOTES_OFF_CONTROLLER} | all sound off, all notes off: everything that sounds \
         ends within ten milliseconds, cymbals included; pedals stay where they are |"
    );
    text.push_str(
        "| poly pressure | chokes the cymbal of that note or lays a hand on the head of that drum, in proportion to the pressure and \
         for as long as it lasts, if `chokes` allows it |\n\
         | note off | chokes the cymbal until its next stroke, if `chokes` allows it |\n\
         | choke (CLAP) | chokes the cymbal until its next stroke, always; a choke of any note chokes every cymbal |\n\
         | brightness of a note | position of its stroke, as with the controllers above, when it comes with the note; later \
         that of the next strokes on the piece until the note ends |\n\
         | volume, pan of a note | scale the struck piece in all microphones and move its close one aside, until its next \
         stroke |\n\
         | pressure of a note | as poly pressure |\n\
         | tuning of a note | bends the struck piece by so many semitones, within the piece's range and until its \
         next stroke |\n\n\
         Expressions act from their sample on, whether the host names the note by its number or by its id alone (CLAP, \
         VST3). CLAP hosts are told when a note has ended: with the next stroke on its piece, or when the piece is silent.\n\n\
         Controllers move strokes with a tip on a head or a bow; cross-sticks, rimshots, bells and edges keep \
         their positions. A value holds until the next one or until the host resets the plugin.\n",
    );
    text
}

/// What is said of all maps.
const MAPS: &str = "\n## Modules\n\n\
    The parameter `note_map` chooses the module that is played. `roland` is that of the TD-17, TD-27, TD-50, V51 and V71, \
    `yamaha` of the DTX, `alesis` of the Nitro. The notes of `efnote`, `edrumin` and `megadrum` are assumed: such modules send what \
    they are set to. The MIDI page of the editor shows what arrives; a note that differs is learned there. Brushes are \
    played with the softest mallet, as nothing in the kit sweeps.\n";

/// What is said of calibration.
const CALIBRATION: &str = "\n## Calibration\n\n\
    The page MIDI, Calibration shows every message with its time and learns pads and the pedal:\n\n\
    * **A pad**: strike it softly, hard and in between, one stroke at a time. Its softest and hardest velocities become 1 and 127, \
    its middle one the middle. A second note within the retrigger time is dropped; it is learned from double triggers, and 0 without \
    any. A soft note within 12 ms of a louder one on another pad is crosstalk and dropped if it is below a share of the other's \
    velocity.\n\
    * **The pedal**: leave it up for a moment, then press and release it some times. Its ends become up and down, inverted ones too. \
    Where note 44 sounds the hats are closed (0.8 of the way), and the shallowest press that lasts less than 0.2 s makes them \
    meet (0.6). Readings that tremble are held still. A pedal that hardly moves is stuck: it is not listened to, and notes open and \
    close the hats.\n\n\
    All of it can be corrected by hand, undone, and used with the keyboard alone. It is stored with the project. Times are counted in \
    samples, so that a bounce drops what playing drops.\n";
