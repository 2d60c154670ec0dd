//! A kit that fills every slot.

use overhear_engine::kit_spec::{KitSpec, PieceSpec, PlaceSpec};
use overhear_engine::slot::SLOTS;
use overhear_measure::standard;

/// How far from the first ones the copies stand, m: a second kit behind the drummer.
const BEHIND: f64 = 2.5;

/// The standard kit, and its first pieces a second time, by other names in other places.
///
/// # Panics
/// If that is no kit.
pub fn sixteen() -> KitSpec {
    let mut kit = standard();
    let copies: Vec<PieceSpec> = kit.pieces.iter().take(SLOTS - kit.pieces.len()).map(copy).collect();
    kit.pieces.extend(copies);
    assert_eq!((kit.pieces.len(), kit.check()), (SLOTS, Ok(())));
    kit
}

fn copy(piece: &PieceSpec) -> PieceSpec {
    let [x, y, z] = piece.place.centre;
    PieceSpec {
        name: format!("{}-2", piece.name),
        title: format!("{} 2", piece.title),
        place: PlaceSpec { centre: [x, y, z - BEHIND], ..piece.place },
        ..piece.clone()
    }
}
