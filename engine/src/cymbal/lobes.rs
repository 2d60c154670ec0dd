//! What a cymbal's modes show of themselves toward receivers while it swings.
//!
//! Model: of a mode with `m` nodal diameters, a direction at the inclination `i` and the azimuth `a` from the tilted cymbal's axis
//! receives its [far pattern](FarPattern) at `i`, times `cos m (a - axis)` or the sine. What a receiver hears is what it hears of
//! the cymbal at rest, and the difference of the patterns in both directions, spread over its distance.
//!
//! Limits: so near that the waves have not parted, the difference is that of the far field. Mean and size are right there, single
//! modes are not.

use std::ops::Range;

use crate::cache::Shared;
use crate::math::cubic::Stencil;
use crate::math::negligible::drop_negligible;
use crate::modal::simd::Kernels;
use crate::modal::simd::row_products::RowProducts;
use crate::modal::{Row, zero_row};
use crate::plate::free_disc::{DIRECTIONS, FarPattern};
use crate::receiver::{POINTS, ReceiverPosition, Receivers};
use crate::shapes::ShapeIndex;
use crate::surface::swing::Directivity;

/// What differs from rest in what the points hear of every mode, Pa s2/m: `[2 point + (real, imaginary)][mode]`.
type Changes = [Row; 2 * POINTS];

/// Nodal diameters of any mode are fewer.
const ORDERS: usize = 160;

/// A plain mode as directions receive it.
#[derive(Debug, Clone, Copy)]
struct Lobe {
    /// Row of its pattern; none of a motion that is not heard.
    shell: Option<u32>,
    m: u32,
    /// Shares of `cos m a` and `sin m a` in what it shows.
    around: [f32; 2],
}

/// A direction seen from the tilted cymbal.
#[derive(Clone)]
struct Direction {
    stencil: Stencil,
    cosine: f64,
    /// `cos m a` and `sin m a`, `[m]`.
    around: Vec<[f32; 2]>,
}

impl Direction {
    fn new() -> Direction {
        Direction { stencil: Stencil::at(0.0, DIRECTIONS), cosine: 1.0, around: vec![[1.0, 0.0]; ORDERS] }
    }

    /// Turns to a vector of unit length.
    fn turn(&mut self, [x, y, z]: [f64; 3]) {
        let sine = libm::hypot(x, y).min(1.0);
        self.stencil = Stencil::at(sine * (DIRECTIONS - 1) as f64, DIRECTIONS);
        self.cosine = z;
        let (c, s) = if sine > 1e-9 { (x / sine, y / sine) } else { (1.0, 0.0) };
        let (mut re, mut im) = (1.0, 0.0);
        for around in &mut self.around {
            *around = [re as f32, im as f32];
            (re, im) = (re * c - im * s, im * c + re * s);
        }
    }

    /// How much of its pattern a mode shows, dimensionless.
    #[inline(always)]
    fn shown(&self, lobe: &Lobe) -> f32 {
        let [cos, sin] = self.around[lobe.m as usize];
        self.cosine as f32 * (lobe.around[0] * cos + lobe.around[1] * sin)
    }
}

/// Far patterns of all shell modes, those of one direction side by side: a turn reads four directions from one end to the other, where it
/// would wait for the memory at every pattern.
struct Patterns {
    shells: usize,
    /// `[direction][shell]`, Pa s2/m at a metre.
    all: Vec<[f32; 2]>,
}

impl Patterns {
    fn new(patterns: &[FarPattern]) -> Patterns {
        let shells = patterns.len();
        let mut all = vec![[0.0; 2]; DIRECTIONS * shells];
        for (shell, FarPattern(pattern)) in patterns.iter().enumerate() {
            let mut pattern = pattern.clone();
            drop_negligible(pattern.as_flattened_mut());
            pattern.into_iter().enumerate().for_each(|(i, heard)| all[i * shells + shell] = heard);
        }
        Patterns { shells, all }
    }

    /// What a shell mode has in a direction, Pa s2/m at a metre.
    #[inline(always)]
    fn toward(&self, direction: &Direction, shell: usize) -> [f32; 2] {
        let mut sum = [0.0; 2];
        for (i, weight) in direction.stencil.weights.iter().enumerate() {
            let [re, im] = self.all[(direction.stencil.first + i) * self.shells + shell];
            sum[0] += *weight as f32 * re;
            sum[1] += *weight as f32 * im;
        }
        sum
    }
}

/// A receiver.
struct LobeReceiver {
    /// Toward it from the cymbal at rest, of unit length.
    toward: [f64; 3],
    /// Pressure there over that at a metre.
    spread: f32,
    now: Direction,
    /// `[mode]`: what it hears at rest, Pa s2/m, and of that the patterns' part of the plain modes.
    rest: Vec<[f64; 2]>,
    plain_at_rest: Vec<[f32; 2]>,
}

/// The lobes of all modes.
pub struct Lobes {
    kernels: Kernels,
    patterns: Patterns,
    mixture: Option<Shared<RowProducts>>,
    lobes: Vec<Lobe>,
    receivers: [LobeReceiver; POINTS],
    /// Of plain modes and of those that are heard.
    plain: Changes,
    mixed: Changes,
}

impl Lobes {
    /// Those of a plate with these patterns, `[shell]`, of whose plain modes the first are `rigid` motions; `shells` are the others' rows;
    /// `rest` is heard at rest at each point, far away as at a metre, Pa s2/m `[mode]`. Allocates.
    pub fn new(
        patterns: &[FarPattern],
        mixture: Option<Shared<RowProducts>>,
        (index, shells, rigid): (&[ShapeIndex], &[usize], usize),
        receivers: &Receivers,
        mut rest: [Vec<[f64; 2]>; POINTS],
    ) -> Lobes {
        let lobe = |(k, (shape, &shell)): (usize, (&ShapeIndex, &usize))| {
            let around = shape.member.around(shape.m, shape.axis).map(|x| x as f32);
            Lobe { shell: (k >= rigid).then_some(shell as u32), m: shape.m, around }
        };
        let lobes: Vec<Lobe> = index.iter().zip(shells).enumerate().map(lobe).collect();
        let modes = lobes.len();
        let (points, scales) = (receivers.points(), receivers.scales());
        let receivers = std::array::from_fn(|at| LobeReceiver {
            toward: toward(&points[at]),
            spread: (scales[at] / points[at].distance) as f32,
            now: Direction::new(),
            rest: std::mem::take(&mut rest[at]),
            plain_at_rest: vec![[0.0; 2]; modes],
        });
        let changes = || std::array::from_fn(|_| zero_row(modes));
        let (plain, mixed) = (changes(), changes());
        let patterns = Patterns::new(patterns);
        let mut all = Lobes { kernels: Kernels::detect(), patterns, mixture, lobes, receivers, plain, mixed };
        all.turn([0.0; 2]);
        for receiver in &mut all.receivers {
            for (rest, lobe) in receiver.plain_at_rest.iter_mut().zip(&all.lobes) {
                let Some(shell) = lobe.shell else { continue };
                let shown = receiver.now.shown(lobe);
                *rest = all.patterns.toward(&receiver.now, shell as usize).map(|x| x * shown);
            }
        }
        all
    }

    /// What differs from rest in some of the plain modes.
    #[inline(always)]
    fn show(&mut self, modes: Range<usize>) {
        let Lobes { patterns, lobes, receivers, plain, .. } = self;
        for (receiver, [re, im]) in receivers.iter().zip(plain.as_chunks_mut::<2>().0) {
            let LobeReceiver { now, spread, plain_at_rest, .. } = receiver;
            let rows = lobes[modes.clone()].iter().zip(&plain_at_rest[modes.clone()]);
            let rows = rows.zip(re[modes.clone()].iter_mut().zip(&mut im[modes.clone()]));
            // The modes of a pair follow each other and have one pattern.
            let mut latest = (None, [0.0; 2]);
            for ((lobe, rest), (re, im)) in rows {
                let Some(shell) = lobe.shell else { continue };
                if latest.0 != Some(shell) {
                    latest = (Some(shell), patterns.toward(now, shell as usize));
                }
                let shown = now.shown(lobe);
                *re = spread * (latest.1[0] * shown - rest[0]);
                *im = spread * (latest.1[1] * shown - rest[1]);
            }
        }
    }

    /// Some of so many parts of what differs from rest in the modes that are heard.
    fn mix(&mut self, part: usize, parts: usize) {
        let Lobes { kernels, mixture, lobes, plain, mixed, .. } = self;
        let share = |of: usize| of * part / parts..of * (part + 1) / parts;
        match mixture {
            Some(mixture) => {
                let (plain, mixed) =
                    (plain.each_ref().map(|row| &row[..]), mixed.each_mut().map(|row| &mut row[..]));
                kernels.some_row_products(mixture, share(mixture.parts()), plain, mixed);
            }
            None => {
                let modes = share(lobes.len());
                let rows = mixed.iter_mut().zip(plain.iter());
                rows.for_each(|(mixed, plain)| mixed[modes.clone()].copy_from_slice(&plain[modes.clone()]));
            }
        }
    }
}

/// The vector of unit length toward a point.
fn toward(point: &ReceiverPosition) -> [f64; 3] {
    let (sin, cos) = libm::sincos(point.inclination);
    let (across, along) = libm::sincos(point.azimuth);
    [sin * along, sin * across, cos]
}

/// A vector as seen from a disc that is tilted (rad) into the surface toward either axis.
fn seen_tilted([x, y, z]: [f64; 3], tilt: [f64; 2]) -> [f64; 3] {
    let size = libm::hypot(tilt[0], tilt[1]);
    if size == 0.0 {
        return [x, y, z];
    }
    let [u, v] = tilt.map(|part| part / size);
    let (sin, cos) = libm::sincos(size);
    // Toward the tilt, and across it, which stays.
    let (along, across) = (x * u + y * v, y * u - x * v);
    let turned = along * cos - z * sin;
    [turned * u - across * v, turned * v + across * u, along * sin + z * cos]
}

impl Directivity for Lobes {
    fn turn(&mut self, tilt: [f64; 2]) {
        for receiver in &mut self.receivers {
            receiver.now.turn(seen_tilted(receiver.toward, tilt));
        }
    }

    fn work(&mut self, part: usize, parts: usize) {
        // The plain modes come first, then those that are heard.
        let half = parts.div_ceil(2);
        if part >= half {
            return self.mix(part - half, parts - half);
        }
        let (kernels, modes) = (self.kernels, self.lobes.len());
        kernels.vectorized(
            #[inline(always)]
            || self.show(modes * part / half..modes * (part + 1) / half),
        );
    }

    fn write_rest(&self, transfers: [&mut [[f64; 2]]; POINTS]) {
        for (out, receiver) in transfers.into_iter().zip(&self.receivers) {
            out.copy_from_slice(&receiver.rest);
        }
    }

    fn write(&self, transfers: [&mut [[f64; 2]]; POINTS]) {
        for (at, (out, receiver)) in transfers.into_iter().zip(&self.receivers).enumerate() {
            let changes = self.mixed[2 * at].iter().zip(self.mixed[2 * at + 1].iter());
            for ((out, rest), (re, im)) in out.iter_mut().zip(&receiver.rest).zip(changes) {
                *out = [rest[0] + f64::from(*re), rest[1] + f64::from(*im)];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::build_context::BuildOptions;
    use crate::cymbal::assembly::CymbalPlate;
    use crate::plate::PlateTables;
    use crate::plate::free_disc::FreeDisc;
    use crate::radiation::Radiator;
    use crate::reference;
    use crate::split::Splitting;

    #[test]
    fn what_lies_on_the_axis_of_a_tilted_disc_is_seen_on_it() {
        let tilt = [0.3_f64, -0.4];
        // Where it leans into the surface the axis leans to.
        let axis = [0.6 * 0.5_f64.sin(), -0.8 * 0.5_f64.sin(), 0.5_f64.cos()];
        let seen = seen_tilted(axis, tilt);
        assert!(seen[0].abs() < 1e-12 && seen[1].abs() < 1e-12 && (seen[2] - 1.0).abs() < 1e-12, "{seen:?}");
        let across = seen_tilted([0.8, 0.6, 0.0], tilt);
        assert!((across[0] - 0.8).abs() < 1e-12 && (across[1] - 0.6).abs() < 1e-12, "{across:?}");
        assert_eq!(seen_tilted(axis, [0.0; 2]), axis);
    }

    #[test]
    fn from_far_away_a_tilted_cymbal_is_heard_as_from_where_it_looks() {
        let context = reference::standard("splash").context(BuildOptions::new(44_100.0));
        let spec = reference::cymbal("splash");
        let plate = CymbalPlate::new(&spec, None, &context).unwrap();
        let known = plate.known();
        let shells = &known.plate.shells;
        let (mut index, mut rows) = (Vec::new(), Vec::new());
        for (row, shell) in shells.iter().enumerate() {
            let axis = 0.2 * f64::from(shell.m);
            for (member, _) in Splitting::ROUND.members(shell.m, shell.n) {
                index.push(ShapeIndex { radial: row, rows: 1, m: shell.m, member, axis });
                rows.push(row);
            }
        }
        let count = index.len();
        let zero = || vec![[0.0; 2]; count];
        let mut lobes = Lobes::new(
            &known.patterns,
            None,
            (&index, &rows, 0),
            &context.receivers,
            std::array::from_fn(|_| zero()),
        );
        let mut transfers: [_; POINTS] = std::array::from_fn(|_| zero());
        fn slices(transfers: &mut [Vec<[f64; 2]>; POINTS]) -> [&mut [[f64; 2]]; POINTS] {
            transfers.each_mut().map(|row| &mut row[..])
        }
        (0..4).for_each(|part| lobes.work(part, 4));
        lobes.write(slices(&mut transfers));
        assert!(transfers.iter().flatten().all(|transfer| *transfer == [0.0; 2]), "at rest nothing differs");

        let tilt = [0.21, -0.13];
        lobes.turn(tilt);
        (0..4).for_each(|part| lobes.work(part, 4));
        lobes.write(slices(&mut transfers));
        let [_, far, _] = transfers;
        // The same by the integral over the disc, at the points that it sees.
        let [x, y, z] = seen_tilted(toward(&context.receivers.far[0]), tilt);
        let distance = 200.0;
        let tilted = ReceiverPosition { distance, inclination: libm::acos(z), azimuth: libm::atan2(y, x) };
        let level = ReceiverPosition { distance, ..context.receivers.far[0] };
        let (orders, extent) = known.plate.table_extent(21_000.0);
        let tables = PlateTables::new(orders, extent);
        let disc = FreeDisc::new(known.plate.spec.radius(), [tilted, level, level], 110);
        let shapes = known.plate.radial_shapes(&tables, disc.radii());
        for hz in [900.0, 3_000.0, 8_000.0, 15_000.0] {
            let k = (0..count).find(|&k| shells[rows[k]].omega > TAU * hz).unwrap();
            let (shell, shape) = (&shells[rows[k]], &index[k]);
            let radial = &shapes[rows[k] * 110..][..110];
            let mode = Radiator { m: shell.m, radial, omega: shell.omega };
            let heard = disc.radiate(&mode, known.plate.wave_number(shell)).transfers;
            let shown = [&tilted, &level].map(|point| point.toward(shell.m, shape.member, shape.axis));
            let FarPattern(pattern) = &known.patterns[rows[k]];
            let largest = pattern.iter().map(|[re, im]| f64::from(re.hypot(*im))).fold(0.0, f64::max);
            for part in 0..2 {
                let want = distance * (heard[0][part] * shown[0] - heard[1][part] * shown[1]);
                let error = (far[k][part] - want).abs() / largest;
                assert!(error < 0.02, "{hz} Hz: {} {want}", far[k][part]);
            }
        }
    }
}
