//! What is rendered while the clock runs.

use anyhow::Result;
use overhear_engine::kit::{BLOCK, Kit};
use overhear_engine::piece::{Piece, PieceId, Quality};
use overhear_engine::strike::Strike;

use super::options;
use crate::{bad_input, hear};

/// Speed of the strokes on single pieces and on all at once, m/s.
const HARD: f64 = 6.0;

/// Where drums and cymbals are struck then, shares of the radius.
const ON_DRUMS: f64 = 0.35;
const ON_CYMBALS: f64 = 0.9;

/// A scene, cymbals of a tier.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scene {
    /// Four seconds: a ride every quarter of a second, a kick on every fourth of those, a snare on the third of
    /// each four, a crash on the first.
    Groove(Quality),
    /// Every piece but the timpani struck at once, and four seconds of what follows.
    AllAtOnce(Quality),
    /// A kit that nobody has struck, for a second.
    Idle,
    /// One piece, and the second after a hard stroke.
    Piece(PieceId, Quality),
}

impl Scene {
    /// How long it lasts, s.
    pub fn seconds(self) -> f64 {
        match self {
            Scene::Groove(_) | Scene::AllAtOnce(_) => 4.0,
            Scene::Idle | Scene::Piece(..) => 1.0,
        }
    }

    /// Whether the whole kit plays.
    pub fn is_kit(self) -> bool {
        matches!(self, Scene::Groove(_) | Scene::AllAtOnce(_))
    }

    /// Name of the scene or of its piece.
    pub fn name(self) -> &'static str {
        match self {
            Scene::Groove(_) => "groove",
            Scene::AllAtOnce(_) => "all-at-once",
            Scene::Idle => "idle",
            Scene::Piece(piece, _) => piece.name(),
        }
    }

    /// The strokes: at which sample, on what, how.
    fn strokes(self, rate: f64) -> Vec<(usize, PieceId, Strike)> {
        match self {
            Scene::Groove(_) => groove(rate),
            Scene::AllAtOnce(_) => {
                let struck = PieceId::KIT.into_iter().filter(|&piece| piece != PieceId::Timpani);
                struck.map(|piece| (0, piece, hard(piece))).collect()
            }
            Scene::Idle => Vec::new(),
            Scene::Piece(piece, _) => vec![(0, piece, hard(piece))],
        }
    }
}

fn hard(piece: PieceId) -> Strike {
    strike(piece, HARD, if piece.is_drum() { ON_DRUMS } else { ON_CYMBALS })
}

fn strike(piece: PieceId, speed: f64, radius: f64) -> Strike {
    Strike { speed, radius, ..hear::default_strike(piece) }
}

fn groove(rate: f64) -> Vec<(usize, PieceId, Strike)> {
    let mut strokes = Vec::new();
    for step in 0..16 {
        let at = (0.25 * f64::from(step) * rate) as usize;
        strokes.push((at, PieceId::Ride, strike(PieceId::Ride, 2.5, 0.6)));
        match step % 4 {
            0 => strokes.push((at, PieceId::Kick, strike(PieceId::Kick, 3.0, 0.2))),
            2 => strokes.push((at, PieceId::Snare, strike(PieceId::Snare, 4.0, 0.3))),
            _ => {}
        }
        if step == 0 {
            strokes.push((at, PieceId::Crash, strike(PieceId::Crash, 5.0, 0.92)));
        }
    }
    strokes
}

/// A kit and the strokes on it, as far as they have been played.
pub struct Workload {
    scene: Scene,
    rate: f64,
    kit: Kit,
    strokes: Vec<(usize, PieceId, Strike)>,
    played: usize,
    now: usize,
    left: [f32; BLOCK],
    right: [f32; BLOCK],
}

impl Workload {
    /// Builds what plays at a rate in Hz. A single piece plays in a kit of its own.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) if a piece cannot be built.
    pub fn new(scene: &Scene, rate: f64) -> Result<Workload> {
        let scene = *scene;
        let (ids, quality) = match scene {
            Scene::Groove(quality) | Scene::AllAtOnce(quality) => (PieceId::KIT.to_vec(), quality),
            Scene::Idle => (PieceId::KIT.to_vec(), Quality::Standard),
            Scene::Piece(piece, quality) => (vec![piece], quality),
        };
        let mut kit = Kit::new(rate);
        for id in ids {
            let piece = Piece::new(id, &options(quality, rate)).map_err(|error| bad_input!("{error}"))?;
            kit.install(Box::new(piece));
        }
        let (left, right) = ([0.0; BLOCK], [0.0; BLOCK]);
        Ok(Workload { scene, rate, kit, strokes: scene.strokes(rate), played: 0, now: 0, left, right })
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

    /// Renders one block of [`BLOCK`] samples, cut where strokes fall.
    #[inline(never)] // Instructions are counted by its name.
    pub fn block(&mut self) {
        let (start, end) = (self.now, self.now + BLOCK);
        while self.now < end {
            while let Some((_, piece, strike)) =
                self.strokes.get(self.played).filter(|(at, ..)| *at <= self.now)
            {
                self.kit.strike(*piece, strike);
                self.played += 1;
            }
            let next = self.strokes.get(self.played).map_or(end, |&(at, ..)| at.min(end));
            let run = self.now - start..next - start;
            self.kit.render(&mut self.left[run.clone()], &mut self.right[run]);
            self.now = next;
        }
    }
}
