//! Who wakes a window that rests.
//!
//! Drawing a still picture over and over is what costs most of a window at rest. So it is drawn once in a while only,
//! and a thread looks meanwhile, which costs next to nothing, whether something sounds or a parameter has been
//! moved; then it asks for a frame. It begins with the first frame, as a window must not be asked to draw before it is
//! shown, and has ended once the window's content is dropped: none of it is left when a host unloads the plugin.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use nice_plug::prelude::Param;

use crate::host_parameters::HostParameters;
use crate::sound::Sound;

/// How often it looks: soon enough for a first stroke to be seen as it is heard.
const LOOK: Duration = Duration::from_millis(15);

/// A thread that asks for frames; ends when dropped.
pub struct Watch {
    ends: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Watch {
    /// Begins to look. Without a thread the window is drawn once in a while all the same.
    pub fn new(context: egui::Context, sound: Sound, parameters: Arc<HostParameters>) -> Watch {
        let ends = Arc::<AtomicBool>::default();
        let told = ends.clone();
        let look = move || {
            let mut known = Seen::of(&sound, &parameters);
            while !told.load(Ordering::Acquire) {
                thread::sleep(LOOK);
                let seen = Seen::of(&sound, &parameters);
                if seen != known {
                    context.request_repaint();
                }
                known = seen;
            }
        };
        let thread = thread::Builder::new().name("overhear-watch".to_owned()).spawn(look).ok();
        Watch { ends, thread }
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Release);
        if let Some(thread) = self.thread.take() {
            // It panics no more than what it calls; a window that closes has nothing to do about it.
            let _ = thread.join();
        }
    }
}

/// What a resting window would look different by.
#[derive(PartialEq)]
struct Seen {
    /// Whether something sounds.
    loud: bool,
    /// Sum of the parameters' places, as bits in their order.
    parameters: u64,
}

impl Seen {
    fn of(sound: &Sound, parameters: &HostParameters) -> Seen {
        let places = parameters.values().iter().map(|value| value.unmodulated_normalized_value());
        let mixed = places.fold(0_u64, |mixed, place| mixed.rotate_left(5) ^ u64::from(place.to_bits()));
        Seen { loud: sound.is_loud(), parameters: mixed }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicUsize;
    use std::time::Instant;

    #[test]
    fn what_begins_to_sound_wakes_a_window_and_silence_does_not() {
        let context = egui::Context::default();
        let asked = Arc::<AtomicUsize>::default();
        let count = asked.clone();
        context.set_request_repaint_callback(move |_| {
            count.fetch_add(1, Ordering::AcqRel);
        });
        let sound = Sound::default();
        let watch = Watch::new(context, sound.clone(), Arc::default());
        thread::sleep(4 * LOOK);
        assert_eq!(asked.load(Ordering::Acquire), 0);
        sound.set_loud(true);
        let begun = Instant::now();
        while asked.load(Ordering::Acquire) == 0 {
            assert!(begun.elapsed() < Duration::from_secs(10), "nobody asks for a frame");
            thread::sleep(LOOK);
        }
        drop(watch);
    }
}
