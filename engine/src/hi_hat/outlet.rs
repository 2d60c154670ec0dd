//! The lens of air between the cymbals of a hi-hat, and the gap of the rims as its outlet, of any width.
//!
//! Model: pressure goes as `p (r / a)^m cos(m theta)`. What it lets expand, its density being `h (r / a)^m`, flows along the lens, as high as the profiles and
//! the gap make it, as a potential: `div(h grad phi) = h (r / a)^m`. Without nodal diameters it leaves between the rims, `-phi = X h phi'` there, with `X` the air
//! between the rounded edges, `gap + x^2 / edge` high, and that of a ring in free air, `ln(8 a / e) / (2 pi)`. With nodal diameters it also goes around
//! inside. The flow's energy is the inertance, its friction that in the boundary layers of both faces (of thin ones and, where the
//! gap is thinner than they are, of all of it).
//!
//! Sources: Morse & Ingard, Theoretical Acoustics, ch. 6 (boundary layers) and 9 (lumped elements).

use std::f64::consts::{PI, TAU};

use crate::air_load::{DENSITY, SPEED_OF_SOUND};
use crate::math::bessel;
use crate::math::quadrature;

/// Nodal diameters of the pressure, from 0.
pub const ORDERS: usize = 6;

/// Orders that are heard.
pub const HEARD: usize = 3;

/// Kinematic viscosity of air, m2/s.
const VISCOSITY: f64 = 1.5e-5;

/// Gaps of the rims that it is known for, m: as high as what is rough on a turned edge, to the widest a pedal opens.
const GAPS: (f64, f64) = (2e-5, 0.05);

/// How many gaps, evenly spaced by their logarithm.
const STEPS: usize = 64;

/// Rings of the lens, closest together at the rim. *Converged*: twice as many change inertances and friction by 1e-4 at most.
const RINGS: usize = 400;

/// The lens between two cymbals.
pub struct Lens<'a> {
    /// m.
    pub radius: f64,
    /// Height at a share of the radius while the rims meet, m.
    pub height: &'a dyn Fn(f64) -> f64,
    /// Radius of the edges, m.
    pub edge: f64,
}

/// What lens and outlet are at one width of the gap.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Outlet {
    /// Of each order, m3/Pa.
    pub compliance: [f64; ORDERS],
    /// Of what goes around inside, of each order but the first, kg/m4.
    pub inside: [f64; ORDERS],
    /// Friction over inertance of what goes around inside, 1/s.
    pub slowed: [f64; ORDERS],
    /// Of what leaves, kg/m4.
    pub inertance: f64,
    /// Friction of what leaves, Pa s/m3: of slow flow, and what thin boundary layers add to that of fast flow.
    pub friction: [f64; 2],
}

/// What the air around takes as sound from the flow of one order through the rims, in its moment around them: a dashpot beside a mass, as a sphere that
/// pulsates feels. Slow flow moves the mass alone, fast flow feels the dashpot.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Outside {
    /// Pa s/m3.
    pub resistance: f64,
    /// kg/m4.
    pub inertance: f64,
}

/// Angular frequency, in units of the speed of sound over the radius, at which dashpot and mass take as much as each other and the ring's own resistance is
/// met. *Judgement*: of a hi-hat 610 Hz, the middle of what its air sounds.
const OUTSIDE: f64 = 2.0;

impl Outside {
    /// Of a ring (radius in m).
    pub fn new(m: u32, radius: f64) -> Outside {
        let omega = OUTSIDE * SPEED_OF_SOUND / radius;
        let resistance = 2.0 * sound(m, radius, omega);
        Outside { resistance, inertance: resistance / omega }
    }
}

/// Lens and outlet at any width.
pub struct Outlets(Vec<Outlet>);

/// Where a gap stands between the steps of the table.
#[derive(Debug, Clone, Copy)]
pub struct GapPosition {
    step: usize,
    share: f64,
}

impl Outlets {
    /// Of a lens. Allocates.
    pub fn new(lens: &Lens<'_>) -> Outlets {
        let gap = |step| GAPS.0 * (GAPS.1 / GAPS.0).powf(f64::from(step) / (STEPS - 1) as f64);
        Outlets((0..STEPS as u32).map(|step| Outlet::new(lens, gap(step))).collect())
    }

    fn between(&self, place: GapPosition, of: impl Fn(&Outlet) -> f64) -> f64 {
        let [one, other] = [of(&self.0[place.step]), of(&self.0[place.step + 1])];
        one + place.share * (other - one)
    }

    /// All at a gap.
    pub fn at(&self, place: GapPosition) -> Outlet {
        let (inertance, friction) = self.leaving(place);
        Outlet {
            compliance: std::array::from_fn(|m| self.between(place, |outlet| outlet.compliance[m])),
            inside: std::array::from_fn(|m| self.between(place, |outlet| outlet.inside[m])),
            slowed: std::array::from_fn(|m| self.between(place, |outlet| outlet.slowed[m])),
            inertance,
            friction,
        }
    }

    /// Inertance (kg/m4) and friction (Pa s/m3) of what leaves at a gap.
    pub fn leaving(&self, place: GapPosition) -> (f64, [f64; 2]) {
        let friction = [0, 1].map(|which: usize| self.between(place, |outlet| outlet.friction[which]));
        (self.between(place, |outlet| outlet.inertance), friction)
    }
}

impl GapPosition {
    /// Of a gap, m.
    pub fn of(gap: f64) -> GapPosition {
        let at = (gap.max(GAPS.0) / GAPS.0).ln() / (GAPS.1 / GAPS.0).ln() * (STEPS - 1) as f64;
        let step = (at as usize).min(STEPS - 2);
        GapPosition { step, share: (at - step as f64).min(1.0) }
    }
}

impl Outlet {
    /// Of a gap that is as wide all around, m.
    fn new(lens: &Lens<'_>, gap: f64) -> Outlet {
        let rings = LensRings::new(lens, gap);
        let unit = DENSITY * SPEED_OF_SOUND * SPEED_OF_SOUND;
        let compliance: [f64; ORDERS] = std::array::from_fn(|m| rings.expands(m) / unit);
        // Even pressure moves nothing inside.
        let (mut inside, mut slowed) = ([f64::MAX; ORDERS], [0.0; ORDERS]);
        for m in 1..ORDERS {
            let phi = rings.potential(m, 0.0);
            inside[m] = rings.inertance(m, &phi);
            let omega = (inside[m] * compliance[m]).sqrt().recip();
            let [slow, fast] = rings.slowed(m, &phi);
            let all = 12.0 * VISCOSITY * slow + omega * thickness(omega) * fast;
            slowed[m] = DENSITY * PI * all / rings.expands(m).powi(2) / inside[m];
        }
        let ring = (8.0 * lens.radius / (lens.edge + 0.25 * gap)).ln() / TAU;
        // A part of it belongs to the dashpot that takes the sound.
        let ring = ring - TAU * lens.radius * Outside::new(0, lens.radius).inertance / DENSITY;
        let round = (lens.edge / gap).sqrt();
        let phi = rings.potential(0, lens.radius / (ring + PI / 2.0 * round));
        let inertance = rings.inertance(0, &phi);
        let omega = (inertance * compliance[0]).sqrt().recip();
        // Over the edges' outer half, `int dx / h^3` and `int dx / h^2`.
        let narrow = [3.0 * PI / (16.0 * gap * gap), PI / (4.0 * gap)];
        let leaving = rings.expands(0) / TAU;
        let losses = [12.0 * VISCOSITY, omega * thickness(omega)];
        let friction = [0, 1].map(|which: usize| {
            let edges = leaving * leaving / lens.radius * round * narrow[which];
            let slowed = rings.slowed(0, &phi)[which] + edges;
            DENSITY * TAU * losses[which] * slowed / rings.expands(0).powi(2)
        });
        Outlet { compliance, inside, slowed, inertance, friction }
    }
}

/// Thickness of a boundary layer, m.
fn thickness(omega: f64) -> f64 {
    (2.0 * VISCOSITY / omega).sqrt()
}

/// What a ring takes as sound from the flow through it, of a moment around it, Pa s/m3.
fn sound(m: u32, radius: f64, omega: f64) -> f64 {
    let around = if m == 0 { 1.0 } else { 0.5 };
    let x = omega * radius / SPEED_OF_SOUND;
    let lobe = |cos: f64| bessel::j(m, x * (1.0 - cos * cos).sqrt()).powi(2);
    let mean = quadrature::shared_unit(16).integrate(lobe);
    DENSITY * omega * omega / (4.0 * PI * SPEED_OF_SOUND) * mean / around
}

/// The lens cut into rings, from the rim inward.
struct LensRings {
    radius: f64,
    /// Edges and middles of the rings, shares of the radius.
    edges: Vec<f64>,
    middles: Vec<f64>,
    /// Height in the middle and at the outer edge, m.
    heights: Vec<[f64; 2]>,
    /// Area over the angle and the square of the radius.
    sizes: Vec<f64>,
}

impl LensRings {
    fn new(lens: &Lens<'_>, gap: f64) -> LensRings {
        let share = |i: f64| 1.0 - (i / RINGS as f64).powi(4);
        let edges: Vec<f64> = (0..=RINGS).map(|i| share(i as f64)).collect();
        let middles: Vec<f64> = (0..RINGS).map(|i| share(i as f64 + 0.5)).collect();
        let high = |r: f64| (lens.height)(r) + gap;
        let heights = (0..RINGS).map(|i| [high(middles[i]), high(edges[i])]).collect();
        let sizes = edges.windows(2).map(|pair| 0.5 * (pair[0].powi(2) - pair[1].powi(2))).collect();
        LensRings { radius: lens.radius, edges, middles, heights, sizes }
    }

    /// What expands in a ring, over the angle, m3.
    fn source(&self, m: usize, i: usize) -> f64 {
        self.heights[i][0] * self.middles[i].powi(m as i32) * self.sizes[i] * self.radius * self.radius
    }

    /// What expands in all, weighed with the pressure, m3.
    fn expands(&self, m: usize) -> f64 {
        let around = if m == 0 { TAU } else { PI };
        around * (0..RINGS).map(|i| self.middles[i].powi(m as i32) * self.source(m, i)).sum::<f64>()
    }

    /// What flows from ring `i` outward over the difference of the potential, m; at the rim to nothing, `outside`, m.
    fn conductance(&self, i: usize, outside: f64) -> f64 {
        let (r, middle) = (self.edges[i], self.middles[i]);
        if i > 0 {
            return self.heights[i][1] * r / (self.middles[i - 1] - middle);
        }
        if outside == 0.0 { 0.0 } else { 1.0 / (1.0 / outside + (r - middle) / self.heights[0][1]) }
    }

    /// The potential of each ring, m2.
    fn potential(&self, m: usize, outside: f64) -> Vec<f64> {
        // Thomas' elimination from the middle outward: `phi[i] = factor[i] phi[i - 1] + rest[i]`.
        let (mut factor, mut rest) = (vec![0.0; RINGS + 1], vec![0.0; RINGS + 1]);
        let mut inward = 0.0;
        for i in (0..RINGS).rev() {
            let outward = self.conductance(i, outside);
            let turning = (m * m) as f64 * self.heights[i][0] * self.sizes[i] / self.middles[i].powi(2);
            let whole = outward + turning + inward * (1.0 - factor[i + 1]);
            factor[i] = outward / whole;
            rest[i] = (inward * rest[i + 1] - self.source(m, i)) / whole;
            inward = outward;
        }
        let mut phi = vec![0.0; RINGS];
        let mut outer = 0.0;
        for i in 0..RINGS {
            phi[i] = factor[i] * outer + rest[i];
            outer = phi[i];
        }
        phi
    }

    /// Twice the flow's energy over the square of what expands, kg/m4.
    fn inertance(&self, m: usize, phi: &[f64]) -> f64 {
        let around = if m == 0 { TAU } else { PI };
        let energy: f64 = -(0..RINGS).map(|i| phi[i] * self.source(m, i)).sum::<f64>();
        DENSITY * around * energy / self.expands(m).powi(2)
    }

    /// Squares of the speeds times the area, over the height and not, over the angle: `int u^2 / h r dr` and `int u^2 r dr`, m3 and m4.
    fn slowed(&self, m: usize, phi: &[f64]) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for i in 0..RINGS {
            let (height, r) = (self.heights[i][0], self.middles[i]);
            // What leaves is all that expands, of even pressure; of others nothing leaves.
            let outer = match i {
                0 if m == 0 => self.expands(0) / TAU,
                0 => 0.0,
                _ => self.conductance(i, 0.0) * (phi[i - 1] - phi[i]),
            };
            let around = m as f64 * phi[i] / r;
            let turning = m as f64 * around * height * self.sizes[i] / r;
            let outward = (outer - 0.5 * (self.source(m, i) + turning)) / (height * r);
            let square = (outward * outward + around * around) * self.sizes[i];
            sums = [sums[0] + square / height, sums[1] + square];
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::bessel;

    const RADIUS: f64 = 0.178;

    fn flat(height: f64) -> impl Fn(f64) -> f64 {
        move |_| height
    }

    fn of(height: &dyn Fn(f64) -> f64, gap: f64) -> Outlet {
        Outlet::new(&Lens { radius: RADIUS, height, edge: 1e-3 }, gap)
    }

    #[test]
    fn between_flat_discs_air_goes_around_as_in_a_shallow_cylinder() {
        let outlet = of(&flat(0.0), 0.01);
        // What `r^m` makes of the lowest resonance is a little over it.
        for m in 1..ORDERS {
            let omega = (outlet.inside[m] * outlet.compliance[m]).sqrt().recip();
            let exact = bessel::zero_prime(m as u32, 1) * SPEED_OF_SOUND / RADIUS;
            let over = omega / exact - 1.0;
            assert!((0.0..0.04).contains(&over), "m {m}: {over}");
        }
    }

    #[test]
    fn what_leaves_between_flat_discs_has_the_inertance_of_a_widening_flow_and_of_a_ring() {
        let gap = 0.01;
        let outlet = of(&flat(0.0), gap);
        // A uniform expansion: `u` goes as `r`, and its energy is a fourth of that at the rim.
        let lens = DENSITY / (8.0 * PI * gap);
        let edges = DENSITY / (TAU * RADIUS) * PI / 2.0 * (1e-3 / gap).sqrt();
        let ring = DENSITY * (8.0 * RADIUS / (1e-3 + gap / 4.0)).ln() / (4.0 * PI * PI * RADIUS);
        let want = lens + edges + ring - Outside::new(0, RADIUS).inertance;
        assert!((outlet.inertance / want - 1.0).abs() < 1e-3, "{} {want}", outlet.inertance);
        let volume = PI * RADIUS * RADIUS * gap;
        let compliance = volume / (DENSITY * SPEED_OF_SOUND * SPEED_OF_SOUND);
        assert!((outlet.compliance[0] / compliance - 1.0).abs() < 1e-6);
        // Friction of a thick layer is Poiseuille's, `12 nu / h^2` over the inertance, where all is as high.
        let slow = 12.0 * VISCOSITY / (gap * gap) * lens
            + 12.0 * VISCOSITY * DENSITY / (TAU * RADIUS) * (1e-3 / gap).sqrt() * 3.0 * PI
                / (16.0 * gap * gap);
        assert!((outlet.friction[0] / slow - 1.0).abs() < 0.01, "{} {slow}", outlet.friction[0]);
    }

    #[test]
    fn a_narrower_gap_is_heavier_and_rubs_more() {
        let height = |r: f64| 0.03 * (1.0 - r * r);
        let lens = Lens { radius: RADIUS, height: &height, edge: 1e-3 };
        let outlets = Outlets::new(&lens);
        let mut before = (0.0, [0.0; 2]);
        for gap in [0.03, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5] {
            let outlet = outlets.at(GapPosition::of(gap));
            let exact = Outlet::new(&lens, gap);
            assert!((outlet.inertance / exact.inertance - 1.0).abs() < 0.01, "{gap} m");
            assert!((outlet.friction[1] / exact.friction[1] - 1.0).abs() < 0.05, "{gap} m");
            assert!(outlet.inertance > before.0 && outlet.friction[0] > before.1[0], "{gap} m");
            before = (outlet.inertance, outlet.friction);
        }
    }

    #[test]
    fn slow_flow_radiates_as_a_point_does() {
        // Of a dashpot beside a mass, `R w^2 / (w^2 + c^2)`.
        let outside = Outside::new(0, RADIUS);
        let (omega, corner) = (TAU * 60.0, outside.resistance / outside.inertance);
        let heard = outside.resistance * omega * omega / (omega * omega + corner * corner);
        let point = DENSITY * omega * omega / (4.0 * PI * SPEED_OF_SOUND);
        let db = 10.0 * (heard / point).log10();
        assert!((-4.0..0.0).contains(&db), "{db} dB");
    }
}
