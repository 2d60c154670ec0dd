use super::*;
use crate::reference;

#[test]
fn the_gradient_is_that_of_the_energy_below_and_beyond_yield() {
    let spec = reference::drum("rack-tom");
    let drum = Shared::new(DrumModes::new(&spec).unwrap());
    let mixed = Shared::new(MixedModes::new(&drum, &spec.unevenness().unwrap(), |_| 0.0));
    for mixed in [None, Some(&mixed)] {
        check(&spec, &drum, mixed);
    }
}

fn check(spec: &crate::drum::DrumSpec, drum: &Shared<DrumModes>, mixed: Option<&Shared<MixedModes>>) {
    let StretchModel { potential: mut stretch, modes, .. } = StretchModel::new(drum, mixed, spec.pitch_hz);
    let mut gradient = zero_row(modes);
    let mut scratch = zero_row(modes);
    let shapes: Vec<f32> = (0..modes).map(|k| (2.3 * k as f32).cos()).collect();
    stretch.press(0.3, &shapes, &scratch);
    for size in [1e-4_f32, 3e-3, 3e-2] {
        let mut q: Vec<f32> = (0..modes).map(|k| size * (1.7 * k as f32).sin() / (1.0 + k as f32)).collect();
        stretch.evaluate(&q, &mut gradient);
        for k in [0, 1, 5, modes / 2] {
            let (at, step) = (q[k], 3e-3 * size);
            q[k] = at + step;
            let up = stretch.evaluate(&q, &mut scratch).energy;
            q[k] = at - step;
            let down = stretch.evaluate(&q, &mut scratch).energy;
            q[k] = at;
            let slope = (up - down) / f64::from(2.0 * step);
            let error = (slope - f64::from(gradient[k])).abs();
            let scale = f64::from(gradient[0].abs().max(gradient[k].abs()));
            assert!(error < 2e-3 * scale, "{size} {k}: {slope} {}", gradient[k]);
        }
    }
}

#[test]
fn the_gradient_holds_every_mode_and_the_energy_too() {
    // Below yield the energy goes with the fourth power of the displacement: by Euler's theorem `grad E . q = 4 E`.
    let spec = reference::drum("rack-tom");
    let drum = Shared::new(DrumModes::new(&spec).unwrap());
    let mixed = Shared::new(MixedModes::new(&drum, &spec.unevenness().unwrap(), |_| 0.0));
    let StretchModel { potential: mut stretch, modes, .. } =
        StretchModel::new(&drum, Some(&mixed), spec.pitch_hz);
    let (mut q, mut gradient) = (zero_row(modes), zero_row(modes));
    stretch.press(0.2, &vec![1.0; modes], &q);
    for k in 0..modes {
        q[k] = 1e-4;
        let energy = stretch.evaluate(&q[..modes], &mut gradient).energy;
        let work = f64::from(gradient[k]) * f64::from(q[k]);
        assert!(energy > 0.0 && (work / (4.0 * energy) - 1.0).abs() < 1e-5, "mode {k}: {work} {energy}");
        q[k] = 0.0;
    }
}

#[test]
fn at_another_pitch_it_is_the_stretch_of_a_drum_built_there_and_what_that_adds_is_told() {
    let spec = reference::drum("kick");
    let drum = Shared::new(DrumModes::new(&spec).unwrap());
    let mixed = Shared::new(MixedModes::new(&drum, &spec.unevenness().unwrap(), |_| 0.0));
    let of = |pitch_hz: f64| StretchModel::new(&drum, Some(&mixed), pitch_hz);
    let StretchModel { potential: mut live, modes, .. } = of(spec.pitch_hz);
    let q: Vec<f32> =
        (0..zero_row(modes).len()).map(|k| 3e-3 * (1.7 * k as f32).sin() / (1.0 + k as f32)).collect();
    let shapes: Vec<f32> = (0..modes).map(|k| (2.3 * k as f32).cos()).collect();
    let (mut gradient, mut expected) = (zero_row(modes), zero_row(modes));
    live.press(0.3, &shapes, &q);
    let mut before = live.evaluate(&q, &mut gradient).energy;
    let mut changes = 0.0_f64;
    for pitch in [spec.lowest_pitch_hz, spec.highest_pitch_hz, 50.0] {
        let more = live.retune(pitch, &q);
        let held = live.evaluate(&q, &mut gradient).energy;
        assert!((before + more - held).abs() < 1e-6 * held, "{pitch} Hz: {before} and {more} for {held}");
        changes = changes.max((more / held).abs());
        // The next tip finds what a drum has that was built there.
        let StretchModel { potential: mut built, modes: as_many, .. } = of(pitch);
        assert_eq!(as_many, modes);
        built.press(0.3, &shapes, &q);
        live.press(0.3, &shapes, &q);
        let (ours, theirs) =
            (live.evaluate(&q, &mut gradient).energy, built.evaluate(&q, &mut expected).energy);
        assert_eq!((ours, &*gradient), (theirs, &*expected), "{pitch} Hz");
        before = ours;
    }
    assert!(changes > 0.01, "shares matter: {changes}");
}

#[test]
fn modes_that_do_not_stretch_the_heads_stiffen_by_the_whole_of_an_added_tension() {
    // Of a mode that is a head's alone, tension and the film's bending are all the stiffness there is.
    let mut spec = reference::drum("rack-tom");
    spec.batter.modes_to_hz = 3000.0;
    let drum = Shared::new(DrumModes::new(&spec).unwrap());
    // Where the drum is worked out: between, shares are blended by themselves.
    let pitch = drum.heads.scale.pitches()[crate::drum::heads::MIDDLE];
    let place = drum.heads.scale.place(pitch);
    let StretchModel { modes: first, above, .. } = StretchModel::new(&drum, None, pitch);
    let heads = [Some(&drum.heads.batter), drum.heads.resonant.as_ref()].map(Option::unwrap);
    let members = drum.modes.iter().flat_map(|mode| {
        let at = mode.at(&place);
        std::iter::repeat_n(at, Splitting::ROUND.members(mode.m, 0).count())
    });
    let mut compared = [0; HEADS];
    for (mode, above) in members.skip(first).zip(above) {
        let shares = [mode.batter, mode.resonant];
        let Some(of) = (0..HEADS).find(|&of| shares[of] > 0.9 && shares[1 - of].abs() < 1e-6) else {
            continue;
        };
        let (head, spec) = (heads[of], heads[of].membrane.spec());
        let by_tension = above[of] * head.tension(&place);
        let by_bending = above[of].powi(2) / spec.area() * spec.flexural_rigidity();
        let stiffness = mode.mass * mode.omega * mode.omega;
        let off = (by_tension + by_bending) / stiffness - 1.0;
        assert!(off.abs() < 2e-3, "{off} {mode:?}");
        compared[of] += 1;
    }
    assert!(compared.iter().all(|&modes| modes > 50), "{compared:?}");
}
