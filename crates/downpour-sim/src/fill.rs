//! Initial drops of a frustum, and those after a jump of the eye: the rain at its position.

use downpour_math::rng::rng_draw;
use downpour_shaders::sim::enter::ENTER_DRAW;
use downpour_shaders::sim::step::{STEP_COUNT, STEP_COUNT_SHIFT, STEP_FALLING, VOLUME_BALL, VOLUME_INSIDE};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::SimError;
use crate::motion::motion_diameter;
use crate::plan::Plan;
use crate::poisson::poisson_at;
use crate::population::{Bin, reserve};
use crate::step::{StepDrop, StepWorld, step_word};
use crate::volume::volume_limit;

/// First dimension of the random numbers of counts.
const COUNT: u32 = 28_672;

/// Number of candidates of one work item.
const PIECE: usize = 1 << 12;

/// All drops of the frustum of a frame, at their positions in the middle of the horizon: [`StepWorld::step_begin`]
/// turns them into drops of a state.
///
/// # Errors
/// [`SimError::Memory`].
pub(crate) fn fill(plan: &Plan, world: &StepWorld<'_>) -> Result<Vec<StepDrop>, SimError> {
    let frame = world.frame;
    let bounds: Vec<[DVec3; 2]> =
        plan.bins.iter().map(|bin| plan.frustum().bounds(bin.diameters[1], bin.speeds[1])).collect();
    let counts: Vec<u32> = (0..)
        .zip(plan.bins.iter().zip(&bounds))
        .map(|(number, (bin, [low, high]))| {
            let expected = bin.density * (*high - *low).element_product();
            poisson_at(expected, frame.seed, frame.step, COUNT + number)
        })
        .collect();
    reserve(counts.iter().map(|&n| u64::from(n)).sum())?;
    let mut drops = Vec::new();
    for (number, ((bin, bounds), count)) in (0..).zip(plan.bins.iter().zip(&bounds).zip(counts)) {
        let pieces: Vec<Vec<StepDrop>> = (0..count)
            .into_par_iter()
            .chunks(PIECE)
            .map(|piece| {
                piece.into_iter().filter_map(|k| candidate(plan, world, bin, bounds, [number, k])).collect()
            })
            .collect();
        let of_bin = pieces.iter().map(Vec::len).sum();
        drops.try_reserve(of_bin).map_err(|_| SimError::memory((drops.len() + of_bin) as u64))?;
        drops.extend(pieces.into_iter().flatten());
    }
    Ok(drops)
}

/// Returns a drop, if this candidate is accepted.
fn candidate(
    plan: &Plan,
    world: &StepWorld<'_>,
    bin: &Bin,
    [low, high]: &[DVec3; 2],
    [number, k]: [u32; 2],
) -> Option<StepDrop> {
    let frame = world.frame;
    // The entry regions leave this number of each bin free: a step either fills or enters the frustum.
    let dimension = ENTER_DRAW + number * (VOLUME_BALL + 1);
    let words = rng_draw(frame.seed, k, frame.step, dimension);
    let [x, y, z, fraction] = words.map(|word| (f64::from(word) + 0.5) / 4_294_967_296.0);
    let offset = plan.frustum().offset(*low + (*high - *low) * DVec3::new(x, y, z)).as_vec3();
    let bits = u32::from(bin.code(fraction));
    let diameter = motion_diameter(bits);
    let speed = world.step_speed(diameter);
    if volume_limit(&frame.frustum, offset, diameter, speed) != VOLUME_INSIDE {
        return None;
    }
    let ahead = Vec3::from(frame.frustum.eye) + offset;
    Some(StepDrop {
        position: ahead.to_array(),
        word: step_word(bits, STEP_FALLING, k & STEP_COUNT),
        velocity: [0.0; 3],
        // Drops beyond the maximum count are distinguished by an earlier step.
        last: frame.step.wrapping_sub(k >> (32 - STEP_COUNT_SHIFT)),
    })
}
