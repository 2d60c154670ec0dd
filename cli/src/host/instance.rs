//! One plugin instance, on its main thread.

use std::ffi::{CStr, CString};
use std::thread;

use anyhow::{Context, Result, anyhow, ensure};
use clack_extensions::audio_ports::{AudioPortInfoBuffer, PluginAudioPorts};
use clack_extensions::gui::{GuiApiType, GuiConfiguration, GuiSize, PluginGui, Window};
use clack_extensions::latency::PluginLatency;
use clack_extensions::note_ports::{NotePortInfoBuffer, PluginNotePorts};
use clack_extensions::params::{ParamInfoBuffer, PluginParams};
use clack_extensions::render::{PluginRender, RenderMode};
use clack_extensions::state::PluginState;
use clack_host::events::io::{EventBuffer, InputEvents, OutputEvents};
use clack_host::extensions::Extension;
use clack_host::prelude::*;
use clack_host::utils::ClapId;

use super::event::{Event, What};
use super::handlers::{Host, MainThread, Requests, Shared, become_audio_thread};
use super::processor::Processor;

/// An audio output or input of a plugin.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AudioPort {
    /// Name for people.
    pub name: String,
    /// Channels.
    pub channels: u32,
}

/// A note input of a plugin.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NotePort {
    /// Name for people.
    pub name: String,
}

/// A parameter of a plugin as the format has it.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterInfo {
    /// Id in the format.
    pub id: u32,
    /// Name for people.
    pub name: String,
    /// Group for people.
    pub module: String,
    /// Smallest value, in the parameter's unit.
    pub min: f64,
    /// Largest value, in the parameter's unit.
    pub max: f64,
    /// Value of a fresh instance, in the parameter's unit.
    pub default: f64,
    /// Present value, in the parameter's unit.
    pub value: f64,
}

/// A plugin, not processing.
pub struct Instance {
    plugin: PluginInstance<Host>,
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

impl Instance {
    pub(super) fn new(entry: &PluginEntry, id: &CStr, info: &HostInfo) -> Result<Instance> {
        let plugin = PluginInstance::new(|_| Shared::new(), |_| MainThread::default(), entry, id, info)
            .with_context(|| format!("the plugin {} cannot be made", id.to_string_lossy()))?;
        Ok(Instance { plugin })
    }

    fn extension<E: Extension<ExtensionSide = clack_host::extensions::PluginExtensionSide>>(
        &mut self,
    ) -> Result<E> {
        self.plugin
            .plugin_handle()
            .get_extension()
            .with_context(|| format!("the plugin has no extension {:?}", E::IDENTIFIERS[0]))
    }

    /// Audio outputs, the main one first.
    ///
    /// # Errors
    /// If the plugin does not tell.
    pub fn audio_outputs(&mut self) -> Result<Vec<AudioPort>> {
        let ports: PluginAudioPorts = self.extension()?;
        let handle = self.plugin.plugin_handle();
        let mut buffer = AudioPortInfoBuffer::new();
        (0..ports.count(&handle, false))
            .map(|index| {
                let port = ports.get(&handle, index, false, &mut buffer);
                let port = port.with_context(|| format!("audio output {index} is not described"))?;
                Ok(AudioPort { name: text(port.name), channels: port.channel_count })
            })
            .collect()
    }

    /// Note inputs.
    ///
    /// # Errors
    /// If the plugin does not tell.
    pub fn note_inputs(&mut self) -> Result<Vec<NotePort>> {
        let ports: PluginNotePorts = self.extension()?;
        let handle = self.plugin.plugin_handle();
        let mut buffer = NotePortInfoBuffer::new();
        (0..ports.count(&handle, true))
            .map(|index| {
                let port = ports.get(&handle, index, true, &mut buffer);
                let port = port.with_context(|| format!("note input {index} is not described"))?;
                Ok(NotePort { name: text(port.name) })
            })
            .collect()
    }

    /// Every parameter with its present value.
    ///
    /// # Errors
    /// If the plugin does not tell.
    pub fn parameters(&mut self) -> Result<Vec<ParameterInfo>> {
        let params: PluginParams = self.extension()?;
        let handle = self.plugin.plugin_handle();
        let mut buffer = ParamInfoBuffer::new();
        (0..params.count(&handle))
            .map(|index| {
                let info = params.get_info(&handle, index, &mut buffer);
                let info = info.with_context(|| format!("parameter {index} is not described"))?;
                let value = params.get_value(&handle, info.id);
                Ok(ParameterInfo {
                    id: info.id.get(),
                    name: text(info.name),
                    module: text(info.module),
                    min: info.min_value,
                    max: info.max_value,
                    default: info.default_value,
                    value: value.context("a parameter has no value")?,
                })
            })
            .collect()
    }

    /// A value in the parameter's unit as the plugin shows it.
    ///
    /// # Errors
    /// If the plugin does not show it.
    pub fn value_text(&mut self, id: u32, value: f64) -> Result<String> {
        let params: PluginParams = self.extension()?;
        let id = ClapId::from_raw(id).context("not a parameter id")?;
        let mut buffer = [0; 256];
        let shown = params.value_to_text(&self.plugin.plugin_handle(), id, value, &mut buffer);
        Ok(text(shown.map_err(|_| anyhow!("the value {value} is not shown"))?))
    }

    /// The value that a shown text stands for, in the parameter's unit.
    ///
    /// # Errors
    /// If the plugin does not understand it.
    pub fn text_value(&mut self, id: u32, shown: &str) -> Result<f64> {
        let params: PluginParams = self.extension()?;
        let id = ClapId::from_raw(id).context("not a parameter id")?;
        let shown = CString::new(shown)?;
        params
            .text_to_value(&self.plugin.plugin_handle(), id, &shown)
            .with_context(|| format!("{shown:?} is not understood"))
    }

    /// Moves parameters while the plugin is not active: `(id, value)`, in the parameters' units.
    ///
    /// # Errors
    /// If the plugin has no parameters.
    pub fn set_parameters(&mut self, values: &[(u32, f64)]) -> Result<()> {
        let params: PluginParams = self.extension()?;
        let mut events = EventBuffer::new();
        for &(id, value) in values {
            Event { offset: 0, what: What::Parameter { id, value } }.push(&mut events);
        }
        let mut output = EventBuffer::new();
        let mut handle = self.plugin.inactive_plugin_handle().context("the plugin is still active")?;
        params.flush(
            &mut handle,
            &InputEvents::from_buffer(&events),
            &mut OutputEvents::from_buffer(&mut output),
        );
        Ok(())
    }

    /// The state the plugin would have a project store.
    ///
    /// # Errors
    /// If the plugin fails to save.
    pub fn save_state(&mut self) -> Result<Vec<u8>> {
        let state: PluginState = self.extension()?;
        let mut bytes = Vec::new();
        state.save(&self.plugin.plugin_handle(), &mut bytes).context("saving the state")?;
        Ok(bytes)
    }

    /// Gives the plugin a state to take over.
    ///
    /// # Errors
    /// If the plugin refuses it.
    pub fn load_state(&mut self, bytes: &[u8]) -> Result<()> {
        let state: PluginState = self.extension()?;
        state.load(&self.plugin.plugin_handle(), &mut &*bytes).context("loading the state")
    }

    /// Latency in samples; zero if the plugin does not tell.
    pub fn latency(&mut self) -> u32 {
        let latency: Option<PluginLatency> = self.plugin.plugin_handle().get_extension();
        latency.map_or(0, |latency| latency.get(&self.plugin.plugin_handle()))
    }

    /// Tells the plugin that it is not played in real time, if it cares.
    ///
    /// # Errors
    /// If it cares and refuses.
    pub fn set_offline(&mut self) -> Result<()> {
        let render: Option<PluginRender> = self.plugin.plugin_handle().get_extension();
        match render {
            Some(render) => Ok(render.set(&self.plugin.plugin_handle(), RenderMode::Offline)?),
            None => Ok(()),
        }
    }

    /// Opens the editor inside an X11 window made by `parent` for the size it is given, and tells
    /// what that made.
    ///
    /// # Errors
    /// If the plugin has no editor for X11 or cannot open it; what `parent` returns.
    pub fn open_editor<T>(&mut self, parent: impl FnOnce(u32, u32) -> Result<(u32, T)>) -> Result<T> {
        self.open_editor_scaled(None, parent)
    }

    /// As [`open_editor`](Self::open_editor), told how many pixels of the screen a point has.
    ///
    /// # Errors
    /// As there, and if the plugin refuses the scale.
    pub fn open_editor_scaled<T>(
        &mut self,
        scale: Option<f64>,
        parent: impl FnOnce(u32, u32) -> Result<(u32, T)>,
    ) -> Result<T> {
        let gui: PluginGui = self.extension()?;
        let handle = self.plugin.plugin_handle();
        let configuration = GuiConfiguration { api_type: GuiApiType::X11, is_floating: false };
        ensure!(gui.is_api_supported(&handle, configuration), "the editor cannot be embedded in X11");
        gui.create(&handle, configuration)?;
        if let Some(scale) = scale {
            gui.set_scale(&handle, scale).with_context(|| format!("the editor refuses the scale {scale}"))?;
        }
        let GuiSize { width, height } = gui.get_size(&handle).context("the editor has no size")?;
        let (window, made) = parent(width, height)?;
        // SAFETY: the window lives until the editor has been closed, or its server is gone.
        unsafe { gui.set_parent(&handle, Window::from_x11_handle(window.into())) }?;
        // Embedded windows show by themselves; few plugins implement the call.
        let _ = gui.show(&handle);
        Ok(made)
    }

    /// Gives the open editor another size, or the nearest that it takes, and tells which.
    ///
    /// # Errors
    /// If it keeps its size.
    pub fn resize_editor(&mut self, width: u32, height: u32) -> Result<(u32, u32)> {
        let gui: PluginGui = self.extension()?;
        let handle = self.plugin.plugin_handle();
        ensure!(gui.can_resize(&handle), "the editor cannot be resized");
        let wanted = GuiSize { width, height };
        let size = gui.adjust_size(&handle, wanted).context("the editor takes no such size")?;
        gui.set_size(&handle, size)?;
        Ok((size.width, size.height))
    }

    /// Gives the open editor a size whether it takes it or not.
    ///
    /// # Errors
    /// If it refuses.
    pub fn force_editor_size(&mut self, width: u32, height: u32) -> Result<()> {
        let gui: PluginGui = self.extension()?;
        Ok(gui.set_size(&self.plugin.plugin_handle(), GuiSize { width, height })?)
    }

    /// Closes the editor.
    ///
    /// # Errors
    /// If the plugin has none.
    pub fn close_editor(&mut self) -> Result<()> {
        let gui: PluginGui = self.extension()?;
        gui.destroy(&self.plugin.plugin_handle());
        Ok(())
    }

    /// The plugin's requests so far.
    pub fn requests(&self) -> Requests {
        self.plugin.access_handler(MainThread::requests)
    }

    /// Number of the plugin's requests to be activated again.
    pub fn restarts(&self) -> u32 {
        self.plugin.access_shared_handler(Shared::restarts)
    }

    /// The plugin's log.
    pub fn log(&self) -> Vec<String> {
        self.plugin.access_shared_handler(Shared::log)
    }

    /// Activates the plugin at a sample rate (Hz) for buffers of `frames`, lets `work` play it on
    /// a thread of its own, and deactivates it.
    ///
    /// # Errors
    /// If the plugin refuses, or what `work` returns.
    ///
    /// # Panics
    /// If `work` does.
    pub fn run<T: Send>(
        &mut self,
        rate: f64,
        frames: std::ops::RangeInclusive<u32>,
        work: impl FnOnce(&mut Processor) -> Result<T> + Send,
    ) -> Result<T> {
        self.run_beside(rate, frames, work, |_| Ok(()))
    }

    /// As [`run`](Self::run), with `meanwhile` on this thread while the other plays.
    ///
    /// # Errors
    /// If the plugin refuses, or what `meanwhile` and `work` return.
    ///
    /// # Panics
    /// If `work` does.
    pub fn run_beside<T: Send>(
        &mut self,
        rate: f64,
        frames: std::ops::RangeInclusive<u32>,
        work: impl FnOnce(&mut Processor) -> Result<T> + Send,
        meanwhile: impl FnOnce(&mut Instance) -> Result<()>,
    ) -> Result<T> {
        self.answer();
        let max_frames = *frames.end();
        let configuration = PluginAudioConfiguration {
            sample_rate: rate,
            min_frames_count: *frames.start(),
            max_frames_count: max_frames,
        };
        let stopped = self
            .plugin
            .activate(|_, _| (), configuration)
            .with_context(|| format!("the plugin does not activate at {rate} Hz"))?;
        let audio = move || {
            become_audio_thread();
            let started = match stopped.start_processing() {
                Ok(started) => started,
                Err(error) => return (error.into_stopped_processor(), None),
            };
            let mut processor = Processor::new(started, max_frames);
            let result = work(&mut processor);
            (processor.into_started().stop_processing(), Some(result))
        };
        let (beside, played) = thread::scope(|scope| {
            let audio = scope.spawn(audio);
            (meanwhile(self), audio.join())
        });
        let (stopped, result) = played.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        self.plugin.deactivate(stopped);
        self.answer();
        beside?;
        result.context("the plugin does not start to process")?
    }

    /// Makes the calls on the main thread that the plugin asked for.
    pub fn answer(&mut self) {
        if self.plugin.access_shared_handler(Shared::take_callback) {
            self.plugin.call_on_main_thread_callback();
        }
    }
}
