//! The command line: which commands there are, what they take, and how they fail.
//!
//! Results go to standard output, progress and errors to standard error. An error is one line; of several files that are
//! checked, each has its own.
//! Exit codes: 0 done, 1 failed on the way, 2 bad input (the line says what would be accepted).

mod alterations;
mod arguments;
mod numbers;

use std::ffi::OsString;
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Result, bail};
use clap::Parser;
use clap::error::ErrorKind;
use overhear::presets::Library;

use crate::{bench, error, hear, kit, presets, render};
use arguments::{BenchArguments, HearArguments, KitTask, ModesArguments, PresetTask, RenderArguments};

pub use arguments::{Command, speed};

/// A physically modelled drum kit on the command line.
#[derive(Debug, Parser)]
#[command(name = "overhear", version, arg_required_else_help = true)]
struct CommandLine {
    #[command(subcommand)]
    command: Command,
}

/// Whether the program understands a command line, the program's name first; nothing is run.
///
/// # Errors
/// What is wrong with it.
pub fn check(arguments: impl IntoIterator<Item = OsString>) -> Result<(), String> {
    CommandLine::try_parse_from(arguments).map(drop).map_err(|refusal| refusal.to_string())
}

/// Runs a command line of the program, the program's name first, and tells how it ended.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    run_as(arguments, |line: CommandLine| dispatch(line.command))
}

/// Parses a command line, the program's name first, does what it says, and tells how that ended.
pub fn run_as<Invocation: Parser>(
    arguments: impl IntoIterator<Item = OsString>,
    work: impl FnOnce(Invocation) -> Result<()>,
) -> ExitCode {
    let line = match Invocation::try_parse_from(arguments) {
        Ok(line) => line,
        Err(refusal) => return refused::<Invocation>(&refusal),
    };
    match work(line) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            for line in error::lines(&failure) {
                eprintln!("error: {line}");
            }
            ExitCode::from(error::exit_code(&failure))
        }
    }
}

/// Prints help where it was asked for, and anything else as one line.
fn refused<Invocation: Parser>(refusal: &clap::Error) -> ExitCode {
    if matches!(refusal.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
        // A reader may have seen enough and gone: `overhear --help | head`.
        drop(write!(std::io::stdout(), "{refusal}"));
        return ExitCode::SUCCESS;
    }
    if refusal.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        eprint!("{refusal}");
        return ExitCode::from(2);
    }
    let text = refusal.to_string();
    // A hint to read the help and the usage follow, over several lines.
    let reason = text.split("\n\nUsage:").next().unwrap_or(&text);
    let reason = reason.split("\n\nFor more").next().unwrap_or(reason);
    let mut line = reason.split_whitespace().collect::<Vec<_>>().join(" ");
    if refusal.kind() == ErrorKind::InvalidSubcommand {
        let command = Invocation::command();
        let names: Vec<_> = command.get_subcommands().map(|command| command.get_name()).collect();
        line = format!("{line}, accepted: {}", names.join(", "));
    }
    eprintln!("{line}");
    ExitCode::from(2)
}

/// Does what a command says.
///
/// # Errors
/// Whatever stops it; [`BadInput`](crate::error::BadInput) for what it cannot use.
pub fn dispatch(command: Command) -> Result<()> {
    // Whatever builds pieces finds what earlier commands and the plugin have built. `bench` measures builds, and has a folder of its own.
    if matches!(command, Command::Render(_) | Command::Hear(_) | Command::Modes(_)) {
        overhear::cache::provide();
    }
    match command {
        Command::Render(arguments) => render(arguments),
        Command::Hear(arguments) => hear(arguments),
        Command::Modes(arguments) => modes(&arguments),
        Command::Kit { task } => kit(task),
        Command::Presets { folder, task } => presets(folder.as_deref(), task),
        // What a development build measures is not what is installed, least of all its calibration loop.
        Command::Bench(_) if cfg!(debug_assertions) => {
            bail!("this is a development build, whose costs say nothing, accepted: a build with --release")
        }
        Command::Bench(arguments) => bench(arguments),
        Command::BenchScene { index, quality, simd, kit } => {
            bench::count_this(index, quality.into(), simd.into(), kit.as_deref())
        }
    }
}

/// Prints a result. A reader who has seen enough and closed the pipe is no error.
///
/// # Errors
/// If standard output cannot be written for any other reason.
pub fn say(text: &str) -> Result<()> {
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}

fn presets(folder: Option<&Path>, task: Option<PresetTask>) -> Result<()> {
    let library = folder.map_or_else(Library::default, Library::at);
    match task {
        None => say(&presets::list(&library)),
        Some(PresetTask::Show { name }) => say(&presets::show(&library, &name)?),
        Some(PresetTask::Save { name, from, set, about }) => {
            say(&presets::save(&library, &name, &from, &set, about)?)
        }
        Some(PresetTask::Rename { from, to }) => presets::rename(&library, &from, &to),
        Some(PresetTask::Delete { name }) => presets::delete(&library, &name),
        Some(PresetTask::Check { files }) => say(&presets::check(&library, &files)?),
    }
}

fn render(arguments: RenderArguments) -> Result<()> {
    render::run(&arguments.into_request()?)
}

fn hear(arguments: HearArguments) -> Result<()> {
    let (json, wav) = (arguments.json, arguments.wav.clone());
    let measurement = hear::run(&arguments.into_request()?, wav.as_deref())?;
    say(&if json { serde_json::to_string(&measurement)? + "\n" } else { measurement.to_string() })
}

fn bench(arguments: BenchArguments) -> Result<()> {
    let json = arguments.json;
    let report = bench::run(&arguments.into_request())?;
    say(&if json { serde_json::to_string(&report)? + "\n" } else { report.to_string() })
}

fn modes(arguments: &ModesArguments) -> Result<()> {
    let modes = arguments.run()?;
    say(&if arguments.json { serde_json::to_string(&modes)? + "\n" } else { modes.to_string() })
}

fn kit(task: KitTask) -> Result<()> {
    match task {
        KitTask::Show { what } => say(&kit::show(&Library::default(), what.as_deref())?),
        KitTask::New { file, from } => kit::new(&file, from.as_deref()),
        KitTask::Library { words } => say(&kit::library(&words)?),
        KitTask::Check { files } => {
            let (sound, outcome) = kit::check(&files);
            say(&sound)?;
            outcome
        }
        KitTask::Fitted { json: true } => say(&kit::fitted_json()?),
        KitTask::Fitted { json: false } => say(&kit::fitted_table()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_commands_are_well_formed() {
        CommandLine::command().debug_assert();
    }
}
