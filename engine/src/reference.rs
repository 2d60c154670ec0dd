//! Bodies that tests measure: those of the standard kit, and named references of which closed forms or published figures
//! are known.

use crate::contact::Material;
use crate::cymbal::spec::CymbalSpec;
use crate::drum::spec::DrumSpec;
use crate::hi_hat::spec::HiHatSpec;
use crate::kit_spec::{InstrumentSpec, KitSpec, PieceBuild};
use crate::plate::PlateSpec;

/// A bronze cap as thick everywhere, without a bell: diameter (m), mass (kg), rise (m).
fn cap(diameter: f64, mass: f64, rise: f64) -> PlateSpec {
    let Material { youngs_modulus, poisson_ratio, density, .. } = Material::BRONZE;
    PlateSpec {
        diameter,
        mass,
        rise,
        bell: None,
        flange: None,
        taper: 1.0,
        youngs_modulus,
        poisson_ratio,
        density,
    }
}

/// A 16 in crash as a cap.
pub(crate) fn cap_crash() -> PlateSpec {
    cap(0.4064, 1.10, 0.020)
}

/// A 20 in ride as a cap.
pub(crate) fn cap_ride() -> PlateSpec {
    cap(0.5080, 2.50, 0.028)
}

/// A 10 in splash as a cap.
pub(crate) fn cap_splash() -> PlateSpec {
    cap(0.2540, 0.25, 0.012)
}

/// A piece of the standard kit with where it is heard from.
pub(crate) fn standard(name: &str) -> PieceBuild {
    let kit = KitSpec::standard();
    let (slot, _) = kit.find(name).unwrap();
    kit.build(slot).unwrap()
}

/// A drum of the standard kit.
pub(crate) fn drum(name: &str) -> DrumSpec {
    *standard(name).spec.drum().unwrap()
}

/// A cymbal of the standard kit.
pub(crate) fn cymbal(name: &str) -> CymbalSpec {
    match standard(name).spec.instrument {
        InstrumentSpec::Cymbal(cymbal) => cymbal,
        other => panic!("{other:?} is no cymbal"),
    }
}

/// The hi-hat of the standard kit.
pub(crate) fn hi_hat() -> HiHatSpec {
    match standard("hi-hat").spec.instrument {
        InstrumentSpec::HiHat(hat) => hat,
        other => panic!("{other:?} is no hi-hat"),
    }
}
