//! The parameters of the whole kit, of playing and of rendering.

use overhear_engine::kit::{Control, Microphone, SILENT_DB};

use super::parameter::{Construction, Drives, Manner, Parameter, Stand};
use crate::midi::maps::NoteMap;
use crate::midi::playing::{CURVE, ChokeRule, FULL_SPEED, POSITION_SPREAD, SPEED_SPREAD};
use crate::workers;

/// How many there are.
pub const GLOBALS: usize = 25;

/// Every parameter that belongs to no slot, in the order hosts see. Frozen: append only.
pub static TABLE: [Parameter; GLOBALS] = [
    Parameter {
        id: "master",
        name: "master_level",
        label: "Level",
        group: "Kit",
        // A groove at full velocity peaks a few decibels below full scale.
        default: -12.0,
        ..decibels(Control::Master)
    },
    Parameter {
        id: "dynam",
        name: "dynamics",
        label: "Stick speed at full velocity",
        group: "Kit",
        unit: " m/s",
        min: 1.0,
        max: 12.0,
        default: FULL_SPEED as f32,
        centre: 6.0,
        step: 0.01,
        decimals: 2,
        ..playing(Manner::Dynamics)
    },
    Parameter {
        id: "velcur",
        name: "velocity_curve",
        label: "Curve",
        min: 0.25,
        max: 4.0,
        default: CURVE as f32,
        centre: 1.0,
        step: 0.01,
        decimals: 2,
        ..playing(Manner::Curve)
    },
    Parameter {
        id: "humpla",
        name: "humanize_position",
        label: "Humanize position",
        unit: " %",
        default: (100.0 * POSITION_SPREAD) as f32,
        max: 20.0,
        centre: 5.0,
        step: 0.1,
        decimals: 1,
        ..playing(Manner::PositionSpread)
    },
    Parameter {
        id: "humspd",
        name: "humanize_velocity",
        label: "Humanize velocity",
        unit: " dB",
        default: SPEED_SPREAD as f32,
        max: 6.0,
        centre: 1.5,
        step: 0.01,
        decimals: 2,
        ..playing(Manner::SpeedSpread)
    },
    Parameter { id: "notmap", name: "note_map", label: "Note map", ..choice(Manner::Map, &NoteMap::NAMES) },
    Parameter { id: "midchn", name: "midi_channel", label: "Channel", ..choice(Manner::Channel, &CHANNELS) },
    Parameter {
        id: "chokes",
        name: "chokes",
        label: "Choke",
        default: 1.0,
        ..choice(Manner::Chokes, &ChokeRule::NAMES)
    },
    Parameter {
        id: "poscc",
        name: "position_controllers",
        label: "Position CCs",
        default: 1.0,
        ..choice(Manner::FollowsPosition, &["off", "on"])
    },
    Parameter {
        id: "qualit",
        name: "quality",
        label: "Quality",
        group: "Rendering",
        default: 1.0,
        ..built(Construction::Quality, &["eco", "standard", "high", "offline"])
    },
    Parameter {
        id: "offqua",
        name: "offline_quality",
        label: "Offline quality",
        group: "Rendering",
        // Nobody waits for a bounce as for a buffer.
        default: 4.0,
        ..built(Construction::OfflineQuality, &["as played", "eco", "standard", "high", "offline"])
    },
    microphones("cllevl", "close_level", "Close", 0.0, Control::CloseLevel),
    microphones("ohlevl", "overheads_level", "Overheads", 0.0, OVERHEADS),
    microphones("rmlevl", "room_level", "Room", -9.0, ROOM),
    switch("hear", "sympathetic_resonance", "Sympathetic resonance", 1.0, Control::SympatheticCoupling),
    Parameter {
        id: "sympat",
        name: "sympathetic_amount",
        label: "Sympathetic amount",
        group: "Kit",
        default: 1.0,
        step: 0.001,
        decimals: 3,
        drives: Drives::Control(Control::Sympathy),
        ..Parameter::SWITCH
    },
    switch("clip", "safety_clip", "Safety clip", 0.0, Control::SafetyClip),
    Parameter {
        id: "workrs",
        name: "render_threads",
        label: "Render threads",
        group: "Rendering",
        max: workers::MOST as f32,
        centre: 0.5 * workers::MOST as f32,
        ..built(Construction::Workers, &[])
    },
    Parameter {
        id: "progch",
        name: "program_changes",
        label: "Program changes",
        default: 1.0,
        ..choice(Manner::FollowsPrograms, &["off", "on"])
    },
    moved("ohup", "overheads_height", (Microphone::Overheads, Stand::Height), (-30.0, 150.0)),
    moved("ohaway", "overheads_depth", (Microphone::Overheads, Stand::Depth), (-150.0, 150.0)),
    moved("ohwide", "overheads_width", (Microphone::Overheads, Stand::Width), (10.0, 200.0)),
    moved("rmup", "room_height", (Microphone::Room, Stand::Height), (-140.0, 100.0)),
    moved("rmaway", "room_depth", (Microphone::Room, Stand::Depth), (-180.0, 300.0)),
    moved("rmwide", "room_width", (Microphone::Room, Stand::Width), (10.0, 250.0)),
];

/// Names that some of them once had, still understood, and those they have.
pub(super) const FORMER_NAMES: [(&str, &str); 5] = [
    ("humanize_place", "humanize_position"),
    ("humanize_speed", "humanize_velocity"),
    ("hearing", "sympathetic_resonance"),
    ("sympathy", "sympathetic_amount"),
    ("workers", "render_threads"),
];

const OVERHEADS: Control = Control::MicrophoneLevel(Microphone::Overheads);
const ROOM: Control = Control::MicrophoneLevel(Microphone::Room);

/// Texts of the channel filter.
const CHANNELS: [&str; 17] =
    ["all", "1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "16"];

const fn microphones(
    id: &'static str,
    name: &'static str,
    label: &'static str,
    default: f32,
    control: Control,
) -> Parameter {
    Parameter { id, name, label, group: "Microphones", default, ..decibels(control) }
}

/// Where a pair of microphones stands, from where it does by default: so that it stays there in any kit.
const fn moved(
    id: &'static str,
    name: &'static str,
    (pair, stand): (Microphone, Stand),
    (min, max): (f32, f32),
) -> Parameter {
    let (label, unit, usual) = match stand {
        Stand::Height => ("Height", " cm", 0.0),
        Stand::Depth => ("Depth", " cm", 0.0),
        Stand::Width => ("Width", " %", 100.0),
    };
    let group = match pair {
        Microphone::Room => "Room",
        Microphone::Overheads | Microphone::Close(_) => "Overheads",
    };
    let (default, centre, drives) = (usual, 0.5 * (min + max), Drives::Stand(pair, stand));
    Parameter { id, name, label, group, unit, min, max, default, centre, drives, ..Parameter::SWITCH }
}

const fn switch(
    id: &'static str,
    name: &'static str,
    label: &'static str,
    default: f32,
    control: Control,
) -> Parameter {
    let (drives, choices) = (Drives::Control(control), &["off", "on"]);
    Parameter { id, name, label, group: "Kit", default, drives, choices, ..Parameter::SWITCH }
}

const fn decibels(control: Control) -> Parameter {
    Parameter {
        unit: " dB",
        min: SILENT_DB as f32,
        max: 12.0,
        // As on a mixing desk's fader: half its travel for the last 12 dB and the reserve.
        centre: -12.0,
        step: 0.01,
        decimals: 2,
        drives: Drives::Control(control),
        ..Parameter::SWITCH
    }
}

const fn playing(manner: Manner) -> Parameter {
    Parameter { group: "Playing", drives: Drives::Playing(manner), ..Parameter::SWITCH }
}

const fn choice(manner: Manner, choices: &'static [&'static str]) -> Parameter {
    let max = (choices.len() - 1) as f32;
    Parameter { max, centre: max / 2.0, choices, ..playing(manner) }
}

const fn built(construction: Construction, choices: &'static [&'static str]) -> Parameter {
    let max = choices.len().saturating_sub(1) as f32;
    let drives = Drives::Building(construction);
    Parameter { max, centre: max / 2.0, choices, drives, ..Parameter::SWITCH }
}
