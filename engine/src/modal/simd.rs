//! The kernels of a modal body: every loop over modes there is.
//!
//! One generic form each, compiled for the baseline of the architecture and for what `pulp` can
//! select at run time (AVX2 + FMA, AVX-512, NEON). Rows are whole multiples of [`LANES`] long.
//! Within one level results are bit-equal whatever way a stretch of samples is cut; across levels
//! they differ by rounding.

//!
//! [`dispatch`] chooses the instruction set; [`primitives`] are loops over rows, [`ring`] many samples at once, and
//! the others what single callers need.

pub mod blocks;
pub mod dispatch;
pub mod flush;
pub mod rim_harmonics;
pub mod coupled_modes;
pub mod level;
pub mod peak;
pub mod polar;
pub mod primitives;
pub mod ring;

pub use dispatch::{Kernels, LANES};
pub use ring::{MAX_DRIVES, MAX_RUN, RECEIVERS, REST};
