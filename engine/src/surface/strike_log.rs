//! Record of strokes: energies of arriving and leaving strikers, and measurements of the latest stroke's contacts.

use crate::snapshot::StrikeSnapshot;

use super::exciter::{ContactPoint, Exciter};

/// Record of strokes.
#[derive(Default)]
pub(super) struct StrikeLog {
    /// Energy of arriving and of leaving strikers, J.
    pub(super) brought: f64,
    pub(super) departed: f64,
    pub(super) last: StrikeSnapshot,
    /// Strikers that were removed before they had left.
    pub(super) hurried: u32,
}

impl StrikeLog {
    /// Adds this sample to the measurements of the latest stroke's contacts.
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
