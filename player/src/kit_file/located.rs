//! What is wrong with a field, named as the file names it.

use overhear_engine::error::SpecError;

use super::error::{Fault, shortened};
use super::source::Origins;
use super::units::shown_within;

impl Fault {
    /// A fault of the field of that path in SI names; the reason follows the field as the file names it.
    pub(super) fn of(path: &str, origins: &Origins, reason: &str) -> Fault {
        let found = origins.locate(path);
        Fault::new(found.at, format!("{} {reason}", found.path))
    }

    /// What a check of the kit refuses, as the file names it and in the file's units.
    pub(super) fn of_spec(error: &SpecError, origins: &Origins) -> Fault {
        let path = error.field();
        let found = origins.locate(path);
        match error {
            SpecError::OutOfRange { value, min, max, .. } => {
                let [value, min, max] =
                    [*value, *min, *max].map(|x| found.unit.map_or(x, |unit| unit.of_si(x)));
                let value = found.literal.map_or_else(|| value.to_string(), shortened);
                let [min, max] = shown_within(min, max);
                Fault::new(found.at, format!("{} is {value}, accepted: {min} to {max}", found.path))
            }
            // The reason may contain the value in SI units, so the field goes by its SI name.
            SpecError::Refused { reason, .. } => Fault::new(found.at, format!("{path} {reason}")),
        }
    }
}
