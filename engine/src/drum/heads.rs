//! A drum's heads, stretched over its range of pitches, and the drum's modes at one of them.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::air_load::{DENSITY, MassCurves};
use crate::build_context::BuildContext;
use crate::cavity::{CavityOrder, HeadShape};
use crate::drum::coupled::{CoupledMode, OrderProblem, Stretched};
use crate::drum::spec::{DrumSpec, PitchOf};
use crate::drum::tuned::{PITCHES, PitchPosition, PitchScale};
use crate::error::SpecError;
use crate::high_band::{HighBandSpec, Receiver};
use crate::math::bessel::{self, JTable};
use crate::membrane::mesh::Slip;
use crate::membrane::{self, Membrane, MembraneMode, MembraneSpec, ModeRange, Surroundings};
use crate::surface::local_compliance::{LocalDot, LocalHeadCompliance};

/// Modes of the enclosed air up to this are kept as modes, Hz; above, air only rides along.
const CAVITY_LIMIT_HZ: f64 = 2500.0;

/// The pitch at which modes are chosen: the middle of the range, whatever the default, so that a drum tuned
/// live and one built at that pitch are made of the same.
pub(super) const MIDDLE: usize = PITCHES / 2;

/// Modes of the heads that enter, over those that are kept. *Converged*: the highest kept have neighbours that
/// are left out; without some of them they would be off by up to 9 cents, by an amount that depends on the pitch.
const BASIS: f64 = 1.15;

/// The same of a head with a dot, on which waves are shorter. *Converged*: with 1.15 the highest kept would be up to 1.7 % off.
const BASIS_UNDER_DOT: f64 = 1.4;

/// A head with its modes, and its tension at every pitch of the scale.
#[derive(Serialize, Deserialize)]
pub struct TunedHead {
    /// The head.
    pub membrane: Membrane,
    /// N/m.
    pub tensions: [f64; PITCHES],
    /// Its modes up to this are kept, at the middle pitch, Hz.
    limit_hz: f64,
}

impl TunedHead {
    /// Stretches a head so that its mode `(m, n)` runs through the pitches.
    fn new(
        spec: &MembraneSpec,
        limit_hz: f64,
        (m, n): (u32, u32),
        pitches: &[f64; PITCHES],
        curves: &mut MassCurves,
    ) -> Result<TunedHead, SpecError> {
        // A first look with few modes finds the tensions; the air weighs less than thirty films.
        let zero = bessel::zero(m, n);
        let high = pitches[PITCHES - 1];
        let most = 30.0 * membrane::vacuum_tension(spec, (m, zero), high);
        let few = ModeRange { reference_tension: most, limit_hz: 6.0 * high };
        let look = Membrane::sharing(*spec, Surroundings::Air, &few, curves)?;
        let tension = |hz| look.tension_for(m, n, hz).unwrap_or(most);
        let basis = if spec.dot.is_some() { BASIS_UNDER_DOT } else { BASIS };
        let range = ModeRange { reference_tension: tension(pitches[MIDDLE]), limit_hz: basis * limit_hz };
        let membrane = Membrane::sharing(*spec, Surroundings::Air, &range, curves)?.by_order();
        let tensions = pitches.map(|hz| membrane.tension_for(m, n, hz).unwrap_or_else(|| tension(hz)));
        Ok(TunedHead { membrane, tensions, limit_hz })
    }

    /// What the head does above its modes, in slices of that density (an octave), pressed on at so many places, which may be more than half a
    /// wave apart.
    pub fn high_band(
        &self,
        ear: Receiver,
        context: &BuildContext,
        (density, places, apart): (f64, usize, bool),
    ) -> HighBandSpec {
        let limit = TAU * self.limit_hz;
        let reached =
            |mode: &&MembraneMode| self.membrane.ringing(mode, self.tensions[MIDDLE]).omega <= limit;
        let pairs = self.membrane.modes().iter().filter(reached);
        HighBandSpec {
            head: *self.membrane.spec(),
            tensions: [self.tensions[0], self.tensions[MIDDLE], self.tensions[PITCHES - 1]],
            complete: pairs.map(|mode| if mode.m == 0 { 1 } else { 2 }).sum(),
            density,
            ear,
            lossless: context.ideal.lossless,
            sample_rate: context.options.sample_rate,
            seed: 100 + u32::from(ear.far),
            places,
            apart,
            air_loss: 1.0,
        }
    }

    /// Where the complete set ends at a place of the scale, rad/s.
    pub fn top(&self, place: &PitchPosition) -> f64 {
        TAU * self.limit_hz * (self.tension(place) / self.tensions[MIDDLE]).sqrt()
    }

    /// The head as a tip feels it from near, at a place of the scale.
    pub fn film(&self, place: &PitchPosition) -> LocalHeadCompliance {
        let (spec, now) = (self.membrane.spec(), self.tension(place));
        let reached = self.top(place);
        // Waves that fine move the air within their own length only: rho / k on either face.
        let bare = spec.area_density();
        let air = 2.0 * DENSITY * (now / bare).sqrt() / reached;
        let air = air * spec.mesh.map_or(1.0, |mesh| Slip::new(&mesh, spec.thickness, air, reached).mass);
        LocalHeadCompliance {
            radius: spec.radius,
            tension: now,
            density: bare + air,
            rigidity: spec.dented_rigidity(),
            stretching: spec.material.youngs_modulus * spec.thickness,
            reached,
            dents: true,
            dot: spec.dot.map(|dot| {
                let both = MembraneSpec { thickness: spec.thickness + dot.thickness, ..*spec };
                LocalDot {
                    reach: 0.5 * dot.diameter / spec.radius,
                    density: both.area_density() - spec.area_density(),
                    rigidity: both.dented_rigidity(),
                    stretching: both.material.youngs_modulus * both.thickness,
                }
            }),
        }
    }

    fn stretched(&self, pitch: usize) -> Stretched<'_> {
        Stretched { membrane: &self.membrane, tension: self.tensions[pitch] }
    }

    /// Tension at a pitch, N/m.
    pub fn tension(&self, place: &PitchPosition) -> f64 {
        place.blend(|i| self.tensions[i].ln()).exp()
    }

    /// First mode of order `m`, and how many there are.
    pub fn order(&self, m: u32) -> (usize, usize) {
        let modes = self.membrane.modes();
        let [first, end] = [m, m + 1].map(|m| modes.partition_point(|mode| mode.m < m));
        if first == end { (0, 0) } else { (first, end - first) }
    }
}

/// The heads with their tensions at every pitch.
#[derive(Serialize, Deserialize)]
pub struct TunedHeads {
    /// The pitches worked out.
    pub scale: PitchScale,
    /// The struck head; its modes in ascending order of diameters, then circles.
    pub batter: TunedHead,
    /// The other head.
    pub resonant: Option<TunedHead>,
}

/// The heads, each stretched by itself: what the drum makes of their pitches is not known yet.
pub struct BareHeads(TunedHeads);

impl BareHeads {
    /// Stretches the heads of a drum. Allocates; takes tenths of a second.
    ///
    /// # Errors
    /// [`SpecError`] if the spec is out of range.
    pub fn new(spec: &DrumSpec) -> Result<BareHeads, SpecError> {
        let [low, _, high] = spec.pitches();
        let named = spec.pitch_of.mode();
        let scale = PitchScale::new(low, high);
        let pitches = scale.pitches();
        let mut curves = MassCurves::default();
        let batter = TunedHead::new(
            &spec.membrane(&spec.batter),
            spec.batter.modes_to_hz,
            named,
            &pitches,
            &mut curves,
        )?;
        let resonant = spec
            .resonant
            .map(|resonant| {
                let ratio = resonant.pitch_ratio;
                let pitches = pitches.map(|hz| ratio * hz);
                let head = resonant.head();
                TunedHead::new(&spec.membrane(&head), head.modes_to_hz, named, &pitches, &mut curves)
            })
            .transpose()?;
        Ok(BareHeads(TunedHeads { scale, batter, resonant }))
    }

    /// The Bessel functions of their modes, `[order]`.
    pub fn tables(&self) -> Vec<JTable> {
        let TunedHeads { batter, resonant, .. } = &self.0;
        let reach = [Some(batter), resonant.as_ref()]
            .into_iter()
            .flatten()
            .flat_map(|head| head.membrane.modes().iter().map(|mode| mode.zero))
            .fold(0.0, f64::max);
        JTable::orders(self.0.orders(), reach + 1.0)
    }

    /// The heads as the drum needs them, its batter tuned by itself or as heard, as the spec says.
    pub fn tuned(self, spec: &DrumSpec, tables: &[JTable]) -> TunedHeads {
        let BareHeads(mut heads) = self;
        if spec.pitch_of == PitchOf::PrincipalHeard {
            heads.tune_as_heard(spec, tables);
        }
        heads
    }
}

impl TunedHeads {
    /// The highest order of the batter's modes.
    pub fn orders(&self) -> u32 {
        self.batter.membrane.modes().iter().map(|mode| mode.m).max().unwrap_or(0)
    }

    /// Stretches the batter so that its named mode has the pitches in the drum, not by itself.
    fn tune_as_heard(&mut self, spec: &DrumSpec, tables: &[JTable]) {
        let (m, n) = spec.pitch_of.mode();
        let air = self.air(spec, m);
        for (pitch, hz) in self.scale.pitches().into_iter().enumerate() {
            // The air moves a pitch by some percent and that by little with the tension.
            for _ in 0..3 {
                let solved = self.solve(spec, m, &tables[m as usize], air.as_ref(), pitch);
                let part = n as usize - 1;
                let most = solved.iter().max_by(|a, b| a.shares[part].total_cmp(&b.shares[part]));
                let Some(mode) = most else { return };
                self.batter.tensions[pitch] *= (TAU * hz / mode.omega).powi(2);
            }
        }
    }

    /// The enclosed air against the heads' modes of one order.
    pub fn air(&self, spec: &DrumSpec, m: u32) -> Option<CavityOrder> {
        spec.cavity().map(|cavity| cavity.order(m, &self.head_shapes(m), TAU * CAVITY_LIMIT_HZ))
    }

    /// The drum's modes of one order at one of the pitches.
    pub fn solve(
        &self,
        spec: &DrumSpec,
        m: u32,
        bessel: &JTable,
        air: Option<&CavityOrder>,
        pitch: usize,
    ) -> Vec<CoupledMode> {
        let problem = OrderProblem {
            m,
            batter: self.batter.stretched(pitch),
            resonant: self.resonant.as_ref().map(|head| head.stretched(pitch)),
            cavity: air,
            cavity_q: spec.cavity().map_or(1.0, |cavity| cavity.q),
            outside: spec.outside(),
            bessel,
        };
        problem.solve()
    }

    /// The heads' modes of one order as the cavity sees them, batter first.
    pub fn head_shapes(&self, m: u32) -> Vec<HeadShape> {
        let of = |head: &TunedHead, far| {
            let modes = head.membrane.modes().iter().filter(|mode| mode.m == m);
            modes.map(move |mode| HeadShape { zero: mode.zero, norm: mode.norm, far }).collect::<Vec<_>>()
        };
        let mut shapes = of(&self.batter, false);
        shapes.extend(self.resonant.iter().flat_map(|head| of(head, true)));
        shapes
    }
}
