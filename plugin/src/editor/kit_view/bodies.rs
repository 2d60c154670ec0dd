//! The pieces as bodies in the world: where each stands, how large it is, what it is made of.
//!
//! Places come from the engine's [`Layout`] and sizes from the specs it builds from: what is seen is what is heard.

use egui::Color32;
use overhear_engine::cymbal::CymbalSpec;
use overhear_engine::drum::DrumSpec;
use overhear_engine::hi_hat::HiHatSpec;
use overhear_engine::layout::{Layout, Placement};
use overhear_engine::piece::PieceId;
use overhear_engine::plate::PlateSpec;

use super::vector::{V3, add, cross, dot, scale, sub, unit};

/// Depth of the kettle of a timpano below its rim, m. *Literature*: bowls of 26 inch ones.
const KETTLE: f32 = 0.46;

/// A piece as it is drawn.
#[derive(Debug, Clone, Copy)]
pub struct Body {
    pub piece: PieceId,
    pub frame: Frame,
    /// Radius of the struck surface, m.
    pub radius: f32,
    pub kind: Kind,
}

/// What kind of thing it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A shell of that depth (m) and colour.
    Drum { depth: f32, shell: Color32 },
    /// A bowl of that depth (m).
    Kettle { depth: f32 },
    /// A plate.
    Cymbal { plate: PlateSpec },
}

/// Where a surface lies and which way it faces.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    /// Middle of the struck surface, m.
    pub centre: V3,
    /// Of the struck side.
    pub normal: V3,
    /// To the drummer's right, in the surface.
    pub right: V3,
    /// Away from the player, in the surface.
    pub away: V3,
}

impl Frame {
    fn of(placement: &Placement) -> Frame {
        let single = |x: [f64; 3]| x.map(|x| x as f32);
        Frame::new(single(placement.centre), single(placement.normal))
    }

    /// A surface at a place with a normal. Angles count from the player's side, which of a disc that faces the
    /// player is below, as in [`Placement::sees`].
    pub fn new(centre: V3, normal: V3) -> Frame {
        let normal = unit(normal);
        let flat = |x: V3| sub(x, scale(normal, dot(x, normal)));
        let back = flat([0.0, 0.0, -1.0]);
        let back = if dot(back, back) > 0.09 { back } else { flat([0.0, -1.0, 0.0]) };
        let back = unit(back);
        Frame { centre, normal, right: cross(back, normal), away: scale(back, -1.0) }
    }

    /// A place from its coordinates in the surface and its height over it, m.
    pub fn at(&self, x: f32, y: f32, z: f32) -> V3 {
        let flat = add(scale(self.right, x), scale(self.away, y));
        add(self.centre, add(flat, scale(self.normal, z)))
    }

    /// A direction from its parts, m.
    pub fn direction(&self, x: f32, y: f32, z: f32) -> V3 {
        add(add(scale(self.right, x), scale(self.away, y)), scale(self.normal, z))
    }
}

impl Body {
    fn of(piece: PieceId, placement: &Placement) -> Body {
        let drum = |spec: DrumSpec| spec.batter.membrane.radius as f32;
        let lacquer = Color32::from_rgb(122, 34, 32);
        let shell = |shell| Kind::Drum { depth: placement.depth as f32, shell };
        let plate = |plate: PlateSpec| (plate.radius() as f32, Kind::Cymbal { plate });
        let (radius, kind) = match piece {
            PieceId::Kick => (drum(DrumSpec::kick()), shell(lacquer)),
            PieceId::Snare => (drum(DrumSpec::snare()), shell(Color32::from_rgb(150, 147, 142))),
            PieceId::RackTom => (drum(DrumSpec::rack_tom()), shell(lacquer)),
            PieceId::FloorTom => (drum(DrumSpec::floor_tom()), shell(lacquer)),
            PieceId::Timpani => (drum(DrumSpec::timpani()), Kind::Kettle { depth: KETTLE }),
            PieceId::Crash => plate(CymbalSpec::crash().shaped().plate),
            PieceId::Ride => plate(CymbalSpec::ride().shaped().plate),
            PieceId::Splash => plate(CymbalSpec::splash().shaped().plate),
            PieceId::HiHat => plate(HiHatSpec::default().shaped().top.plate),
        };
        Body { piece, frame: Frame::of(placement), radius, kind }
    }

    /// The pieces of the kit where they stand by default, in the order of [`PieceId::KIT`].
    pub fn kit() -> [Body; PieceId::KIT.len()] {
        let layout = Layout::default();
        std::array::from_fn(|slot| Body::of(PieceId::KIT[slot], &layout.pieces[slot]))
    }

    /// Height of the surface at rest at a distance from the middle (radii), m. A cymbal's edge lies at the frame, its
    /// bow and bell rise over it.
    pub fn profile(&self, radius: f32) -> f32 {
        let Kind::Cymbal { plate } = self.kind else { return 0.0 };
        // Plates are drawn a little more domed than they are: what is thinner than a point has no shape.
        1.35 * plate.height(f64::from(radius)) as f32
    }

    /// A point of the surface at rest from shares of the radius, with a displacement (m).
    pub fn surface(&self, x: f32, y: f32, displacement: f32) -> V3 {
        self.frame.at(x * self.radius, y * self.radius, self.profile(x.hypot(y)) + displacement)
    }

    /// How tall its motion is drawn at most, m.
    pub fn tallest(&self) -> f32 {
        match self.kind {
            Kind::Cymbal { .. } => 0.26 * self.radius,
            _ => 0.24 * self.radius,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_the_engines() {
        for body in Body::kit() {
            let placement = Placement::of(body.piece);
            for angle in [0.0_f32, 0.8, 2.0, -1.3] {
                let (sin, cos) = angle.sin_cos();
                let seen = placement.sees(&body.frame.at(0.3 * sin, -0.3 * cos, 0.0).map(f64::from));
                assert!(
                    (seen.azimuth as f32 - angle).abs() < 1e-3,
                    "{:?} {angle}: {}",
                    body.piece,
                    seen.azimuth
                );
            }
        }
    }

    #[test]
    fn sizes_are_those_that_sound() {
        let inches = |piece: PieceId| 2.0 * Body::kit()[piece.slot().unwrap()].radius / 0.0254;
        for (piece, diameter) in
            [(PieceId::Kick, 22.0), (PieceId::Snare, 14.0), (PieceId::Ride, 20.0), (PieceId::HiHat, 14.0)]
        {
            assert!((inches(piece) - diameter).abs() < 0.1, "{piece:?}: {}", inches(piece));
        }
    }
}
