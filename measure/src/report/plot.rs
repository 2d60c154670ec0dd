//! Curve plots of the report, as PNG.

use std::ops::Range;

use anyhow::Result;
use plotters::coord::ranged1d::{Ranged, ValueFormatter};
use plotters::prelude::*;

use crate::picture;

/// Size of a picture, pixels.
const SIZE: (u32, u32) = (1500, 520);

const PAPER: RGBColor = RGBColor(255, 255, 255);
const INK: RGBColor = RGBColor(40, 44, 52);
const GRID: RGBColor = RGBColor(215, 218, 224);
const LINES: [RGBColor; 9] = [
    RGBColor(130, 130, 130),
    RGBColor(60, 130, 200),
    RGBColor(20, 150, 90),
    RGBColor(230, 130, 20),
    RGBColor(190, 40, 60),
    RGBColor(120, 60, 170),
    RGBColor(90, 200, 210),
    RGBColor(150, 110, 60),
    RGBColor(220, 110, 180),
];

/// A line: its name and its points; one that is not a number lifts the pen.
pub type Curve = (String, Vec<(f64, f64)>);

/// Scale of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// In proportion.
    Linear,
    /// By their logarithms; values and ranges are above zero.
    Log,
}

/// An axis.
pub struct Axis<'a> {
    /// What it shows.
    pub name: &'a str,
    /// From where to where.
    pub range: Range<f64>,
    /// How.
    pub scale: Scale,
}

impl<'a> Axis<'a> {
    /// In proportion.
    pub fn linear(name: &'a str, range: Range<f64>) -> Axis<'a> {
        Axis { name, range, scale: Scale::Linear }
    }

    /// By logarithms.
    pub fn log(name: &'a str, range: Range<f64>) -> Axis<'a> {
        Axis { name, range, scale: Scale::Log }
    }
}

/// Plots side by side over one kind of axis.
pub struct Plot<'a> {
    /// The horizontal axis.
    pub across: Axis<'a>,
    /// The vertical axis.
    pub up: Axis<'a>,
    /// Title and lines of each panel.
    pub panels: Vec<(String, Vec<Curve>)>,
}

/// Error of drawing.
type Drawn = Result<(), Box<dyn std::error::Error>>;

/// Area of a panel.
type Area<'a> = DrawingArea<BitMapBackend<'a>, plotters::coord::Shift>;

impl Plot<'_> {
    /// The bytes of a PNG.
    ///
    /// # Errors
    /// If drawing or encoding fails.
    pub fn png(&self) -> Result<Vec<u8>> {
        picture::drawn(SIZE, |area| self.draw(area))
    }

    fn draw(&self, area: &Area<'_>) -> Drawn {
        area.fill(&PAPER)?;
        let panels = area.split_evenly((1, self.panels.len().max(1)));
        for (panel, (title, lines)) in panels.iter().zip(&self.panels) {
            let mut builder = ChartBuilder::on(panel);
            builder
                .margin(10)
                .caption(title, ("sans-serif", 22).into_font().color(&INK))
                .x_label_area_size(40)
                .y_label_area_size(64);
            let (x, y) = (self.across.range.clone(), self.up.range.clone());
            match (self.across.scale, self.up.scale) {
                (Scale::Linear, Scale::Linear) => self.fill(builder.build_cartesian_2d(x, y)?, lines)?,
                (Scale::Log, Scale::Linear) => {
                    self.fill(builder.build_cartesian_2d(x.log_scale(), y)?, lines)?;
                }
                (Scale::Linear, Scale::Log) => {
                    self.fill(builder.build_cartesian_2d(x, y.log_scale())?, lines)?;
                }
                (Scale::Log, Scale::Log) => {
                    self.fill(builder.build_cartesian_2d(x.log_scale(), y.log_scale())?, lines)?;
                }
            }
        }
        area.present()?;
        Ok(())
    }

    /// Draws axes and lines of a panel.
    fn fill<'a, 'b, X, Y>(
        &self,
        mut chart: ChartContext<'a, BitMapBackend<'b>, Cartesian2d<X, Y>>,
        lines: &[Curve],
    ) -> Drawn
    where
        'b: 'a,
        X: Ranged<ValueType = f64> + ValueFormatter<f64>,
        Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        chart
            .configure_mesh()
            .x_labels(if self.panels.len() > 1 { 6 } else { 11 })
            .x_desc(self.across.name)
            .y_desc(self.up.name)
            .x_label_formatter(&|x| short(*x))
            .y_label_formatter(&|y| short(*y))
            .axis_style(INK)
            .light_line_style(PAPER)
            .bold_line_style(GRID)
            .label_style(("sans-serif", 16).into_font().color(&INK))
            .draw()?;
        for ((name, points), &color) in lines.iter().zip(LINES.iter().cycle()) {
            let strokes = points.split(|point| point.0.is_nan()).filter(|stroke| !stroke.is_empty());
            let strokes = strokes.map(|stroke| PathElement::new(stroke.to_vec(), color.stroke_width(2)));
            let drawn = chart.draw_series(strokes)?;
            if !name.is_empty() {
                drawn
                    .label(name)
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
            }
        }
        if lines.iter().all(|(name, _)| name.is_empty()) {
            return Ok(());
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .label_font(("sans-serif", 16).into_font().color(&INK))
            .background_style(PAPER)
            .draw()?;
        Ok(())
    }
}

/// A number on an axis; what is left of nought by rounding is nought.
fn short(value: f64) -> String {
    let value = if value.abs() < 1e-15 { 0.0 } else { value };
    let text = if value != 0.0 && value.abs() < 1e-3 { format!("{value:e}") } else { format!("{value:.3}") };
    let plain = !text.contains('e') && text.contains('.');
    if plain { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Upright lines at some places.
pub fn comb(name: &str, places: &[f64], [foot, top]: [f64; 2]) -> Curve {
    let upright = |&x: &f64| [(x, foot), (x, top), (f64::NAN, f64::NAN)];
    (name.to_owned(), places.iter().flat_map(upright).collect())
}
