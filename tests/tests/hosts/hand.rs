//! Mouse and keyboard in the editor's window, in a host: input reaches the audio and the host, and sizes are stored. Also
//! hosts in which no window can open.

use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use overhear::parameters::{find, host_id, parameters};
use overhear_cli::host::{Instance, Processor, Touch};
use overhear_cli::player::Blocks;
use overhear_engine::kit_spec::KitSpec;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{self, ConfigureWindowAux, ConnectionExt};
use x11rb::protocol::xtest::ConnectionExt as _;

use crate::score::{assert_same, notes, through_engine, through_plugin};
use crate::window::{PATIENCE, Parent};
use crate::{Stop, alone, instance};

const RATE: f64 = 48_000.0;

/// Places in a window of the size it has at first, pixels: the snare's head, and the first knob of the snare, which is
/// selected at first.
const SNARE_HEAD: (i16, i16) = (437, 286);
const FIRST_KNOB: (i16, i16) = (235, 558);

/// What the audio thread has met so far.
#[derive(Default)]
pub struct Met {
    blocks: u64,
    /// Largest sample since it was last asked for.
    peak: f32,
    touches: Vec<(u32, Touch)>,
}

/// Plays silence in about real time and takes note of what comes of the window, until it is told to stop.
pub fn listen(processor: &mut Processor, met: &Mutex<Met>, stop: &AtomicBool) -> anyhow::Result<()> {
    let mut sound = [[0.0; 256], [0.0; 256]];
    while !stop.load(Ordering::Acquire) {
        let [left, right] = &mut sound;
        processor.process(&[], left, right)?;
        let peak = left.iter().chain(&*right).fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
        let mut met = met.lock().unwrap();
        met.blocks += 1;
        met.peak = met.peak.max(peak);
        met.touches.extend(processor.touched());
        drop(met);
        thread::sleep(Duration::from_millis(4));
    }
    Ok(())
}

/// A hand with a pointer.
pub struct Hand<'a> {
    pub parent: &'a Parent,
}

impl Hand<'_> {
    fn input(&self, kind: u8, detail: u8, (x, y): (i16, i16)) {
        let connection = &self.parent.connection;
        let root = connection.setup().roots[0].root;
        connection.xtest_fake_input(kind, detail, 0, root, x, y, 0).unwrap().check().unwrap();
        thread::sleep(Duration::from_millis(20));
    }

    pub fn move_to(&self, place: (i16, i16)) {
        self.input(xproto::MOTION_NOTIFY_EVENT, 0, place);
    }

    pub fn press(&self) {
        self.input(xproto::BUTTON_PRESS_EVENT, 1, (0, 0));
    }

    pub fn release(&self) {
        self.input(xproto::BUTTON_RELEASE_EVENT, 1, (0, 0));
    }
}

/// Waits until something has been met.
fn until(instance: &mut Instance, met: &Mutex<Met>, what: &str, found: impl Fn(&Met) -> bool) {
    let begun = Instant::now();
    while !found(&met.lock().unwrap()) {
        assert!(begun.elapsed() < PATIENCE, "{what}");
        instance.answer();
        thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn a_hand_at_the_window_strikes_the_kit_and_moves_a_parameter_by_gestures_of_the_host() {
    let _turn = alone();
    let mut instance = instance();
    let (met, stop) = (Mutex::<Met>::default(), AtomicBool::new(false));
    let id = host_id(parameters()[find("snare_tune", &KitSpec::standard()).unwrap()].id);
    let value = |instance: &mut Instance| {
        instance.parameters().unwrap().into_iter().find(|parameter| parameter.id == id).unwrap().value
    };
    let work = |instance: &mut Instance| {
        let _stop = Stop(&stop);
        let parent = Parent::around(instance);
        parent.wait_for_text(instance, "at first");
        let hand = Hand { parent: &parent };
        let before = met.lock().unwrap().blocks;
        until(instance, &met, "nothing plays", |met| met.blocks > before + 20);
        assert_eq!(met.lock().unwrap().peak, 0.0, "something sounds before it is struck");
        hand.move_to(SNARE_HEAD);
        hand.press();
        hand.release();
        until(instance, &met, "a click on the snare is not heard", |met| met.peak > 0.01);
        assert_eq!(met.lock().unwrap().touches, [], "a stroke moves no parameter");

        let default = value(instance);
        hand.move_to(FIRST_KNOB);
        hand.press();
        for step in 1..=10 {
            hand.move_to((FIRST_KNOB.0, FIRST_KNOB.1 - 4 * step));
        }
        // A window that draws seldom would see press and release at once.
        until(instance, &met, "the knob does not move", |met| met.touches.len() > 1);
        hand.release();
        let ended = |met: &Met| met.touches.last() == Some(&(id, Touch::End));
        until(instance, &met, "the gesture does not end", ended);
        let touches = std::mem::take(&mut met.lock().unwrap().touches);
        assert!(touches.iter().all(|(of, _)| *of == id), "{touches:?}");
        assert_eq!(touches.first(), Some(&(id, Touch::Begin)));
        let values: Vec<f64> = touches
            .iter()
            .filter_map(|(_, touch)| match touch {
                Touch::Value(value) => Some(*value),
                _ => None,
            })
            .collect();
        assert_eq!(touches.len(), values.len() + 2, "one gesture: {touches:?}");
        assert!(values.is_sorted() && values.first() > Some(&default), "{values:?} from {default}");
        assert_eq!(value(instance), *values.last().unwrap());
        instance.close_editor()
    };
    instance
        .run_beside(RATE, 1..=256, |processor| listen(processor, &met, &stop), work)
        .expect("it plays with a window");
}

/// Size of the editor's own window.
pub fn own_size(parent: &Parent) -> (u32, u32) {
    let tree = parent.connection.query_tree(parent.window).unwrap().reply().unwrap();
    let own = *tree.children.first().expect("the editor's window");
    let shape = parent.connection.get_geometry(own).unwrap().reply().unwrap();
    (shape.width.into(), shape.height.into())
}

#[test]
fn the_window_takes_other_sizes_and_opens_again_as_it_was_left() {
    let _turn = alone();
    let mut instance = instance();
    let mut parent = Parent::around(&mut instance);
    parent.wait_for_text(&mut instance, "at first");
    for (wanted, given) in [((1200, 780), (1200, 780)), ((300, 200), (800, 500)), ((1000, 700), (1000, 700))]
    {
        assert_eq!(instance.resize_editor(wanted.0, wanted.1).unwrap(), given);
        // A host follows with its own.
        let size = ConfigureWindowAux::new().width(given.0).height(given.1);
        parent.connection.configure_window(parent.window, &size).unwrap().check().unwrap();
        parent.size = given;
        let begun = Instant::now();
        while own_size(&parent) != given {
            assert!(begun.elapsed() < PATIENCE, "it stays at {:?}, not {given:?}", own_size(&parent));
            instance.answer();
            thread::sleep(Duration::from_millis(20));
        }
        parent.wait_for_text(&mut instance, "at another size");
    }
    for (width, height) in [(1, 1), (100_000, 100_000), (1_000, 20)] {
        assert!(instance.force_editor_size(width, height).is_err(), "{width} by {height} is taken");
    }
    assert_eq!(own_size(&parent), (1000, 700));
    // It is told of its size by its next frame.
    let stored = |instance: &mut Instance| {
        String::from_utf8_lossy(&instance.save_state().unwrap()).contains("\"window\":\"[1000,700]\"")
    };
    let begun = Instant::now();
    while !stored(&mut instance) {
        assert!(begun.elapsed() < PATIENCE, "a project does not remember the size");
        thread::sleep(Duration::from_millis(50));
    }
    instance.close_editor().unwrap();
    let again = Parent::around(&mut instance);
    assert_eq!(again.size, (1000, 700));
    again.wait_for_text(&mut instance, "opened again");
    instance.close_editor().unwrap();

    // And in another instance that loads the project.
    let state = instance.save_state().unwrap();
    let mut other = crate::instance();
    other.load_state(&state).unwrap();
    let parent = Parent::around(&mut other);
    assert_eq!(parent.size, (1000, 700));
    other.close_editor().unwrap();
}

/// What a machine lacks, for [`without_a_window`].
const LACKS: &str = "OVERHEAR_TEST_LACKS";

/// Runs in a process of its own, whose environment another test has made poor: see below.
#[test]
#[ignore = "runs in the process of another test"]
fn without_a_window() {
    if std::env::var_os(LACKS).is_none() {
        return;
    }
    let mut instance = instance();
    let opened = instance.open_editor(|width, height| {
        // Without a display a host has no window either; what it hands over is then none.
        match x11rb::connect(None) {
            Ok(_) => {
                let parent = Parent::new(width, height);
                Ok((parent.window, Some(parent)))
            }
            Err(_) => Ok((1, None)),
        }
    });
    assert!(opened.is_err(), "there is a window");
    let score = notes(RATE);
    let sound = through_plugin(&mut instance, &score, RATE, Blocks::Fixed(512));
    assert_same(&sound, &through_engine(&score, RATE), "without a window");
    println!("log: {:?}", instance.log());
}

#[test]
fn without_a_display_or_without_opengl_it_plays_and_logs_why_there_is_no_window() {
    let _turn = alone();
    let poor = |lacks: &str, change: &dyn Fn(&mut Command)| {
        let mut test = Command::new(std::env::current_exe().unwrap());
        test.args(["--exact", "hand::without_a_window", "--ignored", "--nocapture"]).env(LACKS, lacks);
        change(&mut test);
        let done = test.output().unwrap();
        let said =
            String::from_utf8_lossy(&done.stdout).into_owned() + &String::from_utf8_lossy(&done.stderr);
        assert!(done.status.success() && said.contains("1 passed"), "without {lacks}: {said}");
        assert!(
            said.contains("The window cannot open, but the kit still plays: "),
            "without {lacks}: {said}"
        );
    };
    poor("a display", &|test| {
        test.env_remove("DISPLAY");
    });
    poor("OpenGL", &|test| {
        // No driver can be loaded from nowhere.
        test.env("LIBGL_DRIVERS_PATH", "/nonexistent").env("__GLX_VENDOR_LIBRARY_NAME", "none");
    });
}
