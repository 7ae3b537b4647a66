//! Lines over the picture: models of objects, handles, the wind on a slice, tracers, the camera's path.

use downpour::math::ops::f64 as ops;
use downpour::weather::Weather;
use downpour::wind::WindMatrix;
use downpour::wind::primitive::wind_primitive_velocity;
use egui::{Align2, Color32, FontId, Painter, Pos2, Shape, Stroke};
use glam::{DVec2, DVec3};

use super::{App, HandleKind};
use crate::engine::PictureView;
use crate::objects::Object;
use crate::theme::{AXES, kind_color, okabe_ito};
use crate::wire::{Wire, model};

/// Cells of the slice along an edge.
const SLICE_CELLS: i32 = 12;

/// Steps of a streamline.
const STREAM_STEPS: usize = 10;

/// Tracers in the wind.
const TRACERS: u32 = 240;

/// Speed of still air, m/s: nothing is drawn.
const STILL_M_S: f32 = 0.02;

/// Distance ahead at which things without a place are drawn, m.
const ANCHOR_M: f64 = 12.0;

/// The wind at one time, for any place.
pub(super) struct Air(Vec<WindMatrix>);

impl Air {
    /// The wind of a weather at a time in s, without its turbulence.
    pub(super) fn of(weather: &Weather, time_s: f64) -> Self {
        Self(WindMatrix::encode(&weather.wind.at(time_s)).unwrap_or_default())
    }

    /// Velocity, m/s.
    pub(super) fn velocity(&self, at: DVec3) -> DVec3 {
        let at = at.as_vec3();
        let sum = |all: glam::Vec3, matrix: &WindMatrix| all + wind_primitive_velocity(matrix, at);
        self.0.iter().fold(glam::Vec3::ZERO, sum).as_dvec3()
    }

    /// A streamline from a place, by the midpoint rule, over a time in s.
    pub(super) fn stream(&self, begin: DVec3, time_s: f64) -> Vec<DVec3> {
        let step = time_s / STREAM_STEPS as f64;
        let mut points = vec![begin];
        let mut at = begin;
        for _ in 0..STREAM_STEPS {
            let half = at + self.velocity(at) * (0.5 * step);
            at += self.velocity(half) * step;
            points.push(at);
        }
        points
    }

    fn is_still(&self) -> bool {
        self.0.is_empty()
    }
}

impl App {
    /// Place in the window of a place in the picture.
    pub(super) fn to_screen(&self, place: DVec2) -> Pos2 {
        let size = self.picture.size();
        self.picture.min + egui::vec2(place.x as f32 * size.x, place.y as f32 * size.y)
    }

    /// Place in the picture of a place in the window.
    pub(super) fn on_picture(&self, at: Pos2) -> DVec2 {
        let offset = at - self.picture.min;
        let size = self.picture.size();
        DVec2::new(f64::from(offset.x / size.x), f64::from(offset.y / size.y))
    }

    /// Position of things without a place: ahead of the eye, above the ground.
    pub(super) fn anchor(&self, view: &PictureView) -> DVec3 {
        view.eye + view.forward * ANCHOR_M + view.up * (view.height_at(ANCHOR_M) * 0.22)
    }

    /// A line of the scene in the window, cut before the eye.
    fn screen_lines(&self, points: &[DVec3], view: &PictureView) -> Vec<Vec<Pos2>> {
        let mut lines: Vec<Vec<Pos2>> = vec![Vec::new()];
        for point in points {
            match view.project(*point).filter(|(place, _)| place.abs().max_element() < 20.0) {
                Some((place, _)) => {
                    if let Some(line) = lines.last_mut() {
                        line.push(self.to_screen(place));
                    }
                }
                None => lines.push(Vec::new()),
            }
        }
        lines.retain(|line| line.len() > 1);
        lines
    }

    /// Draws a line with a dark edge, so that it is seen before all things.
    fn draw_wire(&self, painter: &Painter, wire: &Wire, view: &PictureView, color: Color32, width: f32) {
        for line in self.screen_lines(&wire.points, view) {
            painter.add(Shape::line(line.clone(), Stroke::new(width + 1.6, Color32::from_black_alpha(110))));
            if let (true, [.., before, end]) = (wire.is_arrow, &line[..]) {
                arrow_head(painter, *before, *end, color, 5.0 + width * 1.5);
            }
            painter.add(Shape::line(line, Stroke::new(width, color)));
        }
    }

    /// Draws all of it.
    pub(super) fn draw_overlay(&self, painter: &Painter, objects: &[Object], view: &PictureView) {
        let air = Air::of(self.document.weather(), self.clock.time_s);
        if self.overlay.has_slice && !air.is_still() {
            self.draw_slice(painter, &air, view);
        }
        if self.overlay.has_tracers && !air.is_still() {
            self.draw_tracers(painter, &air, view);
        }
        if self.overlay.has_path {
            self.draw_camera_path(painter, view);
        }
        if !self.overlay.has_objects {
            return;
        }
        let anchor = self.anchor(view);
        for object in objects.iter().filter(|object| !self.hidden.contains(&object.id)) {
            let is_selected = self.selected.contains(&object.id);
            let color = kind_color(&object.kind);
            let color = if is_selected { color } else { color.gamma_multiply(0.75) };
            for wire in model(object, anchor) {
                self.draw_wire(painter, &wire, view, color, if is_selected { 2.0 } else { 1.2 });
            }
            let at = object.position.as_ref().map_or(anchor, |(_, at)| *at);
            if let Some((place, _)) = view.project(at) {
                let at = self.to_screen(place) + egui::vec2(0.0, 14.0);
                self.draw_text(painter, at, Align2::CENTER_TOP, &self.object_name(object), color);
            }
        }
        self.draw_handles(painter, objects);
    }

    fn draw_text(&self, painter: &Painter, at: Pos2, align: Align2, text: &str, color: Color32) {
        let font = FontId::proportional(12.0);
        painter.text(at + egui::vec2(1.0, 1.0), align, text, font.clone(), Color32::from_black_alpha(200));
        painter.text(at, align, text, font, color);
    }

    fn draw_handles(&self, painter: &Painter, objects: &[Object]) {
        let hovered = painter.ctx().pointer_hover_pos().and_then(|at| self.handle_at(at));
        let held = self.drag.as_ref().map(|drag| drag.kind);
        for handle in &self.handles {
            let is_hot = held.or(hovered) == Some(handle.kind);
            let radius = if is_hot { 7.0 } else { 5.0 };
            let dark = Stroke::new(1.5, Color32::from_black_alpha(180));
            match handle.kind {
                HandleKind::Axis(axis) => {
                    let color = AXES[axis.min(2)];
                    painter.line_segment(
                        [handle.from, handle.at],
                        Stroke::new(4.0, Color32::from_black_alpha(110)),
                    );
                    painter.line_segment([handle.from, handle.at], Stroke::new(2.2, color));
                    arrow_head(painter, handle.from, handle.at, color, if is_hot { 14.0 } else { 11.0 });
                }
                HandleKind::Level => {
                    let square = egui::Rect::from_center_size(handle.at, egui::Vec2::splat(radius * 1.8));
                    painter.rect_filled(square, 2.0, Color32::WHITE);
                    painter.rect_stroke(square, 2.0, dark, egui::StrokeKind::Outside);
                }
                HandleKind::Radius | HandleKind::Edge(_) => {
                    painter.circle_filled(handle.at, radius, Color32::WHITE);
                    painter.circle_stroke(handle.at, radius, dark);
                }
                HandleKind::Direction => {
                    painter.line_segment(
                        [handle.from, handle.at],
                        Stroke::new(1.2, Color32::from_white_alpha(150)),
                    );
                    painter.circle_filled(handle.at, radius, okabe_ito::YELLOW);
                    painter.circle_stroke(handle.at, radius, dark);
                }
                HandleKind::Strength => {
                    let [up, down] = [-1.0, 1.0].map(|sign| handle.at + egui::vec2(0.0, sign * radius * 1.5));
                    let [left, right] = [-1.0, 1.0].map(|sign| handle.at + egui::vec2(sign * radius, 0.0));
                    painter.add(Shape::convex_polygon(vec![up, right, down, left], okabe_ito::ORANGE, dark));
                }
            }
        }
        // The number beside what is dragged or under the pointer.
        let object = objects.iter().rfind(|object| self.selected.contains(&object.id));
        let (Some(kind), Some(object)) = (held.or(hovered), object) else { return };
        if let Some(handle) = self.handles.iter().find(|handle| handle.kind == kind) {
            let at = handle.at + egui::vec2(14.0, 0.0);
            self.draw_text(painter, at, Align2::LEFT_CENTER, &reading(kind, object), Color32::WHITE);
        }
    }

    /// Short streamlines from the middles of a level slice.
    fn draw_slice(&self, painter: &Painter, air: &Air, view: &PictureView) {
        let level = self.overlay.slice_m;
        let middle = self.slice_middle(view);
        let edge = (view.eye - middle).length().clamp(6.0, 60.0) * 1.1;
        let cell = edge / f64::from(SLICE_CELLS);
        let half = SLICE_CELLS / 2;
        for x in -half..half {
            for z in -half..half {
                let begin = DVec3::new(
                    middle.x + (f64::from(x) + 0.5) * cell,
                    level,
                    middle.z + (f64::from(z) + 0.5) * cell,
                );
                let speed = air.velocity(begin).length();
                if speed < f64::from(STILL_M_S) {
                    continue;
                }
                // A line is nearly a cell long where the wind is strong, and shorter where it is weak.
                let length = cell * 0.9 * (speed / (speed + 1.5));
                let points = air.stream(begin, length / speed);
                self.draw_wire(painter, &Wire { points, is_arrow: true }, view, speed_color(speed), 1.3);
            }
        }
    }

    fn slice_middle(&self, view: &PictureView) -> DVec3 {
        let mut ahead = view.forward;
        ahead.y = 0.0;
        let reach = self.eye.map_or(14.0, |eye| eye.distance.clamp(6.0, 40.0));
        view.eye + ahead.normalize_or_zero() * reach
    }

    /// Particles that the wind carries: each is born at a place of its own and drawn with the last part of its way.
    fn draw_tracers(&self, painter: &Painter, air: &Air, view: &PictureView) {
        const LIFE_S: f64 = 2.0;
        let middle = self.slice_middle(view);
        let clock_s = painter.ctx().input(|input| input.time);
        for index in 0..TRACERS {
            let [a, b, c, phase] = [0, 1, 2, 3].map(|k| unit_hash(index * 4 + k));
            let begin = middle + DVec3::new((a - 0.5) * 26.0, (b * 6.0) + 0.2 - middle.y, (c - 0.5) * 26.0);
            let age = (clock_s + phase * LIFE_S).rem_euclid(LIFE_S);
            let way = air.stream(begin, age.max(0.05));
            let tail = way.get(way.len().saturating_sub(4)..).unwrap_or_default().to_vec();
            let speed = air.velocity(begin).length();
            if speed < f64::from(STILL_M_S) {
                continue;
            }
            let middle_age = 2.0 * age / LIFE_S - 1.0;
            let fade = (1.0 - middle_age * middle_age) as f32;
            let color = speed_color(speed).gamma_multiply(fade);
            for line in self.screen_lines(&tail, view) {
                if let Some(end) = line.last() {
                    painter.circle_filled(*end, 2.0, color);
                }
                painter.add(Shape::line(line, Stroke::new(1.2, color)));
            }
        }
    }

    /// The way of the camera, with a mark for each second.
    fn draw_camera_path(&self, painter: &Painter, view: &PictureView) {
        let Some(path) = self.document.weather().camera.path.as_ref().filter(|path| !path.is_still()) else {
            return;
        };
        let [begin, end] = self.clock.range_s;
        let steps = 120;
        let time = |k: i32| begin + (end - begin) * f64::from(k) / f64::from(steps);
        let points: Vec<DVec3> = (0..=steps).map(|k| path.at(time(k)).position).collect();
        // Seen from itself a path is a point.
        let is_inside = points.iter().all(|point| (*point - view.eye).length() < 0.3);
        if is_inside {
            return;
        }
        self.draw_wire(painter, &Wire { points, is_arrow: true }, view, okabe_ito::GREEN, 1.6);
        for second in 0..=(end - begin).min(200.0) as i32 {
            if let Some((place, _)) = view.project(path.at(begin + f64::from(second)).position) {
                painter.circle_filled(self.to_screen(place), 3.0, okabe_ito::GREEN);
            }
        }
    }
}

/// The number that a handle changes, with its unit.
fn reading(kind: HandleKind, object: &Object) -> String {
    let place = |axis: usize| object.position.as_ref().map_or(0.0, |(_, at)| at.to_array()[axis]);
    match kind {
        HandleKind::Axis(axis) => format!("{} {:.2} m", ["x", "y", "z"][axis.min(2)], place(axis.min(2))),
        HandleKind::Level => format!("x {:.2} m   z {:.2} m", place(0), place(2)),
        HandleKind::Radius => {
            format!("radius {:.2} m", object.radius.as_ref().map_or(0.0, |(_, radius)| *radius))
        }
        HandleKind::Edge(edge) => {
            let length = object
                .rectangle
                .as_ref()
                .and_then(|(_, size, _)| size.get(edge))
                .copied()
                .unwrap_or_default();
            format!("{} {length:.2} m", if edge == 0 { "width" } else { "length" })
        }
        HandleKind::Direction if object.rectangle.is_some() => {
            let turn = object.rectangle.as_ref().map_or(0.0, |(_, _, turn)| turn.to_degrees());
            format!("turn {turn:.0}°")
        }
        HandleKind::Direction => object.direction.as_ref().map_or_else(String::new, |(_, d)| {
            let azimuth = ops::atan2(d.z, d.x).to_degrees();
            format!("azimuth {azimuth:.0}°   elevation {:.0}°", ops::asin(d.y.clamp(-1.0, 1.0)).to_degrees())
        }),
        HandleKind::Strength => object.strength.as_ref().map_or_else(String::new, |(path, value)| {
            let field = crate::schema::Field {
                key: path.name().to_owned(),
                kind: crate::schema::Kind::Raw,
                about: String::new(),
                default: String::new(),
                is_keyed: false,
            };
            format!("{} {value:.4} {}", field.label(), field.unit())
        }),
    }
}

fn arrow_head(painter: &Painter, from: Pos2, tip: Pos2, color: Color32, size: f32) {
    let way = tip - from;
    if way.length() < 0.5 {
        return;
    }
    let along = way.normalized() * size;
    let beside = along.rot90() * 0.38;
    let points = vec![tip + along * 0.4, tip - along * 0.6 + beside, tip - along * 0.6 - beside];
    painter.add(Shape::convex_polygon(points, color, Stroke::NONE));
}

/// Color of a speed: from blue to yellow with rising lightness, so that it is told apart without hue.
fn speed_color(speed: f64) -> Color32 {
    let part = (speed / (speed + 5.0)) as f32;
    let mix = |a: u8, b: u8| (f32::from(a) + (f32::from(b) - f32::from(a)) * part).round() as u8;
    let [low, high] = [okabe_ito::SKY, okabe_ito::YELLOW];
    Color32::from_rgb(mix(low.r(), high.r()), mix(low.g(), high.g()), mix(low.b(), high.b()))
}

/// A number from 0 to 1 of an index.
fn unit_hash(index: u32) -> f64 {
    let mut state = index.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    state = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    f64::from((state >> 22) ^ state) / f64::from(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Round a vortex a streamline stays on its circle, in the time that its speed takes: circulation over 2 pi r.
    #[test]
    fn streamlines_go_round_a_vortex() {
        let text = "[[wind]]\nvortex = { strength_m2_s = 40, core_m = 0.01 }\n";
        let air = Air::of(&Weather::parse("", text).unwrap(), 0.0);
        let speed = 40.0 / (std::f64::consts::TAU * 5.0);
        assert!((air.velocity(DVec3::X * 5.0).length() - speed).abs() < 1.0e-3);
        let way = air.stream(DVec3::X * 5.0, 0.5 * std::f64::consts::PI * 5.0 / speed);
        let end = way.last().unwrap();
        // Right-handed about +Y: from +X to -Z.
        assert!((*end - DVec3::NEG_Z * 5.0).length() < 0.15, "{end}");
    }

    #[test]
    fn hashes_fill_the_unit_interval() {
        let sum: f64 = (0..1000).map(unit_hash).sum();
        assert!((sum / 1000.0 - 0.5).abs() < 0.03);
    }
}
