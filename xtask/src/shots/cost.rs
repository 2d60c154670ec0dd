//! CPU cost of an open editor: the window's threads, and the audio thread.
//!
//! Counted is the processor time that the kernel gave to each thread (`/proc/self/task/*/schedstat`), which says the same
//! on a machine that others use as well. A window's threads are those that were not there before the first one was opened:
//! the one that draws, the rasterizer's where the processor draws, and the one that watches.
//!
//! The audio thread does the same work with a window or without; what a window can take from it is the processor's
//! own: a shared core, shared caches, heat. Its time is therefore told in that of the calibration loop of `bench`, a slice of
//! which runs after every buffer on the same thread: what slows the whole core is in both, what is left is the
//! plugin's.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Mutex;
use std::sync::mpsc::{Sender, channel};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow, ensure};
use cpu_time::ThreadTime;

use super::window::HostWindow;
use super::{BLOCK, RATE, Shot, pass, play, shot, with_view};
use overhear_cli::bench::calibration::Calibration;
use overhear_cli::host::{Bundle, Instance, Processor};

/// Size of the window, points: the smallest there is.
const SIZE: [u32; 2] = [800, 500];

/// From the opening to the first count, and how long is counted.
const SETTLE: Duration = Duration::from_secs(4);
const COUNTED: Duration = Duration::from_secs(8);

/// From one stroke to the next while the kit rings.
const BEAT: Duration = Duration::from_millis(250);

/// Pairs of a closed and an open window by which the audio thread is judged.
const PAIRS: usize = 8;

/// Strokes of a groove on every piece.
const GROOVE: &[(u8, f32)] =
    &[(36, 0.8), (42, 0.6), (38, 0.8), (51, 0.7), (48, 0.8), (49, 0.7), (41, 0.8), (55, 0.6)];

/// Pages that are counted, at rest and ringing.
const PAGES: &[Shot] = &[
    shot("kit", 0, "rack-tom", &[], 0),
    shot("physics", 1, "rack-tom", &[], 0),
    shot("mix", 2, "rack-tom", &[], 0),
    shot("settings", 5, "rack-tom", &[], 0),
];

/// Processor time of threads so far, by id.
type Times = BTreeMap<u64, (String, Duration)>;

/// Shares of a core, by name of the threads.
type Shares = BTreeMap<String, f64>;

/// Counts on the display of the environment, and prints what it finds.
///
/// # Errors
/// If the plugin does not load, its editor does not show, or the system does not tell what threads take.
pub fn here(plugin: &Path) -> Result<()> {
    let bundle = Bundle::load(plugin)?;
    let mut instance = bundle.instantiate()?;
    let (notes, played) = channel();
    let meter = Meter::default();
    let own = &meter;
    let work = move |processor: &mut Processor| {
        let mut calibration = Calibration::new();
        play(processor, &played, |sound| own.time(&mut calibration, sound))
    };
    instance.run_beside(RATE, 1..=BLOCK as u32, work, |instance| {
        pass(instance, Duration::from_secs(1));
        let before: BTreeSet<u64> = times()?.into_keys().collect();
        println!("window of {} x {}, share of a core over {} s", SIZE[0], SIZE[1], COUNTED.as_secs());
        println!(
            "{:<10} {:>9} {:>9} {:>9}   threads while ringing",
            "page", "at rest", "ringing", "frames/s"
        );
        // At rest first, as cymbals ring for long.
        let resting = PAGES.iter().map(|page| {
            beside_window(instance, page, |instance, _| {
                pass(instance, SETTLE);
                count(instance, &before, None)
            })
        });
        let resting = resting.collect::<Result<Vec<_>>>()?;
        for (page, resting) in PAGES.iter().zip(resting) {
            let (ringing, frames) = beside_window(instance, page, |instance, window| {
                Ok((count(instance, &before, Some(&notes))?, frames(instance, window, &notes)?))
            })?;
            // A window that has stopped costs nothing; the measurement would be meaningless.
            ensure!(frames > 1.0, "the window draws {frames:.1} frames a second of the {} page", page.name);
            println!("{}", row(page, &resting, &ringing, frames));
        }
        println!("{}", beside(instance, &meter, &notes)?);
        drop(notes);
        Ok(())
    })
}

/// Processor time of the audio thread: what the plugin took, and the calibration slices between its buffers, s.
#[derive(Default)]
struct Meter {
    /// Behind a lock: the measuring thread has no deadline.
    taken: Mutex<[f64; 2]>,
}

impl Meter {
    /// Does a buffer's work and a slice of the loop, and counts both.
    fn time(&self, calibration: &mut Calibration, work: &mut dyn FnMut() -> Result<()>) -> Result<()> {
        let start = ThreadTime::now();
        work()?;
        let took = [start.elapsed().as_secs_f64(), calibration.slice()];
        let mut taken = self.taken.lock().map_err(|_| anyhow!("who reads the meter died"))?;
        taken.iter_mut().zip(took).for_each(|(sum, time)| *sum += time);
        Ok(())
    }

    /// Counts so far.
    fn taken(&self) -> Result<[f64; 2]> {
        Ok(*self.taken.lock().map_err(|_| anyhow!("the audio thread died"))?)
    }
}

/// Opens a page, works beside it, and closes it.
fn beside_window<T>(
    instance: &mut Instance,
    page: &Shot,
    work: impl FnOnce(&mut Instance, &HostWindow) -> Result<T>,
) -> Result<T> {
    let window = open(instance, page)?;
    let done = work(instance, &window);
    instance.close_editor()?;
    // The window must be destroyed after the editor in it.
    drop(window);
    done
}

/// A line of the table.
fn row(page: &Shot, resting: &Shares, ringing: &Shares, frames: f64) -> String {
    let sum = |shares: &Shares| 100.0 * shares.values().sum::<f64>();
    let each: Vec<_> = ringing.iter().map(|(name, share)| format!("{name} {:.1} %", 100.0 * share)).collect();
    let (rest, ring) = (sum(resting), sum(ringing));
    format!("{:<10} {rest:>7.2} % {ring:>7.2} % {frames:>9.1}   {}", page.name, each.join(", "))
}

fn open(instance: &mut Instance, page: &Shot) -> Result<HostWindow> {
    let state = with_view(&instance.save_state()?, page, (false, 1), SIZE)?;
    instance.load_state(&state)?;
    let window = instance.open_editor(|width, height| {
        let window = HostWindow::open(width, height)?;
        Ok((window.id(), window))
    })?;
    window.wait(instance)?;
    Ok(window)
}

/// Shares of a core that threads take which were not there `before`, by name; with strokes, if they have somewhere to go.
fn count(
    instance: &mut Instance,
    before: &BTreeSet<u64>,
    notes: Option<&Sender<(u8, f32)>>,
) -> Result<Shares> {
    if notes.is_some() {
        // Count only after the kit rings.
        groove(instance, notes, Duration::from_secs(2))?;
    }
    let (first, begun) = (times()?, Instant::now());
    groove(instance, notes, COUNTED)?;
    let (last, took) = (times()?, begun.elapsed());
    let mut shares = BTreeMap::new();
    for (id, (name, time)) in last.into_iter().filter(|(id, _)| !before.contains(id)) {
        let earlier = first.get(&id).map_or(Duration::ZERO, |(_, time)| *time);
        // The rasterizer has a thread for each core, with its number.
        let name = name.trim_end_matches(|c: char| c.is_ascii_digit() || c == '-').to_owned();
        *shares.entry(name).or_insert(0.0) += (time - earlier).as_secs_f64() / took.as_secs_f64();
    }
    Ok(shares)
}

/// Lets time pass, with strokes if they have somewhere to go.
fn groove(instance: &mut Instance, notes: Option<&Sender<(u8, f32)>>, time: Duration) -> Result<()> {
    let beats = (time.as_secs_f64() / BEAT.as_secs_f64()).round() as usize;
    for beat in 0..beats {
        if let Some(notes) = notes {
            notes.send(GROOVE[beat % GROOVE.len()]).context("nobody plays")?;
        }
        pass(instance, BEAT);
    }
    Ok(())
}

/// Different pictures seen a second while the kit rings, as far as one who looks every 15 ms sees them.
fn frames(instance: &mut Instance, window: &HostWindow, notes: &Sender<(u8, f32)>) -> Result<f64> {
    const SEEN: Duration = Duration::from_secs(4);
    let (begun, mut beats, mut pictures) = (Instant::now(), 0, 0);
    let mut former = Vec::new();
    while begun.elapsed() < SEEN {
        if begun.elapsed() >= BEAT * beats {
            notes.send(GROOVE[beats as usize % GROOVE.len()]).context("nobody plays")?;
            beats += 1;
        }
        let picture = window.pixels()?;
        pictures += u32::from(picture != former);
        former = picture;
        pass(instance, Duration::from_millis(15));
    }
    Ok(f64::from(pictures) / begun.elapsed().as_secs_f64())
}

/// What the audio thread takes with a window open against without, in two lines: in slices of the calibration loop, and
/// as the clock has it.
///
/// Both play the same strokes; closed and open take turns, and the middle of the ratios counts, so that what else goes
/// on in the machine falls out.
fn beside(instance: &mut Instance, meter: &Meter, notes: &Sender<(u8, f32)>) -> Result<String> {
    let mut ratios = [Vec::new(), Vec::new()];
    for pair in 0..PAIRS {
        let mut took = [[0.0; 2]; 2];
        // The second measurement finds the processor warm, so both alternate.
        for turn in [pair % 2, 1 - pair % 2] {
            took[turn] = match turn {
                0 => audio_time(instance, meter, notes)?,
                _ => beside_window(instance, &PAGES[0], |instance, _| audio_time(instance, meter, notes))?,
            };
        }
        let [[closed, unit], [open, unit_open]] = took;
        ratios[0].push((open / unit_open) / (closed / unit));
        ratios[1].push(open / closed);
    }
    let [measured, clock] = ratios.map(|mut ratios| {
        ratios.sort_by(f64::total_cmp);
        let percent = |ratio: f64| 100.0 * (ratio - 1.0);
        let middle = percent(0.5 * (ratios[(PAIRS - 1) / 2] + ratios[PAIRS / 2]));
        format!("{middle:+.1} % ({:+.1} to {:+.1} %)", percent(ratios[0]), percent(ratios[PAIRS - 1]))
    });
    Ok(format!(
        "audio thread with the window open, middle of {PAIRS} pairs: {measured} of calibrations,\n\
         {clock} of processor time, what a busier processor does to any work included"
    ))
}

/// Processor time of the audio thread while it plays a groove: what the plugin took, and the loop, s.
fn audio_time(instance: &mut Instance, meter: &Meter, notes: &Sender<(u8, f32)>) -> Result<[f64; 2]> {
    groove(instance, Some(notes), Duration::from_secs(1))?;
    let before = meter.taken()?;
    groove(instance, Some(notes), Duration::from_secs(4))?;
    let after = meter.taken()?;
    Ok([after[0] - before[0], after[1] - before[1]])
}

/// Processor time of every thread of this process so far.
fn times() -> Result<Times> {
    let tasks = std::fs::read_dir("/proc/self/task").context("the system does not list its threads")?;
    let one = |folder: &Path| {
        let id = folder.file_name()?.to_str()?.parse().ok()?;
        let name = std::fs::read_to_string(folder.join("comm")).ok()?;
        let spent = std::fs::read_to_string(folder.join("schedstat")).ok()?;
        let nanoseconds = spent.split_whitespace().next()?.parse().ok()?;
        Some((id, (name.trim().to_owned(), Duration::from_nanos(nanoseconds))))
    };
    // A thread that ends meanwhile is left out.
    Ok(tasks.flatten().filter_map(|task| one(&task.path())).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn work_of_a_thread_is_counted_as_its_own() {
        let work = || {
            let begun = Instant::now();
            while begun.elapsed() < Duration::from_millis(50) {
                std::hint::black_box(begun.elapsed());
            }
        };
        let path = std::fs::read_link("/proc/thread-self").unwrap();
        let thread = path.file_name().unwrap().to_str().unwrap().parse().unwrap();
        let spent = |times: &Times| {
            let (_, spent): &(String, Duration) = &times[&thread];
            *spent
        };
        let before = times().unwrap();
        work();
        let spent = spent(&times().unwrap()) - spent(&before);
        assert!(spent > Duration::from_millis(5) && spent <= Duration::from_millis(100), "{spent:?}");
    }

    #[test]
    fn a_buffer_and_its_slice_are_counted_apart() {
        let (meter, mut calibration) = (Meter::default(), Calibration::new());
        for _ in 0..3 {
            meter.time(&mut calibration, &mut || Ok(())).unwrap();
        }
        let [sound, unit] = meter.taken().unwrap();
        assert!(unit > 0.0 && sound < 0.1 * unit, "{sound} {unit}");
    }
}
