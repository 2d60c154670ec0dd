//! The foot on the pedal, which moves the rod to its goal.
//!
//! Model: foot and pedal are a mass on a critically damped spring, the leg. Forces of the cymbals do not act on it. A foot has a
//! largest speed. A pedal that is moved in steps, as controllers do, therefore moves smoothly and as fast as the steps come. The
//! speed of the rod determines the force between the cymbals.
//!
//! Coordinates: `y` is the way of the rod down from the raised pedal, m.

use crate::fitted;

/// Stiffness of the leg over the mass it moves, as a rate, 1/s. *By ear*: half a movement takes 8 ms, short
/// enough to be played, long enough that the steps of a controller are inaudible.
const LEG: f64 = fitted::LEG_RATE;

/// Slowest, default and fastest speed of a foot, m/s. *Derived*: from lowering it to a stamp; a foot falls the
/// 3 cm between open and closed at 0.8 m/s by itself.
pub const SPEED: (f64, f64, f64) = (0.02, 1.0, 2.5);

/// Distance (m) and speed (m/s) below which the goal counts as reached.
const THERE: (f64, f64) = (1e-7, 1e-5);

/// A foot and the rod it moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// Position of the rod, m.
    y: f64,
    /// Its speed, m/s.
    v: f64,
    target: f64,
    fastest: f64,
    turn: Option<Turn>,
    /// End of a stamp, m.
    end: Option<f64>,
}

/// A turning point on the way down, and the goal after it, m.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Turn {
    at: f64,
    then: f64,
}

/// What a foot does on a pedal, beginning at full speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Speed down, m/s.
    pub speed: f64,
    /// How far down, m.
    pub to: f64,
    /// Where it goes from there at once, m; none where it stays.
    pub then: Option<f64>,
}

impl Foot {
    /// At rest with the rod at `y`, m.
    pub fn new(y: f64) -> Foot {
        Foot { y, v: 0.0, target: y, fastest: SPEED.1, turn: None, end: None }
    }

    /// Way of the rod down, m.
    pub fn place(&self) -> f64 {
        self.y
    }

    /// Speed of the rod, positive down, m/s.
    pub fn speed(&self) -> f64 {
        self.v
    }

    /// Whether it moves or will move.
    pub fn moves(&self) -> bool {
        self.y != self.target || self.v != 0.0
    }

    /// Moves to a position (m) at up to a speed (m/s).
    pub fn go(&mut self, target: f64, fastest: f64) {
        (self.target, self.fastest) = (target, fastest.clamp(SPEED.0, SPEED.2));
        (self.turn, self.end) = (None, None);
    }

    /// Stands still at `y`, m, until it is moved on.
    pub fn put(&mut self, y: f64) {
        (self.y, self.v) = (y, 0.0);
    }

    /// Stops, with another goal (m).
    pub fn stop_for(&mut self, target: f64) {
        self.go(target, SPEED.1);
        self.v = 0.0;
    }

    /// Steps on the pedal: moves down without slowing down before the end.
    pub fn take(&mut self, step: Step) {
        let Step { speed, to, then } = step;
        // The goal lies past the end.
        self.go(to + 2.0 * speed / LEG, speed);
        self.v = self.fastest;
        match then {
            Some(then) => self.turn = Some(Turn { at: to, then }),
            None => self.end = Some(to),
        }
    }

    /// Takes a position at once.
    pub fn jump(&mut self) {
        self.target = self.turn.take().map(|turn| turn.then).or(self.end.take()).unwrap_or(self.target);
        (self.y, self.v) = (self.target, 0.0);
    }

    /// Advances by a sample.
    pub fn step(&mut self, dt: f64) {
        if !self.moves() {
            return;
        }
        let pull = LEG * (LEG * (self.target - self.y) - 2.0 * self.v);
        self.v = (self.v + pull * dt).clamp(-self.fastest, self.fastest);
        self.y += self.v * dt;
        if let Some(turn) = self.turn.filter(|turn| self.y >= turn.at) {
            // The cymbals stop it.
            (self.target, self.turn, self.v) = (turn.then, None, 0.0);
        }
        if let Some(end) = self.end.filter(|&end| self.y >= end) {
            (self.y, self.v, self.target, self.end) = (end, 0.0, end, None);
        }
        if (self.y - self.target).abs() < THERE.0 && self.v.abs() < THERE.1 {
            (self.y, self.v) = (self.target, 0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 1.0 / 44_100.0;

    #[test]
    fn a_foot_arrives_and_never_goes_faster_than_it_may() {
        for fastest in [0.1, 0.5, 2.0] {
            let mut foot = Foot::new(0.0);
            foot.go(0.03, fastest);
            let (mut most, mut samples) = (0.0_f64, 0);
            while foot.moves() {
                foot.step(DT);
                most = most.max(foot.speed().abs());
                samples += 1;
                assert!(samples < 44_100, "never there");
                assert!(foot.place() < 0.03 + 1e-6, "beyond");
            }
            assert!(most <= fastest && most > 0.9 * fastest, "{fastest}: {most}");
            assert_eq!(foot.place(), 0.03);
        }
    }

    #[test]
    fn a_splash_comes_back() {
        let mut foot = Foot::new(0.027);
        foot.take(Step { speed: 1.0, to: 0.03, then: Some(0.005) });
        let mut deepest = 0.0_f64;
        while foot.moves() {
            foot.step(DT);
            deepest = deepest.max(foot.place());
        }
        assert!((0.03..0.0301).contains(&deepest), "{deepest}");
        assert_eq!(foot.place(), 0.005);
    }

    #[test]
    fn a_stamp_keeps_its_speed_until_it_is_there() {
        for speed in [0.1, 0.4, 2.0] {
            let mut foot = Foot::new(0.0305);
            foot.take(Step { speed, to: 0.031, then: None });
            let mut slowest = f64::INFINITY;
            while foot.moves() {
                slowest = slowest.min(foot.speed());
                foot.step(DT);
            }
            assert_eq!((foot.place(), foot.speed()), (0.031, 0.0));
            assert!(slowest > 0.9 * speed, "{slowest} m/s");
        }
    }
}
