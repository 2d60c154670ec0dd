//! How a plate's energy is shared among octaves, live: struck hard, it wanders upward before it fades.
//!
//! One line for each octave, low ones cold and high ones warm, on a scale of decades. The engine tells the energy of all
//! modes, not only of those whose shapes are drawn; what the plate's stretch holds belongs to no octave.

use std::collections::VecDeque;

use egui::{Align2, Color32, Rect, Ui, pos2};
use overhear_engine::snapshot::{FIRST_OCTAVE, OCTAVES};

use super::past::{MEMORY, Moment};
use crate::editor::plot::Plot;
use crate::editor::theme::{self, Palette};

/// Ends of the scale, J.
const RANGE: (f32, f32) = (1e-9, 0.3);

/// Room for the octaves' names, points.
const NAMES: f32 = 34.0;

/// Draws the energies of a piece's octaves over time.
pub(super) fn show(ui: &Ui, rect: Rect, moments: &VecDeque<Moment>, (slot, now): (usize, f64)) {
    let palette = theme::of(ui);
    let latest = moments.back().map_or([0.0; OCTAVES], |moment| moment.octaves[slot]);
    let mut plot = Plot::new(ui, rect, "Energy by octave", &remark(&latest));
    let names = plot.area.max.x;
    plot.area.max.x -= NAMES;
    for octave in 0..OCTAVES {
        let points = moments.iter().map(|moment| {
            let x = 1.0 - ((now - moment.time) / MEMORY) as f32;
            plot.at(x, height(moment.octaves[slot][octave]))
        });
        let colour = colour(octave, palette);
        plot.line(points.collect(), colour);
        let y = plot.area.max.y - (octave as f32 + 0.5) / OCTAVES as f32 * plot.area.height();
        let at = pos2(names, y);
        plot.painter().text(at, Align2::RIGHT_CENTER, name(octave), theme::small(), colour);
    }
    plot.ends(&format!("{MEMORY:.0} s ago"), "now");
}

/// Which octave holds most.
fn remark(octaves: &[f32; OCTAVES]) -> String {
    let most = octaves.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    match most {
        Some((octave, &energy)) if energy > RANGE.0 => {
            format!("strongest from {} to {} Hz", name(octave), name(octave + 1))
        }
        _ => "at rest".to_owned(),
    }
}

/// Where an octave begins, Hz.
fn name(octave: usize) -> String {
    let hertz = FIRST_OCTAVE * 2.0_f64.powi(octave as i32);
    if hertz < 1e3 { format!("{hertz:.0}") } else { format!("{:.0}k", hertz / 1_024.0) }
}

/// Colour of an octave.
fn colour(octave: usize, palette: &Palette) -> Color32 {
    palette.down.lerp_to_gamma(palette.up, octave as f32 / (OCTAVES - 1) as f32)
}

/// Place of an energy (J) on the scale, 0 to 1.
fn height(energy: f32) -> f32 {
    let (least, most) = RANGE;
    if energy > least { ((energy / least).ln() / (most / least).ln()).min(1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn octaves_are_named_by_where_they_begin() {
        assert_eq!([0, 4, 5, 9].map(name), ["32", "512", "1k", "16k"]);
        let mut octaves = [0.0; OCTAVES];
        assert_eq!(remark(&octaves), "at rest");
        octaves[5] = 1e-3;
        assert_eq!(remark(&octaves), "strongest from 1k to 2k Hz");
        assert_eq!([height(f32::NAN), height(0.0), height(1e9)], [0.0, 0.0, 1.0]);
    }
}
