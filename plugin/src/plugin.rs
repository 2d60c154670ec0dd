//! The instance a host holds: glue between the framework and the performer.
//!
//! Threads: the host creates, activates and drops it on its main thread and calls
//! [`process`](Plugin::process) on an audio thread, never both at once. Pieces come from the
//! [builder](overhear_player::builder)'s thread; the editor sees [snapshots](crate::monitor) only.
//!
//! The framework calls `process` once per slice between parameter changes, so that values moved
//! here at its start are sample-accurate. Notes do not cut slices and are met among the events, each at its
//! sample; one may lie right behind the slice.

use std::marker::PhantomData;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use nice_plug::prelude::*;

use crate::bypass::Bypass;
use crate::editor::OverhearEditor;
use crate::guard::caught;
use crate::host_parameters::{self, HostParameters};
use crate::monitor::{self, Publisher, Viewer};
use crate::outputs::{Apart, Buffers, Mix, Outputs};
use crate::state;
use overhear_engine::kit::Routing;
use overhear_engine::piece::SAMPLE_RATES;
use overhear_player::builder::{Arrival, Builder, Delivery, Outcome};
use overhear_player::building::{BuildPlan, Pace};
use overhear_player::decimation::{self, Decimation, LOWEST_RATE};
use overhear_player::parameters::parameters;
use overhear_player::performer::Performer;
use overhear_player::strokes::{self, Strokes, Waiting};

mod events;
mod sounding;

use events::play;
use sounding::Sounding;

/// How long activation waits for the pieces.
///
/// A project that is opened and bounced at once must not lose its first bar, hence the wait; a
/// machine too slow for it gets a kit that fills up while it plays rather than a host that hangs.
const BUILD_TIMEOUT: Duration = Duration::from_secs(if cfg!(test) { PATIENCE_OF_TESTS } else { 20 });

/// Tests run beside others and want a whole kit, s.
const PATIENCE_OF_TESTS: u64 = 120;

/// Overhear with one stereo output.
pub type Overhear = Instrument<Mix>;

/// Overhear with an output for every slot and each pair of microphones.
pub type OverhearMulti = Instrument<Apart>;

/// One instance.
pub struct Instrument<O> {
    parameters: Arc<HostParameters>,
    /// Whether the host renders to a file.
    offline: Arc<AtomicBool>,
    builder: Builder,
    /// What plays, once activated.
    stage: Option<Stage>,
    publisher: Publisher,
    viewer: Viewer,
    strokes: Strokes,
    waiting: Waiting,
    outputs: PhantomData<O>,
}

/// A performer, where its pieces come from, and the host's sample rate.
struct Stage {
    performer: Performer,
    sounding: Sounding,
    /// For a host whose sample rate is too low for the engine.
    decimation: Option<Decimation>,
    delivery: Delivery,
    sample_rate: f32,
    bypass: Bypass,
    /// Set by a panic in the engine: silent from then on, until the next activation.
    broken: bool,
}

impl<O> Default for Instrument<O> {
    fn default() -> Self {
        let (publisher, viewer) = monitor::monitor();
        let (strokes, waiting) = strokes::strokes();
        let (parameters, offline) = (host_parameters::for_new_instance(), Arc::<AtomicBool>::default());
        let builder = {
            let (parameters, offline) = (parameters.clone(), offline.clone());
            let deadlines = parameters.deadlines().clone();
            Builder::new(Arc::new(move || plan(&parameters, &offline)), deadlines)
        };
        Instrument {
            parameters,
            offline,
            builder,
            stage: None,
            publisher,
            viewer,
            strokes,
            waiting,
            outputs: PhantomData,
        }
    }
}

/// What is to be built now.
fn plan(host: &HostParameters, offline: &AtomicBool) -> BuildPlan {
    let pace = if offline.load(Ordering::Acquire) { Pace::Offline } else { Pace::RealTime };
    let value = |index: usize| {
        let default = parameters()[index].default;
        host.values().get(index).map_or(default, |value| value.unmodulated_plain_value())
    };
    BuildPlan::of(host.document(), value, pace)
}

impl<O: Outputs> Plugin for Instrument<O> {
    const NAME: &'static str = O::NAME;
    const VENDOR: &'static str = "The Overhear authors";
    // The project has neither a page nor a mailbox of its own.
    const URL: &'static str = "";
    const EMAIL: &'static str = "";
    const VERSION: &'static str = env!("CARGO_PKG_VERSION");

    const AUDIO_IO_LAYOUTS: &'static [AudioIOLayout] = &[O::LAYOUT];
    const MIDI_INPUT: MidiConfig = MidiConfig::MidiCCs;
    const SAMPLE_ACCURATE_AUTOMATION: bool = true;
    /// Beyond its capacity the framework allocates while it processes: room for more than a flood of controllers in the
    /// longest of buffers. What is not used takes no memory but addresses.
    const INPUT_EVENT_CAPACITY: usize = 65_536;

    type Editor = OverhearEditor;
    type SysExMessage = ();
    type BackgroundTask = ();

    fn params(&self) -> Arc<dyn Params> {
        self.parameters.clone()
    }

    fn editor(&mut self, _executor: AsyncExecutor<Self>) -> Option<OverhearEditor> {
        caught("editor", None, || {
            let (parameters, viewer) = (self.parameters.clone(), self.viewer.clone());
            Some(OverhearEditor::new(parameters, viewer, self.builder.shapes(), self.strokes.clone()))
        })
    }

    fn filter_state(state: &mut PluginState) {
        let sound = caught("filter_state", false, || {
            state::put_in_order(state);
            true
        });
        // A state that has no fields changes nothing.
        if !sound {
            state.params.clear();
            state.fields.clear();
        }
    }

    fn activate(
        &mut self,
        _layout: &AudioIOLayout,
        config: &BufferConfig,
        _context: &mut impl ActivateContext<Self>,
    ) -> bool {
        caught("Plugin::activate", false, || {
            let offline = config.process_mode == ProcessMode::Offline;
            let awaited = (!offline).then_some(f64::from(config.sample_rate));
            self.parameters.deadlines().expect(awaited);
            self.parameters.read_programs();
            self.prepare(config.sample_rate, offline)
        })
    }

    fn reset(&mut self) {
        caught("Plugin::reset", (), || {
            if self.parameters.resumes() {
                return;
            }
            self.waiting.clear();
            let bypassed = self.parameters.is_bypassed();
            if let Some(stage) = &mut self.stage {
                stage.bypass.settle(bypassed);
                stage.guarded(|stage| {
                    stage.performer.reset();
                    stage.sounding.forget();
                    stage.decimation.iter_mut().for_each(Decimation::reset);
                });
            }
        });
    }

    fn process(
        &mut self,
        buffer: &mut Buffer,
        aux: &mut AuxiliaryBuffers,
        context: &mut impl ProcessContext<Self>,
    ) -> ProcessStatus {
        caught("Plugin::process", ProcessStatus::Error("Overhear broke"), || {
            let Some(mut buffers) =
                Buffers::new(buffer.as_slice(), aux.outputs, self.parameters.used_outputs())
            else {
                return ProcessStatus::Error("Overhear plays in stereo only");
            };
            let bypassed = self.parameters.is_bypassed();
            let played = self.stage.as_mut().is_some_and(|stage| {
                stage.guarded(|stage| {
                    stage.follow(&self.parameters);
                    self.waiting.deliver(&mut stage.performer);
                    // A program of its own has nobody who times whole buffers.
                    self.parameters.deadlines().bounded(buffers.len(), || {
                        let Stage { performer, sounding, decimation, .. } = stage;
                        let next_event = || context.next_event();
                        let parameters = &self.parameters;
                        play(performer, sounding, decimation.as_mut(), &mut buffers, parameters, next_event);
                        // A host without room for it asks for nothing.
                        sounding.tell(|event| {
                            let _ = context.try_send_event(event);
                        });
                    });
                    stage.bypass.apply(bypassed, buffers.channels());
                    let (heard, _) = buffers.stretch(0, buffers.len());
                    self.publisher.heard(heard[0], heard[1]);
                    self.publisher.rendered(buffers.len(), &mut stage.performer);
                })
            });
            if !played {
                buffers.silence();
            }
            // A cymbal may ring for a minute after the last note.
            ProcessStatus::KeepAlive
        })
    }
}

impl<O: Outputs> Instrument<O> {
    /// Makes the kit for a host's sample rate (Hz) ready, unless it is, to be played or for a bounce; false if nothing can be
    /// played at that rate, which the window then says.
    fn prepare(&mut self, sample_rate: f32, offline: bool) -> bool {
        let factor = decimation::factor(f64::from(sample_rate));
        self.parameters.refuse_rate(factor.is_none().then_some(sample_rate));
        let Some(factor) = factor else {
            nice_error!("{sample_rate} Hz: accepted are {LOWEST_RATE} to {} Hz", SAMPLE_RATES.end());
            self.stage = None;
            return false;
        };
        let other_pace = self.offline.swap(offline, Ordering::AcqRel) != offline;
        // The engine's.
        let rate = f64::from(sample_rate) * factor as f64;
        let usable = |stage: &Stage| stage.sample_rate == sample_rate && !stage.broken;
        let document = self.parameters.document();
        let at_another_kit =
            self.stage.as_ref().is_some_and(|stage| *stage.performer.document() != *document);
        let ordered = if self.stage.as_ref().is_some_and(usable) {
            None
        } else {
            self.stage = None;
            Some(self.builder.order(rate, document.clone()))
        };
        // A kit that plays is replaced piece by piece while it plays on. A bounce gets what it asks for from its start,
        // and so does who plays after it: a kit made for bouncing may be too dear to be played. Nor does another kit begin
        // with what is left of the former one, nor one without its pieces.
        let is_whole = !at_another_kit && !self.builder.is_building();
        if ordered.is_none() && !offline && !other_pace && is_whole {
            self.follow();
            return true;
        }
        let outcome = self.builder.wait(BUILD_TIMEOUT);
        match outcome {
            Outcome::Finished => {}
            Outcome::Late => nice_warn!("The kit is not built yet: strokes are dropped until it is"),
            Outcome::Failed(reason) => {
                nice_error!("The kit cannot be built and stays silent: {reason}");
                self.stage = None;
                return true;
            }
        }
        if let Some(delivery) = ordered {
            let mut performer = Performer::new(rate, &document, self.parameters.assignments());
            performer.route(Routing::Instead);
            let bypass = Bypass::new(sample_rate, self.parameters.is_bypassed());
            let decimation = Decimation::new(factor);
            let sounding = Sounding::default();
            self.stage =
                Some(Stage { performer, sounding, decimation, delivery, sample_rate, bypass, broken: false });
            self.publisher.set_sample_rate(f64::from(sample_rate));
            self.parameters.monitor().set_rate(f64::from(sample_rate));
        }
        self.follow();
        true
    }

    /// Takes over parameters and pieces.
    fn follow(&mut self) {
        if let Some(stage) = &mut self.stage {
            stage.guarded(|stage| stage.follow(&self.parameters));
        }
    }
}

impl Stage {
    /// Takes over the parameters, then the kit and the pieces that have arrived: in this order a new piece
    /// starts with the present values.
    fn follow(&mut self, parameters: &HostParameters) {
        for (index, value) in parameters.values().iter().enumerate() {
            self.performer.set_parameter(index, value.value());
        }
        self.delivery.take(|arrival| match arrival {
            Arrival::Setup(setup) => Some(Arrival::Setup(self.performer.change_kit(setup))),
            Arrival::Piece(piece) => self.performer.install(piece).map(Arrival::Piece),
        });
        while let Some(piece) = self.performer.retire() {
            self.delivery.give_back(piece);
        }
        // Jobs that the workers have not brought back would be dropped with them.
        if self.performer.is_whole() {
            self.delivery.take_workers(|workers| self.performer.attach(workers));
        }
    }

    /// Runs the engine unless it broke, and says whether it ran well. A panic must not reach the
    /// host: it would take the whole project down.
    fn guarded(&mut self, engine: impl FnOnce(&mut Stage)) -> bool {
        let whole = !self.broken
            && caught("the engine", false, || {
                engine(self);
                true
            });
        self.broken = !whole;
        whole
    }
}

impl<O: Outputs> ClapPlugin for Instrument<O> {
    const CLAP_ID: &'static str = O::CLAP_ID;
    const CLAP_DESCRIPTION: Option<&'static str> = Some(O::ABOUT);
    const CLAP_MANUAL_URL: Option<&'static str> = None;
    const CLAP_SUPPORT_URL: Option<&'static str> = None;
    const CLAP_FEATURES: &'static [ClapFeature] =
        &[ClapFeature::Instrument, ClapFeature::Drum, ClapFeature::Synthesizer, ClapFeature::Stereo];

    /// One page for each group of parameters; longer ones are divided by the framework.
    fn remote_controls(&self, context: &mut impl RemoteControlsContext) {
        caught("remote_controls", (), || {
            context.add_section("Kit", |section| {
                let mut groups: Vec<&str> = Vec::new();
                for parameter in parameters() {
                    if !groups.contains(&parameter.group) {
                        groups.push(parameter.group);
                    }
                }
                for group in groups {
                    section.add_page(group, |page| {
                        for (parameter, value) in parameters().iter().zip(self.parameters.values()) {
                            if parameter.group == group {
                                page.add_param(value);
                            }
                        }
                    });
                }
            });
        });
    }
}

impl<O: Outputs> Vst3Plugin for Instrument<O> {
    const VST3_CLASS_ID: [u8; 16] = O::VST3_ID;
    const VST3_SUBCATEGORIES: &'static [Vst3SubCategory] =
        &[Vst3SubCategory::Instrument, Vst3SubCategory::Drum, Vst3SubCategory::Stereo];
}

#[cfg(test)]
mod tests;
