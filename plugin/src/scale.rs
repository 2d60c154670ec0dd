//! How many pixels of the screen a point of the window has.
//!
//! The screen knows it, or the host tells: before the window is there, while it is, or never. The framework opens a window as
//! if a point were a pixel even when it has been told otherwise, and forgets what it is told too early. So the scale is kept
//! here, and a window is told of it after it has been opened and before it is shown.

use crossbeam::atomic::AtomicCell;

/// Smallest and largest scale that is believed. *By ear*, of sight: no screen has others, and a window beyond is none.
const SANE: (f64, f64) = (0.5, 8.0);

/// Whether a screen can have this scale, a factor.
pub fn is_sane(factor: f64) -> bool {
    (SANE.0..=SANE.1).contains(&factor)
}

/// The scale of an instance's window.
#[derive(Debug, Default)]
pub struct Scale {
    /// What the host says of the window that it opens next.
    told: AtomicCell<Option<f64>>,
    /// What the open window is drawn at: the screen's own scale counts more than the host's.
    drawn: AtomicCell<Option<f64>>,
}

impl Scale {
    /// What the host has told of the window that it opens next, a factor.
    pub fn told(&self) -> Option<f64> {
        self.told.load()
    }

    /// Takes in what the host tells, a factor, or that it has told nothing.
    pub fn tell(&self, factor: Option<f64>) {
        self.told.store(factor.filter(|factor| is_sane(*factor)));
    }

    /// Takes in what the open window is drawn at, a factor, or that there is none.
    pub fn draw(&self, factor: Option<f64>) {
        self.drawn.store(factor);
    }

    /// Pixels to a point of the open window, or of the one that would be opened now: a factor.
    pub fn present(&self) -> f64 {
        self.drawn.load().or_else(|| self.told()).unwrap_or(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_open_window_counts_more_than_what_the_host_says_and_nonsense_counts_for_nothing() {
        let scale = Scale::default();
        assert_eq!(scale.present(), 1.0);
        for nonsense in [0.0, -1.0, 0.1, 100.0, f64::INFINITY, f64::NAN] {
            scale.tell(Some(nonsense));
            assert_eq!((scale.told(), scale.present()), (None, 1.0), "{nonsense}");
        }
        scale.tell(Some(2.0));
        assert_eq!(scale.present(), 2.0);
        scale.draw(Some(1.5));
        assert_eq!((scale.present(), scale.told()), (1.5, Some(2.0)));
        scale.draw(None);
        assert_eq!(scale.present(), 2.0);
    }
}
