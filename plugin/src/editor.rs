//! The editor: the kit's levels, one piece's motion, its parameters.
//!
//! It reads snapshots, mode shapes and parameters and never touches the engine. Every frame asks for the next, and what
//! wakes a resting window begins with the first: a window asked to draw before it is shown waits for an answer that
//! X11 gives only to those who are shown, and stays blank. Drawing is split
//! into the surface, the panels around it, those of presets and of playing, the knob and the theme; what stays here is the
//! window: opening it at the size the project stored, and storing the size it is given.

use std::error::Error;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use cpu_time::ThreadTime;
use glow::HasContext;
use nice_plug::context::gui::GuiContext;
use nice_plug::editor::dpi::{LogicalSize, NativeSize};
use nice_plug::editor::{EditorHandle, HostMethods, SpawnedEditor};
use nice_plug::prelude::*;
use nice_plug_egui::baseview::{HandlerError, WindowSize};
use nice_plug_egui::{
    EguiEditor, EguiEditorState, EguiNiceSettings, Frame, GraphicsConfig, NiceEguiApp, RepaintNotifier,
    create_egui_editor,
};
use overhear_engine::slot::Slot;

use crate::guard::caught;
use crate::host_parameters::HostParameters;
use crate::monitor::{AUDIBLE, Viewer};
use overhear_player::NAME;
use overhear_player::builder::Shapes;
use overhear_player::presets::Library;
use overhear_player::strokes::Strokes;

mod build;
mod calibration;
mod control;
mod fader;
mod field;
mod gesture;
mod history;
mod kit_view;
mod knob;
mod knobs;
mod levels;
mod list;
mod mix;
mod pace;
mod pairs;
mod panels;
mod physics;
mod playing;
mod plot;
mod presets;
mod settings;
mod stage;
mod status;
mod theme;
mod values;
mod watch;
mod window;

use pace::{Pace, Pulse};
use panels::{Hands, Inputs, Panels};
use watch::Watch;
use window::{Farewell, resize_hint};

/// The framework's own way of asking for frames would do so before the window is shown.
const NEVER: Duration = Duration::from_secs(24 * 60 * 60);

/// What every window of an instance looks at.
#[derive(Clone)]
struct Sources {
    parameters: Arc<HostParameters>,
    viewer: Viewer,
    shapes: Shapes,
    strokes: Strokes,
}

/// The editor as the framework holds it: opens a window when the host asks.
pub struct OverhearEditor {
    sources: Sources,
    /// The latest window, or the one to open next.
    window: Mutex<Arc<EguiEditorState>>,
}

impl OverhearEditor {
    /// An editor without a window.
    pub fn new(
        parameters: Arc<HostParameters>,
        viewer: Viewer,
        shapes: Shapes,
        strokes: Strokes,
    ) -> OverhearEditor {
        let window = Mutex::new(window_of(&parameters));
        OverhearEditor { sources: Sources { parameters, viewer, shapes, strokes }, window }
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
            // Noise against banding costs a processor that draws more than the picture does.
            .with_graphics_config(GraphicsConfig { dithering: false, ..GraphicsConfig::default() })
            .with_repaint_poll_interval(NEVER);
        create_egui_editor(window, RepaintNotifier::new(), settings, App::new(self.sources.clone(), farewell))
    }
}

fn window_of(parameters: &HostParameters) -> Arc<EguiEditorState> {
    let (width, height) = parameters.window();
    EguiEditorState::from_size(LogicalSize::new(f64::from(width), f64::from(height)), parameters.view().zoom)
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
        caught("Editor::spawn", Err("the window broke".into()), || {
            window::keep_driver();
            let parameters = &self.sources.parameters;
            let (farewell, end) = Farewell::new();
            let editor = self.egui_editor(self.window(), farewell).ok_or("no editor")?;
            let host = host.map(|host| end.untold(host));
            // Opened at a scale, the framework's window would have the pixels of another.
            let spawned =
                editor.spawn(parent, wait_for_parent, None, gui_context, host).inspect_err(|error| {
                    nice_error!("The window cannot open, but the kit still plays: {error}")
                })?;
            let spawned = window::closing_whole(spawned, end, parameters.clone());
            if let Some(scale) = fallback_scale_factor.or_else(|| parameters.scale().told())
                && let Err(error) = spawned.handle.set_fallback_scale_factor(scale, &spawned.window)
            {
                nice_warn!("The window opens without the host's scale: {error}");
            }
            Ok(spawned)
        })
    }

    fn size(&self) -> NativeSize<u32> {
        caught("Editor::size", NativeSize::new(0, 0), || self.present_size())
    }

    fn resize_hint(&self) -> ResizeHint {
        resize_hint()
    }
}

impl OverhearEditor {
    /// Size of the window with its zoom, in the pixels of the host.
    fn present_size(&self) -> NativeSize<u32> {
        let window = self.window();
        let (size, zoom) = (window.logical_size(), f64::from(window.user_scale_factor()));
        let zoomed = LogicalSize::new(f64::from(size.width) * zoom, f64::from(size.height) * zoom);
        NativeSize::from_size(zoomed.into(), self.sources.parameters.scale().present())
    }
}

/// One window's content.
struct App {
    sources: Sources,
    farewell: Farewell,
    gui: Option<GuiContext>,
    /// From the beginning on.
    context: Option<egui::Context>,
    panels: Panels,
    /// From the first frame on.
    watch: Option<Watch>,
    pace: Pace,
    pulse: Pulse,
    /// What the thread that draws had taken when the latest frame began.
    taken: Option<Duration>,
    /// Set by a panic while it was drawn: blank from then on.
    broken: bool,
}

impl App {
    fn new(sources: Sources, farewell: Farewell) -> App {
        let (view, document) = (sources.parameters.view(), sources.parameters.document());
        App {
            sources,
            farewell,
            gui: None,
            context: None,
            panels: Panels::new(Library::default(), view, document),
            watch: None,
            pace: Pace::default(),
            pulse: Pulse::default(),
            taken: None,
            broken: false,
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
        self.farewell.carry(frame.baseview_window());
        self.guarded("the window's beginning", |app| app.begin(context, gui, frame));
        Ok(())
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut Frame) {
        self.guarded("the window's frame", |app| app.draw(ui, frame));
    }

    fn resized(&mut self, size: WindowSize) {
        if self.farewell.bid() {
            return;
        }
        self.guarded("the window's size", |app| {
            let (points, parameters) = (size.logical, &app.sources.parameters);
            parameters.set_window((points.width.round() as u32, points.height.round() as u32));
            // The zoom is part of what the size counts as a scale.
            let zoom = app.context.as_ref().map_or(1.0, egui::Context::zoom_factor);
            parameters.scale().draw(Some(size.scale_factor / f64::from(zoom)));
        });
    }
}

impl App {
    /// Calls what draws unless it broke. A panic must not reach the host.
    fn guarded(&mut self, entry: &'static str, draw: impl FnOnce(&mut App)) {
        self.broken = self.broken
            || caught(entry, true, || {
                draw(self);
                false
            });
    }

    fn begin(&mut self, context: egui::Context, gui: GuiContext, frame: &mut Frame) {
        theme::apply(&context);
        let light = self.sources.parameters.view().light;
        theme::choose(&context, light);
        self.gui = Some(gui);
        self.context = Some(context);
        self.sources.parameters.scale().draw(Some(frame.baseview_window().scale_factor()));
        if draws_in_software(frame) {
            self.pace = Pace::in_software();
        }
        // Peaks and strokes from while no window was open are old news.
        drop(self.sources.viewer.since());
        self.panels.forget(&self.sources.viewer.latest());
    }

    fn draw(&mut self, ui: &mut egui::Ui, frame: &mut Frame) {
        let Some(gui) = &self.gui else { return };
        frame.set_clear_color(as_written(theme::of(ui).background));
        let watch = self.watch.get_or_insert_with(|| {
            Watch::new(ui.ctx().clone(), self.sources.viewer.clone(), self.sources.parameters.clone())
        });
        let seen = watch.look();
        let past = self.sources.viewer.since();
        let mut snapshot = self.sources.viewer.latest();
        snapshot.late_buffers = self.sources.parameters.deadlines().late();
        let shapes = |slot: Slot| self.sources.shapes.of(slot);
        let building = |slot: Slot| self.sources.shapes.is_building(slot);
        let mut set = |index: usize, gesture| {
            let Some(parameter) = self.sources.parameters.values().get(index) else { return };
            gesture_to_host(&gui.param_setter(), parameter, gesture);
        };
        let mut play = |stroke| self.sources.strokes.play(stroke);
        let (parameters, sound) = (&self.sources.parameters, self.sources.viewer.sound());
        let inputs = Inputs {
            snapshot: &snapshot,
            past: &past,
            shapes: &shapes,
            building: &building,
            parameters,
            sound,
        };
        self.panels.show(ui, &inputs, &mut Hands { set: &mut set, play: &mut play });
        self.sources.parameters.set_view(self.panels.view());
        let now = ui.input(|input| input.time);
        let sounds = snapshot.pieces.iter().any(|piece| piece.peak > AUDIBLE);
        let played =
            (sounds || self.panels.moves_on(&snapshot, now)) && self.pulse.goes_on(snapshot.clock, now);
        // What is built is told whether anything plays or not.
        let moves = played || self.panels.waits(now) || Slot::ALL.into_iter().any(building);
        watch.drawn(seen, moves);
        // From frame to frame: what is painted after this function is in it.
        let taken = ThreadTime::now().as_duration();
        if let Some(before) = self.taken.replace(taken) {
            self.pace.drew(taken.saturating_sub(before));
        }
        if let Some(wait) = self.pace.next(now, moves) {
            // Not through egui, which passes on no request while it has a sooner one of its own.
            frame.baseview_window().request_redraw_after(wait);
        }
    }
}

/// A colour to clear with, which goes to the screen as it is: no light is computed from it.
fn as_written(colour: egui::Color32) -> egui::Rgba {
    let [red, green, blue, _] = colour.to_array().map(|channel| f32::from(channel) / 255.0);
    egui::Rgba::from_rgb(red, green, blue)
}

/// Whether the processor draws rather than a graphics card.
#[allow(unsafe_code)]
fn draws_in_software(frame: &Frame) -> bool {
    let Some(context) = frame.baseview_window().gl_context() else { return false };
    // SAFETY: it is the window's own context, on the thread that draws with it; it is current no longer than here, and
    // nothing else is in between.
    let renderer = unsafe {
        if context.make_current().is_err() {
            return false;
        }
        let renderer = frame.gl().get_parameter_string(glow::RENDERER);
        // One that cannot be let go will be taken again by the first frame.
        let _ = context.make_not_current();
        renderer
    };
    ["llvmpipe", "softpipe", "swrast", "SwiftShader", "Software"].iter().any(|name| renderer.contains(name))
}

fn gesture_to_host(setter: &ParamSetter, parameter: &FloatParam, gesture: gesture::Gesture) {
    match gesture {
        gesture::Gesture::Begin => setter.begin_set_parameter(parameter),
        gesture::Gesture::Set(value) => setter.set_parameter(parameter, value),
        gesture::Gesture::End => setter.end_set_parameter(parameter),
    }
}

#[cfg(test)]
mod tests;
