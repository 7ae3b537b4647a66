//! Looking up a streak: twins of `shaders/wgsl/atlas/atlas.wgsl` and `lookup.wgsl`.
//!
//! A light is rotated into the frame of the streak and mapped to the plane of the triangles (see `triangles`). From the
//! elevation's first triangle the walk crosses the edge that the point is farthest beyond, until it is in a triangle
//! or at the rim; at the rim, weights below 0 count as 0.
//!
//! The three directions are those of the pattern; the amount is interpolated in dense grids over the same plane, which have
//! separate elevations. Both are linear between neighboring elevations, by their sine, and between neighboring diameters, by their
//! logarithm.

use bytemuck::{Pod, Zeroable};
use downpour_math::ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_math::vector::{cross, dot, scale};
use downpour_shaders::atlas::{
    ATLAS_DIMENSION, ATLAS_GRID, ATLAS_MIN_DIAMETER, ATLAS_NONE, ATLAS_RANDOM, ATLAS_RISE_LIMIT, ATLAS_RISES,
    ATLAS_STEPS, ATLAS_TINY,
};

/// Parameters of an atlas for shaders: the WGSL struct of the same name, 224 bytes.
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
    /// 1 if all elevations have the same directions, else 0: then patterns are those of the nearest elevation.
    pub is_shared: u32,
    /// Not used.
    pub unused: u32,
    /// Gaps between neighboring diameters, up to eight: the lower end, the logarithm to base 2 of meters; then 1 / the width of
    /// each gap. 0 for unused gaps.
    pub diameters: [[f32; 4]; 4],
    /// Gaps between neighboring elevations, by their sines, in the same form.
    pub elevations: [[f32; 4]; 4],
    /// First triangle of each elevation, then the number of all.
    pub first: [[u32; 4]; 3],
}

/// A triangle of three directions and its neighbors: the WGSL struct of the same name, 64 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct AtlasTriangle {
    /// Positions of the corners in the map, counter-clockwise.
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

/// Position of a streak in the atlas: the WGSL struct of the same name, 48 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct AtlasSlot {
    /// Three layers of the atlas, of the lower diameter and the lower elevation.
    pub layers: [u32; 3],
    /// -1 if the streak is to be mirrored, else 1.
    pub side: f32,
    /// Weights of the three directions; together 1.
    pub weights: [f32; 3],
    /// The radiance, in 1/sr for an irradiance of 1, of a disk of the equivalent radius with as much light.
    pub amount: f32,
    /// Weights of the higher diameter and of the higher elevation, 0 to 1, below 1 in all.
    pub parts: [f32; 2],
    /// Not used.
    pub unused: [f32; 2],
}

/// Three directions of an elevation and their weights: the WGSL struct of the same name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtlasMix {
    /// Numbers of the directions.
    pub directions: [u32; 3],
    /// Their weights; together 1.
    pub weights: [f32; 3],
}

/// The four arrays of an atlas.
#[derive(Clone, Copy, Debug)]
pub struct AtlasData<'a> {
    /// Its frame.
    pub frame: &'a AtlasFrame,
    /// Triangles of all elevations.
    pub triangles: &'a [AtlasTriangle],
    /// Patterns, two half floats each, the first in the low bits: layers, rows, columns. A texel is the ratio of its brightness to
    /// that of a uniform disk with the streak's amount.
    pub texels: &'a [u32],
    /// Amounts: diameters, oscillations, elevations of the grids, rows, columns; then that of each layer.
    pub amounts: &'a [f32],
}

/// Direction `light` in the frame of the streak of a drop with this axis. All are unit vectors; if the viewer looks along
/// the axis, any of the possible frames is used.
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

/// Position of a direction in the map: (y, z) / (1 + |x|).
#[must_use]
pub fn atlas_map(direction: [f32; 3]) -> [f32; 2] {
    let below = 1.0 / (1.0 + direction[0].abs());
    [direction[1] * below, direction[2] * below]
}

/// Position of a value among up to nine ascending nodes: 0 at the first, 1 at the second, linear in between, constant beyond the
/// ends. `low` and `high` are the lower ends of the gaps between nodes, the others 1 / their widths, 0 for unused gaps.
#[must_use]
pub fn atlas_position(
    low: [f32; 4],
    high: [f32; 4],
    low_inverse: [f32; 4],
    high_inverse: [f32; 4],
    value: f32,
) -> f32 {
    let part = |k: usize| {
        ((value - low[k]) * low_inverse[k]).clamp(0.0, 1.0)
            + ((value - high[k]) * high_inverse[k]).clamp(0.0, 1.0)
    };
    (part(0) + part(1)) + (part(2) + part(3))
}

/// Position of a viewer among the grids of amounts, by the sine of the elevation: 0 at the lowest, 24 at the highest.
#[must_use]
pub fn atlas_rise(sine: f32) -> f32 {
    (0.5 * (sine / ATLAS_RISE_LIMIT) + 0.5).clamp(0.0, 1.0) * (ATLAS_RISES - 1) as f32
}

/// Cell of the grid of amounts that a point of the map is in: column and row of its first node, then the point's distance from
/// that node in cells, 0 to 1 along each axis.
#[must_use]
pub fn atlas_cell(point: [f32; 2]) -> [f32; 4] {
    let cells = (ATLAS_GRID - 1) as f32;
    let (x, y) = ((0.5 * point[0] + 0.5) * cells, (0.5 * point[1] + 0.5) * cells);
    let (column, row) = (x.floor().clamp(0.0, cells - 1.0), y.floor().clamp(0.0, cells - 1.0));
    [column, row, (x - column).clamp(0.0, 1.0), (y - row).clamp(0.0, 1.0)]
}

/// Weight of one of the four neighbors in diameter and elevation. Bit 0 of `corner`: the higher diameter; bit 1: the higher
/// elevation. `size`, `rise`: the weights of the higher ones.
#[must_use]
pub fn atlas_corner(size: f32, rise: f32, corner: u32) -> f32 {
    (if corner & 1 == 1 { size } else { 1.0 - size }) * (if corner & 2 == 2 { rise } else { 1.0 - rise })
}

/// Barycentric weights of the corners a, b, c at a point of the map; their sum is 1, a weight is below 0 beyond the opposite edge.
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

/// Random index below `count`, by the id of a particle. `which` numbers the choices.
#[must_use]
pub fn atlas_draw(seed: [u32; 2], id: u32, which: u32, count: u32) -> u32 {
    let [word, ..] = rng_draw(seed, id, which, ATLAS_DIMENSION);
    ((rng_unit(word) * count as f32) as u32).min(count - 1)
}

/// The three directions of an elevation about a point of the map, and their weights.
#[must_use]
pub fn atlas_lookup_mix(data: &AtlasData<'_>, elevation: u32, point: [f32; 2]) -> AtlasMix {
    let first = data.frame.first[(elevation >> 2) as usize][(elevation & 3) as usize];
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
    AtlasMix { directions: triangle.directions, weights: atlas_clamp(weights) }
}

/// The amount of one grid in a cell: bilinear.
#[must_use]
pub fn atlas_lookup_amount(data: &AtlasData<'_>, grid: u32, cell: [f32; 4]) -> f32 {
    let [column, row, x, y] = cell;
    let first = ((grid * ATLAS_GRID + row as u32) * ATLAS_GRID + column as u32) as usize;
    let next = first + ATLAS_GRID as usize;
    let below = data.amounts[first] * (1.0 - x) + data.amounts[first + 1] * x;
    let above = data.amounts[next] * (1.0 - x) + data.amounts[next + 1] * x;
    below * (1.0 - y) + above * y
}

/// The streak of a drop's id, diameter in meters and axis, and the unit vectors from it to its light and viewer.
#[must_use]
pub fn atlas_lookup_slot(
    data: &AtlasData<'_>,
    id: u32,
    diameter: f32,
    axis: [f32; 3],
    light: [f32; 3],
    view: [f32; 3],
) -> AtlasSlot {
    let frame = data.frame;
    let [diameters, oscillations, elevations, directions] = frame.counts;
    let within = atlas_light(light, view, axis);
    let side = if within[0] < 0.0 { -1.0 } else { 1.0 };
    if frame.pick == ATLAS_RANDOM {
        let sets = diameters * oscillations;
        let layer = atlas_draw(frame.seed, id, 1, sets * elevations * directions);
        let amount = data.amounts[(sets * ATLAS_RISES * ATLAS_GRID * ATLAS_GRID + layer) as usize];
        return AtlasSlot {
            layers: [layer; 3],
            side,
            weights: [1.0, 0.0, 0.0],
            amount,
            ..AtlasSlot::default()
        };
    }
    let position =
        |gaps: &[[f32; 4]; 4], value: f32| atlas_position(gaps[0], gaps[1], gaps[2], gaps[3], value);
    let size = position(&frame.diameters, ops::log2(diameter.max(ATLAS_MIN_DIAMETER)));
    let lower = size.floor();
    let oscillation = atlas_draw(frame.seed, id, 0, oscillations);
    let group = lower as u32 * oscillations + oscillation;
    let point = atlas_map(within);
    let cell = atlas_cell(point);
    let sine = dot(view, axis);
    let rise = atlas_rise(sine);
    let mut amount = 0.0;
    for corner in 0..4 {
        let weight = atlas_corner(size - lower, rise - rise.floor(), corner);
        if weight > 0.0 {
            let of_group = group + (corner & 1) * oscillations;
            let grid = of_group * ATLAS_RISES + rise as u32 + (corner >> 1);
            amount += weight * atlas_lookup_amount(data, grid, cell);
        }
    }
    let level = position(&frame.elevations, sine);
    let nearest = frame.is_shared == 0;
    let elevation = if nearest { level + 0.5 } else { level } as u32;
    let parts = [size - lower, if nearest { 0.0 } else { level - level.floor() }];
    let mix = atlas_lookup_mix(data, elevation, point);
    let base = (group * elevations + elevation) * directions;
    AtlasSlot {
        layers: mix.directions.map(|direction| base + direction),
        side,
        weights: mix.weights,
        amount,
        parts,
        unused: [0.0; 2],
    }
}

/// A texel. Columns outside are 0, rows wrap.
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

/// Radiance at a position in the atlas, `across` equivalent radii to the right of the middle, `turns` of the mode (2,0) along.
#[must_use]
pub fn atlas_lookup_radiance(data: &AtlasData<'_>, slot: &AtlasSlot, across: f32, turns: f32) -> f32 {
    let frame = data.frame;
    let half = 0.5 * frame.size[0] as f32;
    let column = half + half * (across * slot.side / frame.half_extent).clamp(-2.0, 2.0);
    let row = (turns - turns.floor()) * frame.size[1] as f32;
    let mut pattern = 0.0;
    for corner in 0..4 {
        let weight = atlas_corner(slot.parts[0], slot.parts[1], corner);
        if weight > 0.0 {
            let sizes = (corner & 1) * frame.counts[1] * frame.counts[2];
            let step = (sizes + (corner >> 1)) * frame.counts[3];
            let mean = slot.weights[0] * atlas_lookup_layer(data, slot.layers[0] + step, column, row)
                + slot.weights[1] * atlas_lookup_layer(data, slot.layers[1] + step, column, row)
                + slot.weights[2] * atlas_lookup_layer(data, slot.layers[2] + step, column, row);
            pattern += weight * mean;
        }
    }
    slot.amount * pattern
}
