//! The editor in a window of a host.

use std::collections::HashSet;
use std::process::Command;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ConnectionExt, CreateWindowAux, ImageFormat, WindowClass};
use x11rb::rust_connection::RustConnection;
use x11rb::{COPY_DEPTH_FROM_PARENT, COPY_FROM_PARENT};

use crate::score::{assert_same, notes, through_engine, through_plugin};
use crate::{Stop, alone, instance};
use overhear_cli::host::{Event, Instance, Processor, What};
use overhear_cli::player::Blocks;

/// How long an editor may take to appear: a virtual display draws in software.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// A window of the host's.
pub struct Parent {
    pub connection: RustConnection,
    pub window: u32,
    pub size: (u32, u32),
}

/// Holds on to the display for as long as the process lasts: a server that is left by its last client starts anew, and takes
/// nobody meanwhile.
fn keep_display() {
    static DISPLAY: OnceLock<Option<RustConnection>> = OnceLock::new();
    DISPLAY.get_or_init(|| x11rb::connect(None).ok().map(|(connection, _)| connection));
}

impl Parent {
    pub fn new(width: u32, height: u32) -> Parent {
        keep_display();
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
        // A round trip to the server, so that the window exists when the editor looks for it.
        connection.get_input_focus().unwrap().reply().unwrap();
        Parent { connection, window, size: (width, height) }
    }

    /// One with the editor in it.
    pub fn around(instance: &mut Instance) -> Parent {
        Parent::scaled(instance, None)
    }

    /// One with the editor in it, on a screen with so many pixels to a point.
    pub fn scaled(instance: &mut Instance, scale: Option<f64>) -> Parent {
        let opened = instance.open_editor_scaled(scale, |width, height| {
            let parent = Parent::new(width, height);
            Ok((parent.window, parent))
        });
        opened.expect("the editor opens")
    }

    /// What is seen in the window.
    fn picture(&self) -> Vec<u8> {
        let (width, height) = (self.size.0 as u16, self.size.1 as u16);
        let whole = self.connection.get_image(ImageFormat::Z_PIXMAP, self.window, 0, 0, width, height, !0);
        whole.unwrap().reply().unwrap().data
    }

    /// How many colours are seen in the window.
    fn colours(&self) -> usize {
        self.picture()
            .chunks_exact(4)
            .map(|pixel| [pixel[0], pixel[1], pixel[2]])
            .collect::<HashSet<_>>()
            .len()
    }

    /// Waits until something is drawn.
    pub fn wait_for_text(&self, instance: &mut Instance, when: &str) {
        let begun = Instant::now();
        // Text alone gives dozens of shades.
        while self.colours() < 20 {
            assert!(begun.elapsed() < PATIENCE, "{when}: the editor stays blank");
            instance.answer();
            thread::sleep(Duration::from_millis(50));
        }
    }

    pub fn children(&self) -> usize {
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
        let parent = Parent::around(&mut instance);
        let sound = through_plugin(&mut instance, &score, rate, Blocks::Fixed(512));
        assert_same(&sound, &through_engine(&score, rate), "with the editor open");
        parent.wait_for_text(&mut instance, &format!("round {round}"));
        assert_eq!(parent.children(), 1);
        instance.close_editor().unwrap();
    }
}

#[test]
fn an_instance_that_goes_takes_its_open_window_and_its_threads_along() {
    let _turn = alone();
    let mut threads = usize::MAX;
    for round in 0..3 {
        let mut instance = instance();
        let parent = Parent::around(&mut instance);
        parent.wait_for_text(&mut instance, &format!("round {round}"));
        assert_eq!(parent.children(), 1);
        drop(instance);
        assert_eq!(parent.children(), 0, "round {round}: the window is still there");
        let left = fewest_threads(1, Duration::from_secs(2));
        // The first window may leave threads of the graphics driver behind.
        assert!(left <= threads, "round {round}: {left} threads, {threads} after the first");
        threads = left;
    }
}

/// Set where [`windows_open_and_close`] is to do so.
const OPENS: &str = "OVERHEAR_TEST_OPENS";

/// Runs in a process of its own, whose log another test reads: see below.
#[test]
#[ignore = "runs in the process of another test"]
fn windows_open_and_close() {
    if std::env::var_os(OPENS).is_none() {
        return;
    }
    let mut instance = instance();
    for round in 0..30 {
        let parent = Parent::around(&mut instance);
        // Some windows close before they are drawn.
        if round % 3 > 0 {
            parent.wait_for_text(&mut instance, &format!("round {round}"));
        }
        instance.close_editor().unwrap();
        assert_eq!(parent.children(), 0, "round {round}");
    }
}

#[test]
fn a_window_that_closes_logs_nothing() {
    let _turn = alone();
    keep_display();
    let mut test = Command::new(std::env::current_exe().unwrap());
    test.args(["--exact", "window::windows_open_and_close", "--ignored", "--nocapture"]).env(OPENS, "");
    let done = test.output().unwrap();
    let (said, logged) = (String::from_utf8_lossy(&done.stdout), String::from_utf8_lossy(&done.stderr));
    assert!(done.status.success() && said.contains("1 passed"), "{said}{logged}");
    let lines: Vec<_> = said.lines().chain(logged.lines()).filter(|line| line.contains("X11")).collect();
    assert!(lines.is_empty(), "{} lines, the first: {}", lines.len(), lines[0]);
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

/// Plays a stroke now and then in about real time, until it is told to stop; gives the blocks and the peak.
fn play(processor: &mut Processor, stop: &AtomicBool) -> anyhow::Result<(u32, f32)> {
    let mut sound = [[0.0; 256], [0.0; 256]];
    let (mut blocks, mut peak) = (0_u32, 0.0_f32);
    while !stop.load(Ordering::Acquire) {
        let what = What::NoteOn { channel: 9, key: 36 + (blocks % 24) as u8, velocity: 0.7 };
        let events = if blocks.is_multiple_of(40) { vec![Event { offset: 100, what }] } else { Vec::new() };
        let [left, right] = &mut sound;
        processor.process(&events, left, right)?;
        peak = left.iter().chain(&*right).fold(peak, |peak, sample| peak.max(sample.abs()));
        blocks += 1;
        // So that the windows get their turn.
        thread::sleep(Duration::from_millis(3));
    }
    Ok((blocks, peak))
}

#[test]
fn a_window_goes_on_drawing_while_the_kit_rings() {
    /// More than anything but the kit's own motion brings about.
    const PICTURES: usize = 25;
    let _turn = alone();
    let mut instance = instance();
    let stop = AtomicBool::new(false);
    let look = |instance: &mut Instance| {
        let _stop = Stop(&stop);
        let parent = Parent::around(instance);
        parent.wait_for_text(instance, "at first");
        let (mut seen, mut since) = (HashSet::new(), Instant::now());
        while seen.len() < PICTURES {
            if seen.insert(parent.picture()) {
                since = Instant::now();
            }
            assert!(since.elapsed() < PATIENCE, "it stopped after {} pictures", seen.len());
            instance.answer();
            thread::sleep(Duration::from_millis(10));
        }
        instance.close_editor()
    };
    instance.run_beside(48_000.0, 1..=256, |processor| play(processor, &stop), look).expect("it plays");
}

/// Processor time of this process so far, s.
fn processor_time() -> f64 {
    // SAFETY: plain data, valid when it is zero, and room for it.
    let usage = unsafe {
        let mut usage: libc::rusage = std::mem::zeroed();
        assert_eq!(libc::getrusage(libc::RUSAGE_SELF, &mut usage), 0);
        usage
    };
    [usage.ru_utime, usage.ru_stime].map(|time| time.tv_sec as f64 + 1e-6 * time.tv_usec as f64).iter().sum()
}

#[test]
fn a_host_that_stops_the_audio_in_mid_ring_leaves_a_window_at_rest() {
    /// How long it may take to notice, and how long is measured, s.
    const NOTICED: Duration = Duration::from_secs(2);
    const MEASURED: Duration = Duration::from_secs(4);
    let _turn = alone();
    let mut instance = instance();
    let (rings, stop) = (AtomicBool::new(false), AtomicBool::new(false));
    let ring = |processor: &mut Processor| {
        let [mut left, mut right] = [vec![0.0; 512], vec![0.0; 512]];
        let strike = |key| Event { offset: 0, what: What::NoteOn { channel: 9, key, velocity: 1.0 } };
        processor.process(&[strike(49), strike(51)], &mut left, &mut right)?;
        for _ in 0..40 {
            processor.process(&[], &mut left, &mut right)?;
            // So that the window sees it.
            thread::sleep(Duration::from_millis(10));
        }
        let peak = left.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
        rings.store(true, Ordering::Release);
        while !stop.load(Ordering::Acquire) {
            thread::sleep(Duration::from_millis(50));
        }
        Ok(peak)
    };
    let look = |instance: &mut Instance| {
        let _stop = Stop(&stop);
        let parent = Parent::around(instance);
        parent.wait_for_text(instance, "at first");
        while !rings.load(Ordering::Acquire) {
            thread::sleep(Duration::from_millis(10));
        }
        thread::sleep(NOTICED);
        let before = processor_time();
        thread::sleep(MEASURED);
        let share = (processor_time() - before) / MEASURED.as_secs_f64();
        println!("a window at rest takes {:.2} % of a core", 100.0 * share);
        assert!(share < 0.02, "{:.1} % of a core", 100.0 * share);
        instance.close_editor()
    };
    let peak = instance.run_beside(48_000.0, 1..=512, ring, look).expect("it plays");
    assert!(peak > 0.01, "nothing rang: {peak}");
}

/// Memory that is allocated and not freed, bytes: of the whole process, the plugin and the graphics driver included. Unlike what
/// is resident it does not count what the allocator keeps for later.
fn allocated() -> u64 {
    // SAFETY: it reads the allocator's own books, under its own locks.
    let books = unsafe { libc::mallinfo2() };
    (books.uordblks + books.hblkhd) as u64
}

/// Windows opened and closed in a row.
const WINDOWS: usize = 100;

/// What drivers and allocators keep has settled after so many.
const SETTLED: usize = 20;

#[test]
fn a_hundred_windows_opened_and_closed_while_it_plays_leave_no_thread_and_only_their_keymaps() {
    let _turn = alone();
    let mut instance = instance();
    let stop = AtomicBool::new(false);
    let open_and_close = |instance: &mut Instance| {
        let _stop = Stop(&stop);
        let (mut threads, mut memory) = (0, 0);
        for round in 0..WINDOWS {
            let parent = Parent::around(instance);
            parent.wait_for_text(instance, &format!("round {round}"));
            instance.close_editor()?;
            if round == 0 {
                // The first window may leave threads of the graphics driver behind.
                threads = fewest_threads(0, Duration::from_secs(2));
            }
            if round + 1 == SETTLED {
                memory = allocated();
            }
        }
        let left = fewest_threads(threads, PATIENCE);
        assert!(left <= threads, "{left} threads after {WINDOWS} windows, {threads} after the first");
        let each = allocated().saturating_sub(memory) / (WINDOWS - SETTLED) as u64;
        println!("a window leaves {each} bytes");
        // Of a window nothing stays but its keymap, which baseview 0.4.2 never frees: 70 kB with the usual layouts
        // (docs/limits.md). Its fonts, textures and meshes are megabytes, and a driver loaded anew keeps 8 kB.
        // What pieces are built beside them moves the allocator's books by some kilobytes either way.
        assert!(each < 76 << 10, "a window leaves {each} bytes");
        Ok(())
    };
    let play = |processor: &mut Processor| play(processor, &stop);
    let (blocks, peak) = instance.run_beside(48_000.0, 1..=256, play, open_and_close).expect("it plays");
    assert!(blocks > 100 && peak > 0.01 && peak.is_finite(), "{blocks} blocks, peak {peak}");
}
