//! The streak of one exact drop: the mean over an exposure of a drop that falls and oscillates.
//!
//! A drop that falls is a ray that rises: in the drop's frame, at u radii of fall after the middle of the exposure, the
//! ray of the camera is shifted by u along +Y. It meets the bounding spheroid of the drop for one interval of u, which is known
//! in closed form ([`specimen_streak_passage`]); during the remaining exposure it shows the sky, with its exact weight. The interval
//! is divided into equal parts, one instant in each, all at the same position in their part, which is random for each sample of the
//! picture: the mean over many samples is that over all times, and the weights sum to 1 for any number of instants.
//!
//! Lengths are in units of the volume-equivalent radius. Twin of `shaders/wgsl/render/specimen_streak.wgsl`; in f64 the
//! reference above it.

use downpour_drop::oscillation::{
    DropOscillation, DropOscillationTime, drop_oscillation_displacement, drop_oscillation_inverse_cube_root,
};
use downpour_math::real::Real;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_math::vector::{add, add_scaled, scale};
use downpour_shaders::render::specimen::{
    SPECIMEN_ALL, SPECIMEN_MIN_FRACTION, SPECIMEN_STREAK_DIMENSION, SPECIMEN_STREAK_REFLECTIONS,
    SPECIMEN_STREAK_TRACES, SPECIMEN_TINY,
};

use super::motion::SpecimenMotion;
use super::render::View;
use super::sky::{Sky, sky_f64, specimen_sky_light};
use super::trace::{SpecimenRay, specimen_ray};
use super::wobble::{SpecimenWobble, specimen_wobble_bounce, specimen_wobble_enter, specimen_wobble_meet};

/// Time interval in which a ray meets the drop.
#[derive(Clone, Copy, Debug)]
pub struct SpecimenPassage<R> {
    /// Foot of the shifted ray at the nearest approach of the drop's axis and the ray.
    pub foot: [R; 3],
    /// u there.
    pub middle: R,
    /// The interval of u.
    pub first: R,
    /// Its end.
    pub last: R,
    /// Fraction of the exposure that it covers.
    pub cover: R,
}

/// The interval in which a ray meets the spheroid that holds the drop.
#[inline]
#[must_use]
pub fn specimen_streak_passage<R: Real<Mask = bool>>(
    motion: &SpecimenMotion,
    ray: &SpecimenRay<R>,
) -> SpecimenPassage<R> {
    let [dx, dy, dz] = ray.direction;
    let zero = dx.constant(0.0);
    let tiny = dx.constant(f64::from(SPECIMEN_TINY));
    let (wide, high) = (dx.constant(motion.inverse_wide), dx.constant(motion.inverse_tall));
    let farthest = dx.constant(motion.farthest);
    let level = (dx * dx + dz * dz).at_least(tiny);
    let aside = dx * ray.foot[2] - dz * ray.foot[0];
    let foot = scale([-dz, zero, dx], aside / level);
    let middle = -ray.foot[1] / level;
    let room = level - aside * aside * wide;
    let tall = level / high + dy * dy / wide;
    let half = room.at_least(zero).sqrt() * tall.sqrt() / level;
    let first = (middle - half).at_least(-farthest);
    let last = (middle + half).at_most(farthest);
    let meets = !last.less(first) & zero.less(room);
    let still = R::select(meets, dx.constant(1.0), zero);
    let moving = (last - first).at_least(zero) / (dx.constant(2.0) * farthest).at_least(tiny);
    SpecimenPassage { foot, middle, first, last, cover: R::select(zero.less(farthest), moving, still) }
}

/// A ray in the frame of the drop, after `u` radii of fall.
#[inline]
#[must_use]
pub fn specimen_streak_shift<R: Real>(
    ray: &SpecimenRay<R>,
    passage: &SpecimenPassage<R>,
    u: R,
) -> SpecimenRay<R> {
    let [dx, dy, dz] = ray.direction;
    let rise = [-(dx * dy), dx * dx + dz * dz, -(dz * dy)];
    SpecimenRay {
        foot: add_scaled(passage.foot, rise, u - passage.middle),
        reach: ray.reach - u * dy,
        direction: ray.direction,
    }
}

/// s2, s3, and the factor that conserves the volume, `seconds` after the middle of the exposure. `volume` is the polynomial of
/// `OscillatingDrop::volume_polynomial`.
#[inline]
#[must_use]
pub fn specimen_streak_state(oscillation: DropOscillation, volume: [f64; 5], seconds: f32) -> [f32; 3] {
    let [v1, v2, v3, w0, w1] = volume.map(|v| v as f32);
    let time = DropOscillationTime { ticks: 0, offset: seconds };
    let [s2, s3] = drop_oscillation_displacement(oscillation, time, 0.0);
    let even = s2 * (v1 + s2 * (v2 + s2 * v3));
    let odd = s3 * s3 * (w0 + s2 * w1);
    [s2, s3, drop_oscillation_inverse_cube_root(1.0 + (even + odd))]
}

/// Position of the instants of a sample within their parts, in [0, 1).
#[inline]
#[must_use]
pub fn specimen_streak_offset(pixel: u32, sample: u32) -> f32 {
    rng_unit(rng_draw([0, 0], pixel, sample, SPECIMEN_STREAK_DIMENSION)[0])
}

/// A number in which a streak can be made.
pub(crate) trait Precision: Real<Mask = bool> {
    fn single(value: f32) -> Self;
    fn to_single(self) -> f32;
    fn state(motion: &SpecimenMotion, oscillation: DropOscillation, seconds: Self) -> [Self; 3];
    fn sky(sky: Sky<'_>, direction: [Self; 3]) -> [Self; 3];
}

impl Precision for f32 {
    fn single(value: f32) -> Self {
        value
    }
    fn to_single(self) -> f32 {
        self
    }
    fn state(motion: &SpecimenMotion, oscillation: DropOscillation, seconds: Self) -> [Self; 3] {
        specimen_streak_state(oscillation, motion.drop.volume_polynomial(), seconds)
    }
    fn sky(sky: Sky<'_>, direction: [Self; 3]) -> [Self; 3] {
        specimen_sky_light(sky, direction)
    }
}

impl Precision for f64 {
    fn single(value: f32) -> Self {
        value.into()
    }
    fn to_single(self) -> f32 {
        self as f32
    }
    fn state(motion: &SpecimenMotion, _: DropOscillation, seconds: Self) -> [Self; 3] {
        motion.drop.at(seconds, 0.0).state()
    }
    fn sky(sky: Sky<'_>, direction: [Self; 3]) -> [Self; 3] {
        sky_f64(sky, direction)
    }
}

/// The radiance along a ray in the frame of the drop.
fn specimen_streak_radiance<R: Precision>(
    drop: &SpecimenWobble<R>,
    ray: &SpecimenRay<R>,
    sky: Sky<'_>,
) -> [R; 3] {
    let Some(s) = specimen_wobble_meet(drop, ray) else { return R::sky(sky, ray.direction) };
    let zero = s.constant(0.0);
    let mut light = specimen_wobble_enter(drop, ray, s);
    let mut radiance = scale(R::sky(sky, light.exit), light.fraction);
    for k in 0..=SPECIMEN_STREAK_REFLECTIONS {
        if !zero.less(light.rest) {
            break;
        }
        let least = if k == SPECIMEN_STREAK_REFLECTIONS { SPECIMEN_ALL } else { SPECIMEN_MIN_FRACTION };
        light = specimen_wobble_bounce(drop, &light, R::single(least));
        if zero.less(light.fraction) {
            radiance = add_scaled(radiance, R::sky(sky, light.exit), light.fraction);
        }
    }
    radiance
}

/// Parameters of a streak: the uniforms of the shader.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Streak<'a> {
    pub(crate) view: &'a View,
    pub(crate) motion: &'a SpecimenMotion,
    pub(crate) oscillation: DropOscillation,
    pub(crate) sky: Sky<'a>,
}

impl Streak<'_> {
    /// Contribution of trace `k` to a sum over the samples of a pixel. The first instant of a sample adds the uncovered time.
    fn specimen_streak_trace<R: Precision>(&self, column: u32, row: u32, k: u32) -> [R; 3] {
        let (view, motion) = (self.view, self.motion);
        let samples = view.samples;
        let (sample, instant) = (k / motion.instants, k % motion.instants);
        let line = row * samples + sample / samples;
        let x = R::single(view.sample_position(column * samples + sample % samples, line));
        let y = R::single(view.line_height(line));
        let (zero, one) = (x.constant(0.0), x.constant(1.0));
        let ray = specimen_ray(&view.camera, x, y);
        let passage = specimen_streak_passage(motion, &ray);
        let mut sum = [zero; 3];
        if instant == 0 {
            sum = scale(R::sky(self.sky, ray.direction), one - passage.cover);
        }
        if zero.less(passage.cover) {
            let inverse = one / x.constant(f64::from(motion.instants));
            let offset = specimen_streak_offset(row * view.size[0] + column, sample);
            let part = (x.constant(f64::from(instant)) + R::single(offset)) * inverse;
            let u = passage.first + (passage.last - passage.first) * part;
            let state = R::state(motion, self.oscillation, u / x.constant(motion.speed));
            let drop = SpecimenWobble {
                coefficients: view.drop.coefficients,
                state,
                index: view.drop.index,
                inverse_wide: motion.inverse_wide,
                inverse_tall: motion.inverse_tall,
            };
            let shifted = specimen_streak_shift(&ray, &passage, u);
            let radiance = specimen_streak_radiance(&drop, &shifted, self.sky);
            sum = add_scaled(sum, radiance, passage.cover * inverse);
        }
        sum
    }

    /// One pixel: as many traces at a time as in an invocation of the shader.
    pub(crate) fn pixel<R: Precision>(&self, column: u32, row: u32) -> [f32; 3] {
        let zero = R::single(0.0);
        let samples = self.view.samples;
        let mean = zero.constant(1.0) / zero.constant(f64::from(samples * samples));
        let traces = samples * samples * self.motion.instants;
        let mut pixel = [zero; 3];
        for first in (0..traces).step_by(SPECIMEN_STREAK_TRACES as usize) {
            let mut sum = [zero; 3];
            for k in first..(first + SPECIMEN_STREAK_TRACES).min(traces) {
                sum = add(sum, self.specimen_streak_trace::<R>(column, row, k));
            }
            pixel = add(pixel, scale(sum, mean));
        }
        pixel.map(R::to_single)
    }
}
