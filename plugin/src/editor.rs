//! The editor: the kit's levels, one piece's motion, its parameters.
//!
//! It reads snapshots, mode shapes and parameters and never touches the engine. Every frame asks for the next: nothing
//! outside does, because a window asked to draw before it is shown waits for an answer that X11 gives only to those
//! who are shown, and stays blank. Drawing is split
//! into the surface, the panels around it, those of presets and of playing, the knob and the theme; what stays here is the
//! window: opening it at the size the project stored, and storing the size it is given.

use std::error::Error;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use nice_plug::context::gui::GuiContext;
use nice_plug::editor::dpi::{LogicalSize, NativeSize};
use nice_plug::editor::{HostMethods, SpawnedEditor};
use nice_plug::prelude::*;
use nice_plug_egui::baseview::{HandlerError, WindowSize};
use nice_plug_egui::{
    EguiEditor, EguiEditorState, EguiNiceSettings, Frame, NiceEguiApp, RepaintNotifier, create_egui_editor,
};

use crate::NAME;
use crate::builder::Shapes;
use crate::host_parameters::{HostParameters, SMALLEST_WINDOW};
use crate::monitor::Viewer;
use crate::presets::Library;

mod knob;
mod panels;
mod playing;
mod presets;
mod surface;
mod theme;
mod window;

use panels::Panels;
use playing::PlayingPanel;
use presets::PresetBar;
use window::Farewell;

/// From one frame to the next while the kit plays: 60 a second.
const FRAME_INTERVAL: Duration = Duration::from_micros(16_667);

/// From one frame to the next while nothing sounds: soon enough for a first stroke, cheap enough to stay open.
const RESTING_INTERVAL: Duration = Duration::from_millis(80);

/// A piece's peak above which it is drawn moving, full scale 1.
const AUDIBLE: f32 = 1e-5;

/// The framework's own way of asking for frames would do so before the window is shown.
const NEVER: Duration = Duration::from_secs(24 * 60 * 60);

/// What every window of an instance looks at.
#[derive(Clone)]
struct Sources {
    parameters: Arc<HostParameters>,
    viewer: Viewer,
    shapes: Shapes,
}

/// The editor as the framework holds it: opens a window when the host asks.
pub struct OverhearEditor {
    sources: Sources,
    /// The latest window, or the one to open next.
    window: Mutex<Arc<EguiEditorState>>,
}

impl OverhearEditor {
    /// An editor without a window.
    pub fn new(parameters: Arc<HostParameters>, viewer: Viewer, shapes: Shapes) -> OverhearEditor {
        let window = Mutex::new(window_of(&parameters));
        OverhearEditor { sources: Sources { parameters, viewer, shapes }, window }
    }

    /// The open window, or one of the stored size: the framework's own state keeps the size it
    /// was made with, and a project may have been loaded since.
    fn window(&self) -> Arc<EguiEditorState> {
        let mut window = self.window.lock().unwrap_or_else(PoisonError::into_inner);
        if !window.is_open() {
            *window = window_of(&self.sources.parameters);
        }
        window.clone()
    }

    fn egui_editor(&self, window: Arc<EguiEditorState>, farewell: Farewell) -> Option<EguiEditor<App>> {
        let settings = EguiNiceSettings::new()
            .with_tile(NAME)
            .with_resize_hint(resize_hint())
            .with_repaint_poll_interval(NEVER);
        create_egui_editor(window, RepaintNotifier::new(), settings, App::new(self.sources.clone(), farewell))
    }
}

fn window_of(parameters: &HostParameters) -> Arc<EguiEditorState> {
    let (width, height) = parameters.window();
    EguiEditorState::from_size(LogicalSize::new(f64::from(width), f64::from(height)), 1.0)
}

fn resize_hint() -> ResizeHint {
    let (width, height) = SMALLEST_WINDOW;
    ResizeHint::RESIZABLE.with_min_logical_size(LogicalSize::new(width as f32, height as f32))
}

impl Editor for OverhearEditor {
    type Handle = window::Handle;

    fn spawn(
        &self,
        parent: Option<ParentWindowHandle>,
        wait_for_parent: bool,
        fallback_scale_factor: Option<f64>,
        gui_context: GuiContext,
        host: Option<HostMethods>,
    ) -> Result<SpawnedEditor<window::Handle>, Box<dyn Error>> {
        let (farewell, ended) = Farewell::new();
        let editor = self.egui_editor(self.window(), farewell).ok_or("no editor")?;
        editor
            .spawn(parent, wait_for_parent, fallback_scale_factor, gui_context, host)
            .map(|spawned| window::closing_whole(spawned, ended))
            .inspect_err(|error| nice_error!("The window cannot open, the kit plays on: {error}"))
    }

    fn size(&self) -> NativeSize<u32> {
        let window = self.window();
        NativeSize::from_size(window.physical_size().into(), 1.0)
    }

    fn resize_hint(&self) -> ResizeHint {
        resize_hint()
    }
}

/// One window's content.
struct App {
    sources: Sources,
    farewell: Farewell,
    gui: Option<GuiContext>,
    panels: Panels,
    presets: PresetBar,
    playing: PlayingPanel,
    /// Whether the panel of playing covers the surface.
    plays: bool,
}

impl App {
    fn new(sources: Sources, farewell: Farewell) -> App {
        App {
            sources,
            farewell,
            gui: None,
            panels: Panels::default(),
            presets: PresetBar::new(Library::default()),
            playing: PlayingPanel::default(),
            plays: false,
        }
    }
}

impl NiceEguiApp for App {
    fn build(
        &mut self,
        context: egui::Context,
        gui: GuiContext,
        frame: &mut Frame,
    ) -> Result<(), HandlerError> {
        self.farewell.carry();
        theme::apply(&context);
        frame.set_clear_color(theme::BACKGROUND.into());
        self.gui = Some(gui);
        // Peaks collected while no window was open are old news.
        self.sources.viewer.latest();
        Ok(())
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut Frame) {
        let Some(gui) = &self.gui else { return };
        let mut snapshot = self.sources.viewer.latest();
        snapshot.late_buffers = self.sources.parameters.deadlines().late();
        let shapes = |slot| self.sources.shapes.of(slot);
        let mut set = |index: usize, gesture| {
            let Some(parameter) = self.sources.parameters.values().get(index) else { return };
            gesture_to_host(&gui.param_setter(), parameter, gesture);
        };
        self.panels.show(ui, &snapshot, &shapes, self.sources.parameters.values(), &mut set);
        if self.plays {
            let cover = self.panels.stage_rect();
            self.playing.show(ui, cover, &self.sources.parameters, &mut set);
        }
        let bar = panels::bar_rect(ui.max_rect());
        ui.scope_builder(egui::UiBuilder::new().max_rect(bar), |ui| {
            ui.horizontal(|ui| {
                ui.toggle_value(&mut self.plays, "Playing");
                self.presets.show(ui, &self.sources.parameters, &mut set);
            });
        });
        let moves = snapshot.pieces.iter().any(|piece| piece.peak > AUDIBLE);
        ui.ctx().request_repaint_after(if moves { FRAME_INTERVAL } else { RESTING_INTERVAL });
    }

    fn resized(&mut self, size: WindowSize) {
        let size = size.logical;
        self.sources.parameters.set_window((size.width.round() as u32, size.height.round() as u32));
    }
}

fn gesture_to_host(setter: &ParamSetter, parameter: &FloatParam, gesture: knob::Gesture) {
    match gesture {
        knob::Gesture::Begin => setter.begin_set_parameter(parameter),
        knob::Gesture::Set(value) => setter.set_parameter(parameter, value),
        knob::Gesture::End => setter.end_set_parameter(parameter),
    }
}

#[cfg(test)]
mod tests;
