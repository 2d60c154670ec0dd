//! What was of late, for diagrams over time.

use std::collections::VecDeque;

use egui::Color32;
use overhear_engine::slot::SLOTS;
use overhear_engine::snapshot::OCTAVES;

use crate::editor::plot::Plot;

/// How far back energies and pitches are drawn, s.
pub const MEMORY: f64 = 3.0;

/// What was at a time.
pub struct Moment {
    /// s of the editor's time.
    pub time: f64,
    /// How far pitch is above its own, cents, by slot.
    pub cents: [f32; SLOTS],
    /// Largest displacement of a plate over its thickness, no unit, by slot.
    pub bending: [f32; SLOTS],
    /// Energy of the modes of each octave, J, by slot.
    pub octaves: [[f32; OCTAVES]; SLOTS],
}

/// Draws one height (share of the plot's) for each moment over the time that is remembered, up to `now`, s.
pub fn over_time(
    plot: &Plot,
    moments: &VecDeque<Moment>,
    now: f64,
    heights: impl Iterator<Item = f32>,
    colour: Color32,
) {
    let across = moments.iter().map(|moment| 1.0 - ((now - moment.time) / MEMORY) as f32);
    let points: Vec<_> = across.zip(heights).map(|(x, y)| plot.at(x, y)).collect();
    plot.curve(&points, colour);
    plot.ends(&format!("{MEMORY:.0} s ago"), "now");
}
