//! Light of lamps and sun that unresolved drops scatter toward the eye. Twin of `shaders/wgsl/render/medium_light.wgsl`,
//! where the method is described.

use std::f32::consts::PI;

use downpour_math::ops;
use downpour_math::rng::rng_unit;
use downpour_shaders::render::medium::{
    MEDIUM_DARK, MEDIUM_FAR, MEDIUM_FOG_REACH, MEDIUM_LAMP_REACH, MEDIUM_LAMPS, MEDIUM_LATTICE, MEDIUM_NEAR,
    MEDIUM_PARTS, MEDIUM_SKY, MEDIUM_SKY_REACH, MEDIUM_SLICES, MEDIUM_SPOTS, MEDIUM_TURN,
};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::MediumFrame;
use super::filter::Filter;
use super::fog::medium_fog_depth;
use super::frame::{medium_both, medium_node, medium_roots};
use super::phase::{medium_phase_at, medium_phase_within, phase_table};
use super::smooth::Smooth;
use crate::camera::Camera;
use crate::light::{Light, light_weight};
use crate::path_lattice::path_lattice_words;
use crate::plate::Lighting;
use crate::rain::glint::drop_glint_angle;
use crate::rain::light::{DropLightForm, DropLights};

/// Light of a scene's lamps on unresolved rain.
#[derive(Clone, Debug)]
pub struct MediumLight<'a> {
    pub(crate) lighting: &'a dyn Lighting,
    pub(crate) camera: Camera,
    pub(crate) medium: MediumFrame,
    /// Integral of the phase functions of drops (by color) and of fog over the scattering angle, from 0 to each multiple of pi / 256.
    pub(crate) phase: Vec<[f32; 4]>,
}

/// Light found so far before a pixel.
#[derive(Clone, Copy, Debug, Default)]
struct Found {
    /// Light if nothing hides it.
    whole: Vec3,
    /// Part of the random number that is left.
    rest: f32,
    /// Light of the part of the ray that was drawn.
    drawn: Vec3,
    /// Part of it that fog scatters, which no roof keeps off, 0 to 1.
    foggy: f32,
    /// Sum of distances, weighted by light.
    weighted: f32,
    /// First and last distance of the part that was drawn.
    part: Vec2,
    /// Lamp that was drawn.
    lamp: u32,
}

/// Lamps that light unresolved drops in a form.
pub(in crate::rain) fn lamps_of(form: DropLightForm) -> u32 {
    match form {
        DropLightForm::None => MEDIUM_DARK,
        DropLightForm::ImSung2022 => MEDIUM_SPOTS,
        _ => MEDIUM_LAMPS,
    }
}

impl<'a> MediumLight<'a> {
    /// The unresolved rain of a picture, lit by `form` as its drops are.
    pub(crate) fn new(
        medium: &MediumFrame,
        camera: &Camera,
        lights: &DropLights<'a>,
        form: DropLightForm,
    ) -> Self {
        let open = u32::from(lights.lighting.is_open());
        let medium = MediumFrame { open, ..*medium };
        let phase = phase_table(form, lights.table, medium.fog_phase[1].into());
        Self { lighting: lights.lighting, camera: *camera, medium, phase }
    }

    /// Rows of the grid of open air, before those of the pixels.
    pub(crate) fn grid_rows(&self) -> usize {
        (self.medium.columns * self.medium.rows * MEDIUM_SLICES) as usize
    }

    /// Unresolved rain before each pixel, rows from the top: light of lamps, and the mean distance of that light and the
    /// optical depth as halves. `clean` is the scene's picture with its distances. The same bits for any number of threads.
    #[must_use]
    pub fn layer(&self, clean: &[[f32; 4]]) -> Vec<[f32; 4]> {
        self.filtered(clean, &self.found(clean))
    }

    /// The same from what was found ([`MediumLight::found`]).
    #[must_use]
    pub fn filtered(&self, clean: &[[f32; 4]], found: &[[f32; 4]]) -> Vec<[f32; 4]> {
        let [width, height] = self.camera.size();
        let filter = Filter { light: self, clean, found };
        let smooth = (self.medium.fog[0] > 0.0).then(|| Smooth::new(&filter));
        let pixel = |x, y| match &smooth {
            Some(smooth) => smooth.medium_smooth_pixel(x, y),
            None => filter.medium_filter_pixel(x, y),
        };
        (0..height)
            .into_par_iter()
            .flat_map_iter(|y| (0..width).map(move |x| pixel(x, y).to_array()))
            .collect()
    }

    /// The grid of open air, then for each pixel two rows: light of lamps if nothing hid them (below 0: that of the pixels around it), and
    /// optical depth; light that
    /// one ray has seen, and its mean distance.
    #[must_use]
    pub fn found(&self, clean: &[[f32; 4]]) -> Vec<[f32; 4]> {
        let cells = self.medium.columns * self.medium.rows;
        let mut rows: Vec<[f32; 4]> =
            (0..cells).into_par_iter().flat_map_iter(|cell| self.slices_of(clean, cell)).collect();
        let [width, height] = self.camera.size();
        let grid = &rows;
        let pixels: Vec<[f32; 4]> = (0..height)
            .into_par_iter()
            .flat_map_iter(|y| (0..width).flat_map(move |x| self.medium_light_pixel(clean, grid, x, y)))
            .collect();
        rows.extend(pixels);
        rows
    }

    /// The part of a ray that a lamp lights: within its cone and its range.
    fn medium_light_span(&self, light: &Light, origin: Vec3, direction: Vec3, farthest: f32) -> Vec2 {
        let spots = self.medium.lit == MEDIUM_SPOTS;
        let nothing = Vec2::splat(farthest);
        let mut span = Vec2::new(0.0, farthest);
        if light.is_parallel() {
            return if spots { nothing } else { span };
        }
        let (axis, reach, [scale, edge]) = (light.axis, light.range, light.cone);
        let offset = origin - light.position;
        let near = offset.dot(direction);
        if reach > 0.0 {
            span = medium_both(span, medium_roots(1.0, near, offset.dot(offset) - reach * reach));
        }
        let edge = -edge / scale.max(1.0e-9);
        if scale <= 0.0 || edge <= 0.0 {
            return if spots && scale <= 0.0 { nothing } else { span };
        }
        let (rate, depth) = (direction.dot(axis), offset.dot(axis));
        let a = rate * rate - edge * edge;
        let b = rate * depth - edge * edge * near;
        let c = depth * depth - edge * edge * offset.dot(offset);
        let root = b * b - a * c;
        if root <= 0.0 {
            return if c > 0.0 && depth > 0.0 { span } else { nothing };
        }
        let sign = if a >= 0.0 { 1.0 } else { -1.0 };
        let firm = sign * a.abs().max(1.0e-12);
        let first = (-b - sign * root.sqrt()) / firm;
        let second = (-b + sign * root.sqrt()) / firm;
        if a < 0.0 {
            let middle = depth + rate * 0.5 * (first + second);
            return if middle > 0.0 { medium_both(span, Vec2::new(first, second)) } else { nothing };
        }
        let beyond = if rate > 0.0 { Vec2::new(second, MEDIUM_FAR) } else { Vec2::new(-MEDIUM_FAR, first) };
        medium_both(span, beyond)
    }

    /// The light of a lamp, added part by part.
    fn medium_light_lamp(&self, sum: Found, index: u32, direction: Vec3, reach: Vec2, pixel: f32) -> Found {
        let medium = &self.medium;
        let eye = Vec3::from(medium.eye);
        let lamp = self.lighting.light(index);
        let parallel = lamp.is_parallel();
        let lit = self.medium_light_span(&lamp, eye, direction, if parallel { reach.x } else { reach.y });
        if lit.y <= lit.x {
            return sum;
        }
        let region = medium.medium_span(direction);
        let outline = medium.medium_outline(direction);
        let offset = lamp.position - eye;
        let nearest = offset.dot(direction);
        let aside = offset - direction * nearest;
        let least = 0.284 * pixel * nearest.max(0.0);
        let h = (aside.dot(aside) + least * least + 1.0e-8).sqrt();
        let first = ops::atan2(h, nearest - lit.x);
        // Distance at which the lamp stands at an angle.
        let at_angle = |angle: f32| nearest - h * ops::cos(angle) / ops::sin(angle).max(1.0e-6);
        let mut next = sum;
        let mut near = lit.x;
        // The sky is as it is seen through rain, but not as it is seen through fog.
        let rain_reach = if parallel { MEDIUM_SKY_REACH } else { MEDIUM_FAR };
        let fog_depth = |distance| medium_fog_depth(medium.fog.into(), direction.y, distance);
        let mut near_depth = medium.medium_depth(near.min(rain_reach), region, outline);
        let mut near_fog = fog_depth(near);
        let mut near_angle = first;
        let mut near_phase = medium_phase_within(&self.phase, first);
        for part in 0..MEDIUM_PARTS {
            if near >= lit.y {
                break;
            }
            let position = 3.0 * ops::log2((near * 1.001 / MEDIUM_NEAR).max(1.0));
            let slice = medium_node(2 * (0.5 * (position + 1.0)) as u32 + 1);
            let turned = near_angle + MEDIUM_TURN;
            let turn = if parallel || turned > 3.1 { MEDIUM_FAR } else { at_angle(turned) };
            let ends = part + 1 == MEDIUM_PARTS;
            let far = if ends { lit.y } else { slice.min(turn.max(near * 1.001)).min(lit.y) };
            let far_depth = medium.medium_depth(far.min(rain_reach), region, outline);
            let far_fog = fog_depth(far);
            let far_angle = ops::atan2(h, nearest - far);
            let far_phase = medium_phase_within(&self.phase, far_angle);
            let middle = at_angle(0.5 * (near_angle + far_angle));
            let light = lamp.light_sample(eye + direction * middle.clamp(near, far), 0.0);
            let mut given = light.irradiance * PI;
            let mut foggy = given * medium.fog[3];
            let through_fog = ops::exp(-0.5 * (near_fog + far_fog));
            if parallel {
                let toward = drop_glint_angle(light.direction, direction) * PI;
                let phase = medium_phase_at(&self.phase, toward);
                given *= phase.truncate() * (ops::exp(-near_depth) - ops::exp(-far_depth)) * through_fog;
                let passed = ops::exp(-0.5 * (near_depth + far_depth));
                foggy *= phase.w * (ops::exp(-near_fog) - ops::exp(-far_fog)) * passed;
            } else {
                let square = (light.distance * light.distance).max(1.0e-8);
                let density = (far_depth - near_depth) / (far - near).max(1.0e-6);
                let passed = ops::exp(-0.5 * (near_depth + far_depth)) * through_fog;
                given *= (far_phase - near_phase).truncate() * (square / h * density * passed);
                let fog_density = (far_fog - near_fog) / (far - near).max(1.0e-6);
                foggy *= (far_phase - near_phase).w * (square / h * fog_density * passed);
            }
            let both = [given.max(Vec3::ZERO), foggy.max(Vec3::ZERO)];
            next = medium_light_add(next, both, index, near, far);
            near_fog = far_fog;
            (near, near_depth, near_angle, near_phase) = (far, far_depth, far_angle, far_phase);
        }
        next
    }

    /// Light and optical depth of the unresolved drops before a pixel; light below 0: that of the pixels around it.
    fn medium_light_pixel(&self, clean: &[[f32; 4]], grid: &[[f32; 4]], x: u32, y: u32) -> [[f32; 4]; 2] {
        let (medium, camera) = (&self.medium, &self.camera);
        let scene = clean[(y * camera.width + x) as usize][3];
        let position = Vec2::new(x as f32, y as f32) + 0.5;
        let direction = camera.camera_direction(position.x, position.y);
        let end = if scene >= MEDIUM_SKY { MEDIUM_SKY_REACH } else { scene };
        let depth = self.medium_open_at(grid, position.x, position.y, end).x;
        if self.medium_light_is_spared(clean, [x, y], direction) {
            return [Vec3::NEG_ONE.extend(depth).to_array(), [0.0; 4]];
        }
        let mut sum = Found::default();
        let mut seen = Vec3::ZERO;
        if medium.lit != MEDIUM_DARK && (medium.all > 0.0 || medium.fog[0] > 0.0) {
            let random = path_lattice_words(camera.seed, x, y, MEDIUM_LATTICE);
            sum.rest = rng_unit(random[0]);
            let sun_reach = if medium.fog[0] > 0.0 { MEDIUM_FOG_REACH } else { MEDIUM_SKY_REACH };
            let reach = Vec2::new(scene.min(sun_reach), scene.min(MEDIUM_LAMP_REACH));
            for k in 0..self.lighting.light_count() {
                sum = self.medium_light_lamp(sum, k, direction, reach, camera.pixel_angle);
            }
            let fraction = light_weight(sum.drawn);
            if fraction > 0.0 {
                let distance = sum.part.x + (sum.part.y - sum.part.x) * rng_unit(random[1]);
                let from = Vec3::from(medium.eye) + direction * distance;
                let light = self.lighting.light(sum.lamp).light_sample(from, 0.0);
                let open = self.medium_open_at(grid, position.x, position.y, distance).y;
                seen = self.lighting.visibility(from, light.direction, light.distance)
                    * (open * (1.0 - sum.foggy) + sum.foggy)
                    * (sum.drawn * (light_weight(sum.whole) / fraction));
            }
        }
        let mean = sum.weighted / light_weight(sum.whole).max(1.0e-20);
        [sum.whole.extend(depth).to_array(), seen.extend(mean).to_array()]
    }
}

/// Adds a part of a ray, from one distance to another, that would give `light`; draws it by what it gives.
fn medium_light_add(sum: Found, [rain, fog]: [Vec3; 2], lamp: u32, near: f32, far: f32) -> Found {
    let light = rain + fog;
    let fraction = light_weight(light);
    if fraction <= 0.0 {
        return sum;
    }
    let chance = fraction / (light_weight(sum.whole) + fraction);
    let mut next = sum;
    next.whole += light;
    next.weighted += 0.5 * (near + far) * fraction;
    if sum.rest < chance {
        next.rest = sum.rest / chance;
        next.drawn = light;
        next.foggy = light_weight(fog) / fraction;
        next.part = Vec2::new(near, far);
        next.lamp = lamp;
    } else {
        next.rest = (sum.rest - chance) / (1.0 - chance).max(1.0e-9);
    }
    next
}
