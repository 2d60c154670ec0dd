//! The window of an open editor, and its end.
//!
//! On X11 the framework draws in a thread of its own. Closing joins that thread, except when it is quicker than the
//! question put to it before the join: then the framework gives up and the thread still takes its graphics down while
//! the host goes on, unloads the plugin or ends the process. So the thread carries something that only its end drops,
//! and closing waits for that.

use std::cell::Cell;
use std::fmt;
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::{self, ThreadId};
use std::time::Duration;

use nice_plug::editor::dpi::NativeSize;
use nice_plug::editor::{EditorHandle, Modifiers, ParentWindowHandle, SpawnedEditor, VirtualKeyCode};
use nice_plug_egui::{EguiEditorHandle, baseview};

use crate::guard::caught;

/// Longest wait for the thread of a closed window. *By ear*, of patience: a host that closes a window should not hang.
const LONGEST_FAREWELL: Duration = Duration::from_secs(2);

/// Longest side of a window, pixels: what graphics drivers draw at least, and twice what the widest screens have.
const MOST_PIXELS: u32 = 16_384;

/// Whether a window can have a size.
fn is_sane(size: NativeSize<u32>) -> bool {
    size.width.max(size.height) <= MOST_PIXELS
}

/// Holds on to the graphics driver for as long as the process lasts. baseview opens it for every window and lets it go
/// after, and whenever Mesa is loaded anew it writes down its functions' names once more, some kilobytes that stay.
#[cfg(target_os = "linux")]
#[allow(unsafe_code)]
pub fn keep_driver() {
    static DRIVER: std::sync::OnceLock<Option<libloading::Library>> = std::sync::OnceLock::new();
    // SAFETY: baseview is about to load the same library.
    DRIVER.get_or_init(|| unsafe { libloading::Library::new("libEGL.so.1").ok() });
}

/// Nothing: the system keeps its driver.
#[cfg(not(target_os = "linux"))]
pub fn keep_driver() {}

thread_local! {
    /// Dropped by the end of a window's thread.
    static CARRIED: Cell<Option<Sender<()>>> = const { Cell::new(None) };
}

/// What the window's content takes along to the thread that draws it.
pub struct Farewell {
    opened_by: ThreadId,
    sender: Option<Sender<()>>,
}

impl Farewell {
    /// One to take along, and the receiver that is disconnected once the thread has ended.
    pub fn new() -> (Farewell, Receiver<()>) {
        let (sender, ended) = mpsc::channel();
        (Farewell { opened_by: thread::current().id(), sender: Some(sender) }, ended)
    }

    /// To be called by the thread that draws. Where that is the one that opens the window, the window's content ends with
    /// the window, and nobody needs to wait for more.
    pub fn carry(&mut self) {
        if thread::current().id() != self.opened_by {
            CARRIED.set(self.sender.take());
        }
    }
}

/// A window that is gone, with its thread, once it is dropped.
pub struct Window {
    shown: Option<baseview::Window>,
    ended: Receiver<()>,
}

impl Window {
    fn shown(&self) -> &baseview::Window {
        // Taken by `run_until_closed` and `drop` only, which own it.
        self.shown.as_ref().expect("a window that is not closed")
    }
}

impl Drop for Window {
    fn drop(&mut self) {
        caught("the window's end", (), || drop(self.shown.take()));
        // Nothing is ever sent; an error is the end or, after the wait, a thread that hangs in its graphics driver.
        let _ = self.ended.recv_timeout(LONGEST_FAREWELL);
    }
}

/// The framework's handle, whose window takes its thread with it.
pub struct Handle(EguiEditorHandle);

/// What the framework has opened, with the other end of its content's [`Farewell`].
pub fn closing_whole(spawned: SpawnedEditor<EguiEditorHandle>, ended: Receiver<()>) -> SpawnedEditor<Handle> {
    SpawnedEditor { handle: Handle(spawned.handle), window: Window { shown: Some(spawned.window), ended } }
}

/// Why a window does not do what a host asks.
#[derive(Debug)]
pub enum WindowError {
    /// The window's library says so.
    Library(baseview::Error),
    /// Nothing would be legible at this size, or no screen could show it: pixels.
    Size(NativeSize<u32>),
}

impl fmt::Display for WindowError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            WindowError::Library(error) => error.fmt(f),
            WindowError::Size(size) => write!(f, "no window is {} by {} pixels", size.width, size.height),
        }
    }
}

impl std::error::Error for WindowError {}

impl EditorHandle for Handle {
    type Window = Window;
    type Error = WindowError;

    fn run_until_closed(mut window: Window) -> Result<(), WindowError> {
        let shown = window.shown.take();
        shown.map_or(Ok(()), EguiEditorHandle::run_until_closed).map_err(WindowError::Library)
    }

    fn set_parent(&self, parent: ParentWindowHandle, window: &Window) -> Result<(), WindowError> {
        caught("EditorHandle::set_parent", Ok(()), || {
            self.0.set_parent(parent, window.shown()).map_err(WindowError::Library)
        })
    }

    fn show(&self, window: &Window) -> Result<(), WindowError> {
        caught("EditorHandle::show", Ok(()), || self.0.show(window.shown()).map_err(WindowError::Library))
    }

    fn hide(&self, window: &Window) -> Result<(), WindowError> {
        caught("EditorHandle::hide", Ok(()), || self.0.hide(window.shown()).map_err(WindowError::Library))
    }

    fn set_size(&self, size: NativeSize<u32>, window: &Window) -> Result<(), WindowError> {
        caught("EditorHandle::set_size", Ok(()), || {
            let fitting = self.0.adjust_size(size, window.shown());
            if fitting.is_some_and(|fitting| fitting != size) || !is_sane(size) {
                return Err(WindowError::Size(size));
            }
            self.0.set_size(size, window.shown()).map_err(WindowError::Library)
        })
    }

    fn host_main_thread_callback(&self, window: &Window) {
        caught("EditorHandle::host_main_thread_callback", (), || {
            self.0.host_main_thread_callback(window.shown())
        });
    }

    fn adjust_size(&self, size: NativeSize<u32>, window: &Window) -> Option<NativeSize<u32>> {
        let sane = NativeSize { width: size.width.min(MOST_PIXELS), height: size.height.min(MOST_PIXELS) };
        caught("EditorHandle::adjust_size", None, || self.0.adjust_size(sane, window.shown()))
    }

    fn set_fallback_scale_factor(&self, factor: f64, window: &Window) -> Result<(), WindowError> {
        caught("EditorHandle::set_fallback_scale_factor", Ok(()), || {
            self.0.set_fallback_scale_factor(factor, window.shown()).map_err(WindowError::Library)
        })
    }

    fn on_virtual_key_from_host(&self, key: VirtualKeyCode, is_down: bool, modifiers: Modifiers) -> bool {
        caught("EditorHandle::on_virtual_key_from_host", false, || {
            self.0.on_virtual_key_from_host(key, is_down, modifiers)
        })
    }

    fn state_changed(&self) {
        caught("EditorHandle::state_changed", (), || self.0.state_changed());
    }

    fn param_value_changed(&self, id: &str, normalized: f32) {
        caught("EditorHandle::param_value_changed", (), || self.0.param_value_changed(id, normalized));
    }

    fn param_modulation_changed(&self, id: &str, offset: f32) {
        caught("EditorHandle::param_modulation_changed", (), || self.0.param_modulation_changed(id, offset));
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{RecvTimeoutError, TryRecvError};

    use super::*;

    #[test]
    fn the_end_of_the_thread_that_draws_is_noticed_and_not_before() {
        let (mut farewell, ended) = Farewell::new();
        let (go, wait) = mpsc::channel::<()>();
        let drawing = thread::spawn(move || {
            farewell.carry();
            // What was drawn is gone; the thread is not.
            drop(farewell);
            let _ = wait.recv();
        });
        assert_eq!(ended.recv_timeout(Duration::from_millis(50)), Err(RecvTimeoutError::Timeout));
        drop(go);
        assert_eq!(ended.recv_timeout(Duration::from_secs(30)), Err(RecvTimeoutError::Disconnected));
        drawing.join().unwrap();
    }

    #[test]
    fn who_draws_where_it_was_opened_is_gone_with_its_content() {
        let (mut farewell, ended) = Farewell::new();
        farewell.carry();
        assert_eq!(ended.try_recv(), Err(TryRecvError::Empty));
        drop(farewell);
        assert_eq!(ended.try_recv(), Err(TryRecvError::Disconnected));
    }
}
