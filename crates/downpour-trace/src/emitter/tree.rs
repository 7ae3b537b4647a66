//! The tree over the triangles that shine.

use downpour_bvh::Hit;
use downpour_render::light::light_weight;
use downpour_shaders::render::scene::{EMITTER_WORDS, SCENE_BLENDED, SCENE_MASKED};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::EmitterNode;
use crate::data::SceneData;
use crate::texture::TextureFootprint;

/// Places of a triangle where its emission is looked up, barycentric.
const PLACES: [[f32; 2]; 7] =
    [[0.333, 0.333], [0.1, 0.1], [0.8, 0.1], [0.1, 0.8], [0.45, 0.45], [0.1, 0.45], [0.45, 0.1]];

/// Maximum number of triangles in the tree: of more, those that give most.
const MAX_EMITTERS: usize = 1 << 18;

/// Triangle that shines.
#[derive(Clone, Copy, Debug)]
struct Emitter {
    triangle: u32,
    low: Vec3,
    high: Vec3,
    power: f32,
    color: u32,
    area: f32,
}

/// Mean emission over a triangle, and its area, m^2.
pub(crate) fn mean_emission(data: &SceneData, triangle: u32) -> (Vec3, f32) {
    let hit = |[u, v]: [f32; 2]| Hit { distance: 0.0, triangle, u, v };
    let footprint = TextureFootprint::round(third_width(data, triangle));
    let sum: Vec3 = PLACES.iter().map(|&place| data.surface_emission(&hit(place), &footprint)).sum();
    let edges = data.surface_edges(&hit(PLACES[0]));
    (sum / PLACES.len() as f32, 0.5 * edges.length())
}

/// About a third of the width of a triangle in units of texture coordinates.
fn third_width(data: &SceneData, triangle: u32) -> f32 {
    let first = triangle as usize * 3;
    let [a, b, c] =
        [0, 1, 2].map(|k| Vec2::new(data.corners[first + k].uv[0], data.corners[first + k].uv[1]));
    (0.125 * (b - a).perp_dot(c - a).abs()).sqrt()
}

/// The words of the tree over `triangles` of a scene; empty if none of them shines.
pub(crate) fn words(data: &SceneData, triangles: &[u32]) -> Vec<u32> {
    let mut emitters: Vec<Emitter> =
        triangles.par_iter().filter_map(|&triangle| emitter(data, triangle)).collect();
    if emitters.len() > MAX_EMITTERS {
        emitters.sort_by(|a, b| b.power.total_cmp(&a.power).then(a.triangle.cmp(&b.triangle)));
        emitters.truncate(MAX_EMITTERS);
    }
    let Some(first) = emitters.first() else { return Vec::new() };
    let mut nodes = vec![leaf(first)];
    let mut open = vec![(0, 0, emitters.len())];
    while let Some((node, from, to)) = open.pop() {
        let own = &mut emitters[from..to];
        if own.len() == 1 {
            nodes[node] = leaf(&own[0]);
            continue;
        }
        let middle = halve(own);
        let next = nodes.len();
        nodes[node] = branch(own, next as u32);
        nodes.extend([leaf(&own[0]), leaf(&own[middle])]);
        open.push((next, from, from + middle));
        open.push((next + 1, from + middle, to));
    }
    let mut words = Vec::with_capacity(nodes.len() * EMITTER_WORDS as usize);
    for node in &nodes {
        words
            .extend([node.center.x, node.center.y, node.center.z, node.square, node.power].map(f32::to_bits));
        words.extend([node.next, node.color, node.area.to_bits()]);
    }
    words
}

fn emitter(data: &SceneData, triangle: u32) -> Option<Emitter> {
    let (emission, area) = mean_emission(data, triangle);
    let material = data.material_load(data.corners[triangle as usize * 3].material);
    let opacity = |[u, v]: [f32; 2]| {
        let alpha = data.surface_alpha(&material, &Hit { distance: 0.0, triangle, u, v }).clamp(0.0, 1.0);
        let masked = if alpha < material.cutoff { 0.0 } else { 1.0 };
        if material.flags & SCENE_MASKED != 0 { masked } else { alpha }
    };
    let mut cover = 1.0;
    if material.flags & (SCENE_MASKED | SCENE_BLENDED) != 0 {
        cover = PLACES.iter().map(|&place| opacity(place)).sum::<f32>() / PLACES.len() as f32;
    }
    let weight = light_weight(emission);
    let power = weight * area * cover;
    if !(power > 0.0 && power.is_finite()) {
        return None;
    }
    let corners = data.triangles[triangle as usize].corners().map(Vec3::from);
    let low = corners[0].min(corners[1]).min(corners[2]);
    let high = corners[0].max(corners[1]).max(corners[2]);
    let part = |part: f32| (part / weight * 4095.0 + 0.5) as u32;
    let color = part(emission.x) | part(emission.y) << 12 | 1 << 31;
    Some(Emitter { triangle, low, high, power, color, area: area * cover })
}

fn leaf(emitter: &Emitter) -> EmitterNode {
    EmitterNode {
        center: 0.5 * (emitter.low + emitter.high),
        square: 0.25 * (emitter.high - emitter.low).length_squared(),
        power: emitter.power,
        next: emitter.triangle,
        color: emitter.color,
        area: emitter.area,
    }
}

fn branch(emitters: &[Emitter], next: u32) -> EmitterNode {
    let low = emitters.iter().fold(Vec3::INFINITY, |low, e| low.min(e.low));
    let high = emitters.iter().fold(Vec3::NEG_INFINITY, |high, e| high.max(e.high));
    let power: f64 = emitters.iter().map(|e| f64::from(e.power)).sum();
    EmitterNode {
        center: 0.5 * (low + high),
        square: 0.25 * (high - low).length_squared(),
        power: power as f32,
        next,
        color: 0,
        area: 0.0,
    }
}

/// Sorts emitters along the longest edge of their centers' box, and returns the number of those in the lower half: by count,
/// so that the tree is as shallow as can be.
fn halve(emitters: &mut [Emitter]) -> usize {
    let center = |e: &Emitter| e.low + e.high;
    let low = emitters.iter().fold(Vec3::INFINITY, |low, e| low.min(center(e)));
    let high = emitters.iter().fold(Vec3::NEG_INFINITY, |high, e| high.max(center(e)));
    let axis = (high - low).max_position();
    let middle = emitters.len() / 2;
    emitters.select_nth_unstable_by(middle, |a, b| {
        center(a)[axis].total_cmp(&center(b)[axis]).then(a.triangle.cmp(&b.triangle))
    });
    middle
}
