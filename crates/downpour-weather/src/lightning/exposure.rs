//! Light of flashes over an exposure: what a picture is lit by, and the part of the exposure in which.

use super::{Lightning, StrokeOf};

/// Maximum number of parts of an exposure.
const MAX_PARTS: usize = 4;

/// A part with less than this fraction of the light of the brightest one is not drawn apart.
const MIN_PART: f64 = 0.03;

/// Parallel light of a flash over an exposure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlashLight {
    /// Unit direction toward the flash.
    pub towards: [f64; 3],
    /// Tint, linear.
    pub color: [f64; 3],
    /// Illuminance of a surface that faces it, lux: the mean over the whole exposure.
    pub illuminance_lux: f64,
    /// Illuminance of level ground by the clouds that the flash lights, over `illuminance_lux`.
    pub clouds: f64,
}

/// Part of an exposure in which flashes shine.
#[derive(Clone, Debug, PartialEq)]
pub struct FlashExposure {
    /// Begin and end of the part, s: light that is even over it begins when that of the strokes does, and has its mean time.
    pub lit_s: [f64; 2],
    /// Flashes, one for each position.
    pub lights: Vec<FlashLight>,
}

impl FlashExposure {
    /// Sum of the illuminances, lux.
    fn illuminance_lux(&self) -> f64 {
        self.lights.iter().map(|light| light.illuminance_lux).sum()
    }

    /// Takes the light of another part.
    fn take(&mut self, other: Self) {
        for light in other.lights {
            let is_same = |own: &&mut FlashLight| {
                own.towards == light.towards && own.color == light.color && own.clouds == light.clouds
            };
            match self.lights.iter_mut().find(is_same) {
                Some(own) => own.illuminance_lux += light.illuminance_lux,
                None => self.lights.push(light),
            }
        }
    }

    /// Time in its middle, s.
    fn middle_s(&self) -> f64 {
        let [begin, end] = self.lit_s;
        0.5 * (begin + end)
    }
}

impl Lightning {
    /// Light of an exposure from `open_s` to `close_s`, s, in parts, in order of time: each stroke shines for its part of the exposure,
    /// and together they have the mean illuminance over all of it. At most four parts: strokes that are nearest to each other share
    /// one. `is_fading`: light of the age `a` has the weight `2 (1 - a / T)`, as in an eye. An exposure without a length has the
    /// light of its time.
    #[must_use]
    pub fn exposure(&self, open_s: f64, close_s: f64, is_fading: bool) -> Vec<FlashExposure> {
        if self.is_none() {
            return Vec::new();
        }
        let strokes = self.strokes(open_s, close_s);
        let mut parts: Vec<FlashExposure> =
            strokes.iter().filter_map(|stroke| part(stroke, open_s, close_s, is_fading)).collect();
        let most = parts.iter().map(FlashExposure::illuminance_lux).fold(0.0, f64::max);
        while parts.len() > 1 {
            let faint = parts.iter().position(|part| part.illuminance_lux() < MIN_PART * most);
            let nearest = faint.map_or_else(|| closest(&parts), |faint| Some(beside(&parts, faint)));
            let Some([kept, taken]) = nearest.filter(|_| faint.is_some() || parts.len() > MAX_PARTS) else {
                break;
            };
            let other = parts.remove(taken);
            let kept = if taken < kept { kept.saturating_sub(1) } else { kept };
            if let Some(part) = parts.get_mut(kept) {
                if faint.is_none() {
                    part.lit_s = [part.lit_s[0].min(other.lit_s[0]), part.lit_s[1].max(other.lit_s[1])];
                }
                part.take(other);
            }
        }
        parts
    }
}

/// A part and the one whose middle is nearest to it, as the index of the other and of itself.
fn beside(parts: &[FlashExposure], index: usize) -> [usize; 2] {
    let own = parts.get(index).map_or(0.0, FlashExposure::middle_s);
    let others = parts.iter().enumerate().filter(|(other, _)| *other != index);
    let apart = |part: &FlashExposure| (part.middle_s() - own).abs();
    let nearest = others.min_by(|(_, a), (_, b)| apart(a).total_cmp(&apart(b)));
    [nearest.map_or(index, |(other, _)| other), index]
}

/// The two neighbors whose middles are nearest to each other.
fn closest(parts: &[FlashExposure]) -> Option<[usize; 2]> {
    let apart = |two: &[FlashExposure]| match two {
        [a, b] => (b.middle_s() - a.middle_s()).abs(),
        _ => f64::INFINITY,
    };
    let nearest = parts.windows(2).enumerate().min_by(|(_, a), (_, b)| apart(a).total_cmp(&apart(b)));
    nearest.map(|(first, _)| [first, first.saturating_add(1)])
}

/// Light of one stroke over an exposure, if it shines in it.
fn part(stroke: &StrokeOf, open_s: f64, close_s: f64, is_fading: bool) -> Option<FlashExposure> {
    let StrokeOf { pulse, towards, color, clouds } = *stroke;
    let length = close_s - open_s;
    let (illuminance_lux, lit_s) = if length > 0.0 {
        let [whole, late] = pulse.exposure(open_s, close_s);
        let begin = open_s.max(pulse.begin_s);
        let middle = if whole > 0.0 { open_s + late / whole } else { begin };
        let end = (2.0 * middle - begin).clamp(begin, close_s);
        let mean = if is_fading { 2.0 * late / (length * length) } else { whole / length };
        (mean, [begin, end])
    } else {
        (pulse.at(open_s), [open_s; 2])
    };
    let light = FlashLight { towards, color, illuminance_lux, clouds };
    (illuminance_lux > 0.0).then(|| FlashExposure { lit_s, lights: vec![light] })
}
