//! How values of parameters move the kit and the playing.

use overhear_engine::kit::{Control, Microphone};
use overhear_engine::slot::Slot;
use overhear_engine::strike::Striker;

use super::{Performer, flushed};
use crate::midi::maps::NoteMap;
use crate::midi::playing::{ChokeRule, NOTES_OFF_CONTROLLER, SOUND_OFF_CONTROLLER, STRAINER_CONTROLLER};
use crate::parameters::{Drives, Manner, SlotParameter, default_value, is_live, parameters, slot_index};
use crate::placing;

impl Performer {
    /// Moves a parameter, by its place in the [table](parameters), to a plain value from the next sample
    /// on; before the first note and sample it is there at once. The value is
    /// [snapped](crate::parameters::Parameter::snap); what is not a number is the kit's default. An unchanged value and an
    /// unknown index do nothing.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn set_parameter(&mut self, index: usize, value: f32) {
        let Some(parameter) = parameters().get(index) else {
            return;
        };
        if std::mem::replace(&mut self.asked[index], value) == value {
            return;
        }
        let value =
            if value.is_nan() { default_value(index, &self.document().kit) } else { parameter.snap(value) };
        if std::mem::replace(&mut self.values[index], value) != value {
            self.apply(index);
        }
    }

    /// Lets a parameter's value act.
    pub(super) fn apply(&mut self, index: usize) {
        let (Some(parameter), Some(value)) = (parameters().get(index), self.values.get(index)) else {
            return;
        };
        let value = f64::from(*value);
        match parameter.drives {
            Drives::Slot(slot, what) => {
                if is_live(index, &self.document().kit) {
                    self.apply_to(slot, what, value);
                }
            }
            Drives::Control(control) => flushed(|| self.kit.set(control, value)),
            Drives::Stand(pair, _) => self.place(pair),
            Drives::Playing(manner) => self.set_manner(manner, value),
            // The builder reads it; new pieces will arrive.
            Drives::Building(_) => {}
        }
    }

    fn apply_to(&mut self, slot: Slot, what: SlotParameter, value: f64) {
        let (control, value) = match what {
            SlotParameter::Tune => return self.tune(slot),
            SlotParameter::Muffle => (Control::Muffling(slot), value),
            SlotParameter::Level => (Control::Level(slot), self.expressions[slot.index()].level(value)),
            SlotParameter::Pan => (Control::Pan(slot), self.expressions[slot.index()].pan(value / 100.0)),
            SlotParameter::Preload => (Control::Preload(slot), value),
            SlotParameter::Wires => {
                let on = self.playing.thrown(slot).unwrap_or(value >= 0.5);
                self.wires[slot.index()] = on;
                (Control::Wires(slot), if on { 1.0 } else { 0.0 })
            }
            SlotParameter::Pedal => (Control::Pedal(slot), value),
            SlotParameter::Position => {
                self.playing.style.offsets[slot.index()] = value;
                return;
            }
            SlotParameter::Stick => {
                let striker = (value as usize).checked_sub(1).and_then(|at| Striker::ALL.get(at).copied());
                self.playing.style.strikers[slot.index()] = striker;
                return;
            }
        };
        flushed(|| self.kit.set(control, value));
    }

    /// Puts a pair of microphones where the parameters want it.
    pub(super) fn place(&mut self, pair: Microphone) {
        let (usual, layout) = (self.document().kit.microphones, self.kit.layout());
        let (usual, present) = match pair {
            Microphone::Room => (usual.room, layout.room),
            Microphone::Overheads | Microphone::Close(_) => (usual.overheads, layout.overheads),
        };
        let places = placing::places(usual, pair, &|index| self.values.get(index).copied());
        // What stays where it is must not fade over.
        if places != present {
            flushed(|| self.kit.place(pair, places));
        }
    }

    fn set_manner(&mut self, manner: Manner, value: f64) {
        let style = &mut self.playing.style;
        let place = value as usize;
        match manner {
            Manner::Dynamics => style.dynamics = value,
            Manner::Curve => style.curve = value,
            Manner::PositionSpread => style.position_spread = value / 100.0,
            Manner::SpeedSpread => style.speed_spread = value,
            Manner::Map => style.map = NoteMap::ALL.get(place).copied().unwrap_or_default(),
            Manner::Channel => style.channel = place.checked_sub(1).map(|channel| channel as u8),
            Manner::Chokes => style.chokes = ChokeRule::ALL.get(place).copied().unwrap_or_default(),
            Manner::FollowsPosition => style.follows_position = value >= 0.5,
            Manner::FollowsPrograms => style.follows_programs = value >= 0.5,
        }
    }

    /// Brings the piece of a slot to the pitch that its parameter and its bend come to.
    pub(super) fn tune(&mut self, slot: Slot) {
        let tuning = self.tuning(slot);
        flushed(|| self.kit.set(Control::Tuning(slot), tuning));
    }

    /// The pitch that the parameter and the bend of a slot come to, Hz or a ratio.
    pub(super) fn tuning(&self, slot: Slot) -> f64 {
        let semitones = f64::from(self.values[slot_index(slot, SlotParameter::Tune)])
            + self.expressions[slot.index()].bend;
        self.own[slot.index()] * libm::exp2(semitones / 12.0)
    }

    /// Moves a MIDI controller to a value, 0 to 1. All sound off and all notes off (120, 123) end whatever sounds.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub fn control_change(&mut self, controller: u8, value: f32, channel: u8) {
        let silences = matches!(controller, SOUND_OFF_CONTROLLER | NOTES_OFF_CONTROLLER);
        if silences && self.hears(channel) {
            self.silence();
        }
        self.playing.control_change(controller, value, channel);
        if let Some(pedal) = self.playing.pedal(controller, value, channel) {
            self.press_pedals(pedal);
        }
        if let Some(on) = self.playing.throw(controller, value, channel) {
            Slot::ALL.into_iter().for_each(|slot| self.throw(slot, on));
        }
        if controller == STRAINER_CONTROLLER && self.hears(channel) && !value.is_nan() {
            self.strain(f64::from(value.clamp(0.0, 1.0)));
        }
    }

    /// Brings the pedals of all hi-hats to a place, 0 (up) to 1 (down).
    pub(super) fn press_pedals(&mut self, pedal: f64) {
        for slot in self.hi_hats().into_iter().flatten() {
            flushed(|| self.kit.set(Control::Pedal(slot), pedal));
        }
    }

    /// Throws the snare wires of a slot's drum on or off, unless they are so.
    pub(super) fn throw(&mut self, slot: Slot, on: bool) {
        if std::mem::replace(&mut self.wires[slot.index()], on) != on {
            flushed(|| self.kit.set(Control::Wires(slot), if on { 1.0 } else { 0.0 }));
        }
    }

    /// Whether the parameter of a slot has its wires on.
    pub(super) fn wires_by_parameter(&self, slot: Slot) -> bool {
        self.values[slot_index(slot, SlotParameter::Wires)] >= 0.5
    }

    /// Presses the wires of all drums on as a share of the strainer's way says, 0 (weakest) to 1: equal ways are equal ratios of
    /// force.
    fn strain(&mut self, way: f64) {
        for slot in Slot::ALL {
            let index = slot_index(slot, SlotParameter::Preload);
            if is_live(index, &self.document().kit) {
                let [weak, strong] = [parameters()[index].min, parameters()[index].max].map(f64::from);
                let force = weak * libm::pow(strong / weak, way);
                flushed(|| self.kit.set(Control::Preload(slot), force));
            }
        }
    }
}
