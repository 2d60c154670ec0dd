//! The mathematics the bodies are built from: cylinder functions, polynomials, quadrature, roots, eigenproblems, interpolation.
//!
//! Everything here runs while a piece is built or, the interpolation, the sines and the sums, once a block or a stroke; in `f64`, the sums in `f32` too;
//! nothing runs per sample.

pub mod bessel;
pub mod cubic;
pub mod eigen;
pub mod jacobi;
pub mod negligible;
pub mod quadrature;
pub mod roots;
pub mod sums;
pub mod trigonometry;
