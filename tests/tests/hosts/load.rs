//! Time of loading in a host that reads and moves every parameter of a plugin while it loads it: pedalboard.

use std::process::Command;

use overhear_cli::plugin_folders::Format;
use serde_json::Value;

use crate::vst3::python;
use crate::{alone, bundle_path, here};

/// Most parameters that a host has to try one by one. With one for every controller of every channel there were over two thousand, and
/// loading took half a minute.
const MOST: f64 = 400.0;

/// Loads a plugin of the bundle and plays a note.
fn loaded(plugin: &str) -> Value {
    let output = Command::new(python())
        .arg(here("hosts/pedalboard_load.py"))
        .arg(bundle_path(Format::Vst3))
        .arg(plugin)
        // As in `through_python`: without a display JUCE opens no window.
        .env("DISPLAY", ":65000")
        .output()
        .expect("Python");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "pedalboard failed ({}): {said}", output.status);
    serde_json::from_slice(&output.stdout).expect("figures")
}

#[test]
fn pedalboard_loads_each_instrument_and_has_few_parameters_to_try() {
    let _turn = alone();
    for plugin in ["Overhear", "Overhear Multi"] {
        // The first load may have to compute what later ones find in the cache.
        let all = [loaded(plugin), loaded(plugin)];
        let figure = |name: &str| all[1][name].as_f64().expect("a figure");
        println!("{plugin}: {} {}", all[0], all[1]);
        assert!(figure("peak") > 0.01, "{plugin} is silent");
        let parameters = figure("parameters");
        assert!(parameters > 100.0 && parameters < MOST, "{plugin} has {parameters} parameters");
    }
}
