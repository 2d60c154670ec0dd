//! A hi-hat: two cymbals face to face, a rod, and a foot.
//!
//! ```text
//! foot --> rod --> clutch --> upper cymbal (shell, heave, tilt) <-- strikers
//!                                   | 32 contacts around the rim, the air in the gap
//!                 floor --> seat --> lower cymbal (shell, heave, tilt)
//! ```
//!
//! Model: two shallow [cymbals](crate::cymbal). The lower one is upside down and a little tilted, as stands hold it, so that
//! closed cymbals do not trap all of the air. The upper one hangs in a clutch on the rod, the lower one lies on a seat. Felts hold both:
//! springs and dampers for their rigid motion ([`rigid`]). The rims are not flat ([`warp`]) and touch by the law of every contact ([`pair`]). What air is between
//! the two presses them apart and leaves through what gap there is ([`gap_air`]). The upper
//! cymbal's modes are coupled by its stretching, as those of any other cymbal. The lower one's are not.
//!
//! The pedal is one control: from 0, with the rims [`GAP`] apart, over [`TOUCHING`], where rims without tilt would meet, to 1,
//! where they are pressed together by [`CLAMPING`]. Open, loose, half and tight are positions of it. The [foot] moves it at
//! a finite speed, and the sound follows from the contact of the rims.
//!
//! A stack of two cymbals is the same without pedal: a nut presses the rim of the upper one on the lower one, which may be wider.
//!
//! No real-time model of a hi-hat is published; the parts are as elsewhere in this crate. Energy: all contacts are discrete
//! gradients of one potential, solved together with the strikers through both bodies.

mod arriving;
mod attached;
mod fading;
pub mod foot;
pub mod gap_air;
pub mod half;
mod lobed_sound;
mod near_points;
mod outlet;
pub mod pair;
pub mod rigid;
pub mod rigid_sound;
pub mod rim_points;
mod settling;
mod solving;
pub mod spec;
mod step;
pub mod warp;

use std::f64::consts::TAU;

use crate::build_context::BuildContext;
use crate::contact::{ContactLaw, Tip};
use crate::cymbal::assembly::{self, PlateShapes};
use crate::cymbal::spec::CymbalSpec;
use crate::damping::SIGMA_T60;
use crate::error::SpecError;
use crate::fitted;
use crate::glide::Glide;
use crate::grip::Grip;
use crate::instrument::{Instrument, Pedal};
use crate::math::roots;
use crate::mode::{ModeInfo, ModeKind};
use crate::surface::Surface;

pub use pair::arrival::ARRIVAL;
pub use rim_points::POINTS;
pub use spec::HiHatSpec;

use foot::{Foot, SPEED, Step};
use gap_air::GapAir;
use half::{Damping, Half};
use pair::{Pair, PairParts};
use rigid::Rigid;
use rigid_sound::rigid_sound;

/// Mean distance of the rims while the pedal is up, m. *Literature*: players set 2 to 4 cm.
pub const GAP: f64 = 0.030;

/// Position of the pedal, as a share of its way, at which rims without tilt would touch. *By ear*: feet play mostly around it.
pub const TOUCHING: f64 = fitted::HAT_TOUCHING;

/// Force at the pedal's end, N. *Derived*: a seventh of a drummer's weight.
pub const CLAMPING: f64 = 100.0;

/// A hi-hat that can be struck and stepped on.
pub struct HiHat {
    surface: Surface,
    halves: [Half; 2],
    lossless: bool,
    tuning: Glide,
    muffling: Glide,
    hand: Grip,
    /// Amount of rubbing of the rims, 0 to 1, and the clamping force at which it is half, N.
    rubbing: f64,
    half_rubbing: f64,
    stale: bool,
    /// Position of the rod at the pedal's end, m.
    closed: f64,
    pedal: f64,
    /// Whether a nut holds the rod where a pedal would move it.
    is_stack: bool,
}

impl HiHat {
    /// Builds a hi-hat, pedal up. Allocates; takes some tenths of a second.
    ///
    /// # Errors
    /// [`SpecError`] if a number is out of range.
    pub fn new(spec: &HiHatSpec, context: &BuildContext) -> Result<HiHat, SpecError> {
        spec.check()?;
        let coupled_hz = assembly::coupled_hz(context);
        let [above, below] = spec.meeting();
        let top = Half::new(&spec.top, (&spec.clutch, spec.rubbing), above, coupled_hz, context)?;
        let bottom = Half::new(&spec.bottom, (&spec.seat, spec.rubbing), below, None, context)?;
        let (surface, halves) = assemble(spec, context, top, bottom);
        let (low, tuning, high) = CymbalSpec::TUNING;
        let mut hat = HiHat {
            surface,
            halves,
            lossless: context.ideal.lossless,
            tuning: Glide::new(tuning, low, high),
            muffling: Glide::new(0.0, 0.0, 1.0),
            hand: Grip::new(),
            rubbing: 0.0,
            half_rubbing: spec.half_rubbing,
            stale: true,
            closed: GAP,
            pedal: 0.0,
            is_stack: spec.pressed.is_some(),
        };
        hat.follow_controls();
        hat.closed = hat.find_closed(spec.pressed.unwrap_or(CLAMPING));
        if hat.is_stack {
            let pressed = hat.closed;
            hat.move_pedal(|foot| foot.go(pressed, SPEED.1));
            hat.finish_controls();
        }
        Ok(hat)
    }

    /// Position of the rod at which the rims press on each other with a force (N), m.
    fn find_closed(&self, force: f64) -> f64 {
        let clamping = |y: f64| self.pair().map_or(force, |pair| pair.clamping(y));
        // Far below any motion: the width of an atom.
        const TOLERANCE: f64 = 1e-11;
        let most = GAP + 0.05;
        // A light force is held by the highest spots alone, before the rims meet in the mean.
        let nearest = self.pair().map_or(GAP, |pair| pair.statics.nearest());
        let least = if clamping(GAP) > force { nearest } else { GAP };
        roots::find(|y| clamping(y) - force, least, most, TOLERANCE).unwrap_or(most)
    }

    /// Position of the rod for a position of the pedal, 0 to 1; m.
    ///
    /// The scale is finer where the rims are about to touch, as a millimetre there sounds like a centimetre farther apart.
    fn rod(&self, pedal: f64) -> f64 {
        if pedal < TOUCHING {
            GAP * (1.0 - (1.0 - pedal / TOUCHING).powi(2))
        } else {
            GAP + (self.closed - GAP) * ((pedal - TOUCHING) / (1.0 - TOUCHING)).powi(2)
        }
    }

    /// Goal of the pedal, from 0 (up) to 1 (down): a share of its way.
    pub fn pedal(&self) -> f64 {
        self.pedal
    }

    /// Moves the foot on the pedal.
    fn move_pedal(&mut self, send: impl FnOnce(&mut Foot)) {
        self.surface.with(|pair: &mut Pair, site| {
            pair.forget_step();
            send(pair.foot_mut());
            if pair.is_moved() {
                pair.engage(site.body.modal());
            }
        });
    }

    /// Lets a foot step on the pedal, from where it reaches the rims soon after.
    fn take(&mut self, step: Step) {
        let nearest = self.pair().map_or(GAP, |pair| pair.statics.nearest());
        let from = (nearest - FALL * step.speed.clamp(SPEED.0, SPEED.2)).max(0.0);
        self.surface.with(|pair: &mut Pair, site| pair.arrive(from, Some(step), site));
    }

    /// The lower cymbal and its contacts.
    fn pair(&self) -> Option<&Pair> {
        self.surface.attachment()
    }

    /// Amount of rubbing at the present clamping, 0 to 1.
    fn rubbing_now(&self) -> f64 {
        let clamped = self.pair().map_or(0.0, Pair::clamped);
        clamped / (clamped + self.half_rubbing)
    }
}

impl Instrument for HiHat {
    fn surface(&self) -> &Surface {
        &self.surface
    }

    fn surface_mut(&mut self) -> &mut Surface {
        &mut self.surface
    }

    fn set_tuning(&mut self, ratio: f64) {
        self.stale |= self.tuning.set(ratio);
    }

    fn set_muffling(&mut self, amount: f64) {
        self.stale |= self.muffling.set(amount);
    }

    fn pedal_mut(&mut self) -> Option<&mut dyn Pedal> {
        if self.is_stack { None } else { Some(self) }
    }

    fn choke(&mut self, strength: f64) {
        self.hand.set(strength);
    }

    fn has_moved(&self) -> bool {
        self.stale || self.hand.has_moved()
    }

    /// Rims that begin to rub do so within a block.
    fn is_urgent(&self) -> bool {
        (self.rubbing_now() - self.rubbing).abs() > RUBBING_STEP
    }

    fn advance_controls(&mut self, seconds: f64) {
        let moved = [&mut self.tuning, &mut self.muffling].map(|glide| glide.advance(seconds));
        self.stale |= moved.contains(&true);
        self.hand.advance(seconds);
    }

    fn follow_controls(&mut self) {
        if self.is_urgent() {
            (self.rubbing, self.stale) = (self.rubbing_now(), true);
        }
        if !self.has_moved() {
            return;
        }
        self.stale = false;
        let tuning = self.tuning.value();
        let damping = Damping {
            muffling: self.muffling.value(),
            hand: self.hand.follow(),
            rubbing: self.rubbing,
            lossless: self.lossless,
        };
        let [top, bottom] = &self.halves;
        if let Some(pair) = self.surface.attachment_mut::<Pair>() {
            pair.retune(|k| bottom.mode(k, tuning, &damping));
        }
        self.surface.retune(|k, _| top.mode(k, tuning, &damping));
        // A stiffer metal resists stretching as it resists bending.
        if let Some(force) = self.surface.nonlinear_force_mut() {
            force.set_stiffness(tuning * tuning);
        }
    }

    fn finish_controls(&mut self) {
        let moved = [&mut self.tuning, &mut self.muffling].map(Glide::jump);
        self.stale |= moved.contains(&true) | self.hand.jump();
        if let Some(pair) = self.surface.attachment_mut::<Pair>().filter(|pair| pair.is_moved()) {
            pair.come_to_rest();
        }
        let rubbing = self.rubbing_now();
        self.stale |= rubbing != self.rubbing;
        self.rubbing = rubbing;
        self.follow_controls();
    }

    fn modes(&self) -> Vec<ModeInfo> {
        let bodies = [
            ("top", Some(self.surface.body()), &self.halves[0]),
            ("bottom", self.pair().map(Pair::bottom), &self.halves[1]),
        ];
        let rows = bodies.into_iter().filter_map(|(name, body, half)| Some((name, body?, half)));
        rows.flat_map(|(name, body, half)| {
            body.modes().iter().zip(&half.cymbal.modes).map(move |(mode, built)| ModeInfo {
                body: name,
                m: built.m,
                n: built.n,
                member: built.member,
                frequency_hz: mode.omega_d() / TAU,
                t60: SIGMA_T60 / mode.sigma,
                modal_mass: half.cymbal.mass,
                radiation: built.monopole_area,
                kind: ModeKind::Complete,
            })
        })
        .collect()
    }
}

impl Pedal for HiHat {
    fn press(&mut self, pedal: f64, speed: f64) {
        if pedal.is_nan() || speed.is_nan() {
            return;
        }
        let pedal = pedal.clamp(0.0, 1.0);
        if pedal == self.pedal && speed == SPEED.1 {
            return;
        }
        self.pedal = pedal;
        let rod = self.rod(pedal);
        self.move_pedal(|foot| foot.go(rod, speed));
    }

    fn arrive(&mut self, pedal: f64) {
        if pedal.is_nan() {
            return;
        }
        let pedal = pedal.clamp(0.0, 1.0);
        if pedal == self.pedal && !self.pair().is_some_and(Pair::is_moved) {
            return;
        }
        self.pedal = pedal;
        let rod = self.rod(pedal);
        self.surface.with(|pair: &mut Pair, site| pair.arrive(rod, None, site));
    }

    fn stamp(&mut self, speed: f64) {
        if speed.is_nan() {
            return;
        }
        self.pedal = 1.0;
        let closed = self.closed;
        self.take(Step { speed, to: closed, then: None });
    }

    fn splash(&mut self, speed: f64) {
        if speed.is_nan() {
            return;
        }
        // Rims that are pressed together have to come apart to ring.
        self.pedal = self.pedal.min(SPLASHING);
        let rod = self.rod(self.pedal);
        self.take(Step { speed, to: GAP, then: Some(rod) });
    }
}

/// A splash leaves the pedal no farther down than this share of its way: the rims well apart.
pub const SPLASHING: f64 = 0.2;

/// Smallest change of the rubbing that the modes follow. Following every change would cost a block's time while the pedal
/// moves.
const RUBBING_STEP: f64 = 0.01;

/// Time of a step from its beginning until rims meet, s; what leads the foot there takes up to [`ARRIVAL`] more. *Judgement*: a note names a
/// sound, so that it is over soon, and rims are loudest 5 to 25 ms after they first meet.
const FALL: f64 = 3e-3;

/// The upper cymbal as the struck surface, with the pair attached.
fn assemble(
    spec: &HiHatSpec,
    context: &BuildContext,
    (mut top, struck): (Half, PlateShapes),
    (mut bottom, below): (Half, PlateShapes),
) -> (Surface, [Half; 2]) {
    let BuildContext { options, ideal, .. } = context;
    let lossless = ideal.lossless;
    let mut surface = struck.into_surface(&spec.top, &top.cymbal, context);
    let tip = Tip::Solid { material: spec.rim, radius: spec.edge };
    let law =
        ContactLaw::new(&tip, &spec.bottom.alloy.material(), if lossless { 1.0 } else { spec.restitution });
    let heights = spec.warp.heights();
    let leaning = spec.top.plate().radius() * spec.tilt;
    let dt = 1.0 / options.sample_rate;
    let radii = [&spec.top, &spec.bottom].map(|half| half.plate().radius());
    let rigid = [(&top, &spec.clutch, radii[0]), (&bottom, &spec.seat, radii[1])]
        .map(|(half, mount, radius)| Rigid::new((half.cymbal.mass, radius), mount, lossless, dt));
    surface.attach(Pair::new(PairParts {
        bottom: (0..bottom.cymbal.modes.len()).map(|k| bottom.cymbal.bare(k, 1.0)).collect(),
        transfers: below.transfers,
        folded: [std::mem::take(&mut top.folded), std::mem::take(&mut bottom.folded)],
        rigid,
        rigid_sounds: radii.map(|radius| rigid_sound(radius, &context.receivers, dt)),
        air: spec.pressed.is_none().then(|| {
            let plates = [spec.top.plate(), spec.bottom.plate()];
            GapAir::new(
                plates.each_ref(),
                &[std::mem::take(&mut top.volumes), std::mem::take(&mut bottom.volumes)],
                spec.edge,
                lossless,
                &context.receivers,
                dt,
            )
        }),
        law,
        lasting_loss: law.lambda(spec.lasting),
        depth: std::array::from_fn(|j| {
            GAP + leaning * (rim_points::angle(j) - spec.toward).cos() + heights[j]
        }),
        meeting: spec.meeting(),
        sample_rate: options.sample_rate,
    }));
    (surface, [top, bottom])
}
