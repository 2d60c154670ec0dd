//! A cymbal: a domed plate with a bell on a stand, struck and heard.
//!
//! Model: the shell modes of the plate, up to the edge of hearing, and the plate's rigid motions on its
//! stand, a bounce and a rock. Bent by more than its thickness the plate stretches, which couples the
//! modes up to a frequency that the quality chooses ([`VonKarman`]); above, they stay linear. The
//! rigid motions are too slow to be heard. The plate stands in free air ([`FreeDisc`]).

use std::f64::consts::TAU;

use overhear_kept::{Kept, Shared};
use serde::{Deserialize, Serialize};

use crate::air;
use crate::build_context::BuildContext;
use crate::damping::{LossLaw, Muffler, SIGMA_T60, Thermoelastic};
use crate::error::SpecError;
use crate::fitted;
use crate::glide::Glide;
use crate::instrument::Instrument;
use crate::listening::Radiator;
use crate::modal::Mode;
use crate::mode::Member;
use crate::mode::ModeInfo;
use crate::mode::ModeKind;
use crate::plate::free_disc::{FreeDisc, Radiated};
use crate::plate::{PlateModes, PlateSpec, PlateTables};
use crate::receiver::Receivers;
use crate::schema::MARK;
use crate::shapes::{ShapeIndex, ShapeTable};
use crate::split::Splitting;
use crate::surface::{Surface, SurfaceParts};
use crate::von_karman::{CoupledPair, VonKarman};

pub mod spec;

pub use spec::{CymbalSpec, Stand};

/// A hand that grips the edge on the player's side, thumb above and fingers below.
pub(crate) struct Hand;

impl Hand {
    /// Decay rate of a mode of unit mean square in the palm, 1/s. *By ear*: a choked crash is gone in
    /// a fifth of a second.
    const SIGMA: f64 = fitted::HAND_SIGMA;
    /// Where the palm lies: shares of the radius, rad.
    const RADII: [f64; 3] = [0.8, 0.9, 0.98];
    const ANGLES: [f64; 5] = [-0.24, -0.12, 0.0, 0.12, 0.24];
    /// A hand closes so many times more slowly than a control glides: in some 25 ms.
    pub(crate) const SLOWER: f64 = 5.0;

    /// Dashpots all over the palm: decay rate of a mode of unit square shape there (1/s), radius and angle.
    pub(crate) fn places() -> impl Iterator<Item = (f64, f64, f64)> {
        let share = Hand::SIGMA / (Hand::RADII.len() * Hand::ANGLES.len()) as f64;
        Hand::RADII.into_iter().flat_map(move |radius| Hand::ANGLES.map(|angle| (share, radius, angle)))
    }
}

/// Rate at which the stretching is evaluated, Hz, over the highest coupled mode, and at most, as long as it is
/// five times that. *Converged*: at seven times, third octaves of a hard stroke are within 0.4 dB in the mean of
/// those with every sample; a stroke a millimetre beside changes them by more.
const COUPLING_RATE_PER_HZ: f64 = 7.0;
const MOST_COUPLING_RATE: f64 = 20_000.0;

/// Samples between evaluations of the stretching of modes up to `highest_hz`.
pub(crate) fn coupling_stride(highest_hz: f64, sample_rate: f64) -> u32 {
    let rate = (COUPLING_RATE_PER_HZ * highest_hz).min(MOST_COUPLING_RATE).max(5.0 * highest_hz);
    (sample_rate / rate) as u32
}

/// Share of the sample rate that coupled modes may reach.
pub(crate) const COUPLED_SHARE_OF_RATE: f64 = 0.3;

/// Highest mode, Hz: the edge of hearing. The same at every rate that can carry it, so that a
/// stroke meets the same body.
pub(crate) const LIMIT_HZ: f64 = 21_000.0;

/// Share of the sample rate that modes may reach.
pub(crate) const LIMIT_OF_RATE: f64 = 0.48;

/// One mode of the body, as built.
#[derive(Debug, Clone, Copy)]
struct BuiltMode {
    m: u32,
    n: u32,
    kind: ModeKind,
    /// Undamped angular frequency at tuning 1, with the member's detuning, rad/s.
    omega: f64,
    /// Radiation resistance over twice the mass at tuning 1, 1/s.
    radiated: f64,
    /// Decay rate at full muffling, 1/s.
    muffling: f64,
    /// Decay rate in a firm hand, 1/s.
    choking: f64,
    /// Area of the monopole that would radiate its power, m2.
    monopole_area: f64,
}

/// A cymbal that can be struck.
pub struct Cymbal {
    surface: Surface,
    modes: Vec<BuiltMode>,
    loss: LossLaw,
    heat: Thermoelastic,
    stand: Stand,
    mass: f64,
    lossless: bool,
    tuning: Glide,
    muffling: Glide,
    /// How firmly a hand holds it, 0 to 1.
    hand: Glide,
    /// Whether a control has moved since the modes last followed.
    stale: bool,
}

impl Cymbal {
    /// Builds a cymbal. Allocates; takes some tenths of a second.
    ///
    /// # Errors
    /// [`SpecError`] if a number is out of range.
    pub fn new(spec: &CymbalSpec, context: &BuildContext) -> Result<Cymbal, SpecError> {
        spec.check()?;
        let stand = spec.stand.ok_or_else(|| SpecError::refused("stand", "is missing, accepted: a stand"))?;
        let BuildContext { options, receivers, ideal } = context;
        let limit_hz = LIMIT_HZ.min(LIMIT_OF_RATE * options.sample_rate);
        let known = SoundingPlate::of(spec, receivers, limit_hz)?;
        let known = &*known;
        let plate = &known.plate;
        let (orders, extent) = plate.table_extent(limit_hz);
        let tables = PlateTables::new(orders, extent);
        let splitting = if ideal.round { Splitting::ROUND } else { spec.evenness };
        let (modes, index) = lay_out(spec, &stand, known, splitting);
        let bare = |mode: &BuiltMode| Mode { omega: mode.omega, sigma: 0.0, mass: spec.mass };
        let coupled = couple(plate, &tables, &index, context);
        let mut surface = Surface::new(SurfaceParts {
            modes: modes.iter().map(bare).collect(),
            shapes: ShapeTable::new(&radial_rows(plate, &tables, &ShapeTable::radii()), index),
            transfer: vec![[0.0; 2]; modes.len()],
            material: spec.alloy,
            lossless: ideal.lossless,
            sample_rate: options.sample_rate,
        });
        let ears = [0, 1].map(|ear| transfer(spec, receivers, known, ear).into_iter());
        let ([near, far], away) = (ears, receivers.far.distance);
        surface.set_transfers(near, far.map(|transfer| transfer.map(|h| h * away)));
        if let Some(Coupled { potential, modes, highest_hz }) = coupled {
            let stride = coupling_stride(highest_hz, options.sample_rate);
            surface.set_potential(Box::new(potential), modes, stride);
        }
        let (low, tuning, high) = CymbalSpec::TUNING;
        let mut cymbal = Cymbal {
            surface,
            modes,
            loss: spec.loss,
            heat: Thermoelastic::bronze(&spec.plate()),
            stand,
            mass: spec.mass,
            lossless: ideal.lossless,
            tuning: Glide::new(tuning, low, high),
            muffling: Glide::new(0.0, 0.0, 1.0),
            hand: Glide::new(0.0, 0.0, 1.0),
            stale: true,
        };
        cymbal.lay_muffler(spec);
        cymbal.lay_hand();
        cymbal.follow_controls();
        Ok(cymbal)
    }

    /// Works out how much the muffler takes from each mode.
    fn lay_muffler(&mut self, spec: &CymbalSpec) {
        let mut shape = vec![1.0_f32; self.modes.len()];
        let full = match spec.muffler {
            Muffler::Pillow { sigma, .. } | Muffler::Ring { sigma, .. } => sigma,
            Muffler::Gel { sigma, radius, angle } => {
                self.surface.shapes().fill(radius, angle, &mut shape);
                sigma
            }
        };
        for (mode, shape) in self.modes.iter_mut().zip(shape) {
            mode.muffling = full * f64::from(shape).powi(2);
        }
    }

    /// Works out how much a hand takes from each mode: dashpots all over the palm.
    fn lay_hand(&mut self) {
        let mut shape = vec![0.0_f32; self.modes.len()];
        for (share, radius, angle) in Hand::places() {
            self.surface.shapes().fill(radius, angle, &mut shape);
            for (mode, &shape) in self.modes.iter_mut().zip(&shape) {
                mode.choking += share * f64::from(shape).powi(2);
            }
        }
    }
}

impl Instrument for Cymbal {
    fn surface(&self) -> &Surface {
        &self.surface
    }

    fn surface_mut(&mut self) -> &mut Surface {
        &mut self.surface
    }

    fn set_tuning(&mut self, ratio: f64) {
        self.tuning.set(ratio);
    }

    fn set_muffling(&mut self, amount: f64) {
        self.muffling.set(amount);
    }

    fn choke(&mut self, strength: f64) {
        self.hand.set(strength);
    }

    fn advance_controls(&mut self, seconds: f64) {
        let moved = [&mut self.tuning, &mut self.muffling].map(|glide| glide.advance(seconds));
        self.stale |= moved.contains(&true) | self.hand.advance(seconds / Hand::SLOWER);
    }

    fn follow_controls(&mut self) {
        if !std::mem::take(&mut self.stale) {
            return;
        }
        let (tuning, muffling, hand) = (self.tuning.value(), self.muffling.value(), self.hand.value());
        let (modes, loss, heat, stand, lossless) =
            (&self.modes, self.loss, self.heat, self.stand, self.lossless);
        self.surface.retune(|k, old| {
            let built = &modes[k];
            let omega = match built.kind {
                ModeKind::Rigid => built.omega,
                _ => built.omega * tuning,
            };
            let own = match built.kind {
                ModeKind::Rigid => omega / (2.0 * stand.q),
                _ => loss.sigma(omega) + heat.sigma(omega) + built.radiated,
            };
            let sigma = if lossless { 0.0 } else { own + muffling * built.muffling + hand * built.choking };
            Mode { omega, sigma, ..*old }
        });
        // A stiffer metal resists stretching as it resists bending.
        if let Some(force) = self.surface.beyond_mut() {
            force.set_stiffness(tuning * tuning);
        }
    }

    fn finish_controls(&mut self) {
        let moved = [&mut self.tuning, &mut self.muffling, &mut self.hand].map(Glide::jump);
        self.stale |= moved.contains(&true);
        self.follow_controls();
    }

    fn modes(&self) -> Vec<ModeInfo> {
        let rows = self.surface.body().modes().iter().zip(self.surface.shapes().index()).zip(&self.modes);
        rows.map(|((mode, shape), built)| ModeInfo {
            body: if built.kind == ModeKind::Rigid { "stand" } else { "plate" },
            m: built.m,
            n: built.n,
            member: shape.member,
            frequency_hz: mode.omega_d() / TAU,
            t60: SIGMA_T60 / mode.sigma,
            modal_mass: self.mass,
            radiation: built.monopole_area,
            kind: built.kind,
        })
        .collect()
    }
}

/// The stretching, and the modes of the body it acts on.
struct Coupled {
    potential: VonKarman,
    modes: usize,
    highest_hz: f64,
}

/// Couples the plate's modes as far up as the options say, unless they say not at all.
fn couple(
    plate: &PlateModes,
    tables: &PlateTables,
    index: &[ShapeIndex],
    context: &BuildContext,
) -> Option<Coupled> {
    let BuildContext { options, ideal, .. } = context;
    if ideal.linear {
        return None;
    }
    let asked_hz = options.quality.coupled_hz().min(COUPLED_SHARE_OF_RATE * options.sample_rate);
    let highest_hz = VonKarman::reach(plate, asked_hz);
    let inside = |mode: &ShapeIndex| {
        let shell = mode.radial.checked_sub(RIGID.len())?;
        (plate.shells[shell].omega <= TAU * highest_hz).then_some(shell)
    };
    let members = index.iter().enumerate().filter_map(|(mode, shape)| {
        let shell = inside(shape)?;
        (shape.member == Member::Cosine).then_some(CoupledPair { shell, mode, axis: shape.axis })
    });
    let pairs: Vec<CoupledPair> = members.collect();
    let last = pairs.last()?;
    let modes = last.mode + if plate.shells[last.shell].m == 0 { 1 } else { 2 };
    Some(Coupled { potential: VonKarman::new(plate, tables, &pairs), modes, highest_hz })
}

/// The rigid motions: order, and radial shape at `r`, of unit mean square over the disc.
const RIGID: [RigidMotion; 2] = [(0, |_| 1.0), (1, |r| 2.0 * r)];

type RigidMotion = (u32, fn(f64) -> f64);

/// The modes of the body: the rigid ones, then the shell's by frequency; and how each goes around.
fn lay_out(
    spec: &CymbalSpec,
    stand: &Stand,
    SoundingPlate { plate, radiated }: &SoundingPlate,
    splitting: Splitting,
) -> (Vec<BuiltMode>, Vec<ShapeIndex>) {
    let (mut modes, mut index) = (Vec::new(), Vec::new());
    let rigid = [stand.bounce_hz, stand.rock_hz].map(|hz| TAU * hz);
    for (radial, ((m, _), omega)) in RIGID.into_iter().zip(rigid).enumerate() {
        let built = BuiltMode {
            m,
            n: 0,
            kind: ModeKind::Rigid,
            omega,
            radiated: 0.0,
            muffling: 0.0,
            choking: 0.0,
            monopole_area: 0.0,
        };
        for (member, _) in Splitting::ROUND.members(m, 0) {
            modes.push(built);
            index.push(ShapeIndex { radial, rows: 1, m, member, axis: 0.0 });
        }
    }
    for ((row, shell), &Radiated { resistance, .. }) in plate.shells.iter().enumerate().zip(radiated) {
        // Both faces are in the resistance, one in the area.
        let radius = spec.plate().radius();
        let unit = air::DENSITY * shell.omega * radius.powi(3);
        let monopole_area = air::monopole_area(radius, 0.5 * resistance / unit, shell.omega);
        let axis = spec.evenness.axis(shell.m, shell.n);
        for (member, detuning) in splitting.members(shell.m, shell.n) {
            modes.push(BuiltMode {
                m: shell.m,
                n: shell.n,
                kind: ModeKind::Complete,
                omega: shell.omega * detuning,
                radiated: resistance / (2.0 * spec.mass),
                muffling: 0.0,
                choking: 0.0,
                monopole_area,
            });
            index.push(ShapeIndex { radial: RIGID.len() + row, rows: 1, m: shell.m, member, axis });
        }
    }
    (modes, index)
}

/// Radial shapes of everything at `radii`, rigid motions first.
fn radial_rows(plate: &PlateModes, tables: &PlateTables, radii: &[f64]) -> Vec<f64> {
    let mut rows: Vec<f64> =
        RIGID.iter().flat_map(|&(_, shape)| radii.iter().map(move |&r| shape(r))).collect();
    rows.extend(plate.radial_shapes(tables, radii));
    rows
}

/// A plate's modes and what each does to the air around.
#[derive(Serialize, Deserialize)]
pub(crate) struct SoundingPlate {
    /// The modes.
    pub plate: PlateModes,
    /// `[shell]`.
    pub radiated: Vec<Radiated>,
}

/// What has been worked out of late.
static PLATES: Kept<SoundingPlate> = Kept::new("plate", MARK, 16);

impl SoundingPlate {
    /// A cymbal's, up to a frequency.
    ///
    /// # Errors
    /// [`SpecError`] if the plate or the limit is out of range.
    pub(crate) fn of(
        spec: &CymbalSpec,
        receivers: &Receivers,
        limit_hz: f64,
    ) -> Result<Shared<SoundingPlate>, SpecError> {
        let plate_spec = spec.plate();
        PLATES.get(&(plate_spec, receivers, limit_hz), || {
            let plate = PlateModes::new(&plate_spec, limit_hz)?;
            let (orders, extent) = plate.table_extent(limit_hz);
            let radiated = radiate(&plate_spec, receivers, &plate, &PlateTables::new(orders, extent));
            Ok(SoundingPlate { plate, radiated })
        })
    }
}

/// What each of the plate's shell modes does to the air around, `[shell]`.
fn radiate(
    spec: &PlateSpec,
    receivers: &Receivers,
    plate: &PlateModes,
    tables: &PlateTables,
) -> Vec<Radiated> {
    let highest = plate.shells.last().map_or(0.0, |shell| shell.omega);
    let finest = plate.flat.iter().flatten().map(|flat| flat.root).fold(0.0, f64::max);
    let trace = highest * spec.radius() / air::SPEED_OF_SOUND;
    let nodes = 12 + (0.7 * (finest + trace)) as usize;
    let disc = FreeDisc::new(spec.radius(), [receivers.near, receivers.far], nodes);
    let shapes = plate.radial_shapes(tables, disc.radii());
    let shells = plate.shells.iter().zip(shapes.chunks_exact(nodes));
    shells
        .map(|(shell, radial)| {
            let wave = Radiator { m: shell.m, radial, omega: shell.omega };
            disc.radiate(&wave, plate.wave_number(shell))
        })
        .collect()
}

/// How each mode is heard by an ear, `[mode]`: 0 at the listening point, 1 far away.
fn transfer(spec: &CymbalSpec, receivers: &Receivers, known: &SoundingPlate, ear: usize) -> Vec<[f64; 2]> {
    let SoundingPlate { plate, radiated } = known;
    let point = [receivers.near, receivers.far][ear];
    // Bounce and the two members of the rock.
    let mut out = vec![[0.0, 0.0]; 3];
    for (shell, radiated) in plate.shells.iter().zip(radiated) {
        let [re, im] = radiated.transfers[ear];
        let axis = spec.evenness.axis(shell.m, shell.n);
        for (member, _) in Splitting::ROUND.members(shell.m, shell.n) {
            let share = point.toward(shell.m, member, axis);
            out.push([share * re, share * im]);
        }
    }
    out
}
