//! Where the pairs of microphones stand, from the parameters that move them.
//!
//! A pair is moved as a whole, up and away from the drummer, and drawn apart along its own axis; all of it from where
//! it stands in the kit, so that untouched parameters leave every kit as it is, to the last bit.

use overhear_engine::kit::Microphone;
use overhear_engine::layout::Pair;

use crate::parameters::{Drives, Stand, parameters};

/// Index of the parameter that moves this of a pair.
///
/// # Real-time
/// A search through the table.
pub fn index_of(pair: Microphone, stand: Stand) -> Option<usize> {
    parameters().iter().position(|parameter| parameter.drives == Drives::Stand(pair, stand))
}

/// Places of a pair that usually stands there; `value` gives a parameter's value in its unit, by its index.
///
/// # Real-time
/// No allocation, no lock.
pub fn places(usual: Pair, pair: Microphone, value: &dyn Fn(usize) -> Option<f32>) -> Pair {
    let of = |stand: Stand, usual: f32| {
        let value = index_of(pair, stand).and_then(value).filter(|value| value.is_finite());
        f64::from(value.unwrap_or(usual))
    };
    let (up, away) = (of(Stand::Height, 0.0) / 100.0, of(Stand::Depth, 0.0) / 100.0);
    let wider = of(Stand::Width, 100.0) / 100.0 - 1.0;
    let moved = [0.0, up, away];
    std::array::from_fn(|side| {
        let (own, other) = (usual[side], usual[1 - side]);
        // Half the way between the two is where its own half ends.
        std::array::from_fn(|axis| own[axis] + wider * 0.5 * (own[axis] - other[axis]) + moved[axis])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use overhear_engine::kit_spec::{KitSpec, MicrophonesSpec};
    use overhear_engine::layout::distance;

    #[test]
    fn untouched_parameters_move_nothing_and_others_what_they_say() {
        let MicrophonesSpec { overheads, room } = KitSpec::standard().microphones;
        let default = |index: usize| Some(parameters()[index].default);
        assert_eq!(places(overheads, Microphone::Overheads, &default), overheads);
        assert_eq!(places(room, Microphone::Room, &default), room);
        let with = |stand: Stand, value: f32| {
            let moved = index_of(Microphone::Overheads, stand).unwrap();
            places(overheads, Microphone::Overheads, &|index| {
                Some(if index == moved { value } else { parameters()[index].default })
            })
        };
        let up = with(Stand::Height, 50.0);
        assert!((0..2).all(|side| (up[side][1] - overheads[side][1] - 0.5).abs() < 1e-9));
        assert!((0..2).all(|side| up[side][0] == overheads[side][0]));
        let wide = with(Stand::Width, 200.0);
        let apart = |pair: Pair| distance(&pair[0], &pair[1]);
        assert!((apart(wide) / apart(overheads) - 2.0).abs() < 1e-9);
        let middle = |pair: Pair| 0.5 * (pair[0][0] + pair[1][0]);
        assert!((middle(wide) - middle(overheads)).abs() < 1e-9);
    }
}
