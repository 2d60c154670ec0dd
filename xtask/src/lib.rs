//! The automation of this repository: what `cargo xtask` does.
//!
//! In reading order: [`cli`] says which tasks there are and what they take; the commands of the program for users are
//! passed on to it ([`program`]). [`suite`] tests, [`bundle`] builds and installs. [`demo`] plays the [`groove`] and draws a
//! picture of it; [`shots`] takes pictures of the editor. [`report`] writes pages of figures and [`realism`] sets every piece beside
//! recordings, both measured with [`overhear_measure`]; [`manual`] writes those pages that come from the code.
//! [`system`] and [`workspace`] say what the machine has and where things lie.
#![deny(unsafe_op_in_unsafe_fn)]

pub mod bundle;
pub mod cli;
pub mod demo;
pub mod groove;
pub mod manual;
pub mod program;
pub mod realism;
pub mod report;
pub mod shots;
pub mod suite;
pub mod system;
pub mod workspace;
