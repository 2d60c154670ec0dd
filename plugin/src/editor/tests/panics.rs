//! An editor that panics wherever the framework calls it without a window.

use nice_plug::editor::dpi::LogicalSize;
use overhear_player::builder::Builder;
use overhear_player::building::{BuildPlan, Pace};
use overhear_player::strokes::strokes;

use super::*;
use crate::guard::failing::while_panicking;
use crate::monitor::monitor;

fn editor() -> OverhearEditor {
    let parameters = Arc::new(HostParameters::default());
    let document = parameters.document();
    let plan = move || {
        BuildPlan::of(document.clone(), |index| parameters::parameters()[index].default, Pace::RealTime)
    };
    let builder = Builder::new(Arc::new(plan), parameters.deadlines().clone());
    OverhearEditor::new(parameters, monitor().1, builder.shapes(), strokes().0)
}

fn resize(app: &mut App, width: f64, height: f64) {
    let size = LogicalSize::new(width, height);
    app.resized(WindowSize { physical: size.to_physical(1.0), logical: size, scale_factor: 1.0 });
}

#[test]
fn a_panic_of_the_editor_is_kept_from_the_framework() {
    let editor = editor();
    let size = editor.size();
    let (broken, panics) = while_panicking("Editor::size", || editor.size());
    assert_eq!((broken, panics), (NativeSize::new(0, 0), 1));
    assert_eq!(editor.size(), size);
}

#[test]
fn a_window_that_panicked_is_left_alone_and_the_next_one_works() {
    let editor = editor();
    let mut app = App::new(editor.sources.clone(), Farewell::new().0);
    resize(&mut app, 900.0, 600.0);
    assert_eq!(editor.sources.parameters.window(), (900, 600));
    let ((), panics) = while_panicking("the window's size", || resize(&mut app, 1000.0, 700.0));
    assert!(panics == 1 && app.broken, "{panics} panics");
    resize(&mut app, 1100.0, 800.0);
    assert_eq!(editor.sources.parameters.window(), (900, 600), "a broken window goes on");
    let mut next = App::new(editor.sources.clone(), Farewell::new().0);
    resize(&mut next, 1100.0, 800.0);
    assert_eq!(editor.sources.parameters.window(), (1100, 800));
}
