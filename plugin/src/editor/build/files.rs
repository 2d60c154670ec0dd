//! Kits and pieces in files: a name in the folder of one's own, or a path.

use std::fs;
use std::path::{Path, PathBuf};

use egui::{Button, TextEdit, Ui};
use overhear_engine::slot::Slot;
use overhear_player::kit_document::KitDocument;
use overhear_player::kit_file;

use super::super::theme;
use super::wish::Wish;

/// Extension of the files.
const EXTENSION: &str = "toml";

/// Files of one window.
pub struct Files {
    folder: Option<PathBuf>,
    /// The name or path in the field.
    named: String,
}

impl Files {
    /// Files in a folder, which need not exist yet.
    pub fn of(folder: Option<PathBuf>) -> Files {
        Files { folder, named: String::new() }
    }

    /// Draws a field for a name or a path, and what can be done with it.
    pub fn show(&mut self, ui: &mut Ui, wish: &mut Option<Wish>) {
        let width = (ui.available_width() - 330.0).clamp(120.0, 420.0);
        let field = TextEdit::singleline(&mut self.named).desired_width(width);
        // It stands on what a field is filled with elsewhere.
        let field = field.background_color(theme::of(ui).panel);
        ui.add(field.hint_text("Name of a kit file, or its path"));
        let named = self.named.trim().to_owned();
        for (text, tip, wanted) in [
            ("Save kit", "Writes the whole kit into that file", Wish::SaveKit as fn(String) -> Wish),
            ("Save piece", "Writes the selected piece, with its notes, into that file", Wish::SavePiece),
            ("Open kit", "Puts the kit of that file in the place of this one", Wish::Open),
            ("Add pieces", "Adds the pieces of that file to this kit", Wish::AddFile),
        ] {
            if ui.add_enabled(!named.is_empty(), Button::new(text)).on_hover_text(tip).clicked() {
                *wish = Some(wanted(named.clone()));
            }
        }
    }

    /// Where a name or a path leads.
    fn path(&self, named: &str) -> Result<PathBuf, String> {
        let path = Path::new(named);
        if path.components().count() > 1 {
            return Ok(path.to_owned());
        }
        let folder = self.folder.as_ref().ok_or("there is no folder for kits; give a path")?;
        let end = if path.extension().is_some_and(|own| own == EXTENSION) { "" } else { ".toml" };
        Ok(folder.join(format!("{named}{end}")))
    }

    /// Writes a kit; says where.
    pub fn save(&self, named: &str, document: &KitDocument) -> Result<String, String> {
        let path = self.path(named)?;
        let failed = |error: std::io::Error| format!("{} cannot be written: {error}", path.display());
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(failed)?;
        }
        // Beside the file first: an interrupted save leaves the old one.
        let draft = path.with_extension("part");
        fs::write(&draft, kit_file::write(document)).map_err(failed)?;
        fs::rename(&draft, &path).map_err(failed)?;
        Ok(format!("Saved as {}", path.display()))
    }

    /// Writes a kit of the piece of a slot alone; says where.
    pub fn save_piece(&self, named: &str, document: &KitDocument, slot: Slot) -> Result<String, String> {
        let piece = overhear_player::kit_edits::alone(document, slot).map_err(|error| error.to_string())?;
        self.save(named, &piece)
    }

    /// Reads a kit.
    pub fn load(&self, named: &str) -> Result<KitDocument, String> {
        kit_file::load(&self.path(named)?).map_err(|error| error.to_string())
    }
}
