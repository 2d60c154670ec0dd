//! The laboratory: pieces built, struck, rendered and measured, for the pages of `cargo xtask report` and for the
//! integration tests. Knows the engine and nothing of the plugin, so that tests with an allocator of their own can use it.

use std::f64::consts::TAU;

use overhear_engine::kit::Kit;
use overhear_engine::piece::{BuildOptions, Piece, PieceId};
use overhear_engine::strike::{Strike, Striker};
use realfft::RealFftPlanner;

/// Sample rates that hosts use, Hz.
pub const RATES: [f64; 4] = [44_100.0, 48_000.0, 96_000.0, 192_000.0];

/// A piece as it is played, at a sample rate in Hz.
pub fn piece(id: PieceId, sample_rate: f64) -> Piece {
    build(id, &BuildOptions::new(sample_rate))
}

/// A piece from which nothing is lost, in its contacts neither, at a sample rate in Hz.
pub fn lossless_piece(id: PieceId, sample_rate: f64) -> Piece {
    build(id, &BuildOptions { lossless: true, ..BuildOptions::new(sample_rate) })
}

/// A perfectly round piece, at a sample rate in Hz.
pub fn round_piece(id: PieceId, sample_rate: f64) -> Piece {
    build(id, &BuildOptions { unsplit: true, ..BuildOptions::new(sample_rate) })
}

/// A piece with any options.
///
/// # Panics
/// If the engine refuses them.
pub fn build(id: PieceId, options: &BuildOptions) -> Piece {
    Piece::new(id, options).expect("a default piece")
}

/// A piece as it stands in the kit, heard by its close microphone, at a sample rate in Hz.
pub fn kit_piece(id: PieceId, sample_rate: f64) -> Piece {
    build(id, &BuildOptions::in_kit(id, sample_rate))
}

/// The whole kit, as the plugin plays it, at a sample rate in Hz.
pub fn kit(sample_rate: f64) -> Kit {
    let mut kit = Kit::new(sample_rate);
    for id in PieceId::KIT {
        assert!(kit.install(Box::new(kit_piece(id, sample_rate))).is_none());
    }
    kit
}

/// A stroke at a speed (m/s), a place (share of the radius) and an angle (rad).
pub fn stroke(striker: Striker, speed: f64, radius: f64, angle: f64) -> Strike {
    Strike { speed, radius, angle, striker }
}

/// Energy of a piece, of the strikers about it and of those that have left, J.
pub fn total_energy(piece: &Piece) -> f64 {
    piece.energy() + piece.striker_energy() + piece.departed_energy()
}

/// Renders a stretch of a piece, s long, at a sample rate in Hz.
pub fn render(piece: &mut Piece, seconds: f64, sample_rate: f64) -> Vec<f32> {
    let mut out = vec![0.0; (seconds * sample_rate).round() as usize];
    piece.render(&mut out);
    out
}

/// How far `a` is above `b`, cents.
pub fn cents(a: f64, b: f64) -> f64 {
    1200.0 * (a / b).log2()
}

/// How much larger an amplitude `a` is than `b`, dB.
pub fn decibels(a: f64, b: f64) -> f64 {
    20.0 * (a / b).log10()
}

/// Numbers that look drawn by chance and are the same in every run (xorshift64*).
pub struct Chance(u64);

impl Chance {
    /// A sequence of its own for every seed.
    pub fn new(seed: u64) -> Chance {
        Chance(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    fn bits(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    /// In 0..1, dimensionless.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// In `low..high`, in their unit.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// One of the indices below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() >> 33) as usize % count
    }

    /// One of a list.
    pub fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }

    /// Any stroke up to a speed, m/s.
    pub fn stroke(&mut self, fastest: f64) -> Strike {
        Strike {
            speed: self.between(0.0, fastest),
            radius: self.unit(),
            angle: self.between(0.0, TAU),
            striker: self.of(&Striker::ALL),
        }
    }
}

/// Power of a sound against frequency.
pub struct Spectrum {
    power: Vec<f64>,
    bin_hz: f64,
}

impl Spectrum {
    /// Of the sound as it is; the sample rate is in Hz.
    pub fn new(sound: &[f32], sample_rate: f64) -> Spectrum {
        Spectrum::windowed(sound, sample_rate, |_| 1.0)
    }

    /// Of the sound under a Hann window, the sample rate in Hz: lines stand apart and can be measured.
    pub fn hann(sound: &[f32], sample_rate: f64) -> Spectrum {
        Spectrum::windowed(sound, sample_rate, |t| 0.5 - 0.5 * (TAU * t).cos())
    }

    fn windowed(sound: &[f32], sample_rate: f64, window: impl Fn(f64) -> f64) -> Spectrum {
        let n = sound.len();
        let fft = RealFftPlanner::<f64>::new().plan_fft_forward(n);
        let mut input: Vec<f64> =
            sound.iter().enumerate().map(|(i, &x)| f64::from(x) * window(i as f64 / n as f64)).collect();
        let mut output = fft.make_output_vec();
        fft.process(&mut input, &mut output).expect("lengths that fit");
        // Over the rate squared: the same sound has the same spectrum at every rate.
        let scale = 1.0 / (sample_rate * sample_rate);
        Spectrum {
            power: output.iter().map(|x| scale * x.norm_sqr()).collect(),
            bin_hz: sample_rate / n as f64,
        }
    }

    /// Frequency of the strongest line within `reach` (Hz) of `near` (Hz), between bins too (a
    /// parabola through the logarithms), Hz.
    pub fn line(&self, near: f64, reach: f64) -> f64 {
        let bin = |hz: f64| (hz / self.bin_hz).round().max(1.0) as usize;
        let range = bin(near - reach)..=bin(near + reach).min(self.power.len() - 2);
        let top = range.max_by(|&a, &b| self.power[a].total_cmp(&self.power[b])).unwrap_or(1);
        let [low, middle, high] = [top - 1, top, top + 1].map(|i| self.power[i].max(1e-300).ln());
        let offset = 0.5 * (low - high) / (low - 2.0 * middle + high);
        (top as f64 + offset) * self.bin_hz
    }

    /// Power between two frequencies, Hz.
    pub fn band(&self, low: f64, high: f64) -> f64 {
        let bins = (low / self.bin_hz).ceil() as usize..(high / self.bin_hz).ceil() as usize;
        self.power[bins].iter().sum()
    }
}
