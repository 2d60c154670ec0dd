//! The instance a host holds: glue between the framework and the performer.
//!
//! Threads: the host creates, activates and drops it on its main thread and calls
//! [`process`](Plugin::process) on an audio thread, never both at once. Pieces come from the
//! [builder](crate::builder)'s thread; the editor sees [snapshots](crate::monitor) only.
//!
//! The framework calls `process` once per slice between parameter changes, so that values moved
//! here at its start are sample-accurate. Notes do not cut slices and are met here, each at its
//! sample; one may lie right behind the slice.

use std::num::NonZeroU32;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::Duration;

use nice_plug::prelude::*;
use nice_plug_egui::RepaintNotifier;

use crate::builder::{Builder, Delivery, Outcome};
use crate::editor::OverhearEditor;
use crate::host_parameters::HostParameters;
use crate::monitor::{self, Publisher, Viewer};
use crate::performer::Performer;
use crate::{CLAP_ID, NAME, state};

/// How long activation waits for the pieces.
///
/// A project that is opened and bounced at once must not lose its first bar, hence the wait; a
/// machine too slow for it gets a kit that fills up while it plays rather than a host that hangs.
const BUILD_TIMEOUT: Duration = Duration::from_secs(10);

/// Overhear, one instance.
pub struct Overhear {
    parameters: Arc<HostParameters>,
    builder: Builder,
    /// What plays, once activated at a rate that the engine accepts.
    stage: Option<Stage>,
    publisher: Publisher,
    viewer: Viewer,
    repaint: RepaintNotifier,
}

/// A performer, where its pieces come from, and its sample rate.
struct Stage {
    performer: Performer,
    delivery: Delivery,
    sample_rate: f32,
    /// Set by a panic in the engine: silent from then on, until the next activation.
    broken: bool,
}

impl Default for Overhear {
    fn default() -> Self {
        let repaint = RepaintNotifier::new();
        let (publisher, viewer) = monitor::monitor(repaint.clone());
        Overhear {
            parameters: Arc::default(),
            builder: Builder::default(),
            stage: None,
            publisher,
            viewer,
            repaint,
        }
    }
}

impl Plugin for Overhear {
    const NAME: &'static str = NAME;
    const VENDOR: &'static str = "The Overhear authors";
    // The project has neither a page nor a mailbox of its own.
    const URL: &'static str = "";
    const EMAIL: &'static str = "";
    const VERSION: &'static str = env!("CARGO_PKG_VERSION");

    const AUDIO_IO_LAYOUTS: &'static [AudioIOLayout] =
        &[AudioIOLayout { main_output_channels: NonZeroU32::new(2), ..AudioIOLayout::const_default() }];
    const MIDI_INPUT: MidiConfig = MidiConfig::Basic;
    const SAMPLE_ACCURATE_AUTOMATION: bool = true;
    /// Beyond its capacity the framework allocates while it processes: room for a dense roll on
    /// every piece and every parameter's automation in the longest of buffers.
    const INPUT_EVENT_CAPACITY: usize = 8192;

    type Editor = OverhearEditor;
    type SysExMessage = ();
    type BackgroundTask = ();

    fn params(&self) -> Arc<dyn Params> {
        self.parameters.clone()
    }

    fn editor(&mut self, _executor: AsyncExecutor<Self>) -> Option<OverhearEditor> {
        Some(OverhearEditor::new(
            self.parameters.clone(),
            self.viewer.clone(),
            self.builder.shapes(),
            self.repaint.clone(),
        ))
    }

    fn filter_state(state: &mut PluginState) {
        state::put_in_order(state);
    }

    fn activate(
        &mut self,
        _layout: &AudioIOLayout,
        config: &BufferConfig,
        _context: &mut impl ActivateContext<Self>,
    ) -> bool {
        self.prepare(config.sample_rate);
        // A rate that the engine does not know is no reason to lose the project: it stays silent.
        true
    }

    fn reset(&mut self) {
        if let Some(stage) = &mut self.stage {
            stage.guarded(|stage| stage.performer.reset());
        }
    }

    fn process(
        &mut self,
        buffer: &mut Buffer,
        _aux: &mut AuxiliaryBuffers,
        context: &mut impl ProcessContext<Self>,
    ) -> ProcessStatus {
        let [left, right] = buffer.as_slice() else {
            return ProcessStatus::Error("Overhear plays in stereo only");
        };
        let played = self.stage.as_mut().is_some_and(|stage| {
            stage.guarded(|stage| {
                stage.follow(&self.parameters);
                play(&mut stage.performer, left, right, || context.next_event());
                self.publisher.rendered(left.len(), &mut stage.performer);
            })
        });
        if !played {
            left.fill(0.0);
            right.fill(0.0);
        }
        // A cymbal may ring for a minute after the last note.
        ProcessStatus::KeepAlive
    }
}

impl Overhear {
    /// Makes the kit for a sample rate (Hz) ready, unless it is.
    fn prepare(&mut self, sample_rate: f32) {
        let rate = f64::from(sample_rate);
        let usable = |stage: &Stage| stage.sample_rate == sample_rate && !stage.broken;
        let ordered = if self.stage.as_ref().is_some_and(usable) {
            None
        } else {
            self.stage = None;
            Some(self.builder.order(rate))
        };
        match self.builder.wait(BUILD_TIMEOUT) {
            Outcome::Finished => {}
            Outcome::Late => nice_warn!("The kit is not built yet: strikes are dropped until then"),
            Outcome::Failed(reason) => {
                nice_error!("The kit cannot be built and stays silent: {reason}");
                self.stage = None;
                return;
            }
        }
        if let Some(delivery) = ordered {
            let performer = Performer::new(rate);
            self.stage = Some(Stage { performer, delivery, sample_rate, broken: false });
            self.publisher.set_sample_rate(rate);
        }
        if let Some(stage) = &mut self.stage {
            stage.guarded(|stage| stage.follow(&self.parameters));
        }
    }
}

impl Stage {
    /// Takes over the parameters, then the pieces that have arrived: in this order a new piece
    /// starts with the present values.
    fn follow(&mut self, parameters: &HostParameters) {
        for (index, value) in parameters.values().iter().enumerate() {
            self.performer.set_parameter(index, value.value());
        }
        self.delivery.take(|piece| self.performer.install(piece));
    }

    /// Runs the engine unless it broke, and says whether it ran well. A panic must not reach the
    /// host: it would take the whole project down.
    fn guarded(&mut self, engine: impl FnOnce(&mut Stage)) -> bool {
        self.broken = self.broken || catch_unwind(AssertUnwindSafe(|| engine(self))).is_err();
        !self.broken
    }
}

/// Renders a slice with its notes, each at its sample; late ones at once, none lost.
fn play<S>(
    performer: &mut Performer,
    left: &mut [f32],
    right: &mut [f32],
    mut next_event: impl FnMut() -> Option<NoteEvent<S>>,
) {
    let samples = left.len().min(right.len());
    let mut now = 0;
    let mut render_until = |performer: &mut Performer, until: usize| {
        if until > now {
            performer.render(&mut left[now..until], &mut right[now..until]);
            now = until;
        }
    };
    while let Some(event) = next_event() {
        // Other events do not cut: the engine renders whole stretches at a lower cost.
        if let NoteEvent::NoteOn { timing, channel, key, velocity, .. } = event
            && let Some(note) = key.number()
        {
            render_until(performer, samples.min(timing as usize));
            performer.note_on(note, velocity, channel.number().unwrap_or(0));
        }
    }
    render_until(performer, samples);
}

impl ClapPlugin for Overhear {
    const CLAP_ID: &'static str = CLAP_ID;
    const CLAP_DESCRIPTION: Option<&'static str> = Some("A physically modelled drum kit");
    const CLAP_MANUAL_URL: Option<&'static str> = None;
    const CLAP_SUPPORT_URL: Option<&'static str> = None;
    const CLAP_FEATURES: &'static [ClapFeature] =
        &[ClapFeature::Instrument, ClapFeature::Drum, ClapFeature::Synthesizer, ClapFeature::Stereo];
}

impl Vst3Plugin for Overhear {
    /// Frozen: projects find the plugin by it.
    const VST3_CLASS_ID: [u8; 16] = *b"OverhearDrumKit1";
    const VST3_SUBCATEGORIES: &'static [Vst3SubCategory] =
        &[Vst3SubCategory::Instrument, Vst3SubCategory::Drum, Vst3SubCategory::Stereo];
}

#[cfg(test)]
mod tests;
