// Ridges of water that a blade has pushed together.
//
// Ahead of a blade the water is one ridge along it, a segment of a circle in cross-section. Left alone it stays where it
// is: a ridge whose contact lines are pinned does not break into drops while its contact angle is below 90 degrees (Davis
// 1980, J. Fluid Mech. 98, 225). It drains along its length as a film does, and where it is so full that Furmidge's
// retention of its length does not hold it, it sags and becomes drops that run.
// Twin: downpour_lattice::glass::ridge.

// True if the progress of a cell says that its water is part of a ridge.
fn glass_ridge_is(progress: u32) -> bool {
    // The progress of drops is a small number of either sign.
    return progress >> 30u == GLASS_RIDGE >> 30u;
}

// Cell in the middle of the ridge of a cell, `distance` / 256 cells ahead of the blade that pushed it.
fn glass_ridge_center(cell: vec2i, ahead: vec2i, distance: u32) -> vec2i {
    return cell + ((ahead * i32(distance) + (1 << 21u)) >> vec2u(22u));
}

// Fraction of the water of a cell that flows along its ridge to one side in a tick, in units of 1/256. `down` is how far
// down that side is, -16384 to 16384.
fn glass_ridge_flow(mass: u32, down: i32, drain: u32) -> u32 {
    let fall = i32(min((min(mass, 65535u) * drain) >> 10u, GLASS_RIDGE_FALL));
    return u32(max(GLASS_RIDGE_LEVEL + ((fall * down) >> 14u), 0));
}

// Key of water that a blade pushes: the direction of the push.
fn glass_ridge_key(ahead: vec2i) -> u32 {
    let part = vec2u(ahead / 9) & vec2u(0xfffu);
    return (GLASS_RIDGE_PUSHED << 24u) | (part.y << 12u) | part.x;
}

// Direction of a push from its key.
fn glass_ridge_ahead(key: u32) -> vec2i {
    let word = key & GLASS_INDEX;
    return vec2i(i32(word << 20u) >> 20u, i32(word << 8u) >> 20u) * 9;
}
