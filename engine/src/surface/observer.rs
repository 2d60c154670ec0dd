//! Observers of contact forces, which do not act back: the [high bands](HighBand) of heads.

use crate::high_band::HighBand;

/// A high band and the first contact point whose force it observes.
struct Observer {
    first: usize,
    band: HighBand,
}

/// All high bands of a struck body.
#[derive(Default)]
pub struct ForceObservers {
    observers: Vec<Observer>,
}

impl ForceObservers {
    /// Adds a band that observes as many contact points as it has places, from `first` on. Allocates.
    pub fn add(&mut self, first: usize, band: HighBand) {
        self.observers.push(Observer { first, band });
    }

    /// The bands, in the order in which they were added.
    pub fn bands(&self) -> impl Iterator<Item = &HighBand> {
        self.observers.iter().map(|observer| &observer.band)
    }

    /// The bands, to be retuned.
    pub fn bands_mut(&mut self) -> impl Iterator<Item = &mut HighBand> {
        self.observers.iter_mut().map(|observer| &mut observer.band)
    }

    /// The band that observes a point, and the point's place in it.
    fn of(&mut self, point: usize) -> Option<(&mut HighBand, usize)> {
        self.observers.iter_mut().find_map(|Observer { first, band }| {
            let place = point.checked_sub(*first).filter(|&place| place < band.places())?;
            Some((band, place))
        })
    }

    /// Sets the position of a point; see [`HighBand::put`]: share of the radius, rad, m.
    pub fn put(&mut self, point: usize, radius: f64, angle: f64, patch: f64) {
        if let Some((band, place)) = self.of(point) {
            band.put(place, radius, angle, patch);
        }
    }

    /// Sets the body's own pressure proportional to a force at a point, Pa/N; see [`HighBand::complete`].
    pub fn complete(&mut self, point: usize, direct: f32) {
        if let Some((band, place)) = self.of(point) {
            band.complete(place, direct);
        }
    }

    /// A force (N) at a point in a sample of the present run.
    pub fn push(&mut self, point: usize, sample: usize, force: f32) {
        if let Some((band, place)) = self.of(point) {
            band.push(place, sample, force);
        }
    }
}
