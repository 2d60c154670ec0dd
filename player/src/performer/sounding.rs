//! The end of everything that sounds.

use std::slice::SliceIndex;

use overhear_engine::kit::{OUTPUTS, Stereo};

/// How long everything takes to fall silent, s. *By ear*: no click, and over before the next stroke of a roll.
const FADE: f64 = 0.01;

/// The fade of everything that sounds.
#[derive(Debug, Clone, Copy)]
pub(super) struct Silencing {
    /// Samples of a whole fade.
    length: usize,
    /// Samples to go; nothing where no fade runs.
    rest: usize,
}

impl Silencing {
    /// No fade, at a sample rate, Hz.
    pub(super) fn new(sample_rate: f64) -> Silencing {
        Silencing { length: ((FADE * sample_rate) as usize).max(1), rest: 0 }
    }

    /// Starts a fade, unless one runs.
    pub(super) fn begin(&mut self) {
        if self.rest == 0 {
            self.rest = self.length;
        }
    }

    /// Ends a fade and says whether one ran.
    pub(super) fn end(&mut self) -> bool {
        std::mem::take(&mut self.rest) > 0
    }

    /// Whether a fade runs.
    pub(super) fn is_running(&self) -> bool {
        self.rest > 0
    }

    /// Lets `render` write what is still heard of a buffer, fades it, and says how many samples it is.
    ///
    /// # Real-time
    /// No allocation, no lock.
    pub(super) fn head(
        &mut self,
        main: &mut Stereo<'_>,
        outputs: &mut [Stereo<'_>],
        render: impl FnOnce(Stereo<'_>, &mut [Stereo<'_>]),
    ) -> usize {
        let fading = self.rest.min(main[0].len()).min(main[1].len());
        if fading == 0 {
            return 0;
        }
        let count = outputs.len().min(OUTPUTS);
        let mut heads = parts(outputs, ..fading);
        render(main.each_mut().map(|side| &mut side[..fading]), &mut heads[..count]);
        let sides = main.iter_mut().map(|side| &mut side[..fading]);
        for side in sides.chain(heads.into_iter().flatten()) {
            self.fade(side);
        }
        self.rest -= fading;
        fading
    }

    /// Fades samples that come next.
    fn fade(&self, samples: &mut [f32]) {
        for (sample, rest) in samples.iter_mut().zip((0..self.rest).rev()) {
            *sample *= rest as f32 / self.length as f32;
        }
    }
}

/// Lets `render` write what comes behind the first `skipped` samples of a buffer.
///
/// # Real-time
/// No allocation, no lock.
pub(super) fn tail(
    skipped: usize,
    main: Stereo<'_>,
    outputs: &mut [Stereo<'_>],
    render: impl FnOnce(Stereo<'_>, &mut [Stereo<'_>]),
) {
    if skipped == 0 {
        render(main, outputs);
    } else if skipped < main[0].len().min(main[1].len()) {
        let count = outputs.len().min(OUTPUTS);
        let mut tails = parts(outputs, skipped..);
        render(main.map(|side| &mut side[skipped..]), &mut tails[..count]);
    }
}

/// A part of each output, empty where it has none.
pub(super) fn parts<'a>(
    outputs: &'a mut [Stereo<'_>],
    part: impl SliceIndex<[f32], Output = [f32]> + Clone,
) -> [Stereo<'a>; OUTPUTS] {
    let mut parts: [Stereo<'a>; OUTPUTS] = std::array::from_fn(|_| Stereo::default());
    for (to, output) in parts.iter_mut().zip(outputs) {
        *to = output.each_mut().map(|side| side.get_mut(part.clone()).unwrap_or_default());
    }
    parts
}
