//! The chunks of a MIDI file, checked for truncation.
//!
//! The parser behind [`super`] reads what it can of a damaged file; half a song that looks like a
//! whole one is worse than none, so the frame of the file is checked here.

use midly::Timing;

/// First byte of a SMPTE time base: 24, 25, 29 (for 29.97) and 30 frames a second, negated.
const FRAME_RATES: [u8; 4] = [0xE8, 0xE7, 0xE3, 0xE2];

/// Contents of a file's chunks.
pub struct Chunks<'a> {
    /// The time base.
    pub timing: Timing,
    /// Whether the tracks are patterns to be played one after the other (format 2).
    pub sequential: bool,
    /// Contents of the tracks.
    pub tracks: Vec<&'a [u8]>,
}

impl<'a> Chunks<'a> {
    /// Finds the header and the tracks.
    pub fn parse(bytes: &'a [u8]) -> Result<Chunks<'a>, String> {
        let bytes = unwrapped(bytes);
        if bytes.is_empty() {
            return Err("it is empty".to_owned());
        }
        if !bytes.starts_with(b"MThd") {
            return Err("it does not begin with `MThd`".to_owned());
        }
        // The parser negates this byte without looking.
        if let Some(&frames) = bytes.get(12).filter(|&&byte| byte >= 0x80)
            && !FRAME_RATES.contains(&frames)
        {
            return Err(format!("its time base is {} frames a second", 256 - u16::from(frames)));
        }
        let header = midly::parse(bytes).map_err(|error| error.to_string())?.0;
        let announced = bytes.get(10..12).map_or(0, |count| u16::from_be_bytes([count[0], count[1]]));
        let mut tracks = Vec::new();
        let mut rest = bytes;
        // Fewer bytes than a chunk's head are padding.
        while let Some((head, body)) = rest.split_at_checked(8) {
            let length = u32::from_be_bytes([head[4], head[5], head[6], head[7]]) as usize;
            let is_track = head.starts_with(b"MTrk");
            let Some((content, after)) = body.split_at_checked(length) else {
                if !is_track && tracks.len() >= usize::from(announced) {
                    break;
                }
                return Err(format!(
                    "track {} is cut off: {length} bytes announced, {} there",
                    tracks.len() + 1,
                    body.len(),
                ));
            };
            if is_track {
                tracks.push(content);
            }
            rest = after;
        }
        if tracks.len() < usize::from(announced) {
            return Err(format!("{announced} tracks announced, {} there", tracks.len()));
        }
        if tracks.is_empty() {
            return Err("it has no track".to_owned());
        }
        let sequential = header.format == midly::Format::Sequential;
        Ok(Chunks { timing: header.timing, sequential, tracks })
    }
}

/// The MIDI file inside a RIFF wrapper (`.rmi`), or the bytes themselves.
fn unwrapped(bytes: &[u8]) -> &[u8] {
    let Some(mut rest) = bytes.get(12..).filter(|_| bytes.starts_with(b"RIFF")) else {
        return bytes;
    };
    while let Some((head, body)) = rest.split_at_checked(8) {
        let length = u32::from_le_bytes([head[4], head[5], head[6], head[7]]) as usize;
        if head.starts_with(b"data") {
            return &body[..length.min(body.len())];
        }
        // Chunks start at even bytes.
        rest = body.get(length.saturating_add(length % 2)..).unwrap_or_default();
    }
    bytes
}
