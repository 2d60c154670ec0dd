//! Strikers against whole pieces: energy kept to the last digit, and contacts that do not depend on
//! the sample rate.

use overhear_engine::kit_spec::PieceSpec;
use overhear_engine::strike::{Strike, Striker};
use overhear_measure::report::contact;
use overhear_tests::{Chance, RATES, lossless_piece, names, render_into, total_energy};

/// Strikes every piece with everything, without any loss, and compares the energy about with what
/// the stroke brought: in the first 100 ms, and for the rest of a second. At rates above 48 kHz, which take long, every other stroke is
/// left out: those or the others, drawn anew in every run.
fn energy_stays(rate: f64) {
    let mut worst = (0.0_f64, 0.0_f64);
    let every = if rate > 50_000.0 { 2 } else { 1 };
    let drawn = Chance::new(Chance::seeds(&[])[0]).below(every);
    for (slot, name) in names().iter().enumerate() {
        let mut piece = lossless_piece(name, rate);
        let drawn = |(place, _): &(usize, Striker)| (slot + place) % every == drawn;
        for (_, striker) in Striker::ALL.into_iter().enumerate().filter(drawn) {
            let strike = contact::trial(slot, striker);
            piece.reset();
            piece.strike(&strike);
            let brought = piece.brought_energy();
            let samples = rate as usize;
            let mut done = 0;
            while done < samples {
                let early = done < samples / 10;
                // At first, while the tip touches, every 8th sample is looked at.
                let run = if done < samples / 50 { 8 } else { 128 };
                let mut sound = [0.0; 128];
                render_into(&mut piece, &mut sound[..run]);
                done += run;
                let off = (total_energy(&piece) / brought - 1.0).abs();
                // The rounding of the `f32` state adds up, the more the more samples there are.
                let (first, later) = if rate > 100_000.0 { (2e-4, 2e-3) } else { (1e-4, 1e-3) };
                let (worst, limit) = if early { (&mut worst.0, first) } else { (&mut worst.1, later) };
                *worst = worst.max(off);
                assert!(off < limit, "{off:.1e} off after {done} samples: {name} {strike:?}");
            }
        }
    }
    println!("{rate}: off by {:.1e} within 100 ms, {:.1e} within 1 s", worst.0, worst.1);
}

#[test]
fn lossless_strikes_keep_their_energy_at_44_1_khz() {
    energy_stays(RATES[0]);
}

#[test]
fn lossless_strikes_keep_their_energy_at_48_khz() {
    energy_stays(RATES[1]);
}

#[test]
fn lossless_strikes_keep_their_energy_at_96_khz() {
    energy_stays(RATES[2]);
}

#[test]
fn lossless_strikes_keep_their_energy_at_192_khz() {
    energy_stays(RATES[3]);
}

/// Compares a stroke at the rates hosts use with the same at 176.4 kHz.
fn contact_is_that_of_a_fine_step(spec: &PieceSpec, strike: &Strike) {
    let name = &spec.name;
    for coarse in contact::against_fine_step(spec, strike) {
        println!("{name}: {coarse:.4?}");
        assert!(coarse.time.abs() < 0.03 && coarse.impulse.abs() < 0.005, "{name}: {coarse:?}");
        // The peak lasts a few samples and is not resolved yet: told here and in the report, not required.
        // A bead of half a gram swings on its contact at 11 kHz, four samples long at 44.1 kHz; the goal is 1 dB at every rate.
        let allowed = if coarse.rate < 96_000.0 { 1.8 } else { 1.0 };
        assert!(coarse.bands < allowed, "{name}: {coarse:?}");
    }
}

#[test]
fn a_shoulder_on_the_crash_and_a_bead_on_the_ride_meet_them_as_at_a_fine_step() {
    for (_, [played, _], strike) in contact::fine_strokes() {
        contact_is_that_of_a_fine_step(&played, &strike);
    }
}

#[test]
fn a_shoulder_and_a_bead_meet_cap_cymbals_as_at_a_fine_step() {
    for (_, [_, cap], strike) in contact::fine_strokes() {
        contact_is_that_of_a_fine_step(&cap, &strike);
    }
}
