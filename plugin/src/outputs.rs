//! The two kinds of instrument: one stereo output, or one more for each piece.

use std::num::NonZeroU32;

use nice_plug::prelude::*;
use overhear_engine::kit::Stereo;
use overhear_engine::piece::PieceId;

/// Pieces of the kit.
const PIECES: usize = PieceId::KIT.len();

/// What tells one kind of instrument from the other.
pub trait Outputs: Send + 'static {
    /// Name in hosts.
    const NAME: &'static str;
    /// Id in CLAP hosts. Frozen: projects find the plugin by it.
    const CLAP_ID: &'static str;
    /// Id in VST3 hosts. Frozen as well.
    const VST3_ID: [u8; 16];
    /// What it is, in a line.
    const ABOUT: &'static str;
    /// Its outputs, the main one first.
    const LAYOUT: AudioIOLayout;
}

/// One stereo output.
pub struct Mix;

impl Outputs for Mix {
    const NAME: &'static str = crate::NAME;
    const CLAP_ID: &'static str = crate::CLAP_ID;
    const VST3_ID: [u8; 16] = *b"OverhearDrumKit1";
    const ABOUT: &'static str = "A physically modelled drum kit";
    const LAYOUT: AudioIOLayout =
        AudioIOLayout { main_output_channels: NonZeroU32::new(2), ..AudioIOLayout::const_default() };
}

/// The mix and a stereo output for every piece.
pub struct Apart;

impl Outputs for Apart {
    const NAME: &'static str = crate::MULTI_NAME;
    const CLAP_ID: &'static str = crate::MULTI_CLAP_ID;
    const VST3_ID: [u8; 16] = *b"OverhearDrumKitM";
    const ABOUT: &'static str = "A physically modelled drum kit with an output for every piece";
    const LAYOUT: AudioIOLayout = AudioIOLayout {
        main_output_channels: NonZeroU32::new(2),
        aux_output_ports: &[new_nonzero_u32(2); PIECES],
        names: PortNames { aux_outputs: &TITLES, ..PortNames::const_default() },
        ..AudioIOLayout::const_default()
    };
}

/// Names of the pieces on screen and of their outputs, in the order of [`PieceId::KIT`].
const TITLES: [&str; PIECES] = {
    let mut titles = [""; PIECES];
    let mut slot = 0;
    while slot < PIECES {
        titles[slot] = title(PieceId::KIT[slot]);
        slot += 1;
    }
    titles
};

/// A piece's name on screen, which is also its parameters' group.
pub const fn title(piece: PieceId) -> &'static str {
    match piece {
        PieceId::Kick => "Kick",
        PieceId::Snare => "Snare",
        PieceId::RackTom => "Rack tom",
        PieceId::FloorTom => "Floor tom",
        PieceId::Crash => "Crash",
        PieceId::Ride => "Ride",
        PieceId::Splash => "Splash",
        PieceId::Timpani => "Timpani",
        PieceId::HiHat => "Hi-hat",
    }
}

/// The buffers of one slice: the mix, and each piece's, empty where there is none.
pub struct Buffers<'a> {
    main: Stereo<'a>,
    pieces: [Stereo<'a>; PIECES],
}

impl<'a> Buffers<'a> {
    /// The buffers that the framework hands over, full scale 1; `None` if the mix is not stereo.
    ///
    /// # Real-time
    /// No allocation.
    pub fn new(main: &'a mut [&mut [f32]], apart: &'a mut [Buffer<'_>]) -> Option<Buffers<'a>> {
        let mut pieces: [Stereo<'a>; PIECES] = std::array::from_fn(|_| Stereo::default());
        for (piece, buffer) in pieces.iter_mut().zip(apart) {
            if let [left, right] = buffer.as_slice() {
                *piece = [left, right];
            }
        }
        match main {
            [left, right] => Some(Buffers { main: [left, right], pieces }),
            _ => None,
        }
    }

    /// Samples of the slice.
    pub fn len(&self) -> usize {
        let [left, right] = &self.main;
        left.len().min(right.len())
    }

    /// Whether the slice has no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A stretch of the slice, for the kit.
    ///
    /// # Real-time
    /// No allocation.
    pub fn stretch(&mut self, from: usize, to: usize) -> (Stereo<'_>, [Stereo<'_>; PIECES]) {
        (cut(&mut self.main, from, to), self.pieces.each_mut().map(|pair| cut(pair, from, to)))
    }

    /// Every channel there is, full scale 1.
    pub fn channels(&mut self) -> impl Iterator<Item = &mut [f32]> {
        self.main.iter_mut().chain(self.pieces.iter_mut().flatten()).map(|channel| &mut **channel)
    }

    /// Silence on every output.
    pub fn silence(&mut self) {
        self.channels().for_each(|channel| channel.fill(0.0));
    }
}

/// A stretch of a pair; empty if the pair is.
fn cut<'b>(pair: &'b mut Stereo<'_>, from: usize, to: usize) -> Stereo<'b> {
    pair.each_mut().map(|channel| channel.get_mut(from..to).unwrap_or_default())
}
