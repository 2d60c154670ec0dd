//! A drum: two heads on a shell with air inside and around, struck on one and heard.
//!
//! Model: the modes of the whole drum, see [`coupled`], over its range of pitches, see [`tuned`]; they are
//! one modal body that is struck on the batter. A head's stretch, the wires and what lies above the modes
//! are not part of it.

use std::f64::consts::TAU;

mod bending;
pub mod body;
mod complete;
pub mod coupled;
mod dent;
pub mod heads;
mod losses;
pub mod lugs;
pub mod mixing;
pub mod mode_transfer;
pub mod modes;
pub mod muffler;
pub mod spec;
pub mod stretch;
pub mod tension_field;
pub mod tuned;

use serde::Serialize;

use crate::build_context::BuildContext;
use crate::cache::{Cache, Shared};
use crate::damping::SIGMA_T60;
use crate::error::SpecError;
use crate::glide::Glide;
use crate::grip::Grip;
use crate::high_band::{HighBand, HighMuffling};
use crate::instrument::Instrument;
use crate::modal::simd::row_products::RowProducts;
use crate::modal::{Mode, Row, zero_row};
use crate::mode::ModeInfo;
use crate::receiver::POINTS;
use crate::rim::{Rim, RimPart};
use crate::schema::SCHEMA;
use crate::shapes::ShapeTable;
use crate::strike::{Strike, Striker};
use crate::surface::contacts::STRIKER_PLACES;
use crate::surface::incident_field::Volume;
use crate::surface::rim::AttachedRim;
use crate::surface::wires::{PRELOAD, SnareWires};
use crate::surface::{Surface, SurfaceParts};

use body::{BodyMode, all_around, describe, sampled};
use complete::{at_pitch, continued};
use losses::{LYING, Losses, palm};
use mixing::MixedModes;
use mode_transfer::{ModeTransfers, heard_by};
use modes::{DrumModes, most_volume};
use muffler::MufflerCoefs;
pub use spec::{DrumSpec, HeadContact, HeadSpec, PitchOf, ResonantSpec, ShellSpec};
use stretch::StretchModel;
use tuned::{ModeAtPitch, PitchPosition};

/// What a drum's modes and their shapes follow from: the key of the cache.
fn modes_key(spec: &DrumSpec) -> impl Serialize {
    let DrumSpec { diameter, pitch_of, batter, resonant, shell, edge, .. } = *spec;
    // In binary form a part that is missing leaves no trace by itself.
    let dots = (batter.dot.is_some(), resonant.is_some_and(|head| head.dot.is_some()));
    let port = resonant.is_some_and(|head| head.port_diameter.is_some());
    let vent = shell.is_some_and(|shell| shell.vent_diameter().is_some());
    let there = (spec.is_uneven(), dots, batter.mesh.is_some(), port, vent);
    (diameter, spec.pitches(), pitch_of, batter, resonant, shell, edge, there)
}

/// What has been worked out of late.
static MODES: Cache<DrumModes> = Cache::new("drum", SCHEMA, 24);
static MIXED: Cache<MixedModes> = Cache::new("mixing", SCHEMA, 24);
static TRANSFERS: Cache<ModeTransfers> = Cache::new("hearing", SCHEMA, 24);

/// What is asked for while it rings.
struct Controls {
    /// Pitch of the named mode, Hz.
    pitch: Glide,
    /// 0 to 1.
    muffling: Glide,
    /// How firmly a hand lies on the batter head, and whether that of the latest cross-stick lies there.
    hand: Grip,
    under_stick: bool,
    /// Force of the strainer, N.
    preload: Glide,
}

impl Controls {
    /// Moves pitch and muffling, and notes which of them did.
    fn move_modes(&mut self, mut by: impl FnMut(&mut Glide) -> bool, stale: &mut Stale) {
        let pitch = by(&mut self.pitch);
        stale.pitch |= pitch;
        stale.losses |= by(&mut self.muffling) | pitch;
    }
}

/// What has yet to follow the controls.
struct Stale {
    /// Where the modes ring.
    pitch: bool,
    /// What they lose.
    losses: bool,
    /// The shapes.
    shapes: bool,
}

/// What becomes of the modes of even heads.
struct Mixing {
    modes: Shared<MixedModes>,
    /// The mixture of their even modes.
    mixture: Shared<RowProducts>,
    /// What is heard of the even modes and of the body's.
    even: HeardRows,
    heard: HeardRows,
}

/// What is heard of all modes, `[what][mode]`: pressure at each point (real, imaginary), volume, and of the pressure at the first far
/// point what goes all around.
type HeardRows = [Row; 2 * POINTS + 2];

/// The places in it of the first far point, of the volume and of what goes all around.
const FAR: usize = 2;
const VOLUME: usize = 2 * POINTS;
const ALL_AROUND: usize = VOLUME + 1;

impl Mixing {
    fn new(modes: Shared<MixedModes>) -> Mixing {
        let mixture = Shared::new(modes.mixture.products());
        let rows = || std::array::from_fn(|_| zero_row(modes.mixture.modes()));
        let (even, heard) = (rows(), rows());
        Mixing { modes, mixture, even, heard }
    }
}

/// A drum that can be struck.
pub struct Drum {
    surface: Surface,
    built: Shared<DrumModes>,
    mixing: Option<Mixing>,
    /// From near and from far.
    hearing: Shared<ModeTransfers>,
    /// What makes of the pressure at each point the one that is passed on.
    scales: [f64; POINTS],
    modes: Vec<BodyMode>,
    /// Shapes on the resonant head, where wires lie against it.
    far_shapes: Option<ShapeTable>,
    losses: Losses,
    /// Whether tips dent the heads.
    dents: bool,
    controls: Controls,
    stale: Stale,
    /// `[kept pair, then mixed mode]`: where each rings now.
    at_pitch: Vec<ModeAtPitch>,
}

impl Drum {
    /// Builds a drum at its default pitch. Allocates; takes tenths of a second.
    ///
    /// # Errors
    /// [`SpecError`] if a number is out of range.
    pub fn new(spec: &DrumSpec, context: &BuildContext) -> Result<Drum, SpecError> {
        spec.check()?;
        let BuildContext { options, receivers, ideal } = context;
        let uneven = spec.unevenness().filter(|_| !ideal.round);
        let [low, pitch, high] = spec.pitches();
        let built = MODES.get(&modes_key(spec), || DrumModes::new(spec))?;
        let place = built.heads.scale.place(pitch);
        let mixed = uneven
            .map(|uneven| {
                let axis = |m| spec.evenness.axis(m, 0);
                let make = || Ok::<_, SpecError>(MixedModes::new(&built, &uneven, axis));
                MIXED.get(&(modes_key(spec), uneven, spec.evenness.seed), make)
            })
            .transpose()?;
        let modes = body::assemble(spec, &built, mixed.as_deref(), ideal.round);
        let muffler = MufflerCoefs::new(spec, &built, mixed.as_deref());
        let at_pitch = at_pitch(&built, mixed.as_deref(), &place).collect::<Vec<_>>();
        let heard = (modes_key(spec), receivers, spec.evenness);
        let hearing = TRANSFERS.get(&heard, || Ok::<_, SpecError>(heard_by(&built, spec, receivers)))?;
        let bare = |mode: &BodyMode| Mode {
            omega: at_pitch[mode.row].omega,
            sigma: 0.0,
            mass: at_pitch[mode.row].mass,
        };
        let mixing = mixed.map(Mixing::new);
        let mixture = || mixing.as_ref().map(|mixing| mixing.mixture.clone());
        let mut surface = Surface::new(SurfaceParts {
            modes: modes.iter().map(bare).collect(),
            shapes: built.batter_shapes(spec.evenness).with_mixture(mixture()),
            transfer: vec![[0.0; 2]; modes.len()],
            material: spec.batter.material,
            lossless: ideal.lossless,
            sample_rate: options.sample_rate,
        });
        surface.set_listener();
        surface.hear_sticks(spec.radius(), receivers, options.sample_rate);
        let mut drum = Drum {
            surface,
            far_shapes: spec
                .wires
                .and_then(|_| built.resonant_shapes(spec.evenness))
                .map(|shapes| shapes.with_mixture(mixture())),
            built,
            mixing,
            hearing,
            scales: receivers.scales(),
            losses: Losses {
                muffler,
                palm: palm(spec),
                muffled: vec![0.0; modes.len()],
                is_known: false,
                lossless: ideal.lossless,
            },
            modes,
            dents: spec.contact == HeadContact::Wraps,
            controls: Controls {
                pitch: Glide::new(pitch, low, high),
                muffling: Glide::new(0.0, 0.0, 1.0),
                hand: Grip::new(),
                under_stick: false,
                preload: Glide::new(*PRELOAD.start(), *PRELOAD.start(), *PRELOAD.end()),
            },
            stale: Stale { pitch: true, losses: true, shapes: true },
            at_pitch,
        };
        if spec.high_band {
            let band = |band| HighBand::new(&continued(&drum.built, drum.mixed(), band));
            let near = band(drum.built.high_band(spec, context));
            let far = drum.built.far_high_band(spec, context).filter(|_| spec.wires.is_some()).map(band);
            drum.surface.observe(0, near);
            far.into_iter().for_each(|far| drum.surface.observe(STRIKER_PLACES, far));
        }
        drum.follow_controls();
        if let (Some(resonant), Some(wires)) = (spec.resonant, spec.wires) {
            let dt = 1.0 / options.sample_rate;
            drum.surface.attach(SnareWires::new(
                &wires,
                (&resonant.material, spec.radius()),
                ideal.lossless,
                dt,
            ));
        }
        if let Some(hoop) = spec.hoop {
            let rim = Rim::new(spec.radius(), &hoop, spec.cylinder().as_ref(), receivers, ideal.lossless);
            drum.surface.attach(AttachedRim::new(rim, options.sample_rate));
        }
        drum.follow_shapes();
        if !ideal.linear {
            let StretchModel { potential, modes, above } =
                StretchModel::new(&drum.built, drum.mixing.as_ref().map(|mixing| &mixing.modes), pitch);
            let potential = if drum.dents { potential } else { potential.evenly() };
            drum.surface.set_potential(Box::new(potential), modes, stretch::stride(options.sample_rate));
            drum.surface.set_glide(modes, above);
        }
        Ok(drum)
    }

    /// Its mixed modes, if its heads are uneven.
    fn mixed(&self) -> Option<&MixedModes> {
        self.mixing.as_ref().map(|mixing| &*mixing.modes)
    }

    /// Brings where the modes ring to where the pitch is.
    fn follow_pitch(&mut self, place: &PitchPosition) {
        self.stale.shapes = true;
        self.losses.is_known = false;
        let now = at_pitch(&self.built, self.mixing.as_ref().map(|mixing| &*mixing.modes), place);
        self.at_pitch.iter_mut().zip(now).for_each(|(row, now)| *row = now);
    }

    /// Brings the heads' shares in the modes to where the pitch is.
    #[inline(always)]
    fn follow_shares(&mut self, place: &PitchPosition) {
        let mut simple = 0;
        for tuned in &self.built.modes {
            let (_, near) = self.built.heads.batter.order(tuned.m);
            // Members of a pair share their weights.
            tuned.write_shares(0, place, self.surface.shapes_mut().weights_mut(simple));
            if let Some(far) = &mut self.far_shapes {
                tuned.write_shares(near, place, far.weights_mut(simple));
            }
            simple += if tuned.m == 0 { 1 } else { 2 };
        }
    }

    /// Brings what is heard of the modes to where the pitch is.
    fn follow_pressures(&mut self, place: &PitchPosition) {
        let Drum { surface, hearing, built, mixing, controls, scales, at_pitch, .. } = self;
        let volumes = built.modes.iter().flat_map(|tuned| {
            let share = all_around(built, tuned, place);
            let volume = share * if share > 0.0 { built.volume(tuned, place) } else { 0.0 };
            std::iter::repeat_n((volume, share), if tuned.m == 0 { 1 } else { 2 })
        });
        let pitch = controls.pitch.value();
        let (near, far) = &**hearing;
        let mut transfers: [_; POINTS] = std::array::from_fn(|point| {
            let hearing = if point == 0 { near } else { &far[point - 1] };
            let scale = scales[point];
            hearing.transfers(&built.modes, place, pitch).map(move |transfer| transfer.map(|h| h * scale))
        });
        let Some(Mixing { modes: mixed, mixture, even, heard }) = mixing else {
            surface.set_volumes(volumes.map(|(volume, share)| Volume { volume, share, all_around: 0.0 }));
            surface.set_transfers(transfers);
            return;
        };
        let count = mixed.mixture.modes();
        for (mode, (volume, share)) in volumes.take(count).enumerate() {
            for (point, transfers) in transfers.iter_mut().enumerate() {
                let [re, im] = transfers.next().unwrap_or_default();
                (even[2 * point][mode], even[2 * point + 1][mode]) = (re as f32, im as f32);
            }
            (even[VOLUME][mode], even[ALL_AROUND][mode]) = (volume as f32, share as f32 * even[FAR][mode]);
        }
        let rows = (even.each_ref().map(|row| &row[..]), heard.each_mut().map(|row| &mut row[..]));
        surface.body().kernels().some_row_products(mixture, 0..mixture.parts(), rows.0, rows.1);
        let kept = mixed.mixture.kept();
        for (volume, now) in heard[VOLUME][kept..].iter_mut().zip(&at_pitch[built.kept..]) {
            // What parts of a mixture send out may add up to more than the mixture is made to lose.
            let most = most_volume(now) as f32;
            *volume = volume.clamp(-most, most);
        }
        let pick = |i: usize| heard[i][..count].iter().map(|&heard| f64::from(heard));
        let pair = |i: usize| pick(i).zip(pick(i + 1)).map(|(a, b)| [a, b]);
        let volumes = pick(VOLUME).zip(pick(ALL_AROUND));
        surface.set_volumes(volumes.map(|(volume, all_around)| Volume { volume, share: 0.0, all_around }));
        surface.set_transfers(std::array::from_fn(|point| pair(2 * point)));
    }

    /// Brings the strainer's force to where its control is.
    fn follow_preload(&mut self) {
        let preload = self.controls.preload.value();
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

    /// A cross-stick lies on the head under a hand, which has left before another stroke.
    fn strike(&mut self, strike: &Strike) {
        self.follow_shapes();
        let lies = strike.striker == Striker::CrossStick && self.surface.rim().is_some();
        if lies != std::mem::replace(&mut self.controls.under_stick, lies) {
            self.stale.losses = true;
            self.follow_controls();
        }
        self.surface.strike(strike);
    }

    /// Brings the shapes and what is heard of them to where the pitch is; only strokes need the shapes, and hide that
    /// what still rings is heard a little differently.
    fn follow_shapes(&mut self) {
        if !std::mem::take(&mut self.stale.shapes) {
            return;
        }
        let place = self.built.heads.scale.place(self.controls.pitch.value());
        let kernels = self.surface.body().kernels();
        kernels.vectorized(
            #[inline(always)]
            || self.follow_shares(&place),
        );
        self.follow_pressures(&place);
        self.surface.tune_potential(self.controls.pitch.value());
        let far = self.built.heads.resonant.as_ref().map(|head| head.film(&place));
        let near = self.built.heads.batter.film(&place);
        self.surface.set_local_compliance(if self.dents { near } else { near.under_fixed_discs() });
        if let Some(shapes) = &self.far_shapes {
            self.surface.with(|wires: &mut SnareWires, site| wires.lay(far, shapes, site));
        }
    }

    fn set_tuning(&mut self, hz: f64) {
        let there = self.controls.pitch.set(hz);
        self.stale.pitch |= there;
        self.stale.losses |= there;
    }

    fn set_muffling(&mut self, amount: f64) {
        self.stale.losses |= self.controls.muffling.set(amount);
    }

    fn choke(&mut self, strength: f64) {
        self.controls.hand.set(strength);
    }

    fn throw_wires(&mut self, on: bool) {
        self.surface.with(|wires: &mut SnareWires, site| wires.throw(on, site));
    }

    fn set_preload(&mut self, newtons: f64) {
        if self.controls.preload.set(newtons) {
            self.follow_preload();
        }
    }

    fn advance_controls(&mut self, seconds: f64) {
        self.controls.move_modes(|glide| glide.advance(seconds), &mut self.stale);
        self.controls.hand.advance(seconds);
        if self.controls.preload.advance(seconds) {
            self.follow_preload();
        }
    }

    fn has_moved(&self) -> bool {
        self.stale.losses || self.controls.hand.has_moved()
    }

    fn follow_controls(&mut self) {
        if !self.has_moved() {
            return;
        }
        self.stale.losses = false;
        let place = self.built.heads.scale.place(self.controls.pitch.value());
        if std::mem::take(&mut self.stale.pitch) {
            self.follow_pitch(&place);
        }
        let amount = self.controls.muffling.value();
        if amount > 0.0 && !self.losses.is_known {
            self.losses.follow_pitch(&self.modes, &self.at_pitch, &self.built, &place);
        }
        let lying = if self.controls.under_stick { LYING } else { 0.0 };
        let hand = self.controls.hand.follow().max(lying) * self.losses.palm;
        let (modes, at_pitch, losses) = (&self.modes, &self.at_pitch, &self.losses);
        self.surface.retune(|k, _| {
            let rung = &at_pitch[modes[k].row];
            let muffled = if amount > 0.0 { amount * losses.muffled[k] } else { 0.0 };
            let sigma = if losses.lossless { 0.0 } else { rung.sigma + muffled + hand * rung.batter };
            Mode { omega: rung.omega * modes[k].detuning, sigma, mass: rung.mass }
        });
        let mut bands = self.surface.high_bands_mut();
        if let Some(near) = bands.next() {
            let muffling = losses.muffler.above(amount).and_even(hand);
            near.retune(self.built.heads.batter.tension(&place), &muffling);
        }
        if let (Some(far), Some(head)) = (bands.next(), &self.built.heads.resonant) {
            far.retune(head.tension(&place), &HighMuffling::NONE);
        }
    }

    fn finish_controls(&mut self) {
        self.controls.move_modes(Glide::jump, &mut self.stale);
        self.stale.losses |= self.controls.hand.jump() | std::mem::take(&mut self.controls.under_stick);
        if self.controls.preload.jump() {
            self.follow_preload();
        }
        self.follow_controls();
        self.follow_shapes();
    }

    fn modes(&self) -> Vec<ModeInfo> {
        let rows = self.surface.body().modes().iter().zip(&self.modes);
        let complete = rows.map(|(mode, row)| {
            let tuned = &self.built.modes[row.pair];
            let (body, n, kind) = describe(&self.built, tuned);
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
            body: if mode.part == RimPart::Wall { "shell" } else { "rim" },
            m: mode.n,
            n: mode.k,
            member: mode.member,
            frequency_hz: mode.mode.omega_d() / TAU,
            t60: SIGMA_T60 / mode.mode.sigma,
            modal_mass: mode.mode.mass,
            radiation: mode.monopole_area(),
            kind: Rim::kind(mode),
        });
        let slices = self.surface.high_bands().take(1).flat_map(HighBand::slices);
        complete.chain(slices.map(sampled)).chain(rim).collect()
    }

    fn tensions(&self) -> Vec<(&'static str, f64)> {
        let place = self.built.heads.scale.place(self.controls.pitch.value());
        let heads =
            [("batter", Some(&self.built.heads.batter)), ("resonant", self.built.heads.resonant.as_ref())];
        heads.into_iter().filter_map(|(name, head)| Some((name, head?.tension(&place)))).collect()
    }
}

#[cfg(test)]
mod tests;
