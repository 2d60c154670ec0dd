//! Undo and redo of what hands did to parameters and of what was learned, and two settings to compare.
//!
//! An edit is what lies between taking hold of a parameter and letting it go; what is done in one frame, as by a
//! preset, is one step. Automation and other windows are not hands: undoing puts back what a parameter was when it
//! was taken hold of, whatever it is now.

use std::sync::Arc;

use nice_plug::prelude::{FloatParam, Param};
use overhear_player::kit_document::KitDocument;
use overhear_player::midi::assignments::Taught;

use super::gesture::{Gesture, put};

/// Steps that are remembered.
const DEPTH: usize = 200;

/// One parameter moved, plain values.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Edit {
    index: usize,
    from: f32,
    to: f32,
}

/// What can be taken back at once.
enum Step {
    /// Parameters were moved.
    Moved(Vec<Edit>),
    /// Notes or a calibration were learned: what was taught before and after.
    Learned(Box<[Taught; 2]>),
    /// Another kit was put in the place of one, and parameters went with it.
    Built([Arc<KitDocument>; 2], Vec<Edit>),
}

/// Where what is undone and done again goes.
pub struct Undoing<'a> {
    /// Receives what is done to the parameter of an index.
    pub set: &'a mut dyn FnMut(usize, Gesture),
    /// Receives what is taught instead of what was.
    pub teach: &'a mut dyn FnMut(&Taught),
    /// Receives the kit that is put in the place of the present one.
    pub build: &'a mut dyn FnMut(&Arc<KitDocument>),
}

/// What was done.
#[derive(Default)]
pub struct History {
    done: Vec<Step>,
    undone: Vec<Step>,
    /// Held now: from where each was taken and where it was last put.
    held: Vec<Edit>,
    /// What this frame has brought.
    fresh: Vec<Edit>,
    /// The setting that is not in use: plain values of all parameters, and the kit.
    other: Option<(Vec<f32>, Arc<KitDocument>)>,
    /// Whether the second setting is in use.
    second: bool,
}

impl History {
    /// Takes note of a gesture before it is passed on; `value` is what the parameter is now, in its own unit.
    pub fn note(&mut self, index: usize, gesture: Gesture, value: f32) {
        match gesture {
            Gesture::Begin => self.held.push(Edit { index, from: value, to: value }),
            Gesture::Set(to) => {
                self.held.iter_mut().filter(|edit| edit.index == index).for_each(|edit| edit.to = to);
            }
            Gesture::End => {
                let Some(place) = self.held.iter().position(|edit| edit.index == index) else { return };
                let edit = self.held.swap_remove(place);
                if edit.from != edit.to {
                    self.fresh.push(edit);
                }
            }
        }
    }

    /// Forgets every step and the other setting: they were about the pieces of another kit.
    pub fn forget(&mut self) {
        *self = History { held: std::mem::take(&mut self.held), ..History::default() };
    }

    /// Ends a frame: what it has brought is a step.
    pub fn end_frame(&mut self) {
        if self.fresh.is_empty() {
            return;
        }
        let fresh = std::mem::take(&mut self.fresh);
        self.add(Step::Moved(fresh));
    }

    /// Takes note of what was learned, which is a step.
    pub fn learned(&mut self, before: Taught, after: Taught) {
        self.add(Step::Learned(Box::new([before, after])));
    }

    /// Takes note of a kit that was put in the place of another in this frame, with what happened to parameters: a step.
    pub fn built(&mut self, before: Arc<KitDocument>, after: Arc<KitDocument>) {
        let edits = std::mem::take(&mut self.fresh);
        self.add(Step::Built([before, after], edits));
    }

    fn add(&mut self, step: Step) {
        self.done.push(step);
        self.undone.clear();
        if self.done.len() > DEPTH {
            self.done.remove(0);
        }
    }

    /// Whether there is something to undo.
    pub fn can_undo(&self) -> bool {
        !self.done.is_empty()
    }

    /// Whether there is something to do again.
    pub fn can_redo(&self) -> bool {
        !self.undone.is_empty()
    }

    /// Takes back the latest step.
    pub fn undo(&mut self, to: &mut Undoing<'_>) {
        let Some(step) = self.done.pop() else { return };
        match &step {
            Step::Moved(edits) => edits.iter().rev().for_each(|edit| put(edit.index, edit.from, to.set)),
            Step::Learned(taught) => (to.teach)(&taught[0]),
            Step::Built([before, _], edits) => {
                (to.build)(before);
                edits.iter().rev().for_each(|edit| put(edit.index, edit.from, to.set));
            }
        }
        self.undone.push(step);
    }

    /// Does again what was undone last.
    pub fn redo(&mut self, to: &mut Undoing<'_>) {
        let Some(step) = self.undone.pop() else { return };
        match &step {
            Step::Moved(edits) => edits.iter().for_each(|edit| put(edit.index, edit.to, to.set)),
            Step::Learned(taught) => (to.teach)(&taught[1]),
            Step::Built([_, after], edits) => {
                (to.build)(after);
                edits.iter().for_each(|edit| put(edit.index, edit.to, to.set));
            }
        }
        self.done.push(step);
    }

    /// Whether the second of two settings is in use.
    pub fn is_second(&self) -> bool {
        self.second
    }

    /// Puts the other setting in place of this one, which is kept; at first both are the same. Gives the kit of the other
    /// setting, if that is to be put in the place of the present one.
    pub fn swap(
        &mut self,
        values: &[FloatParam],
        document: &Arc<KitDocument>,
        set: &mut dyn FnMut(usize, Gesture),
    ) -> Option<Arc<KitDocument>> {
        let present: Vec<f32> = values.iter().map(|value| value.unmodulated_plain_value()).collect();
        self.second = !self.second;
        let (wanted, kit) = self.other.replace((present.clone(), document.clone()))?;
        for (index, (from, to)) in present.into_iter().zip(wanted).enumerate() {
            if from != to {
                self.fresh.push(Edit { index, from, to });
                put(index, to, set);
            }
        }
        (kit != *document).then_some(kit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drag_is_one_step_and_comes_back() {
        let mut history = History::default();
        history.note(3, Gesture::Begin, 10.0);
        for value in [11.0, 12.0, 15.0] {
            history.note(3, Gesture::Set(value), 10.0);
            history.end_frame();
        }
        assert!(!history.can_undo(), "it is still held");
        history.note(3, Gesture::End, 15.0);
        history.end_frame();
        let mut moved = Vec::new();
        let set = &mut |index, gesture| moved.push((index, gesture));
        history.undo(&mut Undoing { set, teach: &mut |_| {}, build: &mut |_| {} });
        assert_eq!(moved, [Gesture::Begin, Gesture::Set(10.0), Gesture::End].map(|gesture| (3, gesture)));
        moved.clear();
        let set = &mut |index, gesture| moved.push((index, gesture));
        history.redo(&mut Undoing { set, teach: &mut |_| {}, build: &mut |_| {} });
        assert_eq!(moved[1], (3, Gesture::Set(15.0)));
        assert!(history.can_undo() && !history.can_redo());
    }

    #[test]
    fn what_one_frame_brings_is_one_step() {
        let mut history = History::default();
        for index in 0..5 {
            put(index, 1.0, &mut |index, gesture| history.note(index, gesture, 0.0));
        }
        history.end_frame();
        let mut undone = 0;
        let set = &mut |_, gesture| undone += usize::from(gesture == Gesture::Set(0.0));
        history.undo(&mut Undoing { set, teach: &mut |_| {}, build: &mut |_| {} });
        assert_eq!(undone, 5);
        assert!(!history.can_undo());
    }

    #[test]
    fn what_is_forgotten_is_not_undone_and_what_is_held_is_still_let_go() {
        let mut history = History::default();
        put(0, 2.0, &mut |index, gesture| history.note(index, gesture, 0.0));
        history.end_frame();
        history.note(1, Gesture::Begin, 0.0);
        history.note(1, Gesture::Set(1.0), 0.0);
        history.forget();
        assert!(!history.can_undo());
        history.note(1, Gesture::End, 1.0);
        history.end_frame();
        assert!(history.can_undo());
    }

    #[test]
    fn holding_without_moving_is_no_step() {
        let mut history = History::default();
        put(0, 2.0, &mut |index, gesture| history.note(index, gesture, 2.0));
        history.end_frame();
        assert!(!history.can_undo());
    }
}
