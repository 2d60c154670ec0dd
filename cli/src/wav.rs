//! WAV files.
//!
//! Integer formats are rounded to the nearest step without dither, so that equal renders give
//! equal files; values beyond full scale are clipped and counted.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use hound::{SampleFormat, WavSpec};

use crate::bad_input;
use crate::output::Draft;

/// Storage format of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Bits {
    /// 16-bit integers.
    #[value(name = "16")]
    Int16,
    /// 24-bit integers.
    #[value(name = "24")]
    Int24,
    /// 32-bit floating point: exactly what was rendered.
    #[value(name = "32f")]
    Float32,
}

impl Bits {
    fn spec(self, rate: u32, channels: u16) -> WavSpec {
        let (bits_per_sample, sample_format) = match self {
            Bits::Int16 => (16, SampleFormat::Int),
            Bits::Int24 => (24, SampleFormat::Int),
            Bits::Float32 => (32, SampleFormat::Float),
        };
        WavSpec { channels, sample_rate: rate, bits_per_sample, sample_format }
    }
}

/// A WAV file being written.
pub struct WavFile {
    target: PathBuf,
    draft: Draft,
    writer: hound::WavWriter<BufWriter<File>>,
    bits: Bits,
    clipped: u64,
}

/// Bytes of sound that fit: the format counts with 32 bits and needs some for its header.
const LARGEST: u64 = u32::MAX as u64 - 256;

impl WavFile {
    /// Starts a file at a sample rate (Hz) for `frames` samples of `channels` channels.
    ///
    /// # Errors
    /// [`BadInput`](crate::error::BadInput) if it cannot be written or does not fit the format.
    pub fn create(target: &Path, bits: Bits, rate: u32, channels: u16, frames: u64) -> Result<WavFile> {
        let spec = bits.spec(rate, channels);
        let frame = u64::from(channels) * u64::from(spec.bits_per_sample / 8);
        if frames.saturating_mul(frame) > LARGEST {
            return Err(bad_input!(
                "`{}` would last {:.0} s, accepted: up to {} s, which is what a WAV file holds at \
                 this rate",
                target.display(),
                frames as f64 / f64::from(rate),
                LARGEST / frame / u64::from(rate),
            ));
        }
        let draft = Draft::new(target)?;
        let writer = hound::WavWriter::create(draft.path(), spec)
            .with_context(|| format!("cannot write `{}`", target.display()))?;
        Ok(WavFile { target: target.to_path_buf(), draft, writer, bits, clipped: 0 })
    }

    /// Appends samples, full scale 1: `[channel][frame]`, all channels of one length.
    ///
    /// # Errors
    /// If the disk refuses.
    pub fn write(&mut self, channels: &[&[f32]]) -> Result<()> {
        let frames = channels.first().map_or(0, |channel| channel.len());
        for frame in 0..frames {
            for channel in channels {
                self.write_sample(channel[frame])
                    .with_context(|| format!("cannot write `{}`", self.target.display()))?;
            }
        }
        Ok(())
    }

    fn write_sample(&mut self, sample: f32) -> hound::Result<()> {
        let full = match self.bits {
            Bits::Float32 => return self.writer.write_sample(sample),
            Bits::Int16 => 32_768.0,
            Bits::Int24 => 8_388_608.0,
        };
        let stepped = (f64::from(sample) * full).round();
        let stored = stepped.clamp(-full, full - 1.0);
        self.clipped += u64::from(stored != stepped);
        self.writer.write_sample(stored as i32)
    }

    /// Closes the file under its name and tells how many samples were clipped.
    ///
    /// # Errors
    /// If the disk refuses.
    pub fn finish(self) -> Result<u64> {
        let WavFile { target, draft, writer, clipped, .. } = self;
        writer.finalize().with_context(|| format!("cannot write `{}`", target.display()))?;
        draft.finish()?;
        Ok(clipped)
    }
}

/// Reads a WAV file of floating-point samples: rate (Hz) and `[channel][frame]`.
///
/// # Errors
/// If it cannot be read or holds integers.
pub fn read_float(path: &Path) -> Result<(u32, Vec<Vec<f32>>)> {
    let mut reader =
        hound::WavReader::open(path).with_context(|| format!("cannot read `{}`", path.display()))?;
    let spec = reader.spec();
    let mut channels = vec![Vec::new(); usize::from(spec.channels)];
    for (index, sample) in reader.samples::<f32>().enumerate() {
        channels[index % usize::from(spec.channels)]
            .push(sample.with_context(|| format!("cannot read `{}`", path.display()))?);
    }
    Ok((spec.sample_rate, channels))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scratch(name: &str) -> PathBuf {
        std::env::temp_dir().join(format!("overhear-wav-{name}-{}.wav", std::process::id()))
    }

    #[test]
    fn floats_come_back_bit_by_bit() {
        let path = scratch("float");
        let (left, right) = ([0.1f32, -2.5, 1e-30], [0.0f32, 1.0, f32::MIN_POSITIVE]);
        let mut file = WavFile::create(&path, Bits::Float32, 44_100, 2, 3).unwrap();
        file.write(&[&left, &right]).unwrap();
        assert_eq!(file.finish().unwrap(), 0);
        assert_eq!(read_float(&path).unwrap(), (44_100, vec![left.to_vec(), right.to_vec()]));
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    fn integers_round_clip_and_count() {
        let path = scratch("integer");
        let mut file = WavFile::create(&path, Bits::Int16, 48_000, 1, 4).unwrap();
        file.write(&[&[0.5, 1.0, -1.0, -1.5]]).unwrap();
        assert_eq!(file.finish().unwrap(), 2);
        let mut reader = hound::WavReader::open(&path).unwrap();
        let samples: Vec<i32> = reader.samples().map(Result::unwrap).collect();
        assert_eq!(samples, [16_384, 32_767, -32_768, -32_768]);
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    fn a_file_too_long_for_the_format_is_refused_at_once() {
        let path = scratch("long");
        let error = WavFile::create(&path, Bits::Float32, 48_000, 2, 1 << 40).err().unwrap();
        assert!(error.to_string().contains("accepted: up to 11184 s"), "{error}");
        assert!(!path.exists());
    }
}
