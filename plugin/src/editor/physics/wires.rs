//! Snare wires: which sections are off the head, and their landings since the stroke.
//!
//! The far head seen from below, with each section where the engine lays it. A section that was off the head a moment ago
//! still glows: it flies and lands faster than anybody looks.

use egui::{Align2, Color32, Rect, Shape, Stroke, Ui, pos2, vec2};
use overhear_engine::snapshot::WireSnapshot;
use overhear_engine::surface::wires::{PLACES, SECTIONS};

use crate::editor::plot::{Plot, time_text};
use crate::editor::theme;

/// How long a section glows, s.
const GLOW: f64 = 0.35;

/// Half the length of a section, shares of the head's radius.
const HALF: f32 = 0.17;

/// When each section was last seen off the head.
#[derive(Debug, Clone, Copy, Default)]
pub struct Wires {
    seen: [Option<f64>; SECTIONS],
}

impl Wires {
    /// Takes in what they do at a time (s).
    pub fn follow(&mut self, wires: &WireSnapshot, now: f64) {
        for (section, seen) in self.seen.iter_mut().enumerate() {
            if wires.aloft & (1 << section) != 0 {
                *seen = Some(now);
            }
        }
    }

    /// How much a section glows, 0 to 1.
    fn glow(&self, section: usize, now: f64) -> f32 {
        self.seen[section].map_or(0.0, |seen| (1.0 - (now - seen) / GLOW).clamp(0.0, 1.0) as f32)
    }

    /// Draws the head with its wires at the time `now`, s.
    pub fn show(&self, ui: &Ui, rect: Rect, wires: &WireSnapshot, now: f64, accent: Color32) {
        let palette = theme::of(ui);
        let plot = Plot::new(ui, rect, "Snare wires", &remark(wires));
        let room = Rect::from_min_max(plot.area.min, pos2(plot.area.max.x, rect.max.y - 24.0));
        let radius = 0.5 * room.height().min(room.width());
        let painter = plot.painter();
        let head = Stroke::new(1.5, palette.raised);
        painter.circle(room.center(), radius, palette.background, head);
        for (section, [x, y]) in PLACES.into_iter().enumerate() {
            let centre = room.center() + radius * vec2(x as f32, -y as f32);
            let glow = self.glow(section, now);
            let colour = palette.chrome.lerp_to_gamma(accent, glow);
            // Three strands stand for a row; one in the air comes nearer.
            for strand in [-1.0, 0.0, 1.0] {
                let at = centre + vec2(0.0, 0.045 * radius * strand * (1.0 + 0.5 * glow));
                let half = vec2(HALF * radius, 0.0);
                painter
                    .add(Shape::line_segment([at - half, at + half], Stroke::new(1.0 + 1.2 * glow, colour)));
            }
        }
        let text = if wires.last_lift > 0.0 {
            format!("last lift at {}", time_text(wires.last_lift))
        } else {
            "all against the head".to_owned()
        };
        let at = pos2(room.center().x, rect.max.y - 12.0);
        painter.text(at, Align2::CENTER_CENTER, text, theme::caption(), palette.faint);
    }
}

/// How many are off the head, and how often they landed.
fn remark(wires: &WireSnapshot) -> String {
    format!("{} of {SECTIONS} off, {} landings", wires.aloft.count_ones(), wires.landings)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_section_that_flew_glows_for_a_while_and_the_others_do_not() {
        let mut wires = Wires::default();
        let aloft = WireSnapshot { aloft: 0b100, landings: 7, last_lift: 0.1 };
        wires.follow(&aloft, 1.0);
        assert_eq!((wires.glow(2, 1.0), wires.glow(1, 1.0)), (1.0, 0.0));
        assert!((0.1..0.9).contains(&wires.glow(2, 1.2)));
        assert_eq!(wires.glow(2, 2.0), 0.0);
        assert_eq!(remark(&aloft), "1 of 8 off, 7 landings");
    }
}
