//! Mixed modes: the matrix that takes anything given per even mode to the mixed ones.
//!
//! Even modes are those of an evenly stretched body. A mixed mode is made of even modes of nearby frequency, so that it is a short
//! run of coefficients over even modes in order of frequency.

pub mod blocks;

use serde::{Deserialize, Serialize};

use crate::modal::simd::row_products::RowProducts;

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

    /// What takes values of the even modes, in any unit, to the mixed ones. Allocates.
    pub fn products(&self) -> RowProducts {
        RowProducts::new(&self.rows(), self.modes())
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modal::simd::Kernels;
    use crate::modal::zero_row;

    fn applied(mixture: &ModeMixture, even: &[f32]) -> Vec<f32> {
        let (mut padded, mut mixed) = (zero_row(even.len()), vec![0.0; mixture.modes()]);
        padded[..even.len()].copy_from_slice(even);
        Kernels::detect().row_products(&mixture.products(), &padded, &mut mixed);
        mixed
    }

    #[test]
    fn kept_modes_stay_and_mixed_ones_are_sums() {
        let rows = [(1, vec![0.5, 0.25]), (2, vec![2.0])];
        let mixture = ModeMixture::new(1, &rows);
        assert_eq!(applied(&mixture, &[7.0, 4.0, 8.0]), [7.0, 4.0, 16.0]);
        assert_eq!(mixture.parts(0).collect::<Vec<_>>(), [(1, 0.5), (2, 0.25)]);
        assert_eq!((mixture.modes(), mixture.kept()), (3, 1));
    }

    #[test]
    fn amplitudes_come_back_by_the_transpose_and_the_first_modes_stand_alone() {
        let mixture = ModeMixture::new(1, &[(1, vec![0.5, 0.25]), (2, vec![2.0])]);
        assert_eq!(applied(&mixture.transposed(), &[7.0, 4.0, 8.0]), [7.0, 2.0, 17.0]);
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
        assert_eq!(applied(&mixture, &even), [7.0, 4.0, 16.0, -1.5]);
        assert_eq!(applied(&mixture.transposed().transposed(), &even), applied(&mixture, &even));
    }
}
