// Scalar tests that WGSL does not guarantee.
// Twin: downpour_math::ops.

// True where x is neither infinite nor NaN. An implementation may assume that NaN never occurs, so `x != x` is
// not a reliable test; the bits are.
fn ops_is_finite(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}
