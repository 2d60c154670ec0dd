//! Line plots of the report, as PNG.

use anyhow::Result;
use plotters::prelude::*;

use crate::picture;

/// Size of a picture, pixels.
const SIZE: (u32, u32) = (1500, 520);

const PAPER: RGBColor = RGBColor(255, 255, 255);
const INK: RGBColor = RGBColor(40, 44, 52);
const GRID: RGBColor = RGBColor(215, 218, 224);
const LINES: [RGBColor; 6] = [
    RGBColor(130, 130, 130),
    RGBColor(60, 130, 200),
    RGBColor(20, 150, 90),
    RGBColor(230, 130, 20),
    RGBColor(190, 40, 60),
    RGBColor(120, 60, 170),
];

/// A line: its name and its points.
pub type Line = (String, Vec<(f64, f64)>);

/// Plots side by side over one kind of axis.
pub struct Plot<'a> {
    /// What the horizontal axis shows.
    pub across: &'a str,
    /// What the vertical axis shows.
    pub up: &'a str,
    /// Range of the vertical axis.
    pub range: std::ops::Range<f64>,
    /// Title and lines of each panel.
    pub panels: Vec<(String, Vec<Line>)>,
}

impl Plot<'_> {
    /// The bytes of a PNG.
    ///
    /// # Errors
    /// If drawing or encoding fails.
    pub fn png(&self) -> Result<Vec<u8>> {
        picture::drawn(SIZE, |area| self.draw(area))
    }

    fn draw(
        &self,
        area: &DrawingArea<BitMapBackend, plotters::coord::Shift>,
    ) -> Result<(), Box<dyn std::error::Error>> {
        area.fill(&PAPER)?;
        for (panel, (title, lines)) in
            area.split_evenly((1, self.panels.len().max(1))).iter().zip(&self.panels)
        {
            let points = lines.iter().flat_map(|(_, points)| points);
            let right = points.map(|&(x, _)| x).fold(0.0, f64::max);
            let mut chart = ChartBuilder::on(panel)
                .margin(10)
                .caption(title, ("sans-serif", 22).into_font().color(&INK))
                .x_label_area_size(40)
                .y_label_area_size(60)
                .build_cartesian_2d(0.0..right, self.range.clone())?;
            chart
                .configure_mesh()
                .x_desc(self.across)
                .y_desc(self.up)
                .axis_style(INK)
                .light_line_style(PAPER)
                .bold_line_style(GRID)
                .label_style(("sans-serif", 16).into_font().color(&INK))
                .draw()?;
            for ((name, points), &color) in lines.iter().zip(LINES.iter().cycle()) {
                chart
                    .draw_series(LineSeries::new(points.iter().copied(), color.stroke_width(2)))?
                    .label(name)
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
            }
            chart
                .configure_series_labels()
                .position(SeriesLabelPosition::UpperRight)
                .label_font(("sans-serif", 16).into_font().color(&INK))
                .background_style(PAPER)
                .draw()?;
        }
        area.present()?;
        Ok(())
    }
}
