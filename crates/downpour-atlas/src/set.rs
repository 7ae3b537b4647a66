//! Streaks of one drop and one oscillation: contents of a file.

use downpour_shaders::atlas::{ATLAS_GRID, ATLAS_RISES};
use half::f16;

use crate::AtlasError;
use crate::{StreakOptions, StreakOscillation, StreakTracer, amount_directions, amount_elevations};

/// Origin of the streaks of a set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StreakOrigin {
    /// Traced here.
    Traced,
    /// The streak database of Columbia University: brightnesses without a unit.
    Columbia,
}

/// The streaks of one drop and one oscillation, over elevations of the viewer and directions of the light.
#[derive(Clone, Debug, PartialEq)]
pub struct StreakSet {
    /// Origin of the streaks.
    pub origin: StreakOrigin,
    /// Equivalent diameter in meters.
    pub diameter: f64,
    /// The oscillation.
    pub oscillation: StreakOscillation,
    /// Options of the tracer.
    pub options: StreakOptions,
    /// Elevations of the viewer above the drop's horizontal plane in radians, ascending.
    pub elevations: Vec<f64>,
    /// For each elevation, the directions toward the light in the frame of the streak, x >= 0; all of one length.
    pub directions: Vec<Vec<[f64; 3]>>,
    /// `columns * rows` texels for each elevation and direction.
    pub texels: Vec<f16>,
    /// For each of [`amount_elevations`], the amounts for [`amount_directions`], in 1/sr for an irradiance of 1: 25 grids of 41 rows of
    /// 41. Or none: then an atlas interpolates them between the means of the layers.
    pub amounts: Vec<f16>,
}

/// The amounts in messages.
pub(crate) const AMOUNTS: &str = "amounts of streaks (key DownpourStreakAmounts)";
/// Rows of a streak that is traced for its amount: a tenth of the rays is enough for a mean.
const AMOUNT_ROWS: u32 = 8;
/// Smallest normal half float: below it half floats lose digits, and drivers may flush them to 0.
const MIN_NORMAL_F16: f32 = 6.104e-5;

/// A radiance as it is stored.
pub(crate) fn stored(radiance: f32) -> f16 {
    if radiance < MIN_NORMAL_F16 { f16::ZERO } else { f16::from_f32(radiance.min(f16::MAX.to_f32())) }
}

impl StreakSet {
    /// Traces a set; all elevations have the same directions.
    ///
    /// # Errors
    /// As [`StreakTracer::new`] and [`StreakTracer::trace`], and as [`StreakSet::check`].
    pub fn trace(
        diameter: f64,
        oscillation: &StreakOscillation,
        elevations: &[f64],
        directions: &[[f64; 3]],
        options: &StreakOptions,
    ) -> Result<Self, AtlasError> {
        let tracer = StreakTracer::new(diameter, oscillation, options)?;
        let mut texels = Vec::new();
        for &elevation in elevations {
            let streaks = tracer.trace(elevation, directions)?;
            texels.extend(streaks.radiance.iter().flatten().map(|&v| stored(v)));
        }
        let rows = options.rows.min(AMOUNT_ROWS);
        let tracer = StreakTracer::new(diameter, oscillation, &StreakOptions { rows, ..*options })?;
        let (grid, mut amounts) = (amount_directions(), Vec::new());
        for elevation in amount_elevations() {
            amounts.extend(tracer.amounts(elevation, &grid)?.iter().map(|&v| stored(v as f32)));
        }
        let set = Self {
            origin: StreakOrigin::Traced,
            diameter,
            oscillation: *oscillation,
            options: *options,
            elevations: elevations.to_vec(),
            directions: vec![directions.to_vec(); elevations.len()],
            texels,
            amounts,
        };
        set.check()?;
        Ok(set)
    }

    /// Layers: elevations times directions.
    #[must_use]
    pub fn layers(&self) -> usize {
        self.directions.iter().map(Vec::len).sum()
    }

    /// Texels of a layer.
    #[must_use]
    pub fn layer_texels(&self) -> usize {
        self.options.columns as usize * self.options.rows as usize
    }

    /// The texels of one layer.
    #[must_use]
    pub fn layer(&self, elevation: usize, direction: usize) -> Option<&[f16]> {
        let directions = self.directions.get(elevation)?.len();
        let first = (elevation * directions + direction) * self.layer_texels();
        if direction < directions { self.texels.get(first..first + self.layer_texels()) } else { None }
    }

    /// Checks that the parts are consistent.
    ///
    /// # Errors
    /// [`AtlasError`] for options, elevations, directions or texels that are wrong.
    pub fn check(&self) -> Result<(), AtlasError> {
        let wrong = |location, found: String, allowed| Err(AtlasError::File { location, found, allowed });
        self.options.check()?;
        self.oscillation.amplitudes()?;
        downpour_drop::DropShape::new(self.diameter)?;
        let ascending = self.elevations.windows(2).all(|pair| pair[0] < pair[1]);
        let within = self.elevations.iter().all(|e| (-1.5..=1.5).contains(e));
        if !(ascending && within && (1..=crate::MAX_SETS).contains(&self.elevations.len())) {
            let found = format!("{:?} radians", self.elevations);
            return wrong("elevations of streaks", found, "1 to 9, ascending, within 85 degrees");
        }
        let count = self.directions.first().map_or(0, Vec::len);
        if self.directions.len() != self.elevations.len() || self.directions.iter().any(|d| d.len() != count)
        {
            let found = format!("{} lists", self.directions.len());
            return wrong("directions of streaks", found, "a list of one length for each elevation");
        }
        let bad = |d: &&[f64; 3]| {
            let square: f64 = d.iter().map(|c| c * c).sum();
            !((square - 1.0).abs() < 1.0e-4 && d[0] >= 0.0)
        };
        if let Some(direction) = self.directions.iter().flatten().find(bad) {
            return wrong("directions of streaks", format!("{direction:?}"), "unit vectors with x >= 0");
        }
        if self.texels.len() != self.layers() * self.layer_texels() {
            let found = format!("{} texels", self.texels.len());
            return wrong("streaks", found, "columns times rows for each direction and elevation");
        }
        let nodes = (ATLAS_RISES * ATLAS_GRID * ATLAS_GRID) as usize;
        if !(self.amounts.is_empty() || self.amounts.len() == nodes) {
            return wrong(AMOUNTS, format!("{} of them", self.amounts.len()), "25 x 41 x 41, or none");
        }
        let usable = |v: &f16| v.is_finite() && *v >= f16::ZERO;
        if let Some(at) = self.amounts.iter().position(|v| !usable(v)) {
            let found = format!("{} in node {at}", self.amounts[at]);
            return wrong(AMOUNTS, found, "finite amounts, 0 or more");
        }
        if let Some(at) = self.texels.iter().position(|v| !usable(v)) {
            let found = format!("{} in texel {at}", self.texels[at]);
            return wrong("streaks", found, "finite radiances, 0 or more");
        }
        Ok(())
    }
}
