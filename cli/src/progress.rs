//! Progress on standard error, if it is a terminal.

use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

/// A line that counts up to 100 % while something long goes on.
///
/// Written on terminals only; logs get the lines around it.
pub struct Progress {
    label: String,
    total: u64,
    done: u64,
    shown: Option<Instant>,
    visible: bool,
}

/// Between two updates of the line.
const INTERVAL: Duration = Duration::from_millis(100);

impl Progress {
    /// Starts at nothing of `total`.
    pub fn new(label: impl Into<String>, total: u64) -> Progress {
        let visible = std::io::stderr().is_terminal();
        Progress { label: label.into(), total, done: 0, shown: None, visible }
    }

    /// A line that is never written.
    pub fn hidden() -> Progress {
        Progress { label: String::new(), total: 0, done: 0, shown: None, visible: false }
    }

    /// Counts on.
    pub fn advance(&mut self, by: u64) {
        self.done += by;
        let due = self.shown.is_none_or(|shown| shown.elapsed() >= INTERVAL);
        if self.visible && due {
            self.shown = Some(Instant::now());
            let percent = 100 * self.done.min(self.total) / self.total.max(1);
            eprint!("\r\x1b[K{}: {percent} %", self.label);
            // Errors of a closed terminal are ignored.
            let _ = std::io::stderr().flush();
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.visible && self.shown.is_some() {
            eprint!("\r\x1b[K");
        }
    }
}
