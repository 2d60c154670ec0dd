use std::f64::consts::TAU;

use super::attachment::{Attachment, Site};
use super::body::{FreeStep, StruckBody};
use super::contacts::Contacts;
use super::*;
use crate::modal::{InputVector, Pressure};
use crate::piece::Member;
use crate::shapes::ShapeIndex;
use crate::strike::{Strike, Striker};

/// A surface of one mode, the same everywhere.
fn surface() -> Surface {
    let index = ShapeIndex { radial: 0, rows: 1, m: 0, member: Member::Cosine, axis: 0.0 };
    Surface::new(SurfaceParts {
        modes: vec![Mode { omega: TAU * 200.0, sigma: 0.0, mass: 0.1 }],
        shapes: ShapeTable::new(&vec![1.0; ShapeTable::radii().len()], vec![index]),
        transfer: vec![[1.0, 0.0]],
        material: Material::FILM,
        lossless: true,
        sample_rate: 44_100.0,
    })
}

fn run(surface: &mut Surface, samples: usize) {
    let mut out = [[0.0; 32]; RECEIVERS];
    surface.render_in_air(out.each_mut().map(|row| &mut row[..samples]), None);
}

/// Pulls the body up by a steady force, N, while it is engaged; notes what it is asked.
struct Pull {
    port: InputVector,
    force: f32,
    engaged: bool,
    asked: Vec<&'static str>,
}

impl Pull {
    fn new(force: f32) -> Pull {
        let mut port = InputVector::new(1);
        port.shape_mut()[0] = 1.0;
        Pull { port, force, engaged: false, asked: Vec::new() }
    }
}

impl Attachment for Pull {
    fn attached(&mut self, site: Site<'_>) {
        site.body.modal().connect(&mut self.port);
    }

    fn follow(&mut self, body: &StruckBody) {
        self.asked.push("follow");
        body.modal().connect(&mut self.port);
    }

    fn wake(&mut self, _site: Site<'_>) {
        self.asked.push("wake");
        self.engaged = true;
    }

    fn step(&mut self, _body: &StruckBody, _free: &FreeStep) {
        self.asked.push("step");
    }

    fn solve(&mut self, _contacts: &mut Contacts, _free: &FreeStep) -> bool {
        self.asked.push("solve");
        false
    }

    fn push(&mut self, _point: usize, force: f64) {
        assert!(force > 0.0);
        self.asked.push("push");
    }

    fn press(&mut self, body: &mut StruckBody) -> (f64, Pressure) {
        self.asked.push("press");
        body.modal_mut().push(&self.port, -self.force);
        (0.0, Pressure::default())
    }

    fn finish(&mut self, _contacts: &Contacts, _free: &FreeStep) -> Pressure {
        self.asked.push("finish");
        Pressure::default()
    }

    fn is_engaged(&self) -> bool {
        self.engaged
    }

    fn reset(&mut self, _contacts: &mut Contacts) {
        self.engaged = false;
    }
}

#[test]
fn an_attachment_goes_through_a_sample_in_the_order_its_docs_say() {
    let mut surface = surface();
    surface.attach(Pull::new(0.0));
    surface.strike(&Strike { speed: 2.0, radius: 0.0, angle: 0.0, striker: Striker::Stick });
    run(&mut surface, 1);
    let pull = surface.attachment::<Pull>().unwrap();
    assert_eq!(pull.asked, ["wake", "step", "solve", "push", "press", "finish"]);
}

#[test]
fn the_force_of_an_attachment_bends_the_body_as_far_as_it_should() {
    let mut surface = surface();
    surface.attach(Pull::new(3.0));
    run(&mut surface, 32);
    assert!(surface.body().is_still(), "moved by what is not engaged");
    surface.wake();
    // To where a force that is put on at once takes an oscillator: twice the static deflection, after half a period.
    let mut farthest = 0.0_f32;
    for _ in 0..80 {
        run(&mut surface, 4);
        farthest = farthest.min(surface.body().displacement(0));
    }
    let statically = 3.0 / (0.1 * (TAU * 200.0).powi(2));
    assert!((f64::from(-farthest) / (2.0 * statically) - 1.0).abs() < 0.01, "{farthest} {statically}");
    surface.reset();
    run(&mut surface, 32);
    assert!(surface.body().is_still(), "engaged after a reset");
}

#[test]
fn an_attachment_is_found_by_its_kind_and_told_of_changed_modes() {
    let mut surface = surface();
    assert!(surface.attachment::<Pull>().is_none());
    surface.attach(Pull::new(1.0));
    assert!(surface.attachment::<AttachedRim>().is_none());
    surface.retune(|_, mode| Mode { omega: 1.1 * mode.omega, ..*mode });
    assert_eq!(surface.attachment::<Pull>().unwrap().asked, ["follow"]);
    let mut changed = false;
    surface.with(|_: &mut AttachedRim, _| unreachable!("there is no rim"));
    surface.with(|pull: &mut Pull, site| changed = pull.force == 1.0 && !site.contacts.is_struck());
    assert!(changed);
}
