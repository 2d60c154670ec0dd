//! Named reference bodies: those with modes in closed form, and those for which figures were published.
//!
//! A claim that is measured on one of them says so. All else is measured on the [standard kit](crate::standard()).

use overhear_engine::cymbal::CymbalSpec;
use overhear_engine::drum::{DrumSpec, HeadContact, HeadSpec};
use overhear_engine::hi_hat::HiHatSpec;
use overhear_engine::hi_hat::warp::WarpSpec;
use overhear_engine::kit_spec::{Defaults, InstrumentSpec, KitSpec, PieceSpec};
use overhear_engine::microphones::CloseSpec;
use overhear_engine::receiver::ReceiverPosition;

use crate::{altered, spec};

/// The plate as a spherical cap, as thick everywhere: diameter (m), mass (kg), rise (m). It is not hammered.
fn cap(cymbal: CymbalSpec, diameter: f64, mass: f64, rise: f64) -> CymbalSpec {
    CymbalSpec { diameter, mass, bow: rise, bell: None, taper: 1.0, hammering: None, rivets: None, ..cymbal }
}

/// A cymbal of the standard kit, renamed, its plate a cap.
fn cap_piece(of: &str, name: &str, size: [f64; 3]) -> PieceSpec {
    let piece = spec(of);
    let [diameter, mass, rise] = size;
    let instrument = match piece.instrument {
        InstrumentSpec::Cymbal(cymbal) => InstrumentSpec::Cymbal(cap(cymbal, diameter, mass, rise)),
        other => other,
    };
    PieceSpec { name: name.to_owned(), instrument, ..piece }
}

/// A 16 in crash as a cap as thick everywhere, without a bell.
pub fn cap_crash() -> PieceSpec {
    cap_piece("crash", "cap-crash", [0.4064, 1.10, 0.020])
}

/// A 20 in ride as a cap.
pub fn cap_ride() -> PieceSpec {
    cap_piece("ride", "cap-ride", [0.5080, 2.50, 0.028])
}

/// A 10 in splash as a cap.
pub fn cap_splash() -> PieceSpec {
    cap_piece("splash", "cap-splash", [0.2540, 0.25, 0.012])
}

/// 14 in hats, both caps.
pub fn cap_hi_hat() -> PieceSpec {
    let piece = spec("hi-hat");
    let instrument = match piece.instrument {
        InstrumentSpec::HiHat(hat) => InstrumentSpec::HiHat(HiHatSpec {
            top: cap(hat.top, 0.3556, 0.95, 0.014),
            bottom: cap(hat.bottom, 0.3556, 1.25, 0.014),
            warp: WarpSpec { rms: 0.0, seed: 0 },
            ..hat
        }),
        other => other,
    };
    PieceSpec { name: "cap-hi-hat".to_owned(), instrument, ..piece }
}

/// A drum as published contacts, landings and glides have it: every stroke presses on its striker's own disc; it is
/// heard from half a metre, without muffling. Its rim does not yield, and its heads are evenly stretched.
fn fixed_disc(of: &str, change: impl FnOnce(DrumSpec) -> DrumSpec) -> PieceSpec {
    let plain = |drum: DrumSpec| DrumSpec {
        contact: HeadContact::FixedDisc,
        edge: None,
        tension_field: None,
        lugs: None,
        ..drum
    };
    let piece = altered(spec(of), |drum| change(plain(drum)));
    let half_a_metre = ReceiverPosition { distance: 0.5, inclination: 0.6, azimuth: 0.4 };
    PieceSpec {
        name: format!("fixed-disc-{of}"),
        close: CloseSpec::beside(half_a_metre),
        defaults: Defaults { muffle: 0.0, ..piece.defaults },
        ..piece
    }
}

/// The kick with a fixed disc, of 55 Hz.
pub fn fixed_disc_kick() -> PieceSpec {
    fixed_disc("kick", |drum| DrumSpec { pitch_hz: 55.0, ..drum })
}

/// The snare with a fixed disc, of 220 Hz, its wires pressed on by 0.15 N.
pub fn fixed_disc_snare() -> PieceSpec {
    let piece = fixed_disc("snare", |drum| DrumSpec { pitch_hz: 220.0, ..drum });
    PieceSpec { defaults: Defaults { preload: Some(0.15), ..piece.defaults }, ..piece }
}

/// The standard kit with the snare and the rack tom of fixed discs.
pub fn fixed_disc_kit() -> KitSpec {
    KitSpec::standard().map(|piece| match piece.name.as_str() {
        "snare" => fixed_disc_snare(),
        "rack-tom" => fixed_disc_rack_tom(),
        _ => piece,
    })
}

/// The rack tom with a fixed disc, of 140 Hz, its modes complete to 3 kHz.
pub fn fixed_disc_rack_tom() -> PieceSpec {
    fixed_disc("rack-tom", |drum| complete_to(3000.0, DrumSpec { pitch_hz: 140.0, ..drum }))
}

/// The floor tom with a fixed disc, of 82 Hz, its modes complete to 1.8 kHz.
pub fn fixed_disc_floor_tom() -> PieceSpec {
    fixed_disc("floor-tom", |drum| complete_to(1800.0, DrumSpec { pitch_hz: 82.0, ..drum }))
}

/// The drum with a batter whose modes are complete to a frequency, Hz.
fn complete_to(modes_to_hz: f64, drum: DrumSpec) -> DrumSpec {
    DrumSpec { batter: HeadSpec { modes_to_hz, ..drum.batter }, ..drum }
}

/// The timpani with a fixed disc.
pub fn fixed_disc_timpani() -> PieceSpec {
    fixed_disc("timpani", |drum| drum)
}
