//! MIDI controllers as this format has them: hidden parameters, one for each controller and channel.
//!
//! The framework makes 2,080 of them, all with a default of 0 and a present value of .5: hosts that send what differs
//! from its default would move every controller when a project opens, and hosts that look at each parameter take half a
//! minute. The guard offers only those that act, and each is where it was moved last.

use std::sync::atomic::{AtomicU64, Ordering};

use nice_plug::wrapper::vst3::vst3::Steinberg::Vst::{CtrlNumber, ParamID, ParamValue};
use overhear_player::midi::playing::CONTROLLERS;

/// Channels of MIDI.
const CHANNELS: usize = 16;

/// Numbers that the framework keeps for each channel: 128 controllers, the pressure on the channel, pitch bend.
const EACH: usize = 130;

/// The first of the framework's ids: they end where those of hosts begin.
const FIRST: ParamID = (1 << 31) - (EACH * CHANNELS) as ParamID;

/// How many are offered.
pub const COUNT: usize = CONTROLLERS.len() * CHANNELS;

/// The latest values, 0 to 1, by the place at which a controller is offered: by channel, then in the order of
/// [`CONTROLLERS`].
pub struct Controllers {
    /// Bits of double precision numbers.
    values: [AtomicU64; COUNT],
}

impl Controllers {
    /// None has been moved.
    pub fn new() -> Controllers {
        Controllers { values: [const { AtomicU64::new(0) }; COUNT] }
    }

    /// Where the parameter of an id is.
    pub fn get(&self, id: ParamID) -> Option<ParamValue> {
        Some(f64::from_bits(self.values.get(place(id)?)?.load(Ordering::Relaxed)))
    }

    /// Takes in where the parameter of an id has been moved, and says whether it is a controller's.
    ///
    /// # Real-time
    /// A store; no allocation, no lock.
    pub fn set(&self, id: ParamID, value: ParamValue) -> bool {
        let known = place(id).and_then(|place| self.values.get(place));
        if let Some(kept) = known.filter(|_| !value.is_nan()) {
            kept.store(value.clamp(0.0, 1.0).to_bits(), Ordering::Relaxed);
        }
        known.is_some()
    }
}

/// The framework's place, behind the parameters proper, of what is offered at a place.
pub fn of_framework(offered: usize) -> Option<usize> {
    let controller = CONTROLLERS.get(offered % CONTROLLERS.len())?;
    (offered < COUNT).then(|| offered / CONTROLLERS.len() * EACH + usize::from(*controller))
}

/// Whether the controller of a number acts.
pub fn acts(controller: CtrlNumber) -> bool {
    u8::try_from(controller).is_ok_and(|number| CONTROLLERS.contains(&number))
}

/// The place at which the parameter of an id is offered.
fn place(id: ParamID) -> Option<usize> {
    let framework = id.checked_sub(FIRST)? as usize;
    let (channel, number) = (framework / EACH, framework % EACH);
    let controller = CONTROLLERS.iter().position(|&controller| usize::from(controller) == number)?;
    (channel < CHANNELS).then_some(channel * CONTROLLERS.len() + controller)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_offered_controller_has_its_own_id_and_value() {
        let controllers = Controllers::new();
        for offered in 0..COUNT {
            let id = FIRST + of_framework(offered).unwrap() as ParamID;
            assert_eq!((place(id), controllers.get(id)), (Some(offered), Some(0.0)));
            assert!(controllers.set(id, offered as f64 / COUNT as f64));
        }
        for offered in 0..COUNT {
            let id = FIRST + of_framework(offered).unwrap() as ParamID;
            assert_eq!(controllers.get(id), Some(offered as f64 / COUNT as f64));
        }
        assert_eq!((of_framework(COUNT), controllers.get(FIRST + 1), controllers.get(7)), (None, None, None));
        assert!(!controllers.set(FIRST + 129, 0.5) && acts(4) && !acts(7) && !acts(129) && !acts(-1));
    }
}
