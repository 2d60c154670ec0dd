//! Numbers on the command line, and what is accepted of them.

/// A number from `least` (left out if `open`) to `most`.
pub(super) fn number(text: &str, least: f64, open: bool, most: f64, unit: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value <= most && (value > least || (value == least && !open)) => Ok(value),
        _ if open => Err(format!("accepted: above {least} to {most}{unit}")),
        _ => Err(format!("accepted: {least} to {most}{unit}")),
    }
}

/// Reads an angle, degrees.
pub(super) fn angle(text: &str) -> Result<f64, String> {
    number(text, -360.0, false, 360.0, " degrees")
}
