//! Whose eye a picture is taken with.

use downpour_scene::scene::{Lens, Pose};
use downpour_weather::{self as weather, Loaded, Weather};
use glam::{DVec3, Vec3};

use downpour_render::camera::{EyeMotion, Viewpoint};

/// Speeds, in m/s and rad/s, above which an eye has not moved but been cut to another position.
const MAX_SPEED_M_S: f32 = 100.0;
const MAX_SPEED_RAD_S: f32 = 30.0;

/// Choice of the camera.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CameraChoice {
    /// The camera of the weather.
    Weather,
    /// This camera of the scene, the first with a perspective.
    Scene(usize),
    /// A camera in front of the whole scene, a little above it.
    Framing,
    /// A camera at eye level that looks along -Z, for an empty scene.
    Standing,
}

/// An eye that somebody has placed.
pub(super) struct CameraView {
    pub(super) choice: CameraChoice,
    pub(super) eye: DVec3,
    forward: Vec3,
    up: Vec3,
    pub(super) fov: f64,
    pub(super) near: Option<f64>,
    pub(super) far: Option<f64>,
}

impl CameraView {
    /// That of the weather, else the first one of the scene.
    pub(super) fn of(weather: &Weather, loaded: &Loaded, pose: &Pose, time_s: f64) -> Option<Self> {
        if let Some(path) = &weather.camera.path {
            let camera = path.at(time_s);
            return Some(Self {
                choice: CameraChoice::Weather,
                eye: camera.position,
                forward: camera.forward.as_vec3(),
                up: Vec3::Y,
                fov: weather::FOV_RAD,
                near: None,
                far: None,
            });
        }
        pose.cameras.iter().find_map(|placed| {
            let Lens::Perspective { yfov, near, far, .. } = loaded.scene.cameras.get(placed.camera)?.lens
            else {
                return None;
            };
            let eye = pose.world_f64(placed.node).map_or(placed.eye.as_dvec3(), |world| world.translation);
            Some(Self {
                choice: CameraChoice::Scene(placed.camera),
                eye,
                forward: placed.forward,
                up: placed.up,
                fov: f64::from(yfov),
                near: Some(f64::from(near)),
                far: far.map(f64::from),
            })
        })
    }

    /// Motion of the eye about a time, from its positions so many seconds apart.
    pub(super) fn motion(before: &Self, after: &Self, apart_s: f64) -> EyeMotion {
        let velocity = (after.eye - before.eye).as_vec3() / apart_s as f32;
        let axes = |seen: &Self| {
            let right = seen.forward.cross(seen.up).normalize_or_zero();
            [right, right.cross(seen.forward), seen.forward]
        };
        // The sum of the cross products of the axes is twice the sine of the angle, along the axis.
        let pairs = axes(before).into_iter().zip(axes(after));
        let turned = pairs.map(|(from, to)| from.cross(to)).sum::<Vec3>() * 0.5;
        let sine = turned.length();
        let angle = downpour_math::ops::asin(sine.min(1.0));
        let turning = if sine > 1.0e-9 { turned * (angle / sine / apart_s as f32) } else { Vec3::ZERO };
        let jumps = !(velocity.length() <= MAX_SPEED_M_S && turning.length() <= MAX_SPEED_RAD_S);
        if jumps { EyeMotion::default() } else { EyeMotion { velocity, turning } }
    }

    pub(super) fn viewpoint(&self, fov: f64, origin: DVec3) -> Viewpoint {
        let eye = (self.eye - origin).as_vec3();
        Viewpoint { eye, forward: self.forward, up: self.up, fov_y: fov as f32 }
    }
}
