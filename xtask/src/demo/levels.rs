//! Level of each piece at each microphone for one stroke at full velocity.

use anyhow::Result;
use overhear::kit_document::KitDocument;
use overhear_engine::kit::{OUTPUTS, Stereo};
use overhear_engine::slot::SLOTS;

use overhear_cli::player::{EnginePlayer, Message, Setup};

/// Peaks of one piece, full scale 1, before the master.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Name of the piece.
    pub piece: String,
    /// At its close microphone, the overheads and the room.
    pub peaks: [f32; 3],
}

/// Strikes every piece that a note of the standard kit strikes, by itself, with the lowest of its notes, and listens for a
/// second.
///
/// # Errors
/// If the engine cannot be built at the sample rate (Hz).
pub fn table(rate: u32) -> Result<Vec<Row>> {
    let setup = Setup { rate, kit: KitDocument::standard(), settings: Vec::new() };
    let mut player = EnginePlayer::new(&setup)?;
    let frames = rate as usize;
    let mut buffers = vec![[vec![0.0_f32; frames], vec![0.0_f32; frames]]; OUTPUTS + 1];
    let mut rows = Vec::new();
    let KitDocument { kit, notes } = &setup.kit;
    for (slot, piece) in kit.slots() {
        let strikes = |&key: &u8| notes.stroke(key).is_some_and(|stroke| stroke.slot == slot);
        let Some(key) = (0..128).find(strikes) else { continue };
        player.performer.reset();
        let hit = Message::note(0, 9, key, 127);
        player.play(&[hit], frames, |performer, part| {
            let mut outputs: Vec<Stereo<'_>> =
                buffers.iter_mut().map(|pair| pair.each_mut().map(|side| &mut side[part.clone()])).collect();
            let (main, microphones) = outputs.split_at_mut(1);
            performer.render_outputs(main[0].each_mut().map(|side| &mut **side), microphones);
        });
        let peaks = [slot.index(), SLOTS, SLOTS + 1].map(|output| {
            let pair = &buffers[1 + output];
            pair.iter().flatten().fold(0.0_f32, |peak, x| peak.max(x.abs()))
        });
        rows.push(Row { piece: piece.name.clone(), peaks });
    }
    Ok(rows)
}
