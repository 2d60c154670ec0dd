//! Sums in a fixed order, which vector registers hold: of the same bits with every instruction set.

use std::iter::Sum;
use std::ops::{AddAssign, Mul};

/// Partial sums.
const LANES: usize = 8;

/// `sum a b`, in the units of both, over as many as the shorter row has.
#[inline(always)]
pub fn sum_of_products<T>(a: &[T], b: &[T]) -> T
where
    T: Copy + Default + AddAssign + Mul<Output = T> + Sum,
{
    let length = a.len().min(b.len());
    let (a, a_rest) = a[..length].as_chunks::<LANES>();
    let (b, b_rest) = b[..length].as_chunks::<LANES>();
    let mut sums = [T::default(); LANES];
    for (a, b) in a.iter().zip(b) {
        for i in 0..LANES {
            sums[i] += a[i] * b[i];
        }
    }
    let rest = a_rest.iter().zip(b_rest).map(|(&a, &b)| a * b).sum::<T>();
    let mut sum = sums.into_iter().sum::<T>();
    sum += rest;
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_product_counts_once() {
        for length in [0, 1, 7, 8, 9, 31] {
            let a: Vec<f64> = (0..length).map(f64::from).collect();
            let b = vec![2.0; a.len() + 3];
            assert_eq!(sum_of_products(&a, &b), f64::from(length * (length - 1).max(0)), "{length}");
        }
    }
}
