//! Notes as text.

use std::fmt::Write as _;

use overhear_engine::slot::Slot;

use crate::midi_map::{Foot, Meaning, NoteTable, Row, Stroke};

use super::super::text::{number, string};
use super::entry::{CHICK, HANDS, SPLASH};

/// Writes the notes of a slot's piece, and its controller.
pub(crate) fn write(text: &mut String, table: &NoteTable, slot: Slot) {
    if let Some(controller) = table.position_controller(slot) {
        let _ = writeln!(text, "position_controller = {controller}");
    }
    let ordinary = table.ordinary(slot);
    let (mut lines, mut strikes) = (String::new(), false);
    for (note, Row { name, meaning, pedal, wires, figure }) in table.rows() {
        let what = match *meaning {
            Meaning::Strikes(Stroke { slot: struck, radius, angle, striker }) if struck == slot => {
                let pedal = pedal.map_or(String::new(), |pedal| format!(", pedal = {}", number(pedal)));
                let wires = wires.map_or(String::new(), |wires| format!(", wires = {wires}"));
                let figure =
                    figure.map_or(String::new(), |figure| format!(", figure = {}", string(figure.name())));
                // The first stroke is the ordinary one if none says otherwise.
                let said = match (ordinary, strikes) {
                    (Some(ordinary), true) if ordinary == note => ", ordinary = true",
                    (None, _) => ", ordinary = false",
                    _ => "",
                };
                strikes = true;
                let (at, angle, stick) = (number(radius), number(angle), string(striker.name()));
                format!("at = {at}, angle_rad = {angle}, stick = {stick}{pedal}{wires}{figure}{said}")
            }
            Meaning::Steps(stepped, foot) if stepped == slot => match foot {
                Foot::Position(place) => format!("foot = {}", number(place)),
                Foot::Chick => format!("foot = {}", string(CHICK)),
                Foot::Splash => format!("foot = {}", string(SPLASH)),
            },
            Meaning::Chokes(_) | Meaning::Throws(..) if meaning.slot() == Some(slot) => {
                let known = HANDS.into_iter().find(|(_, hand)| hand(slot) == *meaning);
                known.map_or(String::new(), |(hand, _)| format!("hand = {}", string(hand)))
            }
            _ => continue,
        };
        let _ = writeln!(lines, "  {{ note = {note}, name = {}, {what} }},", string(name));
    }
    if !lines.is_empty() {
        let _ = writeln!(text, "notes = [\n{lines}]");
    }
}

/// Writes the notes that are in the table and silent.
pub(crate) fn write_silent(text: &mut String, table: &NoteTable) {
    let silent = table.rows().filter(|(_, row)| row.meaning == Meaning::Silent);
    let lines: String = silent.map(|(note, row)| format!("{note} = {}\n", string(&row.name))).collect();
    if !lines.is_empty() {
        let _ = write!(text, "\n# Notes without an instrument in the kit.\n[silent]\n{lines}");
    }
}
