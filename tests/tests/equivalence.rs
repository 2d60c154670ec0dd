//! The same strikes and controls give the same samples, bit for bit, for any buffer sizes; a body at rest stays at rest.

use no_denormals::no_denormals;
use overhear_engine::kit::{Control, Kit};
use overhear_engine::piece::Piece;
use overhear_engine::slot::Slot;
use overhear_engine::strike::{Strike, Striker};
use overhear_tests::{
    Chance, RATES, kit, member, names, piece, render, render_into, slot, spec, standard, stroke, total_energy,
};

#[derive(Debug, Clone, Copy)]
enum Action {
    Strike(Slot, Strike),
    Set(Control, f64),
    /// A newly built snare takes the place of the one that plays.
    Replace,
}

/// What happens at which sample, in order.
type Score = Vec<(usize, Action)>;

const LENGTH: usize = 12_011;

/// Strikes and controls on every piece at odd samples, many of them close together.
fn score(seed: u64) -> Score {
    let mut chance = Chance::new(seed);
    let tunings: Vec<_> =
        standard().slots().map(|(slot, piece)| (slot, piece.instrument.tunings())).collect();
    let [snare, hi_hat] = ["snare", "hi-hat"].map(slot);
    let mut score: Score = (0..90)
        .map(|_| {
            let (slot, [low, _, high]) = chance.of(&tunings);
            let action = match chance.below(9) {
                0 => Action::Set(Control::Tuning(slot), chance.between(low, high)),
                1 => Action::Set(Control::Muffling(slot), chance.unit()),
                2 => Action::Set(Control::Level(slot), chance.between(-70.0, 6.0)),
                3 => Action::Set(Control::Master, chance.between(-20.0, 6.0)),
                4 => Action::Set(Control::Preload(snare), chance.between(0.03, 1.5)),
                5 => Action::Set(Control::Wires(snare), chance.unit().round()),
                6 => Action::Set(Control::Pedal(hi_hat), chance.unit()),
                _ => Action::Strike(slot, chance.stroke(8.0)),
            };
            (chance.below(LENGTH / 2) * 2 + 1, action)
        })
        .collect();
    score.push((5_001, Action::Replace));
    score.sort_by_key(|&(at, _)| at);
    score
}

fn act(kit: &mut Kit, action: Action, spare: &mut Option<Box<Piece>>) {
    match action {
        Action::Strike(slot, strike) => kit.strike(slot, &strike),
        Action::Set(control, value) => kit.set(control, value),
        Action::Replace => *spare = spare.take().and_then(|spare| kit.install(spare)),
    }
}

/// Plays a score in buffers of the lengths that `buffer` gives; both outputs.
fn play(
    kit: &mut Kit,
    spare: &mut Option<Box<Piece>>,
    score: &Score,
    mut buffer: impl FnMut() -> usize,
) -> Vec<[u32; 2]> {
    let (mut left, mut right) = (vec![f32::NAN; LENGTH], vec![f32::NAN; LENGTH]);
    let (mut done, mut buffer_end) = (0, 0);
    let mut events = score.iter().peekable();
    while done < LENGTH {
        if done == buffer_end {
            buffer_end = (done + buffer()).min(LENGTH);
        }
        while let Some((_, action)) = events.next_if(|&&(at, _)| at == done) {
            act(kit, *action, spare);
        }
        let end = events.peek().map_or(buffer_end, |&&(at, _)| at.min(buffer_end));
        kit.render(&mut left[done..end], &mut right[done..end]);
        done = end;
    }
    left.iter().zip(&right).map(|(left, right)| [left.to_bits(), right.to_bits()]).collect()
}

/// Puts the controls where they are in a new kit, and all to rest.
fn start_over(kit: &mut Kit, spare: &mut Option<Box<Piece>>) {
    kit.set(Control::Master, 0.0);
    for (slot, piece) in standard().slots() {
        let [_, own, _] = piece.instrument.tunings();
        kit.set(Control::Tuning(slot), own);
        kit.set(Control::Muffling(slot), piece.defaults.muffle);
        kit.set(Control::Level(slot), piece.defaults.level_db);
        kit.set(Control::Wires(slot), 1.0);
        kit.set(Control::Pedal(slot), 0.0);
        piece.defaults.preload.into_iter().for_each(|newtons| kit.set(Control::Preload(slot), newtons));
    }
    kit.reset();
    if let Some(replaced) = kit.retire() {
        *spare = Some(replaced);
    }
    spare.iter_mut().for_each(|spare| spare.reset());
}

fn spare_snare(rate: f64) -> Box<Piece> {
    Box::new(member(&standard(), slot("snare"), rate))
}

fn buffers_do_not_matter(rate: f64) {
    let mut kit = kit(rate);
    let mut spare = Some(spare_snare(rate));
    let score = score(rate as u64);
    let whole = play(&mut kit, &mut spare, &score, || LENGTH);
    assert!(whole.iter().filter(|&&[left, _]| f32::from_bits(left).abs() > 1e-3).count() > LENGTH / 2);
    for length in [1, 17, 64, 512, 8192] {
        start_over(&mut kit, &mut spare);
        assert!(whole == play(&mut kit, &mut spare, &score, || length), "buffers of {length} at {rate} Hz");
    }
    for seed in 0..3 {
        start_over(&mut kit, &mut spare);
        let mut chance = Chance::new(seed);
        let random = || 1 + chance.below(1 << (1 + seed * 4));
        assert!(whole == play(&mut kit, &mut spare, &score, random), "random buffers at {rate} Hz");
    }
}

#[test]
fn the_hosts_buffer_changes_no_sample_at_44_1_khz() {
    buffers_do_not_matter(RATES[0]);
}

#[test]
fn the_hosts_buffer_changes_no_sample_at_48_khz() {
    buffers_do_not_matter(RATES[1]);
}

#[test]
fn the_hosts_buffer_changes_no_sample_at_96_khz() {
    buffers_do_not_matter(RATES[2]);
}

#[test]
fn a_kit_reset_plays_as_a_new_one() {
    let score = score(7);
    let spare = || Some(spare_snare(RATES[0]));
    let mut random = Chance::new(3);
    let new = play(&mut kit(RATES[0]), &mut spare(), &score, || 512);
    // Left in the middle of a block, with controls on their way and strikers about.
    let mut used = kit(RATES[0]);
    play(&mut used, &mut spare(), &self::score(8), || 1 + random.below(99));
    for (slot, _) in standard().slots() {
        used.set(Control::Tuning(slot), 1.0);
        used.strike(slot, &stroke(Striker::Nylon, 5.0, 0.3, 0.0));
    }
    used.render(&mut [0.0; 7], &mut [0.0; 7]);
    start_over(&mut used, &mut None);
    assert!(new == play(&mut used, &mut spare(), &score, || 512));
}

/// A roll of any strokes.
fn roll(piece: &mut Piece, seed: u64) -> Vec<f32> {
    let mut chance = Chance::new(seed);
    let stroke = |_| {
        piece.strike(&chance.stroke(6.0));
        render(piece, 0.003, RATES[0])
    };
    (0..12).flat_map(stroke).collect()
}

#[test]
fn a_piece_reset_plays_as_a_new_one() {
    for name in names() {
        let mut used = piece(&name, RATES[0]);
        let muffle = spec(&name).defaults.muffle;
        // Among these are cross-sticks, whose tip is pushed into the head before it flies into it.
        for seed in [5, 6, 10, 34] {
            // Reset while it rings, is muffled, and two of three strikers still touch or may again.
            used.strike(&stroke(Striker::Stick, 9.0, 0.8, 0.0));
            used.set_muffling(0.7);
            render_into(&mut used, &mut [0.0; 1003]);
            used.strike(&stroke(Striker::YarnMallet, 1.0, 0.3, 0.0));
            used.strike(&stroke(Striker::FeltBeater, 1.0, 0.5, 1.0));
            render_into(&mut used, &mut [0.0; 5]);
            used.set_muffling(muffle);
            used.reset();
            assert_eq!(total_energy(&used), 0.0);
            let mut new = piece(&name, RATES[0]);
            assert!(roll(&mut new, seed) == roll(&mut used, seed), "{name}, seed {seed}");
        }
    }
}

/// The forces between clamped rims are found by iteration, which must not begin where the last one has ended.
#[test]
fn a_hi_hat_reset_plays_as_a_new_one_wherever_the_pedal_is() {
    let place = |hat: &mut Piece, pedal| {
        hat.press_pedal(pedal, 1.0);
        hat.reset();
    };
    let mut used = piece("hi-hat", RATES[0]);
    for (seed, pedal) in [0.6, 1.0, 0.6, 0.45, 1.0, 0.0].into_iter().enumerate() {
        place(&mut used, pedal);
        let mut new = piece("hi-hat", RATES[0]);
        place(&mut new, pedal);
        let seed = seed as u64;
        assert!(roll(&mut new, seed) == roll(&mut used, seed), "pedal {pedal} after others");
    }
}

/// The kit struck and left to fade, in blocks; bits of all samples.
fn fading(seconds: f64) -> Vec<[u32; 2]> {
    const RATE: f64 = 22_050.0;
    let mut kit = kit(RATE);
    for (slot, _) in standard().slots() {
        kit.strike(slot, &stroke(Striker::Stick, 0.6, 0.4, 1.0));
    }
    let mut sound = [vec![0.0; (seconds * RATE) as usize], vec![0.0; (seconds * RATE) as usize]];
    let [left, right] = &mut sound;
    kit.render(left, right);
    left.iter().zip(right.iter()).map(|(left, right)| [left.to_bits(), right.to_bits()]).collect()
}

/// Hosts call with either mode of the processor. The plugin sets one, whose engine must not depend on it.
#[test]
#[allow(unsafe_code)]
fn flushing_denormals_to_zero_changes_no_bit() {
    let kept = fading(20.0);
    // SAFETY: the mode changes for the engine only, which relies on neither.
    let flushed = unsafe { no_denormals(|| fading(20.0)) };
    let parts = kept.iter().zip(&flushed).position(|(kept, flushed)| kept != flushed);
    assert_eq!(parts, None, "parts at {parts:?} of {}", kept.len());
}

#[test]
fn a_piece_left_alone_comes_to_rest_exactly_and_by_no_denormals() {
    const RATE: f64 = 22_050.0;
    // The larger cymbals take a minute and are no different.
    let kit = standard();
    let small = kit.pieces.iter().filter(|piece| piece.drum().is_some() || piece.name == "splash");
    for name in small.map(|piece| &piece.name) {
        let mut piece = piece(name, RATE);
        piece.strike(&stroke(Striker::Stick, 0.5, 0.4, 1.0));
        let mut seconds = 0;
        while !piece.surface_mut().is_still() {
            let sound = render(&mut piece, 1.0, RATE);
            let body = piece.surface_mut().body();
            for k in 0..body.len() {
                assert!(!body.displacement(k).is_subnormal(), "{name}, mode {k} after {seconds} s");
            }
            // What is heard is a sum over the modes; zero, once there is nothing.
            assert!(sound.iter().all(|x| !x.is_subnormal()));
            seconds += 1;
            assert!(seconds < 120, "{name} still moves");
        }
        assert_eq!(piece.energy(), 0.0);
        assert!(render(&mut piece, 0.1, RATE).iter().all(|&x| x == 0.0));
        println!("{name}: still after {seconds} s");
    }
}
