//! Pixels whose rays look for light that is much the same in neighboring pixels. Twin of `shaders/wgsl/render/spacing.wgsl`.

#[cfg(feature = "wgpu")]
use downpour_shaders::render::scene::SPACING_GROUP;

/// Pixels whose rays look for light: one in each cell of `spacing` times `spacing` pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct RaySpacing {
    spacing: u32,
    column: u32,
    row: u32,
}

impl RaySpacing {
    /// All pixels.
    pub const ALL: Self = Self { spacing: 1, column: 0, row: 0 };

    /// One pixel in each cell of `spacing` times `spacing`, at least 1: that in a column and a row of it, counted on from 0 beyond its edge.
    #[must_use]
    pub fn new(spacing: u32, column: u32, row: u32) -> Self {
        let spacing = spacing.max(1);
        Self { spacing, column: column % spacing, row: row % spacing }
    }

    /// Distance in pixels between those that look for light, at least 1.
    #[must_use]
    pub fn spacing(&self) -> u32 {
        self.spacing
    }

    /// Column and row of the one in each cell.
    #[must_use]
    pub fn place(&self) -> [u32; 2] {
        [self.column, self.row]
    }

    /// True if rays of a pixel look for light; else those of its neighbors do for it.
    #[must_use]
    pub fn spacing_looks(&self, x: u32, y: u32) -> bool {
        x % self.spacing == self.column && y % self.spacing == self.row
    }

    /// Workgroups of 8 times 8 invocations for so many pixels, columns and rows: as many as there are pixels in a cell share an area of
    /// 64 cells.
    #[cfg(feature = "wgpu")]
    #[must_use]
    pub fn workgroups(&self, size: [u32; 2]) -> [u32; 3] {
        let [columns, rows] = size.map(|size| size.div_ceil(SPACING_GROUP * self.spacing) * self.spacing);
        [columns, rows, 1]
    }
}

/// First column (or row) of a window that reaches so far around a pixel, of those that lie `apart` with one of them at `place`.
#[must_use]
pub fn spacing_first(at: u32, apart: u32, reach: u32, place: u32) -> u32 {
    let first = at.saturating_sub(reach);
    first + (place + apart - first % apart) % apart
}

/// The columns (or rows) of that window, below `size`.
pub fn window(at: u32, apart: u32, reach: u32, place: u32, size: u32) -> impl Iterator<Item = u32> {
    (spacing_first(at, apart, reach, place)..=(at + reach).min(size - 1)).step_by(apart as usize)
}
