//! The command line: the tasks of this repository, and the commands of the program `overhear`, which are passed on to it.

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use clap::{Parser, Subcommand};
use overhear_cli::commands::{self, Command, say};
use overhear_cli::output;

use crate::bundle::Processors;
use crate::realism::RealismArguments;
use crate::{bundle, demo, groove, manual, program, realism, report, shots, suite};

/// Developer and user commands of Overhear.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version, arg_required_else_help = true)]
struct CommandLine {
    #[command(subcommand)]
    task: Task,
}

/// What to do.
#[derive(Debug, Subcommand)]
enum Task {
    /// Build and bundle the plugin and play a groove through it: demo.wav and demo.png
    Demo {
        /// Play this MIDI file instead of the groove
        #[arg(long, value_name = "FILE", conflicts_with_all = ["all_presets", "all_kits"])]
        song: Option<PathBuf>,
        /// Instead play half a minute with every preset, into demo-presets
        #[arg(long)]
        all_presets: bool,
        /// Instead play the groove on every whole kit of the library, into demo-kits
        #[arg(long, conflicts_with = "all_presets")]
        all_kits: bool,
    },
    /// Run every check, including tests in hosts
    Test {
        /// Only what takes minutes: formatting, lints, units, and the quick half of the other tests
        #[arg(long)]
        quick: bool,
        /// Only what takes a host of its own: a session in Ardour, which is installed if it is missing
        #[arg(long, conflicts_with = "quick")]
        ardour: bool,
    },
    /// Build the release bundles (CLAP, VST3) and the standalone program
    Bundle {
        /// On macOS: build for both processor types
        #[arg(long)]
        universal: bool,
    },
    /// Build the release bundles and copy them to the plugin folders
    Install,
    /// Compare every piece with recordings of real kits
    Realism(RealismArguments),
    /// Measure and write the pages of docs/report
    Report {
        #[arg(value_name = "PAGE", help = report::help())]
        pages: Vec<String>,
        /// The folder to write to; default: docs/report
        #[arg(short, long, value_name = "DIR")]
        output: Option<PathBuf>,
    },
    /// Write the pages of the manual that are generated from the code: docs/midi.md and docs/parameters.md
    Docs,
    /// Take pictures of the built plugin's editor on a virtual display
    Shots {
        /// The folder to write to
        #[arg(short, long, value_name = "FOLDER", default_value = "shots")]
        out: PathBuf,
        /// A built CLAP plugin; by default the plugin is built and bundled first
        #[arg(long, value_name = "FILE")]
        plugin: Option<PathBuf>,
        /// Instead measure the processor time of an open window
        #[arg(long)]
        cost: bool,
        /// Only the dark palette at 1x
        #[arg(long, conflicts_with = "cost")]
        glance: bool,
        /// Use the existing display
        #[arg(long, hide = true, requires = "plugin")]
        here: bool,
    },
    /// Write the demonstration groove (assets/groove.mid) again
    #[command(hide = true)]
    Groove {
        /// The MIDI file to write
        #[arg(short, long, value_name = "FILE")]
        output: PathBuf,
    },
    #[command(flatten)]
    Program(Command),
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
    commands::run_as(arguments, |line: CommandLine| dispatch(line.task))
}

fn dispatch(task: Task) -> Result<()> {
    match task {
        Task::Demo { all_presets: true, .. } => {
            demo::presets::run(&std::env::current_dir()?.join("demo-presets"))
        }
        Task::Demo { all_kits: true, .. } => demo::kits::run(&std::env::current_dir()?.join("demo-kits")),
        Task::Demo { song, .. } => demo::run(&std::env::current_dir()?, song.as_deref()),
        Task::Test { ardour: true, .. } => suite::run_ardour(),
        Task::Test { quick: true, .. } => suite::run_quick(),
        Task::Test { .. } => suite::run(),
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
        Task::Realism(arguments) => realism::run(arguments),
        Task::Report { pages, output } => report::run(&pages, &output.unwrap_or_else(report::folder)),
        Task::Docs => manual::write(),
        Task::Shots { plugin: Some(plugin), cost: true, here: true, .. } => shots::cost::here(&plugin),
        Task::Shots { out, plugin: Some(plugin), glance, here: true, .. } => {
            shots::here(&out, glance, &plugin)
        }
        Task::Shots { out, plugin, cost, glance, .. } => {
            let aim = match (cost, glance) {
                (true, _) => shots::Aim::Cost,
                (_, true) => shots::Aim::Glance(out),
                _ => shots::Aim::Pictures(out),
            };
            shots::run(&aim, plugin)
        }
        Task::Groove { output } => output::write(&output, &groove::file()),
        Task::Program(Command::Bench(_)) => program::in_release(std::env::args_os().skip(1)),
        Task::Program(command) => commands::dispatch(command),
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
