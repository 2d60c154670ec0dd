//! One cymbal of a hi-hat: modes, mode shapes, transfers, and shapes at the rim.
//!
//! Model: a [cymbal](crate::cymbal) without its stand. Its rigid motion is in [`Rigid`](super::rigid::Rigid).
//!
//! Order of the modes: the lowest, which the editor draws; then those that hard strokes couple; then all others. Each part is
//! sorted by the class at the rim (see [`RimHarmonics`]).

use std::f64::consts::{PI, TAU};

use crate::build_context::BuildContext;
use crate::cymbal::assembly::{CymbalPlate, Ordered, PlateShapes};
use crate::cymbal::modes::CymbalModes;
use crate::cymbal::spec::CymbalSpec;
use crate::damping::LossLaw;
use crate::error::SpecError;
use crate::modal::Mode;
use crate::modal::simd::rim_harmonics::RimHarmonics;
use crate::mode::Member;
use crate::plate::ShellMode;
use crate::snapshot::FIELD_MODES;

use super::gap_air::{COUPLED_HZ, Volume};
use super::outlet::ORDERS;
use super::rigid::Mount;
use super::rim_points::POINTS;

/// Damping of the modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damping {
    /// Muffling, 0 to 1.
    pub muffling: f64,
    /// Firmness of a hand that holds it, 0 to 1.
    pub hand: f64,
    /// Amount of rubbing of the rims, 0 to 1.
    pub rubbing: f64,
    /// Nothing is lost.
    pub lossless: bool,
}

/// A cymbal as built.
pub struct Half {
    /// Its modes.
    pub cymbal: CymbalModes,
    /// Shapes of the modes where the two cymbals meet.
    pub folded: RimHarmonics,
    /// What its modes without nodal diameters displace of the air between.
    pub volumes: Vec<Volume>,
    rubbing: LossLaw,
}

/// Rank of a shell mode in the order of the modes.
struct Ranked {
    shell: usize,
    /// Lowest, coupled, rest; then by class.
    rank: (usize, usize),
}

impl Half {
    /// Builds a cymbal whose modes are coupled up to `coupled_hz`, if they are, and that meets the other one at the share `meeting` of its radius; with it
    /// comes what makes a body of it.
    /// Allocates; takes a tenth of a second.
    ///
    /// # Errors
    /// [`SpecError`] if a number is out of range.
    pub fn new(
        spec: &CymbalSpec,
        (mount, rubbing): (&Mount, LossLaw),
        meeting: f64,
        coupled_hz: Option<f64>,
        context: &BuildContext,
    ) -> Result<(Half, PlateShapes), SpecError> {
        let plate = CymbalPlate::new(spec, coupled_hz, context)?;
        // The lower one lies on its seat; and what is linear does not swing.
        let plate = if coupled_hz.is_some() { plate.tilted_by_its_mount() } else { plate };
        let order = order(&plate);
        let (at_rim, at_mount) = (plate.shapes_at(meeting), plate.shapes_at(mount.reach));
        let mounted = |row: usize, shell: &ShellMode| {
            mount.damping * at_mount[row].powi(2) * if shell.m == 0 { 1.0 } else { 0.5 }
        };
        // Both members of a pair or none.
        let felt: Vec<bool> = plate.shells().iter().map(|shell| shell.omega < TAU * COUPLED_HZ).collect();
        let areas = displaced(&plate);
        let (cymbal, shapes) = plate.assemble(&[], &order, mounted);
        let index = shapes.shapes().index().iter();
        let shares: Vec<_> =
            index.map(|shape| share(shape.m, shape.member, shape.axis, at_rim[shape.radial])).collect();
        let index = shapes.shapes().index().iter().enumerate();
        let volumes = index
            .filter(|(_, shape)| (shape.m as usize) < ORDERS && felt[shape.radial])
            .map(|(mode, shape)| {
                let m = shape.m as usize;
                let [cosine, sine] = shape.member.around(shape.m, shape.axis);
                Volume { mode, m, areas: [cosine, sine].map(|share| share * areas[m][shape.radial]) }
            })
            .collect();
        Ok((Half { cymbal, folded: RimHarmonics::new(&shares), volumes, rubbing }, shapes))
    }

    /// Mode `k` at a ratio of its frequency, damped.
    pub fn mode(&self, k: usize, tuning: f64, damping: &Damping) -> Mode {
        let (bare, built) = (self.cymbal.bare(k, tuning), &self.cymbal.modes[k]);
        let own = self.cymbal.sigma(k, bare.omega);
        let laid = damping.muffling * built.muffling
            + damping.hand * built.choking
            + damping.rubbing * self.rubbing.sigma(bare.omega);
        Mode { sigma: if damping.lossless { 0.0 } else { own + laid }, ..bare }
    }
}

/// Integrals of each shell mode's shape times `(r / a)^m cos(m theta)`, were it of that many nodal diameters, m2, `[m][shell]`.
fn displaced(plate: &CymbalPlate<'_>) -> [Vec<f64>; ORDERS] {
    const RINGS: usize = 64;
    let disc = PI * plate.radius().powi(2);
    let mut areas: [Vec<f64>; ORDERS] = std::array::from_fn(|_| vec![0.0; plate.shells().len()]);
    for ring in 0..RINGS {
        // Rings of equal area.
        let r = ((ring as f64 + 0.5) / RINGS as f64).sqrt();
        let shapes = plate.shapes_at(r);
        for (m, areas) in areas.iter_mut().enumerate() {
            let area = disc / if m == 0 { 1.0 } else { 2.0 };
            let weight = area * r.powi(m as i32) / RINGS as f64;
            areas.iter_mut().zip(&shapes).for_each(|(sum, shape)| *sum += weight * shape);
        }
    }
    areas
}

/// The shell modes in the order they are kept in.
fn order(plate: &CymbalPlate<'_>) -> Vec<Ordered> {
    let mut lowest = 0;
    let rank = |(shell, mode): (usize, &ShellMode)| {
        let members = if mode.m == 0 { 1 } else { 2 };
        let rank = if lowest < FIELD_MODES {
            lowest += members;
            (0, 0)
        } else if plate.is_coupled(mode) {
            (1, class_of(mode.m).0)
        } else {
            (2, class_of(mode.m).0)
        };
        Ranked { shell, rank }
    };
    let mut ranked: Vec<Ranked> = plate.shells().iter().enumerate().map(rank).collect();
    ranked.sort_by_key(|mode| mode.rank);
    ranked.iter().map(|mode| Ordered { shell: mode.shell, is_coupled: mode.rank.0 < 2 }).collect()
}

/// The class of an order at [`POINTS`] points, and the sign of its sine there.
fn class_of(m: u32) -> (usize, f64) {
    let rest = m as usize % POINTS;
    if rest <= POINTS / 2 { (rest, 1.0) } else { (POINTS - rest, -1.0) }
}

/// A member's class and its shares of the class's cosine and sine at the rim.
fn share(m: u32, member: Member, axis: f64, at_rim: f64) -> (usize, [f64; 2]) {
    let (class, sign) = class_of(m);
    let [c, s] = member.around(m, axis);
    // At these points the sines of the first and the last class are zero.
    let sine = if class == 0 || class == POINTS / 2 { 0.0 } else { sign * s };
    (class, [at_rim * c, at_rim * sine])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build_context::BuildOptions;
    use crate::hi_hat::rim_points;
    use crate::modal::ModalBody;
    use crate::reference;

    #[test]
    fn the_rim_feels_at_once_what_each_place_on_it_would() {
        let spec = reference::hi_hat();
        let context = reference::standard("hi-hat").context(BuildOptions::new(44_100.0));
        let (half, plate) =
            Half::new(&spec.top, (&spec.clutch, spec.rubbing), 1.0, Some(2000.0), &context).unwrap();
        let shapes = plate.shapes();
        let damping = Damping { muffling: 0.0, hand: 0.0, rubbing: 0.0, lossless: false };
        let modes: Vec<Mode> = (0..half.cymbal.modes.len()).map(|k| half.mode(k, 1.0, &damping)).collect();
        let mut body = ModalBody::new(modes, 44_100.0);
        let bent: Vec<f32> = (0..body.len()).map(|k| ((k * 37 % 101) as f32 - 50.0) * 1e-6).collect();
        body.set_displacements(&bent);
        let all = rim_points::at_points(&rim_points::fine(&body.folded_displacement(&half.folded)));
        let mut port = crate::modal::InputVector::new(body.len());
        for (j, &at) in all.iter().enumerate() {
            shapes.fill(1.0, rim_points::angle(j), port.shape_mut());
            let want = body.displacement_at(&port);
            assert!((at - want).abs() < 1e-7, "place {j}: {at} {want}");
        }
        // Pushed everywhere at once, as pushed place by place.
        let forces: [f64; POINTS] = std::array::from_fn(|j| (j as f64 * 1.7).sin());
        let mut one_by_one = ModalBody::new(body.modes().to_vec(), 44_100.0);
        body.reset();
        body.push_folded(&half.folded, &rim_points::rounded(&rim_points::amplitudes(&forces)));
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
