//! Cache of the results of long calculations, for the next build of the same piece.
//!
//! A drum's or a plate's modes and their transfer to the receivers follow from its description alone. They are calculated
//! once in a process and shared: every instance and every rebuild that asks for the same description gets the same result, to
//! the last bit. Where the program provides a [`DiskCache`], results also outlive the process. This module opens no file.
//!
//! The key is the whole description in binary form, in which every number stands exactly. The disk cache stores a result
//! behind its key, under a [name](name_of) that also depends on the schema: the version of the equations and a digest of the
//! libraries that calculate.
//!
//! Nothing here runs on the audio thread.

use std::collections::BTreeMap;
use std::hash::Hasher;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use fnv::FnvHasher;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// A result, shared by all who asked for it.
pub type Shared<T> = Arc<T>;

/// Where results outlive the process; see [`provide`].
pub trait DiskCache: Send + Sync {
    /// The bytes stored under a name, verified; `None` if there are none or they are damaged.
    fn take(&self, name: &str) -> Option<Vec<u8>>;
    /// Stores bytes under a name, if that is possible.
    fn put(&self, name: &str, bytes: &[u8]);
}

static DISK: OnceLock<Box<dyn DiskCache>> = OnceLock::new();

/// Results older than this are forgotten.
static AGE: AtomicU64 = AtomicU64::new(0);

/// Provides the disk cache for the rest of the process; false if there is one already.
pub fn provide(disk: Box<dyn DiskCache>) -> bool {
    DISK.set(disk).is_ok()
}

/// Forgets the results in memory, so that they are read from disk or calculated again; for tests and measurements.
pub fn forget() {
    AGE.fetch_add(1, Ordering::AcqRel);
}

/// A result with its age and its key.
type Held<T> = (u64, Vec<u8>, Arc<T>);

/// Results of one kind; the latest are held.
pub struct Cache<T> {
    kind: &'static str,
    schema: &'static str,
    most: usize,
    /// Latest last.
    held: Mutex<Vec<Held<T>>>,
}

impl<T: Serialize + DeserializeOwned> Cache<T> {
    /// Room for so many results, calculated under that schema.
    pub const fn new(kind: &'static str, schema: &'static str, most: usize) -> Cache<T> {
        Cache { kind, schema, most, held: Mutex::new(Vec::new()) }
    }

    /// The result for a key: from memory, from disk, or made. Two threads that ask for the same at once may both make it.
    ///
    /// # Errors
    /// What `make` says.
    pub fn get<E>(&self, key: &impl Serialize, make: impl FnOnce() -> Result<T, E>) -> Result<Shared<T>, E> {
        // A description that cannot be packed is not cached.
        let Ok(key) = postcard::to_stdvec(key) else { return Ok(Arc::new(make()?)) };
        if let Some(held) = self.held(&key) {
            return Ok(held);
        }
        let name = name_of(self.kind, self.schema, &key);
        let disk = DISK.get();
        let stored = disk.and_then(|disk| disk.take(&name)).and_then(|bytes| unpack(&key, &bytes));
        let result = match stored {
            Some(result) => result,
            None => {
                let made = make()?;
                if let (Some(disk), Ok(bytes)) = (disk, postcard::to_stdvec(&(&key, &made))) {
                    disk.put(&name, &bytes);
                }
                made
            }
        };
        let result = Arc::new(result);
        let mut held = self.lock();
        let excess = (held.len() + 1).saturating_sub(self.most);
        held.drain(..excess);
        held.push((AGE.load(Ordering::Acquire), key, result.clone()));
        Ok(result)
    }

    fn held(&self, key: &[u8]) -> Option<Arc<T>> {
        let mut held = self.lock();
        let age = AGE.load(Ordering::Acquire);
        held.retain(|(of, ..)| *of == age);
        let at = held.iter().position(|(_, known, _)| known == key)?;
        let entry = held.remove(at);
        let result = entry.2.clone();
        held.push(entry);
        Some(result)
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<Held<T>>> {
        // Whole after a panic elsewhere: entries are only added and taken out.
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Small tables of one kind, told apart by a number, made once in a process and held for the rest of it.
pub struct Numbered<T> {
    held: Mutex<BTreeMap<usize, Shared<T>>>,
}

impl<T> Numbered<T> {
    /// None yet.
    pub const fn new() -> Numbered<T> {
        Numbered { held: Mutex::new(BTreeMap::new()) }
    }

    /// That of a number. Whoever asks while one is made waits for it.
    pub fn get(&self, number: usize, make: impl FnOnce() -> T) -> Shared<T> {
        // Whole after a panic elsewhere: tables are only added.
        let mut held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
        held.entry(number).or_insert_with(|| Arc::new(make())).clone()
    }
}

impl<T> Default for Numbered<T> {
    fn default() -> Numbered<T> {
        Numbered::new()
    }
}

/// A result from disk, if it is that of the key.
fn unpack<T: DeserializeOwned>(key: &[u8], bytes: &[u8]) -> Option<T> {
    let (known, result): (Vec<u8>, T) = postcard::from_bytes(bytes).ok()?;
    (known == key).then_some(result)
}

/// The name of a result in the disk cache: its kind and a digest (FNV-1a) of schema and key.
pub fn name_of(kind: &str, schema: &str, key: &[u8]) -> String {
    let mut digest = FnvHasher::default();
    // The zero keeps the end of the schema from being taken for the beginning of the key.
    for part in [schema.as_bytes(), &[0], key] {
        digest.write(part);
    }
    format!("{kind}-{:016x}", digest.finish())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_result_is_made_once_and_the_oldest_is_given_up() {
        static CACHE: Cache<f64> = Cache::new("test", "schema", 2);
        let make = |key: &str, value: f64| CACHE.get(&key, || Ok::<_, ()>(value)).unwrap();
        assert_eq!(*make("a", 1.0), 1.0);
        assert_eq!(*make("a", 2.0), 1.0);
        make("b", 3.0);
        make("a", 4.0);
        make("c", 5.0);
        // `a` was asked for after `b`.
        assert_eq!((*make("a", 6.0), *make("b", 7.0)), (1.0, 7.0));
        assert!(CACHE.get(&"d", || Err("no")).is_err());
    }

    #[test]
    fn a_numbered_table_is_made_once() {
        static TABLES: Numbered<usize> = Numbered::new();
        assert_eq!((*TABLES.get(3, || 9), *TABLES.get(3, || 10), *TABLES.get(4, || 16)), (9, 9, 16));
    }

    #[test]
    fn what_comes_from_disk_is_what_was_put_there_to_the_last_bit() {
        let value = vec![0.1_f64, f64::NEG_INFINITY, -0.0, f64::MIN_POSITIVE, 1.0 / 3.0];
        let bytes = postcard::to_stdvec(&(&b"key"[..], &value)).unwrap();
        let back: Vec<f64> = unpack(b"key", &bytes).unwrap();
        assert!(back.iter().zip(&value).all(|(a, b)| a.to_bits() == b.to_bits()));
        assert_eq!(unpack::<Vec<f64>>(b"another", &bytes), None);
        assert_eq!(unpack::<Vec<f64>>(b"key", &bytes[..bytes.len() - 1]), None);
    }
}
