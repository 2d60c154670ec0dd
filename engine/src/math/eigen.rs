//! Eigenvalues and eigenvectors of small dense symmetric matrices.
//!
//! A thin wrapper over `nalgebra`, so that order and signs are the same on every machine and run:
//! values ascend, and each vector's largest component is positive.

use nalgebra::{DMatrix, SymmetricEigen};

/// Solution of a symmetric eigenproblem.
#[derive(Debug, Clone, PartialEq)]
pub struct Eigen {
    /// Eigenvalues, ascending.
    pub values: Vec<f64>,
    /// Unit eigenvectors, one column per value.
    pub vectors: DMatrix<f64>,
}

/// Solves `matrix v = value v`; only the lower triangle is read.
///
/// The error of each value is about 1e-16 times the largest one. The matrix must be finite.
pub fn symmetric(matrix: DMatrix<f64>) -> Eigen {
    debug_assert!(matrix.iter().all(|entry| entry.is_finite()));
    let n = matrix.nrows();
    let solved = SymmetricEigen::new(matrix);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| solved.eigenvalues[a].total_cmp(&solved.eigenvalues[b]));
    let values = order.iter().map(|&i| solved.eigenvalues[i]).collect();
    let mut vectors = DMatrix::zeros(n, n);
    for (column, &from) in order.iter().enumerate() {
        let vector = solved.eigenvectors.column(from);
        let sign = vector[vector.iamax()].signum();
        vectors.set_column(column, &(vector * sign));
    }
    Eigen { values, vectors }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_string_of_masses_has_its_known_values_and_vectors() {
        // The second difference matrix: 4 sin^2(k pi / (2 (n + 1))).
        let n = 24;
        let chain = DMatrix::from_fn(n, n, |i, j| match i.abs_diff(j) {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        });
        let solved = symmetric(chain.clone());
        for (k, &value) in solved.values.iter().enumerate() {
            let angle = (k + 1) as f64 * std::f64::consts::PI / (2.0 * (n + 1) as f64);
            assert!((value - 4.0 * angle.sin().powi(2)).abs() < 1e-13);
            let vector = solved.vectors.column(k);
            assert!((&chain * vector - vector * value).amax() < 1e-13);
            assert!((vector.norm() - 1.0).abs() < 1e-13);
            assert!(vector[vector.iamax()] > 0.0);
        }
    }
}
