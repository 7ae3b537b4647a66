//! Lamps and suns: `KHR_lights_punctual`.
//!
//! Units are those of the extension: a point or spot light has its luminous intensity in candela, a directional
//! light its illuminance in lux, `E = I / r^2` for a surface at distance `r` that faces the lamp. Lights shine along -Z of their node;
//! scale has no effect on them.

use glam::Vec3;

/// A light without a transform.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Name in the file; may be empty.
    pub name: String,
    /// Linear color, in [0, 1].
    pub color: Vec3,
    /// Candela of a point or spot light, lux of a directional one; 0 or more.
    pub intensity: f32,
    /// Distance at which the light has faded to zero, in meters; `None` for an unlimited range.
    pub range: Option<f32>,
    /// Radius of the lamp's sphere, in meters: `radius_m` of the light's `extras`. `None`: that of its glass in the model, or a
    /// point.
    pub radius: Option<f32>,
    /// Kind of the light.
    pub kind: LightKind,
}

/// Kind of a [`Light`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Parallel light from infinitely far away.
    Directional,
    /// A lamp that shines in all directions.
    Point,
    /// A lamp with a cone.
    Spot {
        /// Half the angle of the cone of full intensity, in radians; from 0 on, below `outer`.
        inner: f32,
        /// Half the angle of the cone outside of which there is no light, in radians; up to pi/2.
        outer: f32,
    },
}

/// A light in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedLight {
    /// Node of the light.
    pub node: usize,
    /// Index of the light.
    pub light: usize,
    /// Position, in meters; without meaning for a directional light.
    pub position: Vec3,
    /// The unit direction in which it shines; without meaning for a point light.
    pub direction: Vec3,
}

impl Light {
    /// The part of the intensity that remains at a distance in meters because the range ends.
    ///
    /// `clamp(1 - (d / range)^4, 0, 1)` as the extension recommends; the fall with the square of the distance is
    /// not in it. 1 without a range.
    ///
    /// ```
    /// use downpour_scene::scene::{Light, LightKind};
    /// let range = Some(10.0);
    /// let lamp = Light { name: String::new(), color: [1.0; 3].into(), intensity: 100.0, range, radius: None, kind: LightKind::Point };
    /// assert_eq!((lamp.window(0.0), lamp.window(10.0), lamp.window(99.0)), (1.0, 0.0, 0.0));
    /// ```
    #[must_use]
    pub fn window(&self, distance: f32) -> f32 {
        self.range.map_or(1.0, |range| {
            let square = (distance / range) * (distance / range);
            (1.0 - square * square).clamp(0.0, 1.0)
        })
    }
}
