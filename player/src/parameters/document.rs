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
         Written from the tables in `player/src/parameters/` by `cargo xtask docs`; do not edit.\n\n\
         `--set name=value` and presets use the names, states and hosts the ids. Every value is a multiple of the step. \
         Parameters marked *built* act once the pieces they concern have been built anew, within seconds, and \
         are not automated; all others act from the next sample on, also while a piece rings.\n\n\
         A kit has up to 16 pieces, each in a slot of its own, and every slot has the same parameters. Below they have the \
         names, ranges and defaults of the standard kit; in another kit the names follow its pieces. A drum's tuning is \
         stored and automated in semitones from the drum's own pitch, -12 to 12 in steps of 1/1024, and shown and typed in \
         Hz. What a slot's piece does not have reads `-` and does nothing.\n",
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
        "Empty in the standard kit. Their parameters are named `{}` and so on until a kit has a piece there, and have the ids \
         {} and so on.",
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
        Drives::Control(CloseLevel) => "Level of the close microphones, at the pieces' own outputs too.",
        Drives::Control(Balance(_)) => "Balance of the pair of microphones.",
        Drives::Control(Mute(_)) => "The microphone is silent.",
        Drives::Control(Solo(_)) => "Only microphones with this are heard, if any has it.",
        Drives::Control(Hearing) => "Whether the drums hear the other pieces through the air.",
        Drives::Control(Sympathy) => "How much of the other pieces' sound reaches the drums.",
        Drives::Control(SafetyClip) => "Whether the mix bends softly instead of passing full scale; counted.",
        Drives::Control(Master) => "Level of the mix.",
        // No parameter of the whole kit: slots have their own.
        Drives::Control(Tuning(_) | Muffling(_) | Level(_) | Pan(_) | Preload(_) | Wires(_) | Pedal(_)) => "",
        Drives::Stand(_, Height) => "How much higher than usual the pair of microphones stands.",
        Drives::Stand(_, Depth) => "How much farther from the drummer than usual it stands.",
        Drives::Stand(_, Width) => "How far the two are apart, of what is usual.",
        Drives::Playing(manner) => playing(manner),
        Drives::Building(Quality) => "*Built.* Highest coupled cymbal mode during playback.",
        Drives::Building(OfflineQuality) => "*Built.* The same while the host renders to a file.",
        Drives::Building(Workers) => {
            "*Built.* Threads that render pieces beside the host's own. They change no sample, and look for work all \
             the while the kit sounds."
        }
    }
}

fn of_slot(what: SlotParameter) -> &'static str {
    match what {
        SlotParameter::Tune => "Pitch of the piece; glides over a few milliseconds.",
        SlotParameter::Muffle => "How much of what can muffle the piece lies on it.",
        SlotParameter::Level => "Level of the piece in every microphone and at its own output.",
        SlotParameter::Pan => "Place in the stereo, left to right; by default where the piece stands.",
        SlotParameter::Position => {
            "Moves strokes outward (above 0) or to the centre, by a share of the radius."
        }
        SlotParameter::Stick => "What is swung at the piece, if not what the note says.",
        SlotParameter::Preload => "Force that presses the snare wires on.",
        SlotParameter::Wires => "The strainer's lever.",
        SlotParameter::Pedal => {
            "The hi-hat's pedal, 0 up and open, 1 down and clamped; a foot takes it there."
        }
    }
}

fn playing(manner: Manner) -> &'static str {
    match manner {
        Manner::Dynamics => "Stick speed of a note at full velocity.",
        Manner::Curve => "Exponent of the velocity curve: above 1 soft notes become softer.",
        Manner::PositionSpread => {
            "How far strokes land from where they are aimed, on average, of the radius."
        }
        Manner::SpeedSpread => "How far strokes are from the speed asked for, on average.",
        Manner::Map => "The instrument that sends the notes; see `docs/midi.md`.",
        Manner::Channel => "The only MIDI channel heard.",
        Manner::Chokes => "What lets a hand grip a cymbal: pressure on a note, its end, or both.",
        Manner::FollowsPosition => "Whether controllers 16 to 19 say where strokes land.",
        Manner::FollowsPrograms => "Whether program changes load presets; see `docs/midi.md`.",
    }
}
