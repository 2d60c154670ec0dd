//! What is worked out for a piece is kept and shared: nobody can hear where it came from.

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex};

use overhear_engine::piece::{BuildOptions, Piece, PieceId, Quality};
use overhear_engine::strike::Striker;
use overhear_kept::{Shelf, forget, provide};
use overhear_tests::{RATES, stroke};

/// A shelf in memory that counts and can do harm.
#[derive(Clone, Default)]
struct Counting {
    files: Arc<Mutex<HashMap<String, Vec<u8>>>>,
    found: Arc<AtomicU32>,
    put: Arc<AtomicU32>,
    harmful: Arc<AtomicBool>,
}

impl Shelf for Counting {
    fn take(&self, name: &str) -> Option<Vec<u8>> {
        let mut bytes = self.files.lock().unwrap().get(name)?.clone();
        self.found.fetch_add(1, Ordering::Relaxed);
        if self.harmful.load(Ordering::Relaxed) {
            // What a checksum would have caught.
            bytes.truncate(bytes.len() / 2);
        }
        Some(bytes)
    }

    fn put(&self, name: &str, bytes: &[u8]) {
        self.put.fetch_add(1, Ordering::Relaxed);
        self.files.lock().unwrap().insert(name.to_owned(), bytes.to_vec());
    }
}

fn sound(id: PieceId, options: &BuildOptions) -> Vec<f32> {
    let mut piece = Piece::new(id, options).unwrap();
    piece.strike(&stroke(Striker::Stick, 4.0, 0.4, 0.3));
    let mut out = vec![0.0; 8_000];
    piece.render(&mut out);
    out
}

// One test: the shelf is the whole process's.
#[test]
fn fresh_held_shelved_and_harmed_pieces_sound_alike_to_the_last_bit() {
    let shelf = Counting::default();
    assert!(provide(Box::new(shelf.clone())) && !provide(Box::new(Counting::default())));
    let counts = || (shelf.found.swap(0, Ordering::Relaxed), shelf.put.swap(0, Ordering::Relaxed));
    let options = BuildOptions::new(RATES[0]);
    for id in [PieceId::Snare, PieceId::RackTom, PieceId::Splash, PieceId::HiHat] {
        let fresh = sound(id, &options);
        let (found, put) = counts();
        assert!(found == 0 && put > 0, "{id:?}: {found} found, {put} put");
        assert!(sound(id, &options) == fresh, "{id:?}: held");
        assert_eq!(counts(), (0, 0), "{id:?}: the shelf was asked for what is held");
        forget();
        assert!(sound(id, &options) == fresh, "{id:?}: from the shelf");
        assert_eq!(counts(), (put, 0), "{id:?}: from the shelf");
        forget();
        shelf.harmful.store(true, Ordering::Relaxed);
        assert!(sound(id, &options) == fresh, "{id:?}: harmed");
        assert_eq!(counts(), (put, put), "{id:?}: harmed, and so put anew");
        shelf.harmful.store(false, Ordering::Relaxed);
    }
    // Quality changes what is coupled, not what is kept; a drum of another ratio is another drum.
    sound(PieceId::Splash, &BuildOptions { quality: Quality::Eco, ..options });
    assert_eq!(counts().1, 0);
    sound(PieceId::RackTom, &BuildOptions { resonant_ratio: Some(1.3), ..options });
    assert!(counts().1 > 0);
}
