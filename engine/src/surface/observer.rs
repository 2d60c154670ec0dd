//! Observers of contact forces, which do not act back (but for what a stretched head [hands](HighBand::scatter) to its high band): the [high bands](HighBand) of heads, the [direct sound](DirectSound) of
//! plates, the [sound of the sticks](StickSound).

use crate::high_band::HighBand;
use crate::modal::RECEIVERS;
use crate::stick::Stick;

use super::direct_sound::DirectSound;
use super::exciter::PARTS;
use super::stick_sound::StickSound;

/// A high band and the first contact point whose force it observes.
struct Observer {
    first: usize,
    band: HighBand,
}

/// All observers of a struck body.
#[derive(Default)]
pub struct ForceObservers {
    observers: Vec<Observer>,
    /// Of as many contact points as it has places, from the first on.
    direct: Option<DirectSound>,
    sticks: Option<StickSound>,
}

impl ForceObservers {
    /// Adds a band that observes as many contact points as it has places, from `first` on. Allocates.
    pub fn add(&mut self, first: usize, band: HighBand) {
        self.observers.push(Observer { first, band });
    }

    /// Adds the direct sound of the first contact points. Allocates.
    pub fn hear_directly(&mut self, direct: DirectSound) {
        self.direct = Some(direct);
    }

    /// Adds the sound of the sticks. Allocates.
    pub fn hear_sticks(&mut self, sticks: StickSound) {
        self.sticks = Some(sticks);
    }

    /// A striker arrives, with its stick if it has one, at a place: share of the radius, rad; its points feel so much of the parts of
    /// its exciter, of which the first do not bend.
    pub fn arrive(
        &mut self,
        striker: usize,
        place: (f64, f64),
        stick: Option<&Stick>,
        points: [&[f64; PARTS]; 2],
        rigid: usize,
    ) {
        let Some(sticks) = &mut self.sticks else { return };
        match stick {
            Some(stick) => sticks.arrive(striker, place, stick.place, points, rigid),
            None => sticks.hush(striker),
        }
    }

    /// A force (N) on the point of a striker in a sample of the present run.
    pub fn push_stick(&mut self, point: usize, sample: usize, force: f32) {
        if let Some(sticks) = &mut self.sticks {
            sticks.push(point, sample, force);
        }
    }

    /// The direct sound of a point, and the point's place in it.
    fn direct_of(&mut self, point: usize) -> Option<&mut DirectSound> {
        self.direct.as_mut().filter(|direct| point < direct.places())
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
        if let Some(direct) = self.direct_of(point) {
            direct.put(point, radius, angle);
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
        if let Some(direct) = self.direct_of(point) {
            direct.push(point, sample, force);
        }
    }

    /// Ends the run: adds what is heard at each point, Pa.
    pub fn render(&mut self, out: &mut [&mut [f32]; RECEIVERS]) {
        self.bands_mut().for_each(|band| band.render(out));
        self.direct.iter_mut().for_each(|direct| direct.render(out));
        self.sticks.iter_mut().for_each(|sticks| sticks.render(out));
    }

    /// Zeroes what has decayed to nothing; reports whether all is finite.
    pub fn settle(&mut self) -> bool {
        self.bands_mut().all(HighBand::settle)
            && self.direct.as_mut().is_none_or(DirectSound::settle)
            && self.sticks.as_mut().is_none_or(StickSound::settle)
    }

    /// Whether nothing is to be heard.
    pub fn is_still(&self) -> bool {
        self.bands().all(HighBand::is_still)
            && self.direct.as_ref().is_none_or(DirectSound::is_still)
            && self.sticks.as_ref().is_none_or(StickSound::is_still)
    }

    /// Puts all to rest.
    pub fn reset(&mut self) {
        self.bands_mut().for_each(HighBand::reset);
        self.direct.iter_mut().for_each(DirectSound::reset);
        self.sticks.iter_mut().for_each(StickSound::reset);
    }
}
