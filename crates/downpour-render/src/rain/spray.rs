//! Spray before a picture: the layer of droplets over what rain hits. Twin of `shaders/wgsl/render/spray.wgsl`, where the method is
//! described, and of `spray_frame.wgsl`.
//!
//! What it is: a medium over the first surfaces that the mean fall meets (`map`), lit by lamps at their places (`light`), which shows what
//! unresolved drops show and stands behind all drops of the picture (`blend`): it is within some centimeters of a surface. Its law is
//! [`downpour_drop::spray`]. In the form of Tatarchuk & Isidoro 2006, section 3.4, this is the misty halo along the edges of objects: fins
//! stand on silhouettes of a picture, spray on what is there.

mod blend;
mod light;
mod map;

use bytemuck::{Pod, Zeroable};
use downpour_drop::spray::Spray;
use downpour_math::ops;
use downpour_math::packing::packing_pack_half;
use downpour_shaders::render::spray::{
    SPRAY_AHEAD, SPRAY_CELL, SPRAY_CELLS, SPRAY_EDGE, SPRAY_FAR, SPRAY_LEVELS, SPRAY_REACH, SPRAY_SIZE,
    SPRAY_TOP, SPRAY_TURNS, SPRAY_WIDER,
};
use glam::{Vec2, Vec3, Vec3Swizzles as _, Vec4};
use rayon::prelude::*;

use super::medium::fog::medium_decay_mean;
use super::medium::{MediumFrame, RainMedium};
use crate::camera::Camera;
use crate::spacing::RaySpacing;
pub(super) use blend::SprayBlend;
pub use map::SprayMap;

/// Least upward part of the direction against the mean fall: rain that is more level than this has no spray.
const MIN_RISE: f32 = 0.05;

/// Uniforms of the spray of a picture. The same layout as `SprayFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct SprayFrame {
    /// Squares of the map of heights: x and z of the lowest corner, edge of a texel, m, and its inverse.
    pub levels: [[f32; 4]; SPRAY_LEVELS as usize],
    /// Meters aside, along x and z, per meter upward on a line against the mean fall.
    pub lean: [f32; 2],
    /// Extinction at a surface, 1/m.
    pub extinction: f32,
    /// Height over which it decreases by a factor of e, m.
    pub height: f32,
    /// The eye, relative to the scene's origin, m.
    pub eye: [f32; 3],
    /// Height from which the map looks down, m.
    pub top: f32,
    /// Unit direction against the mean fall.
    pub rise: [f32; 3],
    /// Distance in pixels between those whose rays look for what hides lamps.
    pub ray_spacing: u32,
    /// Column of the one in each cell.
    pub ray_column: u32,
    /// Its row.
    pub ray_row: u32,
    /// Unused.
    pub unused_a: u32,
    /// Unused.
    pub unused_b: u32,
}

impl SprayFrame {
    /// The spray about an eye, relative to the scene's origin, under the rain of a medium; `None` if there is none.
    pub(super) fn new(spray: &Spray, medium: &RainMedium, eye: Vec3) -> Option<Self> {
        let rise = medium.rise();
        if spray.extinction <= 0.0 || rise.y < MIN_RISE {
            return None;
        }
        let lean = rise.xz() / rise.y;
        let foot = eye.xz() - lean * eye.y;
        let mut edge = SPRAY_EDGE;
        let levels = std::array::from_fn(|_| {
            // Texels stay where they are while the eye moves: the square moves by whole cells.
            let cell = edge * SPRAY_CELL as f32;
            let low = ((foot / cell).floor() - (SPRAY_CELLS / 2) as f32) * cell;
            let level = [low.x, low.y, edge, 1.0 / edge];
            edge *= SPRAY_WIDER;
            level
        });
        Some(Self {
            levels,
            lean: lean.into(),
            extinction: spray.extinction as f32,
            height: spray.height_m as f32,
            eye: eye.into(),
            top: eye.y + SPRAY_TOP,
            rise: rise.into(),
            ray_spacing: 1,
            ray_column: 0,
            ray_row: 0,
            unused_a: 0,
            unused_b: 0,
        })
    }

    /// The same with the pixels whose rays look for what hides lamps.
    #[must_use]
    pub fn with_rays(self, rays: RaySpacing) -> Self {
        let [ray_column, ray_row] = rays.place();
        Self { ray_spacing: rays.spacing(), ray_column, ray_row, ..self }
    }
}

/// Spray over a map of heights.
#[derive(Clone, Copy, Debug)]
pub struct SprayView<'a> {
    /// The frame.
    pub frame: &'a SprayFrame,
    /// Heights of what rain hits.
    pub map: &'a SprayMap,
}

impl SprayView<'_> {
    /// Position in texels of a square of a point `way` from another of the plane: the difference from the square's corner first, which has
    /// more digits.
    fn spray_texel(&self, level: u32, foot: Vec2, way: Vec2) -> Vec2 {
        let [x, z, _, inverse] = self.frame.levels[level as usize];
        ((foot - Vec2::new(x, z)) + way) * inverse
    }

    /// The first square from `level` on in which a point `way` from another of the plane is; `SPRAY_LEVELS`: none.
    fn spray_level(&self, level: u32, foot: Vec2, way: Vec2) -> u32 {
        let is_within = |level: &u32| {
            let texel = self.spray_texel(*level, foot, way);
            texel.min_element() >= 1.0 && texel.max_element() < (SPRAY_SIZE - 2) as f32
        };
        (level..SPRAY_LEVELS).find(is_within).unwrap_or(SPRAY_LEVELS)
    }

    /// The height of what rain hits at a position in texels of a square, linear between texels.
    fn spray_height(&self, level: u32, texel: Vec2) -> f32 {
        let last = (SPRAY_SIZE - 2) as f32;
        let low = texel.floor().clamp(Vec2::ZERO, Vec2::splat(last));
        let part = (texel - low).clamp(Vec2::ZERO, Vec2::ONE);
        let first = ((level * SPRAY_SIZE + low.y as u32) * SPRAY_SIZE + low.x as u32) as usize;
        let (heights, below) = (&self.map.words, first + SPRAY_SIZE as usize);
        let near = heights[first] * (1.0 - part.x) + heights[first + 1] * part.x;
        let far = heights[below] * (1.0 - part.x) + heights[below + 1] * part.x;
        near * (1.0 - part.y) + far * part.y
    }

    /// No height of the cell of a position in texels, and of its neighbors toward greater ones, is above this.
    fn spray_roof(&self, level: u32, texel: Vec2) -> f32 {
        let of = |at: f32| ((at as u32) / SPRAY_CELL).min(SPRAY_CELLS - 1);
        let cell = [of(texel.x), of(texel.y)];
        let next = cell.map(|at| (at + 1).min(SPRAY_CELLS - 1));
        let first = SPRAY_LEVELS * SPRAY_SIZE * SPRAY_SIZE + level * SPRAY_CELLS * SPRAY_CELLS;
        let at = |x: u32, z: u32| self.map.words[(first + z * SPRAY_CELLS + x) as usize];
        let near = at(cell[0], cell[1]).max(at(next[0], cell[1]));
        near.max(at(cell[0], next[1]).max(at(next[0], next[1])))
    }

    /// Spray along a ray of unit direction from the eye between two distances.
    #[must_use]
    pub fn spray_along(&self, direction: Vec3, begin: f32, end: f32) -> SprayAlong {
        let frame = self.frame;
        let (eye, lean) = (Vec3::from(frame.eye), Vec2::from(frame.lean));
        let foot = eye.xz() - lean * eye.y;
        let rate = direction.xz() - lean * direction.y;
        let pace = rate.dot(rate).sqrt();
        let reach = SPRAY_REACH * frame.height;
        let (mut level, mut at, mut depth) = (0, begin, 0.0f32);
        // Weight and moments of the distance from the first place where there is some.
        let mut moments = Vec4::ZERO;
        let (mut first, mut last) = (begin, begin);
        // Height of the ray over the surface, where it is known.
        let mut known: Option<f32> = None;
        for _ in 0..SPRAY_TURNS {
            if at >= end {
                break;
            }
            let next_level = self.spray_level(level, foot, rate * at);
            if next_level >= SPRAY_LEVELS {
                break;
            }
            known = known.filter(|_| next_level == level);
            level = next_level;
            let [_, _, edge, inverse] = frame.levels[level as usize];
            let texel = self.spray_texel(level, foot, rate * at);
            let speed = rate * inverse;
            // A little into the next cell.
            let border = spray_border(texel.x, speed.x).min(spray_border(texel.y, speed.y))
                + 0.01 * edge / pace.max(1.0e-6);
            let leaves = (at + border).min(end);
            let height = eye.y + direction.y * at;
            if height.min(eye.y + direction.y * leaves)
                > self.spray_roof(level, texel + sign(speed) * SPRAY_AHEAD) + reach
            {
                at = leaves;
                known = None;
                continue;
            }
            let gap = known.unwrap_or_else(|| height - self.spray_height(level, texel));
            let next = (at + edge / pace.max(1.0e-6)).min(leaves);
            let way = next - at;
            let there = eye.y + direction.y * next - self.spray_height(level, texel + speed * way);
            let part = frame.extinction * spray_between(gap / frame.height, there / frame.height) * way;
            if part > 0.0 {
                let weight = part * ops::exp(-depth - 0.5 * part);
                last = at + 0.5 * way;
                if depth <= 0.0 {
                    first = last;
                }
                let x = last - first;
                moments += weight * Vec4::new(1.0, x, x * x, x * x * x);
                depth += part;
            }
            at = next;
            known = Some(there);
        }
        spray_places(depth, first, last, moments)
    }

    /// Spray before a pixel.
    fn spray_pixel(&self, camera: &Camera, medium: &MediumFrame, scene: f32, x: u32, y: u32) -> SprayAlong {
        let direction = camera.camera_direction(x as f32 + 0.5, y as f32 + 0.5);
        self.spray_along(direction, medium.medium_begin(direction), scene.min(SPRAY_FAR))
    }

    /// Spray before each pixel of a plate with its distances, two rows for each, without light: the fourth numbers are halves, optical depth and
    /// share of the nearer place, and the distances of both places. The same bits for any number of threads.
    #[must_use]
    pub fn found(&self, camera: &Camera, medium: &MediumFrame, clean: &[[f32; 4]]) -> Vec<[f32; 4]> {
        let pixel = |(index, clean): (usize, &[f32; 4])| {
            let [x, y] = [index as u32 % camera.width, index as u32 / camera.width];
            let found = self.spray_pixel(camera, medium, clean[3], x, y);
            [[found.depth.min(6.0e4), found.share], [found.near.min(6.0e4), found.far.min(6.0e4)]]
                .map(|halves| [0.0, 0.0, 0.0, f32::from_bits(packing_pack_half(halves))])
        };
        clean.par_iter().enumerate().flat_map_iter(pixel).collect()
    }
}

/// Spray along a ray: its optical depth, and two places that have the mean, the variance and the third moment of the distances at which light is
/// taken out (Gauss's rule of two points): what is on two surfaces has a place on each. The same layout as `SprayAlong` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct SprayAlong {
    /// Optical depth.
    pub depth: f32,
    /// Distance of the nearer place, m.
    pub near: f32,
    /// Distance of the farther one, m.
    pub far: f32,
    /// Share of the nearer one, 0 to 1.
    pub share: f32,
}

/// Two places of a weight and of moments of the distance from the first place.
#[must_use]
pub fn spray_places(depth: f32, first: f32, last: f32, moments: Vec4) -> SprayAlong {
    let at_one = |place| SprayAlong { depth, near: place, far: place, share: 1.0 };
    if moments.x <= 0.0 {
        return at_one(first);
    }
    let mean = moments.y / moments.x;
    let square = moments.z / moments.x;
    let variance = (square - mean * mean).max(0.0);
    let spread = variance.sqrt();
    if spread <= 1.0e-3 * (last - first) {
        return at_one(first + mean);
    }
    let third = moments.w / moments.x - mean * (3.0 * square - 2.0 * mean * mean);
    let lean = (third / (variance * spread)).clamp(-1.0e3, 1.0e3) * 0.5;
    let root = (1.0 + lean * lean).sqrt();
    let near = (first + mean + spread * (lean - root)).clamp(first, last);
    let far = (first + mean + spread * (lean + root)).clamp(first, last);
    SprayAlong { depth, near, far, share: 0.5 * (1.0 + lean / root) }
}

/// Way along a coordinate in texels that changes by `rate` a meter, in meters, to the border of its cell. What is on a border is in the cell
/// ahead.
#[must_use]
pub fn spray_border(texel: f32, rate: f32) -> f32 {
    if rate.abs() < 1.0e-6 {
        return SPRAY_FAR;
    }
    let edge = SPRAY_CELL as f32;
    let cell = ((texel + rate.signum() * SPRAY_AHEAD) / edge).floor();
    let border = (cell + if rate > 0.0 { 1.0 } else { 0.0 }) * edge;
    ((border - texel) / rate).max(0.0)
}

/// Signs of two numbers, 0 of 0.
fn sign(of: Vec2) -> Vec2 {
    of.map(|x| if x == 0.0 { 0.0 } else { x.signum() })
}

/// Mean of `exp(-gap)` between two gaps over a surface, in heights of the decrease; nothing below it.
#[must_use]
pub fn spray_between(a: f32, b: f32) -> f32 {
    let (low, high) = (a.min(b), a.max(b));
    if high < 0.0 {
        return 0.0;
    }
    let above = if low < 0.0 { high / (high - low) } else { 1.0 };
    let foot = low.max(0.0);
    above * ops::exp(-foot) * medium_decay_mean(high - foot)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_are_those_of_the_integral() {
        // Between 0 and 1: 1 - 1/e. Between -1 and 1 half of the way is below the surface.
        let whole = 1.0 - ops::exp(-1.0);
        assert!((spray_between(0.0, 1.0) - whole).abs() < 1.0e-6);
        assert!((spray_between(-1.0, 1.0) - 0.5 * whole).abs() < 1.0e-6);
        assert_eq!((spray_between(-1.0, -2.0), spray_between(-1.0, 0.0)), (0.0, 0.0));
        assert_eq!(spray_between(0.0, 0.0), 1.0);
        // Where the series ends.
        let [series, formula] = [0.019_99, 0.020_01].map(|gap| spray_between(gap, 0.0));
        assert!((series - formula).abs() < 2.0e-5 && series > formula);
    }

    /// Light that is taken out at two distances has its two places there, with their shares; and of an even part of a ray those of Gauss's rule.
    #[test]
    fn two_places_stand_for_all() {
        let of = |parts: &[(f32, f32)]| {
            let add =
                |sum: Vec4, &(x, weight): &(f32, f32)| sum + weight * Vec4::new(1.0, x, x * x, x * x * x);
            spray_places(0.5, 4.0, 4.0 + parts[parts.len() - 1].0, parts.iter().fold(Vec4::ZERO, add))
        };
        let two = of(&[(0.0, 0.3), (16.0, 0.1)]);
        assert!((two.near - 4.0).abs() < 1.0e-3 && (two.far - 20.0).abs() < 1.0e-3, "{two:?}");
        assert!((two.share - 0.75).abs() < 1.0e-4, "{two:?}");
        let even: Vec<_> = (0..1000).map(|k| (k as f32 / 999.0, 1.0)).collect();
        let gauss = of(&even);
        let aside = 0.5 / 3.0f32.sqrt();
        assert!((gauss.near - 4.5 + aside).abs() < 1.0e-3 && (gauss.far - 4.5 - aside).abs() < 1.0e-3);
        assert!((gauss.share - 0.5).abs() < 1.0e-3);
        assert_eq!(of(&[(0.0, 1.0)]), SprayAlong { depth: 0.5, near: 4.0, far: 4.0, share: 1.0 });
    }

    #[test]
    fn a_border_is_ahead() {
        assert_eq!((spray_border(3.0, 2.0), spray_border(3.0, -2.0)), (2.5, 1.5));
        assert_eq!((spray_border(8.0, 2.0), spray_border(8.0, -2.0)), (4.0, 4.0));
        assert_eq!(spray_border(8.0, 0.0), SPRAY_FAR);
    }
}
