//! The score: bars as lines of sixteenths, and the hand that plays them.
//!
//! A line holds a character per sixteenth: `.` rests, `g` is a ghost note, `-` a soft one, `o` an
//! ordinary, `x` a firm and `X` an accented one; `f` is a flam, two strokes 25 ms apart.

use super::stroke::{BAR, SIXTEENTH, Stroke};

const KICK: u8 = 36;
const SNARE: u8 = 38;
const SIDE_STICK: u8 = 37;
const RACK_TOM: u8 = 48;
const FLOOR_TOM: u8 = 43;
const CRASH: u8 = 49;
const RIDE: u8 = 51;
const RIDE_BELL: u8 = 53;
const SPLASH: u8 = 55;
const HAT: u8 = 42;
const OPEN_HAT: u8 = 46;
const PEDAL: u8 = 44;

/// One bar: lines with what they strike.
type Bar = &'static [(u8, &'static str)];

/// Before the first downbeat: a bar that only fills its second half.
const PICKUP: Bar = &[
    (SNARE, "........g.x.ox.."),
    (RACK_TOM, "..............xx"),
    (KICK, "o.......o......."),
    (SIDE_STICK, "o...o..........."),
];

/// Time on the closed hi-hat.
const A: Bar = &[(HAT, "x.-.o.--x.-.o.-."), (SNARE, ".g.gX..g.g.gX.g."), (KICK, "x.....x.x.o.....")];

/// The same with the kick displaced; the hi-hat opens at the end.
const A_ANSWER: Bar = &[
    (HAT, "x.-.o.-.x.--o..."),
    (OPEN_HAT, "..............o."),
    (SNARE, ".g..X.gg.g..X..g"),
    (KICK, "x..o....x.x..o.."),
];

/// Ends four bars: the last beat goes down the toms.
const A_TURN: Bar = &[
    (HAT, "x.-.o.-.x......."),
    (SNARE, ".g.gX..g..xoX..."),
    (RACK_TOM, "............xo.."),
    (FLOOR_TOM, "..............ox"),
    (KICK, "x.....x.x...x..."),
];

/// Ends the A: a whole bar around the drums.
const A_FILL: Bar = &[
    (SNARE, "XoxogoXo........"),
    (RACK_TOM, "........XoxX...."),
    (FLOOR_TOM, "............XoxX"),
    (KICK, "x...x...x...x.x."),
    (SPLASH, "..X............."),
];

/// Time on the bell, busier feet: the left one closes the hi-hat on two and four.
const B: Bar = &[
    (RIDE_BELL, "X.-.x.-.X.-.x.-."),
    (SNARE, "..ggX.g..g.gX.gg"),
    (KICK, "x..x..x..xx...x."),
    (PEDAL, "....o.......o..."),
];

/// The same with bow between the bells and a splash.
const B_ANSWER: Bar = &[
    (RIDE_BELL, "X...x...X...x..."),
    (RIDE, "..-o..-o..-o..-."),
    (SNARE, ".g..X.g.gg..X.g."),
    (SPLASH, "..............X."),
    (KICK, "x.x...x..xx....x"),
    (PEDAL, "....o.......o..."),
];

/// Ends four bars of B: flams and toms in sixes over the beat.
const B_TURN: Bar = &[
    (RIDE_BELL, "X.-.x.-........."),
    (SNARE, "..ggX.gf..o..o.."),
    (RACK_TOM, "........x..x..x."),
    (FLOOR_TOM, ".........x..x..x"),
    (KICK, "x..x..x...x..x.."),
];

/// Ends the B: a roll that grows.
const B_FILL: Bar =
    &[(SNARE, "gggg----ooooxxXX"), (FLOOR_TOM, "............X.X."), (KICK, "x...x...x...x.x.")];

/// Trading: time for half a bar, toms for the other.
const TRADE: Bar = &[
    (HAT, "x.-.o.-........."),
    (SNARE, ".g.gX..g.......f"),
    (RACK_TOM, "........X.xoX.x."),
    (FLOOR_TOM, "..........X..x.X"),
    (KICK, "x.....x.x...x..."),
];

/// Trading back: cymbals answer.
const TRADE_ANSWER: Bar = &[
    (SNARE, "f..xo.X...xoX..."),
    (SPLASH, "....X.......X..."),
    (CRASH, "........X......."),
    (FLOOR_TOM, "..x...........xX"),
    (KICK, "x...x...x...x.x."),
];

/// The last fill, from the top of the kit to the bottom and back.
const LAST_FILL: Bar = &[
    (SNARE, "XoxoXo........gX"),
    (RACK_TOM, "......XoxoX....."),
    (FLOOR_TOM, "...........oxoX."),
    (KICK, "x...x...x...x..x"),
];

/// The end: everything, left to ring.
const END: Bar = &[
    (KICK, "X..............."),
    (CRASH, "X..............."),
    (RIDE_BELL, "..........-....."),
    (FLOOR_TOM, "X..............."),
    (SPLASH, "......o........."),
];

/// The form, bar by bar, and whether the bar opens with a crash in place of its first ride.
const FORM: [(Bar, bool); 21] = [
    (PICKUP, false),
    (A, true),
    (A_ANSWER, false),
    (A, false),
    (A_TURN, false),
    (A, true),
    (A_ANSWER, false),
    (A, false),
    (A_FILL, false),
    (B, true),
    (B_ANSWER, false),
    (B, false),
    (B_TURN, false),
    (B, true),
    (B_ANSWER, false),
    (B, false),
    (B_FILL, false),
    (TRADE, true),
    (TRADE_ANSWER, false),
    (LAST_FILL, true),
    (END, false),
];

/// Notes of the feet and the hands, by tick.
pub struct Score {
    /// The kick and the hi-hat's pedal.
    pub feet: Vec<Stroke>,
    /// Everything else.
    pub hands: Vec<Stroke>,
}

impl Score {
    /// The score as written above, played by the same person every time.
    pub fn written() -> Score {
        let mut player = Person { state: 0x0D15_EA5E };
        let (mut feet, mut hands) = (Vec::new(), Vec::new());
        for (number, (bar, crash)) in FORM.into_iter().enumerate() {
            let start = number as u32 * BAR;
            for &(key, line) in bar {
                for (place, mark) in line.chars().enumerate() {
                    let crashed = crash && place == 0 && matches!(key, RIDE | RIDE_BELL | HAT);
                    let key = if crashed { CRASH } else { key };
                    let mark = if crashed { 'X' } else { mark };
                    let track = if key == KICK || key == PEDAL { &mut feet } else { &mut hands };
                    player.play(track, start + place as u32 * SIXTEENTH, key, mark);
                }
            }
        }
        feet.sort_by_key(|stroke| stroke.tick);
        hands.sort_by_key(|stroke| stroke.tick);
        Score { feet, hands }
    }
}

/// A player whose strokes vary a little.
struct Person {
    state: u32,
}

impl Person {
    /// A small whole number between `-range` and `range`; the middle is likelier than the ends.
    fn wobble(&mut self, range: i32) -> i32 {
        let mut next = || {
            // A linear congruential generator (Numerical Recipes); its high bits are good enough.
            self.state = self.state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (self.state >> 16) as i32 % (range + 1)
        };
        next() - next()
    }

    fn play(&mut self, track: &mut Vec<Stroke>, tick: u32, key: u8, mark: char) {
        let (velocity, late) = match mark {
            'g' => (28, 3),
            '-' => (58, 1),
            'o' => (78, 0),
            'x' => (98, 0),
            'X' | 'f' => (116, 0),
            _ => return,
        };
        // Cymbals under a crash's force are struck more gently than drums of the same mark.
        let softened = match key {
            RIDE => velocity - velocity / 5,
            CRASH => velocity - 8,
            _ => velocity,
        };
        // A tick is about 1.3 ms.
        let shift = late + self.wobble(4);
        let at = tick.saturating_add_signed(shift);
        let loud = (softened + self.wobble(7)).clamp(12, 124) as u8;
        if mark == 'f' {
            // The other hand's grace note, about 25 ms ahead.
            let grace = Stroke { tick: at.saturating_sub(21), key, velocity: loud / 3 };
            track.push(grace);
        }
        track.push(Stroke { tick: at, key, velocity: loud });
    }
}
