//! Lamps and the sun: as descriptions, and as the rows that the shaders read.

use std::f32::consts::PI;

use downpour_shaders::render::pane_shadow::PANE_SHADOW_SUN;
use downpour_shaders::render::scene::{
    LIGHT_MAX_SPREAD, SCENE_FAR, SCENE_LIGHT_AREA, SCENE_LIGHT_DIRECTIONAL, SCENE_LIGHT_POINT,
    SCENE_LIGHT_ROWS,
};
use glam::{Vec3, Vec4};

use crate::RenderError;
use crate::plate::Lighting;

/// Rows of a light.
pub const ROWS: usize = SCENE_LIGHT_ROWS as usize;

/// A lamp or the sun. Intensities are radiometric, in the scale of the sky map: a white surface that faces an
/// irradiance of pi shows 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightSource {
    /// Parallel light.
    Directional {
        /// Direction in which the light travels, of length 1.
        direction: Vec3,
        /// Irradiance on a surface that faces it.
        irradiance: Vec3,
    },
    /// Light from a point or a sphere.
    Point {
        /// Center, meters.
        position: Vec3,
        /// Radius of the sphere, meters; 0: a point.
        radius: f32,
        /// Radiant intensity: irradiance at 1 m.
        intensity: Vec3,
        /// Range of the light, meters; 0: unlimited.
        range: f32,
    },
    /// Light from a point or a sphere in a cone.
    Spot {
        /// Center, meters.
        position: Vec3,
        /// Radius of the sphere, meters; 0: a point.
        radius: f32,
        /// Axis of the cone, of length 1.
        direction: Vec3,
        /// Radiant intensity on the axis.
        intensity: Vec3,
        /// Range of the light, meters; 0: unlimited.
        range: f32,
        /// Half angle of the full light, radians.
        inner: f32,
        /// Half angle of the cone, radians.
        outer: f32,
    },
}

/// A lamp or the sun as the shaders read it: four rows of a table. Twin of `RenderLight` in `shaders/wgsl/render/light.wgsl`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Light {
    /// Position, meters; nothing for parallel light.
    pub position: Vec3,
    /// `SCENE_LIGHT_DIRECTIONAL`, `SCENE_LIGHT_POINT`, `SCENE_LIGHT_BODY` or `SCENE_LIGHT_AREA`.
    pub kind: u32,
    /// Direction of the light, axis of the cone, or normal of an area.
    pub axis: Vec3,
    /// Chord from the center to the edge of its disk as seen in a drop; 0: that of the sun.
    pub chord: f32,
    /// Irradiance over pi of a surface that faces it, for a lamp at 1 m.
    pub color: Vec3,
    /// Range of the light, meters; 0: unlimited.
    pub range: f32,
    /// Scale and offset of the cosine at the edge of the cone: `clamp(cosine * scale + offset, 0, 1)` squared.
    pub cone: [f32; 2],
    /// Radius of the lamp, meters; 0: a point. Of a place of an area: distance within which its light does not grow.
    pub radius: f32,
}

/// Light of a lamp at a point.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Unit direction to the lamp.
    pub direction: Vec3,
    /// Distance of the lamp, meters.
    pub distance: f32,
    /// Irradiance over pi of a surface that faces it.
    pub irradiance: Vec3,
    /// Half the angle that the light takes, radians.
    pub spread: f32,
}

impl Light {
    /// Reads a light from its rows.
    #[must_use]
    pub fn light_load(rows: &[[u32; 4]; ROWS]) -> Self {
        let [position, axis, color, cone] = rows.map(|row| Vec4::from(row.map(f32::from_bits)));
        Self {
            position: position.truncate(),
            kind: rows[0][3],
            axis: axis.truncate(),
            chord: axis.w,
            color: color.truncate(),
            range: color.w,
            cone: [cone.x, cone.y],
            radius: cone.z,
        }
    }

    /// True for parallel light.
    #[must_use]
    pub fn is_parallel(&self) -> bool {
        self.kind == SCENE_LIGHT_DIRECTIONAL
    }

    /// Returns the light at a point. A lamp nearer than `least` is as bright as at that distance.
    #[must_use]
    pub fn light_sample(&self, point: Vec3, least: f32) -> LightSample {
        if self.is_parallel() {
            return LightSample {
                direction: -self.axis,
                distance: SCENE_FAR,
                irradiance: self.color,
                // A small chord is as long as its angle.
                spread: if self.chord > 0.0 { self.chord } else { PANE_SHADOW_SUN },
            };
        }
        let offset = self.position - point;
        let inside = least.max(self.radius);
        let square = offset.dot(offset).max((inside * inside).max(1.0e-8));
        let distance = offset.dot(offset).max(1.0e-8).sqrt();
        let direction = offset / distance;
        // glTF's window: no light beyond the range, if there is one.
        let part = distance / self.range.max(1.0e-6);
        let fourth = part * part * part * part;
        let window = if self.range > 0.0 { (1.0 - fourth).clamp(0.0, 1.0) } else { 1.0 };
        let [scale, offset_of_edge] = self.cone;
        let cosine = (-direction).dot(self.axis);
        let edge = (cosine * scale + offset_of_edge).clamp(0.0, 1.0);
        // An area shines to both sides.
        let shape = if self.kind == SCENE_LIGHT_AREA { cosine.abs() } else { edge * edge };
        let irradiance = self.color * (window * shape / square);
        let spread =
            if self.kind == SCENE_LIGHT_AREA { 0.0 } else { (self.radius / distance).min(LIGHT_MAX_SPREAD) };
        LightSample { direction, distance, irradiance, spread }
    }
}

/// Sum of a color's components, by which lights are compared.
#[must_use]
pub fn light_weight(color: Vec3) -> f32 {
    color.x + color.y + color.z
}

impl LightSource {
    /// Returns the rows of the light in a table.
    #[must_use]
    pub fn rows(&self) -> [[u32; 4]; ROWS] {
        let over_pi = |c: Vec3| c / PI;
        let row = |v: Vec3, w: f32| [v.x, v.y, v.z, w].map(f32::to_bits);
        let point = |v: Vec3, kind: u32| [v.x.to_bits(), v.y.to_bits(), v.z.to_bits(), kind];
        // The edge is clamp(cos * scale + offset, 0, 1)^2, as KHR_lights_punctual suggests.
        let everywhere = |radius: f32| [0.0f32, 1.0, radius, 0.0].map(f32::to_bits);
        match *self {
            Self::Directional { direction, irradiance } => [
                point(Vec3::ZERO, SCENE_LIGHT_DIRECTIONAL),
                row(direction, 0.0),
                row(over_pi(irradiance), 0.0),
                everywhere(0.0),
            ],
            Self::Point { position, radius, intensity, range } => [
                point(position, SCENE_LIGHT_POINT),
                row(Vec3::NEG_Y, 0.0),
                row(over_pi(intensity), range),
                everywhere(radius),
            ],
            Self::Spot { position, radius, direction, intensity, range, inner, outer } => {
                let (inner, outer) = (downpour_math::ops::cos(inner), downpour_math::ops::cos(outer));
                let scale = 1.0 / (inner - outer).max(1.0e-3);
                [
                    point(position, SCENE_LIGHT_POINT),
                    row(direction, 0.0),
                    row(over_pi(intensity), range),
                    [scale, -outer * scale, radius, 0.0].map(f32::to_bits),
                ]
            }
        }
    }
}

/// The brightest light: a tenth of a millimeter from the lamp it is still within an `f32`.
const BRIGHTEST: f32 = 1.0e30;

/// Checks that the colors of all lights are finite and not negative.
///
/// # Errors
/// [`RenderError::Light`] if a color is not finite, negative, or above 1e30.
pub fn check_lights(lighting: &dyn Lighting) -> Result<(), RenderError> {
    for index in 0..lighting.light_count() {
        for found in (lighting.light(index).color * PI).to_array() {
            if !(0.0..=BRIGHTEST).contains(&found) {
                return Err(RenderError::Light { index, found });
            }
        }
    }
    Ok(())
}
