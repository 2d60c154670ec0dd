//! One vocabulary: private words that the field has words for are no names of ours.

use super::{none, sources};

/// Private names and what the field says instead. Names of code only: as words of a comment some of them are plain English.
const PRIVATE: [(&str, &str); 68] = [
    ("Pickup", "ReceiverWeights"),
    ("Ear", "Receiver, RecordingChain"),
    ("EARS", "RECEIVERS"),
    ("Heard", "Pressure"),
    ("Hearing", "ModeTransfer, SympatheticCoupling"),
    ("PairHearing", "PairTransfer"),
    ("Listener", "AirLoad"),
    ("Incident", "IncidentPressure"),
    ("deaf", "uncoupled"),
    ("ListeningPoint", "ReceiverPosition"),
    ("Toucher", "Exciter"),
    ("toucher", "exciter"),
    ("TouchPoint", "ContactPoint"),
    ("Meeting", "ContactLanes"),
    ("Port", "InputVector"),
    ("Beyond", "NonlinearForce"),
    ("beyond_mut", "nonlinear_force_mut"),
    ("Front", "CoupledModes"),
    ("look_ahead", "predict"),
    ("jolt", "rescale_velocity"),
    ("Faint", "InaudibleModes"),
    ("learn_faint", "update_thresholds"),
    ("Folded", "RimHarmonics"),
    ("yielding", "compliance"),
    ("eased", "preload_offset"),
    ("Film", "LocalHeadCompliance"),
    ("wraps", "dents"),
    ("Discs", "PatchFactors"),
    ("Rung", "ModeAtPitch"),
    ("rungs", "at_pitch"),
    ("Place", "PitchPosition, PointBand, SamplePoint"),
    ("Blueprint", "DrumModes"),
    ("blueprint", "drum modes"),
    ("lay_out", "assemble"),
    ("Line", "DelayLine"),
    ("Tap", "DelayTap"),
    ("Post", "RenderJob"),
    ("Crew", "RenderWorkers"),
    ("crew", "workers"),
    ("hire", "attach"),
    ("Staff", "WorkerPlan"),
    ("Errand", "job slot"),
    ("Hall", "shared state"),
    ("Seat", "RetainedControls"),
    ("Leaving", "FadeOut"),
    ("see_off", "start"),
    ("Kept", "Cache"),
    ("Shelf", "DiskCache"),
    ("shelf", "disk cache"),
    ("MARK", "SCHEMA"),
    ("Voice", "Instrument"),
    ("voice", "instrument"),
    ("Desk", "Mixer"),
    ("Brought", "Position"),
    ("overhear_lab", "overhear_measure"),
    ("overhear_kept", "overhear_engine::cache"),
    ("overhear_crew", "overhear::workers"),
    ("keymap", "nothing"),
    ("posts", "jobs"),
    ("pickups", "receiver weights"),
    ("listener", "receiver"),
    ("ease", "update_offset"),
    ("eases", "preload_offset"),
    ("yields_at", "largest_depth"),
    ("in_front", "is_coupled"),
    ("push_front_and_listen", "push_coupled_and_listen"),
    ("listen_front", "listen_coupled"),
    ("lay_ways", "update_paths"),
];

/// Private names, what the field says instead, and where the name is still used or has a plain meaning.
const PRIVATE_ELSEWHERE: [(&str, &str, &[&str]); 7] = [
    ("ear", "receiver", &["engine/src/drum", "engine/src/high_band"]),
    ("ears", "receivers", &["engine/src/drum"]),
    ("pickup", "weights, receivers", &["engine/src/high_band"]),
    ("rung", "mode at pitch", &["engine/src/drum"]),
    ("front", "coupled modes", &["plugin/src/editor"]),
    // The post of a stand is one.
    ("post", "job", &["plugin/src/editor/kit_view"]),
    ("faint", "inaudible", &["plugin/src/editor"]),
];

/// Private words in the names of files and folders.
const PRIVATE_FILES: [&str; 16] = [
    "lab",
    "kept",
    "crew",
    "keymap",
    "listening",
    "hearing",
    "faint",
    "folded",
    "front",
    "port",
    "pickup",
    "post",
    "leaving",
    "shadow",
    "ears",
    "shelf",
];

/// Three files that were called so meant three things.
const FILES_OF_ONE_MEANING: [&str; 2] = ["air", "uneven"];

/// Names in a line of code: strings and comments aside.
fn names(line: &str) -> Vec<&str> {
    let code = line.split("//").next().unwrap_or_default();
    let outside = code.split('"').step_by(2);
    outside
        .flat_map(|part| part.split(|c: char| !c.is_alphanumeric() && c != '_'))
        .filter(|name| !name.is_empty())
        .collect()
}

/// Whether a file is in one of these folders, or is the file that belongs to one.
fn at_home(path: &str, homes: &[&str]) -> bool {
    homes.iter().any(|home| path.strip_prefix(home).is_some_and(|rest| rest.starts_with(['/', '.'])))
}

#[test]
fn no_name_is_a_private_word() {
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for (path, text) in sources() {
        if path.ends_with("tidy/vocabulary.rs") {
            continue;
        }
        for (number, line) in text.lines().enumerate() {
            for name in names(line) {
                seen += 1;
                let elsewhere = PRIVATE_ELSEWHERE.iter().filter(|(.., homes)| !at_home(&path, homes));
                let private =
                    PRIVATE.iter().copied().chain(elsewhere.map(|&(private, say, _)| (private, say)));
                if let Some((_, say)) = private.into_iter().find(|(private, _)| *private == name) {
                    wrong.push(format!("{path}:{}: `{name}`: say {say}", number + 1));
                }
            }
        }
    }
    assert!(seen > 100_000, "{seen} names");
    none(wrong);
}

#[test]
fn no_file_is_called_by_a_private_word() {
    let mut wrong = Vec::new();
    for (path, _) in sources() {
        for part in path.split('/').map(|part| part.trim_end_matches(".rs")) {
            if PRIVATE_FILES.contains(&part) || FILES_OF_ONE_MEANING.contains(&part) {
                wrong.push(format!("{path}: `{part}`"));
            }
        }
    }
    none(wrong);
}

#[test]
fn names_are_read_without_strings_and_comments() {
    assert_eq!(names("let desk = Desk::new(\"Crew\"); // Post"), ["let", "desk", "Desk", "new"]);
}
