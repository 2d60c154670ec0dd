//! Parameters as they are shown: their values, with the names, units and ranges that the kit at hand gives them.

use nice_plug::prelude::{FloatParam, Param};
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::slot::Slot;

use super::gesture::{Gesture, put};
use overhear_player::parameters::{self, Parameter, ParameterError, SLOT_COUNT, SlotParameter, parameters};

/// The parameters of an instance and the kit that they are about.
#[derive(Clone, Copy)]
pub struct Values<'a> {
    pub all: &'a [FloatParam],
    pub kit: &'a KitSpec,
}

/// A parameter of a kit.
#[derive(Clone, Copy)]
pub struct Item<'a> {
    pub index: usize,
    pub parameter: &'static Parameter,
    pub value: &'a FloatParam,
    /// The piece's title, or the group of what is about all of them.
    pub group: &'a str,
    kit: &'a KitSpec,
    /// Smallest and largest value, in the parameter's unit.
    limits: (f32, f32),
}

impl<'a> Values<'a> {
    /// The present value of an index, in its own unit.
    pub fn plain(&self, index: usize) -> Option<f32> {
        Some(self.all.get(index)?.unmodulated_plain_value())
    }

    /// A parameter of a slot, unless the piece there has none of it.
    pub fn of_slot(&self, slot: Slot, what: SlotParameter) -> Option<Item<'a>> {
        let index = parameters::slot_index(slot, what);
        let piece = self.kit.piece(slot).filter(|_| parameters::is_live(index, self.kit))?;
        let parameter = parameters().get(index)?;
        let all = (parameter.min, parameter.max);
        let limits = match (what, piece.drum()) {
            (SlotParameter::Tune, Some(drum)) => within(all, drum.pitches()),
            _ => all,
        };
        Some(Item {
            index,
            parameter,
            value: self.all.get(index)?,
            group: &piece.title,
            kit: self.kit,
            limits,
        })
    }

    /// Everything that the piece in a slot has.
    pub fn of_piece(&self, slot: Slot) -> Vec<Item<'a>> {
        SlotParameter::ALL.into_iter().filter_map(|what| self.of_slot(slot, what)).collect()
    }

    /// Everything of a group that is about no single piece.
    pub fn of_group(&self, group: &str) -> Vec<Item<'a>> {
        let globals = parameters().iter().zip(self.all).enumerate().skip(SLOT_COUNT);
        let of_it = globals.filter(|(_, (parameter, _))| parameter.group == group);
        of_it.map(|(index, (parameter, value))| self.global(index, parameter, value)).collect()
    }

    /// The parameter of a name, which is about no single piece.
    pub fn named(&self, name: &str) -> Option<Item<'a>> {
        let index = parameters::find(name, self.kit).ok()?;
        Some(self.global(index, parameters().get(index)?, self.all.get(index)?))
    }

    fn global(&self, index: usize, parameter: &'static Parameter, value: &'a FloatParam) -> Item<'a> {
        let limits = (parameter.min, parameter.max);
        Item { index, parameter, value, group: parameter.group, kit: self.kit, limits }
    }
}

/// The range of a tuning in semitones that leaves a drum between its lowest and its highest pitch (Hz).
fn within((min, max): (f32, f32), [low, own, high]: [f64; 3]) -> (f32, f32) {
    let semitones = |hertz: f64| (12.0 * (hertz / own).log2()) as f32;
    (semitones(low).clamp(min, 0.0), semitones(high).clamp(0.0, max))
}

impl Item<'_> {
    /// The present value, in the parameter's unit.
    pub fn plain(&self) -> f32 {
        self.value.unmodulated_plain_value()
    }

    /// Where the kit has it before anybody moves it, in the parameter's unit.
    pub fn usual(&self) -> f32 {
        parameters::default_value(self.index, self.kit)
    }

    /// Smallest and largest value, in the parameter's unit.
    pub fn limits(&self) -> (f32, f32) {
        self.limits
    }

    /// The value at a place on the travel (0 to 1), plain, within the limits.
    pub fn at(&self, place: f32) -> f32 {
        self.value.preview_plain(place).clamp(self.limits.0, self.limits.1)
    }

    /// Place of a plain value on the travel, 0 to 1.
    pub fn place(&self, plain: f32) -> f32 {
        self.value.preview_normalized(plain)
    }

    /// A plain value with its unit.
    pub fn text(&self, plain: f32) -> String {
        parameters::text(self.index, plain, self.kit)
    }

    /// The value that a text stands for, in the parameter's unit.
    ///
    /// # Errors
    /// [`ParameterError`] with what was given and what is accepted.
    pub fn parse(&self, text: &str) -> Result<f32, ParameterError> {
        parameters::parse_value(self.index, text, self.kit)
    }

    /// Moves it to a value in the parameter's unit, in one gesture.
    pub fn put(&self, plain: f32, set: &mut dyn FnMut(usize, Gesture)) {
        put(self.index, plain, set);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::host_parameters::HostParameters;
    use overhear_engine::slot::SLOTS;

    #[test]
    fn a_piece_shows_what_it_has_and_in_its_own_units() {
        let (parameters, kit) = (HostParameters::default(), KitSpec::standard());
        let values = Values { all: parameters.values(), kit: &kit };
        let labels = |name: &str| -> Vec<_> {
            let (slot, _) = kit.find(name).unwrap();
            values.of_piece(slot).iter().map(|item| item.parameter.label).collect()
        };
        assert_eq!(labels("rack-tom"), ["Tune", "Muffle", "Level", "Pan", "Position", "Stick"]);
        assert!(labels("snare").ends_with(&["Preload", "Wires"]));
        assert!(labels("hi-hat").ends_with(&["Pedal"]));
        assert!(values.of_piece(Slot::ALL[SLOTS - 1]).is_empty(), "nobody is there");

        let (slot, _) = kit.find("kick").unwrap();
        let tune = values.of_slot(slot, SlotParameter::Tune).unwrap();
        assert_eq!((tune.group, tune.text(tune.usual()).as_str()), ("Kick", "45.00 Hz"));
        // Its knob ends where the drum does.
        let (low, high) = tune.limits();
        assert!((45.0 * (low / 12.0).exp2() - 35.0).abs() < 1e-3, "{low}");
        assert!((45.0 * (high / 12.0).exp2() - 90.0).abs() < 1e-3, "{high}");
        assert_eq!((tune.at(0.0), tune.at(1.0)), (low, high));
        assert!((tune.parse("60").unwrap() - 12.0 * (60.0_f32 / 45.0).log2()).abs() < 1e-3);
        assert!(tune.parse("20").is_err());
    }
}
