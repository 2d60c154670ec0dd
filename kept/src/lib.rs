//! Results of long calculations, kept for whoever builds the same piece next.
//!
//! What a drum's or a plate's modes are and how they are heard follows from its description alone. It is worked out once
//! in a process and shared: every instance and every rebuild that asks for the same gets the same, to the last bit. Where
//! the program provides a [`Shelf`], results also outlive the process.
//!
//! The key is the whole description in binary form, in which every number stands exactly. On the shelf a result is preceded
//! by its key and stands under a [name](name_of) that also holds a mark: the number of the equations' version and a digest
//! of the libraries that calculate.
//!
//! Nothing here runs on the audio thread.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use serde::Serialize;
use serde::de::DeserializeOwned;

/// A result, shared by all who asked for it.
pub type Shared<T> = Arc<T>;

/// Where results outlive the process; see [`provide`].
pub trait Shelf: Send + Sync {
    /// What was put under a name, unharmed, or nothing.
    fn take(&self, name: &str) -> Option<Vec<u8>>;
    /// Puts something under a name, if that is possible.
    fn put(&self, name: &str, bytes: &[u8]);
}

static SHELF: OnceLock<Box<dyn Shelf>> = OnceLock::new();

/// Results older than this are forgotten.
static AGE: AtomicU64 = AtomicU64::new(0);

/// Provides the shelf for the rest of the process; false if there is one already.
pub fn provide(shelf: Box<dyn Shelf>) -> bool {
    SHELF.set(shelf).is_ok()
}

/// Forgets what is held in memory, so that it is taken from the shelf or worked out anew; for tests and measurements.
pub fn forget() {
    AGE.fetch_add(1, Ordering::AcqRel);
}

/// A result with its age and its key.
type Held<T> = (u64, Vec<u8>, Arc<T>);

/// Results of one kind; the latest are held.
pub struct Kept<T> {
    kind: &'static str,
    mark: &'static str,
    most: usize,
    /// Latest last.
    held: Mutex<Vec<Held<T>>>,
}

impl<T: Serialize + DeserializeOwned> Kept<T> {
    /// Room for so many, made by sources of that mark.
    pub const fn new(kind: &'static str, mark: &'static str, most: usize) -> Kept<T> {
        Kept { kind, mark, most, held: Mutex::new(Vec::new()) }
    }

    /// The result for a key: held, from the shelf, or made. Two threads that ask for the same at once may both make it.
    ///
    /// # Errors
    /// What `make` says.
    pub fn get<E>(&self, key: &impl Serialize, make: impl FnOnce() -> Result<T, E>) -> Result<Shared<T>, E> {
        // A description that cannot be packed is not kept.
        let Ok(key) = postcard::to_stdvec(key) else { return Ok(Arc::new(make()?)) };
        if let Some(held) = self.held(&key) {
            return Ok(held);
        }
        let name = name_of(self.kind, self.mark, &key);
        let shelf = SHELF.get();
        let shelved = shelf.and_then(|shelf| shelf.take(&name)).and_then(|bytes| unpack(&key, &bytes));
        let result = match shelved {
            Some(result) => result,
            None => {
                let made = make()?;
                if let (Some(shelf), Ok(bytes)) = (shelf, postcard::to_stdvec(&(&key, &made))) {
                    shelf.put(&name, &bytes);
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

/// A result from the shelf, if it is that of the key.
fn unpack<T: DeserializeOwned>(key: &[u8], bytes: &[u8]) -> Option<T> {
    let (known, result): (Vec<u8>, T) = postcard::from_bytes(bytes).ok()?;
    (known == key).then_some(result)
}

/// What a result is called on the shelf: its kind and a digest (FNV-1a) of mark and key.
pub fn name_of(kind: &str, mark: &str, key: &[u8]) -> String {
    let digest =
        mark.bytes().chain([0]).chain(key.iter().copied()).fold(0xcbf2_9ce4_8422_2325_u64, |digest, byte| {
            (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
    format!("{kind}-{digest:016x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_result_is_made_once_and_the_oldest_is_given_up() {
        static KEPT: Kept<f64> = Kept::new("test", "mark", 2);
        let make = |key: &str, value: f64| KEPT.get(&key, || Ok::<_, ()>(value)).unwrap();
        assert_eq!(*make("a", 1.0), 1.0);
        assert_eq!(*make("a", 2.0), 1.0);
        make("b", 3.0);
        make("a", 4.0);
        make("c", 5.0);
        // `a` was asked for after `b`.
        assert_eq!((*make("a", 6.0), *make("b", 7.0)), (1.0, 7.0));
        assert!(KEPT.get(&"d", || Err("no")).is_err());
    }

    #[test]
    fn a_numbered_table_is_made_once() {
        static TABLES: Numbered<usize> = Numbered::new();
        assert_eq!((*TABLES.get(3, || 9), *TABLES.get(3, || 10), *TABLES.get(4, || 16)), (9, 9, 16));
    }

    #[test]
    fn what_comes_from_a_shelf_is_what_was_put_there_to_the_last_bit() {
        let value = vec![0.1_f64, f64::NEG_INFINITY, -0.0, f64::MIN_POSITIVE, 1.0 / 3.0];
        let bytes = postcard::to_stdvec(&(&b"key"[..], &value)).unwrap();
        let back: Vec<f64> = unpack(b"key", &bytes).unwrap();
        assert!(back.iter().zip(&value).all(|(a, b)| a.to_bits() == b.to_bits()));
        assert_eq!(unpack::<Vec<f64>>(b"another", &bytes), None);
        assert_eq!(unpack::<Vec<f64>>(b"key", &bytes[..bytes.len() - 1]), None);
    }
}
