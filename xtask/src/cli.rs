//! The command line: which commands there are, what they take, and how they fail.
//!
//! Results go to standard output, progress and errors to standard error. An error is one line; of several files that are
//! checked, each has its own.
//! Exit codes: 0 done, 1 failed on the way, 2 bad input (the line says what would be accepted).

mod alterations;
mod arguments;

use std::ffi::OsString;
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

use anyhow::Result;
use clap::error::ErrorKind;
use clap::{CommandFactory, Parser};
use overhear::presets::Library;

use crate::bundle::Processors;
use crate::{
    bench, bundle, demo, error, groove, hear, kit, manual, output, presets, realism, render, report, shots,
    suite,
};
use arguments::{
    BenchArguments, HearArguments, KitTask, ModesArguments, PresetTask, RealismArguments, RenderArguments,
    Task,
};

/// Developer and user commands of Overhear.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version, arg_required_else_help = true)]
struct CommandLine {
    #[command(subcommand)]
    task: Task,
}

/// Whether the commands understand a command line, the program's name first; nothing is run.
///
/// # Errors
/// What is wrong with it.
pub fn check(arguments: impl IntoIterator<Item = OsString>) -> Result<(), String> {
    CommandLine::try_parse_from(arguments).map(drop).map_err(|refusal| refusal.to_string())
}

/// Runs a command line, the program's name first, and tells how it ended.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let task = match CommandLine::try_parse_from(arguments) {
        Ok(line) => line.task,
        Err(refusal) => return refused(&refusal),
    };
    match dispatch(task) {
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
fn refused(refusal: &clap::Error) -> ExitCode {
    if matches!(refusal.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
        print!("{refusal}");
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
        let command = CommandLine::command();
        let names: Vec<_> = command.get_subcommands().map(|command| command.get_name()).collect();
        line = format!("{line}, accepted: {}", names.join(", "));
    }
    eprintln!("{line}");
    ExitCode::from(2)
}

fn dispatch(task: Task) -> Result<()> {
    match task {
        Task::Demo { all_presets: true } => {
            demo::presets::run(&std::env::current_dir()?.join("demo-presets"))
        }
        Task::Demo { all_presets: false } => demo::run(&std::env::current_dir()?),
        Task::Test => suite::run(),
        Task::Bundle { universal } => {
            let processors = if universal { Processors::Universal } else { Processors::Own };
            for (_, path) in bundle::run_for(processors)? {
                say(&format!("{}\n", path.display()))?;
            }
            say(&format!("{}\n", bundle::standalone(processors)?.display()))
        }
        Task::Install => {
            for path in bundle::install()? {
                say(&format!("installed {}\n", path.display()))?;
            }
            Ok(())
        }
        Task::Render(arguments) => render(arguments),
        Task::Hear(arguments) => hear(arguments),
        Task::Modes(arguments) => modes(arguments),
        Task::Realism(arguments) => realism(arguments),
        Task::Bench(_) if cfg!(debug_assertions) => bench::as_released(),
        Task::Bench(arguments) => bench(arguments),
        Task::BenchScene { index, quality, simd, kit } => {
            bench::count_this(index, quality.into(), simd.into(), kit.as_deref())
        }
        Task::Report { pages, output } => report::run(&pages, &output.unwrap_or_else(report::folder)),
        Task::Presets { folder, task } => presets(folder.as_deref(), task),
        Task::Kit { task } => kit(task),
        Task::Docs => manual::write(),
        Task::Shots { out, plugin, cost, glance, here } => {
            let aim = match (cost, glance) {
                (true, _) => shots::Aim::Cost,
                (_, true) => shots::Aim::Glance(out),
                _ => shots::Aim::Pictures(out),
            };
            match plugin {
                Some(plugin) if here => shots::here(&aim, &plugin),
                plugin => shots::run(&aim, plugin),
            }
        }
        Task::Groove { output } => output::write(&output, &groove::file()),
    }
}

/// Prints a result. A reader who has seen enough and closed the pipe is no error.
fn say(text: &str) -> Result<()> {
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
    let (json, request) = (arguments.json, arguments.into_request()?);
    let measurement = hear::run(&request)?;
    say(&if json { serde_json::to_string(&measurement)? + "\n" } else { measurement.to_string() })
}

fn realism(arguments: RealismArguments) -> Result<()> {
    let (json, request) = (arguments.json, arguments.into_request()?);
    let report = realism::run(&request)?;
    say(&if json { serde_json::to_string(&report)? + "\n" } else { report.to_string() })
}

fn bench(arguments: BenchArguments) -> Result<()> {
    let json = arguments.json;
    let report = bench::run(&arguments.into_request())?;
    say(&if json { serde_json::to_string(&report)? + "\n" } else { report.to_string() })
}

fn modes(arguments: ModesArguments) -> Result<()> {
    let modes = arguments.run()?;
    say(&if arguments.json { serde_json::to_string(&modes)? + "\n" } else { modes.to_string() })
}

fn kit(task: KitTask) -> Result<()> {
    match task {
        KitTask::Show { what } => say(&kit::show(&Library::default(), what.as_deref())?),
        KitTask::New { file } => kit::new(&file),
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

    #[test]
    fn the_commands_are_well_formed() {
        CommandLine::command().debug_assert();
    }
}
