//! Look of the window: dark and quiet, so that the picture is the brightest thing in it.

use egui::{Color32, CornerRadius, Stroke, Vec2};

/// Colors of Okabe & Ito 2008, which people with any kind of color vision can tell apart.
pub mod okabe_ito {
    use egui::Color32;
    /// Orange.
    pub const ORANGE: Color32 = Color32::from_rgb(230, 159, 0);
    /// Sky blue.
    pub const SKY: Color32 = Color32::from_rgb(86, 180, 233);
    /// Bluish green.
    pub const GREEN: Color32 = Color32::from_rgb(0, 158, 115);
    /// Yellow.
    pub const YELLOW: Color32 = Color32::from_rgb(240, 228, 66);
    /// Blue.
    pub const BLUE: Color32 = Color32::from_rgb(0, 114, 178);
    /// Vermilion.
    pub const VERMILION: Color32 = Color32::from_rgb(213, 94, 0);
    /// Reddish purple.
    pub const PURPLE: Color32 = Color32::from_rgb(204, 121, 167);
}

/// Color of an object by its kind.
#[must_use]
pub fn kind_color(kind: &str) -> Color32 {
    match kind {
        "source" => okabe_ito::GREEN,
        "sink" => okabe_ito::VERMILION,
        "vortex" => okabe_ito::SKY,
        "tornado" => okabe_ito::PURPLE,
        "uniform" => okabe_ito::YELLOW,
        "puddle" | "drip" => okabe_ito::BLUE,
        _ => okabe_ito::ORANGE,
    }
}

/// Colors of the axes x, y and z.
pub const AXES: [Color32; 3] = [okabe_ito::VERMILION, okabe_ito::GREEN, okabe_ito::SKY];

/// Background of panels.
pub const PANEL: Color32 = Color32::from_rgb(27, 29, 33);

/// Background behind the picture.
pub const STAGE: Color32 = Color32::from_rgb(14, 15, 17);

/// Text that is not to catch the eye.
pub const QUIET: Color32 = Color32::from_rgb(137, 143, 152);

/// Sets the look of a context.
pub fn apply(context: &egui::Context) {
    context.set_theme(egui::Theme::Dark);
    context.all_styles_mut(|style| {
        if let Some(small) = style.text_styles.get_mut(&egui::TextStyle::Small) {
            small.size = 11.5;
        }
        style.spacing.item_spacing = Vec2::new(8.0, 5.0);
        style.spacing.button_padding = Vec2::new(8.0, 3.0);
        style.spacing.interact_size.y = 22.0;
        style.spacing.indent = 14.0;
        style.interaction.tooltip_delay = 0.4;
        let visuals = &mut style.visuals;
        visuals.panel_fill = PANEL;
        visuals.window_fill = Color32::from_rgb(33, 36, 41);
        visuals.window_stroke = Stroke::new(1.0, Color32::from_rgb(58, 62, 70));
        visuals.extreme_bg_color = Color32::from_rgb(18, 19, 22);
        visuals.faint_bg_color = Color32::from_rgb(32, 35, 39);
        visuals.selection.bg_fill = Color32::from_rgb(38, 79, 110);
        visuals.selection.stroke = Stroke::new(1.0, Color32::from_rgb(214, 232, 245));
        visuals.hyperlink_color = okabe_ito::SKY;
        visuals.warn_fg_color = okabe_ito::ORANGE;
        visuals.error_fg_color = Color32::from_rgb(238, 128, 64);
        visuals.weak_text_color = Some(QUIET);
        let corner = CornerRadius::same(4);
        let widgets = &mut visuals.widgets;
        widgets.noninteractive.bg_stroke = Stroke::new(1.0, Color32::from_rgb(44, 47, 53));
        widgets.noninteractive.fg_stroke.color = Color32::from_rgb(190, 195, 202);
        widgets.inactive.weak_bg_fill = Color32::from_rgb(43, 46, 52);
        widgets.inactive.bg_fill = Color32::from_rgb(43, 46, 52);
        widgets.inactive.fg_stroke.color = Color32::from_rgb(208, 212, 218);
        widgets.hovered.weak_bg_fill = Color32::from_rgb(56, 60, 68);
        widgets.active.weak_bg_fill = Color32::from_rgb(38, 79, 110);
        for state in [
            &mut widgets.noninteractive,
            &mut widgets.inactive,
            &mut widgets.hovered,
            &mut widgets.active,
            &mut widgets.open,
        ] {
            state.corner_radius = corner;
            state.expansion = 0.0;
        }
    });
}
