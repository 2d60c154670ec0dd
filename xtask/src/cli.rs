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
    /// Set up, build, bundle, play a groove through the built CLAP plugin: demo.wav and demo.png
    Demo {
        /// Instead, half a minute of it with every preset, into demo-presets
        #[arg(long)]
        all_presets: bool,
    },
    /// Check everything the project promises, the hosts included
    Test {
        /// Only what takes minutes: formatting, lints, units, and the quick half of the other tests
        #[arg(long)]
        quick: bool,
    },
    /// Build the release bundles (CLAP, VST3) and the program that needs no host
    Bundle {
        /// On macOS: one file for both kinds of processors
        #[arg(long)]
        universal: bool,
    },
    /// Build the release bundles and copy them where hosts look
    Install,
    /// Measure every piece beside recordings of real kits
    Realism(RealismArguments),
    /// Measure and write the pages of docs/report
    Report {
        #[arg(value_name = "PAGE", help = report::help())]
        pages: Vec<String>,
        /// The folder to write to; docs/report if not given
        #[arg(short, long, value_name = "DIR")]
        output: Option<PathBuf>,
    },
    /// Write the manual's pages that come from the code: docs/midi.md and docs/parameters.md
    Docs,
    /// Take pictures of the built plugin's editor on a virtual display
    Shots {
        /// The folder to write to
        #[arg(short, long, value_name = "FOLDER", default_value = "shots")]
        out: PathBuf,
        /// A built CLAP plugin; without it the plugin is built and bundled first
        #[arg(long, value_name = "FILE")]
        plugin: Option<PathBuf>,
        /// Count what an open window costs instead
        #[arg(long)]
        cost: bool,
        /// Only in the dark palette at 1x
        #[arg(long, conflicts_with = "cost")]
        glance: bool,
        /// Use the display there is
        #[arg(long, hide = true, requires = "plugin")]
        here: bool,
    },
    /// Write the demonstration groove (assets/groove.mid) anew
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
        Task::Demo { all_presets: true } => {
            demo::presets::run(&std::env::current_dir()?.join("demo-presets"))
        }
        Task::Demo { all_presets: false } => demo::run(&std::env::current_dir()?),
        Task::Test { quick: true } => suite::run_quick(),
        Task::Test { quick: false } => suite::run(),
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
