//! What a window shows and remembers: pages, the list of pieces beside them, a line about what happens below.

use std::sync::Arc;

use egui::{Align, Align2, Button, Layout, Rect, Ui, UiBuilder, pos2, vec2};
use nice_plug::prelude::Param;
use overhear_engine::piece::PieceId;
use overhear_engine::snapshot::{FieldShapes, KitSnapshot};

use super::history::History;
use super::kit_view::camera::Camera;
use super::kit_view::{KitView, Seen};
use super::knob::Gesture;
use super::levels::Levels;
use super::mix::Mix;
use super::pairs::PairHand;
use super::physics::Physics;
use super::playing::PlayingPanel;
use super::presets::PresetBar;
use super::stage::{self, Stage};
use super::status::{self, Late, Latest};
use super::{knobs, list, physics, theme};
use crate::NAME;
use crate::host_parameters::HostParameters;
use crate::outputs::title;
use crate::presets::Library;
use crate::sound::Sound;
use crate::strokes::Stroke;
use crate::view::View;

/// Space around and between panels, points.
const GAP: f32 = 8.0;

/// Height of the line of pages and presets, and of the line about what happens, points.
const HEADER: f32 = 34.0;
const FOOTER: f32 = 24.0;

/// Width of the list of pieces, points.
const LIST: f32 = 168.0;

/// Sizes of everything that can be chosen.
const SIZES: [(f32, &str); 5] =
    [(0.75, "75 %"), (1.0, "100 %"), (1.25, "125 %"), (1.5, "150 %"), (2.0, "200 %")];

/// Pages of a window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Page {
    /// The kit in perspective, and the knobs of a piece.
    #[default]
    Kit,
    /// What the strokes did.
    Physics,
    /// Levels.
    Mix,
    /// Where the microphones stand, and their levels.
    Microphones,
    /// Which note plays what.
    Midi,
    /// What is about the kit as a whole.
    Settings,
}

impl Page {
    pub const ALL: [(Page, &'static str); 6] = [
        (Page::Kit, "Kit"),
        (Page::Physics, "Physics"),
        (Page::Mix, "Mix"),
        (Page::Microphones, "Microphones"),
        (Page::Midi, "MIDI"),
        (Page::Settings, "Settings"),
    ];
}

/// What a window looks at.
pub struct Inputs<'a> {
    pub snapshot: &'a KitSnapshot,
    /// Those since the frame before, the oldest first.
    pub past: &'a [KitSnapshot],
    /// A piece's mode shapes once it is built, by its slot.
    pub shapes: &'a dyn Fn(usize) -> Option<Arc<FieldShapes>>,
    pub parameters: &'a HostParameters,
    /// What is heard.
    pub sound: &'a Sound,
}

/// Where what hands do goes.
pub struct Hands<'a> {
    /// Receives what is done to the parameter of an index.
    pub set: &'a mut dyn FnMut(usize, Gesture),
    /// Receives strokes.
    pub play: &'a mut dyn FnMut(Stroke),
}

/// Everything one window shows and remembers.
pub struct Panels {
    page: Page,
    selected: usize,
    light: bool,
    zoom: f32,
    kit: KitView,
    stage: Stage,
    physics: Physics,
    mix: Mix,
    levels: Levels,
    presets: PresetBar,
    playing: PlayingPanel,
    history: History,
    pair: PairHand,
    /// Where the kit was drawn last.
    picture: Rect,
    /// The latest snapshot.
    former: KitSnapshot,
    /// The stroke that the sentence is about.
    latest: Latest,
    late: Late,
}

impl Panels {
    /// Panels with the presets of a library.
    pub fn new(library: Library, view: View) -> Panels {
        let kit = KitView::seen_from(Camera::of(view.camera));
        Panels {
            page: Page::ALL.get(usize::from(view.page)).map_or(Page::Kit, |(page, _)| *page),
            selected: usize::from(view.piece).min(PieceId::KIT.len() - 1),
            light: view.light,
            zoom: view.zoom,
            kit,
            stage: Stage::default(),
            physics: Physics::new(),
            mix: Mix::default(),
            levels: Levels::default(),
            presets: PresetBar::new(library),
            playing: PlayingPanel::default(),
            history: History::default(),
            pair: PairHand::default(),
            picture: Rect::ZERO,
            former: KitSnapshot::default(),
            latest: Latest::default(),
            late: Late::default(),
        }
    }

    /// How the window looks at the kit, for the project to remember.
    pub fn view(&self) -> View {
        let place = Page::ALL.iter().position(|(page, _)| *page == self.page).unwrap_or_default();
        View {
            page: place as u8,
            light: self.light,
            piece: self.selected as u8,
            camera: self.kit.camera.numbers(),
            zoom: self.zoom,
        }
    }

    /// Takes what was played before the window opened as old news.
    pub fn forget(&mut self, snapshot: &KitSnapshot) {
        self.former = *snapshot;
        self.late = Late::default();
        self.kit.forget_strokes(snapshot);
    }

    /// Draws one frame.
    pub fn show(&mut self, ui: &mut Ui, inputs: &Inputs<'_>, hands: &mut Hands<'_>) {
        let elapsed = ui.input(|input| input.unstable_dt);
        self.levels.follow(inputs.snapshot, elapsed);
        self.latest.follow(&self.former, inputs.snapshot);
        self.former = *inputs.snapshot;
        self.follow_physics(ui.input(|input| input.time), inputs);

        let whole = ui.max_rect().shrink(GAP);
        let (header, rest) = whole.split_top_bottom_at_y(whole.min.y + HEADER);
        let (middle, footer) = rest.split_top_bottom_at_y(rest.max.y - FOOTER);
        let (beside, page) = middle.split_left_right_at_x(middle.min.x + LIST);
        let page = Rect::from_min_max(page.min + vec2(GAP, 0.0), page.max);

        let values = inputs.parameters.values();
        let mut undone = Vec::new();
        let mut noted = Vec::new();
        {
            let mut set = |index: usize, gesture: Gesture| {
                noted.push((
                    index,
                    gesture,
                    values.get(index).map_or(0.0, |value| value.unmodulated_plain_value()),
                ));
                (hands.set)(index, gesture);
            };
            self.header(ui, header, inputs, &mut set);
            list::show(ui, beside, &mut self.selected, inputs.snapshot, &self.levels);
            match self.page {
                Page::Kit | Page::Microphones => {
                    self.kit(ui, page, inputs, &mut Hands { set: &mut set, play: hands.play })
                }
                Page::Physics => {
                    let shapes = (inputs.shapes)(self.selected);
                    let seen = physics::Seen {
                        snapshot: inputs.snapshot,
                        shapes,
                        selected: self.selected,
                        sound: inputs.sound,
                    };
                    self.physics.show(ui, page, &seen);
                }
                Page::Mix => self.mix.show(ui, page, values, &self.levels, &mut set),
                Page::Midi => self.playing.show(ui, page, inputs.parameters),
                Page::Settings => self.settings(ui, page, inputs, &mut set),
            }
            self.footer(ui, footer, inputs, &mut undone);
        }
        for (index, gesture, value) in noted {
            self.history.note(index, gesture, value);
        }
        self.history.end_frame();
        for (index, gesture) in undone {
            (hands.set)(index, gesture);
        }
    }

    /// Takes note of every snapshot at its time, so that diagrams of the past are as fine however rarely frames come.
    fn follow_physics(&mut self, now: f64, inputs: &Inputs<'_>) {
        let newest = inputs.past.last().map_or(0, |snapshot| snapshot.clock);
        for snapshot in inputs.past {
            let age = newest.saturating_sub(snapshot.clock) as f64 / f64::from(inputs.sound.rate().max(1.0));
            self.physics.follow(now - age, snapshot, inputs.shapes);
        }
        self.physics.forget_before(now);
    }

    /// Whether the next frame will look different though nothing new happens; `now` in s.
    pub fn moves_on(&self, snapshot: &KitSnapshot, now: f64) -> bool {
        let alone = self.page == Page::Physics && self.physics.moves_on();
        alone || self.levels.move_on() || self.kit.replays(snapshot, now)
    }

    /// The picture and the knobs of the selected piece.
    fn kit(&mut self, ui: &mut Ui, rect: Rect, inputs: &Inputs<'_>, hands: &mut Hands<'_>) {
        let (picture, below) = rect.split_top_bottom_at_y(rect.max.y - knobs::PANEL_HEIGHT);
        let picture = Rect::from_min_max(picture.min, picture.max - vec2(0.0, GAP));
        self.picture = picture;
        let values = inputs.parameters.values();
        let plain = |index: usize| Some(values.get(index)?.unmodulated_plain_value());
        let microphones = self.page == Page::Microphones;
        let seen = Seen {
            snapshot: inputs.snapshot,
            shapes: inputs.shapes,
            selected: self.selected,
            microphones: microphones.then_some(&plain as &dyn Fn(usize) -> Option<f32>),
        };
        let dynamics = plain(stage::dynamics()).unwrap_or(6.0);
        let done = self.stage.show(ui, picture, &mut self.kit, &seen, dynamics, hands.play);
        self.selected = done.chosen.unwrap_or(self.selected);
        if let Some(moved) = done.moved {
            self.pair.act(moved, values, hands.set);
        }
        let palette = theme::of(ui);
        let own = (title(PieceId::KIT[self.selected]), palette.pieces[self.selected]);
        let groups =
            [("Microphones", palette.accent), ("Overheads", palette.accent), ("Room", palette.accent)];
        let groups = if microphones { &groups[..] } else { &[own][..] };
        let width = below.width() / groups.len() as f32;
        for (place, group) in groups.iter().enumerate() {
            let left = below.min.x + place as f32 * width;
            let right = left + width - if place + 1 < groups.len() { GAP } else { 0.0 };
            let part = Rect::from_x_y_ranges(left..=right, below.y_range());
            knobs::panel(ui, part, *group, values, hands.set);
        }
    }

    /// What is about the kit as a whole, and the window.
    fn settings(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        inputs: &Inputs<'_>,
        set: &mut dyn FnMut(usize, Gesture),
    ) {
        let groups = ["Kit", "Playing", "Rendering"];
        ui.painter().rect_filled(rect, theme::CORNER, theme::of(ui).panel);
        ui.scope_builder(UiBuilder::new().max_rect(rect.shrink(10.0)), |ui| {
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                let inner = ui.max_rect();
                let bottom = knobs::grid(ui, inner, &groups, inputs.parameters.values(), set);
                ui.allocate_rect(
                    Rect::from_min_max(inner.min, pos2(inner.max.x, bottom)),
                    egui::Sense::hover(),
                );
                ui.horizontal(|ui| {
                    ui.label("Size of everything");
                    for (zoom, name) in SIZES {
                        if ui.selectable_label(self.zoom == zoom, name).clicked() {
                            self.zoom = zoom;
                            ui.ctx().set_zoom_factor(zoom);
                        }
                    }
                });
            });
        });
    }

    fn header(&mut self, ui: &mut Ui, rect: Rect, inputs: &Inputs<'_>, set: &mut dyn FnMut(usize, Gesture)) {
        let palette = theme::of(ui);
        let name = rect.left_center() + vec2(4.0, -4.0);
        ui.painter().text(name, Align2::LEFT_CENTER, NAME, theme::heading(), palette.text);
        let rect = Rect::from_min_max(rect.min + vec2(108.0, 0.0), rect.max - vec2(0.0, GAP));
        ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                for (page, name) in Page::ALL {
                    ui.selectable_value(&mut self.page, page, name);
                }
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    self.presets.show(ui, inputs.parameters, set);
                });
            });
        });
    }

    /// One sentence, and what takes back.
    fn footer(&mut self, ui: &mut Ui, rect: Rect, inputs: &Inputs<'_>, undone: &mut Vec<(usize, Gesture)>) {
        let palette = theme::of(ui);
        let now = ui.input(|input| input.time);
        self.late.follow(inputs.snapshot.late_buffers, now);
        let (text, colour) =
            status::trouble(inputs.snapshot, &self.late, now, palette).unwrap_or_else(|| {
                (self.latest.sentence(inputs.snapshot, self.physics.cents(self.latest.slot())), palette.text)
            });
        let left = pos2(rect.min.x + 4.0, rect.center().y + 3.0);
        let painter = ui.painter_at(Rect::from_min_max(rect.min, pos2(rect.max.x - 250.0, rect.max.y)));
        painter.text(left, Align2::LEFT_CENTER, text, theme::body(), colour);
        let rect = Rect::from_min_max(rect.min + vec2(0.0, 4.0), rect.max);
        ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                self.tools(ui, inputs, &mut |index, gesture| undone.push((index, gesture)));
            });
        });
    }

    fn tools(&mut self, ui: &mut Ui, inputs: &Inputs<'_>, set: &mut dyn FnMut(usize, Gesture)) {
        let name = if self.light { "Dark" } else { "Light" };
        if ui.button(name).on_hover_text("The other palette").clicked() {
            self.light = !self.light;
            theme::choose(ui.ctx(), self.light);
        }
        let (shown, tip) = if self.history.is_second() {
            ("B", "The second of two settings; click for the first")
        } else {
            ("A", "The first of two settings; click for the second")
        };
        if ui.button(shown).on_hover_text(tip).clicked() {
            self.history.swap(inputs.parameters.values(), set);
        }
        let (undo, redo) = ui.input(|input| {
            let z = input.modifiers.command && input.key_pressed(egui::Key::Z);
            (z && !input.modifiers.shift, z && input.modifiers.shift)
        });
        if ui.add_enabled(self.history.can_redo(), Button::new("Redo")).clicked() || redo {
            self.history.redo(set);
        }
        if ui.add_enabled(self.history.can_undo(), Button::new("Undo")).clicked() || undo {
            self.history.undo(set);
        }
    }
}

#[cfg(test)]
impl Panels {
    /// What the tests look into.
    pub fn kit_view(&self) -> &KitView {
        &self.kit
    }

    /// Where the kit was drawn last.
    pub fn picture(&self) -> Rect {
        self.picture
    }

    /// Levels shown of the two outputs, dB.
    pub fn main_levels(&self) -> [f32; 2] {
        self.levels.main()
    }

    pub fn open(&mut self, page: Page) {
        self.page = page;
    }
}
