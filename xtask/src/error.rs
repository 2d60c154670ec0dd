//! What is wrong with what the user gave, as opposed to what went wrong on the way.
//!
//! Bad input ends a command with exit code 2, anything else that fails with 1.

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

/// Exit code for an error: 2 for bad input, 1 for the rest.
pub fn exit_code(error: &anyhow::Error) -> u8 {
    if error.is::<BadInput>() { 2 } else { 1 }
}

/// An error and its causes in one line.
pub fn one_line(error: &anyhow::Error) -> String {
    format!("{error:#}").split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::Context;

    #[test]
    fn bad_input_exits_with_2_even_under_context() {
        let bare = bad_input!("piece is `gong`");
        assert_eq!(exit_code(&bare), 2);
        assert_eq!(exit_code(&Err::<(), _>(bare).context("hear").unwrap_err()), 2);
        assert_eq!(exit_code(&anyhow::anyhow!("the disk is full")), 1);
    }

    #[test]
    fn an_error_of_several_lines_becomes_one() {
        let error = anyhow::anyhow!("a\nb").context("c");
        assert_eq!(one_line(&error), "c: a b");
    }
}
