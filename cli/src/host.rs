//! An embedded CLAP host: loads a built bundle and plays it without any sound card.
//!
//! A [`Bundle`] is a loaded library, an [`Instance`] one plugin of it. [`Instance::run`] does what
//! hosts do around audio: it activates, hands a [`Processor`] to a thread of its own, and
//! deactivates when that is done. Everything else happens on the thread that made the instance,
//! which is the plugin's main thread.

mod event;
mod handlers;
mod instance;
mod processor;
mod state;

use std::ffi::CString;
use std::path::Path;

use anyhow::{Context, Result};
use clack_host::entry::PluginEntry;
use clack_host::host::HostInfo;

use crate::bad_input;

pub use event::{Event, What};
pub use handlers::Requests;
pub use instance::{AudioPort, Instance, NotePort, ParameterInfo};
pub use processor::{Processor, Touch};
pub use state::{set_kit, with_fields};

/// A plugin's description of itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Descriptor {
    /// Unique id.
    pub id: CString,
    /// Name for people.
    pub name: String,
    /// Version for people.
    pub version: String,
    /// Features: `instrument`, `drum`, ...
    pub features: Vec<String>,
}

/// A loaded CLAP library.
pub struct Bundle {
    entry: PluginEntry,
    plugins: Vec<Descriptor>,
    info: HostInfo,
}

impl Bundle {
    /// Loads a bundle.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) with the path if it is not a CLAP bundle.
    pub fn load(path: &Path) -> Result<Bundle> {
        let not_a_bundle = |reason: &str| bad_input!("`{}` is not a CLAP bundle: {reason}", path.display());
        // The dynamic loader would look for a bare name everywhere but here.
        let absolute = path.canonicalize().map_err(|error| not_a_bundle(&error.to_string()))?;
        if absolute.is_dir() && !cfg!(target_os = "macos") {
            return Err(not_a_bundle("it is a folder"));
        }
        // SAFETY: running foreign code is what loading a plugin means; it is the one the user
        // names or has just built.
        let entry =
            unsafe { PluginEntry::load(&absolute) }.map_err(|error| not_a_bundle(&error.to_string()))?;
        let factory = entry.get_plugin_factory().ok_or_else(|| not_a_bundle("it contains no plugins"))?;
        let text = |text: Option<&std::ffi::CStr>| {
            text.map(|text| text.to_string_lossy().into_owned()).unwrap_or_default()
        };
        let plugins: Vec<_> = factory
            .plugin_descriptors()
            .filter_map(|plugin| {
                Some(Descriptor {
                    id: plugin.id()?.to_owned(),
                    name: text(plugin.name()),
                    version: text(plugin.version()),
                    features: plugin.features().map(|feature| text(Some(feature))).collect(),
                })
            })
            .collect();
        if plugins.is_empty() {
            return Err(not_a_bundle("it contains no plugin"));
        }
        let info = HostInfo::new("Overhear commands", "", "", env!("CARGO_PKG_VERSION"))
            .context("the host's own name")?;
        Ok(Bundle { entry, plugins, info })
    }

    /// The plugins in the bundle; at least one.
    pub fn plugins(&self) -> &[Descriptor] {
        &self.plugins
    }

    /// Makes an instance of the first plugin. This thread becomes its main thread.
    ///
    /// # Errors
    /// If the plugin refuses.
    pub fn instantiate(&self) -> Result<Instance> {
        Instance::new(&self.entry, &self.plugins[0].id, &self.info)
    }

    /// Makes an instance of the plugin of an id. This thread becomes its main thread.
    ///
    /// # Errors
    /// If there is none or it refuses.
    pub fn instantiate_id(&self, id: &str) -> Result<Instance> {
        let plugin = self.plugins.iter().find(|plugin| plugin.id.to_str() == Ok(id));
        let plugin = plugin.with_context(|| format!("the bundle contains no {id}"))?;
        Instance::new(&self.entry, &plugin.id, &self.info)
    }
}
