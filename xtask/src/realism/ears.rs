//! The kit as the plugin plays it, and the two ways in which a stroke on it is heard.

use anyhow::{Context, Result};
use overhear::building::Pace;
use overhear::parameters::{Drives, PARAMETERS};
use overhear::performer::Performer;
use overhear_engine::kit::{Control, OUTPUTS, Stereo};
use overhear_engine::piece::PieceId;
use overhear_engine::strike::Strike;
use serde::Serialize;

use crate::bad_input;
use crate::settings::Setting;

/// How a piece is heard.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Ear {
    /// Its close microphone alone.
    Close,
    /// The full mix: close microphones, overheads, room.
    Mix,
}

impl Ear {
    /// In the order of the report.
    pub const ALL: [Ear; 2] = [Ear::Close, Ear::Mix];

    /// Its key in the JSON, also how people read it.
    pub fn name(self) -> &'static str {
        match self {
            Ear::Close => "close",
            Ear::Mix => "mix",
        }
    }

    /// The least share of the figures that is to be inside.
    pub fn goal(self) -> f64 {
        match self {
            Ear::Close => 0.7,
            Ear::Mix => 0.8,
        }
    }
}

/// A kit ready to be struck.
pub struct Stand {
    performer: Performer,
    rate: f64,
}

/// How long controls and the pedal are given to arrive before a stroke, s.
const SETTLING: f64 = 0.5;

impl Stand {
    /// Builds the kit as the plugin has it while a host plays or bounces, with some parameters moved.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) if it cannot be built at the sample rate (Hz).
    pub fn new(rate: u32, settings: &[Setting], pace: Pace) -> Result<Stand> {
        let rate = f64::from(rate);
        let mut performer = Performer::new(rate);
        settings.iter().for_each(|&(index, value)| performer.set_parameter(index, value));
        performer.install_kit_for(rate, pace).map_err(|error| bad_input!("{error}"))?;
        Ok(Stand { performer, rate })
    }

    /// Strikes a piece that is at rest, the pedal brought there before, and returns what each of [`Ear::ALL`] hears for so
    /// many seconds.
    ///
    /// # Errors
    /// If the piece does not stand in the kit.
    pub fn strike(
        &mut self,
        piece: PieceId,
        strike: &Strike,
        pedal: Option<f64>,
        seconds: f64,
    ) -> Result<[Vec<f32>; 2]> {
        let slot = piece.slot().with_context(|| format!("no {} in the kit", piece.name()))?;
        self.performer.reset();
        let control = PARAMETERS.iter().position(|it| it.drives == Drives::Control(Control::Pedal));
        if let (Some(index), Some(pedal)) = (control, pedal) {
            self.performer.set_parameter(index, pedal as f32);
        }
        let _ = self.hear(slot, SETTLING);
        self.performer.strike(piece, strike);
        Ok(self.hear(slot, seconds))
    }

    /// Renders, and keeps a close microphone and the mix.
    fn hear(&mut self, slot: usize, seconds: f64) -> [Vec<f32>; 2] {
        let frames = (seconds * self.rate) as usize;
        let mut pairs = [(); 2].map(|()| [vec![0.0_f32; frames], vec![0.0_f32; frames]]);
        let [close, mix] = &mut pairs;
        let mut outputs: [Stereo<'_>; OUTPUTS] = std::array::from_fn(|_| [&mut [][..], &mut [][..]]);
        outputs[slot] = close.each_mut().map(|side| &mut side[..]);
        self.performer.render_outputs(mix.each_mut().map(|side| &mut side[..]), &mut outputs);
        pairs.map(|[left, right]| left.iter().zip(&right).map(|(l, r)| 0.5 * (l + r)).collect())
    }
}
