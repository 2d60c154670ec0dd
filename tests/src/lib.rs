//! What the integration tests build and measure with: the library that the report is measured with, too, a kit that fills
//! every slot, and a trap for system calls.

mod sixteen;
#[cfg(all(target_os = "linux", any(target_arch = "x86_64", target_arch = "aarch64")))]
pub mod system_calls;

pub use overhear_measure::*;
pub use sixteen::sixteen;
