//! Waves of what moves through puddles: where they get to, and what makes none.

use downpour_lattice::puddle::PuddleForm;
use downpour_trace::puddle::{Ground, PuddleLook, PuddleMap, WakeRows, Wakes};
use glam::{Vec2, Vec3};

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// Depth of the water, m.
const DEPTH_M: f32 = 0.01;

/// Speed of its longest waves, sqrt(g h), m/s.
const WAVES_M_S: f32 = 0.3132;

/// A pool of 12 x 4 m, its long edge along x, turned about its middle; beyond x = `shore` is land.
fn pool(turn: f32, shore: f32) -> Vec<(PuddleMap, PuddleLook)> {
    let ground = Ground { middle: Vec3::new(1.0, 0.2, -2.0), size: Vec2::new(12.0, 4.0), turn, reach: 0.3 };
    let size = [240, 80];
    let cell = |i: usize| {
        let x = (i % size[0]) as f32 * 0.05 - 6.0;
        [0.0, 0.0, if x < shore { DEPTH_M } else { -0.01 }, 1.0]
    };
    vec![(
        PuddleMap { ground, size, cells: (0..size[0] * size[1]).map(cell).collect(), flow: None },
        PuddleLook::default(),
    )]
}

/// A plate of 0.2 x 0.2 m with its middle at a place along the pool's axes, at a height over its ground.
fn plate(turn: f32, along: f32, height: f32) -> Vec<[Vec3; 3]> {
    let axis = Vec2::from_angle(turn);
    let at = |x: f32, y: f32| {
        let flat = axis.rotate(Vec2::new(along + x, y));
        Vec3::new(1.0 + flat.x, 0.2 + height, -2.0 + flat.y)
    };
    let [a, b, c, d] = [at(-0.1, -0.1), at(0.1, -0.1), at(0.1, 0.1), at(-0.1, 0.1)];
    vec![[a, b, c], [a, c, d]]
}

/// Square of the slope at a place along the pool's axes, m from its middle.
fn square(rows: &WakeRows, along: f32, across: f32) -> f32 {
    let cell = |at: f32, half: f32| ((at + half) / rows.cell_m) as usize;
    let slope = rows.slopes[cell(across, 2.0) * rows.size[0] + cell(along, 6.0)];
    slope[0] * slope[0] + slope[1] * slope[1]
}

/// Waves of a plate that goes along the middle from x = -5 m at time 0 with a speed, at a time.
fn after(
    speed: f32,
    turn: f32,
    height: f32,
    times: &[f64],
) -> Result<Vec<WakeRows>, Box<dyn std::error::Error>> {
    let puddles = pool(turn, 7.0);
    let mut wakes = Wakes::new(PuddleForm::GravityCapillary);
    for &time in times {
        wakes.advance(time, &puddles, |time_s, _| {
            plate(turn, -5.0 + speed * time_s.max(0.0) as f32, height)
        })?;
    }
    Ok(wakes.rows(&puddles))
}

/// What is faster than waves has them in a wedge behind it, whose sine is that of Mach's: c / v.
#[test]
fn a_wake_is_a_wedge_of_machs_angle() -> Outcome {
    for (speed, turn) in [(1.5f32, 0.0), (1.0, 0.7)] {
        let time = 9.0 / speed;
        let rows = after(speed, turn, 0.0, &[f64::from(time)])?;
        let [rows] = rows.as_slice() else { return Err(format!("{} puddles", rows.len()).into()) };
        let most = rows
            .slopes
            .iter()
            .map(|slope| (slope[0] * slope[0] + slope[1] * slope[1]).sqrt())
            .fold(0.0, f32::max);
        assert!(most > 0.01, "{most}");
        let edge = |behind: f32| {
            let steps = (0..190u8).rev().map(|k| 0.01 * f32::from(k));
            let mut out = steps.filter(|&across| {
                [across, -across]
                    .iter()
                    .any(|&across| square(rows, 4.0 - behind, across).sqrt() > 0.03 * most)
            });
            out.next().unwrap_or(0.0)
        };
        // Waves from both ends of the way are as far from it as they have run, across the wedge's side.
        let sine = WAVES_M_S / speed;
        let expected = sine / (1.0 - sine * sine).sqrt();
        let found = (edge(3.0) - edge(1.0)) / 2.0;
        assert!((found / expected - 1.0).abs() < 0.2, "{speed} m/s: {found} for {expected}");
        // Nothing is before it, and nothing at the sides of where it is.
        assert!(square(rows, 4.6, 0.0) == 0.0 || square(rows, 4.6, 0.0).sqrt() < 0.01 * most);
        assert!(square(rows, 3.8, 1.2).sqrt() < 0.01 * most);
    }
    Ok(())
}

/// What stands still, what is over the water, and what is elsewhere makes no waves; a slow body makes lower ones than a fast one.
#[test]
fn only_what_moves_through_the_water_makes_waves() -> Outcome {
    assert!(after(0.0, 0.0, 0.0, &[2.0])?.is_empty());
    assert!(after(1.0, 0.0, 0.02, &[2.0])?.is_empty());
    let puddles = pool(0.0, 7.0);
    let mut wakes = Wakes::new(PuddleForm::GravityCapillary);
    wakes.advance(2.0, &puddles, |time_s, _| {
        let far = Vec3::new(0.0, 0.0, 3.0);
        plate(0.0, time_s as f32, 0.0).into_iter().map(|triangle| triangle.map(|at| at + far)).collect()
    })?;
    assert!(wakes.rows(&puddles).is_empty());
    let mean = |speed: f32| -> Result<f32, Box<dyn std::error::Error>> {
        let rows = after(speed, 0.0, 0.0, &[f64::from(2.0 / speed)])?;
        Ok(rows[0].slopes.iter().map(|slope| slope[2]).sum())
    };
    let [slow, fast] = [mean(0.1)?, mean(2.0)?];
    assert!(slow > 0.0 && slow < 0.3 * fast, "{slow} {fast}");
    Ok(())
}

/// Waves at a time do not depend on the times before at which they were asked for, and go away after the body.
#[test]
fn waves_are_a_function_of_time() -> Outcome {
    let at_once = after(1.2, 0.3, 0.0, &[3.0])?;
    let by_frames: Vec<f64> = (1..=90).map(|k| f64::from(k) / 30.0).collect();
    assert_eq!(at_once, after(1.2, 0.3, 0.0, &by_frames)?);
    // Backward, and far forward: anew.
    assert_eq!(at_once, after(1.2, 0.3, 0.0, &[4.0, 3.0])?);
    assert!(after(1.2, 0.3, 0.0, &[3.0, 60.0])?.is_empty());
    Ok(())
}

/// Waves stay in the water: land beyond a shore is still.
#[test]
fn land_is_still() -> Outcome {
    let puddles = pool(0.0, 2.0);
    let mut wakes = Wakes::new(PuddleForm::GravityCapillary);
    wakes.advance(6.0, &puddles, |time_s, _| plate(0.0, -3.0 + 1.5 * time_s.max(0.0) as f32, 0.0))?;
    let rows = wakes.rows(&puddles);
    let beyond =
        |x: f32| (0..70u8).map(|k| square(&rows[0], x, 0.05 * f32::from(k) - 1.75)).fold(0.0, f32::max);
    assert!(beyond(1.5) > 0.0 && beyond(2.3) == 0.0, "{} {}", beyond(1.5), beyond(2.3));
    Ok(())
}
