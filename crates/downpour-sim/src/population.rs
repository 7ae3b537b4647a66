//! Which drops a volume holds: counted from the rain, their sizes, and where they are at first.

use std::f64::consts::FRAC_PI_6;

use downpour_drop::distribution::{DropSizeDistribution, SampleTable, SampledBy};
use downpour_math::ops::f64 as ops;
use downpour_math::rng::{rng_draw, rng_unit, seed_words};
use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;

use crate::SimError;
use crate::error::BYTES_PER_DROP;
use crate::motion::{motion_diameter, motion_diameter_bits};
use crate::simulation::SimVolume;
use crate::view::View;
use crate::volume::{VolumeEye, solid_angle, volume_in_area, volume_in_sphere};

/// Bins of diameter per factor of two.
const BINS_PER_OCTAVE: f64 = 20.0;

/// The most drops that a word can number.
pub(crate) const MOST_DROPS: u64 = 1 << 30;

/// The most drops that are ever made: 8.5 GiB of them.
pub(crate) const MOST_IN_MEMORY: u64 = 1 << 28;

/// Dimensions of the random numbers.
const COUNT: u32 = 8230;
const SIZE: u32 = 8231;
const PLACE: u32 = 8250;

/// Tries for a random choice before the last is taken.
const TRIES: u32 = 64;

/// Drops of about one size.
struct Bin {
    largest: f64,
    /// Per m^3.
    density: f64,
    sizes: SampleTable,
}

/// The drops of a volume.
#[derive(Debug)]
pub(crate) struct Population {
    /// Diameters in 16 bits, in order of size.
    pub(crate) sizes: Vec<u16>,
    /// The least diameter on the picture that a view holds, pixels.
    pub(crate) least_pixels: f64,
    /// The least diameter, m: drops below it are left to extinction.
    pub(crate) least_diameter: f64,
}

/// The volume of the rain that drops of a diameter are in, m^3.
pub(crate) fn volume_of(volume: &SimVolume, view: &View, least_pixels: f64, diameter: f64) -> f64 {
    match *volume {
        SimVolume::Box { size_m } | SimVolume::Tariq { size_m } => size_m.iter().product(),
        SimVolume::View => {
            let range = view.range(diameter, least_pixels);
            solid_angle(view.half_width, view.half_height) * range * range * range / 3.0
        }
        // The sphere of which the pyramid is a part.
        SimVolume::ImSung => FRAC_PI_6 * view.far * view.far * view.far,
        SimVolume::Cylinder { radius_m, height_m, .. } => {
            std::f64::consts::PI * radius_m * radius_m * height_m
        }
    }
}

impl Population {
    /// The drops of a rain in a volume, `most` at most: a view then leaves out drops that are small on the picture, other
    /// volumes small drops.
    ///
    /// # Errors
    /// [`SimError::Drop`] if the distribution cannot be cut; [`SimError::Memory`].
    pub(crate) fn new(
        rain: &DropSizeDistribution,
        volume: &SimVolume,
        view: &View,
        most: u32,
        seed: u64,
    ) -> Result<Self, SimError> {
        let bins = bins(rain)?;
        let seed = seed_words(seed);
        let most = f64::from(most);
        let mut least_pixels = view.least_pixels;
        let mut first = 0;
        let expected = |bin: &Bin, least_pixels: f64| {
            bin.density
                * (0..16u32)
                    .map(|k| {
                        let diameter = f64::from(bin.sizes.sample((2 * k + 1) << 27));
                        volume_of(volume, view, least_pixels, diameter)
                    })
                    .sum::<f64>()
                / 16.0
        };
        let total = |first: usize, least_pixels: f64| -> f64 {
            bins.iter().skip(first).map(|bin| expected(bin, least_pixels)).sum()
        };
        if matches!(volume, SimVolume::View) {
            while total(0, least_pixels) > most {
                // 3 % at a time: a law of the third power is at the limit in a few dozen steps.
                least_pixels = (least_pixels * 1.03).max(1.0e-3);
            }
        } else {
            let counts: Vec<f64> = bins.iter().map(|bin| expected(bin, least_pixels)).collect();
            let mut sum = 0.0;
            first = bins.len();
            while first > 0 && sum + counts[first - 1] <= most {
                first -= 1;
                sum += counts[first];
            }
        }
        // Systematic: the whole count is that of the rain to one drop, and each bin's to one.
        let [start, ..] = rng_draw(seed, 0, 0, COUNT).map(|w| (f64::from(w) + 0.5) / 4_294_967_296.0);
        let mut sum = start;
        let mut counts = vec![0u32; bins.len()];
        for (k, bin) in bins.iter().enumerate().skip(first) {
            let before = sum.floor();
            sum += expected(bin, least_pixels);
            counts[k] = (sum.floor() - before) as u32;
        }
        let all = counts.iter().map(|&n| u64::from(n)).sum::<u64>();
        // All that the drops will take is asked for before any of it is worked out.
        let mut room: Vec<[u8; BYTES_PER_DROP as usize]> = Vec::new();
        room.try_reserve_exact(all as usize).map_err(|_| SimError::memory(all))?;
        drop(room);
        let mut sizes: Vec<u16> = Vec::new();
        sizes.try_reserve_exact(all as usize).map_err(|_| SimError::memory(all))?;
        let mut number = 0;
        for (bin, &count) in bins.iter().zip(&counts) {
            let whole = volume_of(volume, view, least_pixels, bin.largest);
            sizes.par_extend((0..count).into_par_iter().map(|k| {
                let mut diameter = 0.0;
                for attempt in 0..TRIES {
                    let [chance, place, ..] = rng_draw(seed, number + k, attempt, SIZE);
                    // The first try is stratified.
                    let share = if attempt == 0 {
                        (f64::from(k) + f64::from(rng_unit(place))) / f64::from(count)
                    } else {
                        f64::from(rng_unit(place))
                    };
                    diameter = bin.sizes.sample((share * 4_294_967_295.0) as u32);
                    let part = volume_of(volume, view, least_pixels, diameter.into());
                    if f64::from(rng_unit(chance)) * whole <= part {
                        break;
                    }
                }
                motion_diameter_bits(diameter) as u16
            }));
            number += count;
        }
        let least_diameter = bins.get(first).map_or(0.0, |bin| f64::from(bin.sizes.sample(0)));
        Ok(Self { sizes, least_pixels, least_diameter })
    }

    /// Where a drop is at first, relative to `origin`.
    pub(crate) fn place(&self, drop: u32, volume: &SimVolume, view: &View, origin: DVec3, seed: u64) -> Vec3 {
        let seed = seed_words(seed);
        let draw = |attempt: u32| {
            let [a, b, c, d] = rng_draw(seed, drop, attempt, PLACE);
            let unit = |word: u32| (f64::from(word) + 0.5) / 4_294_967_296.0;
            (DVec3::new(unit(a), unit(b), unit(c)), unit(d))
        };
        let eye = view.eye - origin;
        let on_axes = |local: DVec3| eye + view.right * local.x + view.up * local.y + view.forward * local.z;
        match *volume {
            SimVolume::Box { size_m } => {
                // The same rain for every camera: its boxes stand in the world.
                let size = DVec3::from(size_m);
                let centre = box_centre(view, size);
                let place = draw(0).0 * size;
                (place - size * ((place - centre) / size + 0.5).floor() - origin).as_vec3()
            }
            SimVolume::View => {
                let diameter =
                    f64::from(motion_diameter(self.sizes.get(drop as usize).copied().unwrap_or(0).into()));
                let range = view.range(diameter, self.least_pixels);
                let (mut across, mut distance) = (DVec2::ZERO, 0.0);
                for attempt in 0..TRIES {
                    let (random, chance) = draw(attempt);
                    across = DVec2::new(
                        (2.0 * random.x - 1.0) * view.half_width,
                        (2.0 * random.y - 1.0) * view.half_height,
                    );
                    distance = range * ops::cbrt(random.z);
                    // The same solid angle everywhere.
                    if chance * ops::pow(1.0 + across.length_squared(), 1.5) <= 1.0 {
                        break;
                    }
                }
                let local = DVec3::new(across.x, across.y, 1.0).normalize() * distance;
                on_axes(local).as_vec3()
            }
            SimVolume::ImSung => {
                let seen = VolumeEye::new(view, origin);
                let far = view.far as f32;
                let local = (0..TRIES)
                    .map(|attempt| volume_in_sphere(draw(attempt).0.as_vec3(), far))
                    .find(|&local| volume_in_area(&seen, local, far));
                on_axes(local.map_or(DVec3::Z * 0.5 * view.far, Vec3::as_dvec3)).as_vec3()
            }
            SimVolume::Tariq { size_m } => (eye + (draw(0).0 - 0.5) * DVec3::from(size_m)).as_vec3(),
            SimVolume::Cylinder { base_m, radius_m, height_m } => {
                let (random, chance) = draw(0);
                let angle = std::f64::consts::TAU * random.x;
                let radius = radius_m * chance.sqrt();
                let offset =
                    DVec3::new(radius * ops::cos(angle), height_m * random.y, radius * ops::sin(angle));
                (DVec3::from(base_m) + offset - origin).as_vec3()
            }
        }
    }
}

/// The middle of a box that follows the eye: a third of its size ahead.
pub(crate) fn box_centre(view: &View, size: DVec3) -> DVec3 {
    view.eye + view.forward * size / 3.0
}

fn bins(rain: &DropSizeDistribution) -> Result<Vec<Bin>, SimError> {
    if rain.rate_mm_h() <= 0.0 {
        return Ok(Vec::new());
    }
    let options = rain.options();
    let (smallest, largest) = (options.smallest_diameter_m.max(1.0e-6), options.largest_diameter_m);
    let count = (ops::log2(largest / smallest) * BINS_PER_OCTAVE).ceil().max(1.0) as u32;
    let edge = |k: u32| {
        if k == count { largest } else { smallest * ops::pow(2.0, f64::from(k) / BINS_PER_OCTAVE) }
    };
    let bin = |k: u32| {
        let part = rain.restricted_to(edge(k), edge(k + 1))?;
        Ok(Bin {
            largest: edge(k + 1),
            density: part.number_density(),
            sizes: part.sample_table(SampledBy::Number),
        })
    };
    // A last sliver would be too thin a bin.
    (0..count).filter(|&k| edge(k + 1) - edge(k) > 1.0e-6).map(bin).collect()
}
