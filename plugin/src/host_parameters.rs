//! The table of parameters as the framework wants it, the host's own bypass, and what else a project stores.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use crossbeam::atomic::AtomicCell;
use nice_plug::params::persist::{deserialize_field, serialize_field};
use nice_plug::prelude::*;

use crate::deadline::Deadlines;
use crate::midi::assignments::{Assignment, Assignments, NOTES};
use crate::midi::maps::NoteMap;
use crate::parameters::{BYPASS_GROUP, BYPASS_ID, Drives, Manner, PARAMETERS, Parameter, host_id};
use crate::presets::{Library, Program, Programs};
use crate::state;
use crate::view::View;

/// Logical size of the editor's window, pixels: width, height.
pub type WindowSize = (u32, u32);

/// Window of a fresh instance.
pub const DEFAULT_WINDOW: WindowSize = (980, 640);

/// Smallest window in which everything is legible.
pub const SMALLEST_WINDOW: WindowSize = (800, 500);

/// Largest window a state is believed: a broken one must not open a window nobody can close.
const LARGEST_WINDOW: WindowSize = (7680, 4320);

/// Every parameter of the table, the bypass, and the window's size.
pub struct HostParameters {
    /// `[parameter]`, in the order of [`PARAMETERS`]. Boxed, as the framework keeps pointers.
    values: Box<[FloatParam]>,
    /// Boxed for the same reason.
    bypass: Box<BoolParam>,
    window: AtomicCell<WindowSize>,
    view: AtomicCell<View>,
    assignments: Arc<Assignments>,
    /// What program changes call; read when first needed, off the audio thread.
    programs: OnceLock<Programs>,
    /// No parameter, but what host, editor and audio thread share is here.
    deadlines: Deadlines,
}

impl Default for HostParameters {
    fn default() -> Self {
        HostParameters {
            values: PARAMETERS.iter().map(host_parameter).collect(),
            bypass: Box::new(BoolParam::new("Bypass", false).make_bypass()),
            window: AtomicCell::new(DEFAULT_WINDOW),
            view: AtomicCell::new(View::default()),
            assignments: Arc::default(),
            programs: OnceLock::new(),
            deadlines: Deadlines::default(),
        }
    }
}

thread_local! {
    /// The parameters of the instance that was made last on this thread.
    static LATEST: RefCell<Option<Arc<HostParameters>>> = const { RefCell::new(None) };
}

/// Parameters of a new instance, kept for whoever makes it through the framework, which hands none out.
pub fn for_new_instance() -> Arc<HostParameters> {
    let parameters = Arc::<HostParameters>::default();
    LATEST.set(Some(parameters.clone()));
    parameters
}

/// The parameters of the instance that was made last on this thread, once.
pub fn take_latest() -> Option<Arc<HostParameters>> {
    LATEST.take()
}

impl HostParameters {
    /// Every note that sounds, with its name.
    pub fn note_names(&self) -> Vec<(u8, &'static str)> {
        let map = NoteMap::ALL.get(self.manner(Manner::Map) as usize).copied().unwrap_or_default();
        let name = |note: u8| match self.assignments.of(note) {
            Assignment::Mapped => map.name(note),
            Assignment::Silent => None,
            Assignment::Plays(reference) => NoteMap::GeneralMidi.name(reference),
        };
        (0..NOTES as u8).filter_map(|note| Some((note, name(note)?))).collect()
    }

    /// Value of the parameter that moves this.
    fn manner(&self, manner: Manner) -> f32 {
        let index = PARAMETERS.iter().position(|parameter| parameter.drives == Drives::Playing(manner));
        index.and_then(|index| self.values.get(index)).map_or(0.0, |value| value.unmodulated_plain_value())
    }

    /// Reads the presets that program changes call, once. Not for the audio thread.
    pub fn read_programs(&self) {
        self.programs.get_or_init(|| Programs::of(&Library::default()));
    }

    /// The program that a program change on a channel calls, if the parameters let it.
    ///
    /// # Real-time
    /// Look-ups; no allocation, no lock.
    pub fn program(&self, number: u8, channel: u8) -> Option<&Program> {
        let only = self.manner(Manner::Channel);
        let heard = only == 0.0 || only == f32::from(channel) + 1.0;
        let follows = self.manner(Manner::FollowsPrograms) >= 0.5;
        self.programs.get().filter(|_| heard && follows)?.get(number)
    }

    /// Whether the parameters are where a program sets them.
    ///
    /// # Real-time
    /// Look-ups; no allocation, no lock.
    pub fn are_at(&self, program: &Program) -> bool {
        program.values.iter().all(|&(index, plain)| {
            let (parameter, value) = (PARAMETERS.get(index), self.values.get(index));
            parameter.zip(value).is_some_and(|(parameter, value)| {
                parameter.snap(value.unmodulated_plain_value()) == parameter.snap(plain)
            })
        })
    }

    /// The parameters, in the order of [`PARAMETERS`].
    pub fn values(&self) -> &[FloatParam] {
        &self.values
    }

    /// Share of its range, 0 to 1, at which a parameter of the table is without modulation, by its [`host_id`].
    pub fn unmodulated(&self, id: u32) -> Option<f32> {
        let index = PARAMETERS.iter().position(|parameter| host_id(parameter.id) == id)?;
        Some(self.values.get(index)?.unmodulated_normalized_value())
    }

    /// Whether the host bypasses the instrument.
    pub fn is_bypassed(&self) -> bool {
        self.bypass.value()
    }

    /// The user's assignments of notes.
    pub fn assignments(&self) -> Arc<Assignments> {
        self.assignments.clone()
    }

    /// Whether buffers are ready in time.
    pub fn deadlines(&self) -> &Deadlines {
        &self.deadlines
    }

    /// Logical size of the editor's window.
    pub fn window(&self) -> WindowSize {
        self.window.load()
    }

    /// How the editor's window looks at the kit.
    pub fn view(&self) -> View {
        self.view.load()
    }

    /// Stores how the editor's window looks at the kit.
    pub fn set_view(&self, view: View) {
        self.view.store(view);
    }

    /// Stores the logical size of the editor's window, within what is legible and sane.
    pub fn set_window(&self, (width, height): WindowSize) {
        self.window.store((
            width.clamp(SMALLEST_WINDOW.0, LARGEST_WINDOW.0),
            height.clamp(SMALLEST_WINDOW.1, LARGEST_WINDOW.1),
        ));
    }
}

fn host_parameter(parameter: &'static Parameter) -> FloatParam {
    let Parameter { group, label, min, max, .. } = *parameter;
    let range = FloatRange::Skewed { min, max, factor: parameter.skew() };
    // Hosts list names without their groups.
    let value = FloatParam::new(format!("{group} {label}"), parameter.default, range)
        .with_unit(parameter.unit)
        .with_step_size(parameter.step)
        .with_value_to_string(Arc::new(|value| parameter.text(value)))
        .with_string_to_value(Arc::new(|text| parameter.from_text(text)));
    if parameter.is_automatable() { value } else { value.non_automatable() }
}

// SAFETY: the pointers lead into a boxed slice that lives as long as `self` and never moves.
#[allow(unsafe_code)]
unsafe impl Params for HostParameters {
    fn param_map(&self) -> Vec<(String, ParamPtr, String)> {
        std::iter::zip(&PARAMETERS, &self.values)
            .map(|(parameter, value)| (parameter.id.to_owned(), value.as_ptr(), parameter.group.to_owned()))
            .chain([(BYPASS_ID.to_owned(), self.bypass.as_ptr(), BYPASS_GROUP.to_owned())])
            .collect()
    }

    fn serialize_fields(&self) -> BTreeMap<String, String> {
        let mut fields = BTreeMap::new();
        fields.insert(state::SCHEMA_FIELD.to_owned(), state::SCHEMA.to_string());
        if let Ok(window) = serialize_field(&self.window()) {
            fields.insert(state::WINDOW_FIELD.to_owned(), window);
        }
        if let Ok(view) = serialize_field(&self.view().stored()) {
            fields.insert(state::VIEW_FIELD.to_owned(), view);
        }
        fields.insert(state::NOTES_FIELD.to_owned(), state::notes_text(&self.assignments.changed()));
        fields
    }

    fn deserialize_fields(&self, fields: &BTreeMap<String, String>) {
        // A state older than assignments has none.
        let notes = fields.get(state::NOTES_FIELD).map(|text| state::notes(text)).unwrap_or_default();
        self.assignments.replace(&notes);
        // A state older than views has none.
        let view = fields.get(state::VIEW_FIELD).and_then(|text| deserialize_field(text).ok());
        self.set_view(view.map_or_else(View::default, View::from_stored));
        let Some(window) = fields.get(state::WINDOW_FIELD) else { return };
        match deserialize_field(window) {
            Ok(window) => self.set_window(window),
            Err(error) => nice_warn!("The window's size in the state is unreadable: {error}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_host_sees_the_table_in_its_order() {
        let parameters = HostParameters::default();
        let map = parameters.param_map();
        assert_eq!(map.len(), PARAMETERS.len() + 1);
        assert_eq!(map[PARAMETERS.len()].0, BYPASS_ID);
        for ((id, _, group), parameter) in map.iter().zip(&PARAMETERS) {
            assert_eq!((id.as_str(), group.as_str()), (parameter.id, parameter.group));
        }
    }

    #[test]
    fn what_a_host_sends_is_what_the_table_says() {
        let parameters = HostParameters::default();
        for (parameter, value) in PARAMETERS.iter().zip(parameters.values()) {
            assert_eq!(value.default_plain_value(), parameter.default);
            for plain in [parameter.min, parameter.default, parameter.centre, parameter.max] {
                // A switch has no middle.
                let plain = parameter.snap(plain);
                let normalized = value.preview_normalized(plain);
                assert_eq!(normalized, parameter.normalized(plain), "{}", parameter.name);
                assert_eq!(value.preview_plain(normalized), plain, "{}", parameter.name);
                let text = value.normalized_value_to_string(normalized, true);
                assert_eq!(value.string_to_normalized_value(&text), Some(normalized), "{text}");
            }
            let middle = value.preview_plain(0.5);
            assert!((middle - parameter.centre).abs() <= parameter.step, "{}", parameter.name);
        }
    }

    #[test]
    fn the_window_is_stored_and_restored_within_reason() {
        let parameters = HostParameters::default();
        parameters.set_window((1200, 800));
        let fields = parameters.serialize_fields();
        let restored = HostParameters::default();
        restored.deserialize_fields(&fields);
        assert_eq!(restored.window(), (1200, 800));

        for (broken, kept) in
            [("[1,1]", SMALLEST_WINDOW), ("\"large\"", SMALLEST_WINDOW), ("[9e9,1]", SMALLEST_WINDOW)]
        {
            let fields = [(state::WINDOW_FIELD.to_owned(), broken.to_owned())].into();
            restored.deserialize_fields(&fields);
            assert_eq!(restored.window(), kept, "{broken}");
        }
    }
}
