//! What is rendered while the clock runs.

use std::f64::consts::TAU;

use anyhow::{Context, Result};
use overhear::kit_document::KitDocument;
use overhear_engine::kit::{BLOCK, Control, Kit};
use overhear_engine::kit_spec::{Kind, KitSpec};
use overhear_engine::piece::{BuildOptions, Piece, Quality};
use overhear_engine::slot::Slot;
use overhear_engine::strike::Strike;
use overhear_measure::hear::{self, ALONE};

/// Speed of the strokes on single pieces and on all at once, m/s.
const HARD: f64 = 6.0;

/// Where drums and cymbals are struck then, shares of the radius.
const ON_DRUMS: f64 = 0.35;
const ON_CYMBALS: f64 = 0.9;

/// A scene, cymbals of a tier.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scene {
    /// Of the standard kit, four seconds: a ride every quarter of a second, a kick on every fourth of those, a snare on the
    /// third of each four, a crash on the first.
    Groove(Quality),
    /// Every piece struck at once, of the standard kit all but the timpani, and four seconds of what follows.
    AllAtOnce(Quality),
    /// The same while every tuning and muffling is automated: a new value for each in every block.
    Gliding(Quality),
    /// Every cymbal struck at once, and again after two seconds; three seconds.
    Ringing(Quality),
    /// The same while a hand holds them, see [`held`]: a new pressure in every block.
    Choked(Quality),
    /// A kit at rest, for a second.
    Idle,
    /// One piece, and the second after a hard stroke.
    Piece(Slot, Quality),
}

/// When cymbals are struck again, s.
const AGAIN: f64 = 2.0;

/// How firmly a hand holds the cymbals at a time (s), 0 to 1: lightly and never still, so that they ring on; then firmly; then
/// not at all, which ends before the second stroke.
fn held(time: f64) -> f64 {
    match time {
        0.1..1.0 => 0.05 * (1.0 - (4.0 * TAU * time).cos()),
        1.0..1.3 => 1.0,
        _ => 0.0,
    }
}

/// A stroke at a sample.
struct Beat {
    at: usize,
    slot: Slot,
    strike: Strike,
}

impl Scene {
    /// The scenes of a kit as a whole: the groove only of the standard kit, which it was written for.
    pub fn of_kit(document: &KitDocument, quality: Quality) -> Vec<Scene> {
        let groove = (*document == KitDocument::standard()).then_some(Scene::Groove(quality));
        let cymbals = cymbals(document).next().map(|_| [Scene::Ringing(quality), Scene::Choked(quality)]);
        let every = [Scene::AllAtOnce(quality), Scene::Gliding(quality), Scene::Idle];
        groove.into_iter().chain(every).chain(cymbals.into_iter().flatten()).collect()
    }

    /// How long it lasts, s.
    pub fn seconds(self) -> f64 {
        match self {
            Scene::Groove(_) | Scene::AllAtOnce(_) | Scene::Gliding(_) => 4.0,
            Scene::Ringing(_) | Scene::Choked(_) => 3.0,
            Scene::Idle | Scene::Piece(..) => 1.0,
        }
    }

    /// Whether the whole kit plays.
    pub fn is_kit(self) -> bool {
        matches!(self, Scene::Groove(_) | Scene::AllAtOnce(_))
    }

    /// Its name, if controls move in it.
    pub fn moved_controls(self) -> Option<&'static str> {
        match self {
            Scene::Gliding(_) => Some("gliding"),
            Scene::Choked(_) => Some("choked"),
            _ => None,
        }
    }

    /// Name of the scene or of its piece.
    pub fn name(self, kit: &KitSpec) -> String {
        match self {
            Scene::Groove(_) => "groove".to_owned(),
            Scene::AllAtOnce(_) => "all-at-once".to_owned(),
            Scene::Gliding(_) => "gliding".to_owned(),
            Scene::Ringing(_) => "cymbals ringing".to_owned(),
            Scene::Choked(_) => "cymbals choked".to_owned(),
            Scene::Idle => "idle".to_owned(),
            Scene::Piece(slot, _) => kit.piece(slot).map(|piece| piece.name.clone()).unwrap_or_default(),
        }
    }

    /// The strokes on a kit.
    fn beats(self, document: &KitDocument, rate: f64) -> Result<Vec<Beat>> {
        let kit = &document.kit;
        let beat = |slot, strike| Beat { at: 0, slot, strike };
        Ok(match self {
            Scene::Groove(_) => return groove(document, rate),
            Scene::AllAtOnce(_) | Scene::Gliding(_) => {
                // A groove has no use for a timpani; in a kit of one's own every piece is there to be played.
                let spared = kit.find("timpani").filter(|_| *document == KitDocument::standard());
                let struck = kit.slots().map(|(slot, _)| slot);
                let struck = struck.filter(|&slot| spared.is_none_or(|(spared, _)| slot != spared));
                struck.map(|slot| beat(slot, hard(document, slot))).collect()
            }
            Scene::Ringing(_) | Scene::Choked(_) => {
                let again = (AGAIN * rate) as usize;
                let strokes =
                    |at| cymbals(document).map(move |slot| Beat { at, ..beat(slot, hard(document, slot)) });
                strokes(0).chain(strokes(again)).collect()
            }
            Scene::Idle => Vec::new(),
            // The piece is alone in its kit.
            Scene::Piece(slot, _) => vec![beat(ALONE, hard(document, slot))],
        })
    }
}

/// The slots of cymbals and hi-hats.
fn cymbals(document: &KitDocument) -> impl Iterator<Item = Slot> {
    document.kit.slots().filter(|(_, piece)| piece.instrument.kind() != Kind::Drum).map(|(slot, _)| slot)
}

fn hard(document: &KitDocument, slot: Slot) -> Strike {
    let is_drum = document.kit.piece(slot).is_some_and(|piece| piece.instrument.kind() == Kind::Drum);
    let radius = if is_drum { ON_DRUMS } else { ON_CYMBALS };
    Strike { speed: HARD, radius, ..hear::default_strike(document, slot) }
}

fn groove(document: &KitDocument, rate: f64) -> Result<Vec<Beat>> {
    let beat = |at, name: &str, speed, radius| -> Result<Beat> {
        let (slot, _) = document.kit.find(name).with_context(|| format!("no {name} in the kit"))?;
        Ok(Beat { at, slot, strike: Strike { speed, radius, ..hear::default_strike(document, slot) } })
    };
    let mut beats = Vec::new();
    for step in 0..16 {
        let at = (0.25 * f64::from(step) * rate) as usize;
        beats.push(beat(at, "ride", 2.5, 0.6)?);
        match step % 4 {
            0 => beats.push(beat(at, "kick", 3.0, 0.2)?),
            2 => beats.push(beat(at, "snare", 4.0, 0.3)?),
            _ => {}
        }
        if step == 0 {
            beats.push(beat(at, "crash", 5.0, 0.92)?);
        }
    }
    Ok(beats)
}

/// A kit and the strokes on it, as far as they have been played.
pub struct Workload {
    scene: Scene,
    rate: f64,
    kit: Kit,
    beats: Vec<Beat>,
    played: usize,
    now: usize,
    left: [f32; BLOCK],
    right: [f32; BLOCK],
}

impl Workload {
    /// Builds what plays of a kit at a rate in Hz. A single piece plays in a kit of its own.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) if a piece cannot be built.
    pub fn new(scene: Scene, document: &KitDocument, rate: f64) -> Result<Workload> {
        let (spec, quality) = match scene {
            Scene::Groove(quality)
            | Scene::AllAtOnce(quality)
            | Scene::Gliding(quality)
            | Scene::Ringing(quality)
            | Scene::Choked(quality) => (document.kit.clone(), quality),
            Scene::Idle => (document.kit.clone(), Quality::Standard),
            Scene::Piece(slot, quality) => (document.kit.alone(slot).context("an empty slot")?, quality),
        };
        let kit = hear::stand(&spec, &BuildOptions { quality, ..BuildOptions::new(rate) }, &[])?;
        let beats = scene.beats(document, rate)?;
        let (left, right) = ([0.0; BLOCK], [0.0; BLOCK]);
        Ok(Workload { scene, rate, kit, beats, played: 0, now: 0, left, right })
    }

    /// What it is.
    pub fn scene(&self) -> Scene {
        self.scene
    }

    /// Blocks of the whole scene.
    pub fn blocks(&self) -> usize {
        (self.scene.seconds() * self.rate) as usize / BLOCK
    }

    /// Back to the beginning.
    pub fn rewind(&mut self) {
        self.kit.reset();
        self.played = 0;
        self.now = 0;
    }

    /// Moves every tuning, by a semitone to and fro, and every muffling, as curves of a host would.
    fn automate(&mut self) {
        let turn = (TAU * self.now as f64 / self.rate).sin();
        for slot in Slot::ALL {
            let Some([_, own, _]) = self.kit.piece(slot).map(Piece::tunings) else { continue };
            self.kit.set(Control::Tuning(slot), own * (turn / 12.0).exp2());
            self.kit.set(Control::Muffling(slot), 0.5 + 0.5 * turn);
        }
    }

    /// Holds every cymbal; see [`held`].
    fn hold(&mut self) {
        let strength = held(self.now as f64 / self.rate);
        Slot::ALL.into_iter().for_each(|slot| self.kit.choke(slot, strength));
    }

    /// Renders one block of [`BLOCK`] samples, cut where strokes fall.
    #[inline(never)] // Instructions are counted by its name.
    pub fn block(&mut self) {
        let (start, end) = (self.now, self.now + BLOCK);
        match self.scene {
            Scene::Gliding(_) => self.automate(),
            Scene::Choked(_) => self.hold(),
            _ => {}
        }
        while self.now < end {
            while let Some(beat) = self.beats.get(self.played).filter(|beat| beat.at <= self.now) {
                self.kit.strike(beat.slot, &beat.strike);
                self.played += 1;
            }
            let next = self.beats.get(self.played).map_or(end, |beat| beat.at.min(end));
            let run = self.now - start..next - start;
            self.kit.render(&mut self.left[run.clone()], &mut self.right[run]);
            self.now = next;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_groove_is_of_the_standard_kit_and_every_other_is_struck_as_a_whole() {
        let standard = KitDocument::standard();
        let quality = Quality::Standard;
        assert_eq!(Scene::of_kit(&standard, quality).len(), 6);
        let struck =
            |document: &KitDocument| Scene::AllAtOnce(quality).beats(document, 44_100.0).unwrap().len();
        assert_eq!(struck(&standard), standard.kit.pieces.len() - 1);
        assert_eq!(Scene::Groove(quality).beats(&standard, 44_100.0).unwrap().len(), 16 + 4 + 4 + 1);
        let mut other = standard;
        other.kit.pieces.retain(|piece| piece.name != "ride");
        assert_eq!(
            Scene::of_kit(&other, quality),
            [
                Scene::AllAtOnce(quality),
                Scene::Gliding(quality),
                Scene::Idle,
                Scene::Ringing(quality),
                Scene::Choked(quality)
            ]
        );
        assert_eq!(struck(&other), other.kit.pieces.len());
    }
}
