//! Mixed modes: the matrix that takes anything given per even mode to the mixed ones.
//!
//! Even modes are those of an evenly stretched body. A mixed mode is made of even modes of nearby frequency, so that it is a short
//! run of coefficients over even modes in order of frequency.

pub mod blocks;

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::math::sums::sum_of_products;

/// The run of coefficients of one mixed mode.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Run {
    /// First even mode.
    first: u32,
    /// Where its coefficients begin and how many there are.
    start: u32,
    length: u32,
}

/// Even modes before `kept` stay as they are; each further mode is a mixture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModeMixture {
    kept: usize,
    runs: Vec<Run>,
    coefs: Vec<f32>,
}

/// Modes that a mixture can have: two heads of 2,000 each and the air between them are fewer.
pub const MAX_MIXED: usize = 8192;

impl ModeMixture {
    /// From rows of coefficients (dimensionless), each with the first even mode it speaks of.
    ///
    /// # Panics
    /// If there are more than [`MAX_MIXED`] modes.
    pub fn new(kept: usize, rows: &[(usize, Vec<f64>)]) -> ModeMixture {
        assert!(kept + rows.len() <= MAX_MIXED, "{} modes", kept + rows.len());
        let (mut runs, mut coefs) = (Vec::new(), Vec::new());
        for (first, row) in rows {
            runs.push(Run { first: *first as u32, start: coefs.len() as u32, length: row.len() as u32 });
            coefs.extend(row.iter().map(|&coef| coef as f32));
        }
        ModeMixture { kept, runs, coefs }
    }

    /// Number of modes, kept and mixed; there are as many even ones.
    pub fn modes(&self) -> usize {
        self.kept + self.runs.len()
    }

    /// Number of modes that are not mixed.
    pub fn kept(&self) -> usize {
        self.kept
    }

    /// The even modes of a mixed one (counted from the first mixed) and its share of each.
    pub fn parts(&self, mixed: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let Run { first, start, length } = self.runs[mixed];
        let coefs = &self.coefs[start as usize..][..length as usize];
        coefs.iter().enumerate().map(move |(i, &coef)| (first as usize + i, f64::from(coef)))
    }

    /// Each mode's first even mode and its shares of that and of the next ones, dimensionless.
    pub fn rows(&self) -> Vec<(usize, Vec<f64>)> {
        let kept = (0..self.kept).map(|mode| (mode, vec![1.0]));
        let mixed = self
            .runs
            .iter()
            .enumerate()
            .map(|(mixed, run)| (run.first as usize, self.parts(mixed).map(|part| part.1).collect()));
        kept.chain(mixed).collect()
    }

    /// Takes values of the even modes, in any unit, to the mixed ones.
    ///
    /// # Real-time
    /// No allocation; linear in the number of coefficients.
    #[inline(always)]
    pub fn apply(&self, even: &[f32], mixed: &mut [f32]) {
        mixed[..self.kept].copy_from_slice(&even[..self.kept]);
        for (out, run) in mixed[self.kept..].iter_mut().zip(&self.runs) {
            let coefs = &self.coefs[run.start as usize..][..run.length as usize];
            *out = sum_of_products(coefs, &even[run.first as usize..][..run.length as usize]);
        }
    }

    /// The first modes alone, made of as many even ones: what lies beyond in them is left out.
    pub fn first(&self, modes: usize) -> ModeMixture {
        let kept = self.kept.min(modes);
        let row = |mixed: usize| {
            let parts: Vec<(usize, f64)> = self.parts(mixed).filter(|(part, _)| *part < modes).collect();
            let first = parts.first().map_or(kept, |part| part.0);
            (first, parts.into_iter().map(|part| part.1).collect())
        };
        let rows: Vec<(usize, Vec<f64>)> = (0..modes - kept).map(row).collect();
        ModeMixture::new(kept, &rows)
    }

    /// The transpose, which takes amplitudes of the mixed modes to those of the even ones; its own modes are the even ones.
    pub fn transposed(&self) -> ModeMixture {
        let mut of_even: Vec<Vec<(usize, f64)>> = vec![Vec::new(); self.runs.len()];
        for mixed in 0..self.runs.len() {
            self.parts(mixed)
                .for_each(|(even, coef)| of_even[even - self.kept].push((self.kept + mixed, coef)));
        }
        let row = |parts: &Vec<(usize, f64)>| {
            let first = parts.first().map_or(self.kept, |part| part.0);
            let mut row = vec![0.0; parts.last().map_or(0, |part| part.0 + 1 - first)];
            parts.iter().for_each(|&(mixed, coef)| row[mixed - first] = coef);
            (first, row)
        };
        let rows: Vec<(usize, Vec<f64>)> = of_even.iter().map(row).collect();
        ModeMixture::new(self.kept, &rows)
    }

    /// Takes several values of each even mode, in any units, to the mixed ones at once.
    ///
    /// # Real-time
    /// As [`apply`](Self::apply).
    #[inline(always)]
    pub fn apply_rows<const N: usize>(&self, even: &[[f32; N]], mixed: &mut [[f32; N]]) {
        self.apply_some(even, mixed, 0..self.modes());
    }

    /// [`apply_rows`](Self::apply_rows) to some of the modes, of values in any units.
    ///
    /// # Real-time
    /// As [`apply`](Self::apply).
    #[inline(always)]
    pub fn apply_some<const N: usize>(&self, even: &[[f32; N]], mixed: &mut [[f32; N]], modes: Range<usize>) {
        let kept = modes.start.min(self.kept)..modes.end.min(self.kept);
        mixed[kept.clone()].copy_from_slice(&even[kept]);
        let runs = modes.start.max(self.kept)..modes.end.max(self.kept);
        let (first, last) = (runs.start - self.kept, runs.end - self.kept);
        for (out, run) in mixed[runs].iter_mut().zip(&self.runs[first..last]) {
            let coefs = &self.coefs[run.start as usize..][..run.length as usize];
            *out = sum_of_rows(coefs, &even[run.first as usize..][..coefs.len()]);
        }
    }
}

/// Sum of the rows, each times its coefficient. Four sums hide each other's latency.
#[inline(always)]
fn sum_of_rows<const N: usize>(coefs: &[f32], rows: &[[f32; N]]) -> [f32; N] {
    let (mut a, mut b, mut c, mut d) = ([0.0; N], [0.0; N], [0.0; N], [0.0; N]);
    let (fours, rest) = coefs.as_chunks::<4>();
    let (four_rows, rest_rows) = rows.as_chunks::<4>();
    for (coefs, rows) in fours.iter().zip(four_rows) {
        for i in 0..N {
            a[i] += coefs[0] * rows[0][i];
            b[i] += coefs[1] * rows[1][i];
            c[i] += coefs[2] * rows[2][i];
            d[i] += coefs[3] * rows[3][i];
        }
    }
    for (coef, row) in rest.iter().zip(rest_rows) {
        for i in 0..N {
            a[i] += coef * row[i];
        }
    }
    for i in 0..N {
        a[i] = (a[i] + b[i]) + (c[i] + d[i]);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kept_modes_stay_and_mixed_ones_are_sums() {
        let rows = [(1, vec![0.5, 0.25]), (2, vec![2.0])];
        let mixture = ModeMixture::new(1, &rows);
        let mut out = [0.0; 3];
        mixture.apply(&[7.0, 4.0, 8.0], &mut out);
        assert_eq!(out, [7.0, 4.0, 16.0]);
        let mut rows = [[0.0; 2]; 3];
        mixture.apply_rows(&[[7.0, 1.0], [4.0, 2.0], [8.0, 4.0]], &mut rows);
        assert_eq!(rows, [[7.0, 1.0], [4.0, 2.0], [16.0, 8.0]]);
        assert_eq!(mixture.parts(0).collect::<Vec<_>>(), [(1, 0.5), (2, 0.25)]);
        assert_eq!((mixture.modes(), mixture.kept()), (3, 1));
    }

    #[test]
    fn amplitudes_come_back_by_the_transpose_and_the_first_modes_stand_alone() {
        let mixture = ModeMixture::new(1, &[(1, vec![0.5, 0.25]), (2, vec![2.0])]);
        let mut even = [9.0; 3];
        mixture.transposed().apply(&[7.0, 4.0, 8.0], &mut even);
        assert_eq!(even, [7.0, 2.0, 17.0]);
        let first = mixture.first(2);
        assert_eq!((first.modes(), first.kept()), (2, 1));
        assert_eq!(first.parts(0).collect::<Vec<_>>(), [(1, 0.5)]);
        assert_eq!(mixture.first(1).modes(), 1);
    }

    #[test]
    fn twice_transposed_is_the_same() {
        let rows = [(1, vec![0.5, 0.25]), (2, vec![2.0]), (1, vec![0.125, 0.0, -1.0])];
        let mixture = ModeMixture::new(1, &rows);
        let even = [7.0, 4.0, 8.0, 2.0];
        let applied = |mixture: &ModeMixture| {
            let mut mixed = [0.0; 4];
            mixture.apply(&even, &mut mixed);
            mixed
        };
        assert_eq!(applied(&mixture), [7.0, 4.0, 16.0, -1.5]);
        assert_eq!(applied(&mixture.transposed().transposed()), applied(&mixture));
    }
}
