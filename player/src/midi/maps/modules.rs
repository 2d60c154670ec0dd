//! Which notes modules send, and what they play.
//!
//! *Literature*, as the modules leave the factory: Roland's list of the TD-17 and the implementation charts of TD-27 and TD-50,
//! whose notes those that followed share; Yamaha DTX502; Alesis Nitro. *Assumed*, as no list of their notes was found in public:
//!
//! * `EFNOTE`: Roland's notes, with two more for a half open hi-hat and a foot splash. No document was found.
//! * `EDRUMIN`: Audiofront's manual (2.3.1) tells of positional sensing, three zones at one input and a pedal; what was read of it
//!   names no note.
//! * `MEGADRUM`: its documents (pad settings) say that every input has notes of its own, and its editor (MegaDrumManagerFX,
//!   `ConfigPedal`) that bow, edge and bell of the hi-hat each have one for two semi-open, two half open, a semi-closed and a
//!   closed position, beside chick and splash. Neither prints which; here each opening has one note for all zones.

/// A pad of an instrument.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pad {
    /// MIDI note that it sends.
    pub note: u8,
    /// Its name on the instrument.
    pub name: &'static str,
    /// The reference note that it plays.
    pub plays: u8,
}

const fn pad(note: u8, name: &'static str, plays: u8) -> Pad {
    Pad { note, name, plays }
}

/// The pads of some groups in the order of their notes.
const fn merged<const PADS: usize>(groups: &[&[Pad]]) -> [Pad; PADS] {
    let mut pads = [pad(0, "", 0); PADS];
    let (mut count, mut group) = (0, 0);
    while group < groups.len() {
        let mut row = 0;
        while row < groups[group].len() {
            let mut at = count;
            while at > 0 && pads[at - 1].note > groups[group][row].note {
                pads[at] = pads[at - 1];
                at -= 1;
            }
            pads[at] = groups[group][row];
            (count, row) = (count + 1, row + 1);
        }
        group += 1;
    }
    assert!(count == PADS);
    pads
}

/// What all but the DTX have in common.
const MOST: &[Pad] = &[pad(36, "Kick", 36), pad(38, "Snare Head", 38), pad(59, "Ride Edge", 93)];

/// The zones of hi-hat, snare and ride of all but the DTX and the Nitro.
const ZONES: &[Pad] = &[
    pad(22, "Hi-Hat Closed Edge", 42),
    pad(37, "Snare Cross Stick", 37),
    pad(42, "Hi-Hat Closed Bow", 101),
    pad(46, "Hi-Hat Open Bow", 102),
    pad(51, "Ride Bow", 51),
];

/// The rims and edges of a drum set with four toms: Roland, Alesis, Efnote.
const RIMS: &[Pad] = &[
    pad(39, "Tom 4 Rim", 96),
    pad(47, "Tom 2 Rim", 95),
    pad(50, "Tom 1 Rim", 95),
    pad(52, "Crash 2 Edge", 57),
    pad(55, "Crash 1 Edge", 49),
    pad(58, "Tom 3 Rim", 96),
];

/// What Roland and Efnote have in common beyond that.
const CRASHES: &[Pad] =
    &[pad(26, "Hi-Hat Open Edge", 46), pad(49, "Crash 1 Bow", 91), pad(57, "Crash 2 Bow", 91)];

/// What the two interfaces of single pads have in common.
const SINGLE: &[Pad] = &[
    pad(21, "Hi-Hat Foot Splash", 97),
    pad(40, "Snare Rim Shot", 40),
    pad(43, "Floor Tom", 43),
    pad(44, "Hi-Hat Foot Close", 44),
    pad(48, "Rack Tom", 48),
    pad(49, "Crash Edge", 49),
    pad(50, "Rack Tom Rim", 95),
    pad(52, "Crash Bow", 91),
    pad(53, "Ride Bell", 53),
    pad(55, "Splash", 55),
    pad(58, "Floor Tom Rim", 96),
];

pub(super) static ROLAND: [Pad; 33] = merged(&[
    MOST,
    ZONES,
    RIMS,
    CRASHES,
    &[
        pad(23, "Snare Brush", 118),
        pad(27, "Aux 1 Head", 55),
        pad(28, "Aux 1 Rim", 55),
        pad(29, "Aux 2 Head", 52),
        pad(30, "Aux 2 Rim", 52),
        pad(31, "Aux 3 Head", 94),
        pad(32, "Aux 3 Rim", 94),
        pad(33, "Aux 4 Head", 35),
        pad(34, "Aux 4 Rim", 35),
        pad(40, "Snare Rim", 40),
        pad(41, "Tom 4 Head", 41),
        pad(43, "Tom 3 Head", 43),
        pad(44, "Hi-Hat Pedal", 44),
        pad(45, "Tom 2 Head", 47),
        pad(48, "Tom 1 Head", 48),
        pad(53, "Ride Bell", 53),
    ],
]);

pub(super) static YAMAHA: [Pad; 28] = [
    pad(27, "Snare Off Closed Rim", 117),
    pad(31, "Snare Off Head", 115),
    pad(34, "Snare Off Open Rim", 116),
    pad(35, "Kick 2", 35),
    pad(36, "Kick", 36),
    pad(37, "Snare Closed Rim", 37),
    pad(38, "Snare Head", 38),
    pad(40, "Snare Open Rim", 40),
    pad(42, "Hi-Hat Closed", 101),
    pad(43, "Tom 3", 43),
    pad(44, "Hi-Hat Foot Close", 44),
    pad(46, "Hi-Hat Open", 102),
    pad(47, "Tom 2", 47),
    pad(48, "Tom 1", 48),
    pad(49, "Crash Edge", 49),
    pad(50, "Tom 1 Rim", 95),
    pad(51, "Ride Bow", 51),
    pad(52, "Ride Edge", 93),
    pad(53, "Ride Cup", 53),
    pad(55, "Crash Cup", 92),
    pad(57, "Pad 8", 55),
    pad(58, "Tom 3 Rim", 96),
    pad(59, "Crash Bow", 91),
    pad(78, "Hi-Hat Open Edge", 46),
    pad(79, "Hi-Hat Closed Edge", 42),
    pad(83, "Hi-Hat Foot Splash", 97),
    pad(85, "Hi-Hat Open Cup", 104),
    pad(86, "Hi-Hat Closed Cup", 103),
];

pub(super) static ALESIS: [Pad; 23] = merged(&[
    MOST,
    RIMS,
    &[
        pad(21, "Hi-Hat Splash", 97),
        pad(23, "Hi-Hat Half Open", 100),
        pad(40, "Snare Rim", 40),
        pad(41, "Tom 4", 41),
        pad(42, "Hi-Hat Closed", 42),
        pad(43, "Tom 3", 43),
        pad(44, "Hi-Hat Pedal", 44),
        pad(45, "Tom 2", 47),
        pad(46, "Hi-Hat Open", 46),
        pad(48, "Tom 1", 48),
        pad(49, "Crash 1", 49),
        pad(51, "Ride", 51),
        pad(53, "Ride Bell", 53),
        pad(57, "Crash 2", 57),
    ],
]);

pub(super) static EFNOTE: [Pad; 26] = merged(&[
    MOST,
    ZONES,
    RIMS,
    CRASHES,
    &[
        pad(21, "Hi-Hat Foot Splash", 97),
        pad(24, "Hi-Hat Half Open Edge", 100),
        pad(40, "Snare Rim Shot", 40),
        pad(41, "Tom 4", 41),
        pad(43, "Tom 3", 43),
        pad(44, "Hi-Hat Foot Close", 44),
        pad(45, "Tom 2", 47),
        pad(48, "Tom 1", 48),
        pad(53, "Ride Cup", 53),
    ],
]);

pub(super) static EDRUMIN: [Pad; 28] = merged(&[
    MOST,
    ZONES,
    SINGLE,
    &[
        pad(26, "Hi-Hat Open Edge", 46),
        pad(31, "Snare Off Head", 115),
        pad(32, "Snare Off Rim Shot", 116),
        pad(33, "Snare Off Cross Stick", 117),
        pad(54, "Crash Bell", 92),
        pad(80, "Hi-Hat Closed Bell", 103),
        pad(81, "Hi-Hat Open Bell", 104),
        pad(84, "Strainer Off", 119),
        pad(85, "Strainer On", 120),
    ],
]);

pub(super) static MEGADRUM: [Pad; 30] = merged(&[
    MOST,
    ZONES,
    SINGLE,
    &[
        pad(23, "Hi-Hat Tight", 105),
        pad(24, "Hi-Hat Loose", 106),
        pad(25, "Hi-Hat Half Open", 100),
        pad(26, "Hi-Hat Open 1", 107),
        pad(27, "Hi-Hat Open 2", 108),
        pad(28, "Hi-Hat Open 3", 109),
        pad(29, "Hi-Hat Fully Open", 110),
        pad(60, "Crash Choke", 111),
        pad(61, "Ride Choke", 112),
        pad(62, "Splash Choke", 113),
        pad(63, "Hi-Hat Choke", 114),
    ],
]);

pub(super) static PLAIN: [Pad; 22] = [
    pad(36, "Kick", 36),
    pad(37, "Snare", 38),
    pad(38, "Hi-Hat Closed", 42),
    pad(39, "Hi-Hat Open", 46),
    pad(40, "Rack Tom", 48),
    pad(41, "Floor Tom", 43),
    pad(42, "Ride", 51),
    pad(43, "Crash", 49),
    pad(44, "Snare Cross Stick", 37),
    pad(45, "Snare Rim Shot", 40),
    pad(46, "Hi-Hat Pedal", 44),
    pad(47, "Ride Bell", 53),
    pad(48, "Splash", 55),
    pad(49, "Crash Bow", 91),
    pad(50, "Ride Edge", 93),
    pad(51, "Snare Edge", 94),
    pad(52, "Rack Tom Rim Shot", 95),
    pad(53, "Floor Tom Rim Shot", 96),
    pad(54, "Timpani", 88),
    pad(55, "Timpani Hard", 89),
    pad(56, "Timpani Centre", 90),
    pad(57, "Crash Bell", 92),
];
