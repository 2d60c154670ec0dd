//! The room about the kit: early reflections and a diffuse tail, for the room microphones.
//!
//! Model: a shoebox. Each of its six surfaces mirrors every piece once (image sources: the ways from the images are
//! [`DelayTap`](super::delay_line::DelayTap)s like any other, weakened by what the surface swallows). What comes after is diffuse
//! and is left to the [tail], which knows of the room its volume, its mean free way and its reverberation time by octave.
//!
//! Source: Kuttruff, Room Acoustics, ch. 4, 5.

mod losses;
mod tail;

use crate::kit_spec::room::RoomSpec;
use crate::layout::Point;

pub(super) use tail::Tail;

/// Mirror images of a place in the room's surfaces, and the share of the pressure each sends back.
pub(super) fn images(room: &RoomSpec, source: &Point) -> [(Point, f64); 6] {
    std::array::from_fn(|i| {
        let (axis, side) = (i / 2, i % 2);
        let mut image = *source;
        image[axis] = 2.0 * room.corners[side][axis] - image[axis];
        (image, room.reflected[axis][side])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_is_as_far_behind_its_wall_as_the_source_is_before_it() {
        let images = images(&RoomSpec::STANDARD, &[0.5, 1.0, 1.0]);
        assert_eq!(images[2].0, [0.5, -1.0, 1.0]);
        assert!((images[1].0[0] - 6.9).abs() < 1e-12);
    }
}
