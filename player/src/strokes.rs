//! Strokes played by hand on the editor's picture, on their way to the audio thread.
//!
//! A bounded queue: the editor puts strokes in, and `process` takes them out at the start of its next buffer without waiting.
//! Several editors take turns. While nothing renders, the queue fills up and further strokes are dropped.

use std::sync::{Arc, Mutex, PoisonError};

use overhear_engine::slot::Slot;
use overhear_engine::strike::Strike;
use rtrb::{Consumer, Producer, RingBuffer};

use crate::performer::Performer;

/// Strokes that wait at most: more than a hand plays between two buffers.
const WAITING: usize = 32;

/// A stroke on a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Slot of the piece.
    pub slot: Slot,
    /// How fast, where, with what.
    pub strike: Strike,
}

/// The hands' end; clones are the same end.
#[derive(Clone)]
pub struct Strokes {
    sent: Arc<Mutex<Producer<Stroke>>>,
}

/// The audio thread's end.
pub struct Waiting {
    strokes: Consumer<Stroke>,
}

/// Both ends of a queue.
pub fn strokes() -> (Strokes, Waiting) {
    let (sent, strokes) = RingBuffer::new(WAITING);
    (Strokes { sent: Arc::new(Mutex::new(sent)) }, Waiting { strokes })
}

impl Strokes {
    /// Sends a stroke, unless too many wait already.
    pub fn play(&self, stroke: Stroke) {
        let mut sent = self.sent.lock().unwrap_or_else(PoisonError::into_inner);
        // Lost strokes are no loss: see above.
        let _ = sent.push(stroke);
    }
}

impl Waiting {
    /// Lets the performer play everything that waits, at the next sample.
    ///
    /// # Real-time
    /// No allocation, no lock; at most as many strokes as can wait.
    pub fn deliver(&mut self, performer: &mut Performer) {
        // A hand that goes on playing does not hold it up.
        for _ in 0..WAITING {
            let Ok(Stroke { slot, strike }) = self.strokes.pop() else { return };
            performer.strike(slot, &strike);
        }
    }

    /// Forgets what waits, as after a time in which nothing was rendered.
    ///
    /// # Real-time
    /// As [`deliver`](Self::deliver).
    pub fn clear(&mut self) {
        for _ in 0..WAITING {
            if self.strokes.pop().is_err() {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kit_document::{KitDocument, standard_slot};
    use overhear_engine::piece::{BuildOptions, Piece, Quality};
    use overhear_engine::snapshot::KitSnapshot;
    use overhear_engine::strike::Striker;

    const RATE: f64 = 48_000.0;

    fn stroke(piece: &str, speed: f64, radius: f64, angle: f64) -> Stroke {
        Stroke {
            slot: standard_slot(piece),
            strike: Strike { speed, radius, angle, striker: Striker::Stick },
        }
    }

    fn performer(pieces: &[&str]) -> Performer {
        let document = KitDocument::standard();
        let mut performer = Performer::new(RATE, &document, Arc::default());
        for piece in pieces {
            let options = BuildOptions { quality: Quality::Eco, ..BuildOptions::new(RATE) };
            let slot = standard_slot(piece);
            let build = document.kit.build(slot).unwrap();
            performer.install(Box::new(Piece::new(slot, &build, &options).unwrap()));
        }
        performer
    }

    fn heard(performer: &mut Performer) -> Vec<f32> {
        let (mut left, mut right) = (vec![0.0; 9600], vec![0.0; 9600]);
        performer.render(&mut left, &mut right);
        left
    }

    #[test]
    fn a_stroke_of_a_hand_strikes_that_piece_there_and_is_heard() {
        let mut performer = performer(&["rack-tom", "splash"]);
        let (strokes, mut waiting) = super::strokes();
        let silence = heard(&mut performer);
        assert!(silence.iter().all(|&sample| sample == 0.0));
        strokes.play(stroke("rack-tom", 3.0, 0.4, -1.1));
        waiting.deliver(&mut performer);
        let sound = heard(&mut performer);
        assert!(sound.iter().any(|sample| sample.abs() > 0.01), "nothing is heard");
        let mut snapshot = KitSnapshot::default();
        performer.snapshot(&mut snapshot);
        let [tom, splash] =
            ["rack-tom", "splash"].map(|piece| snapshot.pieces[standard_slot(piece).index()].strike);
        assert_eq!((tom.count, tom.speed, tom.radius, tom.angle), (1, 3.0, 0.4, -1.1));
        assert_eq!(splash.count, 0);
    }

    #[test]
    fn elsewhere_sounds_different() {
        let sound = |radius: f64| {
            let mut performer = performer(&["rack-tom"]);
            let (strokes, mut waiting) = super::strokes();
            strokes.play(stroke("rack-tom", 3.0, radius, 0.0));
            waiting.deliver(&mut performer);
            heard(&mut performer)
        };
        let [middle, rim] = [0.0, 0.8].map(sound);
        let difference: f32 = middle.iter().zip(&rim).map(|(a, b)| (a - b).powi(2)).sum();
        let energy: f32 = middle.iter().map(|a| a * a).sum();
        assert!(difference > 0.1 * energy, "{difference} of {energy}");
    }

    #[test]
    fn a_full_queue_loses_strokes_and_nothing_else() {
        let mut performer = performer(&["splash"]);
        let (strokes, mut waiting) = super::strokes();
        for _ in 0..1_000 {
            strokes.play(stroke("splash", 1.0, 0.5, 0.0));
        }
        waiting.deliver(&mut performer);
        let mut snapshot = KitSnapshot::default();
        performer.snapshot(&mut snapshot);
        assert_eq!(snapshot.pieces[standard_slot("splash").index()].strike.count, WAITING as u32);
    }

    #[test]
    fn what_is_forgotten_strikes_nothing() {
        let mut performer = performer(&["splash"]);
        let (strokes, mut waiting) = super::strokes();
        strokes.play(stroke("splash", 1.0, 0.5, 0.0));
        waiting.clear();
        waiting.deliver(&mut performer);
        assert!(heard(&mut performer).iter().all(|&sample| sample == 0.0));
        strokes.play(stroke("splash", 1.0, 0.5, 0.0));
        waiting.deliver(&mut performer);
        assert!(heard(&mut performer).iter().any(|sample| sample.abs() > 1e-3));
    }
}
