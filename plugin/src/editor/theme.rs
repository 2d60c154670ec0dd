//! Colours and type of the editor: one typeface, a dark and a light palette, one accent for each piece.

use egui::{Color32, FontId, Stroke, Theme, Ui, Visuals};
use overhear_engine::slot::SLOTS;

/// Every colour there is.
#[derive(Debug, Clone, PartialEq)]
pub struct Palette {
    /// Behind everything.
    pub background: Color32,
    /// Panels and rows.
    pub panel: Color32,
    /// The row or knob under the pointer, and buttons, which stand on panels and on the background.
    pub hovered: Color32,
    /// The selected row, empty meters, knob tracks.
    pub raised: Color32,
    /// Text that matters.
    pub text: Color32,
    /// Text that explains.
    pub faint: Color32,
    /// What is active where no piece is meant.
    pub accent: Color32,
    /// Upward motion.
    pub up: Color32,
    /// Downward motion.
    pub down: Color32,
    /// Levels with room to spare.
    pub level: Color32,
    /// Levels beyond full scale, and what went wrong.
    pub over: Color32,
    /// One for each piece, by its slot.
    pub pieces: [Color32; SLOTS],
    /// The stage behind the kit, its top and its bottom.
    pub stage: [Color32; 2],
    /// The stage's floor.
    pub floor: Color32,
    /// The rug under the kit.
    pub rug: Color32,
    /// How dark shadows are, 0 to 1.
    pub shadow: f32,
    /// Drum heads.
    pub film: Color32,
    /// Cymbals.
    pub bronze: Color32,
    /// Hoops, lugs and stands.
    pub chrome: Color32,
    /// Wooden hoops.
    pub hoop: Color32,
    /// Kettles.
    pub copper: Color32,
    /// Sticks.
    pub wood: Color32,
}

const fn rgb(rgb: u32) -> Color32 {
    Color32::from_rgb((rgb >> 16) as u8, (rgb >> 8) as u8, rgb as u8)
}

/// In a dark room.
pub static DARK: Palette = Palette {
    background: rgb(0x171615),
    panel: rgb(0x22201E),
    hovered: rgb(0x2E2B28),
    raised: rgb(0x423D37),
    text: rgb(0xEFE9DF),
    faint: rgb(0xA89F93),
    accent: rgb(0xF0923C),
    up: rgb(0xF58A2A),
    down: rgb(0x2F7FD6),
    level: rgb(0x7AB26E),
    over: rgb(0xE5534B),
    pieces: [
        rgb(0xEB6A5C),
        rgb(0xF29A45),
        rgb(0xE9C94F),
        rgb(0xA4CC50),
        rgb(0x58C990),
        rgb(0x48BFCB),
        rgb(0x68A4F2),
        rgb(0xAD93F7),
        rgb(0xE882BC),
        rgb(0xC9A98B),
        rgb(0xA9E2C6),
        rgb(0xA9D3F5),
        rgb(0xDAC4F6),
        rgb(0xF6BDB7),
        rgb(0xB9B46A),
        rgb(0xD973E6),
    ],
    stage: [rgb(0x2C2A29), rgb(0x1B1A19)],
    floor: rgb(0x1B1A19),
    rug: rgb(0x3A3029),
    shadow: 1.0,
    film: rgb(0xE4DED2),
    bronze: rgb(0xCBA055),
    chrome: rgb(0xC9CBCE),
    hoop: rgb(0x2C2522),
    copper: rgb(0xB86F3E),
    wood: rgb(0xDDB985),
};

/// In daylight.
pub static LIGHT: Palette = Palette {
    background: rgb(0xECE9E4),
    panel: rgb(0xFAF8F5),
    hovered: rgb(0xDFDAD1),
    raised: rgb(0xD3CDC4),
    text: rgb(0x23201D),
    faint: rgb(0x5C554D),
    accent: rgb(0xB85A0C),
    up: rgb(0xE8730F),
    down: rgb(0x1F6CC4),
    level: rgb(0x3F7A34),
    over: rgb(0xC6352B),
    pieces: [
        rgb(0xC23B2E),
        rgb(0xB85F0C),
        rgb(0x8F7200),
        rgb(0x587F10),
        rgb(0x13804F),
        rgb(0x077A88),
        rgb(0x2266BF),
        rgb(0x6B4FC4),
        rgb(0xB03A80),
        rgb(0x7A5A3A),
        rgb(0x3D7568),
        rgb(0x3F5F8F),
        rgb(0x8A3FA6),
        rgb(0x94505A),
        rgb(0x66661E),
        rgb(0xB02FC0),
    ],
    stage: [rgb(0xF4F1EC), rgb(0xDDD8D0)],
    floor: rgb(0xDDD8D0),
    rug: rgb(0xC6B8A6),
    shadow: 0.75,
    film: rgb(0xF3EEE4),
    bronze: rgb(0xD2A759),
    chrome: rgb(0xC4C7CB),
    hoop: rgb(0x3A302B),
    copper: rgb(0xC0743F),
    wood: rgb(0xE2BE88),
};

/// The palette in use.
pub fn of(ui: &Ui) -> &'static Palette {
    if ui.visuals().dark_mode { &DARK } else { &LIGHT }
}

/// Corners of panels, points.
pub const CORNER: f32 = 6.0;

/// Headings.
pub fn heading() -> FontId {
    FontId::proportional(19.0)
}

/// Labels and values.
pub fn body() -> FontId {
    FontId::proportional(14.0)
}

/// Captions.
pub fn caption() -> FontId {
    FontId::proportional(12.0)
}

/// Marks in diagrams.
pub fn small() -> FontId {
    FontId::proportional(10.5)
}

/// Sets the look of the framework's own widgets, in both palettes.
pub fn apply(context: &egui::Context) {
    for (theme, palette, mut visuals) in
        [(Theme::Dark, &DARK, Visuals::dark()), (Theme::Light, &LIGHT, Visuals::light())]
    {
        visuals.panel_fill = palette.background;
        visuals.window_fill = palette.panel;
        visuals.window_stroke = Stroke::new(1.0, palette.raised);
        visuals.extreme_bg_color = palette.background;
        visuals.faint_bg_color = palette.hovered;
        visuals.override_text_color = Some(palette.text);
        visuals.selection.bg_fill = palette.accent.gamma_multiply(0.35);
        visuals.selection.stroke = Stroke::new(1.0, palette.accent);
        let widgets = &mut visuals.widgets;
        for (widget, fill) in [
            (&mut widgets.noninteractive, palette.panel),
            (&mut widgets.inactive, palette.hovered),
            (&mut widgets.hovered, palette.raised),
            (&mut widgets.active, palette.raised),
            (&mut widgets.open, palette.raised),
        ] {
            (widget.bg_fill, widget.weak_bg_fill) = (fill, fill);
            widget.bg_stroke = Stroke::NONE;
            widget.fg_stroke = Stroke::new(1.0, palette.text);
            widget.expansion = 0.0;
        }
        context.set_visuals_of(theme, visuals);
    }
}

/// Chooses between the palettes.
pub fn choose(context: &egui::Context, light: bool) {
    context.set_theme(if light { Theme::Light } else { Theme::Dark });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Luminance as the Web Content Accessibility Guidelines define it.
    fn luminance(colour: Color32) -> f64 {
        let linear = |channel: u8| {
            let c = f64::from(channel) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * linear(colour.r()) + 0.7152 * linear(colour.g()) + 0.0722 * linear(colour.b())
    }

    fn contrast(a: Color32, b: Color32) -> f64 {
        let [a, b] = [a, b].map(luminance);
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    /// 4.5 is what the guidelines ask of text, 3 of larger things.
    #[test]
    fn everything_is_legible_in_both_palettes() {
        for (name, palette) in [("dark", &DARK), ("light", &LIGHT)] {
            for behind in [palette.background, palette.panel, palette.stage[0], palette.stage[1]] {
                for (what, text) in [("text", palette.text), ("faint", palette.faint)] {
                    let contrast = contrast(text, behind);
                    assert!(contrast >= 4.5, "{name}: {what} has {contrast:.1}");
                }
                for colour in palette.pieces.iter().chain([&palette.accent, &palette.over, &palette.level]) {
                    let contrast = contrast(*colour, behind);
                    assert!(contrast >= 3.0, "{name}: {colour:?} has {contrast:.1}");
                }
            }
        }
    }

    /// Buttons have no outline.
    #[test]
    fn buttons_stand_out_from_what_they_are_on() {
        for (name, palette) in [("dark", &DARK), ("light", &LIGHT)] {
            for behind in [palette.background, palette.panel] {
                let contrast = contrast(palette.hovered, behind);
                assert!(contrast >= 1.12, "{name}: {contrast:.2}");
            }
            assert!(contrast(palette.text, palette.hovered) >= 4.5);
        }
    }

    #[test]
    fn no_two_pieces_share_an_accent() {
        for palette in [&DARK, &LIGHT] {
            let mut accents = palette.pieces.map(|colour| colour.to_array());
            accents.sort_unstable();
            assert!(accents.windows(2).all(|pair| pair[0] != pair[1]));
        }
    }
}
