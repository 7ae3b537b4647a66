//! Looking up a streak: twins of `shaders/wgsl/mask/atlas.wgsl` and `atlas_lookup.wgsl`.
//!
//! A light is turned into the frame of the streak and mapped to the plane of the triangles (see `triangles`). From the
//! elevation's first triangle the walk goes over the edge that the point is farthest beyond, until it is in a triangle
//! or at the rim; at the rim, weights below 0 count as 0.

use bytemuck::{Pod, Zeroable};
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_math::vector::{cross, dot, scale};
use downpour_shaders::mask::{ATLAS_DIMENSION, ATLAS_NONE, ATLAS_RANDOM, ATLAS_STEPS, ATLAS_TINY};

/// What a shader has to know of an atlas: the WGSL struct of the same name, 192 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct AtlasFrame {
    /// Columns and rows of a layer.
    pub size: [u32; 2],
    /// Half of the width of a streak, in equivalent radii.
    pub half_extent: f32,
    /// `ATLAS_BY_ANGLE` or `ATLAS_RANDOM`.
    pub pick: u32,
    /// Numbers of diameters, oscillations, elevations and directions.
    pub counts: [u32; 4],
    /// Seed of all choices by chance.
    pub seed: [u32; 2],
    /// Not used.
    pub unused: [u32; 2],
    /// Between neighbouring diameters, in metres: their geometric means, then numbers larger than any.
    pub diameters: [[f32; 4]; 2],
    /// Between neighbouring elevations: sines of the angles midway, then numbers larger than any.
    pub elevations: [[f32; 4]; 2],
    /// First triangle of each elevation, then the number of all.
    pub first: [[u32; 4]; 3],
    /// Not used.
    pub unused_1: [u32; 4],
}

/// Three directions and what is next to them: the WGSL struct of the same name, 64 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct AtlasTriangle {
    /// Places of the corners in the map, counter-clockwise.
    pub a: [f32; 2],
    /// The second.
    pub b: [f32; 2],
    /// The third.
    pub c: [f32; 2],
    /// Not used.
    pub unused: [f32; 2],
    /// Directions of the corners.
    pub directions: [u32; 3],
    /// Not used.
    pub unused_1: u32,
    /// Triangles of the elevation across from each corner; `ATLAS_NONE` at the rim.
    pub next: [u32; 3],
    /// Not used.
    pub unused_2: u32,
}

/// Where a streak is in the atlas: the WGSL struct of the same name, 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct AtlasPlace {
    /// Three layers of the atlas.
    pub layers: [u32; 3],
    /// -1 if the streak is to be mirrored, else 1.
    pub side: f32,
    /// Their weights; together 1.
    pub weights: [f32; 3],
    /// Not used.
    pub unused: f32,
}

/// The three arrays of an atlas.
#[derive(Clone, Copy, Debug)]
pub struct AtlasData<'a> {
    /// Its frame.
    pub frame: &'a AtlasFrame,
    /// Triangles of all elevations.
    pub triangles: &'a [AtlasTriangle],
    /// Two half floats each, the first in the low bits: layers, rows, columns.
    pub texels: &'a [u32],
}

/// `light` in the frame of the streak of a drop with this axis. All are unit vectors; if the viewer looks along the
/// axis, any of the possible frames is taken.
#[must_use]
pub fn atlas_light(light: [f32; 3], view: [f32; 3], axis: [f32; 3]) -> [f32; 3] {
    let along = dot(axis, view);
    let up = [axis[0] - along * view[0], axis[1] - along * view[1], axis[2] - along * view[2]];
    let square = dot(up, up);
    // The other side of the frame: x across view, then y from it.
    let steep = square < ATLAS_TINY;
    let spare = cross(view, if view[0].abs() < 0.5 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] });
    let chosen = if steep { spare } else { up };
    let y = scale(chosen, 1.0 / dot(chosen, chosen).sqrt());
    let x = cross(y, view);
    [dot(light, x), dot(light, y), dot(light, view)]
}

/// The place of a direction in the map: (y, z) / (1 + |x|).
#[must_use]
pub fn atlas_map(direction: [f32; 3]) -> [f32; 2] {
    let below = 1.0 / (1.0 + direction[0].abs());
    [direction[1] * below, direction[2] * below]
}

/// How many of eight ascending thresholds `value` is above.
#[must_use]
pub fn atlas_rank(low: [f32; 4], high: [f32; 4], value: f32) -> u32 {
    low.iter().chain(&high).map(|&threshold| u32::from(value > threshold)).sum()
}

/// Shares of the corners a, b, c in a point of the map; together 1, below 0 beyond the opposite edge.
#[must_use]
pub fn atlas_weights(a: [f32; 2], b: [f32; 2], c: [f32; 2], point: [f32; 2]) -> [f32; 3] {
    let (bx, by) = (b[0] - a[0], b[1] - a[1]);
    let (cx, cy) = (c[0] - a[0], c[1] - a[1]);
    let (px, py) = (point[0] - a[0], point[1] - a[1]);
    let area = bx * cy - by * cx;
    let second = (px * cy - py * cx) / area;
    let third = (bx * py - by * px) / area;
    [1.0 - second - third, second, third]
}

/// The weights with those below 0 taken as 0; together 1.
#[must_use]
pub fn atlas_clamp(weights: [f32; 3]) -> [f32; 3] {
    let [a, b, c] = weights.map(|w| w.max(0.0));
    let whole = 1.0 / (a + b + c);
    [a * whole, b * whole, c * whole]
}

/// One of `count` by chance, by the id of a particle. `which` counts the choices.
#[must_use]
pub fn atlas_draw(seed: [u32; 2], id: u32, which: u32, count: u32) -> u32 {
    let [word, ..] = rng_draw(seed, id, which, ATLAS_DIMENSION);
    ((rng_unit(word) * count as f32) as u32).min(count - 1)
}

/// The three layers for a drop's id, diameter in metres and axis, and the unit vectors from it to its light and viewer.
#[must_use]
pub fn atlas_lookup_place(
    data: &AtlasData<'_>,
    id: u32,
    diameter: f32,
    axis: [f32; 3],
    light: [f32; 3],
    view: [f32; 3],
) -> AtlasPlace {
    let frame = data.frame;
    let [diameters, oscillations, elevations, directions] = frame.counts;
    let within = atlas_light(light, view, axis);
    let side = if within[0] < 0.0 { -1.0 } else { 1.0 };
    if frame.pick == ATLAS_RANDOM {
        let layer = atlas_draw(frame.seed, id, 1, diameters * oscillations * elevations * directions);
        return AtlasPlace { layers: [layer; 3], side, weights: [1.0, 0.0, 0.0], unused: 0.0 };
    }
    let size = atlas_rank(frame.diameters[0], frame.diameters[1], diameter);
    let elevation = atlas_rank(frame.elevations[0], frame.elevations[1], dot(view, axis));
    let oscillation = atlas_draw(frame.seed, id, 0, oscillations);
    let base = ((size * oscillations + oscillation) * elevations + elevation) * directions;
    let first = frame.first[(elevation >> 2) as usize][(elevation & 3) as usize];
    let point = atlas_map(within);
    let mut triangle = data.triangles[first as usize];
    let mut weights = atlas_weights(triangle.a, triangle.b, triangle.c, point);
    for _ in 0..ATLAS_STEPS {
        let least = weights[0].min(weights[1].min(weights[2]));
        let over = if weights[0] == least {
            triangle.next[0]
        } else if weights[1] == least {
            triangle.next[1]
        } else {
            triangle.next[2]
        };
        if least >= 0.0 || over == ATLAS_NONE {
            break;
        }
        triangle = data.triangles[(first + over) as usize];
        weights = atlas_weights(triangle.a, triangle.b, triangle.c, point);
    }
    AtlasPlace {
        layers: triangle.directions.map(|direction| base + direction),
        side,
        weights: atlas_clamp(weights),
        unused: 0.0,
    }
}

/// A texel. Columns outside are 0, rows go round.
#[must_use]
pub fn atlas_lookup_texel(data: &AtlasData<'_>, layer: u32, column: i32, row: i32) -> f32 {
    let [columns, rows] = data.frame.size;
    if column < 0 || column >= columns as i32 {
        return 0.0;
    }
    let down = row.rem_euclid(rows as i32) as u32;
    let index = (layer * rows + down) * columns + column as u32;
    let word = data.texels[(index >> 1) as usize];
    half::f16::from_bits((word >> (16 * (index & 1))) as u16).to_f32()
}

/// A layer at `across` columns and `down` rows from its corner: bilinear.
#[must_use]
pub fn atlas_lookup_layer(data: &AtlasData<'_>, layer: u32, across: f32, down: f32) -> f32 {
    let (u, v) = (across - 0.5, down - 0.5);
    let (left, top) = (u.floor(), v.floor());
    let (x, y) = (u - left, v - top);
    let (column, row) = (left as i32, top as i32);
    let above = atlas_lookup_texel(data, layer, column, row) * (1.0 - x)
        + atlas_lookup_texel(data, layer, column + 1, row) * x;
    let below = atlas_lookup_texel(data, layer, column, row + 1) * (1.0 - x)
        + atlas_lookup_texel(data, layer, column + 1, row + 1) * x;
    above * (1.0 - y) + below * y
}

/// The texel of a place at `across` equivalent radii to the right of the middle, `turns` of the mode (2,0) along.
#[must_use]
pub fn atlas_lookup_radiance(data: &AtlasData<'_>, place: &AtlasPlace, across: f32, turns: f32) -> f32 {
    let frame = data.frame;
    let half = 0.5 * frame.size[0] as f32;
    let column = half + half * (across * place.side / frame.half_extent).clamp(-2.0, 2.0);
    let row = (turns - turns.floor()) * frame.size[1] as f32;
    place.weights[0] * atlas_lookup_layer(data, place.layers[0], column, row)
        + place.weights[1] * atlas_lookup_layer(data, place.layers[1], column, row)
        + place.weights[2] * atlas_lookup_layer(data, place.layers[2], column, row)
}
