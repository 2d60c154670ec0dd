//! Fields of a piece's sizes, and lists of what its parts are made of.

use egui::{ComboBox, Grid, Key, Rect, ScrollArea, TextEdit, Ui, UiBuilder};
use overhear_engine::kit_spec::PieceSpec;
use overhear_engine::slot::Slot;
use overhear_player::kit_edits::sizes::{Size, Units};
use overhear_player::kit_file::parts::{self, Part};

use super::super::theme;
use super::wish::Wish;

/// Draws both.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    piece: &PieceSpec,
    (slot, units): (Slot, Units),
    wish: &mut Option<Wish>,
) {
    ui.scope_builder(UiBuilder::new().max_rect(rect).id_salt(("made", slot)), |ui| {
        let accent = theme::of(ui).pieces[slot.index()];
        ui.colored_label(accent, &piece.title);
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            Grid::new("made").num_columns(2).spacing([8.0, 5.0]).show(ui, |ui| {
                for part in parts::of(piece) {
                    ui.colored_label(theme::of(ui).faint, part.label);
                    list(ui, &part, piece, wish);
                    ui.end_row();
                }
                for size in Size::ALL {
                    let Some(value) = size.of(piece) else { continue };
                    ui.colored_label(theme::of(ui).faint, size.label());
                    field(ui, size, value, units, wish);
                    ui.end_row();
                }
            });
        });
    });
}

/// The list of what a part can be.
fn list(ui: &mut Ui, part: &Part, piece: &PieceSpec, wish: &mut Option<Wish>) {
    let choices = part.choices();
    let chosen = part.chosen(piece);
    let present = choices.iter().find(|made| Some(made.name) == chosen);
    let shown = match present {
        Some(made) => made.title,
        None if part.is_there(piece) => "Its own",
        None => "None",
    };
    let width = (ui.max_rect().max.x - ui.cursor().min.x - 14.0).clamp(90.0, 190.0);
    ComboBox::from_id_salt(part.label).width(width).truncate().selected_text(shown).show_ui(ui, |ui| {
        for made in &choices {
            if ui.selectable_label(Some(made.name) == chosen, made.title).clicked() {
                *wish = Some(Wish::Fit(*part, Some(made.name)));
            }
        }
        if part.optional && ui.selectable_label(!part.is_there(piece), "None").clicked() {
            *wish = Some(Wish::Fit(*part, None));
        }
    });
}

/// A field to type a size into; what is typed counts on Enter or when the field is left.
fn field(ui: &mut Ui, size: Size, value: f64, units: Units, wish: &mut Option<Wish>) {
    let id = ui.scope_id().with(("size", size.label()));
    let mut typed = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_else(|| size.text(value, units));
    let readable = size.parse(&typed, units);
    let mut edit = TextEdit::singleline(&mut typed).id(id.with("field")).desired_width(84.0);
    if readable.is_none() {
        edit = edit.text_color(theme::of(ui).over);
    }
    let response = ui.add(edit);
    if response.lost_focus() {
        ui.data_mut(|data| data.remove::<String>(id));
        let given_up = ui.input(|input| input.key_pressed(Key::Escape));
        if let Some(wanted) = readable.filter(|_| !given_up && typed != size.text(value, units)) {
            *wish = Some(Wish::Resize(size, wanted));
        }
    } else if response.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, typed));
    }
    response.on_hover_text("Type a value, with or without a unit");
}
