//! Snapshots: plain data of fixed size about the engine, for the editor.

use crate::slot::SLOTS;

/// Lowest modes of a piece whose displacement is published.
pub const FIELD_MODES: usize = 32;

/// Points of the displacement field: the centre and 6 rings of 24 spokes.
pub const FIELD_POINTS: usize = 1 + 6 * 24;

/// Octaves by which the energy of a piece is told.
pub const OCTAVES: usize = 10;

/// Where the first octave begins, Hz. What is below counts in it, what is beyond the last in that.
pub const FIRST_OCTAVE: f64 = 32.0;

/// The octave that a frequency (Hz) is in.
///
/// # Real-time
/// The exponent of a number: no logarithm.
pub fn octave_of(hertz: f64) -> usize {
    const BIAS: usize = 1_023;
    let exponent = ((hertz / FIRST_OCTAVE).max(1.0).to_bits() >> 52) as usize;
    exponent.saturating_sub(BIAS).min(OCTAVES - 1)
}

/// Steps of a stroke's force over time.
pub const FORCE_STEPS: usize = 96;

/// Force of a stroke over time from its first touch on, as the largest of each step; the steps grow with the stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceTrace {
    /// Largest force of each step, N; zero beyond the present.
    pub steps: [f32; FORCE_STEPS],
    /// Samples in a step: a power of two.
    pub samples: u32,
    /// Length of a sample, s.
    pub dt: f32,
}

impl Default for ForceTrace {
    fn default() -> Self {
        ForceTrace { steps: [0.0; FORCE_STEPS], samples: 1, dt: 0.0 }
    }
}

impl ForceTrace {
    /// Adds the force (N) `age` samples after the first touch. When there is no step left, pairs of steps become one.
    ///
    /// # Real-time
    /// No allocation; a step is written, rarely all.
    pub fn add(&mut self, age: u64, force: f32) {
        while age / u64::from(self.samples) >= FORCE_STEPS as u64 {
            // Of a stroke that lasts longer than anything does, the rest is left out.
            if self.samples > 1 << 16 {
                return;
            }
            for step in 0..FORCE_STEPS {
                let pair = self.steps.get(2 * step..2 * step + 2).unwrap_or_default();
                self.steps[step] = pair.iter().fold(0.0, |most, &force| f32::max(most, force));
            }
            self.samples *= 2;
        }
        let step = &mut self.steps[(age / u64::from(self.samples)) as usize];
        *step = step.max(force);
    }

    /// Length of a step, s.
    pub fn step(&self) -> f32 {
        self.samples as f32 * self.dt
    }
}

/// What a stroke's contact measured.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StrikeSnapshot {
    /// Strokes on this piece so far; a change means that the rest is about a new one.
    pub count: u32,
    /// Speed asked for, m/s.
    pub speed: f32,
    /// Place, share of the radius.
    pub radius: f32,
    /// Direction, rad.
    pub angle: f32,
    /// Time from the first touch to the last, s; grows while the tip still touches.
    pub contact_time: f32,
    /// Largest force so far, N.
    pub peak_force: f32,
    /// Force integrated over time, N s.
    pub impulse: f32,
    /// Speed away from the surface after the last touch, m/s.
    pub leaving_speed: f32,
    /// Separate touches.
    pub touches: u32,
    /// Force over time.
    pub force: ForceTrace,
}

/// What snare wires have done since the latest stroke.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WireSnapshot {
    /// Landings of all sections.
    pub landings: u32,
    /// Sections off the head now, a bit each in the order of [`PLACES`](crate::surface::wires::PLACES).
    pub aloft: u32,
    /// When a section last lifted off, s after the stroke; 0 if none has.
    pub last_lift: f32,
}

/// What a hi-hat's rims have done since the latest stroke.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RimSnapshot {
    /// Landings of all places on each other.
    pub landings: u32,
    /// Places apart now.
    pub apart: u32,
    /// When a place last lifted off, s after the stroke; 0 if none has.
    pub last_lift: f32,
    /// Force that clamps them together at rest, N.
    pub clamped: f32,
    /// How far the pedal's rod is down, m.
    pub pedal: f32,
}

/// The present frequency and loss of a mode.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ModeSnapshot {
    /// Undamped angular frequency, rad/s.
    pub omega: f32,
    /// Decay rate of the amplitude, 1/s.
    pub sigma: f32,
}

/// One piece, seen from outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PieceSnapshot {
    /// Whether the piece has been built and plays.
    pub ready: bool,
    /// Peak of the piece's share of the mix since the last snapshot, full scale 1.
    pub peak: f32,
    /// Vibration energy, J.
    pub energy: f32,
    /// What of it is in the modes of each octave, J.
    pub octaves: [f32; OCTAVES],
    /// What of it is held beyond the modes: by the stretch of a head or a plate, J.
    pub stretch: f32,
    /// Displacement of the lowest modes, m; see [`FieldShapes`] for their shapes.
    pub displacement: [f32; FIELD_MODES],
    /// The same modes as they are tuned and muffled; zero where there is none.
    pub modes: [ModeSnapshot; FIELD_MODES],
    /// The latest stroke.
    pub strike: StrikeSnapshot,
    /// Its snare wires.
    pub wires: WireSnapshot,
    /// Its rims, of a hi-hat.
    pub rims: RimSnapshot,
    /// Times the piece was put back to rest because a value was not finite.
    pub quarantines: u32,
    /// Strikers taken away early, to make room for others: in rolls denser than four at a time.
    pub hurried_strikers: u32,
}

impl Default for PieceSnapshot {
    fn default() -> Self {
        PieceSnapshot {
            ready: false,
            peak: 0.0,
            energy: 0.0,
            octaves: [0.0; OCTAVES],
            stretch: 0.0,
            displacement: [0.0; FIELD_MODES],
            modes: [ModeSnapshot::default(); FIELD_MODES],
            strike: StrikeSnapshot::default(),
            wires: WireSnapshot::default(),
            rims: RimSnapshot::default(),
            quarantines: 0,
            hurried_strikers: 0,
        }
    }
}

/// The kit, seen from outside.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct KitSnapshot {
    /// Samples rendered since construction or reset.
    pub clock: u64,
    /// `[slot]`.
    pub pieces: [PieceSnapshot; SLOTS],
    /// Peak of the two outputs since the last snapshot, full scale 1.
    pub peak: [f32; 2],
    /// Strokes that came before their piece was built.
    pub dropped_strikes: u32,
    /// Runs in which a piece was silent because a worker still had it.
    pub missed_runs: u32,
    /// Samples that the safety clip has bent.
    pub clipped_samples: u64,
    /// Samples that the ceiling has bent since the start.
    pub limited_samples: u64,
    /// Buffers that were ready too late. Filled in by the caller, as the engine has no clock.
    pub late_buffers: u64,
}

/// Shapes of a piece's lowest modes at the points of its displacement field.
///
/// Computed where the piece is built and passed to the editor: the displacement at point `i`
/// is the dot product of `shapes[i]` and [`PieceSnapshot::displacement`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FieldShapes {
    /// `[point]`: place on the unit disc, x to the right and y away from the player.
    pub points: Vec<[f32; 2]>,
    /// `[point][mode]`: mode shape, of unit mean square over the surface.
    pub shapes: Vec<[f32; FIELD_MODES]>,
    /// `[mode]`: nodal diameters and circles; a piece may have fewer modes.
    pub orders: Vec<[u32; 2]>,
    /// Tension of the struck head as it was built, N/m; zero for a plate.
    pub tension: f32,
}

impl FieldShapes {
    /// The points: centre first, then ring by ring from the inside, spoke by spoke.
    pub fn grid() -> Vec<[f32; 2]> {
        let mut points = vec![[0.0, 0.0]];
        for ring in 1..=6 {
            for spoke in 0..24 {
                let (sin, cos) = (spoke as f32 * std::f32::consts::TAU / 24.0).sin_cos();
                let radius = ring as f32 / 6.0;
                points.push([radius * cos, radius * sin]);
            }
        }
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn octaves_double_from_their_first_and_end_at_their_last() {
        for octave in 0..OCTAVES {
            let low = FIRST_OCTAVE * f64::from(1 << octave);
            assert_eq!([octave_of(low), octave_of(1.5 * low), octave_of(1.999 * low)], [octave; 3]);
        }
        assert_eq!(
            [0.0, 1.0, f64::NAN, 1e9, f64::INFINITY].map(octave_of),
            [0, 0, 0, OCTAVES - 1, OCTAVES - 1]
        );
    }

    #[test]
    fn a_trace_keeps_its_peak_and_its_length_however_long_it_grows() {
        let mut trace = ForceTrace { dt: 1e-4, ..ForceTrace::default() };
        let force = |age: u64| 100.0 * (-(age as f32 - 40.0).powi(2) / 200.0).exp();
        for age in 0..5_000 {
            trace.add(age, force(age));
        }
        let peak = trace.steps.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
        assert_eq!(*peak.1, 100.0);
        assert!((peak.0 as f32 * trace.step() - 40e-4).abs() <= trace.step());
        assert!(FORCE_STEPS as f32 * trace.step() >= 0.5);
        trace.add(u64::MAX, 1e9);
        assert_eq!(trace.steps.iter().fold(0.0, |most, &force| f32::max(most, force)), 100.0);
    }
}
