//! Documents drawn by chance.

use std::ops::RangeInclusive;

use overhear_engine::contour::ContourSpec;
use overhear_engine::damping::Muffler;
use overhear_engine::drum::{HeadContact, PitchOf, ShellSpec};
use overhear_engine::kit_spec::{InstrumentSpec, KitSpec, PieceSpec, places};
use overhear_engine::microphones::CloseSpec;
use overhear_engine::numbers::{Numbers as _, Visitor};
use overhear_engine::piece::Idealization;
use overhear_engine::receiver::ReceiverPosition;
use overhear_engine::slot::Slot;
use overhear_engine::strike::Striker;

use crate::kit_document::KitDocument;
use crate::midi_map::{Foot, Meaning, NoteTable, Row, Stroke};

/// A random generator; the same seed draws the same.
pub struct Draw(fastrand::Rng);

impl Draw {
    pub fn new(seed: u64) -> Draw {
        Draw(fastrand::Rng::with_seed(seed))
    }

    pub fn below(&mut self, end: usize) -> usize {
        self.0.usize(..end.max(1))
    }

    /// From 0 to 1.
    pub fn unit(&mut self) -> f64 {
        self.below(1 << 30) as f64 / f64::from((1 << 30) - 1)
    }

    pub fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    pub fn of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }

    /// A number of a range: anywhere in it, at an end, or of few digits.
    fn number(&mut self, accepted: &RangeInclusive<f64>) -> f64 {
        let (min, max) = (*accepted.start(), *accepted.end());
        let x = (min + (max - min) * self.unit()).clamp(min, max);
        match self.below(8) {
            0 => min,
            1 => max,
            2 | 3 => format!("{x:.2e}").parse::<f64>().unwrap().clamp(min, max),
            _ => x,
        }
    }
}

/// Draws some of the numbers that it visits anew.
struct Numbers<'a> {
    draw: &'a mut Draw,
    rarely: usize,
}

impl Visitor for Numbers<'_> {
    fn number(&mut self, _name: &str, value: &mut f64, accepted: RangeInclusive<f64>) {
        if self.draw.one_in(self.rarely) || !accepted.contains(value) {
            *value = self.draw.number(&accepted);
        }
    }

    fn enter(&mut self, _part: &str) {}

    fn leave(&mut self) {}
}

/// A document that passes its check.
pub fn document(seed: u64) -> KitDocument {
    let draw = &mut Draw::new(seed);
    let standard = KitSpec::standard();
    let count = 1 + draw.below(16);
    let mut pieces = Vec::new();
    for slot in 0..count {
        pieces.push(piece(draw, &standard, &pieces, slot));
    }
    let mut kit = KitSpec { pieces, ..standard };
    for x in kit.microphones.overheads.as_flattened_mut() {
        *x += draw.unit();
    }
    kit.room.time = draw.number(&(0.05..=5.0));
    kit.room.octaves[draw.below(9)] = draw.number(&(0.1..=4.0));
    kit.room.corners[1][draw.below(3)] += draw.unit();
    kit.room.reflected[draw.below(3)][draw.below(2)] = draw.number(&(0.0..=0.99));
    let notes = notes(draw, &kit);
    let document = KitDocument { kit, notes };
    document.check().unwrap_or_else(|error| panic!("seed {seed}: {error}"));
    document
}

/// A piece that passes its check and stands in none of the others.
fn piece(draw: &mut Draw, standard: &KitSpec, others: &[PieceSpec], slot: usize) -> PieceSpec {
    let like = &standard.pieces[draw.below(standard.pieces.len())];
    for _ in 0..20 {
        let mut piece = like.clone();
        piece.name = format!("p{slot}-{}", draw.below(1000));
        piece.title =
            draw.of(&["Kick", " \"Big\" \\ drum ", "C'est #1", "Trommel \u{fc}", "none", "[x]"]).to_owned();
        parts(draw, &mut piece);
        let rarely = draw.of(&[2, 4, 10, 1000]);
        piece.visit(&mut Numbers { draw, rarely });
        // Far enough from the others for all but the deepest kettles.
        let at = slot as f64;
        piece.place.centre =
            [(at % 4.0) * 4.0 - 8.0 + draw.unit(), draw.unit(), (at / 4.0).floor() * 4.0 - 8.0];
        if piece.check().is_ok() && !others.iter().any(|other| places::inside(&piece, other)) {
            return piece;
        }
    }
    let place =
        overhear_engine::kit_spec::PlaceSpec { centre: [slot as f64 * 2.0 - 15.0, 0.5, 18.0], ..like.place };
    PieceSpec { name: format!("q{slot}"), place, ..like.clone() }
}

/// Parts that it may have or not, and of which kind they are.
fn parts(draw: &mut Draw, piece: &mut PieceSpec) {
    if draw.one_in(3) {
        let point = ReceiverPosition { distance: 0.4, inclination: 0.5, azimuth: -0.3 };
        let (height, azimuth, gain, contour) = (0.07, -0.4, 0.3, Some(ContourSpec::KICK));
        let contoured = CloseSpec::OverRim { height, azimuth, gain, contour };
        piece.close = draw.of(&[CloseSpec::OVER_RIM, CloseSpec::beside(point), contoured]);
    }
    let mut yes = || draw.one_in(5);
    piece.ideal = Idealization { lossless: yes(), linear: yes(), round: yes() };
    match &mut piece.instrument {
        InstrumentSpec::Drum(drum) => {
            let pillow = Muffler::Pillow { sigma: 20.0, corner_hz: 120.0, flow: 100.0 };
            drum.muffler = draw.of(&[Muffler::GEL, Muffler::RING, pillow]);
            drum.evenness.seed = draw.of(&[0, 7, u32::MAX]);
            drum.contact = draw.of(&[HeadContact::Wraps, HeadContact::FixedDisc]);
            drum.pitch_of = draw.of(&[PitchOf::BatterAlone, PitchOf::PrincipalHeard]);
            drum.batter.plies = draw.of(&[1, 2]);
            drum.high_band = draw.one_in(2);
            if draw.one_in(4) {
                drum.hoop = None;
            }
            if draw.one_in(4) {
                (drum.resonant, drum.wires, piece.defaults.preload) = (None, None, None);
                let kettle = ShellSpec::Kettle { volume: 0.1, air_q: 50.0, vent_diameter: None };
                drum.shell = draw.of(&[None, Some(kettle), drum.shell]);
            }
            let is_open = drum.resonant.is_none() && matches!(drum.shell, Some(ShellSpec::Cylinder { .. }));
            if draw.one_in(4) && !is_open {
                drum.shell = drum.shell.map(|shell| shell.vented(Some(0.0127)));
            }
        }
        InstrumentSpec::Cymbal(cymbal) => {
            if draw.one_in(3) {
                cymbal.bell = None;
            }
        }
        InstrumentSpec::HiHat(hat) => {
            if draw.one_in(3) {
                hat.top.bell = None;
            }
        }
    }
}

fn notes(draw: &mut Draw, kit: &KitSpec) -> NoteTable {
    let mut table = NoteTable::default();
    let slots: Vec<(Slot, bool)> = kit
        .slots()
        .map(|(slot, piece)| (slot, matches!(piece.instrument, InstrumentSpec::HiHat(_))))
        .collect();
    for note in 0..128 {
        let (slot, hat) = draw.of(&slots);
        let place = draw.number(&(0.0..=1.0));
        let angle = draw.number(&(-6.0..=6.0));
        let stroke = Meaning::Strikes(Stroke { slot, radius: place, angle, striker: draw.of(&Striker::ALL) });
        let foot = draw.of(&[Foot::Chick, Foot::Splash, Foot::Position(place)]);
        let meaning = match draw.below(6) {
            0 | 1 => continue,
            2 => Meaning::Silent,
            3 if hat => Meaning::Steps(slot, foot),
            3 if kit.piece(slot).is_some_and(|piece| piece.drum().is_some()) => {
                Meaning::Throws(slot, draw.one_in(2))
            }
            3 => Meaning::Chokes(slot),
            _ => stroke,
        };
        let strikes = matches!(meaning, Meaning::Strikes(_));
        let pedal = (hat && strikes && draw.one_in(2)).then_some(place);
        let drum = kit.piece(slot).is_some_and(|piece| piece.drum().is_some());
        let wires = (drum && strikes && draw.one_in(4)).then(|| draw.one_in(2));
        let figure = (strikes && draw.one_in(4)).then(|| draw.of(&crate::midi::figures::Figure::ALL).0);
        let name = draw.of(&["Hand \"Clap\"", "none", "A # b", " \\ "]).to_owned();
        table.set(note, Some(Row { name, meaning, pedal, wires, figure }));
        if strikes && draw.one_in(3) {
            table.set_ordinary(slot, Some(note));
        }
    }
    for (slot, _) in slots {
        table.set_position_controller(slot, draw.of(&[None, Some(16), Some(19)]));
    }
    table
}
