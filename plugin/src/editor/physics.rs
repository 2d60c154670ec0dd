//! The page of physics: what the strokes did, in diagrams.
//!
//! About the selected piece: the force of its latest stroke, its surface near by or one of its modes alone, its modes;
//! of a drum how its pitch glides, of one with wires what they do, of a plate how far it bends and how its energy wanders
//! through the octaves. About the kit: energies and the spectrum of what is heard.

use std::collections::VecDeque;
use std::sync::Arc;

use egui::{Rect, Ui};
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::slot::{SLOTS, Slot};
use overhear_engine::snapshot::FieldShapes;
use overhear_engine::snapshot::KitSnapshot;

use super::theme;
use crate::monitor::STILL;

mod bending;
mod cascade;
mod closeup;
mod energy;
mod force;
mod glide;
mod modes;
mod page;
mod past;
mod spectrum;
mod wires;

use closeup::Closeup;
use page::halves;
use past::{MEMORY, Moment};
use spectrum::Spectrum;
use wires::Wires;

pub use page::Seen;

/// The page of one window.
pub struct Physics {
    moments: VecDeque<Moment>,
    closeup: Closeup,
    spectrum: Spectrum,
    /// `[slot]`; still of a piece without wires.
    wires: [Wires; SLOTS],
    /// The mode that is shown alone, and of which piece.
    mode: Option<(Slot, usize)>,
}

impl Physics {
    pub fn new() -> Physics {
        Physics {
            moments: VecDeque::new(),
            closeup: Closeup::default(),
            spectrum: Spectrum::new(),
            wires: Default::default(),
            mode: None,
        }
    }

    /// Forgets the past: it was another kit's.
    pub fn forget(&mut self) {
        self.moments.clear();
        self.wires = Default::default();
        self.closeup = Closeup::default();
        self.mode = None;
    }

    /// Takes note of a snapshot of a time (s); `shapes` gives a piece's mode shapes once it is built.
    pub fn follow(
        &mut self,
        now: f64,
        kit: &KitSpec,
        snapshot: &KitSnapshot,
        shapes: &dyn Fn(Slot) -> Option<Arc<FieldShapes>>,
    ) {
        let octaves = snapshot.pieces.map(|piece| piece.octaves);
        let mut moment = Moment { time: now, cents: [0.0; SLOTS], bending: [0.0; SLOTS], octaves };
        for (slot, piece) in kit.slots() {
            let (at, state, shapes) = (slot.index(), &snapshot.pieces[slot.index()], shapes(slot));
            let tension = shapes.as_ref().map_or(0.0, |shapes| shapes.tension);
            moment.cents[at] = glide::cents(piece, state.stretch, tension);
            moment.bending[at] = bending::of(piece, state, shapes.as_deref());
            self.wires[at].follow(&state.wires, now);
        }
        self.moments.push_back(moment);
    }

    /// Lets go of what is no longer drawn at the time `now`, s.
    pub fn forget_before(&mut self, now: f64) {
        while self.moments.front().is_some_and(|moment| now - moment.time > MEMORY) {
            self.moments.pop_front();
        }
    }

    /// How far a piece's pitch is above its own just now, cents: the mean of late, as it sways with every period.
    pub fn cents(&self, slot: Slot) -> f32 {
        const LATE: usize = 6;
        let late = self.moments.iter().rev().take(LATE).map(|moment| moment.cents[slot.index()]);
        late.sum::<f32>() / LATE.min(self.moments.len()).max(1) as f32
    }

    /// Whether the page moves by itself: a mode that swings, or a past that has not gone by yet.
    pub fn moves_on(&self) -> bool {
        let moved = |moment: &Moment| moment.octaves.iter().flatten().any(|&energy| energy > STILL);
        self.mode.is_some() || self.moments.iter().any(moved)
    }

    /// Draws the page.
    pub fn show(&mut self, ui: &mut Ui, rect: Rect, seen: &Seen<'_>) {
        let (slot, spec) = seen.selected;
        if self.mode.is_some_and(|(of, _)| of != slot) {
            self.mode = None;
        }
        let at = slot.index();
        let piece = &seen.snapshot.pieces[at];
        let accent = theme::of(ui).pieces[at];
        let now = ui.input(|input| input.time);
        let (left, right) = halves(rect, 0.56, true);
        let (upper, lower) = halves(left, 0.36, false);
        let (middle, bottom) = halves(lower, 0.5, false);
        let plate = bending::thickness(spec).is_some();
        let wires = spec.drum().is_some_and(|drum| drum.wires.is_some());
        force::show(ui, upper, &spec.title, &piece.strike, accent);
        let (energies, beside) = halves(middle, 0.5, true);
        energy::show(ui, energies, seen.kit, seen.snapshot);
        let (sound, corner) = if plate || wires { halves(bottom, 0.62, true) } else { (bottom, bottom) };
        self.spectrum.show(ui, sound, seen.sound);
        if wires {
            self.wires[at].show(ui, corner, &piece.wires, now, accent);
        }
        if plate {
            bending::show(ui, corner, &self.moments, (at, now), accent);
            cascade::show(ui, beside, &self.moments, (at, now));
        } else {
            glide::show(ui, beside, &self.moments, (at, now), accent);
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
