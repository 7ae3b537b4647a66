//! Grid of the air that is open to the rain. Twin of `shaders/wgsl/render/medium_open.wgsl`, where the method is described.

use downpour_math::ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::render::medium::{MEDIUM_NEAR, MEDIUM_RANDOM_DIMENSION, MEDIUM_SLICES};
use glam::{Vec2, Vec3};

use super::frame::medium_node;
use super::light::MediumLight;

/// Distance of the end of a slice, m.
pub(super) fn medium_open_end(slice: u32) -> f32 {
    medium_node(2 * slice + 1)
}

/// Distance at which a slice begins, m.
fn medium_open_begin(slice: u32) -> f32 {
    if slice == 0 { 0.0 } else { medium_open_end(slice - 1) }
}

/// Distance along the ray of a cell at which the slice asks for what is above it, where a surface is at the distance `solid`.
fn medium_open_asks(word: u32, slice: u32, solid: f32) -> f32 {
    let part = rng_unit(word) + 0.618_034 * slice as f32;
    let part = part - part.floor();
    let [begin, end] = [medium_open_begin(slice), medium_open_end(slice)];
    let before_solid = if begin < solid { end.min(solid) } else { end };
    begin + (before_solid - begin) * part
}

/// The slice of a distance.
pub(super) fn medium_open_slice(distance: f32) -> u32 {
    let position = 0.5 * (3.0 * ops::log2((distance / MEDIUM_NEAR).max(1.0)) + 1.0);
    (position as u32).min(MEDIUM_SLICES - 1)
}

impl MediumLight<'_> {
    /// The middle of a cell of the grid on the picture, pixels from the top left.
    fn medium_open_middle(&self, column: u32, row: u32) -> Vec2 {
        let cells = Vec2::new(self.medium.columns as f32, self.medium.rows as f32);
        let part = (Vec2::new(column as f32, row as f32) + 0.5) / cells;
        part * Vec2::new(self.camera.width as f32, self.camera.height as f32)
    }

    /// The slices of a cell; `clean` is the scene's picture with its distances.
    pub(super) fn slices_of(&self, clean: &[[f32; 4]], cell: u32) -> [[f32; 4]; MEDIUM_SLICES as usize] {
        let medium = &self.medium;
        let middle = self.medium_open_middle(cell % medium.columns, cell / medium.columns);
        let direction = self.camera.camera_direction(middle.x, middle.y);
        let span = medium.medium_span(direction);
        let outline = medium.medium_outline(direction);
        let [word, ..] = rng_draw([self.camera.seed, 0], cell, 0, MEDIUM_RANDOM_DIMENSION);
        let eye = Vec3::from(medium.eye);
        // Rays look for obstacles above the air before what the pixel shows.
        let [.., solid] = clean[(middle.y as u32 * self.camera.width + middle.x as u32) as usize];
        let mut depth = 0.0;
        std::array::from_fn(|slice| {
            let slice = slice as u32;
            let above = || eye + direction * medium_open_asks(word, slice, solid);
            let is_open = medium.open == 1 || !self.lighting.is_covered(above(), medium.rise.into());
            let open = if is_open { 1.0 } else { 0.0 };
            let depth_to = |distance| medium.medium_depth(distance, span, outline);
            let before = if slice > 0 { depth_to(medium_open_begin(slice)) } else { 0.0 };
            depth += (depth_to(medium_open_end(slice)) - before) * open;
            [depth, open, 0.0, 0.0]
        })
    }

    /// Optical depth along the ray of a cell up to a part of a slice, and 1 if the slice is open.
    fn medium_open_cell(&self, grid: &[[f32; 4]], column: u32, row: u32, slice: u32, part: f32) -> Vec2 {
        let at = ((row * self.medium.columns + column) * MEDIUM_SLICES + slice) as usize;
        let here = grid[at];
        let before = if slice > 0 { grid[at - 1][0] } else { 0.0 };
        Vec2::new(before + (here[0] - before) * part, here[1])
    }

    /// Optical depth of unresolved drops up to a distance along the ray through a position of the picture (pixels from the top
    /// left), and whether the air is open to the rain there.
    pub(super) fn medium_open_at(&self, grid: &[[f32; 4]], x: f32, y: f32, distance: f32) -> Vec2 {
        let (medium, camera) = (&self.medium, self.camera);
        let direction = self.camera.camera_direction(x, y);
        let span = medium.medium_span(direction);
        let outline = medium.medium_outline(direction);
        let whole = medium.medium_depth(distance, span, outline);
        if medium.open == 1 {
            return Vec2::new(whole, 1.0);
        }
        let slice = medium_open_slice(distance);
        let mut begin = 0.0;
        if slice > 0 {
            begin = medium.medium_depth(medium_open_begin(slice), span, outline);
        }
        let end = medium.medium_depth(medium_open_end(slice), span, outline);
        // Beyond the last slice, its density continues.
        let fraction = ((whole - begin) / (end - begin).max(1.0e-12)).max(0.0);
        let last = Vec2::new((medium.columns - 1) as f32, (medium.rows - 1) as f32);
        let size = Vec2::new(camera.width as f32, camera.height as f32);
        let position = (Vec2::new(x, y) / size * (last + 1.0) - 0.5).clamp(Vec2::ZERO, last);
        let low = [position.x as u32, position.y as u32];
        let high = [(low[0] + 1).min(last.x as u32), (low[1] + 1).min(last.y as u32)];
        let part = position - position.floor();
        let mut sum = Vec2::ZERO;
        for k in 0..4u32 {
            let (right, below) = (k & 1 == 1, k >= 2);
            let weight =
                if right { part.x } else { 1.0 - part.x } * if below { part.y } else { 1.0 - part.y };
            let column = if right { high[0] } else { low[0] };
            let row = if below { high[1] } else { low[1] };
            sum += weight * self.medium_open_cell(grid, column, row, slice, fraction);
        }
        sum
    }
}
