//! What each command takes.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::{Args, Subcommand, ValueEnum};
use overhear::kit_document::KitDocument;
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::modal::simd::level::InstructionSet;
use overhear_engine::piece::{self, BuildOptions, SAMPLE_RATES};
use overhear_engine::slot::Slot;
use overhear_engine::strike::{Strike, Striker};
use overhear_measure::hear;

use super::alterations::Alterations;
use super::numbers::{angle, number};
use crate::modes::Modes;
use crate::player::{Blocks, Source};
use crate::plugin_folders::{self, Format};
use crate::settings::Chosen;
use crate::wav::Bits;
use crate::{bench, modes, render, settings, stage};

/// Sample rates that the engine builds for, Hz.
const RATES: std::ops::RangeInclusive<i64> = *SAMPLE_RATES.start() as i64..=*SAMPLE_RATES.end() as i64;

/// Longest sound after the last note and of one stroke, s.
const LONGEST: f64 = 600.0;

/// What the program does.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render MIDI files to WAV files
    Render(RenderArguments),
    /// Strike one piece once and measure the sound
    Hear(HearArguments),
    /// List every vibration mode of a piece
    Modes(ModesArguments),
    /// Show, start and check kit files, and list fitted constants
    Kit {
        /// What to do with them.
        #[command(subcommand)]
        task: KitTask,
    },
    /// List, show, save, rename, delete and check presets
    Presets {
        /// The folder of your presets, if it is not the usual one
        #[arg(long, value_name = "DIR", global = true)]
        folder: Option<PathBuf>,
        /// What to do with them; without anything they are listed.
        #[command(subcommand)]
        task: Option<PresetTask>,
    },
    /// Measure how much processor time and memory the instrument needs
    Bench(BenchArguments),
    /// Play one scene of `bench` once, for callgrind to count
    #[command(hide = true)]
    BenchScene {
        /// Number of the scene
        index: usize,
        /// Tier of the kit's cymbals
        quality: Quality,
        /// Instruction set
        simd: Simd,
        /// A file of the kit
        kit: Option<PathBuf>,
    },
}

/// Tasks for kits.
#[derive(Debug, Subcommand)]
pub enum KitTask {
    /// Print the complete file of a kit, by default the standard kit
    Show {
        /// The name of a preset, whose kit is printed, or a kit file
        #[arg(value_name = "NAME|FILE")]
        what: Option<String>,
    },
    /// Start a kit file: the standard kit, with comments on how to change it
    New {
        /// The file to write
        file: PathBuf,
        /// A kit of the library to start from
        #[arg(long, value_name = "KIT")]
        from: Option<String>,
    },
    /// List the instruments and kits of the library
    Library {
        /// Words that their names or descriptions contain
        #[arg(value_name = "WORD")]
        words: Vec<String>,
    },
    /// Check kit files
    Check {
        /// Files
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
    },
    /// List every fitted constant, what it was fitted to, and what else it affects
    Fitted {
        /// Print one JSON list
        #[arg(long)]
        json: bool,
    },
}

/// Tasks for presets; by default they are listed.
#[derive(Debug, Subcommand)]
pub enum PresetTask {
    /// Print a preset's file
    Show {
        /// A name
        name: String,
    },
    /// Save a preset made from another preset and changed values
    Save {
        /// Name of the new preset
        name: String,
        /// The preset to start from
        #[arg(long, value_name = "NAME", default_value = "default")]
        from: String,
        /// Set a parameter, such as kick_tune=60; can be repeated
        #[arg(long, value_name = "NAME=VALUE")]
        set: Vec<String>,
        /// A description of one line
        #[arg(long, default_value = "")]
        about: String,
    },
    /// Rename one of your presets
    Rename {
        /// The present name
        from: String,
        /// The new name
        to: String,
    },
    /// Delete one of your presets
    Delete {
        /// A name
        name: String,
    },
    /// Check preset files, or all presets if none is given
    Check {
        /// Files
        files: Vec<PathBuf>,
    },
}

/// Arguments of `render`.
#[derive(Debug, Args)]
pub struct RenderArguments {
    /// MIDI files, or folders of them
    #[arg(required = true, value_name = "SONG.mid")]
    songs: Vec<PathBuf>,
    /// The WAV file to write, or a folder if there are several songs
    #[arg(short, long, value_name = "OUT.wav")]
    output: PathBuf,
    /// Start from a preset: a name listed by `presets`, or a file
    #[arg(long, value_name = "NAME|FILE.toml", default_value = "default")]
    preset: String,
    /// Play the kit in this file, or of this name in the library, instead of the preset's
    #[arg(long, value_name = "FILE|KIT")]
    kit: Option<PathBuf>,
    /// Set a parameter before the start, such as kick_tune=60 or ride_level=-6; can be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Sample rate, Hz
    #[arg(long, value_name = "HZ", default_value = "48000", value_parser = rate)]
    rate: u32,
    /// Buffer length in samples, 1 to 8192 or `random`; does not change the sound
    #[arg(long, value_name = "N|random", default_value = "512")]
    block: Blocks,
    /// Also write one WAV file per microphone into this folder
    #[arg(long, value_name = "DIR")]
    stems: Option<PathBuf>,
    /// Bits per sample
    #[arg(long, default_value = "32f")]
    bits: Bits,
    /// Play the built-in engine (the default)
    #[arg(long, conflicts_with = "clap")]
    engine: bool,
    /// Play the plugin in an embedded host: a CLAP bundle, or `installed` for the one in a standard plugin folder; the
    /// samples are the same
    #[arg(long, value_name = "PATH|installed")]
    clap: Option<PathBuf>,
    /// Move a piece, a pair of microphones or a close microphone to a position in metres: kick=0,.3,-.2,
    /// overheads=-1,2,0,1,2,0, snare-mic=-.4,.8,-.3; can be repeated
    #[arg(long, value_name = "NAME=X,Y,Z", allow_hyphen_values = true)]
    place: Vec<String>,
    /// Additional threads that render pieces, 0 to 3; does not change the sound
    #[arg(long, alias = "workers", value_name = "N", value_parser = clap::value_parser!(u8).range(0..=3))]
    render_threads: Option<u8>,
    /// Songs rendered at the same time; by default one per processor core
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Length of the sound after the last note, s
    #[arg(long, value_name = "S", default_value = "5", value_parser = tail)]
    tail: f64,
    /// Play only this MIDI channel, 1 to 16
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=16))]
    channel: Option<u8>,
}

impl RenderArguments {
    /// The request of these arguments.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) for a kit or a parameter that is not one.
    pub fn into_request(self) -> Result<render::Request> {
        let source = match self.clap {
            None => Source::Engine,
            Some(path) if path.as_os_str() == "installed" => {
                Source::Clap(plugin_folders::find(Format::Clap)?)
            }
            Some(path) => Source::Clap(path),
        };
        let threads = self.render_threads.map(|threads| format!("render_threads={threads}"));
        let set: Vec<String> = self.set.into_iter().chain(threads).collect();
        let Chosen { kit, settings } = settings::choose(&self.preset, self.kit.as_deref(), &set)?;
        Ok(render::Request {
            inputs: self.songs,
            output: self.output,
            stems: self.stems,
            jobs: self.jobs.map(usize::from),
            style: render::Style {
                source,
                rate: self.rate,
                kit: KitDocument { kit: stage::place(kit.kit, &self.place)?, ..kit },
                settings,
                blocks: self.block,
                bits: self.bits,
                tail: self.tail,
                channel: self.channel,
            },
        })
    }
}

/// Highest coupled mode of a cymbal.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Quality {
    /// To 1 kHz.
    Eco,
    /// To 2 kHz, the default during playback.
    Standard,
    /// To 4 kHz.
    High,
    /// To 8 kHz.
    Offline,
}

impl From<Quality> for piece::Quality {
    fn from(quality: Quality) -> piece::Quality {
        match quality {
            Quality::Eco => piece::Quality::Eco,
            Quality::Standard => piece::Quality::Standard,
            Quality::High => piece::Quality::High,
            Quality::Offline => piece::Quality::Offline,
        }
    }
}

/// Arguments of `hear`.
#[derive(Debug, Args)]
pub struct HearArguments {
    #[arg(help = piece_help())]
    piece: String,
    /// Take the piece from the kit in this file, or of this name in the library
    #[arg(long, value_name = "FILE|KIT")]
    kit: Option<PathBuf>,
    /// Speed of the stroke, m/s, up to 25
    #[arg(long, value_name = "M/S", default_value_t = hear::DEFAULT_SPEED, value_parser = speed)]
    speed: f64,
    /// Distance from the centre, 0 to 1 of the radius; by default where the piece is usually played
    #[arg(long, value_name = "R", value_parser = share)]
    at: Option<f64>,
    /// Direction of the strike position, degrees from the player's side
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, value_parser = angle)]
    angle: Option<f64>,
    #[arg(long, value_name = "NAME", help = striker_help())]
    striker: Option<String>,
    /// Tune or muffle the piece, such as snare_tune=240 or ride_muffle=.3; can be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Sample rate, Hz
    #[arg(long, value_name = "HZ", default_value = "48000", value_parser = rate)]
    rate: u32,
    /// Length of the sound, s
    #[arg(long, value_name = "S", default_value = "4", value_parser = seconds)]
    seconds: f64,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
    /// Write the sound as 32-bit float; full scale is 20 Pa
    #[arg(long, value_name = "OUT.wav")]
    pub wav: Option<PathBuf>,
    #[command(flatten)]
    alterations: Alterations,
    /// Highest coupled mode of a cymbal
    #[arg(long, default_value = "offline")]
    quality: Quality,
}

impl HearArguments {
    /// The request of these arguments.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) for a name or a parameter that is not one.
    pub fn into_request(self) -> Result<hear::Request> {
        let (document, slot, kit) = one_piece(self.kit.as_deref(), &self.piece, &self.alterations)?;
        let default = hear::default_strike(&document, slot);
        let striker = match &self.striker {
            Some(name) => hear::striker(name)?,
            None => default.striker,
        };
        let strike = Strike {
            speed: self.speed,
            radius: self.at.unwrap_or(default.radius),
            angle: self.angle.map_or(default.angle, f64::to_radians),
            striker,
        };
        let settings = settings::parse_for_piece(&kit, &self.set)?;
        let options =
            BuildOptions { quality: self.quality.into(), ..BuildOptions::new(f64::from(self.rate)) };
        Ok(hear::Request { kit, strike, settings, options, seconds: self.seconds })
    }
}

/// What `--help` says of a piece's name.
fn piece_help() -> String {
    let names: Vec<String> = KitSpec::standard().pieces.into_iter().map(|piece| piece.name).collect();
    format!("Name of a piece of the kit; those of the standard kit are {}", names.join(", "))
}

/// What `--help` says of a striker's name.
fn striker_help() -> String {
    let names = Striker::ALL.map(Striker::name).join(", ");
    format!("What strikes, by default what the piece is usually played with: {names}")
}

/// A kit, the slot of a piece in it, and a kit of that piece alone, changed as asked for.
fn one_piece(
    file: Option<&Path>,
    name: &str,
    alterations: &Alterations,
) -> Result<(KitDocument, Slot, KitSpec)> {
    let document = settings::kit(file)?;
    let (slot, piece) = settings::piece(&document.kit, name)?;
    let piece = alterations.apply(piece.clone())?;
    let alone = document.kit.alone(slot).context("the slot is empty")?;
    Ok((document, slot, KitSpec { pieces: vec![piece], ..alone }))
}

/// Arguments of `modes`.
#[derive(Debug, Args)]
pub struct ModesArguments {
    #[arg(help = piece_help())]
    piece: String,
    /// Take the piece from the kit in this file, or of this name in the library
    #[arg(long, value_name = "FILE|KIT")]
    kit: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
    /// Tune or muffle the piece, such as snare_tune=240 or ride_muffle=.3; can be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Sample rate, Hz
    #[arg(long, value_name = "HZ", default_value = "48000", value_parser = rate)]
    rate: u32,
    /// Remove the resonant head, or the timpani's kettle
    #[arg(long)]
    open: bool,
    /// Build perfectly round bodies, whose pairs of modes share one frequency
    #[arg(long)]
    unsplit: bool,
}

impl ModesArguments {
    /// Builds the piece that is asked for and lists its modes.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) for a name or a parameter that is not one.
    pub fn run(&self) -> Result<Modes> {
        let alterations = Alterations { open: self.open, unsplit: self.unsplit, ..Alterations::default() };
        let (.., kit) = one_piece(self.kit.as_deref(), &self.piece, &alterations)?;
        let settings = settings::parse_for_piece(&kit, &self.set)?;
        modes::run(&kit, &BuildOptions::new(f64::from(self.rate)), &settings)
    }
}

/// Arguments of `bench`.
#[derive(Debug, Args)]
pub struct BenchArguments {
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
    /// Measure the kit in this file, or of this name in the library
    #[arg(long, value_name = "FILE|KIT")]
    kit: Option<PathBuf>,
    /// Number of measurements of everything
    #[arg(long, value_name = "N", default_value_t = bench::RUNS as u16, value_parser = clap::value_parser!(u16).range(1..))]
    runs: u16,
    /// Highest coupled mode of the kit's cymbals
    #[arg(long, default_value = "standard")]
    quality: Quality,
    /// Sample rate, Hz
    #[arg(long, value_name = "HZ", default_value_t = bench::RATE as u32, value_parser = clap::value_parser!(u32).range(RATES))]
    rate: u32,
    /// Widest instruction set to use
    #[arg(long)]
    simd: Option<Simd>,
    /// Compare with an older report, written with --json
    #[arg(long, value_name = "OLD.json")]
    compare: Option<PathBuf>,
    /// Also count instructions (needs valgrind)
    #[arg(long)]
    callgrind: bool,
}

impl BenchArguments {
    /// The request of these arguments.
    pub fn into_request(self) -> bench::Request {
        bench::Request {
            kit: self.kit,
            runs: self.runs.into(),
            quality: self.quality.into(),
            rate: self.rate.into(),
            simd: self.simd.map(Into::into),
            compare: self.compare,
            callgrind: self.callgrind,
        }
    }
}

/// Instruction sets of x86-64.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Simd {
    /// Four lanes, on every machine
    Sse2,
    /// Eight lanes
    Avx2,
    /// Sixteen lanes
    Avx512,
}

impl From<Simd> for InstructionSet {
    fn from(simd: Simd) -> InstructionSet {
        match simd {
            Simd::Sse2 => InstructionSet::Sse2,
            Simd::Avx2 => InstructionSet::Avx2,
            Simd::Avx512 => InstructionSet::Avx512,
        }
    }
}

fn rate(text: &str) -> Result<u32, String> {
    text.parse().ok().filter(|&rate: &i64| RATES.contains(&rate)).map_or_else(
        || Err(format!("accepted: {} to {} Hz", RATES.start(), RATES.end())),
        |rate| u32::try_from(rate).map_err(|error| error.to_string()),
    )
}

fn tail(text: &str) -> Result<f64, String> {
    number(text, 0.0, false, LONGEST, " s")
}

fn seconds(text: &str) -> Result<f64, String> {
    number(text, 0.0, true, LONGEST, " s")
}

/// Reads the speed of a stroke, m/s.
///
/// # Errors
/// The accepted range, for what is not in it.
pub fn speed(text: &str) -> Result<f64, String> {
    number(text, 0.0, true, Strike::MAX_SPEED, " m/s")
}

fn share(text: &str) -> Result<f64, String> {
    number(text, 0.0, false, 1.0, " of the radius")
}
