//! Plates of host applications: color and depth textures as radiance and distance, and an environment map made of them.
//! Twin of `shaders/wgsl/render/host_*.wgsl`.

use downpour_math::equirect::equirect_coordinates;
use downpour_math::ops;
use downpour_math::packing::packing_octahedral_decode;
use downpour_math::pyramid::{PyramidRounding, pyramid, pyramid_levels};
use downpour_shaders::render::host::{
    HOST_BLUR, HOST_BORDER, HOST_BRIGHTEST, HOST_FARTHEST, HOST_LEVELS, HOST_MIN_DEPTH, HOST_SKY_TAPS,
    HOST_SPHERE,
};
use downpour_shaders::render::scene::SCENE_FAR;
use glam::{Vec2, Vec3};

use crate::camera::Camera;

/// Meaning of the values of a depth texture: those of a perspective projection of wgpu, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthRange {
    /// Distance of the near plane along the view direction, m.
    pub near_m: f32,
    /// Distance of the far plane, m; infinite for a projection without one.
    pub far_m: f32,
    /// True if the near plane is at 1 and the far plane at 0.
    pub is_reversed: bool,
}

impl DepthRange {
    /// Infinite reversed depth, as most engines use it.
    #[must_use]
    pub const fn reversed(near_m: f32) -> Self {
        Self { near_m, far_m: f32::INFINITY, is_reversed: true }
    }

    /// Depth from 0 at the near plane to 1 at the far plane.
    #[must_use]
    pub const fn standard(near_m: f32, far_m: f32) -> Self {
        Self { near_m, far_m, is_reversed: false }
    }

    /// Inverse depth, 1/m, at the value 0, and how much more it is at 1.
    #[must_use]
    pub fn inverse(&self) -> [f32; 2] {
        let (near, far) = (1.0 / self.near_m, 1.0 / self.far_m);
        if self.is_reversed { [far, near - far] } else { [near, far - near] }
    }

    /// Value where nothing was drawn.
    #[must_use]
    pub const fn clear(&self) -> f32 {
        if self.is_reversed { 0.0 } else { 1.0 }
    }
}

/// Frame of the plate of a host application. The same layout as `HostPlateFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct HostPlateFrame {
    /// [`DepthRange::inverse`].
    pub inverse: [f32; 2],
    /// [`DepthRange::clear`].
    pub clear: f32,
    /// Radiance of the color 1.
    pub scale: f32,
    /// The camera.
    pub camera: Camera,
}

/// Frame of the environment map of a host application. The same layout as `HostEnvironmentFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct HostEnvironmentFrame {
    /// Width, height and first texel of each level of the picture.
    pub levels: [[u32; 4]; HOST_LEVELS as usize],
    /// The camera.
    pub camera: Camera,
    /// Texels along an edge of the map that is made.
    pub size: u32,
    /// The coarsest level of the picture.
    pub last: u32,
    /// 1: directions beyond the picture's borders show the host's sky map.
    pub has_sky: u32,
    /// Radiance of the color 1 of the sky map.
    pub sky_scale: f32,
}

/// Frame of the rain over a color texture. The same layout as `HostBlendFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct HostBlendFrame {
    /// Columns of the picture.
    pub width: u32,
    /// Color of the radiance 1.
    pub scale: f32,
    /// 0.
    pub unused: [u32; 2],
}

/// Radiance of a color times that of 1: none where it is below 0 or no number, and no more than half precision holds.
#[must_use]
pub fn host_radiance_checked(color: Vec3, scale: f32) -> Vec3 {
    let checked = |light: f32| if light >= 0.0 { light.min(HOST_BRIGHTEST) } else { 0.0 };
    Vec3::from((color * scale).to_array().map(checked))
}

/// Distance along a ray, m, of a value of the depth texture; `slant` is the length of the ray at depth 1.
#[must_use]
pub fn host_plate_distance(value: f32, inverse: [f32; 2], clear: f32, slant: f32) -> f32 {
    let inverse_depth = inverse[0] + value * inverse[1];
    if value == clear || inverse_depth < HOST_FARTHEST { SCENE_FAR } else { slant / inverse_depth }
}

/// Plate of a color and a depth picture, rows from the top: radiance and distance of each pixel, all levels.
#[must_use]
pub fn host_plate(frame: &HostPlateFrame, color: &[[f32; 4]], depth: &[f32]) -> Vec<[f32; 4]> {
    let camera = &frame.camera;
    let mut pixels: Vec<[f32; 4]> = (0u32..)
        .zip(color.iter().zip(depth))
        .map(|(i, (&[r, g, b, _], &value))| {
            let (x, y) = (i % camera.width, i / camera.width);
            let ray = camera.camera_ray(x as f32 + 0.5, y as f32 + 0.5);
            let distance = host_plate_distance(value, frame.inverse, frame.clear, ray.dot(ray).sqrt());
            let [r, g, b] = host_radiance_checked(Vec3::new(r, g, b), frame.scale).to_array();
            [r, g, b, distance]
        })
        .collect();
    pyramid(&mut pixels, camera.size(), PyramidRounding::Up);
    pixels
}

/// Position on the picture of a direction, pixels, clamped to its borders, and how far outside it is, in halves of the picture.
#[must_use]
pub fn host_environment_position(camera: &Camera, direction: Vec3) -> Vec3 {
    let along = direction.dot(camera.forward);
    let place = camera.camera_place(direction, along.abs().max(HOST_MIN_DEPTH));
    let at = |v: f32, size: u32| (0.5 + 0.5 * v.clamp(-1.0, 1.0)) * size as f32;
    let outside = (place.x.abs().max(place.y.abs()) - 1.0).clamp(0.0, 1.0);
    let outside = if along <= 0.0 { 1.0 } else { outside };
    Vec3::new(at(place.x, camera.width), at(-place.y, camera.height), outside)
}

impl HostEnvironmentFrame {
    /// The frame of a map of `size` texels along an edge, of a picture; `sky_scale` is the radiance of the color 1 of a sky map,
    /// if there is one.
    #[must_use]
    pub fn new(camera: &Camera, size: u32, sky_scale: Option<f32>) -> Self {
        let mut levels = [[0; 4]; HOST_LEVELS as usize];
        levels[0] = [camera.width, camera.height, 0, 0];
        let mut last = 0;
        for (row, level) in levels[1..].iter_mut().zip(pyramid_levels(camera.size(), PyramidRounding::Up)) {
            *row = [level.size[0], level.size[1], level.target_texel, 0];
            last += 1;
        }
        Self {
            camera: *camera,
            size,
            last,
            has_sky: u32::from(sky_scale.is_some()),
            sky_scale: sky_scale.unwrap_or_default(),
            levels,
        }
    }
}

/// Inputs of an environment map: twin of the bindings of `host_environment.wgsl`.
#[derive(Clone, Copy, Debug)]
pub struct HostEnvironment<'a> {
    /// The frame.
    pub frame: &'a HostEnvironmentFrame,
    /// The plate, all levels.
    pub plate: &'a [[f32; 4]],
    /// Columns and rows of the sky map, and its texels; not read without one.
    pub sky: ([u32; 2], &'a [[f32; 4]]),
}

impl HostEnvironment<'_> {
    /// The finest level of the map, rows from the top.
    #[must_use]
    pub fn map(&self) -> Vec<[f32; 4]> {
        let size = self.frame.size;
        let texel = |i: u32| self.host_environment_radiance(i % size, i / size).extend(0.0).to_array();
        (0..size * size).map(texel).collect()
    }

    fn host_environment_texel(&self, level: u32, column: i32, row: i32) -> Vec3 {
        let [width, height, first, _] = self.frame.levels[level as usize];
        let x = column.clamp(0, width as i32 - 1) as u32;
        let y = row.clamp(0, height as i32 - 1) as u32;
        let [r, g, b, _] = self.plate[(first + y * width + x) as usize];
        Vec3::new(r, g, b)
    }

    fn host_environment_level(&self, level: u32, place: Vec2) -> Vec3 {
        let [width, height, ..] = self.frame.levels[level as usize];
        let finest = self.frame.levels[0];
        let scale = Vec2::new(width as f32 / finest[0] as f32, height as f32 / finest[1] as f32);
        let at = place * scale - 0.5;
        let low = at.floor();
        let part = at - low;
        let (column, row) = (low.x as i32, low.y as i32);
        let texel = |x, y| self.host_environment_texel(level, column + x, row + y);
        let upper = mix(texel(0, 0), texel(1, 0), part.x);
        let lower = mix(texel(0, 1), texel(1, 1), part.x);
        mix(upper, lower, part.y)
    }

    fn host_environment_picture(&self, place: Vec2, width: f32) -> Vec3 {
        let level = ops::log2(width.max(1.0)).min(self.frame.last as f32);
        let finer = level as u32;
        let coarser = (finer + 1).min(self.frame.last);
        let [near, far] = [finer, coarser].map(|level| self.host_environment_level(level, place));
        mix(near, far, level - finer as f32)
    }

    fn host_environment_direction(&self, x: u32, y: u32, dx: f32, dy: f32) -> Vec3 {
        let scale = 2.0 / self.frame.size as f32;
        packing_octahedral_decode([(x as f32 + dx) * scale - 1.0, (y as f32 + dy) * scale - 1.0]).into()
    }

    fn host_environment_seen(&self, x: u32, y: u32) -> Vec3 {
        let ([width, height], texels) = self.sky;
        let size = Vec2::new(width as f32, height as f32);
        let mut sum = Vec3::ZERO;
        for k in 0..HOST_SKY_TAPS * HOST_SKY_TAPS {
            let dx = ((k % HOST_SKY_TAPS) as f32 + 0.5) / HOST_SKY_TAPS as f32;
            let dy = ((k / HOST_SKY_TAPS) as f32 + 0.5) / HOST_SKY_TAPS as f32;
            let direction = self.host_environment_direction(x, y, dx, dy);
            let uv = Vec2::from(equirect_coordinates(direction.to_array()));
            let at = (uv * size).clamp(Vec2::ZERO, size - 1.0);
            let [r, g, b, _] = texels[(at.y as u32 * width + at.x as u32) as usize];
            sum += host_radiance_checked(Vec3::new(r, g, b), self.frame.sky_scale);
        }
        sum / (HOST_SKY_TAPS * HOST_SKY_TAPS) as f32
    }

    fn host_environment_radiance(&self, x: u32, y: u32) -> Vec3 {
        let frame = self.frame;
        let direction = self.host_environment_direction(x, y, 0.5, 0.5);
        let at = host_environment_position(&frame.camera, direction);
        let place = Vec2::new(at.x, at.y);
        let texel = HOST_SPHERE / frame.size as f32 / frame.camera.pixel_angle;
        let blurred = texel + at.z * HOST_BLUR * frame.camera.height as f32;
        if frame.has_sky == 0 {
            return self.host_environment_picture(place, blurred);
        }
        let border = (at.z * HOST_BORDER).clamp(0.0, 1.0);
        if border >= 1.0 {
            return self.host_environment_seen(x, y);
        }
        let picture = self.host_environment_picture(place, texel);
        if border <= 0.0 {
            return picture;
        }
        mix(picture, self.host_environment_seen(x, y), border)
    }
}

/// Corner 0 to 2 of what covers the picture.
#[must_use]
pub fn host_blend_corner(index: u32) -> [f32; 4] {
    let x = ((index & 1) << 2) as f32 - 1.0;
    let y = 1.0 - ((index & 2) << 1) as f32;
    [x, y, 0.0, 1.0]
}

/// Color to add and factor of what is there, of the rain before a pixel.
#[must_use]
pub fn host_blend_color(rain: [f32; 4], scale: f32) -> [f32; 4] {
    let [r, g, b, transmittance] = rain;
    [r * scale, g * scale, b * scale, transmittance]
}

/// WGSL's `mix`.
fn mix(a: Vec3, b: Vec3, part: f32) -> Vec3 {
    a * (1.0 - part) + b * part
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Viewpoint;
    use approx::assert_relative_eq;

    /// Values of the projection matrices of glam, which are those of wgpu.
    #[test]
    fn distances_are_those_of_projection_matrices() {
        use glam::camera::rh::proj::directx as proj;
        let cases = [
            (DepthRange::standard(0.1, 200.0), proj::perspective(1.0, 1.5, 0.1, 200.0)),
            (DepthRange::standard(0.1, f32::INFINITY), proj::perspective_infinite(1.0, 1.5, 0.1)),
            (DepthRange::reversed(0.1), proj::perspective_infinite_reverse(1.0, 1.5, 0.1)),
            (
                DepthRange { near_m: 0.1, far_m: 200.0, is_reversed: true },
                proj::perspective(1.0, 1.5, 200.0, 0.1),
            ),
        ];
        for (range, projection) in cases {
            for depth in [0.1f32, 0.5, 3.0, 40.0, 150.0] {
                let clip = projection * Vec3::new(0.2, 0.1, -depth).extend(1.0);
                let found = host_plate_distance(clip.z / clip.w, range.inverse(), range.clear(), 1.0);
                assert_relative_eq!(found, depth, max_relative = 2.0e-3);
            }
            assert_eq!(host_plate_distance(range.clear(), range.inverse(), range.clear(), 1.0), SCENE_FAR);
        }
    }

    #[test]
    fn a_direction_finds_the_pixel_of_its_ray() {
        let viewpoint = Viewpoint {
            eye: Vec3::new(1.0, 2.0, 3.0),
            forward: Vec3::new(0.3, -0.2, -1.0),
            up: Vec3::Y,
            fov_y: 0.9,
        };
        let camera = viewpoint.camera([640, 360], 0).unwrap();
        for [x, y] in [[0.5, 0.5], [320.0, 180.0], [600.0, 20.0]] {
            let at = host_environment_position(&camera, camera.camera_direction(x, y));
            assert_relative_eq!(at.x, x, epsilon = 0.01);
            assert_relative_eq!(at.y, y, epsilon = 0.01);
            assert_relative_eq!(at.z, 0.0, epsilon = 1.0e-5);
        }
        let above = host_environment_position(&camera, Vec3::Y);
        assert_eq!([above.y, above.z], [0.0, 1.0]);
    }

    #[test]
    fn the_corners_cover_the_picture() {
        let corners = [0, 1, 2].map(host_blend_corner);
        assert_eq!(corners.map(|c| [c[0], c[1]]), [[-1.0, 1.0], [3.0, 1.0], [-1.0, -3.0]]);
    }
}
