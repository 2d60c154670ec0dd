//! What cannot be measured because of what was asked for, as opposed to what went wrong on the way.

/// Input that cannot be used: one line with the value and what is accepted.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct BadInput(pub String);

/// A [`BadInput`] from a format string, as an [`anyhow::Error`].
#[macro_export]
macro_rules! bad_input {
    ($($argument:tt)*) => {
        ::anyhow::Error::new($crate::error::BadInput(format!($($argument)*)))
    };
}
