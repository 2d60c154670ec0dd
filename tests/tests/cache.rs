//! The cache of built pieces: results are the same from every source, and no entry is mistaken for another.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use overhear_engine::SCHEMA;
use overhear_engine::cache::{DiskCache, forget, name_of, provide};
use overhear_engine::drum::{DrumSpec, ResonantSpec};
use overhear_engine::kit_spec::{Defaults, InstrumentSpec, PieceSpec, PlaceSpec};
use overhear_engine::piece::{BuildOptions, Quality};
use overhear_engine::split::Splitting;
use overhear_engine::strike::Striker;
use overhear_tests::{RATES, altered, build, render_into, spec, stroke};

/// A disk in memory that counts and can do harm.
#[derive(Clone, Default)]
struct Counting {
    files: Arc<Mutex<HashMap<String, Vec<u8>>>>,
    found: Arc<AtomicU32>,
    put: Arc<AtomicU32>,
    harmful: Arc<AtomicBool>,
}

impl DiskCache for Counting {
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

/// The disk is the whole process's.
fn alone() -> MutexGuard<'static, ()> {
    static TURN: Mutex<()> = Mutex::new(());
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Counting {
    /// The one of this process.
    fn provided() -> Counting {
        static SHELF: Mutex<Option<Counting>> = Mutex::new(None);
        let mut provided = SHELF.lock().unwrap();
        let disk = provided.get_or_insert_with(|| {
            let disk = Counting::default();
            assert!(provide(Box::new(disk.clone())) && !provide(Box::new(Counting::default())));
            disk
        });
        disk.clone()
    }

    /// Results that were found and put since the last look.
    fn counts(&self) -> (u32, u32) {
        (self.found.swap(0, Ordering::Relaxed), self.put.swap(0, Ordering::Relaxed))
    }
}

fn sound(spec: &PieceSpec, options: &BuildOptions) -> Vec<f32> {
    let mut piece = build(spec, options);
    piece.strike(&stroke(Striker::Stick, 4.0, 0.4, 0.3));
    let mut out = vec![0.0; 8_000];
    render_into(&mut piece, &mut out);
    out
}

#[test]
fn fresh_held_shelved_and_harmed_pieces_sound_alike_to_the_last_bit() {
    let _turn = alone();
    let disk = Counting::provided();
    let options = BuildOptions::new(RATES[0]);
    for name in ["snare", "rack-tom", "splash", "hi-hat"] {
        let spec = spec(name);
        disk.files.lock().unwrap().clear();
        forget();
        disk.counts();
        let fresh = sound(&spec, &options);
        let (found, put) = disk.counts();
        assert!(found == 0 && put > 0, "{name}: {found} found, {put} put");
        assert!(sound(&spec, &options) == fresh, "{name}: held");
        assert_eq!(disk.counts(), (0, 0), "{name}: the disk was asked for what is held");
        forget();
        assert!(sound(&spec, &options) == fresh, "{name}: from the disk");
        assert_eq!(disk.counts(), (put, 0), "{name}: from the disk");
        forget();
        disk.harmful.store(true, Ordering::Relaxed);
        assert!(sound(&spec, &options) == fresh, "{name}: harmed");
        assert_eq!(disk.counts(), (put, put), "{name}: harmed, and so put anew");
        disk.harmful.store(false, Ordering::Relaxed);
    }
}

/// The drum of a piece changed.
fn drum(change: impl FnOnce(DrumSpec) -> DrumSpec) -> PieceSpec {
    altered(spec("rack-tom"), change)
}

/// How many results are worked out for a piece when those of its like in the standard kit are there.
fn worked_out(piece: &PieceSpec, options: &BuildOptions) -> u32 {
    let disk = Counting::provided();
    for name in ["rack-tom", "splash"] {
        build(&spec(name), &BuildOptions::new(RATES[0]));
    }
    disk.counts();
    build(piece, options);
    disk.counts().1
}

#[test]
fn what_is_kept_is_found_by_what_it_follows_from_and_by_nothing_else() {
    let _turn = alone();
    let options = BuildOptions::new(RATES[0]);
    let resonant = |drum: DrumSpec, pitch_ratio: f64| {
        drum.resonant.map(|resonant| ResonantSpec { pitch_ratio, ..resonant })
    };
    // The modes, how they mix, and how they are heard; of another wall, how that is heard.
    for (what, other, results) in [
        ("size", drum(|drum| DrumSpec { diameter: 1.001 * drum.diameter, ..drum }), 4),
        ("other head", drum(|drum| DrumSpec { resonant: resonant(drum, 1.3), ..drum }), 3),
        ("pitch", drum(|drum| DrumSpec { pitch_hz: 1.001 * drum.pitch_hz, ..drum }), 3),
    ] {
        assert_eq!(worked_out(&other, &options), results, "{what}");
    }
    // How they are heard, and, from elsewhere, the wall.
    let uneven = drum(|drum| {
        let evenness = Splitting { detuning: 0.9 * drum.evenness.detuning, ..drum.evenness };
        DrumSpec { evenness, ..drum }
    });
    let tom = spec("rack-tom");
    let moved = PieceSpec { place: PlaceSpec { facing: [0.0, 1.0, 0.1], ..tom.place }, ..tom.clone() };
    let heard = PieceSpec { close: spec("timpani").close, ..tom.clone() };
    for (what, other, results) in
        [("evenness", uneven, 1), ("where it faces", moved, 2), ("microphone", heard, 2)]
    {
        assert_eq!(worked_out(&other, &options), results, "{what}");
    }
    // Neither.
    let muffler = overhear_tests::drum("kick").muffler;
    let hoopless = drum(|drum| DrumSpec { hoop: None, muffler, high_band: false, ..drum });
    let renamed = PieceSpec {
        name: "another".to_owned(),
        title: "Another".to_owned(),
        defaults: Defaults { muffle: 0.7, level_db: -3.0, ..tom.defaults },
        ..tom.clone()
    };
    let ideal = tom.lossless().linear().round();
    for (what, other) in [("hoop", hoopless), ("name", renamed), ("ideal", ideal)] {
        assert_eq!(worked_out(&other, &options), 0, "{what}");
    }
    let splash = spec("splash");
    // What stretches, as far as its modes are coupled.
    assert_eq!(worked_out(&splash, &BuildOptions { quality: Quality::Eco, ..options }), 1, "quality");
    let mut heavy = splash;
    if let InstrumentSpec::Cymbal(cymbal) = &mut heavy.instrument {
        cymbal.mass *= 1.001;
    }
    // Its modes, what hammering makes of them, and how they stretch it.
    assert_eq!(worked_out(&heavy, &options), 3, "mass");
}

#[test]
fn another_version_of_the_equations_or_of_a_library_finds_nothing_of_this_one() {
    let name = |mark: &str| name_of("drum", mark, b"key");
    // No digit of a digest is an x.
    assert_ne!(name(SCHEMA), name(&format!("x{}", &SCHEMA[1..])));
    assert_ne!(name(SCHEMA), name(&format!("{SCHEMA}x")));
    assert_ne!(name(SCHEMA), name_of("plate", SCHEMA, b"key"));
    assert_ne!(name(SCHEMA), name_of("drum", SCHEMA, b"kez"));
    // The digest is that of every source of the engine and of the lock file, however their lines end: FNV-1a of 64 bits.
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let mut files = sources(&root.join("engine/src"));
    files.sort();
    files.push(root.join("Cargo.lock"));
    assert!(files.len() > 100, "{} files", files.len());
    let bytes = files.iter().flat_map(|file| std::fs::read(file).expect("a source"));
    let digest = bytes.filter(|&byte| byte != b'\r').fold(0xcbf2_9ce4_8422_2325_u64, |digest, byte| {
        (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    assert!(SCHEMA.starts_with(&format!("{digest:016x}-")), "{SCHEMA}, not {digest:016x}");
}

/// The files of a folder and of those in it.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    entries.flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] }).collect()
}
