//! What the selected piece is made of: lists of its parts, switches of what it has or has not, fields of its sizes. What is refused is
//! said below the field where it was asked for.

use egui::{Align2, ComboBox, Key, Label, Rect, RichText, ScrollArea, Sense, TextEdit, Ui, UiBuilder, vec2};
use overhear_engine::kit_spec::PieceSpec;
use overhear_engine::slot::Slot;
use overhear_player::kit_edits::features::Feature;
use overhear_player::kit_edits::sizes::{Size, Units};
use overhear_player::kit_file::parts::{self, Part};

use super::super::theme;
use super::wish::{Answer, Field, Wish};

/// Height of a row, and width of its name, points.
const ROW: f32 = 24.0;
const NAME: f32 = 100.0;

/// Where a piece stands, at the end of all sizes.
const PLACE: [Size; 3] = [Size::Right, Size::Height, Size::Forward];

/// What the panel is about beside the piece.
pub struct Seen<'a> {
    pub slot: Slot,
    pub units: Units,
    /// What the latest wish came to.
    pub said: Option<&'a Answer>,
}

/// Draws the panel.
pub fn show(ui: &mut Ui, rect: Rect, piece: &PieceSpec, seen: &Seen<'_>, wish: &mut Option<Wish>) {
    ui.scope_builder(UiBuilder::new().max_rect(rect).id_salt(("made", seen.slot)), |ui| {
        let accent = theme::of(ui).pieces[seen.slot.index()];
        ui.colored_label(accent, &piece.title);
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 2.0;
            heading(ui, "Made of");
            for part in parts::of(piece) {
                row(ui, part.label, |ui| list(ui, &part, piece, wish));
                refusal(ui, Field::Part(part), seen, wish);
            }
            for feature in Feature::ALL {
                let Some(on) = feature.of(piece) else { continue };
                row(ui, feature.label(), |ui| switch(ui, feature, on, wish));
                refusal(ui, Field::Feature(feature), seen, wish);
            }
            heading(ui, "Sizes");
            for size in Size::ALL {
                if !PLACE.contains(&size) {
                    sized(ui, size, piece, seen, wish);
                }
            }
            heading(ui, "Where it stands");
            for size in PLACE {
                sized(ui, size, piece, seen, wish);
            }
        });
    });
}

fn heading(ui: &mut Ui, text: &str) {
    ui.add_space(4.0);
    ui.label(RichText::new(text).font(theme::caption()).color(theme::of(ui).text));
}

/// A name and what stands beside it.
fn row(ui: &mut Ui, name: &str, draw: impl FnOnce(&mut Ui)) {
    ui.horizontal(|ui| {
        let (place, _) = ui.allocate_exact_size(vec2(NAME, ROW), Sense::hover());
        let painter = ui.painter_at(place);
        painter.text(place.left_center(), Align2::LEFT_CENTER, name, theme::body(), theme::of(ui).faint);
        draw(ui);
    });
}

/// The field of a size that a piece has.
fn sized(ui: &mut Ui, size: Size, piece: &PieceSpec, seen: &Seen<'_>, wish: &mut Option<Wish>) {
    let Some(value) = size.of(piece) else { return };
    row(ui, size.label(), |ui| field(ui, size, value, seen.units, wish));
    refusal(ui, Field::Size(size), seen, wish);
}

/// Why the latest wish at a field was refused, and what to do instead.
fn refusal(ui: &mut Ui, at: Field, seen: &Seen<'_>, wish: &mut Option<Wish>) {
    let Some(said) = seen.said.filter(|said| said.field == Some(at)) else { return };
    ui.add(Label::new(RichText::new(&said.words).font(theme::caption()).color(theme::of(ui).over)).wrap());
    if let (Field::Size(size), Some(nearest)) = (at, said.nearest)
        && ui.button(format!("Take {}", size.text(nearest, seen.units))).clicked()
    {
        *wish = Some(Wish::Resize(size, nearest));
    }
    ui.add_space(4.0);
}

/// On or off, and another one of what chance makes.
fn switch(ui: &mut Ui, feature: Feature, on: bool, wish: &mut Option<Wish>) {
    let mut wanted = on;
    if ui.checkbox(&mut wanted, "").changed() {
        *wish = Some(Wish::Switch(feature, wanted));
    }
    if on && feature.is_chance() {
        let tip = "As uneven as this one, elsewhere: no two of a make are alike";
        if ui.small_button("Another one").on_hover_text(tip).clicked() {
            *wish = Some(Wish::DrawAgain(feature));
        }
    }
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
    let width = (ui.max_rect().max.x - ui.cursor().min.x - 14.0).clamp(90.0, 230.0);
    let list = ComboBox::from_id_salt(part.label).width(width).truncate().selected_text(shown);
    let list = list.show_ui(ui, |ui| {
        for made in &choices {
            if ui.selectable_label(Some(made.name) == chosen, made.title).clicked() {
                *wish = Some(Wish::Fit(*part, Some(made.name)));
            }
        }
        if part.optional && ui.selectable_label(!part.is_there(piece), "None").clicked() {
            *wish = Some(Wish::Fit(*part, None));
        }
    });
    list.response.on_hover_text(shown);
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
