//! Motion of a drop in the wind during a step, and its bounce. Twin of `shaders/wgsl/sim/motion.wgsl`.
//!
//! The slip between drop and air relaxes: across the fall with v / g, along it with v / 2g, where v is the terminal
//! speed ([`downpour_drop::fall_speed::relaxation`]). In a constant wind a step of any length is exact. Rousseau 2008
//! instead averages the velocity with the wind, once per step, so that its drops depend on the frame rate.

use downpour_drop::fall_speed::{TerminalSpeed, fall_speed_relaxation};
use downpour_math::ops;
use downpour_shaders::sim::step::{
    MOTION_DIAMETER_STEP, MOTION_MIN_RELAXATION, MOTION_TABLE_LAST, MOTION_TABLE_PER_METER,
};
use glam::Vec3;

/// Result of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionStep {
    /// Velocity after the step, m/s.
    pub velocity: Vec3,
    /// Displacement of the drop, m.
    pub displacement: Vec3,
}

/// Diameter from its 16 bits, m.
#[must_use]
pub fn motion_diameter(bits: u32) -> f32 {
    bits as f32 * MOTION_DIAMETER_STEP
}

/// Diameter in 16 bits, to nearest.
#[must_use]
pub fn motion_diameter_bits(diameter: f32) -> u32 {
    (diameter / MOTION_DIAMETER_STEP + 0.5).clamp(0.0, 65_535.0) as u32
}

/// Index of a diameter in the table of terminal speeds: between this entry and the next.
#[must_use]
pub fn motion_table_entry(diameter: f32) -> u32 {
    let position = (diameter * MOTION_TABLE_PER_METER).clamp(0.0, MOTION_TABLE_LAST as f32);
    (position as u32).min(MOTION_TABLE_LAST - 1)
}

/// Terminal speed between two entries of the table, m/s.
#[must_use]
pub fn motion_table_speed(lower: f32, upper: f32, diameter: f32) -> f32 {
    let position = (diameter * MOTION_TABLE_PER_METER).clamp(0.0, MOTION_TABLE_LAST as f32);
    let fraction = position - motion_table_entry(diameter) as f32;
    lower + (upper - lower) * fraction
}

/// Table of terminal speeds, m/s. Beyond the law's range it keeps the last speed.
#[must_use]
pub fn motion_table(law: &TerminalSpeed) -> Vec<f32> {
    let mut speeds = Vec::with_capacity(MOTION_TABLE_LAST as usize + 1);
    let mut last = 0.0;
    for entry in 0..=MOTION_TABLE_LAST {
        let diameter = f64::from(entry) / f64::from(MOTION_TABLE_PER_METER);
        last = law.at(diameter).map_or(last, |speed| speed as f32);
        speeds.push(last);
    }
    speeds
}

/// Velocity of a drop that is at rest in the surrounding air.
#[must_use]
pub fn motion_settled(wind: Vec3, speed: f32) -> Vec3 {
    Vec3::new(wind.x, wind.y - speed, wind.z)
}

/// A step of `time` seconds by relaxation of the slip.
#[must_use]
pub fn motion_relax(velocity: Vec3, wind: Vec3, speed: f32, time: f32) -> MotionStep {
    let settled = motion_settled(wind, speed);
    let slip = velocity - settled;
    let [along, across] = fall_speed_relaxation(speed).map(|t| t.max(MOTION_MIN_RELAXATION));
    // Along the fall the slip relaxes twice as fast.
    let left = ops::exp(-time / across);
    let stay = Vec3::new(left, left * left, left);
    let reach = Vec3::new(across, along, across) * (1.0 - stay);
    MotionStep { velocity: settled + slip * stay, displacement: settled * time + slip * reach }
}

/// A step as Rousseau 2008, 5.1.2: the mean of the velocity and its equilibrium with air and gravity.
#[must_use]
pub fn motion_average(velocity: Vec3, wind: Vec3, speed: f32, time: f32) -> MotionStep {
    let mean = 0.5 * (velocity + motion_settled(wind, speed));
    MotionStep { velocity: mean, displacement: mean * time }
}

/// Velocity after a bounce off a surface with unit normal `normal`: the fraction `restitution` of the normal component
/// is reflected, the fraction `grip` of the tangential component is lost.
#[must_use]
pub fn motion_bounce(velocity: Vec3, normal: Vec3, restitution: f32, grip: f32) -> Vec3 {
    let into = velocity.dot(normal);
    let past = velocity - normal * into;
    past * (1.0 - grip) - normal * (into * restitution)
}

/// Terminal speed of a diameter by the table, m/s.
pub(crate) fn speed_of(speeds: &[f32], diameter: f32) -> f32 {
    let entry = motion_table_entry(diameter) as usize;
    let at = |k: usize| speeds.get(k).copied().unwrap_or(0.0);
    motion_table_speed(at(entry), at(entry + 1), diameter)
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_drop::air::Air;
    use downpour_drop::fall_speed::FallSpeedModel;

    #[test]
    fn the_table_is_the_law() {
        let law = TerminalSpeed::new(FallSpeedModel::Beard1976, &Air::standard());
        let table = motion_table(&law);
        for k in 1..2000 {
            let diameter = 0.1e-3 + 6.85e-3 * f64::from(k) / 2000.0;
            let bits = motion_diameter_bits(diameter as f32);
            let coded = motion_diameter(bits);
            assert!((f64::from(coded) - diameter).abs() < 0.71e-7, "{diameter}");
            let entry = motion_table_entry(coded) as usize;
            let found = motion_table_speed(table[entry], table[entry + 1], coded);
            let expected = law.at(diameter).unwrap();
            assert!(
                (f64::from(found) - expected).abs() < 2.5e-3 * expected,
                "{diameter}: {found}, {expected}"
            );
        }
    }

    /// Constant wind: many short steps are one long step, and both agree with the exponential law.
    #[test]
    fn steps_of_any_length_agree() {
        let (wind, speed) = (Vec3::new(7.0, 0.5, -3.0), 6.5);
        let one = motion_relax(Vec3::ZERO, wind, speed, 1.2);
        for steps in [36, 72, 288] {
            let (mut velocity, mut moved) = (Vec3::ZERO, Vec3::ZERO);
            for _ in 0..steps {
                let step = motion_relax(velocity, wind, speed, 1.2 / steps as f32);
                velocity = step.velocity;
                moved += step.displacement;
            }
            assert!((velocity - one.velocity).length() < 2.0e-5, "{steps}: {velocity}");
            assert!((moved - one.displacement).length() < 5.0e-5, "{steps}: {moved}");
        }
        let left = ops::f64::exp(-1.2 * 9.80665 / 6.5);
        assert!((f64::from(one.velocity.x) - 7.0 * (1.0 - left)).abs() < 1.0e-5);
    }

    #[test]
    fn the_papers_average_depends_on_the_frame_rate() {
        let after = |steps: u32| {
            (0..steps)
                .fold(Vec3::ZERO, |v, _| motion_average(v, Vec3::X * 10.0, 6.5, 0.1 / steps as f32).velocity)
        };
        assert!((after(3).x - after(24).x).abs() > 1.0);
    }

    #[test]
    fn a_bounce_turns_the_normal_part_round() {
        let after = motion_bounce(Vec3::new(3.0, -8.0, 0.0), Vec3::Y, 0.25, 0.5);
        assert_eq!(after, Vec3::new(1.5, 2.0, 0.0));
    }
}
