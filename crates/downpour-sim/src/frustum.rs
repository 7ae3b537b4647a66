//! Frustum of a picture with its margins, in double precision: source of the shader's [`VolumeFrustum`].

use downpour_math::ops::f64 as ops;
use downpour_shaders::sim::step::{VOLUME_PLANES, VOLUME_RADIUS};
use glam::{DMat3, DVec3, Vec3};

use crate::view::View;
use crate::volume::{VolumeFrustum, solid_angle};

/// Number of planes of a frustum.
pub(crate) const PLANES: usize = VOLUME_PLANES as usize;

/// Frustum of a picture with its margins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frustum {
    pub(crate) eye: DVec3,
    /// Right, up, forward.
    axes: [DVec3; 3],
    /// Half the picture at distance 1, widened by the rotation of the camera within the horizon.
    pub(crate) half: [f64; 2],
    /// Outward normals of right, left, top, bottom and back.
    pub(crate) normals: [DVec3; PLANES],
    /// Velocity of the air at the eye relative to the eye, m/s.
    air: DVec3,
    pub(crate) half_horizon: f64,
    half_wait: f64,
    /// Spread of the wind: m/s, 1/s of distance, and maximum m/s.
    spread: [f64; 3],
    /// Distance at which a drop is resolved, per diameter.
    per_diameter: f64,
    far: f64,
}

impl Frustum {
    /// Creates the frustum of a view in a wind, m/s at the eye, that deviates from it by `spread` (m/s, 1/s of
    /// distance, and maximum m/s). `times`: horizon and longest wait, s.
    pub(crate) fn new(
        view: &View,
        least_pixels: f64,
        wind: DVec3,
        spread: [f64; 3],
        times: [f64; 2],
    ) -> Self {
        let [horizon, wait] = times;
        let turned = 0.5 * horizon * view.turning.length();
        let half = [view.half_width, view.half_height].map(|half| half + turned * (1.0 + half * half));
        let [wide, high] = half;
        let (right, up, forward) = (view.right, view.up, view.forward);
        let side = |along: DVec3, half: f64| (along - forward * half) / (1.0 + half * half).sqrt();
        Self {
            eye: view.eye,
            axes: [right, up, forward],
            half,
            normals: [side(right, wide), side(-right, wide), side(up, high), side(-up, high), -forward],
            air: wind - view.velocity,
            half_horizon: 0.5 * horizon,
            half_wait: 0.5 * wait,
            spread,
            per_diameter: 1.0 / (view.pixel_angle * least_pixels).max(1.0e-12),
            far: view.far,
        }
    }

    /// Unit vectors to the right, up and forward.
    pub(crate) fn axes(&self) -> [DVec3; 3] {
        self.axes
    }

    /// Direction in each plane that is nearest to the view; for the back, to the right.
    pub(crate) fn tangents(&self) -> [DVec3; PLANES] {
        let [right, _, forward] = self.axes;
        let mut tangents = self.normals.map(|n| (forward - n * n.dot(forward)).normalize_or(right));
        tangents[PLANES - 1] = right;
        tangents
    }

    /// Distance, m, at which a diameter, m, is resolved.
    pub(crate) fn range(&self, diameter: f64) -> f64 {
        (diameter * self.per_diameter).min(self.far)
    }

    /// Bound on the difference of the wind, and of the velocity of drops due to it, from the wind at the eye, m/s.
    pub(crate) fn spread(&self, range: f64) -> f64 {
        (self.spread[0] + self.spread[1] * range).min(self.spread[2])
    }

    /// Minimum and maximum margin of a plane, m, for drops between two diameters and speeds.
    pub(crate) fn margins(&self, plane: usize, diameters: [f64; 2], speeds: [f64; 2]) -> [f64; 2] {
        let normal = self.normals[plane];
        let along = speeds.map(|speed| normal.dot(self.air) - speed * normal.y);
        let least = if along[0] * along[1] < 0.0 { 0.0 } else { along[0].abs().min(along[1].abs()) };
        let most = along[0].abs().max(along[1].abs());
        let margin = |diameter: f64, speed: f64| {
            let spread = self.spread(self.range(diameter));
            f64::from(VOLUME_RADIUS) * diameter + self.half_horizon * (speed + spread)
        };
        [margin(diameters[0], least), margin(diameters[1], most)]
    }

    /// Radius of the ball, m, for drops of a diameter and a speed.
    pub(crate) fn reach(&self, diameter: f64, speed: f64) -> f64 {
        let range = self.range(diameter);
        range + self.half_wait * (speed + self.air.length() + self.spread(range))
    }

    /// Volume of the picture up to the distance at which a diameter is resolved, m^3.
    pub(crate) fn volume(view: &View, range: f64) -> f64 {
        solid_angle(view.half_width, view.half_height) * range * range * range / 3.0
    }

    /// Approximate volume with its margins, m^3, to some percent.
    pub(crate) fn about_volume(&self, diameter: f64, speed: f64) -> f64 {
        let [wide, high] = self.half;
        let radius = self.reach(diameter, speed);
        let inner = solid_angle(wide, high) * radius * radius * radius / 3.0;
        let sector = |half: f64, other: f64| radius * radius * ops::atan2(half, (1.0 + other * other).sqrt());
        let areas = [sector(high, wide), sector(high, wide), sector(wide, high), sector(wide, high)];
        let margin = |plane: usize| self.margins(plane, [diameter; 2], [speed; 2])[1];
        inner + areas.into_iter().enumerate().map(|(k, area)| area * margin(k)).sum::<f64>()
    }

    /// Box along right, up and forward, relative to the eye, that holds all drops up to a diameter and a speed.
    pub(crate) fn bounds(&self, diameter: f64, speed: f64) -> [DVec3; 2] {
        let radius = self.reach(diameter, speed);
        // Slower drops may have a wider margin against the wind.
        let margin: [f64; PLANES] = std::array::from_fn(|k| self.margins(k, [diameter; 2], [0.0, speed])[1]);
        let side = |half: f64, margin: f64| (radius * half + margin * (1.0 + half * half).sqrt()).min(radius);
        let [wide, high] = self.half;
        let low = DVec3::new(-side(wide, margin[1]), -side(high, margin[3]), -margin[4].min(radius));
        [low, DVec3::new(side(wide, margin[0]), side(high, margin[2]), radius)]
    }

    /// Converts an offset along right, up and forward to world space.
    pub(crate) fn offset(&self, local: DVec3) -> DVec3 {
        let [right, up, forward] = self.axes;
        DMat3::from_cols(right, up, forward) * local
    }

    /// Frustum in the layout of the shader, relative to `origin`.
    pub(crate) fn relative_to(&self, origin: DVec3) -> VolumeFrustum {
        let plane = |normal: DVec3| normal.as_vec3().extend(normal.dot(self.air) as f32).to_array();
        let eye: Vec3 = (self.eye - origin).as_vec3();
        VolumeFrustum {
            planes: self.normals.map(plane),
            eye: eye.to_array(),
            air: self.air.length() as f32,
            half_horizon: self.half_horizon as f32,
            half_wait: self.half_wait as f32,
            spread: self.spread[0] as f32,
            spread_slope: self.spread[1] as f32,
            spread_max: self.spread[2] as f32,
            range: self.per_diameter as f32,
            farthest: self.far as f32,
            unused: 0,
        }
    }
}
