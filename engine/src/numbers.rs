//! The numbers of a description with their names and accepted ranges: one list for checks, random draws and listings.

use std::ops::RangeInclusive;

use crate::error::SpecError;

/// Sees every number of a description, in a fixed order.
pub trait Visitor {
    /// A number under its name in the kit file, in the unit of that name, and what is accepted of it.
    fn number(&mut self, name: &str, value: &mut f64, accepted: RangeInclusive<f64>);
    /// What follows is inside a part of that name.
    fn enter(&mut self, part: &str);
    /// The part ends.
    fn leave(&mut self);
}

/// A description whose numbers can be visited.
pub trait Numbers {
    /// Shows every number to the visitor. A range that depends on other numbers is worked out from what these are once
    /// they have been visited.
    fn visit(&mut self, visitor: &mut dyn Visitor);

    /// Shows the numbers of a part.
    fn visit_part(&mut self, part: &str, visitor: &mut dyn Visitor) {
        visitor.enter(part);
        self.visit(visitor);
        visitor.leave();
    }
}

/// Checks every number against its range.
///
/// # Errors
/// [`SpecError::OutOfRange`] with the path of the first that lies outside.
pub fn check<T: Numbers + Clone>(spec: &T) -> Result<(), SpecError> {
    let mut checker = Checker::default();
    spec.clone().visit(&mut checker);
    checker.wrong.map_or(Ok(()), Err)
}

/// Keeps the first number that is out of its range.
#[derive(Default)]
struct Checker {
    path: Vec<String>,
    wrong: Option<SpecError>,
}

impl Visitor for Checker {
    fn number(&mut self, name: &str, value: &mut f64, accepted: RangeInclusive<f64>) {
        if self.wrong.is_none() && !accepted.contains(value) {
            let path: Vec<&str> = self.path.iter().map(String::as_str).chain([name]).collect();
            let (min, max) = (*accepted.start(), *accepted.end());
            self.wrong = Some(SpecError::OutOfRange { field: path.join("."), value: *value, min, max });
        }
    }

    fn enter(&mut self, part: &str) {
        self.path.push(part.to_owned());
    }

    fn leave(&mut self) {
        self.path.pop();
    }
}
