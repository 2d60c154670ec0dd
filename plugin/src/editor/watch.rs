//! Who wakes a window that rests.
//!
//! Drawing a still picture over and over is what costs most of a window at rest. So it is drawn once in a while only,
//! and a thread looks meanwhile, which costs next to nothing, whether something sounds, a parameter has been
//! moved, a note learned, another kit loaded, or a buffer was late; then it asks for a frame. It begins with the first frame,
//! as a window must not be asked to draw before it is shown, and has ended once the window's content is dropped: none of it
//! is left when a host unloads the plugin.

use std::hash::{DefaultHasher, Hasher};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use nice_plug::prelude::Param;

use crate::host_parameters::HostParameters;
use crate::monitor::Viewer;

/// How often it looks: soon enough for a first stroke to be seen as it is heard.
const LOOK: Duration = Duration::from_millis(15);

/// The shortest time there is for the framework.
const AT_ONCE: Duration = Duration::from_millis(1);

/// What the thread goes by.
#[derive(Default)]
struct Told {
    ends: AtomicBool,
    /// Whether frames come by themselves.
    moves: AtomicBool,
    /// What the latest frame showed, as a number.
    drawn: AtomicU64,
}

/// A thread that asks for frames; ends when dropped.
pub struct Watch {
    told: Arc<Told>,
    thread: Option<JoinHandle<()>>,
    viewer: Viewer,
    parameters: Arc<HostParameters>,
}

impl Watch {
    /// Begins to look. Without a thread the window is drawn once in a while all the same.
    pub fn new(context: egui::Context, viewer: Viewer, parameters: Arc<HostParameters>) -> Watch {
        let told = Arc::<Told>::default();
        told.drawn.store(seen(&viewer, &parameters), Ordering::Release);
        let thread = {
            let (told, viewer, parameters) = (told.clone(), viewer.clone(), parameters.clone());
            let look = move || {
                while !told.ends.load(Ordering::Acquire) {
                    thread::sleep(LOOK);
                    let rests = !told.moves.load(Ordering::Acquire);
                    if rests && seen(&viewer, &parameters) != told.drawn.load(Ordering::Acquire) {
                        // Asked for at once, egui draws two.
                        context.request_repaint_after(AT_ONCE);
                    }
                }
            };
            thread::Builder::new().name("overhear-watch".to_owned()).spawn(look).ok()
        };
        Watch { told, thread, viewer, parameters }
    }

    /// What a frame that begins now will show; to be taken before its snapshot.
    pub fn look(&self) -> u64 {
        seen(&self.viewer, &self.parameters)
    }

    /// Tells what was [seen](Self::look) and drawn, and whether frames go on by themselves.
    pub fn drawn(&self, seen: u64, moves: bool) {
        self.told.drawn.store(seen, Ordering::Release);
        self.told.moves.store(moves, Ordering::Release);
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.told.ends.store(true, Ordering::Release);
        if let Some(thread) = self.thread.take() {
            // It panics no more than what it calls; a window that closes has nothing to do about it.
            let _ = thread.join();
        }
    }
}

/// What a resting window would look different by, as a number: which kit it is and what it does, where parameters are, what
/// notes play, what arrived, and buffers that were late.
fn seen(viewer: &Viewer, parameters: &HostParameters) -> u64 {
    let mut hasher = DefaultHasher::new();
    let places = parameters.values().iter().map(|value| value.unmodulated_normalized_value());
    places.for_each(|place| hasher.write_u32(place.to_bits()));
    // The window keeps the document that it shows: no other can be at the same address.
    let document = Arc::as_ptr(&parameters.document()).addr() as u64;
    let assigned = parameters.assignments().fingerprint();
    let refused = parameters.refused_rate().map_or(0, |rate| 1 + u64::from(rate.to_bits()));
    let (late, arrived) = (parameters.deadlines().late(), parameters.monitor().count());
    let rest = [viewer.news(), document, assigned, late, refused, arrived];
    rest.into_iter().for_each(|number| hasher.write_u64(number));
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::monitor;
    use std::sync::atomic::AtomicUsize;
    use std::time::Instant;

    #[test]
    fn what_happens_wakes_a_window_and_silence_does_not() {
        let context = egui::Context::default();
        let asked = Arc::<AtomicUsize>::default();
        let count = asked.clone();
        context.set_request_repaint_callback(move |_| {
            count.fetch_add(1, Ordering::AcqRel);
        });
        let (_publisher, viewer) = monitor::monitor();
        let parameters = Arc::<HostParameters>::default();
        let watch = Watch::new(context.clone(), viewer, parameters.clone());
        thread::sleep(4 * LOOK);
        assert_eq!(asked.load(Ordering::Acquire), 0);
        parameters.assignments().learn(Some(38));
        let begun = Instant::now();
        while asked.load(Ordering::Acquire) == 0 {
            assert!(begun.elapsed() < Duration::from_secs(10), "nobody asks for a frame");
            thread::sleep(LOOK);
        }
        // Once it is drawn, or while frames come anyway, nothing more is asked for.
        let frame = || context.run_ui(egui::RawInput::default(), |_| ()).textures_delta.clear();
        for (shown, moves) in [(watch.look(), false), (0, true)] {
            watch.drawn(shown, moves);
            thread::sleep(4 * LOOK);
            // A new window's first frames ask for more by themselves.
            (0..4).for_each(|_| frame());
            let before = asked.load(Ordering::Acquire);
            thread::sleep(4 * LOOK);
            assert_eq!(asked.load(Ordering::Acquire), before);
        }
        drop(watch);
    }

    #[test]
    fn another_kit_looks_different() {
        let (_publisher, viewer) = monitor::monitor();
        let parameters = HostParameters::default();
        let shown = parameters.document();
        let before = seen(&viewer, &parameters);
        assert_eq!(seen(&viewer, &parameters), before);
        let mut other = (*shown).clone();
        other.notes.set(37, None);
        parameters.set_document(Arc::new(other)).unwrap();
        assert_ne!(seen(&viewer, &parameters), before);
    }
}
