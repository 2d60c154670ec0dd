//! Bessel functions on a uniform grid, for integrals that need them a million times.
//!
//! Cubic Hermite interpolation between values and slopes 1/36 apart: the error is at most
//! `h^4 / 384` times the fourth derivative, which never exceeds 1 for `J_m` and 35/8 for `e^-x I_m`
//! (`m = 0`, at the centre): below 2e-9 and 7e-9.

use super::lanes::{LANES, Lanes, i_scaled_orders, j_orders};

/// Grid points per unit of the argument.
const DENSITY: f64 = 36.0;

/// `J_m` of one order on `0..=x_max`.
#[derive(Debug, Clone)]
pub struct JTable(Grid);

/// `e^-x I_m` of one order on `0..=x_max`.
#[derive(Debug, Clone)]
pub struct ITable(Grid);

impl JTable {
    /// Tabulates one order.
    pub fn new(m: u32, x_max: f64) -> JTable {
        // The recurrence runs through the orders below anyway.
        let mut all = JTable::orders(m, x_max);
        all.swap_remove(m as usize)
    }

    /// Tabulates every order `0..=max_order`; one descending recurrence for eight grid points.
    pub fn orders(max_order: u32, x_max: f64) -> Vec<JTable> {
        let slope = |m: usize, values: &[Lanes], lane: usize| match m {
            0 => -values[1][lane],
            _ => 0.5 * (values[m - 1][lane] - values[m + 1][lane]),
        };
        grids(max_order, x_max, j_orders, slope).map(JTable).collect()
    }

    /// `J_m(x)`. Arguments beyond the table read its last value.
    #[inline]
    pub fn value(&self, x: f64) -> f64 {
        self.0.pair(x).0
    }

    /// `J_m(x)` and `J_m'(x)`.
    #[inline]
    pub fn pair(&self, x: f64) -> (f64, f64) {
        self.0.pair(x)
    }
}

impl ITable {
    /// Tabulates every order `0..=max_order`; one descending recurrence for eight grid points.
    pub fn orders(max_order: u32, x_max: f64) -> Vec<ITable> {
        let slope = |m: usize, values: &[Lanes], lane: usize| {
            let derivative = match m {
                0 => values[1][lane],
                _ => 0.5 * (values[m - 1][lane] + values[m + 1][lane]),
            };
            derivative - values[m][lane]
        };
        grids(max_order, x_max, i_scaled_orders, slope).map(ITable).collect()
    }

    /// `e^-x I_m(x)`. Arguments beyond the table read its last value.
    #[inline]
    pub fn value(&self, x: f64) -> f64 {
        self.0.pair(x).0
    }

    /// `e^-x I_m(x)` and `e^-x I_m'(x)`.
    #[inline]
    pub fn pair(&self, x: f64) -> (f64, f64) {
        let (value, slope) = self.0.pair(x);
        (value, slope + value)
    }
}

/// Values and slopes at `x = i / DENSITY`.
#[derive(Debug, Clone)]
struct Grid {
    nodes: Vec<[f64; 2]>,
}

impl Grid {
    /// Interpolated value and slope.
    #[inline]
    fn pair(&self, x: f64) -> (f64, f64) {
        let place = x * DENSITY;
        let index = (place as usize).min(self.nodes.len() - 2);
        let t = (place - index as f64).min(1.0);
        let [a, slope_a] = self.nodes[index];
        let [b, slope_b] = self.nodes[index + 1];
        let (slope_a, slope_b) = (slope_a / DENSITY, slope_b / DENSITY);
        let square = 3.0 * (b - a) - 2.0 * slope_a - slope_b;
        let cube = slope_a + slope_b - 2.0 * (b - a);
        let value = a + t * (slope_a + t * (square + t * cube));
        let slope = slope_a + t * (2.0 * square + 3.0 * t * cube);
        (value, slope * DENSITY)
    }
}

/// One grid per order: `fill` works out all orders, one more than are kept, at eight points, `slope` says how steep one
/// of them is at one.
fn grids(
    max_order: u32,
    x_max: f64,
    fill: impl Fn(&Lanes, &mut [Lanes]),
    slope: impl Fn(usize, &[Lanes], usize) -> f64,
) -> impl Iterator<Item = Grid> {
    let orders = max_order as usize + 1;
    let points = (x_max.max(0.0) * DENSITY).ceil() as usize + 2;
    let mut values = vec![[0.0; LANES]; orders + 1];
    let mut grids = vec![Vec::with_capacity(points.next_multiple_of(LANES)); orders];
    for first in (0..points).step_by(LANES) {
        // The recurrence has no beginning at 0, where all orders but the lowest are nothing.
        fill(&std::array::from_fn(|lane| (first + lane).max(1) as f64 / DENSITY), &mut values);
        if first == 0 {
            values.iter_mut().for_each(|row| row[0] = 0.0);
            values[0][0] = 1.0;
        }
        for (m, grid) in grids.iter_mut().enumerate() {
            grid.extend((0..LANES).map(|lane| [values[m][lane], slope(m, &values, lane)]));
        }
    }
    grids.into_iter().map(move |mut nodes| {
        nodes.truncate(points);
        Grid { nodes }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::bessel::{i_scaled_pair, j_pair};

    #[test]
    fn tables_are_within_1e_8_of_the_functions() {
        let (j_tables, i_tables) = (JTable::orders(80, 90.0), ITable::orders(80, 90.0));
        for m in (0..=80_u32).step_by(4) {
            for i in 0..2000 {
                let x = 0.0449 * f64::from(i);
                let (value, slope) = j_pair(m, x);
                let (got, got_slope) = j_tables[m as usize].pair(x);
                assert!((got - value).abs() < 1e-8, "J_{m}({x})");
                assert!((got_slope - slope).abs() < 1e-6, "J_{m}'({x})");
                let (value, slope) = i_scaled_pair(m, x);
                let (got, got_slope) = i_tables[m as usize].pair(x);
                assert!((got - value).abs() < 1e-8, "I_{m}({x})");
                assert!((got_slope - slope).abs() < 1e-5, "I_{m}'({x})");
            }
        }
    }

    #[test]
    fn arguments_beyond_a_table_read_its_end() {
        let table = JTable::new(2, 5.0);
        assert!((table.value(5.0) - j_pair(2, 5.0).0).abs() < 1e-8);
        assert!(table.value(1e9).is_finite());
    }
}
