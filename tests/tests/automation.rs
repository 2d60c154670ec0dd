//! Parameters swept while a groove plays: no clicks, the same samples for every buffer size.

use std::sync::Arc;

use overhear::building::Pace;
use overhear::kit_document::KitDocument;
use overhear::parameters::{COUNT, default_value, find, is_live, name, parameters};
use overhear::performer::Performer;
use overhear_tests::standard;

const RATE: f64 = 48_000.0;

/// Length of a take, samples: a second.
const FRAMES: usize = 48_000;

/// Samples from one value of a sweep to the next, as hosts send them at best.
const STEP: usize = 64;

/// Notes of the groove: sample, note, velocity.
const GROOVE: [(usize, u8, f32); 8] = [
    (0, 36, 0.9),
    (0, 49, 0.5),
    (6_000, 38, 0.8),
    (12_001, 36, 0.7),
    (15_000, 48, 0.8),
    (18_007, 38, 0.9),
    (24_000, 43, 0.8),
    (36_000, 51, 0.7),
];

/// Low drums only, which ring on without anything as rough as a click: the snare's wires, which answer them, are thrown off.
/// Soft enough to stay below [`BENDS`] with every level at its highest.
const RINGING: [(usize, u8, f32); 3] = [(0, 36, 0.3), (0, 43, 0.3), (0, 88, 0.35)];

/// Full scale above which the mix bends what would hurt, and what is bent is no longer smooth.
const BENDS: f32 = 2.0;

/// What is swept: from one end to the other and back within the take.
struct Sweep {
    names: Vec<String>,
    /// Share of the range at a sample.
    share: fn(usize) -> f32,
    /// Whether the snare has its wires.
    wires: bool,
}

/// Up and down twice.
fn triangle(sample: usize) -> f32 {
    let phase = (sample as f32 / (FRAMES as f32 / 2.0)).fract();
    1.0 - (2.0 * phase - 1.0).abs()
}

/// Everything that can be heard move on a drum that rings, of a suffix.
fn all(suffix: &str) -> Vec<String> {
    let kit = standard();
    let names = (0..COUNT).filter(|&index| is_live(index, &kit)).map(|index| name(index, &kit));
    names.filter(|name| name.ends_with(suffix)).collect()
}

/// A performer with its kit.
fn performer() -> Performer {
    let mut performer = Performer::new(RATE, &KitDocument::standard(), Arc::default());
    performer.install_kit(RATE, Pace::RealTime).unwrap();
    performer
}

/// Plays notes under a sweep in buffers of some length, from rest and from the defaults.
fn play(performer: &mut Performer, sweep: &Sweep, buffer: usize, notes: &[(usize, u8, f32)]) -> Vec<f32> {
    let kit = standard();
    for index in 0..COUNT {
        performer.set_parameter(index, default_value(index, &kit));
    }
    performer.set_parameter(find("snare_wires", &kit).unwrap(), f32::from(u8::from(sweep.wires)));
    performer.reset();
    let indices: Vec<usize> = sweep.names.iter().map(|name| find(name, &kit).unwrap()).collect();
    let (mut left, mut right) = (vec![0.0; FRAMES], vec![0.0; FRAMES]);
    let mut now = 0;
    while now < FRAMES {
        if now % STEP == 0 {
            for &index in &indices {
                let parameter = &parameters()[index];
                let value = parameter.min + (parameter.max - parameter.min) * (sweep.share)(now);
                performer.set_parameter(index, value);
            }
        }
        for &(_, note, velocity) in notes.iter().filter(|(at, ..)| *at == now) {
            performer.note_on(note, velocity, 9);
        }
        let next_value = (now / STEP + 1) * STEP;
        let next_note = notes.iter().map(|(at, ..)| *at).filter(|at| *at > now).min().unwrap_or(FRAMES);
        let until = next_value.min(next_note).min(FRAMES).min((now / buffer + 1) * buffer);
        performer.render(&mut left[now..until], &mut right[now..until]);
        now = until;
    }
    left
}

/// The largest step in the sound once the strokes are over, of the peak: what the third difference, in which a step stands
/// out twice as high as it is, reaches beyond its own roughness about (five times its root mean square over 20 ms; noise
/// that decays reaches 3 to 4.5 times).
fn step(sound: &[f32]) -> f32 {
    let peak = sound.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
    let third: Vec<f32> = sound[6_000..].windows(4).map(|x| x[3] - 3.0 * x[2] + 3.0 * x[1] - x[0]).collect();
    let beyond = |x: &[f32]| {
        let mean = x.iter().map(|x| f64::from(x * x)).sum::<f64>() / x.len() as f64;
        x.iter().fold(0.0_f32, |most, x| most.max(x.abs())) - 5.0 * mean.sqrt() as f32
    };
    third.chunks_exact(960).map(beyond).fold(0.0, f32::max) / (2.0 * peak)
}

/// A step that is inaudible under a ringing drum: 74 dB below the peak of the sound.
const CLICK: f32 = 2e-4;

#[test]
fn sweeps_over_ringing_drums_do_not_click() {
    let mut performer = performer();
    let mut take = |names: Vec<String>| {
        play(&mut performer, &Sweep { names, share: triangle, wires: false }, 512, &RINGING)
    };
    let mut clicking = take(Vec::new());
    let still = step(&clicking);
    let peak = clicking.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
    // Twice the step, since its own height raises the roughness about it.
    clicking[20_000..].iter_mut().for_each(|sample| *sample += 2.0 * CLICK * peak);
    let click = step(&clicking);
    println!("{still:.1e} of the peak without a sweep, {click:.1e} with a click");
    assert!(still < 0.5 * CLICK && click > CLICK, "a click would not be noticed");
    for names in [all("_tune"), all("_muffle"), all("_level"), all("_pan"), vec!["master_level".to_owned()]] {
        let name = names[0].clone();
        let sound = take(names);
        let swept = step(&sound);
        println!("{name}: {swept:.2e}");
        assert!(swept < CLICK, "{name}: {swept}");
        assert!(sound.iter().all(|sample| sample.abs() < BENDS), "{name}: too loud to be told from a click");
    }
}

/// The snare alone, its wires buzzing.
const BUZZING: [(usize, u8, f32); 1] = [(0, 38, 0.9)];

#[test]
fn a_sweep_of_the_preload_over_a_buzzing_snare_does_not_click() {
    let mut performer = performer();
    let mut take = |names: &[&str]| {
        let names = names.iter().map(|name| (*name).to_owned()).collect();
        play(&mut performer, &Sweep { names, share: triangle, wires: true }, 512, &BUZZING)
    };
    let (still, swept) = (step(&take(&[])), step(&take(&["snare_preload"])));
    println!("{still:.1e} of the peak without a sweep, {swept:.1e} with one");
    assert!(swept < CLICK, "{swept} against {still}");
}

#[test]
fn sweeps_give_the_same_samples_for_every_buffer_size() {
    let mut names = all("_tune");
    names.extend(all("_muffle"));
    names.push("snare_preload".to_owned());
    let sweep = Sweep { names, share: triangle, wires: true };
    let mut performer = performer();
    let whole = play(&mut performer, &sweep, FRAMES, &GROOVE);
    assert!(whole.iter().any(|sample| *sample != 0.0));
    for buffer in [17, 64, 441] {
        assert!(play(&mut performer, &sweep, buffer, &GROOVE) == whole, "buffers of {buffer}");
    }
    let silence = play(&mut performer, &sweep, 512, &[]);
    assert!(silence.iter().all(|sample| *sample == 0.0), "a sweep over a silent kit is heard");
}
