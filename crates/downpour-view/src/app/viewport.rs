//! The picture, and what pointers and keys do in it.

use egui::{Color32, CursorIcon, Key, PointerButton, Pos2, Rect, Sense, Vec2};
use glam::{DVec2, DVec3};

use super::App;
use crate::engine::Drawn;
use crate::navigation::FreeEye;
use crate::objects::{Object, ObjectId};
use crate::theme;

/// Radians for each point of a drag.
const TURN: f64 = 0.006;

/// Part of the distance for each point of a wheel.
const WHEEL: f64 = 0.002;

/// Distance of a pointer at which a click selects an object, in points.
const CLICK: f32 = 22.0;

impl App {
    /// The eye that is moved by hand, or that of the picture.
    pub(super) fn free_eye(&self, drawn: &Drawn) -> FreeEye {
        self.eye.unwrap_or_else(|| {
            let distance = drawn.distance(drawn.view.forward).unwrap_or(12.0);
            FreeEye::of(&drawn.view, distance.min(60.0))
        })
    }

    /// The panel in the middle.
    pub(super) fn viewport(&mut self, ui: &mut egui::Ui) {
        let frame = egui::Frame::NONE.fill(theme::STAGE);
        egui::CentralPanel::no_frame().frame(frame).show(ui, |ui| {
            let area = ui.available_rect_before_wrap();
            self.picture = self.fitted(area);
            let pixels = self.picture.size() * ui.ctx().pixels_per_point();
            self.window = [pixels.x.round().max(1.0) as u32, pixels.y.round().max(1.0) as u32];
            let response = ui.allocate_rect(self.picture, Sense::click_and_drag());
            response
                .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "picture of the scene"));
            let painter = ui.painter_at(self.picture);
            match &self.texture {
                Some(texture) => {
                    let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
                    painter.image(texture.id(), self.picture, whole, Color32::WHITE);
                }
                None => {
                    let at = self.picture.center();
                    let font = egui::FontId::proportional(15.0);
                    painter.text(
                        at,
                        egui::Align2::CENTER_CENTER,
                        "drawing the first picture…",
                        font,
                        theme::QUIET,
                    );
                }
            }
            let Some(drawn) = self.drawn.clone() else { return };
            let objects = self.objects();
            self.handles = self.make_handles(&objects, &drawn.view, self.anchor(&drawn.view));
            self.pointer(ui, &response, &drawn, &objects);
            self.flight(ui, &response, &drawn);
            // What was dragged is drawn where it is now.
            let objects = self.objects();
            self.handles = self.make_handles(&objects, &drawn.view, self.anchor(&drawn.view));
            self.draw_overlay(&painter, &objects, &drawn.view);
            self.draw_brush(&painter, &response, &drawn);
        });
    }

    /// The rectangle of the file's proportions within an area.
    fn fitted(&self, area: Rect) -> Rect {
        let [width, height] = self.document.weather().size.map(|edge| edge as f32);
        let scale = (area.width() / width).min(area.height() / height);
        Rect::from_center_size(area.center(), Vec2::new(width, height) * scale)
    }

    fn pointer(&mut self, ui: &egui::Ui, response: &egui::Response, drawn: &Drawn, objects: &[Object]) {
        let modifiers = ui.input(|input| input.modifiers);
        if let Some(at) = response.hover_pos()
            && self.handle_at(at).is_some()
        {
            ui.ctx().set_cursor_icon(CursorIcon::Grab);
        }
        if self.brush.is_on {
            self.paint(ui, response, drawn);
        } else if response.drag_started_by(PointerButton::Primary) {
            let begin = ui.input(|input| input.pointer.press_origin());
            if let Some((begin, kind)) = begin.and_then(|at| Some((at, self.handle_at(at)?))) {
                self.begin_drag(kind, begin);
            }
        }
        if self.drag.is_some() {
            if let Some(at) = response.interact_pointer_pos() {
                self.drag_to(at);
            }
            if response.drag_stopped() {
                self.drag = None;
            }
            return;
        }
        let moved = response.drag_delta();
        let by = DVec2::new(f64::from(moved.x), f64::from(moved.y));
        let is_left = response.dragged_by(PointerButton::Primary) && !self.brush.is_on;
        if by != DVec2::ZERO && (is_left || response.dragged()) {
            let mut eye = self.free_eye(drawn);
            if response.dragged_by(PointerButton::Middle) || (is_left && modifiers.shift) {
                eye.pan(by / f64::from(self.picture.height()), &drawn.view);
            } else if response.dragged_by(PointerButton::Secondary) {
                eye.turn(by * TURN);
            } else if is_left {
                eye.orbit(by * TURN);
            }
            if !self.brush.is_on || !response.dragged_by(PointerButton::Primary) {
                self.eye = Some(eye);
            }
        }
        if response.hovered() {
            let wheel = f64::from(ui.input(egui::InputState::smooth_scroll_delta).y);
            if wheel != 0.0 {
                let mut eye = self.free_eye(drawn);
                eye.dolly(downpour::math::ops::f64::exp(-wheel * WHEEL));
                self.eye = Some(eye);
            }
        }
        if response.clicked()
            && !self.brush.is_on
            && let Some(at) = response.interact_pointer_pos()
        {
            self.click(at, modifiers.shift || modifiers.command, drawn, objects);
        }
    }

    /// Selects what is under a click.
    fn click(&mut self, at: Pos2, adds: bool, drawn: &Drawn, objects: &[Object]) {
        let anchor = self.anchor(&drawn.view);
        let near = objects.iter().filter(|object| !self.hidden.contains(&object.id)).filter_map(|object| {
            let place = object.position.as_ref().map_or(anchor, |(_, place)| *place);
            let distance = self.to_screen(drawn.view.project(place)?.0).distance(at);
            (distance < CLICK).then_some((distance, &object.id))
        });
        match near.min_by(|(a, _), (b, _)| a.total_cmp(b)) {
            Some((_, id)) => self.pick(&id.clone(), adds),
            None if !adds => self.selected.clear(),
            None => {}
        }
    }

    /// Selects an object, alone or with others.
    pub(super) fn pick(&mut self, id: &ObjectId, adds: bool) {
        if !adds {
            self.selected = [id.clone()].into();
        } else if !self.selected.remove(id) {
            self.selected.insert(id.clone());
        }
    }

    /// Flies with the keys: W, A, S, D, Q and E; walks on level ground with Alt.
    fn flight(&mut self, ui: &egui::Ui, response: &egui::Response, drawn: &Drawn) {
        let is_typing = ui.ctx().egui_wants_keyboard_input();
        let is_meant = response.hovered() || response.has_focus() || self.timeline.flight.is_some();
        if is_typing || self.dialog.is_some() || !is_meant {
            self.note_flight();
            return;
        }
        let (way, is_fast, walks, dt) = ui.input(|input| {
            let axis = |plus: Key, minus: Key| {
                f64::from(u8::from(input.key_down(plus))) - f64::from(u8::from(input.key_down(minus)))
            };
            let way = DVec3::new(axis(Key::D, Key::A), axis(Key::E, Key::Q), axis(Key::W, Key::S));
            let way = if input.modifiers.command { DVec3::ZERO } else { way };
            (way, input.modifiers.shift, input.modifiers.alt, f64::from(input.stable_dt.min(0.1)))
        });
        if way != DVec3::ZERO {
            let mut eye = self.free_eye(drawn);
            let step = dt * if is_fast { 12.0 } else { 4.0 };
            if walks {
                eye.walk(way.x * step, way.z * step);
            } else {
                eye.fly(way * step);
            }
            self.eye = Some(eye);
            ui.ctx().request_repaint();
        }
        self.note_flight();
    }

    fn note_flight(&mut self) {
        if let (Some(flight), Some(eye)) = (&mut self.timeline.flight, self.eye) {
            flight.note(self.clock.time_s, &eye);
        }
    }
}
