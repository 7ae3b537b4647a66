//! Surface that the camera's ray through the middle of each pixel meets, for those who need to know it: how wet it is, the depth of the water
//! on it, and how it moves on the picture.

use downpour_render::camera::EyeMotion;
use downpour_shaders::bvh::BVH_FAR;
use glam::{Vec2, Vec3};
use rayon::prelude::*;

use crate::scene::SceneView;

/// Truth about the surface behind a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceTruth {
    /// Wetness, 0 to 1: fraction of the water that it can store. 0 for the sky and under roofs.
    pub wetness: f32,
    /// Depth of the puddle that covers it, m.
    pub water_depth: f32,
    /// Motion on the picture, pixels per second, to the right and down: that of the camera. Models that move add their own, which is not
    /// told.
    pub motion: Vec2,
}

impl SceneView<'_> {
    /// Truth about each pixel of the frame, before an eye that moves.
    #[must_use]
    pub fn truth(&self, motion: &EyeMotion) -> Vec<SurfaceTruth> {
        let camera = &self.frame.camera;
        let load = self.data.wet_load();
        let pixel = |(y, x): (u32, u32)| {
            let direction = camera.camera_direction(x as f32 + 0.5, y as f32 + 0.5);
            let hit = self.data.surface_hit(camera.eye, direction, self.frame.nearest, BVH_FAR);
            let Some(hit) = hit else {
                // What is infinitely far moves as the camera turns.
                let turned = -motion.turning.cross(direction);
                return SurfaceTruth { wetness: 0.0, water_depth: 0.0, motion: self.pace(direction, turned) };
            };
            let found = self.data.surface_at(&hit, camera.eye, direction, camera.pixel_angle, 1.0);
            let wetness = if self.frame.wetness > 0 { self.wet_exposure(&found, &load) } else { 0.0 };
            let water_depth =
                self.puddle_water_find(found.position, found.facet.y).map_or(0.0, |water| water.depth);
            let offset = direction * hit.distance;
            let velocity = -motion.velocity - motion.turning.cross(offset);
            SurfaceTruth { wetness, water_depth, motion: self.pace(offset, velocity) }
        };
        let rows = (0..camera.height).into_par_iter();
        rows.flat_map_iter(|y| (0..camera.width).map(move |x| (y, x))).map(pixel).collect()
    }

    /// Pace on the picture, pixels per second, of what is at an offset from the eye and has a velocity relative to it.
    fn pace(&self, offset: Vec3, velocity: Vec3) -> Vec2 {
        let camera = &self.frame.camera;
        let depth = offset.dot(camera.forward).max(1.0e-6);
        let receding = velocity.dot(camera.forward);
        let along = |axis: Vec3, pixels: u32| {
            // A position of 1 is at the picture's edge.
            let axis = axis / axis.length_squared();
            let rate = (velocity.dot(axis) - offset.dot(axis) * receding / depth) / depth;
            rate * 0.5 * pixels as f32
        };
        Vec2::new(along(camera.right, camera.width), -along(camera.up, camera.height))
    }
}

#[cfg(test)]
mod tests {
    use downpour_render::camera::Viewpoint;
    use glam::Affine3A;

    use super::*;
    use crate::builder::{MeshPart, SceneBuilder};
    use crate::data::RenderFrame;
    use crate::material::MaterialLook;
    use crate::sky_light::SkyLight;

    /// A wall 10 m ahead that fills the lower half of a picture of 90 degrees.
    #[test]
    fn what_the_camera_passes_moves() {
        let mut builder = SceneBuilder::new();
        let material = builder.add_material(MaterialLook::default());
        let positions =
            [[-50.0, -50.0, -10.0], [50.0, -50.0, -10.0], [50.0, 0.0, -10.0], [-50.0, 0.0, -10.0]];
        let part = MeshPart::plain(&positions, &[0, 1, 2, 0, 2, 3], material);
        builder.add_mesh(&part, &Affine3A::IDENTITY);
        let scene = builder.build(&SkyLight::uniform([1.0; 3]));
        let view = Viewpoint {
            eye: Vec3::ZERO,
            forward: Vec3::NEG_Z,
            up: Vec3::Y,
            fov_y: std::f32::consts::FRAC_PI_2,
        };
        let frame = RenderFrame::new(&scene, &view, [40, 40], 1, 0, 1).expect("a frame");
        let view = SceneView { data: &scene, frame: &frame };
        let at = |truth: &[SurfaceTruth], x: usize, y: usize| truth[y * 40 + x].motion;
        // 2 m/s to the right at 10 m: 0.2 of half the picture per second to the left; the sky stays.
        let truth = view.truth(&EyeMotion { velocity: Vec3::X * 2.0, turning: Vec3::ZERO });
        assert!((at(&truth, 7, 30) - Vec2::new(-4.0, 0.0)).length() < 1.0e-4);
        assert_eq!(at(&truth, 7, 5), Vec2::ZERO);
        // 2 m/s ahead: away from the middle, by a fifth of the distance from it per second.
        let truth = view.truth(&EyeMotion { velocity: Vec3::NEG_Z * 2.0, turning: Vec3::ZERO });
        assert!((at(&truth, 34, 29) - Vec2::new(14.5, 9.5) * 0.2).length() < 1.0e-4);
        // A turn to the left by 0.1 rad/s: the middle goes to the right by 0.1 of half the picture.
        let truth = view.truth(&EyeMotion { velocity: Vec3::ZERO, turning: Vec3::Y * 0.1 });
        assert!((at(&truth, 20, 20).x - 2.0).abs() < 0.01 && (at(&truth, 20, 19).x - 2.0).abs() < 0.01);
    }
}
