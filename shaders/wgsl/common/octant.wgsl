// An angle of the first octant from its tangent.
// Twin: downpour_math::octant.

// The angle whose tangent is t, in turns; t is in [0, 1].
fn octant_turns(t: f32) -> f32 {
    let s = t * t;
    var sum = OCTANT_TURN[8];
    sum = sum * s + OCTANT_TURN[7];
    sum = sum * s + OCTANT_TURN[6];
    sum = sum * s + OCTANT_TURN[5];
    sum = sum * s + OCTANT_TURN[4];
    sum = sum * s + OCTANT_TURN[3];
    sum = sum * s + OCTANT_TURN[2];
    sum = sum * s + OCTANT_TURN[1];
    sum = sum * s + OCTANT_TURN[0];
    return sum * t;
}
