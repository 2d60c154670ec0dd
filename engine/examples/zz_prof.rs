use overhear_engine::hi_hat::foot::SPEED;
use overhear_engine::piece::{BuildOptions, Piece, PieceId, Quality};
use overhear_engine::strike::{Strike, Striker};
fn main() {
    let pedal: f64 = std::env::args().nth(1).unwrap().parse().unwrap();
    let n: usize = std::env::args().nth(2).unwrap().parse().unwrap();
    let options = BuildOptions { quality: Quality::Standard, ..BuildOptions::new(44100.0) };
    let mut piece = Piece::new(PieceId::HiHat, &options).unwrap();
    piece.press_pedal(pedal, SPEED.1);
    piece.reset();
    let mut out = vec![0.0; 11025];
    if n == 0 {
        let mut best = vec![f64::MAX; 345];
        for _ in 0..12 {
            piece.reset();
            piece.strike(&Strike { speed: 6.0, radius: 0.97, angle: 0.3, striker: Striker::Stick });
            for (b, best) in out.chunks_mut(32).zip(&mut best) {
                let t = std::time::Instant::now();
                piece.render(b);
                *best = best.min(t.elapsed().as_secs_f64());
            }
        }
        let mut sorted = best.clone();
        sorted.sort_by(|a, b| b.total_cmp(a));
        println!("worst blocks us: {:?}", sorted[..8].iter().map(|t| (t * 1e6) as u32).collect::<Vec<_>>());
        println!(
            "first blocks us: {:?} last {:?}",
            best[..24].iter().map(|t| (t * 1e6) as u32).collect::<Vec<_>>(),
            (best[344] * 1e6) as u32
        );
        return;
    }
    let (mut engaged, mut blocks, mut struck, mut touching, mut active) = (0, 0, 0, 0, 0);
    for _ in 0..n {
        piece.strike(&Strike { speed: 3.0, radius: 0.97, angle: 0.3, striker: Striker::Stick });
        for b in out.chunks_mut(32) {
            piece.render(b);
            blocks += 1;
            let asleep = piece.is_asleep();
            let s = piece.surface_mut();
            if asleep {
                continue;
            }
            struck += s.is_struck() as usize;
            active += s.beyond().unwrap().is_active() as usize;
            let p = s.pair().unwrap();
            engaged += p.is_engaged() as usize;
            touching += p.is_touching() as usize;
        }
    }
    println!(
        "{blocks} blocks: engaged {engaged} touching {touching} struck {struck} potential {active} modes {}",
        piece.modes().len()
    );
}
#[allow(dead_code)]
fn x() {}
