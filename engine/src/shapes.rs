//! Mode shapes of a round body, tabulated along the radius, so that a stroke may land anywhere.
//!
//! A shape is `R(r) cos(m (theta - theta_0))` or its sine twin, `r` the share of the radius. The
//! axes `theta_0` of a pair are where the body's small unevenness puts them.

use crate::cache::Shared;
use crate::math::cubic::Stencil;
use crate::math::negligible::drop_negligible;
use crate::modal::simd::Kernels;
use crate::modal::simd::row_products::RowProducts;
use crate::mode::Member;
use crate::mode_mixture::MAX_MIXED;
use crate::patch_factors::{PatchFactors, pressed_share};

/// Intervals of the table. *Measured*: the finest shape of a cymbal at 22 kHz (wavelength a tenth
/// of the radius) is met within 1e-4.
const INTERVALS: usize = 256;

/// Which radial functions a mode has, and how it goes around.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeIndex {
    /// First row of the table of radial functions.
    pub radial: usize,
    /// How many rows from there the mode is a mixture of.
    pub rows: usize,
    /// Nodal diameters.
    pub m: u32,
    /// Member of the pair.
    pub member: Member,
    /// Direction of the pair's axes, rad.
    pub axis: f64,
}

/// Shapes of all modes of one round body.
pub struct ShapeTable {
    /// `[r][radial]`: a stroke reads four whole rows, one after the other.
    radial: Vec<f32>,
    /// How many radial functions there are.
    functions: usize,
    /// `[mode]`.
    index: Vec<ShapeIndex>,
    /// `[mode]`: where its weights begin; the two members of a pair mix alike and share theirs.
    starts: Vec<usize>,
    /// Share of each row of each pair.
    weights: Vec<f32>,
    /// Number of orders.
    orders: usize,
    /// Modes that mix the same rows, and all modes in their order.
    groups: Vec<Group>,
    grouped: Vec<Mixed>,
    /// `[radial]`: wavenumber of the radial function times the radius; empty if there is no single one.
    waves: Vec<f32>,
    /// The share of every radial function that discs (shares of the radius) feel; none of bodies whose waves are not known.
    felt: PatchFactors,
    /// What becomes of the shapes: each mode of the body is such a mixture of those of the index.
    mixture: Option<Shared<RowProducts>>,
    kernels: Kernels,
}

/// Modes that mix the same rows.
#[derive(Debug, Clone, Copy)]
struct Group {
    radial: usize,
    rows: usize,
    /// How many they are.
    modes: usize,
}

/// A mode among those that mix the same rows: what a stroke needs of it, close together.
#[derive(Debug, Clone, Copy)]
struct Mixed {
    mode: u32,
    /// Where its weights begin.
    start: u32,
    m: u32,
    /// Shares of `cos(m theta)` and `sin(m theta)` in how it goes around.
    around: [f32; 2],
}

/// Orders beyond this would need a larger scratch array; no body has so many.
const MAX_ORDERS: usize = 160;

/// Nor does any mode mix so many rows.
const MAX_ROWS: usize = 128;

impl ShapeTable {
    /// Where along the radius radial functions are wanted, shares of it.
    pub fn radii() -> Vec<f64> {
        (0..=INTERVALS).map(|i| i as f64 / INTERVALS as f64).collect()
    }

    /// From the radial functions, `[radial][r]` flat, at [`radii`](Self::radii); every weight is 1.
    /// Allocates.
    ///
    /// # Panics
    /// If a mode has more nodal diameters (159) or mixes more rows (128) than the engine is made for.
    pub fn new(radial: &[f64], index: Vec<ShapeIndex>) -> ShapeTable {
        let mut radial = radial.to_vec();
        radial.chunks_exact_mut(INTERVALS + 1).for_each(drop_negligible);
        let functions = radial.len() / (INTERVALS + 1);
        let places = (0..=INTERVALS).flat_map(|r| (0..functions).map(move |row| row * (INTERVALS + 1) + r));
        let radial = places.map(|place| radial[place] as f32).collect();
        let orders = index.iter().map(|mode| mode.m as usize + 1).max().unwrap_or(1);
        assert!(orders <= MAX_ORDERS, "{orders} orders");
        let mut starts: Vec<usize> = Vec::with_capacity(index.len());
        let mut total = 0;
        for (k, mode) in index.iter().enumerate() {
            let twin = k.checked_sub(1).filter(|&before| {
                let cosine = ShapeIndex { member: Member::Cosine, ..*mode };
                mode.member == Member::Sine && index[before] == cosine
            });
            match twin {
                Some(before) => starts.push(starts[before]),
                None => {
                    starts.push(total);
                    total += mode.rows;
                }
            }
        }
        let (groups, grouped) = group(&index, &starts);
        let weights = vec![1.0; total];
        let (waves, felt) = (Vec::new(), PatchFactors::default());
        ShapeTable {
            radial,
            functions,
            index,
            starts,
            weights,
            orders,
            groups,
            grouped,
            waves,
            felt,
            mixture: None,
            kernels: Kernels::detect(),
        }
    }

    /// Tells the body's radius (m) and, times that, the wavenumber of every radial function, `[radial]`: those of a
    /// membrane, of which a disc feels a known share, worked out beforehand so that a stroke need not. Allocates.
    pub fn with_waves(mut self, radius: f64, waves: impl Iterator<Item = f64>) -> ShapeTable {
        self.waves = waves.map(|wave| wave as f32).collect();
        let share =
            |disc: f64| self.waves.iter().map(|&wave| pressed_share(f64::from(wave) * disc)).collect();
        self.felt = PatchFactors::new(radius, share);
        self
    }

    /// Makes every mode of the body a mixture of those of the index.
    pub fn with_mixture(self, mixture: Option<Shared<RowProducts>>) -> ShapeTable {
        ShapeTable { mixture, ..self }
    }

    /// How each mode goes around before they are mixed, `[mode]`.
    pub fn index(&self) -> &[ShapeIndex] {
        &self.index
    }

    /// Shares of the rows that mode `k` is a mixture of, and its twin.
    pub fn weights_mut(&mut self, k: usize) -> &mut [f32] {
        &mut self.weights[self.starts[k]..][..self.index[k].rows]
    }

    /// Writes every mode's shape at a place (share of the radius, rad), `[mode]`.
    ///
    /// # Real-time
    /// No allocation; linear in the number of modes and the rows they mix.
    pub fn fill(&self, radius: f64, angle: f64, out: &mut [f32]) {
        self.fill_pressed(radius, angle, 0.0, out);
    }

    /// Writes every mode's shape averaged over a disc about a place, `[mode]`; `disc` is its radius as a share
    /// of the body's. Of a wave the average is `2 J_1(x) / x` of the middle; of bodies whose waves are not
    /// known, the middle is all.
    ///
    /// # Real-time
    /// As [`fill`](Self::fill), and for a disc beyond [those known](PatchFactors) a Bessel function for each row mixed.
    pub fn fill_pressed(&self, radius: f64, angle: f64, disc: f64, out: &mut [f32]) {
        let Some(mixture) = &self.mixture else { return self.fill_simple(radius, angle, disc, out) };
        let mut simple = [0.0; MAX_MIXED];
        self.fill_simple(radius, angle, disc, &mut simple);
        self.kernels.row_products(mixture, &simple, out);
    }

    fn fill_simple(&self, radius: f64, angle: f64, disc: f64, out: &mut [f32]) {
        // cos and sin of every multiple of the angle, by one rotation each.
        let mut around = [[1.0_f64, 0.0]; MAX_ORDERS];
        let (sin, cos) = angle.sin_cos();
        for m in 1..self.orders {
            let [c, s] = around[m - 1];
            around[m] = [c * cos - s * sin, s * cos + c * sin];
        }
        let stencil = Stencil::at(radius * INTERVALS as f64, INTERVALS + 1);
        let known = self.felt.of(disc);
        // What a row is here is the same for all that mix it.
        let mut here = [0.0_f64; MAX_ROWS];
        let mut modes = self.grouped.iter();
        for group in &self.groups {
            let rows = group.radial..group.radial + group.rows;
            let near: [&[f32]; 4] =
                std::array::from_fn(|i| &self.radial[(stencil.first + i) * self.functions..][rows.clone()]);
            for (i, (here, row)) in here[..group.rows].iter_mut().zip(rows).enumerate() {
                let felt = match (&known, self.waves.get(row)) {
                    (Some(felt), _) => felt[row],
                    (None, Some(&wave)) if disc > 0.0 => pressed_share(f64::from(wave) * disc),
                    _ => 1.0,
                };
                *here = felt * stencil.blend_all(near.map(|near| f64::from(near[i])));
            }
            let mut latest = (u32::MAX, 0.0);
            for mode in modes.by_ref().take(group.modes) {
                let [c, s] = around[mode.m as usize];
                let [of_c, of_s] = mode.around.map(f64::from);
                if latest.0 != mode.start {
                    let weights = &self.weights[mode.start as usize..][..group.rows];
                    latest = (mode.start, mixed(weights, &here));
                }
                out[mode.mode as usize] = (latest.1 * (c * of_c + s * of_s)) as f32;
            }
        }
    }
}

/// `sum weight * value`, four by four: one after the other, each sum would wait for the last.
fn mixed(weights: &[f32], values: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (fours, rest) = weights.as_chunks::<4>();
    for (weights, values) in fours.iter().zip(values.chunks_exact(4)) {
        for i in 0..4 {
            sums[i] += f64::from(weights[i]) * values[i];
        }
    }
    let last = rest.iter().zip(&values[4 * fours.len()..]).map(|(&weight, value)| f64::from(weight) * value);
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + last.sum::<f64>()
}

/// Modes by the rows they mix.
fn group(index: &[ShapeIndex], starts: &[usize]) -> (Vec<Group>, Vec<Mixed>) {
    let rows = |&k: &usize| (index[k].radial, index[k].rows);
    let mut grouped: Vec<usize> = (0..index.len()).collect();
    grouped.sort_by_key(rows);
    let same = grouped.chunk_by(|a, b| rows(a) == rows(b));
    let groups = same.map(|modes| {
        let (radial, rows) = rows(&modes[0]);
        assert!(rows <= MAX_ROWS, "{rows} rows");
        Group { radial, rows, modes: modes.len() }
    });
    let mixed = |&k: &usize| {
        let ShapeIndex { m, member, axis, .. } = index[k];
        let around = member.around(m, axis).map(|x| x as f32);
        Mixed { mode: k as u32, start: starts[k] as u32, m, around }
    };
    (groups.collect(), grouped.iter().map(mixed).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_meets_a_fine_shape_anywhere() {
        let modes = [Member::Cosine, Member::Sine].map(|member| ShapeIndex {
            radial: 0,
            rows: 1,
            m: 9,
            member,
            axis: 0.3,
        });
        let radial = |r: f64| libm::jn(9, 60.0 * r);
        let rows: Vec<f64> = ShapeTable::radii().into_iter().map(radial).collect();
        let table = ShapeTable::new(&rows, modes.to_vec());
        let mut out = [0.0; 2];
        for i in 0..500 {
            let (r, theta) = (f64::from(i) / 499.0, 0.07 * f64::from(i));
            table.fill(r, theta, &mut out);
            let (sin, cos) = (9.0 * (theta - 0.3)).sin_cos();
            assert!((f64::from(out[0]) - radial(r) * cos).abs() < 1e-4);
            assert!((f64::from(out[1]) - radial(r) * sin).abs() < 1e-4);
        }
    }
}
