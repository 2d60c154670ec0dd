//! What `hear` and `modes` change of a piece's description before they build it.

use anyhow::Result;
use clap::Args;
use overhear_engine::damping::Muffler;
use overhear_engine::drum::DrumSpec;
use overhear_engine::kit_spec::{Defaults, InstrumentSpec, KitSpec, PieceSpec};

use super::numbers::{angle, number};
use crate::bad_input;

/// Changes to a piece's description.
#[derive(Debug, Default, Args)]
pub struct Alterations {
    /// Turn all damping and radiation off
    #[arg(long)]
    pub lossless: bool,
    /// Switch tension modulation and mode coupling off
    #[arg(long)]
    pub linear: bool,
    /// Build perfectly round bodies, whose pairs of modes share one frequency
    #[arg(long)]
    pub unsplit: bool,
    /// Remove the resonant head, or the timpani's kettle
    #[arg(long)]
    pub open: bool,
    /// Tune a drum's resonant head to the batter head's pitch times this ratio, 0.5 to 2.5
    #[arg(long, value_name = "RATIO", value_parser = ratio)]
    pub resonant_ratio: Option<f64>,
    /// Uneven tension of a drum: mean relative difference between the two modes of a pair, up to .05
    #[arg(long, value_name = "SHARE", value_parser = unevenness)]
    pub uneven: Option<f64>,
    /// Muffling of a drum: pillow, gel, ring, or gel@R,DEG at a position
    #[arg(long, value_name = "MUFFLER", value_parser = muffler)]
    pub muffler: Option<Muffler>,
    /// Leave out the drum heads' sound above their complete sets of modes
    #[arg(long)]
    pub no_high_band: bool,
}

impl Alterations {
    /// The piece with everything changed that is asked for.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) naming what the piece does not have: a cymbal has no heads.
    pub fn apply(&self, mut piece: PieceSpec) -> Result<PieceSpec> {
        if let InstrumentSpec::Drum(drum) = piece.instrument {
            let drum = self.apply_to_drum(&piece.name, drum)?;
            // Without wires nothing presses on them.
            let preload = piece.defaults.preload.filter(|_| drum.wires.is_some());
            piece.instrument = InstrumentSpec::Drum(drum);
            piece.defaults = Defaults { preload, ..piece.defaults };
        } else if let Some(option) = self.of_drums() {
            return Err(bad_input!("{option} applies to drums; the {} is a cymbal", piece.name));
        }
        if self.lossless {
            piece = piece.lossless();
        }
        if self.linear {
            piece = piece.linear();
        }
        if self.unsplit {
            piece = piece.round();
        }
        piece.check().map_err(|error| bad_input!("the {}: {error}", piece.name))?;
        Ok(piece)
    }

    /// The first option asked for that only drums have.
    fn of_drums(&self) -> Option<&'static str> {
        let of_drums = [
            ("--open", self.open),
            ("--resonant-ratio", self.resonant_ratio.is_some()),
            ("--uneven", self.uneven.is_some()),
            ("--muffler", self.muffler.is_some()),
            ("--no-high-band", self.no_high_band),
        ];
        of_drums.into_iter().find(|&(_, asked)| asked).map(|(option, _)| option)
    }

    fn apply_to_drum(&self, name: &str, drum: DrumSpec) -> Result<DrumSpec> {
        let mut drum = if self.open { drum.opened() } else { drum };
        if let Some(ratio) = self.resonant_ratio {
            let resonant = drum.resonant.as_mut();
            let resonant =
                resonant.ok_or_else(|| bad_input!("--resonant-ratio: the {name} has no resonant head"))?;
            resonant.pitch_ratio = ratio;
        }
        if let Some(detuning) = self.uneven {
            drum.evenness.detuning = detuning;
        }
        if let Some(muffler) = self.muffler {
            drum.muffler = muffler;
        }
        drum.high_band &= !self.no_high_band;
        Ok(drum)
    }
}

fn ratio(text: &str) -> Result<f64, String> {
    number(text, 0.5, false, 2.5, " of the struck head's pitch")
}

fn unevenness(text: &str) -> Result<f64, String> {
    number(text, 0.0, false, 0.05, "")
}

/// `pillow`, `gel`, `ring` or `gel@R,DEG`.
fn muffler(text: &str) -> Result<Muffler, String> {
    const ACCEPTED: &str = "accepted: pillow, gel, ring, gel@R,DEG as in gel@.7,90";
    match (text, Muffler::GEL) {
        ("pillow", _) => pillow().ok_or_else(|| ACCEPTED.to_owned()),
        ("gel", gel) => Ok(gel),
        ("ring", _) => Ok(Muffler::RING),
        (place, Muffler::Gel { sigma, .. }) => {
            let place = place.strip_prefix("gel@").and_then(|place| place.split_once(','));
            let (radius, degrees) = place.ok_or(ACCEPTED)?;
            let radius = number(radius, 0.0, false, 0.99, " of the radius")?;
            Ok(Muffler::Gel { sigma, radius, angle: angle(degrees)?.to_radians() })
        }
        _ => Err(ACCEPTED.to_owned()),
    }
}

/// The pillow of the standard kit.
fn pillow() -> Option<Muffler> {
    let kit = KitSpec::standard();
    let mut mufflers = kit.drums().map(|(_, drum)| drum.muffler);
    mufflers.find(|muffler| matches!(muffler, Muffler::Pillow { .. }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn altered(name: &str, alterations: &Alterations) -> Result<PieceSpec> {
        alterations.apply(KitSpec::standard().find(name).unwrap().1.clone())
    }

    #[test]
    fn without_options_every_piece_stays_as_it_is() {
        for piece in KitSpec::standard().pieces {
            assert_eq!(Alterations::default().apply(piece.clone()).unwrap(), piece);
        }
    }

    #[test]
    fn an_opened_snare_has_neither_wires_nor_what_presses_them_on() {
        let snare = altered("snare", &Alterations { open: true, ..Alterations::default() }).unwrap();
        let drum = snare.drum().unwrap();
        assert!(drum.resonant.is_none() && drum.wires.is_none() && snare.defaults.preload.is_none());
    }

    #[test]
    fn what_a_piece_has_not_is_refused_by_its_name() {
        let open = Alterations { open: true, ..Alterations::default() };
        let error = altered("ride", &open).unwrap_err().to_string();
        assert_eq!(error, "--open applies to drums; the ride is a cymbal");
        let ratio = Alterations { resonant_ratio: Some(1.2), ..Alterations::default() };
        assert!(altered("timpani", &ratio).unwrap_err().to_string().contains("no resonant head"));
        assert!(altered("kick", &Alterations { open: true, ..ratio }).is_err());
    }

    #[test]
    fn mufflers_are_read_and_refused() {
        assert!(matches!(muffler("pillow"), Ok(Muffler::Pillow { .. })));
        assert_eq!(muffler("ring"), Ok(Muffler::RING));
        assert!(matches!(muffler("gel@.7,90"), Ok(Muffler::Gel { radius: 0.7, .. })));
        for text in ["", "towel", "gel@", "gel@2,0", "gel@.5"] {
            assert!(muffler(text).unwrap_err().contains("accepted"), "{text}");
        }
    }
}
