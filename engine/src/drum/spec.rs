//! The drums: sizes, heads, pitches.

use crate::cavity::CavitySpec;
use crate::contact::Material;
use crate::damping::{LossLaw, Muffler};
use crate::drum::coupled::Outside;
use crate::error::SpecError;
use crate::listening::ListeningPoint;
use crate::membrane::MembraneSpec;
use crate::piece::BuildOptions;
use crate::split::Splitting;

/// A head of a drum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeadSpec {
    /// The film.
    pub membrane: MembraneSpec,
    /// Its own modes up to this enter the drum's, at the default pitch, Hz.
    pub limit_hz: f64,
}

/// The head that is not struck.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResonantSpec {
    /// The head.
    pub head: HeadSpec,
    /// Ratio of its pitch to the batter's, each by itself in air.
    pub pitch_ratio: f64,
}

/// A drum's description.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrumSpec {
    /// The head that is struck.
    pub batter: HeadSpec,
    /// The other one.
    pub resonant: Option<ResonantSpec>,
    /// The air inside; `None` for a head on its own, with air on both faces.
    pub cavity: Option<CavitySpec>,
    /// What surrounds the drum.
    pub outside: Outside,
    /// The batter's mode whose frequency is the drum's pitch: nodal diameters, nodal circles.
    pub named_mode: (u32, u32),
    /// Whether that is its frequency in the drum; otherwise it is that of the head by itself in air, before the
    /// shell couples it, which is how drummers name what they tune.
    pub tuned_as_heard: bool,
    /// Lowest, default and highest pitch, Hz.
    pub pitch_hz: (f64, f64, f64),
    /// What muffles it.
    pub muffler: Muffler,
    /// How uneven the heads are.
    pub splitting: Splitting,
    /// Where it is heard from.
    pub listening_point: ListeningPoint,
    /// In which direction it is heard from far.
    pub far_point: ListeningPoint,
    /// Whether snare wires lie against the resonant head.
    pub wires: bool,
    /// Whether there is a rim within a stick's reach.
    pub rim: bool,
}

const INCH: f64 = 0.0254;

/// Thickness of all plies, m, and how many they are: of tom and kick heads.
const TWO_PLY: (f64, u32) = (0.36e-3, 2);
/// Of single films.
const SINGLE_PLY: (f64, u32) = (0.19e-3, 1);

/// Modes of a struck head reach this far; above, single modes can no longer be told apart. Hz.
const BATTER_LIMIT: f64 = 3000.0;

/// What a pillow takes from the air that goes past it, 1/s: `r / (2 rho)` of all the air if none could go around
/// it, with the flow resistivity `r` of polyester filling, 850 Pa s/m2 at 12 kg/m3 (*literature*: Garai & Pompoli,
/// Applied Acoustics 66, 2005); and a third of that, for at 60 Hz so much of the flow finds the way around a
/// pillow of a third of the shell's width. *Derived*.
const PILLOW_FLOW: f64 = 0.35 * 850.0 / (2.0 * crate::air::DENSITY);

/// A head of that radius (m), thickness (m) of so many plies, and loss.
fn head(radius: f64, (thickness, plies): (f64, u32), loss: LossLaw, limit_hz: f64) -> HeadSpec {
    let material = Material::FILM;
    HeadSpec { membrane: MembraneSpec { radius, thickness, plies, material, loss }, limit_hz }
}

/// Losses of films. *Measured*: drums are recorded with 0.32 to 0.36 s at 8 kHz whatever their heads, of which the
/// room's tail is a part; these leave a head on its own 0.25 s there, and the octaves from 500 Hz to 2 kHz where recordings
/// have them. The literature's 5 to 12 1/s per kHz leaves 0.07 to 0.16 s. The kick's constant part is the felt
/// strip and what else leans on its head.
const KICK_LOSS: LossLaw = LossLaw { constant: 6.0, per_khz: 3.0 };
const TOM_LOSS: LossLaw = LossLaw { constant: 3.0, per_khz: 3.0 };
const SNARE_LOSS: LossLaw = LossLaw { constant: 4.0, per_khz: 3.0 };
const SNARE_SIDE_LOSS: LossLaw = LossLaw { constant: 3.0, per_khz: 2.0 };

/// A pillow that leans on a kick's head.
pub const PILLOW: Muffler = Muffler::Pillow { sigma: 21.0, flow: PILLOW_FLOW };

impl DrumSpec {
    /// What its modes and their shapes follow from, as text in which every number stands exactly.
    pub(crate) fn body(&self) -> String {
        let DrumSpec { batter, resonant, cavity, outside, named_mode, tuned_as_heard, pitch_hz, .. } = self;
        format!("{batter:?} {resonant:?} {cavity:?} {outside:?} {named_mode:?} {tuned_as_heard} {pitch_hz:?}")
    }

    /// A shell of that size with a head on either end.
    fn two_headed(
        diameter_in: f64,
        depth_in: f64,
        batter: ((f64, u32), LossLaw),
        resonant: ResonantSpec,
    ) -> DrumSpec {
        let (radius, depth) = (0.5 * diameter_in * INCH, depth_in * INCH);
        DrumSpec {
            batter: head(radius, batter.0, batter.1, BATTER_LIMIT),
            resonant: Some(resonant),
            cavity: Some(CavitySpec::cylinder(radius, depth)),
            outside: Outside::Free { length: depth },
            named_mode: (0, 1),
            tuned_as_heard: false,
            pitch_hz: (55.0, 82.0, 160.0),
            muffler: Muffler::GEL,
            splitting: Splitting::DRUM,
            listening_point: ListeningPoint { distance: 0.5, inclination: 0.6, azimuth: 0.4 },
            far_point: ListeningPoint::far(0.6, 0.4),
            wires: false,
            rim: false,
        }
    }

    /// A clear single-ply head, modes to `limit_hz`.
    fn single_ply(diameter_in: f64, pitch_ratio: f64, limit_hz: f64) -> ResonantSpec {
        let head = head(0.5 * diameter_in * INCH, SINGLE_PLY, LossLaw::SINGLE_PLY, limit_hz);
        ResonantSpec { head, pitch_ratio }
    }

    /// 22 x 18 in bass drum with a pillow.
    pub fn kick() -> DrumSpec {
        let batter = (TWO_PLY, KICK_LOSS);
        DrumSpec {
            pitch_hz: (35.0, 55.0, 90.0),
            muffler: PILLOW,
            ..DrumSpec::two_headed(22.0, 18.0, batter, DrumSpec::single_ply(22.0, 1.10, 1000.0))
        }
    }

    /// 14 x 5.5 in snare drum.
    pub fn snare() -> DrumSpec {
        let batter = ((0.25e-3, 1), SNARE_LOSS);
        let head = head(7.0 * INCH, (0.076e-3, 1), SNARE_SIDE_LOSS, BATTER_LIMIT);
        let side = ResonantSpec { head, pitch_ratio: 1.50 };
        DrumSpec {
            pitch_hz: (140.0, 220.0, 360.0),
            wires: true,
            rim: true,
            ..DrumSpec::two_headed(14.0, 5.5, batter, side)
        }
    }

    /// Toms: two-ply batter, single-ply resonant head.
    fn tom(diameter_in: f64, depth_in: f64) -> DrumSpec {
        let batter = (TWO_PLY, TOM_LOSS);
        let resonant = DrumSpec::single_ply(diameter_in, 1.15, 1500.0);
        DrumSpec { rim: true, ..DrumSpec::two_headed(diameter_in, depth_in, batter, resonant) }
    }

    /// 12 x 9 in rack tom.
    pub fn rack_tom() -> DrumSpec {
        DrumSpec { pitch_hz: (90.0, 140.0, 260.0), ..DrumSpec::tom(12.0, 9.0) }
    }

    /// 16 x 16 in floor tom.
    pub fn floor_tom() -> DrumSpec {
        DrumSpec::tom(16.0, 16.0)
    }

    /// 26 in timpani on a kettle of 0.14 m3.
    pub fn timpani() -> DrumSpec {
        let (radius, volume) = (13.0 * INCH, 0.14);
        let depth = volume / (std::f64::consts::PI * radius * radius);
        let batter = (SINGLE_PLY, LossLaw { constant: 0.6, per_khz: 1.5 });
        let unused = DrumSpec::single_ply(26.0, 1.0, 100.0);
        DrumSpec {
            resonant: None,
            cavity: Some(CavitySpec { volume, ..CavitySpec::cylinder(radius, depth) }),
            outside: Outside::Baffle,
            named_mode: (1, 1),
            tuned_as_heard: true,
            pitch_hz: (87.3, 130.8, 196.0),
            splitting: Splitting::CLEARED,
            ..DrumSpec::two_headed(26.0, depth / INCH, batter, unused)
        }
    }

    /// The drum's batter on its own, with air on both faces: no shell, no other head.
    pub fn head_alone(self) -> DrumSpec {
        DrumSpec { resonant: None, cavity: None, outside: Outside::Baffle, wires: false, ..self }
    }

    /// The drum without what closes it: a shell without its other head (a concert tom), or a timpani's head without
    /// its kettle.
    pub fn opened(self) -> DrumSpec {
        match self.outside {
            Outside::Baffle => self.head_alone(),
            Outside::Free { .. } => {
                let cavity = self.cavity.map(|cavity| CavitySpec { open: true, ..cavity });
                DrumSpec { resonant: None, cavity, wires: false, ..self }
            }
        }
    }

    /// The drum built otherwise, as the options ask.
    pub fn with(self, options: &BuildOptions) -> DrumSpec {
        let whole = if options.open { self.opened() } else { self };
        let retuned = |resonant: ResonantSpec| ResonantSpec {
            pitch_ratio: options.resonant_ratio.unwrap_or(resonant.pitch_ratio),
            ..resonant
        };
        let detuning = options.unevenness.unwrap_or(self.splitting.detuning);
        DrumSpec {
            resonant: whole.resonant.map(retuned),
            splitting: Splitting { detuning, ..self.splitting },
            muffler: options.muffler.unwrap_or(self.muffler),
            ..whole
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`SpecError`] naming the field.
    pub fn validated(self) -> Result<DrumSpec, SpecError> {
        let (low, pitch, high) = self.pitch_hz;
        SpecError::check("lowest pitch (Hz)", low, 15.0, 2000.0)?;
        SpecError::check("highest pitch (Hz)", high, 1.01 * low, 8.0 * low)?;
        SpecError::check("pitch (Hz)", pitch, low, high)?;
        self.batter.membrane.validated()?;
        if let Some(resonant) = self.resonant {
            resonant.head.membrane.validated()?;
            SpecError::check("resonant pitch ratio", resonant.pitch_ratio, 0.5, 2.5)?;
        }
        SpecError::check("detuning of pairs", self.splitting.detuning, 0.0, 0.05)?;
        if let Muffler::Gel { radius, .. } | Muffler::Ring { inner: radius, .. } = self.muffler {
            SpecError::check("place of the muffler (share of the radius)", radius, 0.0, 0.99)?;
        }
        if let Some(cavity) = self.cavity {
            SpecError::check("volume inside (m3)", cavity.volume, 1e-4, 1.0)?;
            SpecError::check("depth inside (m)", cavity.depth, 0.01, 2.0)?;
            SpecError::check("quality of the air inside", cavity.q, 1.0, 1e6)?;
        }
        Ok(self)
    }
}
