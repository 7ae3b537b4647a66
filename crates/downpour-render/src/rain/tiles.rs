//! Lists of drops for the tiles of a picture: in each list the drops that may touch the tile, nearest first, without streaks that are
//! summed up. Twin of `shaders/wgsl/render/tiles.wgsl`, where the method is described.

use std::cmp::Ordering;

use downpour_math::bins::Bins;
use downpour_shaders::render::rain::{DROPS_TILE, TILES_EDGES};
use glam::Vec2;
use rayon::prelude::*;

use super::streak::{ScreenDrop, streak_is_summed, streak_pixels};

/// Drops that the lists of all tiles have room for, by the number of drops: on the mean a streak touches some ten tiles.
const ROOM_PER_DROP: u32 = 32;

/// Least and most room: 128 MiB, which every device binds, less twice the largest number of tiles.
const ROOM: [u32; 2] = [1 << 18, (32 << 20) - (10 << 20)];

/// Uniforms of the kernels. The same layout as `TilesFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct TilesFrame {
    /// Columns and rows of the picture.
    pub size: [u32; 2],
    /// Number of drops.
    pub count: u32,
    /// Drops that all lists together have room for, at least `count`.
    pub room: u32,
}

impl TilesFrame {
    /// Lists of so many drops for a picture.
    #[must_use]
    pub fn new(size: [u32; 2], count: u32) -> Self {
        let room = count.saturating_mul(ROOM_PER_DROP).clamp(ROOM[0], ROOM[1]);
        Self { size, count, room: room.max(count) }
    }

    /// Number of tiles of the smallest edge.
    #[must_use]
    pub fn tiles(&self) -> u32 {
        self.size.map(|pixels| pixels.div_ceil(DROPS_TILE)).iter().product()
    }
}

/// First and last row of tiles that a drop may touch; `None` if there is none.
#[must_use]
pub fn tiles_rows(drop: &ScreenDrop, edge: u32, size: [u32; 2]) -> Option<[u32; 2]> {
    if drop.reach <= 0.0 {
        return None;
    }
    let (first, way) = (Vec2::from(drop.first), Vec2::from(drop.screen_delta));
    let (low, high) = (first.min(first + way) - drop.reach, first.max(first + way) + drop.reach);
    streak_pixels(low.x, high.x, size[0])?;
    streak_pixels(low.y, high.y, size[1]).map(|rows| rows.map(|row| row / edge))
}

/// First and last tile of a row of tiles that the path of a drop may touch; `None` if there is none.
#[must_use]
pub fn tiles_columns(drop: &ScreenDrop, row: u32, edge: u32, width: u32) -> Option<[u32; 2]> {
    let (first, way, reach) = (Vec2::from(drop.first), Vec2::from(drop.screen_delta), drop.reach);
    let top = (row * edge) as f32 - reach;
    let bottom = ((row + 1) * edge) as f32 + reach;
    // The part of the path that is as high as this row.
    let (mut low, mut high) = (0.0f32, 1.0f32);
    if way.y.abs() > 1.0e-3 {
        let (a, b) = ((top - first.y) / way.y, (bottom - first.y) / way.y);
        (low, high) = (low.max(a.min(b)), high.min(a.max(b)));
    }
    if low > high {
        return None;
    }
    let (a, b) = (first.x + way.x * low, first.x + way.x * high);
    streak_pixels(a.min(b) - reach, a.max(b) + reach, width)
        .map(|columns| columns.map(|column| column / edge))
}

/// True for a drop that is put on lists.
#[must_use]
pub fn tiles_is_listed(drop: &ScreenDrop) -> bool {
    drop.reach > 0.0 && !streak_is_summed(drop)
}

/// No fewer tiles of an edge than a drop may touch.
#[must_use]
pub fn tiles_bound(drop: &ScreenDrop, edge: u32, size: [u32; 2]) -> u32 {
    let Some([top, bottom]) = tiles_rows(drop, edge, size) else { return 0 };
    let [x, y] = drop.screen_delta.map(f32::abs);
    // Of each row of tiles the path covers what it is slanted, and its own width.
    let reached = edge as f32 + 2.0 * drop.reach;
    let slanted = x.min(reached * x / y.max(1.0e-3));
    let columns = (slanted + 2.0 * drop.reach).min(size[0] as f32) / edge as f32 + 3.0;
    (bottom + 1 - top) * (columns as u32).min(size[0].div_ceil(edge))
}

/// The smallest edge whose lists have room: for each edge, how many drops its lists have at most.
#[must_use]
pub fn tiles_edge(totals: &[u64; TILES_EDGES as usize], room: u32) -> u32 {
    let fits = totals.iter().position(|&total| total <= u64::from(room));
    DROPS_TILE << fits.unwrap_or(totals.len() - 1)
}

/// The sort key of a drop: distances are above 0, whose bits are in their order.
#[must_use]
pub fn tiles_key(drops: &[ScreenDrop], index: u32) -> [u32; 2] {
    [drops[index as usize].nearest.to_bits(), index]
}

/// True if a drop comes before another, by their sort keys.
#[must_use]
pub fn tiles_is_before(drops: &[ScreenDrop], a: [u32; 2], b: [u32; 2]) -> bool {
    let all = |key: [u32; 2]| (key[0], drops[key[1] as usize].id, key[1]);
    all(a) < all(b)
}

/// The lists of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TileLists {
    /// Edge of a tile, pixels.
    edge: u32,
    /// Tiles across the picture.
    across: u32,
    /// Begin of each list, and of one more.
    starts: Vec<u32>,
    drops: Vec<u32>,
}

impl TileLists {
    /// The lists of some drops; the same for any number of threads.
    #[must_use]
    pub fn new(drops: &[ScreenDrop], size: [u32; 2]) -> Self {
        Self::with_room(drops, size, TilesFrame::new(size, drops.len() as u32).room)
    }

    /// The lists of some drops, with tiles so large that there is room.
    #[must_use]
    pub fn with_room(drops: &[ScreenDrop], size: [u32; 2], room: u32) -> Self {
        Self::of(drops, size, room, tiles_is_listed)
    }

    /// Lists of all drops, those that are summed up among them.
    #[must_use]
    pub fn of_all(drops: &[ScreenDrop], size: [u32; 2]) -> Self {
        Self::of(drops, size, TilesFrame::new(size, drops.len() as u32).room, |_| true)
    }

    fn of(drops: &[ScreenDrop], size: [u32; 2], room: u32, is_listed: fn(&ScreenDrop) -> bool) -> Self {
        let mut totals = [0; TILES_EDGES as usize];
        for drop in drops.iter().filter(|drop| is_listed(drop)) {
            for (k, total) in totals.iter_mut().enumerate() {
                *total += u64::from(tiles_bound(drop, DROPS_TILE << k, size));
            }
        }
        let edge = tiles_edge(&totals, room);
        let [across, down] = size.map(|pixels| pixels.div_ceil(edge));
        let touched = |index: u32, each: &mut dyn FnMut(usize)| {
            let drop = &drops[index as usize];
            if !is_listed(drop) {
                return;
            }
            let Some([top, bottom]) = tiles_rows(drop, edge, size) else { return };
            for row in top..=bottom {
                let Some([left, right]) = tiles_columns(drop, row, edge, size[0]) else { continue };
                (left..=right).for_each(|column| each((row * across + column) as usize));
            }
        };
        let Bins { starts, items: mut lists } =
            Bins::new((across * down) as usize, drops.len() as u32, touched);
        let mut rest = lists.as_mut_slice();
        let mut all = Vec::with_capacity(starts.len());
        for pair in starts.windows(2) {
            let (list, behind) = rest.split_at_mut((pair[1] - pair[0]) as usize);
            all.push(list);
            rest = behind;
        }
        all.into_par_iter().for_each(|list| {
            list.sort_unstable_by(|&a, &b| {
                let keys = [tiles_key(drops, a), tiles_key(drops, b)];
                match tiles_is_before(drops, keys[0], keys[1]) {
                    _ if a == b => Ordering::Equal,
                    true => Ordering::Less,
                    false => Ordering::Greater,
                }
            });
        });
        Self { edge, across, starts, drops: lists }
    }

    /// The list of the tile of a pixel, nearest first.
    #[must_use]
    pub fn of_pixel(&self, x: u32, y: u32) -> &[u32] {
        let tile = ((y / self.edge) * self.across + x / self.edge) as usize;
        &self.drops[self.starts[tile] as usize..self.starts[tile + 1] as usize]
    }

    /// The lists as the shader has them.
    #[must_use]
    pub fn words(&self) -> Vec<u32> {
        let first = self.starts.len() as u32 + 1;
        let starts = self.starts.iter().map(|start| start + first);
        std::iter::once(self.edge).chain(starts).chain(self.drops.iter().copied()).collect()
    }
}
