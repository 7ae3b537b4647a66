//! The velocity that a primitive makes at a place, m/s. Twin of `shaders/wgsl/wind/primitive.wgsl`.
//!
//! With e the core radius, and r the distance from the axis (line forms) or from the centre (point forms):
//!
//! | form | speed of strength 1 | far away | source |
//! |---|---|---|---|
//! | line | r / (2 pi (r^2 + e^2)) | 1 / (2 pi r) | Rousseau 2008, 3.1; core: Rosenhead 1930 |
//! | point | r / (4 pi (r^2 + e^2)^(3/2)) | 1 / (4 pi r^2) | the same core in three dimensions |
//!
//! The speed is outward for a source, inward for a sink, and across the axis for a vortex. It is finite everywhere: at
//! most 1 / (4 pi e), at r = e (line), or 0.0306 / e^2, at r = e / sqrt 2 (point). Outside it is less than the law without
//! a core by at most the share e^2 / r^2 (line) or 1.5 e^2 / r^2 (point). A point vortex is the field of Biot and Savart
//! about a short piece of a vortex: its strength is circulation times length.

use downpour_shaders::wind::{
    WIND_PRIMITIVE_LINE, WIND_PRIMITIVE_LINE_SINK, WIND_PRIMITIVE_LINE_SOURCE, WIND_PRIMITIVE_LINE_VORTEX,
    WIND_PRIMITIVE_POINT, WIND_PRIMITIVE_POINT_SINK, WIND_PRIMITIVE_POINT_SOURCE,
    WIND_PRIMITIVE_POINT_VORTEX, WIND_PRIMITIVE_UNIFORM, WIND_PRIMITIVE_UPDRAFT,
};
use glam::Vec3;

use crate::matrix::WindMatrix;

/// The part of an offset that is across the axis, a unit vector.
#[must_use]
pub fn wind_primitive_across(offset: Vec3, axis: Vec3) -> Vec3 {
    offset - axis * offset.dot(axis)
}

/// Speed per distance of a line form, 1/s; `strength` in m^2/s, `squared` is the squared distance from the axis.
#[must_use]
pub fn wind_primitive_line(strength: f32, squared: f32, core: f32) -> f32 {
    WIND_PRIMITIVE_LINE * strength / (squared + core * core)
}

/// Speed per distance of a point form, 1/s; `strength` in m^3/s, `squared` is the squared distance from the centre.
#[must_use]
pub fn wind_primitive_point(strength: f32, squared: f32, core: f32) -> f32 {
    let regular = squared + core * core;
    WIND_PRIMITIVE_POINT * strength / (regular * regular.sqrt())
}

/// The integral of 3 / (regular + u^2)^(5/2) for u from 0 to `along`, times `regular`.
#[must_use]
pub fn wind_primitive_rise(regular: f32, along: f32) -> f32 {
    let whole = regular + along * along;
    along / whole.sqrt() * (1.0 / whole + 2.0 / regular)
}

/// Speed along the line of an updraft, m/s; `strength` in m^3/s, `squared` is the squared distance from the line, `along`
/// the height above its base.
///
/// The updraft is the density of divergence of a point source, 3 e^2 / (4 pi (r^2 + e^2)^(5/2)), spread along its line. It
/// carries what a point sink at its base takes in to a point source at its top; the three have no divergence anywhere.
#[must_use]
pub fn wind_primitive_updraft(strength: f32, squared: f32, along: f32, height: f32, core: f32) -> f32 {
    let core_squared = core * core;
    let regular = squared + core_squared;
    let rise = wind_primitive_rise(regular, along) - wind_primitive_rise(regular, along - height);
    WIND_PRIMITIVE_POINT * strength * core_squared / regular * rise
}

/// The velocity of a primitive at a place, m/s. A type that is none gives 0.
#[must_use]
pub fn wind_primitive_velocity(matrix: &WindMatrix, at: Vec3) -> Vec3 {
    let [[kind, strength, core], centre, up] = matrix.rows;
    let kind = kind as u32;
    let up = Vec3::from(up);
    if kind == WIND_PRIMITIVE_UNIFORM {
        return up * strength;
    }
    let offset = at - Vec3::from(centre);
    if kind == WIND_PRIMITIVE_POINT_SOURCE || kind == WIND_PRIMITIVE_POINT_SINK {
        return offset * wind_primitive_point(strength, offset.dot(offset), core);
    }
    if kind == WIND_PRIMITIVE_POINT_VORTEX {
        return up.cross(offset) * wind_primitive_point(strength, offset.dot(offset), core);
    }
    if kind == WIND_PRIMITIVE_UPDRAFT {
        let height = up.dot(up).sqrt();
        let axis = up / height;
        let across = wind_primitive_across(offset, axis);
        let along = offset.dot(axis);
        return axis * wind_primitive_updraft(strength, across.dot(across), along, height, core);
    }
    let across = wind_primitive_across(offset, up);
    let line = wind_primitive_line(strength, across.dot(across), core);
    if kind == WIND_PRIMITIVE_LINE_VORTEX {
        return up.cross(across) * line;
    }
    if kind == WIND_PRIMITIVE_LINE_SOURCE || kind == WIND_PRIMITIVE_LINE_SINK {
        return across * line;
    }
    Vec3::ZERO
}

/// The velocity of all primitives at a place, m/s: the wind without a grid.
#[must_use]
pub fn velocity(matrices: &[WindMatrix], at: Vec3) -> Vec3 {
    matrices.iter().fold(Vec3::ZERO, |sum, matrix| sum + wind_primitive_velocity(matrix, at))
}
