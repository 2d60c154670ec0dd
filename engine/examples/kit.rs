//! What the kit costs: seconds to build each piece, and the share of real time that a groove takes with and
//! without the pieces hearing each other, asleep too. In CPU time of the thread, as Linux counts it; it needs `/proc`.

use overhear_engine::kit::{Control, Kit, Microphone};
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::piece::{BuildOptions, Piece};
use overhear_engine::slot::Slot;
use overhear_engine::strike::{Strike, Striker};

const RATE: f64 = 44_100.0;

/// CPU time of this thread so far, s.
fn cpu() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    1e-9 * text.split(' ').next().and_then(|field| field.parse().ok()).unwrap_or(f64::NAN)
}

/// Renders so many seconds with a stroke every eighth of one, on the pieces of a pattern in turn; share of real time.
fn play(kit: &mut Kit, pattern: &[Slot], seconds: usize) -> f64 {
    let (mut left, mut right) = (vec![0.0; 64], vec![0.0; 64]);
    let start = cpu();
    for buffer in 0..seconds * RATE as usize / 64 {
        if buffer.is_multiple_of(86)
            && let Some(&slot) = pattern.iter().cycle().nth(buffer / 86)
        {
            kit.strike(slot, &Strike { speed: 3.0, radius: 0.35, angle: 0.0, striker: Striker::Stick });
        }
        kit.render(&mut left, &mut right);
    }
    (cpu() - start) / seconds as f64
}

fn main() {
    let spec = KitSpec::standard();
    let mut kit = Kit::new(RATE, &spec);
    for (slot, piece) in spec.slots() {
        let start = cpu();
        let build = spec.build(slot).expect("a piece in its slot");
        let built = Piece::new(slot, &build, &BuildOptions::new(RATE)).expect("a piece");
        println!("{}: built in {:.3} s", piece.name, (cpu() - start));
        drop(kit.install(Box::new(built)));
    }
    let pattern = ["ride", "kick", "ride", "snare"].map(|name| spec.find(name).expect("a piece").0);
    println!("idle: {:.5} of real time", play(&mut kit, &[], 60));
    for (what, hearing, mics) in [
        ("uncoupled, close microphones alone", 0.0, 1.0),
        ("uncoupled", 0.0, 0.0),
        ("hearing each other", 1.0, 0.0),
    ] {
        kit.set(Control::SympatheticCoupling, hearing);
        kit.set(Control::Mute(Microphone::Overheads), mics);
        kit.set(Control::Mute(Microphone::Room), mics);
        kit.reset();
        println!("groove, {what}: {:.3} of real time", play(&mut kit, &pattern, 8));
    }
    let start = cpu();
    let mut seconds = 0;
    while !kit.is_asleep() && seconds < 90 {
        play(&mut kit, &[], 1);
        seconds += 1;
    }
    println!("asleep {seconds} s after the last stroke ({:.1} s)", (cpu() - start));
}
