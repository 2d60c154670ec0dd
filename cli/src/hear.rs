//! `hear`: one stroke on one piece by itself, measured, and its sound kept if that is asked for.

use std::path::Path;

use anyhow::Result;
use overhear_measure::hear::{self, Measurement, Request};

use crate::wav::{Bits, WavFile};

/// Strikes, measures, writes the sound to a WAV file if one is named, and returns the measurement.
///
/// # Errors
/// [`BadInput`](crate::error::BadInput) if the piece cannot be built or the file not be written.
pub fn run(request: &Request, wav: Option<&Path>) -> Result<Measurement> {
    let rate = request.options.sample_rate;
    let frames = (request.seconds * rate).round() as u64;
    // Before any work: a file that cannot be written is told at once.
    let file = wav.map(|path| WavFile::create(path, Bits::Float32, rate as u32, 1, frames)).transpose()?;
    let sound = hear::render(request)?;
    if let Some(mut file) = file {
        file.write(&[&sound.samples])?;
        file.finish()?;
    }
    Ok(Measurement::new(request, &sound))
}
