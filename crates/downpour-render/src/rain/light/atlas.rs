//! Choice of the streaks of an atlas that a drop shows under a lamp. Twin of `shaders/wgsl/render/drop_atlas.wgsl`.
//!
//! The choice is that of [`downpour_atlas`], from the same numbers. Here they are rows of four behind the table of
//! scattering, since the kernel has no buffer to spare: counts; by angle or at random, the first row of the amounts, and
//! whether all elevations have the same directions; the seed in parts of 16 bits; gaps between diameters and between
//! elevations, four rows each; first triangles, three rows; three rows for each triangle (positions of its corners,
//! triangles across with -1 for the rim, its directions); the amounts, four a row.

use downpour_atlas::StreakAtlas;
use downpour_atlas::lookup::{
    AtlasSlot, atlas_cell, atlas_clamp, atlas_corner, atlas_draw, atlas_light, atlas_map, atlas_position,
    atlas_rise, atlas_weights,
};
use downpour_math::ops;
use downpour_shaders::atlas::{
    ATLAS_GRID, ATLAS_MIN_DIAMETER, ATLAS_NONE, ATLAS_RANDOM, ATLAS_RISES, ATLAS_STEPS,
};
use downpour_shaders::render::drop_light::{
    DROP_ATLAS_COUNTS, DROP_ATLAS_FIRST, DROP_ATLAS_PICK, DROP_ATLAS_RISES, DROP_ATLAS_SEED,
    DROP_ATLAS_SIZES, DROP_ATLAS_TRIANGLES, DROP_LIGHT_ENTRIES, DROP_LIGHT_PATHS,
};
use glam::Vec3;

use super::DropLightTable;

/// Rows before those of an atlas.
pub(super) const FIRST_ROW: u32 = DROP_LIGHT_ENTRIES * (1 + DROP_LIGHT_PATHS);

/// An atlas as rows of the table.
pub(super) fn rows(atlas: &StreakAtlas) -> Vec<[f32; 4]> {
    let data = atlas.data();
    let (frame, triangles) = (data.frame, data.triangles);
    let whole = |numbers: [u32; 4]| numbers.map(|n| n as f32);
    let first_amount = DROP_ATLAS_TRIANGLES + 3 * triangles.len() as u32;
    let [low, high] = frame.seed;
    let mut rows = vec![
        whole(frame.counts),
        whole([frame.pick, first_amount, frame.is_shared, 0]),
        whole([low & 0xffff, low >> 16, high & 0xffff, high >> 16]),
    ];
    rows.extend(frame.diameters);
    rows.extend(frame.elevations);
    rows.extend(frame.first.map(whole));
    for triangle in triangles {
        let next = triangle.next.map(|n| if n == ATLAS_NONE { -1.0 } else { n as f32 });
        let [d0, d1, d2] = triangle.directions.map(|d| d as f32);
        let ([ax, ay], [bx, by], [cx, cy]) = (triangle.a, triangle.b, triangle.c);
        rows.extend([[ax, ay, bx, by], [cx, cy, next[0], next[1]], [next[2], d0, d1, d2]]);
    }
    let four = |four: &[f32]| std::array::from_fn(|k| four.get(k).copied().unwrap_or(0.0));
    rows.extend(data.amounts.chunks(4).map(four));
    rows
}

/// Three directions: positions in the map, what is across from each corner (below 0: the rim), and their numbers.
#[derive(Clone, Copy, Debug)]
struct DropAtlasTriangle {
    a: [f32; 2],
    b: [f32; 2],
    c: [f32; 2],
    next: [f32; 3],
    directions: [f32; 3],
}

/// A row of the atlas' numbers.
fn drop_atlas_row(table: &DropLightTable, k: u32) -> [f32; 4] {
    table.rows().get((FIRST_ROW + k) as usize).copied().unwrap_or_default()
}

/// The seed of all choices by chance.
fn drop_atlas_seed(table: &DropLightTable) -> [u32; 2] {
    let [a, b, c, d] = drop_atlas_row(table, DROP_ATLAS_SEED).map(|half| half as u32);
    [a | (b << 16), c | (d << 16)]
}

/// A triangle of the map.
fn drop_atlas_triangle(table: &DropLightTable, k: u32) -> DropAtlasTriangle {
    let row = DROP_ATLAS_TRIANGLES + 3 * k;
    let [ax, ay, bx, by] = drop_atlas_row(table, row);
    let [cx, cy, next_a, next_b] = drop_atlas_row(table, row + 1);
    let [next_c, d0, d1, d2] = drop_atlas_row(table, row + 2);
    DropAtlasTriangle {
        a: [ax, ay],
        b: [bx, by],
        c: [cx, cy],
        next: [next_a, next_b, next_c],
        directions: [d0, d1, d2],
    }
}

/// An amount by its number.
fn drop_atlas_number(table: &DropLightTable, k: u32) -> f32 {
    let first = drop_atlas_row(table, DROP_ATLAS_PICK)[1] as u32;
    drop_atlas_row(table, first + (k >> 2))[(k & 3) as usize]
}

/// The amount of one grid in a cell: bilinear.
fn drop_atlas_amount(table: &DropLightTable, grid: u32, cell: [f32; 4]) -> f32 {
    let [column, row, x, y] = cell;
    let number = |k| drop_atlas_number(table, k);
    let first = (grid * ATLAS_GRID + row as u32) * ATLAS_GRID + column as u32;
    let next = first + ATLAS_GRID;
    let below = number(first) * (1.0 - x) + number(first + 1) * x;
    let above = number(next) * (1.0 - x) + number(next + 1) * x;
    below * (1.0 - y) + above * y
}

/// Position of a value among the nodes whose gaps are the four rows from `first` on.
fn drop_atlas_position(table: &DropLightTable, first: u32, value: f32) -> f32 {
    let row = |k| drop_atlas_row(table, first + k);
    atlas_position(row(0), row(1), row(2), row(3), value)
}

/// The streak of a drop's id, diameter in meters and axis, and the unit vectors to its light and viewer.
pub(super) fn drop_atlas_slot(
    table: &DropLightTable,
    id: u32,
    diameter: f32,
    axis: Vec3,
    light: Vec3,
    view: Vec3,
) -> AtlasSlot {
    let row = |k| drop_atlas_row(table, k);
    let [sizes, oscillations, elevations, directions] = row(DROP_ATLAS_COUNTS).map(|n| n as u32);
    let [pick, _, is_shared, _] = row(DROP_ATLAS_PICK).map(|n| n as u32);
    let seed = drop_atlas_seed(table);
    let within = atlas_light(light.to_array(), view.to_array(), axis.to_array());
    let side = if within[0] < 0.0 { -1.0 } else { 1.0 };
    if pick == ATLAS_RANDOM {
        let sets = sizes * oscillations;
        let layer = atlas_draw(seed, id, 1, sets * elevations * directions);
        let amount = drop_atlas_number(table, sets * ATLAS_RISES * ATLAS_GRID * ATLAS_GRID + layer);
        return AtlasSlot {
            layers: [layer; 3],
            side,
            weights: [1.0, 0.0, 0.0],
            amount,
            ..AtlasSlot::default()
        };
    }
    let size = drop_atlas_position(table, DROP_ATLAS_SIZES, ops::log2(diameter.max(ATLAS_MIN_DIAMETER)));
    let lower = size.floor();
    let group = lower as u32 * oscillations + atlas_draw(seed, id, 0, oscillations);
    let point = atlas_map(within);
    let cell = atlas_cell(point);
    let sine = view.dot(axis);
    let rise = atlas_rise(sine);
    let mut amount = 0.0;
    for corner in 0..4 {
        let weight = atlas_corner(size - lower, rise - rise.floor(), corner);
        if weight > 0.0 {
            let of_group = group + (corner & 1) * oscillations;
            let grid = of_group * ATLAS_RISES + rise as u32 + (corner >> 1);
            amount += weight * drop_atlas_amount(table, grid, cell);
        }
    }
    let level = drop_atlas_position(table, DROP_ATLAS_RISES, sine);
    let nearest = is_shared == 0;
    let elevation = if nearest { level + 0.5 } else { level } as u32;
    let parts = [size - lower, if nearest { 0.0 } else { level - level.floor() }];
    let base = (group * elevations + elevation) * directions;
    let first = row(DROP_ATLAS_FIRST + (elevation >> 2))[(elevation & 3) as usize] as u32;
    let mut triangle = drop_atlas_triangle(table, first);
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
        if least >= 0.0 || over < 0.0 {
            break;
        }
        triangle = drop_atlas_triangle(table, first + over as u32);
        weights = atlas_weights(triangle.a, triangle.b, triangle.c, point);
    }
    AtlasSlot {
        layers: triangle.directions.map(|direction| base + direction as u32),
        side,
        weights: atlas_clamp(weights),
        amount,
        parts,
        unused: [0.0; 2],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_atlas::{StreakOptions, StreakOscillation, StreakParticle, StreakPick, light_directions};
    use downpour_math::rng::{rng_draw, rng_unit};

    fn small() -> StreakAtlas {
        let options = StreakOptions { columns: 4, rows: 2, rays: 4, ..StreakOptions::default() };
        let oscillations = &StreakOscillation::COMMITTED[..2];
        StreakAtlas::trace(&[1.0e-3, 3.0e-3], oscillations, &[-0.3, 0.3], &light_directions(), &options)
            .unwrap()
    }

    /// The rows lead to the layers that the atlas itself picks.
    #[test]
    fn the_choice_is_that_of_the_atlas() {
        for pick in [StreakPick::ByAngle, StreakPick::Random] {
            let atlas = small().with_pick(pick).with_seed(0x1234_5678_9abc_def0);
            let table = DropLightTable::water().unwrap().with_atlas(&atlas);
            for k in 0..500 {
                let unit = |which| {
                    let [a, b, c, _] = rng_draw([3, 4], k, which, 0).map(|w| 2.0 * rng_unit(w) - 1.0);
                    Vec3::new(a, b, c + 0.001).normalize()
                };
                let (light, view) = (unit(0), unit(1));
                let diameter = 0.5e-3 + 1.0e-5 * k as f32;
                let particle = StreakParticle { diameter, axis: [0.0, 1.0, 0.0], id: k };
                let wanted = atlas.slot(&particle, light.to_array(), view.to_array());
                let found = drop_atlas_slot(&table, k, diameter, Vec3::Y, light, view);
                assert_eq!(found, wanted, "{k}");
            }
        }
    }
}
