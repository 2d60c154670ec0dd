//! The two kinds of instrument: one stereo output, or one more for each slot and each pair of microphones.
//!
//! All outputs that a host uses together are the mix: what has an output of its own is not at the main one, which has the
//! rest. So a host that sums all outputs plays the mix once, and one that uses the main output alone plays it too.

use std::num::NonZeroU32;

use nice_plug::prelude::*;
use overhear_engine::kit::{OUTPUTS, Stereo};
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::slot::Slot;

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
    const NAME: &'static str = overhear_player::NAME;
    const CLAP_ID: &'static str = overhear_player::CLAP_ID;
    const VST3_ID: [u8; 16] = *b"OverhearDrumKit1";
    const ABOUT: &'static str = "A physically modelled drum kit";
    const LAYOUT: AudioIOLayout =
        AudioIOLayout { main_output_channels: NonZeroU32::new(2), ..AudioIOLayout::const_default() };
}

/// A stereo output for every slot and each pair of microphones, and the main one for what a host does not take there.
pub struct Apart;

impl Outputs for Apart {
    const NAME: &'static str = overhear_player::MULTI_NAME;
    const CLAP_ID: &'static str = overhear_player::MULTI_CLAP_ID;
    const VST3_ID: [u8; 16] = *b"OverhearDrumKitM";
    const ABOUT: &'static str = "A physically modelled drum kit with an output for every piece";
    const LAYOUT: AudioIOLayout = AudioIOLayout {
        main_output_channels: NonZeroU32::new(2),
        aux_output_ports: &[new_nonzero_u32(2); OUTPUTS],
        names: PortNames { aux_outputs: &TITLES, ..PortNames::const_default() },
        ..AudioIOLayout::const_default()
    };
}

/// Names of the outputs as the framework has them, before there is an instance: those of the standard kit's pieces, and of the
/// slots behind these. Hosts are told [those of the kit](title).
const TITLES: [&str; OUTPUTS] = [
    "Kick",
    "Snare",
    "Rack tom",
    "Floor tom",
    "Crash",
    "Ride",
    "Splash",
    "Timpani",
    "Hi-hat",
    "Slot 10",
    "Slot 11",
    "Slot 12",
    "Slot 13",
    "Slot 14",
    "Slot 15",
    "Slot 16",
    "Overheads",
    "Room",
];

/// What an output beside the main one is called with a kit: as the piece in its slot.
pub fn title(place: usize, kit: &KitSpec) -> Option<String> {
    match Slot::new(place) {
        Some(slot) => {
            Some(kit.piece(slot).map_or_else(|| format!("Slot {}", place + 1), |piece| piece.title.clone()))
        }
        None => TITLES.get(place).map(|title| (*title).to_owned()),
    }
}

/// Which outputs beside the main one a host uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Used(pub u32);

impl Used {
    /// All of them.
    pub const ALL: Used = Used(u32::MAX);

    /// None of them.
    pub const NONE: Used = Used(0);

    /// With another one, by its place behind the main one.
    #[must_use]
    pub fn with(self, place: usize) -> Used {
        Used(self.0 | (1 << place.min(31)))
    }

    /// Whether one is used, by its place behind the main one.
    pub fn has(self, place: usize) -> bool {
        self.0 & (1 << place.min(31)) != 0
    }
}

/// The buffers of one slice: the main output, and those of the other outputs, empty where there is none.
pub struct Buffers<'a> {
    main: Stereo<'a>,
    others: [Stereo<'a>; OUTPUTS],
}

impl<'a> Buffers<'a> {
    /// The buffers that the framework hands over, full scale 1; `None` if the mix is not stereo. Outputs that the host does
    /// not use, and that a guard has completed, are none.
    ///
    /// # Real-time
    /// No allocation.
    pub fn new(main: &'a mut [&mut [f32]], apart: &'a mut [Buffer<'_>], used: Used) -> Option<Buffers<'a>> {
        let mut others: [Stereo<'a>; OUTPUTS] = std::array::from_fn(|_| Stereo::default());
        for (at, (other, buffer)) in others.iter_mut().zip(apart).enumerate() {
            if let ([left, right], true) = (buffer.as_slice(), used.has(at)) {
                *other = [left, right];
            }
        }
        match main {
            [left, right] => Some(Buffers { main: [left, right], others }),
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
    pub fn stretch(&mut self, from: usize, to: usize) -> (Stereo<'_>, [Stereo<'_>; OUTPUTS]) {
        (cut(&mut self.main, from, to), self.others.each_mut().map(|pair| cut(pair, from, to)))
    }

    /// Every channel there is, full scale 1.
    pub fn channels(&mut self) -> impl Iterator<Item = &mut [f32]> {
        self.main.iter_mut().chain(self.others.iter_mut().flatten()).map(|channel| &mut **channel)
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

#[cfg(test)]
mod tests {
    use super::*;
    use overhear_engine::slot::SLOTS;
    use overhear_player::parameters::SlotParameter::Level;
    use overhear_player::parameters::{parameters, slot_index};

    #[test]
    fn outputs_are_called_as_the_standard_kit_s_parameters_are() {
        let groups = Slot::ALL.map(|slot| parameters()[slot_index(slot, Level)].group);
        assert_eq!(TITLES[..SLOTS], groups);
        let kit = KitSpec::standard();
        for (place, of_framework) in TITLES.into_iter().enumerate() {
            assert_eq!(title(place, &kit).as_deref(), Some(of_framework));
        }
        assert_eq!(title(OUTPUTS, &kit), None);
    }
}
