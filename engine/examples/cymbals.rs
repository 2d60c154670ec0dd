//! What cymbals cost and how they swell: `cargo run --release -p overhear-engine --example cymbals`; with
//! `-- swells` only the latter.
//!
//! Costs are CPU time for the second after a stroke of 6 m/s over that of a fixed loop of 2^30
//! multiply-adds, measured in turns; mean frequencies are those of the crash's modes to 2 kHz,
//! weighted by energy.

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

/// Mean frequency of the modes to 2 kHz, weighted by their energy, Hz; rigid ones left out.
fn mean_frequency(piece: &mut Piece) -> f64 {
    let body = piece.surface_mut().body();
    let (mut sum, mut weighted) = (0.0, 0.0);
    for (k, mode) in body.modes().iter().enumerate().skip(3) {
        let hz = mode.omega / std::f64::consts::TAU;
        if hz < 2000.0 {
            let q = f64::from(body.displacement(k));
            let energy = 0.5 * mode.mass * (body.velocity(k).powi(2) + (mode.omega * q).powi(2));
            sum += energy;
            weighted += energy * hz;
        }
    }
    weighted / sum
}

/// When the band above 3 kHz peaks, ms: its power over 10 ms, by a high-pass of fourth order.
fn bloom_ms(sound: &[f32]) -> f64 {
    let mut high: Vec<f64> = sound.iter().map(|&x| f64::from(x)).collect();
    let keep = (-std::f64::consts::TAU * 3000.0 / RATE).exp();
    for _ in 0..4 {
        let mut low = 0.0;
        for x in &mut high {
            low += (1.0 - keep) * (*x - low);
            *x -= low;
        }
    }
    let power: Vec<f64> = high.chunks(441).map(|part| part.iter().map(|x| x * x).sum()).collect();
    let best = (0..power.len()).max_by(|&a, &b| power[a].total_cmp(&power[b])).unwrap_or(0);
    10.0 * best as f64 + 5.0
}

fn swells() {
    println!("mean frequency, Hz, after  3 ms   30   80  250  500 ms  1 s;  peak above 3 kHz, ms");
    for (name, options) in tiers() {
        for (speed, striker) in
            [0.3, 1.5, 5.0].map(|v| (v, Striker::Stick)).into_iter().chain([(10.0, Striker::Shoulder)])
        {
            let mut piece = Piece::new(PieceId::Crash, &options).expect("a crash");
            piece.strike(&strike(speed, striker));
            print!("{name:>10} {speed:4} m/s {:8}", striker.name());
            let mut sound = Vec::new();
            for span in [0.003, 0.027, 0.05, 0.17, 0.25, 0.5] {
                sound.extend(render(&mut piece, span));
                print!(" {:5.0}", mean_frequency(&mut piece));
            }
            println!("  {:6.0}", bloom_ms(&sound));
        }
    }
}

fn main() {
    if std::env::args().nth(1).as_deref() != Some("swells") {
        costs();
    }
    swells();
}
