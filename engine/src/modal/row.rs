//! Rows of one number per mode, aligned and padded for the kernels.

use aligned_vec::{AVec, ConstAlign};

use super::simd::LANES;

/// A row of one `f32` per mode, in the unit of what it is, aligned and padded with zeros to whole SIMD lanes.
pub type Row = AVec<f32, ConstAlign<64>>;

/// A row of zeros for `modes` modes.
pub fn zero_row(modes: usize) -> Row {
    let padded = modes.div_ceil(LANES) * LANES;
    AVec::from_iter(64, std::iter::repeat_n(0.0, padded))
}
