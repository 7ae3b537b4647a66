//! Lights as rows of the scene's table.

use std::f32::consts::PI;

use downpour_shaders::render::scene::{SCENE_LIGHT_DIRECTIONAL, SCENE_LIGHT_POINT, SCENE_LIGHT_ROWS};
use glam::Vec3;

use crate::RenderError;
use crate::data::SceneData;

const ROWS: usize = SCENE_LIGHT_ROWS as usize;

/// A lamp or the sun. Intensities are radiometric, in the scale of the sky map: a white surface that faces an
/// irradiance of pi shows 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightSource {
    /// Parallel light.
    Directional {
        /// Where the light goes, of length 1.
        direction: Vec3,
        /// Irradiance on a surface that faces it.
        irradiance: Vec3,
    },
    /// Light from a point.
    Point {
        /// Place, metres.
        position: Vec3,
        /// Radiant intensity: irradiance at 1 m.
        intensity: Vec3,
        /// No light beyond this, metres; 0 for no end.
        range: f32,
    },
    /// Light from a point in a cone.
    Spot {
        /// Place, metres.
        position: Vec3,
        /// Axis of the cone, of length 1.
        direction: Vec3,
        /// Radiant intensity on the axis.
        intensity: Vec3,
        /// No light beyond this, metres; 0 for no end.
        range: f32,
        /// Half angle of the full light, radians.
        inner: f32,
        /// Half angle of the cone, radians.
        outer: f32,
    },
}

impl SceneData {
    /// Gives light `index` an angular radius, in radians: that of the disc that drops show of it. Without one it is the sun's.
    pub(crate) fn set_light_radius(&mut self, index: u32, radius: f32) {
        let row = (self.lights + index * SCENE_LIGHT_ROWS + 1) as usize;
        // The chord from the middle to the edge.
        self.table[row][3] = (2.0 * downpour_math::ops::sin(0.5 * radius)).to_bits();
    }
}

impl LightSource {
    pub(crate) fn rows(&self) -> [[u32; 4]; ROWS] {
        let over_pi = |c: Vec3| c / PI;
        let row = |v: Vec3, w: f32| [v.x, v.y, v.z, w].map(f32::to_bits);
        let point = |v: Vec3, kind: u32| [v.x.to_bits(), v.y.to_bits(), v.z.to_bits(), kind];
        // The edge is clamp(cos * scale + offset, 0, 1)^2, as KHR_lights_punctual suggests.
        let everywhere = [0.0f32, 1.0, 0.0, 0.0].map(f32::to_bits);
        match *self {
            Self::Directional { direction, irradiance } => [
                point(Vec3::ZERO, SCENE_LIGHT_DIRECTIONAL),
                row(direction, 0.0),
                row(over_pi(irradiance), 0.0),
                everywhere,
            ],
            Self::Point { position, intensity, range } => [
                point(position, SCENE_LIGHT_POINT),
                row(Vec3::NEG_Y, 0.0),
                row(over_pi(intensity), range),
                everywhere,
            ],
            Self::Spot { position, direction, intensity, range, inner, outer } => {
                let (inner, outer) = (downpour_math::ops::cos(inner), downpour_math::ops::cos(outer));
                let scale = 1.0 / (inner - outer).max(1.0e-3);
                [
                    point(position, SCENE_LIGHT_POINT),
                    row(direction, 0.0),
                    row(over_pi(intensity), range),
                    [scale, -outer * scale, 0.0, 0.0].map(f32::to_bits),
                ]
            }
        }
    }
}

/// The brightest light: a tenth of a millimetre from the lamp it is still within an `f32`.
const BRIGHTEST: f32 = 1.0e30;

/// Whether all lights of a scene are light.
///
/// # Errors
/// [`RenderError::Light`] if a colour is not finite, negative, or above 1e30.
pub fn check_lights(scene: &SceneData) -> Result<(), RenderError> {
    for index in 0..scene.light_count {
        let row = (scene.lights + index * SCENE_LIGHT_ROWS) as usize + 2;
        let colour = scene.table.get(row).map_or([0; 4], |&row| row);
        for found in colour.into_iter().take(3).map(|word| f32::from_bits(word) * PI) {
            if !(0.0..=BRIGHTEST).contains(&found) {
                return Err(RenderError::Light { index, found });
            }
        }
    }
    Ok(())
}
