//! Velocity of a primitive at a position, m/s. Twin of `shaders/wgsl/wind/primitive.wgsl`.
//!
//! With e the core radius, and r the distance from the axis (line forms) or from the center (point forms):
//!
//! | form | speed of strength 1 | far away | maximum, and its radius | source |
//! |---|---|---|---|---|
//! | line | r / (2 pi (r^2 + e^2)) | 1 / (2 pi r) | 0.5 / (2 pi e) at e | Rousseau 2008, 3.1; core: Rosenhead 1930 |
//! | line, Rankine | r / (2 pi max(r, e)^2) | 1 / (2 pi r) | 1 / (2 pi e) at e | Rankine 1858: solid rotation inside |
//! | line, Lamb-Oseen | (1 - exp(-r^2 / e^2)) / (2 pi r) | 1 / (2 pi r) | 0.63817 / (2 pi e) at 1.12091 e | Lamb 1932, Oseen 1911: a vortex spread by viscosity |
//! | point | r / (4 pi (r^2 + e^2)^(3/2)) | 1 / (4 pi r^2) | 0.0306 / e^2 at e / sqrt 2 | Rosenhead's core in three dimensions |
//!
//! The speed is outward for a source, inward for a sink, and across the axis for a vortex. It is finite everywhere.
//! Outside Rosenhead's core the speed is below that without a core by at most the fraction e^2 / r^2 (line) or 1.5 e^2
//! / r^2 (point); with Rankine's it is equal, with Lamb and Oseen's it is below by exp(-r^2 / e^2). A point vortex is
//! the field of Biot and Savart about a short piece of a vortex: its strength is circulation times length.

use downpour_math::ops;
use downpour_shaders::wind::{
    WIND_PRIMITIVE_LAMB_OSEEN, WIND_PRIMITIVE_LINE, WIND_PRIMITIVE_LINE_SINK, WIND_PRIMITIVE_LINE_SOURCE,
    WIND_PRIMITIVE_LINE_VORTEX, WIND_PRIMITIVE_POINT, WIND_PRIMITIVE_POINT_SINK, WIND_PRIMITIVE_POINT_SOURCE,
    WIND_PRIMITIVE_POINT_VORTEX, WIND_PRIMITIVE_RANKINE, WIND_PRIMITIVE_SERIES, WIND_PRIMITIVE_UNIFORM,
    WIND_PRIMITIVE_UPDRAFT,
};
use glam::Vec3;

use crate::matrix::WindMatrix;

/// Component of an offset perpendicular to the axis, a unit vector.
#[must_use]
pub fn wind_primitive_across(offset: Vec3, axis: Vec3) -> Vec3 {
    offset - axis * offset.dot(axis)
}

/// Speed per distance of a line form, 1/s; `strength` in m^2/s, `squared` is the squared distance from the axis.
#[must_use]
pub fn wind_primitive_line(strength: f32, squared: f32, core: f32) -> f32 {
    WIND_PRIMITIVE_LINE * strength / (squared + core * core)
}

/// Speed per distance of a line form with Rankine's core, 1/s; arguments as for [`wind_primitive_line`].
#[must_use]
pub fn wind_primitive_rankine(strength: f32, squared: f32, core: f32) -> f32 {
    WIND_PRIMITIVE_LINE * strength / squared.max(core * core)
}

/// Speed per distance of a line form with the core of Lamb and Oseen, 1/s; arguments as for [`wind_primitive_line`].
#[must_use]
pub fn wind_primitive_lamb_oseen(strength: f32, squared: f32, core: f32) -> f32 {
    let core_squared = core * core;
    let x = squared / core_squared;
    // (1 - exp(-x)) / x; near 0 the difference has no digits.
    let mut fraction =
        1.0 - x * (0.5 - x * (0.16666667 - x * (0.041666668 - x * (0.008333334 - x * 0.0013888889))));
    if x > WIND_PRIMITIVE_SERIES {
        fraction = (1.0 - ops::exp(-x)) / x;
    }
    WIND_PRIMITIVE_LINE * strength / core_squared * fraction
}

/// Speed per distance of a line form with the core of its type, 1/s; arguments as for [`wind_primitive_line`].
#[must_use]
pub fn wind_primitive_core(kind: u32, strength: f32, squared: f32, core: f32) -> f32 {
    if kind >= WIND_PRIMITIVE_LAMB_OSEEN {
        return wind_primitive_lamb_oseen(strength, squared, core);
    }
    if kind >= WIND_PRIMITIVE_RANKINE {
        return wind_primitive_rankine(strength, squared, core);
    }
    wind_primitive_line(strength, squared, core)
}

/// Speed per distance of a point form, 1/s; `strength` in m^3/s, `squared` is the squared distance from the center.
#[must_use]
pub fn wind_primitive_point(strength: f32, squared: f32, core: f32) -> f32 {
    let regular = squared + core * core;
    WIND_PRIMITIVE_POINT * strength / (regular * regular.sqrt())
}

/// Integral of 3 / (regular + u^2)^(5/2) for u from 0 to `along`, times `regular`.
#[must_use]
pub fn wind_primitive_rise(regular: f32, along: f32) -> f32 {
    let whole = regular + along * along;
    along / whole.sqrt() * (1.0 / whole + 2.0 / regular)
}

/// Speed along the line of an updraft, m/s; `strength` in m^3/s, `squared` is the squared distance from the line,
/// `along` the height above its base.
///
/// The updraft is the density of divergence of a point source, 3 e^2 / (4 pi (r^2 + e^2)^(5/2)), spread along its
/// line. It carries the air from a point sink at its base to a point source at its top; the three together have no
/// divergence.
#[must_use]
pub fn wind_primitive_updraft(strength: f32, squared: f32, along: f32, height: f32, core: f32) -> f32 {
    let core_squared = core * core;
    let regular = squared + core_squared;
    let rise = wind_primitive_rise(regular, along) - wind_primitive_rise(regular, along - height);
    WIND_PRIMITIVE_POINT * strength * core_squared / regular * rise
}

/// Velocity of a primitive at a position, m/s; 0 for an unknown type.
#[must_use]
pub fn wind_primitive_velocity(matrix: &WindMatrix, at: Vec3) -> Vec3 {
    let [[kind, strength, core], center, up] = matrix.rows;
    let kind = kind as u32;
    let up = Vec3::from(up);
    if kind == WIND_PRIMITIVE_UNIFORM {
        return up * strength;
    }
    let offset = at - Vec3::from(center);
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
    let line = wind_primitive_core(kind, strength, across.dot(across), core);
    let form = kind % WIND_PRIMITIVE_RANKINE;
    if form == WIND_PRIMITIVE_LINE_VORTEX {
        return up.cross(across) * line;
    }
    if form == WIND_PRIMITIVE_LINE_SOURCE || form == WIND_PRIMITIVE_LINE_SINK {
        return across * line;
    }
    Vec3::ZERO
}

/// Velocity of all primitives at a position, m/s: the wind without a grid.
#[must_use]
pub fn velocity(matrices: &[WindMatrix], at: Vec3) -> Vec3 {
    matrices.iter().fold(Vec3::ZERO, |sum, matrix| sum + wind_primitive_velocity(matrix, at))
}
