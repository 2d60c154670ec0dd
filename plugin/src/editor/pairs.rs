//! A hand that moves a pair of microphones: gestures on the parameters that say where it stands.

use nice_plug::prelude::{FloatParam, Param};
use overhear_engine::kit::Microphone;

use super::gesture::Gesture;
use super::kit_view::Moved;
use overhear_player::parameters::{Stand, parameters};
use overhear_player::placing::index_of;

/// Everything that a drag may move.
const STANDS: [Stand; 3] = [Stand::Height, Stand::Depth, Stand::Width];

/// The pair in a hand. Where it is held is kept apart from the values, which move in steps: slow drags would otherwise be
/// rounded away.
#[derive(Debug, Default)]
pub struct PairHand {
    values: [f32; STANDS.len()],
}

impl PairHand {
    /// Passes on what a hand does.
    pub fn act(&mut self, moved: Moved, values: &[FloatParam], set: &mut dyn FnMut(usize, Gesture)) {
        match moved {
            Moved::Taken(pair) => {
                for (held, (index, value)) in self.values.iter_mut().zip(stands_of(pair, values)) {
                    *held = value.unmodulated_plain_value();
                    set(index, Gesture::Begin);
                }
            }
            Moved::Dragged(pair, changes) => {
                for (place, (index, _)) in stands_of(pair, values).enumerate() {
                    let Some((_, change)) = changes.iter().find(|(stand, _)| *stand == STANDS[place]) else {
                        continue;
                    };
                    let Some(range) = parameters().get(index) else { continue };
                    self.values[place] = (self.values[place] + change).clamp(range.min, range.max);
                    set(index, Gesture::Set(self.values[place]));
                }
            }
            Moved::Released(pair) => {
                stands_of(pair, values).for_each(|(index, _)| set(index, Gesture::End));
            }
        }
    }
}

/// The parameters of a pair with their indices, in the order of [`STANDS`].
fn stands_of(pair: Microphone, values: &[FloatParam]) -> impl Iterator<Item = (usize, &FloatParam)> {
    STANDS.into_iter().filter_map(move |stand| {
        let index = index_of(pair, stand)?;
        Some((index, values.get(index)?))
    })
}
