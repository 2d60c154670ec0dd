//! A whole drum over its range of pitches, worked out beforehand, so that it can be tuned while it rings.
//!
//! The drum's modes (see [`coupled`](super::coupled)) are solved at a few pitches when it is built. From pitch to
//! pitch a mode is followed by its shape, not its rank: where a head's mode passes one of the air each
//! keeps its own character. Between, everything is interpolated (cubic; frequencies, losses and masses
//! in logarithms, shares of energy held between none and all), which is what a rebuild at that pitch would give.
//!
//! Shapes: each mode is a mixture of the heads' own modes of its order, scaled so that the squares of
//! the shares add to one.

use serde::{Deserialize, Serialize};

use crate::drum::coupled::CoupledMode;
use crate::math::cubic::Stencil;

/// Pitches worked out over the range. *Converged*: frequencies between are met within 2 cents up to eight times
/// the pitch, most within a tenth; above, up to 25 cents off where heads and air pass each other closely.
pub const PITCHES: usize = 25;

/// At how many of them an order is worked out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Grid {
    /// All: its modes pass some of the air where single pitches are heard.
    Fine,
    /// Every second: they pass some of the air.
    Middle,
    /// Every fourth: they pass nothing.
    Coarse,
}

/// Steps of the grids, in their order.
const STRIDES: [usize; 3] = [1, 2, 4];

impl Grid {
    /// The pitches that are worked out.
    pub fn pitches(self) -> impl DoubleEndedIterator<Item = usize> + ExactSizeIterator {
        (0..PITCHES).step_by(STRIDES[self as usize])
    }
}

/// What is interpolated, `ln` but for the shares.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
struct Entry {
    omega: f64,
    sigma: f64,
    mass: f64,
    /// Share of the kinetic energy that is the batter's.
    batter: f64,
    /// Share that is the resonant head's.
    resonant: f64,
    /// Share that is in air going along the drum.
    flow: f64,
    /// Area of the monopole in a baffle that radiates as the mode does at a modal mass of 1 kg, m2.
    monopole_area: f64,
}

/// One mode (or pair) of the drum against pitch.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct TunedMode {
    /// Nodal diameters.
    pub m: u32,
    /// The mode as solved at the default pitch.
    pub reference: CoupledMode,
    /// The head mode (batter's first) or, after those, cavity mode that it is named after.
    pub name: usize,
    grid: Grid,
    /// `[pitch of the grid]`.
    entries: Vec<Entry>,
    /// `[pitch of the grid]`: the air at an open end or in holes, over the head modes as the shares are.
    outlet: Vec<f32>,
    /// `[pitch of the grid][head mode]`: shares of the heads' modes of this order, batter first.
    shares: Vec<f32>,
}

/// Where a mode rings at some pitch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeAtPitch {
    /// Undamped angular frequency, rad/s.
    pub omega: f64,
    /// Decay rate, 1/s.
    pub sigma: f64,
    /// Modal mass, kg.
    pub mass: f64,
    /// Share of the kinetic energy that is the batter's.
    pub batter: f64,
    /// Share of the kinetic energy that is the resonant head's.
    pub resonant: f64,
    /// Share of the kinetic energy that is in air going along the drum as one.
    pub flow: f64,
}

/// The pitches of a table, evenly spaced in logarithm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PitchScale {
    low: f64,
    high: f64,
}

impl PitchScale {
    /// From the lowest to the highest pitch, Hz.
    pub fn new(low_hz: f64, high_hz: f64) -> PitchScale {
        PitchScale { low: low_hz.ln(), high: high_hz.ln() }
    }

    /// The pitches worked out, Hz.
    pub fn pitches(&self) -> [f64; PITCHES] {
        std::array::from_fn(|i| (self.low + (self.high - self.low) * i as f64 / (PITCHES - 1) as f64).exp())
    }

    /// Where a pitch (Hz) lies between them; made once, used for every mode.
    pub fn place(&self, pitch_hz: f64) -> PitchPosition {
        let x = (pitch_hz.ln() - self.low) / (self.high - self.low) * (PITCHES - 1) as f64;
        PitchPosition {
            grids: STRIDES.map(|stride| Stencil::at(x / stride as f64, (PITCHES - 1) / stride + 1)),
        }
    }
}

/// Four neighbours among the pitches and their weights, for each grid.
#[derive(Debug, Clone, Copy)]
pub struct PitchPosition {
    grids: [Stencil; STRIDES.len()],
}

impl PitchPosition {
    /// Interpolates a row given at every pitch, in its own units.
    pub fn blend(&self, value: impl Fn(usize) -> f64) -> f64 {
        self.of(Grid::Fine).blend(value)
    }

    /// The neighbours among the pitches of a grid.
    pub fn of(&self, grid: Grid) -> &Stencil {
        &self.grids[grid as usize]
    }
}

impl TunedMode {
    /// Where the mode rings.
    ///
    /// # Real-time
    /// Three exponentials.
    pub fn at(&self, place: &PitchPosition) -> ModeAtPitch {
        let (row, place) = (&self.entries, place.of(self.grid));
        ModeAtPitch {
            omega: place.blend(|i| row[i].omega).exp(),
            sigma: place.blend(|i| row[i].sigma).exp(),
            mass: place.blend(|i| row[i].mass).exp(),
            batter: place.blend_shares(|i| row[i].batter),
            resonant: place.blend_shares(|i| row[i].resonant),
            flow: place.blend_shares(|i| row[i].flow),
        }
    }

    /// Share of the order's head mode `i`, batter's first.
    pub fn share(&self, i: usize, place: &PitchPosition) -> f64 {
        place.of(self.grid).blend(|pitch| self.share_at(i, pitch))
    }

    /// Shares (dimensionless) of the order's head modes from `first` on, as many as there are places. To be called where it is vectorized.
    #[inline(always)]
    pub fn write_shares(&self, first: usize, place: &PitchPosition, out: &mut [f32]) {
        let (stencil, heads, count) = (place.of(self.grid), self.heads(), out.len());
        let rows: [&[f32]; 4] =
            std::array::from_fn(|p| &self.shares[(stencil.first + p) * heads + first..][..count]);
        for i in 0..count {
            out[i] = stencil.blend_all(rows.map(|row| f64::from(row[i]))) as f32;
        }
    }

    /// Share of the order's head mode `i` at a pitch of its grid, by number, dimensionless.
    pub fn share_at(&self, i: usize, pitch: usize) -> f64 {
        f64::from(self.shares[pitch * self.heads() + i])
    }

    /// Displacement of the air at an open end or in holes, per share.
    pub fn outlet(&self, place: &PitchPosition) -> f64 {
        place.of(self.grid).blend(|pitch| f64::from(self.outlet[pitch]))
    }

    /// Area of the monopole in a baffle that radiates as the mode does at a modal mass of 1 kg, m2.
    pub fn monopole_area(&self, place: &PitchPosition) -> f64 {
        let row = &self.entries;
        place.of(self.grid).blend(|pitch| row[pitch].monopole_area).max(0.0)
    }

    /// The pitches it is worked out at.
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// Number of head modes it mixes.
    pub fn heads(&self) -> usize {
        self.shares.len() / self.entries.len()
    }
}

/// Follows the modes of one order through the pitches of its grid; `keep` chooses them at the middle one.
///
/// `solved` holds the order's modes at every pitch of the grid, `heads` is how many of a vector's entries are head modes.
pub fn follow(
    m: u32,
    solved: &[Vec<CoupledMode>],
    heads: usize,
    grid: Grid,
    keep: impl Fn(&CoupledMode) -> bool,
) -> Vec<TunedMode> {
    let pitches = solved.len();
    let reference = pitches / 2;
    let start = &solved[reference];
    // `paths[k][pitch]`: which mode at that pitch is the one that is `k` at the reference.
    let mut paths: Vec<Vec<(usize, f64)>> = (0..start.len()).map(|k| vec![(k, 1.0); pitches]).collect();
    let mut walk = |from: usize, to: usize| {
        let here: Vec<(usize, f64)> = paths.iter().map(|path| path[from]).collect();
        for (path, next) in paths.iter_mut().zip(matched(&solved[from], &solved[to], &here)) {
            path[to] = next;
        }
    };
    (reference + 1..pitches).for_each(|pitch| walk(pitch - 1, pitch));
    (0..reference).rev().for_each(|pitch| walk(pitch + 1, pitch));
    let names = named(start);
    let tuned = |path: &Vec<(usize, f64)>| {
        let mut entries = vec![Entry::default(); pitches];
        let mut shares = vec![0.0_f32; heads * pitches];
        let mut outlet = vec![0.0_f32; pitches];
        for (pitch, &(k, sign)) in path.iter().enumerate() {
            let mode = &solved[pitch][k];
            let size = mode.vector[..heads].iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-12);
            entries[pitch] = Entry {
                omega: mode.omega.ln(),
                sigma: mode.sigma.max(1e-9).ln(),
                mass: -2.0 * size.ln(),
                batter: mode.share[0],
                resonant: mode.share[1],
                flow: mode.flow,
                monopole_area: mode.monopole_area,
            };
            outlet[pitch] = (sign * mode.outlet / size) as f32;
            for (share, x) in shares[pitch * heads..][..heads].iter_mut().zip(&mode.vector) {
                *share = (sign * x / size) as f32;
            }
        }
        let k = path[reference].0;
        TunedMode { m, reference: start[k].clone(), name: names[k], grid, entries, outlet, shares }
    };
    paths.iter().filter(|path| keep(&start[path[reference].0])).map(tuned).collect()
}

/// Names each mode after the part that it is most of, no two after the same.
fn named(modes: &[CoupledMode]) -> Vec<usize> {
    let mut claims: Vec<(f64, usize, usize)> = Vec::new();
    for (k, mode) in modes.iter().enumerate() {
        claims.extend(mode.shares.iter().enumerate().map(|(part, &share)| (share, k, part)));
    }
    claims.sort_by(|a, b| b.0.total_cmp(&a.0));
    let parts = modes.first().map_or(0, |mode| mode.shares.len());
    let (mut names, mut taken) = (vec![None; modes.len()], vec![false; parts]);
    for (_, k, part) in claims {
        if names[k].is_none() && !taken[part] {
            names[k] = Some(part);
            taken[part] = true;
        }
    }
    // There are never more modes than parts.
    names.into_iter().map(|name| name.unwrap_or(0)).collect()
}

/// For each mode `here` (index among `from`, sign): the mode among `to` of the most similar shape.
/// The most similar pair is matched first; what finds none keeps its index.
fn matched(from: &[CoupledMode], to: &[CoupledMode], here: &[(usize, f64)]) -> Vec<(usize, f64)> {
    let mut pairs = Vec::with_capacity(here.len() * to.len());
    for (i, &(k, sign)) in here.iter().enumerate() {
        for (j, mode) in to.iter().enumerate() {
            let product: f64 = from[k].direction.iter().zip(&mode.direction).map(|(a, b)| a * b).sum();
            pairs.push((sign * product, i, j));
        }
    }
    pairs.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let last = to.len().saturating_sub(1);
    let mut next: Vec<(usize, f64)> = here.iter().map(|&(k, sign)| (k.min(last), sign)).collect();
    let (mut done, mut taken) = (vec![false; here.len()], vec![false; to.len()]);
    for (product, i, j) in pairs {
        if !done[i] && !taken[j] {
            (done[i], taken[j]) = (true, true);
            next[i] = (j, product.signum());
        }
    }
    next
}
