//! Runs checks and tests and counts the results.

use std::fmt;
use std::io::{BufRead, BufReader};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Results so far.
#[derive(Debug, Default)]
pub struct Tally {
    /// Tests and checks that passed.
    pub passed: u64,
    /// Tests and checks that failed.
    pub failed: u64,
    times: Vec<(&'static str, Duration)>,
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} passed, {} failed", self.passed, self.failed)
    }
}

impl Tally {
    /// Prints how long each part took.
    pub fn print_times(&self) {
        println!();
        for (what, time) in &self.times {
            println!("{:>5} s  {what}", time.as_secs());
        }
    }
}

/// Announces a part.
pub fn heading(what: &str) {
    eprintln!("\n== {what}");
}

/// Runs a command that passes or fails as a whole.
pub fn check(tally: &mut Tally, what: &'static str, command: &mut Command) {
    heading(what);
    let begun = Instant::now();
    let passed = command.status().as_ref().is_ok_and(ExitStatus::success);
    tally.times.push((what, begun.elapsed()));
    if passed {
        tally.passed += 1;
    } else {
        eprintln!("{what}: failed");
        tally.failed += 1;
    }
}

/// Runs cargo's tests, passing on what they print, and adds up their own summaries.
pub fn tests(tally: &mut Tally, what: &'static str, command: &mut Command) {
    heading(what);
    let begun = Instant::now();
    let mut failed_before = tally.failed;
    let succeeded = command.stdout(Stdio::piped()).spawn().and_then(|mut child| {
        for line in child.stdout.take().into_iter().flat_map(|out| BufReader::new(out).lines()) {
            let line = line?;
            println!("{line}");
            if let Some((passed, failed)) = summary(&line) {
                tally.passed += passed;
                tally.failed += failed;
            }
        }
        Ok(child.wait()?.success())
    });
    tally.times.push((what, begun.elapsed()));
    // A test that does not compile, or takes its runner down, is in no summary.
    failed_before += u64::from(!succeeded.unwrap_or(false));
    tally.failed = tally.failed.max(failed_before);
}

/// Passed and failed tests in a line like `test result: ok. 12 passed; 0 failed; ...`.
fn summary(line: &str) -> Option<(u64, u64)> {
    let counts = line.strip_prefix("test result: ")?;
    let count = |what: &str| {
        let words: Vec<_> = counts.split_whitespace().collect();
        let place = words.iter().position(|word| word.trim_end_matches(';') == what)?;
        words[place.checked_sub(1)?].parse().ok()
    };
    Some((count("passed")?, count("failed")?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_runner_s_summary_is_understood() {
        let line = "test result: FAILED. 12 passed; 3 failed; 1 ignored; 0 measured; 0 filtered out";
        assert_eq!(summary(line), Some((12, 3)));
        assert_eq!(summary("test a_result ... ok"), None);
    }

    #[test]
    fn a_command_that_fails_without_a_summary_counts_as_one_failure() {
        let mut tally = Tally::default();
        tests(&mut tally, "nothing", &mut Command::new("no-such-program-anywhere"));
        check(&mut tally, "nothing", &mut Command::new("no-such-program-anywhere"));
        assert_eq!(tally.to_string(), "0 passed, 2 failed");
    }
}
