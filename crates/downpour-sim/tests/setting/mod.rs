//! A camera and winds that tests have in common.

use downpour_math::ops::f64 as ops;
use downpour_sim::view::View;
use downpour_wind::{
    WindCore, WindField, WindForm, WindGrid, WindMask, WindPrimitive, WindSingularity, WindUniform,
};
use glam::{DVec3, Vec3};

/// A camera at a position that looks along an azimuth and an elevation, radians.
pub(crate) fn looking(eye: DVec3, azimuth: f64, elevation: f64) -> View {
    let (level, up) = (ops::cos(elevation), ops::sin(elevation));
    let forward = DVec3::new(level * ops::sin(azimuth), up, -level * ops::cos(azimuth));
    let right = forward.cross(DVec3::Y).normalize();
    View { eye, forward, right, up: right.cross(forward), far: 8.0, ..View::default() }
}

/// The wind of some primitives in a box of 40 m.
pub(crate) fn field(primitives: &[WindPrimitive]) -> WindField {
    let grid = WindGrid::new(Vec3::splat(-20.0), Vec3::splat(20.0), [32; 3]).expect("in range");
    WindField::new(&grid, primitives, &WindMask::open(&grid)).expect("in range")
}

/// Wind of 3 m/s with a vortex of up to 3.2 m/s ahead of the eye.
pub(crate) fn vortex() -> WindField {
    field(&[
        WindPrimitive::Uniform(WindUniform { speed: 3.0, direction: Vec3::X }),
        WindPrimitive::Vortex(WindSingularity {
            form: WindForm::Line,
            strength: 120.0,
            center: Vec3::new(0.0, 0.0, -4.0),
            axis: Vec3::Y,
            core_radius: 3.0,
            core: WindCore::Rosenhead,
        }),
    ])
}
