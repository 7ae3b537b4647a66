//! Joints and weights of vertices: glTF 2.0, section 3.7.3.3.

use super::fields::single;
use super::primitives::Reading;
use crate::error::SceneError;
use crate::gltf::irregular;
use crate::scene::Primitive;
use crate::warning::{WarningKind, Warnings};
use gltf::json::mesh::{self, Semantic};
use gltf::json::validation::Checked;

/// Tolerance of the sum of weights around 1 without a warning.
const NEAR: f64 = 0.01;

/// Reads the first set. Weights are scaled to a sum of 1; a joint without weight becomes joint 0.
pub(super) fn read(
    reading: &Reading<'_>,
    json: &mesh::Primitive,
    part: &mut Primitive,
    path: &str,
    warnings: &mut Warnings,
) -> Result<(), SceneError> {
    let joints = reading.attribute(json, Semantic::Joints(0))?;
    let (Some(mut joints), Some(mut weights)) = (joints, reading.attribute(json, Semantic::Weights(0))?)
    else {
        return Ok(());
    };
    if json.attributes.contains_key(&Checked::Valid(Semantic::Joints(1))) {
        warnings.add(WarningKind::Ignored, path, || {
            "more than four joints for a vertex: only those of the first set are read".into()
        });
    }
    let mut odd = 0usize;
    while let (Some(joint), Some(weight)) = (joints.quartet()?, weights.numbers::<4>(0.0)?) {
        let element = part.joints.len();
        let wrong = |part: &f64| !(part.is_finite() && *part >= 0.0);
        if let Some(found) = weight.iter().find(|weight| wrong(weight)) {
            let path = format_args!("{path}.attributes.WEIGHTS_0");
            return Err(SceneError::bad(path, format!("{found} at element {element}"), "numbers from 0 on"));
        }
        let sum: f64 = weight.iter().sum();
        odd = odd.saturating_add(usize::from((sum - 1.0).abs() > NEAR));
        if sum > 0.0 {
            let mut used = [0u16; 4];
            for ((used, joint), weight) in used.iter_mut().zip(joint).zip(weight) {
                // Formats of joints have 16 bits at most.
                *used = if weight > 0.0 { u16::try_from(joint).unwrap_or(u16::MAX) } else { 0 };
            }
            part.joints.push(used);
            part.weights.push(weight.map(|weight| single(weight / sum)));
        } else {
            part.joints.push([0; 4]);
            part.weights.push([1.0, 0.0, 0.0, 0.0]);
        }
    }
    if odd > 0 {
        irregular(warnings, path, || {
            format!(
                "{odd} vertices whose weights do not add up to 1: scaled, or without any bound to the first joint"
            )
        });
    }
    Ok(())
}
