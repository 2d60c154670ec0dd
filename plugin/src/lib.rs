//! Overhear as a plugin.
