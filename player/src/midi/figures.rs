//! Figures of more than one stroke that a note names: flams, and rolls that last as long as the note.

/// What a note strikes with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Figure {
    /// A grace note by one hand, and the stroke by the other.
    Flam,
    /// Two strokes by each hand in turn.
    DoubleStrokes,
    /// Each hand in turn presses its stick on the head, where it bounces.
    Press,
    /// The same, so firmly that no stroke is told from the next.
    Buzz,
}

impl Figure {
    /// Every figure with its name in kit files.
    pub const ALL: [(Figure, &'static str); 4] = [
        (Figure::Flam, "flam"),
        (Figure::DoubleStrokes, "double-strokes"),
        (Figure::Press, "press"),
        (Figure::Buzz, "buzz"),
    ];

    /// The figure of a name.
    pub fn from_name(name: &str) -> Option<Figure> {
        Figure::ALL.into_iter().find(|(_, other)| *other == name).map(|(figure, _)| figure)
    }

    /// Its name in kit files.
    pub fn name(self) -> &'static str {
        Figure::ALL.into_iter().find(|(figure, _)| *figure == self).map_or("", |(_, name)| name)
    }

    /// The stroke of a number, from 0 on; none where the figure is over.
    pub fn stroke(self, number: u32) -> Option<Beat> {
        match self {
            Figure::Flam => match number {
                0 => Some(Beat { speed: GRACE, gap: GRACE_TIME, bounces: false }),
                1 => Some(Beat { speed: 1.0, gap: f64::INFINITY, bounces: false }),
                _ => None,
            },
            Figure::DoubleStrokes => {
                let bounces = number % 2 == 1;
                Some(Beat { speed: if bounces { DOUBLED } else { 1.0 }, gap: DOUBLE_TIME, bounces })
            }
            Figure::Press => Some(pressed(number, PRESS)),
            Figure::Buzz => Some(pressed(number, BUZZ)),
        }
    }
}

/// One stroke of a figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beat {
    /// Its speed over that of the note, a ratio.
    pub speed: f64,
    /// Time to the next stroke, s.
    pub gap: f64,
    /// Whether the hand of the stroke before makes it.
    pub bounces: bool,
}

/// Speed of a grace note over that of its stroke, and how long before it comes, s. *Assumed*.
const GRACE: f64 = 0.25;
const GRACE_TIME: f64 = 0.028;

/// Speed of a hand's second stroke over its first, and time between strokes, s: 17 a second. *Assumed*.
const DOUBLED: f64 = 0.8;
const DOUBLE_TIME: f64 = 0.058;

/// How a stick bounces that is pressed on a head: strokes of a hand, time to the first bounce and from hand to hand, s.
#[derive(Clone, Copy)]
struct Pressed {
    bounces: u32,
    first: f64,
    hand: f64,
}

/// *Assumed*: some five bounces for each hand; a buzz is pressed three times as firmly.
const PRESS: Pressed = Pressed { bounces: 5, first: 0.034, hand: 0.115 };
const BUZZ: Pressed = Pressed { bounces: 6, first: 0.013, hand: 0.062 };

/// Speed after a bounce over that before. *Assumed*, from the restitution of sticks on heads.
const RESTITUTION: f64 = 0.82;

/// The stroke of a number of a roll with pressed sticks. A constant force brings a stick back in a time that is proportional to its
/// speed, so both fall by the restitution at each bounce.
fn pressed(number: u32, Pressed { bounces, first, hand }: Pressed) -> Beat {
    let bounce = number % bounces;
    let speed = libm::pow(RESTITUTION, f64::from(bounce));
    let elapsed = first * (1.0 - libm::pow(RESTITUTION, f64::from(bounce))) / (1.0 - RESTITUTION);
    let gap = if bounce + 1 == bounces { hand - elapsed } else { first * speed };
    Beat { speed, gap, bounces: bounce > 0 }
}

/// A figure that is being played.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Running {
    /// The note, its velocity (0 to 1) and its channel.
    pub note: (u8, f32, u8),
    /// What is played.
    pub figure: Figure,
    /// Number of the next stroke.
    pub number: u32,
    /// Samples until it.
    pub due: usize,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flam_has_two_strokes_and_rolls_never_end() {
        let beats = |figure: Figure| (0..40).map_while(|number| figure.stroke(number)).collect::<Vec<_>>();
        assert_eq!(beats(Figure::Flam).len(), 2);
        for figure in [Figure::DoubleStrokes, Figure::Press, Figure::Buzz] {
            let beats = beats(figure);
            assert_eq!(beats.len(), 40);
            assert!(
                beats.iter().all(|beat| beat.gap > 0.002 && (0.2..=1.0).contains(&beat.speed)),
                "{figure:?}"
            );
        }
    }

    #[test]
    fn a_pressed_stick_bounces_sooner_and_softer_until_the_other_hand_comes() {
        let beats: Vec<Beat> = (0..10).filter_map(|number| Figure::Press.stroke(number)).collect();
        for hand in beats.chunks(5) {
            assert!(
                hand[..4].windows(2).all(|pair| pair[1].gap < pair[0].gap && pair[1].speed < pair[0].speed)
            );
            let whole: f64 = hand.iter().map(|beat| beat.gap).sum();
            assert!((whole - 0.115).abs() < 1e-9, "{whole}");
        }
    }

    #[test]
    fn names_and_figures_agree() {
        for (figure, name) in Figure::ALL {
            assert_eq!((Figure::from_name(name), figure.name()), (Some(figure), name));
        }
        assert_eq!(Figure::from_name("drag"), None);
    }
}
