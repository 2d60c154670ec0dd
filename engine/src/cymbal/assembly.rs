//! From a cymbal's description to a body that can be struck: what a cymbal on a stand and the two of a hi-hat share.
//!
//! ```text
//! CymbalSpec --> CymbalPlate --(order of the modes, what holds it)--> CymbalModes, PlateShapes --> Surface
//! ```
//!
//! Whoever builds a cymbal chooses the order of its modes and what moves before them as a whole; each step takes what the
//! one before it returns.

use std::convert::Infallible;
use std::f64::consts::TAU;

use crate::cache::{Cache, Shared};

use crate::air_load;
use crate::block::BLOCK;
use crate::build_context::BuildContext;
use crate::damping::Thermoelastic;
use crate::error::SpecError;
use crate::modal::simd::row_products::RowProducts;
use crate::mode::ModeKind;
use crate::plate::free_disc::Radiated;
use crate::plate::{PlateModes, PlateTables, ShellMode};
use crate::potential::Potential;
use crate::receiver::{POINTS, Receivers};
use crate::schema::SCHEMA;
use crate::shapes::{ShapeIndex, ShapeTable};
use crate::split::Splitting;
use crate::surface::rivets::Rivets;
use crate::surface::swing::{Rock, Swing};
use crate::surface::{Surface, SurfaceParts};
use crate::transport::TransportSpec;
use crate::von_karman::dome_share::kept_below_the_whole;
use crate::von_karman::{CoupledPair, VonKarman};

use super::hammering::HammeringSpec;
use super::lobes::Lobes;
use super::mixed_potential::MixedPotential;
use super::mixing::{HammeredModes, MIXED_FROM_HZ, PlainMode};
use super::modes::{BuiltMode, CymbalModes};
use super::sounding_plate::SoundingPlate;
use super::spec::CymbalSpec;

/// Rate at which the stretching is evaluated, Hz, over the highest coupled mode, and at most, as long as it is
/// five times that. *Converged*: with this, third octaves of hard strokes (crash, splash) are within 0.6 dB in the mean of
/// those with every sample, as they are at seven times.
const COUPLING_RATE_PER_HZ: f64 = 5.5;
const MOST_COUPLING_RATE: f64 = 20_000.0;

/// What hammering has made of modes of late.
static HAMMERED: Cache<HammeredModes> = Cache::new("hammered", SCHEMA, 16);

/// Samples between evaluations of the stretching of modes up to `highest_hz`.
fn coupling_stride(highest_hz: f64, sample_rate: f64) -> u32 {
    let rate = (COUPLING_RATE_PER_HZ * highest_hz).min(MOST_COUPLING_RATE).max(5.0 * highest_hz);
    (sample_rate / rate) as u32
}

/// Share of the sample rate that coupled modes may reach.
const COUPLED_SHARE_OF_RATE: f64 = 0.3;

/// Highest mode, Hz: the edge of hearing. The same at every rate that can carry it, so that a
/// stroke meets the same body.
const LIMIT_HZ: f64 = 21_000.0;

/// Share of the sample rate that modes may reach.
const LIMIT_OF_RATE: f64 = 0.48;

/// Up to where hard strokes couple modes, Hz, as the options of a build say; none if bending stays small.
pub fn coupled_hz(context: &BuildContext) -> Option<f64> {
    let BuildContext { options, ideal, .. } = context;
    let highest = options.quality.coupled_hz().min(COUPLED_SHARE_OF_RATE * options.sample_rate);
    (!ideal.linear).then_some(highest)
}

/// A motion of the plate as a whole.
pub struct RigidMotion {
    /// Nodal diameters.
    pub m: u32,
    /// Radial shape at a share of the radius, of unit mean square over the disc.
    pub shape: fn(f64) -> f64,
    /// Undamped angular frequency, rad/s.
    pub omega: f64,
    /// Decay rate, 1/s.
    pub sigma: f64,
}

/// A shell mode in the order of the body's.
#[derive(Debug, Clone, Copy)]
pub struct Ordered {
    /// Which of the plate's.
    pub shell: usize,
    /// Whether it is a coupled mode, which the stretching may act on.
    pub is_coupled: bool,
}

/// What a struck cymbal has beside its modes, to become a [`Surface`].
pub struct PlateShapes {
    shapes: ShapeTable,
    /// How each mode is heard at every point, far away as at a metre, `[point][mode]`: Pa s2/m of its acceleration, real and
    /// imaginary part.
    pub transfers: [Vec<[f64; 2]>; POINTS],
    coupled: Option<Coupled>,
    swing: Option<Swing>,
}

/// The stretching, the coupled modes that it acts on, and the highest of them, Hz.
struct Coupled {
    potential: Box<dyn Potential>,
    modes: usize,
    highest_hz: f64,
}

/// A cymbal's plate: its shell modes, not yet in the order of a body's.
pub struct CymbalPlate<'a> {
    spec: &'a CymbalSpec,
    receivers: &'a Receivers,
    known: Shared<SoundingPlate>,
    tables: PlateTables,
    splitting: Splitting,
    hammering: Option<HammeringSpec>,
    limit_hz: f64,
    /// Sample rate, Hz, if it may swing.
    swings: Option<f64>,
    /// Whether its mount tilts it, and not a rock of its own.
    is_tilted: bool,
    /// Modes up to this are coupled, Hz.
    highest_hz: Option<f64>,
}

impl<'a> CymbalPlate<'a> {
    /// The plate of a description that has been checked, its modes coupled up to a frequency (Hz) if they are. Allocates;
    /// takes some tenths of a second.
    ///
    /// # Errors
    /// [`SpecError`] if a number is out of range.
    pub fn new(
        spec: &'a CymbalSpec,
        coupled_hz: Option<f64>,
        context: &'a BuildContext,
    ) -> Result<CymbalPlate<'a>, SpecError> {
        let BuildContext { options, receivers, ideal } = context;
        let limit_hz = LIMIT_HZ.min(LIMIT_OF_RATE * options.sample_rate);
        let known = SoundingPlate::of(&spec.plate(), receivers, limit_hz)?;
        let (orders, extent) = known.plate.table_extent(limit_hz);
        let tables = PlateTables::new(orders, extent);
        let splitting = if ideal.round { Splitting::ROUND } else { spec.evenness };
        let highest_hz = coupled_hz.map(|hz| VonKarman::reach(&known.plate, hz));
        let hammering = spec.hammering.filter(|_| !ideal.round);
        let swings = (!ideal.linear).then_some(options.sample_rate);
        Ok(CymbalPlate {
            spec,
            receivers,
            known,
            tables,
            splitting,
            hammering,
            limit_hz,
            swings,
            is_tilted: false,
            highest_hz,
        })
    }

    /// The plate, whose mount tilts it: it swings without a rock of its own.
    pub fn tilted_by_its_mount(self) -> CymbalPlate<'a> {
        CymbalPlate { is_tilted: true, ..self }
    }

    /// What is known of the plate.
    #[cfg(test)]
    pub fn known(&self) -> &Shared<SoundingPlate> {
        &self.known
    }

    /// Radius, m.
    pub fn radius(&self) -> f64 {
        self.spec.plate().radius()
    }

    /// The shell modes, by frequency.
    pub fn shells(&self) -> &[ShellMode] {
        &self.known.plate.shells
    }

    /// Whether a shell mode is coupled with others.
    pub fn is_coupled(&self, shell: &ShellMode) -> bool {
        self.highest_hz.is_some_and(|hz| shell.omega <= TAU * hz)
    }

    /// Radial shape of every shell mode at a share of the radius, `[shell]`.
    pub fn shapes_at(&self, radius: f64) -> Vec<f64> {
        self.known.plate.radial_shapes(&self.tables, &[radius])
    }

    /// Direction of the axes of a shell mode's pair, rad.
    pub fn axis(&self, shell: &ShellMode) -> f64 {
        self.spec.evenness.axis(shell.m, shell.n)
    }

    /// Puts rigid motions and then shell modes in their order; `mounted` is the decay rate that the mount adds to each
    /// shell mode, 1/s. Allocates; takes some tenths of a second where modes are coupled.
    pub fn assemble(
        self,
        rigid: &[RigidMotion],
        order: &[Ordered],
        mounted: impl Fn(usize, &ShellMode) -> f64,
    ) -> (CymbalModes, PlateShapes) {
        let mut rows = Rows::default();
        rigid.iter().enumerate().for_each(|(radial, motion)| rows.push_rigid(radial, motion));
        let SoundingPlate { plate, radiated, .. } = &*self.known;
        let mut pairs = Vec::new();
        let mut coupled = 0;
        for &Ordered { shell: row, is_coupled } in order {
            let shell = &plate.shells[row];
            if self.is_coupled(shell) {
                pairs.push(CoupledPair { shell: row, mode: rows.modes.len(), axis: self.axis(shell) });
            }
            self.push_shell(&mut rows, (row, rigid.len() + row), &radiated[row], mounted(row, shell));
            if is_coupled {
                coupled = rows.modes.len();
            }
        }
        let hammered = self.hammering.map(|hammering| self.hammer(&hammering, &rows));
        if let Some(hammered) = &hammered {
            rows.mix(hammered);
        }
        let coupled = self.highest_hz.filter(|_| !pairs.is_empty()).map(|highest_hz| {
            let plain = VonKarman::new(plate, &self.tables, &pairs);
            let stiffness: Vec<f64> =
                rows.modes[..coupled].iter().map(|mode| self.spec.mass * mode.omega.powi(2)).collect();
            let potential: Box<dyn Potential> = match &hammered {
                Some(hammered) if hammered.mixture.kept() < coupled => {
                    let mixed = MixedPotential::new(plain, &hammered.mixture, coupled);
                    Box::new(kept_below_the_whole(mixed, &stiffness))
                }
                _ => Box::new(kept_below_the_whole(plain, &stiffness)),
            };
            Coupled { potential, modes: coupled, highest_hz }
        });
        let mixture = hammered.map(|hammered| Shared::new(hammered.mixture.products()));
        let moved = coupled.as_ref().map_or(0, |coupled| coupled.modes);
        let swing = self.swing(rigid, (&rows, moved), mixture.as_ref());
        let shapes =
            ShapeTable::new(&radial_rows(rigid, plate, &self.tables), rows.index).with_mixture(mixture);
        let mut modes = CymbalModes {
            modes: rows.modes,
            alloy: self.spec.alloy,
            heat: Thermoelastic::new(&self.spec.plate(), &self.spec.alloy.heat()),
            loss: self.spec.loss,
            mass: self.spec.mass,
        };
        modes.damp(&self.spec.muffler, &shapes);
        (modes, PlateShapes { shapes, transfers: rows.transfers, coupled, swing })
    }

    /// The swing of a cymbal that rocks: rigid motions of one nodal diameter, or its mount. Its first modes are `coupled`. What is linear does
    /// not swing, for a swing modulates.
    fn swing(
        &self,
        rigid: &[RigidMotion],
        (rows, coupled): (&Rows, usize),
        mixture: Option<&Shared<RowProducts>>,
    ) -> Option<Swing> {
        let sample_rate = self.swings?;
        let rock = rigid.iter().position(|motion| motion.m == 1);
        if rock.is_none() && !self.is_tilted {
            return None;
        }
        let members = |motion: &RigidMotion| Splitting::ROUND.members(motion.m, 0).count();
        let before = |n: usize| rigid[..n].iter().map(members).sum::<usize>();
        let rock = rock.map(|rock| Rock {
            modes: [before(rock), before(rock) + 1],
            // The slope of the rock's shape over the radius.
            tilt_per_metre: (rigid[rock].shape)(1.0) / self.spec.plate().radius(),
        });
        let lobes = Lobes::new(
            &self.known.patterns,
            mixture.cloned(),
            (&rows.index, &rows.shells, before(rigid.len())),
            self.receivers,
            rows.transfers.clone(),
        );
        let modes = (rows.modes.len(), coupled);
        Some(Swing::new(Box::new(lobes), rock, modes, sample_rate))
    }

    /// What becomes of the modes by hammering, from [`MIXED_FROM_HZ`] on; they stand in order of their frequency.
    fn hammer(&self, hammering: &HammeringSpec, rows: &Rows) -> Shared<HammeredModes> {
        let is_kept = |mode: &&BuiltMode| mode.kind == ModeKind::Rigid || mode.omega < TAU * MIXED_FROM_HZ;
        let kept = rows.modes.iter().take_while(is_kept).count();
        let key = (self.spec.plate(), hammering, self.splitting, self.limit_hz, kept);
        let made = HAMMERED.get(&key, || {
            let mixed = rows.modes.iter().zip(&rows.index).zip(&rows.shells).skip(kept);
            let plain: Vec<PlainMode> = mixed
                .map(|((mode, shape), &shell)| PlainMode {
                    shell,
                    m: mode.m,
                    member: mode.member,
                    axis: shape.axis,
                    omega: mode.omega,
                })
                .collect();
            let plate = &self.known.plate;
            Ok::<_, Infallible>(HammeredModes::new(plate, &self.tables, hammering, kept, &plain))
        });
        made.unwrap_or_else(|never| match never {})
    }

    /// Appends the members of one shell mode.
    fn push_shell(&self, rows: &mut Rows, (row, radial): (usize, usize), radiated: &Radiated, mounted: f64) {
        let shell = &self.known.plate.shells[row];
        let (axis, receivers) = (self.axis(shell), self.receivers);
        // Both faces are in the resistance, one in the area.
        let radius = self.spec.plate().radius();
        let unit = air_load::DENSITY * shell.omega * radius.powi(3);
        let monopole_area = air_load::monopole_area(radius, 0.5 * radiated.resistance / unit, shell.omega);
        for (member, detuning) in self.splitting.members(shell.m, shell.n) {
            rows.modes.push(BuiltMode {
                m: shell.m,
                n: shell.n,
                member,
                kind: ModeKind::Complete,
                omega: shell.omega * detuning,
                radiated: radiated.resistance / (2.0 * self.spec.mass),
                mounted,
                muffling: 0.0,
                choking: 0.0,
                monopole_area,
            });
            rows.shells.push(row);
            rows.index.push(ShapeIndex { radial, rows: 1, m: shell.m, member, axis });
            let points = receivers.points().into_iter().zip(receivers.scales());
            for (at, (point, scale)) in points.enumerate() {
                let share = scale * point.toward(shell.m, member, axis);
                rows.transfers[at].push(radiated.transfers[at].map(|x| share * x));
            }
        }
    }
}

/// Rows about the modes, `[mode]`, as they are put together.
#[derive(Default)]
struct Rows {
    modes: Vec<BuiltMode>,
    index: Vec<ShapeIndex>,
    transfers: [Vec<[f64; 2]>; POINTS],
    /// Which of the plate's shell modes; 0 of a rigid motion.
    shells: Vec<usize>,
}

impl Rows {
    /// Mixes the modes from those kept on. How they go around stays that of the plain ones.
    fn mix(&mut self, hammered: &HammeredModes) {
        let kept = hammered.mixture.kept();
        let plain = self.modes.split_off(kept);
        for (k, (&omega, &name)) in hammered.omegas.iter().zip(&hammered.names).enumerate() {
            let mean = |of: fn(&BuiltMode) -> f64| hammered.mean(k, |i| of(&plain[i]));
            self.modes.push(BuiltMode {
                omega,
                radiated: mean(|mode| mode.radiated),
                mounted: mean(|mode| mode.mounted),
                monopole_area: mean(|mode| mode.monopole_area),
                ..plain[name as usize]
            });
        }
        for transfers in &mut self.transfers {
            let of_plain = transfers.clone();
            for (k, mixed) in transfers[kept..].iter_mut().enumerate() {
                let parts = hammered.mixture.parts(k);
                *mixed = parts.fold([0.0; 2], |[re, im], (i, share)| {
                    let [of_re, of_im] = of_plain[i];
                    [re + share * of_re, im + share * of_im]
                });
            }
        }
    }

    /// Appends the members of a rigid motion, which is too slow to be heard.
    fn push_rigid(&mut self, radial: usize, motion: &RigidMotion) {
        let &RigidMotion { m, omega, sigma, .. } = motion;
        for (member, _) in Splitting::ROUND.members(m, 0) {
            self.modes.push(BuiltMode {
                m,
                n: 0,
                member,
                kind: ModeKind::Rigid,
                omega,
                radiated: 0.0,
                mounted: sigma,
                muffling: 0.0,
                choking: 0.0,
                monopole_area: 0.0,
            });
            self.shells.push(0);
            self.index.push(ShapeIndex { radial, rows: 1, m, member, axis: 0.0 });
            self.transfers.iter_mut().for_each(|transfers| transfers.push([0.0; 2]));
        }
    }
}

/// Radial shapes of everything where a [`ShapeTable`] wants them, rigid motions first.
fn radial_rows(rigid: &[RigidMotion], plate: &PlateModes, tables: &PlateTables) -> Vec<f64> {
    let radii = ShapeTable::radii();
    let mut rows: Vec<f64> =
        rigid.iter().flat_map(|motion| radii.iter().map(|&r| (motion.shape)(r))).collect();
    rows.extend(plate.radial_shapes(tables, &radii));
    rows
}

impl PlateShapes {
    /// The shapes alone, of a cymbal that is not struck.
    pub fn shapes(&self) -> &ShapeTable {
        &self.shapes
    }

    /// The struck cymbal, at rest. Allocates.
    pub fn into_surface(self, spec: &CymbalSpec, built: &CymbalModes, context: &BuildContext) -> Surface {
        let BuildContext { options, ideal, receivers } = context;
        let mut surface = Surface::new(SurfaceParts {
            modes: (0..built.modes.len()).map(|k| built.bare(k, 1.0)).collect(),
            shapes: self.shapes,
            transfer: vec![[0.0; 2]; built.modes.len()],
            material: spec.alloy.material(),
            lossless: ideal.lossless,
            sample_rate: options.sample_rate,
        });
        surface.set_transfers(self.transfers.map(Vec::into_iter));
        surface.hear_directly(&spec.plate(), receivers, options.sample_rate);
        surface.hear_sticks(spec.plate().radius(), receivers, options.sample_rate);
        if let Some(bell) = spec.bell {
            surface.set_bell(bell, spec.plate().radius());
        }
        if let Some(swing) = self.swing {
            surface.set_swing(swing);
        }
        if let Some(Coupled { potential, modes, highest_hz }) = self.coupled {
            let stride = coupling_stride(highest_hz, options.sample_rate);
            surface.set_potential(potential, modes, stride);
            if spec.stand.is_some() {
                surface.set_transport(TransportSpec {
                    rigid: built.modes.iter().take_while(|mode| mode.kind == ModeKind::Rigid).count(),
                    coupled: modes,
                    inertia: spec.mass * spec.plate().thickness().powi(2),
                    interval: BLOCK as f64 / options.sample_rate,
                });
            }
        }
        if let Some(rivets) = &spec.rivets {
            let dt = 1.0 / options.sample_rate;
            surface.attach(Rivets::new(rivets, &spec.alloy.material(), ideal.lossless, dt));
        }
        surface
    }
}
