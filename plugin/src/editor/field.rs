//! A piece's displacement field, refined for the eye.
//!
//! The 145 points that the lowest modes give are joined by cubic interpolation, along spokes and around rings;
//! refined points fall on the field's own every [`FINER`] steps. A field stays within what is drawn however
//! much it moves: its height follows the logarithm of the largest displacement of late.

use overhear_engine::snapshot::FieldShapes;

/// Rings and spokes of the field.
const RINGS: usize = 6;
const SPOKES: usize = 24;

/// Points drawn for each of the field's, along a radius and around.
pub const FINER: usize = 2;
/// Rings drawn, beside the centre.
pub const RADII: usize = RINGS * FINER;
/// Spokes drawn.
pub const ANGLES: usize = SPOKES * FINER;

/// Heights, m, by ring, the centre first, and spoke. Spoke 0 is to the right, the next ones away from the player.
pub type Refined = [[f32; ANGLES]; RADII + 1];

/// Displacement at every point of the field, m, along the normal of the struck side; zero where it is not a number.
pub fn displacement(shapes: &FieldShapes, modes: &[f32]) -> Vec<f32> {
    // Modes move along the stroke, into the surface.
    let at = |shape: &[f32]| -shape.iter().zip(modes).map(|(shape, q)| shape * q).sum::<f32>();
    let finite = |z: f32| if z.is_finite() { z } else { 0.0 };
    shapes.shapes.iter().map(|shape| finite(at(shape))).collect()
}

/// Joins the field's points.
pub fn refined(field: &[f32]) -> Refined {
    let around: [[f32; ANGLES]; RINGS] = std::array::from_fn(|ring| refined_ring(field, ring));
    let centre = field.first().copied().unwrap_or(0.0);
    // Beyond the centre a radius goes on along the opposite one, beyond the edge straight.
    let at = |ring: isize, angle: usize| match ring {
        0 => centre,
        1.. => {
            let inside = |ring: usize| around[ring - 1][angle];
            let ring = ring as usize;
            if ring <= RINGS { inside(ring) } else { 2.0 * inside(RINGS) - inside(RINGS - 1) }
        }
        _ => around[(-ring) as usize - 1][(angle + ANGLES / 2) % ANGLES],
    };
    std::array::from_fn(|radius| {
        let (ring, part) = ((radius / FINER) as isize, (radius % FINER) as f32 / FINER as f32);
        std::array::from_fn(|angle| {
            cubic([ring - 1, ring, ring + 1, ring + 2].map(|ring| at(ring, angle)), part)
        })
    })
}

/// One ring of the field with points added between the spokes.
fn refined_ring(field: &[f32], ring: usize) -> [f32; ANGLES] {
    let at = |spoke: usize| field.get(1 + ring * SPOKES + spoke % SPOKES).copied().unwrap_or(0.0);
    std::array::from_fn(|angle| {
        let (spoke, part) = (angle / FINER, (angle % FINER) as f32 / FINER as f32);
        cubic([SPOKES - 1, 0, 1, 2].map(|offset| at(spoke + offset)), part)
    })
}

/// Catmull-Rom interpolation between the middle two of four equidistant values.
fn cubic([a, b, c, d]: [f32; 4], part: f32) -> f32 {
    let linear = 0.5 * (c - a);
    let square = a - 2.5 * b + 2.0 * c - 0.5 * d;
    let cube = 0.5 * (d - a) + 1.5 * (b - c);
    b + part * (linear + part * (square + part * cube))
}

/// Height at a place on the unit disc, x to the right and y away from the player, of the nearest point.
pub fn height_at(field: &Refined, x: f32, y: f32) -> f32 {
    let radius = ((x.hypot(y) * RADII as f32).round() as usize).min(RADII);
    let turn = y.atan2(x).rem_euclid(std::f32::consts::TAU) / std::f32::consts::TAU;
    field[radius][(turn * ANGLES as f32).round() as usize % ANGLES]
}

/// Follows how much a piece moves, and says how much larger it is drawn.
#[derive(Debug, Clone, Copy, Default)]
pub struct Magnifier {
    /// Largest displacement of late, m.
    tallest: f32,
}

impl Magnifier {
    /// Time in which what was tallest is half forgotten, s: a few periods of the lowest drum.
    const HALF_LIFE: f32 = 0.12;

    /// Displacements from which on motion is drawn, and at which it fills the height there is, m. *By ear*, so to
    /// say: a head answers sound with micrometres and a stroke with millimetres.
    const RANGE: (f32, f32) = (1e-6, 1.5e-3);

    /// Takes in what is seen `elapsed` seconds after the last.
    pub fn follow(&mut self, field: &[f32], elapsed: f32) {
        let faded = self.tallest * (-elapsed.clamp(0.0, 1.0) / Magnifier::HALF_LIFE).exp2();
        self.tallest = field.iter().fold(faded, |tallest, z| tallest.max(z.abs()));
        // What is left of a decay is not worth a number.
        if self.tallest < 1e-12 {
            self.tallest = 0.0;
        }
    }

    /// Largest displacement of late, m.
    pub fn tallest(&self) -> f32 {
        self.tallest
    }

    /// Height of the largest displacement on the screen, 0 to 1 of what there is.
    pub fn level(&self) -> f32 {
        let (least, most) = Magnifier::RANGE;
        ((self.tallest / least).max(1.0).ln() / (most / least).ln()).clamp(0.0, 1.0).powf(1.7)
    }

    /// What displacements (m) are multiplied by so that the largest is drawn `height` (m) tall at most.
    pub fn factor(&self, height: f32) -> f32 {
        if self.tallest > 0.0 { self.level() * height / self.tallest } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn displacement_is_the_sum_of_modes_against_the_stroke_and_always_a_number() {
        let mut shapes =
            FieldShapes { points: vec![[0.0; 2]; 2], shapes: vec![[0.0; 32]; 2], ..FieldShapes::default() };
        shapes.shapes[0][3] = 2.0;
        let mut modes = [0.0; 32];
        modes[3] = 0.5;
        assert_eq!(displacement(&shapes, &modes), [-1.0, 0.0]);
        modes[3] = f32::NAN;
        assert_eq!(displacement(&shapes, &modes), [0.0, 0.0]);
    }

    #[test]
    fn refined_points_pass_through_the_field() {
        let field: Vec<f32> =
            FieldShapes::grid().iter().map(|[x, y]| 0.1 * x - 0.05 * y + 0.02 * x * y).collect();
        let fine = refined(&field);
        assert!((fine[0][0] - field[0]).abs() < 1e-6);
        for ring in 1..=RINGS {
            for spoke in 0..SPOKES {
                let own = field[1 + (ring - 1) * SPOKES + spoke];
                assert!((fine[ring * FINER][spoke * FINER] - own).abs() < 1e-6);
            }
        }
        let (x, y) = (0.5 * 0.5_f32.sqrt(), 0.5 * 0.5_f32.sqrt());
        assert!((height_at(&fine, x, y) - (0.1 * x - 0.05 * y + 0.02 * x * y)).abs() < 1e-3);
    }

    #[test]
    fn more_motion_is_drawn_taller_and_never_too_tall() {
        let mut former = 0.0;
        for tallest in [1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-1] {
            let mut magnifier = Magnifier::default();
            magnifier.follow(&[tallest, -0.5 * tallest], 0.01);
            let height = tallest * magnifier.factor(0.04);
            assert!(height >= former && height <= 0.04 + 1e-6, "{tallest}: {height}");
            former = height;
        }
        assert!(former > 0.039);
    }
}
