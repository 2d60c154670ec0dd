//! Which strokes are measured.

use anyhow::Result;
use overhear::building::Pace;
use overhear::kit_document::KitDocument;
use overhear_engine::slot::Slot;

use crate::settings::Setting;

use super::subject::Subject;

/// Request for a measurement.
#[derive(Debug, Clone)]
pub struct Request {
    /// The pieces, as they were recorded.
    pub subjects: Vec<Subject>,
    /// Speeds of the strokes, m/s, ascending.
    pub speeds: Vec<f64>,
    /// The kit, which has pieces of the subjects' names, and its notes.
    pub kit: KitDocument,
    /// Parameters that are not at their default.
    pub settings: Vec<Setting>,
    /// Whether the kit is bounced or played live; this selects the quality of its cymbals.
    pub pace: Pace,
}

/// One stroke of a subject.
#[derive(Debug, Clone, Copy)]
pub struct Job {
    /// The struck subjects.
    pub subject: Subject,
    /// Its slot.
    pub slot: Slot,
    /// Speed, m/s.
    pub speed: f64,
    /// Place, share of the radius.
    pub place: f64,
}

impl Request {
    /// How many strokes it asks for.
    pub fn strokes(&self) -> usize {
        self.subjects.iter().map(|subject| subject.places.len() * self.speeds.len()).sum()
    }

    /// Every stroke: subject by subject, speed by speed, place by place.
    pub(super) fn jobs(&self) -> Result<Vec<Job>> {
        let mut jobs = Vec::new();
        for &subject in &self.subjects {
            let slot = subject.slot(&self.kit)?;
            for &speed in &self.speeds {
                jobs.extend(subject.places.map(|place| Job { subject, slot, speed, place }));
            }
        }
        Ok(jobs)
    }
}
