//! A page of the report: claims with their figures, then whatever shows more of them.

use std::fmt::Write;

use anyhow::Result;

use super::plot::Plot;

/// A page as it is written.
#[derive(Debug, Clone)]
pub struct Page {
    /// Its name: the file is `name.md`.
    pub name: &'static str,
    /// The page itself.
    pub markdown: String,
    /// Its claims.
    pub claims: Vec<Claim>,
    /// Its pictures: file name and PNG bytes.
    pub pictures: Vec<(String, Vec<u8>)>,
}

/// A claim of this project, and the measured figure.
#[derive(Debug, Clone)]
pub struct Claim {
    /// The claim.
    pub what: String,
    /// Of which instrument or body it was measured; see [`bodies`].
    pub on: &'static str,
    /// The measured figure, with its unit.
    pub figure: String,
    /// The target, and its tolerance.
    pub reference: String,
    /// Source of the target.
    pub source: &'static str,
    /// Whether the figure meets the target; none for figures given as information.
    pub met: Option<bool>,
}

impl Claim {
    /// A figure that should lie within a share of another, both with their unit.
    pub fn near(
        what: &str,
        on: &'static str,
        (value, unit): (f64, &str),
        (wanted, share): (f64, f64),
        source: &'static str,
    ) -> Claim {
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        Claim {
            what: what.to_owned(),
            on,
            figure: format!("{}{unit}", figure(value)),
            reference: format!("{}{unit}, {} %", figure(wanted), figure(100.0 * share)),
            source,
            met: Some((value / wanted - 1.0).abs() <= share),
        }
    }

    /// A figure given as information.
    pub fn told(
        what: &str,
        on: &'static str,
        figure: String,
        reference: &str,
        source: &'static str,
    ) -> Claim {
        Claim { what: what.to_owned(), on, figure, reference: reference.to_owned(), source, met: None }
    }
}

/// Four figures of a number in any unit, no more than there are.
pub fn figure(value: f64) -> String {
    let size = if value == 0.0 { 0.0 } else { value.abs().log10().floor() };
    let decimals = (3.0 - size).clamp(0.0, 9.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Sources of targets.
pub mod sources {
    /// Published figures of an earlier engine of this kind.
    pub const EARLIER: &str = "an earlier engine";
    /// Real instruments.
    pub const MEASURED: &str = "measured instruments";
    /// Follows from the equations.
    pub const EXACT: &str = "mathematics";
    /// A goal of this project.
    pub const GOAL: &str = "our goal";
}

/// Bodies on which figures are measured: the played instrument, or a named reference.
pub mod bodies {
    /// The played instrument: the standard kit, or a piece of it by itself.
    pub const PLAYED: &str = "standard kit";
    /// A piece of it without what makes it uneven.
    pub const ROUND: &str = "standard kit, perfectly round";
    /// A cymbal as a spherical cap, as thick everywhere, whose modes are known in closed form.
    pub const CAP: &str = "reference: cap";
    /// A drum on which every stroke presses on its striker's own disc, as published figures have it.
    pub const FIXED_DISC: &str = "reference: fixed disc";
    /// A membrane in vacuo, so thin that it does not resist bending.
    pub const MEMBRANE: &str = "reference: membrane in vacuo";
    /// A timpani's head with air on both faces.
    pub const NO_KETTLE: &str = "reference: timpani head without its kettle";
    /// No piece: an equation's own body.
    pub const EQUATION: &str = "no piece: the equation";
}

/// A page in the making.
pub struct Sheet {
    name: &'static str,
    title: &'static str,
    about: String,
    on: &'static str,
    claims: Vec<Claim>,
    body: String,
    pictures: Vec<(String, Vec<u8>)>,
}

impl Sheet {
    /// An empty page of a name, under a title, that begins with a paragraph on what is measured, and on which
    /// [bodies]; that is also what plots and tables show that do not say otherwise.
    pub fn new(name: &'static str, title: &'static str, on: &'static str, about: &str) -> Sheet {
        Sheet {
            name,
            title,
            about: about.to_owned(),
            on,
            claims: Vec::new(),
            body: String::new(),
            pictures: Vec::new(),
        }
    }

    /// Adds a row to the table of claims.
    pub fn claim(&mut self, claim: Claim) {
        self.claims.push(claim);
    }

    /// Adds a heading below the claims.
    pub fn heading(&mut self, text: &str) {
        let _ = write!(self.body, "\n## {text}\n");
    }

    /// Adds a paragraph below the claims.
    pub fn text(&mut self, text: &str) {
        let _ = write!(self.body, "\n{text}\n");
    }

    /// Adds a table below the claims.
    pub fn table(&mut self, head: &[&str], rows: impl IntoIterator<Item = Vec<String>>) {
        let _ = write!(self.body, "\n| {} |\n|{}\n", head.join(" | "), "---|".repeat(head.len()));
        for row in rows {
            let _ = writeln!(self.body, "| {} |", row.join(" | "));
        }
    }

    /// Adds a plot, `what` it shows being the last part of its file's name.
    ///
    /// # Errors
    /// If it cannot be drawn.
    pub fn plot(&mut self, what: &str, caption: &str, plot: &Plot<'_>) -> Result<()> {
        self.picture(what, caption, plot.png()?);
        Ok(())
    }

    /// Adds a PNG, `what` it shows being the last part of its file's name.
    pub fn picture(&mut self, what: &str, caption: &str, png: Vec<u8>) {
        let file = format!("{}-{what}.png", self.name);
        let _ = write!(self.body, "\n![{caption}]({file})\n\n{caption}.\n");
        self.pictures.push((file, png));
    }

    /// The page.
    pub fn finish(self) -> Page {
        let Sheet { name, title, about, on, claims, body, pictures } = self;
        let mut markdown = format!(
            "# {title}\n\n{about}\n\nMeasured on: {on}.\n\n`cargo xtask report {name}` writes this page.\n"
        );
        if !claims.is_empty() {
            markdown.push_str(
                "\n| claim | measured on | figure | target | source | met |\n|---|---|---|---|---|---|\n",
            );
        }
        for Claim { what, on, figure, reference, source, met } in &claims {
            let met = match met {
                Some(true) => MET,
                Some(false) => MISSED,
                None => "| info |",
            };
            let _ = writeln!(markdown, "| {what} | {on} | {figure} | {reference} | {source} {met}");
        }
        markdown.push_str(&body);
        Page { name, markdown, claims, pictures }
    }
}

/// Ends of the rows of claims that are met, and that are not met.
pub const MET: &str = "| yes |";
/// See [`MET`].
pub const MISSED: &str = "| **no** |";

/// Number of claims that are met, and number of claims with a target.
pub fn tally(claims: &[Claim]) -> [usize; 2] {
    let bound = claims.iter().filter_map(|claim| claim.met);
    [bound.clone().filter(|met| *met).count(), bound.count()]
}
