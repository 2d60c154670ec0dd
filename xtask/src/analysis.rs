//! What can be measured on a sound: levels, spectrum, decay, glide.
//!
//! Everything here takes samples and a sample rate and knows nothing of drums. A value that the
//! sound does not support is `None`, never a guess.

pub mod decay;
pub mod glide;
pub mod level;
pub mod spectrum;

pub use decay::{OCTAVES, octave_decays};
pub use glide::{Motion, glide_cents};
pub use level::{mean, peak, rms, to_dbfs};
pub use spectrum::Spectrum;
