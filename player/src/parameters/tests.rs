use overhear_engine::kit_spec::KitSpec;
use overhear_engine::slot::Slot;

use super::*;
use overhear_engine::kit_spec::Kind;

/// Changing these breaks every project that was ever saved.
const FROZEN_ENDS: [&str; 9] = ["tune", "muff", "levl", "pan_", "posn", "stik", "prel", "wire", "pedl"];
const FROZEN_IDS: [&str; 25] = [
    "master", "dynam", "velcur", "humpla", "humspd", "notmap", "midchn", "chokes", "poscc", "qualit",
    "offqua", "cllevl", "ohlevl", "rmlevl", "hear", "sympat", "clip", "workrs", "progch", "ohup", "ohaway",
    "ohwide", "rmup", "rmaway", "rmwide",
];

fn standard() -> KitSpec {
    KitSpec::standard()
}

/// Place of a parameter of the standard kit.
fn at(name: &str) -> usize {
    find(name, &standard()).unwrap()
}

#[test]
fn ids_hash_as_the_framework_documents() {
    assert_eq!((host_id(""), host_id("a"), host_id("ab")), (0, 97, 97 * 31 + 98));
    assert_eq!(host_id("01tune") >> 31, 0);
}

#[test]
fn ids_and_their_order_are_frozen() {
    let slots = (1..=16).flat_map(|slot| FROZEN_ENDS.map(|end| format!("{slot:02}{end}")));
    let frozen: Vec<String> = slots.chain(FROZEN_IDS.map(str::to_owned)).collect();
    assert_eq!(parameters().map(|parameter| parameter.id.to_owned()).to_vec(), frozen);
}

#[test]
fn ids_are_short_and_ids_hashes_and_names_unique() {
    for (index, parameter) in parameters().iter().enumerate() {
        assert!(parameter.id.is_ascii() && (1..=6).contains(&parameter.id.len()));
        for other in &parameters()[..index] {
            assert_ne!(parameter.id, other.id);
            assert_ne!(host_id(parameter.id), host_id(other.id), "{} {}", parameter.id, other.id);
            assert_ne!(parameter.name, other.name);
        }
    }
}

#[test]
fn every_piece_can_be_tuned_muffled_and_levelled() {
    let kit = standard();
    for (slot, piece) in kit.slots() {
        let name = piece.name.replace('-', "_");
        for what in [SlotParameter::Tune, SlotParameter::Muffle, SlotParameter::Level] {
            let index = find(&format!("{name}_{}", what.name()), &kit).unwrap();
            assert_eq!((index, is_live(index, &kit)), (slot_index(slot, what), true), "{name}");
        }
    }
}

#[test]
fn a_fresh_instance_has_the_defaults_of_the_standard_kit() {
    let kit = standard();
    for (index, parameter) in parameters().iter().enumerate() {
        assert_eq!(parameter.default, default_value(index, &kit), "{}", parameter.name);
        assert_eq!(parameter.name, name(index, &kit));
        assert_eq!(find(parameter.name, &kit), Ok(index));
    }
    for (slot, piece) in kit.slots() {
        let value = |what| default_value(slot_index(slot, what), &kit);
        assert_eq!(value(SlotParameter::Tune), 0.0, "{}", piece.name);
        assert_eq!(value(SlotParameter::Muffle), piece.defaults.muffle as f32);
        assert_eq!(value(SlotParameter::Level), piece.defaults.level_db as f32);
        assert_eq!(f64::from(value(SlotParameter::Pan)) / 100.0, piece.defaults.pan);
    }
}

#[test]
fn a_kit_names_its_own_parameters() {
    let mut kit = standard();
    kit.pieces.swap(0, 1);
    kit.pieces[2].name = "tom-1".to_owned();
    kit.pieces.truncate(3);
    assert_eq!(name(0, &kit), "snare_tune");
    assert_eq!(find("kick_tune", &kit), Ok(9));
    assert_eq!(find("tom_1_level", &kit), Ok(20));
    assert_eq!(name(slot_index(Slot::ALL[3], SlotParameter::Pan), &kit), "slot_4_pan");
    assert_eq!(find("slot_4_pan", &kit), Ok(30));
    assert_eq!(find("slot_1_tune", &kit), Ok(0), "by number too");
    for unknown in
        ["floor_tom_tune", "slot_0_tune", "slot_17_tune", "slot__tune", "kick", "kick_", "_tune", ""]
    {
        assert!(matches!(find(unknown, &kit), Err(ParameterError::Unknown { .. })), "{unknown}");
    }
}

#[test]
fn former_names_are_understood() {
    let kit = standard();
    for (former, present) in [
        ("kick_place", "kick_position"),
        ("hi_hat_striker", "hi_hat_stick"),
        ("humanize_place", "humanize_position"),
        ("humanize_speed", "humanize_velocity"),
        ("hearing", "sympathetic_resonance"),
        ("sympathy", "sympathetic_amount"),
        ("workers", "render_threads"),
    ] {
        assert_eq!(find(former, &kit), find(present, &kit), "{former}");
        assert_eq!(name(at(former), &kit), present);
    }
}

#[test]
fn what_a_piece_does_not_have_is_inert() {
    let kit = standard();
    for (slot, piece) in kit.slots() {
        let live = |what| is_live(slot_index(slot, what), &kit);
        let wired = piece.name == "snare";
        assert_eq!(
            (live(SlotParameter::Preload), live(SlotParameter::Wires)),
            (wired, wired),
            "{}",
            piece.name
        );
        assert_eq!(live(SlotParameter::Pedal), piece.instrument.kind() == Kind::HiHat, "{}", piece.name);
    }
    for (index, why) in
        [(at("slot_10_tune"), "the slot is empty"), (at("kick_pedal"), "`kick` has no such control")]
    {
        assert!(!is_live(index, &kit));
        assert_eq!(text(index, 0.5, &kit), "-");
        assert_eq!(from_text(index, "-", &kit), Some(parameters()[index].default));
        let error = parse_value(index, "0", &kit).unwrap_err().to_string();
        assert_eq!(error, format!("{} does nothing: {why}", name(index, &kit)));
    }
    assert!(!is_live(COUNT, &kit));
}

#[test]
fn a_drum_is_tuned_in_hertz_about_its_own_pitch() {
    let kit = standard();
    for (slot, piece) in kit.slots().filter(|(_, piece)| piece.drum().is_some()) {
        let index = slot_index(slot, SlotParameter::Tune);
        let [low, own, high] = piece.instrument.tunings();
        // As far as the drum can be tuned, an octave at most.
        let [low, high] = [low.max(0.5 * own), high.min(2.0 * own)];
        assert_eq!(text(index, 0.0, &kit), format!("{own:.2} Hz"));
        assert_eq!(range(index, &kit), (low as f32, high as f32, " Hz"));
        for hertz in [low, own, high, 0.5 * (low + own)] {
            let semitones = parse_value(index, &format!("{hertz} Hz"), &kit).unwrap();
            let pitch = own * f64::from(semitones / 12.0).exp2();
            assert!((pitch / hertz - 1.0).abs() < 3e-5, "{pitch} for {hertz}");
        }
        assert_eq!(parse_value(index, &own.to_string(), &kit), Ok(0.0));
        assert_eq!(parse_value(index, "-3 st", &kit), Ok(-3.0));
        assert_eq!(text(index, -12.0, &kit), format!("{low:.2} Hz"));
        assert_eq!(text(index, 12.0, &kit), format!("{high:.2} Hz"));
        assert!(parse_value(index, &(0.99 * low).to_string(), &kit).is_err());
    }
    let (ride, _) = kit.find("ride").unwrap();
    let index = slot_index(ride, SlotParameter::Tune);
    assert_eq!(text(index, -1.5, &kit), "-1.50 st");
    assert_eq!(parse_value(index, "-1.5", &kit), Ok(-1.5));
}

#[test]
fn a_value_that_went_through_a_host_comes_back_the_same() {
    for parameter in parameters() {
        for part in 0..=1000 {
            let span = parameter.max - parameter.min;
            let value = parameter.snap(parameter.min + span * part as f32 / 1000.0);
            let share = parameter.normalized(value).powf(1.0 / parameter.skew());
            let back = parameter.snap(parameter.min + span * share);
            assert_eq!(value, back, "{}", parameter.name);
            assert_eq!(parameter.snap(value), value, "{}", parameter.name);
        }
    }
}

#[test]
fn text_and_value_agree_both_ways() {
    let kit = standard();
    for (index, parameter) in parameters().iter().enumerate() {
        for value in [parameter.min, parameter.default, parameter.centre, parameter.max] {
            // A switch has no middle.
            let value = parameter.snap(value);
            let own = format!("{}{}", parameter.text(value), parameter.unit);
            assert_eq!(parameter.from_text(&own), Some(value), "{own}");
            // What is shown is read back as what shows the same.
            let shown = text(index, value, &kit);
            let back = from_text(index, &shown, &kit).unwrap();
            assert_eq!(text(index, parameter.snap(back), &kit), shown, "{}", parameter.name);
        }
    }
}

#[test]
fn every_pitch_that_is_shown_is_read_back_as_the_same() {
    let kit = standard();
    for (slot, _) in kit.drums() {
        let index = slot_index(slot, SlotParameter::Tune);
        for step in -12_288..=12_288 {
            let shown = text(index, step as f32 / 1024.0, &kit);
            let back = parameters()[index].snap(from_text(index, &shown, &kit).unwrap());
            assert_eq!(text(index, back, &kit), shown);
        }
    }
}

#[test]
fn errors_name_the_value_and_what_is_accepted() {
    let kit = standard();
    let error = |text: &str| parse_assignment(text, &kit).unwrap_err().to_string();
    assert_eq!(error("kick_tune=20"), "kick_tune is 20, accepted: 35 to 90 Hz");
    assert_eq!(error("kick_tune=low"), "kick_tune is `low`, accepted: 35 to 90 Hz");
    assert_eq!(error("kick_tune=13 st"), "kick_tune is 13, accepted: -12 to 12 st");
    assert_eq!(error("ride_tune=-12.5"), "ride_tune is -12.5, accepted: -12 to 12 st");
    assert_eq!(error("kick_muffle=much"), "kick_muffle is `much`, accepted: 0 to 1");
    assert_eq!(error("kick_muffle=NaN"), "kick_muffle is `NaN`, accepted: 0 to 1");
    assert!(error("kick_muffle").contains("`kick_muffle` is not of the form name=value"));
    assert!(error("triangle_tune=1").contains("accepted: kick_tune, kick_muffle"));
    assert!(!error("triangle_tune=1").contains("slot_"), "what does nothing is not offered");
}

#[test]
fn assignments_take_plain_units() {
    let kit = standard();
    let read = |text: &str| parse_assignment(text, &kit);
    assert_eq!(read("kick_tune=45"), Ok((at("kick_tune"), 0.0)));
    assert_eq!(read("kick_muffle=.5"), Ok((at("kick_muffle"), 0.5)));
    assert_eq!(read(" crash_tune = -3 st"), Ok((at("crash_tune"), -3.0)));
    assert_eq!(read("master_level=-inf"), Ok((SLOT_COUNT, -60.0)));
}

#[test]
fn hundredths_of_a_semitone_and_whole_ones_are_what_they_say() {
    let tune = &parameters()[at("ride_tune")];
    for semitones in -12..=12 {
        assert_eq!(tune.snap(semitones as f32), semitones as f32);
    }
    for hundredths in -1200..=1200 {
        let value = tune.snap(hundredths as f32 / 100.0);
        assert_eq!(tune.text(value), tune.text(hundredths as f32 / 100.0));
    }
}
