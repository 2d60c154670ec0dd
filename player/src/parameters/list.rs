//! All parameters, in the order that hosts see.

use std::collections::HashMap;
use std::sync::LazyLock;

use overhear_engine::kit_spec::KitSpec;
use overhear_engine::slot::{SLOTS, Slot};

use super::parameter::{Parameter, SlotParameter};
use super::table::{GLOBALS, TABLE};

/// Parameters that belong to a slot: they come first, slot by slot.
pub const SLOT_COUNT: usize = SLOTS * SlotParameter::ALL.len();

/// All parameters.
pub const COUNT: usize = SLOT_COUNT + GLOBALS;

/// Every parameter, in the order hosts see, named and set as in the standard kit. The order is frozen: append only.
///
/// # Real-time
/// A look at a pointer, once it has been called anywhere before.
pub fn parameters() -> &'static [Parameter; COUNT] {
    static PARAMETERS: LazyLock<[Parameter; COUNT]> = LazyLock::new(|| {
        let kit = KitSpec::standard();
        std::array::from_fn(|index| match slot_parameter(index) {
            Some((slot, what)) => what.in_slot(slot, &kit),
            None => TABLE[index - SLOT_COUNT],
        })
    });
    &PARAMETERS
}

/// Place in the table of a slot's parameter.
pub const fn slot_index(slot: Slot, what: SlotParameter) -> usize {
    slot.index() * SlotParameter::ALL.len() + what as usize
}

/// Slot and kind of a slot's parameter, by its place in the table; none of one that belongs to no slot.
pub fn slot_parameter(index: usize) -> Option<(Slot, SlotParameter)> {
    let slot = Slot::new(index / SlotParameter::ALL.len())?;
    Some((slot, SlotParameter::ALL[index % SlotParameter::ALL.len()]))
}

/// Number by which hosts know a parameter's id: the hash of the framework.
pub fn host_id(id: &str) -> u32 {
    let hash = id.bytes().fold(0_u32, |hash, byte| hash.wrapping_mul(31).wrapping_add(u32::from(byte)));
    // The highest bit belongs to the host in VST3.
    hash & !(1 << 31)
}

/// [Steps](Parameter::steps) of the parameter that hosts know by a number.
///
/// # Real-time
/// A look-up, once it has been called anywhere before.
pub fn stepped(id: u32) -> Option<u32> {
    static STEPS: LazyLock<HashMap<u32, u32>> = LazyLock::new(|| {
        let steps = |parameter: &Parameter| Some((host_id(parameter.id), parameter.steps()?));
        parameters().iter().filter_map(steps).collect()
    });
    STEPS.get(&id).copied()
}
