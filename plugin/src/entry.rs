//! The entry points that hosts look for in the library, with a guard before the framework.
//!
//! Hosts leave outputs out: JUCE passes null channels for buses it keeps inactive, others pass fewer ports than
//! were declared. The framework then skips the audio or writes where it must not. The guard completes what
//! is missing with scratch buffers, so that the framework only ever sees what was declared; to CLAP hosts it
//! also tells the names of notes.
//!
//! This module and its children hold all unsafe code that touches a host. Each function says what it relies on;
//! the formats' own contracts, in short, are: a pointer that a host passes is null or valid for the call; a CLAP
//! plugin or VST3 object lives from its creation to its `destroy` or last release; `activate` and `process`
//! never overlap.
#![allow(unsafe_code)]

/// How long it rings after the last note, s: a cymbal, a minute at most.
const TAIL: f64 = 60.0;

mod clap;
mod scratch;
#[cfg(test)]
mod sweep;
mod vst3;
