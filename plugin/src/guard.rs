//! Panics, caught where a host or the framework calls the plugin.
//!
//! A panic that leaves an `extern "C"` function ends the process, and the host's project with it. The framework's own entry
//! points are such functions, so that nothing can be caught around them: whatever of the plugin they call is caught inside.
//! Where the framework is called through plain functions, as in the VST3 interfaces, its own panics are caught too.

use std::panic::{AssertUnwindSafe, catch_unwind};

use nice_plug::nice_error;
use nice_plug::util::permit_alloc;

/// The result of `work`, or `otherwise` if it panics. `entry` names the call in the log.
///
/// # Real-time
/// Costs nothing as long as nothing panics.
pub fn caught<T>(entry: &'static str, otherwise: T, work: impl FnOnce() -> T) -> T {
    let run = || catch_unwind(AssertUnwindSafe(work));
    #[cfg(test)]
    let run = || failing::run(entry, run);
    run().unwrap_or_else(|payload| {
        // After a panic on the audio thread its deadline is lost in any case.
        permit_alloc(|| {
            nice_error!("A panic in {entry} was kept from the host");
            // A payload may panic as it is dropped.
            std::mem::forget(payload);
        });
        otherwise
    })
}

/// Panics on demand: only tests have them.
#[cfg(test)]
pub mod failing {
    use std::cell::Cell;
    use std::panic::{AssertUnwindSafe, catch_unwind};
    use std::thread;

    use nice_plug::util::permit_alloc;

    thread_local! {
        static ENTRY: Cell<Option<&'static str>> = const { Cell::new(None) };
        static COUNT: Cell<u32> = const { Cell::new(0) };
    }

    /// Calls `host` while the entry of that name panics on this thread, and says how often it did.
    pub fn while_panicking<T>(entry: &'static str, host: impl FnOnce() -> T) -> (T, u32) {
        COUNT.set(0);
        ENTRY.set(Some(entry));
        let result = host();
        ENTRY.set(None);
        (result, COUNT.get())
    }

    /// Runs what is guarded, or panics in its place.
    pub fn run<T>(entry: &'static str, run: impl FnOnce() -> thread::Result<T>) -> thread::Result<T> {
        if ENTRY.get() != Some(entry) {
            return run();
        }
        COUNT.set(COUNT.get() + 1);
        // The framework aborts debug builds that allocate while they process; unwinding does.
        permit_alloc(|| catch_unwind(AssertUnwindSafe(|| panic!("a panic in {entry}, on demand"))))
    }
}
