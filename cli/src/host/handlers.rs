//! What the host answers when a plugin calls.

use std::cell::Cell;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::thread::{self, ThreadId};

use clack_extensions::gui::{GuiSize, HostGui, HostGuiImpl};
use clack_extensions::latency::{HostLatency, HostLatencyImpl};
use clack_extensions::log::{HostLog, HostLogImpl, LogSeverity};
use clack_extensions::params::{
    HostParams, HostParamsImplMainThread, HostParamsImplShared, ParamClearFlags, ParamRescanFlags,
};
use clack_extensions::state::{HostState, HostStateImpl};
use clack_extensions::thread_check::{HostThreadCheck, HostThreadCheckImpl};
use clack_host::prelude::*;
use clack_host::utils::ClapId;

thread_local! {
    /// Whether this thread is an audio thread of some instance.
    static IS_AUDIO: Cell<bool> = const { Cell::new(false) };
}

/// Marks this thread as an audio thread, for good.
pub fn become_audio_thread() {
    IS_AUDIO.set(true);
}

/// The host, seen from a plugin.
pub struct Host;

impl HostHandlers for Host {
    type Shared<'a> = Shared;
    type MainThread<'a> = MainThread;
    type AudioProcessor<'a> = ();

    fn declare_extensions(builder: &mut HostExtensions<Self>, _: &Shared) {
        builder
            .register::<HostLog>()
            .register::<HostThreadCheck>()
            .register::<HostParams>()
            .register::<HostState>()
            .register::<HostLatency>()
            .register::<HostGui>();
    }
}

/// Host functions that plugins may call from any thread.
pub struct Shared {
    main_thread: ThreadId,
    callback: AtomicBool,
    restarts: AtomicU32,
    log: Mutex<Vec<String>>,
}

impl Shared {
    /// For an instance whose main thread is this one.
    pub fn new() -> Shared {
        Shared {
            main_thread: thread::current().id(),
            callback: AtomicBool::new(false),
            restarts: AtomicU32::new(0),
            log: Mutex::default(),
        }
    }

    /// Whether a call on the main thread was asked for since the last time.
    pub fn take_callback(&self) -> bool {
        self.callback.swap(false, Ordering::AcqRel)
    }

    /// Number of the plugin's requests to be activated again.
    pub fn restarts(&self) -> u32 {
        self.restarts.load(Ordering::Acquire)
    }

    /// The plugin's log, one line each: `[severity] message`.
    pub fn log(&self) -> Vec<String> {
        self.log.lock().map(|log| log.clone()).unwrap_or_default()
    }
}

impl SharedHandler<'_> for Shared {
    fn request_restart(&self) {
        self.restarts.fetch_add(1, Ordering::AcqRel);
    }

    fn request_process(&self) {}

    fn request_callback(&self) {
        self.callback.store(true, Ordering::Release);
    }
}

impl HostLogImpl for Shared {
    fn log(&self, severity: LogSeverity, message: &str) {
        if let Ok(mut log) = self.log.lock() {
            log.push(format!("[{severity}] {message}"));
        }
    }
}

impl HostThreadCheckImpl for Shared {
    fn is_main_thread(&self) -> bool {
        thread::current().id() == self.main_thread
    }

    fn is_audio_thread(&self) -> bool {
        IS_AUDIO.get()
    }
}

impl HostParamsImplShared for Shared {
    fn request_flush(&self) {}
}

/// The host's windows are made for the editor as it is and never change on its wish.
impl HostGuiImpl for Shared {
    fn resize_hints_changed(&self) {}

    fn request_resize(&self, _size: GuiSize) -> Result<(), HostError> {
        Err(HostError::Message("the window keeps its size"))
    }

    fn request_show(&self) -> Result<(), HostError> {
        Ok(())
    }

    fn request_hide(&self) -> Result<(), HostError> {
        Ok(())
    }

    fn closed(&self, _was_destroyed: bool) {}
}

/// Host functions that plugins may call from their main thread, with counts of requests.
#[derive(Default)]
pub struct MainThread {
    requests: Cell<Requests>,
}

/// Counts of a plugin's requests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Requests {
    /// To have its parameters read again.
    pub rescans: u32,
    /// To have its state saved.
    pub dirty: u32,
    /// To have its latency read again.
    pub latency: u32,
}

impl MainThread {
    /// Counts of the plugin's requests.
    pub fn requests(&self) -> Requests {
        self.requests.get()
    }

    fn count(&self, which: impl FnOnce(&mut Requests)) {
        let mut requests = self.requests.get();
        which(&mut requests);
        self.requests.set(requests);
    }
}

impl MainThreadHandler<'_> for MainThread {}

impl HostParamsImplMainThread for MainThread {
    fn rescan(&self, _flags: ParamRescanFlags) {
        self.count(|requests| requests.rescans += 1);
    }

    fn clear(&self, _parameter: ClapId, _flags: ParamClearFlags) {}
}

impl HostStateImpl for MainThread {
    fn mark_dirty(&self) {
        self.count(|requests| requests.dirty += 1);
    }
}

impl HostLatencyImpl for MainThread {
    fn changed(&self) {
        self.count(|requests| requests.latency += 1);
    }
}
