//! Colours and type of the editor.

use egui::{Color32, FontId, Stroke, Visuals};

/// Behind everything.
pub const BACKGROUND: Color32 = Color32::from_rgb(24, 23, 22);
/// Panels and rows.
pub const PANEL: Color32 = Color32::from_rgb(35, 33, 31);
/// The row or knob under the pointer.
pub const HOVERED: Color32 = Color32::from_rgb(46, 43, 40);
/// The selected row, empty meters, knob tracks.
pub const RAISED: Color32 = Color32::from_rgb(66, 61, 55);
/// Text that matters.
pub const TEXT: Color32 = Color32::from_rgb(236, 230, 220);
/// Text that explains.
pub const FAINT: Color32 = Color32::from_rgb(160, 151, 139);
/// What is active: values, selection, upward motion.
pub const ACCENT: Color32 = Color32::from_rgb(240, 146, 60);
/// Downward motion.
pub const DEEP: Color32 = Color32::from_rgb(58, 132, 204);
/// Levels with room to spare.
pub const LEVEL: Color32 = Color32::from_rgb(122, 178, 110);
/// Levels beyond full scale.
pub const OVER: Color32 = Color32::from_rgb(222, 72, 58);

/// Corners of panels, points.
pub const CORNER: f32 = 6.0;

/// Headings.
pub fn heading() -> FontId {
    FontId::proportional(20.0)
}

/// Labels and values.
pub fn body() -> FontId {
    FontId::proportional(14.0)
}

/// Captions.
pub fn caption() -> FontId {
    FontId::proportional(12.0)
}

/// Sets the look of the framework's own widgets.
pub fn apply(context: &egui::Context) {
    let mut visuals = Visuals::dark();
    visuals.panel_fill = BACKGROUND;
    visuals.window_fill = BACKGROUND;
    visuals.extreme_bg_color = BACKGROUND;
    visuals.override_text_color = Some(TEXT);
    visuals.selection.bg_fill = ACCENT.gamma_multiply(0.4);
    visuals.selection.stroke = Stroke::new(1.0, ACCENT);
    context.set_theme(egui::Theme::Dark);
    context.set_visuals(visuals);
}

/// A blend of two colours: `share` 0 gives the first, 1 the second.
pub fn blend(from: Color32, to: Color32, share: f32) -> Color32 {
    from.lerp_to_gamma(to, share.clamp(0.0, 1.0))
}

/// A colour under more or less light: 1 leaves it as it is.
pub fn lit(colour: Color32, light: f32) -> Color32 {
    let scale = |channel: u8| (f32::from(channel) * light).clamp(0.0, 255.0) as u8;
    Color32::from_rgb(scale(colour.r()), scale(colour.g()), scale(colour.b()))
}
