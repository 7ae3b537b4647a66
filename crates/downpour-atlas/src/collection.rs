//! An atlas: sets of streaks over diameters and oscillations.

use std::path::Path;

use downpour_math::ops::f64 as ops;
use downpour_math::rng::seed_words;
use downpour_shaders::atlas::{ATLAS_BY_ANGLE, ATLAS_RANDOM};
use half::f16;

use crate::AtlasError;
use crate::lookup::{
    AtlasData, AtlasFrame, AtlasSlot, AtlasTriangle, atlas_lookup_mix, atlas_lookup_radiance,
    atlas_lookup_slot, atlas_map, atlas_position,
};
use crate::set::stored;
use crate::triangles::triangulate;
use crate::{
    StreakOptions, StreakOscillation, StreakSet, amount_directions, amount_elevations, read_streaks,
};

/// Maximum number of diameters, and of elevations, of an atlas.
pub const MAX_SETS: usize = 9;
/// Maximum size of a file that is read, in bytes.
const MAX_FILE_BYTES: u64 = 64 << 20;

/// Choice of a particle's streak among the oscillations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StreakPick {
    /// By diameter and by the directions of light and viewer, interpolated; the oscillation by chance.
    #[default]
    ByAngle,
    /// Any layer by chance, as Im & Sung 2022 do.
    Random,
}

/// State of a drop for the choice of its streak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreakParticle {
    /// Equivalent diameter in meters.
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
    amounts: Vec<f32>,
}

impl StreakAtlas {
    /// Reads every `.ktx2` of a folder.
    ///
    /// # Errors
    /// With the file's name: [`AtlasError::Unreadable`] if the folder or a file is missing or cannot be read, [`AtlasError::InFile`] for what [`read_streaks`] says; else as [`StreakAtlas::from_sets`].
    pub fn load(folder: &Path) -> Result<Self, AtlasError> {
        let unreadable =
            |path: &Path, reason: String| AtlasError::Unreadable { path: path.display().to_string(), reason };
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
            let to_error = |error: std::io::Error| unreadable(&path, error.to_string());
            let about = std::fs::metadata(&path).map_err(to_error)?;
            if !about.is_file() || about.len() > MAX_FILE_BYTES {
                let found = format!("{} bytes", about.len());
                return Err(AtlasError::File {
                    location: "file",
                    found,
                    allowed: "a file of at most 64 MiB",
                }
                .in_file(&path));
            }
            let bytes = std::fs::read(&path).map_err(to_error)?;
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
    ) -> Result<Self, AtlasError> {
        let mut sets = Vec::new();
        for &diameter in diameters {
            for oscillation in oscillations {
                sets.push(StreakSet::trace(diameter, oscillation, elevations, directions, options)?);
            }
        }
        Self::from_sets(sets)
    }

    /// Combines sets to an atlas. Sets of one diameter keep their order.
    ///
    /// # Errors
    /// [`AtlasError::File`] if there are none, if they differ in size, extent, elevations or directions, or if a
    /// diameter has more oscillations than another.
    pub fn from_sets(mut sets: Vec<StreakSet>) -> Result<Self, AtlasError> {
        let wrong = |location, found: String, allowed| AtlasError::File { location, found, allowed };
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
        if groups.len() > MAX_SETS {
            return Err(wrong("diameters", groups.len().to_string(), "1 to 9"));
        }
        let diameters: Vec<f64> = groups.iter().map(|group| group[0].diameter).collect();
        let (frame, triangles) = lay_out(first, &diameters, oscillations)?;
        let means: Vec<f32> = sets.iter().flat_map(layer_amounts).collect();
        let texels = patterns(&sets, &means);
        let mut atlas = Self { sets, frame, triangles, texels, amounts: Vec::new() };
        atlas.amounts = atlas.grids(&means);
        atlas.amounts.extend(means);
        Ok(atlas)
    }

    /// The amounts of all sets on their grids. Those of a set without any are interpolated between the layers': by the triangles,
    /// and by the sine of the elevation.
    fn grids(&self, means: &[f32]) -> Vec<f32> {
        let data = self.data();
        let points: Vec<[f32; 2]> =
            amount_directions().iter().map(|d| atlas_map(d.map(|c| c as f32))).collect();
        let [_, _, elevations, directions] = data.frame.counts;
        let mut all = Vec::new();
        for (set, means) in
            self.sets.iter().zip(means.chunks_exact((elevations * directions).max(1) as usize))
        {
            all.extend(set.amounts.iter().map(|v| v.to_f32()));
            if !set.amounts.is_empty() {
                continue;
            }
            let of_elevation = |elevation: u32, point: [f32; 2]| {
                let mix = atlas_lookup_mix(&data, elevation, point);
                let of =
                    |k: usize| mix.weights[k] * means[(elevation * directions + mix.directions[k]) as usize];
                of(0) + of(1) + of(2)
            };
            for rise in amount_elevations() {
                let [low, high, low_inverse, high_inverse] = data.frame.elevations;
                let level = atlas_position(low, high, low_inverse, high_inverse, ops::sin(rise) as f32);
                let (lower, part) = (level as u32, level - level.floor());
                let upper = (lower + 1).min(elevations - 1);
                let mixed = |&point: &[f32; 2]| {
                    of_elevation(lower, point) * (1.0 - part) + of_elevation(upper, point) * part
                };
                all.extend(points.iter().map(mixed));
            }
        }
        all
    }

    /// Returns the atlas with another way to choose a particle's streak.
    #[must_use]
    pub fn with_pick(mut self, pick: StreakPick) -> Self {
        self.frame.pick = match pick {
            StreakPick::ByAngle => ATLAS_BY_ANGLE,
            StreakPick::Random => ATLAS_RANDOM,
        };
        self
    }

    /// Returns the atlas with another seed for random choices.
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

    /// Arrays that a lookup reads: the same four as a shader's.
    #[must_use]
    pub fn data(&self) -> AtlasData<'_> {
        let Self { frame, triangles, texels, amounts, .. } = self;
        AtlasData { frame, triangles, texels, amounts }
    }

    /// Number of layers of the atlas.
    #[must_use]
    pub fn layers(&self) -> usize {
        self.sets.iter().map(StreakSet::layers).sum()
    }

    /// The streak of a drop: its amount, three layers and their weights. `light` and `view` are unit vectors from the drop to its
    /// light and to its viewer.
    #[must_use]
    pub fn slot(&self, drop: &StreakParticle, light: [f32; 3], view: [f32; 3]) -> AtlasSlot {
        atlas_lookup_slot(&self.data(), drop.id, drop.diameter, drop.axis, light, view)
    }

    /// Radiance at a position in the atlas, in 1/sr for an irradiance of 1, during a fall by one diameter: `across`
    /// equivalent radii to the right of the middle, `turns` of the mode (2,0) along.
    #[must_use]
    pub fn radiance(&self, slot: &AtlasSlot, across: f32, turns: f32) -> f32 {
        atlas_lookup_radiance(&self.data(), slot, across, turns)
    }
}

fn same_diameter(a: &StreakSet, b: &StreakSet) -> bool {
    (a.diameter - b.diameter).abs() <= 1.0e-9 * a.diameter
}

/// The amount of each layer of a set: a layer of mean m and half width h is a disk of 4 h m / pi.
fn layer_amounts(set: &StreakSet) -> Vec<f32> {
    let texels = set.layer_texels().max(1);
    let scale = 4.0 * set.options.half_extent / std::f64::consts::PI / texels as f64;
    let sum = |layer: &[f16]| layer.iter().map(|v| v.to_f64()).sum::<f64>();
    set.texels.chunks_exact(texels).map(|layer| (scale * sum(layer)) as f32).collect()
}

/// Layers divided by their amounts, two half floats per word. A layer without light is uniform: so the mean of any mixture is
/// that of a uniform disk.
fn patterns(sets: &[StreakSet], means: &[f32]) -> Vec<u32> {
    let layers = sets.iter().flat_map(|set| {
        let even = std::f64::consts::FRAC_PI_4 / set.options.half_extent;
        set.texels.chunks_exact(set.layer_texels().max(1)).map(move |layer| (layer, even as f32))
    });
    let halves: Vec<u16> = layers
        .zip(means)
        .flat_map(|((layer, even), &mean)| {
            let pattern = move |v: &f16| if mean > 0.0 { stored(v.to_f32() / mean) } else { stored(even) };
            layer.iter().map(move |v| pattern(v).to_bits())
        })
        .collect();
    let (pairs, _) = halves.as_chunks::<2>();
    pairs.iter().map(|&[low, high]| u32::from(low) | u32::from(high) << 16).collect()
}

/// The gaps between ascending nodes, as `atlas_position` takes them.
fn gaps(nodes: &[f64]) -> [[f32; 4]; 4] {
    let mut gaps = [[0.0; 4]; 4];
    for (k, pair) in nodes.windows(2).enumerate().take(MAX_SETS - 1) {
        gaps[k / 4][k % 4] = pair[0] as f32;
        // From the stored ends: at the next node the position is an integer.
        gaps[2 + k / 4][k % 4] = 1.0 / (pair[1] as f32 - pair[0] as f32);
    }
    gaps
}

/// Frame and triangles of sets like this one.
fn lay_out(
    set: &StreakSet,
    diameters: &[f64],
    oscillations: usize,
) -> Result<(AtlasFrame, Vec<AtlasTriangle>), AtlasError> {
    let sizes: Vec<f64> = diameters.iter().map(|&d| ops::log2(d)).collect();
    let rises: Vec<f64> = set.elevations.iter().map(|&e| ops::sin(e)).collect();
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
        is_shared: u32::from(set.directions.windows(2).all(|pair| pair[0] == pair[1])),
        unused: 0,
        diameters: gaps(&sizes),
        elevations: gaps(&rises),
        first,
    };
    Ok((frame, triangles))
}
