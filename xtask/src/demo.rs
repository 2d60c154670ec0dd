//! `demo`: from a fresh clone to an audible groove.
//!
//! Sets up, builds, bundles, loads the built CLAP into the embedded host, plays
//! `assets/groove.mid` or another song through it at 48 kHz, writes `demo.wav` and `demo.png`, prints the level of each
//! piece at each microphone and the cost, and takes pictures of the editor if the requirements are met.

pub mod kits;
mod levels;
pub mod presets;

use std::path::{Path, PathBuf};

use anyhow::{Result, ensure};
use cpu_time::ThreadTime;
use overhear::kit_document::KitDocument;

use crate::system::{self, WINDOW_LIBRARIES, XVFB};
use crate::workspace::Format;
use levels::Row;
use overhear_cli::output;
use overhear_cli::player::{Blocks, Played, Source, Take};
use overhear_cli::plugin_folders::user_folder;
use overhear_cli::progress::Progress;
use overhear_cli::render::{Style, Taken, decibels, takes};
use overhear_cli::settings;
use overhear_cli::song::Song;
use overhear_cli::wav::{Bits, WavFile};
use overhear_measure::picture;

use crate::{bundle, shots, workspace};

/// What is played if no song is given, from the root of the workspace.
const GROOVE: &str = "assets/groove.mid";

/// Sample rate of the demonstration, Hz.
const RATE: u32 = 48_000;

/// Sound after the last note, s: the last crash rings out.
const TAIL: f64 = 8.0;

/// Buffers as hosts use them, samples.
const BLOCK: u32 = 256;

/// Runs the whole demonstration with a song, or else with the groove; the files go to `folder`.
///
/// # Errors
/// If something is missing, does not build, or does not sound as it must.
pub fn run(folder: &Path, song: Option<&Path>) -> Result<()> {
    let step = |number: u32, what: &str| eprintln!("[{number}/5] {what}");
    let (wav, png) = (folder.join("demo.wav"), folder.join("demo.png"));
    let (path, name) = match song {
        Some(path) => (path.to_path_buf(), path.display().to_string()),
        None => (workspace::root().join(GROOVE), GROOVE.to_owned()),
    };
    // What cannot be read is told before minutes of building.
    let read = Song::read(&path)?;
    step(1, "building and bundling the plugin (some minutes the first time)");
    let clap = clap_bundle()?;
    step(2, &format!("playing {name} through the CLAP plugin"));
    let style = style(Source::Clap(clap.clone()));
    let taken = takes(&read, &style)?;
    let take = &taken.take;
    let (played, left, right) = play(take, &style, "song")?;
    ensure!(played.finite, "the plugin produced values that are not numbers");
    ensure!(played.peak > 0.0, "the plugin stayed silent");
    step(3, "playing it as a host plays it live, and striking every piece by itself");
    let live = live_share(take, clap.clone())?;
    let levels = levels::table(RATE)?;
    step(4, "writing demo.wav and drawing demo.png");
    let mut file = WavFile::create(&wav, Bits::Float32, RATE, 2, take.frames)?;
    file.write(&[&left, &right])?;
    file.finish()?;
    output::write(&png, &picture::png(&format!("Overhear: {name}"), &left, &right, RATE)?)?;
    step(5, "taking pictures of the editor");
    let shots = folder.join("demo-shots");
    // A machine that only renders needs no display; the groove does not depend on it.
    let looked = system::ensure(&[XVFB, WINDOW_LIBRARIES])
        .and_then(|()| shots::run(&shots::Aim::Glance(shots.clone()), Some(clap.clone())));
    report(&taken, [live, busy_share(take, &played)], &played, &levels, [&wav, &png, &clap]);
    match looked {
        Ok(()) => println!("editor   {}", shots.display()),
        Err(reason) => println!("editor   no pictures: {reason:#}"),
    }
    // How loud a song of somebody's own is, is theirs to know.
    ensure!(song.is_some() || played.peak <= 1.0, "the mix is clipped: its peak is {:.3}", played.peak);
    let silent: Vec<_> =
        levels.iter().filter(|row| row.peaks.contains(&0.0)).map(|row| &*row.piece).collect();
    ensure!(silent.is_empty(), "silent: {}", silent.join(", "));
    Ok(())
}

/// Builds the plugins; the CLAP bundle.
fn clap_bundle() -> Result<PathBuf> {
    let bundles = bundle::run()?;
    let clap = bundles.into_iter().find(|(format, _)| *format == Format::Clap);
    clap.map(|(_, path)| path).ok_or_else(|| anyhow::anyhow!("the build made no CLAP bundle"))
}

fn style(source: Source) -> Style {
    Style {
        source,
        rate: RATE,
        kit: KitDocument::standard(),
        settings: Vec::new(),
        blocks: Blocks::Fixed(BLOCK),
        bits: Bits::Float32,
        tail: TAIL,
        channel: None,
    }
}

/// Plays a take to memory.
fn play(take: &Take, style: &Style, label: &str) -> Result<(Played, Vec<f32>, Vec<f32>)> {
    let (mut left, mut right) = (Vec::new(), Vec::new());
    let mut progress = Progress::new(label, take.frames);
    let played = style.source.perform(&style.setup(), |player| {
        take.play(player, style.blocks, |l, r| {
            progress.advance(l.len() as u64);
            left.extend_from_slice(l);
            right.extend_from_slice(r);
            Ok(())
        })
    })?;
    Ok((played, left, right))
}

/// Length of a take, s.
fn seconds(take: &Take) -> f64 {
    take.frames as f64 / f64::from(RATE)
}

/// Time spent on a take, a share of its length.
fn busy_share(take: &Take, played: &Played) -> f64 {
    played.busy.as_secs_f64() / seconds(take)
}

/// Share of one core for playing a take live: processor time of the playing thread over the take's length, with cymbals as they
/// are played.
fn live_share(take: &Take, clap: PathBuf) -> Result<f64> {
    let mut style = style(Source::Clap(clap));
    style.settings.extend(settings::parse(&["offline_quality=as played".to_owned()], &style.kit.kit)?);
    let mut progress = Progress::new("the song, live", take.frames);
    style.source.perform(&style.setup(), |player| {
        let start = ThreadTime::now();
        take.play(player, style.blocks, |left, _| {
            progress.advance(left.len() as u64);
            Ok(())
        })?;
        Ok(start.elapsed().as_secs_f64() / seconds(take))
    })
}

/// Prints what came of it; the shares of real time are of playing live and of the file.
fn report(
    taken: &Taken,
    [live, bounced]: [f64; 2],
    played: &Played,
    levels: &[Row],
    [wav, png, clap]: [&Path; 3],
) {
    println!("\npeak of a stroke at full velocity, dBFS, at the microphones: close, overheads, room");
    for Row { piece, peaks } in levels {
        println!("  {:<10}{}", piece, peaks.map(|peak| format!("{:8.1}", 20.0 * peak.log10())).concat());
    }
    println!("peak of the song: {}", decibels(played.peak));
    println!("\n{:.1} s of sound, {} notes", seconds(&taken.take), taken.counts.notes);
    println!(
        "Playing live takes {:.0} % of one core; this file was bounced at the highest quality, which took {:.0} % of real \
         time.",
        100.0 * live,
        100.0 * bounced
    );
    println!("sound    {}", wav.display());
    println!("picture  {}", png.display());
    println!("plugin   {}", clap.display());
    for format in Format::ALL {
        if let Ok(folder) = user_folder(format) {
            println!("`cargo xtask install` puts {} into {}", format.bundle_file(), folder.display());
        }
    }
}
