//! The panel below the picture: play, scrub, tracks of keyframes.

use egui::{Key, Pos2, Rect, RichText, Sense, Stroke};
use glam::DVec3;

use super::icons::{self, Icon};
use super::{App, Command};
use crate::key_path::KeyPath;
use crate::navigation::FreeEye;
use crate::objects::{SAME_TIME_S, rounded, with_key};
use crate::plain::Plain;
use crate::schema::{Field, Kind, find};
use crate::theme::{QUIET, okabe_ito};

/// Width of the names of tracks.
const NAMES: f32 = 190.0;

/// Height of a track.
const TRACK: f32 = 18.0;

/// Tracks that are shown before the list scrolls.
const SHOWN: f32 = 4.0;

/// State of the timeline.
#[derive(Clone, Debug, Default)]
pub(super) struct Timeline {
    /// The keyframe that is selected.
    selected: Option<(KeyPath, f64)>,
    /// A flight that is recorded.
    pub(super) flight: Option<Flight>,
}

/// Time in s, position in m, yaw and pitch in degrees.
type FlightKey = (f64, DVec3, f64, f64);

/// A flight of the eye, a key every quarter of a second.
#[derive(Clone, Debug, Default)]
pub(super) struct Flight {
    keys: Vec<FlightKey>,
}

/// Time between keys of a flight, s.
const FLIGHT_S: f64 = 0.25;

impl Flight {
    /// Takes note of the eye.
    pub(super) fn note(&mut self, time_s: f64, eye: &FreeEye) {
        if self.keys.last().is_some_and(|&(last, ..)| time_s < last + FLIGHT_S) {
            return;
        }
        // The yaw goes on past a whole turn.
        let mut yaw = eye.yaw.to_degrees();
        if let Some(&(.., before, _)) = self.keys.last() {
            yaw += ((before - yaw) / 360.0).round() * 360.0;
        }
        self.keys.push((time_s, eye.position, yaw, eye.pitch.to_degrees()));
    }

    pub(super) fn len(&self) -> usize {
        self.keys.len()
    }

    /// Keys of the camera.
    pub(super) fn keys(&self) -> Vec<(KeyPath, Plain)> {
        let key = |name: &str| KeyPath::of("camera").key(name);
        let hundredths = |value: f64| Plain::Number((value * 100.0).round() / 100.0);
        // Angles of the file are within a turn to both sides.
        let turns = self.keys.first().map_or(0.0, |&(_, _, yaw, _)| (yaw / 360.0).round() * 360.0);
        let all = |value: &dyn Fn(&FlightKey) -> Plain| {
            let keys: Vec<(f64, Plain)> = self.keys.iter().map(|key| (rounded(key.0), value(key))).collect();
            if keys.is_empty() { Plain::Number(0.0) } else { Plain::of_keys(&keys) }
        };
        vec![
            (key("position_m"), all(&|key| Plain::of_numbers(&key.1.to_array().map(rounded)))),
            (key("yaw_deg"), all(&|key| hundredths((key.2 - turns).clamp(-360.0, 360.0)))),
            (key("pitch_deg"), all(&|key| hundredths(key.3))),
        ]
    }
}

/// All values of a file that are keyframes, by their paths.
#[must_use]
pub(super) fn tracks(file: &Plain, schema: &[Field]) -> Vec<(KeyPath, Vec<(f64, Plain)>)> {
    let mut found = Vec::new();
    for (key, value) in file.entries() {
        if let Some(field) = find(schema, key) {
            walk(&KeyPath::of(key), value, field, &mut found);
        }
    }
    found
}

fn walk(path: &KeyPath, value: &Plain, field: &Field, found: &mut Vec<(KeyPath, Vec<(f64, Plain)>)>) {
    let of_table = |path: &KeyPath, table: &Plain, fields: &[Field], found: &mut Vec<_>| {
        for (key, value) in table.entries() {
            if let Some(field) = find(fields, key) {
                walk(&path.key(key), value, field, found);
            }
        }
    };
    match &field.kind {
        Kind::Table(fields) => of_table(path, value, fields, found),
        Kind::List(fields) | Kind::Variants(fields) => {
            for (index, entry) in value.list().iter().enumerate() {
                of_table(&path.entry(index), entry, fields, found);
            }
        }
        _ if field.is_keyed => found.extend(value.keys().map(|keys| (path.clone(), keys))),
        _ => {}
    }
}

impl App {
    /// The panel.
    pub(super) fn timeline(&mut self, ui: &mut egui::Ui) {
        let tracks = tracks(self.document.plain(), &self.schema);
        egui::Panel::bottom("timeline").resizable(false).show(ui, |ui| {
            ui.add_space(5.0);
            self.transport(ui);
            let ruler =
                ui.allocate_exact_size(egui::vec2(ui.available_width(), 22.0), Sense::click_and_drag());
            self.ruler(ui, ruler.0, &ruler.1);
            let rows = SHOWN.min(tracks.len() as f32).max(0.0);
            egui::ScrollArea::vertical().max_height(rows * TRACK + 2.0).auto_shrink([false, true]).show(
                ui,
                |ui| {
                    ui.spacing_mut().item_spacing.y = 0.0;
                    for (path, keys) in &tracks {
                        self.track(ui, path, keys);
                    }
                },
            );
            ui.add_space(3.0);
        });
        self.key_commands(ui, &tracks);
    }

    fn transport(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            let color = ui.visuals().text_color();
            if icons::button(ui, Icon::Begin, color, "to the begin").on_hover_text("to the begin").clicked() {
                self.clock.time_s = self.clock.range_s[0];
            }
            let (icon, name) =
                if self.clock.is_playing { (Icon::Pause, "pause") } else { (Icon::Play, "play") };
            if icons::button(ui, icon, color, name).on_hover_text("play or pause (Space)").clicked() {
                self.run(Command::Play);
            }
            ui.add(
                egui::DragValue::new(&mut self.clock.time_s)
                    .range(0.0..=1.0e6)
                    .speed(0.02)
                    .fixed_decimals(2)
                    .suffix(" s"),
            )
            .on_hover_text("time")
            .accessible_name("time");
            ui.label(RichText::new("speed").color(QUIET));
            let speed =
                egui::DragValue::new(&mut self.clock.speed).range(0.05..=10.0).speed(0.01).prefix("×");
            ui.add(speed).accessible_name("speed");
            ui.label(RichText::new("from").color(QUIET));
            let [begin, end] = &mut self.clock.range_s;
            ui.add(egui::DragValue::new(begin).range(0.0..=*end).speed(0.05).suffix(" s"))
                .accessible_name("range from");
            ui.label(RichText::new("to").color(QUIET));
            ui.add(egui::DragValue::new(end).range(*begin + 0.1..=1.0e6).speed(0.05).suffix(" s"))
                .accessible_name("range to");
            ui.checkbox(&mut self.clock.loops, "loop");
            let is_recording = self.timeline.flight.is_some();
            let text = RichText::new("Record flight");
            let text = if is_recording { text.color(okabe_ito::VERMILION) } else { text };
            if ui
                .button(text)
                .on_hover_text("fly with W A S D Q E; the flight becomes the camera's path (R)")
                .clicked()
            {
                self.run(Command::Record);
            }
            if let Some((path, time)) = &self.timeline.selected {
                ui.label(RichText::new(format!("{path} at {time:.2} s")).color(okabe_ito::YELLOW).small());
            }
        });
    }

    fn time_at(&self, rect: Rect, x: f32) -> f64 {
        let [begin, end] = self.clock.range_s;
        let part = f64::from((x - rect.left() - NAMES) / (rect.width() - NAMES - 8.0));
        begin + part.clamp(0.0, 1.0) * (end - begin)
    }

    fn x_of(&self, rect: Rect, time_s: f64) -> f32 {
        let [begin, end] = self.clock.range_s;
        let part = (time_s - begin) / (end - begin).max(1.0e-6);
        rect.left() + NAMES + part as f32 * (rect.width() - NAMES - 8.0)
    }

    fn ruler(&mut self, ui: &egui::Ui, rect: Rect, response: &egui::Response) {
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, "time ruler"));
        if let Some(at) = response.interact_pointer_pos()
            && (response.dragged() || response.clicked())
        {
            self.clock.is_playing = false;
            self.clock.time_s = (self.time_at(rect, at.x) * 100.0).round() / 100.0;
        }
        let painter = ui.painter_at(rect);
        let [begin, end] = self.clock.range_s;
        let step = [0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 300.0]
            .into_iter()
            .find(|step| (end - begin) / step <= 14.0);
        let step = step.unwrap_or(3600.0);
        let mut time = (begin / step).ceil() * step;
        while time <= end + 1.0e-9 {
            let x = self.x_of(rect, time);
            painter.vline(
                x,
                rect.bottom() - 6.0..=rect.bottom(),
                Stroke::new(1.0, QUIET.gamma_multiply(0.7)),
            );
            let font = egui::FontId::proportional(10.5);
            painter.text(
                Pos2::new(x, rect.top() + 1.0),
                egui::Align2::CENTER_TOP,
                format!("{time:.4}").trim_end_matches('0').trim_end_matches('.'),
                font,
                QUIET,
            );
            time += step;
        }
        self.now_line(&painter, rect);
    }

    fn now_line(&self, painter: &egui::Painter, rect: Rect) {
        let x = self.x_of(rect, self.clock.time_s);
        if x <= rect.right() {
            painter.vline(x, rect.y_range(), Stroke::new(1.5, okabe_ito::VERMILION));
        }
    }

    fn track(&mut self, ui: &mut egui::Ui, path: &KeyPath, keys: &[(f64, Plain)]) {
        let (rect, response) =
            ui.allocate_exact_size(egui::vec2(ui.available_width(), TRACK), Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, format!("track {path}")));
        let painter = ui.painter_at(rect);
        let names = Rect::from_min_size(rect.min, egui::vec2(NAMES - 8.0, TRACK));
        let font = egui::FontId::proportional(11.5);
        painter.with_clip_rect(names).text(
            names.left_center() + egui::vec2(4.0, 0.0),
            egui::Align2::LEFT_CENTER,
            path.to_string(),
            font,
            ui.visuals().text_color(),
        );
        let lane = Rect::from_min_max(Pos2::new(rect.left() + NAMES - 6.0, rect.top() + 1.0), rect.max);
        painter.rect_filled(lane, 2.0, ui.visuals().faint_bg_color);
        let near = |app: &Self, at: Pos2| {
            let distance = |time: f64| (app.x_of(rect, time) - at.x).abs();
            let times = keys.iter().map(|&(time, _)| time).filter(|&time| distance(time) < 7.0);
            times.min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
        };
        if let Some(at) = response.interact_pointer_pos() {
            if response.clicked() || response.drag_started() {
                self.timeline.selected = near(self, at).map(|time| (path.clone(), time));
            }
            if response.double_clicked() && near(self, at).is_none() {
                let time = (self.time_at(rect, at.x) * 100.0).round() / 100.0;
                let value = with_key(keys, time, Plain::of_keys(keys).at(time));
                let result = self.document.set(path, &value, None);
                self.noted(result);
            }
            if response.dragged()
                && let Some((of, old)) = self.timeline.selected.clone().filter(|(of, _)| of == path)
            {
                let time = (self.time_at(rect, at.x) * 100.0).round() / 100.0;
                self.move_key(&of, keys, old, time);
            }
        }
        for &(time, _) in keys {
            let x = self.x_of(rect, time);
            if x > rect.right() {
                continue;
            }
            let is_selected = self
                .timeline
                .selected
                .as_ref()
                .is_some_and(|(of, at)| of == path && (at - time).abs() < SAME_TIME_S);
            let color = if is_selected { okabe_ito::YELLOW } else { okabe_ito::ORANGE };
            let middle = Pos2::new(x, rect.center().y);
            let size = if is_selected { 6.0 } else { 4.5 };
            let points = [(0.0, -size), (size, 0.0), (0.0, size), (-size, 0.0)];
            let points = points.iter().map(|&(x, y)| middle + egui::vec2(x, y)).collect();
            painter.add(egui::Shape::convex_polygon(points, color, Stroke::NONE));
        }
        self.now_line(&painter, rect);
    }

    /// Moves a keyframe in time, not onto another.
    fn move_key(&mut self, path: &KeyPath, keys: &[(f64, Plain)], old: f64, new: f64) {
        let is_taken = keys.iter().any(|&(time, _)| (time - new).abs() < SAME_TIME_S);
        let Some((_, value)) = keys.iter().find(|(time, _)| (time - old).abs() < SAME_TIME_S) else { return };
        if is_taken {
            return;
        }
        let others: Vec<_> =
            keys.iter().filter(|(time, _)| (time - old).abs() >= SAME_TIME_S).cloned().collect();
        let moved = with_key(&others, new, value.clone());
        let result = self.document.set(path, &moved, Some(self.stroke));
        if self.noted(result).is_some() {
            self.timeline.selected = Some((path.clone(), new));
        }
    }

    /// Deletes the selected keyframe with the backspace key, and eases it with X.
    fn key_commands(&mut self, ui: &egui::Ui, tracks: &[(KeyPath, Vec<(f64, Plain)>)]) {
        let Some((path, time)) = self.timeline.selected.clone() else { return };
        let Some((_, keys)) = tracks.iter().find(|(of, _)| *of == path) else {
            self.timeline.selected = None;
            return;
        };
        if ui.ctx().egui_wants_keyboard_input() || self.dialog.is_some() {
            return;
        }
        let pressed = |key: Key| ui.input(|input| input.key_pressed(key));
        if pressed(Key::Backspace) {
            self.delete_key(&path, time);
        } else if pressed(Key::X) {
            let eased = ease(keys, time);
            let result = self.document.set(&path, &eased, None);
            self.noted(result);
        }
    }

    /// Deletes a keyframe; the last one becomes a constant.
    pub fn delete_key(&mut self, path: &KeyPath, time_s: f64) {
        let Some(keys) = self.document.get(path).and_then(Plain::keys) else {
            self.complain(format!("{path}: no keyframes"));
            return;
        };
        let left: Vec<_> =
            keys.iter().filter(|(time, _)| (time - time_s).abs() >= SAME_TIME_S).cloned().collect();
        if left.len() == keys.len() {
            self.complain(format!("{path}: no keyframe at {time_s} s"));
            return;
        }
        let value = match (&left[..], keys.first()) {
            ([], Some((_, last))) => last.clone(),
            _ => Plain::of_keys(&left),
        };
        let result = self.document.set(path, &value, None);
        self.noted(result);
        self.timeline.selected = None;
    }

    /// Sets a keyframe; a constant becomes one of it at time 0 too.
    ///
    /// # Errors
    /// As [`crate::document::Document::set`].
    pub fn set_key(
        &mut self,
        path: &KeyPath,
        time_s: f64,
        value: Plain,
    ) -> Result<(), crate::document::DocumentError> {
        let keys = match self.document.get(path) {
            Some(old) => old.keys().unwrap_or_default(),
            None => Vec::new(),
        };
        self.document.set(path, &with_key(&keys, time_s, value), None)
    }
}

/// Keyframes with more of them after one, so that the value leaves it and reaches the next smoothly: the file's are linear.
fn ease(keys: &[(f64, Plain)], time_s: f64) -> Plain {
    let all = Plain::of_keys(keys);
    let Some(index) = keys.iter().position(|(time, _)| (time - time_s).abs() < SAME_TIME_S) else {
        return all;
    };
    let (Some((begin, _)), Some((end, _))) = (keys.get(index), keys.get(index + 1)) else { return all };
    let mut eased = keys.to_vec();
    let more = (1..8).map(|k| {
        let part = f64::from(k) / 8.0;
        let smooth = part * part * (3.0 - 2.0 * part);
        (rounded(begin + (end - begin) * part), all.at(begin + (end - begin) * smooth))
    });
    eased.splice(index + 1..index + 1, more);
    Plain::of_keys(&eased)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tracks_are_the_keyed_values_of_the_schema() {
        let text = "[rain]\nrate_mm_h = [[0, 1], [4, 20]]\n[camera]\nposition_m = [0, 1, 2]\nlook_at_m = [0, 1, -9]\n\
                    [[flash]]\ntime_s = 1\nazimuth_deg = 0\nstrokes = [[0, 1], [50, 0.5]]\n\
                    [[wind]]\nvortex = { strength_m2_s = 4, center_m = [[0, [1, 2, 3]], [9, [4, 5, 6]]] }\n";
        let document = crate::document::Document::from_text("", text, std::path::Path::new("")).unwrap();
        let found = tracks(document.plain(), &crate::schema::fields());
        let paths: Vec<String> = found.iter().map(|(path, _)| path.to_string()).collect();
        assert_eq!(paths, ["rain.rate_mm_h", "wind[0].vortex.center_m"]);
    }

    #[test]
    fn an_eased_key_starts_and_ends_slowly() {
        let keys = [(0.0, Plain::Number(0.0)), (8.0, Plain::Number(8.0))];
        let eased = ease(&keys, 0.0);
        let at = |time| eased.at(time).number().unwrap();
        assert_eq!((at(0.0), at(4.0), at(8.0)), (0.0, 4.0, 8.0));
        assert!((at(1.0) - 0.34375).abs() < 1.0e-9 && (8.0 - at(7.0) - 0.34375).abs() < 1.0e-9);
    }

    #[test]
    fn a_flight_becomes_keys_that_the_parser_takes() {
        let mut flight = Flight::default();
        let view = crate::engine::PictureView::new(DVec3::ZERO, DVec3::NEG_Z, 0.8, 1.5);
        let mut eye = FreeEye::of(&view, 5.0);
        for step in 0..40 {
            flight.note(f64::from(step) * 0.1, &eye);
            eye.turn(glam::DVec2::new(0.1, 0.01));
            eye.fly(DVec3::new(0.0, 0.0, 0.3));
        }
        assert_eq!(flight.len(), 14);
        let text = "[camera]\nposition_m = [0, 1, 2]\nlook_at_m = [0, 1, -9]\n";
        let mut document = crate::document::Document::from_text("", text, std::path::Path::new("")).unwrap();
        let removed = [KeyPath::parse("camera.look_at_m").unwrap()];
        document.set_and_remove("record", &flight.keys(), &removed).unwrap();
        assert!(!document.weather().camera.path.as_ref().unwrap().is_still());
    }
}
