//! The library: every instrument that the search finds, and whole kits.

use std::sync::LazyLock;

use egui::{ComboBox, Label, Rect, RichText, ScrollArea, Sense, TextEdit, Ui, UiBuilder};
use overhear_player::library::{self, Instrument, WholeKit};

use super::super::theme;
use super::wish::Wish;

/// Both are read once.
static INSTRUMENTS: LazyLock<Vec<Instrument>> = LazyLock::new(|| library::instruments().collect());
static KITS: LazyLock<Vec<WholeKit>> = LazyLock::new(|| library::kits().collect());

/// The library as one window shows it.
#[derive(Default)]
pub struct LibraryList {
    /// What is searched for.
    wanted: String,
    /// The instrument that is chosen.
    chosen: Option<&'static str>,
}

impl LibraryList {
    /// Draws it.
    pub fn show(&mut self, ui: &mut Ui, rect: Rect, wish: &mut Option<Wish>) {
        ui.scope_builder(UiBuilder::new().max_rect(rect).id_salt("library list"), |ui| {
            ui.add(TextEdit::singleline(&mut self.wanted).hint_text("Search").desired_width(f32::INFINITY));
            ui.horizontal(|ui| {
                let chosen = self.chosen;
                ui.add_enabled_ui(chosen.is_some(), |ui| {
                    if ui.button("Add").on_hover_text("One more piece").clicked() {
                        *wish = chosen.map(Wish::Add);
                    }
                    if ui.button("Swap").on_hover_text("In the place of the selected piece").clicked() {
                        *wish = chosen.map(Wish::Exchange);
                    }
                });
            });
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| self.rows(ui, wish));
        });
    }

    fn rows(&mut self, ui: &mut Ui, wish: &mut Option<Wish>) {
        ui.spacing_mut().item_spacing.y = 1.0;
        let palette = theme::of(ui);
        let words: Vec<String> = self.wanted.split_whitespace().map(str::to_lowercase).collect();
        let mut family = "";
        let mut found = false;
        for instrument in INSTRUMENTS.iter().filter(|instrument| fits(instrument, &words)) {
            found = true;
            if instrument.family != family {
                if !family.is_empty() {
                    ui.add_space(6.0);
                }
                family = &instrument.family;
                ui.colored_label(palette.accent, family);
            }
            let row = ui.selectable_label(self.chosen == Some(instrument.name), instrument.name);
            let about = RichText::new(&instrument.about).font(theme::small()).color(palette.faint);
            let about = Label::new(about).wrap().selectable(false).sense(Sense::click());
            let indented = ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = 0.0;
                ui.add_space(ui.spacing().button_padding.x);
                ui.add(about)
            });
            let row = row.union(indented.inner);
            if row.clicked() {
                self.chosen = Some(instrument.name);
            }
            if row.double_clicked() {
                *wish = Some(Wish::Exchange(instrument.name));
            }
        }
        if !found {
            ui.colored_label(palette.faint, "Nothing is called so");
        }
    }
}

/// Whether an instrument has every word in its name, its family or the line on what it is.
fn fits(instrument: &Instrument, words: &[String]) -> bool {
    let all = format!("{} {} {}", instrument.name, instrument.family, instrument.about).to_lowercase();
    words.iter().all(|word| all.contains(word))
}

/// The list of whole kits; gives the one that is chosen.
pub fn whole_kits(ui: &mut Ui) -> Option<&'static str> {
    let mut wanted = None;
    ComboBox::from_id_salt("whole-kits").selected_text("Whole kits").width(130.0).show_ui(ui, |ui| {
        for kit in KITS.iter() {
            if ui.selectable_label(false, kit.name).on_hover_text(&kit.about).clicked() {
                wanted = Some(kit.name);
            }
        }
    });
    wanted
}
