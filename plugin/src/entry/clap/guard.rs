//! What stands in front of one instrument of the framework.

use std::cell::UnsafeCell;
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::sync::{Arc, OnceLock};

use clap_sys::audio_buffer::clap_audio_buffer;
use clap_sys::ext::params::clap_plugin_params;
use clap_sys::host::clap_host;
use clap_sys::plugin::clap_plugin;

use super::input::Input;
use crate::entry::scratch::Scratch;
use crate::host_parameters::HostParameters;

/// The framework's table with the guard's functions, and what they need.
#[repr(C)]
pub struct Guard {
    /// What the host holds: first, so that its address is the guard's.
    pub table: clap_plugin,
    /// The framework's own table.
    pub framework: clap_plugin,
    /// Lives as long as the plugin.
    pub host: *const clap_host,
    pub parameters: Option<Arc<HostParameters>>,
    /// Whether the host has not been told that pieces and notes have other names.
    pub renamed: Arc<AtomicBool>,
    /// Of the latest activation, Hz: bits of a double precision number.
    pub sample_rate: AtomicU64,
    /// The framework's table of parameters, but for their values.
    pub values: OnceLock<clap_plugin_params>,
    /// Touched by `activate` and `process` only, which never overlap; the rest is read by any thread.
    pub outputs: UnsafeCell<Outputs>,
}

/// Scratch and the ports made of it for one call, and the events of one.
pub struct Outputs {
    pub input: Input,
    pub scratch: Scratch,
    /// `[port]`, filled in for a call that needs completing.
    pub ports: Vec<clap_audio_buffer>,
    /// Whether the plugin has been activated.
    pub active: bool,
    /// Whether it has not processed since.
    pub fresh: bool,
}

/// # Safety
/// The host passes the table of a guard that it has not destroyed.
pub unsafe fn guard<'a>(plugin: *const clap_plugin) -> &'a Guard {
    // SAFETY: the table is the guard's first field.
    unsafe { &*plugin.cast() }
}
