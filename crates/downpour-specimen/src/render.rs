//! The picture of a specimen on the CPU. Twin of `shaders/wgsl/render/specimen.wgsl`.
//!
//! [`render_specimen`] is the fast path: machine vectors of samples, rows in parallel. [`render_specimen_scalar`] is the
//! plain loop, the twin of the GPU's kernel; the two give the same bits. [`render_specimen_f64`] is the reference. A streak has
//! one path for both of the first.

use downpour_drop::DropShape;
use downpour_mask::trace::TracedDrop;
use downpour_math::real::{Lanes, Simd, WithLanes, with_widest_lanes};
use downpour_math::rng::rng_unit;
use downpour_math::vector::{add, add_scaled, scale};
use downpour_shaders::render::specimen::SPECIMEN_LATTICE;
use rayon::prelude::*;

use super::options::SpecimenOptions;
use super::sky::{Sky, sky_f64, specimen_sky, specimen_sky_lamps, specimen_sky_position};
use super::streak::{Precision, Streak};
use super::trace::{Receiver, SpecimenCamera, specimen_light, specimen_radiance, upright_drop};
use super::{Image, SpecimenError};

/// More lanes than any vector has.
const MAX_LANES: usize = 64;

/// Newton steps of the reference.
const REFERENCE_STEPS: u32 = 16;

/// View to trace: the drop for one refractive index, seen by a camera, and the colors that it is for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    pub(crate) drop: TracedDrop,
    pub(crate) camera: SpecimenCamera,
    pub(crate) size: [u32; 2],
    pub(crate) samples: u32,
    pub(crate) channels: [bool; 3],
}

/// Views of a picture: one for all colors, or one for each if their indices differ.
pub(crate) fn views(shape: &DropShape, options: &SpecimenOptions) -> Result<Vec<View>, SpecimenError> {
    let camera = options.camera(shape)?;
    let view = |index, channels| View {
        drop: upright_drop(shape, index),
        camera,
        size: options.size,
        samples: options.samples,
        channels,
    };
    let [red, green, blue] = options.refractive_index;
    if red.to_bits() == green.to_bits() && green.to_bits() == blue.to_bits() {
        return Ok(vec![view(red, [true; 3])]);
    }
    Ok(vec![
        view(red, [true, false, false]),
        view(green, [false, true, false]),
        view(blue, [false, false, true]),
    ])
}

/// Position of the samples of a line within their cells, 0 to 1: each line is shifted against the next by the golden ratio, a
/// rank-1 lattice. Features narrower than a cell, as the image of a small lamp drawn out along a
/// column by a falling drop, are not missed, or hit, by all lines alike.
#[inline(always)]
#[must_use]
pub fn specimen_jitter(line: u32) -> f32 {
    rng_unit(line.wrapping_mul(SPECIMEN_LATTICE))
}

impl View {
    /// Height of the samples of line `line` (counted from the top) above the middle of the picture.
    pub(crate) fn line_height(&self, line: u32) -> f32 {
        (self.size[1] * self.samples) as f32 * 0.5 - (line as f32 + 0.5)
    }

    /// Position of sample `index` of line `line`, from the middle of the picture.
    #[inline(always)]
    pub(crate) fn sample_position(&self, index: u32, line: u32) -> f32 {
        index as f32 - (self.size[0] * self.samples) as f32 * 0.5 + specimen_jitter(line)
    }

    /// One row of pixels: the means of their samples.
    fn row(&self, row: u32, pixels: &mut [[f32; 3]], mut trace: impl FnMut(u32, &mut [[f32; 3]])) {
        let samples = self.samples;
        let mut line = vec![[0.0; 3]; (self.size[0] * samples) as usize];
        let mut sums = vec![[0.0f32; 3]; pixels.len()];
        for b in 0..samples {
            trace(row * samples + b, &mut line);
            for (sum, pixel) in sums.iter_mut().zip(line.chunks(samples as usize)) {
                *sum = pixel.iter().fold(*sum, |sum, &sample| add(sum, sample));
            }
        }
        let mean = 1.0 / (samples * samples) as f32;
        for (pixel, sum) in pixels.iter_mut().zip(sums) {
            let sum = scale(sum, mean);
            for c in (0..3).filter(|&c| self.channels[c]) {
                pixel[c] = sum[c];
            }
        }
    }
}

/// Picture of a streak, each pixel in the precision `R`; `None` for a drop at rest.
fn streak<R: Precision>(
    shape: &DropShape,
    options: &SpecimenOptions,
    sky: Sky<'_>,
) -> Result<Option<Image>, SpecimenError> {
    let Some(motion) = options.motion(shape)? else { return Ok(None) };
    let mut image = empty(options);
    for view in views(shape, options)? {
        let oscillation = motion.drop.oscillation().gpu();
        let streak = Streak { view: &view, motion: &motion, oscillation, sky };
        image.pixels.par_chunks_mut(options.size[0] as usize).enumerate().for_each(|(row, pixels)| {
            for (column, pixel) in (0..).zip(pixels) {
                let made = streak.pixel::<R>(column, row as u32);
                for c in (0..3).filter(|&c| view.channels[c]) {
                    pixel[c] = made[c];
                }
            }
        });
    }
    Ok(Some(image))
}

pub(super) fn empty(options: &SpecimenOptions) -> Image {
    let [width, height] = options.size;
    Image { width, height, pixels: vec![[0.0; 3]; width as usize * height as usize] }
}

/// Renders a drop in front of a sky.
///
/// ```
/// use downpour_drop::DropShape;
/// use downpour_specimen::{Sky, SpecimenOptions, render_specimen};
/// let radiance = vec![[0.25, 0.5, 1.0]; 32];
/// let options = SpecimenOptions { size: [32, 18], pitch: 0.3, ..SpecimenOptions::default() };
/// let image = render_specimen(&DropShape::new(2.0e-3)?, &options, Sky::new(8, 4, &radiance)?)?;
/// // In front of a uniform sky, a drop is invisible.
/// assert!(image.pixels.iter().all(|p| (p[2] - 1.0).abs() < 1e-3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`SpecimenOptions::check`].
pub fn render_specimen(
    shape: &DropShape,
    options: &SpecimenOptions,
    sky: Sky<'_>,
) -> Result<Image, SpecimenError> {
    if let Some(image) = streak::<f32>(shape, options, sky)? {
        return Ok(image);
    }
    let mut image = empty(options);
    for view in views(shape, options)? {
        image.pixels.par_chunks_mut(options.size[0] as usize).enumerate().for_each(|(row, pixels)| {
            let trace = |number, line: &mut [[f32; 3]]| {
                with_widest_lanes(Line { view: &view, sky, number, line });
            };
            view.row(row as u32, pixels, trace);
        });
    }
    Ok(image)
}

/// Renders a drop with a plain loop over all samples, one at a time: the twin of the GPU's kernel.
///
/// # Errors
/// As [`render_specimen`].
pub fn render_specimen_scalar(
    shape: &DropShape,
    options: &SpecimenOptions,
    sky: Sky<'_>,
) -> Result<Image, SpecimenError> {
    if let Some(image) = streak::<f32>(shape, options, sky)? {
        return Ok(image);
    }
    let mut image = empty(options);
    for view in views(shape, options)? {
        for (row, pixels) in (0..).zip(image.pixels.chunks_mut(options.size[0] as usize)) {
            view.row(row, pixels, |number, line| {
                let y = view.line_height(number);
                for (k, sample) in (0..).zip(line) {
                    let x = view.sample_position(k, number);
                    *sample = specimen_radiance(&view.drop, &view.camera, sky, x, y);
                }
            });
        }
    }
    Ok(image)
}

/// One line of samples, traced with machine vectors.
struct Line<'a> {
    view: &'a View,
    sky: Sky<'a>,
    /// Lines above it.
    number: u32,
    line: &'a mut [[f32; 3]],
}

/// Sums the sky's radiance over one ray per lane.
struct LaneSums<'a> {
    sky: Sky<'a>,
    sums: &'a mut [[f32; 3]],
}

impl<S: Simd> Receiver<Lanes<S>> for LaneSums<'_> {
    #[inline(always)]
    fn receive(&mut self, direction: [Lanes<S>; 3], fraction: Lanes<S>) {
        let [u, v] = specimen_sky_position(direction);
        let [x, y, z] = direction;
        let mut stored = [[0.0f32; MAX_LANES]; 6];
        let kept = if self.sky.lamps().is_empty() { 3 } else { 6 };
        for (lanes, into) in [u, v, fraction, x, y, z].into_iter().zip(&mut stored[..kept]) {
            lanes.store(into);
        }
        let [u, v, fraction, x, y, z] = &stored;
        for (k, sum) in self.sums.iter_mut().enumerate() {
            if fraction[k] > 0.0 {
                let lamps = specimen_sky_lamps(self.sky, [x[k], y[k], z[k]]);
                let light = add(specimen_sky(self.sky, [u[k], v[k]]), lamps);
                *sum = add_scaled(*sum, light, fraction[k]);
            }
        }
    }
}

impl WithLanes for Line<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let lanes = Lanes::<S>::COUNT;
        debug_assert!(lanes <= MAX_LANES, "a machine with vectors of more than {MAX_LANES} numbers");
        let y = Lanes::splat(simd, self.view.line_height(self.number));
        for (first, sums) in (0..).step_by(lanes).zip(self.line.chunks_mut(lanes)) {
            let mut x = [0.0; MAX_LANES];
            for (k, x) in (0..).zip(&mut x[..lanes]) {
                // Lanes past the end of the line repeat the last sample.
                let index = (first + k).min(first + sums.len() as u32 - 1);
                *x = self.view.sample_position(index, self.number);
            }
            sums.fill([0.0; 3]);
            let mut sums = LaneSums { sky: self.sky, sums };
            let position = [Lanes::load(simd, &x[..lanes]), y];
            specimen_light(&self.view.drop, &self.view.camera, position, &mut sums);
        }
    }
}

/// Sums the sky's radiance in f64.
struct SumF64<'a> {
    sky: Sky<'a>,
    radiance: [f64; 3],
}

impl Receiver<f64> for SumF64<'_> {
    fn receive(&mut self, direction: [f64; 3], fraction: f64) {
        if fraction > 0.0 {
            self.radiance = add_scaled(self.radiance, sky_f64(self.sky, direction), fraction);
        }
    }
}

/// Renders a drop in f64, each sample rounded to f32 at its end: the reference of the others.
///
/// # Errors
/// As [`render_specimen`].
pub fn render_specimen_f64(
    shape: &DropShape,
    options: &SpecimenOptions,
    sky: Sky<'_>,
) -> Result<Image, SpecimenError> {
    if let Some(image) = streak::<f64>(shape, options, sky)? {
        return Ok(image);
    }
    let mut image = empty(options);
    for mut view in views(shape, options)? {
        view.drop.steps = REFERENCE_STEPS;
        image.pixels.par_chunks_mut(options.size[0] as usize).enumerate().for_each(|(row, pixels)| {
            view.row(row as u32, pixels, |number, line| {
                let y = view.line_height(number);
                for (k, sample) in (0..).zip(line) {
                    let position = [view.sample_position(k, number), y].map(f64::from);
                    let mut sum = SumF64 { sky, radiance: [0.0; 3] };
                    specimen_light(&view.drop, &view.camera, position, &mut sum);
                    *sample = sum.radiance.map(|c| c as f32);
                }
            });
        });
    }
    Ok(image)
}
