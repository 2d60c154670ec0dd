//! One cymbal of a hi-hat, as its two halves need it: modes, their shapes, what is heard, what the rim feels.
//!
//! Model: a [cymbal] without its stand: it moves as a whole by [`Rigid`](super::rigid::Rigid).
//!
//! Order of the modes: the lowest first, for whoever draws; then those that hard strokes couple, then all others,
//! each part by what the rim can tell apart (see [`Folded`]).

use std::f64::consts::TAU;

use crate::air;
use crate::cymbal::{self, CymbalSpec};
use crate::damping::{LossLaw, Muffler, Thermoelastic};
use crate::error::SpecError;
use crate::modal::Mode;
use crate::modal::simd::folded::Folded;
use crate::piece::{BuildContext, Member};
use crate::plate::free_disc::Radiated;
use crate::plate::{PlateModes, PlateTables};
use crate::shapes::{ShapeIndex, ShapeTable};
use crate::snapshot::FIELD_MODES;
use crate::split::Splitting;
use crate::von_karman::{CoupledPair, VonKarman};

use super::rigid::Mount;
use super::rim_points::POINTS;

/// One mode, as built.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfMode {
    /// Nodal diameters.
    pub m: u32,
    /// Nodal circles.
    pub n: u32,
    /// Which of a pair.
    pub member: Member,
    /// Undamped angular frequency at tuning 1, with the member's detuning, rad/s.
    pub omega: f64,
    /// Radiation resistance over twice the mass, 1/s.
    pub radiated: f64,
    /// Decay rate that the mount adds, 1/s.
    pub mounted: f64,
    /// Decay rate at full muffling, 1/s.
    pub muffling: f64,
    /// Decay rate in a firm hand, 1/s.
    pub choking: f64,
    /// Area of the monopole that would radiate its power, m2.
    pub monopole_area: f64,
}

/// How a mode is to be damped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damping {
    /// Muffling, 0 to 1.
    pub muffling: f64,
    /// How firmly a hand holds it, 0 to 1.
    pub hand: f64,
    /// How much the rims rub, 0 to 1.
    pub rubbing: f64,
    /// Nothing is lost.
    pub lossless: bool,
}

/// A cymbal as built.
pub struct Half {
    /// `[mode]`.
    pub modes: Vec<HalfMode>,
    /// How each is heard from near and from far away, as at a metre, `[mode]`: Pa s2/m of its acceleration, real
    /// and imaginary part.
    pub transfers: [Vec<[f64; 2]>; 2],
    /// What the rim feels of each.
    pub folded: Folded,
    loss: LossLaw,
    heat: Thermoelastic,
    rubbing: LossLaw,
    /// Of the plate, kg.
    pub mass: f64,
}

/// Its shapes, and what is coupled: for whoever is struck.
pub struct Struck {
    /// Shapes of the modes.
    pub shapes: ShapeTable,
    /// The stretching, the modes in front that it acts on, and the highest of them, Hz.
    pub coupled: Option<(VonKarman, usize, f64)>,
}

/// What a shell mode is to the order of the modes.
struct Ranked {
    shell: usize,
    /// Lowest, coupled, rest; then by class.
    rank: (usize, usize),
}

impl Half {
    /// Builds a cymbal whose modes are coupled up to `coupled_hz`, if they are. Allocates; takes a tenth of a second.
    ///
    /// # Errors
    /// [`SpecError`] if a number is out of range.
    pub fn new(
        spec: &CymbalSpec,
        (mount, rubbing): (&Mount, LossLaw),
        coupled_hz: Option<f64>,
        context: &BuildContext,
    ) -> Result<(Half, Struck), SpecError> {
        let BuildContext { options, receivers, ideal } = context;
        let limit_hz = cymbal::LIMIT_HZ.min(cymbal::LIMIT_OF_RATE * options.sample_rate);
        let known = cymbal::SoundingPlate::of(spec, receivers, limit_hz)?;
        let (plate, radiated) = (&known.plate, &known.radiated);
        let coupled_hz = coupled_hz.map(|hz| VonKarman::reach(plate, hz));
        let (orders, extent) = plate.table_extent(limit_hz);
        let tables = PlateTables::new(orders, extent);
        let splitting = if ideal.round { Splitting::ROUND } else { spec.evenness };
        let at_rim = plate.radial_shapes(&tables, &[1.0]);
        let at_mount = plate.radial_shapes(&tables, &[mount.reach]);
        let (mut modes, mut index, mut shares, mut pairs) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut transfers = [Vec::new(), Vec::new()];
        let mut front = 0;
        for Ranked { shell: row, rank: (part, _) } in order(plate, coupled_hz) {
            let shell = &plate.shells[row];
            let axis = spec.evenness.axis(shell.m, shell.n);
            if coupled_hz.is_some_and(|hz| shell.omega <= TAU * hz) {
                pairs.push(CoupledPair { shell: row, mode: modes.len(), axis });
            }
            for (member, detuning) in splitting.members(shell.m, shell.n) {
                modes.push(HalfMode {
                    m: shell.m,
                    n: shell.n,
                    member,
                    omega: shell.omega * detuning,
                    radiated: radiated[row].resistance / (2.0 * spec.mass),
                    mounted: mount.damping * at_mount[row].powi(2) * if shell.m == 0 { 1.0 } else { 0.5 },
                    muffling: 0.0,
                    choking: 0.0,
                    monopole_area: monopole_area(spec, shell.omega, &radiated[row]),
                });
                index.push(ShapeIndex { radial: row, rows: 1, m: shell.m, member, axis });
                let points = [(receivers.near, 1.0), (receivers.far, receivers.far.distance)];
                for (ear, (point, scale)) in points.into_iter().enumerate() {
                    let share = scale * point.toward(shell.m, member, axis);
                    transfers[ear].push(radiated[row].transfers[ear].map(|x| share * x));
                }
                shares.push(share(shell.m, member, axis, at_rim[row]));
            }
            if part < 2 {
                front = modes.len();
            }
        }
        let coupled = coupled_hz
            .filter(|_| !pairs.is_empty())
            .map(|hz| (VonKarman::new(plate, &tables, &pairs), front, hz));
        let shapes = ShapeTable::new(&plate.radial_shapes(&tables, &ShapeTable::radii()), index);
        let mut half = Half {
            modes,
            transfers,
            folded: Folded::new(&shares),
            loss: spec.loss,
            heat: Thermoelastic::bronze(&spec.plate()),
            rubbing,
            mass: spec.mass,
        };
        half.lay(spec, &shapes);
        Ok((half, Struck { shapes, coupled }))
    }

    /// Works out what the muffler and a hand take from each mode.
    fn lay(&mut self, spec: &CymbalSpec, shapes: &ShapeTable) {
        let mut shape = vec![0.0_f32; self.modes.len()];
        if let Muffler::Gel { sigma, radius, angle } = spec.muffler {
            shapes.fill(radius, angle, &mut shape);
            for (mode, &shape) in self.modes.iter_mut().zip(&shape) {
                mode.muffling = sigma * f64::from(shape).powi(2);
            }
        }
        for (share, radius, angle) in cymbal::Hand::places() {
            shapes.fill(radius, angle, &mut shape);
            for (mode, &shape) in self.modes.iter_mut().zip(&shape) {
                mode.choking += share * f64::from(shape).powi(2);
            }
        }
    }

    /// Mode `k` at a ratio of its frequency, damped.
    pub fn mode(&self, k: usize, tuning: f64, damping: &Damping) -> Mode {
        let built = &self.modes[k];
        let omega = built.omega * tuning;
        let own = self.loss.sigma(omega) + self.heat.sigma(omega) + built.radiated + built.mounted;
        let laid = damping.muffling * built.muffling
            + damping.hand * built.choking
            + damping.rubbing * self.rubbing.sigma(omega);
        Mode { omega, sigma: if damping.lossless { 0.0 } else { own + laid }, mass: self.mass }
    }
}

/// The shell modes in the order they are kept in.
fn order(plate: &PlateModes, coupled_hz: Option<f64>) -> Vec<Ranked> {
    let mut lowest = 0;
    let rank = |(shell, mode): (usize, &crate::plate::ShellMode)| {
        let members = if mode.m == 0 { 1 } else { 2 };
        let rank = if lowest < FIELD_MODES {
            lowest += members;
            (0, 0)
        } else if coupled_hz.is_some_and(|hz| mode.omega <= TAU * hz) {
            (1, class_of(mode.m).0)
        } else {
            (2, class_of(mode.m).0)
        };
        Ranked { shell, rank }
    };
    let mut ranked: Vec<Ranked> = plate.shells.iter().enumerate().map(rank).collect();
    ranked.sort_by_key(|mode| mode.rank);
    ranked
}

/// The class of an order at [`POINTS`] places, and the sign of its sine there.
fn class_of(m: u32) -> (usize, f64) {
    let rest = m as usize % POINTS;
    if rest <= POINTS / 2 { (rest, 1.0) } else { (POINTS - rest, -1.0) }
}

/// A member's class and its shares of the class's cosine and sine at the rim.
fn share(m: u32, member: Member, axis: f64, at_rim: f64) -> (usize, [f64; 2]) {
    let (class, sign) = class_of(m);
    let (sin, cos) = (f64::from(m) * axis).sin_cos();
    let (c, s) = match member {
        Member::Cosine => (cos, sin),
        Member::Sine => (-sin, cos),
    };
    // At these places the sines of the first and the last class vanish.
    let sine = if class == 0 || class == POINTS / 2 { 0.0 } else { sign * s };
    (class, [at_rim * c, at_rim * sine])
}

fn monopole_area(spec: &CymbalSpec, omega: f64, radiated: &Radiated) -> f64 {
    // Both faces are in the resistance, one in the area.
    let radius = spec.plate().radius();
    let unit = air::DENSITY * omega * radius.powi(3);
    air::monopole_area(radius, 0.5 * radiated.resistance / unit, omega)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hi_hat::rim_points;
    use crate::modal::ModalBody;
    use crate::piece::BuildOptions;
    use crate::reference;

    #[test]
    fn the_rim_feels_at_once_what_each_place_on_it_would() {
        let spec = reference::hi_hat();
        let context = reference::standard("hi-hat").context(BuildOptions::new(44_100.0));
        let (half, Struck { shapes, .. }) =
            Half::new(&spec.top, (&spec.clutch, spec.rubbing), Some(2000.0), &context).unwrap();
        let damping = Damping { muffling: 0.0, hand: 0.0, rubbing: 0.0, lossless: false };
        let modes: Vec<Mode> = (0..half.modes.len()).map(|k| half.mode(k, 1.0, &damping)).collect();
        let mut body = ModalBody::new(modes, 44_100.0);
        let bent: Vec<f32> = (0..body.len()).map(|k| ((k * 37 % 101) as f32 - 50.0) * 1e-6).collect();
        body.set_displacements(&bent);
        let all = rim_points::at_points(&body.folded_displacement(&half.folded));
        let mut port = crate::modal::Port::new(body.len());
        for (j, &at) in all.iter().enumerate() {
            shapes.fill(1.0, rim_points::angle(j), port.shape_mut());
            let want = body.displacement_at(&port);
            assert!((at - want).abs() < 1e-7, "place {j}: {at} {want}");
        }
        // Pushed everywhere at once, as pushed place by place.
        let forces: [f64; POINTS] = std::array::from_fn(|j| (j as f64 * 1.7).sin());
        let mut one_by_one = ModalBody::new(body.modes().to_vec(), 44_100.0);
        body.reset();
        body.push_folded(&half.folded, &rim_points::amplitudes(&forces));
        for (j, &force) in forces.iter().enumerate() {
            shapes.fill(1.0, rim_points::angle(j), port.shape_mut());
            one_by_one.connect(&mut port);
            one_by_one.push(&port, force as f32);
        }
        let largest = (0..body.len()).map(|k| body.displacement(k).abs()).fold(0.0, f32::max);
        for k in 0..body.len() {
            let (all, each) = (body.displacement(k), one_by_one.displacement(k));
            assert!((all - each).abs() < 1e-3 * largest, "mode {k}: {all} {each}");
        }
    }
}
