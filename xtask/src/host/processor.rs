//! The audio side of an instance.

use anyhow::{Result, anyhow, ensure};
use clack_host::events::io::{EventBuffer, InputEvents, OutputEvents};
use clack_host::prelude::*;
use clack_host::process::StartedPluginAudioProcessor;

use super::event::Event;
use super::handlers::Host;

/// Renders buffers, on the audio thread, between start and stop.
pub struct Processor {
    started: StartedPluginAudioProcessor<Host>,
    ports: AudioPorts,
    input: EventBuffer,
    output: EventBuffer,
    max_frames: u32,
    steady_time: u64,
}

impl Processor {
    /// Takes over a started plugin that was activated for buffers up to `max_frames`.
    pub(super) fn new(started: StartedPluginAudioProcessor<Host>, max_frames: u32) -> Processor {
        Processor {
            started,
            ports: AudioPorts::with_capacity(2, 1),
            input: EventBuffer::with_capacity(256),
            output: EventBuffer::with_capacity(64),
            max_frames,
            steady_time: 0,
        }
    }

    /// Gives the plugin back to be deactivated.
    pub(super) fn into_started(self) -> StartedPluginAudioProcessor<Host> {
        self.started
    }

    /// Renders one buffer of the main output with the events in it, ordered by offset.
    ///
    /// # Errors
    /// If the buffers are of different or too great lengths, or the plugin fails.
    pub fn process(&mut self, events: &[Event], left: &mut [f32], right: &mut [f32]) -> Result<()> {
        ensure!(left.len() == right.len(), "the two channels differ in length");
        ensure!(left.len() <= self.max_frames as usize, "the plugin was activated for less");
        self.input.clear();
        self.output.clear();
        for event in events {
            event.push(&mut self.input);
        }
        let frames = left.len() as u64;
        let mut outputs = self.ports.with_output_buffers([AudioPortBuffer {
            latency: 0,
            channels: AudioPortBufferType::f32_output_only([left, right].into_iter()),
        }]);
        self.started
            .process(
                &InputAudioBuffers::empty(),
                &mut outputs,
                &InputEvents::from_buffer(&self.input),
                &mut OutputEvents::from_buffer(&mut self.output),
                Some(self.steady_time),
                None,
            )
            .map_err(|error| anyhow!("the plugin fails to process: {error}"))?;
        self.steady_time += frames;
        Ok(())
    }

    /// Asks the plugin to forget all that sounds.
    pub fn reset(&mut self) {
        self.started.reset();
    }
}
