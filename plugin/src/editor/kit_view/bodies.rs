//! The pieces as bodies in the world: where each stands, how large it is, what it is made of, what carries it.
//!
//! All of it follows from the kit's description, which the engine builds from as well: what is seen is what is heard. Names say
//! nothing here; what carries a piece follows from how it hangs.

use std::f32::consts::PI;

use egui::Color32;
use overhear_engine::drum::{DrumSpec, ShellSpec};
use overhear_engine::kit_spec::{InstrumentSpec, KitSpec, PieceSpec};
use overhear_engine::layout::Placement;
use overhear_engine::plate::PlateSpec;
use overhear_engine::surface::rivets::RivetsSpec;

use super::vector::{V3, add, cross, dot, scale, sub, unit};

/// How much of a cylinder of its width and depth a kettle fills. *Fitted*: so a 26 inch one of 0.14 m3 is 0.46 m deep, as
/// bowls of the trade are.
const FULLNESS: f32 = 0.89;

/// A drum lies on its side where its axis rises by less than this, as a share.
const LYING: f32 = 0.5;

/// So near the floor (m) a drum that lies has spurs and a pedal.
const ON_THE_FLOOR: f32 = 0.25;

/// A drum that stands has legs of its own if its lower end is no higher than this, m.
const LEGS: f32 = 0.45;

const LACQUER: Color32 = Color32::from_rgb(122, 34, 32);
const STEEL: Color32 = Color32::from_rgb(150, 147, 142);

/// A piece as it is drawn.
#[derive(Debug, Clone, Copy)]
pub struct Body {
    pub frame: Frame,
    /// Radius of the struck surface, m.
    pub radius: f32,
    pub kind: Kind,
    pub support: Support,
    /// Of a cymbal.
    pub rivets: Option<RivetsSpec>,
}

/// What kind of thing it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A head on its own in its hoop.
    Head,
    /// A shell of that depth (m) and colour, with a head at its other end or open there, and so many lugs if they are counted.
    Drum { depth: f32, shell: Color32, closed: bool, lugs: Option<u32> },
    /// A bowl of that depth (m).
    Kettle { depth: f32 },
    /// A plate.
    Cymbal { plate: PlateSpec },
    /// Two plates; the upper one is struck.
    HiHat { top: PlateSpec, bottom: PlateSpec },
    /// Two plates, the upper one on the lower one; the upper one is struck.
    Stack { top: PlateSpec, bottom: PlateSpec },
}

/// What carries it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Support {
    /// It lies on the floor, on spurs, and is played by a pedal.
    Spurs,
    /// An arm on a post.
    Arm,
    /// Arms from below on a tripod.
    Basket,
    /// So many legs of its own.
    Legs(usize),
    /// A cymbal stand.
    Stand,
    /// A stand with a rod and a pedal.
    HatStand,
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

    /// The way along the floor that the struck side faces; toward the player if it faces straight up.
    pub fn ahead(&self) -> V3 {
        let [x, _, z] = self.normal;
        if x.hypot(z) > 0.1 { unit([x, 0.0, z]) } else { [0.0, 0.0, -1.0] }
    }

    /// A direction from its parts, m.
    pub fn direction(&self, x: f32, y: f32, z: f32) -> V3 {
        add(add(scale(self.right, x), scale(self.away, y)), scale(self.normal, z))
    }
}

impl Kind {
    fn of(piece: &PieceSpec) -> Kind {
        match &piece.instrument {
            InstrumentSpec::Drum(drum) => Kind::of_drum(drum, piece.place.centre[1] as f32),
            InstrumentSpec::Cymbal(cymbal) => Kind::Cymbal { plate: cymbal.plate() },
            InstrumentSpec::HiHat(hat) => {
                let (top, bottom) = (hat.top.plate(), hat.bottom.plate());
                if hat.pressed.is_some() { Kind::Stack { top, bottom } } else { Kind::HiHat { top, bottom } }
            }
        }
    }

    /// A drum whose head is at a height over the floor, m.
    fn of_drum(drum: &DrumSpec, height: f32) -> Kind {
        match drum.shell {
            None => Kind::Head,
            Some(ShellSpec::Cylinder { depth, .. }) => {
                // Those with wires are mostly seen in metal.
                let shell = if drum.wires.is_some() { STEEL } else { LACQUER };
                let lugs = drum.lugs.map(|lugs| lugs.count);
                Kind::Drum { depth: depth as f32, shell, closed: drum.resonant.is_some(), lugs }
            }
            Some(ShellSpec::Kettle { volume, .. }) => {
                let depth = volume as f32 / (FULLNESS * PI * (drum.radius() as f32).powi(2));
                // None reaches into the floor, whatever air it is said to hold.
                Kind::Kettle { depth: depth.min(height.max(0.1)) }
            }
        }
    }

    /// Depth of what is behind the struck surface, m.
    pub fn depth(&self) -> f32 {
        match *self {
            Kind::Drum { depth, .. } | Kind::Kettle { depth } => depth,
            Kind::Head | Kind::Cymbal { .. } | Kind::HiHat { .. } | Kind::Stack { .. } => 0.0,
        }
    }
}

impl Support {
    /// What carries a piece of that kind and radius (m), with or without wires, where it is.
    fn of(kind: &Kind, frame: &Frame, radius: f32, wires: bool) -> Support {
        let rise = frame.normal[1].clamp(-1.0, 1.0);
        let lowest = frame.centre[1] - kind.depth() * rise.max(0.0) - radius * (1.0 - rise * rise).sqrt();
        match kind {
            Kind::Cymbal { .. } | Kind::Stack { .. } => Support::Stand,
            Kind::HiHat { .. } => Support::HatStand,
            Kind::Kettle { .. } => Support::Legs(4),
            Kind::Head => Support::Basket,
            Kind::Drum { .. } if rise.abs() < LYING && lowest < ON_THE_FLOOR => Support::Spurs,
            Kind::Drum { .. } if wires => Support::Basket,
            Kind::Drum { .. } if lowest < LEGS => Support::Legs(3),
            Kind::Drum { .. } => Support::Arm,
        }
    }
}

impl Body {
    /// A piece where it stands.
    pub fn of(piece: &PieceSpec) -> Body {
        let (frame, kind) = (Frame::of(&piece.placement()), Kind::of(piece));
        let radius = piece.instrument.radius() as f32;
        let wires = piece.drum().is_some_and(|drum| drum.wires.is_some());
        let rivets = match &piece.instrument {
            InstrumentSpec::Cymbal(cymbal) => cymbal.rivets,
            _ => None,
        };
        Body { frame, radius, kind, support: Support::of(&kind, &frame, radius, wires), rivets }
    }

    /// The pieces of a kit where they stand, in the order of their slots.
    pub fn all(kit: &KitSpec) -> Vec<Body> {
        kit.pieces.iter().map(Body::of).collect()
    }

    /// The struck plate, if it is one.
    pub fn plate(&self) -> Option<&PlateSpec> {
        match &self.kind {
            Kind::Cymbal { plate } | Kind::HiHat { top: plate, .. } | Kind::Stack { top: plate, .. } => {
                Some(plate)
            }
            Kind::Head | Kind::Drum { .. } | Kind::Kettle { .. } => None,
        }
    }

    /// Whether a pedal's beater strikes it.
    pub fn has_beater(&self) -> bool {
        self.support == Support::Spurs
    }

    /// Height of the surface at rest at a distance from the middle (radii), m. A cymbal's edge lies at the frame, its
    /// bow and bell rise over it.
    pub fn profile(&self, radius: f32) -> f32 {
        let Some(plate) = self.plate() else { return 0.0 };
        // Plates are drawn a little more domed than they are: what is thinner than a point has no shape.
        1.35 * plate.height(f64::from(radius)) as f32
    }

    /// A point of the surface at rest from shares of the radius, with a displacement (m).
    pub fn surface(&self, x: f32, y: f32, displacement: f32) -> V3 {
        self.frame.at(x * self.radius, y * self.radius, self.profile(x.hypot(y)) + displacement)
    }

    /// How tall its motion is drawn at most, m.
    pub fn tallest(&self) -> f32 {
        if self.plate().is_some() { 0.26 * self.radius } else { 0.24 * self.radius }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_the_engines() {
        let kit = KitSpec::standard();
        for (piece, body) in kit.pieces.iter().zip(Body::all(&kit)) {
            for angle in [0.0_f32, 0.8, 2.0, -1.3] {
                let (sin, cos) = angle.sin_cos();
                let seen = piece.placement().sees(&body.frame.at(0.3 * sin, -0.3 * cos, 0.0).map(f64::from));
                assert!(
                    (seen.azimuth as f32 - angle).abs() < 1e-3,
                    "{} {angle}: {}",
                    piece.name,
                    seen.azimuth
                );
            }
        }
    }

    #[test]
    fn sizes_and_shapes_are_those_that_sound() {
        let mut kit = KitSpec::standard();
        let InstrumentSpec::Drum(drum) = &mut kit.pieces[0].instrument else { panic!("no drum") };
        (drum.diameter, drum.shell) =
            (0.508, Some(ShellSpec::Cylinder { depth: 0.4, air_q: 60.0, vent_diameter: None, wall: None }));
        let InstrumentSpec::Cymbal(crash) = &mut kit.pieces[4].instrument else { panic!("no cymbal") };
        (crash.diameter, crash.bell) = (0.457, None);
        let bodies = Body::all(&kit);
        assert_eq!((bodies[0].radius, bodies[0].kind.depth()), (0.254, 0.4));
        assert_eq!(bodies[4].radius, 0.2285);
        assert!((bodies[4].profile(0.0) - 1.35 * crash_bow(&kit)).abs() < 1e-6, "no bell");
        let Kind::HiHat { top, bottom } = bodies[8].kind else { panic!("no hats") };
        assert!(bottom.mass > top.mass);
    }

    fn crash_bow(kit: &KitSpec) -> f32 {
        let InstrumentSpec::Cymbal(crash) = &kit.pieces[4].instrument else { panic!("no cymbal") };
        crash.bow as f32
    }

    #[test]
    fn what_carries_a_piece_follows_from_how_it_hangs() {
        let supports: Vec<_> = Body::all(&KitSpec::standard()).iter().map(|body| body.support).collect();
        let wanted = [
            Support::Spurs,
            Support::Basket,
            Support::Arm,
            Support::Legs(3),
            Support::Stand,
            Support::Stand,
            Support::Stand,
            Support::Legs(4),
            Support::HatStand,
        ];
        assert_eq!(supports, wanted);
        // A rack tom lowered to the floor stands on legs, a kick hung up hangs on an arm.
        let mut kit = KitSpec::standard();
        kit.pieces[2].place.centre[1] = 0.5;
        kit.pieces[0].place.centre[1] = 1.2;
        let bodies = Body::all(&kit);
        assert_eq!((bodies[2].support, bodies[0].support), (Support::Legs(3), Support::Arm));
    }

    #[test]
    fn a_standard_kettle_is_as_deep_as_bowls_of_the_trade_and_none_reaches_into_the_floor() {
        let mut kit = KitSpec::standard();
        let depth = |kit: &KitSpec| Body::all(kit)[7].kind.depth();
        assert!((depth(&kit) - 0.46).abs() < 0.005, "{}", depth(&kit));
        let InstrumentSpec::Drum(drum) = &mut kit.pieces[7].instrument else { panic!("no drum") };
        drum.shell = Some(ShellSpec::Kettle { volume: 0.5, air_q: 60.0, vent_diameter: None });
        assert!(depth(&kit) <= 0.78);
    }
}
