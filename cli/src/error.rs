//! Errors in the user's input, as opposed to failures while a command runs.
//!
//! Bad input ends a command with exit code 2, any other failure with 1.

pub use overhear_measure::error::BadInput;

/// Files that cannot be used: a line for each with what is wrong.
#[derive(Debug, thiserror::Error)]
#[error("{}", .0.join("; "))]
pub struct BadFiles(pub Vec<String>);

/// Exit code for an error: 2 for bad input, 1 for the rest.
pub fn exit_code(error: &anyhow::Error) -> u8 {
    if error.is::<BadInput>() || error.is::<BadFiles>() { 2 } else { 1 }
}

/// The printed text of an error: one line, or one for each of several bad files.
pub fn lines(error: &anyhow::Error) -> Vec<String> {
    match error.downcast_ref() {
        Some(BadFiles(lines)) => lines.clone(),
        None => vec![one_line(error)],
    }
}

/// An error and its causes in one line.
pub fn one_line(error: &anyhow::Error) -> String {
    format!("{error:#}").split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bad_input;
    use anyhow::Context;

    #[test]
    fn bad_input_exits_with_2_even_under_context() {
        let bare = bad_input!("piece is `gong`");
        assert_eq!(exit_code(&bare), 2);
        assert_eq!(exit_code(&Err::<(), _>(bare).context("hear").unwrap_err()), 2);
        assert_eq!(exit_code(&anyhow::anyhow!("the disk is full")), 1);
    }

    #[test]
    fn several_bad_files_have_a_line_each() {
        let error = anyhow::Error::new(BadFiles(vec!["a.toml: x".to_owned(), "b.toml: y".to_owned()]));
        assert_eq!((exit_code(&error), lines(&error)), (2, vec!["a.toml: x".into(), "b.toml: y".into()]));
        assert_eq!(lines(&bad_input!("c")), ["c"]);
    }

    #[test]
    fn an_error_of_several_lines_becomes_one() {
        let error = anyhow::anyhow!("a\nb").context("c");
        assert_eq!(one_line(&error), "c: a b");
    }
}
