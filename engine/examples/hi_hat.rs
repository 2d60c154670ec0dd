//! What a hi-hat costs: `cargo run --release -p overhear-engine --example hi_hat`.
//!
//! CPU time for the second after a stroke of 6 m/s, by place of the pedal, and for a second of eighth notes at 120 a
//! minute, in percent of a core, and in brackets over that of a fixed loop of 2^30 multiply-adds, measured in turns. As Linux counts it; it
//! needs `/proc`.

use std::hint::black_box;

use overhear_engine::hi_hat::foot::SPEED;
use overhear_engine::kit::BLOCK;
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::modal::RECEIVERS;
use overhear_engine::piece::{BuildOptions, Piece, Quality};
use overhear_engine::strike::{Strike, Striker};

const RATE: f64 = 44_100.0;

/// CPU time of this thread so far, s.
fn cpu() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    1e-9 * text.split(' ').next().and_then(|field| field.parse().ok()).unwrap_or(f64::NAN)
}

fn strike(piece: &mut Piece, speed: f64) {
    piece.strike(&Strike { speed, radius: 0.97, angle: 0.3, striker: Striker::Stick });
}

fn render(piece: &mut Piece, seconds: f64) {
    let mut left = (seconds * RATE) as usize;
    while left > 0 {
        let run = piece.run_left().min(left);
        let mut receivers = [[0.0; BLOCK]; RECEIVERS];
        piece.render_in_air(receivers.each_mut().map(|receiver| &mut receiver[..run]), None);
        black_box(receivers);
        left -= run;
    }
}

/// Seconds the calibration loop takes.
fn calibration() -> f64 {
    let mut x = black_box(vec![0.5_f32; 4096]);
    let start = cpu();
    let (a, b) = (black_box(0.9999_f32), black_box(1e-4_f32));
    for _ in 0..1 << 16 {
        for x in &mut x {
            *x = *x * a + b;
        }
        black_box(&mut x);
    }
    4.0 * (cpu() - start)
}

/// Best of some runs of a second, in percent of a core and in calibrations.
fn cost(piece: &mut Piece, pedal: f64, play: impl Fn(&mut Piece)) -> String {
    let (mut best, mut unit) = (f64::MAX, f64::MAX);
    for _ in 0..6 {
        piece.press_pedal(pedal, SPEED.1);
        piece.reset();
        let start = cpu();
        play(piece);
        best = best.min(cpu() - start);
        unit = unit.min(calibration());
    }
    format!("{:5.1} % ({:.2})", 100.0 * best, best / unit)
}

fn main() {
    let kit = KitSpec::standard();
    let (slot, _) = kit.find("hi-hat").expect("a hi-hat");
    let build = kit.build(slot).expect("a piece in its slot");
    println!("                             a stroke         eighths");
    for quality in [Quality::Standard, Quality::High] {
        let options = BuildOptions { quality, ..BuildOptions::new(RATE) };
        let mut piece = Piece::new(slot, &build, &options).expect("a hi-hat");
        for pedal in [0.0, 0.25, 0.5, 0.75, 0.9, 1.0] {
            let once = cost(&mut piece, pedal, |piece| {
                strike(piece, 6.0);
                render(piece, 1.0);
            });
            let eighths = cost(&mut piece, pedal, |piece| {
                for _ in 0..4 {
                    strike(piece, 3.0);
                    render(piece, 0.25);
                }
            });
            println!("{:>9}, pedal {pedal:4.2}  {once:>15} {eighths:>15}", quality.name());
        }
    }
}
