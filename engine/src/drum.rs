//! A drum: two heads on a shell with air inside and around, struck on one and heard.
//!
//! Model: the modes of the whole drum, see [`coupled`], over its range of pitches, see [`tuned`]; they are
//! one modal body that is struck on the batter. A head's stretch, the wires and what lies above the modes
//! are not part of it.

use std::f64::consts::TAU;

pub mod build;
pub mod coupled;
pub mod hearing;
pub mod shadow;
pub mod spec;
pub mod stretch;
pub mod tuned;

use serde::Serialize;

use crate::air::SPEED_OF_SOUND;
use crate::build_context::BuildContext;
use crate::cache::{Cache, Shared};
use crate::damping::{Muffler, SIGMA_T60};
use crate::error::SpecError;
use crate::glide::Glide;
use crate::high_band::{self, HighBand, HighMuffling};
use crate::instrument::Instrument;
use crate::modal::Mode;
use crate::mode::Member;
use crate::mode::ModeInfo;
use crate::mode::ModeKind;
use crate::rim::Rim;
use crate::schema::MARK;
use crate::shapes::ShapeTable;
use crate::split::Splitting;
use crate::surface::contacts::STRIKER_PLACES;
use crate::surface::patch::Film;
use crate::surface::rim::AttachedRim;
use crate::surface::wires::{PRELOAD, SnareWires};
use crate::surface::{Surface, SurfaceParts};

use build::Blueprint;
use hearing::Hearing;
pub use spec::{DrumSpec, HeadContact, HeadSpec, PitchOf, ResonantSpec, ShellSpec};
use stretch::Stretch;
use tuned::{Place, Rung};

/// One mode of the body: which of the drum's, and which member of a pair.
#[derive(Debug, Clone, Copy)]
struct BodyMode {
    pair: usize,
    member: Member,
    /// Factor on the pair's frequency.
    detuning: f64,
    /// How it goes around at the muffler's direction.
    gel_turn: f64,
}

/// Places along the width of a ring that stand for it. *Derived*: a mode at 3 kHz has a wave and a half under one.
const RING_PLACES: usize = 6;

/// What muffling takes from the modes.
#[derive(Debug, Clone, PartialEq)]
enum MufflerCoefs {
    /// Decay rates of the heads' own motion and of the air's along the drum at full amount, 1/s.
    Pillow(f64, f64),
    /// A pad.
    Gel {
        /// Decay rate of a mode of unit square there at full amount, 1/s.
        sigma: f64,
        /// Where it lies, share of the radius.
        radius: f64,
        /// The dashpot that is at full amount, kg/s.
        dashpot: f64,
        /// The batter's radial functions there, `[batter mode]`.
        radial: Vec<f64>,
    },
    /// A ring.
    Ring {
        /// Decay rate of a mode of unit mean square under it at full amount, 1/s.
        sigma: f64,
        /// The dashpot that is at full amount, kg/s.
        dashpot: f64,
        /// Its middle, share of the radius.
        radius: f64,
        /// The batter's radial functions under it, `[batter mode][place]`, at places of equal area.
        radial: Vec<f64>,
    },
}

/// What a drum's modes and their shapes follow from: the key of the cache.
fn blueprint_key(spec: &DrumSpec) -> impl Serialize {
    let DrumSpec { diameter, pitch_of, batter, resonant, shell, .. } = *spec;
    (diameter, spec.pitches(), pitch_of, batter, resonant, shell)
}

/// What has been worked out of late.
static BLUEPRINTS: Cache<Blueprint> = Cache::new("drum", MARK, 24);
static HEARINGS: Cache<[Hearing; 2]> = Cache::new("hearing", MARK, 24);

/// A drum that can be struck.
pub struct Drum {
    surface: Surface,
    blueprint: Shared<Blueprint>,
    /// From near and from far.
    hearing: Shared<[Hearing; 2]>,
    far_distance: f64,
    modes: Vec<BodyMode>,
    /// Shapes on the resonant head, where wires lie against it.
    far_shapes: Option<ShapeTable>,
    muffler: MufflerCoefs,
    lossless: bool,
    /// Whether the heads wrap themselves around tips.
    wraps: bool,
    pitch: Glide,
    muffling: Glide,
    /// Force of the strainer, N.
    preload: Glide,
    /// Whether a control has moved since the modes last followed.
    stale: bool,
    /// Whether the shapes have yet to follow the pitch.
    shapes_stale: bool,
    /// `[pair]`: where each rings now.
    rungs: Vec<Rung>,
}

impl Drum {
    /// Builds a drum at its default pitch. Allocates; takes tenths of a second.
    ///
    /// # Errors
    /// [`SpecError`] if a number is out of range.
    pub fn new(spec: &DrumSpec, context: &BuildContext) -> Result<Drum, SpecError> {
        spec.check()?;
        let BuildContext { options, receivers, ideal } = context;
        let [low, pitch, high] = spec.pitches();
        let blueprint = BLUEPRINTS.get(&blueprint_key(spec), || Blueprint::new(spec))?;
        let place = blueprint.scale.place(pitch);
        let rungs: Vec<Rung> = blueprint.modes.iter().map(|mode| mode.at(&place)).collect();
        let modes = lay_out(spec, &blueprint, ideal.round);
        let muffler = MufflerCoefs::new(spec, &blueprint);
        let points = [receivers.near, receivers.far];
        let heard = (blueprint_key(spec), points, spec.evenness);
        let hearing = HEARINGS.get(&heard, || {
            let near = Hearing::new(&blueprint, spec, receivers.near);
            let far = near.from(&blueprint, spec, receivers.far);
            Ok::<_, SpecError>([near, far])
        })?;
        let bare =
            |mode: &BodyMode| Mode { omega: rungs[mode.pair].omega, sigma: 0.0, mass: rungs[mode.pair].mass };
        let mut surface = Surface::new(SurfaceParts {
            modes: modes.iter().map(bare).collect(),
            shapes: blueprint.batter_shapes(spec.evenness),
            transfer: vec![[0.0; 2]; modes.len()],
            material: spec.batter.material,
            lossless: ideal.lossless,
            sample_rate: options.sample_rate,
        });
        surface.set_listener();
        let mut drum = Drum {
            surface,
            far_shapes: spec.wires.and_then(|_| blueprint.resonant_shapes(spec.evenness)),
            blueprint,
            hearing,
            far_distance: receivers.far.distance,
            modes,
            muffler,
            lossless: ideal.lossless,
            wraps: spec.contact == HeadContact::Wraps,
            pitch: Glide::new(pitch, low, high),
            muffling: Glide::new(0.0, 0.0, 1.0),
            preload: Glide::new(*PRELOAD.start(), *PRELOAD.start(), *PRELOAD.end()),
            stale: true,
            shapes_stale: true,
            rungs,
        };
        if spec.high_band {
            let near = HighBand::new(&drum.blueprint.high_band(spec, context));
            let far = drum.blueprint.far_high_band(spec, context).filter(|_| spec.wires.is_some());
            drum.surface.observe(0, near);
            far.iter().for_each(|far| drum.surface.observe(STRIKER_PLACES, HighBand::new(far)));
        }
        drum.follow_controls();
        if let (Some(resonant), Some(wires)) = (spec.resonant, spec.wires) {
            let dt = 1.0 / options.sample_rate;
            drum.surface.attach(SnareWires::new(&wires, &resonant.material, ideal.lossless, dt));
        }
        if let Some(hoop) = spec.hoop {
            let rim = Rim::new(spec.radius(), &hoop, points, ideal.lossless);
            drum.surface.attach(AttachedRim::new(rim, options.sample_rate));
        }
        drum.follow_shapes();
        if !ideal.linear {
            let (stretch, modes) = Stretch::new(&spec.membrane(&spec.batter), &drum.blueprint, pitch);
            drum.surface.set_potential(Box::new(stretch), modes, stretch::stride(options.sample_rate));
        }
        Ok(drum)
    }

    /// Brings the strainer's force to where its control is.
    fn follow_preload(&mut self) {
        let preload = self.preload.value();
        self.surface.with(|wires: &mut SnareWires, site| wires.set_preload(preload, site));
    }
}

impl Instrument for Drum {
    fn surface(&self) -> &Surface {
        &self.surface
    }

    fn surface_mut(&mut self) -> &mut Surface {
        &mut self.surface
    }

    /// Brings the shapes and what is heard of them to where the pitch is; only strokes need the shapes, and hide that
    /// what still rings is heard a little differently.
    fn follow_shapes(&mut self) {
        if !std::mem::take(&mut self.shapes_stale) {
            return;
        }
        let place = self.blueprint.scale.place(self.pitch.value());
        for (k, mode) in self.modes.iter().enumerate() {
            let tuned = &self.blueprint.modes[mode.pair];
            for (i, weight) in self.surface.shapes_mut().weights_mut(k).iter_mut().enumerate() {
                *weight = tuned.share(i, &place) as f32;
            }
            if let Some(far) = &mut self.far_shapes {
                let (_, near) = self.blueprint.batter.order(tuned.m);
                for (i, weight) in far.weights_mut(k).iter_mut().enumerate() {
                    *weight = tuned.share(near + i, &place) as f32;
                }
            }
        }
        let Drum { surface, hearing, blueprint, modes, pitch, far_distance, .. } = self;
        let [near, far] =
            hearing.each_ref().map(|hearing| hearing.transfers(&blueprint.modes, &place, pitch.value()));
        surface.set_volumes(modes.iter().map(|mode| {
            let tuned = &blueprint.modes[mode.pair];
            let share = all_around(blueprint, tuned, &place);
            (share * if share > 0.0 { blueprint.volume(tuned, &place) } else { 0.0 }, share)
        }));
        surface.set_transfers(near, far.map(|transfer| transfer.map(|h| h * *far_distance)));
        let far = self.blueprint.resonant.as_ref().map(|head| head.film(&place));
        let near = Film { wraps: self.wraps, ..self.blueprint.batter.film(&place) };
        self.surface.set_local_compliance(near);
        if let Some(shapes) = &self.far_shapes {
            self.surface.with(|wires: &mut SnareWires, site| wires.lay(far, shapes, site));
        }
    }

    fn set_tuning(&mut self, hz: f64) {
        self.pitch.set(hz);
    }

    fn set_muffling(&mut self, amount: f64) {
        self.muffling.set(amount);
    }

    fn throw_wires(&mut self, on: bool) {
        self.surface.with(|wires: &mut SnareWires, site| wires.throw(on, site));
    }

    fn set_preload(&mut self, newtons: f64) {
        self.preload.set(newtons);
    }

    fn advance_controls(&mut self, seconds: f64) {
        let moved = [&mut self.pitch, &mut self.muffling].map(|glide| glide.advance(seconds));
        self.stale |= moved.contains(&true);
        if self.preload.advance(seconds) {
            self.follow_preload();
        }
    }

    fn follow_controls(&mut self) {
        if !std::mem::take(&mut self.stale) {
            return;
        }
        self.shapes_stale = true;
        let place = self.blueprint.scale.place(self.pitch.value());
        for (rung, mode) in self.rungs.iter_mut().zip(&self.blueprint.modes) {
            *rung = mode.at(&place);
        }
        let amount = self.muffling.value();
        let (modes, rungs, muffler, blueprint) = (&self.modes, &self.rungs, &self.muffler, &self.blueprint);
        let lossless = self.lossless;
        self.surface.retune(|k, _| {
            let mode = &modes[k];
            let rung = &rungs[mode.pair];
            let muffled =
                if amount > 0.0 { amount * muffler.sigma(mode, rung, blueprint, &place) } else { 0.0 };
            let sigma = if lossless { 0.0 } else { rung.sigma + muffled };
            Mode { omega: rung.omega * mode.detuning, sigma, mass: rung.mass }
        });
        let mut bands = self.surface.high_bands_mut();
        if let Some(near) = bands.next() {
            near.retune(self.blueprint.batter.tension(&place), &self.muffler.above(amount));
        }
        if let (Some(far), Some(head)) = (bands.next(), &self.blueprint.resonant) {
            far.retune(head.tension(&place), &HighMuffling::NONE);
        }
    }

    fn finish_controls(&mut self) {
        let moved = [&mut self.pitch, &mut self.muffling].map(Glide::jump);
        self.stale |= moved.contains(&true);
        if self.preload.jump() {
            self.follow_preload();
        }
        self.follow_controls();
        self.follow_shapes();
    }

    fn modes(&self) -> Vec<ModeInfo> {
        let rows = self.surface.body().modes().iter().zip(&self.modes);
        let complete = rows.map(|(mode, row)| {
            let tuned = &self.blueprint.modes[row.pair];
            let (body, n, kind) = describe(&self.blueprint, tuned);
            ModeInfo {
                body,
                m: tuned.m,
                n,
                member: row.member,
                frequency_hz: mode.omega_d() / TAU,
                t60: SIGMA_T60 / mode.sigma,
                modal_mass: mode.mass,
                radiation: tuned.reference.monopole_area * mode.mass.sqrt(),
                kind,
            }
        });
        let rim = self.surface.rim().into_iter().flat_map(|rim| &rim.modes).map(|mode| ModeInfo {
            body: "rim",
            m: mode.n,
            n: 0,
            member: mode.member,
            frequency_hz: mode.mode.omega_d() / TAU,
            t60: SIGMA_T60 / mode.mode.sigma,
            modal_mass: mode.mode.mass,
            // The narrow hoop's far field is next to nothing; it is heard from near.
            radiation: 0.0,
            kind: Rim::kind(mode),
        });
        let slices = self.surface.high_bands().take(1).flat_map(HighBand::slices);
        complete.chain(slices.map(sampled)).chain(rim).collect()
    }

    fn tensions(&self) -> Vec<(&'static str, f64)> {
        let place = self.blueprint.scale.place(self.pitch.value());
        let heads =
            [("batter", Some(&self.blueprint.batter)), ("resonant", self.blueprint.resonant.as_ref())];
        heads.into_iter().filter_map(|(name, head)| Some((name, head?.tension(&place)))).collect()
    }
}

/// Share of a mode's volume that sends sound all around and feels it: none of modes with nodal diameters, and none where
/// the wave is shorter than the drum.
fn all_around(blueprint: &Blueprint, mode: &tuned::TunedMode, place: &Place) -> f64 {
    if mode.m != 0 {
        return 0.0;
    }
    let u = mode.at(place).omega * blueprint.batter.membrane.spec().radius / SPEED_OF_SOUND;
    (LONG_WAVE[1] - u).clamp(0.0, LONG_WAVE[1] - LONG_WAVE[0]) / (LONG_WAVE[1] - LONG_WAVE[0])
}

/// `omega a / c` up to which a drum is felt and heard as a volume, and from which on not at all. *Derived*: at 3 a
/// disc's own directions differ by 6 dB.
const LONG_WAVE: [f64; 2] = [2.0, 3.0];

/// A slice of the high band as a mode of the batter; it has no nodes of its own.
fn sampled(slice: high_band::SliceInfo) -> ModeInfo {
    ModeInfo {
        body: "batter",
        m: 0,
        n: 0,
        member: Member::Cosine,
        frequency_hz: slice.omega / TAU,
        t60: SIGMA_T60 / slice.sigma,
        modal_mass: slice.mass,
        radiation: slice.monopole_area,
        kind: ModeKind::Sampled,
    }
}

/// What a mode mostly is: body, nodal circles, kind.
fn describe(blueprint: &Blueprint, mode: &tuned::TunedMode) -> (&'static str, u32, ModeKind) {
    let (_, near) = blueprint.batter.order(mode.m);
    let name = mode.name;
    if name < near {
        ("batter", name as u32 + 1, ModeKind::Complete)
    } else if name < mode.heads() {
        ("resonant", (name - near) as u32 + 1, ModeKind::Complete)
    } else {
        ("cavity", (name - mode.heads()) as u32, ModeKind::Cavity)
    }
}

/// Lays the pairs out as modes of a body.
fn lay_out(spec: &DrumSpec, blueprint: &Blueprint, round: bool) -> Vec<BodyMode> {
    let splitting = if round { Splitting::ROUND } else { spec.evenness };
    let angle = match spec.muffler {
        Muffler::Gel { angle, .. } => angle,
        Muffler::Pillow { .. } | Muffler::Ring { .. } => 0.0,
    };
    let mut modes = Vec::new();
    for (pair, mode) in blueprint.modes.iter().enumerate() {
        let turn = f64::from(mode.m) * (angle - spec.evenness.axis(mode.m, 0));
        let (body, n, _) = describe(blueprint, mode);
        // A pair is split by what it is, not by where it stands, so that a rebuild splits it alike.
        let which = n + 1000 * body.len() as u32;
        for (member, detuning) in splitting.members(mode.m, which) {
            let gel_turn = match member {
                Member::Cosine => turn.cos(),
                Member::Sine => turn.sin(),
            };
            modes.push(BodyMode { pair, member, detuning, gel_turn });
        }
    }
    modes
}

impl MufflerCoefs {
    fn new(spec: &DrumSpec, blueprint: &Blueprint) -> MufflerCoefs {
        let membrane = spec.membrane(&spec.batter);
        match spec.muffler {
            Muffler::Pillow { sigma, flow } => MufflerCoefs::Pillow(sigma, flow),
            Muffler::Gel { sigma, radius, .. } => {
                let film = membrane.area_density() * membrane.area();
                let radial = blueprint.batter.membrane.radial_shapes(&[radius]);
                MufflerCoefs::Gel { sigma, radius, dashpot: 2.0 * film * sigma, radial }
            }
            Muffler::Ring { sigma, inner } => {
                let film = membrane.area_density() * membrane.area();
                let part = |i: usize| (i as f64 + 0.5) / RING_PLACES as f64;
                let places: Vec<f64> = (0..RING_PLACES)
                    .map(|i| (inner * inner + part(i) * (1.0 - inner * inner)).sqrt())
                    .collect();
                let radial = blueprint.batter.membrane.radial_shapes(&places);
                MufflerCoefs::Ring { sigma, dashpot: 2.0 * film * sigma, radius: 0.5 * (1.0 + inner), radial }
            }
        }
    }

    /// What some of it takes from the high band.
    fn above(&self, amount: f64) -> HighMuffling {
        match *self {
            MufflerCoefs::Pillow(sigma, _) => HighMuffling { even: amount * sigma, ..HighMuffling::NONE },
            MufflerCoefs::Gel { sigma, radius, .. } | MufflerCoefs::Ring { sigma, radius, .. } => {
                HighMuffling { pad: (amount * sigma, radius), ..HighMuffling::NONE }
            }
        }
    }

    /// Decay rate that full muffling adds to a mode, 1/s.
    fn sigma(&self, mode: &BodyMode, rung: &Rung, blueprint: &Blueprint, place: &Place) -> f64 {
        match self {
            MufflerCoefs::Pillow(sigma, flow) => sigma * (rung.batter + rung.resonant) + flow * rung.flow,
            MufflerCoefs::Gel { dashpot, radial, .. } => {
                let tuned = &blueprint.modes[mode.pair];
                let (first, count) = blueprint.batter.order(tuned.m);
                let shape: f64 = (0..count).map(|i| tuned.share(i, place) * radial[first + i]).sum();
                dashpot * (shape * mode.gel_turn).powi(2) / (2.0 * rung.mass)
            }
            MufflerCoefs::Ring { dashpot, radial, .. } => {
                let tuned = &blueprint.modes[mode.pair];
                let (first, count) = blueprint.batter.order(tuned.m);
                let shape = |at: usize| -> f64 {
                    let of = |i: usize| tuned.share(i, place) * radial[(first + i) * RING_PLACES + at];
                    (0..count).map(of).sum()
                };
                // All the way around, a pair's square is half of its largest.
                let around = if tuned.m == 0 { 1.0 } else { 0.5 };
                let square = (0..RING_PLACES).map(|at| shape(at).powi(2)).sum::<f64>() / RING_PLACES as f64;
                dashpot * around * square / (2.0 * rung.mass)
            }
        }
    }
}
