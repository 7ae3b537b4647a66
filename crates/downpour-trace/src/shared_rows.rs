//! Rows behind those of a scene's table that its copies share: maps of puddles, how their water runs, and the slopes of rings on them.
//!
//! They are large and change seldom, where the table is copied for each frame. A row has one number in both: that of the first shared row
//! is the number of rows of the table.

use std::sync::Arc;

use downpour_shaders::render::puddle_flow::PUDDLE_FLOW_ROW;
use downpour_shaders::render::puddle_water::PUDDLE_WATER_ROWS;

use crate::data::SceneData;

/// Row of a puddle whose third number is the first row of its map.
const MAP_ROW: u32 = 2;

/// Row behind that of the ripples whose first number is the first row of the slopes of rings.
const SLOPES_ROW: u32 = 2;

/// Rows that scenes share.
#[derive(Clone, Debug)]
pub enum SharedRows {
    /// Slopes of rings.
    Slopes(Arc<[[u32; 4]]>),
    /// The map of a puddle.
    Map(u32, Arc<[[f32; 4]]>),
    /// How the water of a puddle runs.
    Flow(u32, Arc<[[u32; 4]]>),
}

impl SharedRows {
    /// The rows, as the shaders read them.
    #[must_use]
    pub fn rows(&self) -> &[[u32; 4]] {
        match self {
            Self::Slopes(rows) | Self::Flow(_, rows) => rows,
            Self::Map(_, rows) => bytemuck::cast_slice(rows),
        }
    }

    /// True for the same rows in the same memory.
    #[must_use]
    pub fn is(&self, other: &Self) -> bool {
        std::ptr::eq(self.rows(), other.rows())
    }
}

impl SceneData {
    /// The shared rows, each with the number of its first row.
    #[must_use]
    pub fn shared_places(&self) -> Vec<(u32, &SharedRows)> {
        let mut next = self.table.len() as u32;
        let mut places = Vec::with_capacity(self.shared.len());
        for rows in &self.shared {
            places.push((next, rows));
            next += rows.rows().len() as u32;
        }
        places
    }

    /// Number of rows of the table and of those that are shared.
    #[must_use]
    pub fn row_count(&self) -> usize {
        self.table.len() + self.shared.iter().map(|rows| rows.rows().len()).sum::<usize>()
    }

    /// Reads a row of the table or one that is shared.
    pub(crate) fn row(&self, row: u32) -> [u32; 4] {
        let mut row = row as usize;
        if row < self.table.len() {
            return self.table[row];
        }
        row -= self.table.len();
        for rows in self.shared.iter().map(SharedRows::rows) {
            if row < rows.len() {
                return rows[row];
            }
            row -= rows.len();
        }
        [0; 4]
    }

    /// Tells the puddles of the table where their shared rows are: after each change of the table's length.
    pub(crate) fn place_shared(&mut self) {
        let of_puddle = |k: u32, row: u32| self.puddles + k * PUDDLE_WATER_ROWS + row;
        let place = |(first, rows): (u32, &SharedRows)| match rows {
            SharedRows::Slopes(_) => (self.ripples_row() + SLOPES_ROW, 0, first),
            SharedRows::Map(k, _) => (of_puddle(*k, MAP_ROW), 2, first),
            SharedRows::Flow(k, _) => (of_puddle(*k, PUDDLE_FLOW_ROW), 0, first),
        };
        let places: Vec<(u32, usize, u32)> = self.shared_places().into_iter().map(place).collect();
        for (row, number, first) in places {
            self.table[row as usize][number] = first;
        }
    }
}
