//! Live controls of a kit.

use crate::slot::Slot;

/// A microphone, or a pair of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Microphone {
    /// The one close to a piece.
    Close(Slot),
    /// The pair above the kit.
    Overheads,
    /// The pair in the room.
    Room,
}

/// A live control of the kit. Acts from the next sample on, smoothed. Switches are on from one half up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// Pitch of a drum, Hz, or of a cymbal, ratio; see [`Piece::tunings`](crate::piece::Piece::tunings).
    Tuning(Slot),
    /// Muffling of a piece, 0 to 1.
    Muffling(Slot),
    /// Preload of a drum's snare wires, N; no effect on other pieces.
    Preload(Slot),
    /// Whether a drum's snare wires lie against its head: below one half they are off.
    Wires(Slot),
    /// A hi-hat's pedal, 0 (up) to 1 (down); see [`Piece::press_pedal`](crate::piece::Piece::press_pedal).
    Pedal(Slot),
    /// Level of a piece in every microphone, dB; at or below [`SILENT_DB`](crate::kit::SILENT_DB) the piece is silent.
    /// Its sound at other pieces does not change.
    Level(Slot),
    /// Pan of a piece's close microphone, -1 (left) to 1 (right); see
    /// [`Placement::side`](crate::layout::Placement::side). Of a pair, see [`Balance`](Self::Balance).
    Pan(Slot),
    /// Balance of a pair of microphones, -1 (left alone) to 1 (right alone); of a close one, its pan.
    Balance(Microphone),
    /// Level of a microphone or a pair, dB.
    MicrophoneLevel(Microphone),
    /// Level of all close microphones, dB.
    CloseLevel,
    /// Switch: the microphone is silent.
    Mute(Microphone),
    /// Switch: if any microphone has it, all others are silent.
    Solo(Microphone),
    /// Switch: sympathetic resonance of the drums.
    SympatheticCoupling,
    /// Share of the other pieces' sound that reaches the drums, 0 to 1.
    Sympathy,
    /// Switch: the outputs bend softly instead of passing full scale.
    SafetyClip,
    /// Level of the whole mix, dB.
    Master,
}
