//! Lights (`KHR_lights_punctual`) and their nodes.

use super::fields;
use crate::error::SceneError;
use crate::gltf::guard::Spot;
use crate::gltf::irregular;
use crate::scene::{Light, LightKind};
use crate::warning::Warnings;
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

const EXTENSION: &str = "KHR_lights_punctual";

/// The largest product of color and intensity: a tenth of a millimeter from the lamp it is still within an `f32`.
const MAX_RADIANCE: f32 = 1.0e30;

/// Maximum radius of a lamp, m.
const MAX_RADIUS_M: f32 = 100.0;

/// All lights.
pub(super) fn read(document: &Spot<'_>, warnings: &mut Warnings) -> Result<Vec<Light>, SceneError> {
    let mut all = Vec::new();
    document.each(&["extensions", EXTENSION, "lights", "[]"], &mut |light| {
        all.push(one(light, warnings)?);
        Ok(())
    })?;
    Ok(all)
}

/// The light of each node.
pub(super) fn of_nodes(document: &Spot<'_>) -> Result<Vec<Option<usize>>, SceneError> {
    let mut all = Vec::new();
    document.each(&["nodes", "[]"], &mut |node| {
        let mut light = None;
        node.each(&["extensions", EXTENSION, "light"], &mut |index| {
            light = usize::try_from(index.whole()?).ok();
            Ok(())
        })?;
        all.push(light);
        Ok(())
    })?;
    Ok(all)
}

fn one(light: &Spot<'_>, warnings: &mut Warnings) -> Result<Light, SceneError> {
    let kind = light.need("type")?;
    let kind = match kind.text()? {
        "directional" => LightKind::Directional,
        "point" => LightKind::Point,
        "spot" => spot(&light.need("spot")?, warnings)?,
        _ => return Err(kind.not("\"directional\", \"point\" or \"spot\"")),
    };
    let range = fields::maybe(light, "range")?;
    if range.is_some_and(|range| range <= 0.0) {
        return Err(light.need("range")?.not("a number above 0"));
    }
    let color = fields::numbers(light, "color", [1.0; 3])?;
    if color.iter().any(|part| !(0.0..=1.0).contains(part)) {
        let spot = light.need("color")?;
        if color.iter().any(|&part| part < 0.0) {
            return Err(spot.wrong("a negative number", "numbers from 0 to 1"));
        }
        irregular(warnings, spot.trail, || "more than 1: taken as it is".into());
    }
    let intensity = fields::from(light, "intensity", 0.0, 1.0)?;
    if color.iter().any(|part| !(0.0..=MAX_RADIANCE).contains(&(part * intensity))) {
        let found = format!(
            "a color times an intensity of {:e}",
            color.iter().fold(0.0f32, |a, &b| a.max(b)) * intensity
        );
        return Err(light.wrong(found, "up to 1e30"));
    }
    let mut radius = None;
    if let Some(extras) = light.get("extras")?
        && extras.get("radius_m")?.is_some()
    {
        let found = fields::from(&extras, "radius_m", 0.0, 0.0)?;
        if found > MAX_RADIUS_M {
            return Err(extras.need("radius_m")?.not("0 to 100 m"));
        }
        radius = Some(found);
    }
    Ok(Light { name: fields::name(light)?, color: color.into(), intensity, range, radius, kind })
}

fn spot(cone: &Spot<'_>, warnings: &mut Warnings) -> Result<LightKind, SceneError> {
    let outer = fields::from(cone, "outerConeAngle", 0.0, FRAC_PI_4)?;
    if outer <= 0.0 || outer > FRAC_PI_2 {
        return Err(cone.need("outerConeAngle")?.not("above 0 and up to pi/2 (1.5708)"));
    }
    let mut inner = fields::from(cone, "innerConeAngle", 0.0, 0.0)?;
    if inner >= outer {
        irregular(warnings, cone.trail, || {
            format!("innerConeAngle {inner} is not below outerConeAngle {outer}: taken as just below")
        });
        inner = outer.next_down();
    }
    Ok(LightKind::Spot { inner, outer })
}
