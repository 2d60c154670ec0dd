//! No code. The manifest asks for the features of third-party crates in which all programs of the workspace compile them, so that
//! the engine is compiled once in each profile.
