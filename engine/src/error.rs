//! What is wrong with a description, said once, where it enters.

/// A description that cannot be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SpecError {
    /// A number lies outside the range the physics or the tables hold for.
    #[error("{field} is {value}, accepted: {min} to {max}")]
    OutOfRange {
        /// What the number describes.
        field: &'static str,
        /// The number given.
        value: f64,
        /// Smallest accepted.
        min: f64,
        /// Largest accepted.
        max: f64,
    },
}

impl SpecError {
    /// Passes `value` through if it lies in `min..=max` (a NaN does not), all in the unit that `field` names.
    ///
    /// # Errors
    /// [`SpecError::OutOfRange`] naming the field, the value and the range.
    pub fn check(field: &'static str, value: f64, min: f64, max: f64) -> Result<f64, SpecError> {
        if (min..=max).contains(&value) {
            Ok(value)
        } else {
            Err(SpecError::OutOfRange { field, value, min, max })
        }
    }
}
