//! Light binned by its scattering angle; the sums conserve it.

use std::f64::consts::PI;

use downpour_math::ops::f64 as ops;

/// Equal intervals of [0, pi], each with its light and that light's first moment of the position on the disk.
#[derive(Clone, Debug)]
pub(super) struct Bins {
    width: f64,
    bins: Vec<[f64; 2]>,
}

/// Rings, and points along half a ring, that sample a disk of light.
const RINGS: u32 = 6;
const POINTS: u32 = 8;

impl Bins {
    pub(super) fn new(count: usize) -> Self {
        Self { width: PI / count as f64, bins: vec![[0.0; 2]; count] }
    }

    /// Adds light that is spread evenly over the angles between two.
    pub(super) fn add_between(&mut self, ends: [f64; 2], light: f64, position: f64) {
        let (low, high) = (ends[0].min(ends[1]).max(0.0), ends[0].max(ends[1]).min(PI));
        let (first, last) = (self.index(low), self.index(high));
        for k in first..=last {
            let start = low.max(k as f64 * self.width);
            let end = high.min((k + 1) as f64 * self.width);
            let part = if first == last { 1.0 } else { (end - start).max(0.0) / (high - low) };
            self.add(k, part * light, position);
        }
    }

    /// Adds light at one angle to the two intervals whose middles are nearest.
    fn add_at(&mut self, angle: f64, light: f64, position: f64) {
        let at = (angle / self.width - 0.5).clamp(0.0, (self.bins.len() - 1) as f64);
        let (low, part) = (at.floor(), at - at.floor());
        self.add(low as usize, light * (1.0 - part), position);
        self.add((low as usize + 1).min(self.bins.len() - 1), light * part, position);
    }

    fn add(&mut self, k: usize, light: f64, position: f64) {
        if let Some(bin) = self.bins.get_mut(k) {
            bin[0] += light;
            bin[1] += light * position;
        }
    }

    fn index(&self, angle: f64) -> usize {
        ((angle / self.width) as usize).min(self.bins.len() - 1)
    }

    /// The same light from a source of this angular diameter in radians instead of a point.
    pub(super) fn of_disk(&self, diameter: f64) -> Self {
        if diameter <= 0.0 {
            return self.clone();
        }
        let fraction = 1.0 / f64::from(RINGS * POINTS);
        let offsets: Vec<[f64; 2]> = (0..RINGS * POINTS)
            .map(|k| {
                // Rings of equal area.
                let ring = 0.5 * diameter * ((f64::from(k / POINTS) + 0.5) / f64::from(RINGS)).sqrt();
                let round = PI * (f64::from(k % POINTS) + 0.5) / f64::from(POINTS);
                [ring, ops::cos(round)]
            })
            .map(|[ring, along]| [ops::cos(ring), ops::sin(ring) * along])
            .collect();
        let mut spread = Self::new(self.bins.len());
        for (k, &[light, moment]) in self.bins.iter().enumerate().filter(|(_, bin)| bin[0] > 0.0) {
            let angle = (k as f64 + 0.5) * self.width;
            let (sine, cosine) = (ops::sin(angle), ops::cos(angle));
            for [deep, aside] in &offsets {
                let turned = ops::acos((cosine * deep + sine * aside).clamp(-1.0, 1.0));
                spread.add_at(turned, light * fraction, moment / light);
            }
        }
        spread
    }

    /// Light and moment of intervals that are `factor` times as wide.
    pub(super) fn merged(&self, factor: usize) -> Vec<[f64; 2]> {
        let sum = |part: &[[f64; 2]]| part.iter().fold([0.0; 2], |s, bin| [s[0] + bin[0], s[1] + bin[1]]);
        self.bins.chunks(factor).map(sum).collect()
    }
}
