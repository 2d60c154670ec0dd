//! What a drum is: its size, heads, shell, hoop, wires, muffling, pitch.

use serde::{Deserialize, Serialize};

use crate::cavity::hole::{Hole, Through};
use crate::cavity::{CavitySpec, HOLES};
use crate::contact::Material;
use crate::damping::{EdgeSpec, LossLaw, Muffler};
use crate::diffraction::Outside;
use crate::drum::lugs::LugsSpec;
use crate::drum::tension_field::{TensionFieldSpec, Unevenness};
use crate::membrane::MembraneSpec;
use crate::membrane::dot::DotSpec;
use crate::membrane::mesh::MeshSpec;
use crate::numbers::{Numbers, Visitor};
use crate::rim::HoopSpec;
use crate::shell::{Cylinder, WallSpec};
use crate::split::Splitting;
use crate::surface::wires::WiresSpec;

mod check;

/// A drum's description.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DrumSpec {
    /// Diameter of its heads, m, 0.15 to 0.82.
    #[serde(rename = "diameter_m")]
    pub diameter: f64,
    /// Pitch to which it is tuned, Hz, within the range.
    pub pitch_hz: f64,
    /// Lowest pitch it can be tuned to while it plays, Hz, 15 to 1000.
    pub lowest_pitch_hz: f64,
    /// Highest, Hz, 1.01 to 4 times the lowest.
    pub highest_pitch_hz: f64,
    /// Which frequency its pitch is.
    pub pitch_of: PitchOf,
    /// The head that is struck.
    pub batter: HeadSpec,
    /// The other one; none of a drum with one head.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resonant: Option<ResonantSpec>,
    /// What the head is stretched over; none for a head on its own, with air on both faces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shell: Option<ShellSpec>,
    /// How the edge that carries the heads yields; none of one that does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub edge: Option<EdgeSpec>,
    /// The hoop that a stick can meet; none where it is out of reach.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hoop: Option<HoopSpec>,
    /// Snare wires against the resonant head, if it has them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wires: Option<WiresSpec>,
    /// What muffles it.
    pub muffler: Muffler,
    /// How uneven its tension is.
    pub evenness: Splitting,
    /// How uneven its heads are where modes crowd; none of heads whose orders do not mix.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tension_field: Option<TensionFieldSpec>,
    /// Where rods pull on its heads, and how evenly; none where that is not described.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lugs: Option<LugsSpec>,
    /// How tips press on its heads.
    pub contact: HeadContact,
    /// Whether it sounds above its heads' complete sets of modes; see [`high_band`](crate::high_band).
    pub high_band: bool,
}

/// Which frequency a drum's pitch is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PitchOf {
    /// The lowest mode, `(0, 1)`, of the batter by itself in air, before the shell couples it: how drummers name what they
    /// tune.
    BatterAlone,
    /// The principal mode, `(1, 1)`, of the whole drum as it is heard: how timpani are tuned.
    PrincipalHeard,
}

/// How a tip presses on a head; see [`patch`](crate::surface::local_compliance).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum HeadContact {
    /// The head wraps itself around a stick's tip, resists being bent, and is tenser where it is dented.
    Wraps,
    /// Every stroke presses on the striker's own disc, whatever its force, and nothing but tension resists it: as published
    /// contacts have it.
    FixedDisc,
}

/// A head of a drum.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeadSpec {
    /// Thickness of the film, m, of all plies together, 0.00003 to 0.002.
    #[serde(rename = "thickness_m")]
    pub thickness: f64,
    /// Films that lie on one another: 1 or 2.
    pub plies: u32,
    /// What the film is made of.
    pub material: Material,
    /// Losses in the film.
    pub loss: LossLaw,
    /// Its own modes up to this enter the drum's, in the middle of the range of pitches, Hz, 100 to 4000.
    pub modes_to_hz: f64,
    /// What is glued to its middle; none of a head without a dot.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dot: Option<DotSpec>,
    /// How it lets air through, if it is woven; none of a tight film.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshSpec>,
}

/// The head that is not struck.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ResonantSpec {
    /// Ratio of its pitch to the batter's, each by itself in air, 0.5 to 2.5.
    pub pitch_ratio: f64,
    /// Thickness of the film, m, 0.00003 to 0.002.
    #[serde(rename = "thickness_m")]
    pub thickness: f64,
    /// Films that lie on one another: 1 or 2.
    pub plies: u32,
    /// What the film is made of.
    pub material: Material,
    /// Losses in the film.
    pub loss: LossLaw,
    /// Its own modes up to this enter the drum's, Hz, 100 to 4000.
    pub modes_to_hz: f64,
    /// Diameter of a hole in it, m, 0.01 to half of the head's; none of a whole head.
    #[serde(default, rename = "port_diameter_m", skip_serializing_if = "Option::is_none")]
    pub port_diameter: Option<f64>,
    /// What is glued to its middle; none of a head without a dot.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dot: Option<DotSpec>,
}

/// What the heads are stretched over.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum ShellSpec {
    /// A cylinder, open where there is no resonant head.
    Cylinder {
        /// Distance from end to end, m, 0.03 to 1.
        #[serde(rename = "depth_m")]
        depth: f64,
        /// Quality factor of the enclosed air's modes: losses at the wall, and through vents that are not described, 1 to 10,000.
        air_q: f64,
        /// Diameter of a hole in the wall half way along, m, 0.002 to 0.05 and no more than half of the depth; none of a tight shell.
        #[serde(default, rename = "vent_diameter_m", skip_serializing_if = "Option::is_none")]
        vent_diameter: Option<f64>,
        /// Its wall, which sounds when the hoop is struck; none of one that does not.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        wall: Option<WallSpec>,
    },
    /// A kettle, closed below.
    Kettle {
        /// Volume of air, m3, 0.001 to 0.5.
        #[serde(rename = "volume_m3")]
        volume: f64,
        /// As of a cylinder.
        air_q: f64,
        /// Diameter of a hole in the bottom, m, 0.002 to 0.05; none of a tight kettle.
        #[serde(default, rename = "vent_diameter_m", skip_serializing_if = "Option::is_none")]
        vent_diameter: Option<f64>,
    },
}

impl HeadSpec {
    /// Shows the numbers of a head so wide, m.
    fn visit_numbers(&mut self, diameter: f64, visitor: &mut dyn Visitor) {
        visitor.number("thickness_m", &mut self.thickness, THICKNESS);
        self.material.visit_part("material", visitor);
        self.loss.visit_part("loss", visitor);
        visitor.number("modes_to_hz", &mut self.modes_to_hz, MODES_TO_HZ);
        if let Some(mesh) = &mut self.mesh {
            mesh.visit_part("mesh", visitor);
        }
        if let Some(dot) = &mut self.dot {
            visitor.enter("dot");
            dot.visit_numbers(diameter, visitor);
            visitor.leave();
        }
    }
}

/// Accepted thickness of films, m, and highest modes of heads, Hz.
const THICKNESS: std::ops::RangeInclusive<f64> = 3e-5..=2e-3;
const MODES_TO_HZ: std::ops::RangeInclusive<f64> = 100.0..=4000.0;

impl Numbers for ShellSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        match self {
            ShellSpec::Cylinder { depth, air_q, vent_diameter, wall } => {
                visitor.number("depth_m", depth, 0.03..=1.0);
                visitor.number("air_q", air_q, 1.0..=10_000.0);
                if let Some(vent) = vent_diameter {
                    let [least, most] = ShellSpec::VENT;
                    visitor.number("vent_diameter_m", vent, least..=most.min(0.5 * *depth));
                }
                if let Some(wall) = wall {
                    wall.visit_part("wall", visitor);
                }
            }
            ShellSpec::Kettle { volume, air_q, vent_diameter } => {
                visitor.number("volume_m3", volume, 1e-3..=0.5);
                visitor.number("air_q", air_q, 1.0..=10_000.0);
                if let Some(vent) = vent_diameter {
                    let [least, most] = ShellSpec::VENT;
                    visitor.number("vent_diameter_m", vent, least..=most);
                }
            }
        }
    }
}

impl Numbers for DrumSpec {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        visitor.number("diameter_m", &mut self.diameter, 0.15..=0.82);
        visitor.number("lowest_pitch_hz", &mut self.lowest_pitch_hz, LOWEST_PITCH_HZ);
        let lowest = self.lowest_pitch_hz;
        visitor.number("highest_pitch_hz", &mut self.highest_pitch_hz, NARROWEST * lowest..=4.0 * lowest);
        visitor.number("pitch_hz", &mut self.pitch_hz, lowest..=self.highest_pitch_hz);
        visitor.enter("batter");
        self.batter.visit_numbers(self.diameter, visitor);
        visitor.leave();
        if let Some(resonant) = &mut self.resonant {
            visitor.enter("resonant");
            visitor.number("pitch_ratio", &mut resonant.pitch_ratio, 0.5..=2.5);
            let mut head = resonant.head();
            head.visit_numbers(self.diameter, visitor);
            let HeadSpec { thickness, plies, material, loss, modes_to_hz, dot, .. } = head;
            *resonant = ResonantSpec { thickness, plies, material, loss, modes_to_hz, dot, ..*resonant };
            if let Some(port) = &mut resonant.port_diameter {
                visitor.number("port_diameter_m", port, 0.01..=0.5 * self.diameter);
            }
            visitor.leave();
        }
        if let Some(shell) = &mut self.shell {
            shell.visit_part("shell", visitor);
        }
        if let Some(edge) = &mut self.edge {
            edge.visit_part("edge", visitor);
        }
        if let Some(hoop) = &mut self.hoop {
            hoop.visit_part("hoop", visitor);
        }
        if let Some(wires) = &mut self.wires {
            wires.visit_part("wires", visitor);
        }
        self.muffler.visit_part("muffler", visitor);
        self.evenness.visit_part("evenness", visitor);
        if let Some(field) = &mut self.tension_field {
            field.visit_part("tension_field", visitor);
        }
        if let Some(lugs) = &mut self.lugs {
            lugs.visit_part("lugs", visitor);
        }
    }
}

impl ShellSpec {
    /// Least and greatest diameter of vents, m.
    const VENT: [f64; 2] = [0.002, 0.05];

    /// Diameter of its vent, m, if it has one.
    pub fn vent_diameter(&self) -> Option<f64> {
        match *self {
            ShellSpec::Cylinder { vent_diameter, .. } | ShellSpec::Kettle { vent_diameter, .. } => {
                vent_diameter
            }
        }
    }

    /// The shell with a vent of that diameter, m, or with none.
    #[must_use]
    pub fn vented(mut self, diameter: Option<f64>) -> ShellSpec {
        match &mut self {
            ShellSpec::Cylinder { vent_diameter, .. } | ShellSpec::Kettle { vent_diameter, .. } => {
                *vent_diameter = diameter;
            }
        }
        self
    }
}

impl ResonantSpec {
    /// The head by itself.
    pub fn head(&self) -> HeadSpec {
        let ResonantSpec { thickness, plies, material, loss, modes_to_hz, dot, .. } = *self;
        HeadSpec { thickness, plies, material, loss, modes_to_hz, dot, mesh: None }
    }
}

impl PitchOf {
    /// Nodal diameters and nodal circles of the mode.
    pub fn mode(self) -> (u32, u32) {
        match self {
            PitchOf::BatterAlone => (0, 1),
            PitchOf::PrincipalHeard => (1, 1),
        }
    }
}

/// Accepted lowest pitches, Hz.
const LOWEST_PITCH_HZ: std::ops::RangeInclusive<f64> = 15.0..=1000.0;

/// Length of a vent's hole where no wall is described, m. *Trade sizes*: plies or a grommet.
const VENT_LENGTH: f64 = 0.006;

/// Highest pitch over the lowest, at least.
const NARROWEST: f64 = 1.01;

impl DrumSpec {
    /// Radius of the heads, m.
    pub fn radius(&self) -> f64 {
        0.5 * self.diameter
    }

    /// Lowest, default and highest pitch, Hz.
    pub fn pitches(&self) -> [f64; 3] {
        [self.lowest_pitch_hz, self.pitch_hz, self.highest_pitch_hz]
    }

    /// Whether its heads are described as unevenly stretched.
    pub fn is_uneven(&self) -> bool {
        self.tension_field.is_some() || self.lugs.is_some()
    }

    /// What stretches its heads unevenly, if anything does.
    pub fn unevenness(&self) -> Option<Unevenness> {
        let field = self.tension_field.filter(|field| field.rms > 0.0);
        let lugs = self.lugs.map(|lugs| (lugs, self.hoop.unwrap_or(HoopSpec::OUT_OF_REACH)));
        (field.is_some() || lugs.is_some()).then_some(Unevenness { field, lugs })
    }

    /// A head as a membrane.
    pub fn membrane(&self, head: &HeadSpec) -> MembraneSpec {
        let HeadSpec { thickness, plies, material, loss, dot, mesh, .. } = *head;
        let (radius, edge) = (self.radius(), self.edge);
        MembraneSpec { radius, thickness, plies, material, loss, edge, dot, mesh }
    }

    /// The enclosed air; none of a head on its own, nor under a mesh, which it passes.
    pub fn cavity(&self) -> Option<CavitySpec> {
        if self.batter.mesh.is_some() {
            return None;
        }
        let radius = self.radius();
        let hole = |diameter: f64, through| Hole { radius: 0.5 * diameter, through };
        Some(match self.shell? {
            ShellSpec::Cylinder { depth, air_q, vent_diameter, wall } => {
                let open = self.resonant.is_none();
                let port = self.resonant.and_then(|resonant| resonant.port_diameter);
                let port = port.map(|diameter| hole(diameter, Through::Head));
                let thickness = wall.map_or(VENT_LENGTH, |wall| wall.thickness);
                let vent = vent_diameter.map(|diameter| hole(diameter, Through::Wall { thickness }));
                let holes = if open { [None; HOLES] } else { [port, vent] };
                CavitySpec { q: air_q, open, holes, ..CavitySpec::cylinder(radius, depth) }
            }
            ShellSpec::Kettle { volume, air_q, vent_diameter } => {
                let depth = volume / (std::f64::consts::PI * radius * radius);
                let vent =
                    vent_diameter.map(|diameter| hole(diameter, Through::Bottom { thickness: VENT_LENGTH }));
                CavitySpec { q: air_q, volume, holes: [None, vent], ..CavitySpec::cylinder(radius, depth) }
            }
        })
    }

    /// What surrounds the drum: it stands free, or its struck head is as in a baffle.
    pub fn outside(&self) -> Outside {
        match self.shell {
            Some(ShellSpec::Cylinder { depth, .. }) => Outside::Free { length: depth },
            Some(ShellSpec::Kettle { .. }) | None => Outside::Baffle,
        }
    }

    /// The wall of the shell, if it sounds.
    pub fn cylinder(&self) -> Option<Cylinder> {
        let Some(ShellSpec::Cylinder { depth, wall: Some(wall), .. }) = self.shell else { return None };
        Some(Cylinder { radius: self.radius(), length: depth, wall })
    }

    /// Length behind the struck head from whose other end sound comes too, m.
    pub fn body_depth(&self) -> f64 {
        match self.outside() {
            Outside::Free { length } => length,
            Outside::Baffle => 0.0,
        }
    }

    /// The drum's batter on its own, with air on both faces: no shell, no other head.
    #[must_use]
    pub fn head_alone(self) -> DrumSpec {
        DrumSpec { resonant: None, shell: None, wires: None, ..self }
    }

    /// The drum without what closes it: a shell without its other head (a concert tom), or a timpani's head without
    /// its kettle.
    #[must_use]
    pub fn opened(self) -> DrumSpec {
        match self.outside() {
            Outside::Baffle => self.head_alone(),
            Outside::Free { .. } => {
                let shell = self.shell.map(|shell| shell.vented(None));
                DrumSpec { resonant: None, shell, wires: None, ..self }
            }
        }
    }
}
