//! Files that are written completely or not at all.
//!
//! A [`Draft`] is written beside its target and takes the target's name in one step when it is
//! finished; dropped before that, it leaves nothing behind.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::bad_input;

/// A file being written.
#[derive(Debug)]
pub struct Draft {
    target: PathBuf,
    temporary: PathBuf,
    finished: bool,
}

impl Draft {
    /// Starts a file that will be called `target`.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) if a file of that name cannot be made.
    pub fn new(target: &Path) -> Result<Draft> {
        let unusable = |reason: &str| bad_input!("cannot write `{}`: {reason}", target.display());
        // Only plain files are accepted: renaming must not replace a device or a folder.
        let target = match fs::metadata(target) {
            Ok(metadata) if metadata.is_dir() => return Err(unusable("it is a folder")),
            Ok(metadata) if !metadata.is_file() => return Err(unusable("it is not a plain file")),
            Ok(metadata) if metadata.permissions().readonly() => {
                return Err(unusable("it is read-only"));
            }
            // A link stays a link; what it leads to is written.
            Ok(_) => fs::canonicalize(target).map_err(|error| unusable(&error.to_string()))?,
            Err(_) => target.to_path_buf(),
        };
        let Some(name) = target.file_name() else {
            return Err(unusable("it names no file"));
        };
        let mut hidden = std::ffi::OsString::from(".");
        hidden.push(name);
        hidden.push(format!(".{}.part", std::process::id()));
        let temporary = target.with_file_name(hidden);
        File::create(&temporary).map_err(|error| unusable(&error.to_string()))?;
        Ok(Draft { target, temporary, finished: false })
    }

    /// Where to write until [`finish`](Self::finish).
    pub fn path(&self) -> &Path {
        &self.temporary
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn finish(mut self) -> Result<()> {
        fs::rename(&self.temporary, &self.target)
            .with_context(|| format!("cannot write `{}`", self.target.display()))?;
        self.finished = true;
        Ok(())
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        if !self.finished {
            // It may not exist; an error here has no receiver.
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

/// A folder to write into. If it was made for that and is still empty when dropped, it goes again.
#[derive(Debug)]
pub struct Folder {
    /// Folders that were not there before, the deepest first.
    made: Vec<PathBuf>,
}

impl Folder {
    /// Makes a folder, with those above it, unless it is there.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) if it cannot be made.
    pub fn new(path: &Path) -> Result<Folder> {
        let missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
        let made = path.ancestors().take_while(missing).map(Path::to_path_buf).collect();
        fs::create_dir_all(path)
            .map_err(|error| bad_input!("cannot make the folder `{}`: {error}", path.display()))?;
        Ok(Folder { made })
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        for folder in &self.made {
            // Fails for a folder that is not empty, as intended.
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Writes a whole file at once.
///
/// # Errors
/// As [`Draft::new`] and [`Draft::finish`].
pub fn write(target: &Path, bytes: &[u8]) -> Result<()> {
    let draft = Draft::new(target)?;
    fs::write(draft.path(), bytes).with_context(|| format!("cannot write `{}`", target.display()))?;
    draft.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn empty_folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("overhear-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    fn count(folder: &Path) -> usize {
        fs::read_dir(folder).unwrap().count()
    }

    #[test]
    fn a_dropped_draft_leaves_nothing_and_a_finished_one_only_its_target() {
        let folder = empty_folder("draft");
        let target = folder.join("a.wav");
        drop(Draft::new(&target).unwrap());
        assert_eq!(count(&folder), 0);
        write(&target, b"sound").unwrap();
        write(&target, b"more").unwrap();
        assert_eq!((fs::read(&target).unwrap(), count(&folder)), (b"more".to_vec(), 1));
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_folder_made_for_nothing_goes_again() {
        let outer = empty_folder("folder");
        drop(Folder::new(&outer.join("a/b")).unwrap());
        assert_eq!(count(&outer), 0);
        let folder = Folder::new(&outer.join("a/b")).unwrap();
        write(&outer.join("a/b/c.wav"), b"sound").unwrap();
        drop(folder);
        drop(Folder::new(&outer).unwrap());
        assert!(outer.join("a/b/c.wav").exists());
        fs::remove_dir_all(outer).unwrap();
    }

    #[test]
    fn folders_devices_and_missing_folders_are_refused() {
        let folder = empty_folder("refused");
        for target in [folder.clone(), folder.join("no/such/a.wav"), PathBuf::from("/dev/null")] {
            let error = Draft::new(&target).unwrap_err();
            assert!(error.is::<crate::error::BadInput>(), "{error}");
            assert!(error.to_string().contains(&target.display().to_string()), "{error}");
        }
        assert_eq!(count(&folder), 0);
        fs::remove_dir_all(folder).unwrap();
    }
}
