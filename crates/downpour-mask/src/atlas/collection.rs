//! An atlas: sets of streaks over diameters and oscillations.

use std::path::Path;

use downpour_math::ops::f64 as ops;
use downpour_math::rng::seed_words;
use downpour_shaders::mask::{ATLAS_BY_ANGLE, ATLAS_RANDOM};

use super::lookup::{
    AtlasData, AtlasFrame, AtlasPlace, AtlasTriangle, atlas_lookup_place, atlas_lookup_radiance,
};
use super::triangles::triangulate;
use super::{StreakOptions, StreakOscillation, StreakSet, read_streaks};
use crate::MaskError;

/// The most diameters, and the most elevations, of an atlas.
pub const MOST_SETS: usize = 9;
/// The largest file that is read, in bytes.
const LARGEST_FILE: u64 = 64 << 20;

/// How a particle gets its streak.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StreakPick {
    /// By diameter and by the directions of light and viewer; the oscillation by chance.
    #[default]
    ByAngle,
    /// Any layer by chance, as Im & Sung 2022 do.
    Random,
}

/// What the atlas has to know of a drop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreakParticle {
    /// Equivalent diameter in metres.
    pub diameter: f32,
    /// The drop's axis upwards, against its fall through the air: a unit vector.
    pub axis: [f32; 3],
    /// By which chance decides.
    pub id: u32,
}

/// Sets of streaks with the same directions and sizes, for every diameter the same number of oscillations.
#[derive(Clone, Debug, PartialEq)]
pub struct StreakAtlas {
    sets: Vec<StreakSet>,
    frame: AtlasFrame,
    triangles: Vec<AtlasTriangle>,
    texels: Vec<u32>,
}

impl StreakAtlas {
    /// Reads every `.ktx2` of a folder.
    ///
    /// # Errors
    /// With the file's name: [`MaskError::Unreadable`] if the folder or a file is missing or cannot be read (exit code
    /// 5), [`MaskError::InFile`] for what [`read_streaks`] says; else as [`StreakAtlas::from_sets`].
    pub fn load(folder: &Path) -> Result<Self, MaskError> {
        let unreadable =
            |path: &Path, reason: String| MaskError::Unreadable { path: path.display().to_string(), reason };
        let mut names = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(|error| unreadable(folder, error.to_string()))? {
            let path = entry.map_err(|error| unreadable(folder, error.to_string()))?.path();
            if path.extension().is_some_and(|extension| extension == "ktx2") {
                names.push(path);
            }
        }
        names.sort();
        if names.is_empty() {
            return Err(unreadable(
                folder,
                "no .ktx2 file is in it (cargo xtask atlas makes them)".to_owned(),
            ));
        }
        let mut sets = Vec::new();
        for path in names {
            let told = |error: std::io::Error| unreadable(&path, error.to_string());
            let about = std::fs::metadata(&path).map_err(told)?;
            if !about.is_file() || about.len() > LARGEST_FILE {
                let found = format!("{} bytes", about.len());
                return Err(MaskError::File { place: "file", found, allowed: "a file of at most 64 MiB" }
                    .in_file(&path));
            }
            let bytes = std::fs::read(&path).map_err(told)?;
            sets.push(read_streaks(&bytes).map_err(|error| error.in_file(&path))?);
        }
        Self::from_sets(sets).map_err(|error| error.in_file(folder))
    }

    /// Traces an atlas, in the order of diameters, then oscillations.
    ///
    /// # Errors
    /// As [`StreakSet::trace`] and [`StreakAtlas::from_sets`].
    pub fn trace(
        diameters: &[f64],
        oscillations: &[StreakOscillation],
        elevations: &[f64],
        directions: &[[f64; 3]],
        options: &StreakOptions,
    ) -> Result<Self, MaskError> {
        let mut sets = Vec::new();
        for &diameter in diameters {
            for oscillation in oscillations {
                sets.push(StreakSet::trace(diameter, oscillation, elevations, directions, options)?);
            }
        }
        Self::from_sets(sets)
    }

    /// Puts sets together. Sets of one diameter keep their order.
    ///
    /// # Errors
    /// [`MaskError::File`] if there are none, if they differ in size, extent, elevations or directions, or if a
    /// diameter has more oscillations than another.
    pub fn from_sets(mut sets: Vec<StreakSet>) -> Result<Self, MaskError> {
        let wrong = |place, found: String, allowed| MaskError::File { place, found, allowed };
        for set in &sets {
            set.check()?;
        }
        sets.sort_by(|a, b| a.diameter.total_cmp(&b.diameter));
        let Some(first) = sets.first() else {
            return Err(wrong("streaks", "no set".to_owned(), "one or more"));
        };
        let layout = |set: &StreakSet| {
            let StreakOptions { columns, rows, half_extent, .. } = set.options;
            (columns, rows, half_extent.to_bits())
        };
        let same = |set: &&StreakSet| {
            layout(set) == layout(first)
                && set.elevations == first.elevations
                && set.directions == first.directions
        };
        if let Some(other) = sets.iter().find(|set| !same(set)) {
            let found = format!("{} mm differs from {} mm", other.diameter * 1.0e3, first.diameter * 1.0e3);
            return Err(wrong("sets of streaks", found, "one size, extent, and list of directions"));
        }
        let groups: Vec<&[StreakSet]> = sets.chunk_by(same_diameter).collect();
        let oscillations = groups.iter().map(|group| group.len()).max().unwrap_or(0);
        if let Some(short) = groups.iter().find(|group| group.len() != oscillations) {
            let found = format!("{} at {} mm", short.len(), short[0].diameter * 1.0e3);
            return Err(wrong("oscillations", found, "as many as at every other diameter"));
        }
        if groups.len() > MOST_SETS {
            return Err(wrong("diameters", groups.len().to_string(), "1 to 9"));
        }
        let diameters: Vec<f64> = groups.iter().map(|group| group[0].diameter).collect();
        let (frame, triangles) = lay_out(first, &diameters, oscillations)?;
        let halves: Vec<u16> = sets.iter().flat_map(|set| &set.texels).map(|v| v.to_bits()).collect();
        let (pairs, _) = halves.as_chunks::<2>();
        let texels = pairs.iter().map(|&[low, high]| u32::from(low) | u32::from(high) << 16).collect();
        Ok(Self { sets, frame, triangles, texels })
    }

    /// The same, with another way to pick a particle's streak.
    #[must_use]
    pub fn with_pick(mut self, pick: StreakPick) -> Self {
        self.frame.pick = match pick {
            StreakPick::ByAngle => ATLAS_BY_ANGLE,
            StreakPick::Random => ATLAS_RANDOM,
        };
        self
    }

    /// The same, with another seed for what chance decides.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.frame.seed = seed_words(seed);
        self
    }

    /// Its sets by diameter, then oscillation.
    #[must_use]
    pub fn sets(&self) -> &[StreakSet] {
        &self.sets
    }

    /// What a lookup reads: the same three arrays as a shader's.
    #[must_use]
    pub fn data(&self) -> AtlasData<'_> {
        AtlasData { frame: &self.frame, triangles: &self.triangles, texels: &self.texels }
    }

    /// Layers of the whole atlas.
    #[must_use]
    pub fn layers(&self) -> usize {
        self.sets.iter().map(StreakSet::layers).sum()
    }

    /// The three layers of a drop's streak and their weights. `light` and `view` are unit vectors from the drop to its
    /// light and to its viewer.
    #[must_use]
    pub fn place(&self, drop: &StreakParticle, light: [f32; 3], view: [f32; 3]) -> AtlasPlace {
        atlas_lookup_place(&self.data(), drop.id, drop.diameter, drop.axis, light, view)
    }

    /// The radiance of a place, in 1/sr for an irradiance of 1, while the drop moves on by its diameter: `across`
    /// equivalent radii to the right of the middle, `turns` of the mode (2,0) along.
    #[must_use]
    pub fn radiance(&self, place: &AtlasPlace, across: f32, turns: f32) -> f32 {
        atlas_lookup_radiance(&self.data(), place, across, turns)
    }
}

fn same_diameter(a: &StreakSet, b: &StreakSet) -> bool {
    (a.diameter - b.diameter).abs() <= 1.0e-9 * a.diameter
}

/// The frame and the triangles of sets like this one.
fn lay_out(
    set: &StreakSet,
    diameters: &[f64],
    oscillations: usize,
) -> Result<(AtlasFrame, Vec<AtlasTriangle>), MaskError> {
    let thresholds = |values: Vec<f64>| -> [[f32; 4]; 2] {
        let at = |k: usize| values.get(k).map_or(f32::MAX, |&v| v as f32);
        [[at(0), at(1), at(2), at(3)], [at(4), at(5), at(6), at(7)]]
    };
    let between = diameters.windows(2).map(|pair| (pair[0] * pair[1]).sqrt()).collect();
    let midway = set.elevations.windows(2).map(|pair| ops::sin(0.5 * (pair[0] + pair[1]))).collect();
    let mut triangles = Vec::new();
    let mut first = [[0; 4]; 3];
    for (k, directions) in set.directions.iter().enumerate() {
        first[k / 4][k % 4] = triangles.len() as u32;
        triangles.extend(triangulate(directions)?);
    }
    let after = set.directions.len();
    first[after / 4][after % 4] = triangles.len() as u32;
    let directions = set.directions.first().map_or(0, Vec::len);
    let frame = AtlasFrame {
        size: [set.options.columns, set.options.rows],
        half_extent: set.options.half_extent as f32,
        pick: ATLAS_BY_ANGLE,
        counts: [diameters.len(), oscillations, set.elevations.len(), directions].map(|n| n as u32),
        seed: [0; 2],
        unused: [0; 2],
        diameters: thresholds(between),
        elevations: thresholds(midway),
        first,
        unused_1: [0; 4],
    };
    Ok((frame, triangles))
}
