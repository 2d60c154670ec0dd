//! Random pieces within the accepted ranges, no larger than can be built quickly.
//!
//! Each begins as a piece of the standard kit, gains or loses parts, and has every number of its description moved: by a
//! factor of up to three either way, sometimes to the very end of its accepted range. Pieces that the description refuses,
//! or that have too many modes, are drawn again. [`kits`] puts them together.

pub mod kits;
mod parts;

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use overhear_engine::air_load::SPEED_OF_SOUND;
use overhear_engine::contour::ContourSpec;
use overhear_engine::cymbal::CymbalSpec;
use overhear_engine::damping::{LossLaw, Muffler};
use overhear_engine::drum::{DrumSpec, HeadContact, HeadSpec, PitchOf, ShellSpec};
use overhear_engine::hi_hat::HiHatSpec;
use overhear_engine::kit_spec::{InstrumentSpec, PieceSpec};
use overhear_engine::membrane::dot::DotSpec;
use overhear_engine::microphones::CloseSpec;
use overhear_engine::numbers::{Numbers, Visitor};
use overhear_engine::surface::rivets::{self, RivetsSpec};

use crate::{Chance, spec};

/// Sample rate of random pieces, Hz: the lowest that hosts play at.
pub const RATE: f64 = 44_100.0;

/// Farthest that a number is moved from the standard kit's, a factor.
const FACTOR: f64 = 3.0;

/// Probability that a number is at an end of its range instead.
const EXTREME: f64 = 0.02;

/// Highest mode of a plate, Hz.
const HIGHEST_HZ: f64 = 21_000.0;

/// Most modes of a random body, roughly.
const MOST_MODES: f64 = 1200.0;

/// Moves every number that it sees.
struct Shaker<'a>(&'a mut Chance);

impl Visitor for Shaker<'_> {
    fn number(&mut self, _: &str, value: &mut f64, accepted: RangeInclusive<f64>) {
        let (low, high, chance) = (*accepted.start(), *accepted.end(), &mut *self.0);
        let moved = if chance.happens(EXTREME) {
            chance.of(&[low, high])
        } else if low < 0.0 {
            chance.between(low, high)
        } else {
            *value * FACTOR.powf(chance.between(-1.0, 1.0))
        };
        // The range may be empty, which the check refuses.
        *value = moved.max(low).min(high);
    }

    fn enter(&mut self, _: &str) {}

    fn leave(&mut self) {}
}

/// A piece of any kind.
pub fn piece(chance: &mut Chance) -> PieceSpec {
    match chance.below(5) {
        0 | 1 => cymbal(chance),
        2 => hi_hat(chance),
        _ => drum(chance),
    }
}

/// A drum.
pub fn drum(chance: &mut Chance) -> PieceSpec {
    const DRUMS: [&str; 5] = ["kick", "snare", "rack-tom", "floor-tom", "timpani"];
    draw(chance, &DRUMS, |instrument, chance| match instrument {
        InstrumentSpec::Drum(drum) => InstrumentSpec::Drum(few_modes(rebuilt(drum, chance), chance)),
        other => other,
    })
}

/// A drum whose heads are not of film alone: one of them at least has a dot. The drum is that of [`drum`].
pub fn dotted(chance: &mut Chance) -> PieceSpec {
    loop {
        let mut piece = drum(chance);
        let InstrumentSpec::Drum(drum) = &mut piece.instrument else { continue };
        let wide = drum.diameter;
        let mut dot = || DotSpec {
            diameter: chance.between(0.05, 0.9) * wide,
            thickness: 2e-5 * 25.0_f64.powf(chance.unit()),
            loss: LossLaw { constant: chance.between(0.0, 5.0), per_khz: chance.between(0.0, 20.0) },
        };
        drum.batter.dot = Some(dot());
        let far = dot();
        if chance.happens(0.3) {
            drum.resonant.iter_mut().for_each(|head| head.dot = Some(far));
        }
        if piece.check().is_ok() {
            return piece;
        }
    }
}

/// A cymbal on a stand.
pub fn cymbal(chance: &mut Chance) -> PieceSpec {
    draw(chance, &["crash", "ride", "splash"], |instrument, chance| match instrument {
        InstrumentSpec::Cymbal(cymbal) => InstrumentSpec::Cymbal(reshaped(cymbal, chance)),
        other => other,
    })
}

/// A hi-hat.
pub fn hi_hat(chance: &mut Chance) -> PieceSpec {
    draw(chance, &["hi-hat"], |instrument, chance| match instrument {
        InstrumentSpec::HiHat(hat) => {
            let diameter = hat.top.diameter * chance.between(0.995, 1.005);
            let bottom = CymbalSpec { diameter, ..reshaped(hat.bottom, chance) };
            InstrumentSpec::HiHat(HiHatSpec { top: reshaped(hat.top, chance), bottom, ..hat })
        }
        other => other,
    })
}

/// Draws until there is one that can be.
fn draw(
    chance: &mut Chance,
    from: &[&str],
    change: impl Fn(InstrumentSpec, &mut Chance) -> InstrumentSpec,
) -> PieceSpec {
    const TRIES: usize = 100_000;
    for _ in 0..TRIES {
        let mut piece = spec(chance.of(from));
        piece.instrument.visit(&mut Shaker(chance));
        piece.instrument = change(piece.instrument, chance);
        // A contour stays what it is: no body depends on it, and a seed goes on to draw the bodies that it drew.
        let contour = contour_of(&mut piece.close).take();
        piece.close.visit(&mut Shaker(chance));
        *contour_of(&mut piece.close) = contour;
        let wires = piece.drum().is_some_and(|drum| drum.wires.is_some());
        piece.defaults.preload = wires.then(|| 0.03 * 50.0_f64.powf(chance.unit()));
        piece.defaults.muffle = if chance.happens(0.5) { 0.0 } else { chance.unit() };
        let few = modes(&piece.instrument) < MOST_MODES;
        if few && piece.drum().is_none_or(is_below_its_air) && piece.check().is_ok() {
            rivet(&mut piece.instrument);
            return piece;
        }
    }
    panic!("no {from:?} of {TRIES} can be");
}

/// The contour of a microphone, to be changed.
fn contour_of(close: &mut CloseSpec) -> &mut Option<ContourSpec> {
    match close {
        CloseSpec::OverRim { contour, .. } | CloseSpec::Beside { contour, .. } => contour,
    }
}

/// Gives and takes parts of a drum.
fn rebuilt(drum: DrumSpec, chance: &mut Chance) -> DrumSpec {
    let snare = crate::drum("snare");
    let mut drum = drum;
    if drum.resonant.is_some() && chance.happens(0.3) {
        drum.wires = snare.wires;
    }
    if chance.happens(0.3) {
        drum.hoop = snare.hoop;
    }
    if chance.happens(0.1) {
        drum = drum.opened();
    }
    // A timpani's pitch is that of the whole drum; a kettle much too small or too large would dominate it.
    let sensible = |chance: &mut Chance| drum.diameter.powi(3) * chance.between(0.3, 0.8);
    match drum.shell {
        Some(ShellSpec::Kettle { air_q, vent_diameter, .. }) => {
            drum.shell = Some(ShellSpec::Kettle { volume: sensible(chance), air_q, vent_diameter });
        }
        _ if drum.resonant.is_none() && chance.happens(0.3) => {
            let (volume, air_q) = (sensible(chance), chance.between(10.0, 200.0));
            drum.shell = Some(ShellSpec::Kettle { volume, air_q, vent_diameter: None });
        }
        _ => {}
    }
    drum.muffler = match chance.below(4) {
        0 => Muffler::Pillow {
            sigma: chance.between(0.0, 60.0),
            corner_hz: chance.between(0.0, 300.0),
            flow: chance.between(0.0, 300.0),
        },
        1 => Muffler::Ring { sigma: chance.between(0.0, 60.0), inner: chance.between(0.3, 0.99) },
        _ => drum.muffler,
    };
    drum.contact = if chance.happens(0.85) { HeadContact::Wraps } else { HeadContact::FixedDisc };
    drum.high_band = chance.happens(0.8);
    drum.batter.plies = chance.of(&[1, 2]);
    drum
}

/// A drum whose heads' modes end so many times over its pitch, as do those of its film with few.
fn few_modes(drum: DrumSpec, chance: &mut Chance) -> DrumSpec {
    let middle = (drum.lowest_pitch_hz * drum.highest_pitch_hz).sqrt();
    let to = |ratio: f64| (middle * ratio).clamp(100.0, 4000.0);
    let batter = HeadSpec { modes_to_hz: to(chance.between(8.0, 14.0)), ..drum.batter };
    let resonant = drum.resonant.map(|resonant| {
        let modes_to_hz = to(resonant.pitch_ratio * chance.between(7.0, 10.0));
        overhear_engine::drum::ResonantSpec { modes_to_hz, ..resonant }
    });
    DrumSpec { batter, resonant, ..drum }
}

/// Takes a cymbal's bell or its taper away, now and then.
fn reshaped(cymbal: CymbalSpec, chance: &mut Chance) -> CymbalSpec {
    let bell = cymbal.bell.filter(|_| chance.happens(0.85));
    let taper = if chance.happens(0.15) { 1.0 } else { cymbal.taper };
    CymbalSpec { bell, taper, ..cymbal }
}

/// Puts rivets into a cymbal on a stand, now and then. Whether and which is drawn from the cymbal itself, so that whatever is drawn after
/// it is the same with rivets and without.
fn rivet(instrument: &mut InstrumentSpec) {
    let InstrumentSpec::Cymbal(cymbal) = instrument else { return };
    let mut chance = Chance::new(cymbal.mass.to_bits());
    if chance.happens(0.4) {
        let mut rivets = RivetsSpec {
            number: 1 + chance.below(rivets::MOST) as u32,
            radius: 0.9,
            arc: chance.happens(0.3).then_some(0.5),
            toward: 0.0,
            mass: 1.5e-3,
            play: 2.5e-3,
        };
        rivets.visit(&mut Shaker(&mut chance));
        cymbal.rivets = Some(rivets);
    }
}

/// How many modes there are, roughly: of a membrane `(k a / 2)^2` to the highest, of a plate by the density of its
/// bending waves.
fn modes(instrument: &InstrumentSpec) -> f64 {
    match instrument {
        InstrumentSpec::Drum(drum) => {
            let middle = (drum.lowest_pitch_hz * drum.highest_pitch_hz).sqrt();
            let of = |to: f64, pitch: f64| (2.405 * to / pitch / 2.0).powi(2);
            let far = drum.resonant.map_or(0.0, |far| of(far.modes_to_hz, far.pitch_ratio * middle));
            of(drum.batter.modes_to_hz, middle) + far
        }
        InstrumentSpec::Cymbal(cymbal) => plate_modes(cymbal),
        InstrumentSpec::HiHat(hat) => plate_modes(&hat.top) + plate_modes(&hat.bottom),
    }
}

/// Whether a drum that is tuned as it is heard stays as far below the first mode of the air across it as a timpani does:
/// near it the head's mode and the air's are two halves of one, and neither is the drum's pitch.
fn is_below_its_air(drum: &DrumSpec) -> bool {
    const FIRST_ACROSS: f64 = 1.841;
    let across = FIRST_ACROSS * SPEED_OF_SOUND / (TAU * drum.radius());
    drum.pitch_of == PitchOf::BatterAlone || drum.highest_pitch_hz < 0.65 * across
}

fn plate_modes(cymbal: &CymbalSpec) -> f64 {
    let plate = cymbal.plate();
    let area = std::f64::consts::PI * plate.radius().powi(2);
    let waves = (plate.youngs_modulus / plate.density).sqrt() * plate.thickness();
    3.0_f64.sqrt() * area * HIGHEST_HZ / waves
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_pieces_can_be_differ_and_are_the_same_for_the_same_seed() {
        let drawn = |seed| piece(&mut Chance::new(seed));
        for seed in 0..200 {
            assert_eq!(drawn(seed).check(), Ok(()));
            assert_eq!(drawn(seed), drawn(seed));
            assert_ne!(drawn(seed), drawn(seed + 1));
        }
        let drawn = (0..200).map(|seed| cymbal(&mut Chance::new(seed)));
        let riveted = drawn.filter(|piece| match piece.instrument {
            InstrumentSpec::Cymbal(cymbal) => cymbal.rivets.is_some(),
            _ => false,
        });
        assert!((50..110).contains(&riveted.count()));
    }
}
