//! The program as somebody without a host starts it.

use std::process::{Child, Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use x11rb::connection::Connection;
use x11rb::protocol::xproto::{AtomEnum, ConnectionExt, MapState, Window};
use x11rb::rust_connection::RustConnection;

/// How long a window may take: the kit is built first.
const PATIENCE: Duration = Duration::from_secs(60);

fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_overhear-standalone"))
}

/// Ends the program however the test does.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn run(arguments: &[&str]) -> Output {
    program().args(arguments).stdin(Stdio::null()).output().expect("the program starts")
}

/// A window of the name that is shown, if there is one.
fn window(display: &RustConnection, screen: usize, name: &str) -> Option<Window> {
    let root = display.setup().roots[screen].root;
    let children = display.query_tree(root).ok()?.reply().ok()?.children;
    children.into_iter().find(|&child| {
        let title = display.get_property(false, child, AtomEnum::WM_NAME, AtomEnum::ANY, 0, 64);
        let titled = title
            .ok()
            .and_then(|title| title.reply().ok())
            .is_some_and(|title| title.value == name.as_bytes());
        let shown = display.get_window_attributes(child).ok().and_then(|window| window.reply().ok());
        titled && shown.is_some_and(|window| window.map_state == MapState::VIEWABLE)
    })
}

#[test]
fn it_opens_its_window_and_stays_on_the_dummy_backend() {
    let (display, screen) =
        x11rb::connect(None).expect("a display: run `cargo xtask test`, which brings its own");
    let started =
        program().args(["--backend", "dummy", "--sample-rate", "44100", "--period-size", "64"]).spawn();
    let mut running = Running(started.expect("the program starts"));
    let begun = Instant::now();
    while window(&display, screen, "Overhear").is_none() {
        assert!(begun.elapsed() < PATIENCE, "no window");
        assert_eq!(running.0.try_wait().unwrap(), None, "it ended before it had a window");
        thread::sleep(Duration::from_millis(50));
    }
    thread::sleep(Duration::from_secs(1));
    assert_eq!(running.0.try_wait().unwrap(), None, "it does not stay");
}

#[test]
fn it_tells_its_options_and_refuses_what_it_does_not_know() {
    let help = run(&["--help"]);
    assert!(help.status.success());
    let help = String::from_utf8_lossy(&help.stdout).into_owned();
    for option in ["--backend", "--midi-input", "--connect-jack-midi-input", "--sample-rate"] {
        assert!(help.contains(option), "{option} is not told");
    }
    for refused in [&["--backend", "tape"][..], &["--sample-rate", "fast"], &["--loud"]] {
        let refusal = run(refused);
        assert!(!refusal.status.success(), "{refused:?}");
        let said = String::from_utf8_lossy(&refusal.stderr).into_owned();
        assert!(said.contains(refused[0]), "{said}");
    }
}
