//! The impostors of a frame: billboards, and an environment map.

use std::collections::BTreeMap;
use std::f32::consts::PI;
use std::sync::Arc;

use downpour_math::color::color_luminance;
use downpour_render::RenderError;
use downpour_render::camera::Viewpoint;
use downpour_render::light::light_weight;
use downpour_render::rain::{EnvironmentFrame, RefractionForm};
use downpour_shaders::bvh::BVH_FAR;
use downpour_shaders::render::impostor::IMPOSTOR_PROBE;
use downpour_shaders::render::scene::{SCENE_ALL_OUT, SCENE_LIGHT_ROWS};
use glam::{Vec2, Vec3};

use crate::billboards::{Basis, Billboard, Impostors};
use crate::capture::trace_environment_rows;
use crate::data::{RenderFrame, SceneData};
use crate::emitter::emitter_color;
use crate::scene::SceneView;

/// Maximum number of billboards: of more, those that give most.
const MAX_BILLBOARDS: usize = 256;

/// Radius of a lamp without one, m.
const LAMP_RADIUS_M: f32 = 0.1;

/// Factor of the difference between a color and its gray: the paper's reflections "strongly saturate the dominant colors".
const SATURATION: f32 = 1.5;

/// Distance of the environment map ahead of the eye, m, and its height over the ground.
const AHEAD_M: f32 = 6.0;
const ABOVE_M: f32 = 0.3;

/// Distance that stays between that position and what stands before it, m.
const CLEARANCE_M: f32 = 0.3;

/// Height of an eye that nothing is below, m.
const EYE_HEIGHT_M: f32 = 1.6;

/// Edge of the cells within which corners of triangles count as one, m.
const SAME_CORNER_M: f32 = 1.0e-3;

/// A shining object.
#[derive(Clone, Copy, Debug)]
struct Shining {
    low: Vec3,
    high: Vec3,
    radiance: Vec3,
}

/// Finds the impostors of a scene for an eye: those of `before`, if they were found for the same.
///
/// # Errors
/// [`RenderError`] for an invalid eye.
pub fn find(
    data: &SceneData,
    viewpoint: &Viewpoint,
    edge: f32,
    before: Option<&Arc<Impostors>>,
) -> Result<Arc<Impostors>, RenderError> {
    let of = basis(data, viewpoint);
    match before.filter(|before| before.of.is_same(&of)) {
        Some(before) if before.edge.to_bits() == edge.to_bits() => return Ok(before.clone()),
        Some(before) => return Ok(Arc::new(Impostors { edge, ..Impostors::clone(before) })),
        None => {}
    }
    let eye = viewpoint.eye;
    // The environment is dry, so that it does not depend on the rain.
    let frame = RenderFrame {
        wetness: 0,
        glazing: 0,
        puddle_count: 0,
        pane: 0,
        suns_out: SCENE_ALL_OUT,
        ..RenderFrame::new(data, viewpoint, [8, 8], 1, 1, 0)?
    };
    let view = SceneView { data, frame: &frame };
    let below = data.surface_hit(eye, Vec3::NEG_Y, frame.nearest, BVH_FAR);
    let ground = eye.y - below.map_or(EYE_HEIGHT_M, |hit| hit.distance);
    let environment = environment(&view, ground, viewpoint);
    let mut found: Vec<(f32, Billboard)> = lamps(&view, ground)
        .into_iter()
        .chain(groups(data))
        .filter_map(|shining| mirrored(&view, &shining, ground))
        .map(|billboard| {
            let square = billboard.center.distance_squared(eye).max(1.0e-4);
            (light_weight(billboard.radiance) * billboard.half.element_product() / square, billboard)
        })
        .collect();
    found.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    found.truncate(MAX_BILLBOARDS);
    let mut billboards: Vec<Billboard> = found.into_iter().map(|(_, billboard)| billboard).collect();
    let from_eye = |billboard: &Billboard| billboard.center.distance_squared(eye);
    billboards.sort_by(|a, b| from_eye(b).total_cmp(&from_eye(a)));
    Ok(Arc::new(Impostors { edge, environment, billboards, of }))
}

/// The basis of the impostors of a scene for an eye.
fn basis(data: &SceneData, viewpoint: &Viewpoint) -> Basis {
    let first = data.lights as usize;
    let lights = data.table[first..first + (data.light_count * SCENE_LIGHT_ROWS) as usize].to_vec();
    Basis { nodes: data.nodes.clone(), sky: data.sky.clone(), lights, viewpoint: *viewpoint }
}

/// Environment map of a position near the ground ahead of the eye.
fn environment(view: &SceneView<'_>, ground: f32, viewpoint: &Viewpoint) -> Vec<Vec3> {
    let eye = viewpoint.eye;
    let forward = Vec3::new(viewpoint.forward.x, 0.0, viewpoint.forward.z).normalize_or_zero();
    let start = Vec3::new(eye.x, ground + ABOVE_M, eye.z);
    let blocked = view.data.surface_hit(start, forward, view.frame.nearest, AHEAD_M + CLEARANCE_M);
    let ahead = blocked.map_or(AHEAD_M, |hit| (hit.distance - CLEARANCE_M).max(0.0));
    let mut frame = *view.frame;
    frame.camera.eye = start + forward * ahead;
    let map = EnvironmentFrame {
        form: RefractionForm::Direction,
        size: IMPOSTOR_PROBE,
        grid: 2,
        right: Vec3::X,
        up: Vec3::Y,
        forward: Vec3::NEG_Z,
        texel_angle: (4.0 * PI).sqrt() / IMPOSTOR_PROBE as f32,
    };
    let texels = trace_environment_rows(view.data, &frame, &map, 0..IMPOSTOR_PROBE);
    texels.into_iter().map(|[r, g, b, _]| Vec3::new(r, g, b)).collect()
}

/// Lamps, as bright as level ground below the eye sees them.
fn lamps(view: &SceneView<'_>, ground: f32) -> Vec<Shining> {
    let eye = view.frame.camera.eye;
    let shining = |index: u32| {
        let lamp = view.data.light_load(index);
        if lamp.is_parallel() {
            return None;
        }
        let radius = if lamp.radius > 0.0 { lamp.radius } else { LAMP_RADIUS_M };
        let sample = lamp.light_sample(on_ground(eye, lamp.position, ground), 0.0);
        let radiance = sample.irradiance * (sample.distance / radius) * (sample.distance / radius);
        let (low, high) = (lamp.position - radius, lamp.position + radius);
        Some(Shining { low, high, radiance })
    };
    (0..view.data.light_count).filter_map(shining).collect()
}

/// Groups of triangles that shine and touch each other.
fn groups(data: &SceneData) -> Vec<Shining> {
    let leaves = data.shining_leaves();
    let mut parents: Vec<usize> = (0..leaves.len()).collect();
    let mut at_corner: BTreeMap<[i64; 3], usize> = BTreeMap::new();
    for (k, leaf) in leaves.iter().enumerate() {
        for corner in data.triangles[leaf.next as usize].corners() {
            let cell = corner.map(|x| (f64::from(x) / f64::from(SAME_CORNER_M)).round() as i64);
            let other = *at_corner.entry(cell).or_insert(k);
            let (a, b) = (root(&mut parents, k), root(&mut parents, other));
            parents[a.max(b)] = a.min(b);
        }
    }
    let mut sums: BTreeMap<usize, (Shining, Vec3, f32)> = BTreeMap::new();
    for (k, leaf) in leaves.iter().enumerate() {
        let corners = data.triangles[leaf.next as usize].corners().map(Vec3::from);
        let none = Shining { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY, radiance: Vec3::ZERO };
        let sum = sums.entry(root(&mut parents, k)).or_insert((none, Vec3::ZERO, 0.0));
        for corner in corners {
            sum.0.low = sum.0.low.min(corner);
            sum.0.high = sum.0.high.max(corner);
        }
        sum.1 += emitter_color(leaf.color) * leaf.power;
        sum.2 += leaf.area;
    }
    let mean = |(shining, light, area): (Shining, Vec3, f32)| {
        (area > 0.0).then(|| Shining { radiance: light / area, ..shining })
    };
    sums.into_values().filter_map(mean).collect()
}

/// The group that a triangle belongs to.
fn root(parents: &mut [usize], mut k: usize) -> usize {
    while parents[k] != k {
        parents[k] = parents[parents[k]];
        k = parents[k];
    }
    k
}

/// A position mirrored in level ground.
fn below_ground(position: Vec3, ground: f32) -> Vec3 {
    Vec3::new(position.x, 2.0 * ground - position.y, position.z)
}

/// Position on level ground in which an eye sees a position mirrored.
fn on_ground(eye: Vec3, position: Vec3, ground: f32) -> Vec3 {
    let (above, below) = ((eye.y - ground).max(1.0e-3), (position.y - ground).max(1.0e-3));
    eye + (below_ground(position, ground) - eye) * (above / (above + below))
}

/// The billboard of a shining object, as far as the ground sees it; `None` if the ground does not.
fn mirrored(view: &SceneView<'_>, shining: &Shining, ground: f32) -> Option<Billboard> {
    let eye = view.frame.camera.eye;
    let (center, size) = (0.5 * (shining.low + shining.high), shining.high - shining.low);
    if center.y <= ground {
        return None;
    }
    let from = on_ground(eye, center, ground) + Vec3::Y * (4.0 * view.frame.nearest);
    let offset = center - from;
    let distance = offset.length();
    // Across the view.
    let along = Vec2::new(center.x - eye.x, center.z - eye.z).normalize_or(Vec2::X);
    let width = (size.x * along.y).abs() + (size.z * along.x).abs();
    let reach = 0.5 * size.length() + view.frame.nearest;
    let visible = view.scene_visibility(from, offset / distance.max(1.0e-6), distance - reach);
    let radiance = saturated(shining.radiance * visible);
    let half = 0.5 * Vec2::new(width.max(size.y * 0.02), size.y.max(width * 0.02));
    let is_seen = light_weight(radiance) > 0.0 && radiance.is_finite() && half.min_element() > 0.0;
    is_seen.then_some(Billboard { center: below_ground(center, ground), half, radiance })
}

/// A color farther from its gray, of the same luminance.
fn saturated(color: Vec3) -> Vec3 {
    let luminance = color_luminance(color.to_array());
    let gray = Vec3::splat(luminance);
    let vivid = (gray + (color - gray) * SATURATION).max(Vec3::ZERO);
    vivid * (luminance / color_luminance(vivid.to_array()).max(f32::MIN_POSITIVE))
}
