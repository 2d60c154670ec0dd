//! Sizes as they are written and read: numbers with their units.

use super::{DEGREE, INCH, Measure, Size, Units};

impl Size {
    /// A value with its unit.
    pub fn text(self, value: f64, units: Units) -> String {
        let (scale, unit, digits) = self.unit(units);
        let text = format!("{:.digits$}", value / scale);
        let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        format!("{text} {unit}").trim_end().to_owned()
    }

    /// The value that a text stands for, in SI units: a number, with or without a unit.
    pub fn parse(self, text: &str, units: Units) -> Option<f64> {
        let text = text.trim();
        let end = text.find(|c: char| c.is_alphabetic() || "\"%°".contains(c)).unwrap_or(text.len());
        let (number, unit) = text.split_at(end);
        let number: f64 = number.trim().replace(',', ".").parse().ok()?;
        let scale = match (self.measure(), unit.trim()) {
            (_, "") => self.unit(units).0,
            (Measure::Percent, "%") => 1e-2,
            (Measure::Grams, "g") => 1e-3,
            (Measure::Angle, "°" | "deg") => DEGREE,
            (Measure::Thickness, "mm") => 1e-3,
            (Measure::Length, "in" | "\"") => INCH,
            (Measure::Length, "mm") | (Measure::Mass, "g") | (Measure::Volume, "l") => 1e-3,
            (Measure::Length, "cm") => 1e-2,
            (Measure::Length, "m")
            | (Measure::Mass, "kg")
            | (Measure::Pitch, "Hz" | "hz")
            | (Measure::Force, "N" | "n") => 1.0,
            _ => return None,
        };
        Some(number * scale)
    }

    /// The unit that it is shown in: its size in SI units, its name, digits behind the point.
    pub(super) fn unit(self, units: Units) -> (f64, &'static str, usize) {
        match (self.measure(), units) {
            (Measure::Length, Units::Inches) => (INCH, "in", 2),
            (Measure::Length, Units::Millimetres) => (1e-3, "mm", 1),
            (Measure::Volume, _) => (1e-3, "l", 1),
            (Measure::Mass, _) => (1e-3, "g", 0),
            (Measure::Pitch, _) => (1.0, "Hz", 1),
            (Measure::Thickness, _) => (1e-3, "mm", 2),
            (Measure::Ratio, _) => (1.0, "", 3),
            (Measure::Percent, _) => (1e-2, "%", 1),
            (Measure::Count, _) => (1.0, "", 0),
            (Measure::Force, _) => (1.0, "N", 1),
            (Measure::Grams, _) => (1e-3, "g", 2),
            (Measure::Angle, _) => (DEGREE, "°", 0),
        }
    }
}
