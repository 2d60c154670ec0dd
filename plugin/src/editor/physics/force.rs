//! The contact force of a stroke over time.

use egui::{Color32, Rect, Ui};
use overhear_engine::snapshot::{FORCE_STEPS, StrikeSnapshot};

use crate::editor::plot::{Plot, time_text};

/// Draws the force on the piece of a title, with contact time, peak, impulse and rebound.
pub fn show(ui: &Ui, rect: Rect, title: &str, strike: &StrikeSnapshot, accent: Color32) {
    let heading = format!("{title}: contact force");
    if strike.count == 0 {
        Plot::new(ui, rect, &heading, "").nothing("Strike the piece to see the force of its latest stroke");
        return;
    }
    let plot = Plot::new(ui, rect, &heading, &remark(strike));
    let trace = &strike.force;
    let long = FORCE_STEPS as f32 * trace.step();
    // What is over is not drawn: a little more than the contact.
    let shown = (1.15 * strike.contact_time).clamp(8.0 * trace.step(), long).max(f32::MIN_POSITIVE);
    let most = strike.peak_force.max(1e-3);
    let point =
        |step: usize, force: f32| plot.at((step as f32 + 0.5) * trace.step() / shown, force / (1.08 * most));
    let steps = ((shown / trace.step()).ceil() as usize).clamp(1, FORCE_STEPS);
    let mut points = vec![plot.at(0.0, 0.0)];
    points.extend(trace.steps.iter().enumerate().take(steps).map(|(step, &force)| point(step, force)));
    plot.curve(&points, accent);
    plot.ends("0", &time_text(shown));
}

/// What the contact measured, in a line.
fn remark(strike: &StrikeSnapshot) -> String {
    let touches = if strike.touches > 1 { format!(" in {} touches", strike.touches) } else { String::new() };
    format!(
        "{}{touches}, peak {:.0} N, {:.0} mN s, rebound {:.1} m/s",
        time_text(strike.contact_time),
        strike.peak_force,
        1e3 * strike.impulse,
        strike.leaving_speed
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stroke_is_summed_up_with_its_units() {
        let strike = StrikeSnapshot {
            contact_time: 5.84e-3,
            peak_force: 31.2,
            impulse: 0.091,
            leaving_speed: 2.04,
            touches: 2,
            ..StrikeSnapshot::default()
        };
        assert_eq!(remark(&strike), "5.8 ms in 2 touches, peak 31 N, 91 mN s, rebound 2.0 m/s");
    }
}
