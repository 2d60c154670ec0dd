//! The kit as the plugin plays it, and the two recording chains of a stroke.

use std::sync::Arc;

use anyhow::Result;
use overhear::building::Pace;
use overhear::kit_document::KitDocument;
use overhear::parameters::{SlotParameter, slot_index};
use overhear::performer::Performer;
use overhear_engine::kit::{OUTPUTS, Stereo};
use overhear_engine::slot::Slot;
use overhear_engine::strike::Strike;
use serde::Serialize;

use crate::bad_input;
use crate::settings::Setting;

/// Recording chain of a piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum RecordingChain {
    /// Its close microphone alone.
    Close,
    /// The full mix: close microphones, overheads, room.
    Mix,
}

impl RecordingChain {
    /// In the order of the report.
    pub const ALL: [RecordingChain; 2] = [RecordingChain::Close, RecordingChain::Mix];

    /// Its key in the JSON, also how people read it.
    pub fn name(self) -> &'static str {
        match self {
            RecordingChain::Close => "close",
            RecordingChain::Mix => "mix",
        }
    }

    /// The least share of the figures that is to be inside.
    pub fn goal(self) -> f64 {
        match self {
            RecordingChain::Close => 0.7,
            RecordingChain::Mix => 0.8,
        }
    }
}

/// A kit ready to be struck.
pub struct Stand {
    performer: Performer,
    rate: f64,
}

/// Time for controls and the pedal to settle before a stroke, s.
const SETTLING: f64 = 0.5;

impl Stand {
    /// Builds the kit as the plugin has it while a host plays or bounces, with some parameters moved.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) if it cannot be built at the sample rate (Hz).
    pub fn new(rate: u32, document: &KitDocument, settings: &[Setting], pace: Pace) -> Result<Stand> {
        let rate = f64::from(rate);
        let mut performer = Performer::new(rate, document, Arc::default());
        settings.iter().for_each(|&(index, value)| performer.set_parameter(index, value));
        performer.install_kit(rate, pace).map_err(|error| bad_input!("{error}"))?;
        Ok(Stand { performer, rate })
    }

    /// Strikes the piece of a slot, which is at rest, its pedal brought there before, and returns what each of
    /// [`RecordingChain::ALL`] hears for so many seconds.
    pub fn strike(&mut self, slot: Slot, strike: &Strike, pedal: Option<f64>, seconds: f64) -> [Vec<f32>; 2] {
        self.performer.reset();
        if let Some(pedal) = pedal {
            self.performer.set_parameter(slot_index(slot, SlotParameter::Pedal), pedal as f32);
        }
        let _ = self.hear(slot, SETTLING);
        self.performer.strike(slot, strike);
        self.hear(slot, seconds)
    }

    /// Renders, and keeps a close microphone and the mix.
    fn hear(&mut self, slot: Slot, seconds: f64) -> [Vec<f32>; 2] {
        let frames = (seconds * self.rate) as usize;
        let mut pairs = [(); 2].map(|()| [vec![0.0_f32; frames], vec![0.0_f32; frames]]);
        let [close, mix] = &mut pairs;
        let mut outputs: [Stereo<'_>; OUTPUTS] = std::array::from_fn(|_| [&mut [][..], &mut [][..]]);
        outputs[slot.index()] = close.each_mut().map(|side| &mut side[..]);
        self.performer.render_outputs(mix.each_mut().map(|side| &mut side[..]), &mut outputs);
        pairs.map(|[left, right]| left.iter().zip(&right).map(|(l, r)| 0.5 * (l + r)).collect())
    }
}
