//! Loops over rows: products, sums, rotations.

use pulp::Simd;

use super::dispatch::{Kernel, Kernels};

/// Sums side by side, which hide the latency of the addition.
const SUMS: usize = 4;

/// All lanes of all sums.
#[inline(always)]
fn total<S: Simd>(simd: S, sums: [S::f32s; SUMS]) -> f32 {
    simd.reduce_sum_f32s(simd.add_f32s(simd.add_f32s(sums[0], sums[1]), simd.add_f32s(sums[2], sums[3])))
}

/// A row that goes through whole vectors only.
#[inline(always)]
fn whole<S: Simd>(row: &[f32]) -> &[S::f32s] {
    let (whole, rest) = S::as_simd_f32s(row);
    debug_assert!(rest.is_empty(), "{} values are no whole number of vectors", row.len());
    whole
}

/// The same, to be changed.
#[inline(always)]
fn whole_mut<S: Simd>(row: &mut [f32]) -> &mut [S::f32s] {
    let length = row.len();
    let (whole, rest) = S::as_mut_simd_f32s(row);
    debug_assert!(rest.is_empty(), "{length} values are no whole number of vectors");
    whole
}

impl Kernels {
    /// `z <- z + turn * z`, complex, for every mode.
    pub fn rotate(&self, re: &mut [f32], im: &mut [f32], turn_re: &[f32], turn_im: &[f32]) {
        self.run(Rotate { re, im, turn_re, turn_im });
    }

    /// `y <- y + x * factor`.
    pub fn axpy(&self, y: &mut [f32], x: &[f32], factor: f32) {
        self.run(Axpy { y, x, factor });
    }

    /// `out <- a * b`.
    pub fn multiply(&self, out: &mut [f32], a: &[f32], b: &[f32]) {
        self.run(Multiply { out, a, b });
    }

    /// `sum a * b`, over as many as the shorter row has, which may be any number.
    pub fn dot(&self, a: &[f32], b: &[f32]) -> f32 {
        let length = a.len().min(b.len());
        self.run(Dot { a: &a[..length], b: &b[..length] })
    }

    /// `sum a * (x - y)`, each difference taken before it is weighted.
    pub fn dot_difference(&self, a: &[f32], x: &[f32], y: &[f32]) -> f32 {
        let length = a.len().min(x.len()).min(y.len());
        self.run(DotDifference { a: &a[..length], x: &x[..length], y: &y[..length] })
    }

    /// `sum a * x^2`.
    pub fn dot_square(&self, a: &[f32], x: &[f32]) -> f32 {
        let length = a.len().min(x.len());
        self.run(DotSquare { a: &a[..length], x: &x[..length] })
    }

    /// `out <- a * x + b * y`.
    pub fn combine(&self, out: &mut [f32], (a, x): (&[f32], &[f32]), (b, y): (&[f32], &[f32])) {
        self.run(Combine { out, a, x, b, y });
    }

    /// `y <- y * factor`.
    pub fn scale(&self, y: &mut [f32], factor: f32) {
        self.run(Scale { y, factor });
    }

    /// Whether every value is a finite number.
    pub fn is_finite(&self, row: &[f32]) -> bool {
        self.vectorized(
            #[inline(always)]
            || row.iter().fold(true, |finite, x| finite & x.is_finite()),
        )
    }

    /// Whether every value is exactly zero.
    pub fn is_zero(&self, row: &[f32]) -> bool {
        row.iter().all(|&x| x == 0.0)
    }
}

struct Rotate<'a> {
    re: &'a mut [f32],
    im: &'a mut [f32],
    turn_re: &'a [f32],
    turn_im: &'a [f32],
}

/// One sample of one group of modes.
#[inline(always)]
pub(super) fn turn<S: Simd>(
    simd: S,
    fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s,
    (re, im): (S::f32s, S::f32s),
    (t_re, t_im): (S::f32s, S::f32s),
) -> (S::f32s, S::f32s) {
    // The small change is summed first and added last, so that the state is rounded once a sample.
    // Rounding it twice lets the energy of slow modes wander by 1e-3 a second (measured).
    let change_re = fma(t_re, re, simd.neg_f32s(simd.mul_f32s(t_im, im)));
    let change_im = fma(t_im, re, simd.mul_f32s(t_re, im));
    (simd.add_f32s(re, change_re), simd.add_f32s(im, change_im))
}

impl Kernel for Rotate<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let (re, im) = (whole_mut::<S>(self.re), whole_mut::<S>(self.im));
        let (t_re, t_im) = (whole::<S>(self.turn_re), whole::<S>(self.turn_im));
        for ((re, im), (&t_re, &t_im)) in re.iter_mut().zip(im).zip(t_re.iter().zip(t_im)) {
            (*re, *im) = turn(simd, fma, (*re, *im), (t_re, t_im));
        }
    }
}

struct Axpy<'a> {
    y: &'a mut [f32],
    x: &'a [f32],
    factor: f32,
}

impl Kernel for Axpy<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let factor = simd.splat_f32s(self.factor);
        for (y, &x) in whole_mut::<S>(self.y).iter_mut().zip(whole::<S>(self.x)) {
            *y = fma(x, factor, *y);
        }
    }
}

struct Multiply<'a> {
    out: &'a mut [f32],
    a: &'a [f32],
    b: &'a [f32],
}

impl Kernel for Multiply<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, _: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let factors = whole::<S>(self.a).iter().zip(whole::<S>(self.b));
        for (out, (&a, &b)) in whole_mut::<S>(self.out).iter_mut().zip(factors) {
            *out = simd.mul_f32s(a, b);
        }
    }
}

struct Dot<'a> {
    a: &'a [f32],
    b: &'a [f32],
}

impl Kernel for Dot<'_> {
    type Output = f32;
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) -> f32 {
        let mut sums = [simd.splat_f32s(0.0); SUMS];
        let ((a, a_end), (b, b_end)) = (S::as_simd_f32s(self.a), S::as_simd_f32s(self.b));
        // Less than a vector: most rows are whole ones, and have none.
        let end: f32 = a_end.iter().zip(b_end).map(|(a, b)| a * b).sum();
        let (a_fours, a_rest) = a.as_chunks::<SUMS>();
        let (b_fours, b_rest) = b.as_chunks::<SUMS>();
        for (a, b) in a_fours.iter().zip(b_fours) {
            for i in 0..SUMS {
                sums[i] = fma(a[i], b[i], sums[i]);
            }
        }
        for (i, (&a, &b)) in a_rest.iter().zip(b_rest).enumerate() {
            sums[i] = fma(a, b, sums[i]);
        }
        total(simd, sums) + end
    }
}

struct DotDifference<'a> {
    a: &'a [f32],
    x: &'a [f32],
    y: &'a [f32],
}

impl Kernel for DotDifference<'_> {
    type Output = f32;
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) -> f32 {
        let mut sums = [simd.splat_f32s(0.0); SUMS];
        let [(a, a_rest), (x, x_rest), (y, y_rest)] =
            [self.a, self.x, self.y].map(|row| whole::<S>(row).as_chunks::<SUMS>());
        for ((a, x), y) in a.iter().zip(x).zip(y) {
            for i in 0..SUMS {
                sums[i] = fma(a[i], simd.sub_f32s(x[i], y[i]), sums[i]);
            }
        }
        for (i, ((&a, &x), &y)) in a_rest.iter().zip(x_rest).zip(y_rest).enumerate() {
            sums[i] = fma(a, simd.sub_f32s(x, y), sums[i]);
        }
        total(simd, sums)
    }
}

struct DotSquare<'a> {
    a: &'a [f32],
    x: &'a [f32],
}

impl Kernel for DotSquare<'_> {
    type Output = f32;
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) -> f32 {
        let mut sums = [simd.splat_f32s(0.0); SUMS];
        let [(a, a_rest), (x, x_rest)] = [self.a, self.x].map(|row| whole::<S>(row).as_chunks::<SUMS>());
        for (a, x) in a.iter().zip(x) {
            for i in 0..SUMS {
                sums[i] = fma(simd.mul_f32s(a[i], x[i]), x[i], sums[i]);
            }
        }
        for (i, (&a, &x)) in a_rest.iter().zip(x_rest).enumerate() {
            sums[i] = fma(simd.mul_f32s(a, x), x, sums[i]);
        }
        total(simd, sums)
    }
}

struct Combine<'a> {
    out: &'a mut [f32],
    a: &'a [f32],
    x: &'a [f32],
    b: &'a [f32],
    y: &'a [f32],
}

impl Kernel for Combine<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, fma: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let [a, x, b, y] = [self.a, self.x, self.b, self.y].map(whole::<S>);
        let terms = a.iter().zip(x).zip(b.iter().zip(y));
        for (out, ((&a, &x), (&b, &y))) in whole_mut::<S>(self.out).iter_mut().zip(terms) {
            *out = fma(a, x, simd.mul_f32s(b, y));
        }
    }
}

struct Scale<'a> {
    y: &'a mut [f32],
    factor: f32,
}

impl Kernel for Scale<'_> {
    type Output = ();
    #[inline(always)]
    fn with<S: Simd>(self, simd: S, _: impl Fn(S::f32s, S::f32s, S::f32s) -> S::f32s + Copy) {
        let factor = simd.splat_f32s(self.factor);
        for y in whole_mut::<S>(self.y) {
            *y = simd.mul_f32s(*y, factor);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sum_of_products_leaves_none_out_however_many_there_are() {
        for kernels in [Kernels::detect(), Kernels::baseline()] {
            for count in 0..=70 {
                let a: Vec<f32> = (0..count).map(|i| (i + 1) as f32).collect();
                let expected: f32 = (0..count).map(|i| 2.0 * (i + 1) as f32).sum();
                assert_eq!(kernels.dot(&a, &[2.0; 70]), expected, "{count} values");
            }
        }
    }
}
