//! The selected piece from the side, with handles that change its sizes.

use egui::{Align2, CursorIcon, Pos2, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};
use overhear_engine::kit_spec::PieceSpec;
use overhear_engine::slot::Slot;
use overhear_player::kit_edits::sizes::{Size, Units};

use super::super::theme;
use super::wish::Wish;

/// A handle's half width, points.
const HANDLE: f32 = 7.0;

/// The drawing of one window.
#[derive(Default)]
pub struct Drawing {
    /// The size in the hand.
    held: Option<Held>,
}

#[derive(Debug, Clone, Copy)]
struct Held {
    size: Size,
    /// What it comes to where the hand is, m.
    is: f64,
    /// Points for a metre.
    scale: f32,
}

impl Drawing {
    /// Draws the piece of a slot.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        piece: &PieceSpec,
        (slot, units): (Slot, Units),
        wish: &mut Option<Wish>,
    ) {
        let Some(diameter) = Size::Diameter.of(piece) else { return };
        let depth = Size::Depth.of(piece);
        let held = self.held;
        let now = |size: Size, value: f64| match held {
            Some(held) if held.size == size => held.is,
            _ => value,
        };
        let tall = depth.or(Size::Bow.of(piece)).unwrap_or(0.3 * diameter);
        let fits = (0.62 * rect.width() / diameter as f32).min(0.60 * rect.height() / tall as f32);
        // The scale stays while a hand holds a size.
        let scale = held.map_or(fits, |held| held.scale);
        let wide = scale * now(Size::Diameter, diameter) as f32;
        let middle = rect.center() - vec2(0.0, 8.0);
        let accent = theme::of(ui).pieces[slot.index()];
        let high = match (depth, Size::Bow.of(piece)) {
            (Some(depth), _) => scale * now(Size::Depth, depth) as f32,
            (None, Some(bow)) => scale * now(Size::Bow, bow) as f32,
            (None, None) => 0.4 * wide,
        };
        let body = Rect::from_center_size(middle, vec2(wide, high));
        let painter = ui.painter_at(rect);
        let line = Stroke::new(2.0, accent);
        if piece.drum().is_some() {
            painter.add(Shape::convex_polygon(
                shell(body, depth.is_none()),
                accent.gamma_multiply(0.25),
                line,
            ));
            painter.hline(body.x_range(), body.min.y, Stroke::new(5.0, theme::of(ui).faint));
            painter.hline(body.x_range(), body.min.y, Stroke::new(3.0, theme::of(ui).film));
        } else {
            painter.add(Shape::line(bow(body), Stroke::new(3.0, theme::of(ui).bronze)));
        }
        let right = pos2(body.max.x, if piece.drum().is_some() { body.center().y } else { body.max.y });
        self.handle(ui, right, (Size::Diameter, diameter), scale, (slot, units), wish);
        if let Some(depth) = depth {
            self.handle(ui, body.center_bottom(), (Size::Depth, depth), scale, (slot, units), wish);
        } else if let Some(bow) = Size::Bow.of(piece) {
            self.handle(ui, body.center_top(), (Size::Bow, bow), scale, (slot, units), wish);
        }
        let faint = theme::of(ui).faint;
        let sizes = match depth {
            Some(depth) => {
                let depth = Size::Depth.text(now(Size::Depth, depth), units);
                format!("{} x {depth}", Size::Diameter.text(now(Size::Diameter, diameter), units))
            }
            None => Size::Diameter.text(now(Size::Diameter, diameter), units),
        };
        let at = pos2(rect.center().x, rect.max.y - 12.0);
        painter.text(at, Align2::CENTER_CENTER, sizes, theme::body(), faint);
    }

    fn handle(
        &mut self,
        ui: &mut Ui,
        at: Pos2,
        (size, value): (Size, f64),
        scale: f32,
        (slot, units): (Slot, Units),
        wish: &mut Option<Wish>,
    ) {
        let id = ui.scope_id().with(("handle", size.label(), slot));
        let hit = Rect::from_center_size(at, egui::Vec2::splat(2.0 * HANDLE + 4.0));
        let response = ui.interact(hit, id, Sense::click_and_drag());
        if response.drag_started() {
            self.held = Some(Held { size, is: value, scale });
        }
        if let Some(held) = self.held.as_mut().filter(|held| held.size == size && response.dragged()) {
            // From where it was pressed: what a pointer moves before that counts as a drag is counted.
            let by = response.total_drag_delta().unwrap_or_default();
            // Half of a diameter is on this side of the middle, and so is half of a depth.
            let moved = 2.0
                * match size {
                    Size::Diameter => by.x,
                    Size::Bow => -by.y,
                    _ => by.y,
                };
            let hand = value + f64::from(moved / scale);
            let fine = ui.input(|input| input.modifiers.shift) || size == Size::Bow;
            held.is = if fine { hand } else { size.snapped(hand, units) };
        }
        if response.drag_stopped()
            && let Some(held) = self.held.take()
            && held.is != value
        {
            *wish = Some(Wish::Resize(size, held.is));
        }
        let palette = theme::of(ui);
        let active = response.hovered() || response.dragged() || response.has_focus();
        let fill = if active { palette.accent } else { palette.text };
        ui.painter().circle(
            at,
            if active { HANDLE } else { HANDLE - 2.0 },
            fill,
            Stroke::new(1.0, palette.panel),
        );
        let cursor = match size {
            Size::Diameter => CursorIcon::ResizeHorizontal,
            _ => CursorIcon::ResizeVertical,
        };
        let tip = format!("{}: drag it; Shift for fine steps", size.label());
        response.on_hover_cursor(cursor).on_hover_text(tip);
    }
}

/// A shell from the side; a kettle is round below.
fn shell(body: Rect, kettle: bool) -> Vec<Pos2> {
    if !kettle {
        return vec![body.left_top(), body.right_top(), body.right_bottom(), body.left_bottom()];
    }
    let round = (0..=24).map(|step| {
        let (sin, cos) = (std::f32::consts::PI * step as f32 / 24.0).sin_cos();
        pos2(body.center().x + 0.5 * body.width() * cos, body.min.y + body.height() * sin)
    });
    round.collect()
}

/// A cymbal from the side: its bow, and a bell in the middle.
fn bow(body: Rect) -> Vec<Pos2> {
    let points = (-30..=30).map(|step| {
        let x = step as f32 / 30.0;
        let bell = (1.0 - (x / 0.22).powi(2)).max(0.0) * 0.05 * body.width();
        pos2(body.center().x + 0.5 * body.width() * x, body.min.y + body.height() * x * x - bell)
    });
    points.collect()
}
