//! The kernels for different instruction sets produce the same sound.
//!
//! One test only: the limit it sets is the whole process's.

use overhear::kit_document::KitDocument;
use overhear_engine::modal::simd::Kernels;
use overhear_engine::modal::simd::level::{self, InstructionSet};
use overhear_engine::piece::BuildOptions;
use overhear_engine::slot::Slot;
use overhear_engine::strike::{Strike, Striker};
use overhear_measure::hear;
use overhear_measure::spectra::PowerSpectrum;
use overhear_tests::{build, render_into};

const RATE: f64 = 44_100.0;

/// Seconds rendered, and of them those that are compared sample by sample.
const LENGTH: f64 = 3.0;
const ATTACK: f64 = 0.3;

/// Where a stick meets a cymbal once and is gone, share of the radius. On an edge it chatters, two dozen touches in 20 ms,
/// and each multiplies roundings.
const BOW: f64 = 0.6;

/// When energies are compared, s; chaotic takes end with the last.
const LOOKS: [f64; 2] = [0.05, 0.3];

/// What a piece struck at 4 m/s sounds like, and its energy at [`LOOKS`], J.
///
/// Calm: without what makes its motion chaotic, a cymbal's coupling, a stick on its edge, and the snare's wires.
fn sound(slot: Slot, calm: bool) -> (Vec<f32>, [f64; 2]) {
    let document = KitDocument::standard();
    let spec = document.kit.piece(slot).expect("a piece of the kit");
    let linear = calm && spec.drum().is_none();
    let spec = if linear { spec.clone().linear() } else { spec.clone() };
    let mut piece = build(&spec, &BuildOptions::new(RATE));
    piece.throw_wires(!calm);
    let usual = hear::default_strike(&document, slot);
    let (striker, radius) = if linear { (Striker::Stick, BOW) } else { (usual.striker, usual.radius) };
    piece.strike(&Strike { speed: 4.0, striker, radius, ..usual });
    let length = if calm { LENGTH } else { LOOKS[1] };
    let mut out = vec![0.0; (length * RATE) as usize];
    let mut done = 0;
    let energies = LOOKS.map(|seconds| {
        let until = (seconds * RATE) as usize;
        render_into(&mut piece, &mut out[done..until]);
        done = until;
        piece.energy()
    });
    render_into(&mut piece, &mut out[done..]);
    (out, energies)
}

/// Largest difference over the attack, of the peak.
fn apart(a: &[f32], b: &[f32]) -> f32 {
    let peak = a.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
    let attack = a.iter().zip(b).take((ATTACK * RATE) as usize);
    attack.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max) / peak
}

/// Largest difference of a third octave, dB, among those within 60 dB of the loudest.
fn third_octaves_apart(a: &[f32], b: &[f32]) -> f64 {
    let bands = |sound: &[f32]| {
        let spectrum = PowerSpectrum::new(sound, RATE);
        let middles = (0..28).map(|i| 31.25 * 2.0_f64.powf(f64::from(i) / 3.0));
        middles.map(|hz| spectrum.band(hz * 2.0_f64.powf(-1.0 / 6.0), hz * 2.0_f64.powf(1.0 / 6.0))).collect()
    };
    let (a, b): (Vec<f64>, Vec<f64>) = (bands(a), bands(b));
    let loudest = a.iter().copied().fold(0.0, f64::max);
    let heard = a.iter().zip(&b).filter(|(a, _)| **a > 1e-6 * loudest);
    heard.map(|(a, b)| 10.0 * (a / b).log10().abs()).fold(0.0, f64::max)
}

#[test]
fn every_instruction_set_makes_the_same_sound() {
    let sets: Vec<_> = InstructionSet::ALL.into_iter().filter(|set| set.is_available()).collect();
    for (slot, spec) in KitDocument::standard().kit.slots() {
        let name = &spec.name;
        // Where motion is chaotic a rounding makes another sound of it, equally loud.
        let chaotic = spec.drum().is_none_or(|drum| drum.wires.is_some());
        let render = |set| {
            level::limit(set);
            assert_eq!(Kernels::detect().name(), InstructionSet::name(set));
            (sound(slot, true), chaotic.then(|| sound(slot, false)))
        };
        let (plain, wild) = render(InstructionSet::Sse2);
        for &set in &sets[1..] {
            let (other, other_wild) = render(set);
            let (attack, thirds) = (apart(&plain.0, &other.0), third_octaves_apart(&plain.0, &other.0));
            println!("{} {}: attack {attack:.1e} of the peak, thirds {thirds:.4} dB", name, set.name());
            assert!(attack < 1e-3, "{name} {set:?}: {attack}");
            assert!(thirds < 0.1, "{name} {set:?}: {thirds} dB");
            for (a, b) in wild.iter().zip(&other_wild) {
                let energies = a.1.iter().zip(b.1).map(|(a, b)| b / a).collect::<Vec<_>>();
                println!("    chaotic: energies {energies:.3?}");
                assert!(
                    energies.iter().all(|ratio| (0.9..1.1).contains(ratio)),
                    "{name} {set:?}: {energies:?}"
                );
            }
        }
    }
    level::limit(InstructionSet::Avx512);
}
