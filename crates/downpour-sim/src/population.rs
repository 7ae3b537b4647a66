//! Initial drops of a volume: number, sizes and positions.
//!
//! Numbers are Poisson distributed, sizes and positions independent of each other, as for drops of a rain.

use downpour_drop::distribution::{DropSizeDistribution, SampledBy};
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_math::ops::f64 as ops;
use downpour_math::rng::{rng_draw, seed_words};
use downpour_shaders::sim::enter::ENTER_SIZES;
use downpour_shaders::sim::step::MOTION_DIAMETER_STEP;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::SimError;
use crate::error::BYTES_PER_DROP;
use crate::frustum::Frustum;
use crate::options::{MAX_DROPS_IN_MEMORY, SimVolume};
use crate::poisson::poisson_at;
use crate::step::{step_column, step_image, step_pack};
use crate::view::View;
use crate::volume::{VolumeEye, volume_in_area, volume_in_sphere};

/// Number of diameter bins per factor of two.
const BINS_PER_OCTAVE: f64 = 8.0;

/// Dimensions of the random numbers.
const COUNT: u32 = 8230;
const SIZE: u32 = 8231;
const POSITION: u32 = 8250;

/// Number of tries of a rejection sampling before the last is used.
const TRIES: u32 = 64;

/// Drops of similar size.
#[derive(Clone, Debug)]
pub(crate) struct Bin {
    /// Diameters, m.
    pub(crate) diameters: [f64; 2],
    /// Terminal speeds of the smallest and the largest drop, m/s.
    pub(crate) speeds: [f64; 2],
    /// Number per m^3.
    pub(crate) density: f64,
    /// Quantiles of the diameter, evenly spaced, in steps of the 16 bits.
    pub(crate) sizes: [f32; ENTER_SIZES as usize],
}

impl Bin {
    /// Diameter of a quantile, 0 to 1, in 16 bits.
    pub(crate) fn code(&self, unit: f64) -> u16 {
        let position = unit * f64::from(ENTER_SIZES - 1);
        let entry = (position as usize).min(ENTER_SIZES as usize - 2);
        match self.sizes.get(entry..entry + 2) {
            Some(&[a, b]) => (f64::from(a) + f64::from(b - a) * (position - entry as f64) + 0.5) as u16,
            _ => 0,
        }
    }
}

/// Bins of the diameters of a rain, in ascending order.
///
/// # Errors
/// [`SimError::Drop`] if the distribution cannot be divided.
pub(crate) fn bins(rain: &DropSizeDistribution) -> Result<Vec<Bin>, SimError> {
    if rain.rate_mm_h() <= 0.0 {
        return Ok(Vec::new());
    }
    let options = rain.options();
    let law = TerminalSpeed::new(options.fall_speed, &options.air);
    let bin = |diameters: [f64; 2]| {
        let part = rain.restricted_to(diameters[0], diameters[1])?;
        let table = part.sample_table(SampledBy::Number);
        let quantile = |n: usize| {
            let word = (n as u64 * u64::from(u32::MAX) / u64::from(ENTER_SIZES - 1)) as u32;
            table.sample(word) / MOTION_DIAMETER_STEP
        };
        Ok(Bin {
            diameters,
            speeds: diameters.map(|d| law.at(d).unwrap_or(0.0)),
            density: part.number_density(),
            sizes: std::array::from_fn(quantile),
        })
    };
    // A narrow last bin would have too few drops.
    let classes = rain.diameter_classes(BINS_PER_OCTAVE).into_iter();
    classes.filter(|[lower, upper]| upper - lower > 1.0e-6).map(bin).collect()
}

/// Drops of a volume with a constant number of drops.
#[derive(Debug)]
pub(crate) struct Population {
    /// Diameters in 16 bits, in the order of the bins.
    pub(crate) sizes: Vec<u16>,
    /// Minimum diameter, m: smaller drops are left out.
    pub(crate) min_diameter: f64,
}

/// Volume of a box, of the sphere that contains the rain area of Im & Sung, or of a cylinder, m^3.
pub(crate) fn volume_of(volume: &SimVolume, view: &View) -> f64 {
    match *volume {
        SimVolume::Box { size_m } | SimVolume::Tariq { size_m } => size_m.iter().product(),
        SimVolume::ImSung | SimVolume::View => std::f64::consts::FRAC_PI_6 * view.far * view.far * view.far,
        SimVolume::Cylinder { radius_m, height_m, .. } => {
            std::f64::consts::PI * radius_m * radius_m * height_m
        }
    }
}

/// Minimum diameter on the picture, pixels, at which a view holds about `most` drops, and at least that of the view.
pub(crate) fn affordable_pixels(bins: &[Bin], view: &View, times: [f64; 2], most: u32) -> f64 {
    let mut least_pixels = view.least_pixels;
    let expected = |least_pixels: f64| -> f64 {
        // In still air, so that the current wind has no effect.
        let frustum = Frustum::new(view, least_pixels, view.velocity, [0.0; 3], times);
        bins.iter().map(|bin| bin.density * frustum.about_volume(bin.diameters[1], bin.speeds[1])).sum()
    };
    while expected(least_pixels) > f64::from(most) {
        // 3 % at a time: a law of the third power reaches the limit in a few dozen steps.
        least_pixels = (least_pixels * 1.03).max(1.0e-3);
    }
    least_pixels
}

/// Checks that the memory holds so many drops.
///
/// # Errors
/// [`SimError::Memory`].
pub(crate) fn reserve(drops: u64) -> Result<(), SimError> {
    if drops > MAX_DROPS_IN_MEMORY {
        return Err(SimError::memory(drops));
    }
    // All memory of the drops is requested before any drop is computed.
    let mut room: Vec<[u8; BYTES_PER_DROP as usize]> = Vec::new();
    room.try_reserve_exact(drops as usize).map_err(|_| SimError::memory(drops))
}

impl Population {
    /// Drops of a rain in a volume, about `most` at most: small drops are left out.
    ///
    /// # Errors
    /// [`SimError::Memory`].
    pub(crate) fn new(
        bins: &[Bin],
        volume: &SimVolume,
        view: &View,
        most: u32,
        seed: u64,
    ) -> Result<Self, SimError> {
        let seed = seed_words(seed);
        let space = volume_of(volume, view);
        // The largest first, and a part of one bin.
        let mut room = f64::from(most);
        let fractions: Vec<f64> = bins
            .iter()
            .rev()
            .map(|bin| {
                let expected = bin.density * space;
                let fraction = (room / expected.max(1.0e-300)).min(1.0);
                room -= fraction * expected;
                fraction
            })
            .collect();
        let kept: Vec<(&Bin, f64)> = bins.iter().zip(fractions.into_iter().rev()).collect();
        let counts: Vec<u32> = (0..)
            .zip(&kept)
            .map(|(k, (bin, fraction))| poisson_at(bin.density * space * fraction, seed, k, COUNT))
            .collect();
        let all = counts.iter().map(|&n| u64::from(n)).sum::<u64>();
        reserve(all)?;
        let mut sizes: Vec<u16> = Vec::new();
        sizes.try_reserve_exact(all as usize).map_err(|_| SimError::memory(all))?;
        let mut number = 0;
        for (&(bin, fraction), &count) in kept.iter().zip(&counts) {
            sizes.par_extend((0..count).into_par_iter().map(|k| {
                let [word, ..] = rng_draw(seed, number + k, 0, SIZE);
                bin.code(1.0 - fraction * (f64::from(word) + 0.5) / 4_294_967_296.0)
            }));
            number += count;
        }
        let least = kept.iter().find(|(_, fraction)| *fraction > 0.0);
        let min_diameter = least.map_or(0.0, |&(bin, fraction)| {
            let code = f64::from(bin.code(1.0 - fraction)) * f64::from(MOTION_DIAMETER_STEP);
            if fraction < 1.0 { code } else { bin.diameters[0] }
        });
        Ok(Self { sizes, min_diameter })
    }
}

/// Initial position relative to `origin` of a drop of a volume with a constant number of drops, and its count.
pub(crate) fn initial_position(
    drop: u32,
    volume: &SimVolume,
    view: &View,
    origin: DVec3,
    seed: u64,
) -> (Vec3, u32) {
    let seed = seed_words(seed);
    let draw = |attempt: u32| {
        let [a, b, c, d] = rng_draw(seed, drop, attempt, POSITION);
        let unit = |word: u32| (f64::from(word) + 0.5) / 4_294_967_296.0;
        (DVec3::new(unit(a), unit(b), unit(c)), unit(d))
    };
    let eye = view.eye - origin;
    let position = match *volume {
        SimVolume::Box { size_m } => {
            // The same rain for every camera: its boxes are fixed in the world.
            let size = DVec3::from(size_m);
            let images = |at: DVec3| ((at - box_center(view, size)) / size + 0.5).floor();
            let start = draw(0).0 * size;
            let away = images(start);
            let image = step_image(0, step_pack(away.as_vec3()));
            let column = step_column(seed, drop, image, size.as_vec3());
            let moved = start - size * away + DVec3::new(column.x.into(), 0.0, column.y.into());
            let across = images(moved) * DVec3::new(1.0, 0.0, 1.0);
            let at = moved - size * across - origin;
            return (at.as_vec3(), step_image(image, step_pack(across.as_vec3())));
        }
        SimVolume::View | SimVolume::ImSung => {
            let seen = VolumeEye::new(view, origin);
            let far = view.far as f32;
            let local = (0..TRIES)
                .map(|attempt| volume_in_sphere(draw(attempt).0.as_vec3(), far))
                .find(|&local| volume_in_area(&seen, local, far));
            let local = local.map_or(DVec3::Z * 0.5 * view.far, Vec3::as_dvec3);
            (eye + view.right * local.x + view.up * local.y + view.forward * local.z).as_vec3()
        }
        SimVolume::Tariq { size_m } => (eye + (draw(0).0 - 0.5) * DVec3::from(size_m)).as_vec3(),
        SimVolume::Cylinder { base_m, radius_m, height_m } => {
            let (random, chance) = draw(0);
            let angle = std::f64::consts::TAU * random.x;
            let radius = radius_m * chance.sqrt();
            let offset = DVec3::new(radius * ops::cos(angle), height_m * random.y, radius * ops::sin(angle));
            (DVec3::from(base_m) + offset - origin).as_vec3()
        }
    };
    (position, 0)
}

/// Center of a box that follows the eye: a third of its size ahead.
pub(crate) fn box_center(view: &View, size: DVec3) -> DVec3 {
    view.eye + view.forward * size / 3.0
}
