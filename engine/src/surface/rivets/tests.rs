use std::f64::consts::TAU;

use super::*;
use crate::block::BLOCK;
use crate::build_context::{BuildOptions, Idealization};
use crate::cymbal::Cymbal;
use crate::instrument::Instrument as _;
use crate::modal::{Mode, RECEIVERS};
use crate::mode::Member;
use crate::reference;
use crate::shapes::{ShapeIndex, ShapeTable};
use crate::strike::{Strike, Striker};
use crate::surface::{Surface, SurfaceParts};

const RATE: f64 = 44_100.0;

const SIX: RivetsSpec =
    RivetsSpec { number: 6, radius: 0.9, arc: None, toward: 0.3, mass: 1.5e-3, play: 2.5e-3 };

const STROKE: Strike = Strike { striker: Striker::Stick, speed: 3.0, radius: 0.7, angle: 0.3 };

/// A cymbal of the standard kit with rivets, of which something may be left out.
fn cymbal(name: &str, rivets: Option<RivetsSpec>, ideal: Idealization) -> Cymbal {
    let mut build = reference::standard(name);
    build.spec.ideal = ideal;
    let spec = crate::cymbal::CymbalSpec { rivets, ..reference::cymbal(name) };
    Cymbal::new(&spec, &build.context(BuildOptions::new(RATE))).unwrap()
}

/// A body of one heavy mode, the same everywhere, with one rivet that loses nothing.
fn heavy(play: f64) -> Surface {
    let index = ShapeIndex { radial: 0, rows: 1, m: 0, member: Member::Cosine, axis: 0.0 };
    let mut surface = Surface::new(SurfaceParts {
        modes: vec![Mode { omega: TAU * 20.0, sigma: 0.0, mass: 1e4 }],
        shapes: ShapeTable::new(&vec![1.0; ShapeTable::radii().len()], vec![index]),
        transfer: vec![[1.0, 0.0]],
        material: Material::BRONZE,
        lossless: true,
        sample_rate: RATE,
    });
    let spec = RivetsSpec { number: 1, play, ..SIX };
    surface.attach(Rivets::new(&spec, &Material::BRONZE, true, 1.0 / RATE));
    surface.wake();
    surface
}

fn run(surface: &mut Surface, samples: usize) -> [f32; BLOCK] {
    let mut out = [[0.0; BLOCK]; RECEIVERS];
    surface.render_in_air(out.each_mut().map(|row| &mut row[..samples]), None);
    out[0]
}

fn rivets(surface: &Surface) -> &Rivets {
    surface.attachment().unwrap()
}

fn height(surface: &Surface) -> f64 {
    rivets(surface).heights().next().unwrap()
}

/// Renders for a time (s), block by block.
fn play(surface: &mut Surface, seconds: f64) -> Vec<f32> {
    let mut sound = Vec::new();
    for _ in 0..(seconds * RATE / BLOCK as f64).round() as usize {
        assert!(surface.settle());
        sound.extend(run(surface, BLOCK));
    }
    sound
}

/// Energy of all there is and of what has left, over what was brought.
fn share(surface: &Surface) -> f64 {
    (surface.energy() + surface.striker_energy() + surface.departed_energy()) / surface.brought_energy()
}

#[test]
fn a_rivet_that_is_thrown_up_falls_as_a_stone_and_bounces_as_high() {
    let mut surface = heavy(5e-3);
    let speed = 0.25;
    surface.attachment_mut::<Rivets>().unwrap().rivets[0].mass.v = -speed;
    let (mut highest, mut landed, mut samples) = (0.0_f64, Vec::new(), 0);
    while landed.len() < 4 && samples < 20_000 {
        run(&mut surface, 1);
        samples += 1;
        highest = highest.max(height(&surface));
        if rivets(&surface).landings() as usize > landed.len() {
            landed.push(samples as f64 / RATE);
        }
    }
    // v^2 / 2g high, 2v/g long.
    assert!((highest / (speed * speed / (2.0 * GRAVITY)) - 1.0).abs() < 0.01, "{highest} m");
    for pair in landed.windows(2) {
        let flight = pair[1] - pair[0];
        assert!((flight / (2.0 * speed / GRAVITY) - 1.0).abs() < 0.01, "{flight} s");
    }
    assert_eq!(landed.len(), 4);
}

#[test]
fn the_lower_end_stops_a_rivet_that_is_thrown_too_high() {
    let (play, speed) = (1e-3, 0.5);
    let mut surface = heavy(play);
    surface.attachment_mut::<Rivets>().unwrap().rivets[0].mass.v = -speed;
    let energy = surface.energy();
    let mut highest = 0.0_f64;
    for _ in 0..2000 {
        run(&mut surface, 1);
        highest = highest.max(height(&surface));
        assert!((surface.energy() / energy - 1.0).abs() < 1e-6);
    }
    // It would fly a dozen times as high; its end gives by micrometres.
    assert!((play..play + 2e-5).contains(&highest), "{highest} m");
    // Up and down takes nearly 2 p / v: both ends land some ten times.
    assert!(rivets(&surface).landings() > 15, "{}", rivets(&surface).landings());
}

#[test]
fn a_rivet_at_rest_stays_at_rest() {
    let mut surface = heavy(1e-3);
    for _ in 0..1000 {
        let loudest = run(&mut surface, BLOCK).iter().fold(0.0_f32, |most, x| most.max(x.abs()));
        assert!(loudest < 1e-15, "{loudest} Pa");
    }
    assert_eq!(rivets(&surface).landings(), 0);
    assert!(height(&surface).abs() < 1e-12, "{} m", height(&surface));
}

#[test]
fn without_losses_a_cymbal_and_its_rivets_keep_their_energy() {
    let most = RivetsSpec { number: 12, ..SIX };
    let cluster = RivetsSpec { number: 3, arc: Some(0.3), mass: 2.5e-3, play: 5e-4, ..SIX };
    for (name, rivets, linear) in [("crash", SIX, true), ("crash", most, false), ("splash", cluster, false)] {
        let ideal = Idealization { lossless: true, linear, ..Idealization::default() };
        let mut cymbal = cymbal(name, Some(rivets), ideal);
        for speed in [1.0, 5.0] {
            cymbal.surface_mut().reset();
            cymbal.surface_mut().strike(&Strike { speed, ..STROKE });
            for _ in 0..10 {
                play(cymbal.surface_mut(), 0.05);
                let off = share(cymbal.surface()) - 1.0;
                assert!(off.abs() < 1e-3, "{name} at {speed} m/s: {off:.1e}");
            }
            assert!(self::rivets(cymbal.surface()).landings() > 100, "{name}");
        }
    }
}

#[test]
fn struck_rivets_land_often_take_energy_only_and_come_to_lie() {
    let [mut plain, mut riveted] =
        [None, Some(SIX)].map(|rivets| cymbal("splash", rivets, Idealization::default()));
    for cymbal in [&mut plain, &mut riveted] {
        cymbal.surface_mut().strike(&STROKE);
    }
    let (mut before, mut landed) = (f64::INFINITY, Vec::new());
    for tenth in 0..60 {
        play(plain.surface_mut(), 0.1);
        play(riveted.surface_mut(), 0.1);
        let share = share(riveted.surface());
        assert!(
            share < before + 1e-6 && share < 1.0,
            "after {tenth} tenths of a second {share}, before {before}"
        );
        before = share;
        landed.push(rivets(riveted.surface()).landings());
    }
    assert!(landed[1] > 50, "{landed:?}");
    assert!(riveted.surface().energy() < plain.surface().energy());
    // They have come to lie long before, and the cymbal rings in blocks.
    assert!(!rivets(riveted.surface()).is_engaged(), "{landed:?}");
    assert_eq!(landed[50], landed[59]);
}

#[test]
fn what_shakes_the_plate_wakes_rivets_that_lie() {
    let mut cymbal = cymbal("ride", Some(SIX), Idealization::default());
    let surface = cymbal.surface_mut();
    surface.strike(&Strike { speed: 0.01, ..STROKE });
    assert!(rivets(surface).is_engaged());
    play(surface, 3.0);
    assert!(!rivets(surface).is_engaged());
    // A push that is no stroke: a mode near 1 kHz moves by a micrometre, 40 m/s2.
    let k = surface.body().modes().iter().position(|mode| mode.omega > TAU * 1000.0).unwrap();
    let mut displacements = surface.body().displacements().to_vec();
    displacements[k] += 1e-6;
    surface.body_mut().set_displacements(&displacements);
    play(surface, 0.05);
    assert!(rivets(surface).is_engaged());
    assert!(rivets(surface).landings() > 0);
}

#[test]
fn ends_that_are_left_out_would_not_have_touched() {
    // The same with both ends of all rivets solved for in every sample: other sums round otherwise, and rivets that bounce make
    // a hundred times as much of a difference every few milliseconds.
    let mut cymbal = cymbal("crash", Some(SIX), Idealization { linear: true, ..Idealization::default() });
    let mut sounds = [false, true].map(|all| {
        let surface = cymbal.surface_mut();
        surface.reset();
        surface.attachment_mut::<Rivets>().unwrap().solves_all = all;
        surface.strike(&Strike { speed: 6.0, ..STROKE });
        let sound = play(surface, 0.012);
        assert!(rivets(surface).landings() > 20, "{}", rivets(surface).landings());
        sound
    });
    let loudest = sounds[0].iter().fold(0.0_f32, |most, x| most.max(x.abs()));
    let [near, all] = &mut sounds;
    let apart = near.iter().zip(all).fold(0.0_f32, |most, (a, b)| most.max((*a - *b).abs()));
    assert!(apart < 1e-3 * loudest, "{apart} of {loudest} Pa");
}
