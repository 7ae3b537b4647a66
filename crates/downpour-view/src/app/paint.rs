//! Painting of puddles in the picture.

use egui::{Color32, Painter, PointerButton, Stroke};
use glam::DVec3;

use super::App;
use crate::brush::{DEPTH_MM, Mask, SQUARE_M, free_name};
use crate::document::write_whole;
use crate::engine::Drawn;
use crate::key_path::KeyPath;
use crate::objects::{ObjectId, rounded};
use crate::plain::Plain;
use crate::theme::okabe_ito;
use crate::wire::circle;

/// Farthest ground that is painted, m.
const REACH_M: f64 = 200.0;

impl App {
    /// The ground under a place of the window.
    fn ground(&self, at: egui::Pos2, drawn: &Drawn) -> Option<DVec3> {
        let ray = drawn.view.ray(self.on_picture(at));
        let distance = drawn.distance(ray).filter(|distance| *distance < REACH_M)?;
        Some(drawn.view.eye + ray * distance)
    }

    /// Paints where the pointer is dragged; the puddle is made when it is let go.
    pub(super) fn paint(&mut self, ui: &egui::Ui, response: &egui::Response, drawn: &Drawn) {
        let _ = ui;
        let is_down = response.is_pointer_button_down_on() && !response.dragged_by(PointerButton::Secondary);
        if is_down && let Some(place) = response.interact_pointer_pos().and_then(|at| self.ground(at, drawn))
        {
            self.paint_at(place);
        } else if !is_down && self.brush.mask.is_some() {
            self.end_painting();
        }
    }

    /// Paints a spot of the ground.
    pub fn paint_at(&mut self, place: DVec3) {
        let radius = self.brush.radius_m;
        self.brush.mask.get_or_insert_with(|| Mask::new(place)).paint(place, radius);
    }

    /// Radius of the brush, m.
    pub fn set_brush_radius(&mut self, radius_m: f64) {
        self.brush.radius_m = radius_m.clamp(0.1, 10.0);
    }

    /// Writes the mask beside the weather file and adds the puddle that has it.
    pub fn end_painting(&mut self) {
        let Some(mask) = self.brush.mask.take().filter(|mask| mask.volume_m3() > 0.0) else { return };
        let place = self.document.place();
        let name = free_name(&place);
        let written = mask.png().map_err(|error| format!("{name}: {error}")).and_then(|bytes| {
            write_whole(&place.with_file_name(&name), &bytes).map_err(|error| error.to_string())
        });
        if let Err(error) = written {
            self.complain(error);
            return;
        }
        let entry = Plain::Table(vec![
            ("position_m".to_owned(), Plain::of_numbers(&mask.center.to_array().map(rounded))),
            ("size_m".to_owned(), Plain::of_numbers(&[SQUARE_M, SQUARE_M])),
            ("mask".to_owned(), Plain::Text(name.clone())),
            ("depth_mm".to_owned(), Plain::Number(DEPTH_MM)),
        ]);
        let result = self.document.add_entry(&KeyPath::of("puddle"), &entry);
        if let Some(index) = self.noted(result) {
            self.selected = [ObjectId { list: "puddle", index }].into();
            self.say(format!("painted a puddle of {:.0} l: {name}", mask.volume_m3() * 1000.0));
        }
    }

    /// Draws the ring of the brush, and what was painted.
    pub(super) fn draw_brush(&self, painter: &Painter, response: &egui::Response, drawn: &Drawn) {
        if !self.brush.is_on {
            return;
        }
        let Some(place) = response.hover_pos().and_then(|at| self.ground(at, drawn)) else { return };
        let ring = circle(place + DVec3::Y * 0.02, DVec3::Y, self.brush.radius_m);
        let points: Option<Vec<egui::Pos2>> = ring
            .iter()
            .map(|point| drawn.view.project(*point).map(|(place, _)| self.to_screen(place)))
            .collect();
        if let Some(points) = points {
            let color = if self.brush.mask.is_some() { okabe_ito::YELLOW } else { Color32::WHITE };
            painter.add(egui::Shape::line(points, Stroke::new(2.0, color)));
        }
    }
}
