//! Kernels for fields on a polar grid: radius along the lanes, Fourier orders and angles along the rows.
//!
//! Shapes: a *spectrum* is `[row][cos, sin][lane]`, one row per order, evens first, each parity
//! padded to whole blocks of [`BLOCK`], and may have more lanes than its field, before those of the field, which no transform
//! concerns; a *field* is `[angle][mirror][lane]` over a quarter turn
//! and its mirror images `t, -t, pi - t, pi + t`, which share every cosine and sine; *amplitudes*
//! are `[row][cos, sin][SLOTS]`, radial functions of one order side by side.
//!
//! The transform in angle is a matrix product, folded by the mirrors: at the sizes of a cymbal
//! (60 to 100 angles) that is as fast as an FFT and runs at the machine's full width.

use pulp::Simd;

use super::dispatch::{Kernel, Kernels, LANES};
use crate::modal::row::{Row, zero_row};

/// Radial functions of one order, at most.
pub const SLOTS: usize = 16;

/// Rows or angles taken together.
pub const BLOCK: usize = 3;

/// Transform between spectrum and field for one number of orders and angles.
pub struct Circle {
    /// Rows of even and of odd orders, padded, and without.
    evens: usize,
    odds: usize,
    orders: [usize; 2],
    /// Angles in a quarter turn.
    quarter: usize,
    /// `[angle block][row][angle][cos, sin]`.
    unfold: Vec<[f32; 2 * BLOCK]>,
    /// `[row block][angle][row][cos, sin]`.
    fold: Vec<[f32; 2 * BLOCK]>,
}

impl Circle {
    /// For orders `0..=highest` and `4 * quarter` angles, `quarter` a multiple of [`BLOCK`]. Allocates.
    pub fn new(highest: usize, quarter: usize) -> Circle {
        assert!(quarter.is_multiple_of(BLOCK), "{quarter} angles in a quarter turn");
        let evens = (highest / 2 + 1).next_multiple_of(BLOCK);
        let odds = highest.div_ceil(2).next_multiple_of(BLOCK);
        let turn = |row: usize, angle: usize| -> [f32; 2] {
            let m = if row < evens { 2 * row } else { 2 * (row - evens) + 1 };
            if m > highest {
                return [0.0, 0.0];
            }
            let theta = (angle as f64 + 0.5) / (4 * quarter) as f64 * std::f64::consts::TAU;
            let (sin, cos) = (m as f64 * theta).sin_cos();
            [cos as f32, sin as f32]
        };
        let pack = |of: &dyn Fn(usize) -> [f32; 2]| {
            let mut out = [0.0; 2 * BLOCK];
            out.as_chunks_mut::<2>().0.iter_mut().enumerate().for_each(|(i, pair)| *pair = of(i));
            out
        };
        let rows = evens + odds;
        let unfold = (0..quarter / BLOCK)
            .flat_map(|block| (0..rows).map(move |row| (block, row)))
            .map(|(block, row)| pack(&|i| turn(row, block * BLOCK + i)))
            .collect();
        let fold = (0..rows / BLOCK)
            .flat_map(|block| (0..quarter).map(move |angle| (block, angle)))
            .map(|(block, angle)| pack(&|i| turn(block * BLOCK + i, angle)))
            .collect();
        Circle { evens, odds, orders: [highest / 2 + 1, highest.div_ceil(2)], quarter, unfold, fold }
    }

    /// Rows of a spectrum.
    pub fn rows(&self) -> usize {
        self.evens + self.odds
    }

    /// Row of an order.
    pub fn row(&self, m: usize) -> usize {
        if m.is_multiple_of(2) { m / 2 } else { self.evens + m / 2 }
    }

    /// Angles of a field, mirrors counted.
    pub fn angles(&self) -> usize {
        4 * self.quarter
    }
}

/// Radial functions, those of one row side by side: `[function][lane]`.
pub struct Radials {
    /// First function of each row, and the end.
    starts: Vec<usize>,
    table: Row,
    lanes: usize,
    /// Lanes from here on belong to the field turned by a quarter: cosine amplitudes drive its
    /// negative sine, sine ones its cosine.
    turned: usize,
}

impl Radials {
    /// From `[row][function][lane]`; at most [`SLOTS`] functions a row. Allocates.
    pub fn new(rows: &[Vec<Vec<f64>>], lanes: usize, turned: usize) -> Radials {
        assert!(rows.iter().all(|row| row.len() <= SLOTS), "too many functions of one order");
        let mut starts = vec![0];
        starts.extend(rows.iter().scan(0, |sum, row| {
            *sum += row.len();
            Some(*sum)
        }));
        let mut table = zero_row(starts[rows.len()] * lanes);
        for (to, from) in table.iter_mut().zip(rows.iter().flatten().flatten()) {
            *to = *from as f32;
        }
        Radials { starts, table, lanes, turned }
    }

    /// Multiplies the first lanes of every function by a factor.
    pub fn scale(&mut self, lanes: usize, factor: f64) {
        for function in self.table.chunks_exact_mut(self.lanes) {
            function[..lanes].iter_mut().for_each(|value| *value *= factor as f32);
        }
    }

    /// Functions of a row.
    pub fn count(&self, row: usize) -> usize {
        self.starts[row + 1] - self.starts[row]
    }
}

impl Kernels {
    /// Spectrum of amplitudes.
    pub fn spread(&self, radials: &Radials, amplitudes: &[f32], spectrum: &mut [f32]) {
        self.run(Spread { radials, amplitudes, spectrum });
    }

    /// Adds what a spectrum projects on each function to the amplitudes: the transpose of
    /// [`spread`](Self::spread).
    pub fn gather(&self, radials: &Radials, spectrum: &[f32], amplitudes: &mut [f32]) {
        self.run(Gather { radials, spectrum, amplitudes });
    }

    /// Field of a spectrum.
    pub fn unfold(&self, circle: &Circle, spectrum: &[f32], field: &mut [f32]) {
        self.run(Unfold { circle, spectrum, field });
    }

    /// Spectrum of a field, its transpose; the field is used up.
    pub fn fold(&self, circle: &Circle, field: &mut [f32], spectrum: &mut [f32]) {
        self.run(Fold { circle, field, spectrum });
    }

    /// `2 (a b - d^2)` of a field of `a, b, d`.
    pub fn bracket(&self, lanes: usize, bent: &[f32], out: &mut [f32]) {
        self.run(Bracket { lanes, bent, out });
    }

    /// Turns `a, b, d` into the derivatives of `stress` times their bracket: `2 b, 2 a, -4 d` times it.
    pub fn stress(&self, lanes: usize, stress: &[f32], bent: &mut [f32]) {
        self.run(Stress { lanes, stress, bent });
    }
}

struct Spread<'a> {
    radials: &'a Radials,
    amplitudes: &'a [f32],
    spectrum: &'a mut [f32],
}

impl Kernel for Spread<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let width = S::F32_LANES;
        let Radials { starts, table, lanes, turned } = self.radials;
        let (w, turned) = (lanes / width, turned / width);
        let table = S::as_simd_f32s(table).0;
        let out = S::as_mut_simd_f32s(self.spectrum).0;
        let rows = starts.windows(2).zip(self.amplitudes.as_chunks::<SLOTS>().0.as_chunks::<2>().0);
        for ((range, amplitudes), out) in rows.zip(out.chunks_exact_mut(2 * w)) {
            let functions = (&table[range[0] * w..range[1] * w], w);
            let mut v = 0;
            while v < w {
                v += match w - v {
                    4.. => spread_some::<S, 4>(simd, fma, (v, turned), functions, amplitudes, out),
                    2.. => spread_some::<S, 2>(simd, fma, (v, turned), functions, amplitudes, out),
                    _ => spread_some::<S, 1>(simd, fma, (v, turned), functions, amplitudes, out),
                };
            }
        }
    }
}

/// `V` vectors of a row of a spectrum from `v` on, of functions of `w` vectors. Returns `V`.
#[inline(always)]
fn spread_some<S: Simd, const V: usize>(
    simd: S,
    fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s,
    (v, turned): (usize, usize),
    (functions, w): (&[S::f32s], usize),
    [cos, sin]: &[[f32; SLOTS]; 2],
    out: &mut [S::f32s],
) -> usize {
    let mut sums = [[simd.splat_f32s(0.0); 2]; V];
    for ((function, &c), &s) in functions.chunks_exact(w).zip(cos).zip(sin) {
        let (c, s, function) = (simd.splat_f32s(c), simd.splat_f32s(s), &function[v..v + V]);
        for j in 0..V {
            sums[j][0] = fma(function[j], c, sums[j][0]);
            sums[j][1] = fma(function[j], s, sums[j][1]);
        }
    }
    for (j, [c, s]) in sums.into_iter().enumerate() {
        (out[v + j], out[w + v + j]) = if v + j < turned { (c, s) } else { (s, simd.neg_f32s(c)) };
    }
    V
}

struct Gather<'a> {
    radials: &'a Radials,
    spectrum: &'a [f32],
    amplitudes: &'a mut [f32],
}

impl Kernel for Gather<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let width = S::F32_LANES;
        let Radials { starts, table, lanes, turned } = self.radials;
        let (w, turned) = (lanes / width, turned / width);
        let table = S::as_simd_f32s(table).0;
        let spectrum = S::as_simd_f32s(self.spectrum).0;
        let amplitudes = self.amplitudes.as_chunks_mut::<SLOTS>().0.as_chunks_mut::<2>().0;
        for ((range, amplitudes), row) in starts.windows(2).zip(amplitudes).zip(spectrum.chunks_exact(2 * w))
        {
            let count = range[1] - range[0];
            let mut first = 0;
            while first < count {
                let functions = &table[(range[0] + first) * w..range[1] * w];
                first += match count - first {
                    3.. => gather_some::<S, 3>(simd, fma, functions, (row, turned), first, amplitudes),
                    2 => gather_some::<S, 2>(simd, fma, functions, (row, turned), first, amplitudes),
                    _ => gather_some::<S, 1>(simd, fma, functions, (row, turned), first, amplitudes),
                };
            }
        }
    }
}

/// Adds what a row of a spectrum projects on the first `F` of these functions to amplitudes from `first` on. Returns `F`.
#[inline(always)]
fn gather_some<S: Simd, const F: usize>(
    simd: S,
    fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s,
    functions: &[S::f32s],
    (row, turned): (&[S::f32s], usize),
    first: usize,
    [to_cos, to_sin]: &mut [[f32; SLOTS]; 2],
) -> usize {
    let (cos, sin) = row.split_at(row.len() / 2);
    let w = cos.len();
    let mut sums = [[simd.splat_f32s(0.0); 2]; F];
    let shapes: [&[S::f32s]; F] = std::array::from_fn(
        #[inline(always)]
        |f| &functions[f * w..][..w],
    );
    for v in 0..turned {
        for f in 0..F {
            sums[f][0] = fma(shapes[f][v], cos[v], sums[f][0]);
            sums[f][1] = fma(shapes[f][v], sin[v], sums[f][1]);
        }
    }
    for v in turned..w {
        let minus_sin = simd.neg_f32s(sin[v]);
        for f in 0..F {
            sums[f][0] = fma(shapes[f][v], minus_sin, sums[f][0]);
            sums[f][1] = fma(shapes[f][v], cos[v], sums[f][1]);
        }
    }
    for (f, [c, s]) in sums.into_iter().enumerate() {
        to_cos[first + f] += simd.reduce_sum_f32s(c);
        to_sin[first + f] += simd.reduce_sum_f32s(s);
    }
    F
}

struct Unfold<'a> {
    circle: &'a Circle,
    spectrum: &'a [f32],
    field: &'a mut [f32],
}

impl Kernel for Unfold<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let Circle { evens, orders, unfold, .. } = self.circle;
        let rows = self.circle.rows();
        let spectrum = S::as_simd_f32s(self.spectrum).0;
        let field = S::as_mut_simd_f32s(self.field).0;
        let (w, row) = (field.len() / self.circle.angles(), spectrum.len() / (2 * rows));
        let (even_rows, odd_rows) = spectrum.split_at(2 * row * evens);
        // What fills up the blocks is zero.
        let (even_rows, odd_rows) = (&even_rows[..2 * row * orders[0]], &odd_rows[..2 * row * orders[1]]);
        let (even_rows, odd_rows) = ((even_rows, row), (odd_rows, row));
        for (turns, out) in unfold.chunks_exact(rows).zip(field.chunks_exact_mut(4 * BLOCK * w)) {
            let (even_turns, odd_turns) = turns.split_at(*evens);
            let (even, odd) = ((even_rows, even_turns), (odd_rows, odd_turns));
            // Vectors side by side share the cosines and sines. The widest registers are 32 and hold the sums of three; others are 16.
            let mut v = 0;
            while v < w {
                v += match w - v {
                    3.. if S::F32_LANES == LANES => unfold_some::<S, 3>(simd, fma, (v, w), even, odd, out),
                    2.. => unfold_some::<S, 2>(simd, fma, (v, w), even, odd, out),
                    _ => unfold_some::<S, 1>(simd, fma, (v, w), even, odd, out),
                };
            }
        }
    }
}

/// Rows of a spectrum, their vectors of cosines, and the cosines and sines of a block of angles for each.
type TurnedRows<'a, S> = ((&'a [<S as Simd>::f32s], usize), &'a [[f32; 2 * BLOCK]]);

/// A block of angles of a field, `V` vectors of its `w` from `v` on.
#[inline(always)]
fn unfold_some<S: Simd, const V: usize>(
    simd: S,
    fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy,
    (v, w): (usize, usize),
    ((even_rows, row), even_turns): TurnedRows<'_, S>,
    ((odd_rows, _), odd_turns): TurnedRows<'_, S>,
    out: &mut [S::f32s],
) -> usize {
    let places = [row - w + v, 2 * row - w + v];
    let even = sum_rows::<S, V>(simd, fma, (even_rows, 2 * row, places), even_turns);
    let odd = sum_rows::<S, V>(simd, fma, (odd_rows, 2 * row, places), odd_turns);
    for i in 0..BLOCK {
        let out = &mut out[4 * i * w..][..4 * w];
        for j in 0..V {
            let ([ec, es], [oc, os]) = (even[i][j], odd[i][j]);
            let (near, far) = (simd.add_f32s(ec, oc), simd.sub_f32s(ec, oc));
            let (up, down) = (simd.add_f32s(es, os), simd.sub_f32s(es, os));
            out[v + j] = simd.add_f32s(near, up);
            out[w + v + j] = simd.sub_f32s(near, up);
            out[2 * w + v + j] = simd.sub_f32s(far, down);
            out[3 * w + v + j] = simd.add_f32s(far, down);
        }
    }
    V
}

/// Sums of rows of so many vectors, each weighted by the cosines and sines of a block: those take the vectors from either place on, `V`
/// vectors in turn. `[of the block][vector][cos, sin]`
#[inline(always)]
fn sum_rows<S: Simd, const V: usize>(
    simd: S,
    fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s,
    (rows, length, [cos, sin]): (&[S::f32s], usize, [usize; 2]),
    turns: &[[f32; 2 * BLOCK]],
) -> [[[S::f32s; 2]; V]; BLOCK] {
    let mut sums = [[[simd.splat_f32s(0.0); 2]; V]; BLOCK];
    for (row, turn) in rows.chunks_exact(length).zip(turns) {
        let (cos, sin) = (&row[cos..cos + V], &row[sin..sin + V]);
        for i in 0..BLOCK {
            let (by_cos, by_sin) = (simd.splat_f32s(turn[2 * i]), simd.splat_f32s(turn[2 * i + 1]));
            for j in 0..V {
                sums[i][j][0] = fma(by_cos, cos[j], sums[i][j][0]);
                sums[i][j][1] = fma(by_sin, sin[j], sums[i][j][1]);
            }
        }
    }
    sums
}

struct Fold<'a> {
    circle: &'a Circle,
    field: &'a mut [f32],
    spectrum: &'a mut [f32],
}

impl Kernel for Fold<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let Circle { evens, quarter, fold, .. } = self.circle;
        let spectrum = S::as_mut_simd_f32s(self.spectrum).0;
        let field = S::as_mut_simd_f32s(self.field).0;
        let (w, row) = (field.len() / (4 * quarter), spectrum.len() / (2 * self.circle.rows()));
        // Each angle's mirrors become what even and odd orders see of them: cos, sin, cos, sin.
        for x in field.chunks_exact_mut(4 * w) {
            for v in 0..w {
                let [a, b, c, d] = [x[v], x[w + v], x[2 * w + v], x[3 * w + v]];
                let (near, far) = (simd.add_f32s(a, b), simd.add_f32s(c, d));
                let (up, down) = (simd.sub_f32s(a, b), simd.sub_f32s(d, c));
                x[v] = simd.add_f32s(near, far);
                x[w + v] = simd.add_f32s(up, down);
                x[2 * w + v] = simd.sub_f32s(near, far);
                x[3 * w + v] = simd.sub_f32s(up, down);
            }
        }
        let blocks = fold.chunks_exact(*quarter).zip(spectrum.chunks_exact_mut(2 * BLOCK * row));
        for (block, (turns, out)) in blocks.enumerate() {
            let first = if block * BLOCK < *evens { 0 } else { 2 * w };
            // As in unfolding.
            let mut v = 0;
            while v < w {
                v += match w - v {
                    3.. if S::F32_LANES == LANES => {
                        fold_some::<S, 3>(simd, fma, (v, w), (field, first, turns), (out, row))
                    }
                    2.. => fold_some::<S, 2>(simd, fma, (v, w), (field, first, turns), (out, row)),
                    _ => fold_some::<S, 1>(simd, fma, (v, w), (field, first, turns), (out, row)),
                };
            }
        }
    }
}

/// A block of rows of a spectrum, `row` vectors of cosines and as many of sines each, `V` vectors of the `w` of a field from `v` on;
/// a field's mirrors for these rows are `first` vectors from the beginning of each angle's.
#[inline(always)]
fn fold_some<S: Simd, const V: usize>(
    simd: S,
    fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy,
    (v, w): (usize, usize),
    (field, first, turns): (&[S::f32s], usize, &[[f32; 2 * BLOCK]]),
    (out, row): (&mut [S::f32s], usize),
) -> usize {
    let sums = sum_rows::<S, V>(simd, fma, (field, 4 * w, [first + v, first + w + v]), turns);
    for (i, sums) in sums.iter().enumerate() {
        for (j, sum) in sums.iter().enumerate() {
            let end = (2 * i + 1) * row - w + v + j;
            (out[end], out[end + row]) = (sum[0], sum[1]);
        }
    }
    V
}

struct Bracket<'a> {
    lanes: usize,
    bent: &'a [f32],
    out: &'a mut [f32],
}

impl Kernel for Bracket<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let w = self.lanes / S::F32_LANES;
        let bent = S::as_simd_f32s(self.bent).0.chunks_exact(3 * w);
        for (bent, out) in bent.zip(S::as_mut_simd_f32s(self.out).0.chunks_exact_mut(w)) {
            let (a, rest) = bent.split_at(w);
            let (b, d) = rest.split_at(w);
            for (((out, &a), &b), &d) in out.iter_mut().zip(a).zip(b).zip(d) {
                let product = fma(a, b, simd.neg_f32s(simd.mul_f32s(d, d)));
                *out = simd.add_f32s(product, product);
            }
        }
    }
}

struct Stress<'a> {
    lanes: usize,
    stress: &'a [f32],
    bent: &'a mut [f32],
}

impl Kernel for Stress<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, _: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let w = self.lanes / S::F32_LANES;
        let stress = S::as_simd_f32s(self.stress).0.chunks_exact(w);
        for (bent, stress) in S::as_mut_simd_f32s(self.bent).0.chunks_exact_mut(3 * w).zip(stress) {
            let (a, rest) = bent.split_at_mut(w);
            let (b, d) = rest.split_at_mut(w);
            for (((a, b), d), &stress) in a.iter_mut().zip(b).zip(d).zip(stress) {
                let twice = simd.add_f32s(stress, stress);
                (*a, *b) = (simd.mul_f32s(twice, *b), simd.mul_f32s(twice, *a));
                *d = simd.mul_f32s(simd.neg_f32s(simd.add_f32s(twice, twice)), *d);
            }
        }
    }
}
