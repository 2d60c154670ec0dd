//! The standard kit: the only default there is.
//!
//! Sizes are those of the trade. Constants that were chosen by comparing with recordings say so (*fitted*).

use std::f64::consts::{PI, TAU};

use crate::build_context::Idealization;
use crate::contact::Material;
use crate::contour::ContourSpec;
use crate::cymbal::FELT_RADIUS;
use crate::cymbal::alloy::Alloy;
use crate::cymbal::hammering::HammeringSpec;
use crate::cymbal::spec::{CymbalSpec, Stand};
use crate::damping::{EdgeSpec, LossLaw, Muffler};
use crate::drum::spec::{DrumSpec, HeadContact, HeadSpec, PitchOf, ResonantSpec, ShellSpec};
use crate::drum::tension_field::TensionFieldSpec;
use crate::fitted;
use crate::hi_hat::rigid::Mount;
use crate::hi_hat::spec::HiHatSpec;
use crate::hi_hat::warp::WarpSpec;
use crate::layout::Point;
use crate::microphones::CloseSpec;
use crate::plate::Bell;
use crate::receiver::ReceiverPosition;
use crate::rim::HoopSpec;
use crate::shell::WallSpec;
use crate::split::Splitting;
use crate::surface::wires::WiresSpec;

use super::piece::{Defaults, InstrumentSpec, PieceSpec, PlaceSpec};
use super::room::RoomSpec;
use super::{KitSpec, MicrophonesSpec};

/// So many inches, m: the number nearest to the exact one.
const fn inches(inches: f64) -> f64 {
    inches * 254.0 / 1e4
}

impl KitSpec {
    /// The standard kit: kick, snare, two toms, crash, ride, splash, timpani, hi-hat.
    pub fn standard() -> KitSpec {
        KitSpec {
            pieces: vec![
                at_a_kick(piece(
                    "kick",
                    "Kick",
                    kick(),
                    ([0.0, 0.30, -0.23], [0.0, 0.0, -1.0]),
                    (0.15, 0.0, 0.0),
                )),
                PieceSpec {
                    defaults: Defaults {
                        muffle: 0.0,
                        level_db: 0.0,
                        pan: -0.35,
                        preload: Some(fitted::SNARE_PRELOAD),
                    },
                    ..piece(
                        "snare",
                        "Snare",
                        snare(),
                        ([-0.40, 0.66, -0.40], [0.0, 0.97, -0.24]),
                        (0.0, 0.0, 0.0),
                    )
                },
                piece(
                    "rack-tom",
                    "Rack tom",
                    rack_tom(),
                    ([-0.14, 0.88, -0.12], [0.15, 0.85, -0.5]),
                    (0.0, -2.0, -0.12),
                ),
                piece(
                    "floor-tom",
                    "Floor tom",
                    floor_tom(),
                    ([0.47, 0.62, -0.34], [0.0, 1.0, 0.0]),
                    (0.0, -3.0, 0.41),
                ),
                piece(
                    "crash",
                    "Crash",
                    crash(),
                    ([-0.64, 1.20, 0.0], [0.22, 0.95, -0.25]),
                    (0.0, 2.5, -0.56),
                ),
                from_above(piece(
                    "ride",
                    "Ride",
                    ride(),
                    ([0.68, 1.06, -0.04], [-0.16, 0.96, -0.22]),
                    (0.0, 1.5, 0.60),
                )),
                piece(
                    "splash",
                    "Splash",
                    splash(),
                    ([0.16, 1.22, 0.08], [0.0, 0.97, -0.25]),
                    (0.0, -2.0, 0.14),
                ),
                // Beyond the floor tom, a turn of the stool away.
                piece(
                    "timpani",
                    "Timpani",
                    timpani(),
                    ([0.86, 0.78, -0.86], [-0.1, 0.99, -0.05]),
                    (0.0, 0.0, 0.70),
                ),
                piece(
                    "hi-hat",
                    "Hi-hat",
                    hi_hat(),
                    ([-0.72, 0.86, -0.30], [0.0, 1.0, 0.0]),
                    (0.0, -0.5, -0.63),
                ),
            ],
            microphones: MicrophonesSpec {
                // A spaced pair, both 1.33 m from the snare, so it stands in the middle.
                overheads: [[-0.85, 1.90, -0.20], [0.45, 1.68, -0.50]],
                room: [[-1.2, 1.6, 2.8], [1.2, 1.6, 2.8]],
            },
            room: RoomSpec::STANDARD,
        }
    }
}

/// A piece of the kit: its centre (m) and where it faces; muffling, level (dB, *fitted* to the balance of five mixed recordings, `docs/realism.md`) and pan.
fn piece(
    name: &str,
    title: &str,
    instrument: InstrumentSpec,
    (centre, facing): (Point, Point),
    (muffle, level_db, pan): (f64, f64, f64),
) -> PieceSpec {
    let timpani = ReceiverPosition { distance: 0.5, inclination: 0.6, azimuth: 0.4 };
    let close = match &instrument {
        InstrumentSpec::Drum(DrumSpec { shell: Some(ShellSpec::Cylinder { .. }), .. }) => CloseSpec::OVER_RIM,
        InstrumentSpec::Drum(_) => CloseSpec::beside(timpani),
        _ => CloseSpec::beside(beside_a_cymbal(fitted::CYMBAL_CLOSE_INCLINATION)),
    };
    PieceSpec {
        name: name.to_owned(),
        title: title.to_owned(),
        instrument,
        place: PlaceSpec { centre, facing },
        close,
        defaults: Defaults { muffle, level_db, pan, preload: None },
        ideal: Idealization::NONE,
    }
}

/// A point half a metre from a cymbal, beside it and above its plane, out of the player's way; its angle from the axis, rad.
const fn beside_a_cymbal(inclination: f64) -> ReceiverPosition {
    ReceiverPosition { distance: 0.5, inclination, azimuth: fitted::CYMBAL_CLOSE_AZIMUTH }
}

/// The piece, its close microphone higher over it, where those of rides hear the stick.
fn from_above(piece: PieceSpec) -> PieceSpec {
    PieceSpec { close: CloseSpec::beside(beside_a_cymbal(fitted::SPOT_INCLINATION)), ..piece }
}

/// The piece, its close microphone as far from the head as those of kicks stand, and with their contour.
fn at_a_kick(piece: PieceSpec) -> PieceSpec {
    let close = CloseSpec::OverRim {
        height: fitted::KICK_CLOSE_HEIGHT,
        azimuth: fitted::OVER_RIM_AZIMUTH,
        gain: fitted::KICK_CLOSE_GAIN,
        contour: Some(ContourSpec::KICK),
    };
    PieceSpec { close, ..piece }
}

/// Modes of a struck head reach this far; above, single modes can no longer be told apart. Hz.
const BATTER_MODES_TO: f64 = 3000.0;

/// The same of a kick, Hz, on whose heads a pillow lies: six modes lie within the half-power width of one here, and two from 0.5 kHz on. *Judgement*: an
/// end at 1 or 1.5 kHz changes the attack.
const KICK_MODES_TO: f64 = 2000.0;

/// The same of a floor tom, Hz: from here on two modes of the drum lie within the half-power width of one. *Derived* from their density, 0.5
/// per hertz, and their decay; that both heads count is *judgement*, of the struck one alone two do from 1.9 kHz on. A rack tom's would reach
/// to 2 kHz by this rule; its end is [fitted](fitted::RACK_TOM_MODES_TO).
const FLOOR_TOM_MODES_TO: f64 = 1200.0;

/// What a pillow takes from the air that goes past it, 1/s: `r / (2 rho)` of all the air if none could go around
/// it, with the flow resistivity `r` of polyester filling, 850 Pa s/m2 at 12 kg/m3 (*literature*: Garai & Pompoli,
/// Applied Acoustics 66, 2005); and a third of that, for at 60 Hz so much of the flow finds the way around a
/// pillow of a third of the shell's width. *Derived*.
const PILLOW_FLOW: f64 = 0.35 * 850.0 / (2.0 * crate::air_load::DENSITY);

/// A head of film: thickness (m), plies, losses.
fn film(thickness: f64, plies: u32, loss: LossLaw) -> HeadSpec {
    HeadSpec {
        thickness,
        plies,
        material: Material::FILM,
        loss,
        modes_to_hz: BATTER_MODES_TO,
        dot: None,
        mesh: None,
    }
}

/// A clear single-ply head.
fn single_ply(pitch_ratio: f64, modes_to_hz: f64) -> ResonantSpec {
    let HeadSpec { thickness, plies, material, loss, .. } = film(0.19e-3, 1, LossLaw::SINGLE_PLY);
    ResonantSpec {
        pitch_ratio,
        thickness,
        plies,
        material,
        loss,
        modes_to_hz,
        port_diameter: None,
        dot: None,
    }
}

/// Losses of films. *Fitted* within the literature's 2 to 12 1/s per kHz; what the [edge](EDGE) takes is not among them.
/// The kick's constant part is the felt strip and what else leans on its head.
const KICK_LOSS: LossLaw =
    LossLaw { constant: fitted::KICK_BATTER_LOSS, per_khz: fitted::TWO_PLY_LOSS_PER_KHZ };
const TOM_LOSS: LossLaw =
    LossLaw { constant: LossLaw::SINGLE_PLY.constant, per_khz: fitted::TWO_PLY_LOSS_PER_KHZ };
const SNARE_LOSS: LossLaw =
    LossLaw { constant: fitted::SNARE_BATTER_LOSS, per_khz: fitted::SNARE_BATTER_LOSS_PER_KHZ };
const SNARE_SIDE_LOSS: LossLaw =
    LossLaw { constant: fitted::SNARE_SIDE_LOSS, per_khz: fitted::SNARE_SIDE_LOSS_PER_KHZ };

/// A triple-flanged steel hoop, 2.3 mm thick and 40 mm high (*literature*: dimensions of the trade); quality factors, and the
/// drum's mass and frequency on its stand, *by ear*.
const HOOP: HoopSpec = HoopSpec {
    material: Material::STEEL,
    wall: 2.3e-3,
    height: 0.040,
    flange: 0.010,
    q: fitted::HOOP_Q,
    drum_mass: fitted::DRUM_MASS,
    stand_hz: fitted::DRUM_STAND_HZ,
    stand_q: fitted::DRUM_STAND_Q,
};

/// A wall of maple or birch plies, 6 mm (*trade sizes*); plies along and across the grain (*literature*: 11 and 0.9 GPa, two thirds
/// along). The quality factor is that of wood (*literature*: 50 to 100), less what lugs and edges take (*judgement*).
const WALL: WallSpec = WallSpec {
    material: Material { youngs_modulus: 7.6e9, poisson_ratio: 0.3, density: 680.0 },
    thickness: 6e-3,
    q: 40.0,
};

/// A shell of that size (in) with a batter and a resonant head: pitch, lowest and highest, Hz.
fn two_headed(
    [diameter_in, depth_in]: [f64; 2],
    batter: HeadSpec,
    resonant: ResonantSpec,
    [lowest_pitch_hz, pitch_hz, highest_pitch_hz]: [f64; 3],
) -> DrumSpec {
    DrumSpec {
        diameter: inches(diameter_in),
        pitch_hz,
        lowest_pitch_hz,
        highest_pitch_hz,
        pitch_of: PitchOf::BatterAlone,
        batter,
        resonant: Some(resonant),
        shell: Some(ShellSpec::Cylinder {
            depth: inches(depth_in),
            air_q: fitted::AIR_Q,
            vent_diameter: None,
            wall: Some(WALL),
        }),
        edge: Some(EDGE),
        hoop: None,
        wires: None,
        muffler: Muffler::GEL,
        evenness: Splitting::DRUM,
        tension_field: Some(UNEVEN),
        lugs: None,
        contact: HeadContact::Wraps,
        high_band: true,
    }
}

/// What carries heads on toms and bass drums: collar, bearing edge, hoop and shell. *Fitted*.
const EDGE: EdgeSpec =
    EdgeSpec { resistance: fitted::EDGE_RESISTANCE, corner_hz: fitted::EDGE_CORNER_HZ, mount: 0.0 };

/// The same of toms, on their mounts and legs. *Fitted*. A rigid floor tom of 5 kg on a
/// mount that takes the most, a dashpot of `omega M`, would lose 1.6 1/s of its (0,1) and 0.5 of its (1,1).
const TOM_EDGE: EdgeSpec = EdgeSpec { mount: fitted::TOM_MOUNT_LOSS, ..EDGE };

/// On snare drums, whose shells are short and whose hoops stiff. *Fitted*.
const SNARE_EDGE: EdgeSpec = EdgeSpec { resistance: fitted::SNARE_EDGE_RESISTANCE, ..EDGE };

/// How uneven heads are: tension by lugs that are a few cents apart, film, collar. *Fitted*.
const UNEVEN: TensionFieldSpec =
    TensionFieldSpec { rms: fitted::TENSION_RMS, correlation: fitted::TENSION_CORRELATION, seed: 1 };

/// The corner of the filling of a pillow: a quarter wave in 0.1 m of filling in which waves go at some 50 m/s. *Judgement*.
const PILLOW_CORNER: f64 = 125.0;

/// A port in the front head, m (*trade sizes*: 4 to 6 in).
const PORT: f64 = inches(5.0);

/// 22 x 18 in bass drum with a pillow and a port, heard at 50 Hz, as recorded ones are. Its pitch is *fitted*.
fn kick() -> InstrumentSpec {
    let drum = two_headed(
        [22.0, 18.0],
        film(0.36e-3, 2, KICK_LOSS),
        single_ply(1.10, 1000.0),
        [35.0, fitted::KICK_PITCH_HZ, 90.0],
    );
    let muffler =
        Muffler::Pillow { sigma: fitted::PILLOW_SIGMA, corner_hz: PILLOW_CORNER, flow: PILLOW_FLOW };
    let batter = HeadSpec { modes_to_hz: KICK_MODES_TO, ..drum.batter };
    let resonant = drum.resonant.map(|head| ResonantSpec { port_diameter: Some(PORT), ..head });
    InstrumentSpec::Drum(DrumSpec { batter, muffler, resonant, ..drum })
}

/// 14 x 5.5 in snare drum. Its pitch is *fitted*: with the resonant head and the air between it is heard at 222 Hz, as recorded
/// ones are. Twenty strands of 1 g: steel wire of half a
/// millimetre in coils of 2.3 mm, 2.4 mm apart (*derived*: 3.7 g/m). They hold 2 N each at the default preload, as their coils do when they
/// are drawn out by some millimetres (*by judgement*: strainers differ), over a bed 10 cm wide (*judgement*). Air alone would leave a Q
/// of a thousand; cords and coils take more (*by judgement*).
fn snare() -> InstrumentSpec {
    let thin = single_ply(1.50, BATTER_MODES_TO);
    let side = ResonantSpec { thickness: 0.076e-3, loss: SNARE_SIDE_LOSS, ..thin };
    let drum =
        two_headed([14.0, 5.5], film(0.25e-3, 1, SNARE_LOSS), side, [140.0, fitted::SNARE_PITCH_HZ, 360.0]);
    let wires = WiresSpec {
        mass: 20e-3,
        bend: 0.002,
        bed: 0.1,
        q: 100.0,
        radius: 0.8e-3,
        material: Material::STEEL,
        restitution: 0.35,
    };
    InstrumentSpec::Drum(DrumSpec {
        wires: Some(wires),
        hoop: Some(HOOP),
        edge: Some(SNARE_EDGE),
        tension_field: Some(TensionFieldSpec { seed: 2, ..UNEVEN }),
        ..drum
    })
}

/// A tom: two-ply batter whose modes reach up to `modes_to_hz`, single-ply resonant head.
fn tom(size_in: [f64; 2], pitches: [f64; 3], modes_to_hz: f64, seed: u32) -> InstrumentSpec {
    let drum = two_headed(size_in, film(0.36e-3, 2, TOM_LOSS), single_ply(1.15, 2500.0), pitches);
    let tension_field = Some(TensionFieldSpec { seed, ..UNEVEN });
    let batter = HeadSpec { modes_to_hz, ..drum.batter };
    InstrumentSpec::Drum(DrumSpec { batter, hoop: Some(HOOP), edge: Some(TOM_EDGE), tension_field, ..drum })
}

/// 12 x 9 in rack tom, heard at 127 Hz, as recorded ones are. *Fitted*.
fn rack_tom() -> InstrumentSpec {
    tom([12.0, 9.0], [80.0, fitted::RACK_TOM_PITCH_HZ, 225.0], fitted::RACK_TOM_MODES_TO, 3)
}

/// 16 x 16 in floor tom, heard at 72 Hz, as recorded ones are. *Fitted*.
fn floor_tom() -> InstrumentSpec {
    tom([16.0, 16.0], [55.0, fitted::FLOOR_TOM_PITCH_HZ, 145.0], FLOOR_TOM_MODES_TO, 4)
}

/// 26 in timpani on a kettle of 0.14 m3.
fn timpani() -> InstrumentSpec {
    let batter = film(0.19e-3, 1, LossLaw { constant: 0.6, per_khz: 1.5 });
    let drum = two_headed([26.0, 10.0], batter, single_ply(1.0, 100.0), [87.3, 130.8, 196.0]);
    InstrumentSpec::Drum(DrumSpec {
        resonant: None,
        shell: Some(ShellSpec::Kettle { volume: 0.14, air_q: fitted::AIR_Q, vent_diameter: None }),
        pitch_of: PitchOf::PrincipalHeard,
        evenness: Splitting::CLEARED,
        edge: None,
        tension_field: None,
        lugs: None,
        ..drum
    })
}

/// A bronze cymbal of a diameter (in) and mass (kg): the rise of its bow, its bell's radius and rise, m. *Fitted*: shapes chosen by
/// how near to recordings they sound among some dozen tried for each; as a cap, as thick everywhere, a crash has 67 % of
/// its figures in the mix as recordings have them, a splash 61 %, with these 83 and 89.
fn bronze(diameter_in: f64, mass: f64, bow: f64, (radius, rise): (f64, f64)) -> CymbalSpec {
    CymbalSpec {
        diameter: inches(diameter_in),
        mass,
        bow,
        bell: Some(Bell { radius, rise }),
        flange: None,
        taper: fitted::CYMBAL_TAPER,
        alloy: Alloy::BRONZE,
        loss: LossLaw::BRONZE,
        stand: Some(stand(inches(diameter_in) / 2.0, bow + rise)),
        // A strip of tape near the edge. *By ear*.
        muffler: Muffler::Gel { sigma: fitted::CYMBAL_TAPE_SIGMA, radius: 0.85, angle: 2.3 },
        evenness: Splitting::CYMBAL,
        hammering: None,
        rivets: None,
    }
}

/// Acceleration of free fall, m/s2.
const GRAVITY: f64 = 9.81;

/// Radius of the edge of the felt that a cymbal rests on, m. *Trade sizes*: 35 to 40 mm wide.
const FELT_EDGE: f64 = 0.018;

/// Tilt of a loud stroke, rad.
const LOUD_TILT: f64 = 0.2;

/// The stand of a cymbal of a radius and a height, m, whose nut is loose.
///
/// *Derived*: the felts give by less than a millimetre under the plate, so a tilt of more than some hundredths of a radian stands on
/// the felt's edge, with the moment `M g f` at every tilt `t`; of one frequency with it at that amplitude is the stiffness
/// `4 M g f / (pi t)`. The plate, with the moment of inertia `M R^2 / 4`, hangs below by half its height. The bounce and the
/// qualities are *assumed*: a crash that is let go rocks some times.
fn stand(radius: f64, height: f64) -> Stand {
    let edge = 4.0 * FELT_EDGE / (PI * LOUD_TILT);
    let rock_hz = (GRAVITY * (edge + 0.5 * height) * 4.0 / (radius * radius)).sqrt() / TAU;
    // As files have it.
    Stand { bounce_hz: 20.0, rock_hz: (10.0 * rock_hz).round() / 10.0, q: 3.0, rock_q: 6.0 }
}

/// The clutch of a hi-hat whose upper cymbal has a radius and a height, m.
///
/// *Derived*: players leave it loose, so that the cymbal lies on the lower felt by its weight and swings. The felt gives as that of a
/// stand does, `k = M w^2` at its bounce; it is a ring of the radius `f`, so that a tilt `t` has the moment `k f^2 / 2 t`, and the
/// cymbal hangs below by half its height. Struck hats tilt by less than the felt is pressed in, 0.6 mm over its radius. The bounce
/// here is that of a rod that pushes the cymbal down through both felts, *by ear*, the rock's quality that of a stand.
fn clutch(radius: f64, height: f64) -> Mount {
    let loose = stand(radius, height);
    let felt = (TAU * loose.bounce_hz * FELT_RADIUS).powi(2) / 2.0;
    let rock_hz = ((felt + 0.5 * GRAVITY * height) * 4.0 / (radius * radius)).sqrt() / TAU;
    Mount {
        bounce_hz: 60.0,
        rock_hz: (10.0 * rock_hz).round() / 10.0,
        q: 2.0,
        rock_q: Some(loose.rock_q),
        damping: 0.5,
        reach: 0.08,
    }
}

/// A cymbal hammered in its own way.
fn hammered(cymbal: CymbalSpec, seed: u32) -> InstrumentSpec {
    let hammering =
        HammeringSpec { rms: fitted::HAMMERING_RMS, correlation: fitted::HAMMERING_CORRELATION, seed };
    InstrumentSpec::Cymbal(CymbalSpec { hammering: Some(hammering), ..cymbal })
}

/// A 16 in crash.
fn crash() -> InstrumentSpec {
    hammered(bronze(16.0, 1.10, fitted::CRASH_BOW, (fitted::CRASH_BELL_RADIUS, fitted::CRASH_BELL_RISE)), 1)
}

/// A 20 in ride.
fn ride() -> InstrumentSpec {
    let bell = (fitted::RIDE_BELL_RADIUS, fitted::RIDE_BELL_RISE);
    hammered(bronze(20.0, fitted::RIDE_MASS, fitted::RIDE_BOW, bell), 2)
}

/// A 10 in splash.
fn splash() -> InstrumentSpec {
    let bell = (fitted::SPLASH_BELL_RADIUS, fitted::SPLASH_BELL_RISE);
    hammered(bronze(10.0, 0.25, fitted::SPLASH_BOW, bell), 3)
}

/// 14 in hats.
fn hi_hat() -> InstrumentSpec {
    let half = |mass, seed| CymbalSpec {
        // *Fitted*: with it open ones decay within a quarter as recordings of them do, 3.3 to 2.5 s.
        loss: LossLaw { constant: fitted::HAT_LOSS, per_khz: fitted::HAT_LOSS_PER_KHZ },
        stand: None,
        evenness: Splitting { seed, ..Splitting::CYMBAL },
        ..bronze(14.0, mass, fitted::HAT_BOW, (fitted::HAT_BELL_RADIUS, fitted::HAT_BELL_RISE))
    };
    InstrumentSpec::HiHat(HiHatSpec {
        top: half(0.95, 5),
        bottom: half(1.25, 6),
        pressed: None,
        clutch: clutch(inches(14.0) / 2.0, fitted::HAT_BOW + fitted::HAT_BELL_RISE),
        seat: Mount { bounce_hz: 50.0, rock_hz: 12.0, q: 2.0, rock_q: None, damping: 0.5, reach: 0.12 },
        tilt: 0.009,
        toward: 2.0,
        edge: 1e-3,
        // *Fitted*, the seed too: of seven pairs the one whose closed sound has the fewest lines.
        warp: WarpSpec { rms: fitted::HAT_WARP, seed: 6 },
        // Bronze as it gives where two rims touch at their highest spots: softer than smooth edges, of 110 GPa.
        rim: Material { youngs_modulus: fitted::HAT_RIM_MODULUS, ..Material::BRONZE },
        // *Judgement*: metals that meet at a metre per second part with about half of it. Scores are the same from 0.3 to 0.6.
        restitution: 0.5,
        // *Fitted*: with it closed ones decay within a third as recordings of them do, 0.43 to 0.27 s.
        rubbing: LossLaw { constant: fitted::HAT_RUBBING, per_khz: fitted::HAT_RUBBING_PER_KHZ },
        half_rubbing: 25.0,
        lasting: 0.02,
    })
}
