//! How far a plate bends, against its thickness.
//!
//! A plate that bends by a small part of its thickness is linear; from about half of it on its modes exchange energy,
//! which is what makes a crash swell. Taken from the largest displacement of the modes whose shapes are drawn, but for those
//! in which a plate swings on its stand and stays as it is.

use std::collections::VecDeque;

use egui::{Color32, Rect, Stroke, Ui};
use overhear_engine::kit_spec::{InstrumentSpec, PieceSpec};
use overhear_engine::snapshot::{FieldShapes, PieceSnapshot};

use super::past::{Moment, over_time};
use crate::editor::field;
use crate::editor::plot::Plot;
use crate::editor::theme;
use crate::monitor::STILL;

/// Nodal diameters and circles of the motions that bend nothing: up and down, and tilting.
const RIGID: [[u32; 2]; 2] = [[0, 0], [1, 0]];

/// Thickness of what is struck of a piece that is a plate, m.
pub fn thickness(piece: &PieceSpec) -> Option<f32> {
    let plate = match &piece.instrument {
        InstrumentSpec::Drum(_) => return None,
        InstrumentSpec::Cymbal(cymbal) => cymbal.plate(),
        InstrumentSpec::HiHat(hat) => hat.top.plate(),
    };
    Some(plate.thickness() as f32)
}

/// Largest displacement by which a plate is bent now, in units of its thickness; nothing of what is none.
pub fn of(piece: &PieceSpec, state: &PieceSnapshot, shapes: Option<&FieldShapes>) -> f32 {
    let moves = state.energy > STILL;
    let Some((thickness, shapes)) = thickness(piece).zip(shapes).filter(|_| moves) else { return 0.0 };
    let mut modes = state.displacement;
    for (q, order) in modes.iter_mut().zip(&shapes.orders) {
        if RIGID.contains(order) {
            *q = 0.0;
        }
    }
    let field = field::displacement(shapes, &modes);
    field.into_iter().fold(0.0, |most: f32, z| most.max(z.abs())) / thickness
}

/// Draws the bending over time.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    moments: &VecDeque<Moment>,
    (slot, now): (usize, f64),
    accent: Color32,
) {
    let most = moments.iter().map(|moment| moment.bending[slot]).fold(0.0, f32::max);
    let plot = Plot::new(ui, rect, "Bending", &format!("up to {most:.2} thicknesses"));
    let top = most.max(1.2);
    let thickness = plot.at(0.0, 1.0 / (1.08 * top)).y;
    let palette = theme::of(ui);
    plot.painter().hline(plot.area.x_range(), thickness, Stroke::new(1.0, palette.raised));
    let heights = moments.iter().map(|moment| moment.bending[slot] / (1.08 * top));
    over_time(&plot, moments, now, heights, accent);
    plot.remark_at(thickness, "its thickness");
}

#[cfg(test)]
mod tests {
    use super::*;
    use overhear_engine::kit_spec::KitSpec;
    use overhear_engine::snapshot::FIELD_MODES;

    #[test]
    fn bending_counts_in_thicknesses_and_only_of_plates() {
        let mut shapes = FieldShapes { shapes: vec![[0.0; FIELD_MODES]; 2], ..FieldShapes::default() };
        shapes.shapes[1][2] = 2.0;
        let mut state = PieceSnapshot { energy: 1e-3, ..PieceSnapshot::default() };
        let kit = KitSpec::standard();
        let [(_, crash), (_, snare)] = ["crash", "snare"].map(|name| kit.find(name).unwrap());
        let thickness = thickness(crash).unwrap();
        state.displacement[2] = 0.25 * thickness;
        let bending = of(crash, &state, Some(&shapes));
        assert!((bending - 0.5).abs() < 1e-6, "{bending}");
        // Swinging on its stand it stays flat.
        shapes.orders = vec![[0, 0], [2, 0], [1, 0]];
        assert_eq!(of(crash, &state, Some(&shapes)), 0.0);
        shapes.orders = vec![[0, 0], [1, 0], [2, 0]];
        assert_eq!(of(crash, &state, Some(&shapes)), bending);
        assert_eq!(of(snare, &state, Some(&shapes)), 0.0);
        assert_eq!(of(crash, &state, None), 0.0);
        state.energy = 0.0;
        assert_eq!(of(crash, &state, Some(&shapes)), 0.0);
    }
}
