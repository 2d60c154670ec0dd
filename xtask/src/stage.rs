//! `--place NAME=x,y,z`: where pieces and microphones stand.

use anyhow::Result;
use overhear_engine::layout::{FARTHEST, Layout, Point};
use overhear_engine::listening::ListeningPoint;
use overhear_engine::piece::PieceId;

use crate::bad_input;

/// A close microphone is no nearer than this to the middle of its piece, m, and stands before its struck side.
const NEAREST: f64 = 0.05;
const LOWEST: f64 = 1.4;

/// The kit's layout and its close microphones.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stage {
    /// Pieces and pairs of microphones.
    pub layout: Layout,
    /// `[piece]`: where a close microphone was put, m.
    close: [Option<Point>; PieceId::KIT.len()],
}

impl Stage {
    /// Reads places: `overheads` and `room` with six coordinates, left and right; a piece's name with three; and, with
    /// three, `PIECE-mic` for its close microphone.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) with what was given and what is accepted.
    pub fn parse(places: &[String]) -> Result<Stage> {
        let mut stage = Stage::default();
        for text in places {
            stage.put(text)?;
        }
        for id in PieceId::KIT {
            stage.check(id)?;
        }
        Ok(stage)
    }

    fn put(&mut self, text: &str) -> Result<()> {
        let wrong = |what: &str| {
            let names = PieceId::KIT.map(PieceId::name).join(", ");
            bad_input!(
                "`{text}` {what}, accepted: NAME=x,y,z in metres for {names}, each with -mic for its close \
                 microphone; NAME=x,y,z,x,y,z, left and right, for overheads, room"
            )
        };
        let (name, numbers) = text.split_once('=').ok_or_else(|| wrong("has no ="))?;
        let numbers: Option<Vec<f64>> = numbers.split(',').map(|number| number.trim().parse().ok()).collect();
        let numbers = numbers.ok_or_else(|| wrong("has a place that is no number"))?;
        if !numbers.iter().all(|x| x.abs() <= FARTHEST) {
            return Err(wrong(&format!("is farther than {FARTHEST} m")));
        }
        let (piece, microphone) = match name.strip_suffix("-mic") {
            Some(piece) => (piece, true),
            None => (name, false),
        };
        let slot = PieceId::from_name(piece).and_then(PieceId::slot);
        match (&numbers[..], name, slot) {
            (&[a, b, c, d, e, f], "overheads", _) => self.layout.overheads = [[a, b, c], [d, e, f]],
            (&[a, b, c, d, e, f], "room", _) => self.layout.room = [[a, b, c], [d, e, f]],
            (&[x, y, z], _, Some(slot)) if microphone => self.close[slot] = Some([x, y, z]),
            (&[x, y, z], _, Some(slot)) => self.layout.pieces[slot].centre = [x, y, z],
            _ => return Err(wrong("names nothing, or has not its number of coordinates")),
        }
        Ok(())
    }

    /// Where the close microphone of a piece was put, as it is seen from there.
    pub fn close(&self, id: PieceId) -> Option<ListeningPoint> {
        let slot = id.slot()?;
        self.close[slot].map(|place| self.layout.pieces[slot].sees(&place))
    }

    fn check(&self, id: PieceId) -> Result<()> {
        let Some(point) = self.close(id) else { return Ok(()) };
        if point.distance < NEAREST || point.inclination > LOWEST {
            return Err(bad_input!(
                "the close microphone of the {} is {:.2} m from its middle, {:.0} degrees from its axis, accepted: from \
                 {NEAREST} m on, up to {:.0} degrees, before its struck side",
                id.name(),
                point.distance,
                point.inclination.to_degrees(),
                LOWEST.to_degrees(),
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(texts: &[&str]) -> Result<Stage> {
        Stage::parse(&texts.iter().map(|text| (*text).to_owned()).collect::<Vec<_>>())
    }

    #[test]
    fn places_are_read_for_pieces_pairs_and_close_microphones() {
        let stage =
            parse(&["snare=0,0.7,-0.4", "overheads=-1,2,0,1,2,0", "floor-tom-mic=0.47,0.8,-0.34"]).unwrap();
        assert_eq!(stage.layout.pieces[1].centre, [0.0, 0.7, -0.4]);
        assert_eq!(stage.layout.overheads, [[-1.0, 2.0, 0.0], [1.0, 2.0, 0.0]]);
        let close = stage.close(PieceId::FloorTom).unwrap();
        assert!((close.distance - 0.18).abs() < 1e-9 && close.inclination < 1e-6);
        assert!(stage.close(PieceId::Kick).is_none());
        assert_eq!(parse(&[]).unwrap(), Stage::default());
    }

    #[test]
    fn places_that_are_none_are_refused_with_what_is_accepted() {
        for text in
            ["snare", "snare=1,2", "room=1,2,3", "gong=1,2,3", "snare=a,b,c", "kick=0,0,99", "snare=nan,0,0"]
        {
            let error = parse(&[text]).unwrap_err().to_string();
            assert!(error.contains(text) && error.contains("accepted"), "{error}");
        }
        // Under the floor tom.
        let error = parse(&["floor-tom-mic=0.47,0.3,-0.34"]).unwrap_err().to_string();
        assert!(error.contains("floor-tom") && error.contains("struck side"), "{error}");
    }
}
