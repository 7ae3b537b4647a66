//! Handles of objects: what is dragged in the picture changes keys of the file.

use downpour::math::ops::f64 as ops;
use egui::Pos2;
use glam::DVec3;

use super::App;
use crate::engine::PictureView;
use crate::key_path::KeyPath;
use crate::objects::{DirectionKey, Object, rounded, significant};
use crate::plain::Plain;
use crate::wire::{across, rectangle_axes};

/// Length of the arrows of a handle, as a part of the picture's height.
const ARROW: f64 = 0.11;

/// Distance of a pointer at which it takes a handle, in points.
const REACH: f32 = 11.0;

/// Step of lengths and of angles with snap, m and degrees.
const STEP_M: f64 = 0.5;
const STEP_DEG: f64 = 15.0;

/// Least edge of a rectangle, m.
const MIN_EDGE_M: f64 = 0.1;

/// Points by which a strength is dragged until it is multiplied by e.
const STRENGTH_POINTS: f64 = 120.0;

/// The value that a handle changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HandleKind {
    /// Place, along x, y or z.
    Axis(usize),
    /// Place, on a level plane.
    Level,
    /// Core radius.
    Radius,
    /// Width (0) or length (1) of a rectangle.
    Edge(usize),
    /// Direction.
    Direction,
    /// Strength: up is more.
    Strength,
}

/// A handle in the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Handle {
    /// The value that it changes.
    pub kind: HandleKind,
    /// Its position, in points.
    pub at: Pos2,
    /// Position of its object, in points.
    pub from: Pos2,
}

/// A drag of a handle.
#[derive(Clone, Debug)]
pub(super) struct Drag {
    pub(super) kind: HandleKind,
    /// The object whose handle it is, as it was.
    object: Object,
    /// Place of each object that moves, as it was.
    moved: Vec<(KeyPath, DVec3)>,
    /// Position at which the drag began, in points.
    begin: Pos2,
    view: PictureView,
    anchor: DVec3,
}

/// Point of a line that is nearest to a ray, as the distance along the line; `None` if they are parallel.
#[must_use]
fn along_line(point: DVec3, axis: DVec3, eye: DVec3, ray: DVec3) -> Option<f64> {
    let offset = point - eye;
    let slant = axis.dot(ray);
    let apart = 1.0 - slant * slant;
    (apart > 1.0e-4).then(|| (slant * ray.dot(offset) - axis.dot(offset)) / apart)
}

/// Point in which a ray meets a plane, before the eye.
#[must_use]
fn on_plane(point: DVec3, normal: DVec3, eye: DVec3, ray: DVec3) -> Option<DVec3> {
    let toward = ray.dot(normal);
    let distance = (point - eye).dot(normal) / toward;
    (toward.abs() > 1.0e-3 && distance > 0.0).then(|| eye + ray * distance)
}

impl App {
    /// Handles of the object that is selected alone, or those of place of the last of several.
    pub(super) fn make_handles(&self, objects: &[Object], view: &PictureView, anchor: DVec3) -> Vec<Handle> {
        let Some(object) = objects.iter().rfind(|object| self.selected.contains(&object.id)) else {
            return Vec::new();
        };
        if self.hidden.contains(&object.id) || self.brush.is_on {
            return Vec::new();
        }
        let at = object.position.as_ref().map_or(anchor, |(_, at)| *at);
        let Some((_, depth)) = view.project(at) else { return Vec::new() };
        let arrow = view.height_at(depth) * ARROW;
        let mut places = Vec::new();
        if object.position.is_some() {
            for (axis, direction) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
                places.push((HandleKind::Axis(axis), at + direction * arrow));
            }
            places.push((HandleKind::Level, at));
        }
        if self.selected.len() == 1 {
            if let Some((_, direction)) = &object.direction
                && (object.strength.is_some() || object.rectangle.is_some())
            {
                places.push((HandleKind::Direction, at + *direction * turn_reach(object, arrow)));
            }
            if let Some((_, size, turn)) = &object.rectangle {
                for (edge, (axis, length)) in rectangle_axes(*turn).into_iter().zip(size).enumerate() {
                    places.push((HandleKind::Edge(edge), at + axis * (length * 0.5)));
                }
            }
            if let Some((_, radius)) = &object.radius {
                let axis = object.direction.as_ref().map_or(DVec3::Y, |(_, direction)| *direction);
                places.push((HandleKind::Radius, at + radius_side(axis, view) * *radius));
            }
            if object.strength.is_some() {
                places.push((HandleKind::Strength, at + (view.right * 0.75 + view.up * 0.75) * arrow));
            }
        }
        let screen = |point: DVec3| view.project(point).map(|(place, _)| self.to_screen(place));
        let Some(from) = screen(at) else { return Vec::new() };
        places
            .into_iter()
            .filter_map(|(kind, point)| Some(Handle { kind, at: screen(point)?, from }))
            .collect()
    }

    /// The handle under a pointer.
    pub(super) fn handle_at(&self, pointer: Pos2) -> Option<HandleKind> {
        let near = self.handles.iter().map(|handle| (handle.at.distance(pointer), handle.kind));
        let (distance, kind) = near.min_by(|(a, _), (b, _)| a.total_cmp(b))?;
        (distance <= REACH).then_some(kind)
    }

    /// Begins to drag a handle.
    pub(super) fn begin_drag(&mut self, kind: HandleKind, begin: Pos2) {
        let Some(drawn) = self.drawn.clone() else { return };
        let objects = self.objects();
        let Some(object) = objects.iter().rfind(|object| self.selected.contains(&object.id)).cloned() else {
            return;
        };
        let moved = objects
            .iter()
            .filter(|object| self.selected.contains(&object.id))
            .filter_map(|object| object.position.clone())
            .collect();
        let anchor = self.anchor(&drawn.view);
        self.drag = Some(Drag { kind, object, moved, begin, view: drawn.view, anchor });
    }

    /// Drags the handle to a pointer.
    pub(super) fn drag_to(&mut self, pointer: Pos2) {
        let Some(drag) = self.drag.take() else { return };
        let values = self.dragged(&drag, pointer);
        let label = format!("drag {}", drag.object.id.list);
        let values: Vec<(KeyPath, Plain)> = values
            .into_iter()
            .map(|(path, value)| {
                let value = crate::objects::set_at(self.document.get(&path), self.clock.time_s, value);
                (path, value)
            })
            .collect();
        if !values.is_empty() {
            let result = self.document.set_all(&label, &values, Some(self.stroke));
            self.noted(result);
        }
        self.drag = Some(drag);
    }

    /// Values of keys for a pointer.
    fn dragged(&self, drag: &Drag, pointer: Pos2) -> Vec<(KeyPath, Plain)> {
        let view = &drag.view;
        let [begin, now] = [drag.begin, pointer].map(|at| view.ray(self.on_picture(at)));
        let at = drag.object.position.as_ref().map_or(drag.anchor, |(_, at)| *at);
        let snapped =
            |value: f64, step: f64| if self.overlay.snaps { (value / step).round() * step } else { value };
        let number = |path: &KeyPath, value: f64| vec![(path.clone(), Plain::Number(value))];
        match drag.kind {
            HandleKind::Axis(axis) => {
                let direction = DVec3::AXES[axis.min(2)];
                let [from, to] = [begin, now].map(|ray| along_line(at, direction, view.eye, ray));
                let (Some(from), Some(to)) = (from, to) else { return Vec::new() };
                move_all(&drag.moved, direction * snapped(to - from, STEP_M))
            }
            HandleKind::Level => {
                let [from, to] = [begin, now].map(|ray| on_plane(at, DVec3::Y, view.eye, ray));
                let (Some(from), Some(to)) = (from, to) else { return Vec::new() };
                let by = to - from;
                move_all(&drag.moved, DVec3::new(snapped(by.x, STEP_M), 0.0, snapped(by.z, STEP_M)))
            }
            HandleKind::Radius => {
                let Some((path, _)) = &drag.object.radius else { return Vec::new() };
                let Some(point) = on_plane(at, -view.forward, view.eye, now) else { return Vec::new() };
                let axis = drag.object.direction.as_ref().map_or(DVec3::Y, |(_, direction)| *direction);
                let radius = (point - at).dot(radius_side(axis, view)).max(0.05);
                number(path, significant(snapped(radius, STEP_M).max(0.05)))
            }
            HandleKind::Edge(edge) => {
                let Some((path, size, turn)) = &drag.object.rectangle else { return Vec::new() };
                let Some(point) = on_plane(at, DVec3::Y, view.eye, now) else { return Vec::new() };
                let mut size = *size;
                let (Some(axis), Some(length)) =
                    (rectangle_axes(*turn).get(edge).copied(), size.get_mut(edge))
                else {
                    return Vec::new();
                };
                *length = rounded(snapped(2.0 * (point - at).dot(axis), STEP_M).max(MIN_EDGE_M));
                vec![(path.clone(), Plain::of_numbers(&size))]
            }
            HandleKind::Strength => {
                let Some((path, strength)) = &drag.object.strength else { return Vec::new() };
                let up = f64::from(drag.begin.y - pointer.y);
                let factor = ops::exp(up / STRENGTH_POINTS);
                let value = if *strength == 0.0 { up * 0.1 } else { strength * factor };
                number(path, significant(value))
            }
            HandleKind::Direction => {
                let Some((key, old)) = &drag.object.direction else { return Vec::new() };
                let arrow = view.project(at).map_or(1.0, |(_, depth)| view.height_at(depth) * ARROW);
                let tip = at + *old * turn_reach(&drag.object, arrow);
                match key {
                    DirectionKey::Degrees(path) => {
                        let Some(point) = on_plane(at, DVec3::Y, view.eye, now) else { return Vec::new() };
                        let way = point - at;
                        let degrees = ops::atan2(way.z, way.x).to_degrees();
                        number(path, snapped(degrees, STEP_DEG).round())
                    }
                    DirectionKey::Vector(path) => {
                        let Some(point) = on_plane(tip, -view.forward, view.eye, now) else {
                            return Vec::new();
                        };
                        let Some(direction) = (point - at).try_normalize() else { return Vec::new() };
                        let direction =
                            if self.overlay.snaps { snap_direction(direction) } else { direction };
                        vec![(path.clone(), Plain::of_numbers(&direction.to_array().map(rounded)))]
                    }
                }
            }
        }
    }

    /// Position to which a handle has to be dragged, in points: by meters along an axis, by a factor of radius, size or strength, by degrees of a
    /// direction about the vertical.
    #[must_use]
    pub fn dragged_place(&self, handle: &Handle, by: f64) -> Option<Pos2> {
        let drawn = self.drawn.as_ref()?;
        let view = &drawn.view;
        let objects = self.objects();
        let object = objects.iter().rfind(|object| self.selected.contains(&object.id))?;
        let at = object.position.as_ref().map_or_else(|| self.anchor(view), |(_, at)| *at);
        let (_, depth) = view.project(at)?;
        let screen = |point: DVec3| view.project(point).map(|(place, _)| self.to_screen(place));
        match handle.kind {
            HandleKind::Axis(axis) => {
                screen(at + DVec3::AXES[axis.min(2)] * (view.height_at(depth) * ARROW + by))
            }
            HandleKind::Radius => {
                let axis = object.direction.as_ref().map_or(DVec3::Y, |(_, direction)| *direction);
                screen(at + radius_side(axis, view) * (object.radius.as_ref()?.1 * by))
            }
            HandleKind::Edge(edge) => {
                let (_, size, turn) = object.rectangle.as_ref()?;
                screen(at + *rectangle_axes(*turn).get(edge)? * (size.get(edge)? * 0.5 * by))
            }
            HandleKind::Direction => {
                let (DirectionKey::Degrees(_), direction) = object.direction.as_ref()? else { return None };
                let reach = turn_reach(object, view.height_at(depth) * ARROW);
                let angle = ops::atan2(direction.z, direction.x) + by.to_radians();
                screen(at + DVec3::new(ops::cos(angle), 0.0, ops::sin(angle)) * reach)
            }
            HandleKind::Strength if by > 0.0 => {
                let up = STRENGTH_POINTS * ops::ln(by);
                Some(handle.at - egui::vec2(0.0, up as f32))
            }
            _ => None,
        }
    }
}

/// A direction across an axis, as far in the plane of the picture as may be: there the radius is dragged.
fn radius_side(axis: DVec3, view: &PictureView) -> DVec3 {
    axis.cross(view.forward)
        .try_normalize()
        .map_or_else(|| across(axis).0, |side| if side.dot(view.right) < 0.0 { -side } else { side })
}

/// Distance of the handle of a direction from its object, m: beyond the edge of a rectangle, whose own handle is there. `arrow`: length of
/// arrows at the object, m.
fn turn_reach(object: &Object, arrow: f64) -> f64 {
    object.rectangle.as_ref().map_or(arrow * 1.5, |(_, size, _)| size[0] * 0.5 + arrow)
}

fn move_all(moved: &[(KeyPath, DVec3)], by: DVec3) -> Vec<(KeyPath, Plain)> {
    let place = |at: &DVec3| Plain::of_numbers(&(*at + by).to_array().map(rounded));
    moved.iter().map(|(path, at)| (path.clone(), place(at))).collect()
}

/// A direction in steps of elevation and azimuth.
fn snap_direction(direction: DVec3) -> DVec3 {
    let step = |angle: f64| (angle.to_degrees() / STEP_DEG).round() * STEP_DEG;
    let elevation = step(ops::asin(direction.y.clamp(-1.0, 1.0))).to_radians();
    let azimuth = step(ops::atan2(direction.z, direction.x)).to_radians();
    let level = ops::cos(elevation);
    DVec3::new(level * ops::cos(azimuth), ops::sin(elevation), level * ops::sin(azimuth))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_meet_lines_and_planes() {
        let eye = DVec3::new(0.0, 2.0, 10.0);
        let target = DVec3::new(3.0, 0.0, -4.0);
        let ray = (target - eye).normalize();
        let along = along_line(DVec3::new(0.0, 0.0, -4.0), DVec3::X, eye, ray).unwrap();
        assert!((along - 3.0).abs() < 1.0e-9);
        assert!((on_plane(DVec3::ZERO, DVec3::Y, eye, ray).unwrap() - target).length() < 1.0e-9);
        assert_eq!(along_line(DVec3::ZERO, ray, eye, ray), None);
        assert_eq!(on_plane(DVec3::new(0.0, 5.0, 0.0), DVec3::Y, eye, ray), None, "behind the eye");
    }

    #[test]
    fn directions_snap_to_steps() {
        let snapped = snap_direction(DVec3::new(0.99, 0.05, 0.02).normalize());
        assert!((snapped - DVec3::X).length() < 1.0e-9);
    }
}
