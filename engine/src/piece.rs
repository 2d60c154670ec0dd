//! One piece of the kit: a drum or a cymbal, and what can be asked of it.

use crate::cymbal::{Cymbal, CymbalSpec};
use crate::damping::Muffler;
use crate::drum::{Drum, DrumSpec};
use crate::error::SpecError;
use crate::hi_hat::pair::Pair;
use crate::hi_hat::{HiHat, HiHatSpec};
use crate::kit::BLOCK;
use crate::layout::Layout;
use crate::listening::ListeningPoint;
use crate::microphones::{self, CloseMicrophone};
use crate::modal::EARS;
use crate::snapshot::{FieldShapes, PieceSnapshot, RimSnapshot, StrikeSnapshot, WireSnapshot};
use crate::strike::Strike;
use crate::surface::Surface;
use crate::surface::air::{AUDIBLE, Incident};

/// Which piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum PieceId {
    /// 22 x 18 in bass drum.
    Kick,
    /// 14 x 5.5 in snare drum.
    Snare,
    /// 12 x 9 in rack tom.
    RackTom,
    /// 16 x 16 in floor tom.
    FloorTom,
    /// 16 in crash cymbal.
    Crash,
    /// 20 in ride cymbal.
    Ride,
    /// 10 in splash cymbal.
    Splash,
    /// 26 in timpani.
    Timpani,
    /// 14 in hi-hat.
    HiHat,
}

impl PieceId {
    /// The pieces of the kit, in the order of every per-piece table.
    pub const KIT: [PieceId; 9] = [
        PieceId::Kick,
        PieceId::Snare,
        PieceId::RackTom,
        PieceId::FloorTom,
        PieceId::Crash,
        PieceId::Ride,
        PieceId::Splash,
        PieceId::Timpani,
        PieceId::HiHat,
    ];

    /// Every piece that can be built.
    pub const ALL: [PieceId; 9] = PieceId::KIT;

    /// Place in [`PieceId::KIT`], if the piece belongs to the kit.
    pub fn slot(self) -> Option<usize> {
        PieceId::KIT.iter().position(|&id| id == self)
    }

    /// The name used on command lines, in presets and on screen.
    pub fn name(self) -> &'static str {
        match self {
            PieceId::Kick => "kick",
            PieceId::Snare => "snare",
            PieceId::RackTom => "rack-tom",
            PieceId::FloorTom => "floor-tom",
            PieceId::Crash => "crash",
            PieceId::Ride => "ride",
            PieceId::Splash => "splash",
            PieceId::Timpani => "timpani",
            PieceId::HiHat => "hi-hat",
        }
    }

    /// The piece of that [`name`](Self::name), if there is one.
    pub fn from_name(name: &str) -> Option<PieceId> {
        PieceId::ALL.into_iter().find(|id| id.name() == name)
    }

    /// Whether the piece is a drum (it has a pitch to tune); the others are cymbals.
    pub fn is_drum(self) -> bool {
        !matches!(self, PieceId::Crash | PieceId::Ride | PieceId::Splash | PieceId::HiHat)
    }
}

/// How far up a cymbal's modes are coupled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Quality {
    /// To 1 kHz.
    Eco,
    /// To 2 kHz.
    #[default]
    Standard,
    /// To 4 kHz.
    High,
    /// To 8 kHz; not meant for real time.
    Offline,
}

impl Quality {
    /// Every quality, lowest first.
    pub const ALL: [Quality; 4] = [Quality::Eco, Quality::Standard, Quality::High, Quality::Offline];

    /// Highest mode of a cymbal that hard strokes couple with others, Hz.
    pub fn coupled_hz(self) -> f64 {
        match self {
            Quality::Eco => 1000.0,
            Quality::Standard => 2000.0,
            Quality::High => 4000.0,
            Quality::Offline => 8000.0,
        }
    }

    /// The name used on command lines and in presets.
    pub fn name(self) -> &'static str {
        match self {
            Quality::Eco => "eco",
            Quality::Standard => "standard",
            Quality::High => "high",
            Quality::Offline => "offline",
        }
    }

    /// The quality of that [`name`](Self::name), if there is one.
    pub fn from_name(name: &str) -> Option<Quality> {
        Quality::ALL.into_iter().find(|quality| quality.name() == name)
    }
}

/// How a piece is built, beyond what it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BuildOptions {
    /// Sample rate, Hz, 22,050 to 768,000.
    pub sample_rate: f64,
    /// All damping and radiation off: energy stays.
    pub lossless: bool,
    /// Perfectly round bodies: the two members of every pair share one frequency.
    pub unsplit: bool,
    /// Bending stays small: no stretch of heads, no coupling of modes.
    pub linear: bool,
    /// How far up a cymbal's modes are coupled.
    pub quality: Quality,
    /// Heads sound above their complete sets of modes; see [`high_band`](crate::drum::high_band).
    pub high_band: bool,
    /// Drums without what closes them: see [`DrumSpec::opened`].
    pub open: bool,
    /// Pitch of a drum's other head over the struck one's, if not its own.
    pub resonant_ratio: Option<f64>,
    /// Mean relative difference of the two members of a drum's pairs, if not its own: how uneven its tension is.
    pub unevenness: Option<f64>,
    /// What muffles a drum, if not its own.
    pub muffler: Option<Muffler>,
    /// Where the close microphone stands, if not at the piece's own listening point; see
    /// [`microphones`](crate::microphones) for where it stands in the kit.
    pub close: Option<ListeningPoint>,
}

impl BuildOptions {
    /// The instrument as it is played.
    pub fn new(sample_rate: f64) -> Self {
        BuildOptions {
            sample_rate,
            lossless: false,
            unsplit: false,
            linear: false,
            quality: Quality::Standard,
            high_band: true,
            open: false,
            resonant_ratio: None,
            unevenness: None,
            muffler: None,
            close: None,
        }
    }

    /// The instrument as it stands in the kit: heard by the piece's close microphone.
    pub fn in_kit(id: PieceId, sample_rate: f64) -> Self {
        BuildOptions { close: microphones::over_rim(id), ..BuildOptions::new(sample_rate) }
    }
}

/// What kind of mode a row of [`Piece::modes`] is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModeKind {
    /// A mode of the surface itself.
    Complete,
    /// One mode that stands for a slice of many.
    Sampled,
    /// A mode of the enclosed air.
    Cavity,
    /// The body moving as a whole on its stand.
    Rigid,
}

/// Which of the two modes of one order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Member {
    /// Shape proportional to `cos(m theta)`; the only one for `m = 0`.
    Cosine,
    /// Shape proportional to `sin(m theta)`.
    Sine,
}

/// One mode of a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeInfo {
    /// What vibrates: `batter`, `plate`, `stand`, ...
    pub body: &'static str,
    /// Nodal diameters.
    pub m: u32,
    /// Nodal circles; a membrane's rim counts, a plate's does not.
    pub n: u32,
    /// Member of the pair.
    pub member: Member,
    /// Damped frequency, Hz.
    pub frequency_hz: f64,
    /// Time to decay by 60 dB, s; infinite without losses.
    pub t60: f64,
    /// Modal mass with the air it carries, kg.
    pub modal_mass: f64,
    /// Radiated weight: area of the monopole that would radiate the mode's power, m2.
    pub radiation: f64,
    /// Kind of mode.
    pub kind: ModeKind,
}

/// Sound below this is silence, Pa: 100 dB under full scale.
const SILENT: f32 = 2e-4;

/// A piece with less energy of motion than this that has been silent for so long falls asleep, J and s. What is only held
/// bent does not keep it awake.
const STILL: f64 = 1e-10;
const DOZE: f64 = 0.05;

/// A built piece that can be struck and heard.
pub struct Piece {
    id: PieceId,
    voice: Voice,
    sample_rate: f64,
    /// Samples into the present block.
    phase: usize,
    /// Samples since the controls were last let glide.
    unglided: usize,
    /// Nothing moves and nothing is about: there is nothing to render.
    asleep: bool,
    quarantines: u32,
    close: CloseMicrophone,
    /// Largest sound since the block began, Pa, and samples for which it has been next to nothing.
    loudest: f32,
    quiet: usize,
}

enum Voice {
    Drum(Box<Drum>),
    Cymbal(Box<Cymbal>),
    HiHat(Box<HiHat>),
}

impl Voice {
    fn surface(&self) -> &Surface {
        match self {
            Voice::Drum(drum) => drum.surface(),
            Voice::Cymbal(cymbal) => cymbal.surface(),
            Voice::HiHat(hat) => hat.surface(),
        }
    }

    fn surface_mut(&mut self) -> &mut Surface {
        match self {
            Voice::Drum(drum) => drum.surface_mut(),
            Voice::Cymbal(cymbal) => cymbal.surface_mut(),
            Voice::HiHat(hat) => hat.surface_mut(),
        }
    }
}

impl Piece {
    /// Builds the default piece of that name. Allocates and takes up to a second.
    ///
    /// # Errors
    /// [`SpecError`] if the options are out of range.
    pub fn new(id: PieceId, options: &BuildOptions) -> Result<Piece, SpecError> {
        SpecError::check("sample rate (Hz)", options.sample_rate, 22_050.0, 768_000.0)?;
        let far_point = Layout::far_point(id);
        let drum = |spec: DrumSpec| {
            let listening_point = options.close.unwrap_or(spec.listening_point);
            let spec = DrumSpec { listening_point, far_point, ..spec.with(options) };
            Drum::new(&spec, options).map(|drum| (listening_point, Voice::Drum(Box::new(drum))))
        };
        let cymbal = |spec: CymbalSpec| {
            let listening_point = options.close.unwrap_or(spec.listening_point);
            let spec = CymbalSpec { listening_point, far_point, ..spec };
            Cymbal::new(&spec, options).map(|cymbal| (listening_point, Voice::Cymbal(Box::new(cymbal))))
        };
        let (close, voice) = match id {
            PieceId::Kick => drum(DrumSpec::kick())?,
            PieceId::Snare => drum(DrumSpec::snare())?,
            PieceId::RackTom => drum(DrumSpec::rack_tom())?,
            PieceId::FloorTom => drum(DrumSpec::floor_tom())?,
            PieceId::Timpani => drum(DrumSpec::timpani())?,
            PieceId::Crash => cymbal(CymbalSpec::crash())?,
            PieceId::Ride => cymbal(CymbalSpec::ride())?,
            PieceId::Splash => cymbal(CymbalSpec::splash())?,
            PieceId::HiHat => {
                let spec = HiHatSpec::default();
                let listening_point = options.close.unwrap_or(spec.top.listening_point);
                let spec = spec.heard_at(listening_point, far_point);
                (listening_point, Voice::HiHat(Box::new(HiHat::new(&spec, options)?)))
            }
        };
        Ok(Piece {
            id,
            voice,
            sample_rate: options.sample_rate,
            phase: 0,
            unglided: 0,
            asleep: true,
            quarantines: 0,
            close: CloseMicrophone::new(id, options.close, close),
            loudest: 0.0,
            quiet: 0,
        })
    }

    /// Which piece this is.
    pub fn id(&self) -> PieceId {
        self.id
    }

    /// Lowest, default and highest of [`set_tuning`](Self::set_tuning): Hz for drums, ratio for
    /// cymbals.
    pub fn tuning_range(id: PieceId) -> (f64, f64, f64) {
        match id {
            PieceId::Kick => DrumSpec::kick().pitch_hz,
            PieceId::Snare => DrumSpec::snare().pitch_hz,
            PieceId::RackTom => DrumSpec::rack_tom().pitch_hz,
            PieceId::FloorTom => DrumSpec::floor_tom().pitch_hz,
            PieceId::Timpani => DrumSpec::timpani().pitch_hz,
            PieceId::Crash | PieceId::Ride | PieceId::Splash | PieceId::HiHat => CymbalSpec::TUNING,
        }
    }

    /// Asks for a pitch: of the named mode of a drum, Hz; of a cymbal, a ratio to its own.
    ///
    /// Acts while it rings, gliding over a few milliseconds from this sample on; clamped to the range.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn set_tuning(&mut self, tuning: f64) {
        self.glide();
        match &mut self.voice {
            Voice::Drum(drum) => drum.set_tuning(tuning),
            Voice::Cymbal(cymbal) => cymbal.set_tuning(tuning),
            Voice::HiHat(hat) => hat.set_tuning(tuning),
        }
    }

    /// Asks for muffling, 0 (none) to 1 (all there is). Acts while it rings, as the tuning does.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn set_muffling(&mut self, amount: f64) {
        self.glide();
        match &mut self.voice {
            Voice::Drum(drum) => drum.set_muffling(amount),
            Voice::Cymbal(cymbal) => cymbal.set_muffling(amount),
            Voice::HiHat(hat) => hat.set_muffling(amount),
        }
    }

    /// Lets a hand take hold of a cymbal, firmly at 1, or let go of it, 0. Closes over some 25 ms from
    /// this sample on; takes energy and gives none. Drums are not choked.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn choke(&mut self, strength: f64) {
        self.glide();
        match &mut self.voice {
            Voice::Drum(_) => {}
            Voice::Cymbal(cymbal) => cymbal.choke(strength),
            Voice::HiHat(hat) => hat.choke(strength),
        }
    }

    /// Brings a hi-hat's pedal to a place, 0 (up, open) to 1 (down, clamped), from the next sample on, at up to a
    /// speed (m/s, see [`SPEED`](crate::hi_hat::foot::SPEED)). Other pieces have no such pedal.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn press_pedal(&mut self, pedal: f64, speed: f64) {
        if let Voice::HiHat(hat) = &mut self.voice {
            hat.press(pedal, speed);
            self.asleep = false;
        }
    }

    /// Stamps on a hi-hat's pedal: brings it down at up to a speed (m/s); one that is down already is lifted first.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn stamp_pedal(&mut self, speed: f64) {
        if let Voice::HiHat(hat) = &mut self.voice {
            hat.stamp(speed);
            self.asleep = false;
        }
    }

    /// Splashes with a hi-hat's pedal: brings the rims together at up to a speed (m/s) and lets them go at once.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn splash_pedal(&mut self, speed: f64) {
        if let Voice::HiHat(hat) = &mut self.voice {
            hat.splash(speed);
            self.asleep = false;
        }
    }

    /// Throws snare wires on (from where the head is now) or off, at the next sample. Pieces without wires
    /// have none to throw.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn throw_wires(&mut self, on: bool) {
        self.glide();
        if let Voice::Drum(drum) = &mut self.voice {
            drum.throw_wires(on);
        }
    }

    /// Asks for a force that presses the snare wires on, all of them together, N; see
    /// [`PRELOAD`](crate::surface::wires::PRELOAD) for the range. Acts while they buzz, gliding.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn set_preload(&mut self, newtons: f64) {
        self.glide();
        if let Voice::Drum(drum) = &mut self.voice {
            drum.set_preload(newtons);
        }
    }

    /// What the snare wires have done since the latest stroke.
    pub fn wires(&self) -> WireSnapshot {
        self.voice.surface().wires()
    }

    /// What a hi-hat's rims have done since the latest stroke.
    pub fn rims(&self) -> RimSnapshot {
        self.voice.surface().pair().map_or_else(RimSnapshot::default, Pair::landings)
    }

    /// Lets tuning and muffling arrive at once instead of gliding.
    ///
    /// # Real-time
    /// No allocation, no lock; linear in the number of modes.
    pub fn finish_controls(&mut self) {
        match &mut self.voice {
            Voice::Drum(drum) => drum.finish_controls(),
            Voice::Cymbal(cymbal) => cymbal.finish_controls(),
            Voice::HiHat(hat) => hat.finish_controls(),
        }
    }

    /// Lets the controls glide up to now, so that what is asked next starts here, not at a block.
    fn glide(&mut self) {
        let seconds = std::mem::take(&mut self.unglided) as f64 / self.sample_rate;
        match &mut self.voice {
            Voice::Drum(drum) => drum.advance_controls(seconds),
            Voice::Cymbal(cymbal) => cymbal.advance_controls(seconds),
            Voice::HiHat(hat) => hat.advance_controls(seconds),
        }
    }

    /// Strikes at the next sample. Speed and radius are clamped; a stroke with a number that is not
    /// finite is not played.
    ///
    /// # Real-time
    /// No allocation, no lock; cost is linear in the number of modes.
    pub fn strike(&mut self, strike: &Strike) {
        if !strike.is_finite() {
            return;
        }
        self.asleep = false;
        match &mut self.voice {
            Voice::Drum(drum) => drum.strike(strike),
            Voice::Cymbal(cymbal) => cymbal.surface_mut().strike(strike),
            Voice::HiHat(hat) => hat.surface_mut().strike(strike),
        }
    }

    /// Renders sound pressure at the piece's listening point, Pa, overwriting `out`. Any length;
    /// how time is cut into calls does not change a sample.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render(&mut self, out: &mut [f32]) {
        let mut rest = out;
        while !rest.is_empty() {
            if self.phase == 0 {
                self.begin_block();
            }
            let run = rest.len().min(BLOCK - self.phase);
            let (now, later) = rest.split_at_mut(run);
            if self.asleep {
                now.fill(0.0);
            } else {
                self.voice.surface_mut().render(now);
            }
            self.phase = (self.phase + run) % BLOCK;
            self.unglided += run;
            rest = later;
        }
    }

    /// Renders sound pressure at the close microphone, far away as at a metre, and what other pieces hear as at a
    /// metre, Pa, while sound from elsewhere arrives. At most to the end of the piece's block.
    ///
    /// As [`render`](Self::render), but what cannot be heard any more falls asleep, and what sleeps wakes when sound above
    /// [`AUDIBLE`] reaches it.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render_in_air(&mut self, mut out: [&mut [f32]; EARS], incident: Option<Incident<'_>>) {
        if self.phase == 0 {
            self.doze();
            self.begin_block();
        }
        let samples = out[0].len();
        debug_assert!(samples <= BLOCK - self.phase);
        let incident = incident.filter(|_| self.voice.surface().listens());
        let deaf = self.asleep || self.voice.surface().has_parked_wires();
        let loud = |incident: Incident<'_>| incident.iter().position(|pressure| pressure.abs() > AUDIBLE);
        let wakes = incident.filter(|_| deaf).and_then(loud);
        let before = wakes.unwrap_or(samples);
        self.render_stretch(out.each_mut().map(|out| &mut out[..before]), incident, 0);
        if wakes.is_some() {
            self.hear();
            self.render_stretch(out.each_mut().map(|out| &mut out[before..]), incident, before);
        }
        self.loudest = out.iter().flat_map(|out| out.iter()).fold(self.loudest, |size, x| size.max(x.abs()));
        self.phase = (self.phase + samples) % BLOCK;
        self.unglided += samples;
    }

    /// Renders from sample `from` of what arrives on.
    fn render_stretch(&mut self, out: [&mut [f32]; EARS], incident: Option<Incident<'_>>, from: usize) {
        if self.asleep {
            out.into_iter().for_each(|out| out.fill(0.0));
            return;
        }
        let to = from + out[0].len();
        self.voice.surface_mut().render_in_air(out, incident.map(|incident| &incident[from..to]));
    }

    /// Wakes by sound.
    fn hear(&mut self) {
        self.asleep = false;
        self.quiet = 0;
        if let Voice::Drum(drum) = &mut self.voice {
            drum.follow_shapes();
        }
        self.voice.surface_mut().hear();
    }

    /// Falls asleep if nothing has been heard of it for a while and next to nothing moves.
    fn doze(&mut self) {
        let silent = std::mem::take(&mut self.loudest) < SILENT;
        let surface = self.voice.surface();
        if self.asleep || !silent || surface.is_struck() || surface.motion() > STILL {
            self.quiet = 0;
            return;
        }
        self.quiet += BLOCK;
        if self.quiet as f64 >= DOZE * self.sample_rate {
            self.quiet = 0;
            self.voice.surface_mut().rest();
            self.asleep = true;
        }
    }

    /// Its close microphone.
    pub fn close(&self) -> &CloseMicrophone {
        &self.close
    }

    /// What is done once a block: controls followed, silence made exact, faults caught.
    fn begin_block(&mut self) {
        self.glide();
        match &mut self.voice {
            Voice::Drum(drum) => drum.follow_controls(),
            Voice::Cymbal(cymbal) => cymbal.follow_controls(),
            Voice::HiHat(hat) => hat.follow_controls(),
        }
        if self.asleep {
            return;
        }
        if !self.voice.surface_mut().settle() {
            self.quarantines = self.quarantines.saturating_add(1);
        }
        self.asleep = self.voice.surface().is_still();
    }

    /// Whether nothing moves and nothing is about: there is nothing to hear until the next stroke.
    pub fn is_asleep(&self) -> bool {
        self.asleep
    }

    /// Puts the piece's block grid at `phase` samples into a block, as its kit's is.
    pub fn align(&mut self, phase: usize) {
        self.phase = phase % BLOCK;
    }

    /// Puts the piece to rest and at the start of a block.
    pub fn reset(&mut self) {
        self.voice.surface_mut().reset();
        self.asleep = true;
        (self.loudest, self.quiet) = (0.0, 0);
        self.finish_controls();
        self.phase = 0;
        self.unglided = 0;
    }

    /// What the latest stroke's contact measured.
    pub fn last_strike(&self) -> StrikeSnapshot {
        self.voice.surface().last_strike()
    }

    /// Vibration energy of the piece itself, J.
    pub fn energy(&self) -> f64 {
        self.voice.surface().energy()
    }

    /// Kinetic energy of the strikers about and energy held in their contacts, J.
    pub fn striker_energy(&self) -> f64 {
        self.voice.surface().striker_energy()
    }

    /// Kinetic energy that strikers have come with since the last reset, J.
    pub fn brought_energy(&self) -> f64 {
        self.voice.surface().brought_energy()
    }

    /// Energy that strikers have taken away with them since the last reset, J.
    pub fn departed_energy(&self) -> f64 {
        self.voice.surface().departed_energy()
    }

    /// Times the piece was put back to rest because a value was not finite.
    pub fn quarantines(&self) -> u32 {
        self.quarantines
    }

    /// Every mode with the present tuning and muffling, lowest first. Allocates.
    pub fn modes(&self) -> Vec<ModeInfo> {
        match &self.voice {
            Voice::Drum(drum) => drum.modes(),
            Voice::Cymbal(cymbal) => cymbal.modes(),
            Voice::HiHat(hat) => hat.modes(),
        }
    }

    /// Tension of each stretched body, N/m: `("batter", 2729.0)`. Empty for cymbals. Allocates.
    pub fn tensions(&self) -> Vec<(&'static str, f64)> {
        match &self.voice {
            Voice::Drum(drum) => drum.tensions(),
            Voice::Cymbal(_) | Voice::HiHat(_) => Vec::new(),
        }
    }

    /// The surface that is struck, for tests and tools that look closely.
    pub fn surface_mut(&mut self) -> &mut Surface {
        // It may be set going.
        self.asleep = false;
        self.voice.surface_mut()
    }

    /// Mode shapes for the displacement field. Allocates.
    pub fn field_shapes(&self) -> FieldShapes {
        let surface = self.voice.surface();
        let mut all = vec![0.0_f32; surface.body().len()];
        let points = FieldShapes::grid();
        let shapes = points
            .iter()
            .map(|&[x, y]| {
                // Angle 0 is toward the player, who looks along y.
                let (radius, angle) = (f64::from(x.hypot(y)), f64::from(x.atan2(-y)));
                surface.shapes().fill(radius, angle, &mut all);
                std::array::from_fn(|k| all.get(k).copied().unwrap_or(0.0))
            })
            .collect();
        FieldShapes { points, shapes }
    }

    /// Fills in what is known of the piece but for its peak, which the mix measures.
    ///
    /// # Real-time
    /// Linear in the number of modes.
    pub fn snapshot(&self, into: &mut PieceSnapshot) {
        let body = self.voice.surface().body();
        into.ready = true;
        into.energy = self.energy() as f32;
        into.strike = self.last_strike();
        into.wires = self.wires();
        into.rims = self.rims();
        into.quarantines = self.quarantines;
        into.hurried_strikers = self.voice.surface().hurried_strikers();
        for (k, q) in into.displacement.iter_mut().enumerate() {
            *q = if k < body.len() { body.displacement(k) } else { 0.0 };
        }
    }
}
