//! What a window shows and remembers: pages, the list of pieces beside them, a line about what happens below.

use std::sync::Arc;

use egui::{Align, Align2, Button, Layout, Rect, Ui, UiBuilder, pos2, vec2};
use overhear_engine::slot::Slot;
use overhear_engine::snapshot::{FieldShapes, KitSnapshot};

use super::build::{About, Build};
use super::gesture::Gesture;
use super::history::{History, Undoing};
use super::kit_view::camera::Camera;
use super::kit_view::{KitView, Seen};
use super::levels::Levels;
use super::mix::Mix;
use super::pairs::PairHand;
use super::physics::Physics;
use super::playing::PlayingPanel;
use super::presets::PresetBar;
use super::stage::{self, Stage};
use super::status::{self, Latest, News};
use super::values::Values;
use super::{knobs, list, physics, settings, theme};
use crate::host_parameters::HostParameters;
use crate::sound::Sound;
use crate::view::View;
use overhear_player::NAME;
use overhear_player::kit_document::KitDocument;
use overhear_player::midi::assignments::Taught;
use overhear_player::presets::Library;
use overhear_player::strokes::Stroke;

/// Space around and between panels, points.
const GAP: f32 = 8.0;

/// Height of the line of pages and presets, and of the line about what happens, points.
const HEADER: f32 = 34.0;
const FOOTER: f32 = 24.0;

/// Time in which the builder has noticed another kit, s: it looks ten times a second.
const NOTICED: f64 = 0.3;

/// Width of the list of pieces, points.
const LIST: f32 = 168.0;

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
    /// What the kit is made of.
    Build,
}

impl Page {
    /// In the order in which projects count them.
    pub const ALL: [(Page, &'static str); 7] = [
        (Page::Kit, "Kit"),
        (Page::Physics, "Physics"),
        (Page::Mix, "Mix"),
        (Page::Microphones, "Microphones"),
        (Page::Midi, "MIDI"),
        (Page::Settings, "Settings"),
        (Page::Build, "Build"),
    ];

    /// In the order in which they are shown.
    const SHOWN: [(Page, &'static str); 7] =
        [Page::ALL[0], Page::ALL[6], Page::ALL[1], Page::ALL[2], Page::ALL[3], Page::ALL[4], Page::ALL[5]];
}

/// What a window looks at.
pub struct Inputs<'a> {
    pub snapshot: &'a KitSnapshot,
    /// Those since the frame before, the oldest first.
    pub past: &'a [KitSnapshot],
    /// A piece's mode shapes once it is built.
    pub shapes: &'a dyn Fn(Slot) -> Option<Arc<FieldShapes>>,
    /// Whether the piece of a slot is being built at present.
    pub building: &'a dyn Fn(Slot) -> bool,
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
    /// The kit that everything here was made for.
    document: Arc<KitDocument>,
    selected: Slot,
    light: bool,
    zoom: f32,
    kit: KitView,
    stage: Stage,
    physics: Physics,
    mix: Mix,
    build: Build,
    levels: Levels,
    presets: PresetBar,
    playing: PlayingPanel,
    history: History,
    /// What the user had taught at the latest look, and its fingerprint.
    taught: Option<(u64, Taught)>,
    pair: PairHand,
    /// Where the kit was drawn last.
    picture: Rect,
    /// The latest snapshot.
    former: KitSnapshot,
    /// The stroke that the sentence is about.
    latest: Latest,
    late: News,
    limited: News,
    /// When a hand last changed the kit, s of the window's time.
    changed: f64,
}

impl Panels {
    /// Panels about a kit, with the presets of a library.
    pub fn new(library: Library, view: View, document: Arc<KitDocument>) -> Panels {
        // Beside that of the presets.
        let folder = library.folder().ok().and_then(|presets| Some(presets.parent()?.join("kits")));
        let kit = KitView::seen_from(Camera::of(view.camera), &document.kit);
        Panels {
            page: Page::ALL.get(usize::from(view.page)).map_or(Page::Kit, |(page, _)| *page),
            selected: within(&document, usize::from(view.piece)),
            document,
            light: view.light,
            zoom: view.zoom,
            kit,
            stage: Stage::default(),
            physics: Physics::new(),
            mix: Mix::default(),
            build: Build::new(folder),
            levels: Levels::default(),
            presets: PresetBar::new(library),
            playing: PlayingPanel::default(),
            history: History::default(),
            taught: None,
            pair: PairHand::default(),
            picture: Rect::ZERO,
            former: KitSnapshot::default(),
            latest: Latest::default(),
            late: News::default(),
            limited: News::default(),
            changed: f64::NEG_INFINITY,
        }
    }

    /// How the window looks at the kit, for the project to remember.
    pub fn view(&self) -> View {
        let place = Page::ALL.iter().position(|(page, _)| *page == self.page).unwrap_or_default();
        View {
            page: place as u8,
            light: self.light,
            piece: self.selected.index() as u8,
            camera: self.kit.camera.numbers(),
            zoom: self.zoom,
        }
    }

    /// Takes what was played before the window opened as old news.
    pub fn forget(&mut self, snapshot: &KitSnapshot) {
        self.former = *snapshot;
        (self.late, self.limited) = (News::default(), News::default());
        self.kit.forget_strokes(snapshot);
    }

    /// Goes over to the kit of the parameters if they have got another, as from a state that was loaded.
    fn follow_document(&mut self, inputs: &Inputs<'_>) {
        let document = inputs.parameters.document();
        if Arc::ptr_eq(&document, &self.document) {
            return;
        }
        self.history.forget();
        self.adopt(document, inputs);
    }

    /// Goes over to a kit.
    fn adopt(&mut self, document: Arc<KitDocument>, inputs: &Inputs<'_>) {
        self.selected = within(&document, self.selected.index());
        self.kit.adopt(&document.kit, inputs.snapshot);
        self.physics.forget();
        self.mix.forget();
        self.taught = None;
        self.latest = Latest::default();
        self.former = *inputs.snapshot;
        self.document = document;
    }

    /// Draws one frame.
    pub fn show(&mut self, ui: &mut Ui, inputs: &Inputs<'_>, hands: &mut Hands<'_>) {
        self.follow_document(inputs);
        let elapsed = ui.input(|input| input.unstable_dt);
        self.levels.follow(inputs.snapshot, elapsed);
        self.latest.follow(&self.former, inputs.snapshot);
        self.former = *inputs.snapshot;
        self.follow_physics(ui.input(|input| input.time), inputs);
        if !ui.input(|input| input.pointer.any_down()) {
            self.follow_taught(inputs);
        }

        let whole = ui.max_rect().shrink(GAP);
        let (header, rest) = whole.split_top_bottom_at_y(whole.min.y + HEADER);
        let (middle, footer) = rest.split_top_bottom_at_y(rest.max.y - FOOTER);
        let (beside, page) = middle.split_left_right_at_x(middle.min.x + LIST);
        let page = Rect::from_min_max(page.min + vec2(GAP, 0.0), page.max);

        let all = inputs.parameters.values();
        let document = self.document.clone();
        let values = Values { all, kit: &document.kit };
        let mut undone = Vec::new();
        let mut noted = Vec::new();
        {
            let mut set = |index: usize, gesture: Gesture| {
                noted.push((index, gesture, values.plain(index).unwrap_or(0.0)));
                (hands.set)(index, gesture);
            };
            self.header(ui, header, inputs, &mut set);
            list::show(ui, beside, &document.kit, &mut self.selected, inputs.snapshot, &self.levels);
            let mut hands = Hands { set: &mut set, play: hands.play };
            self.page(ui, page, inputs, &document, &mut hands);
        }
        for (index, gesture, value) in noted {
            self.history.note(index, gesture, value);
        }
        // A kit that hands have built or chosen, as a state would not come just now.
        let built = inputs.parameters.document();
        if Arc::ptr_eq(&built, &document) {
            self.history.end_frame();
        } else {
            self.history.built(document.clone(), built.clone());
            self.adopt(built, inputs);
            self.changed = ui.input(|input| input.time);
        }
        self.footer(ui, footer, inputs, &mut undone);
        for (index, gesture) in undone {
            (hands.set)(index, gesture);
        }
    }

    /// The page that is open.
    fn page(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        inputs: &Inputs<'_>,
        document: &Arc<KitDocument>,
        hands: &mut Hands<'_>,
    ) {
        let values = Values { all: inputs.parameters.values(), kit: &document.kit };
        match self.page {
            Page::Kit | Page::Microphones => self.kit(ui, rect, inputs, document, hands),
            Page::Physics => {
                let Some(piece) = document.kit.piece(self.selected) else { return };
                let seen = physics::Seen {
                    snapshot: inputs.snapshot,
                    kit: &document.kit,
                    selected: (self.selected, piece),
                    shapes: (inputs.shapes)(self.selected),
                    sound: inputs.sound,
                };
                self.physics.show(ui, rect, &seen);
            }
            Page::Mix => self.mix.show(ui, rect, values, &self.levels, hands.set),
            Page::Midi => self.playing.show(ui, rect, inputs.parameters, document),
            Page::Settings => settings::show(ui, rect, values, &mut self.zoom, hands.set),
            Page::Build => {
                let building =
                    |slot: Slot| !inputs.snapshot.pieces[slot.index()].ready || (inputs.building)(slot);
                let about = About { parameters: inputs.parameters, document, building: &building };
                self.build.show(ui, rect, &about, &mut self.selected, hands.set);
            }
        }
    }

    /// Takes note of what was learned on the page for that: it can be undone.
    fn follow_taught(&mut self, inputs: &Inputs<'_>) {
        let assignments = inputs.parameters.assignments();
        let now = assignments.fingerprint();
        if self.taught.as_ref().is_some_and(|(known, _)| *known == now) {
            return;
        }
        let taught = assignments.taught();
        let former = self.taught.replace((now, taught.clone()));
        if let Some((_, former)) = former.filter(|(_, former)| self.page == Page::Midi && *former != taught) {
            self.history.learned(former, taught);
        }
    }

    /// Takes note of every snapshot at its time, so that diagrams of the past are as fine however rarely frames come.
    fn follow_physics(&mut self, now: f64, inputs: &Inputs<'_>) {
        let newest = inputs.past.last().map_or(0, |snapshot| snapshot.clock);
        for snapshot in inputs.past {
            let age = newest.saturating_sub(snapshot.clock) as f64 / f64::from(inputs.sound.rate().max(1.0));
            self.physics.follow(now - age, &self.document.kit, snapshot, inputs.shapes);
        }
        self.physics.forget_before(now);
    }

    /// Whether the builder may not have noticed yet that the kit was changed; `now` in s.
    pub fn waits(&self, now: f64) -> bool {
        now - self.changed < NOTICED
    }

    /// Whether the next frame will look different though nothing new happens; `now` in s.
    pub fn moves_on(&self, snapshot: &KitSnapshot, now: f64) -> bool {
        let alone = self.page == Page::Physics && self.physics.moves_on();
        alone || self.levels.move_on() || self.kit.replays(snapshot, now)
    }

    /// The picture and the knobs of the selected piece.
    fn kit(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        inputs: &Inputs<'_>,
        document: &KitDocument,
        hands: &mut Hands<'_>,
    ) {
        let (picture, below) = rect.split_top_bottom_at_y(rect.max.y - knobs::PANEL_HEIGHT);
        let picture = Rect::from_min_max(picture.min, picture.max - vec2(0.0, GAP));
        self.picture = picture;
        let values = Values { all: inputs.parameters.values(), kit: &document.kit };
        let plain = |index: usize| values.plain(index);
        let microphones = self.page == Page::Microphones;
        let seen = Seen {
            snapshot: inputs.snapshot,
            document,
            shapes: inputs.shapes,
            selected: self.selected,
            microphones: microphones.then_some(&plain as &dyn Fn(usize) -> Option<f32>),
        };
        let full_speed = values.named("dynamics").map_or(stage::SLOWEST, |dynamics| dynamics.plain());
        let done = self.stage.show(ui, picture, &mut self.kit, &seen, full_speed, hands.play);
        self.selected = done.chosen.unwrap_or(self.selected);
        if let Some(moved) = done.moved {
            self.pair.act(moved, values.all, hands.set);
        }
        if microphones {
            knobs::panels(ui, below, &["Microphones", "Overheads", "Room"], values, hands.set);
        } else if let Some(piece) = document.kit.piece(self.selected) {
            let accent = theme::of(ui).pieces[self.selected.index()];
            let items = values.of_piece(self.selected);
            knobs::panel(ui, below, (&piece.title, accent), &items, hands.set);
        }
    }

    fn header(&mut self, ui: &mut Ui, rect: Rect, inputs: &Inputs<'_>, set: &mut dyn FnMut(usize, Gesture)) {
        let palette = theme::of(ui);
        let name = rect.left_center() + vec2(4.0, -4.0);
        ui.painter().text(name, Align2::LEFT_CENTER, NAME, theme::heading(), palette.text);
        let rect = Rect::from_min_max(rect.min + vec2(108.0, 0.0), rect.max - vec2(0.0, GAP));
        ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                for (page, name) in Page::SHOWN {
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
        self.limited.follow(inputs.snapshot.limited_samples, now);
        let kit = &self.document.kit;
        let refused = inputs.parameters.refused_rate().map(|rate| status::refused(rate, palette));
        let trouble = refused
            .or_else(|| status::trouble(inputs.snapshot, kit, [&self.late, &self.limited], now, palette));
        let (text, colour) = trouble.unwrap_or_else(|| {
            let cents = self.latest.slot().map_or(0.0, |slot| self.physics.cents(slot));
            (self.latest.sentence(inputs.snapshot, kit, cents), palette.text)
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
        if ui.button(name).on_hover_text("Switch the palette").clicked() {
            self.light = !self.light;
            theme::choose(ui.ctx(), self.light);
        }
        let (shown, tip) = if self.history.is_second() {
            ("B", "Setting B; click to switch to setting A")
        } else {
            ("A", "Setting A; click to switch to setting B")
        };
        if ui.button(shown).on_hover_text(tip).clicked() {
            let other = self.history.swap(inputs.parameters.values(), &inputs.parameters.document(), set);
            if let Some(kit) = other {
                self.put_back(&kit, inputs);
            } else {
                self.history.end_frame();
            }
        }
        let (undo, redo) = ui.input(|input| {
            let z = input.modifiers.command && input.key_pressed(egui::Key::Z);
            (z && !input.modifiers.shift, z && input.modifiers.shift)
        });
        let assignments = inputs.parameters.assignments();
        let mut kit = None;
        let mut back = Undoing {
            set,
            teach: &mut |taught| assignments.teach(taught),
            build: &mut |document| kit = Some(document.clone()),
        };
        let mut acted = false;
        if ui.add_enabled(self.history.can_redo(), Button::new("Redo")).clicked() || redo {
            self.history.redo(&mut back);
            acted = true;
        }
        if ui.add_enabled(self.history.can_undo(), Button::new("Undo")).clicked() || undo {
            self.history.undo(&mut back);
            acted = true;
        }
        if let Some(kit) = kit {
            let document = inputs.parameters.document();
            // It has been there before, so it passes the check.
            if inputs.parameters.set_document(kit).is_ok()
                && !Arc::ptr_eq(&document, &inputs.parameters.document())
            {
                self.adopt(inputs.parameters.document(), inputs);
            }
        }
        if acted {
            self.taught = Some((assignments.fingerprint(), assignments.taught()));
        }
    }
}

impl Panels {
    /// Puts the kit of the other setting in the place of the present one, which is a step.
    fn put_back(&mut self, kit: &Arc<KitDocument>, inputs: &Inputs<'_>) {
        let before = self.document.clone();
        if inputs.parameters.set_document(kit.clone()).is_ok() {
            self.history.built(before, kit.clone());
            self.adopt(inputs.parameters.document(), inputs);
        }
    }
}

/// The slot of an index, or the last that has a piece.
fn within(document: &KitDocument, index: usize) -> Slot {
    Slot::new(index.min(document.kit.pieces.len().saturating_sub(1))).unwrap_or(Slot::ALL[0])
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
