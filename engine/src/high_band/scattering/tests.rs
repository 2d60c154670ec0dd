use std::f64::consts::TAU;

use super::super::HighBand;
use super::*;
use crate::build_context::{BuildContext, BuildOptions, Idealization};
use crate::drum::Drum;
use crate::drum::modes::DrumModes;
use crate::instrument::Instrument;
use crate::reference;
use crate::strike::{Strike, Striker};

const RATE: f64 = 44_100.0;

fn context(name: &str) -> BuildContext {
    reference::standard(name).context(BuildOptions::new(RATE))
}

fn stroke(speed: f64, angle: f64) -> Strike {
    Strike { speed, radius: 0.3, angle, striker: Striker::Stick }
}

/// Renders a block of a drum.
fn render(drum: &mut Drum) {
    let mut sounds = [[0.0; BLOCK]; crate::modal::RECEIVERS];
    drum.surface_mut().render_in_air(sounds.each_mut().map(|row| &mut row[..]), None);
    assert!(drum.surface_mut().settle());
}

fn decibels(ratio: f64) -> f64 {
    10.0 * ratio.log10()
}

#[test]
fn every_slice_gets_its_share_and_all_of_them_what_is_said() {
    let spec = reference::drum("rack-tom");
    let built = DrumModes::new(&spec).unwrap();
    let mut band = HighBand::new(&built.high_band(&spec, &context("rack-tom")));
    let HighBand { body, scattering, laid, slices, .. } = &mut band;
    let kinetic = 0.1;
    for stretched in [0.05, 0.5, 5.0] {
        body.reset();
        let given = scattering.scatter((stretched, kinetic), laid.tension, body);
        let energy = body.energy();
        assert!(given > 0.0 && (energy / given - 1.0).abs() < 1e-4, "{energy} J for {given}");
        let reach = scattering.reach(stretched, laid.tension);
        let share = scattering.rate * body.modes()[0].omega / slices[0].zero * scattering.interval;
        for (k, slice) in slices.iter().enumerate().filter(|(_, slice)| slice.zero < 10.0 * reach) {
            let law = 2.0 * kinetic * share / (reach * reach) * slice.count * (-slice.zero / reach).exp();
            let got = body.band_energy(k..k + 1, &scattering.weights).whole;
            assert!(decibels(got / law).abs() < 1.0, "{stretched} J, {}: {got} J for {law}", slice.zero);
        }
    }
    // Slices that move already, too: 30 blocks of it are 30 times as much.
    body.reset();
    let given: f64 = (0..30).map(|_| scattering.scatter((0.5, kinetic), laid.tension, body)).sum();
    assert!((body.energy() / given - 1.0).abs() < 1e-4, "{} J for {given}", body.energy());
}

#[test]
fn what_slices_get_is_taken_from_the_modes() {
    for name in ["rack-tom", "kick"] {
        let ideal = Idealization { lossless: true, ..Idealization::NONE };
        let mut drum = Drum::new(&reference::drum(name), &BuildContext { ideal, ..context(name) }).unwrap();
        drum.strike(&stroke(10.0, 0.3));
        let surface = |drum: &Drum| {
            let it = drum.surface();
            (it.energy() + it.striker_energy() + it.departed_energy(), it.scattered_energy())
        };
        let brought = drum.surface().brought_energy();
        for block in 0..60 {
            render(&mut drum);
            let (kept, scattered) = surface(&drum);
            let off = (kept + scattered) / brought - 1.0;
            assert!(off.abs() < 1e-4, "{name}, block {block}: {off:.1e}");
        }
        let (_, scattered) = surface(&drum);
        println!("{name}: {:.1} dB of a stroke at 10 m/s", decibels(scattered / brought));
        assert!((0.001..0.1).contains(&(scattered / brought)), "{name}: {scattered} of {brought} J");
    }
}

#[test]
fn the_waves_above_the_modes_get_what_foeppls_equations_give_them() {
    // What reaches a film of 12 in by the equations in the plane (EXPERIMENTS.md, Drums), from 2.8, 4 and 5.6 to 8 kHz, over what the force of
    // the instrument's tip gives a film that does not stretch, both as a force there in dB re 1 N s.
    let equations =
        [(3.0, [-77, -81, -86].map(f64::from)), (5.0, [-70.0, -74.0, -80.0]), (8.0, [-62.0, -65.0, -71.0])];
    let force = [[-77.0, -80.0, -84.0], [-72.0, -75.0, -80.0], [-66.0, -71.0, -75.0]];
    let edges = [2800.0, 4000.0, 5600.0, 8000.0];
    let mut drum = Drum::new(&reference::drum("rack-tom"), &context("rack-tom")).unwrap();
    let mut energies = |speed: f64, rate: f64| -> [f64; 3] {
        let mut sums = [0.0; 3];
        for angle in [0.3, 1.1, 2.0, 2.9, 3.7, 4.8] {
            drum.surface_mut().reset();
            drum.surface_mut().high_bands_mut().for_each(|band| band.set_scattering(rate));
            drum.strike(&stroke(speed, angle));
            // 9 ms; the tip touches for 5 to 7.
            (0..13).for_each(|_| render(&mut drum));
            let band = drum.surface().high_bands().next().unwrap();
            let at = |hz: f64| band.body.modes().partition_point(|mode| mode.omega < TAU * hz);
            for (sum, edge) in sums.iter_mut().zip(edges.windows(2)) {
                let slices = at(edge[0])..at(edge[1]);
                *sum += band.body.band_energy(slices, &band.scattering.weights).whole;
            }
        }
        sums
    };
    for ((speed, equations), force) in equations.into_iter().zip(force) {
        let (with, without) = (energies(speed, fitted::SCATTERING), energies(speed, 0.0));
        for band in 0..3 {
            let (more, by) = (decibels(with[band] / without[band]), equations[band] - force[band]);
            println!("{speed} m/s from {} Hz: {more:.1} dB more, by the equations {by:.1}", edges[band]);
            // The law only adds to what the force gives.
            assert!((more - by.max(0.0)).abs() < 2.0, "{speed} m/s from {} Hz: {more} for {by}", edges[band]);
        }
    }
}
