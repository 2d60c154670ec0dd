//! A drum: a head stretched to a pitch, struck and heard.
//!
//! Model: one head in air, its outer face radiating into a half-space. The shell, the air inside
//! and a second head are not modelled.

use crate::air::SPEED_OF_SOUND;
use crate::contact::Material;
use crate::damping::{LossLaw, Muffler};
use crate::error::SpecError;
use crate::glide::Glide;
use crate::listening::{ListeningPoint, Radiator, Rayleigh};
use crate::math::bessel;
use crate::membrane::{self, Membrane, MembraneSpec, ModeRange, Surroundings};
use crate::modal::Mode;
use crate::piece::{BuildOptions, ModeInfo, ModeKind};
use crate::shapes::{ShapeIndex, ShapeTable};
use crate::split::Splitting;
use crate::surface::{Surface, SurfaceParts};
use crate::tuned_head::{Place, TunedHead};

/// A drum's description.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrumSpec {
    /// The head that is struck.
    pub batter: MembraneSpec,
    /// The mode whose frequency is the drum's pitch: nodal diameters, nodal circles.
    pub named_mode: (u32, u32),
    /// Lowest, default and highest pitch, Hz.
    pub pitch_hz: (f64, f64, f64),
    /// What muffles it.
    pub muffler: Muffler,
    /// How uneven the head is.
    pub splitting: Splitting,
    /// Modes reach up to this at the default pitch, Hz.
    pub limit_hz: f64,
    /// Where it is heard from.
    pub listening_point: ListeningPoint,
}

const INCH: f64 = 0.0254;

/// Two-ply film of tom and kick heads, m.
const TWO_PLY: f64 = 0.36e-3;
/// Single-ply film, m.
const SINGLE_PLY: f64 = 0.19e-3;

/// A gel pad as drummers place it, near the rim. *By ear*.
const fn gel(sigma: f64) -> Muffler {
    Muffler::Gel { sigma, radius: 0.8, angle: 2.3 }
}

impl DrumSpec {
    fn with_head(diameter_in: f64, thickness: f64, constant: f64, per_khz: f64) -> DrumSpec {
        let batter = MembraneSpec {
            radius: 0.5 * diameter_in * INCH,
            thickness,
            material: Material::FILM,
            loss: LossLaw { constant, per_khz },
        };
        DrumSpec {
            batter,
            named_mode: (0, 1),
            pitch_hz: (55.0, 82.0, 160.0),
            muffler: gel(30.0),
            splitting: Splitting::DRUM,
            limit_hz: 3000.0,
            listening_point: ListeningPoint { distance: 0.5, inclination: 0.6, azimuth: 0.4 },
        }
    }

    /// 22 x 18 in bass drum with a pillow.
    pub fn kick() -> DrumSpec {
        DrumSpec {
            pitch_hz: (35.0, 55.0, 90.0),
            muffler: Muffler::Pillow { sigma: 21.0 },
            ..DrumSpec::with_head(22.0, TWO_PLY, 4.0, 12.0)
        }
    }

    /// 14 x 5.5 in snare drum.
    pub fn snare() -> DrumSpec {
        DrumSpec { pitch_hz: (140.0, 220.0, 360.0), ..DrumSpec::with_head(14.0, 0.25e-3, 4.0, 6.0) }
    }

    /// 12 x 9 in rack tom.
    pub fn rack_tom() -> DrumSpec {
        DrumSpec { pitch_hz: (90.0, 140.0, 260.0), ..DrumSpec::with_head(12.0, TWO_PLY, 3.0, 5.0) }
    }

    /// 16 x 16 in floor tom.
    pub fn floor_tom() -> DrumSpec {
        DrumSpec::with_head(16.0, TWO_PLY, 3.0, 5.0)
    }

    /// 26 in timpani.
    pub fn timpani() -> DrumSpec {
        DrumSpec {
            named_mode: (1, 1),
            pitch_hz: (87.3, 130.8, 196.0),
            splitting: Splitting::CLEARED,
            ..DrumSpec::with_head(26.0, SINGLE_PLY, 0.6, 1.5)
        }
    }
}

/// What does not change after the build: one entry per mode of the body.
struct DrumCoefs {
    head: TunedHead,
    /// `[mode]`: row of the tuned head.
    rows: Vec<usize>,
    /// `[mode]`: detuning of the member, a factor.
    detuning: Vec<f64>,
    /// `[mode]`: decay rate at full muffling, 1/s.
    muffling: Vec<f64>,
    /// `[mode]`: orders.
    orders: Vec<(u32, u32)>,
    lossless: bool,
}

/// A drum that can be struck.
pub struct Drum {
    surface: Surface,
    coefs: DrumCoefs,
    pitch: Glide,
    muffling: Glide,
    /// Whether a control has moved since the modes last followed.
    stale: bool,
    membrane: Membrane,
}

impl Drum {
    /// Builds a drum at its default pitch. Allocates; takes some tens of milliseconds.
    ///
    /// # Errors
    /// [`SpecError`] if a number is out of range.
    pub fn new(spec: &DrumSpec, options: &BuildOptions) -> Result<Drum, SpecError> {
        let (low, pitch, high) = spec.pitch_hz;
        SpecError::check("lowest pitch (Hz)", low, 15.0, 2000.0)?;
        SpecError::check("pitch (Hz)", pitch, low, high)?;
        let membrane = stretched(spec)?;
        let tension = |hz| {
            let (m, n) = spec.named_mode;
            membrane.tension_for(m, n, hz).unwrap_or(0.0)
        };
        let head = TunedHead::new(&membrane, [low, high], tension);
        let coefs = DrumCoefs::new(spec, &membrane, head, options);
        let place = coefs.head.place(pitch);
        let modes = (0..coefs.rows.len()).map(|k| coefs.mode(k, &place, 0.0)).collect();
        let surface = Surface::new(SurfaceParts {
            modes,
            shapes: shape_table(spec, &membrane, &coefs),
            transfer: transfer(spec, &membrane, &coefs, &place),
            material: spec.batter.material,
            lossless: options.lossless,
            sample_rate: options.sample_rate,
        });
        let (pitch, muffling) = (Glide::new(pitch, low, high), Glide::new(0.0, 0.0, 1.0));
        let mut drum = Drum { surface, coefs, pitch, muffling, stale: false, membrane };
        drum.lay_muffler(spec);
        Ok(drum)
    }

    /// Works out how much the muffler takes from each mode; it may need the shapes where it lies.
    fn lay_muffler(&mut self, spec: &DrumSpec) {
        self.coefs.muffling = match spec.muffler {
            Muffler::Pillow { sigma } => vec![sigma; self.coefs.rows.len()],
            Muffler::Gel { sigma, radius, angle } => {
                let mut shape = vec![0.0_f32; self.coefs.rows.len()];
                self.surface.shapes().fill(radius, angle, &mut shape);
                shape.iter().map(|&shape| sigma * f64::from(shape).powi(2)).collect()
            }
        };
    }

    /// The head and what is about it.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// The head and what is about it.
    pub fn surface_mut(&mut self) -> &mut Surface {
        &mut self.surface
    }

    /// Asks for a pitch (Hz) of the named mode.
    pub fn set_tuning(&mut self, hz: f64) {
        self.pitch.set(hz);
    }

    /// Asks for muffling, 0 to 1.
    pub fn set_muffling(&mut self, amount: f64) {
        self.muffling.set(amount);
    }

    /// Lets the controls glide for `seconds`.
    pub fn advance_controls(&mut self, seconds: f64) {
        let moved = [&mut self.pitch, &mut self.muffling].map(|glide| glide.advance(seconds));
        self.stale |= moved.contains(&true);
    }

    /// Lets the controls arrive at once.
    pub fn finish_controls(&mut self) {
        let moved = [&mut self.pitch, &mut self.muffling].map(Glide::jump);
        self.stale |= moved.contains(&true);
        self.follow_controls();
    }

    /// Brings the modes to where the controls are.
    ///
    /// # Real-time
    /// Nothing while they rest; linear in the number of modes while they move.
    pub fn follow_controls(&mut self) {
        if std::mem::take(&mut self.stale) {
            let place = self.coefs.head.place(self.pitch.value());
            let (coefs, muffling) = (&self.coefs, self.muffling.value());
            self.surface.retune(|k, _| coefs.mode(k, &place, muffling));
        }
    }

    /// Tension of the head, N/m.
    pub fn tension(&self) -> f64 {
        self.coefs.head.tension(&self.coefs.head.place(self.pitch.value()))
    }

    /// Every mode as it is now.
    pub fn modes(&self) -> Vec<ModeInfo> {
        let index = self.surface.shapes().index();
        let rows =
            self.surface.body().modes().iter().zip(index).zip(&self.coefs.orders).zip(&self.coefs.rows);
        rows.map(|(((mode, shape), &(m, n)), &row)| ModeInfo {
            body: "batter",
            m,
            n,
            member: shape.member,
            frequency_hz: mode.omega_d() / std::f64::consts::TAU,
            t60: crate::damping::SIGMA_T60 / mode.sigma,
            modal_mass: mode.mass,
            radiation: self.membrane.monopole_area(&self.membrane.modes()[row], mode.omega),
            kind: ModeKind::Complete,
        })
        .collect()
    }
}

/// The head with its modes chosen.
fn stretched(spec: &DrumSpec) -> Result<Membrane, SpecError> {
    let (low, pitch, high) = spec.pitch_hz;
    let (m, n) = spec.named_mode;
    // A first look with few modes finds the tensions; air at most quadruples the mass of the film's.
    let zero = bessel::zero(m, n);
    let guess = |hz| membrane::vacuum_tension(&spec.batter, zero, hz);
    let wide = [guess(low), 30.0 * guess(high)];
    let few = ModeRange { tension: wide, reference_tension: wide[1], limit_hz: 6.0 * high };
    let look = Membrane::new(spec.batter, Surroundings::Air, &few)?;
    let tension = |hz| look.tension_for(m, n, hz).unwrap_or(wide[1]);
    let range = ModeRange {
        tension: [tension(low), tension(high)],
        reference_tension: tension(pitch),
        limit_hz: spec.limit_hz,
    };
    Membrane::new(spec.batter, Surroundings::Air, &range)
}

impl DrumCoefs {
    /// Lays the pairs out as modes of a body, lowest first.
    fn new(spec: &DrumSpec, membrane: &Membrane, head: TunedHead, options: &BuildOptions) -> DrumCoefs {
        let splitting = if options.unsplit { Splitting::ROUND } else { spec.splitting };
        let mut coefs = DrumCoefs {
            head,
            rows: Vec::new(),
            detuning: Vec::new(),
            muffling: Vec::new(),
            orders: Vec::new(),
            lossless: options.lossless,
        };
        for (row, mode) in membrane.modes().iter().enumerate() {
            for (_, detuning) in splitting.members(mode.m, mode.n) {
                coefs.rows.push(row);
                coefs.detuning.push(detuning);
                coefs.muffling.push(0.0);
                coefs.orders.push((mode.m, mode.n));
            }
        }
        coefs
    }

    /// Mode `k` at a place of the tuning table, with an amount of muffling.
    fn mode(&self, k: usize, place: &Place, muffling: f64) -> Mode {
        let ringing = self.head.ringing(self.rows[k], place);
        let sigma = if self.lossless { 0.0 } else { ringing.sigma + muffling * self.muffling[k] };
        Mode { omega: ringing.omega * self.detuning[k], sigma, mass: ringing.mass }
    }
}

fn shape_table(spec: &DrumSpec, membrane: &Membrane, coefs: &DrumCoefs) -> ShapeTable {
    let mut index = Vec::with_capacity(coefs.rows.len());
    for (row, mode) in membrane.modes().iter().enumerate() {
        let axis = spec.splitting.axis(mode.m, mode.n);
        let members = Splitting::ROUND.members(mode.m, mode.n);
        index.extend(members.map(|(member, _)| ShapeIndex { radial: row, m: mode.m, member, axis }));
    }
    ShapeTable::new(&membrane.radial_shapes(&ShapeTable::radii()), index)
}

/// How each mode is heard at the listening point, `[mode]`.
fn transfer(spec: &DrumSpec, membrane: &Membrane, coefs: &DrumCoefs, place: &Place) -> Vec<[f64; 2]> {
    let finest = membrane.modes().iter().map(|mode| mode.zero).fold(0.0, f64::max);
    let highest = std::f64::consts::TAU * spec.limit_hz * spec.batter.radius / SPEED_OF_SOUND;
    let nodes = 12 + (0.7 * (finest + highest)) as usize;
    let rayleigh = Rayleigh::new(spec.batter.radius, spec.listening_point, nodes);
    let shapes = membrane.radial_shapes(rayleigh.radii());
    let mut out = Vec::with_capacity(coefs.rows.len());
    for ((row, mode), radial) in membrane.modes().iter().enumerate().zip(shapes.chunks_exact(nodes)) {
        let omega = coefs.head.ringing(row, place).omega;
        let [re, im] = rayleigh.transfer(&Radiator { m: mode.m, radial, omega });
        let axis = spec.splitting.axis(mode.m, mode.n);
        for (member, _) in Splitting::ROUND.members(mode.m, mode.n) {
            let share = rayleigh.toward(mode.m, member, axis);
            out.push([share * re, share * im]);
        }
    }
    out
}
