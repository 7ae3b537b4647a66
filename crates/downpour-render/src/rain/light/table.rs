//! The scattering of water for red, green and blue, as the shader reads it.

use std::sync::Arc;

use downpour_atlas::StreakAtlas;
use downpour_drop::DropError;
use downpour_drop::air::Air;
use downpour_drop::optics::{SCATTERING_PATHS, SUN_DIAMETER, SphereScattering, rgb_indices};
use downpour_shaders::render::drop_light::{DROP_LIGHT_ENTRIES, DROP_LIGHT_PATHS};

use super::atlas;

const _: () = assert!(SCATTERING_PATHS == DROP_LIGHT_PATHS as usize);

/// Table of scattering cross-sections over the angle.
///
/// Row 0: (dsigma/dOmega) / (pi a^2) in 1/sr, red, green, blue. Rows 1 to 6: the same for each
/// [`ScatteringPath`](downpour_drop::optics::ScatteringPath), and green's position on the disk. Behind them, if there is
/// one, what has to be known of a streak atlas.
#[derive(Clone, Debug, PartialEq)]
pub struct DropLightTable {
    rows: Arc<Vec<[f32; 4]>>,
}

impl DropLightTable {
    /// Computes the table for three refractive indices, 1.2 to 1.4, and lamps whose disks have a diameter in radians, 0 to 0.2.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] outside these ranges.
    pub fn new(indices: [f64; 3], diameter: f64) -> Result<Self, DropError> {
        let entries = DROP_LIGHT_ENTRIES as usize;
        let mut colors = Vec::with_capacity(indices.len());
        for index in indices {
            colors.push(SphereScattering::new(index, entries, diameter)?);
        }
        let mut rows = vec![[0.0; 4]; entries * (1 + SCATTERING_PATHS)];
        let (whole, paths) = rows.split_at_mut(entries);
        for (color, sphere) in colors.iter().enumerate() {
            for (row, path) in paths.chunks_exact_mut(entries).zip(sphere.paths()) {
                for (k, entry) in row.iter_mut().enumerate() {
                    let phase = path.phase[k] as f32;
                    entry[color] = phase;
                    whole[k][color] += phase;
                    if color == 1 {
                        entry[3] = path.exit_position[k] as f32;
                    }
                }
            }
        }
        Ok(Self { rows: Arc::new(rows) })
    }

    /// Computes the table of water in standard air, for lamps of the sun's angular diameter. Three sweeps of 50 000 rays.
    ///
    /// # Errors
    /// None that is known: those of [`DropLightTable::new`] for the indices of water.
    pub fn water() -> Result<Self, DropError> {
        Self::new(rgb_indices(&Air::standard())?, SUN_DIAMETER)
    }

    /// Returns the table with the streaks of this atlas.
    #[must_use]
    pub fn with_atlas(mut self, atlas: &StreakAtlas) -> Self {
        let rows = Arc::make_mut(&mut self.rows);
        rows.truncate(atlas::FIRST_ROW as usize);
        rows.extend(atlas::rows(atlas));
        self
    }

    /// True if there is an atlas.
    #[must_use]
    pub fn has_atlas(&self) -> bool {
        self.rows.len() > atlas::FIRST_ROW as usize
    }

    /// All rows of the table.
    #[must_use]
    pub fn rows(&self) -> &[[f32; 4]] {
        &self.rows
    }

    /// True if two tables share their rows.
    #[cfg(feature = "wgpu")]
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.rows, &other.rows)
    }
}
