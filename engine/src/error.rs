//! What is wrong with a description, said once, where it enters.

/// A description that cannot be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SpecError {
    /// A number lies outside the range the physics or the tables hold for.
    #[error("{field} is {value}, accepted: {min} to {max}")]
    OutOfRange {
        /// Path of the number in the description: `pieces.snare.diameter_m`.
        field: String,
        /// The number given.
        value: f64,
        /// Smallest accepted.
        min: f64,
        /// Largest accepted.
        max: f64,
    },
    /// Parts that do not fit each other, or something that is no number and not accepted.
    #[error("{field} {reason}")]
    Refused {
        /// Path of what is refused in the description.
        field: String,
        /// What is wrong, and what is accepted.
        reason: String,
    },
}

impl SpecError {
    /// Passes `value` through if it lies in `min..=max` (a NaN does not), all in the unit that `field` names.
    ///
    /// # Errors
    /// [`SpecError::OutOfRange`] naming the field, the value and the range.
    pub fn check(field: &str, value: f64, min: f64, max: f64) -> Result<f64, SpecError> {
        if (min..=max).contains(&value) {
            Ok(value)
        } else {
            Err(SpecError::OutOfRange { field: field.to_owned(), value, min, max })
        }
    }

    /// A refusal for a reason, which says what is accepted.
    pub fn refused(field: &str, reason: impl Into<String>) -> SpecError {
        SpecError::Refused { field: field.to_owned(), reason: reason.into() }
    }

    /// The path of what is wrong.
    pub fn field(&self) -> &str {
        match self {
            SpecError::OutOfRange { field, .. } | SpecError::Refused { field, .. } => field,
        }
    }

    /// The same error of a part of a larger description: `batter` turns `thickness_m` into `batter.thickness_m`.
    #[must_use]
    pub fn inside(mut self, part: &str) -> SpecError {
        let (SpecError::OutOfRange { field, .. } | SpecError::Refused { field, .. }) = &mut self;
        *field = if field.is_empty() { part.to_owned() } else { format!("{part}.{field}") };
        self
    }
}
