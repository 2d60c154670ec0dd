//! What a piece has or has not: a bell, an upturned rim, hammering, an unevenly stretched head,
//! counted lugs, a vent.
//!
//! What is switched on comes as the standard kit's has it, in proportion to the piece.

use overhear_engine::cymbal::CymbalSpec;
use overhear_engine::drum::lugs::LugsSpec;
use overhear_engine::drum::spec::{DrumSpec, ShellSpec};
use overhear_engine::kit_spec::{InstrumentSpec, KitSpec, PieceSpec};
use overhear_engine::plate::{Bell, Flange};
use overhear_engine::surface::rivets::RivetsSpec;

/// Where a china's rim begins to turn up and how far it does, shares of the radius. *Judgement*: the china of the kit files'
/// documentation.
const CHINA: (f64, f64) = (0.8, 0.09);

/// Distance of tension rods along the rim, m. *Trade sizes*: five on a 10 in tom, six on 12 in, eight on 16 in, ten on kicks.
const ROD_DISTANCE: f64 = 0.16;
/// Rivets as they are put into rides: six, evenly around, an inch from the rim of one of 20 in. *Judgement*: what is sold.
const RIVETS: RivetsSpec =
    RivetsSpec { number: 6, radius: 0.9, arc: None, toward: 0.0, mass: 1.5e-3, play: 2.5e-3 };

/// Diameter of a vent, m. *Trade sizes*: half an inch, of snares and toms alike.
const VENT: f64 = 0.0127;

/// What can be switched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feature {
    /// A cymbal's bell.
    Bell,
    /// The upturned rim of a china.
    Flange,
    /// Uneven thickness of a cymbal on a stand.
    Hammering,
    /// Uneven film and tension of a drum's heads.
    UnevenHead,
    /// Lugs that are counted, and where a drum's heads are pulled.
    Lugs,
    /// A vent in the shell of a drum that is closed.
    Vent,
    /// Rivets in a cymbal on a stand.
    Rivets,
}

impl Feature {
    /// All of them.
    pub const ALL: [Feature; 7] = [
        Feature::Bell,
        Feature::Flange,
        Feature::Hammering,
        Feature::Rivets,
        Feature::UnevenHead,
        Feature::Lugs,
        Feature::Vent,
    ];

    /// What it is called on screen.
    pub fn label(self) -> &'static str {
        match self {
            Feature::Bell => "With a bell",
            Feature::Flange => "China rim",
            Feature::Hammering => "Hammered",
            Feature::UnevenHead => "Uneven head",
            Feature::Lugs => "Lugs counted",
            Feature::Vent => "Vent",
            Feature::Rivets => "Rivets",
        }
    }

    /// Whether a piece has it; nothing if it cannot.
    pub fn of(self, piece: &PieceSpec) -> Option<bool> {
        match (self, &piece.instrument) {
            (Feature::UnevenHead, InstrumentSpec::Drum(drum)) => Some(drum.tension_field.is_some()),
            (Feature::Lugs, InstrumentSpec::Drum(drum)) => Some(drum.lugs.is_some()),
            (Feature::Vent, InstrumentSpec::Drum(drum)) => {
                closed(drum).map(|shell| shell.vent_diameter().is_some())
            }
            (Feature::Bell, InstrumentSpec::HiHat(hat)) => Some(hat.top.bell.is_some()),
            (Feature::Bell, InstrumentSpec::Cymbal(cymbal)) => Some(cymbal.bell.is_some()),
            (Feature::Flange, InstrumentSpec::Cymbal(cymbal)) => Some(cymbal.flange.is_some()),
            (Feature::Hammering, InstrumentSpec::Cymbal(cymbal)) => Some(cymbal.hammering.is_some()),
            (Feature::Rivets, InstrumentSpec::Cymbal(cymbal)) => Some(cymbal.rivets.is_some()),
            _ => None,
        }
    }

    /// Gives it to a piece or takes it away.
    pub fn switch(self, piece: &mut PieceSpec, on: bool) {
        match (self, &mut piece.instrument) {
            (Feature::UnevenHead, InstrumentSpec::Drum(drum)) => {
                let usual = KitSpec::standard().pieces.iter().find_map(|other| other.drum()?.tension_field);
                drum.tension_field = usual.filter(|_| on);
            }
            (Feature::Lugs, InstrumentSpec::Drum(drum)) => {
                let rods = (std::f64::consts::PI * drum.diameter / ROD_DISTANCE).round();
                let count = (rods as u32).clamp(5, 10);
                let lugs = LugsSpec { count, rms: LugsSpec::BY_EAR, seed: drum.evenness.seed };
                drum.lugs = on.then_some(lugs);
            }
            (Feature::Vent, InstrumentSpec::Drum(drum)) => {
                let vented = closed(drum).map(|shell| shell.vented(on.then_some(VENT)));
                drum.shell = vented.or(drum.shell);
            }
            (Feature::Bell, InstrumentSpec::HiHat(hat)) => {
                [&mut hat.top, &mut hat.bottom].into_iter().for_each(|cymbal| self.switch_cymbal(cymbal, on));
            }
            (_, InstrumentSpec::Cymbal(cymbal)) => self.switch_cymbal(cymbal, on),
            _ => {}
        }
    }

    fn switch_cymbal(self, cymbal: &mut CymbalSpec, on: bool) {
        let usual = usual().filter(|_| on);
        let by = usual.map_or(1.0, |usual| cymbal.diameter / usual.diameter);
        match self {
            Feature::Bell => {
                let like = |bell: Bell| Bell { radius: by * bell.radius, rise: by * bell.rise };
                cymbal.bell = usual.and_then(|usual| usual.bell).map(like);
            }
            Feature::Flange => {
                let radius = 0.5 * cymbal.diameter;
                let flange = Flange { radius: CHINA.0 * radius, rise: CHINA.1 * radius };
                cymbal.flange = on.then_some(flange);
            }
            Feature::Hammering => cymbal.hammering = usual.and_then(|usual| usual.hammering),
            Feature::Rivets => cymbal.rivets = on.then_some(RIVETS),
            Feature::UnevenHead | Feature::Lugs | Feature::Vent => {}
        }
    }

    /// Whether there are many of the kind, told apart by chance.
    pub fn is_chance(self) -> bool {
        matches!(self, Feature::Hammering | Feature::UnevenHead | Feature::Lugs)
    }

    /// Another one of the kind.
    pub fn draw_again(self, piece: &mut PieceSpec) {
        let seed = match (self, &mut piece.instrument) {
            (Feature::Hammering, InstrumentSpec::Cymbal(cymbal)) => {
                cymbal.hammering.as_mut().map(|hammering| &mut hammering.seed)
            }
            (Feature::UnevenHead, InstrumentSpec::Drum(drum)) => {
                drum.tension_field.as_mut().map(|field| &mut field.seed)
            }
            (Feature::Lugs, InstrumentSpec::Drum(drum)) => drum.lugs.as_mut().map(|lugs| &mut lugs.seed),
            _ => None,
        };
        if let Some(seed) = seed {
            *seed = seed.wrapping_add(1);
        }
    }
}

/// The shell of a drum, if air can leave it by a vent alone.
fn closed(drum: &DrumSpec) -> Option<ShellSpec> {
    drum.shell.filter(|shell| drum.resonant.is_some() || matches!(shell, ShellSpec::Kettle { .. }))
}

/// The standard kit's first cymbal.
fn usual() -> Option<CymbalSpec> {
    KitSpec::standard().pieces.iter().find_map(|piece| match piece.instrument {
        InstrumentSpec::Cymbal(cymbal) => Some(cymbal),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_switched_is_there_or_not_and_every_piece_takes_it() {
        for piece in KitSpec::standard().pieces {
            for feature in Feature::ALL {
                let Some(had) = feature.of(&piece) else { continue };
                for on in [!had, had, true] {
                    let mut changed = piece.clone();
                    feature.switch(&mut changed, on);
                    assert_eq!(feature.of(&changed), Some(on), "{} of {}", feature.label(), piece.name);
                    assert_eq!(changed.check(), Ok(()), "{} of {}", feature.label(), piece.name);
                    let mut other = changed.clone();
                    feature.draw_again(&mut other);
                    assert_eq!(other != changed, on && feature.is_chance());
                }
            }
        }
    }
}
