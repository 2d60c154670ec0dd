//! How loud each piece is at each microphone, of one stroke at full velocity.

use anyhow::Result;
use overhear::midi_map;
use overhear_engine::kit::{OUTPUTS, Stereo};
use overhear_engine::piece::PieceId;

use crate::player::{EnginePlayer, Hit, Setup};
use crate::stage::Stage;

/// Peaks of one piece, full scale 1, before the master.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Which.
    pub piece: PieceId,
    /// At its close microphone, the overheads and the room.
    pub peaks: [f32; 3],
}

/// Strikes every piece that General MIDI knows by itself and listens for a second.
///
/// # Errors
/// If the engine cannot be built at the sample rate (Hz).
pub fn table(rate: u32) -> Result<Vec<Row>> {
    let mut player = EnginePlayer::new(&Setup { rate, settings: Vec::new(), stage: Stage::default() })?;
    let frames = rate as usize;
    let mut buffers = vec![[vec![0.0_f32; frames], vec![0.0_f32; frames]]; OUTPUTS + 1];
    let mut rows = Vec::new();
    for (slot, piece) in PieceId::KIT.into_iter().enumerate() {
        let strikes = |&key: &u8| midi_map::stroke(key).is_some_and(|stroke| stroke.piece == piece);
        let Some(key) = (0..128).find(strikes) else { continue };
        player.performer.reset();
        let hit = Hit { sample: 0, channel: 9, key, velocity: 127 };
        player.play(&[hit], frames, |performer, part| {
            let mut outputs: Vec<Stereo<'_>> =
                buffers.iter_mut().map(|pair| pair.each_mut().map(|side| &mut side[part.clone()])).collect();
            let (main, microphones) = outputs.split_at_mut(1);
            performer.render_outputs(main[0].each_mut().map(|side| &mut **side), microphones);
        });
        let pieces = PieceId::KIT.len();
        let peaks = [slot, pieces, pieces + 1].map(|output| {
            let pair = &buffers[1 + output];
            pair.iter().flatten().fold(0.0_f32, |peak, x| peak.max(x.abs()))
        });
        rows.push(Row { piece, peaks });
    }
    Ok(rows)
}
