//! `--place NAME=x,y,z`: positions of pieces and microphones.

use anyhow::Result;
use overhear_engine::kit_spec::{KitSpec, PieceSpec};
use overhear_engine::layout::{FARTHEST, Point};

use crate::bad_input;

/// A close microphone is no nearer than this to the middle of its piece, m, and stands before its struck side.
const NEAREST: f64 = 0.05;
const LOWEST: f64 = 1.4;

/// The kit with pieces and microphones put in places: `overheads` and `room` with six coordinates, left and right; a
/// piece's name with three; and, with three, `PIECE-mic` for its close microphone.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) with what was given and what is accepted.
pub fn place(mut kit: KitSpec, places: &[String]) -> Result<KitSpec> {
    // A piece may be moved after its microphone was placed.
    let mut microphones = Vec::new();
    for text in places {
        put(&mut kit, text, &mut microphones)?;
    }
    for (at, point) in microphones {
        put_close(&mut kit.pieces[at], &point)?;
    }
    kit.check().map_err(|error| bad_input!("{error}"))?;
    Ok(kit)
}

fn put(kit: &mut KitSpec, text: &str, microphones: &mut Vec<(usize, Point)>) -> Result<()> {
    let names = kit.pieces.iter().map(|piece| &*piece.name).collect::<Vec<_>>().join(", ");
    let wrong = |what: &str| {
        bad_input!(
            "`{text}` {what}, accepted: NAME=x,y,z in metres for {names}, each with -mic for its close microphone; \
             NAME=x,y,z,x,y,z, left and right, for overheads, room"
        )
    };
    let (name, numbers) = text.split_once('=').ok_or_else(|| wrong("has no ="))?;
    let numbers: Option<Vec<f64>> = numbers.split(',').map(|number| number.trim().parse().ok()).collect();
    let numbers = numbers.ok_or_else(|| wrong("has a coordinate that is not a number"))?;
    if !numbers.iter().all(|x| x.abs() <= FARTHEST) {
        return Err(wrong(&format!("is farther than {FARTHEST} m")));
    }
    let find = |name: &str| kit.pieces.iter().position(|piece| piece.name == name);
    // A piece whose own name ends like a microphone's is the piece.
    let microphone = || find(name.strip_suffix("-mic")?);
    match (&numbers[..], name, find(name), microphone()) {
        (&[a, b, c, d, e, f], "overheads", ..) => kit.microphones.overheads = [[a, b, c], [d, e, f]],
        (&[a, b, c, d, e, f], "room", ..) => kit.microphones.room = [[a, b, c], [d, e, f]],
        (&[x, y, z], _, Some(at), _) => kit.pieces[at].place.centre = [x, y, z],
        (&[x, y, z], _, None, Some(at)) => microphones.push((at, [x, y, z])),
        _ => return Err(wrong("names nothing known, or has a wrong number of coordinates")),
    }
    Ok(())
}

/// Puts the close microphone of a piece at a point, m.
fn put_close(piece: &mut PieceSpec, point: &Point) -> Result<()> {
    let seen = piece.placement().sees(point);
    if seen.distance < NEAREST || seen.inclination > LOWEST {
        return Err(bad_input!(
            "the close microphone of the {} is {:.2} m from its middle, {:.0} degrees from its axis, accepted: from \
             {NEAREST} m on, up to {:.0} degrees, before its struck side",
            piece.name,
            seen.distance,
            seen.inclination.to_degrees(),
            LOWEST.to_degrees(),
        ));
    }
    piece.close = piece.close.moved_to(seen, piece.instrument.radius());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(texts: &[&str]) -> Result<KitSpec> {
        place(KitSpec::standard(), &texts.iter().map(|text| (*text).to_owned()).collect::<Vec<_>>())
    }

    #[test]
    fn places_are_read_for_pieces_pairs_and_close_microphones() {
        let kit =
            placed(&["snare=0,0.7,-0.4", "overheads=-1,2,0,1,2,0", "floor-tom-mic=0.47,0.8,-0.34"]).unwrap();
        assert_eq!(kit.find("snare").unwrap().1.place.centre, [0.0, 0.7, -0.4]);
        assert_eq!(kit.microphones.overheads, [[-1.0, 2.0, 0.0], [1.0, 2.0, 0.0]]);
        let tom = kit.find("floor-tom").unwrap().1;
        let close = tom.close.point(tom.instrument.radius());
        assert!((close.distance - 0.18).abs() < 1e-9 && close.inclination < 1e-6);
        let standard = KitSpec::standard();
        assert_eq!(kit.find("kick"), standard.find("kick"));
        assert_eq!(placed(&[]).unwrap(), standard);
    }

    #[test]
    fn a_microphone_stands_where_it_was_put_whenever_its_piece_was_moved() {
        let texts = ["crash-mic=-0.6,1.7,0.1", "crash=-0.64,1.3,0"];
        let [before, after] = [texts, [texts[1], texts[0]]].map(|texts| placed(&texts).unwrap());
        assert_eq!(before, after);
    }

    #[test]
    fn places_that_are_none_are_refused_with_what_is_accepted() {
        for text in
            ["snare", "snare=1,2", "room=1,2,3", "gong=1,2,3", "snare=a,b,c", "kick=0,0,99", "snare=nan,0,0"]
        {
            let error = placed(&[text]).unwrap_err().to_string();
            assert!(error.contains(text) && error.contains("accepted"), "{error}");
        }
        // Under the floor tom.
        let error = placed(&["floor-tom-mic=0.47,0.3,-0.34"]).unwrap_err().to_string();
        assert!(error.contains("floor-tom") && error.contains("struck side"), "{error}");
        // In the kick.
        let error = placed(&["floor-tom=0,0.3,-0.1"]).unwrap_err().to_string();
        assert!(error.contains("accepted"), "{error}");
    }
}
