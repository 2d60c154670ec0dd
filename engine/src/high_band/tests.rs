use super::slices::*;
use super::*;
use crate::build_context::BuildOptions;
use crate::drum::mode_transfer::ModeTransfer;
use crate::drum::modes::DrumModes;
use crate::drum::spec::DrumSpec;
use crate::kit_spec::PieceBuild;
use crate::reference;
use crate::surface::wires;

const RATE: f64 = 44_100.0;

fn band(built: &DrumModes, build: &PieceBuild) -> HighBand {
    let context = build.context(BuildOptions::new(RATE));
    HighBand::new(&built.high_band(build.spec.drum().unwrap(), &context))
}

fn rack_tom() -> (DrumModes, PieceBuild) {
    let build = reference::standard("rack-tom");
    (DrumModes::new(build.spec.drum().unwrap()).unwrap(), build)
}

#[test]
fn slices_follow_on_the_complete_set_in_frequency_mass_count_and_loudness() {
    let (built, build) = rack_tom();
    let band = band(&built, &build);
    let spec = *build.spec.drum().unwrap();
    let middle = (spec.lowest_pitch_hz * spec.highest_pitch_hz).sqrt();
    let place = built.heads.scale.place(middle);
    // Modes of the batter alone: some share their motion with the air and the other head.
    let top: Vec<_> = built.modes.iter().rev().filter(|mode| mode.at(&place).batter > 0.9).collect();
    let highest = top[0].at(&place);
    let first = band.slices().next().unwrap();
    println!("complete to {:.0} Hz, slices from {:.0} Hz", highest.omega / TAU, first.omega / TAU);
    assert!((first.omega / highest.omega - 1.0).abs() < 0.04);
    assert!((first.mass * band.slices[0].count / highest.mass - 1.0).abs() < 0.1);
    // Half an octave of pairs below the slices, against the formula.
    let members = |m: u32| if m == 0 { 1.0 } else { 2.0 };
    let low = highest.omega / 2.0_f64.sqrt();
    let (mut heard, mut count) = (0.0, 0.0);
    let spec = DrumSpec { pitch_hz: middle, ..spec };
    let hearing = ModeTransfer::new(&built, &spec, build.receivers.near);
    let transfer: Vec<_> = hearing.transfers(&built.modes, &place, middle).collect();
    let mut k = 0;
    for mode in &built.modes {
        let both = members(mode.m) as usize;
        if mode.at(&place).omega > low && mode.at(&place).batter > 0.5 {
            heard += transfer[k..k + both].iter().map(|[re, im]| re * re + im * im).sum::<f64>();
            count += members(mode.m);
        }
        k += both;
    }
    let slice = Slice { zero: band.slices[0].zero / 2.0_f64.powf(0.25), ..band.slices[0] };
    let formula = loudness(&band.spec, &slice, first.omega / 2.0_f64.powf(0.25));
    let off = 20.0 * ((heard / count).sqrt() / formula).log10();
    println!("{count} modes are {off:+.2} dB louder than the formula");
    assert!(off.abs() < 2.0, "{off}");
}

#[test]
fn slices_stand_for_as_many_modes_as_there_are_wherever_they_are_narrower_than_one() {
    for name in ["kick", "snare", "rack-tom", "floor-tom"] {
        let build = reference::standard(name);
        let built = DrumModes::new(build.spec.drum().unwrap()).unwrap();
        let band = band(&built, &build);
        let mut below = band.spec.complete as f64;
        for slice in &band.slices {
            // Weyl's count for a clamped membrane; the wave lies anywhere in its slice.
            let modes = 0.25 * slice.zero * slice.zero - 0.5 * slice.zero;
            let within = below - 1e-3..below + slice.count + 1e-3;
            assert!(within.contains(&modes), "{name}, {}: {modes} modes, {within:?}", slice.zero);
            below += slice.count;
        }
        let first = band.slices[0].count;
        println!("{name}: slices stand for {first:.2} modes and more");
        assert_eq!(name != "kick", first < 1.0, "{name}: {first}");
    }
}

#[test]
fn between_the_tensions_that_are_worked_out_modes_are_those_of_their_equation() {
    let (built, build) = rack_tom();
    let band = band(&built, &build);
    let [low, _, high] = band.spec.tensions;
    let table = SliceTable::new(&band.spec, &band.slices);
    for share in [0.0, 0.03, 0.21, 0.47, 0.5, 0.81, 0.99, 1.0] {
        let tension = low * (high / low).powf(share);
        for (slice, TunedSlice { mode: between, loudness }) in band.slices.iter().zip(table.at(tension)) {
            let exact = mode(&band.spec, slice, tension);
            let loud = slices::loudness(&band.spec, slice, exact.omega) / slice.count.sqrt();
            assert!((loudness / loud - 1.0).abs() < 1e-3, "{share}: {loudness} {loud}");
            assert!((between.omega / exact.omega - 1.0).abs() < 1e-5, "{share}: {between:?} {exact:?}");
            assert!((between.sigma / exact.sigma - 1.0).abs() < 1e-3, "{share}: {between:?} {exact:?}");
            assert!((between.mass / exact.mass - 1.0).abs() < 1e-4, "{share}: {between:?} {exact:?}");
        }
    }
}

#[test]
fn it_reaches_16_khz_and_no_farther() {
    let (built, build) = rack_tom();
    for pitch in build.spec.instrument.tunings() {
        let mut band = band(&built, &build);
        band.retune(built.heads.batter.tension(&built.heads.scale.place(pitch)), &HighMuffling::NONE);
        let last = band.slices().last().unwrap().omega / TAU;
        assert!((15_500.0..=16_000.0).contains(&last), "{pitch}: {last}");
    }
}

#[test]
fn a_waves_shape_is_zero_at_the_rim_and_one_in_the_mean() {
    let (built, build) = rack_tom();
    let band = band(&built, &build);
    let count = band.slices.len();
    let at = |radius: f64, angle: f64| {
        let mut out = vec![0.0; count];
        band.waves.fill(radius, angle, &mut out);
        out
    };
    assert!(at(1.0, 0.7).iter().all(|shape| shape.abs() < 1e-6));
    let mut sum = 0.0;
    for i in 0..400 {
        let (radius, angle) = (((f64::from(i) + 0.5) / 400.0).sqrt(), 2.4 * f64::from(i));
        for (got, slice) in at(radius, angle).into_iter().zip(&band.slices) {
            let along = angle.cos() * slice.direction[0] + angle.sin() * slice.direction[1];
            let wave = |r: f64| (slice.zero * r * along + slice.phase).cos();
            let want = wave(radius) - wave(2.0 - radius);
            assert!((f64::from(got) - want).abs() < 1e-6, "{got} {want}");
            sum += want * want / 400.0;
        }
    }
    let mean = sum / count as f64;
    assert!((mean - 1.0).abs() < 0.05, "{mean}");
}

#[test]
fn how_a_run_is_cut_changes_no_sample() {
    let (built, build) = rack_tom();
    let play = |cuts: &[usize]| {
        let mut band = band(&built, &build);
        band.put(0, 0.3, 0.5, 0.003);
        band.put(2, 0.7, 1.5, 0.003);
        let mut sound = vec![0.0_f32; 96];
        let (mut at, mut rest) = (0, &mut sound[..]);
        for &cut in cuts.iter().cycle() {
            let (run, later) = rest.split_at_mut(cut.min(rest.len()));
            for n in 0..run.len() {
                let time = (at + n) as f32;
                // The second presses only for a while.
                band.push(0, n, 3.0 + (0.3 * time).sin());
                band.push(2, n, if (20.0..40.0).contains(&time) { time } else { 0.0 });
            }
            let mut rows = [[0.0; MAX_RUN]; RECEIVERS];
            let mut out = rows.each_mut().map(|row| &mut row[..run.len()]);
            band.render(&mut out);
            run.copy_from_slice(out[0]);
            (at, rest) = (at + run.len(), later);
            if rest.is_empty() {
                break;
            }
        }
        sound
    };
    let whole = play(&[32]);
    assert!(whole.iter().any(|x| x.abs() > 1e-4));
    for cuts in [&[1][..], &[7, 25], &[31, 2, 5]] {
        assert!(whole == play(cuts), "{cuts:?}");
    }
}

#[test]
fn tuned_back_and_forth_it_is_what_it_was() {
    let (built, build) = rack_tom();
    let mut band = band(&built, &build);
    let before: Vec<SliceInfo> = band.slices().collect();
    let [_, tension, highest] = band.spec.tensions;
    band.retune(highest, &HighMuffling { even: 5.0, pad: (30.0, 0.8) });
    let ratio = band.slices().next().unwrap().omega / before[0].omega;
    let bending = {
        let spec = build.spec.drum().unwrap();
        let head = spec.membrane(&spec.batter);
        head.flexural_rigidity() * (band.slices[0].zero / head.radius).powi(2)
    };
    let expected = ((highest + bending) / (tension + bending)).sqrt();
    assert!((ratio / expected - 1.0).abs() < 0.02, "{ratio} {expected}");
    band.retune(tension, &HighMuffling::NONE);
    assert!(before == band.slices().collect::<Vec<_>>());
}

/// Energy (J) after a force that rises and falls within 16 ms, with or without a walk of the phases.
fn energy_after_a_slow_force(walks: bool) -> f64 {
    let (built, build) = rack_tom();
    let mut band = band(&built, &build);
    band.put(0, 0.3, 0.2, 0.004);
    let mut rows = [[0.0; 32]; RECEIVERS];
    for block in 0..30 {
        for sample in 0..32 {
            let share = f64::from(block * 32 + sample) / 700.0;
            let force = if share < 1.0 { 20.0 * (std::f64::consts::PI * share).sin().powi(4) } else { 0.0 };
            band.push(0, sample as usize, force as f32);
        }
        band.render(&mut rows.each_mut().map(|row| &mut row[..]));
        band.settle();
        if walks {
            band.glide(0.0);
        }
    }
    band.energy()
}

#[test]
fn what_a_slow_force_bends_is_not_turned_into_motion() {
    let [still, walking] = [false, true].map(energy_after_a_slow_force);
    assert!((walking / still - 1.0).abs() < 0.01, "{walking:e} J for {still:e} J");
}

/// Energy (J) that noise at all sections of the wires gives the snare's far band, by sums of the forces if its places are `apart`: the
/// mean over some courses of the noise.
fn energy_under_wires(apart: bool) -> f64 {
    let build = reference::standard("snare");
    let drum = build.spec.drum().unwrap();
    let context = build.context(BuildOptions::new(RATE));
    let spec = DrumModes::new(drum).unwrap().far_high_band(drum, &context).unwrap();
    assert!(spec.apart);
    let mut band = HighBand::new(&HighBandSpec { apart, ..spec });
    for (i, [x, y]) in wires::PLACES.into_iter().enumerate() {
        band.put(i, x.hypot(y), x.atan2(-y), wires::TURN);
    }
    const COURSES: u64 = 40;
    let energy = |seed: u64| {
        let mut noise = fastrand::Rng::with_seed(seed);
        let mut rows = [[0.0; 32]; RECEIVERS];
        band.reset();
        for _ in 0..100 {
            for sample in 0..32 {
                // The outer sections are pressed on more than the inner ones.
                (0..band.places())
                    .for_each(|i| band.push(i, sample, [2.0, 1.0][i % 2] * (noise.f32() - 0.5)));
            }
            band.render(&mut rows.each_mut().map(|row| &mut row[..]));
        }
        band.energy() / COURSES as f64
    };
    (0..COURSES).map(energy).sum()
}

#[test]
fn sums_of_the_forces_set_going_as_much_as_every_force_by_itself() {
    let [each, sums] = [false, true].map(energy_under_wires);
    println!("{each:e} J by itself, {sums:e} J by sums");
    assert!((sums / each - 1.0).abs() < 0.03, "{sums:e} J for {each:e} J");
}
