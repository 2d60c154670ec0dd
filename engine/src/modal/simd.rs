//! The kernels of a modal body: all loops over modes.
//!
//! One generic form each, compiled for the baseline of the architecture and for what `pulp` can
//! select at run time (AVX2 + FMA, AVX-512, NEON). Rows are whole multiples of [`LANES`] long.
//! On one instruction set the results are bit-equal for any division of the samples into runs. Across instruction sets they
//! differ by rounding.

//!
//! [`dispatch`] chooses the instruction set; [`primitives`] are loops over rows, [`ring`] many samples at once, and
//! the others serve single callers.

pub mod blocks;
pub mod dispatch;
pub mod flush;
pub mod hear;
pub mod rim_harmonics;
pub mod coupled_modes;
pub mod level;
pub mod peak;
pub mod polar;
pub mod primitives;
pub mod ring;
pub mod row_products;

pub use dispatch::{Kernels, LANES};
pub use ring::{MAX_DRIVES, MAX_RUN, RECEIVERS, REST};
