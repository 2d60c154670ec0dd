//! The page on which a kit is built: pieces from the library, where they stand, their sizes and parts, and files.
//!
//! Whatever a hand does here gives a whole new document or is refused in words, with the document that sounds untouched. The
//! builder notices a new one and builds the pieces that differ; parameters go with their pieces.

mod drawing;
mod files;
mod floor;
mod parts;
mod library_list;
mod wish;

use std::path::PathBuf;
use std::sync::Arc;

use egui::{Align, Button, Layout, Rect, Ui, UiBuilder, pos2, vec2};
use overhear_engine::kit_spec::{KitSpec, PieceSpec};
use overhear_engine::slot::Slot;
use overhear_player::kit_document::KitDocument;
use overhear_player::kit_edits::sizes::{Refusal, Units, resize};
use overhear_player::kit_edits::{self, Edit, Origin};
use overhear_player::library;
use overhear_player::parameters::{SlotParameter, default_value, is_live, slot_index};

use wish::{Answer, Wish};

use super::gesture::{Gesture, put};
use super::theme;
use super::values::Values;
use crate::host_parameters::HostParameters;

/// Height of a line of switches, points.
const LINE: f32 = 30.0;

/// Space between panels, points.
const GAP: f32 = 8.0;

/// What can be done, while there is nothing to say.
const HINT: &str = "Drag pieces on the floor, or the handles of a drum or cymbal; arrow keys move the piece that has the focus";

/// The page of one window.
pub struct Build {
    units: Units,
    list: library_list::LibraryList,
    floor: floor::Floor,
    drawing: drawing::Drawing,
    files: files::Files,
    /// What the latest wish came to.
    said: Option<Answer>,
}

/// What the page is about.
pub struct About<'a> {
    pub parameters: &'a HostParameters,
    pub document: &'a Arc<KitDocument>,
    /// Whether the piece of a slot is being built.
    pub building: &'a dyn Fn(Slot) -> bool,
}

impl Build {
    /// A page that keeps files in a folder.
    pub fn new(folder: Option<PathBuf>) -> Build {
        Build {
            units: Units::default(),
            list: library_list::LibraryList::default(),
            floor: floor::Floor::default(),
            drawing: drawing::Drawing::default(),
            files: files::Files::of(folder),
            said: None,
        }
    }

    /// Draws the page; `set` receives what happens to parameters.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        about: &About<'_>,
        selected: &mut Slot,
        set: &mut dyn FnMut(usize, Gesture),
    ) {
        let kit = &about.document.kit;
        let Some(piece) = kit.piece(*selected) else { return };
        let mut wish = None;
        let (top, rest) = rect.split_top_bottom_at_y(rect.min.y + LINE);
        let (middle, bottom) = rest.split_top_bottom_at_y(rest.max.y - 2.0 * LINE);
        self.top(ui, top, kit, &mut wish);
        self.middle(ui, middle, (kit, piece), selected, &mut wish);
        let (line, files) = bottom.split_top_bottom_at_y(bottom.center().y);
        self.line(ui, line, about);
        within(ui, files, |ui| self.files.show(ui, &mut wish));
        if let Some(wish) = wish {
            self.grant(wish, about, selected, set);
        }
    }

    /// What is done with the piece that is selected, whole kits, units.
    fn top(&mut self, ui: &mut Ui, rect: Rect, kit: &KitSpec, wish: &mut Option<Wish>) {
        within(ui, rect, |ui| {
            if ui.button("Duplicate").on_hover_text("Another one like the selected piece").clicked() {
                *wish = Some(Wish::Duplicate);
            }
            let tip = "Takes the selected piece out of the kit";
            let several = kit.pieces.len() > 1;
            if ui.add_enabled(several, Button::new("Remove")).on_hover_text(tip).clicked() {
                *wish = Some(Wish::Remove);
            }
            ui.separator();
            if let Some(name) = library_list::whole_kits(ui) {
                *wish = Some(Wish::Kit(name));
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.selectable_value(&mut self.units, Units::Millimetres, "mm");
                ui.selectable_value(&mut self.units, Units::Inches, "in");
                let count = kit.pieces.len();
                ui.colored_label(theme::of(ui).faint, format!("{count} of 16 pieces"));
            });
        });
    }

    /// The library, the floor and the piece itself, what it is made of.
    fn middle(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        (kit, piece): (&KitSpec, &PieceSpec),
        selected: &mut Slot,
        wish: &mut Option<Wish>,
    ) {
        let left = (0.29 * rect.width()).clamp(168.0, 300.0);
        let right = (0.36 * rect.width()).clamp(214.0, 330.0);
        let part = |from: f32, to: f32| Rect::from_x_y_ranges(from..=to, rect.y_range());
        let list = part(rect.min.x, rect.min.x + left);
        let views = part(list.max.x + GAP, rect.max.x - right - GAP);
        let made = part(rect.max.x - right, rect.max.x);
        let (floor, drawn) = views.split_top_bottom_at_fraction(0.52);
        let floor = Rect::from_min_max(floor.min, pos2(floor.max.x, floor.max.y - GAP));
        for panel in [list, floor, drawn, made] {
            ui.painter().rect_filled(panel, theme::CORNER, theme::of(ui).panel);
        }
        self.list.show(ui, list.shrink(8.0), wish);
        self.floor.show(ui, floor, kit, selected, wish);
        self.drawing.show(ui, drawn, piece, (*selected, self.units), wish);
        let said = self.said.as_ref();
        parts::show(
            ui,
            made.shrink(8.0),
            piece,
            &parts::Seen { slot: *selected, units: self.units, said },
            wish,
        );
    }

    /// What the latest wish came to, unless it is said at its field, and what is being built.
    fn line(&mut self, ui: &mut Ui, rect: Rect, about: &About<'_>) {
        let palette = theme::of(ui);
        let pieces = about.document.kit.slots().filter(|(slot, _)| (about.building)(*slot));
        let building: Vec<&str> = pieces.map(|(_, piece)| piece.title.as_str()).collect();
        let building = (!building.is_empty()).then(|| format!("Building {}", building.join(", ")));
        let said = self.said.as_ref().filter(|said| said.field.is_none());
        let (text, colour) = match (said, &building) {
            (Some(Answer { words, refused: true, .. }), _) => (words.as_str(), palette.over),
            (_, Some(building)) => (building.as_str(), palette.accent),
            (Some(Answer { words, .. }), None) => (words.as_str(), palette.text),
            (None, None) => (HINT, palette.faint),
        };
        within(ui, rect, |ui| {
            ui.add(egui::Label::new(egui::RichText::new(text).color(colour)).truncate()).on_hover_text(text);
        });
    }

    /// Does what is wanted, or says why not.
    fn grant(
        &mut self,
        wish: Wish,
        about: &About<'_>,
        selected: &mut Slot,
        set: &mut dyn FnMut(usize, Gesture),
    ) {
        let document = &**about.document;
        let field = wish.field();
        let done = match wish {
            Wish::SaveKit(name) => return self.told(self.files.save(&name, document)),
            Wish::SavePiece(name) => return self.told(self.files.save_piece(&name, document, *selected)),
            Wish::Resize(size, value) => {
                let resized = resize(document, *selected, size, value, self.units);
                resized.map_err(|Refusal { words, nearest }| (words, nearest))
            }
            wish => self.edit(wish, document, *selected).map_err(|words| (words, None)),
        };
        self.said = None;
        let refused = match done {
            Ok(edit) => {
                let about_slot = edit.about;
                match take(edit, about.parameters, set) {
                    Ok(()) => {
                        *selected = about_slot;
                        return;
                    }
                    Err(words) => (words, None),
                }
            }
            Err(refused) => refused,
        };
        let (words, nearest) = refused;
        self.said = Some(Answer { words, refused: true, field, nearest });
    }

    fn edit(&self, wish: Wish, document: &KitDocument, selected: Slot) -> Result<Edit, String> {
        let instrument =
            |name: &str| library::instrument(name).ok_or(format!("{name} is not in the library"));
        let plain =
            |edit: Result<Edit, overhear_engine::error::SpecError>| edit.map_err(|error| error.to_string());
        match wish {
            Wish::Add(name) => plain(kit_edits::add(document, &instrument(name)?)),
            Wish::Exchange(name) => plain(kit_edits::exchange(document, selected, &instrument(name)?)),
            Wish::Duplicate => plain(kit_edits::duplicate(document, selected)),
            Wish::Remove => plain(kit_edits::remove(document, selected)),
            Wish::Move(slot, [x, z]) => plain(kit_edits::change(document, slot, |piece| {
                (piece.place.centre[0], piece.place.centre[2]) = (x, z);
            })),
            Wish::Fit(part, name) => {
                let piece = document.kit.piece(selected).ok_or("there is no piece")?;
                let fitted = part.fitted(piece, name)?;
                plain(kit_edits::change(document, selected, |piece| *piece = fitted))
            }
            Wish::Switch(feature, on) => {
                plain(kit_edits::change(document, selected, |piece| feature.switch(piece, on)))
            }
            Wish::DrawAgain(feature) => {
                plain(kit_edits::change(document, selected, |piece| feature.draw_again(piece)))
            }
            Wish::Kit(name) => {
                let kit = library::whole_kit(name).ok_or(format!("{name} is not in the library"))?;
                let other = kit.document().map_err(|error| error.to_string())?;
                Ok(kit_edits::replace(document, other))
            }
            Wish::Open(name) => Ok(kit_edits::replace(document, self.files.load(&name)?)),
            Wish::AddFile(name) => plain(kit_edits::add_all(document, &self.files.load(&name)?)),
            Wish::Resize(..) | Wish::SaveKit(_) | Wish::SavePiece(_) => Err("nothing to change".to_owned()),
        }
    }

    fn told(&mut self, done: Result<String, String>) {
        let refused = done.is_err();
        let words = done.unwrap_or_else(|words| words);
        self.said = Some(Answer { words, refused, field: None, nearest: None });
    }
}

/// Draws in a line.
fn within(ui: &mut Ui, rect: Rect, draw: impl FnOnce(&mut Ui)) {
    let rect = rect.shrink2(vec2(2.0, 2.0));
    ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
        ui.with_layout(Layout::left_to_right(Align::Center), draw);
    });
}

/// Puts a kit in the place of the present one, with parameters that go with their pieces.
fn take(edit: Edit, parameters: &HostParameters, set: &mut dyn FnMut(usize, Gesture)) -> Result<(), String> {
    let before = parameters.document();
    let after = Arc::new(edit.document);
    parameters.set_document(after.clone()).map_err(|error| error.to_string())?;
    let values = Values { all: parameters.values(), kit: &before.kit };
    for (slot, origin) in Slot::ALL.into_iter().zip(edit.origins) {
        for what in SlotParameter::ALL {
            let index = slot_index(slot, what);
            if !is_live(index, &after.kit) {
                continue;
            }
            let wanted = carried(what, origin, values).unwrap_or_else(|| default_value(index, &after.kit));
            if values.plain(index) != Some(wanted) {
                put(index, wanted, set);
            }
        }
    }
    Ok(())
}

/// The value that a piece brings from where it was, if it was moved from its default there.
fn carried(what: SlotParameter, origin: Origin, values: Values<'_>) -> Option<f32> {
    let own_sound = matches!(what, SlotParameter::Tune | SlotParameter::Muffle | SlotParameter::Preload);
    let slot = match origin {
        Origin::Same(slot) => slot,
        // What another piece sounds like is its own affair.
        Origin::Exchanged(slot) if !own_sound => slot,
        Origin::Exchanged(_) | Origin::New => return None,
    };
    let index = slot_index(slot, what);
    values
        .plain(index)
        .filter(|_| is_live(index, values.kit))
        .filter(|&value| value != default_value(index, values.kit))
}
