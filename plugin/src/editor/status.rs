//! What happens, in a plain sentence.

use egui::Color32;
use overhear_engine::kit_spec::KitSpec;
use overhear_engine::piece::SAMPLE_RATES;
use overhear_engine::slot::Slot;
use overhear_engine::snapshot::{KitSnapshot, PieceSnapshot};
use overhear_player::decimation::LOWEST_RATE;

use super::theme::Palette;

/// Landings of snare wires after the latest stroke from which on they are said to answer.
const ANSWERING: u32 = 8;

/// Glide that is worth a word, cents: about what is heard.
const AUDIBLE_CENTS: f32 = 3.0;

/// What is the matter with the kit as a whole, if anything is; and in what colour to say it. News are those of late buffers
/// and of the ceiling.
pub fn trouble(
    snapshot: &KitSnapshot,
    kit: &KitSpec,
    [late, limited]: [&News; 2],
    now: f64,
    palette: &Palette,
) -> Option<(String, Color32)> {
    let quarantines: u32 = snapshot.pieces.iter().map(|piece| piece.quarantines).sum();
    let pieces = kit.pieces.len();
    let ready = snapshot.pieces.iter().take(pieces).filter(|piece| piece.ready).count();
    let found = if quarantines > 0 {
        (format!("A piece became unstable {quarantines} times and was reset"), palette.over)
    } else if snapshot.clock == 0 {
        ("Waiting for the host to start processing".to_owned(), palette.faint)
    } else if ready < pieces {
        (format!("Building the kit: {ready} of {pieces} pieces"), palette.accent)
    } else if limited.is_news(now) {
        ("Too loud: held below 12 dB above full scale to protect your ears".to_owned(), palette.over)
    } else if late.is_news(now) {
        let dropouts = match snapshot.late_buffers {
            1 => "1 buffer".to_owned(),
            late => format!("{late} buffers"),
        };
        let advice = "lower the quality, or add a render thread";
        (format!("Audio dropouts: {dropouts} took too long; {advice}"), palette.over)
    } else if snapshot.missed_runs > 0 {
        let missed = snapshot.missed_runs;
        (format!("Render threads left pieces silent for {missed} blocks: use fewer of them"), palette.over)
    } else {
        return None;
    };
    Some(found)
}

/// That a sample rate, Hz, was refused; and in what colour to say it.
pub fn refused(rate: f32, palette: &Palette) -> (String, Color32) {
    let highest = SAMPLE_RATES.end();
    (
        format!("Refused: nothing can be played at {rate} Hz. Accepted: {LOWEST_RATE} to {highest} Hz"),
        palette.over,
    )
}

/// How often something went wrong, and when there was more of it: what is long ago is not worth a sentence.
#[derive(Debug, Clone, Copy, Default)]
pub struct News {
    count: Option<u64>,
    /// When the latest was noticed, s of the editor's time.
    seen: Option<f64>,
}

impl News {
    /// How long it is said, s.
    const LASTING: f64 = 4.0;

    /// Takes in how many there were so far, at the time `now`, s.
    pub fn follow(&mut self, count: u64, now: f64) {
        // Those from before the window was opened are old news.
        if self.count.replace(count).is_some_and(|before| before != count) {
            self.seen = Some(now);
        }
    }

    fn is_news(&self, now: f64) -> bool {
        self.seen.is_some_and(|seen| now - seen < News::LASTING)
    }
}

/// The stroke that was seen last, and what there was before it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Latest {
    slot: Option<Slot>,
    /// Landings of all snare wires when it was seen.
    landings: u32,
}

impl Latest {
    /// Finds a new stroke in a snapshot, given the one before; of several, the fastest.
    pub fn follow(&mut self, before: &KitSnapshot, now: &KitSnapshot) {
        let counts = Slot::ALL.into_iter().zip(before.pieces.iter().zip(&now.pieces));
        let fresh = counts.filter(|(_, (before, now))| before.strike.count != now.strike.count);
        if let Some((slot, _)) = fresh.max_by(|a, b| a.1.1.strike.speed.total_cmp(&b.1.1.strike.speed)) {
            *self = Latest { slot: Some(slot), landings: landings(before) };
        }
    }

    /// Its piece.
    pub fn slot(&self) -> Option<Slot> {
        self.slot
    }

    /// What it did. `cents` is how far its head's pitch is above its own now.
    pub fn sentence(&self, snapshot: &KitSnapshot, kit: &KitSpec, cents: f32) -> String {
        let struck = self.slot.and_then(|slot| Some((&snapshot.pieces[slot.index()], kit.piece(slot)?)));
        let Some((piece, spec)) = struck.filter(|(piece, _)| piece.strike.count > 0) else {
            return "No stroke yet. Click a head or a cymbal".to_owned();
        };
        let stroke = &piece.strike;
        let mut text = format!(
            "{} {:.1} m/s at {:.2}: {:.1} ms, {:.0} N",
            spec.title,
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
        let wires = spec.drum().is_some_and(|drum| drum.wires.is_some());
        for said in self.consequences(piece, snapshot, wires) {
            text += "; ";
            text += &said;
        }
        text
    }

    /// What else the stroke set going on a piece with or without wires.
    fn consequences(&self, piece: &PieceSnapshot, snapshot: &KitSnapshot, wires: bool) -> Vec<String> {
        let mut said = Vec::new();
        if piece.rims.landings > 0 {
            said.push(format!("rims touched {} times", piece.rims.landings));
        }
        if wires {
            if piece.wires.landings > 0 {
                said.push(format!("wires landed {} times", piece.wires.landings));
            }
        } else if landings(snapshot).saturating_sub(self.landings) > ANSWERING {
            said.push("snare wires buzzing".to_owned());
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
        let kit = KitSpec::standard();
        let mut latest = Latest::default();
        assert!(latest.sentence(&now, &kit, 0.0).starts_with("No stroke yet"));
        latest.follow(&before, &now);
        assert_eq!(latest.sentence(&now, &kit, 0.0), "Rack tom 4.0 m/s at 0.35: 5.8 ms, 31 N");
        now.pieces[1].wires.landings = 40;
        latest.follow(&now, &now);
        assert_eq!(
            latest.sentence(&now, &kit, 0.0),
            "Rack tom 4.0 m/s at 0.35: 5.8 ms, 31 N; snare wires buzzing"
        );
        let stretched =
            "Rack tom 4.0 m/s at 0.35: 5.8 ms, 31 N; head stretched, +10 cents; snare wires buzzing";
        assert_eq!(latest.sentence(&now, &kit, 10.2), stretched);
        // A stroke after that, which the wires do not answer.
        let before = now;
        now.pieces[4].strike = StrikeSnapshot { count: 1, ..StrikeSnapshot::default() };
        latest.follow(&before, &now);
        assert!(!latest.sentence(&now, &kit, 0.0).contains("wires"));
    }

    #[test]
    fn a_refused_rate_is_named() {
        let (text, _) = refused(500.0, &crate::editor::theme::DARK);
        assert_eq!(text, "Refused: nothing can be played at 500 Hz. Accepted: 1000 to 1536000 Hz");
    }

    #[test]
    fn trouble_counts_the_pieces_of_the_kit_at_hand_and_dropouts_while_they_are_new() {
        let kit = KitSpec::standard();
        let one = kit.alone(Slot::ALL[1]).unwrap();
        let mut snapshot = KitSnapshot { clock: 1, ..KitSnapshot::default() };
        let mut late = News::default();
        let said = |snapshot: &KitSnapshot, kit: &KitSpec, late: &News| {
            trouble(snapshot, kit, [late, &News::default()], 1.0, &crate::editor::theme::DARK)
                .map(|(text, _)| text)
        };
        snapshot.pieces[0].ready = true;
        assert_eq!(said(&snapshot, &kit, &late).unwrap(), "Building the kit: 1 of 9 pieces");
        assert_eq!(said(&snapshot, &one, &late), None);
        late.follow(0, 0.0);
        late.follow(1, 0.5);
        snapshot.late_buffers = 1;
        let text = said(&snapshot, &one, &late).unwrap();
        assert!(text.starts_with("Audio dropouts: 1 buffer took too long"), "{text}");
        let mut limited = News::default();
        limited.follow(0, 0.0);
        limited.follow(7, 0.5);
        let said = |now: f64| trouble(&snapshot, &one, [&late, &limited], now, &crate::editor::theme::DARK);
        assert!(said(1.0).is_some_and(|(text, _)| text.starts_with("Too loud")));
        assert_eq!(said(9.0), None);
    }
}
