//! One sample with contacts: everything steps without contact forces, then all forces are solved together.

use crate::modal::Pressure;

use super::Surface;
use super::attachment::Attachment;
use super::body::{FreeStep, SoundingBody, StruckBody, add};
use super::contacts::{STRIKER_PLACES, owner};
use super::exciter::Ground;
use super::incident_field::IncidentPressure;

/// The body under points on this ground.
fn ground_of<'a>(
    ground: Ground,
    body: &'a StruckBody,
    attachments: &'a [Box<dyn Attachment>],
) -> &'a SoundingBody {
    match ground {
        Ground::Body => body.sound(),
        Ground::Attachment(index) => {
            attachments.get(index).and_then(|attachment| attachment.ground()).unwrap_or(body.sound())
        }
    }
}

impl Surface {
    /// Connects the present points whose shape or body has changed, in their order.
    pub(super) fn connect_stale(&mut self) {
        for n in 0..self.contacts.present().len() {
            let i = self.contacts.present()[n];
            if self.contacts.points[i].stale {
                self.connect(i);
            }
        }
    }

    /// Updates the compliances between point `i` and the others.
    pub(super) fn connect(&mut self, i: usize) {
        let Surface { body, contacts, attachments, observers, .. } = self;
        let ground = contacts.points[i].ground;
        let point = &mut contacts.points[i];
        point.stale = false;
        let SoundingBody { modal, receiver } = ground_of(ground, body, attachments);
        modal.connect(&mut point.port);
        point.direct = receiver.direct_at(modal, &point.port);
        contacts.coupling[i] = match ground {
            Ground::Body => body.coupling(&point.port),
            Ground::Attachment(_) => 0.0,
        };
        if ground == Ground::Body {
            observers.complete(i, point.direct[0]);
        }
        if i < STRIKER_PLACES {
            attachments.iter_mut().for_each(|attachment| attachment.connect(i, &point.port, body));
        }
        let SoundingBody { modal, .. } = ground_of(ground, body, attachments);
        for n in 0..contacts.present().len() {
            let j = contacts.present()[n];
            let [one, other] = [&contacts.points[i], &contacts.points[j]];
            let mut mutual = 0.0;
            if other.ground == ground {
                mutual = modal.compliance(&other.port, &one.port);
            }
            if i < STRIKER_PLACES && j < STRIKER_PLACES {
                attachments.iter().for_each(|attachment| mutual += attachment.compliance(i, j));
            }
            if owner(i) == owner(j) {
                mutual += contacts.exciters[owner(i)].compliance(&one.weights, &other.weights);
            }
            contacts.compliance[i][j] = mutual;
            contacts.compliance[j][i] = mutual;
        }
    }

    /// Renders sample `sample` of a run with contacts, under the incident pressure of the run. Returns the pressure, Pa.
    pub(super) fn step(&mut self, sample: usize, incident: Option<IncidentPressure<'_>>) -> Pressure {
        let free = self.body.step(sample, incident);
        self.contacts.stiffen(&self.body, &free);
        for attachment in &mut self.attachments {
            if free.recoupled {
                attachment.couple(&self.body);
            }
            attachment.step(&self.body, &free);
        }
        self.contacts.step();
        self.fly(&free);
        let Surface { body, contacts, attachments, .. } = self;
        if !attachments.iter_mut().any(|attachment| attachment.solve(contacts, &free)) {
            contacts.solve(body.kernels());
        }
        let direct = self.push(sample, free.heard);
        self.finish(&free, direct)
    }

    /// Prepares every contact from the displacements of body and exciters without forces.
    fn fly(&mut self, free: &FreeStep) {
        let Surface { body, contacts, attachments, .. } = self;
        let dt = contacts.dt();
        for n in 0..contacts.present().len() {
            let i = contacts.present()[n];
            let (coupling, compliance) = (contacts.coupling(i), contacts.stiffened(i, i));
            let mut position = contacts.exciter(i).position(&contacts.points[i].weights);
            let point = &mut contacts.points[i];
            let ground = match point.ground {
                Ground::Body => body.modal().displacement_at(&point.port) - coupling * free.mean,
                other => ground_of(other, body, attachments).modal.displacement_at(&point.port),
            };
            if i < STRIKER_PLACES {
                for attachment in attachments.iter() {
                    position += attachment.preload_offset(i, coupling, free) - attachment.displacement(i);
                }
            }
            point.free_flight(position - ground - point.origin, compliance, dt);
        }
    }

    /// Applies the forces that were found. Returns the pressure proportional to them plus `direct`, Pa.
    fn push(&mut self, sample: usize, mut direct: Pressure) -> Pressure {
        let Surface { body, contacts, attachments, observers, .. } = self;
        let mut pressed = 0.0;
        for n in 0..contacts.present().len() {
            let i = contacts.present()[n];
            let point = &contacts.points[i];
            let force = point.pressing();
            if force == 0.0 {
                continue;
            }
            match point.ground {
                Ground::Body => {
                    body.modal_mut().push(&point.port, force as f32);
                    observers.push(i, sample, force as f32);
                }
                Ground::Attachment(index) => {
                    let ground = attachments.get_mut(index).and_then(|attachment| attachment.ground_mut());
                    ground.into_iter().for_each(|ground| ground.modal.push(&point.port, force as f32));
                }
            }
            contacts.exciters[owner(i)].push(&point.weights, force);
            if i < STRIKER_PLACES {
                observers.push_stick(i, sample, force as f32);
                attachments.iter_mut().for_each(|attachment| attachment.push(i, force));
            }
            add(&mut direct, point.direct.map(|direct| force as f32 * direct));
            pressed += force * contacts.coupling(i);
        }
        for attachment in attachments {
            let (more, at_once) = attachment.press(body);
            pressed += more;
            add(&mut direct, at_once);
        }
        add(&mut direct, body.finish(pressed));
        direct
    }

    /// Ends the sample. Returns the pressure at each receiver, Pa.
    fn finish(&mut self, free: &FreeStep, direct: Pressure) -> Pressure {
        let Surface { body, contacts, attachments, .. } = self;
        for n in 0..contacts.present().len() {
            let i = contacts.present()[n];
            let mut others = contacts.moved_by_others(i);
            if i < STRIKER_PLACES {
                for attachment in attachments.iter() {
                    others += attachment.displaced(i, contacts.coupling(i), free);
                }
            }
            contacts.points[i].finish(others);
        }
        let mut after = Pressure::default();
        for attachment in attachments {
            add(&mut after, attachment.finish(contacts, free));
            add(&mut after, attachment.impart(body));
        }
        self.watch_strikers();
        let mut heard = self.body.sound().listen();
        self.attachments.iter().for_each(|attachment| add(&mut heard, attachment.listen()));
        add(&mut heard, direct);
        add(&mut heard, after);
        heard
    }
}
