//! Pictures of sounds as PNGs: waveform above spectrogram, and spectrograms side by side.

mod spectrogram;

use anyhow::{Context, Result, anyhow};
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};

use spectrogram::Spectrogram;

/// Size of the picture, pixels.
const SIZE: (u32, u32) = (1600, 900);

/// Size of a picture of spectrograms side by side, pixels.
const SIDE_BY_SIDE: (u32, u32) = (1080, 320);

/// Height of the waveforms, pixels.
const WAVES: u32 = 300;

/// Lowest and highest frequency shown, Hz.
const FREQUENCIES: std::ops::Range<f64> = 30.0..20_000.0;

const PAPER: RGBColor = RGBColor(16, 18, 24);
const INK: RGBColor = RGBColor(200, 205, 215);
const GRID: RGBColor = RGBColor(60, 64, 74);
const WAVE: RGBColor = RGBColor(240, 170, 80);

/// Draws a sound, full scale 1, at a sample rate (Hz), under a title, and returns the PNG's bytes.
///
/// # Errors
/// If drawing or encoding fails.
pub fn png(title: &str, left: &[f32], right: &[f32], rate: u32) -> Result<Vec<u8>> {
    drawn(SIZE, |area| draw(area, title, [left, right], f64::from(rate)))
}

/// Draws spectrograms side by side, each a sound (full scale 1) under its name, at a sample rate (Hz), and returns the PNG's
/// bytes.
///
/// # Errors
/// If drawing or encoding fails.
pub fn spectrograms(panels: &[(String, &[f32])], rate: f64) -> Result<Vec<u8>> {
    drawn(SIDE_BY_SIDE, |area| {
        area.fill(&PAPER)?;
        for (area, (name, sound)) in area.split_evenly((1, panels.len())).iter().zip(panels) {
            let area = area.titled(name, ("sans-serif", 18).into_font().color(&INK))?;
            draw_spectrogram(&area, sound, rate, 5)?;
        }
        area.present()?;
        Ok(())
    })
}

/// The PNG of what `draw` draws on an area of that size, pixels.
///
/// # Errors
/// If drawing or encoding fails.
pub(crate) fn drawn(
    size: (u32, u32),
    draw: impl FnOnce(&Area) -> Result<(), Box<dyn std::error::Error>>,
) -> Result<Vec<u8>> {
    register_font("sans-serif", FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT)
        .map_err(|_| anyhow!("the font cannot be used"))?;
    let mut pixels = vec![0; (size.0 * size.1 * 3) as usize];
    {
        let area = BitMapBackend::with_buffer(&mut pixels, size).into_drawing_area();
        draw(&area).map_err(|error| anyhow!("cannot draw: {error}"))?;
    }
    encode(&pixels, size).context("cannot encode the picture")
}

/// A PNG of pixels, row by row: red, green, blue.
///
/// # Errors
/// If there are too many or too few.
pub fn encode(pixels: &[u8], (width, height): (u32, u32)) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(bytes)
}

pub(crate) type Area<'a> = DrawingArea<BitMapBackend<'a>, plotters::coord::Shift>;

fn draw(
    area: &Area,
    title: &str,
    channels: [&[f32]; 2],
    rate: f64,
) -> Result<(), Box<dyn std::error::Error>> {
    area.fill(&PAPER)?;
    let area = area.titled(title, ("sans-serif", 26).into_font().color(&INK))?;
    let (waves, below) = area.split_vertically(WAVES);
    let seconds = channels[0].len() as f64 / rate;
    for (half, (name, channel)) in
        waves.split_evenly((2, 1)).iter().zip([("left", channels[0]), ("right", channels[1])])
    {
        draw_wave(half, name, channel, seconds)?;
    }
    let mono: Vec<f32> = std::iter::zip(channels[0], channels[1]).map(|(l, r)| l + r).collect();
    draw_spectrogram(&below, &mono, rate, 14)?;
    area.present()?;
    Ok(())
}

/// The least and the greatest sample behind every column.
fn draw_wave(
    area: &Area,
    name: &str,
    samples: &[f32],
    seconds: f64,
) -> Result<(), Box<dyn std::error::Error>> {
    let mut chart = ChartBuilder::on(area)
        .margin(6)
        .x_label_area_size(0)
        .y_label_area_size(70)
        .build_cartesian_2d(0.0..seconds.max(1e-3), -1.0..1.0)?;
    chart
        .configure_mesh()
        .y_desc(name)
        .y_labels(3)
        .axis_style(GRID)
        .light_line_style(PAPER)
        .bold_line_style(GRID)
        .label_style(("sans-serif", 16).into_font().color(&INK))
        .draw()?;
    let columns = chart.plotting_area().dim_in_pixel().0 as usize;
    let per_column = samples.len().div_ceil(columns.max(1)).max(1);
    chart.draw_series(samples.chunks(per_column).enumerate().map(|(column, chunk)| {
        let time = (column * per_column) as f64 / samples.len().max(1) as f64 * seconds;
        let least = chunk.iter().fold(f32::INFINITY, |least, &sample| least.min(sample));
        let most = chunk.iter().fold(f32::NEG_INFINITY, |most, &sample| most.max(sample));
        let ends = [(time, f64::from(least)), (time, f64::from(most))];
        PathElement::new(ends.to_vec(), WAVE)
    }))?;
    Ok(())
}

/// Levels over time, with so many marks of time, and frequency.
fn draw_spectrogram(
    area: &Area,
    sound: &[f32],
    rate: f64,
    marks: usize,
) -> Result<(), Box<dyn std::error::Error>> {
    let seconds = sound.len() as f64 / rate;
    let mut chart = ChartBuilder::on(area)
        .margin(6)
        .x_label_area_size(44)
        .y_label_area_size(70)
        .build_cartesian_2d(0.0..seconds.max(1e-3), FREQUENCIES.log_scale())?;
    chart
        .configure_mesh()
        .disable_mesh()
        .x_desc("s")
        .y_desc("Hz")
        .x_labels(marks)
        .x_label_formatter(&|time| if seconds < 3.0 { format!("{time:.1}") } else { format!("{time:.0}") })
        .y_label_formatter(&|hertz| format!("{hertz:.0}"))
        .axis_style(GRID)
        .label_style(("sans-serif", 16).into_font().color(&INK))
        .draw()?;
    let plot = chart.plotting_area().strip_coord_spec();
    let (columns, rows) = plot.dim_in_pixel();
    let spectrogram = Spectrogram::new(sound, rate, columns as usize);
    let ratio = FREQUENCIES.end / FREQUENCIES.start;
    for row in 0..rows {
        let height = f64::from(rows - 1 - row) / f64::from(rows.max(1));
        let frequency = FREQUENCIES.start * ratio.powf(height);
        for column in 0..columns {
            let (r, g, b) = heat(spectrogram.level(column as usize, frequency));
            plot.draw_pixel((column as i32, row as i32), &RGBColor(r, g, b))?;
        }
    }
    Ok(())
}

/// Colour of a level from 0 to 1: from the paper through violet and orange to white.
fn heat(level: f64) -> (u8, u8, u8) {
    const STOPS: [(f64, [f64; 3]); 5] = [
        (0.0, [16.0, 18.0, 24.0]),
        (0.35, [74.0, 30.0, 110.0]),
        (0.6, [190.0, 55.0, 85.0]),
        (0.82, [245.0, 150.0, 50.0]),
        (1.0, [255.0, 245.0, 215.0]),
    ];
    let level = level.clamp(0.0, 1.0);
    let above = STOPS.iter().position(|stop| stop.0 >= level).unwrap_or(STOPS.len() - 1).max(1);
    let ((from, low), (to, high)) = (STOPS[above - 1], STOPS[above]);
    let share = (level - from) / (to - from);
    let mix = |index: usize| (low[index] + share * (high[index] - low[index])).round() as u8;
    (mix(0), mix(1), mix(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sound_becomes_a_png_and_silence_does_too() {
        let sine: Vec<f32> = (0..24_000).map(|n| (n as f32 * 0.05).sin() * 0.5).collect();
        for sound in [&sine[..], &[0.0; 4800]] {
            let bytes = png("a title", sound, sound, 48_000).unwrap();
            assert!(bytes.starts_with(b"\x89PNG"));
            let bytes = spectrograms(&[("one".to_owned(), sound), ("two".to_owned(), sound)], 48e3).unwrap();
            assert!(bytes.starts_with(b"\x89PNG"));
        }
    }

    #[test]
    fn heat_runs_from_paper_to_nearly_white() {
        assert_eq!(heat(-1.0), (PAPER.0, PAPER.1, PAPER.2));
        assert_eq!(heat(2.0), (255, 245, 215));
    }
}
