//! The table of parameters.

use overhear_engine::kit::{Control, SILENT_DB};
use overhear_engine::piece::PieceId;

use super::{Drives, Parameter};

/// Every parameter, in the order hosts see. Frozen: append only.
pub static PARAMETERS: [Parameter; 32] = {
    use PieceId::*;
    [
        drum_tune(Kick, "Kick", "kktune", "kick_tune", [35.0, 55.0, 90.0]),
        muffle(Kick, "Kick", "kkmuff", "kick_muffle", 0.15),
        level(Kick, "Kick", "kklevl", "kick_level", 0.0),
        drum_tune(Snare, "Snare", "sntune", "snare_tune", [140.0, 220.0, 360.0]),
        muffle(Snare, "Snare", "snmuff", "snare_muffle", 0.0),
        level(Snare, "Snare", "snlevl", "snare_level", -4.0),
        drum_tune(RackTom, "Rack tom", "rttune", "rack_tom_tune", [90.0, 140.0, 260.0]),
        muffle(RackTom, "Rack tom", "rtmuff", "rack_tom_muffle", 0.0),
        level(RackTom, "Rack tom", "rtlevl", "rack_tom_level", 3.0),
        drum_tune(FloorTom, "Floor tom", "fttune", "floor_tom_tune", [55.0, 82.0, 160.0]),
        muffle(FloorTom, "Floor tom", "ftmuff", "floor_tom_muffle", 0.0),
        level(FloorTom, "Floor tom", "ftlevl", "floor_tom_level", 2.0),
        cymbal_tune(Crash, "Crash", "crtune", "crash_tune"),
        muffle(Crash, "Crash", "crmuff", "crash_muffle", 0.0),
        level(Crash, "Crash", "crlevl", "crash_level", 6.0),
        cymbal_tune(Ride, "Ride", "rdtune", "ride_tune"),
        muffle(Ride, "Ride", "rdmuff", "ride_muffle", 0.0),
        level(Ride, "Ride", "rdlevl", "ride_level", -10.0),
        cymbal_tune(Splash, "Splash", "sptune", "splash_tune"),
        muffle(Splash, "Splash", "spmuff", "splash_muffle", 0.0),
        level(Splash, "Splash", "splevl", "splash_level", 3.0),
        Parameter {
            id: "master",
            name: "master_level",
            label: "Level",
            group: "Kit",
            // A groove at full velocity peaks a few decibels below full scale.
            default: -4.0,
            ..decibels(Control::Master)
        },
        Parameter {
            id: "dynam",
            name: "dynamics",
            label: "Dynamics",
            group: "Kit",
            unit: " m/s",
            min: 1.0,
            max: 10.0,
            default: 6.0,
            centre: 5.5,
            step: 0.01,
            decimals: 2,
            drives: Drives::Dynamics,
        },
        Parameter {
            id: "snprel",
            name: "snare_preload",
            label: "Preload",
            group: "Snare",
            unit: " N",
            min: 0.03,
            max: 1.5,
            default: 0.15,
            // As much knob for the loose half of what drummers use as for the tight one.
            centre: 0.15,
            // Of the steps about as fine as this, the largest of which 0.03, 0.15 and 1.5 are exact multiples
            // in single precision.
            step: 1.0 / 1100.0,
            decimals: 3,
            drives: Drives::Control(Control::SnarePreload),
        },
        Parameter {
            id: "snwire",
            name: "snare_wires",
            label: "Wires",
            group: "Snare",
            unit: "",
            min: 0.0,
            max: 1.0,
            default: 1.0,
            centre: 0.5,
            step: 1.0,
            decimals: 0,
            drives: Drives::Control(Control::SnareWires),
        },
        // The pedal.
        drum_tune(Timpani, "Timpani", "tptune", "timpani_tune", [87.3, 130.8, 196.0]),
        muffle(Timpani, "Timpani", "tpmuff", "timpani_muffle", 0.0),
        level(Timpani, "Timpani", "tplevl", "timpani_level", 0.0),
        cymbal_tune(HiHat, "Hi-hat", "hhtune", "hi_hat_tune"),
        muffle(HiHat, "Hi-hat", "hhmuff", "hi_hat_muffle", 0.0),
        level(HiHat, "Hi-hat", "hhlevl", "hi_hat_level", 0.0),
        Parameter {
            id: "hhpedl",
            name: "hihat_pedal",
            label: "Pedal",
            group: "Hi-hat",
            unit: "",
            min: 0.0,
            max: 1.0,
            default: 0.0,
            centre: 0.5,
            step: 0.001,
            decimals: 3,
            drives: Drives::Control(Control::Pedal),
        },
    ]
};

const fn drum_tune(
    piece: PieceId,
    group: &'static str,
    id: &'static str,
    name: &'static str,
    [min, default, max]: [f32; 3],
) -> Parameter {
    Parameter {
        id,
        name,
        label: "Tune",
        group,
        unit: " Hz",
        min,
        max,
        default,
        // The drum's own pitch in the middle leaves about as much knob below it as above.
        centre: default,
        // Half a cent at the lowest kick.
        step: 0.01,
        decimals: 2,
        drives: Drives::Control(Control::Tuning(piece)),
    }
}

const fn cymbal_tune(piece: PieceId, group: &'static str, id: &'static str, name: &'static str) -> Parameter {
    Parameter {
        id,
        name,
        label: "Tune",
        group,
        unit: " st",
        min: -12.0,
        max: 12.0,
        default: 0.0,
        centre: 0.0,
        step: 0.01,
        decimals: 2,
        drives: Drives::Semitones(piece),
    }
}

const fn muffle(
    piece: PieceId,
    group: &'static str,
    id: &'static str,
    name: &'static str,
    default: f32,
) -> Parameter {
    Parameter {
        id,
        name,
        label: "Muffle",
        group,
        unit: "",
        min: 0.0,
        max: 1.0,
        default,
        centre: 0.5,
        step: 0.001,
        decimals: 3,
        drives: Drives::Control(Control::Muffling(piece)),
    }
}

/// A level; its default balances the kit. *By ear*: a ride's ping at half a metre is far louder than a mix has
/// it, a crash from the side far softer.
const fn level(
    piece: PieceId,
    group: &'static str,
    id: &'static str,
    name: &'static str,
    default: f32,
) -> Parameter {
    Parameter { id, name, label: "Level", group, default, ..decibels(Control::Level(piece)) }
}

const fn decibels(control: Control) -> Parameter {
    Parameter {
        id: "",
        name: "",
        label: "",
        group: "",
        unit: " dB",
        min: SILENT_DB as f32,
        max: 12.0,
        default: 0.0,
        // As on a mixing desk's fader: half its travel for the last 12 dB and the reserve.
        centre: -12.0,
        step: 0.01,
        decimals: 2,
        drives: Drives::Control(control),
    }
}
