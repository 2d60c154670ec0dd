//! Test programs, built by cargo and run beside each other.
//!
//! Cargo runs one program at a time, and many of them keep one processor busy for most of their time. Here cargo only
//! builds. As many programs then run at once as there are processors, each with one thread; what a program prints appears
//! when it has ended. Programs in a [`Row`] use the same files and follow one another.

use std::collections::VecDeque;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Instant;

use serde_json::Value;

use super::runner::{Tally, heading, timed};

/// A test program and what it is started with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Program {
    /// Name of its target.
    pub target: String,
    /// What it is called in the output.
    pub name: String,
    path: PathBuf,
    /// Where cargo would start it.
    folder: PathBuf,
    arguments: Vec<&'static str>,
}

impl Program {
    /// The same program under another name and with further arguments.
    pub fn with(&self, name: &str, arguments: &[&'static str]) -> Program {
        let arguments = [&self.arguments[..], arguments].concat();
        Program { name: name.to_owned(), arguments, ..self.clone() }
    }

    /// A program of no file.
    #[cfg(test)]
    pub fn of(target: &str) -> Program {
        let [target, name] = [target, target].map(str::to_owned);
        Program { target, name, path: PathBuf::new(), folder: PathBuf::new(), arguments: Vec::new() }
    }

    /// The program in one line of cargo's messages, if it names one.
    fn in_message(line: &str) -> Option<Program> {
        let message: Value = serde_json::from_str(line).ok()?;
        let path = PathBuf::from(message["executable"].as_str()?);
        if message["reason"] != "compiler-artifact" || message["profile"]["test"] != true {
            return None;
        }
        let folder = Path::new(message["manifest_path"].as_str()?).parent()?.to_path_buf();
        let target = message["target"]["name"].as_str()?.to_owned();
        let kind = message["target"]["kind"][0].as_str()?;
        let package = folder.file_name()?.to_string_lossy();
        let name = match kind {
            "test" => target.clone(),
            "bin" => format!("units of {package}, the program"),
            _ => format!("units of {package}"),
        };
        Some(Program { target, name, path, folder, arguments: vec!["--test-threads=1"] })
    }
}

/// Programs that follow one another.
pub type Row = Vec<Program>;

/// Has cargo build test programs, and tells which.
pub fn built(tally: &mut Tally, what: &str, cargo: &mut Command) -> Vec<Program> {
    cargo.args(["--no-run", "--message-format", "json-render-diagnostics"]).stdout(Stdio::piped());
    let mut programs = Vec::new();
    timed(tally, what, || {
        let mut child = cargo.spawn()?;
        for line in child.stdout.take().into_iter().flat_map(|out| BufReader::new(out).lines()) {
            programs.extend(Program::in_message(&line?));
        }
        child.wait()
    });
    programs
}

/// Runs every row, as many at once as there are processors, those that come first first.
pub fn run(tally: &mut Tally, rows: Vec<Row>, environment: &[(&str, &Path)]) {
    let lanes = thread::available_parallelism().map_or(1, usize::from);
    let programs: usize = rows.iter().map(Vec::len).sum();
    eprintln!("\n{programs} programs of tests, {lanes} at once; each prints its results when it has ended");
    let (rows, tally) = (Mutex::new(VecDeque::from(rows)), Mutex::new(tally));
    // What one lane leaves behind when it panics is still in order.
    let next = || rows.lock().unwrap_or_else(PoisonError::into_inner).pop_front();
    thread::scope(|scope| {
        for _ in 0..lanes {
            scope.spawn(|| {
                while let Some(row) = next() {
                    for program in row {
                        let begun = Instant::now();
                        let (said, succeeded) = output(&program, environment).unwrap_or_else(|error| {
                            (format!("cannot run `{}`: {error}\n", program.path.display()), false)
                        });
                        let mut tally = tally.lock().unwrap_or_else(PoisonError::into_inner);
                        heading(&program.name);
                        print!("{said}");
                        tally.count(&program.name, &said, succeeded);
                        tally.took(&program.name, begun.elapsed());
                    }
                }
            });
        }
    });
}

/// Runs a program: what it prints, and whether it succeeds.
fn output(program: &Program, environment: &[(&str, &Path)]) -> io::Result<(String, bool)> {
    let (mut said, pipe) = io::pipe()?;
    let mut child = {
        let mut command = Command::new(&program.path);
        command.args(&program.arguments).current_dir(&program.folder);
        command.env("CARGO_MANIFEST_DIR", &program.folder).envs(environment.iter().copied());
        command.stdin(Stdio::null()).stdout(pipe.try_clone()?).stderr(pipe);
        command.spawn()?
    };
    let mut bytes = Vec::new();
    said.read_to_end(&mut bytes)?;
    Ok((String::from_utf8_lossy(&bytes).into_owned(), child.wait()?.success()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A script of the system's shell in place of a program of tests.
    #[cfg(unix)]
    fn script(text: &'static str) -> Program {
        let (path, folder) = (PathBuf::from("sh"), std::env::temp_dir());
        Program { path, folder, arguments: vec!["-c", text], ..Program::of("script") }
    }

    #[test]
    #[cfg(unix)]
    fn every_row_is_run_in_its_order_and_every_result_is_counted() {
        let folder = std::env::temp_dir().join(format!("overhear-programs-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let first = "sleep 0.2; touch $FOLDER/first; echo 'test result: ok. 5 passed; 0 failed;'";
        let second = "test -e $FOLDER/first && echo 'test result: FAILED. 2 passed; 1 failed;'; false";
        let rows = vec![
            vec![script(first), script(second)],
            // Without a summary, on its way down.
            vec![script("echo 'test result: ok. 1 passed; 0 failed;' >&2; kill $$")],
            vec![Program { path: "no-such-program-anywhere".into(), ..script("") }],
        ];
        let mut tally = Tally::default();
        run(&mut tally, rows, &[("FOLDER", &folder)]);
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(tally.to_string(), "8 passed, 3 failed");
    }

    #[test]
    fn cargo_s_messages_name_the_programs() {
        let message = |reason: &str, test: bool, executable: &str| {
            format!(
                r#"{{"reason":"{reason}","manifest_path":"/here/tests/Cargo.toml","target":{{"kind":["test"],"name":"hosts"}},"profile":{{"test":{test}}},"executable":{executable}}}"#
            )
        };
        let program = Program::in_message(&message("compiler-artifact", true, r#""/here/hosts-0""#)).unwrap();
        assert_eq!((&*program.target, &*program.name), ("hosts", "hosts"));
        assert_eq!((program.path, program.folder), ("/here/hosts-0".into(), "/here/tests".into()));
        for other in [
            message("compiler-artifact", false, r#""/here/overhear""#),
            message("compiler-artifact", true, "null"),
            message("build-finished", true, r#""/here/hosts-0""#),
            "no message".to_owned(),
        ] {
            assert_eq!(Program::in_message(&other), None, "{other}");
        }
    }
}
