//! What cymbals cost: `cargo run --release -p overhear-engine --example cymbals`.
//!
//! CPU time for the second after a stroke of 6 m/s over that of a fixed loop of 2^30 multiply-adds, measured
//! in turns.

use std::hint::black_box;
use std::time::Instant;

use overhear_engine::piece::{BuildOptions, Piece, PieceId, Quality};
use overhear_engine::strike::{Strike, Striker};

const RATE: f64 = 44_100.0;

/// The tiers, linear first.
fn tiers() -> impl Iterator<Item = (&'static str, BuildOptions)> {
    let linear = BuildOptions { linear: true, ..BuildOptions::new(RATE) };
    let coupled =
        Quality::ALL.map(|quality| (quality.name(), BuildOptions { quality, ..BuildOptions::new(RATE) }));
    std::iter::once(("linear", linear)).chain(coupled)
}

fn strike(speed: f64, striker: Striker) -> Strike {
    Strike { speed, radius: 0.92, angle: 0.3, striker }
}

fn render(piece: &mut Piece, seconds: f64) -> Vec<f32> {
    let mut out = vec![0.0; (seconds * RATE) as usize];
    piece.render(&mut out);
    out
}

/// Seconds the calibration loop takes.
fn calibration() -> f64 {
    let mut x = black_box(vec![0.5_f32; 4096]);
    let start = Instant::now();
    let (a, b) = (black_box(0.9999_f32), black_box(1e-4_f32));
    for _ in 0..1 << 16 {
        for x in &mut x {
            *x = *x * a + b;
        }
        black_box(&mut x);
    }
    4.0 * start.elapsed().as_secs_f64()
}

fn costs() {
    println!("cost in calibrations       linear   eco  standard  high  offline");
    for id in [PieceId::Crash, PieceId::Ride, PieceId::Splash] {
        print!("{:>24}", id.name());
        for (_, options) in tiers() {
            let mut piece = Piece::new(id, &options).expect("a cymbal");
            let (mut best, mut unit) = (f64::MAX, f64::MAX);
            for _ in 0..6 {
                piece.reset();
                piece.strike(&strike(6.0, Striker::Stick));
                let start = Instant::now();
                black_box(render(&mut piece, 1.0));
                best = best.min(start.elapsed().as_secs_f64());
                unit = unit.min(calibration());
            }
            print!("  {:6.2}", best / unit);
        }
        println!();
    }
}

fn main() {
    costs();
}
