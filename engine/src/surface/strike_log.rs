//! What strikers have done to a body: energies brought and taken away, and what the latest stroke's contacts measured.

use crate::snapshot::StrikeSnapshot;

use super::exciter::{ContactPoint, Exciter};

/// What strikers have done.
#[derive(Default)]
pub(super) struct StrikeLog {
    /// Energy that strikers have come with, and taken with them, J.
    pub(super) brought: f64,
    pub(super) departed: f64,
    pub(super) last: StrikeSnapshot,
    /// Strikers that had to make room for others before they had left.
    pub(super) hurried: u32,
}

impl StrikeLog {
    /// Adds this sample to what the latest stroke's contacts have measured.
    pub(super) fn report(&mut self, striker: &Exciter, points: &[ContactPoint], dt: f64) {
        let last = &mut self.last;
        let mut force = 0.0;
        for point in points.iter().filter(|point| point.present && point.force > 0.0) {
            force += point.force;
            if point.step.before <= 0.0 {
                last.touches += 1;
            }
            last.contact_time = (striker.age as f64 * dt) as f32;
            last.peak_force = last.peak_force.max(point.force as f32);
            last.impulse += (point.force * dt) as f32;
        }
        if force > 0.0 {
            // The first sample of a touch is the first of its age.
            last.force.add(striker.age.saturating_sub(1), force as f32);
        }
        last.leaving_speed = striker.leaving_speed() as f32;
    }
}
