//! What is wrong with a value asked for on a command line or in a preset.

/// What is wrong with a `name=value`.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ParameterError {
    /// Not of the form `name=value`.
    #[error("`{given}` is not of the form name=value, as in {example}")]
    Syntax {
        /// The text given.
        given: String,
        /// One that is of the form.
        example: String,
    },
    /// No parameter has that name.
    #[error("no parameter is called `{name}`, accepted: {accepted}")]
    Unknown {
        /// The name given.
        name: String,
        /// Every name, separated by commas.
        accepted: String,
    },
    /// The slot is empty, or its piece has no such control.
    #[error("{name} does nothing: {reason}")]
    Inert {
        /// The parameter's name.
        name: String,
        /// Why it does nothing.
        reason: String,
    },
    /// The value is not a number.
    #[error("{name} is `{given}`, accepted: {min} to {max}{unit}")]
    NotANumber {
        /// The parameter's name.
        name: String,
        /// The text given.
        given: String,
        /// Smallest accepted.
        min: f32,
        /// Largest accepted.
        max: f32,
        /// Unit of both.
        unit: &'static str,
    },
    /// The value lies outside the range.
    #[error("{name} is {value}, accepted: {min} to {max}{unit}")]
    OutOfRange {
        /// The parameter's name.
        name: String,
        /// The value given.
        value: f64,
        /// Smallest accepted.
        min: f32,
        /// Largest accepted.
        max: f32,
        /// Unit of both.
        unit: &'static str,
    },
}
