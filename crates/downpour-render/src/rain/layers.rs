//! Rainfall as layers of a texture in one pass over a picture, in place of drops: the form of Tatarchuk & Isidoro 2006, section 3.1. Twin of
//! `shaders/wgsl/render/layers.wgsl`.
//!
//! A texture of places, which moves with the rain, gives each cell of the picture a random number `r`. The rain that is seen there is at
//! `w = p r` of the range of parallax `p`, and the texture of streaks is looked up in its scale: near streaks are large and fast, far
//! ones small and slow, with one look into one texture. A streak has a normal, which is looked up in a coarser level the faster the rain
//! is; it refracts and mirrors what is around the eye and the light of lamps (unhidden, as in the paper), with `f = 0.95 (1 - n . v)^4 + 0.05`, and is
//! mixed with white, as milk in water is for a film.
//!
//! Where the paper leaves numbers to an artist, here they are the weather's: the direction is that of the mean drop as the eye sees it, the
//! speed that of a drop of 1.8 mm in any rain (one that changed would move all that has fallen so far), the length of streaks is what that
//! falls while the shutter is open, and the opacity is as much in the mean as drops take out between the nearest and the farthest layer.
//! Distances are meters. Both textures are made here.
//!
//! What it is not: drops do not end at roofs, and the number of streaks is the same in any rain. Flashes of lightning light the layers as
//! any lamp does, in place of the paper's factors.

use std::cmp::Reverse;
use std::sync::LazyLock;

use downpour_drop::optics::{optics_reflect, optics_refract};
use downpour_math::ops;
use downpour_math::pyramid::{PyramidRounding, pyramid};
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::render::layers::{
    LAYERS_COLUMNS, LAYERS_INDEX, LAYERS_LAMPS, LAYERS_LEVELS, LAYERS_NEAREST, LAYERS_PLACES, LAYERS_SIZE,
    LAYERS_WIDTH,
};
use glam::{IVec2, Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::drops_frame::DropsView;
use super::{DropsFrame, EnvironmentMap, RainOptions};
use crate::camera::Camera;
use crate::plate::Lighting;

/// Streaks of the texture, in a square meter.
const STREAKS: u32 = 90;

/// Half the width of a streak, m: a streak of this width is seen at some meters, where a true one is far below a pixel.
const HALF_WIDTH_M: f32 = 0.003;

/// Length of a streak in the texture, m.
const LENGTH_M: f32 = 0.12;

/// Levels by which the normals of the nearest layer are coarser at 9 m/s.
const DISTORTION: f32 = 2.0;

/// Speed at which layers fall, m/s.
const SPEED: f64 = 6.0;

/// Speed of the fastest drops, m/s.
const FASTEST: f64 = 9.0;

/// Distance at which rows of places move as fast as the rain, m: cells are as high there.
const PLACES_M: f64 = 4.0;

/// Seed and dimension of the random numbers of the textures.
const SEED: [u32; 2] = [0x6c61_7965, 0x7273_3036];
const DIMENSION: u32 = 4211;

/// A lamp as the layers show it. The same layout as `LayersLamp` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct LayersLamp {
    /// Place relative to the eye, m, or the direction to it if its light is parallel.
    pub place: [f32; 3],
    /// 1 if its light is parallel.
    pub is_parallel: u32,
    /// Irradiance over pi of a surface that faces it, at 1 m.
    pub color: [f32; 3],
    /// 0.
    pub unused: u32,
}

/// Uniforms of the layers. The same layout as `LayersFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct LayersFrame {
    /// Factor of the opacity of the texture.
    pub strength: f32,
    /// Distance of the farthest layer over that of the nearest.
    pub parallax: f32,
    /// Direction of the fall on the picture, right and up.
    pub fall: [f32; 2],
    /// Part of a period by which the streaks have moved.
    pub moved: f32,
    /// Part of a row of cells by which the places have moved.
    pub row_part: f32,
    /// Whole rows of cells by which they have moved.
    pub row: u32,
    /// Number of lamps.
    pub count: u32,
    /// Fraction of white.
    pub milk: f32,
    /// Length of streaks over that in the texture.
    pub stretch: f32,
    /// Levels by which the nearest normals are coarser.
    pub distortion: f32,
    /// 0.
    pub unused: u32,
    /// Lamps, the brightest first.
    pub lamps: [LayersLamp; LAYERS_LAMPS as usize],
}

impl LayersFrame {
    /// The layers of a rain in a picture, without lamps; `None` if it has none, or no rain.
    pub(super) fn new(camera: &Camera, options: &RainOptions) -> Option<Self> {
        let layers = options.layers?;
        let (medium, exposure) = (&options.medium, &options.exposure);
        let velocity = medium.velocity() - exposure.eye.velocity;
        let on_picture = [camera.right, camera.up].map(|axis| velocity.dot(axis.normalize_or_zero()));
        let on_picture = Vec2::from(on_picture);
        let fall = on_picture.try_normalize().unwrap_or(Vec2::NEG_Y);
        let stretch = (SPEED * exposure.drops_s() / f64::from(LENGTH_M)).clamp(0.125, 32.0);
        let way = SPEED * exposure.time_s;
        let (periods, rows) = (way / stretch, way / PLACES_M);
        // As much as drops take out in the mean.
        let range = f64::from(LAYERS_NEAREST) * (layers.parallax - 1.0);
        let wanted = 1.0 - downpour_math::ops::f64::exp(-medium.extinction() * range);
        if wanted <= 0.0 {
            return None;
        }
        Some(Self {
            fall: fall.into(),
            moved: (periods - periods.floor()) as f32,
            row_part: (rows - rows.floor()) as f32,
            row: (rows.floor() as i64) as u32,
            count: 0,
            strength: (wanted / f64::from(TEXTURE.opacity)) as f32,
            parallax: layers.parallax as f32,
            milk: layers.milk as f32,
            stretch: stretch as f32,
            distortion: DISTORTION * (f64::from(velocity.length()) / FASTEST).min(1.0) as f32,
            unused: 0,
            lamps: [LayersLamp::default(); LAYERS_LAMPS as usize],
        })
    }

    /// The same with the lamps of a plate that are brightest at its eye.
    #[must_use]
    pub fn lit(mut self, eye: Vec3, lighting: &dyn Lighting) -> Self {
        let found = lamps(eye, lighting);
        self.count = found.len().min(self.lamps.len()) as u32;
        self.lamps.iter_mut().zip(found).for_each(|(lamp, found)| *lamp = found);
        self
    }

    /// Puts the layers before rain that is drawn: radiance, and the transmittance of the scene behind it.
    pub fn before(
        &self,
        drops: &DropsFrame,
        clean: &[[f32; 4]],
        environment: &EnvironmentMap,
        rain: &mut [[f32; 4]],
    ) {
        let drops = DropsView { frame: drops, masks: &[], capture: &environment.texels };
        let view = LayersView { frame: self, drops: &drops, texture: texture_words() };
        let width = drops.frame.camera.width;
        rain.par_iter_mut().zip(clean).enumerate().for_each(|(index, (behind, clean))| {
            let shown = view.layers_pixel(index as u32 % width, index as u32 / width, clean[3]);
            *behind = (Vec4::from(*behind) * (1.0 - shown.w) + shown.truncate().extend(0.0)).to_array();
        });
    }
}

/// Lamps of a plate, the brightest at the eye first.
fn lamps(eye: Vec3, lighting: &dyn Lighting) -> Vec<LayersLamp> {
    let mut lamps: Vec<(u32, LayersLamp)> = (0..lighting.light_count())
        .map(|index| {
            let light = lighting.light(index);
            let at_eye = light.light_sample(eye, 1.0).irradiance.element_sum();
            let place = if light.is_parallel() { -light.axis } else { light.position - eye };
            let lamp = LayersLamp {
                place: place.into(),
                is_parallel: u32::from(light.is_parallel()),
                color: light.color.into(),
                unused: 0,
            };
            // Bits of numbers from 0 on are in their order.
            (at_eye.max(0.0).to_bits(), lamp)
        })
        .collect();
    lamps.sort_by_key(|&(bits, _)| Reverse(bits));
    lamps.into_iter().map(|(_, lamp)| lamp).collect()
}

/// Inputs of the layers of a pixel.
struct LayersView<'a> {
    frame: &'a LayersFrame,
    drops: &'a DropsView<'a>,
    texture: &'a [u32],
}

impl LayersView<'_> {
    /// The place of a cell: r, and the shift.
    fn layers_place(&self, column: u32, row: u32) -> Vec3 {
        let edge = LAYERS_PLACES - 1;
        unpacked(self.texture[((row & edge) * LAYERS_PLACES + (column & edge)) as usize])
    }

    /// A texel of a level of the streaks: opacity, and the parts of the normal across and along the fall.
    fn layers_texel(&self, level: u32, column: i32, row: i32) -> Vec3 {
        let size = LAYERS_SIZE >> level;
        let first = LAYERS_PLACES * LAYERS_PLACES + 4 * (LAYERS_SIZE * LAYERS_SIZE - size * size) / 3;
        let edge = size - 1;
        let found =
            unpacked(self.texture[(first + (row as u32 & edge) * size + (column as u32 & edge)) as usize]);
        Vec3::new(found.x, found.y * 2.0 - 1.0, found.z * 2.0 - 1.0)
    }

    /// A level at a position in periods, bilinear.
    fn layers_level(&self, level: u32, position: Vec2) -> Vec3 {
        let at = position * (LAYERS_SIZE >> level) as f32 - 0.5;
        let low = at.floor();
        let part = at - low;
        let IVec2 { x, y } = low.as_ivec2();
        let texel = |column, row| self.layers_texel(level, column, row);
        let upper = texel(x, y) * (1.0 - part.x) + texel(x + 1, y) * part.x;
        let lower = texel(x, y + 1) * (1.0 - part.x) + texel(x + 1, y + 1) * part.x;
        upper * (1.0 - part.y) + lower * part.y
    }

    /// The streaks at a position in periods, between two levels.
    fn layers_streaks(&self, position: Vec2, level: f32) -> Vec3 {
        let within = level.clamp(0.0, (LAYERS_LEVELS - 1) as f32);
        let low = (within as u32).min(LAYERS_LEVELS - 2);
        let part = within - low as f32;
        self.layers_level(low, position) * (1.0 - part) + self.layers_level(low + 1, position) * part
    }

    /// The layers in a pixel before a scene so far away: radiance times opacity, and opacity.
    fn layers_pixel(&self, x: u32, y: u32, scene: f32) -> Vec4 {
        let (frame, camera) = (self.frame, &self.drops.frame.camera);
        let (wide, high) = (camera.right.dot(camera.right).sqrt(), camera.up.dot(camera.up).sqrt());
        let plane = Vec2::new(
            (2.0 * (x as f32 + 0.5) / camera.width as f32 - 1.0) * wide,
            (1.0 - 2.0 * (y as f32 + 0.5) / camera.height as f32) * high,
        );
        let fall = Vec2::from(frame.fall);
        let along = plane.dot(fall);
        let across = plane.x * -fall.y + plane.y * fall.x;
        let column = (across * LAYERS_COLUMNS).floor() as i32 as u32;
        let row = ((along - frame.row_part).floor() as i32 as u32).wrapping_sub(frame.row);
        let found = self.layers_place(column, row);
        // w = p r, over the nearest layer.
        let distance = LAYERS_NEAREST * (1.0 + (frame.parallax - 1.0) * found.x);
        if scene < distance {
            return Vec4::ZERO;
        }
        let position =
            Vec2::new(across * distance + found.y, along * distance / frame.stretch - frame.moved + found.z);
        let level = ops::log2((distance * camera.pixel_angle * LAYERS_SIZE as f32).max(1.0));
        let opacity = (self.layers_streaks(position, level).x * frame.strength).min(1.0);
        if opacity <= 0.0 {
            return Vec4::ZERO;
        }
        let bent = self.layers_streaks(position, level + frame.distortion * (1.0 - found.x));
        let direction = camera.camera_direction(x as f32 + 0.5, y as f32 + 0.5);
        let (right, up) = (camera.right / wide, camera.up / high);
        let leaning =
            (right * -fall.y + up * fall.x) * bent.y + (right * fall.x + up * fall.y) * bent.z - direction;
        let normal = leaning / leaning.dot(leaning).sqrt();
        let cosine = -direction.dot(normal);
        let fresnel = layers_fresnel(cosine);
        let mirrored = optics_reflect(direction.to_array(), normal.to_array()).into();
        let refracted = layers_refracted(direction, normal);
        let about = |way| self.drops.drops_capture_about(direction, way, LAYERS_WIDTH);
        let mut seen = about(refracted) * (1.0 - fresnel) + about(mirrored) * fresnel;
        for lamp in &frame.lamps[..frame.count as usize] {
            seen += layers_lamp(lamp, direction * distance, direction, normal);
        }
        let white = self.drops.drops_capture_texel(self.drops.frame.capture_last, 0, 0).max_element();
        seen += (Vec3::splat(white) - seen) * frame.milk;
        (seen * opacity).extend(opacity)
    }
}

/// Fraction of light that a streak mirrors, by the cosine between its normal and the way to the viewer: the paper's `f`.
#[must_use]
pub fn layers_fresnel(cosine: f32) -> f32 {
    let aside = 1.0 - cosine.clamp(0.0, 1.0);
    0.95 * (aside * aside) * (aside * aside) + 0.05
}

/// The way of light that a streak shows, into water, for a ray of a direction and a normal toward the viewer, both of length 1.
#[must_use]
pub fn layers_refracted(direction: Vec3, normal: Vec3) -> Vec3 {
    optics_refract(direction.to_array(), normal.to_array(), 1.0 / LAYERS_INDEX).0.into()
}

/// The fourth power of a cosine, 0 if it is below 0.
fn layers_lobe(cosine: f32) -> f32 {
    let square = cosine.max(0.0) * cosine.max(0.0);
    square * square
}

/// Light of a lamp that a streak at a place relative to the eye mirrors, and that comes through it.
fn layers_lamp(lamp: &LayersLamp, place: Vec3, direction: Vec3, normal: Vec3) -> Vec3 {
    let mut offset = Vec3::from(lamp.place) - place;
    let mut square = offset.dot(offset).max(1.0e-2);
    if lamp.is_parallel > 0 {
        offset = lamp.place.into();
        square = 1.0;
    }
    let along = offset / offset.dot(offset).sqrt().max(1.0e-6);
    let half_way = along - direction;
    let middle = half_way / half_way.dot(half_way).sqrt().max(1.0e-6);
    // Blinn's lobe of exponent 16, and Phong's of exponent 4 about the refracted ray: their light would not change with it.
    let fourth = layers_lobe(normal.dot(middle));
    let mirrored = (fourth * fourth)
        * (fourth * fourth)
        * layers_fresnel(along.dot(middle))
        * normal.dot(along).max(0.0);
    let through = layers_lobe(layers_refracted(direction, normal).dot(along))
        * (1.0 - layers_fresnel(-direction.dot(normal)));
    Vec3::from(lamp.color) * ((mirrored * (24.0 / 8.0) + through * (5.0 / 2.0)) / square)
}

/// First three bytes of a word, 0 to 1.
fn unpacked(word: u32) -> Vec3 {
    let [x, y, z, _] = word.to_le_bytes();
    Vec3::new(f32::from(x), f32::from(y), f32::from(z)) / 255.0
}

/// Bytes of numbers of 0 to 1.
fn packed(parts: Vec3) -> u32 {
    let [x, y, z] = parts.to_array().map(|part| (part.clamp(0.0, 1.0) * 255.0).round() as u8);
    u32::from_le_bytes([x, y, z, 0])
}

/// Both textures.
struct Texture {
    words: Vec<u32>,
    /// Mean opacity of the streaks.
    opacity: f32,
}

static TEXTURE: LazyLock<Texture> = LazyLock::new(texture);

/// The texture of places, and behind it all levels of that of streaks: a byte for each number.
#[must_use]
pub fn texture_words() -> &'static [u32] {
    &TEXTURE.words
}

fn texture() -> Texture {
    let number = |id: u32, step: u32| rng_draw(SEED, id, step, DIMENSION).map(rng_unit);
    let place = |id| {
        let [r, across, along, _] = number(id, 0);
        packed(Vec3::new(r, across, along))
    };
    let mut words: Vec<u32> = (0..LAYERS_PLACES * LAYERS_PLACES).map(place).collect();
    let size = LAYERS_SIZE as usize;
    // Opacity, and how the surface leans: flat where there is no streak.
    let mut finest = vec![[0.0f32, 0.5, 0.5]; size * size];
    let [half, long] = [HALF_WIDTH_M, 0.5 * LENGTH_M].map(|meters| meters * LAYERS_SIZE as f32);
    for id in 0..STREAKS {
        let [x, y, faint, thin] = number(id, 1);
        let (x, y) = (x * LAYERS_SIZE as f32, y * LAYERS_SIZE as f32);
        let (half, strength) = (half * (0.6 + 0.8 * thin), 0.35 + 0.65 * faint);
        let [wide, high] = [half * 2.5, long].map(|reach| reach.ceil() as i32);
        for row in -high..=high {
            for column in -wide..=wide {
                let at = Vec2::new(
                    (x.floor() as i32 + column) as f32 + 0.5,
                    (y.floor() as i32 + row) as f32 + 0.5,
                );
                let (across, along) = ((at.x - x) / half, (at.y - y) / long);
                let square = along * along;
                let end = (1.0 - square * square).max(0.0);
                let opacity = strength * ops::exp(-across * across) * end;
                let [column, row] = [at.x, at.y].map(|n| (n as i32).rem_euclid(LAYERS_SIZE as i32) as usize);
                let texel = &mut finest[row * size + column];
                if opacity > texel[0] {
                    let lean = Vec2::new(0.8 * across.clamp(-1.0, 1.0), 0.4 * along) * 0.5 + 0.5;
                    *texel = [opacity, lean.x, lean.y];
                }
            }
        }
    }
    let opacity = finest.iter().map(|texel| texel[0]).sum::<f32>() / (size * size) as f32;
    pyramid(&mut finest, [LAYERS_SIZE; 2], PyramidRounding::Down);
    words.extend(finest.into_iter().map(|texel| packed(texel.into())));
    Texture { words, opacity }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn textures_have_all_levels() {
        let streaks: u32 =
            (0..LAYERS_LEVELS).map(|level| (LAYERS_SIZE >> level) * (LAYERS_SIZE >> level)).sum();
        assert_eq!(texture_words().len() as u32, LAYERS_PLACES * LAYERS_PLACES + streaks);
        let last = unpacked(texture_words()[texture_words().len() - 1]);
        assert!((last.x - TEXTURE.opacity).abs() < 0.01, "{} and {}", last.x, TEXTURE.opacity);
        // Half of the layers are nearer than the middle.
        let near = texture_words()[..4096].iter().filter(|&&word| unpacked(word).x < 0.5).count();
        assert!((1900..2200).contains(&near), "{near}");
    }

    /// Light bends toward the normal by Snell's law, and not at all head on.
    #[test]
    fn streaks_refract() {
        assert!((layers_refracted(Vec3::NEG_Z, Vec3::Z) - Vec3::NEG_Z).length() < 1.0e-6);
        let normal = Vec3::new(0.6, 0.0, 0.8);
        let way = layers_refracted(Vec3::NEG_Z, normal);
        let (before, after) = (Vec3::NEG_Z.cross(normal).length(), way.cross(normal).length());
        assert!((before / after - LAYERS_INDEX).abs() < 1.0e-4 && (way.length() - 1.0).abs() < 1.0e-5);
        assert_eq!((layers_fresnel(1.0), layers_fresnel(0.0)), (0.05, 1.0));
    }
}
