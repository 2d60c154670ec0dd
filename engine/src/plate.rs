//! Cymbals' plates: geometry and metal turned into modes.
//!
//! Model: a thin circular plate (Kirchhoff), free at its rim, domed to a shallow shell (Marguerre).
//! [`spec`] describes the plate, [`edges`] finds the flat plate's modes, [`dome`] turns those of each order into shell
//! modes of a cap as thick everywhere, [`thickness_taper`] into those of a plate with a bell or a taper; [`radial`] and [`bent`] know
//! their shapes, [`free_disc`] what they do to the air. Nothing is said here of losses in the metal, of a hole or a stand.
//!
//! Coordinates: `r` is a share of the radius; shapes are `R(r) cos(m theta)` and
//! `R(r) sin(m theta)`, of unit mean square over the metal, so each mode's mass is the plate's.
//!
//! Limits: complete up to the frequency asked for; rigid motions of the plate on its stand are not
//! among the modes.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::air_load;
use crate::error::SpecError;
use crate::math::bessel::{ITable, JTable};

pub mod bent;
pub mod dome;
pub mod edges;
pub mod free_disc;
pub mod radial;
pub mod spec;
pub mod thickness_taper;

use bent::Bent;
use dome::Shell;
use radial::RadialMode;
use thickness_taper::Section;

pub use spec::{Bell, Flange, PlateSpec};

/// Wave numbers by which the flat modes of an eigenproblem reach past the frequency asked for: four
/// more modes an order. *Converged*: any more move no frequency by 0.01 %.
const FLAT_MARGIN: f64 = 2.0 * TAU;

/// A mode of the domed plate; for `m > 0` it has two members, cosine and sine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShellMode {
    /// Nodal diameters.
    pub m: u32,
    /// Nodal circles of the flat mode it grows out of.
    pub n: u32,
    /// Undamped angular frequency, rad/s.
    pub omega: f64,
    /// Share of each flat mode of its order, as in [`PlateModes::flat`].
    pub expansion: Vec<f64>,
    /// Share of the rigid motion `r^m` that keeps the plate in balance; none of an even plate or from order 2 on.
    pub rigid: f64,
}

impl ShellMode {
    /// The rigid part of the radial shape at the share `r` of the radius.
    fn rigid_shape(&self, r: f64) -> f64 {
        if self.rigid == 0.0 { 0.0 } else { self.rigid * r.powi(self.m as i32) }
    }
}

/// Every mode of a plate up to a frequency.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct PlateModes {
    /// What it was built from.
    pub spec: PlateSpec,
    /// Flat modes, `[order][circle]`, reaching past the limit; what shell modes are expanded in.
    pub flat: Vec<Vec<RadialMode>>,
    /// Shell modes, one per pair of members, by ascending frequency.
    pub shells: Vec<ShellMode>,
}

/// Tables of the cylinder functions that plates' shapes and radiation are read from.
///
/// One set, made for the plate with the largest [`PlateModes::table_extent`], serves a whole kit.
#[derive(Debug, Clone)]
pub struct PlateTables {
    /// `J_m`, `[order]`.
    pub j: Vec<JTable>,
    /// `e^-x I_m`, `[order]`.
    pub i: Vec<ITable>,
}

impl PlateTables {
    /// Tables of every order to `max_order` and dimensionless arguments to `x_max`.
    pub fn new(max_order: u32, x_max: f64) -> PlateTables {
        PlateTables { j: JTable::orders(max_order, x_max), i: ITable::orders(max_order, x_max) }
    }

    /// Both of one order.
    ///
    /// # Panics
    /// If they do not reach it.
    pub fn order(&self, m: u32) -> (&JTable, &ITable) {
        (&self.j[m as usize], &self.i[m as usize])
    }
}

impl PlateModes {
    /// Finds every mode up to `limit_hz` (100 to 48000 Hz).
    ///
    /// # Errors
    /// [`SpecError`] if the plate or the limit is out of range.
    pub fn new(spec: &PlateSpec, limit_hz: f64) -> Result<PlateModes, SpecError> {
        spec.check()?;
        SpecError::check("highest mode (Hz)", limit_hz, 100.0, 48_000.0)?;
        let limit = TAU * limit_hz;
        let reach = (limit / spec.flat_omega()).sqrt() * shortening(spec) + FLAT_MARGIN;
        // Every order from 2 on begins with a higher wave number than the one before.
        let flat: Vec<Vec<RadialMode>> = (0..)
            .map(|m| edges::free_modes(m, spec.poisson_ratio, reach))
            .take_while(|modes| !modes.is_empty())
            .collect();
        let mut shells: Vec<ShellMode> = if spec.is_even() {
            flat.iter().flat_map(|modes| named(modes, dome::shells(spec, modes))).collect()
        } else {
            let tables = PlateTables::new(flat.len() as u32, reach);
            let section = Section::new(spec, reach);
            let solve =
                |m, modes: &[RadialMode]| thickness_taper::shells(spec, &section, modes, tables.order(m));
            (0..).zip(&flat).flat_map(|(m, modes)| named(modes, solve(m, modes))).collect()
        };
        shells.retain(|shell| shell.omega <= limit);
        shells.sort_by(|a, b| a.omega.total_cmp(&b.omega));
        Ok(PlateModes { spec: *spec, flat, shells })
    }

    /// Flat modes that `shell` is expanded in.
    pub fn flat_of(&self, shell: &ShellMode) -> &[RadialMode] {
        &self.flat[shell.m as usize]
    }

    /// Wave number of a shell mode's finest ripples times the radius, dimensionless.
    pub fn wave_number(&self, shell: &ShellMode) -> f64 {
        let flat = self.flat_of(shell).iter().find(|flat| flat.n == shell.n);
        flat.map_or(0.0, |flat| flat.root) * shortening(&self.spec)
    }

    /// Radial shape of a shell mode, of unit mean square, at the share `r` of the radius, to rounding.
    pub fn radial_shape(&self, shell: &ShellMode, r: f64) -> f64 {
        let terms = self.flat_of(shell).iter().zip(&shell.expansion);
        terms.map(|(flat, share)| share * flat.value(r)).sum::<f64>() + shell.rigid_shape(r)
    }

    /// A shell mode bent, at `radii` (shares of the radius), all above 0.
    ///
    /// # Panics
    /// If the tables do not reach the order.
    pub fn bent(&self, tables: &PlateTables, shell: &ShellMode, radii: &[f64]) -> Bent {
        let mut sum = Bent::zero(radii.len());
        for (flat, &share) in self.flat_of(shell).iter().zip(&shell.expansion) {
            sum.add(share, &Bent::of(flat, tables.order(shell.m), radii));
        }
        // The rigid part bends nothing.
        sum.value.iter_mut().zip(radii).for_each(|(value, &r)| *value += shell.rigid_shape(r));
        sum
    }

    /// Highest order and largest (dimensionless) argument the tables must reach for this plate's modes, at
    /// frequencies up to `limit_hz`, Hz.
    pub fn table_extent(&self, limit_hz: f64) -> (u32, f64) {
        let root = self.flat.iter().flatten().map(|flat| flat.root).fold(0.0, f64::max);
        let trace = TAU * limit_hz * self.spec.radius() / air_load::SPEED_OF_SOUND;
        (self.flat.len().saturating_sub(1) as u32, root.max(trace))
    }

    /// Radial shapes of all flat modes, of unit mean square, at `radii` (shares of the radius),
    /// `[order][circle * radii.len() + radius]`, within about 1e-7.
    ///
    /// # Panics
    /// If the tables do not reach the plate's highest order.
    pub fn flat_shapes(&self, tables: &PlateTables, radii: &[f64]) -> Vec<Vec<f64>> {
        let sample_order = |(m, modes): (usize, &Vec<RadialMode>)| {
            let mut rows = vec![0.0; modes.len() * radii.len()];
            for (mode, row) in modes.iter().zip(rows.chunks_exact_mut(radii.len().max(1))) {
                mode.sample(&tables.j[m], &tables.i[m], radii, row);
            }
            rows
        };
        self.flat.iter().enumerate().map(sample_order).collect()
    }

    /// Radial shapes of all shell modes, of unit mean square, at `radii` (shares of the radius),
    /// `[shell * radii.len() + radius]`, within about 1e-6.
    ///
    /// # Panics
    /// If the tables do not reach the plate's highest order.
    pub fn radial_shapes(&self, tables: &PlateTables, radii: &[f64]) -> Vec<f64> {
        let flat_shapes = self.flat_shapes(tables, radii);
        // An empty grid has no chunks of any length.
        let length = radii.len().max(1);
        let mut shapes = vec![0.0; self.shells.len() * radii.len()];
        for (shell, shape) in self.shells.iter().zip(shapes.chunks_exact_mut(length)) {
            let rows = flat_shapes[shell.m as usize].chunks_exact(length);
            for (row, &share) in rows.zip(&shell.expansion) {
                for (shape, flat) in shape.iter_mut().zip(row) {
                    *shape += share * flat;
                }
            }
            shape.iter_mut().zip(radii).for_each(|(shape, &r)| *shape += shell.rigid_shape(r));
        }
        shapes
    }
}

/// By how much waves are shorter where a plate is thinnest than where it is as thick as in the mean.
fn shortening(spec: &PlateSpec) -> f64 {
    spec.relative_thickness(1.0).sqrt().recip()
}

/// Solved modes of one order with the names of the flat modes they grow out of.
fn named(flat: &[RadialMode], solved: Vec<Shell>) -> impl Iterator<Item = ShellMode> {
    solved.into_iter().zip(flat).map(|(shell, flat)| ShellMode {
        m: flat.m,
        n: flat.n,
        omega: shell.omega_squared.sqrt(),
        expansion: shell.expansion,
        rigid: shell.rigid,
    })
}

#[cfg(test)]
mod tests;
