//! Negative controls: runs that have to fail. A comparison that cannot go red proves nothing.

use crate::compare::{Cpu, MIN_SCALE, compare};
use crate::function::Run;
use crate::signature::WordKind;
use crate::tolerance::Tol;

/// Damages the CPU side of a passing run in ways that the comparer has to see.
///
/// # Errors
/// The damage that went unseen.
pub fn must_go_red(run: &Run, tol: &Tol) -> Result<(), String> {
    let per_call = run.kinds.len();
    // As many calls as a tolerance for outliers could hide, and one more.
    let calls = run.cpu.0.len() / per_call;
    let enough = ((tol.outliers * run.cpu.0.len() as f64) as usize + 1).min(calls);
    // Each output on its own: a case must not be blind in one component.
    for component in 0..per_call {
        let mut damaged = run.cpu.clone();
        let mut hit = 0;
        for call in 0..calls {
            let word = &mut damaged.0[call * per_call + component];
            *word = flip(*word, run.kinds[component], tol);
            hit += 1;
            if hit == enough {
                break;
            }
        }
        if compare(&damaged, &run.gpu, &run.kinds, tol).failure.is_none() {
            return Err(format!("a damaged component {component} in {enough} calls went unseen"));
        }
    }
    // Other inputs: the results of the next call in place of this one's.
    let mut shifted = run.cpu.0.clone();
    shifted.rotate_left(per_call);
    if shifted != run.cpu.0 && compare(&Cpu(shifted), &run.gpu, &run.kinds, tol).failure.is_none() {
        return Err("the results of other inputs passed as right".to_owned());
    }
    if run.cpu.0.chunks(per_call).all(|c| c == &run.cpu.0[..per_call]) {
        return Err("all calls give the same result: the domains are too narrow".to_owned());
    }
    Ok(())
}

/// The lowest bit whose change is outside the tolerance.
fn flip(word: u32, kind: WordKind, tol: &Tol) -> u32 {
    if kind == WordKind::Integer {
        return word ^ 1;
    }
    let before = f32::from_bits(word);
    for bit in 0..31 {
        let after = f32::from_bits(word ^ (1 << bit));
        let difference = (f64::from(after) - f64::from(before)).abs();
        let outside = difference > 2.0 * tol.abs
            && difference > 2.0 * tol.rel * f64::from(before).abs().max(MIN_SCALE)
            && crate::compare::ulp_distance(before, after) > 2 * tol.ulp;
        if after.is_finite() && outside {
            return after.to_bits();
        }
    }
    f32::INFINITY.to_bits()
}
