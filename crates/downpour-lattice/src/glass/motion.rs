//! Motion of a drop: forces, friction, and the choice among the cells ahead of it (Tatarchuk & Isidoro 2006, section
//! 5). Twin of `shaders/wgsl/lattice/glass_motion.wgsl`.
//!
//! Velocities are integers: 16384 is one cell per tick. Directions are octants: 0 along +x, then by eighths of a turn
//! toward +y, which is down the pane.

use downpour_shaders::lattice::glass::GLASS_CELL;
use glam::{IVec2, UVec2, UVec3};

use super::size::{glass_size_class, glass_size_floor};

/// Integer part of the square root of a number below 2^31.
#[inline]
#[must_use]
pub fn glass_motion_root(n: u32) -> u32 {
    // The root of f32 may be off by one; the integers correct it.
    let mut root = (n as f32).sqrt() as u32;
    while root * root > n {
        root -= 1;
    }
    while (root + 1) * (root + 1) <= n {
        root += 1;
    }
    root
}

/// Length of a vector whose components are below 2^15.
#[inline]
#[must_use]
pub fn glass_motion_length(v: IVec2) -> u32 {
    glass_motion_root((v.x * v.x + v.y * v.y) as u32)
}

/// Packs a velocity into a word.
#[inline]
#[must_use]
pub fn glass_motion_pack(v: IVec2) -> u32 {
    (v.x as u32 & 0xffff) | ((v.y as u32) << 16)
}

/// Unpacks a velocity from a word.
#[inline]
#[must_use]
pub fn glass_motion_unpack(word: u32) -> IVec2 {
    IVec2::new((word << 16) as i32 >> 16, word as i32 >> 16)
}

/// Octant of a vector below 2^15.
#[inline]
#[must_use]
pub fn glass_motion_octant(v: IVec2) -> u32 {
    let size = v.abs();
    // tan(22.5 degrees) = 106 / 256.
    if 256 * size.x.min(size.y) > 106 * size.x.max(size.y) {
        return match (v.x > 0, v.y > 0) {
            (true, true) => 1,
            (false, true) => 3,
            (false, false) => 5,
            (true, false) => 7,
        };
    }
    if size.x > size.y {
        return if v.x > 0 { 0 } else { 4 };
    }
    if v.y >= 0 { 2 } else { 6 }
}

/// Offset of the next cell along an octant.
#[inline]
#[must_use]
pub fn glass_motion_offset(octant: u32) -> IVec2 {
    let o = octant & 7;
    let x = i32::from(o == 7 || o < 2) - i32::from(o > 2 && o < 6);
    let y = i32::from(o > 0 && o < 4) - i32::from(o > 4);
    IVec2::new(x, y)
}

/// Component of the unit vector along an octant, in units of 1/256.
#[inline]
#[must_use]
pub fn glass_motion_unit(octant: u32) -> i32 {
    if octant & 1 == 1 { 181 } else { 256 }
}

/// Velocity after a tick: driven, slowed by friction that never reverses it and by the viscosity of the water, and
/// limited to one cell per tick.
#[inline]
#[must_use]
pub fn glass_motion_slide(v: IVec2, drive: IVec2, hold: u32, slow: u32) -> IVec2 {
    let driven = (v + drive).clamp(IVec2::splat(-32767), IVec2::splat(32767));
    let size = glass_motion_length(driven);
    if size <= hold {
        return IVec2::ZERO;
    }
    let left = driven - driven * hold as i32 / size as i32;
    let slowed = left * slow as i32 / GLASS_CELL;
    let speed = glass_motion_length(slowed);
    if speed > GLASS_CELL as u32 {
        return slowed * GLASS_CELL / speed as i32;
    }
    slowed
}

/// Weight of a cell in the random choice: the fourth power of the velocity's fraction along it, times the attraction of
/// affinity, times that of wetness. At most 2^14.
#[inline]
#[must_use]
pub fn glass_motion_weight(v: IVec2, octant: u32, affinity: u32, wetness: u32, pull: UVec2) -> u32 {
    let step = glass_motion_offset(octant);
    let size = glass_motion_length(v).max(1) as i32;
    let along = ((v.x * step.x + v.y * step.y) * glass_motion_unit(octant) / size).clamp(0, 256) as u32;
    let squared = (along * along) >> 8;
    let grip = (64 + ((affinity * pull.x) >> 4)).min(1023);
    let wet = (256 + ((wetness * pull.y) >> 4)).min(2047);
    (((squared * squared) >> 8) * grip * wet) >> 15
}

/// Chooses one of three by a random word and their weights (at most 2^14 each); 3 if all weights are 0.
#[inline]
#[must_use]
pub fn glass_motion_choose(weights: UVec3, word: u32) -> u32 {
    let sum = weights.x + weights.y + weights.z;
    if sum == 0 {
        return 3;
    }
    let at = ((word >> 16) * sum) >> 16;
    if at < weights.x {
        0
    } else if at < weights.x + weights.y {
        1
    } else {
        2
    }
}

/// Turns a velocity by a quarter of the difference toward an octant.
#[inline]
#[must_use]
pub fn glass_motion_turn(v: IVec2, octant: u32) -> IVec2 {
    let size = glass_motion_length(v) as i32;
    let along = glass_motion_offset(octant) * ((size * glass_motion_unit(octant)) / 256);
    (v * 3 + along) / 4
}

/// Velocity of a drop after merging with drops at rest.
#[inline]
#[must_use]
pub fn glass_motion_merged(v: IVec2, class_before: u32, mass: u32) -> IVec2 {
    if glass_size_class(mass) <= class_before {
        return v;
    }
    let fraction = (glass_size_floor(class_before) << 10) / glass_size_floor(glass_size_class(mass));
    v * fraction as i32 / 1024
}

/// Wetness of the glass where water moved at `stamp` (0: never), 0 to 255.
#[inline]
#[must_use]
pub fn glass_motion_wetness(clock: u32, stamp: u32, life: u32) -> u32 {
    if stamp == 0 {
        return 0;
    }
    let age = ((clock - clock.min(stamp)) >> 6).min(life);
    255 - age * 255 / life
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_whole_parts() {
        for n in (0..46_340u32).flat_map(|k| [k * k, (k * k).saturating_sub(1), k * k + k]) {
            let root = glass_motion_root(n);
            assert!(root * root <= n && (root + 1) * (root + 1) > n, "{n}: {root}");
        }
        assert_eq!(glass_motion_root(i32::MAX as u32), 46_340);
    }

    #[test]
    fn octants_are_nearest() {
        for x in -40..=40 {
            for y in -40..=40 {
                if (x, y) == (0, 0) {
                    continue;
                }
                let v = IVec2::new(x, y);
                let along = |o| glass_motion_offset(o).dot(v) * glass_motion_unit(o);
                let best = (0..8).map(along).max().unwrap();
                let found = along(glass_motion_octant(v));
                assert!(f64::from(best - found) <= 0.005 * f64::from(best), "{v}: {found} of {best}");
            }
        }
    }

    #[test]
    fn friction_never_turns_a_drop_back() {
        let v = glass_motion_slide(IVec2::new(300, -400), IVec2::ZERO, 499, GLASS_CELL as u32);
        assert!(v.x >= 0 && v.y <= 0 && glass_motion_length(v) <= 2, "{v}");
        assert_eq!(glass_motion_slide(IVec2::new(300, -400), IVec2::ZERO, 500, 16384), IVec2::ZERO);
        let fast = glass_motion_slide(IVec2::splat(16384), IVec2::splat(16384), 0, 16384);
        assert!(glass_motion_length(fast) <= GLASS_CELL as u32);
    }
}
