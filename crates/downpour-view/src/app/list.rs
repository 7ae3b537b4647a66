//! The panel on the left: objects of the scene, and figures of the picture.

use egui::{RichText, ScrollArea};

use super::App;
use crate::engine::Histogram;
use crate::key_path::KeyPath;
use crate::objects::{NEW_KINDS, Object};
use crate::theme::{QUIET, kind_color, okabe_ito};

/// Titles of the lists.
const TITLES: [(&str, &str); 4] =
    [("wind", "Wind"), ("light", "Lamps"), ("puddle", "Puddles"), ("drip", "Drips")];

impl App {
    /// The panel.
    pub(super) fn list(&mut self, ui: &mut egui::Ui) {
        egui::Panel::left("objects").default_size(200.0).size_range(150.0..=360.0).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
                ui.add_space(6.0);
                ui.horizontal(|ui| {
                    ui.strong("Scene");
                    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                        ui.menu_button("Add", |ui| {
                            for kind in NEW_KINDS {
                                let text = RichText::new(kind).color(kind_color(kind));
                                if ui.button(text).clicked() {
                                    self.add(kind, None);
                                    ui.close();
                                }
                            }
                        });
                    });
                });
                let objects = self.objects();
                for (list, title) in TITLES {
                    let of_list: Vec<&Object> =
                        objects.iter().filter(|object| object.id.list == list).collect();
                    if of_list.is_empty() {
                        continue;
                    }
                    ui.add_space(4.0);
                    ui.label(RichText::new(title).small().color(QUIET));
                    for object in of_list {
                        self.row(ui, object);
                    }
                }
                if objects.is_empty() {
                    ui.add_space(4.0);
                    ui.label(RichText::new("no wind, lamps or puddles of its own").small().color(QUIET));
                }
                ui.add_space(12.0);
                self.names(ui, &objects);
                self.figures(ui);
            });
        });
    }

    fn row(&mut self, ui: &mut egui::Ui, object: &Object) {
        let name = self.object_name(object);
        let is_hidden = self.hidden.contains(&object.id);
        let color = if is_hidden { QUIET } else { kind_color(&object.kind) };
        ui.horizontal(|ui| {
            let (dot, _) = ui.allocate_exact_size(egui::vec2(8.0, 14.0), egui::Sense::hover());
            ui.painter().circle_filled(dot.center(), 4.0, color);
            let is_selected = self.selected.contains(&object.id);
            let text = RichText::new(&name);
            let text = if is_hidden { text.color(QUIET).italics() } else { text };
            let response = ui.selectable_label(is_selected, text);
            if response.clicked() {
                let adds = ui.input(|input| input.modifiers.shift || input.modifiers.command);
                self.pick(&object.id, adds);
            }
        });
    }

    /// Name of the object that is selected alone.
    fn names(&mut self, ui: &mut egui::Ui, objects: &[Object]) {
        let mut chosen = objects.iter().filter(|object| self.selected.contains(&object.id));
        let (Some(object), None) = (chosen.next(), chosen.next()) else { return };
        let mut name = self.document.entry_name(object.id.list, object.id.index).unwrap_or_default();
        let label = ui.label(RichText::new("Name").small().color(QUIET));
        let edit =
            egui::TextEdit::singleline(&mut name).hint_text(&*object.kind).desired_width(f32::INFINITY);
        if ui.add(edit).labelled_by(label.id).changed() {
            let result = self.document.set_entry_name(&KeyPath::of(object.id.list), object.id.index, &name);
            self.noted(result);
        }
        ui.add_space(12.0);
    }

    /// Figures of the picture: its exposure, its drops, the time of its passes.
    fn figures(&mut self, ui: &mut egui::Ui) {
        let Some(drawn) = self.drawn.clone() else { return };
        ui.separator();
        ui.label(RichText::new("Exposure").small().color(QUIET));
        histogram(ui, &drawn.histogram);
        let clipped = drawn.histogram.white * 100.0;
        let color = if clipped > 2.0 { okabe_ito::ORANGE } else { QUIET };
        ui.label(RichText::new(format!("{clipped:.1} % of the pixels are white")).small().color(color));
        ui.add_space(6.0);
        ui.label(RichText::new("Time of passes, ms").small().color(QUIET));
        egui::Grid::new("passes").num_columns(2).spacing([12.0, 2.0]).show(ui, |ui| {
            for (name, ms) in &drawn.passes {
                ui.label(RichText::new(*name).small());
                ui.label(RichText::new(format!("{ms:.1}")).small().monospace());
                ui.end_row();
            }
            ui.label(RichText::new("frame").small().strong());
            ui.label(RichText::new(format!("{:.1}", drawn.frame_ms)).small().monospace().strong());
            ui.end_row();
        });
    }
}

fn histogram(ui: &mut egui::Ui, histogram: &Histogram) {
    let (rect, response) =
        ui.allocate_exact_size(egui::vec2(ui.available_width(), 46.0), egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "histogram of brightness"));
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 3.0, ui.visuals().extreme_bg_color);
    let most = histogram.bins.iter().copied().fold(1.0e-6, f32::max);
    let width = rect.width() / histogram.bins.len() as f32;
    for (k, &part) in histogram.bins.iter().enumerate() {
        // Square roots show the few bright pixels beside the many dark ones.
        let height = (part / most).sqrt() * (rect.height() - 4.0);
        let left = rect.left() + k as f32 * width;
        let bar = egui::Rect::from_min_max(
            egui::pos2(left, rect.bottom() - height),
            egui::pos2(left + width * 0.85, rect.bottom()),
        );
        painter.rect_filled(bar, 0.0, okabe_ito::SKY.gamma_multiply(0.8));
    }
}
