//! Pictures of a pane: affinity, friction and obstacles of its glass.

use std::sync::{Arc, OnceLock};

use super::{Pane, Weather};
use downpour_lattice::glass::GlassTexture;
use downpour_scene::Budget;
use downpour_scene::error::SceneError;
use downpour_scene::picture::{self, Picture, Pixels};
use downpour_scene::sandbox::Files;
use downpour_scene::uri::RelativePath;

/// Maximum number of pixels along an edge of a picture of a pane.
const MAX_EDGE: u32 = 4096;

/// Largest friction in a picture, as a multiple of the usual one: white.
const MAX_FRICTION: f32 = 1.99;

/// Red from which on a cell is an obstacle.
const OBSTACLE: f32 = 0.5;

/// A picture over the visible pane: red, linear, 0 to 1. [`load`](crate::load) reads it; until then the pane is as without it.
#[derive(Clone, Debug, PartialEq)]
pub struct PaneMap {
    /// The file.
    pub file: RelativePath,
    red: Arc<OnceLock<Red>>,
}

/// The red channel of a picture.
#[derive(Debug, PartialEq)]
struct Red {
    size: [usize; 2],
    values: Vec<f32>,
}

impl PaneMap {
    pub(super) fn new(file: RelativePath) -> Self {
        Self { file, red: Arc::default() }
    }

    fn read(&self, files: &dyn Files, budget: &mut Budget) -> Result<(), SceneError> {
        let name = self.file.as_str();
        let mut read = || {
            let bytes = files.open(&self.file)?.read_all(budget)?;
            let picture = picture::decode(name, &bytes, budget)?;
            if picture.width.max(picture.height) > MAX_EDGE {
                let found = format!("a map of {} x {} pixels", picture.width, picture.height);
                return Err(SceneError::limit("", found, format!("1 to {MAX_EDGE} pixels along each edge")));
            }
            picture.strict()
        };
        let picture = read().map_err(|error| error.in_file(name))?;
        // The files of a weather do not change after they were read once.
        self.red.get_or_init(|| Red::new(&picture));
        Ok(())
    }

    /// Values at the cells of a lattice, row by row; the uppermost `above` rows are those of the picture's upper edge. `None` before
    /// the file was read.
    fn values(&self, [columns, rows]: [u32; 2], above: u32) -> Option<Vec<f32>> {
        let red = self.red.get()?;
        let shown = rows.saturating_sub(above).max(1);
        let row = |y: u32| (0..columns).map(move |x| red.at(x, columns, y.saturating_sub(above), shown));
        Some((0..rows).flat_map(row).collect())
    }
}

impl Red {
    fn new(picture: &Picture) -> Self {
        let values = match &picture.pixels {
            Pixels::Rgba8(pixels) => pixels.iter().map(|[red, ..]| f32::from(*red) / 255.0).collect(),
            Pixels::RgbaF32(pixels) => pixels.iter().map(|[red, ..]| red.clamp(0.0, 1.0)).collect(),
        };
        Self { size: [picture.width as usize, picture.height as usize], values }
    }

    /// Bilinear interpolation at the center of cell `x` of `columns`, `y` of `rows`.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the pixels")]
    fn at(&self, x: u32, columns: u32, y: u32, rows: u32) -> f32 {
        let [width, height] = self.size;
        let pixel = |cell: u32, cells: u32, pixels: usize| {
            let last = pixels.saturating_sub(1) as f64;
            let at = ((f64::from(cell) + 0.5) / f64::from(cells) * pixels as f64 - 0.5).clamp(0.0, last);
            let low = at.floor();
            (low as usize, (low as usize).saturating_add(1).min(pixels.saturating_sub(1)), (at - low) as f32)
        };
        let (left, right, s) = pixel(x, columns, width);
        let (top, bottom, t) = pixel(y, rows, height);
        let value = |column: usize, row: usize| {
            let index = row.saturating_mul(width).saturating_add(column);
            self.values.get(index).copied().unwrap_or_default()
        };
        let upper = value(left, top) * (1.0 - s) + value(right, top) * s;
        let lower = value(left, bottom) * (1.0 - s) + value(right, bottom) * s;
        upper * (1.0 - t) + lower * t
    }
}

impl Pane {
    /// Affinity of the glass in a lattice of this size.
    pub(super) fn affinity_texture(&self, size: [u32; 2], above: u32, usual: GlassTexture) -> GlassTexture {
        let values = self.affinity.as_ref().and_then(|map| map.values(size, above));
        values.map_or(usual, GlassTexture::Given)
    }

    /// Friction of the glass: black has none, middle gray the usual one, white nearly twice that.
    pub(super) fn friction_texture(&self, size: [u32; 2], above: u32, usual: GlassTexture) -> GlassTexture {
        let values = self.friction_map.as_ref().and_then(|map| map.values(size, above));
        values.map_or(usual, |values| {
            GlassTexture::Given(values.iter().map(|red| (2.0 * red).min(MAX_FRICTION)).collect())
        })
    }

    /// Cells that hold no water.
    pub(super) fn obstacle_cells(&self, size: [u32; 2], above: u32) -> Option<Vec<bool>> {
        let values = self.obstacles.as_ref()?.values(size, above)?;
        Some(values.iter().map(|red| *red >= OBSTACLE).collect())
    }
}

/// Reads the pictures of a weather's pane.
pub(super) fn read_pane_maps(
    weather: &Weather,
    files: &dyn Files,
    budget: &mut Budget,
) -> Result<(), SceneError> {
    let Some(pane) = &weather.glass else { return Ok(()) };
    let maps = [&pane.affinity, &pane.friction_map, &pane.obstacles];
    maps.into_iter().flatten().try_for_each(|map| map.read(files, budget))
}
