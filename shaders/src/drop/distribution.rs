//! `wgsl/drop/distribution.wgsl`. Twin: `downpour_drop::distribution`.

use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&DISTRIBUTION_CONSTANTS, &DISTRIBUTION];

/// Sampling of diameters from a table of quantiles or from the exponential law. Twin: `downpour_drop::distribution`.
pub static DISTRIBUTION: Module = Module {
    path: "drop/distribution.wgsl",
    wgsl: include_str!("../../wgsl/drop/distribution.wgsl"),
    uses: &[&DISTRIBUTION_CONSTANTS],
};

shared_constants! {
    /// Layout of the table of quantiles.
    DISTRIBUTION_CONSTANTS at "drop/distribution constants" {
        /// Each octave of the probability of a tail is split into 2 to this power cells.
        DISTRIBUTION_CELL_BITS: u32 = 6;
        /// Nodes of one tail: 128 + 24 * 64 cells and the last edge.
        DISTRIBUTION_SIDE_NODES: u32 = 1665;
        /// 2^-32: the probability of one word.
        DISTRIBUTION_WORD_STEP: f32 = 2.3283064e-10;
        /// 2^-23: the spacing of probabilities that are not rare.
        DISTRIBUTION_COARSE_STEP: f32 = 1.1920929e-7;
        /// 2^22: words below it are rare and have separate nodes.
        DISTRIBUTION_RARE_WORDS: u32 = 4194304;
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn steps_are_powers_of_two() {
        assert_eq!(super::DISTRIBUTION_WORD_STEP.to_bits(), (127 - 32) << 23);
        assert_eq!(super::DISTRIBUTION_COARSE_STEP.to_bits(), (127 - 23) << 23);
        assert_eq!(super::DISTRIBUTION_RARE_WORDS, 1 << 22);
        let cells = 1 << super::DISTRIBUTION_CELL_BITS;
        assert_eq!(
            super::DISTRIBUTION_SIDE_NODES,
            2 * cells + (31 - 1 - super::DISTRIBUTION_CELL_BITS) * cells + 1
        );
    }
}
