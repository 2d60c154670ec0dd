//! What happens, in a plain sentence.

use egui::Color32;
use overhear_engine::piece::PieceId;
use overhear_engine::snapshot::{KitSnapshot, PieceSnapshot};

use super::theme::Palette;
use crate::outputs::title;

/// Landings of snare wires after the latest stroke from which on they are said to answer.
const ANSWERING: u32 = 8;

/// Glide that is worth a word, cents: about what is heard.
const AUDIBLE_CENTS: f32 = 3.0;

/// What is the matter with the kit as a whole, if anything is; and in what colour to say it.
pub fn trouble(
    snapshot: &KitSnapshot,
    late: &Late,
    now: f64,
    palette: &Palette,
) -> Option<(String, Color32)> {
    let quarantines: u32 = snapshot.pieces.iter().map(|piece| piece.quarantines).sum();
    let ready = snapshot.pieces.iter().filter(|piece| piece.ready).count();
    let found = if quarantines > 0 {
        (format!("A piece went out of bounds {quarantines} times and was reset"), palette.over)
    } else if snapshot.clock == 0 {
        ("Waiting for the host to run".to_owned(), palette.faint)
    } else if ready < PieceId::KIT.len() {
        (format!("Building the kit: {ready} of {} pieces", PieceId::KIT.len()), palette.accent)
    } else if late.is_news(now) {
        let late = match snapshot.late_buffers {
            1 => "A buffer was".to_owned(),
            late => format!("{late} buffers were"),
        };
        (format!("{late} late: lower the quality, or add a worker"), palette.over)
    } else if snapshot.missed_runs > 0 {
        let missed = snapshot.missed_runs;
        (format!("Workers left pieces silent for {missed} blocks: use fewer of them"), palette.over)
    } else {
        return None;
    };
    Some(found)
}

/// Buffers that were late, and when there were more of them: what is long ago is not worth a sentence.
#[derive(Debug, Clone, Copy, Default)]
pub struct Late {
    count: Option<u64>,
    /// When the latest was noticed, s of the editor's time.
    seen: Option<f64>,
}

impl Late {
    /// How long it is said, s.
    const NEWS: f64 = 4.0;

    /// Takes in how many there were so far, at the time `now`, s.
    pub fn follow(&mut self, count: u64, now: f64) {
        // Those from before the window was opened are old news.
        if self.count.replace(count).is_some_and(|before| before != count) {
            self.seen = Some(now);
        }
    }

    fn is_news(&self, now: f64) -> bool {
        self.seen.is_some_and(|seen| now - seen < Late::NEWS)
    }
}

/// The stroke that was seen last, and what there was before it.
#[derive(Debug, Clone, Copy)]
pub struct Latest {
    slot: usize,
    /// Landings of the snare's wires when it was seen.
    landings: u32,
}

impl Default for Latest {
    fn default() -> Latest {
        Latest { slot: 1, landings: 0 }
    }
}

impl Latest {
    /// Finds a new stroke in a snapshot, given the one before; of several, the fastest.
    pub fn follow(&mut self, before: &KitSnapshot, now: &KitSnapshot) {
        let counts = before.pieces.iter().zip(&now.pieces).enumerate();
        let fresh = counts.filter(|(_, (before, now))| before.strike.count != now.strike.count);
        if let Some((slot, _)) = fresh.max_by(|a, b| a.1.1.strike.speed.total_cmp(&b.1.1.strike.speed)) {
            *self = Latest { slot, landings: landings(before) };
        }
    }

    /// Slot of its piece.
    pub fn slot(&self) -> usize {
        self.slot
    }

    /// What it did.
    /// `cents` is how far its head's pitch is above its own now.
    pub fn sentence(&self, snapshot: &KitSnapshot, cents: f32) -> String {
        let piece = &snapshot.pieces[self.slot];
        let name = title(PieceId::KIT[self.slot]);
        let stroke = &piece.strike;
        if stroke.count == 0 {
            return format!("{name}: not struck yet. Click a head or a cymbal");
        }
        let mut text = format!(
            "{name} {:.1} m/s at {:.2}: {:.1} ms, {:.0} N",
            stroke.speed,
            stroke.radius,
            1e3 * stroke.contact_time,
            stroke.peak_force
        );
        if stroke.touches > 1 {
            text += &format!(" in {} touches", stroke.touches);
        }
        if cents >= AUDIBLE_CENTS {
            text += &format!("; head stretched, +{cents:.0} cents");
        }
        for said in self.consequences(piece, snapshot) {
            text += "; ";
            text += &said;
        }
        text
    }

    /// What else the stroke set going.
    fn consequences(&self, piece: &PieceSnapshot, snapshot: &KitSnapshot) -> Vec<String> {
        let mut said = Vec::new();
        if piece.rims.landings > 0 {
            said.push(format!("rims met {} times", piece.rims.landings));
        }
        if PieceId::KIT[self.slot] == PieceId::Snare {
            if piece.wires.landings > 0 {
                said.push(format!("wires landed {} times", piece.wires.landings));
            }
        } else if landings(snapshot).saturating_sub(self.landings) > ANSWERING {
            said.push("snare wires answering".to_owned());
        }
        said
    }
}

/// Landings of all snare wires.
fn landings(snapshot: &KitSnapshot) -> u32 {
    snapshot.pieces.iter().map(|piece| piece.wires.landings).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use overhear_engine::snapshot::StrikeSnapshot;

    #[test]
    fn the_sentence_tells_of_the_newest_stroke_and_of_the_wires_since() {
        let before = KitSnapshot::default();
        let mut now = before;
        now.pieces[2].strike = StrikeSnapshot {
            count: 1,
            speed: 4.0,
            radius: 0.35,
            contact_time: 5.8e-3,
            peak_force: 31.0,
            touches: 1,
            ..StrikeSnapshot::default()
        };
        let mut latest = Latest::default();
        latest.follow(&before, &now);
        assert_eq!(latest.sentence(&now, 0.0), "Rack tom 4.0 m/s at 0.35: 5.8 ms, 31 N");
        now.pieces[1].wires.landings = 40;
        latest.follow(&now, &now);
        assert_eq!(
            latest.sentence(&now, 0.0),
            "Rack tom 4.0 m/s at 0.35: 5.8 ms, 31 N; snare wires answering"
        );
        let stretched =
            "Rack tom 4.0 m/s at 0.35: 5.8 ms, 31 N; head stretched, +10 cents; snare wires answering";
        assert_eq!(latest.sentence(&now, 10.2), stretched);
        // A stroke after that, which the wires do not answer.
        let before = now;
        now.pieces[4].strike = StrikeSnapshot { count: 1, ..StrikeSnapshot::default() };
        latest.follow(&before, &now);
        assert!(!latest.sentence(&now, 0.0).contains("wires"));
    }
}
