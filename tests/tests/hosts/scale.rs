//! The editor on screens with more pixels.

use std::thread;
use std::time::{Duration, Instant};

use x11rb::connection::Connection;
use x11rb::protocol::xproto::{AtomEnum, ConnectionExt, PropMode};
use x11rb::wrapper::ConnectionExt as _;

use crate::hand::own_size;
use crate::window::{PATIENCE, Parent};
use crate::{alone, instance};
use overhear_cli::host::Instance;

/// A fresh instance's window, points.
const POINTS: (u32, u32) = (980, 640);

/// The smallest window, points: docs/editor.md.
const SMALLEST: (u32, u32) = (800, 500);

fn pixels((width, height): (u32, u32), scale: f64) -> (u32, u32) {
    let of = |points: u32| (f64::from(points) * scale).round() as u32;
    (of(width), of(height))
}

/// Waits until the editor's own window has a size.
fn wait_for_size(parent: &Parent, instance: &mut Instance, size: (u32, u32), when: &str) {
    let begun = Instant::now();
    while own_size(parent) != size {
        assert!(begun.elapsed() < PATIENCE, "{when}: it stays at {:?}, not {size:?}", own_size(parent));
        instance.answer();
        thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn every_window_opens_at_the_host_s_scale() {
    let _turn = alone();
    let mut instance = instance();
    for (round, scale) in [2.0, 2.0, 2.0, 1.0, 1.5, 1.0, 2.0].into_iter().enumerate() {
        let when = format!("window {round}, scale {scale}");
        let parent = Parent::scaled(&mut instance, Some(scale));
        assert_eq!(parent.size, pixels(POINTS, scale), "{when}");
        wait_for_size(&parent, &mut instance, pixels(POINTS, scale), &when);
        parent.wait_for_text(&mut instance, &when);
        instance.close_editor().unwrap();
    }
}

#[test]
fn the_smallest_size_is_in_points() {
    let _turn = alone();
    let mut instance = instance();
    for scale in [2.0, 2.0, 1.0] {
        let parent = Parent::scaled(&mut instance, Some(scale));
        let smallest = pixels(SMALLEST, scale);
        let below = (smallest.0 - 1, smallest.1);
        assert!(instance.force_editor_size(below.0, below.1).is_err(), "scale {scale}: {below:?} is taken");
        assert_eq!(instance.resize_editor(below.0, below.1).unwrap(), smallest, "scale {scale}");
        wait_for_size(&parent, &mut instance, smallest, &format!("scale {scale}"));
        instance.close_editor().unwrap();
    }
    let parent = Parent::scaled(&mut instance, Some(1.0));
    assert_eq!(parent.size, SMALLEST, "it opens as it was left");
    instance.close_editor().unwrap();
}

#[test]
fn scales_that_no_screen_has_are_refused() {
    let _turn = alone();
    let mut instance = instance();
    for scale in [0.0, -2.0, 1e-3, 1e6, f64::INFINITY, f64::NAN] {
        let opened = instance.open_editor_scaled(Some(scale), |_, _| Ok((0, ())));
        assert!(opened.is_err(), "the scale {scale} is taken");
        instance.close_editor().unwrap();
    }
    let parent = Parent::scaled(&mut instance, Some(2.0));
    assert_eq!(parent.size, pixels(POINTS, 2.0));
    instance.close_editor().unwrap();
}

/// The screen's own resolution, taken back when dropped.
struct Resolution<'a>(&'a Parent);

impl Resolution<'_> {
    fn new(parent: &Parent, dots_per_inch: u32) -> Resolution<'_> {
        let (root, text) = (root(parent), format!("Xft.dpi:\t{dots_per_inch}\n"));
        let (kind, string) = (AtomEnum::RESOURCE_MANAGER, AtomEnum::STRING);
        let change =
            parent.connection.change_property8(PropMode::REPLACE, root, kind, string, text.as_bytes());
        change.unwrap().check().unwrap();
        Resolution(parent)
    }
}

impl Drop for Resolution<'_> {
    fn drop(&mut self) {
        let change = self.0.connection.delete_property(root(self.0), AtomEnum::RESOURCE_MANAGER.into());
        change.unwrap().check().unwrap();
    }
}

fn root(parent: &Parent) -> u32 {
    parent.connection.setup().roots[0].root
}

#[test]
fn the_screen_s_own_scale_counts_more_than_the_host_s() {
    let _turn = alone();
    let screen = Parent::new(1, 1);
    let mut instance = instance();
    {
        let _resolution = Resolution::new(&screen, 192);
        for scale in [None, Some(1.0), Some(3.0)] {
            let parent = Parent::scaled(&mut instance, scale);
            assert_eq!(parent.size, pixels(POINTS, 2.0), "a host that says {scale:?}");
            let when = format!("a host that says {scale:?}");
            wait_for_size(&parent, &mut instance, pixels(POINTS, 2.0), &when);
            assert_eq!(instance.resize_editor(1, 1).unwrap(), pixels(SMALLEST, 2.0));
            instance.resize_editor(parent.size.0, parent.size.1).unwrap();
            instance.close_editor().unwrap();
        }
    }
    let parent = Parent::scaled(&mut instance, Some(1.0));
    assert_eq!(parent.size, POINTS);
    instance.close_editor().unwrap();
}
