//! What a project remembers of its window beside the size: the page, the palette, the piece, the point of view.

/// How a window looks at the kit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// The page, by its place among the editor's pages.
    pub page: u8,
    /// Whether the palette is the light one.
    pub light: bool,
    /// The piece that the panels are about, by its place in the kit.
    pub piece: u8,
    /// Turn (rad), height (rad) and distance (m) of the eye.
    pub camera: [f32; 3],
    /// Size of everything, a factor: 1 as designed.
    pub zoom: f32,
}

/// Smallest and largest zoom, factors.
pub const ZOOM: (f32, f32) = (0.75, 3.0);

impl Default for View {
    fn default() -> View {
        View { page: 0, light: false, piece: 1, camera: [-0.14, 0.60, 2.5], zoom: 1.0 }
    }
}

/// A view as it is stored: its fields in their order and units.
pub type Stored = (u8, bool, u8, [f32; 3], f32);

impl View {
    /// The view to store.
    pub fn stored(&self) -> Stored {
        (self.page, self.light, self.piece, self.camera, self.zoom)
    }

    /// A stored view, as far as it can be believed.
    pub fn from_stored((page, light, piece, camera, zoom): Stored) -> View {
        let usual = View::default();
        let camera = if camera.iter().all(|x| x.is_finite()) { camera } else { usual.camera };
        let zoom = if zoom.is_finite() { zoom.clamp(ZOOM.0, ZOOM.1) } else { usual.zoom };
        View { page, light, piece, camera, zoom }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_comes_back_and_a_broken_one_does_no_harm() {
        let view = View { page: 2, light: true, piece: 4, camera: [1.0, 0.5, 2.0], zoom: 2.0 };
        assert_eq!(View::from_stored(view.stored()), view);
        let broken = View::from_stored((9, false, 99, [f32::NAN, 0.0, 0.0], 1e9));
        assert_eq!((broken.camera, broken.zoom), (View::default().camera, ZOOM.1));
    }
}
