//! Points around the rims that may touch in a sample, and the compliances between them.

use crate::contact::solver::Compliances;

use super::rim_points::POINTS;

/// Points of the rims to be solved for.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Near {
    all: [usize; POINTS],
    /// How many there are.
    pub(super) count: usize,
}

impl Near {
    /// Adds a point.
    pub(super) fn add(&mut self, point: usize) {
        self.all[self.count] = point;
        self.count += 1;
    }

    /// The points.
    pub(super) fn listed(&self) -> &[usize] {
        &self.all[..self.count]
    }
}

/// Compliances between the points solved for last, which are the same for dozens of samples: collecting them takes as long as a third of
/// a solution.
pub(super) struct NearCompliances {
    near: Near,
    /// `[lane][lane]`, m/N.
    rows: Compliances<POINTS>,
}

impl Default for NearCompliances {
    /// Of no points.
    fn default() -> NearCompliances {
        NearCompliances { near: Near::default(), rows: [[0.0; POINTS]; POINTS] }
    }
}

impl NearCompliances {
    /// Forgets them, after a change of the compliances.
    pub(super) fn forget(&mut self) {
        self.near.count = 0;
    }

    /// Collects those between these points out of those between all, unless they are the same points as last.
    pub(super) fn collect(&mut self, near: &Near, whole: &Compliances<POINTS>) {
        if self.near == *near {
            return;
        }
        self.near = *near;
        for (row, &i) in self.rows.iter_mut().zip(near.listed()) {
            row.iter_mut().zip(near.listed()).for_each(|(out, &j)| *out = whole[i][j]);
        }
    }

    /// Takes away what the nonlinear force takes: `coupling` and `divisor` as [`FreeStep`](crate::surface::body::FreeStep) has them.
    #[inline(always)]
    pub(super) fn less<const N: usize>(&self, coupling: &[f64; POINTS], divisor: f64) -> Compliances<N> {
        let mut coupled = [0.0; N];
        for (coupled, &i) in coupled.iter_mut().zip(self.near.listed()) {
            *coupled = coupling[i];
        }
        let mut out = [[0.0; N]; N];
        for lane in 0..self.near.count.min(N) {
            let (row, taken) = (&self.rows[lane], coupled[lane] / divisor);
            for i in 0..N.min(POINTS) {
                out[lane][i] = row[i] - taken * coupled[i];
            }
            // Lanes beyond are strikers' or none's.
            for out in &mut out[lane][self.near.count.min(N)..] {
                *out = 0.0;
            }
        }
        out
    }
}
