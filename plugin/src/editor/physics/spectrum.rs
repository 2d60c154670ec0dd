//! The spectrum of what is heard, and how it came about.
//!
//! A Hann window over the latest 4096 samples, as a curve over pitch; beside it the same over the last seconds, newest
//! at the right. All of it is computed here, away from the audio thread.

use std::sync::Arc;

use egui::{Color32, ColorImage, Rect, TextureHandle, TextureOptions, Ui, pos2};
use realfft::num_complex::Complex;
use realfft::{RealFftPlanner, RealToComplex};

use crate::editor::plot::Plot;
use crate::editor::theme::{self, Palette};
use crate::sound::{KEPT, Sound};

/// Samples of a window.
const WINDOW: usize = 4096;

/// Pitches drawn, and moments of the past.
const BANDS: usize = 96;
const COLUMNS: usize = 180;

/// Moments drawn for each second.
const COLUMN_RATE: f32 = 60.0;

/// Frequencies drawn, Hz.
const RANGE: (f32, f32) = (30.0, 20_000.0);

/// Levels drawn, dB of full scale.
const LEVELS: (f32, f32) = (-96.0, -6.0);

/// How fast a level falls on the screen, dB a column.
const FALL: f32 = 2.0;

/// Spectrum and spectrogram of one window.
pub struct Spectrum {
    transform: Arc<dyn RealToComplex<f32>>,
    window: Vec<f32>,
    samples: Vec<f32>,
    bins: Vec<Complex<f32>>,
    scratch: Vec<Complex<f32>>,
    /// Levels, 0 to 1, lowest pitch first.
    levels: [f32; BANDS],
    /// Earlier ones, oldest first.
    past: Vec<[f32; BANDS]>,
    texture: Option<TextureHandle>,
    /// Samples that had been written when the latest column was drawn.
    written: usize,
}

impl Spectrum {
    pub fn new() -> Spectrum {
        let transform = RealFftPlanner::new().plan_fft_forward(WINDOW);
        let hann = |place: usize| 0.5 - 0.5 * (std::f32::consts::TAU * place as f32 / WINDOW as f32).cos();
        Spectrum {
            window: (0..WINDOW).map(hann).collect(),
            samples: transform.make_input_vec(),
            bins: transform.make_output_vec(),
            scratch: transform.make_scratch_vec(),
            transform,
            levels: [0.0; BANDS],
            past: vec![[0.0; BANDS]; COLUMNS],
            texture: None,
            written: 0,
        }
    }

    /// Draws what is heard now and what was.
    pub fn show(&mut self, ui: &Ui, rect: Rect, sound: &Sound) {
        let palette = theme::of(ui);
        let loudest = self.follow(sound);
        let remark = loudest.map_or(String::new(), |hertz| format!("strongest at {hertz:.0} Hz"));
        let plot = Plot::new(ui, rect, "Spectrum, and its last seconds", &remark);
        let (now, past) = super::page::halves(plot.area, 0.5, true);
        let inside = |x: f32, y: f32| pos2(now.min.x + x * now.width(), now.max.y - y * now.height());
        let points: Vec<_> = self
            .levels
            .iter()
            .enumerate()
            .map(|(band, &level)| inside(band as f32 / (BANDS - 1) as f32, level))
            .collect();
        for hertz in [100.0, 1_000.0, 10_000.0] {
            let share = place(hertz) * now.width() / plot.area.width();
            plot.tick(
                share,
                if hertz < 1e3 {
                    "100"
                } else if hertz < 1e4 {
                    "1 kHz"
                } else {
                    "10 kHz"
                },
            );
        }
        plot.curve(&points, palette.accent);
        let image = self.image(palette);
        let texture = self.texture.get_or_insert_with(|| {
            ui.ctx().load_texture("spectrogram", image.clone(), TextureOptions::LINEAR)
        });
        texture.set(image, TextureOptions::LINEAR);
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        plot.painter().image(texture.id(), past, whole, Color32::WHITE);
    }

    /// Takes in the latest sound; gives the strongest frequency, Hz, if anything is heard.
    fn follow(&mut self, sound: &Sound) -> Option<f32> {
        let written = sound.written();
        let before = std::mem::replace(&mut self.written, written);
        if before == written {
            // Nobody renders: nothing is new, and what was falls.
            self.levels.iter_mut().for_each(|level| *level = (*level - 0.02).max(0.0));
            return None;
        }
        // As many columns as time has passed for, each with the sound of its time: where frames are far apart, as where the
        // processor draws, the past is no coarser for it.
        let hop = (sound.rate() / COLUMN_RATE).max(1.0);
        let passed = written.wrapping_sub(before) as f32 / hop;
        let columns = (passed.round() as usize).clamp(1, COLUMNS);
        // What is no longer kept cannot be told apart.
        let told = columns.min(((KEPT - WINDOW) as f32 / hop) as usize + 1);
        let mut strongest = None;
        for column in 0..told {
            let back = ((told - 1 - column) as f32 * hop) as usize;
            strongest = self.look(sound, written.wrapping_sub(back))?;
            let same = if column == 0 { columns - told + 1 } else { 1 };
            self.past.extend(std::iter::repeat_n(self.levels, same));
        }
        self.past.drain(..self.past.len() - COLUMNS);
        strongest
    }

    /// Takes in the sound up to where so many samples had been written; gives the strongest frequency, Hz, if there is one,
    /// or nothing at all if the transform fails.
    fn look(&mut self, sound: &Sound, written: usize) -> Option<Option<f32>> {
        sound.until(written, &mut self.samples);
        self.samples.iter_mut().zip(&self.window).for_each(|(sample, weight)| *sample *= weight);
        self.transform.process_with_scratch(&mut self.samples, &mut self.bins, &mut self.scratch).ok()?;
        // A sine of full scale has the height 1 under this window.
        let scale = 4.0 / WINDOW as f32;
        let per_bin = sound.rate() / WINDOW as f32;
        let range = LEVELS.1 - LEVELS.0;
        let mut strongest = (LEVELS.0, None);
        for (band, level) in self.levels.iter_mut().enumerate() {
            let [from, to] = [band as f32 - 0.5, band as f32 + 0.5].map(|band| frequency(band) / per_bin);
            let last = self.bins.len() - 1;
            let (first, beyond) = ((from.round() as usize).min(last), (to.round() as usize).min(last));
            let bins = first..=beyond.max(first);
            let most = bins.map(|bin| self.bins[bin].norm()).fold(0.0, f32::max);
            let decibels = 20.0 * (scale * most).max(1e-9).log10();
            if decibels > strongest.0 {
                strongest = (decibels, Some(frequency(band as f32)));
            }
            *level = ((decibels - LEVELS.0) / range).clamp(0.0, 1.0).max(*level - FALL / range);
        }
        Some(strongest.1)
    }

    fn image(&self, palette: &Palette) -> ColorImage {
        let mut image = ColorImage::filled([COLUMNS, BANDS], palette.panel);
        for (column, levels) in self.past.iter().enumerate() {
            for (band, &level) in levels.iter().enumerate() {
                image[(column, BANDS - 1 - band)] = heat(level, palette);
            }
        }
        image
    }
}

/// Frequency of a band, Hz; bands may be counted in parts.
fn frequency(band: f32) -> f32 {
    RANGE.0 * (RANGE.1 / RANGE.0).powf(band / (BANDS - 1) as f32)
}

/// Place of a frequency (Hz) on the axis, 0 to 1.
fn place(hertz: f32) -> f32 {
    (hertz / RANGE.0).ln() / (RANGE.1 / RANGE.0).ln()
}

/// Colour of a level, 0 to 1.
fn heat(level: f32, palette: &Palette) -> Color32 {
    let share = level.clamp(0.0, 1.0);
    if share < 0.6 {
        palette.background.lerp_to_gamma(palette.down, share / 0.6)
    } else {
        palette.down.lerp_to_gamma(palette.up, (share - 0.6) / 0.4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_strongest_band_is_that_of_the_sine_that_is_heard() {
        let sound = Sound::default();
        let mut spectrum = Spectrum::new();
        assert_eq!(spectrum.follow(&sound), None);
        for hertz in [110.0_f32, 1_000.0, 8_000.0] {
            let sine: Vec<f32> = (0..8192)
                .map(|n| 0.3 * (std::f32::consts::TAU * hertz * n as f32 / 48_000.0).sin())
                .collect();
            sound.write(&sine, &sine);
            let found = spectrum.follow(&sound).expect("a tone");
            assert!((found / hertz).log2().abs() < 0.1, "{found} for {hertz}");
            // Nothing new: no tone.
            assert_eq!(spectrum.follow(&sound), None);
        }
    }

    #[test]
    fn frames_far_apart_tell_the_past_as_finely_as_near_ones() {
        let tone = |hertz: f32| -> Vec<f32> {
            (0..4096).map(|n| 0.3 * (std::f32::consts::TAU * hertz * n as f32 / 48_000.0).sin()).collect()
        };
        let (sound, mut spectrum) = (Sound::default(), Spectrum::new());
        for hertz in [200.0, 2_000.0] {
            sound.write(&tone(hertz), &tone(hertz));
        }
        spectrum.follow(&sound);
        // A sixth of a second in one frame: the columns in it differ, and the newest is the newest.
        assert_eq!(spectrum.past.len(), COLUMNS);
        let loudest = |column: usize| {
            let levels = spectrum.past[column];
            (0..BANDS).max_by(|&a, &b| levels[a].total_cmp(&levels[b])).map(|band| frequency(band as f32))
        };
        let (early, late) = (loudest(COLUMNS - 6).unwrap(), loudest(COLUMNS - 1).unwrap());
        assert!((early / 200.0).log2().abs() < 0.1 && (late / 2_000.0).log2().abs() < 0.1, "{early} {late}");
    }

    #[test]
    fn bands_and_places_agree() {
        for band in [0.0, 20.5, 95.0] {
            assert!((place(frequency(band)) * (BANDS - 1) as f32 - band).abs() < 1e-3);
        }
    }
}
