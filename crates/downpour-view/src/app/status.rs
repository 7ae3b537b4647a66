//! The bar at the bottom: what happened last, and how fast pictures come.

use egui::RichText;

use super::App;
use crate::engine::DeviceChoice;
use crate::theme::{QUIET, okabe_ito};

impl App {
    /// The bar.
    pub(super) fn status(&mut self, ui: &mut egui::Ui) {
        egui::Panel::bottom("status").exact_size(26.0).show(ui, |ui| {
            ui.horizontal_centered(|ui| {
                if let Some(job) = &self.job {
                    let progress = job.progress();
                    let text = format!("rendering {} of {}", progress.done, progress.all);
                    let part = progress.done as f32 / progress.all.max(1) as f32;
                    ui.add(egui::ProgressBar::new(part).desired_width(180.0).text(text));
                    let is_canceled = ui.button("Cancel").clicked();
                    if is_canceled {
                        job.cancel();
                    }
                    if let Some(result) = progress.result {
                        self.job = None;
                        match result {
                            Ok(text) => self.say(text),
                            Err(text) => self.complain(text),
                        }
                    }
                }
                if let Some((text, is_error)) = &self.message {
                    let color = if *is_error { ui.visuals().error_fg_color } else { QUIET };
                    let room = ui.available_width() * 0.55;
                    let layout = egui::Layout::left_to_right(egui::Align::Center);
                    ui.allocate_ui_with_layout(egui::vec2(room, 20.0), layout, |ui| {
                        ui.add(egui::Label::new(RichText::new(text).color(color)).truncate())
                            .on_hover_text(text);
                    });
                }
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    self.figures_of_status(ui);
                });
            });
        });
    }

    fn figures_of_status(&self, ui: &mut egui::Ui) {
        let quiet = |text: String| RichText::new(text).small().color(QUIET);
        if let Some(drawn) = &self.drawn {
            ui.label(quiet(drawn.adapter.clone()));
            ui.separator();
            let scale = f64::from(drawn.size[1]) / f64::from(self.window[1].max(1));
            let size = format!("{} x {} ({:.0} %)", drawn.size[0], drawn.size[1], scale * 100.0);
            ui.label(quiet(size))
                .on_hover_text("size of the picture, and its part of the window: at rest it is refined");
            ui.separator();
            ui.label(quiet(format!("{} drops", drawn.drops_drawn)));
            ui.separator();
            if let Some(ms) = self.fluid_ms {
                ui.label(quiet(format!("{:.1} /s", 1000.0 / ms.max(0.01))))
                    .on_hover_text("pictures per second while something moves");
                ui.separator();
            }
        } else if self.options.device == DeviceChoice::default() {
            ui.label(quiet("no picture yet".to_owned()));
        }
        let limit = &self.document.weather().lightning;
        if limit.is_limited() {
            ui.label(quiet("flashes limited".to_owned()))
                .on_hover_text("not more than three strokes of lightning in any second (lightning.limit)");
        } else {
            ui.label(RichText::new("flashes not limited").small().color(okabe_ito::ORANGE)).on_hover_text(
                "lightning.limit is false: viewers who are sensitive to flashing may be harmed",
            );
        }
    }
}
