//! The report as text tables.

use std::fmt;

use super::RecordingChain;
use super::report::{Count, PieceReport, Report, Row};

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        for piece in &self.pieces {
            piece.write(f, &self.speeds_m_s)?;
            writeln!(f)?;
        }
        writeln!(
            f,
            "[a .. b]  10-90 % of real kits        (a .. b)  near the median of real kits; their range is unknown"
        )?;
        writeln!(f, "< > outside        - cannot be measured; counts as outside")?;
        for heard in RecordingChain::ALL {
            self.write_shares(f, heard)?;
        }
        Ok(())
    }
}

impl Report {
    fn write_shares(&self, f: &mut fmt::Formatter, heard: RecordingChain) -> fmt::Result {
        let all = |f: &mut fmt::Formatter, name: &str, [ranges, medians, firm]: [Count; 3], goal: &str| {
            let [ranges, medians, firm] = [ranges, medians, firm].map(share);
            writeln!(f, "{name:<14}{ranges:>22}{medians:>22}{firm:>24}  {goal}")
        };
        let goal = format!("goal {:.0} %", 100.0 * heard.goal());
        let title = format!("\n{}", heard.name());
        writeln!(
            f,
            "{title:<15}{:>22}{:>22}{:>24}  {goal}",
            "in the real range", "near the median", "all, 3 m/s and more"
        )?;
        for piece in self.pieces.iter().filter(|piece| piece.heard == heard) {
            let reached = if piece.firm.share() >= heard.goal() { "reached" } else { "missed" };
            all(f, piece.piece, [piece.ranges, piece.medians, piece.firm], reached)?;
        }
        let counts: [fn(&PieceReport) -> Count; 3] =
            [|piece| piece.ranges, |piece| piece.medians, |piece| piece.firm];
        all(f, "all", counts.map(|count| self.all(heard, count)), "")
    }
}

fn share(count: Count) -> String {
    format!("{} of {} ({:.0} %)", count.inside, count.of, 100.0 * count.share())
}

impl PieceReport {
    fn write(&self, f: &mut fmt::Formatter, speeds: &[f64]) -> fmt::Result {
        let places = self.at.map(|place| place.to_string()).join(", ");
        writeln!(f, "{}, {}: {} at {places}", self.piece, self.heard.name(), self.striker)?;
        write!(f, "{:<32}{:>8}{:>21}", "", "real", "")?;
        for speed in speeds {
            write!(f, "{:>11}", format!("{speed} m/s"))?;
        }
        writeln!(f)?;
        for row in &self.features {
            row.write(f)?;
        }
        if let Some(slope) = &self.slope {
            let value = slope.value.map_or_else(|| "-".to_owned(), |value| format!("{value:.2}"));
            let mark = if slope.inside { "" } else { ", outside" };
            writeln!(
                f,
                "  {} grows by {value} octaves per +20 dB; real: {}, within {}{mark}",
                slope.feature,
                slope.median,
                super::reference::SLOPE_WITHIN,
            )?;
        }
        Ok(())
    }
}

impl Row {
    fn write(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (open, close) = if self.ranged { ('[', ']') } else { ('(', ')') };
        let bounds = format!("{open}{} .. {}{close}", short(self.low), short(self.high));
        write!(f, "  {:<30}{:>8}  {bounds:<19}", self.feature, short(self.median))?;
        for (value, inside) in self.values.iter().zip(&self.inside) {
            let mark = match value {
                Some(value) if !inside => {
                    if *value < self.low {
                        '<'
                    } else {
                        '>'
                    }
                }
                _ => ' ',
            };
            let value = value.map_or_else(|| "-".to_owned(), short);
            write!(f, "{value:>9} {mark}")?;
        }
        writeln!(f)
    }
}

/// Three figures, as people write them.
fn short(value: f64) -> String {
    let decimals = match value.abs() {
        size if size >= 99.5 => 0,
        size if size >= 9.95 => 1,
        _ => 2,
    };
    format!("{value:.decimals$}")
}
