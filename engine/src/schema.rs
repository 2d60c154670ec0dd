//! The version of what caches hold.

/// Stands for the version of the equations, the libraries that calculate and the kind of processor: results that another
/// one has cached are not this one's. The number before the dash counts up whenever the same description comes to other
/// modes, masses, losses or pressures; `tests/tests/cache.rs` fails when it was forgotten.
pub const SCHEMA: &str = concat!("3-", env!("OVERHEAR_LIBRARIES_SCHEMA"));
