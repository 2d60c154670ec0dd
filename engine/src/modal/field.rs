//! Fields that act on some modes only, and are moved by them: pressures of shut-in air.

use super::{ModalBody, Pressure, ReceiverWeights};

/// What a pair of fields feels of a mode.
#[derive(Debug, Clone, Copy, PartialEq)]
struct FieldMode {
    mode: usize,
    /// By how much the displacements along the fields grow with the mode's; 0 for a silent mode.
    moments: [f64; 2],
    /// Of the real and the imaginary part of the state, for the speed, 1/s.
    speed: [f64; 2],
    /// What an impulse over the moment adds to the real part, s/kg.
    gain: f64,
}

/// A pair of fields, cosine and sine, and the modes that they act on. No mode is moved along both, summed over the modes: pairs of equal shape and turned axes
/// are complete.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ModalField {
    modes: Vec<FieldMode>,
    /// Moments as given, `[mode]`.
    given: Vec<[f64; 2]>,
    mobility: [f64; 2],
}

impl ModalField {
    /// Of modes and their moments: in m2 if displacements along the fields are volumes. Allocates.
    pub fn new(moments: impl Iterator<Item = (usize, [f64; 2])>) -> ModalField {
        let (modes, given) = moments
            .map(|(mode, moments)| (FieldMode { mode, moments, speed: [0.0; 2], gain: 0.0 }, moments))
            .unzip();
        ModalField { modes, given, mobility: [0.0; 2] }
    }

    /// Sums of the squares of the moments over the masses, in the square of the moments' unit over kg.
    pub fn mobility(&self) -> [f64; 2] {
        self.mobility
    }
}

impl ModalBody {
    /// Updates a field after a change of the modes.
    ///
    /// # Real-time
    /// Linear in the number of modes of the field.
    pub fn connect_field(&self, field: &mut ModalField) {
        field.mobility = [0.0; 2];
        for (row, given) in field.modes.iter_mut().zip(&field.given) {
            let mode = &self.modes[row.mode];
            let moves = self.coefs.hold_im[row.mode] != 0.0;
            row.moments = if moves { *given } else { [0.0; 2] };
            let omega = mode.omega_d();
            row.speed = [omega, -mode.sigma];
            row.gain = (mode.mass * omega).recip();
            for (mobility, moment) in field.mobility.iter_mut().zip(&row.moments) {
                *mobility += moment * moment / mode.mass;
            }
        }
    }

    /// Speeds along a field, in the unit of its moments times m/s.
    pub fn speeds_along(&self, field: &ModalField) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for row in &field.modes {
            let (re, im) = (f64::from(self.state.re[row.mode]), f64::from(self.state.im[row.mode]));
            let speed = row.speed[0] * re + row.speed[1] * im;
            sums = [sums[0] + row.moments[0] * speed, sums[1] + row.moments[1] * speed];
        }
        sums
    }

    /// Changes the speeds at once by impulses along a field, N s over the unit of its moments.
    pub fn impart(&mut self, field: &ModalField, impulses: [f64; 2]) {
        for row in &field.modes {
            let along = row.moments[0] * impulses[0] + row.moments[1] * impulses[1];
            self.state.re[row.mode] += (row.gain * along) as f32;
        }
    }
}

impl ReceiverWeights {
    /// Pressures proportional to forces along a field, Pa per N and unit of its moments.
    ///
    /// # Real-time
    /// Linear in the number of modes of the field.
    pub fn direct_along(&self, field: &ModalField) -> [Pressure; 2] {
        [0, 1].map(|part: usize| {
            self.receivers.each_ref().map(|receiver| {
                let direct = |row: &FieldMode| receiver.direct.get(row.mode).copied().unwrap_or(0.0);
                field.modes.iter().map(|row| row.moments[part] as f32 * direct(row)).sum()
            })
        })
    }
}
