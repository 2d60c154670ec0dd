//! What takes the energy out of drums, beside what recordings show.

use std::f64::consts::TAU;

use overhear_engine::damping::SIGMA_T60;
use overhear_engine::piece::{ModeInfo, PieceId};
use overhear_tests::round_piece;

const RATE: f64 = 48_000.0;

/// The lowest mode of an order.
fn lowest(modes: &[ModeInfo], m: u32) -> ModeInfo {
    let of_order = modes.iter().filter(|mode| mode.m == m && mode.body == "batter");
    *of_order.min_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz)).unwrap()
}

#[test]
fn a_pillow_takes_the_boom_before_the_rest() {
    let mut kick = round_piece(PieceId::Kick, RATE);
    let open = kick.modes();
    kick.set_muffling(1.0);
    kick.finish_controls();
    let muffled = kick.modes();
    let added = |m| SIGMA_T60 / lowest(&muffled, m).t60 - SIGMA_T60 / lowest(&open, m).t60;
    let [boom, edge] = [added(0), added(1)];
    println!("adds {boom:.1} 1/s to the boom, {edge:.1} to (1,1)");
    // The heads' own loss is shared by the resonant head; what the air between them loses comes on top.
    assert!(boom > 1.5 * edge, "{boom} {edge}");
}

#[test]
fn toms_sing_for_more_than_a_second_and_their_heads_apart_thud() {
    for (id, apart) in [(PieceId::RackTom, 261.0), (PieceId::FloorTom, 169.0)] {
        let modes = round_piece(id, RATE).modes();
        let together = lowest(&modes, 0);
        let thud = modes
            .iter()
            .filter(|mode| mode.m == 0)
            .min_by(|a, b| (a.frequency_hz - apart).abs().total_cmp(&(b.frequency_hz - apart).abs()))
            .unwrap();
        println!("{id:?}: {:.2} s, {:.2} s at {:.0} Hz", together.t60, thud.t60, thud.frequency_hz);
        assert!(together.t60 > 1.0 && thud.t60 < 0.25 * together.t60, "{together:?} {thud:?}");
        // Radiation is less than what a monopole of its volume would send out.
        assert!(together.frequency_hz < 0.7 * thud.frequency_hz);
        assert!(together.radiation * TAU < thud.radiation * TAU);
    }
}
