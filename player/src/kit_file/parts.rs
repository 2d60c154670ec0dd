//! Parts of a piece chosen from the library's lists: heads, shells, hoops, wires, metals.

use overhear_engine::kit_spec::{InstrumentSpec, KitSpec, PieceSpec};
use toml::{Table, Value};

use super::catalogue;
use super::drafts::Draft;
use super::laying::{NONE, lay_over};
use super::pieces;
use super::source::Origins;
use super::text;

/// A part that a piece has, or can do without.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// What it is called on screen.
    pub label: &'static str,
    /// Where it stands among the piece's fields.
    path: &'static [&'static str],
    /// The list that it is chosen from.
    kind: &'static str,
    /// Whether the piece can do without it.
    pub optional: bool,
}

/// A part of the library.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Made {
    /// What kit files call it.
    pub name: &'static str,
    /// What it is, in a few words.
    pub title: &'static str,
}

const fn part(label: &'static str, path: &'static [&'static str], kind: &'static str) -> Part {
    Part { label, path, kind, optional: false }
}

const fn optional(label: &'static str, path: &'static [&'static str], kind: &'static str) -> Part {
    Part { label, path, kind, optional: true }
}

/// Parts of a drum, of a cymbal, of a hi-hat.
const BATTER: Part = part("Batter head", &["batter"], "heads");
const RESONANT: Part = optional("Resonant head", &["resonant"], "heads");
const SHELL: Part = optional("Shell", &["shell", "wall"], "walls");
const HOOP: Part = optional("Hoops", &["hoop"], "hoops");
const WIRES: Part = optional("Wires", &["wires"], "wires");
const ALLOY: Part = part("Alloy", &["alloy"], "alloys");
const HATS: [Part; 2] =
    [part("Top alloy", &["top", "alloy"], "alloys"), part("Bottom alloy", &["bottom", "alloy"], "alloys")];

/// What a head has that is woven.
const MESH: &str = "mesh";

/// The parts of a piece that can be chosen.
pub fn of(piece: &PieceSpec) -> Vec<Part> {
    use overhear_engine::drum::spec::ShellSpec;
    match &piece.instrument {
        InstrumentSpec::Drum(drum) => match drum.shell {
            Some(ShellSpec::Cylinder { .. }) => vec![BATTER, RESONANT, SHELL, HOOP, WIRES],
            _ => vec![BATTER, HOOP],
        },
        InstrumentSpec::Cymbal(_) => vec![ALLOY],
        InstrumentSpec::HiHat(_) => HATS.to_vec(),
    }
}

impl Part {
    /// What it can be chosen from.
    pub fn choices(&self) -> Vec<Made> {
        let made = |(name, fields): (&'static String, &'static Value)| {
            let about = fields.get("about").and_then(Value::as_str).unwrap_or(name);
            Made { name: name.as_str(), title: about.split(':').next().unwrap_or(about) }
        };
        let known = catalogue::parts(self.kind).iter();
        // Air between two heads would escape through a mesh, and a mesh below a film is no use.
        known.filter(|(_, fields)| *self != RESONANT || fields.get(MESH).is_none()).map(made).collect()
    }

    /// Whether a piece has it.
    pub fn is_there(&self, piece: &PieceSpec) -> bool {
        self.found(&text::fields(piece)).is_some()
    }

    /// Which of the library's it is, if it is one of them.
    pub fn chosen(&self, piece: &PieceSpec) -> Option<&'static str> {
        let fields = text::fields(piece);
        let own = self.found(&fields)?;
        let known = catalogue::parts(self.kind).keys();
        known
            .filter_map(|name| Some((name, catalogue::part(self.kind, name)?)))
            .find_map(|(name, made)| agrees(own, &made).then_some(name.as_str()))
    }

    fn found<'a>(&self, fields: &'a Table) -> Option<&'a Table> {
        let mut table = fields;
        for key in self.path {
            table = table.get(*key)?.as_table()?;
        }
        Some(table)
    }

    /// The piece with this part from the library, or without it.
    ///
    /// # Errors
    /// A line on what does not fit.
    pub fn fitted(&self, piece: &PieceSpec, name: Option<&str>) -> Result<PieceSpec, String> {
        let mut changes = Table::new();
        match name {
            None => changes.insert("like".to_owned(), Value::String(NONE.to_owned())),
            Some(name) => {
                let made = catalogue::part(self.kind, name);
                changes = made.ok_or_else(|| format!("{name} is not in the library"))?;
                None
            }
        };
        let mut fields = text::fields(piece);
        let missing = self.found(&fields).is_none();
        let (last, way) = self.path.split_last().ok_or("a part has no place")?;
        let mut table = &mut fields;
        for key in way {
            let inner = table.get_mut(*key).and_then(Value::as_table_mut);
            table = inner.ok_or_else(|| format!("{} has no {key}", piece.title))?;
        }
        if name.is_none() {
            table.remove(*last);
        } else {
            if missing {
                table.insert((*last).to_owned(), Value::Table(self.usual()));
            }
            lay_over(table, Table::from_iter([((*last).to_owned(), Value::Table(changes))]));
        }
        // Nothing is stretched below a mesh. Wires need a force that presses them on, and a head to lie against; a vent needs a shell
        // that is closed.
        let mesh = *self == BATTER && self.found(&fields).is_some_and(|head| head.contains_key(MESH));
        if mesh {
            fields.remove("resonant");
        }
        if mesh || *self == RESONANT && name.is_none() {
            fields.remove("wires");
            let shell = fields.get_mut("shell").and_then(Value::as_table_mut);
            shell.and_then(|shell| shell.remove("vent_diameter_m"));
        }
        preload(&mut fields);
        let draft = Draft { name: piece.name.clone(), fields, is_kept: true, beside: Table::new() };
        pieces::read(&draft, &Origins::default()).map_err(|fault| fault.reason)
    }

    /// What the part is beside what the library says: that of the first piece of the standard kit which has one.
    fn usual(&self) -> Table {
        let standard = KitSpec::standard();
        let of_piece = |piece: &PieceSpec| self.found(&text::fields(piece)).cloned();
        standard.pieces.iter().rev().find_map(of_piece).unwrap_or_default()
    }
}

/// Whether a table has all that another says, and not what that takes away.
fn agrees(own: &Table, made: &Table) -> bool {
    let number = |value: &Value| value.as_float().or(value.as_integer().map(|whole| whole as f64));
    made.iter().all(|(key, made)| match (own.get(key), made) {
        (Some(Value::Table(own)), Value::Table(made)) => agrees(own, made),
        (Some(own), made) => own == made || number(own).is_some_and(|own| Some(own) == number(made)),
        (None, made) => made.as_str() == Some(NONE),
    })
}

/// Gives a piece with wires the force that presses them on, and takes it from one without.
fn preload(fields: &mut Table) {
    const FORCE: &str = "preload_n";
    let wires = fields.contains_key("wires");
    let Some(Value::Table(defaults)) = fields.get_mut("defaults") else { return };
    if !wires {
        defaults.remove(FORCE);
    } else if !defaults.contains_key(FORCE) {
        let standard = KitSpec::standard();
        if let Some(force) = standard.pieces.iter().find_map(|piece| piece.defaults.preload) {
            defaults.insert(FORCE.to_owned(), Value::Float(force));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn standard(name: &str) -> PieceSpec {
        KitSpec::standard().find(name).unwrap().1.clone()
    }

    #[test]
    fn every_part_of_every_list_can_be_fitted_and_is_found_again() {
        let kit = KitSpec::standard();
        let mut fitted = 0;
        for piece in &kit.pieces {
            for part in of(piece) {
                for made in part.choices() {
                    let with = part.fitted(piece, Some(made.name)).unwrap();
                    assert_eq!(part.chosen(&with), Some(made.name), "{} of {}", part.label, piece.name);
                    assert!(!made.title.is_empty());
                    fitted += 1;
                }
                if part.optional {
                    let without = part.fitted(piece, None).unwrap();
                    assert!(!part.is_there(&without));
                    assert_eq!(without.check(), Ok(()), "{} without {}", piece.name, part.label);
                }
            }
        }
        assert!(fitted > 100, "{fitted}");
    }

    #[test]
    fn an_ordinary_head_takes_the_dot_away() {
        let snare = standard("snare");
        let dotted = BATTER.fitted(&snare, Some("coated-10-dot")).unwrap();
        assert!(dotted.drum().unwrap().batter.dot.is_some());
        assert_eq!(BATTER.chosen(&dotted), Some("coated-10-dot"));
        let plain = BATTER.fitted(&dotted, Some("coated-10")).unwrap();
        assert_eq!(plain.drum().unwrap().batter.dot, None);
        assert_eq!(BATTER.chosen(&plain), Some("coated-10"));
    }

    #[test]
    fn no_two_of_a_list_are_called_alike() {
        for part in [BATTER, RESONANT, SHELL, HOOP, WIRES, ALLOY] {
            let mut titles: Vec<_> = part.choices().iter().map(|made| made.title).collect();
            let count = titles.len();
            titles.sort_unstable();
            titles.dedup();
            assert_eq!(titles.len(), count, "{titles:?}");
        }
    }

    #[test]
    fn a_mesh_takes_the_head_below_and_its_wires_away() {
        let snare = standard("snare");
        let woven = BATTER.fitted(&snare, Some("mesh")).unwrap();
        let drum = woven.drum().unwrap();
        assert!(drum.batter.mesh.is_some() && drum.resonant.is_none() && drum.wires.is_none());
        assert!(woven.defaults.preload.is_none() && woven.check() == Ok(()));
        assert_eq!(BATTER.chosen(&woven), Some("mesh"));
        let below = RESONANT.fitted(&woven, Some("snare-side-3")).unwrap();
        let refused = below.check().unwrap_err().to_string();
        assert!(refused.contains("none under a mesh"), "{refused}");
        assert!(RESONANT.choices().iter().all(|made| !made.name.starts_with(MESH)));
        let plain = BATTER.fitted(&woven, Some("coated-10")).unwrap();
        assert_eq!(plain.drum().unwrap().batter.mesh, None);
    }

    #[test]
    fn wires_come_with_their_force_and_go_with_the_head_that_they_lie_against() {
        let tom = standard("rack-tom");
        let rattling = WIRES.fitted(&tom, Some("strands-12")).unwrap();
        assert!(rattling.defaults.preload.is_some() && rattling.check() == Ok(()));
        assert_eq!(WIRES.fitted(&rattling, None).unwrap(), tom);
        let open = RESONANT.fitted(&standard("snare"), None).unwrap();
        assert!(open.drum().unwrap().wires.is_none() && open.defaults.preload.is_none());
    }
}
