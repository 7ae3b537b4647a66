//! Sampling of diameters.
//!
//! A random word of 32 bits becomes a diameter; a larger word gives a larger drop. The table of quantiles has cells
//! that halve with the remaining probability on either side of the median, down to single words, so that the rare
//! large drops are drawn as exactly as the many small ones: drops of a probability of 1e-9 carry water, and a
//! second of heavy rain over a square kilometer has 1e10 drops. Finding the cell needs no transcendental function: the
//! result has the same bits on every device.

use downpour_math::ops;
use downpour_shaders::drop::distribution::{
    DISTRIBUTION_CELL_BITS, DISTRIBUTION_COARSE_STEP, DISTRIBUTION_RARE_WORDS, DISTRIBUTION_SIDE_NODES,
    DISTRIBUTION_WORD_STEP,
};

use super::grid::Grid;

/// Population from which drops are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SampledBy {
    /// Drops in a volume: proportional to N(D).
    Number,
    /// Drops that cross a horizontal plane: proportional to N(D) v(D). Large drops fall faster and cross more often.
    Flux,
}

/// Quantiles of a distribution, from which diameters are drawn.
///
/// A GPU needs the nodes only: see [`distribution_table_position`].
///
/// ```
/// use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw, SampledBy};
/// use downpour_math::rng::{rng_draw, seed_words};
/// let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 10.0)?;
/// let table = rain.sample_table(SampledBy::Number);
/// let diameter_m = table.sample(rng_draw(seed_words(1), 42, 0, 0)[0]);
/// assert!((0.1e-3..=8.0e-3).contains(&diameter_m));
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SampleTable {
    by: SampledBy,
    nodes: Vec<f32>,
}

impl SampleTable {
    /// Number of nodes of a table.
    pub const NODES: usize = 2 * DISTRIBUTION_SIDE_NODES as usize;

    pub(super) fn new(by: SampledBy, grid: &Grid, density: impl Fn(f64) -> f64) -> Self {
        let cumulative = grid.cumulate(density);
        let fraction = |node: u32| (f64::from(words_before(node)) + 0.5) / 4_294_967_296.0;
        let below = (0..DISTRIBUTION_SIDE_NODES).map(|i| cumulative.at_fraction_below(fraction(i)) as f32);
        let above = (0..DISTRIBUTION_SIDE_NODES).map(|i| cumulative.at_fraction_above(fraction(i)) as f32);
        Self { by, nodes: below.chain(above).collect() }
    }

    /// Population of the table.
    #[must_use]
    pub fn by(&self) -> SampledBy {
        self.by
    }

    /// Diameters at the nodes, in meters: from the smallest up to the median, then from the largest down to it.
    #[must_use]
    pub fn nodes(&self) -> &[f32] {
        &self.nodes
    }

    /// Diameter of a word, in meters.
    #[must_use]
    pub fn sample(&self, word: u32) -> f32 {
        let position = distribution_table_position(word);
        let index = position.index as usize;
        distribution_lerp(self.nodes[index], self.nodes[index + 1], position.fraction)
    }
}

/// Number of words of a side before a node.
fn words_before(node: u32) -> u32 {
    let cells = 1 << DISTRIBUTION_CELL_BITS;
    if node < 2 * cells {
        return node;
    }
    ((node % cells) + cells) << (node / cells - 1)
}

/// Position in the table, between the nodes `index` and `index + 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistributionPosition {
    /// Index of the node below.
    pub index: u32,
    /// Fraction of the distance to the next node, in [0, 1).
    pub fraction: f32,
}

/// Position of a word in the table. Nodes 0 to `DISTRIBUTION_SIDE_NODES` - 1 go from the smallest drop up to the
/// median; the others from the largest down to the median.
#[inline]
#[must_use]
pub fn distribution_table_position(word: u32) -> DistributionPosition {
    let upper = word >= 0x8000_0000;
    // Words left on the nearer side: below 2^31.
    let left = if upper { !word } else { word };
    let leading = 31 - (left | 1).leading_zeros();
    let shift = leading.max(DISTRIBUTION_CELL_BITS) - DISTRIBUTION_CELL_BITS;
    let cell = (shift << DISTRIBUTION_CELL_BITS) + (left >> shift);
    // Below 2^24, and the scale is a power of two: exact.
    let rest = left & ((1 << shift) - 1);
    let scale = f32::from_bits((127 - shift) << 23);
    let index = cell + if upper { DISTRIBUTION_SIDE_NODES } else { 0 };
    DistributionPosition { index, fraction: rest as f32 * scale }
}

/// Interpolates a diameter between two nodes.
#[inline]
#[must_use]
pub fn distribution_lerp(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// Maps a word to a probability in (0, 1), with all 32 bits where it is small. Exact.
#[inline]
#[must_use]
pub fn distribution_probability(word: u32) -> f32 {
    let coarse = ((word >> 9) as f32 + 0.5) * DISTRIBUTION_COARSE_STEP;
    let rare = ((word & (DISTRIBUTION_RARE_WORDS - 1)) as f32 + 0.5) * DISTRIBUTION_WORD_STEP;
    if word < DISTRIBUTION_RARE_WORDS { rare } else { coarse }
}

/// Draws a diameter of the exponential law N ~ exp(-slope D) between two diameters in meters. The slope in 1/m is
/// positive.
///
/// ```
/// use downpour_drop::distribution::distribution_sample_exponential;
/// // Marshall & Palmer at 10 mm/h: half of the drops above 0.1 mm are below 0.37 mm.
/// let median = distribution_sample_exponential(0x8000_0000, 2528.0, 0.1e-3, 8.0e-3);
/// assert!((median - 0.374e-3).abs() < 1e-6);
/// ```
#[inline]
#[must_use]
pub fn distribution_sample_exponential(word: u32, slope: f32, smallest: f32, largest: f32) -> f32 {
    // Fraction of the untruncated tail beyond the largest drop.
    let cut = ops::exp(-(slope * (largest - smallest)));
    let tail = cut + distribution_probability(!word) * (1.0 - cut);
    // Not clamp(): its panic at smallest > largest would be reachable.
    (smallest - ops::ln(tail) / slope).max(smallest).min(largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The words before each node agree with the positions of words.
    #[test]
    fn nodes_and_positions_agree() {
        for node in 0..DISTRIBUTION_SIDE_NODES - 1 {
            let first = words_before(node);
            let position = distribution_table_position(first);
            assert_eq!((position.index, position.fraction), (node, 0.0), "word {first}");
            let last = distribution_table_position(words_before(node + 1) - 1);
            assert_eq!(last.index, node);
            assert!(last.fraction < 1.0);
            // The other side is mirrored.
            let mirror = distribution_table_position(!first);
            assert_eq!((mirror.index, mirror.fraction), (node + DISTRIBUTION_SIDE_NODES, 0.0));
        }
        assert_eq!(words_before(DISTRIBUTION_SIDE_NODES - 1), 1 << 31);
    }

    #[test]
    fn probabilities_rise_with_the_word_and_are_exact() {
        assert_eq!(distribution_probability(0), 0.5f32 / 4_294_967_296.0);
        assert_eq!(distribution_probability(u32::MAX), 1.0 - 0.5f32 / 8_388_608.0);
        let mut before = 0.0;
        for word in (0..u32::MAX - 100_003).step_by(100_003) {
            let p = distribution_probability(word);
            assert!(p >= before, "{word}");
            // The difference to the word's own probability is at most half of a coarse step.
            let exact = (f64::from(word) + 0.5) / 4_294_967_296.0;
            assert!((f64::from(p) - exact).abs() <= 0.5 / 8_388_608.0, "{word}: {p} for {exact}");
            before = p;
        }
    }
}
