//! The performer: turns notes and parameters into strikes and controls of the kit.
//!
//! Every musical decision of the plugin is made here and none in the glue to the framework, so
//! that whoever drives a performer with the same notes, values and sample times, be it a host or
//! a command line, hears the same samples.

use no_denormals::no_denormals;
use overhear_engine::error::SpecError;
use overhear_engine::hi_hat::foot::SPEED;
use overhear_engine::kit::{Control, Kit};
use overhear_engine::piece::{BuildOptions, Piece, PieceId};
use overhear_engine::snapshot::KitSnapshot;
use overhear_engine::strike::Strike;

use crate::midi_map::{self, Foot};
use crate::parameters::{Drives, PARAMETERS};

/// Stick speed of the softest note, m/s. *By ear*: the faintest tap a pad reports.
pub const SOFTEST: f64 = 0.4;

/// Velocity of the softest note: 1 of MIDI's 127.
const LEAST_VELOCITY: f64 = 1.0 / 127.0;

/// A MIDI velocity, 0 to 127, as a share of full velocity.
pub fn velocity_from_midi(velocity: u8) -> f32 {
    f32::from(velocity) / 127.0
}

/// Stick speed, m/s, of a velocity (0 to 1), given the speed at full velocity.
///
/// Equal steps of velocity are equal ratios of speed, as loudness is heard.
pub fn stick_speed(velocity: f32, full: f64) -> f64 {
    let share = (f64::from(velocity) - LEAST_VELOCITY) / (1.0 - LEAST_VELOCITY);
    SOFTEST * libm::pow(full / SOFTEST, share.clamp(0.0, 1.0))
}

/// Slowest and fastest of a foot on the hi-hat's pedal, m/s. *By ear*: what the softest and the loudest note sound like.
const FOOT: (f64, f64) = (0.15, 2.0);

/// Speed of a foot, m/s, of a velocity (0 to 1); spaced as [`stick_speed`] is.
fn foot_speed(velocity: f32) -> f64 {
    FOOT.0 * libm::pow(FOOT.1 / FOOT.0, f64::from(velocity).clamp(0.0, 1.0))
}

/// A kit and who plays it.
pub struct Performer {
    kit: Kit,
    /// Values as asked for, `[parameter]`: hosts repeat all of them with every buffer.
    asked: [f32; PARAMETERS.len()],
    /// Plain values, `[parameter]`.
    values: [f32; PARAMETERS.len()],
    /// Stick speed at full velocity, m/s.
    dynamics: f64,
    /// Whether a controller plays the hi-hat's pedal.
    pedal_played: bool,
    /// Whether anything was played or rendered since the start or the latest reset.
    started: bool,
}

impl Performer {
    /// A performer at a kit that has no pieces yet, every parameter at its default.
    pub fn new(sample_rate: f64) -> Performer {
        let mut performer = Performer {
            kit: Kit::new(sample_rate),
            asked: [f32::NAN; PARAMETERS.len()],
            values: [f32::NAN; PARAMETERS.len()],
            dynamics: 0.0,
            pedal_played: false,
            started: false,
        };
        for (index, parameter) in PARAMETERS.iter().enumerate() {
            performer.set_parameter(index, parameter.default);
        }
        performer
    }

    /// Builds and installs every piece of the kit, on this thread. Takes seconds.
    ///
    /// # Errors
    /// [`SpecError`] if the sample rate is out of range.
    pub fn install_kit(&mut self, sample_rate: f64) -> Result<(), SpecError> {
        for id in PieceId::KIT {
            self.install(Box::new(Piece::new(id, &BuildOptions::new(sample_rate))?));
        }
        Ok(())
    }

    /// Puts a piece in its place and returns what stood there, to be dropped elsewhere.
    ///
    /// # Real-time
    /// No allocation; nothing is dropped here.
    pub fn install(&mut self, piece: Box<Piece>) -> Option<Box<Piece>> {
        flushed(|| self.kit.install(piece))
    }

    /// Plays a note at the next sample: velocity 0 to 1, any channel. Says whether it strikes.
    ///
    /// A velocity of nothing is MIDI's other way to end a note and is silent.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn note_on(&mut self, note: u8, velocity: f32, _channel: u8) -> bool {
        // Written so that a velocity that is not a number is silent as well.
        let sounds = velocity > 0.0;
        if let Some(foot) = midi_map::foot(note).filter(|_| sounds) {
            self.step(foot, velocity);
            if midi_map::stroke(note).is_none() {
                return true;
            }
        }
        let Some(stroke) = midi_map::stroke(note).filter(|_| sounds) else {
            return false;
        };
        let strike = Strike {
            speed: stick_speed(velocity, self.dynamics),
            radius: stroke.radius,
            angle: stroke.angle,
            striker: stroke.striker,
        };
        self.start();
        flushed(|| self.kit.strike(stroke.piece, &strike));
        true
    }

    /// What a note does with the hi-hat's pedal.
    fn step(&mut self, foot: Foot, velocity: f32) {
        let speed = foot_speed(velocity);
        if !matches!(foot, Foot::Brought(_)) {
            self.start();
        }
        flushed(|| match foot {
            Foot::Brought(_) if self.pedal_played => {}
            // As fast as can be: a drummer would have been there before the stroke.
            Foot::Brought(pedal) => self.kit.press_pedal(pedal, SPEED.2),
            Foot::Chick => self.kit.stamp_pedal(speed),
            Foot::Splash => self.kit.splash_pedal(speed),
        });
    }

    /// Moves the hi-hat's pedal, 0 (up) to 1 (down), as a foot controller does; from then on notes leave it where it
    /// is.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn press_pedal(&mut self, pedal: f32) {
        self.pedal_played = true;
        self.start();
        flushed(|| self.kit.set(Control::Pedal, f64::from(pedal)));
    }

    /// Moves a parameter, by its index in [`PARAMETERS`], to a plain value from the next sample
    /// on; before the first note and sample it is there at once. The value is
    /// [snapped](crate::parameters::Parameter::snap); an unchanged one and an unknown index do
    /// nothing.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn set_parameter(&mut self, index: usize, value: f32) {
        let Some(parameter) = PARAMETERS.get(index) else {
            return;
        };
        if std::mem::replace(&mut self.asked[index], value) == value {
            return;
        }
        let value = parameter.snap(value);
        if value == self.values[index] {
            return;
        }
        self.values[index] = value;
        let value = f64::from(value);
        match parameter.drives {
            Drives::Control(control) => flushed(|| self.kit.set(control, value)),
            Drives::Semitones(piece) => {
                let ratio = libm::exp2(value / 12.0);
                flushed(|| self.kit.set(Control::Tuning(piece), ratio));
            }
            Drives::Dynamics => self.dynamics = value,
        }
    }

    /// The present plain value of a parameter, by its index in [`PARAMETERS`].
    pub fn parameter(&self, index: usize) -> Option<f32> {
        self.values.get(index).copied()
    }

    /// Renders both outputs, full scale 1, overwriting them. Any length, both the same; the cut
    /// into calls does not change the samples.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        self.start();
        flushed(|| self.kit.render(left, right));
    }

    /// Whether every piece has been installed.
    pub fn is_complete(&self) -> bool {
        self.kit.is_complete()
    }

    /// Puts every piece to rest; parameters keep their values.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn reset(&mut self) {
        if !self.pedal_played {
            // Where notes have left it is forgotten, where a foot is is not.
            let pedal = PARAMETERS.iter().zip(self.values);
            let pedal = pedal.filter(|(parameter, _)| parameter.drives == Drives::Control(Control::Pedal));
            pedal.for_each(|(_, value)| self.kit.set(Control::Pedal, f64::from(value)));
        }
        flushed(|| self.kit.reset());
        self.started = false;
    }

    /// Lets what was set before the first sample be there from the first sample: hosts send a
    /// project's values as late as with the first buffer, and the sound must not glide to them.
    fn start(&mut self) {
        if !self.started {
            self.started = true;
            flushed(|| self.kit.finish_controls());
        }
    }

    /// Describes the kit to whoever draws it, and starts the peaks anew.
    ///
    /// # Real-time
    /// A copy, no allocation.
    pub fn snapshot(&mut self, into: &mut KitSnapshot) {
        self.kit.snapshot(into);
    }
}

/// Runs the engine with denormal numbers flushed to zero and puts the thread's mode back.
///
/// Hosts call with either mode; a tail that fades through denormals must neither cost a hundred
/// times as much in one of them nor sound different.
#[allow(unsafe_code)]
fn flushed<T>(engine: impl FnOnce() -> T) -> T {
    // SAFETY: only the flush-to-zero and denormals-are-zero modes change, and only in here; no
    // code in the engine relies on denormals, and the former mode returns before any other code
    // runs.
    unsafe { no_denormals(engine) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 48_000.0;

    #[test]
    fn velocity_runs_from_the_softest_tap_to_the_dynamics() {
        assert_eq!(stick_speed(velocity_from_midi(1), 6.0) as f32, 0.4);
        assert_eq!(stick_speed(velocity_from_midi(127), 6.0), 6.0);
        assert_eq!(stick_speed(1.0, 10.0), 10.0);
        assert_eq!(stick_speed(0.001, 6.0), SOFTEST);
        assert_eq!(stick_speed(2.0, 6.0), 6.0);
    }

    #[test]
    fn equal_steps_of_velocity_are_equal_ratios_of_speed() {
        let speed = |velocity| stick_speed(velocity_from_midi(velocity), 6.0);
        let ratio = speed(2) / speed(1);
        for velocity in 2..=127 {
            assert!((speed(velocity) / speed(velocity - 1) / ratio - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn only_notes_of_the_map_with_a_velocity_strike() {
        let mut performer = Performer::new(RATE);
        assert!(performer.note_on(38, 0.5, 9));
        for (note, velocity) in [(38, 0.0), (38, -1.0), (38, f32::NAN), (39, 1.0), (200, 1.0)] {
            assert!(!performer.note_on(note, velocity, 0), "{note} at {velocity}");
        }
        let mut snapshot = KitSnapshot::default();
        performer.snapshot(&mut snapshot);
        assert_eq!(snapshot.dropped_strikes, 1, "the snare is not built");
    }

    #[test]
    fn parameters_snap_and_ignore_what_they_cannot_take() {
        let mut performer = Performer::new(RATE);
        performer.set_parameter(0, 60.004);
        assert_eq!(performer.parameter(0), Some(60.0));
        performer.set_parameter(0, f32::INFINITY);
        assert_eq!(performer.parameter(0), Some(90.0));
        performer.set_parameter(0, f32::NAN);
        assert_eq!(performer.parameter(0), Some(55.0));
        performer.set_parameter(PARAMETERS.len(), 1.0);
    }

    /// One event: sample, then a note and velocity, or a parameter and value.
    enum Event {
        Note(usize, u8, f32),
        Parameter(usize, usize, f32),
    }

    fn score() -> Vec<Event> {
        use Event::*;
        vec![
            Note(0, 36, 1.0),
            Note(0, 49, 0.9),
            Parameter(700, 0, 62.0),
            Note(1_001, 38, 0.3),
            Parameter(1_001, 4, 0.4),
            Note(2_048, 48, 0.7),
            Note(2_049, 41, 0.8),
            Note(3_000, 51, 0.5),
            Parameter(3_300, 15, -2.0),
            Note(4_000, 55, 1.0),
            Parameter(5_000, 21, -6.0),
        ]
    }

    /// Renders the score in buffers of the given sizes, in turn.
    fn play(sizes: &[usize]) -> (Vec<f32>, Vec<f32>) {
        const LENGTH: usize = 9_600;
        let mut performer = Performer::new(RATE);
        performer.install_kit(RATE).unwrap();
        let (mut left, mut right) = (vec![f32::NAN; LENGTH], vec![f32::NAN; LENGTH]);
        let mut score = score().into_iter().peekable();
        let (mut now, mut sizes) = (0, sizes.iter().cycle());
        while now < LENGTH {
            let end = LENGTH.min(now + sizes.next().unwrap());
            while now < end {
                let at = |event: &Event| match *event {
                    Event::Note(at, ..) | Event::Parameter(at, ..) => at,
                };
                while let Some(event) = score.next_if(|event| at(event) == now) {
                    match event {
                        Event::Note(_, note, velocity) => {
                            performer.note_on(note, velocity, 9);
                        }
                        Event::Parameter(_, index, value) => performer.set_parameter(index, value),
                    }
                }
                let until = score.peek().map_or(end, |event| at(event).min(end));
                performer.render(&mut left[now..until], &mut right[now..until]);
                now = until;
            }
        }
        (left, right)
    }

    #[test]
    fn values_set_before_the_first_sample_do_not_glide() {
        let start = |early: bool| {
            let mut performer = Performer::new(RATE);
            if early {
                performer.set_parameter(3, 300.0);
            }
            performer.install_kit(RATE).unwrap();
            performer.set_parameter(3, 300.0);
            performer.note_on(38, 1.0, 9);
            let mut sound = [vec![0.0; 4_800], vec![0.0; 4_800]];
            let [left, right] = &mut sound;
            performer.render(left, right);
            sound
        };
        assert!(start(true) == start(false));
    }

    #[test]
    fn a_reset_performer_plays_like_a_new_one() {
        let hit = |performer: &mut Performer| {
            performer.note_on(36, 0.9, 9);
            performer.note_on(49, 0.6, 9);
            let mut sound = [vec![0.0; 4_800], vec![0.0; 4_800]];
            let [left, right] = &mut sound;
            performer.render(left, right);
            sound
        };
        let mut performer = Performer::new(RATE);
        performer.install_kit(RATE).unwrap();
        let first = hit(&mut performer);
        assert!(first.iter().flatten().any(|&sample| sample != 0.0));
        performer.render(&mut [0.0; 77], &mut [0.0; 77]);
        performer.reset();
        assert!(hit(&mut performer) == first);
    }

    #[test]
    fn the_cut_into_buffers_does_not_change_a_sample() {
        let whole = play(&[9_600]);
        assert!(whole.0.iter().chain(&whole.1).all(|sample| sample.is_finite()));
        for sizes in [&[1][..], &[17], &[64], &[512], &[1, 255, 3, 1024, 31, 33]] {
            assert!(play(sizes) == whole, "buffers of {sizes:?}");
        }
    }
}
