//! What sizes, heads and metals do to a sound, as the literature and those who make and sell instruments say: larger is lower, two
//! plies are duller and shorter than one, brass is shorter and darker than bronze.
//!
//! Every instrument here is a few lines of a kit file, as a user writes them; it is built, struck and measured as `hear` does. Each
//! test names its source. Where sources contradict each other or the instrument, docs/kit-files.md says so.

use overhear::kit_document::KitDocument;
use overhear::kit_file;
use overhear_engine::piece::BuildOptions;
use overhear_engine::strike::{Strike, Striker};
use overhear_measure::analysis;
use overhear_measure::hear::{self, Request};
use overhear_measure::spectra::PowerSpectrum;
use overhear_tests::stroke;

const RATE: f64 = 44_100.0;

/// A struck instrument.
struct Recorded(Vec<f32>);

/// Kit file of a kit of the one piece `tested`.
fn file(piece: &str) -> String {
    let others = "kick snare rack-tom floor-tom crash ride splash hi-hat timpani".split(' ');
    let others: Vec<String> = others.map(|name| format!("{name:?}")).collect();
    format!("format = 1\nremove = [{}]\n[pieces.tested]\n{piece}", others.join(", "))
}

fn read(piece: &str) -> KitDocument {
    kit_file::read("tested", &file(piece)).unwrap_or_else(|refused| panic!("{refused}\n{piece}"))
}

/// Builds what a kit file says of a piece, strikes it, and listens for so many seconds.
fn struck(piece: &str, strike: Strike, seconds: f64) -> Recorded {
    let kit = read(piece).kit;
    let options = BuildOptions::new(RATE);
    let request = Request { kit, strike, settings: Vec::new(), options, seconds };
    Recorded(hear::render(&request).expect("a piece that can be built").samples)
}

impl Recorded {
    /// The strongest line between two frequencies, Hz.
    fn line(&self, low: f64, high: f64) -> f64 {
        PowerSpectrum::hann(&self.0, RATE).line(0.5 * (low + high), 0.5 * (high - low))
    }

    /// Mean frequency by power, Hz.
    fn brightness(&self) -> f64 {
        PowerSpectrum::new(&self.0, RATE).centroid(20.0, 20_000.0).expect("a sound")
    }

    /// Mean frequency by power of what rings from 50 ms on, Hz.
    fn ring(&self) -> f64 {
        Recorded(self.0[(0.05 * RATE) as usize..].to_vec()).brightness()
    }

    /// Time by which the sound would fall by 60 dB, from its first 10 dB, s.
    fn length(&self) -> f64 {
        analysis::broadband_decays(&self.0, RATE)[0].expect("a sound that falls")
    }

    /// The same in one octave, from its late decay, s.
    fn decay(&self, octave_hz: f64) -> f64 {
        let at = analysis::OCTAVES.iter().position(|&hz| hz == octave_hz).expect("an octave");
        analysis::octave_decays(&self.0, RATE)[at].expect("an octave that falls")
    }

    /// Level above a frequency (Hz) between two times (s), dB.
    fn level(&self, above: f64, from: f64, to: f64) -> f64 {
        let part = &self.0[(from * RATE) as usize..(to * RATE) as usize];
        10.0 * PowerSpectrum::hann(part, RATE).band(above, 20_000.0).log10()
    }

    /// How much more the first 30 ms have than all that follows, dB: the stick over the wash.
    fn ping(&self) -> f64 {
        let (first, rest) = self.0.split_at((0.03 * RATE) as usize);
        let energy = |of: &[f32]| of.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>();
        10.0 * (energy(first) / energy(rest)).log10()
    }
}

/// Whether each figure is higher than the next by a share of it at least.
#[track_caller]
fn falls(what: &str, figures: &[f64], share: f64) {
    println!("{what}: {figures:.3?}");
    assert!(figures.windows(2).all(|pair| pair[0] > (1.0 + share) * pair[1]), "{what}: {figures:?}");
}

/// Whether each figure is lower than the next by a share of it at least.
#[track_caller]
fn rises(what: &str, figures: &[f64], share: f64) {
    println!("{what}: {figures:.3?}");
    assert!(figures.windows(2).all(|pair| pair[1] > (1.0 + share) * pair[0]), "{what}: {figures:?}");
}

const STICK: Striker = Striker::Stick;

/// `f = j / (2 pi a) sqrt(T / sigma)`: T. D. Rossing, Science of Percussion Instruments, 2000, ch. 2. Small drums are quieter
/// and higher: drumyoda.blogspot.com/2022/03.
#[test]
fn of_drums_with_one_head_at_one_tension_the_larger_are_lower() {
    let toms = [10.0, 12.0, 14.0, 16.0].map(|inches| {
        let pitch = 1580.0 / inches;
        let piece = format!(
            "like = \"tom-12x9\"\ndiameter_in = {inches}\npitch_hz = {pitch}\nlowest_pitch_hz = 60\nhighest_pitch_hz = 200"
        );
        struck(&piece, stroke(STICK, 3.0, 0.3, 0.0), 1.5)
    });
    falls("the strongest line, Hz", &toms.each_ref().map(|tom| tom.line(60.0, 300.0)), 0.08);
    falls("mean frequency, Hz", &toms.each_ref().map(Recorded::brightness), 0.02);
    rises("decay at 125 Hz, s", &toms.each_ref().map(|tom| tom.decay(125.0)), 0.03);
}

/// The air in a drum couples the first modes of its heads, as a spring that is the softer the more air there is: T. D. Rossing,
/// I. Bork, H. Zhao, D. Fystrom, Acoustics of snare drums, J. Acoust. Soc. Am. 92, 1992; a shallow piccolo is higher and sharper:
/// spiegato.com/en/what-is-a-piccolo-snare-drum.
#[test]
fn a_deeper_snare_has_a_lower_cavity_and_is_darker() {
    let snares = [3.5, 5.0, 6.5, 8.0, 12.0].map(|inches| {
        let body = "like = \"snare-14-standard\"\nwires = \"none\"\ndefaults.preload_n = \"none\"";
        let piece = format!("{body}\nshell.depth_in = {inches}");
        struck(&piece, stroke(STICK, 2.0, 0.0, 0.0), 1.0)
    });
    falls("the first round mode, Hz", &snares.each_ref().map(|snare| snare.line(180.0, 290.0)), 0.02);
    falls("mean frequency, Hz", &snares.each_ref().map(Recorded::brightness), 0.04);
}

fn headed(head: &str) -> Recorded {
    let piece = format!("like = \"tom-12x9\"\nbatter.like = \"{head}\"");
    struck(&piece, stroke(STICK, 3.0, 0.3, 0.0), 2.0)
}

/// F. Azzarto, What you need to know about drumheads, Modern Drummer, 2010: two plies have fewer overtones and a shorter
/// sustain, one ply is brighter and rings. By how much is not said.
#[test]
fn two_plies_are_duller_and_shorter_than_one() {
    let heads = ["clear-7", "two-ply-clear"].map(headed);
    falls("what rings, mean frequency, Hz", &heads.each_ref().map(Recorded::ring), 0.02);
    for octave in [250.0, 1000.0, 4000.0] {
        falls(&format!("decay at {octave} Hz, s"), &heads.each_ref().map(|head| head.decay(octave)), 0.15);
    }
}

/// The coating muffles as a further ply does: A. Klausner, Which head's for you?, iml.jou.ufl.edu/projects/fall11/klausner_a.
#[test]
fn a_coated_head_is_shorter_than_a_clear_one() {
    let heads = ["clear-10", "coated-10"].map(headed);
    for octave in [250.0, 1000.0, 4000.0] {
        falls(&format!("decay at {octave} Hz, s"), &heads.each_ref().map(|head| head.decay(octave)), 0.2);
    }
}

/// The thinner a single ply, the less it sustains: F. Azzarto, Modern Drummer, 2010. What moves less mass is braked more by the sound
/// that it sends out: N. H. Fletcher, T. D. Rossing, The Physics of Musical Instruments, 1998, ch. 18.
#[test]
fn a_thin_film_rings_shorter_than_a_thick_one() {
    let heads = ["clear-7", "clear-10", "clear-12"].map(headed);
    rises("length, s", &heads.each_ref().map(Recorded::length), 0.03);
}

/// A dot focuses the sound and changes how it decays: Inside your drumhead, Drum! magazine. Here overtones are shorter.
#[test]
fn a_dot_takes_from_the_overtones() {
    let heads = ["clear-10", "clear-10-dot"].map(headed);
    for octave in [500.0, 2000.0, 4000.0] {
        falls(&format!("decay at {octave} Hz, s"), &heads.each_ref().map(|head| head.decay(octave)), 0.1);
    }
}

/// A mesh moves without pushing much air: johnlambdrums.com/remo-silentstrokes; by how much is not said. The air between the threads is
/// inert, and least so for slow waves: P. M. Morse, K. U. Ingard, Theoretical Acoustics, 1968, ch. 6.
#[test]
fn a_mesh_is_much_softer_than_a_film_most_of_all_in_the_lows() {
    let heads = ["clear-10", "mesh"].map(|head| {
        let piece = format!("like = \"concert-tom-12\"\nbatter.like = \"{head}\"");
        struck(&piece, stroke(STICK, 3.0, 0.3, 0.0), 1.0)
    });
    let softer = |above| {
        let levels = heads.each_ref().map(|head| head.level(above, 0.0, 0.25));
        println!("level above {above} Hz, dB: {levels:.1?}");
        levels[0] - levels[1]
    };
    let [all, highs] = [20.0, 2000.0].map(softer);
    assert!((20.0..60.0).contains(&all) && (10.0..40.0).contains(&highs), "{all} {highs}");
    assert!(highs < all - 5.0, "{all} {highs}");
}

/// A pillow takes ring and boom and leaves a punch: drumbeatsonline.com/blog/bass-drum-dampening-how-to-control-your-kick-drum-sound;
/// musicalinstrumentworld.com/archives/16175.
#[test]
fn a_muffled_kick_is_shorter_and_more_attack() {
    let kicks = [0.0, 0.5, 1.0].map(|muffle| {
        let piece = format!("like = \"kick-22x18\"\ndefaults.muffle = {muffle}");
        struck(&piece, stroke(Striker::FeltBeater, 4.0, 0.15, 0.0), 2.0)
    });
    falls("length, s", &kicks.each_ref().map(Recorded::length), 0.15);
    let attack = kicks.each_ref().map(Recorded::ping);
    println!("the first 30 ms over the rest, dB: {attack:.1?}");
    assert!(attack.windows(2).all(|pair| pair[1] > pair[0] + 2.0), "{attack:?}");
}

/// A smaller size has a higher pitch: vintagedrum.com, Some points about sounds. Of plates of one thickness frequencies go as one over
/// the diameter squared, less where the bow stiffens them: N. H. Fletcher, T. D. Rossing, 1998, ch. 3 and 20.
#[test]
fn of_cymbals_of_one_thickness_the_larger_are_lower() {
    let cymbals = [16.0, 18.0, 20.0, 22.0].map(|inches: f64| {
        let mass = 1.4 * (inches / 18.0).powi(2);
        let piece = format!("like = \"crash-18-medium\"\ndiameter_in = {inches}\nmass_kg = {mass}");
        // Hammering makes every place another: a mean over some.
        [0.0, 1.6, 3.1, 4.7].map(|angle| struck(&piece, stroke(Striker::TimpaniMallet, 3.0, 0.9, angle), 2.0))
    });
    let mean = |of: fn(&Recorded) -> f64| cymbals.each_ref().map(|all| all.iter().map(of).sum::<f64>() / 4.0);
    falls("the strongest line, Hz", &mean(|cymbal| cymbal.line(200.0, 1000.0)), 0.02);
    falls("mean frequency, Hz", &mean(Recorded::brightness), 0.0);
}

fn ride(change: &str, strike: Strike) -> Recorded {
    struck(&format!("like = \"ride-20\"\n{change}"), strike, 4.0)
}

/// Of cymbals of one diameter heavier ones are higher and last longer: bloodyrich.net/cymbal.html; samash.com, Cymbal buyer's
/// guide. Thicker rides have more ping and less wash: thomann.de, Online guide on cymbals.
#[test]
fn a_heavier_ride_is_higher_drier_and_lasts_longer() {
    let masses = [1.85, 2.5, 3.05];
    let bowed =
        masses.map(|kg| ride(&format!("mass_kg = {kg}"), stroke(Striker::TimpaniMallet, 1.0, 0.95, 0.0)));
    rises("the lowest mode, Hz", &bowed.each_ref().map(|ride| ride.line(20.0, 90.0)), 0.1);
    let tipped = masses.map(|kg| ride(&format!("mass_kg = {kg}"), stroke(STICK, 2.0, 0.5, 0.0)));
    let ping = tipped.each_ref().map(Recorded::ping);
    println!("ping over wash, dB: {ping:.1?}");
    assert!(ping[2] > ping[0] + 1.0, "{ping:?}");
    rises("decay at 500 Hz, s", &tipped.each_ref().map(|ride| ride.decay(500.0)), 0.1);
}

/// Rivets make the wash louder and more penetrating, and take sustain: where too little energy is left to lift them, the sound ends sharply.
/// en.wikipedia.org/wiki/Sizzle_cymbal.
#[test]
fn rivets_make_a_ride_sizzle_until_too_little_is_left_to_lift_them() {
    let rivets = "rivets = { number = 6, radius = 0.9, toward_rad = 0, mass_g = 1.5, play_mm = 2.5 }";
    let rides = ["", rivets].map(|change| ride(change, stroke(STICK, 8.0, 0.7, 0.3)));
    rises("what rings, mean frequency, Hz", &rides.each_ref().map(Recorded::ring), 0.1);
    let wash = rides.each_ref().map(|ride| ride.level(6000.0, 0.7, 1.7));
    let tail = rides.each_ref().map(|ride| ride.level(6000.0, 3.0, 4.0));
    println!("above 6 kHz, dB: {wash:.1?} from .7 s, {tail:.1?} from 3 s");
    let fallen = [0, 1].map(|of| wash[of] - tail[of]);
    assert!(wash[1] > wash[0] + 6.0 && fallen[1] > fallen[0] + 6.0);
}

/// The higher the profile, the higher the pitch: bloodyrich.net/cymbal.html. N. H. Fletcher, T. D. Rossing, 1998, ch. 20.
#[test]
fn a_cymbal_of_a_higher_profile_is_higher() {
    let rides = [12, 18, 26]
        .map(|bow| ride(&format!("bow_mm = {bow}"), stroke(Striker::TimpaniMallet, 1.0, 0.9, 0.0)));
    rises("mean frequency, Hz", &rides.each_ref().map(Recorded::brightness), 0.05);
}

/// Brass conducts heat more than twice as well as bronze and has a loss factor of 2e-4 to 1e-3: L. Cremer, M. Heckl,
/// B. Petersson, Structure-Borne Sound, 2005. Those who sell it: dark and warm, phoenixtonetailors.com/?p=625; neutral,
/// notsomoderndrummer.com, Know your metal, 2022.
#[test]
fn brass_is_shorter_and_darker_than_bronze() {
    let crashes = ["b20", "brass"].map(|alloy| {
        let piece = format!("like = \"crash-16\"\nalloy.like = \"{alloy}\"");
        struck(&piece, stroke(Striker::Shoulder, 4.0, 0.9, 0.0), 4.0)
    });
    for octave in [1000.0, 4000.0, 8000.0] {
        falls(&format!("decay at {octave} Hz, s"), &crashes.each_ref().map(|crash| crash.decay(octave)), 0.4);
    }
    falls("mean frequency, Hz", &crashes.each_ref().map(Recorded::brightness), 0.1);
    falls("what rings, mean frequency, Hz", &crashes.each_ref().map(Recorded::ring), 0.1);
}

/// Heavy hats are loud and bright, light ones dark and soft: samash.com, Cymbal buyer's guide, of thin and thick cymbals.
#[test]
fn heavier_hats_are_brighter() {
    let hats = [(0.82, 1.0), (1.15, 1.48)].map(|(top, bottom)| {
        let piece = format!("like = \"hats-14\"\ntop.mass_kg = {top}\nbottom.mass_kg = {bottom}");
        struck(&piece, stroke(Striker::Shoulder, 3.0, 0.9, 0.0), 2.0)
    });
    rises("mean frequency, Hz", &hats.each_ref().map(Recorded::brightness), 0.1);
}

/// The air in a kettle stiffens a timpani's round modes and hardly moves those with nodal diameters: R. S. Christian, R. E. Davis,
/// A. Tubis, C. A. Anderson, R. I. Mills, T. D. Rossing, Effects of air loading on timpani membrane vibrations, J. Acoust. Soc.
/// Am. 76, 1984.
#[test]
fn a_smaller_kettle_raises_the_round_modes_of_a_timpani() {
    let timpani = [140.0, 70.0].map(|litres| {
        let piece = format!("like = \"timpani-26\"\nshell.volume_l = {litres}");
        [0.0, 0.75].map(|at| struck(&piece, stroke(Striker::TimpaniMallet, 2.0, at, 0.0), 2.0))
    });
    rises("the loudest round mode, Hz", &timpani.each_ref().map(|kettle| kettle[0].line(60.0, 400.0)), 0.05);
    let principal = timpani.each_ref().map(|kettle| kettle[1].line(90.0, 180.0));
    println!("the principal, Hz: {principal:.1?}");
    assert!((principal[1] / principal[0] - 1.0).abs() < 0.01, "{principal:?}");
}

/// A drum's useful pitches end where its film would yield: the larger, the lower. What cannot be is refused at its field, with the
/// highest that can.
#[test]
fn a_large_drum_cannot_be_tuned_as_high_as_a_small_one() {
    let ends = [10, 16, 22].map(|inches| {
        let piece = format!(
            "like = \"tom-12x9\"\ndiameter_in = {inches}\nlowest_pitch_hz = 900\npitch_hz = 1000\nhighest_pitch_hz = 1800"
        );
        let refused = kit_file::read("tested", &file(&piece)).err().map(|refused| refused.to_string()).expect("no film stands that");
        println!("{inches} in: {refused}");
        assert!(refused.starts_with("tested, line ") && refused.contains("highest_pitch_hz"), "{refused}");
        let numbers = refused.split(|c: char| !c.is_ascii_digit() && c != '.');
        numbers.filter_map(|word| word.parse::<f64>().ok()).next_back().expect("the highest that is accepted")
    });
    falls("highest pitch, Hz", &ends, 0.2);
}
