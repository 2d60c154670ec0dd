//! The floating point mode in which the engine runs, on whatever thread.

use no_denormals::no_denormals;

/// Runs the engine with denormal numbers flushed to zero and puts the thread's mode back.
///
/// Hosts call with either mode. The engine makes such numbers in hardly any block, but what is around it may: neither may cost a
/// hundred times as much in one of the modes nor sound different.
#[allow(unsafe_code)]
pub(crate) fn flushed<T>(engine: impl FnOnce() -> T) -> T {
    // SAFETY: only the flush-to-zero and denormals-are-zero modes change, and only in here; no
    // code in the engine relies on denormals, and the former mode returns before any other code
    // runs.
    unsafe { no_denormals(engine) }
}
