//! Overhear without a host: its window, MIDI and sound on JACK or on the system's own devices.
//!
//! The framework brings backends and options (`overhear-standalone --help`); MIDI from any port plays the kit as a host's would.
//! Without JACK, sound devices and MIDI ports it still runs, on a backend without output.

use std::process::ExitCode;

use nice_plug::prelude::nice_export_standalone;
use overhear_shell::plugin::Overhear;

fn main() -> ExitCode {
    if nice_export_standalone::<Overhear>() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
