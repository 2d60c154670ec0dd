//! The built bundles in real hosts: CLAP in the commands' own host, VST3 in DawDreamer.
//!
//! `cargo xtask test` builds the release bundles first and sets the VST3 host up. Run by hand,
//! the tests take what `cargo xtask bundle` left in the target folder, and fail without it.

#[cfg(target_os = "linux")]
#[path = "hosts/ardour.rs"]
mod ardour;
#[cfg(target_os = "linux")]
#[path = "hosts/building.rs"]
mod building;
#[path = "hosts/description.rs"]
mod description;
#[cfg(target_os = "linux")]
#[path = "hosts/hand.rs"]
mod hand;
#[path = "hosts/identity.rs"]
mod identity;
#[path = "hosts/kits.rs"]
mod kits;
#[path = "hosts/lifecycle.rs"]
mod lifecycle;
#[path = "hosts/load.rs"]
mod load;
#[path = "hosts/midi.rs"]
mod midi;
#[path = "hosts/multi.rs"]
mod multi;
#[path = "hosts/resources.rs"]
mod resources;
#[cfg(target_os = "linux")]
#[path = "hosts/scale.rs"]
mod scale;
#[path = "hosts/score.rs"]
mod score;
#[path = "hosts/songs.rs"]
mod songs;
#[path = "hosts/state.rs"]
mod state;
#[path = "hosts/vst3.rs"]
mod vst3;
#[cfg(target_os = "linux")]
#[path = "hosts/vst3_window.rs"]
mod vst3_window;
#[cfg(target_os = "linux")]
#[path = "hosts/window.rs"]
mod window;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use overhear::parameters::{host_id, parameters, parse_assignment};
use overhear_cli::host::{Bundle, Instance};
use overhear_cli::plugin_folders::Format;
use overhear_engine::kit_spec::KitSpec;
use xtask::workspace::bundle_in;

/// The release bundle of a format.
fn bundle_path(format: Format) -> PathBuf {
    let test = std::env::current_exe().expect("the test's own path");
    // target/debug/deps/hosts-0123
    let target = test.ancestors().nth(3).expect("a target folder");
    let path = bundle_in(target, format);
    assert!(path.exists(), "no bundle at {}: run `cargo xtask bundle` first", path.display());
    path
}

/// An instance of the built CLAP plugin, whose main thread is this one.
fn instance() -> Instance {
    let bundle = Bundle::load(&bundle_path(Format::Clap)).expect("a CLAP bundle");
    bundle.instantiate().expect("an instance")
}

/// A parameter of the standard kit, by its place in the table, and its value: `kick_tune=62` is a pitch in Hz.
fn setting(text: &str) -> (usize, f32) {
    parse_assignment(text, &KitSpec::standard()).expect("a parameter and a value")
}

/// A parameter's value as CLAP hosts have it: by its number, and as a share of the range or the number of a step.
fn as_hosts_have_it((index, value): (usize, f32)) -> (u32, f64) {
    let parameter = &parameters()[index];
    (host_id(parameter.id), parameter.in_clap(value))
}

/// One test at a time: each builds kits, and a plugin that waits too long for its kit starts
/// without it, as it should on a machine that cannot keep up.
fn alone() -> MutexGuard<'static, ()> {
    static TURN: Mutex<()> = Mutex::new(());
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Tells the other thread to stop, whatever ends this one's work.
struct Stop<'a>(&'a AtomicBool);

impl Drop for Stop<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}

/// A file of this package.
fn here(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}
