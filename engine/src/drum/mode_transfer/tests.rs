use super::*;
use crate::drum::tuned::ModeAtPitch;
use crate::reference;

/// How loud the lowest modes of the batter with so many nodal diameters are at a point, over the loudest without.
fn shares(spec: &DrumSpec, point: ReceiverPosition) -> [f64; 4] {
    let drum = DrumModes::new(spec).unwrap();
    let place = drum.heads.scale.place(spec.pitch_hz);
    let transfers = HeadTransfers::new(&drum, spec, point, TAU * spec.batter.modes_to_hz);
    let size = |mode: &TunedMode| {
        let [re, im] = transfers.transfer(mode, &place).map(f64::from);
        re.hypot(im) / mode.at(&place).mass.sqrt()
    };
    let round = drum.modes.iter().filter(|mode| mode.m == 0);
    let loudest = round.take(4).map(size).fold(0.0, f64::max);
    [1, 2, 3, 4].map(|m| {
        let lowest = drum.modes.iter().find(|mode| mode.m == m && mode.name == 0).unwrap();
        size(lowest) / loudest
    })
}

#[test]
fn over_its_rim_a_drum_shows_modes_that_it_hardly_sends_out() {
    for name in ["kick", "snare", "rack-tom", "floor-tom"] {
        let build = reference::standard(name);
        let spec = build.spec.drum().unwrap();
        let far = shares(spec, build.receivers.far[0]);
        let close = shares(spec, build.receivers.near);
        println!("{name}: (m, 1) over the loudest round mode, m = 1 to 4: close {close:.3?}, far {far:.4?}");
        // The more nodal diameters, the less a mode sends out, and the more the near field is all there is of it.
        assert!(far[1] > 3.0 * far[2] && far[2] > 3.0 * far[3], "{far:?}");
        for (m, least) in [(2, 3.0), (3, 10.0), (4, 20.0)] {
            assert!(
                close[m - 1] > least * far[m - 1],
                "{name} ({m}, 1): {} and {}",
                close[m - 1],
                far[m - 1]
            );
        }
    }
}

/// What all modes of an octave together show of themselves at a point and a pitch, dB: of the table, and as worked out there.
fn octaves(drum: &DrumModes, table: &ModeTransfer, exact: &HeadTransfers, pitch_hz: f64) -> Vec<[f64; 2]> {
    let place = drum.heads.scale.place(pitch_hz);
    let mut octaves = vec![[0.0; 2]; 7];
    for ((pair, shown), told) in table.members.iter().zip(table.transfers(&drum.modes, &place, pitch_hz)) {
        let mode = &drum.modes[*pair as usize];
        let ModeAtPitch { omega, mass, .. } = mode.at(&place);
        let exact = exact.transfer(mode, &place).map(|part| f64::from(shown * part));
        let octave = (omega / TAU / 44.0).log2().clamp(0.0, 6.0) as usize;
        for (sum, [re, im]) in octaves[octave].iter_mut().zip([told, exact]) {
            *sum += (re * re + im * im) / mass;
        }
    }
    octaves.into_iter().map(|pair| pair.map(|sum| 10.0 * sum.log10())).collect()
}

#[test]
fn a_drum_tuned_anywhere_is_heard_from_everywhere_as_it_is_worked_out_there() {
    let mut worst = 0.0_f64;
    for name in ["kick", "snare", "rack-tom", "floor-tom"] {
        let build = reference::standard(name);
        let spec = build.spec.drum().unwrap();
        let drum = DrumModes::new(spec).unwrap();
        let [lowest, default, highest] = spec.pitches();
        // As the drum itself has them.
        let (near, far) = heard_by(&drum, spec, &build.receivers);
        let [left, right] = &far;
        let receivers = &build.receivers;
        for (point, table, at) in [
            ("near", &near, receivers.near),
            ("left", left, receivers.far[0]),
            ("right", right, receivers.far[1]),
        ] {
            let exact = HeadTransfers::new(&drum, spec, at, TAU * spec.batter.modes_to_hz);
            for pitch in [lowest, (lowest * default).sqrt(), (default * highest).sqrt(), highest] {
                for (octave, [told, exact]) in octaves(&drum, table, &exact, pitch).into_iter().enumerate() {
                    // An octave may have no modes.
                    let off = if exact.is_finite() { (told - exact).abs() } else { 0.0 };
                    assert!(
                        off < 1.0,
                        "{name} at {pitch:.1} Hz, {point}, octave {octave}: {told:.1} dB for {exact:.1}"
                    );
                    worst = worst.max(off);
                }
            }
        }
    }
    println!("worst {worst:.2} dB");
}
