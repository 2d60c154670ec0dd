//! Resources of an instance in a host: scan time, memory, threads, and their release.

use std::time::{Duration, Instant};

use overhear_cli::host::{Bundle, Event, What};
use overhear_cli::plugin_folders::Format;

use crate::{alone, bundle_path, instance};

/// Longest time for a look at the plugin, were this machine doing nothing else.
const SCAN: Duration = Duration::from_millis(50);

/// Threads of this process by name.
#[cfg(target_os = "linux")]
fn threads_named(name: &str) -> usize {
    let tasks = std::fs::read_dir("/proc/self/task").unwrap();
    let names = tasks.flatten().filter_map(|task| std::fs::read_to_string(task.path().join("comm")).ok());
    names.filter(|found| found.trim() == name).count()
}

/// Memory in use, bytes.
#[cfg(target_os = "linux")]
fn resident() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse::<u64>().unwrap() * 1024
}

#[test]
fn a_host_s_scan_builds_nothing_and_is_short() {
    let _turn = alone();
    let path = bundle_path(Format::Clap);
    let scan = || {
        let begun = Instant::now();
        let bundle = Bundle::load(&path).unwrap();
        for plugin in bundle.plugins() {
            let mut instance = bundle.instantiate_id(plugin.id.to_str().unwrap()).unwrap();
            assert!(!instance.audio_outputs().unwrap().is_empty());
        }
        begun.elapsed()
    };
    // The shortest of several: others use this machine as well.
    let shortest = (0..10).map(|_| scan()).min().unwrap();
    assert!(shortest < SCAN, "{shortest:?}");
    println!("a scan takes {shortest:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_hundred_instances_leave_no_thread_and_little_memory() {
    const BUILDER: &str = "overhear-builde";
    let _turn = alone();
    let one = || {
        let mut instance = instance();
        assert_eq!(threads_named(BUILDER), 0, "an instance that is only looked at builds nothing");
        instance
            .run(48_000.0, 1..=64, |processor| {
                let note = Event { offset: 0, what: What::NoteOn { channel: 9, key: 38, velocity: 1.0 } };
                processor.process(&[note], &mut [0.0; 64], &mut [0.0; 64])
            })
            .unwrap();
        assert_eq!(threads_named(BUILDER), 1);
        resident()
    };
    let before = resident();
    // Less than nothing if what another test has left is given back meanwhile.
    let built = one().saturating_sub(before);
    assert!(built < 150 << 20, "a kit takes {} MB", built >> 20);
    println!("a kit takes {} MB", built >> 20);
    assert_eq!(threads_named(BUILDER), 0);
    for _ in 0..4 {
        one();
    }
    let settled = resident();
    // Most are gone before they are built, as when a project is closed while it loads.
    for _ in 0..95 {
        drop(instance());
    }
    assert_eq!(threads_named(BUILDER), 0);
    let grown = resident().saturating_sub(settled);
    assert!(grown < 16 << 20, "95 instances leave {} MB", grown >> 20);
}
