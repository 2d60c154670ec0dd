//! The window of an open editor, and its end.
//!
//! On X11 the framework draws in a thread of its own. Closing joins that thread, except when it is quicker than the
//! question put to it before the join: then the framework gives up, says so in the log, and the thread still takes its
//! graphics down while the host goes on, unloads the plugin or ends the process. So the thread is ended first, from within:
//! it is told by a change of size, the only call of the window's that reaches its content at once. The thread carries
//! something that only its end drops, closing waits for that, and a window whose thread has ended is asked nothing.

use std::cell::Cell;
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::{self, ThreadId};
use std::time::Duration;

use nice_plug::editor::dpi::{LogicalSize, NativeSize, PhysicalSize};
use nice_plug::editor::{
    EditorHandle, HostMainThreadCaller, HostMethods, Modifiers, ParentWindowHandle, SpawnedEditor,
    VirtualKeyCode,
};
use nice_plug::prelude::ResizeHint;
use nice_plug_egui::{EguiEditorHandle, baseview};

use crate::guard::caught;
use crate::host_parameters::{HostParameters, SMALLEST_WINDOW};
use crate::scale;

/// Longest wait for the thread of a closed window. *By ear*, of patience: a host that closes a window should not hang.
const LONGEST_FAREWELL: Duration = Duration::from_secs(2);

/// Longest side of a window, pixels: what graphics drivers draw at least, and twice what the widest screens have.
const MOST_PIXELS: u32 = 16_384;

/// The sizes that windows take.
pub fn resize_hint() -> ResizeHint {
    let (width, height) = SMALLEST_WINDOW;
    ResizeHint::RESIZABLE.with_min_logical_size(LogicalSize::new(width as f32, height as f32))
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
    /// The window that this thread draws, as long as there is something to draw.
    static DRAWN: Cell<Option<baseview::WindowContext>> = const { Cell::new(None) };
}

/// What a window's content and its handle have in common.
#[derive(Default)]
struct Shared {
    /// Whether another thread draws than the one that opened the window.
    apart: AtomicBool,
    closes: AtomicBool,
}

/// What the window's content takes along to the thread that draws it.
pub struct Farewell {
    opened_by: ThreadId,
    sender: Option<Sender<()>>,
    shared: Arc<Shared>,
}

/// What closing a window waits for.
pub struct End {
    /// Disconnected once the thread has ended.
    ended: Receiver<()>,
    shared: Arc<Shared>,
}

impl Farewell {
    /// One to take along, and what to wait for.
    pub fn new() -> (Farewell, End) {
        let ((sender, ended), shared) = (mpsc::channel(), Arc::<Shared>::default());
        let farewell =
            Farewell { opened_by: thread::current().id(), sender: Some(sender), shared: shared.clone() };
        (farewell, End { ended, shared })
    }

    /// To be called by the thread that draws. Where that is the one that opens the window, the window's content ends with
    /// the window, and nobody needs to wait for more.
    pub fn carry(&mut self, window: &baseview::WindowContext) {
        if self.take_along() {
            DRAWN.set(Some(window.clone()));
        }
    }

    /// Whether this thread is not the one that opened the window; then its end is noticed.
    fn take_along(&mut self) -> bool {
        let apart = thread::current().id() != self.opened_by;
        if apart {
            CARRIED.set(self.sender.take());
            self.shared.apart.store(true, Ordering::Release);
        }
        apart
    }

    /// Ends the thread if the window closes, and says whether it does. To be called by the thread that draws.
    pub fn bid(&self) -> bool {
        let closes = self.shared.closes.load(Ordering::Acquire);
        if closes && let Some(window) = DRAWN.take() {
            window.request_close();
        }
        closes
    }
}

impl Drop for Farewell {
    fn drop(&mut self) {
        // Its own thread's: others draw none. Not left to the thread's end, which may be too late for graphics.
        if thread::current().id() != self.opened_by {
            drop(DRAWN.take());
        }
    }
}

/// Calls the host's main thread, except for a window that is being closed: the main thread closes it, and there is nothing to
/// tell. A host without a loop of events would hear of it on another thread, while the framework holds the window.
struct Caller {
    framework: Box<dyn HostMainThreadCaller>,
    shared: Arc<Shared>,
}

impl HostMainThreadCaller for Caller {
    fn call_main_thread(&mut self) {
        if !self.shared.closes.load(Ordering::Acquire) {
            self.framework.call_main_thread();
        }
    }
}

impl End {
    /// A host that hears nothing of the thread's end when the host itself closes the window.
    pub fn untold(&self, host: HostMethods) -> HostMethods {
        let framework = host.main_thread_caller;
        HostMethods {
            main_thread_caller: Box::new(Caller { framework, shared: self.shared.clone() }),
            ..host
        }
    }
}

/// A window that is gone, with its thread, once it is dropped.
pub struct Window {
    shown: Option<baseview::Window>,
    end: End,
    parameters: Arc<HostParameters>,
}

impl Window {
    fn shown(&self) -> &baseview::Window {
        // Taken by `run_until_closed` and `drop` only, which own it.
        self.shown.as_ref().expect("a window that is not closed")
    }

    /// Ends the thread that draws, if it is another one.
    fn end_thread(&self) {
        let Some(shown) = self.shown.as_ref().filter(|shown| shown.is_open()) else { return };
        if !self.end.shared.apart.load(Ordering::Acquire) {
            return;
        }
        self.end.shared.closes.store(true, Ordering::Release);
        let PhysicalSize { width, height } = shown.size().physical;
        // It fails where the host's window is gone already, but the content has heard of it all the same.
        let _ = shown.resize(PhysicalSize::new(width + 1, height));
        self.wait();
    }

    /// Waits for the thread. Nothing is ever sent; an error is the end or, after the wait, a thread that hangs in its
    /// graphics driver.
    fn wait(&self) {
        let _ = self.end.ended.recv_timeout(LONGEST_FAREWELL);
    }
}

impl Drop for Window {
    fn drop(&mut self) {
        caught("the window's end", (), || {
            self.end_thread();
            drop(self.shown.take());
        });
        self.wait();
        self.parameters.scale().draw(None);
    }
}

/// The framework's handle, whose window takes its thread with it.
pub struct Handle {
    framework: EguiEditorHandle,
    parameters: Arc<HostParameters>,
}

/// What the framework has opened, with the other end of its content's [`Farewell`].
pub fn closing_whole(
    spawned: SpawnedEditor<EguiEditorHandle>,
    end: End,
    parameters: Arc<HostParameters>,
) -> SpawnedEditor<Handle> {
    SpawnedEditor {
        handle: Handle { framework: spawned.handle, parameters: parameters.clone() },
        window: Window { shown: Some(spawned.window), end, parameters },
    }
}

impl Handle {
    /// The nearest size that a window can have. The framework would go by the scale that the window was opened with.
    fn fitting(&self, size: NativeSize<u32>, window: &Window) -> NativeSize<u32> {
        let size = NativeSize { width: size.width.min(MOST_PIXELS), height: size.height.min(MOST_PIXELS) };
        let present = window.shown().size();
        let present = NativeSize::from_logical_or_physical(present.logical, present.physical);
        resize_hint().adjust_size(size, present, self.parameters.scale().present())
    }
}

/// Why a window does not do what a host asks.
#[derive(Debug)]
pub enum WindowError {
    /// The window's library says so.
    Library(baseview::Error),
    /// Nothing would be legible at this size, or no screen could show it: pixels.
    Size(NativeSize<u32>),
    /// No screen has this scale.
    Scale(f64),
}

impl fmt::Display for WindowError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            WindowError::Library(error) => error.fmt(f),
            WindowError::Size(size) => write!(f, "no window is {} by {} pixels", size.width, size.height),
            WindowError::Scale(scale) => write!(f, "no screen has {scale} pixels to a point"),
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
            self.framework.set_parent(parent, window.shown()).map_err(WindowError::Library)
        })
    }

    fn show(&self, window: &Window) -> Result<(), WindowError> {
        caught("EditorHandle::show", Ok(()), || {
            self.framework.show(window.shown()).map_err(WindowError::Library)
        })
    }

    fn hide(&self, window: &Window) -> Result<(), WindowError> {
        caught("EditorHandle::hide", Ok(()), || {
            self.framework.hide(window.shown()).map_err(WindowError::Library)
        })
    }

    fn set_size(&self, size: NativeSize<u32>, window: &Window) -> Result<(), WindowError> {
        caught("EditorHandle::set_size", Ok(()), || {
            if self.fitting(size, window) != size {
                return Err(WindowError::Size(size));
            }
            self.framework.set_size(size, window.shown()).map_err(WindowError::Library)
        })
    }

    fn host_main_thread_callback(&self, window: &Window) {
        caught("EditorHandle::host_main_thread_callback", (), || {
            self.framework.host_main_thread_callback(window.shown())
        });
    }

    fn adjust_size(&self, size: NativeSize<u32>, window: &Window) -> Option<NativeSize<u32>> {
        caught("EditorHandle::adjust_size", None, || Some(self.fitting(size, window)))
    }

    fn set_fallback_scale_factor(&self, factor: f64, window: &Window) -> Result<(), WindowError> {
        caught("EditorHandle::set_fallback_scale_factor", Ok(()), || {
            if !scale::is_sane(factor) {
                return Err(WindowError::Scale(factor));
            }
            self.framework.set_fallback_scale_factor(factor, window.shown()).map_err(WindowError::Library)
        })
    }

    fn on_virtual_key_from_host(&self, key: VirtualKeyCode, is_down: bool, modifiers: Modifiers) -> bool {
        caught("EditorHandle::on_virtual_key_from_host", false, || {
            self.framework.on_virtual_key_from_host(key, is_down, modifiers)
        })
    }

    fn state_changed(&self) {
        caught("EditorHandle::state_changed", (), || self.framework.state_changed());
    }

    fn param_value_changed(&self, id: &str, normalized: f32) {
        caught("EditorHandle::param_value_changed", (), || {
            self.framework.param_value_changed(id, normalized)
        });
    }

    fn param_modulation_changed(&self, id: &str, offset: f32) {
        caught("EditorHandle::param_modulation_changed", (), || {
            self.framework.param_modulation_changed(id, offset)
        });
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{RecvTimeoutError, TryRecvError};

    use super::*;

    #[test]
    fn the_end_of_the_thread_that_draws_is_noticed_and_not_before() {
        let (mut farewell, End { ended, .. }) = Farewell::new();
        let (go, wait) = mpsc::channel::<()>();
        let drawing = thread::spawn(move || {
            farewell.take_along();
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
        let (mut farewell, End { ended, .. }) = Farewell::new();
        farewell.take_along();
        assert_eq!(ended.try_recv(), Err(TryRecvError::Empty));
        drop(farewell);
        assert_eq!(ended.try_recv(), Err(TryRecvError::Disconnected));
    }
}
