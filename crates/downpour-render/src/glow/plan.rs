//! Order of the passes of a glow.

use bytemuck::{Pod, Zeroable};
use downpour_math::pyramid::{PyramidLevel, PyramidRounding, pyramid_levels};
use downpour_shaders::render::glow::GLOW_COARSE_STEPS;
use downpour_weather::GlowFilter;

use super::{Glow, GlowKernel};

/// Fraction of light below which nothing is spread.
const MIN_FRACTION: f64 = 1.0e-7;

/// Standard deviation of the glare of Kawase's passes per axis, degrees, times the width.
const KAWASE_DEG: f64 = 0.5;

/// Most passes of Kawase's filter.
const MAX_KAWASE_PASSES: u32 = 32;

/// Uniforms of a pass. The same layout as `GlowLevel` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct GlowLevel {
    /// Columns and rows of the level.
    pub size: [u32; 2],
    /// Columns and rows of the coarser level.
    pub coarse: [u32; 2],
    /// First texel of the level.
    pub first: u32,
    /// First texel of the coarser level.
    pub coarse_first: u32,
    /// Factor of the level.
    pub weight: f32,
    /// Factor of the coarser level.
    pub coarse_weight: f32,
    /// Fraction of light that is taken from all pixels.
    pub fraction: f32,
    /// Extinction by which light is diffracted, 1/m.
    pub extinction: f32,
    /// 1: adds to the glow that is there.
    pub is_added: u32,
    /// Offset of Kawase's taps, in texels; 1 in a step of [`GlowCoarse`] that goes up.
    pub offset: u32,
}

/// Uniforms of steps between coarse levels. The same layout as `GlowCoarse` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct GlowCoarse {
    /// Number of steps.
    pub count: u32,
    /// 0.
    pub unused_1: u32,
    /// 0.
    pub unused_2: u32,
    /// 0.
    pub unused_3: u32,
    /// The steps, in their order: those that go up have an offset of 1.
    pub levels: [GlowLevel; GLOW_COARSE_STEPS as usize],
}

/// Kind of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum GlowStep {
    /// Takes light from each pixel.
    Take,
    /// Makes a coarser level.
    Down,
    /// Adds the coarser levels to a level.
    Up,
    /// Makes a pass of Kawase's filter.
    Kawase,
    /// Adds what comes to each pixel.
    Add,
}

/// The passes of a glow in their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct GlowPlan {
    /// The passes.
    pub(crate) steps: Vec<(GlowStep, GlowLevel)>,
    /// Texels of all levels.
    pub(crate) texels: usize,
}

impl GlowPlan {
    /// The passes of a glow before a picture of `size` whose pixels are `pixel` radians wide; without steps if nothing glows.
    pub(crate) fn new(glow: &Glow, size: [u32; 2], pixel: f32) -> Self {
        let mut plan = Self { steps: Vec::new(), texels: 0 };
        let pixel = f64::from(pixel);
        if let Some(drops) = glow.diffraction {
            let take = GlowLevel { size, extinction: drops.extinction, ..GlowLevel::default() };
            plan.pyramid(&take, &GlowKernel::disk(drops.angle.into()), pixel);
        }
        let take = GlowLevel { size, fraction: glow.glare, ..GlowLevel::default() };
        match glow.filter {
            _ if glow.glare <= 0.0 => {}
            GlowFilter::Kawase => plan.kawase(&take, KAWASE_DEG.to_radians() * f64::from(glow.width) / pixel),
            _ => plan.pyramid(&take, &GlowKernel::glare(glow.width.into()), pixel),
        }
        plan
    }

    fn is_added(&self) -> u32 {
        u32::from(!self.steps.is_empty())
    }

    /// The light of a kernel by a pyramid.
    fn pyramid(&mut self, take: &GlowLevel, kernel: &GlowKernel, pixel: f64) {
        let levels = pyramid_levels(take.size, PyramidRounding::Up);
        let Some(last) = levels.last() else { return };
        let fractions = kernel.fractions(&variances(take.size, &levels), pixel);
        let sum: f64 = fractions.iter().sum();
        if sum * f64::from(take.fraction.max(take.extinction)) < MIN_FRACTION {
            return;
        }
        let is_added = self.is_added();
        self.texels = self.texels.max((last.target_texel + last.size[0] * last.size[1]) as usize);
        self.steps.push((GlowStep::Take, GlowLevel { is_added, ..*take }));
        let between = |level: &PyramidLevel| GlowLevel {
            size: level.source_size,
            coarse: level.size,
            first: level.source,
            coarse_first: level.target_texel,
            coarse_weight: 1.0,
            ..GlowLevel::default()
        };
        self.steps.extend(levels.iter().map(|level| (GlowStep::Down, between(level))));
        // The coarsest level has its factor where it is added.
        let mut coarse_weight = fractions.last().map_or(0.0, |&fraction| fraction as f32);
        for (level, fraction) in levels.iter().skip(1).zip(&fractions).rev() {
            let weight = *fraction as f32;
            self.steps.push((GlowStep::Up, GlowLevel { weight, coarse_weight, ..between(level) }));
            coarse_weight = 1.0;
        }
        let add = GlowLevel { weight: sum as f32, coarse_weight, is_added, ..between(&levels[0]) };
        self.steps.push((GlowStep::Add, add));
    }

    /// Glare by passes of Kawase's filter, with a standard deviation of `pixels` per axis.
    fn kawase(&mut self, take: &GlowLevel, pixels: f64) {
        let is_added = self.is_added();
        let texels = take.size[0] * take.size[1];
        self.texels = self.texels.max(3 * texels as usize);
        self.steps.push((GlowStep::Take, GlowLevel { is_added, ..*take }));
        let mut level = GlowLevel { coarse: take.size, coarse_first: 0, ..*take };
        // Adding it to the pixels is one more filter, of half a pixel.
        let mut left = (pixels * pixels - 0.5).max(0.0);
        for offset in 0..MAX_KAWASE_PASSES {
            if left <= 0.0 {
                break;
            }
            // The last pass is mixed with the one before, so that the variance is exact.
            let variance = (f64::from(offset) + 0.5) * (f64::from(offset) + 0.5) + 0.25;
            level.weight = (left / variance).min(1.0) as f32;
            left -= variance;
            level = GlowLevel {
                offset,
                coarse_first: if offset % 2 == 0 { texels } else { 2 * texels },
                ..level
            };
            self.steps.push((GlowStep::Kawase, level));
            level.first = level.coarse_first;
        }
        let add = GlowLevel { first: 0, weight: 1.0, coarse_weight: 1.0, is_added, ..level };
        self.steps.push((GlowStep::Add, add));
    }
}

/// Variance of the kernel of each level but the finest, the mean of both axes, in pixels. With texels of `s_k` pixels the filter [1 2 1] / 4 has
/// the variance `s_k^2 / 2` on the way down and as much on the way up; the means by area add `(s^2 - 1) / 12` each way.
fn variances(size: [u32; 2], levels: &[PyramidLevel]) -> Vec<f64> {
    let mut sum = 0.0;
    levels
        .iter()
        .map(|level| {
            let square = |edges: [u32; 2]| {
                let edge = |k: usize| f64::from(size[k]) / f64::from(edges[k]);
                0.5 * (edge(0) * edge(0) + edge(1) * edge(1))
            };
            sum += square(level.source_size);
            sum + (square(level.size) - 1.0) / 6.0
        })
        .collect()
}
