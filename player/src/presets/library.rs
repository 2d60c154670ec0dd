//! All presets there are: the built-in ones and the user's files.

use std::fs;
use std::path::{Path, PathBuf};

use directories::ProjectDirs;

use super::error::PresetError;
use super::preset::{FACTORY, Preset};

/// Extension of the files.
const EXTENSION: &str = "toml";

/// Longest name, characters.
const LONGEST_NAME: usize = 60;

/// Largest file read, bytes: a preset has some kilobytes.
const LARGEST_FILE: u64 = 1 << 20;

/// Where a preset comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// Built in.
    Factory,
    /// A file of the user's.
    User,
}

/// A preset's name and origin.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// Name; of a file its name without the extension.
    pub name: String,
    /// Where it comes from.
    pub origin: Origin,
}

/// The presets of a folder, behind the built-in ones.
#[derive(Debug, Clone)]
pub struct Library {
    folder: Option<PathBuf>,
}

impl Default for Library {
    /// The user's own, in the folder where the platform keeps an application's data.
    fn default() -> Self {
        let project = ProjectDirs::from("org", "Overhear", "Overhear");
        Library { folder: project.map(|project| project.data_dir().join("presets")) }
    }
}

impl Library {
    /// The presets of a folder, which need not exist yet.
    pub fn at(folder: &Path) -> Library {
        Library { folder: Some(folder.to_owned()) }
    }

    /// The folder of the user's files.
    ///
    /// # Errors
    /// [`PresetError::NoFolder`].
    pub fn folder(&self) -> Result<&Path, PresetError> {
        self.folder.as_deref().ok_or(PresetError::NoFolder)
    }

    /// Every preset: the built-in ones in their order, then the user's by name. A folder that cannot be read has none.
    pub fn list(&self) -> Vec<Entry> {
        let factory =
            FACTORY.iter().map(|(name, _)| Entry { name: (*name).to_owned(), origin: Origin::Factory });
        let files = self.folder.iter().flat_map(fs::read_dir).flatten().flatten();
        let mut names: Vec<String> = files
            .map(|file| file.path())
            .filter(|path| path.extension().is_some_and(|extension| extension == EXTENSION) && path.is_file())
            .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
            .filter(|name| built_in(name).is_none())
            .collect();
        names.sort();
        factory.chain(names.into_iter().map(|name| Entry { name, origin: Origin::User })).collect()
    }

    /// Loads a preset by its name.
    ///
    /// # Errors
    /// [`PresetError`] if there is none or its file cannot be read.
    pub fn load(&self, name: &str) -> Result<Preset, PresetError> {
        if let Some(text) = built_in(name) {
            return Preset::parse(name, text);
        }
        let known = self.list();
        if !known.iter().any(|entry| entry.name == name) {
            let names: Vec<_> = known.into_iter().map(|entry| entry.name).collect();
            return Err(PresetError::Unknown { name: name.to_owned(), accepted: names.join(", ") });
        }
        load_file(&self.path(name)?)
    }

    /// Stores a preset under a name, over a file of that name; returns the file.
    ///
    /// # Errors
    /// [`PresetError`] if the name or the folder cannot be used.
    pub fn save(&self, name: &str, preset: &Preset) -> Result<PathBuf, PresetError> {
        let path = self.path(name)?;
        let folder = self.folder()?;
        fs::create_dir_all(folder).map_err(file_error("make", folder))?;
        // Beside the file first: an interrupted save leaves the old one.
        let draft = folder.join(format!(".{name}.part"));
        fs::write(&draft, preset.to_text()).map_err(file_error("write", &draft))?;
        fs::rename(&draft, &path).map_err(file_error("write", &path))?;
        Ok(path)
    }

    /// Gives one of the user's presets another name.
    ///
    /// # Errors
    /// [`PresetError`] if there is none, or if the new name cannot be used or is taken.
    pub fn rename(&self, from: &str, to: &str) -> Result<(), PresetError> {
        let (old, new) = (self.existing(from)?, self.path(to)?);
        if new.exists() {
            return Err(PresetError::Name { name: to.to_owned(), reason: "a preset of this name exists" });
        }
        fs::rename(&old, &new).map_err(file_error("rename", &old))
    }

    /// Deletes one of the user's presets.
    ///
    /// # Errors
    /// [`PresetError`] if there is none or the file stays.
    pub fn delete(&self, name: &str) -> Result<(), PresetError> {
        let path = self.existing(name)?;
        fs::remove_file(&path).map_err(file_error("delete", &path))
    }

    fn existing(&self, name: &str) -> Result<PathBuf, PresetError> {
        let path = self.path(name)?;
        if path.is_file() {
            return Ok(path);
        }
        let user = self.list().into_iter().filter(|entry| entry.origin == Origin::User);
        let names: Vec<_> = user.map(|entry| entry.name).collect();
        Err(PresetError::Unknown { name: name.to_owned(), accepted: names.join(", ") })
    }

    /// The file of a name that may be a user's.
    fn path(&self, name: &str) -> Result<PathBuf, PresetError> {
        let refused = |reason| Err(PresetError::Name { name: name.to_owned(), reason });
        if built_in(name).is_some() {
            return Err(PresetError::BuiltIn { name: name.to_owned() });
        }
        if name.trim() != name || name.is_empty() || name.chars().count() > LONGEST_NAME {
            return refused("accepted: 1 to 60 characters, no space at either end");
        }
        // What one of the platforms would not take, or would take for a path.
        if name.starts_with('.') || name.chars().any(|c| c.is_control() || r#"/\:*?"<>|"#.contains(c)) {
            return refused(r#"accepted: no dot at the start, none of / \ : * ? " < > |"#);
        }
        Ok(self.folder()?.join(format!("{name}.{EXTENSION}")))
    }
}

/// Loads a preset from any file.
///
/// # Errors
/// [`PresetError`] if it cannot be read or says something that is not understood.
pub fn load_file(path: &Path) -> Result<Preset, PresetError> {
    let shown = path.display().to_string();
    let size = fs::metadata(path).map_err(file_error("read", path))?.len();
    if size > LARGEST_FILE {
        let reason = format!("{size} bytes are no preset, accepted: up to {LARGEST_FILE}");
        return Err(PresetError::AtLine { file: shown, line: 1, reason });
    }
    let bytes = fs::read(path).map_err(file_error("read", path))?;
    match std::str::from_utf8(&bytes) {
        Ok(text) => Preset::parse(&shown, text),
        Err(error) => {
            let line = 1 + bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count();
            Err(PresetError::AtLine { file: shown, line, reason: "this is not text (UTF-8)".to_owned() })
        }
    }
}

fn built_in(name: &str) -> Option<&'static str> {
    FACTORY.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

fn file_error(what: &'static str, path: &Path) -> impl Fn(std::io::Error) -> PresetError {
    move |source| PresetError::File { what, path: path.to_owned(), source }
}
