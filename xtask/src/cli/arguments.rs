//! What each command takes.

use std::path::PathBuf;

use anyhow::Result;
use clap::{Args, Subcommand, ValueEnum};
use overhear::building::Pace;
use overhear_engine::damping::Muffler;
use overhear_engine::drum::spec::PILLOW;
use overhear_engine::modal::simd::level::InstructionSet;
use overhear_engine::piece::{self, BuildOptions};
use overhear_engine::strike::Strike;

use crate::player::{Blocks, Source};
use crate::stage::Stage;
use crate::wav::Bits;
use crate::{bench, hear, realism, render, settings};

/// Sample rates that the engine builds for, Hz.
const RATES: std::ops::RangeInclusive<i64> = 22_050..=768_000;

/// Longest sound after the last note and of one stroke, s.
const LONGEST: f64 = 600.0;

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Task {
    /// Set up, build, bundle, play a groove through the built CLAP plugin: demo.wav and demo.png
    Demo {
        /// Instead, half a minute of it with every preset, into demo-presets
        #[arg(long)]
        all_presets: bool,
    },
    /// Check everything the project promises, the hosts included
    Test,
    /// Build the release bundles (CLAP, VST3) and the program that needs no host
    Bundle {
        /// On macOS: one file for both kinds of processors
        #[arg(long)]
        universal: bool,
    },
    /// Build the release bundles and copy them where hosts look
    Install,
    /// Render MIDI files to WAV files
    Render(RenderArguments),
    /// Strike one piece once and measure it
    Hear(HearArguments),
    /// List everything that vibrates in a piece
    Modes(ModesArguments),
    /// Measure every piece beside recordings of real kits
    Realism(RealismArguments),
    /// Measure what the instrument costs
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
    },
    /// Measure and write the pages of docs/report
    Report {
        /// modal, contact, heads, glide, drums, snare, plate, cymbal, cascade, hi-hat, radiation, kit, realism, cost; all if
        /// none is given
        #[arg(value_name = "PAGE")]
        pages: Vec<String>,
        /// The folder to write to; docs/report if not given
        #[arg(short, long, value_name = "DIR")]
        output: Option<PathBuf>,
    },
    /// List, show, save, rename, delete and check presets
    Presets {
        /// The folder of the user's presets, if not the platform's
        #[arg(long, value_name = "DIR", global = true)]
        folder: Option<PathBuf>,
        #[command(subcommand)]
        task: Option<PresetTask>,
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
}

/// What to do with presets; without anything they are listed.
#[derive(Debug, Subcommand)]
pub enum PresetTask {
    /// Print a preset's file
    Show {
        /// A name
        name: String,
    },
    /// Save a preset from another one and from values
    Save {
        /// Its name
        name: String,
        /// The preset to start from
        #[arg(long, value_name = "NAME", default_value = "default")]
        from: String,
        /// Move a parameter, as in kick_tune=60; repeatable
        #[arg(long, value_name = "NAME=VALUE")]
        set: Vec<String>,
        /// What it is for, in a line
        #[arg(long, default_value = "")]
        about: String,
    },
    /// Give one of your presets another name
    Rename {
        /// The name it has
        from: String,
        /// The name it gets
        to: String,
    },
    /// Delete one of your presets
    Delete {
        /// A name
        name: String,
    },
    /// Check files, or all presets if none is given
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
    /// The WAV file to write; a folder for several songs
    #[arg(short, long, value_name = "OUT.wav")]
    output: PathBuf,
    /// Start from a preset: a name that `presets` lists, or a file
    #[arg(long, value_name = "NAME|FILE.toml", default_value = "default")]
    preset: String,
    /// Move a parameter before the start, as in kick_tune=60 or ride_level=-6; repeatable
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Sample rate, Hz
    #[arg(long, value_name = "HZ", default_value = "48000", value_parser = rate)]
    rate: u32,
    /// Samples rendered at a time, 1 to 8192 or `random`; does not change the sound
    #[arg(long, value_name = "N|random", default_value = "512")]
    block: Blocks,
    /// Write one more WAV file per microphone into this folder
    #[arg(long, value_name = "DIR")]
    stems: Option<PathBuf>,
    /// Bits per sample
    #[arg(long, default_value = "32f")]
    bits: Bits,
    /// Play the engine itself (the default)
    #[arg(long, conflicts_with = "clap")]
    engine: bool,
    /// Play a CLAP bundle in an embedded host; the same samples
    #[arg(long, value_name = "PATH")]
    clap: Option<PathBuf>,
    /// Put a piece, a pair of microphones or a close microphone somewhere, metres: kick=0,.3,-.2,
    /// overheads=-1,2,0,1,2,0, snare-mic=-.4,.8,-.3; repeatable; the engine only
    #[arg(long, value_name = "NAME=X,Y,Z", allow_hyphen_values = true)]
    place: Vec<String>,
    /// Threads that render pieces beside the first, 0 to 3; does not change the sound
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=3))]
    workers: Option<u8>,
    /// Songs rendered at once; as many as there are cores if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Sound after the last note, s
    #[arg(long, value_name = "S", default_value = "5", value_parser = tail)]
    tail: f64,
    /// Play one MIDI channel only, 1 to 16
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=16))]
    channel: Option<u8>,
}

impl RenderArguments {
    /// What is asked for.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) for a parameter that is not one.
    pub fn into_request(self) -> Result<render::Request> {
        let source = self.clap.map_or(Source::Engine, Source::Clap);
        let workers = self.workers.map(|workers| format!("workers={workers}"));
        let set: Vec<String> = self.set.into_iter().chain(workers).collect();
        Ok(render::Request {
            inputs: self.songs,
            output: self.output,
            stems: self.stems,
            jobs: self.jobs.map(usize::from),
            style: render::Style {
                source,
                rate: self.rate,
                settings: settings::preset_and_set(&self.preset, &set)?,
                stage: Stage::parse(&self.place)?,
                blocks: self.block,
                bits: self.bits,
                tail: self.tail,
                channel: self.channel,
            },
        })
    }
}

/// How far up a cymbal's modes are coupled.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Quality {
    /// To 1 kHz.
    Eco,
    /// To 2 kHz, as played by default.
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
    /// kick, snare, rack-tom, floor-tom, crash, ride, splash or timpani
    piece: String,
    /// Speed of the stroke, m/s, up to 25
    #[arg(long, value_name = "M/S", default_value_t = hear::DEFAULT_SPEED, value_parser = speed)]
    speed: f64,
    /// Distance of the place from the centre, share of the radius; where it is played if not given
    #[arg(long, value_name = "R", value_parser = share)]
    at: Option<f64>,
    /// Direction of the place, degrees from the player's side
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, value_parser = angle)]
    angle: Option<f64>,
    /// stick, shoulder, nylon, felt-beater, plastic-beater, timpani-mallet, hard-mallet or
    /// yarn-mallet; what the piece is played with if not given
    #[arg(long, value_name = "NAME")]
    striker: Option<String>,
    /// Tune or muffle the piece, as in snare_tune=240 or ride_muffle=.3; repeatable
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Sample rate, Hz
    #[arg(long, value_name = "HZ", default_value = "48000", value_parser = rate)]
    rate: u32,
    /// Length of the sound, s
    #[arg(long, value_name = "S", default_value = "4", value_parser = seconds)]
    seconds: f64,
    /// Print one JSON object (see docs/commands.md)
    #[arg(long)]
    pub json: bool,
    /// Write the sound as 32-bit float, 20 Pa being full scale
    #[arg(long, value_name = "OUT.wav")]
    wav: Option<PathBuf>,
    /// Switch all damping and radiation off
    #[arg(long)]
    lossless: bool,
    /// Switch tension modulation and the coupling of the modes off
    #[arg(long)]
    linear: bool,
    /// Build perfectly round bodies, whose pairs of modes share one frequency
    #[arg(long)]
    unsplit: bool,
    /// Take off what closes a drum: the resonant head, or the timpani's kettle
    #[arg(long)]
    open: bool,
    /// Give a cymbal the bell and the taper it has in the kit
    #[arg(long)]
    bell: bool,
    /// Let a drum's head wrap itself around a stick's tip, as it does in the kit
    #[arg(long)]
    wrap: bool,
    /// Tune a drum's other head to so many times the struck one's pitch
    #[arg(long, value_name = "RATIO", value_parser = ratio)]
    resonant_ratio: Option<f64>,
    /// Make a drum's tension so uneven: mean relative difference of the two members of a pair, up to .05
    #[arg(long, value_name = "SHARE", value_parser = unevenness)]
    uneven: Option<f64>,
    /// What muffles a drum: pillow, gel, ring, or gel@R,DEG at a place
    #[arg(long, value_name = "MUFFLER", value_parser = muffler)]
    muffler: Option<Muffler>,
    /// Leave out what drum heads do above their complete sets of modes
    #[arg(long)]
    no_high_band: bool,
    /// How far up a cymbal's modes are coupled
    #[arg(long, default_value = "offline")]
    quality: Quality,
}

impl HearArguments {
    /// What is asked for.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) for a name or a parameter that is not one.
    pub fn into_request(self) -> Result<hear::Request> {
        let piece = settings::piece(&self.piece)?;
        let default = hear::default_strike(piece);
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
        let mut options = BuildOptions::new(f64::from(self.rate));
        options.lossless = self.lossless;
        options.unsplit = self.unsplit;
        options.linear = self.linear;
        options.high_band = !self.no_high_band;
        options.open = self.open;
        options.shaped = self.bell;
        options.wraps = self.wrap;
        options.resonant_ratio = self.resonant_ratio;
        options.unevenness = self.uneven;
        options.muffler = self.muffler;
        options.quality = self.quality.into();
        settings::check_options(piece, &options)?;
        let settings = settings::parse_for_piece(piece, &self.set)?;
        Ok(hear::Request { piece, strike, settings, options, seconds: self.seconds, wav: self.wav })
    }
}

/// Arguments of `modes`.
#[derive(Debug, Args)]
pub struct ModesArguments {
    /// kick, snare, rack-tom, floor-tom, crash, ride, splash or timpani
    pub piece: String,
    /// Print one JSON object (see docs/commands.md)
    #[arg(long)]
    pub json: bool,
    /// Tune or muffle the piece, as in snare_tune=240 or ride_muffle=.3; repeatable
    #[arg(long, value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// Sample rate, Hz
    #[arg(long, value_name = "HZ", default_value = "48000", value_parser = rate)]
    pub rate: u32,
    /// Take off what closes a drum: the resonant head, or the timpani's kettle
    #[arg(long)]
    open: bool,
    /// Give a cymbal the bell and the taper it has in the kit
    #[arg(long)]
    bell: bool,
    /// Perfectly round bodies, whose pairs of modes share one frequency
    #[arg(long)]
    unsplit: bool,
}

impl ModesArguments {
    /// How the piece is built.
    pub fn options(&self) -> BuildOptions {
        let own = BuildOptions::new(f64::from(self.rate));
        BuildOptions { open: self.open, shaped: self.bell, unsplit: self.unsplit, ..own }
    }
}

/// Arguments of `realism`.
#[derive(Debug, Args)]
pub struct RealismArguments {
    /// kick, snare, rack-tom, floor-tom, crash, ride, splash, hi-hat-closed, hi-hat-open; all if not given
    #[arg(value_name = "PIECE")]
    pieces: Vec<String>,
    /// Speeds of the strokes, m/s, up to 25
    #[arg(long, value_name = "M/S,M/S,...", value_delimiter = ',', value_parser = speed,
          default_values_t = realism::SPEEDS)]
    speeds: Vec<f64>,
    /// Move a parameter from its default, as in snare_tune=180 or offline_quality=high; repeatable
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// The kit as a host plays it, cymbals at the quality for that; else as it is bounced
    #[arg(long)]
    live: bool,
    /// Print one JSON object (see docs/commands.md)
    #[arg(long)]
    pub json: bool,
    /// Keep the sounds in this folder, as 32-bit float
    #[arg(long, value_name = "DIR")]
    wav: Option<PathBuf>,
}

impl RealismArguments {
    /// What is asked for.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) for a piece that was not recorded.
    pub fn into_request(self) -> Result<realism::Request> {
        let mut speeds = self.speeds;
        speeds.sort_by(f64::total_cmp);
        speeds.dedup();
        let subjects = realism::subjects(&self.pieces)?;
        let settings = settings::parse(&self.set)?;
        let pace = if self.live { Pace::RealTime } else { Pace::Offline };
        Ok(realism::Request { subjects, speeds, settings, pace, wav: self.wav })
    }
}

/// Arguments of `bench`.
#[derive(Debug, Args)]
pub struct BenchArguments {
    /// Print one JSON object (see docs/commands.md)
    #[arg(long)]
    pub json: bool,
    /// Times that everything is measured
    #[arg(long, value_name = "N", default_value_t = bench::RUNS as u16, value_parser = clap::value_parser!(u16).range(1..))]
    runs: u16,
    /// How far up the modes of the kit's cymbals are coupled
    #[arg(long, default_value = "standard")]
    quality: Quality,
    /// Sample rate, Hz
    #[arg(long, value_name = "HZ", default_value_t = bench::RATE as u32, value_parser = clap::value_parser!(u32).range(RATES))]
    rate: u32,
    /// Use no wider instruction set
    #[arg(long)]
    simd: Option<Simd>,
    /// Set the costs beside those of an older report, written with --json
    #[arg(long, value_name = "OLD.json")]
    compare: Option<PathBuf>,
    /// Count instructions, too (needs valgrind)
    #[arg(long)]
    callgrind: bool,
}

impl BenchArguments {
    /// What is asked for.
    pub fn into_request(self) -> bench::Request {
        bench::Request {
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

/// A number from `least` (left out if `open`) to `most`.
fn number(text: &str, least: f64, open: bool, most: f64, unit: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value <= most && (value > least || (value == least && !open)) => Ok(value),
        _ if open => Err(format!("accepted: above {least} to {most}{unit}")),
        _ => Err(format!("accepted: {least} to {most}{unit}")),
    }
}

fn tail(text: &str) -> Result<f64, String> {
    number(text, 0.0, false, LONGEST, " s")
}

fn seconds(text: &str) -> Result<f64, String> {
    number(text, 0.0, true, LONGEST, " s")
}

fn speed(text: &str) -> Result<f64, String> {
    number(text, 0.0, true, Strike::MAX_SPEED, " m/s")
}

fn share(text: &str) -> Result<f64, String> {
    number(text, 0.0, false, 1.0, " of the radius")
}

fn ratio(text: &str) -> Result<f64, String> {
    number(text, 0.5, false, 2.5, " of the struck head's pitch")
}

fn unevenness(text: &str) -> Result<f64, String> {
    number(text, 0.0, false, 0.05, "")
}

/// `pillow`, `gel`, `ring` or `gel@R,DEG`.
fn muffler(text: &str) -> Result<Muffler, String> {
    const ACCEPTED: &str = "accepted: pillow, gel, ring, gel@R,DEG as in gel@.7,90";
    match (text, Muffler::GEL) {
        ("pillow", _) => Ok(PILLOW),
        ("gel", gel) => Ok(gel),
        ("ring", _) => Ok(Muffler::RING),
        (place, Muffler::Gel { sigma, .. }) => {
            let place = place.strip_prefix("gel@").and_then(|place| place.split_once(','));
            let (radius, degrees) = place.ok_or(ACCEPTED)?;
            let radius = number(radius, 0.0, false, 0.99, " of the radius")?;
            Ok(Muffler::Gel { sigma, radius, angle: angle(degrees)?.to_radians() })
        }
        _ => Err(ACCEPTED.to_owned()),
    }
}

fn angle(text: &str) -> Result<f64, String> {
    number(text, -360.0, false, 360.0, " degrees")
}
