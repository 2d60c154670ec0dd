//! A child process that forbids itself all system calls and works: the kernel kills it at the first one.
//!
//! A test that traps has an ignored test beside it, which is the child: it prepares, calls [`forbid`], works, and ends with
//! [`done`]. [`child`] runs it.

use std::process::{Command, ExitStatus};

use seccompiler::{BpfProgram, SeccompAction, SeccompFilter};

/// Exit code of a child that got to its end.
const DONE: i32 = 42;

/// From here on any system call of this thread kills the process, but for those that end it (they
/// release its signal stack too).
///
/// # Panics
/// If the kernel has no such filters.
pub fn forbid() {
    let filter = SeccompFilter::new(
        [libc::SYS_exit_group, libc::SYS_sigaltstack, libc::SYS_munmap].map(|call| (call, vec![])).into(),
        SeccompAction::KillProcess,
        SeccompAction::Allow,
        std::env::consts::ARCH.try_into().expect("a known architecture"),
    );
    let program: BpfProgram = filter.expect("a filter").try_into().expect("a program");
    seccompiler::apply_filter(&program).expect("a kernel that filters");
}

/// Ends a child with a status that tells its parent whether all went well.
pub fn done(well: bool) -> ! {
    std::process::exit(if well { DONE } else { 1 });
}

/// Runs an ignored test of this program in a process of its own.
///
/// # Panics
/// If there can be no process.
pub fn child(test: &str) -> ExitStatus {
    let mut command = Command::new(std::env::current_exe().expect("this test"));
    command.args(["--exact", test, "--ignored", "--nocapture"]);
    command.status().expect("a child")
}

/// Runs an ignored test of this program in a process of its own, which must get to its end.
///
/// # Panics
/// If it does not.
#[track_caller]
pub fn child_gets_to_its_end(test: &str) {
    let status = child(test);
    assert_eq!(status.code(), Some(DONE), "{test}: {status}");
}
