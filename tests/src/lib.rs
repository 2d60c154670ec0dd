//! What the integration tests build and measure with: the laboratory that `cargo xtask report` uses, too.

pub use overhear_lab::*;
