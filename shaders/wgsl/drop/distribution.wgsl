// Sampling of drop diameters.
//
// A drop size distribution N(D) reaches the GPU as a table of quantiles, computed in f64, or, if it is exponential
// (Marshall & Palmer, J. Meteor. 5, 165, 1948: N = N0 exp(-slope D)), as its slope. A random word of 32 bits
// becomes a diameter; a larger word gives a larger drop. The cells of the table halve with the remaining
// probability on either side of the median, down to single words, so that the rare large drops are drawn as exactly
// as the many small ones. Finding the cell needs no transcendental function: the result has the same bits on every
// device.
// Units: diameters in meters, slopes in 1/m.
// Twin: downpour_drop::distribution, which also creates the table.

// Position in the table, between the nodes `index` and `index + 1`.
struct DistributionPosition {
    index: u32,
    fraction: f32,
}

// Position of a word in the table. Nodes 0 to DISTRIBUTION_SIDE_NODES - 1 go from the smallest drop up to the
// median; the others from the largest down to the median.
fn distribution_table_position(word: u32) -> DistributionPosition {
    let upper = word >= 0x80000000u;
    // Words left on the nearer side: below 2^31.
    let left = select(word, ~word, upper);
    let leading = firstLeadingBit(left | 1u);
    let shift = max(leading, DISTRIBUTION_CELL_BITS) - DISTRIBUTION_CELL_BITS;
    let cell = (shift << DISTRIBUTION_CELL_BITS) + (left >> shift);
    // Below 2^24, and the scale is a power of two: exact.
    let rest = left & ((1u << shift) - 1u);
    let scale = bitcast<f32>((127u - shift) << 23u);
    return DistributionPosition(cell + select(0u, DISTRIBUTION_SIDE_NODES, upper), f32(rest) * scale);
}

// Interpolates a diameter between two nodes.
fn distribution_lerp(a: f32, b: f32, t: f32) -> f32 {
    return a + (b - a) * t;
}

// Maps a word to a probability in (0, 1), with all 32 bits where it is small. Exact.
fn distribution_probability(word: u32) -> f32 {
    let coarse = (f32(word >> 9u) + 0.5) * DISTRIBUTION_COARSE_STEP;
    let rare = (f32(word & (DISTRIBUTION_RARE_WORDS - 1u)) + 0.5) * DISTRIBUTION_WORD_STEP;
    return select(coarse, rare, word < DISTRIBUTION_RARE_WORDS);
}

// Draws a diameter of the exponential law between two diameters. The slope is positive.
fn distribution_sample_exponential(word: u32, slope: f32, smallest: f32, largest: f32) -> f32 {
    // Fraction of the untruncated tail beyond the largest drop.
    let cut = exp(-(slope * (largest - smallest)));
    let tail = cut + distribution_probability(~word) * (1.0 - cut);
    return clamp(smallest - log(tail) / slope, smallest, largest);
}
