//! What one evaluation of a crash's stretching costs, by transform and by tables:
//! `cargo run --release -p overhear-engine --example coupling`.
//!
//! The tables hold one real number for every Airy function and every pair of modes whose orders add or
//! subtract to its own. Their evaluation is stood for by its inner loops alone, over numbers that mean nothing: what
//! each function makes of all products of complex amplitudes of two orders, and back for the gradient. Making the
//! products and the forces of them, which a real one would add, is left out.

use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::Instant;

use overhear_engine::kit_spec::{InstrumentSpec, KitSpec};
use overhear_engine::modal::simd::{Kernels, LANES};
use overhear_engine::modal::{Row, zero_row};
use overhear_engine::plate::{PlateModes, PlateTables};
use overhear_engine::potential::Potential;
use overhear_engine::von_karman::{CoupledPair, VonKarman, airy::AiryOrder};

fn main() {
    let kit = KitSpec::standard();
    let Some(InstrumentSpec::Cymbal(crash)) = kit.find("crash").map(|(_, piece)| piece.instrument) else {
        return eprintln!("no crash in the standard kit");
    };
    let plate = PlateModes::new(&crash.plate(), 21_000.0).expect("a crash");
    let (orders, extent) = plate.table_extent(21_000.0);
    let tables = PlateTables::new(orders, extent);
    println!("to Hz   modes  coefficients   transform us   tables us");
    for hz in [1000.0, 2000.0, 4000.0, 8000.0] {
        let (pairs, modes) = pairs(&plate, hz);
        let mut stretching = VonKarman::new(&plate, &tables, &pairs);
        let bent: Vec<f32> = (0..modes.next_multiple_of(LANES)).map(|k| 1e-4 / (1.0 + k as f32)).collect();
        let mut gradient = vec![0.0; bent.len()];
        let transform = best(|| {
            black_box(stretching.evaluate(black_box(&bent), &mut gradient));
        });
        let blocks = blocks(&plate, &tables, &pairs);
        let coefficients: usize = blocks.iter().map(|[k, p, q]| k * p * q).sum();
        let padded = |[k, p, q]: &[usize; 3]| k * (p * q).next_multiple_of(LANES);
        let mut table = zero_row(blocks.iter().map(padded).sum());
        table.fill(1e-3);
        let mut work = [(); 4].map(|()| zero_row(1024));
        let dense = best(|| dense(&blocks, &table, &mut work));
        println!("{hz:5}  {modes:6}  {coefficients:12}  {transform:13.2}  {dense:10.2}");
    }
}

/// Shortest time of a call, us.
fn best(mut call: impl FnMut()) -> f64 {
    let once = |call: &mut dyn FnMut()| {
        let start = Instant::now();
        (0..100).for_each(|_| call());
        start.elapsed().as_secs_f64() * 1e4
    };
    (0..20).map(|_| once(&mut call)).fold(f64::MAX, f64::min)
}

fn pairs(plate: &PlateModes, hz: f64) -> (Vec<CoupledPair>, usize) {
    let mut modes = 0;
    let inside = plate.shells.iter().enumerate().filter(|(_, shell)| shell.omega < TAU * hz);
    let pairs = inside.map(|(shell, mode)| {
        let pair = CoupledPair { shell, mode: modes, axis: 0.0 };
        modes += if mode.m == 0 { 1 } else { 2 };
        pair
    });
    let pairs: Vec<CoupledPair> = pairs.collect();
    (pairs, modes)
}

/// Airy functions, modes of one order and modes of the other, of every table.
fn blocks(plate: &PlateModes, tables: &PlateTables, pairs: &[CoupledPair]) -> Vec<[usize; 3]> {
    let shells = || pairs.iter().map(|pair| &plate.shells[pair.shell]);
    let highest = shells().map(|shell| shell.m).max().unwrap_or(0);
    let of_order = |m: u32| shells().filter(|shell| shell.m == m).count();
    let finest = shells().map(|shell| plate.wave_number(shell)).fold(0.0, f64::max);
    let mut out = Vec::new();
    for (m, order) in (0..).zip(AiryOrder::all(plate, tables, highest, finest)) {
        let airys = order.stiffness.len();
        for p in 0..=highest {
            for q in p..=highest {
                for _ in [p + q, q - p].into_iter().filter(|&sum| sum == m && airys > 0) {
                    out.push([airys, of_order(p), of_order(q)]);
                }
            }
        }
    }
    out.retain(|[k, p, q]| k * p * q > 0);
    out
}

/// Both passes over every table, at the machine's full width: every product of two amplitudes once, what each
/// Airy function makes of them, and what the stresses make of each product.
fn dense(blocks: &[[usize; 3]], table: &[f32], work: &mut [Row; 4]) {
    let kernels = Kernels::detect();
    let mut at = 0;
    let mut total = 0.0;
    for &[airys, rows, columns] in blocks {
        let length = (rows * columns).next_multiple_of(LANES);
        let [re, im, force_re, force_im] = work.each_mut().map(|row| &mut row[..length]);
        for (i, (re, im)) in re.iter_mut().zip(im.iter_mut()).enumerate() {
            (*re, *im) = (0.1 * i as f32, 0.2 * i as f32);
        }
        for row in table[at..][..airys * length].chunks_exact(length) {
            let (p_re, p_im) = (kernels.dot(row, re), kernels.dot(row, im));
            kernels.axpy(force_re, row, p_re);
            kernels.axpy(force_im, row, p_im);
            total += p_re + p_im;
        }
        at += airys * length;
    }
    black_box(total);
}
