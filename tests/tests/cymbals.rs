//! What cymbals do when they are struck: energy, cascade, offset, drift.

use overhear_engine::piece::{BuildOptions, Piece, PieceId, Quality};
use overhear_engine::strike::{Strike, Striker};

const RATE: f64 = 44_100.0;

fn options() -> BuildOptions {
    BuildOptions::new(RATE)
}

fn hit(speed: f64, radius: f64, striker: Striker) -> Strike {
    Strike { speed, radius, angle: 0.3, striker }
}

fn render(piece: &mut Piece, seconds: f64) -> Vec<f32> {
    let mut out = vec![0.0; (seconds * RATE) as usize];
    piece.render(&mut out);
    out
}

/// Mean frequency of the modes to `limit_hz`, weighted by their energy, Hz; rigid ones left out.
fn mean_frequency(piece: &mut Piece, limit_hz: f64) -> f64 {
    let body = piece.surface_mut().body();
    let (mut sum, mut weighted) = (0.0, 0.0);
    for (k, mode) in body.modes().iter().enumerate().skip(3) {
        let hz = mode.omega / std::f64::consts::TAU;
        if hz < limit_hz {
            let q = f64::from(body.displacement(k));
            let energy = 0.5 * mode.mass * (body.velocity(k).powi(2) + (mode.omega * q).powi(2));
            sum += energy;
            weighted += energy * hz;
        }
    }
    weighted / sum
}

#[test]
#[ignore = "a measurement"]
fn measure() {
    let marks = [0.003, 0.03, 0.08, 0.25, 0.5, 1.0];
    for (label, linear, quality) in [
        ("linear", true, Quality::Standard),
        ("eco", false, Quality::Eco),
        ("standard", false, Quality::Standard),
        ("high", false, Quality::High),
        ("offline", false, Quality::Offline),
    ] {
        for speed in [0.3, 1.5, 5.0] {
            for (place, striker) in [(0.92, Striker::Shoulder), (0.92, Striker::Stick)] {
                let start = std::time::Instant::now();
                let mut piece =
                    Piece::new(PieceId::Crash, &BuildOptions { linear, quality, ..options() }).unwrap();
                let build = start.elapsed();
                piece.strike(&hit(speed, place, striker));
                let start = std::time::Instant::now();
                let mut now = 0.0;
                let mut row = String::new();
                let mut sound = Vec::new();
                for mark in marks {
                    sound.extend(render(&mut piece, mark - now));
                    now = mark;
                    row += &format!(" {:5.0}", mean_frequency(&mut piece, 2000.0));
                }
                let cost = start.elapsed().as_secs_f64();
                let peak = sound.iter().fold(0.0_f32, |a, x| a.max(x.abs()));
                let mean: f32 = sound
                    .windows(4410)
                    .step_by(441)
                    .map(|w| (w.iter().sum::<f32>() / 4410.0).abs())
                    .fold(0.0, f32::max);
                let (truth, off) = piece.surface_mut().true_potential();
                let ex = piece.surface_mut().beyond().map_or(0.0, |f| f.exchanged());
                println!(
                    "{label} {speed} {striker:?}:{row} Hz | peak {peak:.2} Pa mean/peak {:.1e} | E {:.2e} U {truth:.1e} psi {off:.1e} exch {ex:.1e} | {:.3} s, build {build:?}",
                    mean / peak,
                    piece.energy(),
                    cost
                );
            }
        }
    }
}

/// CPU seconds of the calibration loop.
fn calibration() -> f64 {
    let mut x = std::hint::black_box(vec![0.5_f32; 4096]);
    let start = std::time::Instant::now();
    let (a, b) = (std::hint::black_box(0.9999_f32), std::hint::black_box(1e-4_f32));
    for _ in 0..1 << 16 {
        for x in &mut x {
            *x = *x * a + b;
        }
        std::hint::black_box(&mut x);
    }
    4.0 * start.elapsed().as_secs_f64()
}

#[test]
#[ignore = "a measurement"]
fn cost() {
    for id in [PieceId::Crash, PieceId::Ride, PieceId::Splash] {
        for (label, linear, quality) in [
            ("linear", true, Quality::Standard),
            ("eco", false, Quality::Eco),
            ("standard", false, Quality::Standard),
            ("high", false, Quality::High),
            ("offline", false, Quality::Offline),
        ] {
            let mut piece = Piece::new(id, &BuildOptions { linear, quality, ..options() }).unwrap();
            let (mut best, mut loops) = (f64::MAX, f64::MAX);
            for _ in 0..4 {
                piece.reset();
                piece.strike(&hit(6.0, 0.9, Striker::Stick));
                let start = std::time::Instant::now();
                render(&mut piece, 1.0);
                best = best.min(start.elapsed().as_secs_f64());
                loops = loops.min(calibration());
            }
            println!("{} {label}: {best:.4} s, {:.2} calibrations of {loops:.4} s", id.name(), best / loops);
        }
    }
}
