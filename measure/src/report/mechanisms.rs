//! What does what in a drum and about it: each mechanism taken away from the standard kit by itself, and what then becomes of the
//! sound.

use std::sync::{Mutex, PoisonError};

use anyhow::{Context, Result};
use overhear::building::Pace;
use overhear::kit_document::KitDocument;
use overhear::midi_map::NoteTable;
use overhear::parameters::parse_assignment;
use overhear_engine::drum::{DrumSpec, HeadContact, ResonantSpec, ShellSpec};
use overhear_engine::kit_spec::{Defaults, KitSpec, PieceSpec};
use overhear_engine::piece::{BuildOptions, Piece};
use overhear_engine::strike::{Strike, Striker};
use rayon::prelude::*;

use super::page::bodies::PLAYED;
use super::page::{Page, Sheet};
use crate::analysis::{OneShot, line_share};
use crate::realism::features::{self, Feature};
use crate::realism::{self, SPEEDS, SUBJECTS, Subject};
use crate::{alone, altered, hear, settings, spec};

const RATE: f64 = 48_000.0;

/// Recorded length, s.
const SECONDS: f64 = 2.0;

/// What is measured of a stroke beside its lines, and how it is headed.
const FIGURES: [(Feature, &str); 10] = [
    (Feature::Click, "click, dB"),
    (Feature::Decay125, "T60 at 125 Hz, s"),
    (Feature::Decay500, "500 Hz"),
    (Feature::Decay1k, "1 kHz"),
    (Feature::Decay2k, "2 kHz"),
    (Feature::Decay4k, "4 kHz"),
    (Feature::Energy300, "0.3 to 1 kHz, dB"),
    (Feature::Energy1k, "1 to 3 kHz"),
    (Feature::Energy3k, "3 to 8 kHz"),
    (Feature::Energy8k, "above 8 kHz"),
];

/// Without the shell's wall, which only strokes on the hoop meet.
const SILENT: &str = "a shell that is silent";

/// A mechanism, and the piece without it; the same piece if it does not have it.
type Mechanism = (&'static str, fn(PieceSpec) -> PieceSpec);

/// Without what a stretched head hands to its short waves, which no description names.
const UNSCATTERED: &str = "nothing scattered";

/// All that can be taken away from a description.
const MECHANISMS: [Mechanism; 10] = [
    ("even heads", |piece| altered(piece, |drum| DrumSpec { tension_field: None, ..drum })),
    ("edges that do not yield", |piece| altered(piece, |drum| DrumSpec { edge: None, ..drum })),
    ("nothing above the modes", |piece| altered(piece, |drum| DrumSpec { high_band: false, ..drum })),
    ("one disc for every stroke", |piece| {
        altered(piece, |drum| DrumSpec { contact: HeadContact::FixedDisc, ..drum })
    }),
    ("heads that do not stretch", |mut piece| {
        piece.ideal.linear = true;
        piece
    }),
    ("no port", |piece| {
        altered(piece, |drum| {
            let resonant = drum.resonant.map(|head| ResonantSpec { port_diameter: None, ..head });
            DrumSpec { resonant, ..drum }
        })
    }),
    ("no muffling", |piece| PieceSpec { defaults: Defaults { muffle: 0.0, ..piece.defaults }, ..piece }),
    ("no wires", |piece| altered(piece, |drum| DrumSpec { wires: None, ..drum })),
    (SILENT, |piece| altered(piece, silent)),
    ("one head", |piece| altered(piece, DrumSpec::opened)),
];

/// A mechanism about the drums: the assignment of a parameter that takes it away, or nothing, and the kit without it.
type About = (&'static str, &'static str, fn(KitSpec, &Subject) -> KitSpec);

/// All that can be taken away about a drum.
const ABOUT: [About; 6] = [
    (AS_PLAYED, "", |kit, _| kit),
    ("no room microphones", "room_level=-inf", |kit, _| kit),
    ("walls that send nothing back", "", |mut kit, _| {
        kit.room.reflected = [[0.0; 2]; 3];
        kit
    }),
    ("a reverberation of 0.05 s", "", |mut kit, _| {
        kit.room.time = 0.05;
        kit
    }),
    ("no sympathetic resonance", "sympathetic_resonance=off", |kit, _| kit),
    ("no other pieces", "", |mut kit, subject| {
        kit.pieces.retain(|piece| piece.name == subject.piece);
        kit
    }),
];

/// The row of everything.
const AS_PLAYED: &str = "as played";

/// A drum whose shell does not sound.
fn silent(drum: DrumSpec) -> DrumSpec {
    let shell = drum.shell.map(|shell| match shell {
        ShellSpec::Cylinder { depth, air_q, vent_diameter, .. } => {
            ShellSpec::Cylinder { depth, air_q, vent_diameter, wall: None }
        }
        kettle => kettle,
    });
    DrumSpec { shell, ..drum }
}

/// The page.
///
/// # Errors
/// If a drum cannot be built.
pub fn page() -> Result<Page> {
    let mut sheet = Sheet::new(
        "mechanisms",
        "Mechanisms of drums",
        PLAYED,
        "Each mechanism of the kit's drums is taken away by itself. Each drum stands alone and is heard at its close microphone, as the mean of nine strokes: 1.5, 4 and\n\
         8 m/s at the three places of [the comparison with recordings](realism.md); strokes on the hoop at one place. `lines` is the share of the energy from 1 to 10 kHz that is in\n\
         lines; all figures are those of [commands.md](../commands.md#realism). The random field of tension moves shares in lines by some hundredths: it is the same in every row\n\
         that has one. Energy is of the whole sound's. In the mix each drum stands in the kit, with the plugin's defaults, and what is about it is taken away.",
    );
    for subject in SUBJECTS.iter().filter(|subject| spec(subject.piece).drum().is_some()) {
        let strikes = strikes(subject)?;
        table(&mut sheet, subject.name, &spec(subject.piece), &strikes)?;
    }
    for (title, striker) in
        [("snare, rimshot", Striker::RimShot), ("snare, cross-stick", Striker::CrossStick)]
    {
        let strikes = SPEEDS.map(|speed| Strike { speed, radius: 0.35, angle: 0.3, striker });
        table(&mut sheet, title, &spec("snare"), &strikes)?;
    }
    for subject in SUBJECTS.iter().filter(|subject| spec(subject.piece).drum().is_some()) {
        sheet.heading(&format!("{}, in the mix", subject.name));
        let rows = ABOUT.iter().map(|about| row_in_the_mix(about, subject));
        sheet.table(&head(), rows.collect::<Result<Vec<_>>>()?);
    }
    Ok(sheet.finish())
}

/// The strokes on a drum: every speed at every place.
fn strikes(subject: &Subject) -> Result<Vec<Strike>> {
    let document = KitDocument::standard();
    let (slot, _) = settings::piece(&document.kit, subject.piece)?;
    let strike = subject.strike(&document, slot);
    let places = SPEEDS.iter().flat_map(|&speed| subject.places.map(|radius| (speed, radius)));
    Ok(places.map(|(speed, radius)| Strike { speed, radius, ..strike }).collect())
}

/// A row with all mechanisms, and one without each that the strokes meet.
fn table(sheet: &mut Sheet, title: &str, piece: &PieceSpec, strikes: &[Strike]) -> Result<()> {
    let hoop = [Striker::RimShot, Striker::CrossStick];
    let on_hoop = strikes.iter().any(|strike| hoop.contains(&strike.striker));
    let without = MECHANISMS.iter().map(|(name, take)| (*name, take(piece.clone())));
    let variants: Vec<(&str, PieceSpec)> = [AS_PLAYED, UNSCATTERED]
        .map(|name| (name, piece.clone()))
        .into_iter()
        .chain(without.filter(|(name, changed)| changed != piece && (*name != SILENT || on_hoop)))
        .collect();
    let rows: Vec<Vec<String>> =
        variants.into_par_iter().map(|(name, piece)| row(name, &piece, strikes)).collect::<Result<_>>()?;
    sheet.heading(title);
    sheet.table(&head(), rows);
    Ok(())
}

/// The first row.
fn head() -> Vec<&'static str> {
    ["", "lines"].into_iter().chain(FIGURES.map(|(_, name)| name)).collect()
}

/// The row of strokes on a drum alone, at its close microphone.
fn row(name: &str, piece: &PieceSpec, strikes: &[Strike]) -> Result<Vec<String>> {
    let mut means = Means::default();
    for &strike in strikes {
        let options = BuildOptions::new(RATE);
        let request =
            hear::Request { kit: alone(piece), strike, settings: Vec::new(), options, seconds: SECONDS };
        let scatter = |piece: &mut Piece| {
            if name == UNSCATTERED {
                piece.surface_mut().high_bands_mut().for_each(|band| band.set_scattering(0.0));
            }
        };
        means.add(&hear::render_prepared(&request, scatter)?.samples);
    }
    Ok(means.row(name))
}

/// The row of strokes on a drum in the kit, in the mix.
fn row_in_the_mix((name, assignment, take): &About, subject: &Subject) -> Result<Vec<String>> {
    let kit = take(KitSpec::standard(), subject);
    let assigned = Some(assignment).filter(|text| !text.is_empty());
    let setting = assigned.map(|text| parse_assignment(text, &kit)).transpose()?;
    let notes = NoteTable::standard(&kit);
    let request = realism::Request {
        subjects: vec![*subject],
        speeds: SPEEDS.to_vec(),
        kit: KitDocument { kit, notes },
        settings: setting.into_iter().collect(),
        pace: Pace::RealTime,
    };
    let sounds: Mutex<Vec<([u64; 2], Vec<f32>)>> = Mutex::default();
    realism::run_and_show(&request, &|job, [_, mix]| {
        let sound = mix[..mix.len().min((SECONDS * RATE) as usize)].to_vec();
        // Strokes end in any order.
        let key = [job.speed, job.place].map(f64::to_bits);
        sounds.lock().unwrap_or_else(PoisonError::into_inner).push((key, sound));
        Ok(())
    })
    .with_context(|| format!("{}, {name}", subject.name))?;
    let mut sounds = sounds.into_inner().unwrap_or_else(PoisonError::into_inner);
    sounds.sort_unstable_by_key(|(key, _)| *key);
    let mut means = Means::default();
    sounds.iter().for_each(|(_, sound)| means.add(sound));
    Ok(means.row(name))
}

/// Figures of some strokes.
#[derive(Default)]
struct Means {
    lines: Vec<f64>,
    figures: [Vec<f64>; FIGURES.len()],
}

impl Means {
    /// Measures a stroke.
    fn add(&mut self, sound: &[f32]) {
        self.lines.extend(OneShot::new(sound, RATE).as_ref().and_then(line_share));
        let found = features::measure(sound, RATE);
        for ((feature, _), values) in FIGURES.iter().zip(&mut self.figures) {
            values.extend(found.get(feature));
        }
    }

    /// Means over the strokes; a figure that no stroke has is left out.
    fn row(&self, name: &str) -> Vec<String> {
        let mean =
            |values: &[f64]| (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64);
        let shown = |(value, decimals): (Option<f64>, usize)| {
            value.map_or("-".to_owned(), |value| format!("{value:.decimals$}"))
        };
        let decimals = |feature: Feature| if feature.key().ends_with("_s") { 2 } else { 1 };
        let figures = FIGURES
            .iter()
            .zip(&self.figures)
            .map(|((feature, _), values)| (mean(values), decimals(*feature)));
        let cells = [(mean(&self.lines), 2)].into_iter().chain(figures).map(shown);
        [name.to_owned()].into_iter().chain(cells).collect()
    }
}
