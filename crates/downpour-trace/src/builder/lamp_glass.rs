//! The glass of lamps: small surfaces that shine beside a lamp are its body, and do not light the scene a second time.

use std::collections::BTreeMap;

use downpour_bvh::BvhTriangle;
use downpour_render::light::{LightSource, light_weight};
use glam::Vec3;

/// Maximum distance of a lamp's glass from its light, m.
const REACH_M: f32 = 0.5;

/// Maximum area of a triangle of a lamp's glass, m^2: a larger one is a sign or a window.
const MAX_GLASS_M2: f32 = 0.25;

/// A lamp that is not parallel.
struct Lamp {
    position: Vec3,
    radius: f32,
    intensity: f32,
}

/// The lamp of a light, unless that is parallel.
fn lamp(light: &LightSource) -> Option<Lamp> {
    match *light {
        LightSource::Directional { .. } => None,
        LightSource::Point { position, radius, intensity, .. }
        | LightSource::Spot { position, radius, intensity, .. } => {
            Some(Lamp { position, radius, intensity: light_weight(intensity) })
        }
    }
}

/// For each of some triangles that shine, the lamp whose glass it is: the nearest within reach.
pub(super) fn owners(
    triangles: &[BvhTriangle],
    shining: &[u32],
    lights: &[LightSource],
) -> BTreeMap<u32, usize> {
    // Sorted, so that a scene of many lamps and many lit windows takes no time.
    let mut lamps: Vec<(f32, usize, Vec3)> = (0..)
        .zip(lights)
        .filter_map(|(index, light)| lamp(light).map(|lamp| (lamp.position.x, index, lamp.position)))
        .collect();
    lamps.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let owner = |&triangle: &u32| {
        let [a, b, c] = triangles[triangle as usize].corners().map(Vec3::from);
        if 0.5 * (b - a).cross(c - a).length() > MAX_GLASS_M2 {
            return None;
        }
        let middle = (a + b + c) / 3.0;
        let first = lamps.partition_point(|lamp| lamp.0 < middle.x - REACH_M);
        lamps[first..]
            .iter()
            .take_while(|lamp| lamp.0 <= middle.x + REACH_M)
            .map(|&(_, index, position)| ((position - middle).length(), index))
            .filter(|&(distance, _)| distance <= REACH_M)
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
            .map(|(_, index)| (triangle, index))
    };
    shining.iter().filter_map(owner).collect()
}

/// Radius of the sphere that is as bright as the glass of a lamp and gives the lamp's light, m: `I = pi r^2 L`; no larger than a disk of
/// the glass's area, since the light of a spot is not all from where its glass seems to shine. `glass`: mean emission and area of
/// its parts. `None` if the light has a radius of its own.
pub(super) fn radius(light: &LightSource, glass: &[(Vec3, f32)]) -> Option<f32> {
    let Lamp { radius: own, intensity, .. } = lamp(light)?;
    if own > 0.0 {
        return None;
    }
    let area: f32 = glass.iter().map(|part| part.1).sum();
    let emission: f32 = glass.iter().map(|part| light_weight(part.0) * part.1).sum::<f32>() / area;
    let radius = (intensity / (std::f32::consts::PI * emission)).sqrt();
    let disk = (area / std::f32::consts::PI).sqrt();
    radius.is_finite().then(|| radius.min(disk).min(REACH_M))
}
