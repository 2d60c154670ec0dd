//! The engine as a player: through the performer that the plugin uses.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use anyhow::{Context, Result};
use overhear::building::{BuildPlan, Pace};
use overhear::parameters::{self, parameters};
use overhear::performer::{Performer, velocity_from_midi};
use overhear::presets::{Library, Program, Programs};

use super::role::{Player, Setup};
use crate::bad_input;
use crate::message::{Meaning, Message};

/// The engine alone.
pub struct EnginePlayer {
    /// The performer that plays it.
    pub performer: Performer,
    /// What program changes call.
    programs: Programs,
}

impl EnginePlayer {
    /// Builds the kit as a file is rendered.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) if the kit cannot be built at the sample rate.
    pub fn new(setup: &Setup) -> Result<EnginePlayer> {
        EnginePlayer::at_pace(setup, Pace::Offline)
    }

    /// Builds the kit as it is played, or as a file is rendered.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) if the kit cannot be built at the sample rate.
    pub fn at_pace(setup: &Setup, pace: Pace) -> Result<EnginePlayer> {
        let rate = f64::from(setup.rate);
        let mut performer = Performer::new(rate, &setup.kit, Arc::default());
        // Before the pieces, as the plugin does it: they start with these values.
        for &(index, value) in &setup.settings {
            performer.set_parameter(index, value);
        }
        let value = |index: usize| {
            let usual = || parameters::default_value(index, &setup.kit.kit);
            performer.parameter(index).unwrap_or_else(usual)
        };
        let plan = BuildPlan::of(Arc::new(setup.kit.clone()), value, pace);
        for piece in plan.pieces(rate).map_err(|error| bad_input!("{error}"))? {
            performer.install(Box::new(piece));
        }
        performer.attach(plan.worker_plan().attach().context("the system starts no more threads")?);
        let programs = Programs::of(&Library::default(), &setup.kit.kit);
        Ok(EnginePlayer { performer, programs })
    }

    /// Plays messages within a buffer; `render` is called for each part between them.
    pub fn play(
        &mut self,
        messages: &[Message],
        frames: usize,
        mut render: impl FnMut(&mut Performer, Range<usize>),
    ) {
        let mut now = 0;
        for together in messages.chunk_by(|one, next| one.sample == next.sample) {
            let at = together.first().map_or(now, |message| message.sample as usize);
            if at > now {
                render(&mut self.performer, now..at);
                now = at;
            }
            self.call_programs(together);
            together.iter().for_each(|message| self.tell(message));
        }
        if now < frames {
            render(&mut self.performer, now..frames);
        }
    }

    /// Moves the parameters for the program changes among messages. As in a host, values act before whatever else
    /// happens at their sample.
    fn call_programs(&mut self, messages: &[Message]) {
        let mut values = BTreeMap::new();
        for message in messages {
            let Meaning::Program(number) = message.meaning() else { continue };
            if self.performer.changes_program(message.channel()) {
                values.extend(self.programs.get(number).iter().flat_map(|program| &program.values).copied());
            }
        }
        // Of several at one sample only the last acts.
        values.into_iter().for_each(|(index, value)| self.performer.set_parameter(index, value));
    }

    fn tell(&mut self, message: &Message) {
        let (performer, channel) = (&mut self.performer, message.channel());
        match message.meaning() {
            Meaning::NoteOn { key, velocity } => {
                performer.note_on(key, velocity_from_midi(velocity), channel);
            }
            Meaning::NoteOff { key } => performer.note_off(key, channel),
            Meaning::Pressure { key, pressure } => {
                performer.pressure(key, velocity_from_midi(pressure), channel);
            }
            Meaning::Controller { number, value } => {
                performer.control_change(number, velocity_from_midi(value), channel);
            }
            Meaning::Program(number) => {
                let program = self.programs.get(number);
                if let Some(program) = program.filter(|program| is_at(performer, program)) {
                    performer.program_change(program, channel);
                }
            }
            Meaning::Other => {}
        }
    }
}

/// Whether the parameters are where a program sets them: of several at one sample only the last one is.
fn is_at(performer: &Performer, program: &Program) -> bool {
    program.values.iter().all(|&(index, value)| {
        let parameter = parameters().get(index).zip(performer.parameter(index));
        parameter.is_some_and(|(parameter, present)| present == parameter.snap(value))
    })
}

impl Player for EnginePlayer {
    fn render(&mut self, messages: &[Message], left: &mut [f32], right: &mut [f32]) -> Result<()> {
        self.play(messages, left.len(), |performer, part| {
            performer.render(&mut left[part.clone()], &mut right[part]);
        });
        Ok(())
    }
}
