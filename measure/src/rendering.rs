//! Single pieces, rendered as their kit renders them.

use overhear_engine::kit::BLOCK;
use overhear_engine::modal::RECEIVERS;
use overhear_engine::piece::Piece;
use overhear_engine::surface::Surface;

/// Renders a stretch of a piece, s long, at a sample rate in Hz: sound pressure at its close microphone, Pa.
pub fn render(piece: &mut Piece, seconds: f64, sample_rate: f64) -> Vec<f32> {
    let mut out = vec![0.0; (seconds * sample_rate).round() as usize];
    render_into(piece, &mut out);
    out
}

/// Renders a stretch of a piece, s long, at a sample rate in Hz: sound pressure at each receiver, Pa.
pub fn render_everywhere(piece: &mut Piece, seconds: f64, sample_rate: f64) -> [Vec<f32>; RECEIVERS] {
    let samples = (seconds * sample_rate).round() as usize;
    let mut out: [Vec<f32>; RECEIVERS] = std::array::from_fn(|_| vec![0.0; samples]);
    let mut done = 0;
    while done < samples {
        let run = done..(done + piece.run_left()).min(samples);
        done = run.end;
        piece.render_in_air(out.each_mut().map(|row| &mut row[run.clone()]), None);
    }
    out
}

/// Renders sound pressure at a piece's close microphone, Pa, overwriting `out`; of any length.
pub fn render_into(piece: &mut Piece, out: &mut [f32]) {
    let mut rest = out;
    while !rest.is_empty() {
        let (run, later) = rest.split_at_mut(piece.run_left().min(rest.len()));
        let mut others = [[0.0; BLOCK]; RECEIVERS];
        piece.render_in_air(near_into(run, &mut others), None);
        rest = later;
    }
}

/// Renders so many samples of a surface by itself: sound pressure from near, Pa.
pub fn render_surface(surface: &mut Surface, samples: usize) -> Vec<f32> {
    let mut out = vec![0.0; samples];
    for run in out.chunks_mut(BLOCK) {
        let mut others = [[0.0; BLOCK]; RECEIVERS];
        surface.render_in_air(near_into(run, &mut others), None);
    }
    out
}

/// Runs of all receivers, that of the near one `run`.
fn near_into<'a>(
    run: &'a mut [f32],
    others: &'a mut [[f32; BLOCK]; RECEIVERS],
) -> [&'a mut [f32]; RECEIVERS] {
    let samples = run.len();
    let mut runs = others.each_mut().map(|row| &mut row[..samples]);
    runs[0] = run;
    runs
}
