//! Parts that no piece of the standard kit has.

use overhear_engine::drum::lugs::LugsSpec;
use overhear_engine::drum::spec::ShellSpec;
use overhear_engine::drum::{DrumSpec, HeadSpec};
use overhear_engine::hi_hat::HiHatSpec;
use overhear_engine::kit_spec::{Defaults, InstrumentSpec, PieceSpec};
use overhear_engine::membrane::mesh::MeshSpec;

use crate::Chance;

/// Probability of each part.
const OFTEN: f64 = 0.3;

/// The piece with some more parts, where it is accepted so.
pub fn added(piece: PieceSpec, chance: &mut Chance) -> PieceSpec {
    let more = match piece.instrument {
        InstrumentSpec::Drum(drum) => InstrumentSpec::Drum(more_of_drum(drum, chance)),
        InstrumentSpec::HiHat(hat) => InstrumentSpec::HiHat(more_of_pair(hat, chance)),
        other => other,
    };
    let preload = piece.defaults.preload.filter(|_| more_has_wires(&more));
    let defaults = Defaults { preload, ..piece.defaults };
    let more = PieceSpec { instrument: more, defaults, ..piece.clone() };
    if more.check().is_ok() { more } else { piece }
}

fn more_of_drum(drum: DrumSpec, chance: &mut Chance) -> DrumSpec {
    let [fewest, most] = LugsSpec::COUNT;
    let lugs = chance.happens(OFTEN).then(|| LugsSpec {
        count: fewest + chance.below((most - fewest + 1) as usize) as u32,
        rms: chance.between(0.0, 0.3),
        seed: chance.below(1000) as u32,
    });
    if chance.happens(OFTEN) {
        // Nothing is stretched below a mesh.
        let flow_resistance = 0.5 * 2000.0_f64.powf(chance.unit());
        let mesh = Some(MeshSpec { flow_resistance, open: chance.between(0.05, 0.9) });
        let batter = HeadSpec { mesh, ..drum.batter };
        return DrumSpec { lugs, batter, resonant: None, wires: None, ..drum };
    }
    let closed =
        drum.shell.filter(|shell| drum.resonant.is_some() || matches!(shell, ShellSpec::Kettle { .. }));
    let vented = closed.filter(|_| chance.happens(OFTEN)).map(|shell| {
        // As often between 2 and 4 mm as between 25 and 50.
        let diameter = 0.002 * 25.0_f64.powf(chance.unit());
        shell.vented(Some(diameter))
    });
    DrumSpec { lugs, shell: vented.or(drum.shell), ..drum }
}

fn more_has_wires(instrument: &InstrumentSpec) -> bool {
    matches!(instrument, InstrumentSpec::Drum(DrumSpec { wires: Some(_), .. }))
}

/// A stack of its cymbals, now and then, the lower one as thin and wider.
fn more_of_pair(hat: HiHatSpec, chance: &mut Chance) -> HiHatSpec {
    if !chance.happens(OFTEN) {
        return hat;
    }
    let by = chance.between(1.0, 1.6);
    let mut bottom = hat.bottom;
    (bottom.diameter, bottom.mass, bottom.bow) =
        (by * bottom.diameter, by * by * bottom.mass, by * bottom.bow);
    HiHatSpec { bottom, pressed: Some(0.5 * 400.0_f64.powf(chance.unit())), ..hat }
}
