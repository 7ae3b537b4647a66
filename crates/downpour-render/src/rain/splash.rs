//! Masks of splashes: their crowns at stages, seen from elevations.

use std::sync::{Arc, Mutex, PoisonError};

use downpour_mask::{ClosedMesh, Mask, MaskError, View, trace_model_views};
use downpour_shaders::render::rain::{DROPS_ELEVATIONS, PROJECT_SPLASH_TOP, PROJECT_SPLASHES};
use downpour_shaders::sim::splash::SPLASH_RISE_SHARE;
use rayon::prelude::*;

use super::masks::options;

/// Masks of each stage, one per elevation.
type SplashMasks = Arc<Vec<Vec<Mask>>>;

/// The masks of the last refractive index: they take a second to trace.
static LAST: Mutex<Option<(f64, SplashMasks)>> = Mutex::new(None);

/// Masks of splashes for a refractive index: of each stage those of all elevations, from level to straight above. Lengths are in
/// largest radii of the crown, the middle of its height is in the middle of the mask.
///
/// # Errors
/// [`MaskError::OutOfRange`] for an invalid index.
pub(super) fn masks(refractive_index: f64) -> Result<SplashMasks, MaskError> {
    let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((index, masks)) = last.as_ref()
        && *index == refractive_index
    {
        return Ok(Arc::clone(masks));
    }
    let above = f64::from(DROPS_ELEVATIONS - 1);
    let views = (0..DROPS_ELEVATIONS)
        .map(|k| View::from_elevation(f64::from(k) / above * std::f64::consts::FRAC_PI_2))
        .collect::<Result<Vec<View>, _>>()?;
    let masks = (0..PROJECT_SPLASHES).into_par_iter().map(|row| {
        let mesh = ClosedMesh::crown(stage(f64::from(row)))?;
        trace_model_views(&mesh, &options(View::SIDE, refractive_index), &views)
    });
    let masks = Arc::new(masks.collect::<Result<Vec<_>, _>>()?);
    *last = Some((refractive_index, Arc::clone(&masks)));
    Ok(masks)
}

/// Stage of a row of the masks of splashes.
fn stage(row: f64) -> f64 {
    let (top, rise) = (f64::from(PROJECT_SPLASH_TOP), f64::from(SPLASH_RISE_SHARE));
    if row <= top {
        return row / top * rise;
    }
    rise + (1.0 - rise) * (row - top) / (f64::from(PROJECT_SPLASHES - 1) - top)
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_math::ops::f64 as ops;
    use glam::Vec3;

    #[test]
    fn rows_are_stages_in_order() {
        let stages: Vec<f64> = (0..PROJECT_SPLASHES).map(|row| stage(f64::from(row))).collect();
        assert!(stages.is_sorted() && stages[0] == 0.0 && stages.last() == Some(&1.0), "{stages:?}");
        assert_eq!(stages[3], 0.125);
    }

    /// The light of a lamp that a splash shows where it bends light as a sphere does, over the outline of a sphere: by Snell's law.
    #[test]
    fn a_sphere_shows_as_much_light_as_its_mean() {
        use crate::rain::drops::drops_bent;
        let steps = 4000;
        let of = |k: u32| {
            let across = ((f64::from(k) + 0.5) / f64::from(steps)).sqrt();
            let bends = 2.0 * (ops::asin(across) - ops::asin(across / 1.333));
            f64::from(drops_bent(Vec3::new(ops::sin(bends) as f32, 0.0, -ops::cos(bends) as f32)))
        };
        let mean = (0..steps).map(of).sum::<f64>() / f64::from(steps);
        assert!((mean - 1.0).abs() < 0.05, "{mean}");
        assert_eq!(drops_bent(Vec3::NEG_Z), 0.0);
    }

    #[test]
    fn a_crown_lets_through_and_reflects_all_light() {
        let masks = masks(1.333).expect("masks");
        assert_eq!(masks.len(), PROJECT_SPLASHES as usize);
        for mask in masks.iter().flatten() {
            let covered = mask.texels.iter().filter(|texel| texel.coverage > 0.0);
            for texel in covered.clone() {
                let sum = texel.transmittance + texel.internal_transmittance + texel.reflectance(1.333);
                assert!((0.0..=1.001).contains(&sum), "{sum}");
            }
            assert!(covered.count() > 20, "{:?} {}", mask.view, mask.half_extent);
            assert!((0.2..2.0).contains(&mask.half_extent), "{}", mask.half_extent);
        }
    }
}
