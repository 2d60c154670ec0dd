//! The audio side of an instance.

use anyhow::{Result, anyhow, ensure};
use clack_host::events::UnknownEvent;
use clack_host::events::event_types::{ParamGestureBeginEvent, ParamGestureEndEvent, ParamValueEvent};
use clack_host::events::io::{EventBuffer, InputEvents, OutputEvents};
use clack_host::prelude::*;
use clack_host::process::StartedPluginAudioProcessor;
use overhear_engine::kit::OUTPUTS;

use super::event::Event;
use super::handlers::Host;

/// Outputs there is room for. With more the list of channels would have to grow while ports point into it.
const PORTS: usize = 1 + OUTPUTS;

/// What a hand does to a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Touch {
    /// It takes hold.
    Begin,
    /// It moves it to a value of the format's.
    Value(f64),
    /// It lets go.
    End,
}

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
            ports: AudioPorts::with_capacity(2 * PORTS, PORTS),
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

    /// Renders one buffer of the main output, full scale 1, with the events in it, ordered by offset.
    ///
    /// # Errors
    /// If the buffers are of different or too great lengths, or the plugin fails.
    pub fn process(&mut self, events: &[Event], left: &mut [f32], right: &mut [f32]) -> Result<()> {
        self.process_ports(events, &mut [[left, right]])
    }

    /// Renders one buffer of as many stereo outputs as are given, full scale 1, the main one first.
    ///
    /// # Errors
    /// As [`process`](Self::process).
    pub fn process_ports(&mut self, events: &[Event], ports: &mut [[&mut [f32]; 2]]) -> Result<()> {
        let frames = ports.first().map_or(0, |[left, _]| left.len());
        let same = ports.iter().flatten().all(|channel| channel.len() == frames);
        ensure!(same, "the channels differ in length");
        ensure!(ports.len() <= PORTS, "more outputs than there is room for");
        ensure!(frames <= self.max_frames as usize, "the plugin was activated for less");
        self.input.clear();
        self.output.clear();
        for event in events {
            event.push(&mut self.input);
        }
        let mut outputs = self.ports.with_output_buffers(ports.iter_mut().map(|port| AudioPortBuffer {
            latency: 0,
            channels: AudioPortBufferType::f32_output_only(port.iter_mut().map(|channel| &mut **channel)),
        }));
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
        self.steady_time += frames as u64;
        Ok(())
    }

    /// Parameters that the plugin said it has moved in the latest buffer: id and value in its unit.
    pub fn moved(&self) -> Vec<(u32, f64)> {
        let values = self.output.iter().filter_map(|event| event.as_event::<ParamValueEvent>());
        values.filter_map(|event| Some((event.param_id()?.get(), event.value()))).collect()
    }

    /// What hands at the plugin's window did to parameters in the latest buffer, in order: ids and what was done.
    pub fn touched(&self) -> Vec<(u32, Touch)> {
        let touch = |event: &UnknownEvent| {
            if let Some(begin) = event.as_event::<ParamGestureBeginEvent>() {
                Some((begin.param_id()?.get(), Touch::Begin))
            } else if let Some(end) = event.as_event::<ParamGestureEndEvent>() {
                Some((end.param_id()?.get(), Touch::End))
            } else {
                let value = event.as_event::<ParamValueEvent>()?;
                Some((value.param_id()?.get(), Touch::Value(value.value())))
            }
        };
        self.output.iter().filter_map(touch).collect()
    }

    /// Asks the plugin to forget all that sounds.
    pub fn reset(&mut self) {
        self.started.reset();
    }
}
