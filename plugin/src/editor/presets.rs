//! The bar of presets: choose one, save what is set, rename and delete one's own.

use egui::{Button, ComboBox, TextEdit, Ui};

use nice_plug::prelude::Param;
use overhear_engine::error::SpecError;

use super::gesture::Gesture;
use super::gesture::put;
use super::theme;
use crate::host_parameters::HostParameters;
use overhear_player::presets::{DEFAULT, Entry, Library, Origin, Preset, PresetError};

/// What a name is being typed for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Naming {
    Save,
    Rename,
}

/// The bar of one window.
pub struct PresetBar {
    library: Library,
    entries: Vec<Entry>,
    /// Name of the preset that was chosen or saved last.
    chosen: String,
    naming: Option<(Naming, String)>,
    /// What the latest action came to, if it went wrong.
    trouble: Option<String>,
}

impl PresetBar {
    /// A bar of the presets of a library.
    pub fn new(library: Library) -> PresetBar {
        let entries = library.list();
        PresetBar { library, entries, chosen: DEFAULT.to_owned(), naming: None, trouble: None }
    }

    /// Draws the bar in a line; `set` receives what a chosen preset does to the parameter of an index.
    pub fn show(&mut self, ui: &mut Ui, parameters: &HostParameters, set: &mut dyn FnMut(usize, Gesture)) {
        if let Some((naming, typed)) = self.naming.take() {
            self.name_field(ui, naming, typed, parameters);
            return;
        }
        let own = self.entries.iter().any(|entry| entry.name == self.chosen && entry.origin == Origin::User);
        let mut wanted = None;
        ComboBox::from_id_salt("presets").selected_text(&self.chosen).show_ui(ui, |ui| {
            for entry in &self.entries {
                if ui.selectable_label(entry.name == self.chosen, &entry.name).clicked() {
                    wanted = Some(entry.name.clone());
                }
            }
        });
        if let Some(name) = wanted {
            self.load(&name, parameters, set);
        }
        if ui.button("Save").clicked() {
            let name = if own { self.chosen.clone() } else { String::new() };
            self.naming = Some((Naming::Save, name));
        }
        if ui.add_enabled(own, Button::new("Rename")).clicked() {
            self.naming = Some((Naming::Rename, self.chosen.clone()));
        }
        if ui.add_enabled(own, Button::new("Delete")).clicked() {
            let deleted = self.library.delete(&self.chosen);
            if self.went_well(deleted) {
                DEFAULT.clone_into(&mut self.chosen);
            }
        }
        if let Some(trouble) = &self.trouble {
            ui.colored_label(theme::of(ui).over, trouble);
        }
    }

    /// A field for a name, with what confirms and what gives up.
    fn name_field(&mut self, ui: &mut Ui, naming: Naming, mut typed: String, parameters: &HostParameters) {
        let field = ui.add(TextEdit::singleline(&mut typed).desired_width(140.0).hint_text("name"));
        field.request_focus();
        let (entered, left) =
            ui.input(|input| (input.key_pressed(egui::Key::Enter), input.key_pressed(egui::Key::Escape)));
        let confirmed = ui.button("OK").clicked() || entered;
        if ui.button("Cancel").clicked() || left {
            return;
        }
        if !confirmed {
            self.naming = Some((naming, typed));
            return;
        }
        let done = match naming {
            Naming::Save => self.library.save(&typed, &present(parameters)).map(|_| ()),
            Naming::Rename => self.library.rename(&self.chosen, &typed),
        };
        if self.went_well(done) {
            self.chosen = typed;
        }
    }

    fn load(&mut self, name: &str, parameters: &HostParameters, set: &mut dyn FnMut(usize, Gesture)) {
        let loaded = self.library.load(name).map_err(|error| error.to_string());
        let done =
            loaded.and_then(|preset| apply(&preset, parameters, set).map_err(|error| error.to_string()));
        if done.is_ok() {
            name.clone_into(&mut self.chosen);
        }
        self.trouble = done.err();
        self.entries = self.library.list();
    }

    fn went_well(&mut self, done: Result<(), PresetError>) -> bool {
        self.trouble = done.err().map(|error| error.to_string());
        self.entries = self.library.list();
        self.trouble.is_none()
    }
}

/// What is set now, as a preset.
fn present(parameters: &HostParameters) -> Preset {
    let plain = |index: usize| {
        parameters.values().get(index).map_or(f32::NAN, |value| value.unmodulated_plain_value())
    };
    Preset::of(plain, &parameters.document(), "")
}

/// Brings the preset's kit, if it has one, and moves every parameter that it has elsewhere, as one gesture each.
fn apply(
    preset: &Preset,
    parameters: &HostParameters,
    set: &mut dyn FnMut(usize, Gesture),
) -> Result<(), SpecError> {
    if let Some(kit) = preset.kit() {
        parameters.set_document(kit.clone())?;
    }
    let document = parameters.document();
    for (index, value) in parameters.values().iter().enumerate() {
        let wanted = preset.value(index, &document.kit);
        if let Some(wanted) = wanted.filter(|&wanted| wanted != value.unmodulated_plain_value()) {
            put(index, wanted, set);
        }
    }
    if let Some(notes) = &preset.notes {
        parameters.assignments().replace(notes);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use overhear_engine::kit_spec::KitSpec;
    use overhear_player::parameters::{find, parse_assignment};

    #[test]
    fn a_preset_moves_what_differs_and_nothing_else() {
        let parameters = HostParameters::default();
        let mut moved = Vec::new();
        let mut bar = PresetBar::new(Library::at(std::path::Path::new("no-such-folder")));
        bar.load("jazz", &parameters, &mut |index, gesture| moved.push((index, gesture)));
        let kit = KitSpec::standard();
        let (kick, tuned) = parse_assignment("kick_tune=66", &kit).unwrap();
        let of_kick: Vec<_> =
            moved.iter().filter(|(index, _)| *index == kick).map(|(_, gesture)| *gesture).collect();
        assert_eq!(of_kick, [Gesture::Begin, Gesture::Set(tuned), Gesture::End]);
        let untouched = find("timpani_tune", &kit).unwrap();
        assert!(moved.iter().all(|(index, _)| *index != untouched));
        assert_eq!(bar.chosen, "jazz");
    }

    #[test]
    fn a_preset_that_is_gone_is_named_and_changes_nothing() {
        let mut bar = PresetBar::new(Library::at(std::path::Path::new("no-such-folder")));
        bar.load("mine", &HostParameters::default(), &mut |_, _| panic!("moved"));
        assert!(bar.trouble.as_ref().is_some_and(|trouble| trouble.contains("`mine`")));
        assert_eq!(bar.chosen, DEFAULT);
    }
}
