//! Drip points as a device has them, in a steady wind; twin of `shaders/wgsl/sim/drip.wgsl`, whose structs have the layout of [`DripRow`] and
//! [`DripFrame`].

use bytemuck::{Pod, Zeroable};
use downpour_drop::fall_speed::fall_speed_relaxation;
use downpour_math::ops;
use downpour_shaders::drop::fall_speed::FALL_SPEED_GRAVITY;
use downpour_shaders::sim::drip::DRIP_FAR;
use downpour_shaders::sim::field::FIELD_ALWAYS;
use glam::Vec3;

/// A point that drips.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct DripRow {
    /// Position relative to the origin of the points, m.
    pub position: Vec3,
    /// Terminal speed of its drops, m/s.
    pub terminal: f32,
    /// Where the longest fall ends, relative to the same origin, m.
    pub end: Vec3,
    /// Time of that fall, s.
    pub longest: f32,
    /// Drops that are yet to leave at time 0: whole ones with a sign in two words, the high one first, and a fraction in units of 2^-32.
    pub due: [u32; 3],
    /// Drops per second, in units of 2^-shift.
    pub units: u32,
    /// Drops that will ever have left, as `due`, where the rain ends.
    pub left: [u32; 3],
    /// See `units`.
    pub shift: u32,
    /// Key of its random numbers.
    pub key: [u32; 2],
    /// Diameter of the drops that fall, m.
    pub diameter: f32,
    /// Distance of a drop's center from the point when it begins to fall, m.
    pub below: f32,
    /// Time after which a fall ends on a surface, s; `FIELD_ALWAYS`: nowhere.
    pub until: f32,
    /// Cube of the diameter of the water that hangs there before a drop leaves, m^3; 0 for drops of a jet.
    pub hanging: f32,
    /// Cube of the diameter of a drop that leaves, m^3.
    pub leaving: f32,
    /// Time constant with which the point runs dry after the rain, s; 0: the rain does not end.
    pub drain: f32,
    /// Unit normal of the surface on which a fall ends; it looks straight down where a fall ends nowhere.
    pub normal: Vec3,
    /// 0.
    pub unused: u32,
}

/// Uniforms of the search for the drops of points.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct DripFrame {
    /// Not read: a software driver makes the kernel again for each value of the first word of a block that it reads.
    pub unread: u32,
    /// Whole seconds of the time of the picture ([`FieldTime`](crate::field::chain::FieldTime)).
    pub seconds: u32,
    /// See `seconds`.
    pub fraction: u32,
    /// See `seconds`.
    pub is_before: u32,
    /// Position of the eye relative to the origin of the points, m.
    pub eye: Vec3,
    /// Number of points.
    pub points: u32,
    /// Velocity of the wind along the ground, m/s.
    pub wind: Vec3,
    /// End of the rain, s from the time of the picture.
    pub end: f32,
    /// Largest distance of a drop, m.
    pub farthest: f32,
    /// Upper bound of the speed of a drop relative to the eye, m/s.
    pub fastest: f32,
    /// 0.
    pub unused: [u32; 2],
}

/// Number of drops of a point by time: it rises with the rain, and after it by a part that decays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DripClock {
    /// Drops per second while it rains.
    pub per_s: f32,
    /// Number of drops at the time of the picture; if the rain ends before, of all that will ever have left.
    pub part: f32,
    /// End of the rain, s from the time of the picture.
    pub end: f32,
    /// Time constant of the decay, s.
    pub drain: f32,
}

impl DripClock {
    /// Number of drops that leave the point after the rain.
    #[must_use]
    pub fn drip_store(&self) -> f32 {
        self.drain * self.per_s
    }

    /// Number of drops that will have left the point in the end.
    #[must_use]
    pub fn drip_total(&self) -> f32 {
        if self.end < 0.0 {
            return self.part;
        }
        self.part + self.end * self.per_s + self.drip_store()
    }

    /// Number of drops that have left at a time, s.
    #[must_use]
    pub fn drip_reached(&self, time: f32) -> f32 {
        if time > self.end {
            return self.drip_total() - self.drip_store() * ops::exp((self.end - time) / self.drain);
        }
        if self.end < 0.0 {
            return self.part - self.drip_store() + (time - self.end) * self.per_s;
        }
        self.part + time * self.per_s
    }

    /// Time of a number of drops, s; `FIELD_ALWAYS` for more than there will be.
    #[must_use]
    pub fn drip_time(&self, drops: f32) -> f32 {
        let rest = self.drip_total() - drops;
        if rest <= 0.0 {
            return FIELD_ALWAYS;
        }
        let store = self.drip_store();
        if rest < store {
            return self.end - self.drain * ops::ln(rest / store);
        }
        if self.end < 0.0 {
            return self.end - (rest - store) / self.per_s;
        }
        (drops - self.part) / self.per_s
    }
}

/// The first drop of a point, counted from one of a number of two words, the high one first and with a sign: -`DRIP_FAR` or `DRIP_FAR`
/// where that is farther.
#[must_use]
pub fn drip_begin(number: [u32; 2]) -> i32 {
    let far = i64::from(DRIP_FAR);
    let number = (u64::from(number[0]) << 32 | u64::from(number[1])) as i64;
    (-number.clamp(-far, far)) as i32
}

/// Number of a drop that is counted from one of a number of two words, the high one first.
#[must_use]
pub fn drip_number(number: [u32; 2], drop: i32) -> [u32; 2] {
    let number = (u64::from(number[0]) << 32 | u64::from(number[1])).wrapping_add_signed(drop.into());
    [(number >> 32) as u32, number as u32]
}

/// Distance and speed of a drop of a terminal speed that has fallen from rest for a time, m and m/s.
#[must_use]
pub fn drip_rest(terminal: f32, age: f32) -> [f32; 2] {
    if terminal <= 0.0 || age <= 0.0 {
        return [0.0; 2];
    }
    let x = age * FALL_SPEED_GRAVITY / terminal;
    let square = x * x;
    // ln cosh x = x + ln(1/2 + exp(-2x) / 2), whose digits are lost where x is small.
    let ln_cosh = if x > 0.25 {
        x + ops::ln(0.5 + 0.5 * ops::exp(-2.0 * x))
    } else {
        square * (0.5 - square * (1.0 / 12.0 - square / 45.0))
    };
    [terminal * terminal / FALL_SPEED_GRAVITY * ln_cosh, terminal * ops::tanh(x.min(20.0))]
}

/// Displacement and velocity of a drop of a terminal speed that has fallen from rest for a time in a wind along the ground, m and m/s.
#[must_use]
pub fn drip_fall(terminal: f32, wind: Vec3, age: f32) -> [Vec3; 2] {
    let time = age.max(0.0);
    let [distance, speed] = drip_rest(terminal, time);
    let across = fall_speed_relaxation(terminal)[1].max(1.0e-9);
    let carried = 1.0 - ops::exp(-time / across);
    [wind * (time - across * carried) - Vec3::Y * distance, wind * carried - Vec3::Y * speed]
}

/// Diameter, m, of the water that hangs at a point at a fraction of the time between two drops, from the cubes of the whole and of what
/// leaves.
#[must_use]
pub fn drip_hanging(hanging: f32, leaving: f32, fraction: f32) -> f32 {
    ops::cbrt((hanging - leaving * (1.0 - fraction.clamp(0.0, 1.0))).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_drop::drip::Drip;
    use downpour_drop::fall_speed::fall_from_rest;

    /// The digits of f32 are enough for drops at any age.
    #[test]
    fn a_fall_in_f32_is_that_of_f64() {
        for k in 1..4000u16 {
            let (terminal, age) = (f32::from(k % 9) + 0.5, f32::from(k) * 1.0e-3);
            let [distance, speed] = drip_rest(terminal, age);
            let exact = fall_from_rest(terminal.into(), age.into());
            assert!((f64::from(distance) - exact[0]).abs() < 2.0e-6 * exact[0].max(1.0), "{terminal}, {age}");
            assert!((f64::from(speed) - exact[1]).abs() < 2.0e-6 * exact[1].max(1.0), "{terminal}, {age}");
        }
    }

    #[test]
    fn water_that_hangs_grows_as_its_volume() {
        let drip = Drip::new(1.0e-3, 10.0).unwrap();
        let cube = |diameter: f64| (diameter * diameter * diameter) as f32;
        let (hanging, leaving) = (cube(drip.hanging_diameter(1.0)), cube(drip.diameter_m));
        for k in 0..=10u16 {
            let fraction = f32::from(k) / 10.0;
            let found = f64::from(drip_hanging(hanging, leaving, fraction));
            let exact = drip.hanging_diameter(fraction.into());
            assert!((found / exact - 1.0).abs() < 1.0e-5, "{fraction}: {found} and {exact}");
        }
    }

    /// 2 drops a second up to a second after the picture or 20 s before it, then 160 of them by decay.
    #[test]
    fn times_are_the_inverse_of_numbers() {
        for (end, part, at_end) in [(1.0f32, 0.25f32, 2.25f32), (-20.0, 0.25, -159.75)] {
            let clock = DripClock { per_s: 2.0, part, end, drain: 80.0 };
            assert!((clock.drip_reached(end) - at_end).abs() < 1.0e-4);
            assert!((clock.drip_reached(end - 0.5) - (at_end - 1.0)).abs() < 1.0e-4);
            let expected = at_end + 160.0 * (1.0 - ops::exp(-1.0));
            assert!((clock.drip_reached(end + 80.0) - expected).abs() < 1.0e-4);
            assert!((clock.drip_reached(1.0e5) - (at_end + 160.0)).abs() < 1.0e-4);
            for more in [-3.0, -0.5, 0.0, 1.0, 50.0, 150.0, 159.0] {
                let drops = at_end + more;
                assert!((clock.drip_reached(clock.drip_time(drops)) - drops).abs() < 1.0e-4, "{drops}");
            }
            assert_eq!(clock.drip_time(at_end + 160.5), FIELD_ALWAYS);
        }
    }
}
