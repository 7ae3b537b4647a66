//! Light of sky and surfaces on surfaces: means over what the pixels around a pixel have found on the same surface. Twin of
//! `shaders/wgsl/render/skylight.wgsl`.
//!
//! First the mean of a window of 7 x 7 pixels, whose weights fall to 0 at 4 pixels, with the variance of that mean; where several rays
//! of each pixel look for light, of 5 x 5 or 3 x 3 ([`skylight_radius`]): pictures of more rays are sharper, too. Then means
//! of such means, 4, 8 and 16 pixels apart, or less by as much: as far as two of them differ by no more than their noise (H. Dammertz et al., HPG
//! 2010, for the steps; C. Schied et al., HPG 2017, for the variance). A hat of twice the width is the sum of three hats, halved
//! at the sides: what one pixel has found is spread by one hat in the end, 32 pixels to each side, without edges or overlaps.
//!
//! A neighbor counts as far as its normal agrees and as it is on the plane through the pixel's position; in the gloss, as far
//! as it mirrors the same direction, within the lobe. Pixels whose rays have not looked for light ([`RenderFrame::ray_spacing`]) count
//! only where no other does: what they show is what others have found, or the open sky where no other shows their surface.
//!
//! A pixel at an edge shows a second surface, whose light is that of the pixels around it which show it as their first.
//!
//! [`RenderFrame::ray_spacing`]: crate::data::RenderFrame::ray_spacing

use downpour_math::color::color_luminance;
use downpour_render::spacing::window;
use downpour_shaders::render::scene::{
    SKYLIGHT_FILM, SKYLIGHT_FILM_EDGE, SKYLIGHT_GUESSED, SKYLIGHT_LOBE, SKYLIGHT_LOOSE,
    SKYLIGHT_LOOSE_ROUGHNESS, SKYLIGHT_MANY, SKYLIGHT_NOISE, SKYLIGHT_OWN, SKYLIGHT_PASSES, SKYLIGHT_RADIUS,
};
use glam::{Vec3, Vec4};
use rayon::prelude::*;

use crate::data::RenderFrame;
use crate::path::PathSlot;
use crate::scene::SceneView;
use crate::trace::{TraceAmbient, TraceSlot, trace_unpack};

/// Pixels to each side of a window that holds enough rays, if so many of a pixel look for light, in one pixel of each cell of `spacing`
/// times `spacing`.
#[must_use]
pub fn skylight_radius(rays: u32, spacing: u32) -> u32 {
    if spacing > 1 || rays <= 1 {
        SKYLIGHT_RADIUS
    } else if rays >= SKYLIGHT_MANY {
        1
    } else {
        SKYLIGHT_RADIUS - 1
    }
}

/// Weight of a pixel by its distance along an edge, in pixels, in a window of a radius.
#[must_use]
pub fn skylight_hat(from: u32, to: u32, radius: u32) -> f32 {
    (radius + 1 - from.abs_diff(to)) as f32
}

/// A slot of a pixel, unpacked.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SkylightSlot {
    light: Vec3,
    /// Of the surface.
    normal: Vec3,
    /// Of what counts as the same: the normal, or the direction that a mirror would show.
    direction: Vec3,
    pub(crate) position: Vec3,
    pub(crate) slack: f32,
    pub(crate) roughness: f32,
    /// Of its light.
    weight: f32,
}

/// Agreement of two mirrored directions within the lobe of a roughness: 1 for the same direction, at least 0.
#[must_use]
pub fn skylight_lobe(cosine: f32, roughness: f32) -> f32 {
    let alpha = roughness * roughness;
    (1.0 - (1.0 - cosine) / (SKYLIGHT_LOBE * alpha * alpha).max(1.0e-7)).max(0.0)
}

/// Agreement of the roughness of two glosses, 0 to 1: a film and the dry surface beside it mirror different things.
#[must_use]
pub fn skylight_film(own: f32, other: f32) -> f32 {
    let apart = (own - other).abs() / own.max(other).max(1.0e-6);
    ((SKYLIGHT_FILM - apart) / SKYLIGHT_FILM_EDGE).clamp(0.0, 1.0)
}

/// Weight of another pixel in the mean of a pixel: the degree to which both show one surface, 0 to 1. `wet`: of a scene that the rain
/// has made wet.
pub(crate) fn skylight_same(own: &SkylightSlot, other: &SkylightSlot, wet: bool) -> f32 {
    if other.slack <= 0.0 || (own.roughness > 0.0) != (other.roughness > 0.0) {
        return 0.0;
    }
    let off = own.normal.dot(other.position - own.position).abs();
    let near = (1.0 - off / own.slack).max(0.0);
    let cosine = own.direction.dot(other.direction);
    if own.roughness > 0.0 {
        if wet {
            return skylight_lobe(cosine, own.roughness)
                * near
                * skylight_film(own.roughness, other.roughness);
        }
        return skylight_lobe(cosine, own.roughness) * near;
    }
    let agrees = cosine.max(0.0);
    let fourth = agrees * agrees * agrees * agrees;
    fourth * fourth * near
}

/// Weight of a pixel in the mean of another: [`skylight_same`]. If no ray has looked for the light of that one, any surface is better than
/// none, and best is one that faces or mirrors the same way.
fn skylight_near(own: &SkylightSlot, other: &SkylightSlot, wet: bool) -> f32 {
    let same = skylight_same(own, other, wet);
    if own.weight >= 1.0 || other.slack <= 0.0 || (own.roughness > 0.0) != (other.roughness > 0.0) {
        return same;
    }
    let alike = skylight_lobe(own.direction.dot(other.direction), SKYLIGHT_LOOSE_ROUGHNESS);
    same.max(SKYLIGHT_LOOSE * alike.max(SKYLIGHT_LOOSE))
}

/// Similarity of two means given their noise, 0 to 1: variances are those of the means.
#[must_use]
pub fn skylight_alike(own: Vec4, other: Vec4) -> f32 {
    let apart = color_luminance(own.truncate().into()) - color_luminance(other.truncate().into());
    (1.0 - apart * apart / (SKYLIGHT_NOISE * (own.w + other.w)).max(1.0e-20)).max(0.0)
}

/// Slots of all pixels. A mean of a slot is a color and the variance of its luminance.
struct Pixels<'a> {
    frame: &'a RenderFrame,
    slots: &'a [[SkylightSlot; 2]],
    /// True if the rain has made surfaces wet.
    wet: bool,
    /// Pixels to each side of a window.
    radius: u32,
}

impl SceneView<'_> {
    /// Light of sky and surfaces in each pixel: means over its neighbors of what their rays have found, for its two slots, with the
    /// variance of the means' luminance; and what it adds to the picture. `others`: what the rays have found on other surfaces.
    pub(crate) fn skylight(
        &self,
        ambient: &[TraceAmbient],
        others: &[TraceAmbient],
    ) -> (Vec<[Vec4; 2]>, Vec<Vec3>) {
        let eye = self.frame.camera.eye;
        let slots: Vec<[SkylightSlot; 2]> =
            ambient.par_iter().map(|pixel| [0, 1].map(|slot| skylight_slot(pixel, slot, eye))).collect();
        let [width, height] = self.frame.camera.size();
        let radius = skylight_radius(self.frame.sky_rays, self.frame.ray_spacing);
        let pixels = &Pixels { frame: self.frame, slots: &slots, wet: self.frame.wetness > 0, radius };
        let all = |of: &(dyn Fn(u32, u32, usize) -> Vec4 + Sync)| -> Vec<[Vec4; 2]> {
            (0..height)
                .into_par_iter()
                .flat_map_iter(|y| (0..width).map(move |x| [of(x, y, 0), of(x, y, 1)]))
                .collect()
        };
        let mut means = all(&|x, y, k| pixels.skylight_mean(x, y, k));
        for pass in 0..SKYLIGHT_PASSES {
            // As far apart as the weights of a window reach, so that they add up to the same everywhere.
            means = all(&|x, y, k| pixels.skylight_wide(&means, x, y, k, (pixels.radius + 1) << pass));
        }
        let shown = |(k, pixel): (usize, &TraceAmbient)| {
            let (x, y) = (k as u32 % width, k as u32 / width);
            let other = |slot| pixels.skylight_other(&means, others, x, y, slot);
            light_shown(pixel, &means[k], eye) + (other(0) + other(1))
        };
        let light = ambient.par_iter().enumerate().map(shown).collect();
        (means, light)
    }
}

/// Light that the means of a pixel's two slots add to it, as an eye sees it.
fn light_shown(pixel: &TraceAmbient, [of_base, of_mirror]: &[Vec4; 2], eye: Vec3) -> Vec3 {
    skylight_factor(pixel, 0, eye) * of_base.truncate()
        + skylight_factor(pixel, 1, eye) * of_mirror.truncate()
}

/// Factor of the light of a slot of a pixel.
pub(crate) fn skylight_factor(pixel: &TraceAmbient, slot: usize, eye: Vec3) -> Vec3 {
    trace_unpack(skylight_packed(pixel, slot), eye).factor
}

/// A slot of a surface in a pixel.
fn skylight_packed(pixel: &TraceAmbient, slot: usize) -> &TraceSlot {
    if slot > 0 { &pixel.mirror } else { &pixel.base }
}

/// A slot of a pixel, unpacked.
pub(crate) fn skylight_slot(pixel: &TraceAmbient, slot: usize, eye: Vec3) -> SkylightSlot {
    skylight_unpack(skylight_packed(pixel, slot), eye)
}

/// A slot, unpacked.
fn skylight_unpack(slot: &TraceSlot, eye: Vec3) -> SkylightSlot {
    let PathSlot { light, slack, roughness, normal: direction, guessed, position, .. } =
        trace_unpack(slot, eye);
    let mut normal = direction;
    if roughness > 0.0 {
        // Between what is seen and what is mirrored.
        let seen = position - eye;
        let sum = direction - seen / seen.dot(seen).sqrt().max(1.0e-20);
        normal = sum / sum.dot(sum).sqrt().max(1.0e-20);
    }
    let weight = if guessed { SKYLIGHT_GUESSED } else { 1.0 };
    SkylightSlot { light, normal, direction, position, slack, roughness, weight }
}

impl Pixels<'_> {
    /// The mean of the window around a pixel, and the variance of its luminance: of the pixels whose rays have looked for light, or
    /// of all where none of those shows anything like it.
    fn skylight_mean(&self, x: u32, y: u32, slot: usize) -> Vec4 {
        let RenderFrame { camera, ray_spacing, ray_column, ray_row, .. } = self.frame;
        let index = |x: u32, y: u32| (y * camera.width + x) as usize;
        let own = &self.slots[index(x, y)][slot];
        if own.slack <= 0.0 {
            return Vec4::ZERO;
        }
        let (mut sum, mut squares, mut weight, mut weights) = (Vec3::ZERO, 0.0, 0.0, 0.0);
        for apart in [*ray_spacing, 1] {
            if weight > 0.0 {
                break;
            }
            for row in window(y, apart, self.radius, *ray_row, camera.height) {
                for column in window(x, apart, self.radius, *ray_column, camera.width) {
                    let other = index(column, row);
                    let hat = skylight_hat(x, column, self.radius) * skylight_hat(y, row, self.radius);
                    let mut counts = hat * self.slots[other][slot].weight;
                    if row != y || column != x {
                        counts *= skylight_near(own, &self.slots[other][slot], self.wet);
                    }
                    if counts > 0.0 {
                        let light = self.slots[other][slot].light;
                        let luminance = color_luminance(light.into());
                        sum += light * counts;
                        squares += luminance * luminance * counts;
                        weight += counts;
                        weights += counts * counts;
                    }
                }
            }
        }
        let mean = sum / weight;
        let luminance = color_luminance(mean.into());
        let variance = (squares / weight - luminance * luminance).max(0.0);
        // How many there are; of one alone nothing is known.
        let count = weight * weight / weights;
        mean.extend(variance / (count - 1.0).max(0.5) + luminance * luminance / (count * count))
    }

    /// Light on the other surface of a pixel, times what that makes of it: the mean of the means of the pixels around it that show that
    /// surface first; what has been found of it where it is the other one counts little beside them.
    fn skylight_other(
        &self,
        means: &[[Vec4; 2]],
        others: &[TraceAmbient],
        x: u32,
        y: u32,
        slot: usize,
    ) -> Vec3 {
        let camera = &self.frame.camera;
        let pixel = &others[(y * camera.width + x) as usize];
        let own = skylight_slot(pixel, slot, camera.eye);
        if own.slack <= 0.0 {
            return Vec3::ZERO;
        }
        let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
        for row in window(y, 1, self.radius, 0, camera.height) {
            for column in window(x, 1, self.radius, 0, camera.width) {
                let other = (row * camera.width + column) as usize;
                let hat = skylight_hat(x, column, self.radius) * skylight_hat(y, row, self.radius);
                let counts = hat * skylight_near(&own, &self.slots[other][slot], self.wet);
                let its = skylight_slot(&others[other], slot, camera.eye);
                let mut few = hat * SKYLIGHT_OWN * its.weight;
                if row != y || column != x {
                    few *= skylight_near(&own, &its, self.wet);
                }
                sum += means[other][slot].truncate() * counts + its.light * few;
                weight += counts + few;
            }
        }
        skylight_factor(pixel, slot, camera.eye) * (sum / weight)
    }

    /// The mean of means `step` pixels apart that show the same.
    fn skylight_wide(&self, means: &[[Vec4; 2]], x: u32, y: u32, slot: usize, step: u32) -> Vec4 {
        let [width, height] = self.frame.camera.size();
        let here = (y * width + x) as usize;
        let (own, mean) = (&self.slots[here][slot], means[here][slot]);
        if own.slack <= 0.0 {
            return Vec4::ZERO;
        }
        let (mut sum, mut variance, mut weight) = (mean.truncate() * 4.0, mean.w * 16.0, 4.0);
        for k in 0..9 {
            let (column, row) = (x + k % 3 * step, y + k / 3 * step);
            if k == 4 || column < step || row < step || column - step >= width || row - step >= height {
                continue;
            }
            let other = ((row - step) * width + column - step) as usize;
            let its = means[other][slot];
            let kernel = if k % 2 == 0 { 1.0 } else { 2.0 };
            let counts =
                kernel * skylight_same(own, &self.slots[other][slot], self.wet) * skylight_alike(mean, its);
            sum += its.truncate() * counts;
            variance += its.w * counts * counts;
            weight += counts;
        }
        (sum / weight).extend(variance / (weight * weight))
    }
}
