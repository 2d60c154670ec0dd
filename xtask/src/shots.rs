//! `shots`: pictures of the built plugin's editor.
//!
//! Opens the editor of the built CLAP in the embedded host, in a window on a virtual display, plays, and writes
//! screenshots. The page is selected as a project selects it: by the view in the plugin's state.

pub mod cost;
mod window;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};
use overhear_engine::kit_spec::KitSpec;
use serde_json::{Value, json};

use crate::suite::display::Display;
use crate::workspace::Format;
use overhear_cli::host::{Bundle, Event, Instance, Processor, What};
use overhear_cli::{host, output};

use crate::bundle;
use window::HostWindow;

/// Sample rate, Hz, and samples of a buffer.
const RATE: f64 = 48_000.0;
const BLOCK: usize = 1024;

/// Size of a window as designed, points.
const SIZE: [u32; 2] = [1080, 700];

/// One picture: what is shown, what is played, and how long after it is taken.
struct Shot {
    name: &'static str,
    page: u8,
    /// Name of the piece that the panels are about.
    piece: &'static str,
    /// Notes and velocities, a beat apart; the picture is taken after the last.
    notes: &'static [(u8, f32)],
    /// From the last note to the picture.
    wait: Duration,
}

/// From one note to the next: so that meters and energies show all of them.
const BEAT: Duration = Duration::from_millis(250);

const fn shot(
    name: &'static str,
    page: u8,
    piece: &'static str,
    notes: &'static [(u8, f32)],
    wait: u64,
) -> Shot {
    Shot { name, page, piece, notes, wait: Duration::from_millis(wait) }
}

/// The pictures, in the order they are taken; pieces sound on from one to the next, so the one at rest is the first.
const SHOTS: &[Shot] = &[
    shot("kit", 0, "snare", &[], 600),
    shot("rack-tom", 0, "rack-tom", &[(48, 1.0)], 420),
    shot("crash", 0, "crash", &[(49, 0.95)], 420),
    shot(
        "physics",
        1,
        "rack-tom",
        &[(36, 0.9), (42, 0.7), (38, 0.8), (51, 0.8), (36, 0.8), (49, 0.8), (41, 0.9), (48, 1.0)],
        500,
    ),
    shot("cascade", 1, "crash", &[(38, 0.6), (49, 1.0)], 1_100),
    shot("wires", 1, "snare", &[(36, 0.8), (38, 0.9)], 300),
    shot("mix", 2, "rack-tom", &[(41, 0.9), (38, 0.9)], 200),
    shot("microphones", 3, "snare", &[], 400),
    shot("midi", 4, "snare", &[], 400),
    shot("settings", 5, "snare", &[], 400),
    shot("build", 6, "snare", &[], 400),
    shot("build-cymbal", 6, "crash", &[], 400),
];

/// Task for the editor.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Aim {
    /// Every picture is taken and written to a folder.
    Pictures(PathBuf),
    /// The same in the dark palette at 1x only.
    Glance(PathBuf),
    /// Measure and print its cost.
    Cost,
}

/// Opens the editor of the plugin at `plugin`, or of one that is built first, on a display of its own.
///
/// # Errors
/// If there is no display to draw on, the plugin does not build, or its editor does not show.
pub fn run(aim: &Aim, plugin: Option<PathBuf>) -> Result<()> {
    let plugin = match plugin {
        Some(plugin) => plugin,
        None => {
            let mut bundles = bundle::run()?.into_iter();
            let clap = bundles.find(|(format, _)| *format == Format::Clap);
            clap.context("the build made no CLAP bundle")?.1
        }
    };
    let display = Display::start()?;
    // The display is found through the environment, which a process must not change under its own threads.
    let mut again = Command::new(std::env::current_exe()?);
    again.args(["shots", "--here"]);
    match aim {
        Aim::Pictures(folder) => again.arg("--out").arg(folder),
        Aim::Glance(folder) => again.arg("--glance").arg("--out").arg(folder),
        Aim::Cost => again.arg("--cost"),
    };
    let status = again
        .arg("--plugin")
        .arg(plugin)
        .env("DISPLAY", display.name())
        .env("LIBGL_ALWAYS_SOFTWARE", "1")
        .status()
        .context("cannot start over under the display")?;
    ensure!(status.success(), "the editor could not be seen");
    Ok(())
}

/// Takes the pictures on the display of the environment, in the dark palette at 1x only if it is a glance.
///
/// # Errors
/// If the plugin does not load or its editor does not show.
pub fn here(folder: &Path, glance: bool, plugin: &Path) -> Result<()> {
    let looks = [(false, 1), (false, 2), (true, 1), (true, 2)];
    pictures(folder, plugin, if glance { &looks[..1] } else { &looks })
}

/// Takes every picture in each of the looks: whether it is light, and how large everything is.
fn pictures(folder: &Path, plugin: &Path, looks: &[(bool, u32)]) -> Result<()> {
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make `{}`", folder.display()))?;
    let bundle = Bundle::load(plugin)?;
    let mut instance = bundle.instantiate()?;
    let (notes, played) = channel();
    let play = move |processor: &mut Processor| play(processor, &played, |sound| sound());
    instance.run_beside(RATE, 1..=BLOCK as u32, play, |instance| {
        for (set, &(light, zoom)) in looks.iter().enumerate() {
            if set > 0 {
                // So that the next one at rest is.
                pass(instance, Duration::from_secs(8));
            }
            let theme = if light { "light" } else { "dark" };
            for shot in SHOTS {
                let path = folder.join(format!("{}-{theme}-{zoom}x.png", shot.name));
                let png = take(instance, shot, (light, zoom), &notes)?;
                output::write(&path, &png)?;
                println!("{}", path.display());
            }
        }
        drop(notes);
        Ok(())
    })
}

/// Opens the editor, plays, and takes the picture.
fn take(
    instance: &mut Instance,
    shot: &Shot,
    (light, zoom): (bool, u32),
    notes: &Sender<(u8, f32)>,
) -> Result<Vec<u8>> {
    let state = with_view(&instance.save_state()?, shot, (light, zoom), SIZE)?;
    instance.load_state(&state)?;
    let window = instance.open_editor(|width, height| {
        let window = HostWindow::open(width, height)?;
        Ok((window.id(), window))
    })?;
    window.wait(instance)?;
    for (place, note) in shot.notes.iter().enumerate() {
        if place > 0 {
            pass(instance, BEAT);
        }
        notes.send(*note).context("nobody plays")?;
    }
    // Where the processor draws, more points take longer.
    pass(instance, shot.wait * zoom);
    let png = window.png()?;
    instance.close_editor()?;
    // The window must be destroyed after the editor in it.
    drop(window);
    Ok(png)
}

/// Lets time pass, as a host does.
fn pass(instance: &mut Instance, time: Duration) {
    let until = Instant::now() + time;
    while Instant::now() < until {
        instance.answer();
        thread::sleep(Duration::from_millis(5));
    }
}

/// A state that shows what a shot wants.
fn with_view(state: &[u8], shot: &Shot, (light, zoom): (bool, u32), size: [u32; 2]) -> Result<Vec<u8>> {
    host::with_fields(state, |fields| {
        let known = fields.get("view").and_then(Value::as_str).context("the state has no view")?;
        let mut view: Value = serde_json::from_str(known)?;
        let usual = view.as_array_mut().context("the view is not a list")?;
        ensure!(usual.len() == 5, "the view has other fields than this command knows");
        let kit = KitSpec::standard();
        let (slot, _) = kit.find(shot.piece).with_context(|| format!("no {} in the kit", shot.piece))?;
        (usual[0], usual[1], usual[2], usual[4]) =
            (json!(shot.page), json!(light), json!(slot.index()), json!(zoom));
        fields.insert("view".into(), view.to_string().into());
        fields.insert("window".into(), json!(size).to_string().into());
        Ok(())
    })
}

/// Plays the events that are sent, in real time, until the channel closes; `buffer` processes each buffer.
fn play(
    processor: &mut Processor,
    notes: &Receiver<(u8, f32)>,
    mut buffer: impl FnMut(&mut dyn FnMut() -> Result<()>) -> Result<()>,
) -> Result<()> {
    let (mut left, mut right) = ([0.0; BLOCK], [0.0; BLOCK]);
    let length = Duration::from_secs_f64(BLOCK as f64 / RATE);
    let mut due = Instant::now();
    loop {
        let mut events = Vec::new();
        loop {
            use std::sync::mpsc::TryRecvError;
            match notes.try_recv() {
                Ok((key, velocity)) => {
                    events.push(Event { offset: 0, what: What::NoteOn { channel: 9, key, velocity } });
                }
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => return Ok(()),
            }
        }
        buffer(&mut || processor.process(&events, &mut left, &mut right))?;
        due += length;
        // Late buffers are not made up: a picture needs no continuous sound.
        let now = Instant::now();
        due = due.max(now);
        thread::sleep(due - now);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_is_put_into_a_state_that_has_one() {
        let state = json!({"fields": {"view": "[0,false,1,[0.5,0.5,2.0],1.0]", "window": "[1,2]"}});
        let bytes = |state: &Value| [&[0; 8][..], &serde_json::to_vec(state).unwrap()].concat();
        let changed = with_view(&bytes(&state), &SHOTS[1], (true, 2), SIZE).unwrap();
        let changed: Value = serde_json::from_slice(&changed[8..]).unwrap();
        assert_eq!(changed["fields"]["view"], "[0,true,2,[0.5,0.5,2.0],2]");
        assert_eq!(changed["fields"]["window"], "[1080,700]");
        assert!(with_view(&bytes(&json!({"fields": {}})), &SHOTS[1], (true, 2), SIZE).is_err());
    }

    #[test]
    fn every_picture_is_about_a_piece_of_the_standard_kit() {
        let kit = KitSpec::standard();
        assert!(SHOTS.iter().all(|shot| kit.find(shot.piece).is_some()));
    }
}
