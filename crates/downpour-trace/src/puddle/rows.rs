//! Puddles as rows of the scene's table. Twin of `shaders/wgsl/render/puddle.wgsl`.

use std::sync::Arc;

use downpour_shaders::render::puddle_rings::PUDDLE_RINGS_ROWS;
use downpour_shaders::render::puddle_wake::PUDDLE_WAKE_ROW;
use downpour_shaders::render::puddle_water::{PUDDLE_WATER_MAX_COUNT, PUDDLE_WATER_ROWS};
use glam::{Vec2, Vec3, Vec4};

use super::map::{PuddleMap, turned};
use super::rings::RingRows;
use super::wakes::WakeRows;
use crate::data::SceneData;
use crate::scene::puddle_flow::cycle_row;
use crate::shared_rows::SharedRows;

/// Appearance of a puddle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PuddleLook {
    /// Size of the ripples, as a multiple of the true one.
    pub scale: f32,
    /// Turn of the ripples, rad.
    pub angle: f32,
    /// Slopes of the ripples, as a multiple of the true ones.
    pub influence: f32,
    /// Water less deep than this, in m, has smaller ripples.
    pub rippling_depth: f32,
    /// Albedo of water so deep that the ground is not seen.
    pub scattering_albedo: Vec3,
    /// Fraction of light that is lost per meter of water, 1/m.
    pub extinction: f32,
    /// True if single drops make rings near the eye; ripples that are not of the true size have none.
    pub rings: bool,
}

impl PuddleLook {
    /// True if single drops make rings.
    pub(crate) fn has_rings(&self) -> bool {
        self.rings && self.scale == 1.0 && self.influence > 0.0
    }
}

impl Default for PuddleLook {
    /// Ripples as they are, from 1.5 mm on as large as they get; water that rain has stirred, clear for 0.25 m.
    fn default() -> Self {
        Self {
            scale: 1.0,
            angle: 0.0,
            influence: 1.0,
            rippling_depth: 1.5e-3,
            scattering_albedo: Vec3::new(0.12, 0.105, 0.08),
            extinction: 4.0,
            rings: true,
        }
    }
}

/// Puddles and their ripples, to be added to a scene.
#[derive(Clone, Copy, Debug)]
pub struct PuddleRows<'a> {
    /// The puddles, at most [`PUDDLE_WATER_MAX_COUNT`]; those beyond are left out.
    pub puddles: &'a [(PuddleMap, PuddleLook)],
    /// Columns of the finest level of the ripples, levels, edge of a cell (m).
    pub shape: (u32, u32, f32),
    /// [`Ripples::slopes`](super::Ripples::slopes); none: level water, or ripples that a device holds.
    pub slopes: &'a [[f32; 4]],
    /// Added to the position of each map, m.
    pub shift: Vec3,
    /// Rings of single drops near the eye.
    pub rings: Option<&'a RingRows>,
    /// Waves of what moves through some of the puddles.
    pub wakes: &'a [WakeRows],
    /// Time of the picture, s: ripples move with water that runs.
    pub time_s: f64,
}

/// Water on the ground as the shaders read it. Twin of the WGSL struct of the same name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RenderPuddle {
    /// Middle of the map.
    pub(crate) middle: Vec3,
    /// Cosine and sine of the map's turn, and half its edges, m.
    pub(crate) axes: Vec4,
    /// Columns, rows and first row of the texels of the map.
    pub(crate) map: [u32; 3],
    /// Ripples: scale, cosine and sine of the angle, influence.
    pub(crate) ripples: Vec4,
    /// Albedo of deep water.
    pub(crate) scattering_albedo: Vec3,
    /// Fraction of light that is lost per meter of water, 1/m.
    pub(crate) extinction: f32,
    /// Depth of full ripples, and the puddle's own part of the lattice.
    pub(crate) own: Vec3,
    /// 1: the rings of single drops are shown where they are large enough.
    pub(crate) rings: f32,
}

/// The lattice of the ripples of all puddles as the shaders read it. Twin of the WGSL struct of the same name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RenderRipples {
    /// Columns of the finest level; 0: level water.
    pub(crate) size: u32,
    /// Number of levels.
    pub(crate) levels: u32,
    /// First row of the texels.
    pub(crate) first: u32,
    /// Edge of a cell, m.
    pub(crate) cell: f32,
}

impl SceneData {
    /// Reads a puddle.
    pub(crate) fn puddle_load(&self, index: u32) -> RenderPuddle {
        let first = (self.puddles + index * PUDDLE_WATER_ROWS) as usize;
        let rows = &self.table[first..first + PUDDLE_WATER_ROWS as usize];
        let numbers = |k: usize| Vec4::from(rows[k].map(f32::from_bits));
        let [columns, lines, texels, _] = rows[2];
        RenderPuddle {
            middle: numbers(0).truncate(),
            axes: numbers(1),
            map: [columns, lines, texels],
            ripples: numbers(3),
            scattering_albedo: numbers(4).truncate(),
            extinction: numbers(4).w,
            own: numbers(5).truncate(),
            rings: numbers(5).w,
        }
    }

    /// Row of the lattice of the ripples, behind the puddles.
    pub(crate) fn ripples_row(&self) -> u32 {
        self.puddles + self.puddle_count * PUDDLE_WATER_ROWS
    }

    /// Reads the lattice of the ripples.
    pub(crate) fn puddle_ripples(&self) -> RenderRipples {
        let [size, levels, first, cell] = self.table[self.ripples_row() as usize];
        RenderRipples { size, levels, first, cell: f32::from_bits(cell) }
    }

    /// Reads a texel of a map or of the ripples.
    pub(crate) fn puddle_texel(&self, row: u32) -> Vec4 {
        Vec4::from(self.row(row).map(f32::from_bits))
    }

    /// Sets the puddles of the scene; replaces earlier ones.
    pub fn set_puddles(&mut self, rows: &PuddleRows<'_>) {
        // A pane comes after the puddles in the table, wherever they end.
        let pane = self.take_pane();
        if self.puddle_count > 0 {
            self.table.truncate(self.puddles as usize);
            self.shared.clear();
        }
        let puddles = &rows.puddles[..rows.puddles.len().min(PUDDLE_WATER_MAX_COUNT as usize)];
        self.puddles = self.table.len() as u32;
        self.puddle_count = puddles.len() as u32;
        #[cfg(feature = "wgpu")]
        {
            self.ripples = None;
        }
        if !puddles.is_empty() {
            self.add_puddles(puddles, rows);
        }
        self.add_pane(&pane);
    }

    /// Adds the rows of puddles at the end of the table.
    fn add_puddles(&mut self, puddles: &[(PuddleMap, PuddleLook)], rows: &PuddleRows<'_>) {
        let words = |numbers: [f32; 4]| numbers.map(f32::to_bits);
        let head = puddles.len() * PUDDLE_WATER_ROWS as usize + 1 + PUDDLE_RINGS_ROWS as usize;
        let first = self.puddles + head as u32;
        for (k, (map, look)) in (0u16..).zip(puddles) {
            let middle = map.ground.middle + rows.shift;
            let turn = turned(map.ground.turn);
            let half = map.ground.size * 0.5;
            let ripples = turned(look.angle);
            // Each puddle has its own part of the ripples.
            let own = Vec2::new(3.7, 11.3) * f32::from(k);
            self.table.extend([
                words([middle.x, middle.y, middle.z, 0.0]),
                words([turn.x, turn.y, half.x, half.y]),
                // The first row of its map is known when the table is whole.
                [map.size[0] as u32, map.size[1] as u32, 0, 0],
                words([look.scale, ripples.x, ripples.y, look.influence]),
                words([
                    look.scattering_albedo.x,
                    look.scattering_albedo.y,
                    look.scattering_albedo.z,
                    look.extinction,
                ]),
                words([look.rippling_depth, own.x, own.y, if look.has_rings() { 1.0 } else { 0.0 }]),
            ]);
            // No wakes and no flow, as far as it is known yet.
            self.table.extend([[0; 4], cycle_row(rows.time_s)]);
        }
        let (size, levels, cell) = rows.shape;
        let size = if rows.slopes.is_empty() { 0 } else { size };
        self.table.push([size, levels, first, cell.to_bits()]);
        let behind = first + rows.slopes.len() as u32;
        self.table.extend(
            rows.rings.map_or([[0; 4]; PUDDLE_RINGS_ROWS as usize], |rings| rings.head(behind, rows.shift)),
        );
        self.table.extend(rows.slopes.iter().map(|&slope| words(slope)));
        if let Some(rings) = rows.rings {
            rings.extend(&mut self.table);
            self.shared.push(SharedRows::Slopes(rings.slopes()));
        }
        for (k, (map, _)) in (0u32..).zip(puddles) {
            self.shared.push(SharedRows::Map(k, Arc::clone(&map.cells)));
            self.shared.extend(map.flow.iter().map(|flow| SharedRows::Flow(k, Arc::clone(&flow.0))));
        }
        for wake in rows.wakes.iter().filter(|wake| wake.puddle < puddles.len()) {
            let [columns, lines] = wake.size.map(|count| count as u32);
            let row = self.puddles + wake.puddle as u32 * PUDDLE_WATER_ROWS + PUDDLE_WAKE_ROW;
            self.table[row as usize] = [columns, lines, self.table.len() as u32, wake.cell_m.to_bits()];
            self.table.extend(wake.slopes.iter().map(|&slope| words(slope)));
        }
    }
}
