//! The manual's page of parameters, written from the table.

use std::fmt::Write as _;

use overhear_engine::kit_spec::KitSpec;
use overhear_engine::slot::Slot;

use super::in_kit::{default_value, is_live, name, range, text};
use super::list::{SLOT_COUNT, parameters, slot_index};
use super::parameter::{Drives, Manner, Parameter, SlotParameter};
use super::slot::number;

/// The page, in Markdown. `cargo xtask docs` writes it; a test compares.
pub fn document() -> String {
    let kit = KitSpec::standard();
    let mut page = String::from(
        "# Parameters\n\n\
         `cargo xtask docs` writes this page from the tables in `player/src/parameters/`; do not edit it.\n\n\
         `--set name=value` and presets use the names; states and hosts use the ids. Every value is a multiple of the \
         step. Parameters marked *built* act after the affected pieces have been rebuilt, within seconds, and \
         cannot be automated. All others act from the next sample on, also while a piece rings.\n\n\
         A kit has up to 16 pieces, each in its own slot, and every slot has the same parameters. This page shows the \
         names, ranges and defaults of the standard kit; in another kit the names follow its pieces. A drum's tuning is \
         stored and automated in semitones from the drum's own pitch, -12 to 12 in steps of 1/1024, and shown and typed in \
         Hz. Parameters that do not apply to a slot's piece read `-` and do nothing.\n",
    );
    for (slot, piece) in kit.slots() {
        page.push_str(&heading(&piece.title));
        let of_slot = SlotParameter::ALL.map(|what| slot_index(slot, what));
        for index in of_slot.into_iter().filter(|&index| is_live(index, &kit)) {
            page.push_str(&row(index, &kit));
        }
    }
    page.push_str(&empty_slots(&kit));
    let mut groups: Vec<&str> = Vec::new();
    for parameter in &parameters()[SLOT_COUNT..] {
        if !groups.contains(&parameter.group) {
            groups.push(parameter.group);
        }
    }
    for group in groups {
        page.push_str(&heading(group));
        for index in (SLOT_COUNT..parameters().len()).filter(|&index| parameters()[index].group == group) {
            page.push_str(&row(index, &kit));
        }
    }
    page
}

fn heading(group: &str) -> String {
    format!(
        "\n## {group}\n\n| name | id | range | default | step | what it does |\n|---|---|---|---|---|---|\n"
    )
}

/// The slots in which the standard kit has nothing.
fn empty_slots(kit: &KitSpec) -> String {
    let mut empty = Slot::ALL.into_iter().filter(|&slot| kit.piece(slot).is_none());
    let (Some(first), Some(last)) = (empty.next(), empty.next_back()) else { return String::new() };
    let ids = SlotParameter::ALL.map(|what| format!("`{}`", parameters()[slot_index(first, what)].id));
    let mut text = format!("\n## Slots {} to {}\n\n", number(first), number(last));
    let _ = writeln!(
        text,
        "These slots are empty in the standard kit. Their parameters are named `{}` and so on until a kit has a piece \
         there. Their ids are {} and so on.",
        name(slot_index(first, SlotParameter::Tune), kit),
        ids.join(", ")
    );
    text
}

fn row(index: usize, kit: &KitSpec) -> String {
    let parameter = &parameters()[index];
    let Parameter { name, id, choices, .. } = *parameter;
    let (min, max, unit) = range(index, kit);
    let (range, step) = if choices.is_empty() {
        let text =
            |value: f32| if parameter.unit == unit { parameter.text(value) } else { value.to_string() };
        let steps = if parameter.unit == unit {
            format!("{}", (parameter.step * 1e5).round() / 1e5)
        } else {
            String::new()
        };
        (format!("{} to {}{unit}", text(min), text(max)), steps)
    } else {
        (choices.join(", "), String::new())
    };
    let default = text(index, default_value(index, kit), kit);
    format!("| `{name}` | `{id}` | {range} | {default} | {step} | {} |\n", about(parameter))
}

/// One sentence about what a parameter does.
pub fn about(parameter: &Parameter) -> &'static str {
    use super::parameter::{Construction::*, Stand::*};
    use overhear_engine::kit::Control::*;
    match parameter.drives {
        Drives::Slot(_, what) => of_slot(what),
        Drives::Control(MicrophoneLevel(_)) => "Level of the pair of microphones in the mix.",
        Drives::Control(CloseLevel) => {
            "Level of the close microphones in the mix and at the pieces' outputs."
        }
        Drives::Control(Balance(_)) => "Balance of the pair of microphones, left to right.",
        Drives::Control(Mute(_)) => "Mutes the microphone.",
        Drives::Control(Solo(_)) => "If any microphone has solo, only those with solo are in the mix.",
        Drives::Control(SympatheticCoupling) => "Whether the drums respond to the sound of the other pieces.",
        Drives::Control(Sympathy) => "Share of the other pieces' sound that reaches the drums.",
        Drives::Control(SafetyClip) => "Clips softly what exceeds full scale; the samples are counted.",
        Drives::Control(Master) => "Level of the mix.",
        // No parameter of the whole kit: slots have their own.
        Drives::Control(Tuning(_) | Muffling(_) | Level(_) | Pan(_) | Preload(_) | Wires(_) | Pedal(_)) => "",
        Drives::Stand(_, Height) => "Height of the pair of microphones above its default position.",
        Drives::Stand(_, Depth) => "Distance of the pair from its default position, away from the drummer.",
        Drives::Stand(_, Width) => "Distance between the two microphones, relative to the default.",
        Drives::Playing(manner) => playing(manner),
        Drives::Building(Quality) => "*Built.* Highest coupled cymbal mode during playback.",
        Drives::Building(OfflineQuality) => {
            "*Built.* Highest coupled cymbal mode while the host renders offline."
        }
        Drives::Building(Workers) => {
            "*Built.* Additional threads that render pieces. They change no sample, and poll for work while the kit \
             sounds."
        }
    }
}

fn of_slot(what: SlotParameter) -> &'static str {
    match what {
        SlotParameter::Tune => "Pitch of the piece; glides over a few milliseconds.",
        SlotParameter::Muffle => "Amount of muffling: 0 is none, 1 is all of the piece's muffler.",
        SlotParameter::Level => "Level of the piece in every microphone and at its own output.",
        SlotParameter::Pan => "Stereo position, left to right; the default is the piece's position.",
        SlotParameter::Position => {
            "Moves strokes outward (above 0) or toward the centre, relative to the radius."
        }
        SlotParameter::Stick => "Stick that strikes the piece; `as mapped` uses the stick of the note.",
        SlotParameter::Preload => "Force that presses the snare wires against the head.",
        SlotParameter::Wires => "Strainer of the snare wires: on, or thrown off.",
        SlotParameter::Pedal => {
            "Hi-hat pedal: 0 is up and open, 1 is down and clamped. It moves as a foot would move it."
        }
    }
}

fn playing(manner: Manner) -> &'static str {
    match manner {
        Manner::Dynamics => "Speed of the stick for a note at full velocity.",
        Manner::Curve => "Exponent of the velocity curve; above 1 soft notes become softer.",
        Manner::PositionSpread => {
            "Average distance of strokes by hand from their intended position, relative to the radius; hands alternate."
        }
        Manner::SpeedSpread => "Average deviation of strokes from their intended speed.",
        Manner::Map => "Instrument that sends the notes; see `docs/midi.md`.",
        Manner::Channel => "MIDI channel that is played.",
        Manner::Chokes => "What chokes a cymbal: pressure on its note, the end of the note, or both.",
        Manner::FollowsPosition => "Whether controllers 16 to 19 set the strike position.",
        Manner::FollowsPrograms => "Whether program changes load presets; see `docs/midi.md`.",
    }
}
