//! How far a stretched head's pitch is above its own.
//!
//! The engine tells the energy `E` that the stretch holds. From its model (see
//! [`stretch`](overhear_engine::drum::stretch)) with `C = A E_film h / (16 (1 - nu))`, `E = C S^2` and the added tension is
//! `dT = 4 C S / A`, so `dT = 4 sqrt(C E) / A`. Pitch goes as the root of the tension: `600 log2(1 + dT / T)` cents. A
//! drum's air and other head hold some of its pitch, so that it glides by less: this is the head's own glide.

use std::collections::VecDeque;

use egui::{Color32, Rect, Ui};
use overhear_engine::kit_spec::PieceSpec;

use super::past::{Moment, over_time};
use crate::editor::plot::Plot;

/// Glide of a head whose stretch holds an energy (J) at a tension at rest (N/m), cents; nothing of what is no drum.
pub fn cents(piece: &PieceSpec, stretch: f32, tension: f32) -> f32 {
    let Some(drum) = piece.drum() else { return 0.0 };
    if !(stretch > 0.0 && tension > 0.0) {
        return 0.0;
    }
    let head = drum.membrane(&drum.batter);
    let area = head.area();
    let film = &head.material;
    let stiffness = area * film.youngs_modulus * head.thickness / (16.0 * (1.0 - film.poisson_ratio));
    let added = 4.0 * (stiffness * f64::from(stretch)).sqrt() / area;
    (600.0 * (1.0 + added / f64::from(tension)).log2()) as f32
}

/// Draws the glide of a drum over time.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    moments: &VecDeque<Moment>,
    (slot, now): (usize, f64),
    accent: Color32,
) {
    let cents = settled(&moments.iter().map(|moment| moment.cents[slot]).collect::<Vec<_>>());
    let most = cents.iter().copied().fold(0.0, f32::max);
    let plot = Plot::new(ui, rect, "Pitch glide", &format!("up to +{most:.0} cents"));
    let top = 1.1 * most.max(20.0);
    over_time(&plot, moments, now, cents.iter().map(|cents| cents / top), accent);
}

/// The glide that is heard: the mean over snapshots next to each other. One catches the stretch somewhere in its swing,
/// which goes twice as fast as the head; pitch follows what it is on the whole.
fn settled(cents: &[f32]) -> Vec<f32> {
    /// Snapshots to either side: with them 60 ms, some swings of the lowest head.
    const AROUND: usize = 2;
    let mean = |i: usize| {
        let near = &cents[i.saturating_sub(AROUND)..(i + AROUND + 1).min(cents.len())];
        near.iter().sum::<f32>() / near.len() as f32
    };
    (0..cents.len()).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use overhear_engine::kit_spec::KitSpec;

    #[test]
    fn what_swings_settles_at_its_mean_and_a_steady_glide_stays() {
        let swinging: Vec<f32> = (0..100).map(|i| 10.0 + 10.0 * (i as f32 * 2.1).sin()).collect();
        let settled = super::settled(&swinging);
        assert!(settled[5..95].iter().all(|cents| (cents - 10.0).abs() < 4.0), "{settled:?}");
        assert_eq!(super::settled(&[7.0; 9]), [7.0; 9]);
        assert!(super::settled(&[]).is_empty());
    }

    #[test]
    fn a_head_at_rest_is_at_its_pitch_and_a_stretched_one_above() {
        let kit = KitSpec::standard();
        let [(_, tom), (_, crash)] = ["rack-tom", "crash"].map(|name| kit.find(name).unwrap());
        assert_eq!(cents(tom, 0.0, 2_000.0), 0.0);
        assert_eq!(cents(crash, 1.0, 2_000.0), 0.0);
        assert_eq!(cents(tom, f32::NAN, 2_000.0), 0.0);
        let [weak, hard] = [1e-4, 1e-2].map(|stretch| cents(tom, stretch, 2_000.0));
        assert!(weak > 0.0 && hard > 5.0 * weak && hard < 1_200.0, "{weak} {hard}");
    }
}
