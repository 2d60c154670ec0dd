//! Costs, as `bench` measures them in a release build: the one page that depends on the machine.

use anyhow::{Context, Result};
use overhear_measure::report::page::bodies::PLAYED;
use overhear_measure::report::page::figure;
use overhear_measure::report::page::sources::{EARLIER, GOAL};
use overhear_measure::report::plot::{Axis, Plot, comb};
use overhear_measure::report::{Claim, Page, Sheet};
use serde_json::Value;

use crate::program;

/// Runs of everything: enough to see a spread.
const RUNS: &str = "3";

/// The page.
///
/// # Errors
/// If `bench` cannot be built or fails.
pub fn page() -> Result<Page> {
    let report = bench()?;
    let mut sheet = Sheet::new(
        "cost",
        "Costs",
        PLAYED,
        &format!(
            "CPU cost of the instrument on the machine that wrote this page, one thread, {}, {} Hz: `cargo xtask bench --runs {RUNS}`. A\n\
             calibration is the time of a fixed loop ({:.4} s here), measured in alternation with the instrument. Machines and their\n\
             other load differ; [performance.md](../performance.md) says more.",
            text(&report, "simd"),
            number(&report, &["sample_rate_hz"]),
            number(&report, &["calibration_s"]),
        ),
    );
    for (name, key, earlier, goal) in
        [("groove", "groove", 16.5, 1.6), ("all at once, the hi-hat too", "all_at_once", 19.3, 2.4)]
    {
        let of = |what: &str| number(&report, &[key, what]);
        let got = of("calibrations");
        sheet.claim(Claim {
            what: name.to_owned(),
            on: PLAYED,
            figure: format!(
                "{got:.2} calibrations ({:.2} to {:.2}), {:.0} % of a core",
                of("calibrations_min"),
                of("calibrations_max"),
                100.0 * of("share")
            ),
            reference: format!("{goal} (the earlier engine {earlier})"),
            source: GOAL,
            met: Some(got <= goal),
        });
        sheet.claim(Claim {
            what: format!("{name}, against the earlier engine"),
            on: PLAYED,
            figure: format!("{:.1} times less", earlier / got),
            reference: "less than its cost, with twice its modes".to_owned(),
            source: EARLIER,
            met: Some(got < earlier),
        });
    }
    let gliding = number(&report, &["gliding", "share"]);
    sheet.claim(Claim::told(
        "every tuning and muffling automated in every block",
        PLAYED,
        format!("{:.0} % of a core", 100.0 * gliding),
        "no figure known",
        GOAL,
    ));
    let percent = |what: String, share: f64, most: f64| Claim {
        what,
        on: PLAYED,
        figure: format!("{:.2} %", 100.0 * share),
        reference: format!("{most} %"),
        source: GOAL,
        met: Some(100.0 * share < most),
    };
    sheet.claim(percent("idle, of a core".to_owned(), number(&report, &["idle", "share"]), 0.3));
    let over = number(&report, &["cymbals_choked", "over_ringing"]);
    sheet.claim(Claim {
        what: "cymbals choked by a hand that moves".to_owned(),
        on: PLAYED,
        figure: format!("{over:.2} times the cost of ringing ones"),
        reference: "1.2 times".to_owned(),
        source: GOAL,
        met: Some(over <= 1.2),
    });
    let [late, buffers] = ["late", "buffers"].map(|key| number(&report, &["exchanges", "with", key]));
    let exchanged = number(&report, &["exchanges", "exchanged"]);
    sheet.claim(Claim {
        what: format!("late buffers of 64 samples in a groove in which {exchanged} pieces are exchanged"),
        on: PLAYED,
        figure: format!("{late} of {buffers}"),
        reference: "0".to_owned(),
        source: GOAL,
        met: Some(late == 0.0),
    });
    let worst = number(&report, &["worst_block_share"]);
    sheet.claim(percent("longest block of 32 samples, of its deadline".to_owned(), worst, 60.0));
    for (what, key, most, unit) in [
        ("build of the kit, cold", "build_cold_s", 1.0, "s"),
        ("build from the cache folder", "build_from_disk_s", 0.1, "s"),
        ("build from memory", "build_warm_s", 0.1, "s"),
        ("a kit of 16 pieces reopened from its text and the cache folder", "reopen_16_s", 0.3, "s"),
        ("an instance without pieces, as a host's scan makes", "instance_s", 0.05, "s"),
        ("memory with a kit built", "memory_mb", 150.0, "MB"),
    ] {
        let got = number(&report, &[key]);
        sheet.claim(Claim {
            what: what.to_owned(),
            on: PLAYED,
            figure: format!("{} {unit}", figure(got)),
            reference: format!("{most} {unit}"),
            source: GOAL,
            met: Some(got < most),
        });
    }
    let cpu: Vec<String> = report["build_cpu_s"]
        .as_array()
        .map(|all| all.iter().filter_map(Value::as_f64).map(|s| format!("{s:.2}")).collect())
        .unwrap_or_default();
    sheet.claim(Claim::told(
        "CPU time of these three builds, all processors together",
        PLAYED,
        format!("{} CPU s", cpu.join(", ")),
        "6.5 cold, .2 warm",
        EARLIER,
    ));
    sets(&mut sheet, &report);
    pieces(&mut sheet, &report)?;
    Ok(sheet.finish())
}

/// Runs `bench` in a release build, its report as JSON.
fn bench() -> Result<Value> {
    let output = program::released()
        .args(["bench", "--json", "--runs", RUNS])
        .stderr(std::process::Stdio::inherit())
        .output()
        .context("cannot run cargo")?;
    anyhow::ensure!(output.status.success(), "`bench` failed: {}", output.status);
    serde_json::from_slice(&output.stdout).context("`bench` did not print its report")
}

fn number(report: &Value, path: &[&str]) -> f64 {
    path.iter().try_fold(report, |value, key| value.get(key)).and_then(Value::as_f64).unwrap_or(f64::NAN)
}

fn text<'a>(report: &'a Value, key: &str) -> &'a str {
    report.get(key).and_then(Value::as_str).unwrap_or("")
}

/// The kit with each instruction set of the machine.
fn sets(sheet: &mut Sheet, report: &Value) {
    sheet.heading("Instruction sets");
    sheet.text("The kit as it plays with each instruction set of this machine, calibrations (of a core).");
    let cell = |figure: Option<&Value>| {
        figure.map_or_else(String::new, |figure| {
            let [calibrations, share] = ["calibrations", "share"].map(|key| number(figure, &[key]));
            format!("{calibrations:.2} ({:.0} %)", 100.0 * share)
        })
    };
    let none = serde_json::Map::new();
    let narrower = report.get("narrower").and_then(Value::as_object).unwrap_or(&none);
    // By name the sets come in another order.
    let sets = ["sse2", "avx2"].into_iter().filter_map(|set| Some((set, narrower.get(set)?)));
    let row = |(set, scenes): (&str, &Value)| {
        vec![set.to_owned(), cell(scenes.get("groove")), cell(scenes.get("all-at-once"))]
    };
    let widest =
        vec![text(report, "simd").to_owned(), cell(report.get("groove")), cell(report.get("all_at_once"))];
    sheet.table(&["", "groove", "all at once"], sets.map(row).chain([widest]));
}

/// Every piece alone: a table and a plot, costs in calibrations.
fn pieces(sheet: &mut Sheet, report: &Value) -> Result<()> {
    sheet.heading("The pieces");
    sheet.text("Each piece alone, the second after a stroke of 6 m/s, calibrations.");
    let tiers = ["eco", "standard", "high", "offline"];
    let names = overhear_measure::names();
    let cost = |piece: &str, tier: &str| {
        let of_tier = number(report, &["pieces", piece, "tiers", tier, "calibrations"]);
        let standard = number(report, &["pieces", piece, "calibrations"]);
        if of_tier.is_nan() && tier == "standard" { standard } else { of_tier }
    };
    let cell = |value: f64| if value.is_nan() { String::new() } else { format!("{value:.2}") };
    let row = |piece: &String| {
        let cells = tiers.iter().map(|tier| cell(cost(piece, tier)));
        std::iter::once(piece.clone()).chain(cells).collect()
    };
    sheet.table(
        &["", "eco, 1 kHz", "standard, 2 kHz", "high, 4 kHz", "offline, 8 kHz"],
        names.iter().map(row),
    );
    sheet.heading("Buffers");
    sheet.text("CPU time of a host's buffer, % of its deadline, groove and all at once together.");
    let shares = ["50", "90", "99", "99.9", "100"];
    let mut rows = vec![("32", report.get("block_share_percentiles"))];
    for size in ["64", "128", "256", "512"] {
        rows.push((size, report.get("buffers").and_then(|buffers| buffers.get(size))));
    }
    for (name, scene) in [("32, all controls glide", "gliding"), ("32, cymbals choked", "choked")] {
        rows.push((name, report.get("moved_block_share_percentiles").and_then(|scenes| scenes.get(scene))));
    }
    for (name, scene) in [("64, groove", "without"), ("64, groove, pieces exchanged", "with")] {
        rows.push((name, report.pointer(&format!("/exchanges/{scene}/share_percentiles"))));
    }
    let row = |(size, of): (&str, Option<&Value>)| {
        let share = |key: &&str| cell(100.0 * of.map_or(f64::NAN, |of| number(of, &[key])));
        std::iter::once(size.to_owned()).chain(shares.iter().map(share)).collect()
    };
    let head = ["samples", "half", "90 %", "99 %", "99.9 %", "the longest"];
    sheet.table(&head, rows.into_iter().map(row));
    let bars = names.iter().enumerate().map(|(at, piece)| {
        let tops =
            tiers.iter().enumerate().map(|(tier, name)| (at as f64 + 0.2 * tier as f64, cost(piece, name)));
        let bars = tops.filter(|(_, cost)| cost.is_finite()).flat_map(|(x, cost)| {
            let (_, bar) = comb("", &[x], [0.01, cost]);
            bar
        });
        (piece.clone(), bars.collect())
    });
    sheet.plot(
        "pieces",
        "Cost of each piece, cymbals at eco, standard, high and offline",
        &Plot {
            across: Axis::linear("", -0.3..10.5),
            up: Axis::log("calibrations", 0.01..30.0),
            panels: vec![("the second after 6 m/s".to_owned(), bars.collect())],
        },
    )
}
