//! The page of physics: what the strokes did, in diagrams.
//!
//! About the selected piece: the force of its latest stroke, its surface near by or one of its modes alone, its modes;
//! of a drum how its pitch glides, of one with wires what they do, of a plate how far it bends and how its energy wanders
//! through the octaves. About the kit: energies and the spectrum of what is heard.

use std::collections::VecDeque;
use std::sync::Arc;

use egui::{Color32, Rect, Ui, pos2};
use overhear_engine::piece::PieceId;
use overhear_engine::snapshot::{FieldShapes, KitSnapshot, OCTAVES};

use super::plot::Plot;
use super::theme;
use crate::monitor::STILL;
use crate::sound::Sound;

mod bending;
mod cascade;
mod closeup;
mod energy;
mod force;
mod glide;
mod modes;
mod spectrum;
mod wires;

use closeup::Closeup;
use spectrum::Spectrum;
use wires::Wires;

/// Pieces of the kit.
const PIECES: usize = PieceId::KIT.len();

/// The piece with snare wires, by its place in the kit.
const SNARE: usize = 1;

/// How far back energies and pitches are drawn, s.
const MEMORY: f64 = 3.0;

/// Space between diagrams, points.
const GAP: f32 = 8.0;

/// What was at a time.
struct Moment {
    /// s of the editor's time.
    time: f64,
    /// How far pitch is above its own, cents, by slot.
    cents: [f32; PIECES],
    /// Largest displacement over thickness, by slot; of plates.
    bending: [f32; PIECES],
    /// Energy of the modes of each octave, J, by slot.
    octaves: [[f32; OCTAVES]; PIECES],
}

/// The page of one window.
pub struct Physics {
    moments: VecDeque<Moment>,
    closeup: Closeup,
    spectrum: Spectrum,
    wires: Wires,
    /// The mode that is shown alone, and of which piece.
    mode: Option<(usize, usize)>,
}

/// What the page is drawn from.
pub struct Seen<'a> {
    pub snapshot: &'a KitSnapshot,
    pub shapes: Option<Arc<FieldShapes>>,
    pub selected: usize,
    pub sound: &'a Sound,
}

/// Draws one height (share of the plot's) for each moment over the time that is remembered, up to `now`, s.
fn over_time(
    plot: &Plot,
    moments: &VecDeque<Moment>,
    now: f64,
    heights: impl Iterator<Item = f32>,
    colour: Color32,
) {
    let across = moments.iter().map(|moment| 1.0 - ((now - moment.time) / MEMORY) as f32);
    let points: Vec<_> = across.zip(heights).map(|(x, y)| plot.at(x, y)).collect();
    plot.curve(&points, colour);
    plot.ends(&format!("{MEMORY:.0} s ago"), "now");
}

impl Physics {
    pub fn new() -> Physics {
        Physics {
            moments: VecDeque::new(),
            closeup: Closeup::default(),
            spectrum: Spectrum::new(),
            wires: Wires::default(),
            mode: None,
        }
    }

    /// Takes note of a snapshot of a time (s); `shapes` gives a slot's mode shapes once it is built.
    pub fn follow(
        &mut self,
        now: f64,
        snapshot: &KitSnapshot,
        shapes: &dyn Fn(usize) -> Option<Arc<FieldShapes>>,
    ) {
        let of_pieces = |value: &dyn Fn(usize) -> f32| std::array::from_fn(value);
        let cents = of_pieces(&|slot| {
            let tension = shapes(slot).map_or(0.0, |shapes| shapes.tension);
            glide::cents(PieceId::KIT[slot], snapshot.pieces[slot].stretch, tension)
        });
        let bending = of_pieces(&|slot| {
            bending::of(PieceId::KIT[slot], &snapshot.pieces[slot], shapes(slot).as_deref())
        });
        let octaves = snapshot.pieces.map(|piece| piece.octaves);
        self.moments.push_back(Moment { time: now, cents, bending, octaves });
        self.wires.follow(&snapshot.pieces[SNARE].wires, now);
    }

    /// Lets go of what is no longer drawn at the time `now`, s.
    pub fn forget_before(&mut self, now: f64) {
        while self.moments.front().is_some_and(|moment| now - moment.time > MEMORY) {
            self.moments.pop_front();
        }
    }

    /// How far a piece's pitch is above its own just now, cents: the mean of late, as it sways with every period.
    pub fn cents(&self, slot: usize) -> f32 {
        const LATE: usize = 6;
        let late = self.moments.iter().rev().take(LATE).map(|moment| moment.cents[slot]);
        late.sum::<f32>() / LATE.min(self.moments.len()).max(1) as f32
    }

    /// Whether the page moves by itself: a mode that swings, or a past that has not gone by yet.
    pub fn moves_on(&self) -> bool {
        let moved = |moment: &Moment| moment.octaves.iter().flatten().any(|&energy| energy > STILL);
        self.mode.is_some() || self.moments.iter().any(moved)
    }

    /// Draws the page.
    pub fn show(&mut self, ui: &mut Ui, rect: Rect, seen: &Seen<'_>) {
        let slot = seen.selected;
        if self.mode.is_some_and(|(of, _)| of != slot) {
            self.mode = None;
        }
        let piece = &seen.snapshot.pieces[slot];
        let accent = theme::of(ui).pieces[slot];
        let now = ui.input(|input| input.time);
        let (left, right) = halves(rect, 0.56, true);
        let (upper, lower) = halves(left, 0.36, false);
        let (middle, bottom) = halves(lower, 0.5, false);
        let plate = bending::thickness(PieceId::KIT[slot]).is_some();
        let wires = slot == SNARE;
        force::show(ui, upper, slot, &piece.strike, accent);
        let (energies, beside) = halves(middle, 0.5, true);
        energy::show(ui, energies, seen.snapshot);
        let (sound, corner) = if plate || wires { halves(bottom, 0.62, true) } else { (bottom, bottom) };
        self.spectrum.show(ui, sound, seen.sound);
        if wires {
            self.wires.show(ui, corner, &piece.wires, now, accent);
        }
        if plate {
            bending::show(ui, corner, &self.moments, (slot, now), accent);
            cascade::show(ui, beside, &self.moments, (slot, now));
        } else {
            glide::show(ui, beside, &self.moments, (slot, now), accent);
        }
        let (near, list) = halves(right, 0.48, false);
        let mode = self.mode.map(|(_, mode)| mode);
        self.closeup.show(ui, near, seen, mode);
        if let Some(mode) = modes::show(ui, list, piece, seen.shapes.as_deref(), mode, accent) {
            let chosen = Some((slot, mode));
            self.mode = if self.mode == chosen { None } else { chosen };
        }
    }
}

/// Two parts of a rectangle with a gap between, beside each other or one over the other.
fn halves(rect: Rect, share: f32, beside: bool) -> (Rect, Rect) {
    let gap = 0.5 * GAP;
    if beside {
        let x = rect.min.x + share * rect.width();
        (
            Rect::from_min_max(rect.min, pos2(x - gap, rect.max.y)),
            Rect::from_min_max(pos2(x + gap, rect.min.y), rect.max),
        )
    } else {
        let y = rect.min.y + share * rect.height();
        (
            Rect::from_min_max(rect.min, pos2(rect.max.x, y - gap)),
            Rect::from_min_max(pos2(rect.min.x, y + gap), rect.max),
        )
    }
}
