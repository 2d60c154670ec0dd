use std::sync::{Arc, Mutex};

use super::*;
use crate::modal::Mode;

const RATE: f64 = 44_100.0;

#[test]
fn a_cycle_lasts_until_the_body_has_turned_a_little() {
    let cycles = [0.0, 1e-9, 0.0021, 0.004, 0.1].map(|turn| cycle_of(turn, [4, 17]));
    assert_eq!(cycles, [17, 17, 9, 5, 4]);
    assert_eq!([4, 17, 18, 19, 33].map(step_of), [8, 8, 8, 16, 16]);
}

/// Notes the tilts that it turns to.
#[derive(Clone, Default)]
struct Noted(Arc<Mutex<Vec<f64>>>);

impl Directivity for Noted {
    fn turn(&mut self, tilt: [f64; 2]) {
        self.0.lock().unwrap().push(tilt[0]);
    }
    fn work(&mut self, _: usize, _: usize) {}
    fn write(&self, _: [&mut [[f64; 2]]; POINTS]) {}
    fn write_rest(&self, _: [&mut [[f64; 2]]; POINTS]) {}
}

/// Tilts that lobes are worked out for, each with the block in which that began, while something tilts a body, by block, rad.
fn turned(tilt: impl Fn(usize) -> f64, blocks: usize) -> Vec<(usize, f64)> {
    let modes = vec![Mode { omega: 1e3, sigma: 1.0, mass: 0.1 }];
    let mut body = SoundingBody::new(modes, vec![[0.0; 2]], RATE);
    let noted = Noted::default();
    let mut swing = Swing::new(Box::new(noted.clone()), None, (1, 1), RATE);
    let mut all = Vec::new();
    for block in 0..blocks {
        swing.begin_block(&mut body, Some([tilt(block), 0.0]));
        all.extend(noted.0.lock().unwrap().drain(..).map(|tilt| (block, tilt)));
    }
    all
}

/// Seconds at the beginning of a block.
fn seconds(block: usize) -> f64 {
    (block * BLOCK) as f64 / RATE
}

#[test]
fn lobes_of_a_slow_swing_are_worked_out_rarely_and_those_of_a_fast_one_as_it_turns() {
    // Two seconds at 2 Hz, at most 0.19 and 3.1 rad/s.
    for (amplitude, rarest) in [(0.015, 90), (0.25, 230)] {
        let tilt = |block: usize| amplitude * (4.0 * std::f64::consts::PI * seconds(block)).sin();
        let all = turned(tilt, 2756);
        assert!(all.len() < rarest, "{} times at {amplitude} rad", all.len());
        for pair in all.windows(2) {
            let step = (pair[1].1 - pair[0].1).abs();
            assert!(step < 0.045, "{step} rad at once");
        }
    }
}

#[test]
fn a_stroke_on_a_body_that_hardly_swings_is_followed_at_once() {
    // Slowly, then 2.5 rad/s from the beginning of one of the longest cycles on.
    let slow = |block: usize| 0.3 * seconds(block);
    let struck = turned(slow, 500).last().unwrap().0 + 1;
    let tilt = |block: usize| slow(block) + 2.5 * (seconds(block) - seconds(struck)).max(0.0);
    let all = turned(tilt, 600);
    let (_, before) = all.iter().rfind(|(block, _)| *block <= struck).unwrap();
    let (block, _) = all.iter().find(|(block, _)| *block > struck).unwrap();
    assert!((tilt(*block) - before).abs() < 0.04, "block {block}");
    let after = all.iter().filter(|(block, _)| *block > struck + 18);
    let late = after.clone().zip(after.skip(1)).map(|(a, b)| (b.1 - a.1).abs()).fold(0.0, f64::max);
    assert!(late < 0.024, "{late} rad at once while it turns evenly");
}

#[test]
fn lobes_of_a_body_that_spins_are_worked_out_in_time() {
    let all = turned(|block| 20.0 * seconds(block), 100);
    assert!(all.windows(2).all(|pair| pair[1].0 - pair[0].0 == 4), "{all:?}");
}
