//! The sound at a microphone depends on its position as physics requires.

use overhear_measure::report::radiation::microphones::{
    CLOSE, Farther, OVERHEADS, ROOM, farther, near_field, rack_toms,
};
use overhear_tests::spec;

#[test]
fn a_microphone_34_3_cm_farther_hears_a_millisecond_later_and_one_twice_as_far_half_at_every_rate() {
    // What is off, shares of the sound. The played tom's head wraps around the tip and begins brighter.
    let [(played, _), (fixed_disc, _)] = rack_toms();
    let toms = [(fixed_disc, 0.04), (played, 0.08)];
    for ((tom, most), rate) in
        toms.iter().flat_map(|tom| [44_100.0, 48_000.0, 96_000.0].map(|rate| (tom, rate)))
    {
        // The pairs until the room's first echoes, of the floor, arrive. A drum is no point, and its
        // other head is farther: a close microphone hears that up to some metres. Ways of a broken number of samples lose some
        // of a stroke's first highs, the most at 44.1 kHz.
        let (pairs, alone) = ((0.6, 0.005), (4.0, 0.03));
        for (output, name, at) in
            [(CLOSE, "close", alone), (OVERHEADS, "overheads", pairs), (ROOM, "room", pairs)]
        {
            let Farther { later, a_sample_off, doubled } = farther(tom, output, at, rate);
            println!("{}, {name} at {rate} Hz: {later:.4} off, twice as far {doubled:.4} off", tom.name);
            assert!(later < 0.03 && doubled < *most, "{}, {name} at {rate} Hz", tom.name);
            assert!(a_sample_off > 2.0 * later, "{}, {name} at {rate} Hz", tom.name);
        }
    }
}

#[test]
fn a_close_microphone_hears_modes_that_overheads_and_room_do_not() {
    for name in ["rack-tom", "floor-tom"] {
        for ((m, least), levels) in [(2, 6.0), (3, 12.0)].into_iter().zip(near_field(&spec(name), 44_100.0)) {
            println!("{name} ({m}, 1): close, overheads, room {levels:.1?} dB of the whole");
            assert!(levels[0] > levels[1] + least && levels[0] > levels[2] + least, "{name}: {levels:?}");
        }
    }
}
