//! The played instrument: the standard kit, and single pieces of it.

use overhear_engine::drum::DrumSpec;
use overhear_engine::kit::Kit;
use overhear_engine::kit_spec::{InstrumentSpec, KitSpec, PieceBuild, PieceSpec};
use overhear_engine::piece::{BuildContext, BuildOptions, Piece};
use overhear_engine::plate::PlateSpec;
use overhear_engine::slot::Slot;

/// The standard kit.
pub fn standard() -> KitSpec {
    KitSpec::standard()
}

/// Names of its pieces, in the order of their slots.
pub fn names() -> Vec<String> {
    standard().pieces.into_iter().map(|piece| piece.name).collect()
}

/// The slot of a piece of it.
///
/// # Panics
/// If it has no piece of that name.
pub fn slot(name: &str) -> Slot {
    standard().find(name).unwrap_or_else(|| panic!("no `{name}` in the standard kit")).0
}

/// A piece of it.
///
/// # Panics
/// If it has none of that name.
pub fn spec(name: &str) -> PieceSpec {
    standard().find(name).unwrap_or_else(|| panic!("no `{name}` in the standard kit")).1.clone()
}

/// A drum of it.
///
/// # Panics
/// If it has no drum of that name.
pub fn drum(name: &str) -> DrumSpec {
    *spec(name).drum().unwrap_or_else(|| panic!("`{name}` is no drum"))
}

/// The plate of a cymbal.
///
/// # Panics
/// If the piece is none.
pub fn plate(piece: &PieceSpec) -> PlateSpec {
    match &piece.instrument {
        InstrumentSpec::Cymbal(cymbal) => cymbal.plate(),
        _ => panic!("`{}` is no cymbal on a stand", piece.name),
    }
}

/// A piece of the standard kit as it is played, at a sample rate in Hz.
pub fn piece(name: &str, sample_rate: f64) -> Piece {
    build(&spec(name), &BuildOptions::new(sample_rate))
}

/// A piece of the standard kit from which nothing is lost, in its contacts neither, at a sample rate in Hz.
pub fn lossless_piece(name: &str, sample_rate: f64) -> Piece {
    build(&spec(name).lossless(), &BuildOptions::new(sample_rate))
}

/// A piece of the standard kit made perfectly round, at a sample rate in Hz.
pub fn round_piece(name: &str, sample_rate: f64) -> Piece {
    build(&spec(name).round(), &BuildOptions::new(sample_rate))
}

/// A piece alone in its kit, at its close microphone; its controls have the values of its description.
///
/// # Panics
/// If the engine refuses it.
pub fn build(spec: &PieceSpec, options: &BuildOptions) -> Piece {
    let mut piece = Piece::new(Slot::ALL[0], &build_of(spec), options)
        .unwrap_or_else(|refused| panic!("{}: {refused}", spec.name));
    piece.set_muffling(spec.defaults.muffle);
    spec.defaults.preload.into_iter().for_each(|newtons| piece.set_preload(newtons));
    piece.finish_controls();
    piece
}

/// What an instrument of its own is built with, as the piece's would be, at a sample rate in Hz.
pub fn context(spec: &PieceSpec, sample_rate: f64) -> BuildContext {
    build_of(spec).context(BuildOptions::new(sample_rate))
}

/// A kit of one piece, with the microphones and the room of the standard kit.
pub fn alone(spec: &PieceSpec) -> KitSpec {
    KitSpec { pieces: vec![spec.clone()], ..standard() }
}

/// Dependencies of building the only piece of a kit.
fn build_of(spec: &PieceSpec) -> PieceBuild {
    alone(spec).build(Slot::ALL[0]).expect("the only piece")
}

/// A piece with its drum changed; of a cymbal nothing.
pub fn altered(piece: PieceSpec, change: impl FnOnce(DrumSpec) -> DrumSpec) -> PieceSpec {
    let PieceSpec { mut instrument, mut defaults, .. } = piece;
    if let InstrumentSpec::Drum(drum) = &mut instrument {
        *drum = change(*drum);
        defaults.preload = defaults.preload.filter(|_| drum.wires.is_some());
    }
    PieceSpec { instrument, defaults, ..piece }
}

/// The piece of a slot of a kit, to be installed in it, at a sample rate in Hz.
///
/// # Panics
/// If the slot is empty or the engine refuses the piece.
pub fn member(kit: &KitSpec, slot: Slot, sample_rate: f64) -> Piece {
    let build = kit.build(slot).expect("a slot with a piece");
    Piece::new(slot, &build, &BuildOptions::new(sample_rate))
        .unwrap_or_else(|refused| panic!("{}: {refused}", build.spec.name))
}

/// A kit with all its pieces, at a sample rate in Hz.
pub fn kit_of(spec: &KitSpec, sample_rate: f64) -> Kit {
    let mut kit = Kit::new(sample_rate, spec);
    for (slot, _) in spec.slots() {
        assert!(kit.install(Box::new(member(spec, slot, sample_rate))).is_none());
    }
    kit.finish_controls();
    kit
}

/// The standard kit with all its pieces, as the plugin plays it, at a sample rate in Hz.
pub fn kit(sample_rate: f64) -> Kit {
    kit_of(&standard(), sample_rate)
}
