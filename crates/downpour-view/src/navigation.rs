//! An eye that is moved by hand: orbit, pan, dolly, fly, walk.

use downpour::math::ops::f64 as ops;
use downpour::weather::CameraPose;
use glam::{DVec2, DVec3};

use crate::engine::PictureView;

/// Steepest pitch, radians: straight up and down are no directions of a file.
const MAX_PITCH: f64 = 89.0 * std::f64::consts::PI / 180.0;

/// Distance within which eyes stay, m: that of a file.
const MAX_M: f64 = 1.0e6;

/// An eye, with the point that it turns about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeEye {
    /// Position, m.
    pub position: DVec3,
    /// Turn about the vertical, radians: 0 looks along -Z.
    pub yaw: f64,
    /// Upward angle, radians.
    pub pitch: f64,
    /// Distance of the point in the middle that orbits turn about, m.
    pub distance: f64,
}

impl FreeEye {
    /// The eye of a picture, turning about a point at a distance in m.
    #[must_use]
    pub fn of(view: &PictureView, distance: f64) -> Self {
        let mut eye = Self { position: view.eye, yaw: 0.0, pitch: 0.0, distance: distance.clamp(0.1, 1.0e4) };
        eye.look_along(view.forward);
        eye
    }

    fn look_along(&mut self, forward: DVec3) {
        self.yaw = ops::atan2(-forward.x, -forward.z);
        self.pitch = ops::asin(forward.y.clamp(-1.0, 1.0)).clamp(-MAX_PITCH, MAX_PITCH);
    }

    /// View direction.
    #[must_use]
    pub fn forward(&self) -> DVec3 {
        let flat = ops::cos(self.pitch);
        DVec3::new(-flat * ops::sin(self.yaw), ops::sin(self.pitch), -flat * ops::cos(self.yaw))
    }

    fn right(&self) -> DVec3 {
        DVec3::new(ops::cos(self.yaw), 0.0, -ops::sin(self.yaw))
    }

    /// The point that orbits turn about.
    #[must_use]
    pub fn pivot(&self) -> DVec3 {
        self.position + self.forward() * self.distance
    }

    /// The eye as a pose of a camera.
    #[must_use]
    pub fn pose(&self) -> CameraPose {
        CameraPose { position: self.position, forward: self.forward() }
    }

    /// Turns the eye where it is, by angles in radians to the right and down.
    pub fn turn(&mut self, by: DVec2) {
        let turn = std::f64::consts::TAU;
        self.yaw = (self.yaw - by.x).rem_euclid(turn);
        self.pitch = (self.pitch - by.y).clamp(-MAX_PITCH, MAX_PITCH);
    }

    /// Turns the eye about its pivot, by angles in radians.
    pub fn orbit(&mut self, by: DVec2) {
        let pivot = self.pivot();
        self.turn(by);
        self.place(pivot - self.forward() * self.distance);
    }

    /// Moves the eye in the plane of the picture, by parts of the picture's height.
    pub fn pan(&mut self, by: DVec2, view: &PictureView) {
        let height = view.height_at(self.distance);
        self.place(self.position + (view.up * by.y - view.right * by.x) * height);
    }

    /// Moves the eye toward its pivot, which stays: to this part of the distance.
    pub fn dolly(&mut self, factor: f64) {
        let pivot = self.pivot();
        self.distance = (self.distance * factor).clamp(0.1, 1.0e4);
        self.place(pivot - self.forward() * self.distance);
    }

    /// Flies by meters to the right, up and forward.
    pub fn fly(&mut self, by: DVec3) {
        self.place(self.position + self.right() * by.x + DVec3::Y * by.y + self.forward() * by.z);
    }

    /// Walks on level ground by meters to the right and forward.
    pub fn walk(&mut self, right: f64, ahead: f64) {
        let level = DVec3::new(-ops::sin(self.yaw), 0.0, -ops::cos(self.yaw));
        self.place(self.position + self.right() * right + level * ahead);
    }

    /// Looks at a sphere so that it fills half of the picture's height.
    pub fn frame(&mut self, center: DVec3, radius: f64, view: &PictureView) {
        let forward = self.forward();
        self.distance = (radius * 2.0 / view.half_height).clamp(0.5, 1.0e4);
        self.place(center - forward * self.distance);
    }

    fn place(&mut self, position: DVec3) {
        self.position = position.clamp(DVec3::splat(-MAX_M), DVec3::splat(MAX_M));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn eye() -> (FreeEye, PictureView) {
        let view = PictureView::new(DVec3::new(3.0, 1.6, 5.0), DVec3::new(-0.4, -0.1, -1.0), 0.8, 1.5);
        (FreeEye::of(&view, 10.0), view)
    }

    #[test]
    fn the_eye_of_a_picture_looks_as_it_does() {
        let (eye, view) = eye();
        assert!((eye.forward() - view.forward).length() < 1.0e-12);
        // Yaw and pitch are those of the file's keys.
        let text = format!(
            "[camera]\nposition_m = [0, 0, 0]\nyaw_deg = {}\npitch_deg = {}\n",
            eye.yaw.to_degrees(),
            eye.pitch.to_degrees()
        );
        let weather = downpour::weather::Weather::parse("", &text).unwrap();
        assert!((weather.camera.path.unwrap().at(0.0).forward - eye.forward()).length() < 1.0e-12);
    }

    #[test]
    fn an_orbit_keeps_its_pivot_and_its_distance() {
        let (mut eye, _) = eye();
        let pivot = eye.pivot();
        for step in 0..50 {
            eye.orbit(DVec2::new(0.3, if step % 2 == 0 { 0.4 } else { -0.1 }));
            assert!((eye.pivot() - pivot).length() < 1.0e-9);
            assert!(((eye.position - pivot).length() - 10.0).abs() < 1.0e-9);
            assert!(eye.forward().y.abs() < 1.0, "never straight up or down");
        }
    }

    #[test]
    fn a_pan_moves_what_is_at_the_pivot_with_the_pointer() {
        let (mut eye, view) = eye();
        let pivot = eye.pivot();
        eye.pan(DVec2::new(0.1, 0.2), &view);
        let moved = PictureView::new(eye.position, eye.forward(), 0.8, 1.5);
        let (place, _) = moved.project(pivot).unwrap();
        assert!((place - DVec2::new(0.5 + 0.1 / 1.5, 0.5 + 0.2)).length() < 1.0e-9, "{place}");
    }

    #[test]
    fn walking_stays_level_and_framing_fills_half() {
        let (mut eye, view) = eye();
        eye.walk(2.0, 3.0);
        assert_eq!(eye.position.y, 1.6);
        eye.frame(DVec3::new(7.0, 0.0, -4.0), 2.0, &view);
        let framed = PictureView::new(eye.position, eye.forward(), 0.8, 1.5);
        let (middle, depth) = framed.project(DVec3::new(7.0, 0.0, -4.0)).unwrap();
        assert!((middle - DVec2::splat(0.5)).length() < 1.0e-9);
        assert!((4.0 / framed.height_at(depth) - 0.5).abs() < 1.0e-9);
    }
}
