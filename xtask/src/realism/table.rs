//! The report as tables for people.

use std::fmt;

use super::report::{Count, PieceReport, Report, Row};

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        for piece in &self.pieces {
            piece.write(f, &self.speeds_m_s)?;
            writeln!(f)?;
        }
        writeln!(
            f,
            "[a .. b]  10-90 % of real kits        (a .. b)  near the real median, whose range is unknown"
        )?;
        writeln!(f, "< > outside        - cannot be measured: outside")?;
        writeln!(f, "\n{:<14}{:>22}{:>22}", "", "in the real range", "near the median")?;
        for piece in &self.pieces {
            writeln!(f, "{:<14}{:>22}{:>22}", piece.piece, share(piece.ranges), share(piece.medians))?;
        }
        writeln!(f, "{:<14}{:>22}{:>22}", "all", share(self.ranges), share(self.medians))
    }
}

fn share(count: Count) -> String {
    let percent = 100.0 * count.inside as f64 / count.of.max(1) as f64;
    format!("{} of {} ({percent:.0} %)", count.inside, count.of)
}

impl PieceReport {
    fn write(&self, f: &mut fmt::Formatter, speeds: &[f64]) -> fmt::Result {
        let title = format!("{}, {} at {}", self.piece, self.striker, self.at);
        write!(f, "{title:<32}{:>8}{:>21}", "real", "")?;
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
