//! The table of parameters as the framework wants it, the host's own bypass, and what else a project stores.
//!
//! The kit is here too: whoever changes it puts another [document](KitDocument) in its place, which the builder notices. The
//! audio thread never looks at it here.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};

use crossbeam::atomic::AtomicCell;
use nice_plug::params::persist::{deserialize_field, serialize_field};
use nice_plug::prelude::*;
use overhear_engine::error::SpecError;

use crate::guard::caught;
use crate::incoming::Monitor;
use crate::outputs::Used;
use crate::scale::Scale;
use crate::view::View;
use overhear_player::deadline::Deadlines;
use overhear_player::kit_document::KitDocument;
use overhear_player::midi::assignments::{Assignment, Assignments, NOTES};
use overhear_player::midi::maps::NoteMap;
use overhear_player::parameters::{
    BYPASS_GROUP, BYPASS_ID, Drives, Manner, Parameter, from_text, host_id, parameters, slot_parameter, text,
};
use overhear_player::presets::{Library, Program, Programs};
use overhear_player::state;

/// Logical size of the editor's window, pixels: width, height.
pub type WindowSize = (u32, u32);

/// Window of a fresh instance.
pub const DEFAULT_WINDOW: WindowSize = (980, 640);

/// Smallest window in which everything is legible.
pub const SMALLEST_WINDOW: WindowSize = (800, 500);

/// Largest window a state is believed: a broken one must not open a window nobody can close.
const LARGEST_WINDOW: WindowSize = (7680, 4320);

/// Above the bits of a rate that was refused.
const REFUSED: u64 = 1 << 32;

/// The kit of an instance, shared with whoever shows values as the kit has them.
type SharedDocument = Arc<Mutex<Arc<KitDocument>>>;

/// Every parameter of the table, the bypass, the kit, and the window's size.
pub struct HostParameters {
    /// `[parameter]`, in the order of the table. Boxed, as the framework keeps pointers.
    values: Box<[FloatParam]>,
    /// Boxed for the same reason.
    bypass: Box<BoolParam>,
    window: AtomicCell<WindowSize>,
    view: AtomicCell<View>,
    assignments: Arc<Assignments>,
    document: SharedDocument,
    /// What program changes call at the present kit; read when first needed, off the audio thread. Others hold this lock
    /// for as long as it takes to put two words in their place, and the audio thread does not wait for it.
    programs: Mutex<Option<Programs>>,
    /// No parameter, but what host, editor and audio thread share is here.
    deadlines: Arc<Deadlines>,
    /// Whether processing goes on where it was stopped: no parameter either.
    resumes: AtomicBool,
    /// Which outputs the host uses in the present buffer: no parameter either.
    used: AtomicU32,
    /// The bits of a sample rate that was refused, Hz, with one more above them; 0 if none was.
    refused: AtomicU64,
    /// Of the screen, and what arrives, for the editor: no parameters either.
    scale: Scale,
    monitor: Monitor,
    /// Tells the host that the kit is another one.
    teller: Mutex<Option<Teller>>,
}

/// Called by whoever has changed the kit, on any thread but the audio thread.
pub type Teller = Box<dyn Fn() + Send>;

impl Default for HostParameters {
    fn default() -> Self {
        let document = SharedDocument::default();
        let host_parameter = |(index, parameter)| host_parameter(index, parameter, &document);
        HostParameters {
            values: parameters().iter().enumerate().map(host_parameter).collect(),
            bypass: Box::new(BoolParam::new("Bypass", false).make_bypass()),
            window: AtomicCell::new(DEFAULT_WINDOW),
            view: AtomicCell::new(View::default()),
            assignments: Arc::default(),
            document,
            programs: Mutex::new(None),
            deadlines: Arc::default(),
            resumes: AtomicBool::new(false),
            used: AtomicU32::new(Used::ALL.0),
            refused: AtomicU64::new(0),
            scale: Scale::default(),
            monitor: Monitor::default(),
            teller: Mutex::new(None),
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
    /// The kit and its notes. Not for the audio thread.
    pub fn document(&self) -> Arc<KitDocument> {
        present(&self.document)
    }

    /// Puts a kit in the place of the present one: the builder notices and builds what differs. Parameters keep their
    /// values. A kit that does not pass its [check](KitDocument::check) is not taken. Not for the audio thread.
    ///
    /// # Errors
    /// What the check says.
    pub fn set_document(&self, document: Arc<KitDocument>) -> Result<(), SpecError> {
        document.check()?;
        if *self.document() == *document {
            return Ok(());
        }
        let programs = lock(&self.programs).clone();
        let changed = programs.map(|programs| programs.at(&document.kit));
        let former = std::mem::replace(&mut *lock(&self.document), document);
        // Dropped once nobody waits for either lock.
        let former = (former, changed.and_then(|programs| lock(&self.programs).replace(programs)));
        drop(former);
        if let Some(tell) = &*lock(&self.teller) {
            tell();
        }
        Ok(())
    }

    /// Says who tells the host of another kit; nobody, once this returns, if none does.
    pub fn tell_by(&self, teller: Option<Teller>) {
        *lock(&self.teller) = teller;
    }

    /// Every note that sounds, with its name. Not for the audio thread.
    pub fn note_names(&self) -> Vec<(u8, String)> {
        let document = self.document();
        let map = NoteMap::ALL.get(self.manner(Manner::Map) as usize).copied().unwrap_or_default();
        let name = |note: u8| match self.assignments.of(note) {
            Assignment::Mapped => map.name(note, &document.notes),
            Assignment::Silent => None,
            Assignment::Plays(reference) => NoteMap::GeneralMidi.name(reference, &document.notes),
        };
        (0..NOTES as u8).filter_map(|note| Some((note, name(note)?.to_owned()))).collect()
    }

    /// Value of the parameter that moves this.
    fn manner(&self, manner: Manner) -> f32 {
        let index = parameters().iter().position(|parameter| parameter.drives == Drives::Playing(manner));
        index.and_then(|index| self.values.get(index)).map_or(0.0, |value| value.unmodulated_plain_value())
    }

    /// Reads the presets that program changes call, once. Not for the audio thread.
    pub fn read_programs(&self) {
        if lock(&self.programs).is_none() {
            let programs = Programs::of(&Library::default(), &self.document().kit);
            *lock(&self.programs) = Some(programs);
        }
    }

    /// Does something with the program that a program change on a channel calls, if the parameters let it. In the instant in
    /// which the kit changes no program is called.
    ///
    /// # Real-time
    /// Look-ups; no allocation, and nobody is waited for.
    pub fn with_program<T>(&self, number: u8, channel: u8, act: impl FnOnce(&Program) -> T) -> Option<T> {
        let only = self.manner(Manner::Channel);
        let heard = only == 0.0 || only == f32::from(channel) + 1.0;
        let follows = self.manner(Manner::FollowsPrograms) >= 0.5;
        if !(heard && follows) {
            return None;
        }
        let programs = match self.programs.try_lock() {
            Ok(programs) => programs,
            Err(TryLockError::Poisoned(programs)) => programs.into_inner(),
            Err(TryLockError::WouldBlock) => return None,
        };
        programs.as_ref()?.get(number).map(act)
    }

    /// Whether the parameters are where a program sets them.
    ///
    /// # Real-time
    /// Look-ups; no allocation, no lock.
    pub fn are_at(&self, program: &Program) -> bool {
        program.values.iter().all(|&(index, plain)| {
            let (parameter, value) = (parameters().get(index), self.values.get(index));
            parameter.zip(value).is_some_and(|(parameter, value)| {
                parameter.snap(value.unmodulated_plain_value()) == parameter.snap(plain)
            })
        })
    }

    /// The parameters, in the order of the table.
    pub fn values(&self) -> &[FloatParam] {
        &self.values
    }

    /// Share of its range, 0 to 1, at which a parameter of the table is without modulation, by its [`host_id`].
    pub fn unmodulated(&self, id: u32) -> Option<f32> {
        let index = parameters().iter().position(|parameter| host_id(parameter.id) == id)?;
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

    /// What arrives.
    pub fn monitor(&self) -> &Monitor {
        &self.monitor
    }

    /// Whether buffers are ready in time.
    pub fn deadlines(&self) -> &Arc<Deadlines> {
        &self.deadlines
    }

    /// Does something in which the framework resets the instrument though what rings is to ring on.
    pub fn resuming<T>(&self, act: impl FnOnce() -> T) -> T {
        self.resumes.store(true, Ordering::Release);
        let result = act();
        self.resumes.store(false, Ordering::Release);
        result
    }

    /// Says which outputs the host uses from now on.
    ///
    /// # Real-time
    /// A store.
    pub fn use_outputs(&self, used: Used) {
        self.used.store(used.0, Ordering::Relaxed);
    }

    /// Which outputs the host uses; all where nobody has said.
    pub fn used_outputs(&self) -> Used {
        Used(self.used.load(Ordering::Relaxed))
    }

    /// Says which sample rate (Hz) a host asked for at which nothing can be played, if it did.
    pub fn refuse_rate(&self, rate: Option<f32>) {
        self.refused.store(rate.map_or(0, |rate| REFUSED | u64::from(rate.to_bits())), Ordering::Relaxed);
    }

    /// The sample rate that a host asked for, Hz, if nothing can be played at it.
    pub fn refused_rate(&self) -> Option<f32> {
        let refused = self.refused.load(Ordering::Relaxed);
        (refused != 0).then_some(f32::from_bits(refused as u32))
    }

    /// Whether a reset is to change nothing.
    pub fn resumes(&self) -> bool {
        self.resumes.load(Ordering::Acquire)
    }

    /// Logical size of the editor's window.
    pub fn window(&self) -> WindowSize {
        self.window.load()
    }

    /// How many pixels a point of the editor's window has.
    pub fn scale(&self) -> &Scale {
        &self.scale
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

fn host_parameter(index: usize, parameter: &'static Parameter, document: &SharedDocument) -> FloatParam {
    let Parameter { group, label, unit, min, max, .. } = *parameter;
    let range = FloatRange::Skewed { min, max, factor: parameter.skew() };
    // Hosts list names without their groups.
    let value =
        FloatParam::new(format!("{group} {label}"), parameter.default, range).with_step_size(parameter.step);
    let value = if slot_parameter(index).is_some() {
        // What a slot's value means depends on the piece there, its unit included.
        let (shown, typed) = (document.clone(), document.clone());
        value
            .with_value_to_string(told(move |value| text(index, value, &present(&shown).kit)))
            .with_string_to_value(typed_in(move |text| from_text(index, text, &present(&typed).kit)))
    } else {
        value
            .with_unit(unit)
            .with_value_to_string(told(|value| parameter.text(value)))
            .with_string_to_value(typed_in(|text| parameter.from_text(text)))
    };
    if parameter.is_automatable() { value } else { value.non_automatable() }
}

/// A value's text, for whoever asks.
fn told(text: impl Fn(f32) -> String + Send + Sync + 'static) -> Arc<dyn Fn(f32) -> String + Send + Sync> {
    Arc::new(move |value| caught("value_to_text", String::new(), || text(value)))
}

/// Reads what is typed.
type Typed = dyn Fn(&str) -> Option<f32> + Send + Sync;

/// The value that a text stands for, for whoever asks.
fn typed_in(value: impl Fn(&str) -> Option<f32> + Send + Sync + 'static) -> Arc<Typed> {
    Arc::new(move |text| caught("text_to_value", None, || value(text)))
}

/// The present kit.
fn present(document: &SharedDocument) -> Arc<KitDocument> {
    lock(document).clone()
}

/// Locks even after a panic elsewhere: every value behind these locks is valid at all times.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

// SAFETY: the pointers lead into a boxed slice that lives as long as `self` and never moves.
#[allow(unsafe_code)]
unsafe impl Params for HostParameters {
    fn param_map(&self) -> Vec<(String, ParamPtr, String)> {
        std::iter::zip(parameters(), &self.values)
            .map(|(parameter, value)| (parameter.id.to_owned(), value.as_ptr(), parameter.group.to_owned()))
            .chain([(BYPASS_ID.to_owned(), self.bypass.as_ptr(), BYPASS_GROUP.to_owned())])
            .collect()
    }

    fn serialize_fields(&self) -> BTreeMap<String, String> {
        caught("serialize_fields", BTreeMap::new(), || self.fields())
    }

    fn deserialize_fields(&self, fields: &BTreeMap<String, String>) {
        caught("deserialize_fields", (), || self.take_fields(fields));
    }
}

impl HostParameters {
    /// Everything that a project stores but the parameters.
    fn fields(&self) -> BTreeMap<String, String> {
        let mut fields = BTreeMap::new();
        fields.insert(state::SCHEMA_FIELD.to_owned(), state::SCHEMA.to_string());
        if let Ok(window) = serialize_field(&self.window()) {
            fields.insert(state::WINDOW_FIELD.to_owned(), window);
        }
        if let Ok(view) = serialize_field(&self.view().stored()) {
            fields.insert(state::VIEW_FIELD.to_owned(), view);
        }
        fields.insert(state::NOTES_FIELD.to_owned(), state::notes_text(&self.assignments.changed()));
        let learned = self.assignments.calibration().learned().to_text();
        if !learned.is_empty() {
            fields.insert(state::CALIBRATION_FIELD.to_owned(), learned);
        }
        fields.extend(state::kit_text(&self.document()).map(|text| (state::KIT_FIELD.to_owned(), text)));
        fields
    }

    /// Takes over what [`fields`](Self::fields) has written.
    fn take_fields(&self, fields: &BTreeMap<String, String>) {
        // Every state that was not refused as a whole has a schema by now.
        if !fields.contains_key(state::SCHEMA_FIELD) {
            return;
        }
        match state::kit(fields) {
            Ok(document) => {
                if let Err(error) = self.set_document(Arc::new(document)) {
                    nice_warn!("The kit in the state cannot be built: {error}");
                }
            }
            Err(error) => nice_warn!("The kit in the state is unreadable: {error}"),
        }
        // A state older than assignments has none.
        let notes = fields.get(state::NOTES_FIELD).map(|text| state::notes(text)).unwrap_or_default();
        self.assignments.replace(&notes);
        // And one older than calibration, or of an instance without any, has none.
        let learned = fields.get(state::CALIBRATION_FIELD).map(|text| state::calibration(text));
        self.assignments.calibration().replace(&learned.unwrap_or_default());
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
mod tests;
