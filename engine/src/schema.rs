//! The version of what caches hold.

/// Stands for the engine's sources, the libraries that calculate and the kind of processor: a digest that the build script
/// takes, and the target's name. Results that others have cached are not this version's.
pub const SCHEMA: &str = env!("OVERHEAR_SCHEMA");
