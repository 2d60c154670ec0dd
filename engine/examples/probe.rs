use overhear_engine::{piece::*, strike::*};
fn main() {
    for rate in [44100.0, 96000.0, 192000.0] {
    for id in PieceId::ALL {
        for striker in Striker::ALL {
        for (speed,radius) in [(1.0,0.3),(5.0,0.0),(25.0,0.9)] {
        let mut p = Piece::new(id, &BuildOptions{lossless:true,..BuildOptions::new(rate)}).unwrap();
        p.strike(&Strike { speed, radius, angle: 0.3, striker });
        let e0 = p.striker_energy();
        let mut out = [0f32; 32];
        let (mut lo,mut hi)=(f64::MAX,0f64);
        let mut last_present = e0;
        let mut gone = 0.0;
        for _ in 0..(0.5*rate/32.0) as usize { p.render(&mut out); let s = p.striker_energy(); if s==0.0 && last_present!=0.0 { gone+=last_present; } last_present=s; let e=p.energy()+s+gone; lo=lo.min(e); hi=hi.max(e); }
        let k=p.last_strike();
        let bad = (hi/e0-1.0).max(1.0-lo/e0);
        if bad > 1e-5 { println!("{rate} {:10} {:14} {speed} {radius}: {:.2e} {:.2e}  leaves {} touches {}", id.name(), striker.name(), hi/e0-1.0, lo/e0-1.0, k.leaving_speed, k.touches); }
        }}
    }}
}
