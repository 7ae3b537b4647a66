//! Lightning of a storm, from a seed.

use downpour_math::ops::f64 as ops;
use downpour_math::rng::{rng_draw, rng_unit, rng_unit_positive, seed_words};

use super::stroke::DARK_AFTER;
use super::{Flash, Stroke};
use crate::sky::towards;

/// Luminous energy of a first stroke over the full angle, cd s: 3.7e5 J of light between 0.4 and 1.1 um
/// (Guo & Krider 1982) of 100 lm/W, in all directions.
const ENERGY_CD_S: f64 = 2.9e6;

/// Spread of the energies of flashes: standard deviation of their natural logarithm.
const ENERGY_SPREAD: f64 = 0.6;

/// Fraction of flashes that have one stroke (Rakov & Uman 2003).
const SINGLE_FRACTION: f64 = 0.2;

/// Maximum number of strokes of a flash that was drawn.
const MAX_STROKES: u32 = 8;

/// Probability that a flash of two strokes or more goes on after each: 4 strokes on the mean of all (3 to 5 in Rakov & Uman 2003).
const NEXT: f64 = 0.68;

/// Time between strokes, s: geometric mean, standard deviation of the logarithm, and bounds (Rakov & Uman 2003).
const GAP_S: f64 = 0.05;
const GAP_SPREAD: f64 = 0.35;
const GAPS_S: [f64; 2] = [0.02, 0.12];

/// Energy of a later stroke over that of the first, bounds.
const LATER: [f64; 2] = [0.2, 0.6];

/// Decay of the light, s, bounds: the channel cools in some milliseconds, what flows on and the ways through the cloud stretch it.
const DECAYS_S: [f64; 2] = [0.01, 0.05];

/// Rise of the light, s.
const RISE_S: f64 = 1.0e-4;

/// Height of the middle of the light above the ground, m, bounds.
const HEIGHTS_M: [f64; 2] = [500.0, 2000.0];

/// A slot of time has a Poisson number of flashes of its own, s.
const SLOT_S: f64 = 1.0;

/// Maximum number of flashes in a slot.
const MAX_SLOT_FLASHES: u32 = 64;

/// From the first stroke to the last at most, s.
pub(super) const MAX_FLASH_S: f64 = 0.9;

/// Maximum time from the begin of a flash until it is dark, s.
pub(super) const MAX_LIT_S: f64 = MAX_FLASH_S + DARK_AFTER * DECAYS_S[1];

/// Dimensions of the random numbers: the number of a slot's flashes, two of each flash, and one of each stroke.
const COUNT_DIMENSION: u32 = 7301;
const PLACE_DIMENSION: u32 = 7302;
const LOOK_DIMENSION: u32 = 7303;
const STROKE_DIMENSION: u32 = 7310;

/// Lightning that comes from a seed: flashes at times of a Poisson process, anywhere within bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Storm {
    /// Mean number of flashes in a minute.
    pub per_minute: f64,
    /// Seed: the same one, the same flashes.
    pub seed: u64,
    /// Least and largest horizontal distance, m.
    pub distance_m: [f64; 2],
    /// First and last azimuth, radians.
    pub azimuth: [f64; 2],
    /// Factor of the light.
    pub brightness: f64,
    /// Illuminance of level ground by the clouds that a flash lights, over that of a surface that faces it.
    pub clouds: f64,
    /// Tint, linear.
    pub color: [f64; 3],
}

impl Storm {
    /// The flashes whose first stroke is from `from_s` to before `to_s`, in order of time.
    pub(super) fn between(&self, from_s: f64, to_s: f64) -> Vec<Flash> {
        let mut flashes = Vec::new();
        let (first, last) = ((from_s / SLOT_S).floor(), (to_s / SLOT_S).ceil());
        let mut slot = first;
        while slot < last {
            for number in 0..self.count(slot) {
                let flash = self.flash(slot, number);
                if (from_s..to_s).contains(&flash.time_s) {
                    flashes.push(flash);
                }
            }
            slot += 1.0;
        }
        flashes.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
        flashes
    }

    /// Words for a slot, a number in it, and a dimension.
    fn draw(&self, slot: f64, number: u32, dimension: u32) -> [u32; 4] {
        // Slots of all times that a picture may have are distinct.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole, and below 2^32")]
        let step = (slot + f64::from(1u32 << 31)) as u32;
        rng_draw(seed_words(self.seed), number, step, dimension)
    }

    /// Number of flashes in a slot: Poisson's, by inversion.
    fn count(&self, slot: f64) -> u32 {
        let mean = self.per_minute / 60.0 * SLOT_S;
        let [word, ..] = self.draw(slot, 0, COUNT_DIMENSION);
        let mut left = f64::from(rng_unit(word));
        let mut chance = ops::exp(-mean);
        let mut count = 0u32;
        while left >= chance && count < MAX_SLOT_FLASHES {
            left -= chance;
            count = count.saturating_add(1);
            chance *= mean / f64::from(count);
        }
        count
    }

    /// A flash.
    fn flash(&self, slot: f64, number: u32) -> Flash {
        let [time, azimuth, distance, height] =
            self.draw(slot, number, PLACE_DIMENSION).map(|word| f64::from(rng_unit(word)));
        let [count, energy, turn, going_on] = self.draw(slot, number, LOOK_DIMENSION);
        let [near, far] = self.distance_m;
        // As many in each square kilometer.
        let square = mix(near * near, far * far, distance);
        let height = mix(HEIGHTS_M[0], HEIGHTS_M[1], height);
        let azimuth = mix(self.azimuth[0], self.azimuth[1], azimuth);
        let elevation = ops::atan2(height, square.sqrt());
        let energy = ENERGY_CD_S * self.brightness * ops::exp(ENERGY_SPREAD * normal(energy, turn));
        let lux_s = energy / (square + height * height);
        let mut strokes = Vec::new();
        let mut after_s = 0.0;
        for k in 0..stroke_count(count, going_on) {
            let draw = self.draw(slot, number, STROKE_DIMENSION.saturating_add(k));
            let [gap, turn, part, decay] = draw;
            let mut factor = 1.0;
            if k > 0 {
                let gap = GAP_S * ops::exp(GAP_SPREAD * normal(gap, turn));
                after_s += gap.clamp(GAPS_S[0], GAPS_S[1]);
                factor = between_logs(LATER, part);
            }
            let decay_s = between_logs(DECAYS_S, decay);
            strokes.push(Stroke { after_s, illuminance_lux: lux_s * factor / decay_s, decay_s });
        }
        Flash {
            time_s: (slot + time) * SLOT_S,
            towards: towards(azimuth, elevation),
            color: self.color,
            rise_s: RISE_S,
            clouds: self.clouds,
            strokes,
        }
    }
}

/// Number of strokes of a flash, 1 to [`MAX_STROKES`].
fn stroke_count(single: u32, going_on: u32) -> u32 {
    if f64::from(rng_unit(single)) < SINGLE_FRACTION {
        return 1;
    }
    let mut left = f64::from(rng_unit_positive(going_on));
    let mut count = 2u32;
    while left < NEXT && count < MAX_STROKES {
        left /= NEXT;
        count = count.saturating_add(1);
    }
    count
}

/// A number of the standard normal distribution from two words (Box & Muller 1958).
fn normal(word: u32, turn: u32) -> f64 {
    let radius = (-2.0 * ops::ln(f64::from(rng_unit_positive(word)))).sqrt();
    radius * ops::cos(std::f64::consts::TAU * f64::from(rng_unit(turn)))
}

/// A number whose logarithm is uniform between those of two bounds.
fn between_logs([low, high]: [f64; 2], word: u32) -> f64 {
    ops::exp(mix(ops::ln(low), ops::ln(high), f64::from(rng_unit(word))))
}

fn mix(from: f64, to: f64, part: f64) -> f64 {
    from + (to - from) * part
}

const _: () = assert!(GAPS_S[1] * (MAX_STROKES as f64 - 1.0) <= MAX_FLASH_S);

#[cfg(test)]
mod tests {
    use super::*;

    fn storm(per_minute: f64, seed: u64) -> Storm {
        Storm {
            per_minute,
            seed,
            distance_m: [1000.0, 4000.0],
            azimuth: [0.0, std::f64::consts::TAU],
            brightness: 1.0,
            clouds: 0.5,
            color: [1.0; 3],
        }
    }

    /// Numbers in minutes have Poisson's mean and variance; 4 standard errors over 4000 minutes.
    #[test]
    fn flashes_come_as_poisson_says() {
        for per_minute in [0.5, 6.0, 300.0] {
            let storm = storm(per_minute, 5);
            let n = 4000.0;
            let counts: Vec<f64> = (0..4000)
                .map(|k| storm.between(f64::from(k) * 60.0, f64::from(k + 1) * 60.0).len() as f64)
                .collect();
            let mean = counts.iter().sum::<f64>() / n;
            let variance = counts.iter().map(|c| (c - mean) * (c - mean)).sum::<f64>() / n;
            assert!((mean - per_minute).abs() < 4.0 * (per_minute / n).sqrt(), "{per_minute}: {mean}");
            let spread = per_minute * (2.0 / n).sqrt() + (per_minute / n).sqrt();
            assert!((variance - per_minute).abs() < 4.0 * spread, "{per_minute}: variance {variance}");
        }
        assert!(storm(0.0, 5).between(-100.0, 100.0).is_empty());
    }

    /// 3 to 5 strokes on the mean, a fifth of the flashes with one; gaps and decays within their bounds.
    #[test]
    fn flashes_have_the_strokes_of_the_literature() {
        let flashes = storm(60.0, 9).between(0.0, 10_000.0);
        let n = flashes.len() as f64;
        let mean = flashes.iter().map(|flash| flash.strokes.len() as f64).sum::<f64>() / n;
        assert!((3.0..5.0).contains(&mean), "{mean}");
        let single = flashes.iter().filter(|flash| flash.strokes.len() == 1).count() as f64 / n;
        assert!((single - 0.2).abs() < 0.02, "{single}");
        let gaps: Vec<f64> = flashes
            .iter()
            .flat_map(|flash| flash.strokes.windows(2).map(|two| two[1].after_s - two[0].after_s))
            .collect();
        let mean = gaps.iter().map(|gap| ops::ln(*gap)).sum::<f64>() / gaps.len() as f64;
        let mean_ms = 1000.0 * ops::exp(mean);
        assert!((40.0..60.0).contains(&mean_ms), "{mean_ms} ms");
        for flash in &flashes {
            assert!(flash.strokes.iter().all(|stroke| (0.00999..0.05001).contains(&stroke.decay_s)));
            assert!((flash.towards[1] > 0.0) && flash.strokes.iter().all(|s| s.after_s <= MAX_FLASH_S));
        }
    }

    /// Any interval has the flashes of the whole that are in it, whatever was asked for before.
    #[test]
    fn flashes_do_not_depend_on_what_is_asked_for() {
        let storm = storm(120.0, 77);
        let all = storm.between(-50.0, 50.0);
        assert!(all.len() > 100);
        let mut parts = Vec::new();
        for k in (0..200).rev() {
            let from = f64::from(k) * 0.5 - 50.0;
            parts.extend(storm.between(from, from + 0.5));
        }
        parts.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
        assert_eq!(parts, all);
        assert_ne!(super::Storm { seed: 78, ..storm }.between(-50.0, 50.0), all);
    }
}
