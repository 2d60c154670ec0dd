//! The cache of built pieces: results are the same from every source, and no entry is mistaken for another.

use std::collections::HashMap;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use overhear_engine::SCHEMA;
use overhear_engine::cache::{DiskCache, forget, name_of, provide};
use overhear_engine::drum::{DrumSpec, ResonantSpec};
use overhear_engine::kit::BLOCK;
use overhear_engine::kit_spec::{Defaults, InstrumentSpec, PieceSpec, PlaceSpec};
use overhear_engine::modal::{InputVector, RECEIVERS};
use overhear_engine::piece::{BuildOptions, ModeInfo, Quality};
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
    // The modes, how they mix, and how they are heard.
    for (what, other) in [
        ("size", drum(|drum| DrumSpec { diameter: 1.001 * drum.diameter, ..drum })),
        ("other head", drum(|drum| DrumSpec { resonant: resonant(drum, 1.3), ..drum })),
        ("pitch", drum(|drum| DrumSpec { pitch_hz: 1.001 * drum.pitch_hz, ..drum })),
    ] {
        assert_eq!(worked_out(&other, &options), 3, "{what}");
    }
    // How they are heard.
    let uneven = drum(|drum| {
        let evenness = Splitting { detuning: 0.9 * drum.evenness.detuning, ..drum.evenness };
        DrumSpec { evenness, ..drum }
    });
    let tom = spec("rack-tom");
    let moved = PieceSpec { place: PlaceSpec { facing: [0.0, 1.0, 0.1], ..tom.place }, ..tom.clone() };
    let heard = PieceSpec { close: spec("timpani").close, ..tom.clone() };
    for (what, other) in [("evenness", uneven), ("where it faces", moved), ("microphone", heard)] {
        assert_eq!(worked_out(&other, &options), 1, "{what}");
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
    assert_eq!(worked_out(&splash, &BuildOptions { quality: Quality::Eco, ..options }), 0, "quality");
    let mut heavy = splash;
    if let InstrumentSpec::Cymbal(cymbal) = &mut heavy.instrument {
        cymbal.mass *= 1.001;
    }
    assert_eq!(worked_out(&heavy, &options), 1, "mass");
}

#[test]
fn another_version_of_the_equations_or_of_a_library_finds_nothing_of_this_one() {
    let (version, libraries) = SCHEMA.split_once('-').expect("a number and a digest");
    assert!(version.parse::<u32>().is_ok() && libraries.len() > 16, "{SCHEMA}");
    let name = |mark: &str| name_of("drum", mark, b"key");
    assert_ne!(name(SCHEMA), name(&format!("{version}0-{libraries}")));
    assert_ne!(name(SCHEMA), name(&format!("{version}-0{}", &libraries[1..])));
    assert_ne!(name(SCHEMA), name_of("plate", SCHEMA, b"key"));
    assert_ne!(name(SCHEMA), name_of("drum", SCHEMA, b"kez"));
    // The digest is that of the lock file, however its lines end: FNV-1a of 64 bits.
    let lock = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../Cargo.lock")).expect("a lock file");
    let digest =
        lock.into_iter().filter(|&byte| byte != b'\r').fold(0xcbf2_9ce4_8422_2325_u64, |digest, byte| {
            (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
    assert!(libraries.starts_with(&format!("{digest:016x}-")), "{SCHEMA}");
}

/// The number in [`SCHEMA`] of which [`FIGURES`] are.
const FIGURES_OF: &str = "3";

/// What the standard kit's rack tom and splash come to at 48 kHz. A change of these is a change of what caches hold.
#[rustfmt::skip]
const FIGURES: [(&str, f64); 24] = [
    ("rack-tom (0,1) Hz", 1.276230598e2),
    ("rack-tom (0,1) s", 1.337939221e0),
    ("rack-tom (0,1) kg", 4.451391322e-2),
    ("rack-tom (0,1) m2", 1.716519014e-2),
    ("rack-tom (0,1) near Pa", 4.731775819e0),
    ("rack-tom (0,1) far Pa", 4.353625453e-1),
    ("rack-tom (1,1) Hz", 2.015434264e2),
    ("rack-tom (1,1) s", 9.789726672e-1),
    ("rack-tom (1,1) near Pa", 2.841387892e0),
    ("rack-tom (1,1) far Pa", 1.420394545e-1),
    ("rack-tom (2,1) Hz", 2.796313861e2),
    ("rack-tom (2,1) s", 8.042393733e-1),
    ("splash (0,1) Hz", 3.373644649e2),
    ("splash (0,1) s", 3.308431270e0),
    ("splash (0,1) kg", 2.500000000e-1),
    ("splash (0,1) m2", 3.186949085e-3),
    ("splash (0,1) near Pa", 1.138499941e-1),
    ("splash (0,1) far Pa", 9.826869663e-2),
    ("splash (1,1) Hz", 3.739289680e2),
    ("splash (1,1) s", 3.444296818e0),
    ("splash (1,1) near Pa", 1.899460158e-2),
    ("splash (1,1) far Pa", 1.162023514e-2),
    ("splash (2,0) Hz", 4.494775905e1),
    ("splash (2,0) s", 7.384834361e0),
];

/// Share by which a figure may be off: of what is worked out in double precision, and of what is rendered in single.
const EXACT: f64 = 1e-6;
const RENDERED: f64 = 1e-4;

/// Root mean square of the pressure from near and from far in the tenth of a second after a mode alone was pushed by
/// 1 kN for a sample, Pa.
fn heard(piece: &PieceSpec, hertz: f64) -> [f64; 2] {
    let mut piece = build(&piece.clone().linear(), &BuildOptions::new(RATES[1]));
    let body = piece.surface_mut().body_mut();
    let off = |k: &usize| (body.modes()[*k].omega_d() - TAU * hertz).abs();
    let mode = (0..body.len()).min_by(|a, b| off(a).total_cmp(&off(b))).expect("a mode");
    let mut port = InputVector::new(body.len());
    port.shape_mut()[mode] = 1.0;
    body.connect(&mut port);
    body.push(&port, 1e3);
    let (blocks, mut squares) = (150, [0.0; 2]);
    for _ in 0..blocks {
        let mut receivers = [[0.0_f32; BLOCK]; RECEIVERS];
        piece.render_in_air(receivers.each_mut().map(|receiver| &mut receiver[..]), None);
        for (squares, receiver) in squares.iter_mut().zip(&receivers) {
            *squares += receiver.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>();
        }
    }
    squares.map(|squares| (squares / (blocks * BLOCK) as f64).sqrt())
}

/// The figures as they are now, each with how far it may be off.
fn figures() -> Vec<(String, f64, f64)> {
    let mut figures = Vec::new();
    for (name, body, orders) in
        [("rack-tom", "batter", [(0, 1), (1, 1), (2, 1)]), ("splash", "plate", [(0, 1), (1, 1), (2, 0)])]
    {
        let spec = spec(name);
        let modes = build(&spec, &BuildOptions::new(RATES[1])).modes();
        for (at, (m, n)) in orders.into_iter().enumerate() {
            let is = |mode: &&ModeInfo| (mode.body, mode.m, mode.n) == (body, m, n);
            let mode = modes.iter().find(is).expect("a mode");
            let mut tell = |what: &str, value: f64, within: f64| {
                figures.push((format!("{name} ({m},{n}) {what}"), value, within));
            };
            tell("Hz", mode.frequency_hz, EXACT);
            tell("s", mode.t60, EXACT);
            if at == 0 {
                tell("kg", mode.modal_mass, EXACT);
                tell("m2", mode.radiation, EXACT);
            }
            if at < 2 {
                let [near, far] = heard(&spec, mode.frequency_hz);
                tell("near Pa", near, RENDERED);
                tell("far Pa", far, RENDERED);
            }
        }
    }
    figures
}

#[test]
fn what_is_kept_changes_only_with_the_number_in_the_mark() {
    let _turn = alone();
    let now = figures();
    let mut table = String::new();
    for (what, value, _) in &now {
        let _ = writeln!(table, "    ({what:?}, {value:.9e}),");
    }
    let same = |((what, value, within), (known, expected)): (&(String, f64, f64), &(&str, f64))| {
        what == known && (value / expected - 1.0).abs() < *within
    };
    let unchanged = now.len() == FIGURES.len() && now.iter().zip(&FIGURES).all(same);
    let version = SCHEMA.split('-').next().unwrap_or_default();
    assert!(
        unchanged || version != FIGURES_OF,
        "what caches hold has changed: count the number of `SCHEMA` in engine/src/schema.rs up to {}, and renew FIGURES_OF and \
         FIGURES in this file:\n{table}",
        FIGURES_OF.parse::<u32>().unwrap_or_default() + 1
    );
    assert!(
        unchanged && version == FIGURES_OF,
        "`SCHEMA` in engine/src/schema.rs has the number {version}: renew FIGURES_OF and FIGURES in this file:\n{table}"
    );
}
