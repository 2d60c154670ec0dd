//! Every constant that was fitted: to recordings, to published figures, or by ear. All others are derived, from the literature, or
//! converged, and say so where they stand.
//!
//! A fitted constant is no evidence for what it was fitted to.

/// A fitted constant, for whoever lists them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fitted {
    /// Name in this module, or the path in the standard kit's file.
    pub name: &'static str,
    /// Value, in the unit.
    pub value: f64,
    /// Unit of the value and the range; `1` for a plain number.
    pub unit: &'static str,
    /// What it was fitted to.
    pub to: &'static str,
    /// Range that was tried.
    pub tried: &'static str,
    /// What else it moves.
    pub moves: &'static str,
}

/// Defines the constants and the list of all of them in one.
macro_rules! fitted {
    ($($constant:ident = $value:expr, $unit:literal, $name:literal;
        to $to:literal; tried $tried:literal; moves $moves:literal;)*) => {
        $(
            #[doc = concat!("`", $name, "`, ", $unit, "; fitted to ", $to, "; tried: ", $tried, "; moves ", $moves, ".")]
            pub const $constant: f64 = $value;
        )*

        /// All of them, in the order of this file.
        pub const ALL: &[Fitted] = &[
            $(Fitted { name: $name, value: $value, unit: $unit, to: $to, tried: $tried, moves: $moves }),*
        ];
    };
}

fitted! {
    // Heads.
    PLY_BOND = 0.6, "1", "ply_bond";
        to "how recorded toms brighten with the stroke"; tried "0.4 to 0.8: at 0.4 and 0.8 one of two toms is outside";
        moves "contact disc and brightness of every two-ply head";
    SCATTERING = 0.11, "1", "scattering";
        to "Foeppl's equations in the plane: what reaches the waves of a rack tom from 2.8 to 8 kHz, struck at 0.3 of its radius, 0 to 2 dB over what the tip's force gives at 5 m/s, 4 to 6 at 8";
        tried "0.05 to 0.13 with reaches of 17 to 12; in the same way of the energy of the stretch, which slack heads give back to the tip; as powers of k a, which go too high on kicks"; moves "highs of hard strokes on toms and kick";
    SCATTERING_REACH = 15.0, "1", "scattering_reach";
        to "the same, and that hardly anything is scattered at 3 m/s"; tried "12 to 17, with powers of 0.4 to 0.5 of the energy";
        moves "how high it goes";
    KICK_BATTER_LOSS = 6.0, "1/s", "pieces.kick.batter.loss.constant_1_s";
        to "what the felt strip and all else that leans on the head take: recorded kicks at 125 and 250 Hz"; tried "not recorded"; moves "the kick's boom";
    TOM_MOUNT_LOSS = 1.0, "1/s", "pieces.rack-tom.edge.mount_1_s";
        to "T60 of recorded toms at 125 Hz, 2.0 and 1.5 s"; tried "0 with 3 1/s of the film in all modes, which then die in half of the recorded time at 500 Hz; 1; 1.8: 1.5 and 1.4 s";
        moves "the toms' length";
    TWO_PLY_LOSS_PER_KHZ = 8.0, "1/s", "pieces.rack-tom.batter.loss.per_khz_1_s";
        to "early decays of close microphones on toms from 1 to 8 kHz: 0.54, 0.24, 0.14, 0.12 and 0.57, 0.35, 0.19, 0.15 s";
        tried "2, 3, 4, 8 and 9; the literature has 2 to 12"; moves "every octave from 1 kHz up of toms and kick";
    EDGE_RESISTANCE = 1400.0, "N s/m2", "pieces.rack-tom.edge.resistance_n_s_m2";
        to "the same from 500 Hz to 2 kHz, with the losses of the film"; tried "300 to 1000 with a film that loses half as much: 1 kHz then dies in half of the recorded time; 1400";
        moves "decay of every mode above 500 Hz of toms and kick";
    EDGE_CORNER_HZ = 1500.0, "Hz", "pieces.rack-tom.edge.corner_hz";
        to "the same at 500 Hz: 0.72 and 0.67 s"; tried "700 and 900 with a film that loses half as much; 1500"; moves "where the edge's loss sets in, in every drum";
    SNARE_EDGE_RESISTANCE = 3500.0, "N s/m2", "pieces.snare.edge.resistance_n_s_m2";
        to "early decays of snares, .3 to .4 s from 500 Hz to 4 kHz"; tried "3500 and 4000"; moves "the snare's length";
    TENSION_RMS = 0.12, "1", "pieces.rack-tom.tension_field.rms";
        to "spread of the fine spectrum of recorded toms, 1.5 to 5 kHz"; tried "0.04 to 0.15; lugs tuned by ear leave 0.02 to 0.04";
        moves "how much orders mix: the texture of every drum";
    TENSION_CORRELATION = 0.2, "1", "pieces.rack-tom.tension_field.correlation";
        to "the same"; tried "0.2 and 0.3 of the radius"; moves "how many orders mix";
    PILLOW_SIGMA = 80.0, "1/s", "pieces.kick.muffler.sigma_1_s";
        to "early decays of kicks from 250 Hz to 1 kHz, .1 to .3 s, at 0.15 of its amount"; tried "21 without a corner, 70 and 80; amounts of 0.1 to 0.5 are no nearer and no farther"; moves "the kick's decay";
    KICK_PITCH_HZ = 45.0, "Hz", "pieces.kick.pitch_hz";
        to "fundamental of recorded kicks, 47 Hz (39 to 116): the drum sounds at 50"; tried "44, 45 and 55, which sounds at 61"; moves "density of modes, glide, contact time";
    RACK_TOM_PITCH_HZ = 115.0, "Hz", "pieces.rack-tom.pitch_hz";
        to "fundamental of recorded rack toms, 120 Hz (99 to 156)"; tried "112, 115 and 140"; moves "density of modes, glide, contact time";
    RACK_TOM_MODES_TO = 1300.0, "Hz", "pieces.rack-tom.batter.modes_to_hz";
        to "recorded rack toms close by, which are lines up to 1.5 kHz (their fine spectrum spreads by 10 dB), noise from there on (5.0 dB; noise has 4.9), with a fifth of the energy from 1 to 10 kHz in lines";
        tried "1300 to 3000; at 1600 0.27 to 0.36 are in lines, at 1300 0.22 to 0.34"; moves "texture of the rack tom from 1.2 to 3 kHz, its brightness under hard strokes";
    SNARE_BATTER_LOSS = 4.0, "1/s", "pieces.snare.batter.loss.constant_1_s";
        to "recorded decays of snares, 500 Hz to 2 kHz"; tried "not recorded"; moves "the snare's length";
    SNARE_BATTER_LOSS_PER_KHZ = 3.0, "1/s", "pieces.snare.batter.loss.per_khz_1_s";
        to "0.36 s at 8 kHz of recorded snares, the room's tail included"; tried "2 to 3 against the literature's 5 to 12";
        moves "every octave from 500 Hz up";
    SNARE_SIDE_LOSS = 3.0, "1/s", "pieces.snare.resonant.loss.constant_1_s";
        to "recorded decays of snares, 500 Hz to 2 kHz"; tried "not recorded"; moves "how long wires buzz";
    SNARE_SIDE_LOSS_PER_KHZ = 2.0, "1/s", "pieces.snare.resonant.loss.per_khz_1_s";
        to "recorded decays of snares above 2 kHz"; tried "2 to 3 against the literature's 5 to 12"; moves "the snare's highs";
    SNARE_PITCH_HZ = 170.0, "Hz", "pieces.snare.pitch_hz";
        to "fundamental of recorded snares, heard at 213 and 224 Hz (medians of two collections); this one is heard at 222";
        tried "165, 175, 185, 195 and 220"; moves "contact time, wires' landings";
    FLOOR_TOM_PITCH_HZ = 66.0, "Hz", "pieces.floor-tom.pitch_hz";
        to "recorded 16 in floor toms, heard at 71, 74 and 99 Hz; of 66 and 68 Hz the one that is told from a rack tom";
        tried "66, 68, 75, 82 and 100";
        moves "density of modes, glide, contact time";
    GEL_SIGMA = 30.0, "1/s", "pieces.snare.muffler.sigma_1_s";
        to "by ear: a pad as drummers place it"; tried "not recorded"; moves "what full muffling takes";
    RING_SIGMA = 60.0, "1/s", "ring_sigma";
        to "by ear: a ring as they are sold"; tried "not recorded"; moves "what full muffling takes";
    LYING_HAND = 1.5, "kg/s", "lying_hand";
        to "decays of cross-sticks in four public sets of one-shots: from 300 Hz to 2.4 kHz -3 to -14 dB after 20 to 50 ms, -11 to -23 after 50 to 100, -24 to -44 after 100 to 200";
        tried "0, 1.5, 2.5 and 4"; moves "cross-sticks";
    AIR_Q = 60.0, "1", "pieces.kick.shell.air_q";
        to "by ear: losses at the wall, and through vents that are not described"; tried "not recorded"; moves "decay of modes of the enclosed air";
    // Hoops, sticks, wires.
    HOOP_Q = 50.0, "1", "pieces.snare.hoop.q";
        to "by ear: gaskets, rods and the head take much"; tried "not recorded"; moves "rimshots and cross-sticks";
    DRUM_MASS = 3.5, "kg", "pieces.snare.hoop.drum_mass_kg";
        to "by ear: a drum on its stand"; tried "not recorded"; moves "the thud of a rimshot";
    DRUM_STAND_HZ = 15.0, "Hz", "pieces.snare.hoop.stand_hz";
        to "by ear: a drum on its stand"; tried "not recorded"; moves "the thud of a rimshot";
    DRUM_STAND_Q = 2.0, "1", "pieces.snare.hoop.stand_q";
        to "by ear: a drum on its stand"; tried "not recorded"; moves "the thud of a rimshot";
    STICK_Q = 20.0, "1", "stick_q";
        to "by ear: a stick's bending in a hand"; tried "not recorded"; moves "the click of sticks";
    FELT_STIFFNESS = 1e12, "N/m^3", "felt_beater_stiffness";
        to "the click of recorded kicks: its level, -31 dB (-44 to -22), and when its highs peak, 4.5 ms; force and contact as published within a tenth";
        tried "6e8 with an exponent of 2.3; 1e10: highs peak 13 to 18 ms after soft strokes; 1e11, which on a film that stretches about the beater clicks by -43 to -34 dB; 1e12: -36 to -32 dB";
        moves "the kick's attack";
    FELT_EXPONENT = 3.0, "1", "felt_beater_exponent";
        to "the same; literature: 2.2 to 3.5 of hammers and mallets"; tried "2.3 and 3"; moves "the kick's dynamics";
    SNARE_PRELOAD = 0.1, "N", "pieces.snare.defaults.preload_n";
        to "distance to recorded snares, and that what wires add above 3 kHz is as recorded, 6 to 13 dB (the literature's strainers: 0.15)";
        tried "mix / close 0.84 / 0.86; 0.05: 0.87 / 0.85; 0.075: 0.89 / 0.97; at 195 Hz 0.15 and 0.2 N are 0.07 to 0.17 farther than 0.1";
        moves "landings, length of the buzz, sympathetic buzz";
    STRIKER_AWAY = 0.010, "m", "striker_away";
        to "by ear: no head comes up so far to a stick that has left"; tried "not recorded"; moves "second touches";
    STRIKER_LIFTED_AFTER = 0.3, "s", "striker_lifted_after";
        to "by ear: when a hand lifts a stick that lies"; tried "not recorded"; moves "dead strokes";
    SHOT_LEAD = 0.8e-3, "s", "rimshot_lead";
        to "by ear: how much earlier than the rim a rimshot's bead meets the head"; tried "not recorded"; moves "rimshots";
    // Cymbals.
    BRONZE_LOSS = 0.55, "1/s", "pieces.crash.loss.constant_1_s";
        to "recorded decays of crashes, rides and splashes at 500 Hz"; tried "not recorded"; moves "every cymbal's length";
    BRONZE_LOSS_FACTOR = 4.14e-5, "1", "pieces.crash.alloy.loss_factor";
        to "recorded decays of crashes, rides and splashes at 8 kHz"; tried "not recorded"; moves "every cymbal's highs";
    CRASH_BOW = 0.020, "m", "pieces.crash.bow_m";
        to "recorded crashes, within trade sizes: cymbals of 16 in stand 4 to 5 cm high, bell included";
        tried "some dozen shapes each; 0.010: heard as a ride up to medium strokes; 0.015; 0.025, 0.030; with tapers of 0.6 and 0.5";
        moves "lowest modes, bloom, 100 Hz to 1 kHz";
    CRASH_BELL_RADIUS = 0.055, "m", "pieces.crash.bell.radius_m";
        to "recorded crashes"; tried "some dozen shapes each"; moves "the crash's bell";
    CRASH_BELL_RISE = 0.020, "m", "pieces.crash.bell.rise_m";
        to "recorded crashes"; tried "some dozen shapes each"; moves "the crash's bell";
    RIDE_MASS = 2.2, "kg", "pieces.ride.mass_kg";
        to "where recorded rides end, 14 kHz: from 100 ms on 10.7 to 14 kHz lie at -10 to 1 dB over 7 to 10 kHz, 14 to 17 kHz at -18 to -38, of one at -10; coincidence falls as the plate is thicker; within trade weights of 20 in, 1.8 to 2.7 kg";
        tried "2.5: -21 to -25 and -31 to -44 dB; 2.2: -2 to -10 and -26 to -44; 2.1, 2.0; tapers of 0.6 to 1";
        moves "where ride and bell end, density of modes, loudness";
    RIDE_BOW = 0.018, "m", "pieces.ride.bow_m";
        to "recorded rides"; tried "some dozen shapes each"; moves "lowest modes";
    RIDE_BELL_RADIUS = 0.070, "m", "pieces.ride.bell.radius_m";
        to "recorded rides"; tried "some dozen shapes each"; moves "the ride's bell";
    RIDE_BELL_RISE = 0.025, "m", "pieces.ride.bell.rise_m";
        to "recorded rides"; tried "some dozen shapes each"; moves "the ride's bell";
    SPLASH_BOW = 0.010, "m", "pieces.splash.bow_m";
        to "recorded splashes, within trade sizes: cymbals of 10 in stand 2 to 2.5 cm high, bell included";
        tried "some dozen shapes each; 0.005: heard as an open hi-hat; 0.008; 0.012 to 0.015; with a taper of 0.6";
        moves "lowest modes, bloom, 100 Hz to 1 kHz";
    SPLASH_BELL_RADIUS = 0.038, "m", "pieces.splash.bell.radius_m";
        to "recorded splashes"; tried "some dozen shapes each"; moves "the splash's bell";
    SPLASH_BELL_RISE = 0.013, "m", "pieces.splash.bell.rise_m";
        to "recorded splashes"; tried "some dozen shapes each"; moves "the splash's bell";
    CYMBAL_TAPER = 0.8, "1", "pieces.crash.taper";
        to "recorded crashes and splashes"; tried "1 (as thick everywhere) and 0.8"; moves "high modes of every cymbal";
    HAMMERING_RMS = 0.05, "1", "pieces.crash.hammering.rms";
        to "spread of the fine spectrum of recorded crashes and splashes, 1.5 to 12 kHz"; tried "0.05 only";
        moves "how much orders mix: texture and highs of every cymbal on a stand";
    HAMMERING_CORRELATION = 0.1, "1", "pieces.crash.hammering.correlation";
        to "by eye: marks of a hammer, 2 cm"; tried "0.1 only"; moves "how many orders mix";
    CYMBAL_TAPE_SIGMA = 40.0, "1/s", "pieces.crash.muffler.sigma_1_s";
        to "by ear: a strip of tape near the edge"; tried "not recorded"; moves "what full muffling takes";
    ENERGY_TRANSPORT = 0.010, "1", "energy_transport";
        to "the exact coupling to 8 kHz: energies of bands from 2 to 8 kHz after strokes on crash and splash"; tried "0.004 to 0.02; 0.008 for flatter cymbals; the crash asks for 0.014, the splash for 0.008";
        moves "how fast hard strokes brighten every cymbal on a stand, above the coupled modes";
    TRANSPORT_BETWEEN = 0.1, "1", "transport_between";
        to "the exact coupling after strokes at 0.3 to 3 m/s"; tried "0 to 0.15"; moves "how soon soft strokes stop brightening";
    TRANSPORT_WITHIN = 1.0, "1", "transport_within";
        to "the same"; tried "0.5 to 3"; moves "how soon the modes of a band are equally loud";
    TRANSPORT_HOP = 90.0, "Hz", "transport_hop";
        to "the exact coupling: coherence of modes from 2 to 8 kHz over 16 ms, after strokes at 1.5 to 9 m/s on crash, ride and splash";
        tried "60 to 130 by speed and cymbal; 150 without the limit of hard strokes";
        moves "how wide the lines of struck cymbals are above the coupled modes";
    TRANSPORT_STRONG = 630.0, "1/s", "transport_strong";
        to "the same"; tried "none (a splash at 9 m/s loses its phases three times too fast) and 630";
        moves "the same after hard strokes";
    HAND_SIGMA = 70.0, "1/s", "hand_sigma";
        to "by ear: a choked crash is gone in a fifth of a second"; tried "not recorded"; moves "every choke";
    // Hi-hat.
    HAT_LOSS = 1.2, "1/s", "pieces.hi-hat.top.loss.constant_1_s";
        to "recorded decays of open hats, 3.3 to 2.5 s"; tried "not recorded"; moves "open hats";
    HAT_LOSS_PER_KHZ = 0.06, "1/s", "pieces.hi-hat.top.loss.per_khz_1_s";
        to "recorded decays of open hats, 3.3 to 2.5 s"; tried "not recorded"; moves "open hats";
    HAT_BOW = 0.010, "m", "pieces.hi-hat.top.bow_m";
        to "recorded open hats"; tried "not recorded"; moves "lowest modes";
    HAT_BELL_RADIUS = 0.045, "m", "pieces.hi-hat.top.bell.radius_m";
        to "recorded open hats"; tried "not recorded"; moves "the hats' bells";
    HAT_BELL_RISE = 0.015, "m", "pieces.hi-hat.top.bell.rise_m";
        to "recorded open hats"; tried "not recorded"; moves "the hats' bells";
    HAT_RIM_MODULUS = 7e9, "Pa", "pieces.hi-hat.rim.youngs_modulus_pa";
        to "centroid of recorded closed hats, 8.4 kHz in the first 50 ms; each of 32 points half as stiff as each of 16 was";
        tried "at 3 m/s with 16 points 4e9, 15e9, 40e9, 110e9 (smooth): 10.7, 11.9, 12.7, 13.3 kHz; with 32 points 7e9, 15e9: 11.5, 12.4 kHz";
        moves "highs of closed hats; their texture little";
    HAT_WARP = 1e-3, "m", "pieces.hi-hat.warp.rms_m";
        to "fine spectra of recorded closed, half-open and open hats"; tried "0 (flat) to 2e-3: flat rims ring in lines";
        moves "every sound of the hats in which rims touch";
    HAT_RUBBING = 16.0, "1/s", "pieces.hi-hat.rubbing.constant_1_s";
        to "recorded decays of closed hats, 0.43 to 0.27 s"; tried "with air between the cymbals 19: 0.30 to 0.23 s, 16: 0.35 to 0.25, 13: 0.48 to 0.28; without it 19 and 21";
        moves "closed and half-open hats";
    HAT_RUBBING_PER_KHZ = 0.4, "1/s", "pieces.hi-hat.rubbing.per_khz_1_s";
        to "recorded decays of closed hats, 0.43 to 0.27 s"; tried "0.6 with rims that meet at 16 points, and with 32";
        moves "closed and half-open hats";
    HAT_TOUCHING = 0.6, "1", "pedal_touching";
        to "by ear: where on the pedal's way the rims meet"; tried "not recorded"; moves "half-open hats";
    HAT_SETTLING = 0.003, "s", "hat_settling";
        to "by ear: when a touch of the rims becomes as lossy as one that lasts"; tried "not recorded"; moves "chicks";
    LEG_RATE = 200.0, "1/s", "leg_rate";
        to "by ear: half a movement of the foot takes 8 ms"; tried "not recorded"; moves "chicks";
    // Microphones, room, mix.
    OVER_RIM_HEIGHT = 0.08, "m", "pieces.snare.close.height_m";
        to "49 of 60 figures of recorded kicks, snares and toms inside"; tried "nine places, 0.05 to 0.5"; moves "every drum close by";
    KICK_CLOSE_HEIGHT = 0.15, "m", "pieces.kick.close.height_m";
        to "spectra and decays of recorded kicks; microphones stand 5 to 20 cm from them"; tried "0.08, 0.12, 0.15, 0.3; 20 cm before the middle of the batter"; moves "the kick's 300 Hz to 1 kHz close by";
    KICK_CLOSE_GAIN = 0.36, "1", "pieces.kick.close.gain";
        to "as loud as from 8 cm before"; tried "not recorded"; moves "the kick in the mix";
    OVER_RIM_AZIMUTH = 2.5, "rad", "pieces.snare.close.azimuth_rad";
        to "out of the way of sticks"; tried "not recorded"; moves "modes with nodal diameters close by";
    OVER_RIM_GAIN = 0.28, "1", "pieces.snare.close.gain";
        to "a stroke at 6 m/s as loud as from half a metre"; tried "not recorded"; moves "the mix";
    CYMBAL_CLOSE_INCLINATION = 1.1, "rad", "pieces.crash.close.inclination_rad";
        to "balance of recorded crashes"; tried "0.6, 0.85, 0.95, 1.1; from 0.85 crashes are heard as open hats";
        moves "every cymbal but the ride close by";
    CYMBAL_CLOSE_AZIMUTH = 2.0, "rad", "pieces.crash.close.azimuth_rad";
        to "out of the way of arms and sticks; crashes are heard as crashes"; tried "0.4, 2.0, 2.5, -2.5";
        moves "every cymbal close by: how near the stick is";
    SPOT_INCLINATION = 0.85, "rad", "pieces.ride.close.inclination_rad";
        to "the first 10 ms of recorded rides from 3 to 6 kHz over the next 20, 3 to 6 dB"; tried "0.6, 0.85, 0.95, 1.1";
        moves "the ride close by: the stick, and the balance";
    ROOM_FLOOR = 0.6, "1", "room.reflected";
        to "by ear: carpet; ceiling 0.65, walls 0.7 to 0.75: treated"; tried "not recorded"; moves "early reflections";
    CLIP_KNEE = 0.85, "1", "clip_knee";
        to "by ear: where the safety clip begins to bend"; tried "not recorded"; moves "nothing below it";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fitted_constant_says_what_it_was_fitted_to_and_has_a_name_of_its_own() {
        for (at, constant) in ALL.iter().enumerate() {
            assert!(constant.value.is_finite(), "{}", constant.name);
            assert!(!constant.to.is_empty() && !constant.tried.is_empty() && !constant.moves.is_empty());
            assert!(ALL[..at].iter().all(|other| other.name != constant.name), "{}", constant.name);
        }
    }
}
