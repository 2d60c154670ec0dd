//! Values that a host has set while it processes.
//!
//! Such a value acts when it arrives with a buffer. Until then the framework tells the former one, and a host that reads a
//! value back finds that it was not taken. The guard tells what the host has set.

use std::sync::atomic::{AtomicU64, Ordering};

use fnv::FnvHashMap;
use nice_plug::wrapper::vst3::vst3::Steinberg::Vst::{ParamID, ParamValue};
use overhear_player::parameters::{BYPASS_ID, host_id, parameters};

/// Bits of what is no value.
const NONE: u64 = f64::NAN.to_bits();

/// What is set and has not arrived, by id: bits of double precision numbers.
pub struct Edits(FnvHashMap<ParamID, AtomicU64>);

impl Edits {
    /// Nothing is set. Allocates.
    pub fn new() -> Edits {
        let ids = parameters().iter().map(|parameter| parameter.id).chain([BYPASS_ID]);
        Edits(ids.map(|id| (host_id(id), AtomicU64::new(NONE))).collect())
    }

    /// Takes in what the host sets.
    pub fn set(&self, id: ParamID, value: ParamValue) {
        if let Some(edit) = self.0.get(&id) {
            edit.store(value.clamp(0.0, 1.0).to_bits(), Ordering::Relaxed);
        }
    }

    /// What the host has set, if that has not arrived.
    pub fn get(&self, id: ParamID) -> Option<ParamValue> {
        let value = f64::from_bits(self.0.get(&id)?.load(Ordering::Relaxed));
        (!value.is_nan()).then_some(value)
    }

    /// A value has arrived.
    ///
    /// # Real-time
    /// A look-up and a store; no allocation, no lock.
    pub fn arrived(&self, id: ParamID) {
        if let Some(edit) = self.0.get(&id) {
            edit.store(NONE, Ordering::Relaxed);
        }
    }

    /// All values are others.
    pub fn forget(&self) {
        self.0.values().for_each(|edit| edit.store(NONE, Ordering::Relaxed));
    }
}
