//! The editor in a window of a host.

use std::collections::HashSet;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ConnectionExt, CreateWindowAux, ImageFormat, WindowClass};
use x11rb::rust_connection::RustConnection;
use x11rb::{COPY_DEPTH_FROM_PARENT, COPY_FROM_PARENT};

use crate::score::{assert_same, notes, through_engine, through_plugin};
use crate::{alone, instance};
use xtask::host::{Event, Instance, Processor, What};
use xtask::player::Blocks;

/// How long an editor may take to appear: a virtual display draws in software.
const PATIENCE: Duration = Duration::from_secs(60);

/// A window of the host's.
struct Parent {
    connection: RustConnection,
    window: u32,
    size: (u32, u32),
}

impl Parent {
    fn new(width: u32, height: u32) -> Parent {
        let (connection, screen) =
            x11rb::connect(None).expect("a display: run `cargo xtask test`, which brings its own");
        let root = connection.setup().roots[screen].root;
        let window = connection.generate_id().unwrap();
        let (w, h) = (width as u16, height as u16);
        let class = WindowClass::INPUT_OUTPUT;
        let depth = COPY_DEPTH_FROM_PARENT;
        let plain = CreateWindowAux::new();
        connection
            .create_window(depth, window, root, 0, 0, w, h, 0, class, COPY_FROM_PARENT, &plain)
            .unwrap();
        connection.map_window(window).unwrap();
        // A round trip: the window is there when the editor looks for it.
        connection.get_input_focus().unwrap().reply().unwrap();
        Parent { connection, window, size: (width, height) }
    }

    /// How many colours are seen in the window.
    fn colours(&self) -> usize {
        let (width, height) = (self.size.0 as u16, self.size.1 as u16);
        let image = self
            .connection
            .get_image(ImageFormat::Z_PIXMAP, self.window, 0, 0, width, height, !0)
            .unwrap()
            .reply()
            .unwrap();
        image.data.chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect::<HashSet<_>>().len()
    }

    /// Waits until something is drawn.
    fn wait_for_text(&self, instance: &mut Instance, when: &str) {
        let begun = Instant::now();
        // Text alone gives dozens of shades.
        while self.colours() < 20 {
            assert!(begun.elapsed() < PATIENCE, "{when}: the editor stays blank");
            instance.answer();
            thread::sleep(Duration::from_millis(50));
        }
    }

    fn children(&self) -> usize {
        self.connection.query_tree(self.window).unwrap().reply().unwrap().children.len()
    }
}

#[test]
fn the_editor_opens_draws_and_closes_while_it_plays() {
    let _turn = alone();
    let mut instance = instance();
    let rate = 48_000.0;
    let score = notes(rate);
    for round in 0..2 {
        let parent = instance
            .open_editor(|width, height| {
                let parent = Parent::new(width, height);
                Ok((parent.window, parent))
            })
            .expect("the editor opens");
        let sound = through_plugin(&mut instance, &score, rate, Blocks::Fixed(512));
        assert_same(&sound, &through_engine(&score, rate), "with the editor open");
        parent.wait_for_text(&mut instance, &format!("round {round}"));
        assert_eq!(parent.children(), 1);
        instance.close_editor().unwrap();
    }
    // Gone while its editor is open.
    let parent = instance
        .open_editor(|width, height| {
            let parent = Parent::new(width, height);
            Ok((parent.window, parent))
        })
        .expect("the editor opens again");
    thread::sleep(Duration::from_millis(300));
    drop(instance);
    drop(parent);
}

/// Hosts make their own window between creating the editor and showing it.
#[test]
fn the_editor_draws_however_late_it_is_shown() {
    let _turn = alone();
    for delay in [0, 10, 50, 200, 1000].map(Duration::from_millis) {
        let mut instance = instance();
        let parent = instance
            .open_editor(|width, height| {
                let parent = Parent::new(width, height);
                thread::sleep(delay);
                Ok((parent.window, parent))
            })
            .expect("the editor opens");
        parent.wait_for_text(&mut instance, &format!("shown {delay:?} late"));
        instance.close_editor().unwrap();
    }
}

/// Tells the other thread to stop, whatever ends this one's work.
struct Stop<'a>(&'a AtomicBool);

impl Drop for Stop<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}

/// Threads of this process once no more than `enough` are left, or none has ended for so long: the framework does not
/// always wait for a closed window's own.
fn fewest_threads(enough: usize, patience: Duration) -> usize {
    let threads = || std::fs::read_dir("/proc/self/task").unwrap().count();
    let (mut fewest, mut since) = (threads(), Instant::now());
    while fewest > enough && since.elapsed() < patience {
        thread::sleep(Duration::from_millis(20));
        let now = threads();
        if now < fewest {
            (fewest, since) = (now, Instant::now());
        }
    }
    fewest
}

#[test]
fn the_editor_opens_and_closes_twenty_times_while_it_plays() {
    let _turn = alone();
    let mut instance = instance();
    let stop = AtomicBool::new(false);
    let play = |processor: &mut Processor| {
        let mut sound = [[0.0; 256], [0.0; 256]];
        let (mut blocks, mut peak) = (0_u32, 0.0_f32);
        while !stop.load(Ordering::Acquire) {
            let strike = Event {
                offset: 100,
                what: What::NoteOn { channel: 9, key: 36 + (blocks % 24) as u8, velocity: 0.7 },
            };
            let events = if blocks.is_multiple_of(40) { vec![strike] } else { Vec::new() };
            let [left, right] = &mut sound;
            processor.process(&events, left, right)?;
            peak = left.iter().chain(&*right).fold(peak, |peak, sample| peak.max(sample.abs()));
            blocks += 1;
            // About real time, so that the windows get their turn.
            thread::sleep(Duration::from_millis(3));
        }
        Ok((blocks, peak))
    };
    let open_and_close = |instance: &mut Instance| {
        let _stop = Stop(&stop);
        let mut after_the_first = 0;
        for round in 0..20 {
            let parent = instance.open_editor(|width, height| {
                let parent = Parent::new(width, height);
                Ok((parent.window, parent))
            })?;
            parent.wait_for_text(instance, &format!("round {round}"));
            instance.close_editor()?;
            if round == 0 {
                // The first window may leave threads of the graphics driver behind.
                after_the_first = fewest_threads(0, Duration::from_secs(2));
            }
        }
        let left = fewest_threads(after_the_first, PATIENCE);
        assert!(
            left <= after_the_first,
            "{left} threads after 20 windows, {after_the_first} after the first"
        );
        Ok(())
    };
    let (blocks, peak) = instance.run_beside(48_000.0, 1..=256, play, open_and_close).expect("it plays");
    assert!(blocks > 100 && peak > 0.01 && peak.is_finite(), "{blocks} blocks, peak {peak}");
}
