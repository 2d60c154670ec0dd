//! The disk cache of built pieces' tables: a folder of checked files in the platform's cache.
//!
//! Linux: `~/.cache/overhear`, macOS: `~/Library/Caches/org.Overhear.Overhear`, Windows:
//! `%LOCALAPPDATA%\Overhear\Overhear\cache`. Everything in it can be deleted at any time. A file holds
//!
//! ```text
//! 0   8 bytes  "OVERHEAR"
//! 8   4        version of this format, little-endian as all numbers
//! 12  4        CRC-32 of the contents
//! 16  8        length of the contents, bytes
//! 24           the contents, as the engine's cache has packed them
//! ```
//!
//! and is taken only if all of it is right; whatever is not is as good as missing, and written anew. Its
//! name holds a digest of the version of the engine's equations and of what was asked for, so that a newer engine finds nothing
//! of an older one's. Files are written beside and moved into place: a concurrent reader finds a whole file or none.
//!
//! Nothing here runs on the audio thread.

use std::fs;
use std::io;
use std::path::PathBuf;
use std::sync::Once;
use std::sync::atomic::{AtomicU32, Ordering};

use directories::ProjectDirs;
use overhear_engine::cache::{self, DiskCache};

/// What files begin with, the version of what follows, and where the contents begin.
const SIGNATURE: [u8; 8] = *b"OVERHEAR";
const VERSION: u32 = 1;
const HEADER: usize = 24;

/// How files' names end.
const EXTENSION: &str = "kept";

/// Files kept; beyond, the oldest are removed. The standard kit needs 15 at a sample rate, one of 16 pieces about 30.
const MOST_FILES: usize = 256;

/// A folder of checked files.
pub struct FolderCache {
    folder: PathBuf,
}

impl FolderCache {
    /// In a folder, which is made when something is first put there.
    pub fn new(folder: impl Into<PathBuf>) -> FolderCache {
        FolderCache { folder: folder.into() }
    }

    /// In the platform's cache; none if the platform names no such folder.
    pub fn of_platform() -> Option<FolderCache> {
        ProjectDirs::from("org", "Overhear", "Overhear").map(|places| FolderCache::new(places.cache_dir()))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name).with_extension(EXTENSION)
    }

    fn write(&self, name: &str, contents: &[u8]) -> io::Result<()> {
        /// Tells apart what threads of this process write at once.
        static WRITTEN: AtomicU32 = AtomicU32::new(0);
        fs::create_dir_all(&self.folder)?;
        let path = self.path(name);
        let count = WRITTEN.fetch_add(1, Ordering::Relaxed);
        let beside = path.with_extension(format!("{}-{count}.new", std::process::id()));
        let moved = fs::write(&beside, sealed(contents)).and_then(|()| fs::rename(&beside, &path));
        if moved.is_err() {
            // What could not be written or moved is of no use to anybody.
            let _ = fs::remove_file(&beside);
        }
        self.trim()?;
        moved
    }

    /// Removes the oldest files beyond [`MOST_FILES`].
    fn trim(&self) -> io::Result<()> {
        let mut files = Vec::new();
        for entry in fs::read_dir(&self.folder)? {
            let path = entry?.path();
            if path.extension().is_some_and(|extension| extension == EXTENSION) {
                let changed = fs::metadata(&path).and_then(|data| data.modified());
                files.push((changed.unwrap_or(std::time::UNIX_EPOCH), path));
            }
        }
        files.sort();
        for (_, path) in &files[..files.len().saturating_sub(MOST_FILES)] {
            fs::remove_file(path)?;
        }
        Ok(())
    }
}

impl DiskCache for FolderCache {
    fn take(&self, name: &str) -> Option<Vec<u8>> {
        opened(fs::read(self.path(name)).ok()?)
    }

    fn put(&self, name: &str, bytes: &[u8]) {
        // A cache that cannot be written, on a full or a read-only disk, is done without.
        let _ = self.write(name, bytes);
    }
}

/// Contents with their header.
fn sealed(contents: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(HEADER + contents.len());
    bytes.extend(SIGNATURE);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(crc32fast::hash(contents).to_le_bytes());
    bytes.extend((contents.len() as u64).to_le_bytes());
    bytes.extend(contents);
    bytes
}

/// The contents of a whole file of this version; none of any other.
fn opened(mut bytes: Vec<u8>) -> Option<Vec<u8>> {
    let (header, contents) = bytes.split_at_checked(HEADER)?;
    (header == &sealed(contents)[..HEADER]).then_some(())?;
    Some(bytes.split_off(HEADER))
}

/// Lets the tables of built pieces outlive the process from now on. Calls after the first do nothing.
pub fn provide() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        if let Some(disk) = FolderCache::of_platform() {
            cache::provide(Box::new(disk));
        }
    });
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn cache(name: &str) -> FolderCache {
        let folder = std::env::temp_dir().join(format!("overhear-cache-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        FolderCache::new(folder)
    }

    /// The files of a cache.
    fn files(folder: &Path) -> Vec<PathBuf> {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let paths = entries.map(|entry| entry.path());
        paths.filter(|path| path.extension().is_some_and(|extension| extension == EXTENSION)).collect()
    }

    #[test]
    fn what_was_put_is_taken() {
        let cache = cache("put");
        assert_eq!(cache.take("a"), None);
        cache.put("a", b"some numbers");
        cache.put("b", b"");
        assert_eq!(cache.take("a").as_deref(), Some(&b"some numbers"[..]));
        assert_eq!(cache.take("b").as_deref(), Some(&b""[..]));
        fs::remove_dir_all(&cache.folder).unwrap();
    }

    #[test]
    fn what_is_cut_short_or_has_a_wrong_bit_anywhere_is_not_taken_and_can_be_put_anew() {
        let cache = cache("harm");
        cache.put("a", b"some numbers");
        let whole = fs::read(cache.path("a")).unwrap();
        for length in 0..whole.len() {
            fs::write(cache.path("a"), &whole[..length]).unwrap();
            assert_eq!(cache.take("a"), None, "cut to {length}");
        }
        for bit in 0..8 * whole.len() {
            let mut harmed = whole.clone();
            harmed[bit / 8] ^= 1 << (bit % 8);
            fs::write(cache.path("a"), &harmed).unwrap();
            assert_eq!(cache.take("a"), None, "bit {bit}");
        }
        fs::write(cache.path("a"), [&whole[..], b"!"].concat()).unwrap();
        assert_eq!(cache.take("a"), None, "too long");
        cache.put("a", b"other numbers");
        assert_eq!(cache.take("a").as_deref(), Some(&b"other numbers"[..]));
        fs::remove_dir_all(&cache.folder).unwrap();
    }

    #[test]
    fn another_version_is_not_taken() {
        let cache = cache("version");
        cache.put("a", b"some numbers");
        let mut bytes = fs::read(cache.path("a")).unwrap();
        bytes[8..12].copy_from_slice(&(VERSION + 1).to_le_bytes());
        fs::write(cache.path("a"), bytes).unwrap();
        assert_eq!(cache.take("a"), None);
        fs::remove_dir_all(&cache.folder).unwrap();
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_done_without() {
        let cache = cache("file");
        fs::write(&cache.folder, b"in the way").unwrap();
        cache.put("a", b"some numbers");
        assert_eq!(cache.take("a"), None);
        fs::remove_file(&cache.folder).unwrap();
    }

    #[test]
    fn the_folder_does_not_grow_without_end() {
        let cache = cache("many");
        (0..MOST_FILES + 20).for_each(|i| cache.put(&format!("{i}"), &[i as u8]));
        assert_eq!(files(&cache.folder).len(), MOST_FILES);
        assert_eq!(cache.take(&format!("{}", MOST_FILES + 19)), Some(vec![(MOST_FILES + 19) as u8]));
        fs::remove_dir_all(&cache.folder).unwrap();
    }
}
