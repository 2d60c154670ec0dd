//! What a drum's description has to keep to beyond the range of each number.

use crate::contact::Material;
use crate::drum::lugs::{self, LugsSpec};
use crate::error::SpecError;
use crate::membrane::MembraneSpec;
use crate::numbers;
use crate::rim::HoopSpec;

use super::{DrumSpec, HeadSpec, LOWEST_PITCH_HZ, NARROWEST, ShellSpec};

/// Largest share of what pulls a head back that may be its own stiffness, at the lowest pitch: more, and it is a plate.
const MOST_BENDING: f64 = 0.5;

/// Least tension of a head between its lugs, over the mean, after twice what else is drawn of it. *Judgement*: far from where modes would not be held.
const SLACKEST: f64 = 0.3;

/// Strain that films hold.
const STRONGEST_STRAIN: f64 = 0.03;

impl DrumSpec {
    /// Checks every number and that the parts fit each other.
    ///
    /// # Errors
    /// [`SpecError`] naming the field.
    pub fn check(&self) -> Result<(), SpecError> {
        numbers::check(self)?;
        self.check_lugs()?;
        SpecError::check("batter.plies", f64::from(self.batter.plies), 1.0, 2.0)?;
        if let Some(resonant) = self.resonant {
            SpecError::check("resonant.plies", f64::from(resonant.plies), 1.0, 2.0)?;
            if !matches!(self.shell, Some(ShellSpec::Cylinder { .. })) {
                return Err(SpecError::refused(
                    "resonant",
                    "is given, accepted: only on a shell that is a cylinder",
                ));
            }
            if self.batter.mesh.is_some() {
                return Err(SpecError::refused(
                    "resonant",
                    "is given, accepted: none under a mesh, through which the air between the heads escapes",
                ));
            }
        } else if self.wires.is_some() {
            return Err(SpecError::refused(
                "wires",
                "are given, accepted: only with a resonant head to lie against",
            ));
        }
        self.check_vent()?;
        self.check_pitches()
    }

    /// A vent is in what two heads close, or a kettle.
    fn check_vent(&self) -> Result<(), SpecError> {
        match self.shell {
            Some(ShellSpec::Cylinder { vent_diameter: Some(_), .. }) if self.resonant.is_none() => {
                Err(SpecError::refused(
                    "shell.vent_diameter_m",
                    "is given, accepted: only with a resonant head, as the shell is open without one",
                ))
            }
            _ => Ok(()),
        }
    }

    /// No head is slack between the lugs.
    fn check_lugs(&self) -> Result<(), SpecError> {
        let Some(lugs) = self.lugs else { return Ok(()) };
        let [fewest, most] = LugsSpec::COUNT;
        SpecError::check("lugs.count", f64::from(lugs.count), f64::from(fewest), f64::from(most))?;
        let hoop = self.hoop.unwrap_or(HoopSpec::OUT_OF_REACH);
        let heads = [Some(self.batter), self.resonant.map(|head| head.head())].into_iter().flatten();
        let films: Vec<MembraneSpec> = heads.map(|head| self.membrane(&head)).collect();
        let drawn = 2.0 * self.tension_field.map_or(0.0, |field| field.rms);
        let least = |lugs: &LugsSpec| {
            let tensions =
                films.iter().zip(0..).map(|(film, head)| lugs::least_tension(lugs, &hoop, film, head));
            tensions.fold(f64::INFINITY, f64::min) - drawn
        };
        let holds = |lugs: LugsSpec| least(&lugs) >= SLACKEST;
        if holds(lugs) {
            return Ok(());
        }
        let slack = format!("with which a head would have {:.2} of its mean tension somewhere", least(&lugs));
        if holds(LugsSpec { rms: 0.0, ..lugs }) {
            let (mut works, mut fails) = (0.0, lugs.rms);
            for _ in 0..30 {
                let rms = 0.5 * (works + fails);
                if holds(LugsSpec { rms, ..lugs }) { works = rms } else { fails = rms }
            }
            let works = (1e3 * works).floor() / 1e3;
            let reason = format!("is {}, {slack}, accepted: up to {works}", lugs.rms);
            return Err(SpecError::refused("lugs.rms", reason));
        }
        let enough = (lugs.count..=most).find(|&count| holds(LugsSpec { count, ..lugs }));
        let accepted = enough.map_or("a stiffer hoop".to_owned(), |count| count.to_string());
        let reason = format!("is {}, {slack}, accepted: {accepted}", lugs.count);
        Err(SpecError::refused("lugs.count", reason))
    }

    /// No head is pulled beyond what its film holds at the highest pitch, and each has to be pulled at the lowest. What is said to be
    /// accepted is what all heads accept.
    fn check_pitches(&self) -> Result<(), SpecError> {
        let DrumSpec { lowest_pitch_hz: lowest, pitch_hz: pitch, highest_pitch_hz: highest, .. } = *self;
        let limits = |name: &'static str, head: &HeadSpec, ratio| {
            let [least, most] = self.pitches_of(head, ratio);
            (name, head.thickness, least, most)
        };
        let batter = limits("batter", &self.batter, 1.0);
        let resonant =
            self.resonant.map_or(batter, |head| limits("resonant", &head.head(), head.pitch_ratio));
        let (stiff, thickness, least, _) = if resonant.2 > batter.2 { resonant } else { batter };
        let (weak, .., most) = if resonant.3 < batter.3 { resonant } else { batter };
        if lowest >= least && highest <= most {
            return Ok(());
        }
        // Limits are told in tenths, rounded inward: what is told is accepted.
        let [up, down] = [|hz: f64| (10.0 * hz).ceil() / 10.0, |hz: f64| (10.0 * hz).floor() / 10.0];
        let reach = down(most.min(NARROWEST * LOWEST_PITCH_HZ.end()));
        if up(NARROWEST * up(least)) > reach {
            // A film's lowest pitch is in proportion to its thickness; the highest of the other does not depend on it.
            let wanted = lowest.min(down(reach / NARROWEST - 0.1));
            let thickest = (1e6 * thickness * wanted / least).floor() / 1e6;
            let most = down(most);
            let with = Self::following(
                [
                    ("lowest_pitch_hz", lowest, wanted),
                    ("pitch_hz", pitch, most),
                    ("highest_pitch_hz", highest, most),
                ],
                |value, needed| value > needed,
                |needed| format!("up to {needed:.1}"),
            );
            return Err(SpecError::refused(
                &format!("{stiff}.thickness_m"),
                format!(
                    "is {thickness}, held by its stiffness more than by its tension up to {reach:.1} Hz, accepted: up to {thickest:.6}{with}"
                ),
            ));
        }
        if lowest < least {
            let least = up(least);
            let with = Self::following(
                [("pitch_hz", pitch, least), ("highest_pitch_hz", highest, up(NARROWEST * least))],
                |value, needed| value < needed,
                |needed| format!("{needed:.1} or more"),
            );
            return Err(SpecError::refused(
                "lowest_pitch_hz",
                format!(
                    "is {lowest}, at which the {stiff} head would be held by its stiffness more than by its tension, accepted: {least:.1} or more{with}"
                ),
            ));
        }
        let strain = STRONGEST_STRAIN * (highest / most).powi(2);
        let most = down(most);
        let with = Self::following(
            [("pitch_hz", pitch, most), ("lowest_pitch_hz", lowest, down(most / NARROWEST))],
            |value, needed| value > needed,
            |needed| format!("up to {needed:.1}"),
        );
        Err(SpecError::refused(
            "highest_pitch_hz",
            format!(
                "is {highest}, at which the {weak} head would be strained by {:.1} %, accepted: up to {most:.1}{with}",
                100.0 * strain
            ),
        ))
    }

    /// What else has to change with a pitch that is refused: the name, the present value and the needed one of each.
    fn following<const N: usize>(
        pitches: [(&str, f64, f64); N],
        wrong: impl Fn(f64, f64) -> bool,
        said: impl Fn(f64) -> String,
    ) -> String {
        let wrong = pitches.into_iter().filter(|(_, value, needed)| wrong(*value, *needed));
        wrong.map(|(name, _, needed)| format!(", with {name} {}", said(needed))).collect()
    }

    /// Lowest and highest pitch of the drum, Hz, at which a head whose own is in that ratio to it is still held by its tension and
    /// not torn.
    fn pitches_of(&self, head: &HeadSpec, ratio: f64) -> [f64; 2] {
        let (m, n) = self.pitch_of.mode();
        let membrane = self.membrane(head);
        let zero = crate::math::bessel::zero(m, n);
        let bending = membrane.moved(m, zero).1 * (zero / membrane.radius).powi(2);
        let Material { youngs_modulus, poisson_ratio, .. } = head.material;
        let strongest = STRONGEST_STRAIN * youngs_modulus * head.thickness / (1.0 - poisson_ratio);
        // Without the air, which makes it need more. Tension goes with the square of the frequency.
        let at_one_hertz = crate::membrane::vacuum_tension(&membrane, (m, zero), ratio);
        [bending / MOST_BENDING, strongest].map(|tension| (tension / at_one_hertz).sqrt())
    }
}
