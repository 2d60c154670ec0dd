//! The manual's page of parameters, written from the table.

use std::fmt::Write as _;

use super::{Drives, Manner, PARAMETERS, Parameter};

/// The page, in Markdown. `cargo xtask docs` writes it; a test compares.
pub fn document() -> String {
    let mut page = String::from(
        "# Parameters\n\n\
         Written from the table in `plugin/src/parameters/table.rs` by `cargo xtask docs`; do not edit.\n\n\
         `--set name=value` and presets use the names, states the ids. Every value is a multiple of the step. \
         Parameters marked *built* act once the pieces they concern have been built anew, within seconds, and \
         are not automated; all others act from the next sample on, also while a piece rings.\n",
    );
    let mut groups: Vec<&str> = Vec::new();
    for parameter in &PARAMETERS {
        if !groups.contains(&parameter.group) {
            groups.push(parameter.group);
        }
    }
    for group in groups {
        let _ = write!(page, "\n## {group}\n\n| name | id | range | default | step | what it does |\n");
        page.push_str("|---|---|---|---|---|---|\n");
        for parameter in PARAMETERS.iter().filter(|parameter| parameter.group == group) {
            page.push_str(&row(parameter));
        }
    }
    page
}

fn row(parameter: &Parameter) -> String {
    let Parameter { name, id, unit, min, max, default, step, choices, .. } = *parameter;
    let text = |value| parameter.text(value);
    let (range, step) = if choices.is_empty() {
        (format!("{} to {}{unit}", text(min), text(max)), format!("{}", (step * 1e5).round() / 1e5))
    } else {
        (choices.join(", "), String::new())
    };
    let about = about(parameter);
    format!("| `{name}` | `{id}` | {range} | {}{unit} | {step} | {about} |\n", text(default))
}

/// One sentence about what a parameter does.
pub fn about(parameter: &Parameter) -> &'static str {
    use super::{Construction::*, Control::*, Stand::*};
    match parameter.drives {
        Drives::Control(Tuning(_)) => "Pitch of the drum; glides over a few milliseconds.",
        Drives::Semitones(_) => "Pitch of the cymbal from its own.",
        Drives::Control(Muffling(_)) => "How much of what can muffle the piece lies on it.",
        Drives::Control(Level(_)) => "Level of the piece in every microphone and at its own output.",
        Drives::Control(Pan(_)) | Drives::Percent(_) => {
            "Place in the stereo, left to right; by default where the piece stands."
        }
        Drives::Control(MicrophoneLevel(_)) => "Level of the pair of microphones in the mix.",
        Drives::Control(CloseLevel) => "Level of the close microphones, at the pieces' own outputs too.",
        Drives::Control(Balance(_)) => "Balance of the pair of microphones.",
        Drives::Control(Mute(_)) => "The microphone is silent.",
        Drives::Control(Solo(_)) => "Only microphones with this are heard, if any has it.",
        Drives::Control(Hearing) => "Whether the drums hear the other pieces through the air.",
        Drives::Control(Sympathy) => "How much of the other pieces' sound reaches the drums.",
        Drives::Control(SafetyClip) => "Whether the mix bends softly instead of passing full scale; counted.",
        Drives::Control(Master) => "Level of the mix.",
        Drives::Control(SnarePreload) => "Force that presses the snare wires on.",
        Drives::Control(SnareWires) => "The strainer's lever.",
        Drives::Control(Pedal) => {
            "The hi-hat's pedal, 0 up and open, 1 down and clamped; a foot takes it there."
        }
        Drives::Stand(_, Height) => "How much higher than usual the pair of microphones stands.",
        Drives::Stand(_, Depth) => "How much farther from the drummer than usual it stands.",
        Drives::Stand(_, Width) => "How far the two are apart, of what is usual.",
        Drives::Playing(manner) => playing(manner),
        Drives::Building(Quality) => "*Built.* How far up cymbals' modes are coupled while the host plays.",
        Drives::Building(OfflineQuality) => "*Built.* The same while the host renders to a file.",
        Drives::Building(Workers) => {
            "*Built.* Threads that render pieces beside the host's own. They change no sample, and look for work all \
             the while the kit sounds."
        }
        Drives::Building(ResonantRatio(_)) => "*Built.* Pitch of the resonant head over the batter head's.",
    }
}

fn playing(manner: Manner) -> &'static str {
    match manner {
        Manner::Dynamics => "Stick speed of a note at full velocity.",
        Manner::Curve => "Exponent of the velocity curve: above 1 soft notes become softer.",
        Manner::PlaceSpread => "How far strokes land from where they are aimed, on average, of the radius.",
        Manner::SpeedSpread => "How far strokes are from the speed asked for, on average.",
        Manner::Map => "The instrument that sends the notes; see `docs/midi.md`.",
        Manner::Channel => "The only MIDI channel heard.",
        Manner::Chokes => "What lets a hand grip a cymbal: pressure on a note, its end, or both.",
        Manner::FollowsPosition => "Whether controllers 16 to 19 say where strokes land.",
        Manner::FollowsPrograms => "Whether program changes load presets; see `docs/midi.md`.",
        Manner::Offset(_) => "Moves strokes outward (above 0) or to the centre, by a share of the radius.",
        Manner::Striker(_) => "What is swung at the piece, if not what the note says.",
    }
}
