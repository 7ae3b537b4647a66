//! Ridges of water that a blade has pushed together. Twin of `shaders/wgsl/lattice/glass_ridge.wgsl`.
//!
//! Ahead of a blade the water is one ridge along it, a segment of a circle in cross-section. Left alone it stays where it
//! is: a ridge whose contact lines are pinned does not break into drops while its contact angle is below 90 degrees (Davis
//! 1980, J. Fluid Mech. 98, 225). It drains along its length as a film does, and where it is so full that Furmidge's
//! retention of its length does not hold it, it sags and becomes drops that run.

use downpour_shaders::lattice::glass::{
    GLASS_INDEX, GLASS_RIDGE, GLASS_RIDGE_FALL, GLASS_RIDGE_LEVEL, GLASS_RIDGE_PUSHED,
};
use glam::IVec2;

/// True if the progress of a cell says that its water is part of a ridge.
#[inline]
#[must_use]
pub fn glass_ridge_is(progress: u32) -> bool {
    // The progress of drops is a small number of either sign.
    progress >> 30 == GLASS_RIDGE >> 30
}

/// Cell in the middle of the ridge of a cell, `distance` / 256 cells ahead of the blade that pushed it.
#[inline]
#[must_use]
pub fn glass_ridge_center(cell: IVec2, ahead: IVec2, distance: u32) -> IVec2 {
    cell + ((ahead * distance as i32 + (1 << 21)) >> 22)
}

/// Fraction of the water of a cell that flows along its ridge to one side in a tick, in units of 1/256. `down` is how far
/// down that side is, -16384 to 16384.
#[inline]
#[must_use]
pub fn glass_ridge_flow(mass: u32, down: i32, drain: u32) -> u32 {
    let fall = ((mass.min(65535) * drain) >> 10).min(GLASS_RIDGE_FALL) as i32;
    (GLASS_RIDGE_LEVEL + ((fall * down) >> 14)).max(0) as u32
}

/// Key of water that a blade pushes: the direction of the push.
#[inline]
#[must_use]
pub fn glass_ridge_key(ahead: IVec2) -> u32 {
    let part = |c: i32| (c / 9) as u32 & 0xfff;
    (GLASS_RIDGE_PUSHED << 24) | (part(ahead.y) << 12) | part(ahead.x)
}

/// Direction of a push from its key.
#[inline]
#[must_use]
pub fn glass_ridge_ahead(key: u32) -> IVec2 {
    let word = key & GLASS_INDEX;
    IVec2::new((word << 20) as i32 >> 20, (word << 8) as i32 >> 20) * 9
}
