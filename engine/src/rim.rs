//! The rim of a drum: the steel hoop that a stick's shaft meets in a rimshot and a cross-stick.
//!
//! Model: a free ring that bends out of its plane and twists,
//!
//! ```text
//! omega_n^2 = E I / (rho A R^4) * n^2 (n^2 - 1)^2 / (n^2 + 1 + E I / (G J)),   n = 2, 3, ...
//! ```
//!
//! with two members each, the drum as a whole bouncing on its stand, and the [wall](crate::shell) of the shell, which a stroke on the hoop bends
//! by way of the lugs. The hoop is heard as the narrow ring that its top is, in a baffle.
//!
//! Neglected: what the rods and the head's pull add to the hoop, but for its loss; the rim does not move the head's edge.
//!
//! Source: Love, The Mathematical Theory of Elasticity, sec. 293 (ring, motion at right angles to its plane).

use std::convert::Infallible;
use std::f64::consts::{PI, SQRT_2, TAU};

use serde::{Deserialize, Serialize};

use crate::air_load::{DENSITY, SPEED_OF_SOUND};
use crate::cache::Cache;
use crate::contact::Material;
use crate::modal::Mode;
use crate::mode::{Member, ModeKind};
use crate::numbers::{Numbers, Visitor};
use crate::receiver::{POINTS, ReceiverPosition, Receivers};
use crate::schema::SCHEMA;
use crate::shell::{Cylinder, WallMode};

/// How a wall's modes are heard, `[mode][point]`.
static WALLS: Cache<Vec<[[f64; 2]; POINTS]>> = Cache::new("wall", SCHEMA, 24);

/// A hoop's description, and of the stand its drum is on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HoopSpec {
    /// What it is made of, of at least 1 GPa.
    pub material: Material,
    /// Thickness of its wall, m, 0.0005 to 0.03.
    #[serde(rename = "wall_m")]
    pub wall: f64,
    /// Height, m, 0.01 to 0.1.
    #[serde(rename = "height_m")]
    pub height: f64,
    /// What flanges add to the height that is bent, m, 0 to 0.05.
    #[serde(rename = "flange_m")]
    pub flange: f64,
    /// Quality factor of its modes: gaskets, rods and the head take much, 2 to 1000.
    pub q: f64,
    /// The drum on its stand: mass, kg, 0.3 to 50.
    #[serde(rename = "drum_mass_kg")]
    pub drum_mass: f64,
    /// Frequency at which the drum bounces on its stand, Hz, 1 to 100.
    pub stand_hz: f64,
    /// Quality factor of the bounce, 0.6 to 100.
    pub stand_q: f64,
}

impl Numbers for HoopSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.material.visit_bearing(visitor);
        visitor.number("wall_m", &mut self.wall, 5e-4..=0.03);
        visitor.number("height_m", &mut self.height, 0.01..=0.1);
        visitor.number("flange_m", &mut self.flange, 0.0..=0.05);
        visitor.number("q", &mut self.q, 2.0..=1000.0);
        visitor.number("drum_mass_kg", &mut self.drum_mass, 0.3..=50.0);
        visitor.number("stand_hz", &mut self.stand_hz, 1.0..=100.0);
        visitor.number("stand_q", &mut self.stand_q, 0.6..=100.0);
    }
}

/// A hoop as a ring.
struct Ring {
    /// Mass per length, kg/m.
    line: f64,
    /// Rigidity against being bent out of its plane, N m2.
    bending: f64,
    /// Against being twisted, N m2.
    torsion: f64,
}

impl HoopSpec {
    /// A hoop of maple, as bass drums have it, out of a stick's reach: 9.5 mm by 40 mm (*trade sizes*).
    pub const OUT_OF_REACH: HoopSpec = HoopSpec {
        material: Material::MAPLE,
        wall: 9.5e-3,
        height: 0.040,
        flange: 0.0,
        q: 25.0,
        drum_mass: 8.0,
        stand_hz: 20.0,
        stand_q: 2.0,
    };

    fn ring(&self) -> Ring {
        let HoopSpec { material, wall, height, flange, .. } = *self;
        let shear = material.youngs_modulus / (2.0 * (1.0 + material.poisson_ratio));
        let area = wall * (height + flange);
        Ring {
            line: material.density * area,
            bending: material.youngs_modulus * (wall * height.powi(3) / 12.0),
            torsion: shear * (height + flange) * wall.powi(3) / 3.0,
        }
    }

    /// Load on a hoop of that radius (m) that bends it out of its plane in `n` periods around, over the displacement, N/m2.
    pub fn stiffness(&self, radius: f64, n: u32) -> f64 {
        let Ring { bending, torsion, .. } = self.ring();
        let n2 = f64::from(n * n);
        bending / radius.powi(4) * n2 * (n2 - 1.0).powi(2) / (n2 + 1.0 + bending / torsion)
    }
}

/// Radius of the edge that a shaft meets, m, is the stick's; the hoop is taken as flat. Width of the
/// hoop's top as it is heard, m.
const WIDTH: f64 = 0.012;

/// Highest mode, Hz.
const LIMIT_HZ: f64 = 16_000.0;

/// A rim as a modal body.
#[derive(Debug, Clone, PartialEq)]
pub struct Rim {
    /// Radius, m.
    pub radius: f64,
    /// What the shaft meets.
    pub material: Material,
    /// One of the body each.
    pub modes: Vec<RimMode>,
}

/// What of a drum moves in a mode of its rim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RimPart {
    /// The whole drum, on its stand.
    Drum,
    /// The hoop.
    Hoop,
    /// The wall of the shell.
    Wall,
}

/// One mode of a rim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RimMode {
    /// What moves.
    pub part: RimPart,
    /// Waves around.
    pub n: u32,
    /// Half waves along the shell; 0 of the hoop.
    pub k: u32,
    /// Member of the pair.
    pub member: Member,
    /// The motion.
    pub mode: Mode,
    /// Largest displacement of the hoop per modal displacement, dimensionless.
    pub largest: f64,
    /// Pressure over modal acceleration at each point, far away as at a metre, Pa s2/m.
    pub transfers: [[f64; 2]; POINTS],
}

impl Rim {
    /// The rim of a drum of that radius (m), as receivers hear it; without losses if asked to.
    pub fn new(
        radius: f64,
        hoop: &HoopSpec,
        shell: Option<&Cylinder>,
        receivers: &Receivers,
        lossless: bool,
    ) -> Rim {
        let Ring { line, bending, torsion } = hoop.ring();
        let material = hoop.material;
        let unit = bending / (line * radius.powi(4));
        let loss = |omega: f64, q: f64| if lossless { 0.0 } else { omega / (2.0 * q) };
        let (mass, hz, q) = (hoop.drum_mass, hoop.stand_hz, hoop.stand_q);
        let bounce = Mode { omega: TAU * hz, sigma: loss(TAU * hz, q), mass };
        let mut modes = vec![RimMode {
            part: RimPart::Drum,
            n: 0,
            k: 0,
            member: Member::Cosine,
            mode: bounce,
            largest: 1.0,
            transfers: heard(receivers, |point| transfer(radius, point, 0, bounce.omega)),
        }];
        for n in 2.. {
            let n2 = f64::from(n * n);
            let omega = (unit * n2 * (n2 - 1.0).powi(2) / (n2 + 1.0 + bending / torsion)).sqrt();
            if omega > TAU * LIMIT_HZ {
                break;
            }
            let mode = Mode { omega, sigma: loss(omega, hoop.q), mass: line * TAU * radius };
            let heard = heard(receivers, |point| transfer(radius, point, n, omega));
            for member in [Member::Cosine, Member::Sine] {
                let transfers = shown(heard, receivers, n, member);
                let (part, largest) = (RimPart::Hoop, SQRT_2);
                modes.push(RimMode { part, n, k: 0, member, mode, largest, transfers });
            }
        }
        shell.into_iter().for_each(|wall| modes.extend(wall_modes(wall, receivers, lossless)));
        Rim { radius, material, modes }
    }

    /// Displacement of the hoop at an angle (rad) per modal displacement, `[mode]`.
    pub fn shape(&self, angle: f64, out: &mut [f32]) {
        for (out, mode) in out.iter_mut().zip(&self.modes) {
            let (sin, cos) = (f64::from(mode.n) * angle).sin_cos();
            let around = match mode.member {
                Member::Cosine => cos,
                Member::Sine => sin,
            };
            *out = (mode.largest * around) as f32;
        }
    }

    /// What a row of the list of modes says.
    pub fn kind(mode: &RimMode) -> ModeKind {
        if mode.part == RimPart::Drum { ModeKind::Rigid } else { ModeKind::Complete }
    }
}

impl RimMode {
    /// Area of the monopole in a baffle that would be heard as loud far away, in the first direction, m2.
    pub fn monopole_area(&self) -> f64 {
        let [re, im] = self.transfers[1];
        TAU / DENSITY * re.hypot(im)
    }
}

/// A transfer to each point, far away as at a metre.
fn heard(receivers: &Receivers, transfer: impl Fn(ReceiverPosition) -> [f64; 2]) -> [[f64; 2]; POINTS] {
    let (points, scales) = (receivers.points(), receivers.scales());
    std::array::from_fn(|i| transfer(points[i]).map(|h| h * scales[i]))
}

/// What a member shows of its pair toward each point.
fn shown(heard: [[f64; 2]; POINTS], receivers: &Receivers, n: u32, member: Member) -> [[f64; 2]; POINTS] {
    let points = receivers.points();
    std::array::from_fn(|i| heard[i].map(|h| h * points[i].toward(n, member, 0.0)))
}

/// The modes of a shell's wall, members one by one.
fn wall_modes(wall: &Cylinder, receivers: &Receivers, lossless: bool) -> Vec<RimMode> {
    let modes = wall.modes(lossless);
    let at_points = |own: &WallMode| heard(receivers, |point| wall.transfer(own, point));
    let Ok(transfers) = WALLS
        .get(&(wall, receivers), || Ok::<_, Infallible>(modes.iter().map(at_points).collect::<Vec<_>>()));
    let mut members = Vec::with_capacity(2 * modes.len());
    for (own, &heard) in modes.iter().zip(&*transfers) {
        for member in [Member::Cosine, Member::Sine].into_iter().take(if own.n == 0 { 1 } else { 2 }) {
            let transfers = shown(heard, receivers, own.n, member);
            let (part, largest) = (RimPart::Wall, own.hoop);
            members.push(RimMode { part, n: own.n, k: own.k, member, mode: own.mode, largest, transfers });
        }
    }
    members
}

/// Rayleigh integral over a narrow ring; largest toward the point. The delay from the centre is taken out.
fn transfer(radius: f64, point: ReceiverPosition, n: u32, omega: f64) -> [f64; 2] {
    let k = omega / SPEED_OF_SOUND;
    let (sin, cos) = point.inclination.sin_cos();
    let (height, offset) = (point.distance * cos, point.distance * sin);
    let steps = 32 + 4 * n as usize + (4.0 * k * radius) as usize;
    let (mut re, mut im) = (0.0, 0.0);
    for i in 0..steps {
        let theta = TAU * (i as f64 + 0.5) / steps as f64;
        let d = (height * height + offset * offset + radius * radius - 2.0 * offset * radius * theta.cos())
            .sqrt();
        let around = if n == 0 { 1.0 } else { SQRT_2 * (f64::from(n) * theta).cos() };
        let (sin_kd, cos_kd) = (k * (point.distance - d)).sin_cos();
        re += around * cos_kd / d;
        im += around * sin_kd / d;
    }
    let scale = -DENSITY / (2.0 * PI) * TAU * radius * WIDTH / steps as f64;
    [scale * re, scale * im]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kit_spec::KitSpec;
    use crate::receiver::DIRECTIONS;

    /// The hoop of the standard kit's drums.
    fn hoop() -> HoopSpec {
        KitSpec::standard().drums().find_map(|(_, drum)| drum.hoop).unwrap()
    }

    /// The same point three times.
    fn receivers() -> Receivers {
        let point = ReceiverPosition { distance: 0.5, inclination: 0.6, azimuth: 0.4 };
        Receivers { near: point, far: [point; DIRECTIONS] }
    }

    #[test]
    fn a_snare_hoop_rings_where_hoops_ring() {
        let rim = Rim::new(0.178, &hoop(), None, &receivers(), false);
        let hz = |n: u32| rim.modes.iter().find(|mode| mode.n == n).unwrap().mode.omega / TAU;
        assert!((80.0..250.0).contains(&hz(2)), "{}", hz(2));
        assert!((300.0..800.0).contains(&hz(3)), "{}", hz(3));
        // A kilogram of steel, within a half.
        assert!((0.7..1.5).contains(&rim.modes[1].mode.mass), "{}", rim.modes[1].mode.mass);
    }

    #[test]
    fn shapes_are_of_unit_mean_square() {
        let rim = Rim::new(0.15, &hoop(), None, &receivers(), false);
        let mut sum = vec![0.0_f64; rim.modes.len()];
        let mut out = vec![0.0_f32; rim.modes.len()];
        for i in 0..720 {
            rim.shape(TAU * f64::from(i) / 720.0, &mut out);
            sum.iter_mut().zip(&out).for_each(|(sum, &x)| *sum += f64::from(x * x) / 720.0);
        }
        assert!(sum.iter().all(|square| (square - 1.0).abs() < 1e-5), "{sum:?}");
    }
}
