//! `demo --all-presets`: half a minute of the groove with every preset.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use overhear::presets::Library;

use super::{RATE, clap_bundle, play, style};
use overhear_cli::output::Folder;
use overhear_cli::player::Source;
use overhear_cli::render::{decibels, takes};
use overhear_cli::settings;
use overhear_cli::song::Song;
use overhear_cli::wav::{Bits, WavFile};

use crate::workspace;

/// Length of a demonstration, s.
const SECONDS: f64 = 30.0;

/// When the last note may come, s: nine bars, and the last crash rings out.
const LAST_NOTE: f64 = 22.5;

/// Plays every preset there is, the user's own included, through the built CLAP; writes `NAME.wav` into `folder`.
///
/// # Errors
/// If the plugin does not build, a preset is broken, or one does not sound as it must.
pub fn run(folder: &Path) -> Result<()> {
    let clap = clap_bundle()?;
    let song = Song::read(&workspace::root().join("assets/groove.mid"))?;
    let library = Library::default();
    let _folder = Folder::new(folder)?;
    let mut clipped = Vec::new();
    for entry in library.list() {
        let preset = library.load(&entry.name).with_context(|| format!("the preset `{}`", entry.name))?;
        let mut style = style(Source::Clap(clap.clone()));
        style.kit = settings::kit_of(&preset);
        style.settings = settings::moved(&preset, &style.kit.kit);
        let mut take = takes(&song, &style)?.take;
        let samples = |seconds: f64| (seconds * f64::from(RATE)) as u64;
        take.messages.retain(|message| message.sample <= samples(LAST_NOTE));
        take.frames = samples(SECONDS);
        let (played, left, right) = play(&take, &style, &entry.name)?;
        ensure!(played.finite, "with `{}` the plugin produced values that are not numbers", entry.name);
        ensure!(played.peak > 0.0, "with `{}` the plugin stayed silent", entry.name);
        let path = folder.join(format!("{}.wav", entry.name));
        let mut file = WavFile::create(&path, Bits::Float32, RATE, 2, take.frames)?;
        file.write(&[&left, &right])?;
        file.finish()?;
        let share = 100.0 * played.busy.as_secs_f64() / SECONDS;
        let peak = decibels(played.peak);
        println!("{}: {peak}, {share:.1} % of real time; {}", path.display(), preset.about);
        if played.peak > 1.0 {
            clipped.push(entry.name);
        }
    }
    ensure!(clipped.is_empty(), "clipped: {}", clipped.join(", "));
    Ok(())
}
