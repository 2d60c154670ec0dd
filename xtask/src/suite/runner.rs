//! Runs checks and tests and counts the results.

use std::fmt;
use std::io;
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Results so far.
#[derive(Debug)]
pub struct Tally {
    /// Tests and checks that passed.
    pub passed: u64,
    /// Tests and checks that failed.
    pub failed: u64,
    /// What failed, by name.
    failures: Vec<String>,
    begun: Instant,
    times: Vec<(String, Duration)>,
}

impl Default for Tally {
    fn default() -> Tally {
        Tally { passed: 0, failed: 0, failures: Vec::new(), begun: Instant::now(), times: Vec::new() }
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} passed, {} failed", self.passed, self.failed)
    }
}

impl Tally {
    /// Prints how long each part took, and all of them, some of which ran beside each other.
    pub fn print_times(&self) {
        println!();
        for (what, time) in &self.times {
            println!("{:>5} s  {what}", time.as_secs());
        }
        println!("{:>5} s  in all", self.begun.elapsed().as_secs());
    }

    /// Prints the name of everything that failed: what was printed about it may be far above, or cut off.
    pub fn print_failures(&self) {
        for failure in &self.failures {
            println!("failed: {failure}");
        }
    }

    /// Counts one failure.
    pub fn fail(&mut self, what: &str) {
        self.failed += 1;
        self.failures.push(what.to_owned());
    }

    /// Notes how long a part took.
    pub fn took(&mut self, what: &str, time: Duration) {
        self.times.push((what.to_owned(), time));
    }

    /// Adds up the summaries in what a program of tests has printed, and notes the names of those that failed.
    pub fn count(&mut self, what: &str, said: &str, succeeded: bool) {
        let mut summed = (0, 0);
        for (passed, failed) in said.lines().filter_map(summary) {
            summed = (summed.0 + passed, summed.1 + failed);
        }
        self.passed += summed.0;
        self.failed += summed.1;
        let names = said.lines().filter_map(|line| line.strip_prefix("test ")?.strip_suffix(" ... FAILED"));
        self.failures.extend(names.map(|name| format!("{what}, {name}")));
        // A test that does not compile, or takes its runner down, is in no summary.
        if summed.1 == 0 && !succeeded {
            self.fail(what);
        }
    }
}

/// Announces a part.
pub fn heading(what: &str) {
    eprintln!("\n== {what}");
}

/// Runs a command that passes or fails as a whole.
pub fn check(tally: &mut Tally, what: &str, command: &mut Command) {
    let passed = timed(tally, what, || command.status());
    tally.passed += u64::from(passed);
}

/// Runs something that must succeed before others can, and counts only its failure.
pub fn timed(tally: &mut Tally, what: &str, run: impl FnOnce() -> io::Result<ExitStatus>) -> bool {
    heading(what);
    let begun = Instant::now();
    let passed = run().as_ref().is_ok_and(ExitStatus::success);
    tally.took(what, begun.elapsed());
    if !passed {
        eprintln!("{what}: failed");
        tally.fail(what);
    }
    passed
}

/// Runs cargo's tests, passing on what they print, and adds up their own summaries.
pub fn tests(tally: &mut Tally, what: &str, command: &mut Command) {
    heading(what);
    let begun = Instant::now();
    let output = command.stderr(Stdio::inherit()).output();
    let said = output.as_ref().map(|output| String::from_utf8_lossy(&output.stdout));
    let said = said.unwrap_or_default();
    print!("{said}");
    tally.took(what, begun.elapsed());
    tally.count(what, &said, output.as_ref().is_ok_and(|output| output.status.success()));
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
    fn tests_that_failed_are_known_by_their_names() {
        let said =
            "test a::b ... ok\ntest a::c ... FAILED\ntest result: FAILED. 1 passed; 1 failed; 0 ignored";
        let mut tally = Tally::default();
        tally.count("units", said, false);
        tally.count("aborted", "", false);
        assert_eq!(tally.to_string(), "1 passed, 2 failed");
        assert_eq!(tally.failures, ["units, a::c", "aborted"]);
    }

    #[test]
    fn a_command_that_fails_without_a_summary_counts_as_one_failure() {
        let mut tally = Tally::default();
        tests(&mut tally, "nothing", &mut Command::new("no-such-program-anywhere"));
        check(&mut tally, "nothing", &mut Command::new("no-such-program-anywhere"));
        assert_eq!(tally.to_string(), "0 passed, 2 failed");
    }
}
