//! `demo --all-kits`: the groove on every whole kit of the library.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use overhear::library;
use overhear_measure::{analysis, picture};

use super::{RATE, clap_bundle, play, style};
use overhear_cli::output::{self, Folder};
use overhear_cli::player::Source;
use overhear_cli::render::{decibels, takes};
use overhear_cli::song::Song;
use overhear_cli::wav::{Bits, WavFile};

use crate::workspace;

/// Length of what is written, s: nine bars, and the last crash rings on.
const SECONDS: f64 = 26.0;

/// Fade at its end, s.
const FADE: f64 = 1.5;

/// What the figures begin with.
const TABLE: &str = "# `cargo xtask demo --all-kits` writes this: of the whole groove, bounced.\n";

/// Farthest that two kits may be apart in loudness, LU.
const APART: f64 = 2.0;

/// Plays the groove on every whole kit of the library by the built plugin, bounced; prints the loudness and the peak of the whole, and writes the
/// beginning as `NAME.wav` and its spectrogram as `NAME.png` into `folder`, the figures as `loudness.toml`.
///
/// # Errors
/// If a kit does not sound as it must, is clipped, or is more than 2 LU from another in loudness.
pub fn run(folder: &Path) -> Result<()> {
    let song = Song::read(&workspace::root().join("assets/groove.mid"))?;
    let _folder = Folder::new(folder)?;
    let clap = clap_bundle()?;
    let (mut clipped, mut loudnesses, mut table) = (Vec::new(), Vec::new(), String::from(TABLE));
    for kit in library::kits() {
        let mut style = style(Source::Clap(clap.clone()));
        style.kit = kit.document().with_context(|| format!("the kit `{}`", kit.name))?;
        let take = takes(&song, &style)?.take;
        let (played, mut left, mut right) = play(&take, &style, kit.name)?;
        ensure!(played.finite, "`{}` gave values that are not numbers", kit.name);
        let loudness = analysis::loudness_lufs([&left, &right], RATE);
        let loudness = loudness.with_context(|| format!("`{}` is silent", kit.name))?;
        println!("{}: {loudness:.1} LUFS, {}", kit.name, decibels(played.peak));
        let peak = 20.0 * played.peak.log10();
        table.push_str(&format!("{} = {{ lufs = {loudness:.1}, peak_dbfs = {peak:.1} }}\n", kit.name));
        loudnesses.push(loudness);
        if played.peak > 1.0 {
            clipped.push(kit.name);
        }
        [&mut left, &mut right].into_iter().for_each(faded);
        let mut file = WavFile::create(
            &folder.join(format!("{}.wav", kit.name)),
            Bits::Float32,
            RATE,
            2,
            left.len() as u64,
        )?;
        file.write(&[&left, &right])?;
        file.finish()?;
        let mono: Vec<f32> = left.iter().zip(&right).map(|(left, right)| 0.5 * (left + right)).collect();
        let drawn = picture::spectrograms(&[(kit.name.to_owned(), &mono)], f64::from(RATE))?;
        output::write(&folder.join(format!("{}.png", kit.name)), &drawn)?;
    }
    output::write(&folder.join("loudness.toml"), table.as_bytes())?;
    ensure!(clipped.is_empty(), "clipped: {}", clipped.join(", "));
    let apart = loudnesses.iter().fold(f64::NEG_INFINITY, |most, &it| most.max(it))
        - loudnesses.iter().fold(f64::INFINITY, |least, &it| least.min(it));
    ensure!(apart <= APART, "the kits are {apart:.1} LU apart, at most {APART} are accepted");
    println!("{apart:.1} LU apart");
    Ok(())
}

/// Cuts a sound to [`SECONDS`] and lets it fade at the end.
fn faded(sound: &mut Vec<f32>) {
    let samples = |seconds: f64| (seconds * f64::from(RATE)) as usize;
    sound.truncate(samples(SECONDS));
    for (left, sample) in sound.iter_mut().rev().take(samples(FADE)).enumerate() {
        *sample *= left as f32 / samples(FADE) as f32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sound_is_cut_and_ends_in_silence() {
        let mut sound = vec![1.0; 60 * RATE as usize];
        faded(&mut sound);
        assert_eq!(sound.len(), (SECONDS * f64::from(RATE)) as usize);
        assert!(sound.last() == Some(&0.0) && sound[sound.len() - 2 * RATE as usize] == 1.0);
    }
}
