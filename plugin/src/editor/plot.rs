//! Frames, axes and curves of small diagrams.

use egui::{Align2, Color32, Painter, Pos2, Rect, Shape, Stroke, Ui, pos2, vec2};

use super::theme::{self, Palette};

/// Room above a diagram for its title, points.
const TITLE: f32 = 24.0;

/// Room below it for the ends of its axis, points.
const AXIS: f32 = 16.0;

/// A diagram: where its curves go.
pub struct Plot {
    pub area: Rect,
    painter: Painter,
    palette: &'static Palette,
}

impl Plot {
    /// Draws a panel with a title and a remark at its right; curves go into what is left.
    pub fn new(ui: &Ui, rect: Rect, title: &str, remark: &str) -> Plot {
        let palette = theme::of(ui);
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, theme::CORNER, palette.panel);
        let line = rect.min.y + 0.5 * TITLE + 1.0;
        let left = pos2(rect.min.x + 12.0, line);
        let named = painter.text(left, Align2::LEFT_CENTER, title, theme::body(), palette.text);
        let galley = painter.layout_no_wrap(remark.to_owned(), theme::caption(), palette.faint);
        // What does not fit beside the title goes below it.
        let below = named.max.x + galley.size().x + 20.0 > rect.max.x;
        let place = Align2::RIGHT_CENTER.anchor_size(
            pos2(rect.max.x - 12.0, line + if below { 0.75 * TITLE } else { 0.0 }),
            galley.size(),
        );
        let start = place.min.x.max(rect.min.x + 12.0);
        painter.galley(pos2(start, place.min.y), galley, palette.faint);
        let top = TITLE + 4.0 + if below { 0.6 * TITLE } else { 0.0 };
        let area = Rect::from_min_max(rect.min + vec2(12.0, top), rect.max - vec2(12.0, AXIS + 4.0));
        Plot { area, painter, palette }
    }

    /// Writes what both ends of the horizontal axis stand for.
    pub fn ends(&self, left: &str, right: &str) {
        self.painter.hline(self.area.x_range(), self.area.max.y, Stroke::new(1.0, self.palette.raised));
        let y = self.area.max.y + 0.5 * AXIS + 1.0;
        let text = |x, align, text: &str| {
            self.painter.text(pos2(x, y), align, text, theme::caption(), self.palette.faint);
        };
        text(self.area.min.x, Align2::LEFT_CENTER, left);
        text(self.area.max.x, Align2::RIGHT_CENTER, right);
    }

    /// Writes a mark on the horizontal axis, at a share of it.
    pub fn tick(&self, share: f32, text: &str) {
        let x = self.area.min.x + share * self.area.width();
        let stroke = Stroke::new(1.0, self.palette.raised.gamma_multiply(0.6));
        self.painter.vline(x, self.area.y_range(), stroke);
        let at = pos2(x, self.area.max.y + 0.5 * AXIS + 1.0);
        self.painter.text(at, Align2::CENTER_CENTER, text, theme::caption(), self.palette.faint);
    }

    /// A place from shares of both axes, the vertical one upward.
    pub fn at(&self, x: f32, y: f32) -> Pos2 {
        let share = |x: f32| if x.is_finite() { x.clamp(0.0, 1.0) } else { 0.0 };
        pos2(self.area.min.x + share(x) * self.area.width(), self.area.max.y - share(y) * self.area.height())
    }

    /// Draws a curve through places, filled down to the axis.
    pub fn curve(&self, points: &[Pos2], colour: Color32) {
        let mut mesh = egui::epaint::Mesh::default();
        let (top, bottom) = (colour.gamma_multiply(0.30), colour.gamma_multiply(0.04));
        for point in points {
            mesh.colored_vertex(*point, top);
            mesh.colored_vertex(pos2(point.x, self.area.max.y), bottom);
        }
        for pair in 0..points.len().saturating_sub(1) as u32 {
            mesh.add_triangle(2 * pair, 2 * pair + 1, 2 * pair + 2);
            mesh.add_triangle(2 * pair + 1, 2 * pair + 2, 2 * pair + 3);
        }
        self.painter.add(Shape::mesh(mesh));
        self.painter.line(points.to_vec(), Stroke::new(1.6, colour));
    }

    /// Draws a line through places.
    pub fn line(&self, points: Vec<Pos2>, colour: Color32) {
        self.painter.line(points, Stroke::new(1.4, colour));
    }

    /// Says what a height (points of the screen) stands for, at the left above it.
    pub fn remark_at(&self, y: f32, text: &str) {
        let at = pos2(self.area.min.x, y - 1.0);
        self.painter.text(at, Align2::LEFT_BOTTOM, text, theme::small(), self.palette.faint);
    }

    /// Says in the middle why there is nothing to see.
    pub fn nothing(&self, why: &str) {
        let colour = self.palette.faint;
        self.painter.text(self.area.center(), Align2::CENTER_CENTER, why, theme::caption(), colour);
    }

    pub fn painter(&self) -> &Painter {
        &self.painter
    }
}

/// A time (s) in the unit that suits it.
pub fn time_text(seconds: f32) -> String {
    match seconds {
        s if s >= 1.0 => format!("{s:.1} s"),
        s if s >= 0.01 => format!("{:.0} ms", 1e3 * s),
        s => format!("{:.1} ms", 1e3 * s),
    }
}

/// An energy (J) in the unit that suits it.
pub fn energy_text(joules: f32) -> String {
    match joules {
        e if e >= 1.0 => format!("{e:.1} J"),
        e if e >= 1e-3 => format!("{:.0} mJ", 1e3 * e),
        e if e >= 1e-6 => format!("{:.0} µJ", 1e6 * e),
        e if e >= 1e-9 => format!("{:.0} nJ", 1e9 * e),
        _ => "at rest".to_owned(),
    }
}

/// A length (m) in the unit that suits it.
pub fn length_text(metres: f32) -> String {
    match metres {
        l if l >= 1e-3 => format!("{:.1} mm", 1e3 * l),
        l if l >= 1e-6 => format!("{:.0} µm", 1e6 * l),
        _ => "0".to_owned(),
    }
}
