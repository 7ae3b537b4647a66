// Scalar tests that the language does not promise.
// Twin: downpour_math::ops.

// Whether x is neither infinite nor NaN. An implementation may assume that NaN never happens, so
// `x != x` is not a test; the bits are.
fn ops_is_finite(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}
