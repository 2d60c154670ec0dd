//! What was measured, for people and for programs.

use std::collections::BTreeMap;
use std::fmt;

use overhear_engine::kit::BLOCK;
use overhear_engine::kit_spec::{Kind, KitSpec};
use overhear_engine::modal::simd::level::InstructionSet;
use overhear_engine::piece::Quality;
use serde::Serialize;

use super::callgrind::Count;
use super::compare::Before;
use super::exchanges::Exchanges;
use super::limit::Limit;
use super::measure::{Blocks, Buffers, Cost, QUANTILES};
use super::request::{Builds, Request};
use super::workload::Scene;

/// Buffers of a host, samples, whole blocks.
const BUFFERS: [usize; 4] = [64, 128, 256, 512];

/// The report, one object; units are in the names.
#[derive(Debug, Serialize)]
pub struct Report {
    /// CPU seconds of the calibration loop.
    calibration_s: f64,
    runs: usize,
    quality: &'static str,
    sample_rate_hz: f64,
    /// `standard`, or the file it was read from.
    kit: String,
    /// Of the standard kit only.
    #[serde(skip_serializing_if = "Option::is_none")]
    groove: Option<Figure>,
    all_at_once: Figure,
    gliding: Figure,
    /// Of kits with cymbals.
    #[serde(skip_serializing_if = "Option::is_none")]
    cymbals_ringing: Option<Figure>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cymbals_choked: Option<Choked>,
    pieces: BTreeMap<String, PieceCost>,
    idle: Idle,
    /// The longest block over the groove and all at once, of its deadline.
    worst_block_share: f64,
    /// The time that so many percent of those blocks stay within, of the deadline.
    block_share_percentiles: BTreeMap<&'static str, f64>,
    /// The same for a host's buffers of so many samples.
    buffers: BTreeMap<usize, BTreeMap<&'static str, f64>>,
    /// The percentiles of scenes in which controls move, by scene.
    moved_block_share_percentiles: BTreeMap<&'static str, BTreeMap<&'static str, f64>>,
    /// Of the standard kit only.
    #[serde(skip_serializing_if = "Option::is_none")]
    exchanges: Option<Exchanges>,
    #[serde(flatten)]
    builds: Builds,
    simd: &'static str,
    /// The kit as it plays with narrower instruction sets, by set and scene.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    narrower: BTreeMap<&'static str, BTreeMap<&'static str, Figure>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    instructions: Vec<Count>,
    #[serde(skip)]
    before: Before,
}

/// A cost.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Figure {
    /// CPU seconds per second of sound.
    share: f64,
    calibrations: f64,
    /// Least and greatest of all runs.
    calibrations_min: f64,
    calibrations_max: f64,
}

/// The cost of cymbals that are choked.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Choked {
    #[serde(flatten)]
    cost: Figure,
    /// The same over that of cymbals that are struck alike and ring.
    over_ringing: f64,
    /// The longest block over the longest one of those.
    longest_over_ringing: f64,
}

/// Cost of a kit at rest.
pub type Idle = Figure;

/// A piece at the standard tier, and a cymbal at the others.
#[derive(Debug, Serialize)]
pub struct PieceCost {
    #[serde(flatten)]
    standard: Figure,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    tiers: BTreeMap<&'static str, Figure>,
}

impl From<Cost> for Figure {
    fn from(cost: Cost) -> Figure {
        let Cost { share, calibrations, spread: [calibrations_min, calibrations_max], .. } = cost;
        Figure { share, calibrations, calibrations_min, calibrations_max }
    }
}

/// All measurements.
pub struct Measured<'a> {
    pub request: &'a Request,
    pub kit: &'a KitSpec,
    pub costs: Vec<(Scene, Cost)>,
    pub blocks: Vec<(Scene, Blocks)>,
    pub exchanges: Option<Exchanges>,
    pub narrower: Vec<(InstructionSet, Scene, Cost)>,
    pub builds: Builds,
    pub simd: &'static str,
    pub counts: Vec<Count>,
}

impl Report {
    /// Puts in order what was measured.
    ///
    /// # Panics
    /// If the kit's scenes are not among the costs.
    pub fn new(measured: Measured<'_>) -> Report {
        let Measured { request, kit, costs, blocks, narrower, .. } = measured;
        let find = |wanted: fn(&Scene) -> bool| {
            let found = costs.iter().find(|(scene, _)| wanted(scene));
            found.map(|&(_, cost)| Figure::from(cost))
        };
        let of = |wanted| find(wanted).expect("every scene is measured");
        let cost_of =
            |wanted: fn(&Scene) -> bool| costs.iter().find(|(scene, _)| wanted(scene)).map(|&(_, cost)| cost);
        let ringing = cost_of(|scene| matches!(scene, Scene::Ringing(_)));
        let choked = cost_of(|scene| matches!(scene, Scene::Choked(_)));
        let mut pieces: BTreeMap<String, PieceCost> = BTreeMap::new();
        for &(scene, cost) in &costs {
            let Scene::Piece(slot, quality) = scene else { continue };
            let figure = Figure::from(cost);
            let entry = pieces
                .entry(scene.name(kit))
                .or_insert_with(|| PieceCost { standard: figure, tiers: BTreeMap::new() });
            if quality == Quality::Standard {
                entry.standard = figure;
            }
            if kit.piece(slot).is_some_and(|piece| piece.instrument.kind() != Kind::Drum) {
                entry.tiers.insert(quality.name(), figure);
            }
        }
        let mut loops: Vec<f64> = costs.iter().map(|(_, cost)| cost.calibration_s).collect();
        loops.sort_by(f64::total_cmp);
        let quantiles =
            |buffers: &Buffers| BTreeMap::from(QUANTILES.map(|(name, q)| (name, buffers.within(q))));
        let (played, others): (Vec<_>, Vec<_>) = blocks.into_iter().partition(|(scene, _)| scene.is_kit());
        let played: Vec<Blocks> = played.into_iter().map(|(_, blocks)| blocks).collect();
        let percentiles = |blocks_each: usize| quantiles(&Buffers::of(&played, blocks_each, request.rate));
        let moved = others.into_iter().filter_map(|(scene, blocks)| {
            let name = scene.moved_controls()?;
            Some((name, quantiles(&Buffers::of(&[blocks], 1, request.rate))))
        });
        let moved_block_share_percentiles = moved.collect();
        let mut by_set: BTreeMap<_, BTreeMap<_, _>> = BTreeMap::new();
        for (set, scene, cost) in narrower {
            let name = if matches!(scene, Scene::Groove(_)) { "groove" } else { "all-at-once" };
            by_set.entry(set.name()).or_default().insert(name, Figure::from(cost));
        }
        Report {
            calibration_s: loops[loops.len() / 2],
            runs: request.runs,
            quality: request.quality.name(),
            sample_rate_hz: request.rate,
            kit: request.kit.as_ref().map_or("standard".to_owned(), |kit| kit.display().to_string()),
            groove: find(|scene| matches!(scene, Scene::Groove(_))),
            all_at_once: of(|scene| matches!(scene, Scene::AllAtOnce(_))),
            gliding: of(|scene| matches!(scene, Scene::Gliding(_))),
            cymbals_ringing: ringing.map(Figure::from),
            cymbals_choked: choked.zip(ringing).map(|(choked, ringing)| Choked {
                cost: choked.into(),
                over_ringing: choked.calibrations / ringing.calibrations,
                longest_over_ringing: choked.longest_s / ringing.longest_s,
            }),
            idle: of(|scene| *scene == Scene::Idle),
            pieces,
            worst_block_share: Buffers::of(&played, 1, request.rate).within(1.0),
            block_share_percentiles: percentiles(1),
            buffers: BUFFERS.map(|samples| (samples, percentiles(samples / BLOCK))).into(),
            moved_block_share_percentiles,
            exchanges: measured.exchanges,
            narrower: by_set,
            builds: measured.builds,
            simd: measured.simd,
            instructions: measured.counts,
            before: Before::new(),
        }
    }

    /// The same, with older costs to print beside.
    pub fn beside(self, before: Before) -> Report {
        Report { before, ..self }
    }

    fn row(&self, f: &mut fmt::Formatter, name: &str, figure: &Figure) -> fmt::Result {
        let Figure { share, calibrations, calibrations_min: least, calibrations_max: most } = figure;
        write!(f, "{name:<20} {:>7.2} % {calibrations:>9.3}  {least:>7.3} to {most:<7.3}", 100.0 * share)?;
        match self.before.get(name) {
            Some(before) => writeln!(f, "  {before:>7.3}  x{:.2}", calibrations / before),
            None => writeln!(f),
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(
            f,
            "calibration loop {:.4} s, {} runs, one thread, {}, {} Hz, kit {}, its cymbals at {}\n",
            self.calibration_s, self.runs, self.simd, self.sample_rate_hz, self.kit, self.quality
        )?;
        let before = if self.before.is_empty() { "" } else { "   before  ratio" };
        writeln!(f, "{:<20} {:>9} {:>9}  {:>18}{before}", "", "a core", "calibr.", "least to greatest")?;
        if let Some(groove) = &self.groove {
            self.row(f, "groove", groove)?;
        }
        self.row(f, "all-at-once", &self.all_at_once)?;
        self.row(f, "gliding", &self.gliding)?;
        for (set, scenes) in &self.narrower {
            scenes.iter().try_for_each(|(scene, figure)| self.row(f, &format!("{scene}, {set}"), figure))?;
        }
        if let Some(ringing) = &self.cymbals_ringing {
            self.row(f, "cymbals ringing", ringing)?;
        }
        if let Some(choked) = &self.cymbals_choked {
            self.row(f, "cymbals choked", &choked.cost)?;
        }
        self.row(f, "idle", &self.idle)?;
        for (name, PieceCost { standard, tiers }) in &self.pieces {
            if tiers.is_empty() {
                self.row(f, name, standard)?;
            }
            for quality in Quality::ALL {
                if let Some(figure) = tiers.get(quality.name()) {
                    self.row(f, &format!("{name} {}", quality.name()), figure)?;
                }
            }
        }
        if let Some(Choked { over_ringing, longest_over_ringing, .. }) = &self.cymbals_choked {
            writeln!(
                f,
                "\nchoked cymbals cost {over_ringing:.2} of what ringing ones do, their longest block {longest_over_ringing:.2}"
            )?;
        }
        writeln!(f, "\nCPU time of a buffer, % of its deadline, within which so many stay")?;
        let quantiles = QUANTILES.map(|(name, _)| format!("{:>9}", format!("{name} %"))).concat();
        writeln!(f, "{:<20}{quantiles}", "samples")?;
        for (samples, percentiles) in
            [(&BLOCK, &self.block_share_percentiles)].into_iter().chain(&self.buffers)
        {
            let shares = QUANTILES.map(|(name, _)| format!("{:>9.1}", 100.0 * percentiles[name])).concat();
            writeln!(f, "{samples:<20}{shares}")?;
        }
        for (scene, percentiles) in &self.moved_block_share_percentiles {
            let shares = QUANTILES.map(|(name, _)| format!("{:>9.1}", 100.0 * percentiles[name])).concat();
            writeln!(f, "{:<20}{shares}", format!("{BLOCK}, {scene}"))?;
        }
        if let Some(exchanges) = &self.exchanges {
            for (name, percentiles, [late, buffers]) in exchanges.rows() {
                let shares =
                    QUANTILES.map(|(name, _)| format!("{:>9.1}", 100.0 * percentiles[name])).concat();
                writeln!(f, "{name:<20}{shares}  {late} of {buffers} late")?;
            }
            let (pieces, longest_s) = exchanges.takeovers();
            let [kit, piece] = longest_s.map(|seconds| 1e6 * seconds);
            writeln!(
                f,
                "{pieces} exchanges, each takes over a kit within {kit:.0} us, a piece within {piece:.0} us"
            )?;
        }
        let Builds {
            instance_s,
            build_cold_s,
            build_from_disk_s,
            build_warm_s,
            build_cpu_s,
            reopen_16_s,
            memory_mb,
            limit,
        } = self.builds;
        let seconds = [build_cold_s, build_from_disk_s, build_warm_s];
        for ((from, seconds), cpu_s) in
            ["cold", "from disk", "from memory"].iter().zip(seconds).zip(build_cpu_s)
        {
            writeln!(f, "{:<20} {seconds:>7.3} s {cpu_s:>9.3} s of all processors", format!("build {from}"))?;
        }
        writeln!(f, "{:<20} {reopen_16_s:>7.3} s", "reopen 16 pieces")?;
        writeln!(f, "an instance without pieces {:.1} ms; memory {memory_mb:.0} MB", 1e3 * instance_s)?;
        if let Some(Limit { multiply_adds_per_s, modes, ringing_share }) = limit {
            writeln!(
                f,
                "at most {:.1} billion multiply-adds a second; all {modes} modes ringing take {:.1} % of that",
                1e-9 * multiply_adds_per_s,
                100.0 * ringing_share
            )?;
        }
        for Count { name, instructions_per_s } in &self.instructions {
            writeln!(f, "{name:<20} {:>9.1} million instructions a second", instructions_per_s / 1e6)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::compare;
    use super::*;

    #[test]
    fn a_report_names_every_scene_and_can_be_compared_with() {
        let cost =
            Cost { share: 0.05, calibrations: 0.6, spread: [0.5, 0.7], calibration_s: 0.08, longest_s: 2e-4 };
        let quality = Quality::Standard;
        let cymbals = [Scene::Ringing(quality), Scene::Choked(quality)];
        let kit = [Scene::Groove(quality), Scene::AllAtOnce(quality), Scene::Gliding(quality), Scene::Idle];
        let standard = KitSpec::standard();
        let slot = |name| standard.find(name).unwrap().0;
        let crash = Quality::ALL.map(|quality| Scene::Piece(slot("crash"), quality));
        let scenes = kit.into_iter().chain(cymbals).chain(crash).chain([Scene::Piece(slot("kick"), quality)]);
        let request = Request {
            kit: None,
            runs: 7,
            quality,
            rate: 44_100.0,
            simd: None,
            compare: None,
            callgrind: false,
        };
        let report = Report::new(Measured {
            request: &request,
            kit: &standard,
            costs: scenes.map(|scene| (scene, cost)).collect(),
            blocks: [Scene::AllAtOnce(quality), Scene::Gliding(quality)]
                .map(|it| (it, Blocks::default()))
                .into(),
            narrower: vec![(InstructionSet::Sse2, Scene::Groove(quality), cost)],
            exchanges: Some(Exchanges::example()),
            builds: Builds::default(),
            simd: "avx2",
            counts: Vec::new(),
        });
        let json = serde_json::to_value(&report).unwrap();
        for key in [
            "calibration_s",
            "kit",
            "groove",
            "all_at_once",
            "gliding",
            "cymbals_ringing",
            "cymbals_choked",
            "pieces",
            "idle",
            "worst_block_share",
            "exchanges",
            "build_cold_s",
            "build_warm_s",
            "memory_mb",
            "simd",
        ] {
            assert!(json.get(key).is_some(), "{key}");
        }
        assert_eq!(json["groove"]["calibrations"], 0.6);
        assert_eq!(json["narrower"]["sse2"]["groove"]["share"], 0.05);
        assert_eq!(json["moved_block_share_percentiles"]["gliding"]["50"], 0.0);
        assert_eq!(json["cymbals_choked"]["over_ringing"], 1.0);
        assert_eq!(json["pieces"]["crash"]["tiers"].as_object().unwrap().len(), Quality::ALL.len());
        assert_eq!(json["exchanges"]["with"]["late"], 1);
        assert_eq!(json["exchanges"]["without"]["late"], 0);
        let before = compare::parse(&json.to_string()).unwrap();
        assert_eq!(before.get("crash high"), Some(&0.6));
        let table = report.beside(before).to_string();
        assert!(table.lines().filter(|line| line.ends_with("x1.00")).count() >= 8, "{table}");
        assert!(table.contains("1 of 2 late"), "{table}");
        assert!(compare::parse("{}").unwrap_err().to_string().contains("all_at_once"));
    }
}
