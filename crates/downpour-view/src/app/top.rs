//! The bar on top: menus, and switches of what is drawn over the picture.

use egui::RichText;

use super::{App, Command, Wish};
use crate::theme::{QUIET, okabe_ito};

/// Scales of the window's content.
const ZOOMS: [f32; 5] = [1.0, 1.25, 1.5, 1.75, 2.0];

impl App {
    /// The bar.
    pub(super) fn top(&mut self, ui: &mut egui::Ui) {
        egui::Panel::top("menus").show(ui, |ui| {
            ui.add_space(2.0);
            egui::MenuBar::new().ui(ui, |ui| {
                self.menu(
                    ui,
                    "File",
                    &[
                        Command::Open,
                        Command::Save,
                        Command::SaveAs,
                        Command::Import,
                        Command::Render,
                        Command::SavePicture,
                        Command::Screenshot,
                    ],
                );
                self.menu(
                    ui,
                    "Edit",
                    &[
                        Command::Undo,
                        Command::Redo,
                        Command::Duplicate,
                        Command::Delete,
                        Command::Hide,
                        Command::SelectAll,
                        Command::SelectNone,
                        Command::Snap,
                        Command::Brush,
                    ],
                );
                self.menu(
                    ui,
                    "View",
                    &[
                        Command::FrameSelection,
                        Command::FileCamera,
                        Command::SetCamera,
                        Command::Record,
                        Command::Meter,
                        Command::Slice,
                        Command::Tracers,
                        Command::FullScreen,
                    ],
                );
                ui.menu_button("Scale", |ui| {
                    for zoom in ZOOMS {
                        let is_now = (ui.ctx().zoom_factor() - zoom).abs() < 0.01;
                        if ui.selectable_label(is_now, format!("{:.0} %", zoom * 100.0)).clicked() {
                            ui.ctx().set_zoom_factor(zoom);
                            ui.close();
                        }
                    }
                });
                self.menu(ui, "Help", &[Command::Help]);
                ui.separator();
                let overlay = &mut self.overlay;
                ui.toggle_value(&mut overlay.has_objects, "Objects")
                    .on_hover_text("models and handles of wind, lamps and puddles");
                ui.toggle_value(&mut overlay.has_slice, "Wind slice")
                    .on_hover_text("streamlines on a level slice (L)");
                if overlay.has_slice {
                    let height = egui::DragValue::new(&mut overlay.slice_m)
                        .range(-100.0..=1000.0)
                        .speed(0.05)
                        .suffix(" m");
                    ui.add(height)
                        .on_hover_text("height of the slice")
                        .accessible_name("height of the slice");
                }
                ui.toggle_value(&mut overlay.has_tracers, "Tracers")
                    .on_hover_text("particles in the wind (T)");
                ui.toggle_value(&mut overlay.snaps, "Snap")
                    .on_hover_text("steps of 0.5 m and 15 degrees (G)");
                ui.toggle_value(&mut self.brush.is_on, "Paint puddle")
                    .on_hover_text("paint water on the ground (B)");
                if self.brush.is_on {
                    let radius = egui::DragValue::new(&mut self.brush.radius_m)
                        .range(0.1..=10.0)
                        .speed(0.02)
                        .suffix(" m");
                    ui.add(radius)
                        .on_hover_text("radius of the brush")
                        .accessible_name("radius of the brush");
                }
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    if self.document.is_dirty() {
                        let (rect, response) =
                            ui.allocate_exact_size(egui::vec2(10.0, 14.0), egui::Sense::hover());
                        ui.painter().circle_filled(rect.center(), 4.0, okabe_ito::ORANGE);
                        response.on_hover_text("not saved");
                    }
                    ui.label(RichText::new(self.document.title()).color(QUIET));
                });
            });
            ui.add_space(1.0);
        });
    }

    fn menu(&mut self, ui: &mut egui::Ui, title: &str, commands: &[Command]) {
        ui.menu_button(title, |ui| {
            ui.set_min_width(210.0);
            for &command in commands {
                let keys = ui.ctx().format_shortcut(&command.shortcut());
                let is_enabled = match command {
                    Command::Undo => self.document.undo_label().is_some(),
                    Command::Redo => self.document.redo_label().is_some(),
                    Command::Duplicate | Command::Delete | Command::Hide => !self.selected.is_empty(),
                    _ => true,
                };
                let button = egui::Button::new(command.label()).shortcut_text(keys);
                if ui.add_enabled(is_enabled, button).clicked() {
                    self.run(command);
                    ui.close();
                }
            }
            if title == "File" {
                ui.separator();
                if ui.button("Close").clicked() {
                    self.wishes.push(Wish::Close);
                    ui.close();
                }
            }
        });
    }
}
