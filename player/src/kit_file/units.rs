//! Units in the names of fields: in which others than its own a number can be given.
//!
//! A field's name ends with its SI unit: `thickness_m`. A file may use another name with the same stem: `thickness_mm`.
//! Decimal units are converted as decimal numbers, so that 0.36 mm is the number nearest to 0.00036 m.

use std::f64::consts::PI;

/// A unit in which a file may give what is kept in an SI unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Unit {
    /// End of the field's name.
    pub(super) suffix: &'static str,
    scale: Scale,
}

/// The size of a unit in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Scale {
    /// A whole number times a power of ten.
    Decimal(u128, i32),
    /// A half turn over 180.
    Degree,
}

const fn decimal(suffix: &'static str, times: u128, exponent: i32) -> Unit {
    Unit { suffix, scale: Scale::Decimal(times, exponent) }
}

/// What an inch, a millimetre, a gram and a gigapascal are in SI units.
pub(super) const INCH: Unit = decimal("_in", 254, -4);
pub(super) const MILLIMETRE: Unit = decimal("_mm", 1, -3);
pub(super) const GRAM: Unit = decimal("_g", 1, -3);
pub(super) const GIGAPASCAL: Unit = decimal("_gpa", 1, 9);

/// Ends of names in SI units, with the units that can stand instead. The first that fits counts: those made of several
/// units come before those that they end with.
const SI: [(&str, &[Unit]); 11] = [
    ("_kg_m3", &[]),
    ("_n_m", &[]),
    ("_m_s", &[]),
    ("_1_s", &[]),
    ("_m3", &[decimal("_l", 1, -3)]),
    ("_m", &[INCH, decimal("_cm", 1, -2), MILLIMETRE]),
    ("_kg", &[GRAM]),
    ("_s", &[decimal("_ms", 1, -3)]),
    ("_rad", &[Unit { suffix: "_deg", scale: Scale::Degree }]),
    ("_hz", &[decimal("_khz", 1, 3)]),
    ("_pa", &[GIGAPASCAL]),
];

/// The stem of an SI name and the units that can stand instead of its own.
fn alternatives(name: &str) -> (&str, &'static [Unit]) {
    let of = |(suffix, units): &(&str, &'static [Unit])| Some((name.strip_suffix(*suffix)?, *units));
    SI.iter().find_map(of).unwrap_or((name, &[]))
}

/// The SI name of a field that is named with another unit, and that unit.
pub(super) fn si_name(name: &str) -> Option<(String, Unit)> {
    let of = |(suffix, units): &(&str, &'static [Unit])| {
        units.iter().find_map(|unit| Some((format!("{}{suffix}", name.strip_suffix(unit.suffix)?), *unit)))
    };
    // `stiffness_n_mm` is no length.
    SI.iter().find_map(of).filter(|(si, unit)| alternatives(si).1.contains(unit))
}

/// The name with another unit at its end, if the SI name's unit can be given in it.
pub(super) fn name_in(name: &str, unit: Unit) -> Option<String> {
    let (stem, units) = alternatives(name);
    units.contains(&unit).then(|| format!("{stem}{}", unit.suffix))
}

/// An SI name with its other units: `depth_m (or _in, _cm, _mm)`.
pub(super) fn with_units(name: &str) -> String {
    let (_, units) = alternatives(name);
    let suffixes: Vec<&str> = units.iter().map(|unit| unit.suffix).collect();
    if suffixes.is_empty() { name.to_owned() } else { format!("{name} (or {})", suffixes.join(", ")) }
}

impl Unit {
    /// A number of these units in SI units.
    pub(super) fn to_si(self, x: f64) -> f64 {
        match self.scale {
            Scale::Decimal(times, exponent) => scaled(x, times, exponent).unwrap_or(x),
            Scale::Degree => x * (PI / 180.0),
        }
    }

    /// A number in SI units in these, to rounding.
    pub(super) fn of_si(self, x: f64) -> f64 {
        match self.scale {
            Scale::Decimal(times, exponent) => scaled(x / times as f64, 1, -exponent).unwrap_or(x),
            Scale::Degree => x * (180.0 / PI),
        }
    }

    /// The number of at most 6 digits that in these units is exactly that number of SI units.
    pub(super) fn exactly(self, x: f64) -> Option<f64> {
        let short: f64 = format!("{:.5e}", self.of_si(x)).parse().ok()?;
        (self.to_si(short).to_bits() == x.to_bits()).then_some(short)
    }
}

/// The number nearest to `x * times * 10^exponent`, with `x` read as its shortest decimal; none if it is not finite.
fn scaled(x: f64, times: u128, exponent: i32) -> Option<f64> {
    let text = format!("{x:e}");
    let (mantissa, own) = text.split_once('e')?;
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let (sign, whole) = whole.strip_prefix('-').map_or(("", whole), |whole| ("-", whole));
    let digits = format!("{whole}{fraction}").parse::<u128>().ok()?.checked_mul(times)?;
    let exponent = own.parse::<i32>().ok()? + exponent - i32::try_from(fraction.len()).ok()?;
    format!("{sign}{digits}e{exponent}").parse().ok()
}

/// A range to 4 digits, rounded inward, so that both ends are accepted as they are shown.
pub(super) fn shown_within(min: f64, max: f64) -> [f64; 2] {
    [rounded_up(min), -rounded_up(-max)]
}

/// The least number of 4 digits that is no less.
fn rounded_up(x: f64) -> f64 {
    let to_digits = |x: f64| -> f64 { format!("{x:.3e}").parse().unwrap_or(x) };
    let near = to_digits(x);
    // What a conversion of units has rounded is not less.
    if !x.is_finite() || near >= x - 1e-12 * x.abs() {
        return near;
    }
    to_digits(near + 10.0_f64.powf(x.abs().log10().floor() - 3.0))
}
