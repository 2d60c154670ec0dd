//! What can be measured on a sound: levels, decay, partials, density, glide.
//!
//! Everything here takes samples and a sample rate and knows nothing of drums. A value that the
//! sound does not support is `None`, never a guess.

pub mod decay;
pub mod density;
pub mod envelope;
pub mod glide;
pub mod level;
pub mod lines;
pub mod loudness;
pub mod one_shot;
pub mod partials;

pub use decay::{OCTAVES, broadband_decays, octave_decays};
pub use glide::{Motion, glide_cents};
pub use level::{mean, peak, rms, to_dbfs};
pub use lines::line_share;
pub use loudness::loudness_lufs;
pub use one_shot::OneShot;
