//! `overhear`: see [`overhear_cli::commands`].

use std::process::ExitCode;

fn main() -> ExitCode {
    overhear_cli::commands::run(std::env::args_os())
}
