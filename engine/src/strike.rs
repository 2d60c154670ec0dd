//! What a hit is: how fast, where, with what.

/// One stroke on one piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strike {
    /// Speed of the tip at first touch, m/s, above 0 to [`Strike::MAX_SPEED`].
    pub speed: f64,
    /// Distance from the centre as a share of the radius, 0 to 1.
    pub radius: f64,
    /// Direction of the place seen from the centre, rad; 0 is toward the player.
    pub angle: f64,
    /// What is swung.
    pub striker: Striker,
}

impl Strike {
    /// Fastest stroke accepted, m/s; faster ones are clamped.
    pub const MAX_SPEED: f64 = 25.0;
}

/// What a drummer holds (or stands on).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Striker {
    /// The bead of a hickory stick.
    Stick,
    /// The shoulder of a hickory stick, laid across an edge.
    Shoulder,
    /// A nylon-tipped stick.
    Nylon,
    /// A bass drum beater with a felt head.
    FeltBeater,
    /// A bass drum beater with a plastic head.
    PlasticBeater,
    /// A soft timpani mallet.
    TimpaniMallet,
    /// A hard felt mallet.
    HardMallet,
    /// A yarn-wound mallet.
    YarnMallet,
}

impl Striker {
    /// Every striker, in the order of the manual.
    pub const ALL: [Striker; 8] = [
        Striker::Stick,
        Striker::Shoulder,
        Striker::Nylon,
        Striker::FeltBeater,
        Striker::PlasticBeater,
        Striker::TimpaniMallet,
        Striker::HardMallet,
        Striker::YarnMallet,
    ];

    /// The name used on command lines and in presets.
    pub fn name(self) -> &'static str {
        match self {
            Striker::Stick => "stick",
            Striker::Shoulder => "shoulder",
            Striker::Nylon => "nylon",
            Striker::FeltBeater => "felt-beater",
            Striker::PlasticBeater => "plastic-beater",
            Striker::TimpaniMallet => "timpani-mallet",
            Striker::HardMallet => "hard-mallet",
            Striker::YarnMallet => "yarn-mallet",
        }
    }

    /// The striker of that [`name`](Self::name), if there is one.
    pub fn from_name(name: &str) -> Option<Striker> {
        Striker::ALL.into_iter().find(|striker| striker.name() == name)
    }
}
