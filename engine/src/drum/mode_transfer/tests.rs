use super::*;
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
