//! When the next frame is drawn.
//!
//! The framework never takes a request for a frame back: on X11 each is a timer of its own. If every frame asked for the
//! next, each one that a hand causes would begin a chain of frames beside the one that goes on already, and a window
//! would draw faster with every move of the pointer. So what has been asked for is remembered, and asked for again only
//! when it is due or something is wanted sooner.
//!
//! Where the processor draws, how often is a matter of what it costs: frames come as far apart as keeps them below a share
//! of a core. The drawing thread's own time is measured; what the rasterizer's threads take beside it cannot be seen
//! from here and is taken to be a multiple of it.

use std::time::Duration;

/// From one frame to the next where a graphics card draws and the kit plays: 60 a second.
const SMOOTH: Duration = Duration::from_micros(16_667);

/// From one frame to the next while nothing moves; [`watch`](super::watch) wakes the window when something does.
const RESTING: Duration = Duration::from_secs(10);

/// Share of a core that drawing by the processor may take.
const SHARE: f64 = 0.085;

/// Time of the rasterizer's threads for each second of the drawing thread's. *Measured* with llvmpipe at 800 x 500.
const BESIDE: f64 = 2.0;

/// Shortest and longest time between frames that the processor draws: as much motion as is of use, and as little as still
/// follows what is played.
const DRAWN: (Duration, Duration) = (Duration::from_millis(50), Duration::from_millis(400));

/// How much of a new measurement is taken over.
const NEW: f64 = 0.2;

/// A request is met if a frame comes so much before it, s: clocks differ a little.
const EARLY: f64 = 0.005;

/// When a window is drawn.
#[derive(Debug, Clone, Default)]
pub struct Pace {
    /// What a frame costs the drawing thread, s; nothing where a graphics card draws.
    cost: Option<f64>,
    /// When the frame that was asked for is due, s of the window's time.
    due: Option<f64>,
}

impl Pace {
    /// The pace of a window that the processor draws.
    pub fn in_software() -> Pace {
        Pace { cost: Some(0.02), due: None }
    }

    /// Takes in what a frame cost the thread that drew it.
    pub fn drew(&mut self, took: Duration) {
        if let Some(cost) = &mut self.cost {
            *cost += NEW * (took.as_secs_f64() - *cost);
        }
    }

    /// From one frame to the next while something moves.
    fn moving(&self) -> Duration {
        let apart = |cost: f64| Duration::from_secs_f64(cost * (1.0 + BESIDE) / SHARE);
        self.cost.map_or(SMOOTH, |cost| apart(cost.clamp(0.0, 1.0)).clamp(DRAWN.0, DRAWN.1))
    }

    /// How long after a frame at `now` (s) the next is to be asked for, if it has not been already.
    pub fn next(&mut self, now: f64, moves: bool) -> Option<Duration> {
        let wait = if moves { self.moving() } else { RESTING };
        let wanted = now + wait.as_secs_f64();
        let asked = self.due.is_some_and(|due| due > now + EARLY && due <= wanted + EARLY);
        if asked {
            return None;
        }
        self.due = Some(wanted);
        Some(wait)
    }
}

/// Whether the audio goes on: a host that stops it in mid ring leaves a picture in which nothing moves any more.
#[derive(Debug, Clone, Copy, Default)]
pub struct Pulse {
    clock: u64,
    /// When it was seen to go on, s of the editor's time.
    seen: f64,
}

impl Pulse {
    /// How long it may stand still, s: longer than the longest buffers and than frames are apart.
    const PATIENCE: f64 = 0.5;

    /// Takes in the engine's clock at the time `now`, s, and says whether it goes on.
    pub fn goes_on(&mut self, clock: u64, now: f64) -> bool {
        if self.clock != clock {
            *self = Pulse { clock, seen: now };
        }
        now - self.seen < Pulse::PATIENCE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn audio_that_stops_is_noticed_within_half_a_second_and_so_is_its_return() {
        let mut pulse = Pulse::default();
        assert!(pulse.goes_on(100, 10.0) && pulse.goes_on(100, 10.4));
        assert!(!pulse.goes_on(100, 10.6) && !pulse.goes_on(100, 60.0));
        assert!(pulse.goes_on(101, 60.1));
    }

    #[test]
    fn frames_that_hands_cause_add_none_of_their_own() {
        let mut pace = Pace::in_software();
        let apart = pace.next(0.0, true).expect("a first frame");
        let due = apart.as_secs_f64();
        // The pointer moves a hundred times before the next is due.
        let extra =
            (1..100).filter(|&move_| pace.next(0.005 + due * 0.009 * f64::from(move_), true).is_some());
        assert!(extra.count() <= 4, "only what is about as near as the due one");
        let mut pace = Pace::in_software();
        assert_eq!(pace.next(0.0, false), Some(RESTING));
        assert_eq!(pace.next(0.1, false), None);
        // What begins to move is not kept waiting, and what rests again is drawn no more than was asked for.
        assert!(pace.next(0.2, true).is_some_and(|wait| wait < RESTING));
        assert_eq!(pace.next(0.21, true), None);
    }

    #[test]
    fn a_chain_never_ends() {
        let mut pace = Pace::default();
        let mut now = 0.0;
        for frame in 0..1_000 {
            let wait = pace.next(now, frame % 3 != 0);
            assert!(wait.is_some() || pace.due.is_some_and(|due| due > now), "frame {frame}");
            // Frames come a little early.
            now = (pace.due.unwrap() - 0.004).max(now + 0.001);
        }
    }

    #[test]
    fn dear_frames_come_rarely_and_cheap_ones_often() {
        let apart = |milliseconds: u64| {
            let mut pace = Pace::in_software();
            (0..100).for_each(|_| pace.drew(Duration::from_millis(milliseconds)));
            pace.moving()
        };
        assert_eq!((apart(0), apart(500)), DRAWN);
        let share = 0.005 * (1.0 + BESIDE) / apart(5).as_secs_f64();
        assert!((share - SHARE).abs() < 1e-3, "{share}");
        assert_eq!(Pace::default().moving(), SMOOTH);
    }
}
