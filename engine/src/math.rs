//! The mathematics the bodies are built from: cylinder functions, quadrature, roots, eigenproblems.
//!
//! Everything here runs while a piece is built, in `f64`; nothing runs per sample.

pub mod bessel;
pub mod eigen;
pub mod quadrature;
pub mod roots;
