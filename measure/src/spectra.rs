//! Spectra of finished sounds, all in double precision: the only place that transforms one.
//!
//! | | of | for |
//! |---|---|---|
//! | [`PowerSpectrum`] | a stretch as it is, or under a Hann window | energy of bands, single lines |
//! | [`OnsetSpectrum`] | the beginning of a struck sound, padded fourfold | strongest partials, centroid |
//! | [`Transform`] | a whole sound, padded twofold | cutting bands out without shifting them in time |
//! | [`Frames`] | short frames under a Hann window | spectrograms, density of peaks |
//! | [`third_octaves`] | a whole sound, by a filter each | how alike two sounds are |

mod forward;
mod frames;
mod onset;
mod power;
pub mod third_octaves;
mod transform;

pub use frames::Frames;
pub use onset::OnsetSpectrum;
pub use power::PowerSpectrum;
pub use transform::{Transform, slope};
