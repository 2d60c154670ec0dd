//! The energy of every piece, on a scale of decades.

use egui::{Align2, Rect, Ui, pos2, vec2};
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::slot::Slot;
use overhear_engine::snapshot::KitSnapshot;

use crate::editor::plot::{Plot, energy_text};
use crate::editor::theme;

/// Ends of the scale, J: what falls asleep, and a hard stroke on a kick.
const RANGE: (f32, f32) = (1e-10, 3.0);

/// Least height of a row, points: what is lower cannot be read.
const ROW: f32 = 10.0;

/// Draws a bar for each piece of a kit, or for those with the most energy if there is no room for all.
pub fn show(ui: &Ui, rect: Rect, kit: &KitSpec, snapshot: &KitSnapshot) {
    let palette = theme::of(ui);
    let whole: f32 =
        snapshot.pieces.iter().map(|piece| piece.energy).filter(|energy| energy.is_finite()).sum();
    let plot = Plot::new(ui, rect, "Energy", &energy_text(whole));
    // No axis below: each bar says what it is.
    let area = Rect::from_min_max(plot.area.min, pos2(plot.area.max.x, rect.max.y - 8.0));
    let shown = strongest(kit, snapshot, ((area.height() / ROW) as usize).max(1));
    let height = area.height() / shown.len().max(1) as f32;
    let painter = plot.painter();
    for (place, &slot) in shown.iter().enumerate() {
        let energy = snapshot.pieces[slot.index()].energy;
        let row =
            Rect::from_min_size(area.min + vec2(0.0, place as f32 * height), vec2(area.width(), height));
        let left = pos2(row.min.x, row.center().y);
        let title = kit.piece(slot).map_or("", |piece| &piece.title);
        // A long title ends where its bar begins.
        let name = Rect::from_x_y_ranges(row.min.x..=row.min.x + 60.0, row.y_range());
        painter.with_clip_rect(name).text(left, Align2::LEFT_CENTER, title, theme::caption(), palette.text);
        let right = pos2(row.max.x, row.center().y);
        painter.text(right, Align2::RIGHT_CENTER, energy_text(energy), theme::caption(), palette.faint);
        let room = Rect::from_min_max(
            pos2(row.min.x + 62.0, row.center().y - 3.0),
            pos2(row.max.x - 54.0, row.center().y + 3.0),
        );
        painter.rect_filled(room, 2.0, palette.background);
        let bar = Rect::from_min_size(room.min, vec2(room.width() * share(energy), room.height()));
        painter.rect_filled(bar, 2.0, palette.pieces[slot.index()]);
    }
}

/// As many pieces as asked for, those with the most energy, in the order of their slots.
fn strongest(kit: &KitSpec, snapshot: &KitSnapshot, count: usize) -> Vec<Slot> {
    let mut slots: Vec<Slot> = kit.slots().map(|(slot, _)| slot).collect();
    let energy = |slot: &Slot| snapshot.pieces[slot.index()].energy.max(0.0);
    slots.sort_by(|a, b| energy(b).total_cmp(&energy(a)));
    slots.truncate(count);
    slots.sort_unstable();
    slots
}

/// Place of an energy on the scale, 0 to 1.
fn share(energy: f32) -> f32 {
    let (least, most) = RANGE;
    if energy > least { ((energy / least).ln() / (most / least).ln()).min(1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_stays_on_the_scale() {
        assert_eq!((share(f32::NAN), share(0.0), share(1e9)), (0.0, 0.0, 1.0));
        assert!(share(1e-3) > share(1e-6) && share(1e-6) > 0.0);
    }

    #[test]
    fn where_there_is_no_room_for_all_the_strongest_are_shown_in_their_order() {
        let (kit, mut snapshot) = (KitSpec::standard(), KitSnapshot::default());
        let shown = |snapshot: &KitSnapshot, count: usize| -> Vec<usize> {
            strongest(&kit, snapshot, count).iter().map(|slot| slot.index()).collect()
        };
        assert_eq!(shown(&snapshot, 20), (0..kit.pieces.len()).collect::<Vec<_>>());
        for (slot, energy) in [(7, 1e-3), (2, 1e-6), (4, f32::NAN)] {
            snapshot.pieces[slot].energy = energy;
        }
        assert_eq!(shown(&snapshot, 2), [2, 7]);
    }
}
