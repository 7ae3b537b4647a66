//! Puddles as rows of the scene's table.

use downpour_shaders::render::puddle_water::PUDDLE_WATER_MOST;
use glam::{Vec2, Vec3};

use super::map::{PuddleMap, turned};
use crate::data::SceneData;

/// How a puddle looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PuddleLook {
    /// Size of the ripples, as a multiple of what they are.
    pub scale: f32,
    /// Turn of the ripples, rad.
    pub angle: f32,
    /// Slopes of the ripples, as a multiple of what they are.
    pub influence: f32,
    /// Water less deep than this, in m, has smaller ripples.
    pub rippling_depth: f32,
    /// Albedo of water so deep that the ground is not seen.
    pub murk: Vec3,
    /// Share of light that is lost per metre of water, 1/m.
    pub extinction: f32,
}

impl Default for PuddleLook {
    /// Ripples as they are, from 1.5 mm on as large as they get; water that rain has stirred, clear for 0.25 m.
    fn default() -> Self {
        Self {
            scale: 1.0,
            angle: 0.0,
            influence: 1.0,
            rippling_depth: 1.5e-3,
            murk: Vec3::new(0.12, 0.105, 0.08),
            extinction: 4.0,
        }
    }
}

/// Puddles and their ripples on their way into a scene.
#[derive(Clone, Copy, Debug)]
pub struct PuddleRows<'a> {
    /// The puddles, at most [`PUDDLE_WATER_MOST`]; those beyond are left out.
    pub puddles: &'a [(PuddleMap, PuddleLook)],
    /// Columns of the finest level of the ripples, levels, edge of a cell (m).
    pub shape: (u32, u32, f32),
    /// [`Ripples::slopes`](super::Ripples::slopes); none: level water.
    pub slopes: &'a [[f32; 4]],
    /// Added to the place of each map, m.
    pub shift: Vec3,
}

impl SceneData {
    /// Lays puddles on the ground, in place of those that lie there. A pane is hung after that
    /// ([`SceneData::hang_pane`]): it is taken down.
    pub fn lay_puddles(&mut self, rows: &PuddleRows<'_>) {
        self.clear_pane();
        if self.puddle_count > 0 {
            self.table.truncate(self.puddles as usize);
        }
        let puddles = &rows.puddles[..rows.puddles.len().min(PUDDLE_WATER_MOST as usize)];
        self.puddles = self.table.len() as u32;
        self.puddle_count = puddles.len() as u32;
        if puddles.is_empty() {
            return;
        }
        let words = |numbers: [f32; 4]| numbers.map(f32::to_bits);
        let head = puddles.len() * downpour_shaders::render::puddle_water::PUDDLE_WATER_ROWS as usize + 1;
        let mut first = self.puddles + head as u32;
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
                [map.size[0] as u32, map.size[1] as u32, first, 0],
                words([look.scale, ripples.x, ripples.y, look.influence]),
                words([look.murk.x, look.murk.y, look.murk.z, look.extinction]),
                words([look.rippling_depth, own.x, own.y, 0.0]),
            ]);
            first += map.cells.len() as u32;
        }
        let (size, levels, cell) = rows.shape;
        let size = if rows.slopes.is_empty() { 0 } else { size };
        self.table.push([size, levels, first, cell.to_bits()]);
        for (map, _) in puddles {
            self.table.extend(map.cells.iter().map(|&cell| words(cell)));
        }
        self.table.extend(rows.slopes.iter().map(|&slope| words(slope)));
    }
}
