//! The masks of drops of all sizes from all elevations, packed for the shader.
//!
//! A drop's mask depends on its diameter (its shape) and on how far above or below it the viewer is. Masks are traced
//! for diameters half a millimeter apart and elevations 30 degrees apart; the shader goes between them linearly.
//!
//! Behind them are those of splashes, for stages of their crown and elevations 15 degrees apart, from level to straight above.

use downpour_math::OutOfRange;
use std::sync::Arc;

use downpour_atlas::StreakAtlas;
use downpour_drop::DropShape;
use downpour_drop::oscillation::{Amplitudes, Fluids, FrequencyLaw, OscillatingDrop, Oscillation};
use downpour_drop::shape::{DropShapeCoefficients, ShapeTable};
use downpour_mask::{
    ClosedMesh, Mask, MaskError, MaskOptions, MaskTexel, View, trace_drop, trace_model_views,
};
use downpour_math::packing::{packing_octahedral_encode, packing_pack_snorm, packing_pack_unorm};
use downpour_shaders::render::rain::{
    DROPS_ELEVATIONS, DROPS_TEXEL_WORDS, PROFILES_SHAPE_WORDS, PROFILES_SHAPES, PROFILES_SHAPES_BEGIN,
    PROJECT_DIAMETERS, PROJECT_ROWS, PROJECT_SPLASH_TOP, PROJECT_SPLASHES,
};
use downpour_shaders::sim::splash::SPLASH_RISE_SHARE;

use super::drops_atlas;
use super::light::DropLightTable;
use super::splash;
use super::streak_path::StreakPath;

/// Number of diameters, from a sphere to the largest drop with a known shape.
pub const DIAMETERS: u32 = PROJECT_DIAMETERS;
/// Step between diameters, meters.
pub const DIAMETER_STEP: f64 = 0.5e-3;

/// Meters between the shapes for the rays of streaks.
const SHAPE_STEP: f64 = 0.1e-3;

/// Texels along an edge of a mask.
const SIZE: u32 = 96;

/// Words of a texel.
const WORDS: usize = DROPS_TEXEL_WORDS as usize;

/// Masks of drops of all sizes from all elevations.
#[derive(Clone, Debug, PartialEq)]
pub struct DropMasks {
    /// Five words per texel: the refracted, the reflected and the internally reflected direction as octahedral pairs of 16
    /// bits; coverage and transmittance, then the internal transmittance and the reflectance as 16 bits each. Rows from the
    /// top, elevations within diameters. Behind them the streak atlas, if there is one.
    pub words: Arc<Vec<u32>>,
    /// Texels along an edge of a mask.
    pub size: u32,
    /// First word of the streak atlas behind the masks; 0: there is none.
    pub(crate) atlas: u32,
    /// Table of the light of lamps that a drop scatters.
    pub light: DropLightTable,
    /// True if drops of the smallest diameter look the same from everywhere.
    small_are_round: bool,
    /// True if there are masks of splashes.
    has_splashes: bool,
    /// Half the width of the masks of each row; the area of the outline of each mask; the oval of each outline (half its width,
    /// half its height, and how far its middle is up); all in equivalent radii. Then shapes of drops for the rays of streaks,
    /// [`SHAPE_STEP`] apart: coefficients, volume, half width and height, and refractive index.
    tables: Arc<Vec<f32>>,
}

/// Outlines of masks.
#[derive(Debug, Default)]
struct Outlines {
    half_extents: Vec<f32>,
    areas: Vec<f32>,
    ovals: Vec<[f32; 3]>,
}

impl Outlines {
    /// Adds nothing, up to the last row.
    fn pad(&mut self) {
        let rows = PROJECT_ROWS as usize;
        self.half_extents.resize(rows, 0.0);
        self.areas.resize(rows * DROPS_ELEVATIONS as usize, 0.0);
        self.ovals.resize(rows * DROPS_ELEVATIONS as usize, [0.0; 3]);
    }
}

/// Masks of a drop: their rows, and what they say of its outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MaskLookup {
    pub(crate) index: [f32; 2],
    pub(crate) half_extent: f32,
    pub(crate) area: f32,
    pub(crate) oval: [f32; 3],
}

impl DropMasks {
    /// Traces the masks of drops with this refractive index.
    ///
    /// # Errors
    /// [`MaskError::OutOfRange`] for an invalid index.
    pub fn trace(refractive_index: f64) -> Result<Self, MaskError> {
        Self::trace_shapes(refractive_index, ShapeTable::default())
    }

    /// Traces the masks of the shapes of a table.
    ///
    /// # Errors
    /// As [`DropMasks::trace`].
    pub fn trace_shapes(refractive_index: f64, table: ShapeTable) -> Result<Self, MaskError> {
        let mut masks = Self::empty(refractive_index)?;
        let views = views()?;
        let mut outlines = Outlines::default();
        for k in 1..=DIAMETERS {
            let shape = DropShape::with_table(table, f64::from(k) * DIAMETER_STEP)?;
            let seen = views.iter().map(|&view| trace_drop(&shape, &options(view, refractive_index)));
            masks.append(&mut outlines, &seen.collect::<Result<Vec<Mask>, _>>()?);
        }
        Ok(masks.with_tables(outlines, table, refractive_index))
    }

    /// Traces the masks of a model instead of the drops' shapes: scaled to their volume, its +Y up, its +Z toward the eye.
    /// Rays of streaks and the light of lamps keep those shapes.
    ///
    /// # Errors
    /// As [`DropMasks::trace`].
    pub fn trace_model(refractive_index: f64, model: &ClosedMesh) -> Result<Self, MaskError> {
        let mut masks = Self::empty(refractive_index)?;
        masks.small_are_round = false;
        let seen = trace_model_views(model, &options(View::SIDE, refractive_index), &views()?)?;
        let mut outlines = Outlines::default();
        for _ in 0..DIAMETERS {
            masks.append(&mut outlines, &seen);
        }
        Ok(masks.with_tables(outlines, ShapeTable::default(), refractive_index))
    }

    /// No masks yet.
    fn empty(refractive_index: f64) -> Result<Self, MaskError> {
        Ok(Self {
            words: Arc::default(),
            size: SIZE,
            atlas: 0,
            light: DropLightTable::water().map_err(|_| {
                MaskError::OutOfRange(OutOfRange {
                    quantity: "refractive index of water",
                    found: refractive_index,
                    unit: "",
                    allowed: "1.2 to 1.4".into(),
                })
            })?,
            small_are_round: true,
            has_splashes: false,
            tables: Arc::default(),
        })
    }

    /// Adds the masks of a diameter, one per elevation, all of one scale.
    fn append(&mut self, outlines: &mut Outlines, seen: &[Mask]) {
        outlines.half_extents.extend(seen.first().map(|mask| mask.half_extent as f32));
        for mask in seen {
            let width = mask.texel_width();
            let covered: f64 = mask.texels.iter().map(|texel| f64::from(texel.coverage)).sum();
            outlines.areas.push((covered * width * width) as f32);
            outlines.ovals.push(oval(mask));
            let words = |texel| pack(texel, mask.refractive_index as f32);
            Arc::make_mut(&mut self.words).extend(mask.texels.iter().flat_map(words));
        }
    }

    /// Returns the masks with the streaks of an atlas for [`DropLightForm::Atlas`](super::light::DropLightForm::Atlas),
    /// instead of those of another.
    #[must_use]
    pub fn with_atlas(mut self, atlas: &StreakAtlas) -> Self {
        if self.atlas > 0 {
            Arc::make_mut(&mut self.words).truncate(self.atlas as usize);
        }
        self.atlas = self.words.len() as u32;
        Arc::make_mut(&mut self.words).extend(drops_atlas::words(atlas));
        self.light = self.light.with_atlas(atlas);
        self
    }

    /// The masks with the tables of their outlines and of the shapes.
    fn with_tables(self, mut outlines: Outlines, table: ShapeTable, refractive_index: f64) -> Self {
        outlines.pad();
        let mut tables = outlines.half_extents.clone();
        tables.extend(&outlines.areas);
        tables.extend(outlines.ovals.iter().flatten());
        for k in 1..=PROFILES_SHAPES {
            let path = streak_shape(f64::from(k) * SHAPE_STEP, table, refractive_index);
            let DropShapeCoefficients { c0, c1, c2 } = path.shape;
            tables.extend([c0, c1, c2, path.volume].concat());
            tables.extend([path.volume_last, path.wide, path.tall, path.index]);
        }
        Self { tables: Arc::new(tables), ..self }
    }

    /// Half extents, areas and ovals of the masks, then the shapes, as the shaders read them.
    #[must_use]
    pub fn tables(&self) -> &[f32] {
        &self.tables
    }

    /// Returns the masks with those of splashes behind them, for a refractive index.
    ///
    /// # Errors
    /// As [`DropMasks::trace`].
    pub fn with_splashes(mut self, refractive_index: f64) -> Result<Self, MaskError> {
        if self.has_splashes {
            return Ok(self);
        }
        let splashes = splash::masks(refractive_index)?;
        let mut outlines = Outlines::default();
        let atlas = if self.atlas > 0 { self.atlas as usize } else { self.words.len() };
        let behind = Arc::make_mut(&mut self.words).split_off(atlas);
        for seen in splashes.iter() {
            self.append(&mut outlines, seen);
        }
        if self.atlas > 0 {
            self.atlas = self.words.len() as u32;
        }
        Arc::make_mut(&mut self.words).extend(behind);
        let tables = Arc::make_mut(&mut self.tables);
        let (rows, first) = (PROJECT_ROWS as usize, DIAMETERS as usize);
        let each = DROPS_ELEVATIONS as usize;
        tables[first..rows].copy_from_slice(&outlines.half_extents);
        tables[rows + first * each..rows + rows * each].copy_from_slice(&outlines.areas);
        let ovals = rows + rows * each;
        tables[ovals + first * each * 3..ovals + rows * each * 3]
            .copy_from_slice(outlines.ovals.as_flattened());
        self.has_splashes = true;
        Ok(self)
    }

    /// True if these are the masks of others, or a copy of them.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.words, &other.words) && Arc::ptr_eq(&self.tables, &other.tables)
    }

    /// True if there are masks of splashes.
    #[must_use]
    pub fn has_splashes(&self) -> bool {
        self.has_splashes
    }

    /// True if drops of the smallest diameter look the same from everywhere.
    #[must_use]
    pub fn small_are_round(&self) -> bool {
        self.small_are_round
    }

    /// A value of the masks between two rows and two elevations; `stride` numbers for each.
    fn project_between(&self, first: u32, stride: u32, index: [f32; 2]) -> f32 {
        let [row, column] = index;
        let (low, part) = ([row as u32, column as u32], [row - row.floor(), column - column.floor()]);
        let high = [(low[0] + 1).min(PROJECT_ROWS - 1), (low[1] + 1).min(DROPS_ELEVATIONS - 1)];
        let at = |row: u32, column: u32| {
            self.tables[(first + (row * DROPS_ELEVATIONS + column) * stride) as usize]
        };
        let of_row = |row: u32| at(row, low[1]) * (1.0 - part[1]) + at(row, high[1]) * part[1];
        of_row(low[0]) * (1.0 - part[0]) + of_row(high[0]) * part[0]
    }

    /// Position among the masks of a drop of a diameter in meters, seen from `elevation` radians above it.
    pub(crate) fn project_lookup(&self, diameter: f32, elevation: f32) -> MaskLookup {
        let last = (DIAMETERS - 1) as f32;
        let row = (diameter / DIAMETER_STEP as f32 - 1.0).clamp(0.0, last);
        let half = (DROPS_ELEVATIONS - 1) as f32 * 0.5;
        let turned = (elevation / std::f32::consts::FRAC_PI_2 + 1.0) * half;
        // A sphere is the same from everywhere: one mask does.
        let column = if row == 0.0 && self.small_are_round { half } else { turned.clamp(0.0, 2.0 * half) };
        self.project_mask([row, column])
    }

    /// Position among the masks of a splash that is seen from `elevation` radians above it, at the picture's time.
    pub(crate) fn project_splash(&self, present: [f32; 2], elevation: f32) -> MaskLookup {
        let [begin, end] = present;
        let stage = (-begin / (end - begin).max(1.0e-9)).clamp(0.0, 1.0);
        let rise = PROJECT_SPLASH_TOP * (stage / SPLASH_RISE_SHARE).min(1.0);
        let fall = (stage - SPLASH_RISE_SHARE).max(0.0) / (1.0 - SPLASH_RISE_SHARE);
        let last = (PROJECT_SPLASHES - 1) as f32;
        let row = rise + (last - PROJECT_SPLASH_TOP) * fall;
        let above = (DROPS_ELEVATIONS - 1) as f32;
        let turned = elevation / std::f32::consts::FRAC_PI_2 * above;
        self.project_mask([DIAMETERS as f32 + row.clamp(0.0, last), turned.clamp(0.0, above)])
    }

    /// The outline at a fractional row and elevation, from the masks.
    fn project_mask(&self, index: [f32; 2]) -> MaskLookup {
        let [row, _] = index;
        let (low, part) = (row as u32, row - row.floor());
        let extent = |k: u32| self.tables[k.min(PROJECT_ROWS - 1) as usize];
        let areas = PROJECT_ROWS;
        let ovals = areas + PROJECT_ROWS * DROPS_ELEVATIONS;
        MaskLookup {
            index,
            half_extent: extent(low) * (1.0 - part) + extent(low + 1) * part,
            area: self.project_between(areas, 1, index),
            oval: [0, 1, 2].map(|part| self.project_between(ovals + part, 3, index)),
        }
    }

    /// Area that a drop covers, seen from `elevation` radians above it, over that of the disk of its diameter.
    pub(super) fn outline(&self, diameter: f32, elevation: f32) -> f64 {
        f64::from(self.project_lookup(diameter, elevation).area) / std::f64::consts::PI
    }

    /// The shape of a drop of a diameter in meters, for the rays of its streak.
    #[must_use]
    pub fn profiles_shape(&self, diameter: f32) -> StreakPath {
        let last = (PROFILES_SHAPES - 1) as f32;
        let at = (diameter / SHAPE_STEP as f32 - 1.0).clamp(0.0, last);
        let low = (at as u32).min(PROFILES_SHAPES - 2);
        let part = at - low as f32;
        let near = (PROFILES_SHAPES_BEGIN + low * PROFILES_SHAPE_WORDS) as usize;
        let words = PROFILES_SHAPE_WORDS as usize;
        let (a, b) = (&self.tables[near..near + words], &self.tables[near + words..near + 2 * words]);
        let at = |k: usize| a[k] + (b[k] - a[k]) * part;
        let four = |first: usize| std::array::from_fn(|k| at(first + k));
        StreakPath {
            shape: DropShapeCoefficients { c0: four(0), c1: four(4), c2: four(8) },
            volume: four(12),
            volume_last: at(16),
            wide: at(17),
            tall: at(18),
            index: at(19),
            ..StreakPath::default()
        }
    }
}

/// The elevations of the masks, from below to above.
fn views() -> Result<Vec<View>, MaskError> {
    let half = f64::from(DROPS_ELEVATIONS - 1) * 0.5;
    let elevation = |step: u32| (f64::from(step) / half - 1.0) * std::f64::consts::FRAC_PI_2;
    (0..DROPS_ELEVATIONS).map(|step| View::from_elevation(elevation(step))).collect()
}

pub(super) fn options(view: View, refractive_index: f64) -> MaskOptions {
    MaskOptions { size: SIZE, view, refractive_index }
}

/// A shape with the moments of its volume.
fn streak_shape(diameter: f64, table: ShapeTable, refractive_index: f64) -> StreakPath {
    // The diameters of the table have shapes.
    let Ok(shape) = DropShape::with_table(table, diameter) else { return StreakPath::default() };
    let still = Oscillation::new(diameter, Amplitudes::NONE, &Fluids::AT_20_C, FrequencyLaw::default());
    let Ok(still) = still else { return StreakPath::default() };
    let [v1, v2, v3, w0, volume_last] = OscillatingDrop::new(shape, still).volume_polynomial();
    let radius = shape.equivalent_radius();
    StreakPath {
        shape: shape.gpu_coefficients(),
        volume: [v1, v2, v3, w0].map(|v| v as f32),
        volume_last: volume_last as f32,
        wide: (shape.max_half_width() / radius) as f32,
        tall: (0.5 * (shape.extent_up() + shape.extent_down()) / radius) as f32,
        index: refractive_index as f32,
        ..StreakPath::default()
    }
}

/// The ellipse of the shape of the box around an outline, and of its area.
fn oval(mask: &Mask) -> [f32; 3] {
    let (width, half) = (mask.texel_width(), mask.half_extent);
    let size = mask.size as usize;
    let (mut area, mut wide, mut low, mut high) = (0.0, 0.0f64, f64::INFINITY, f64::NEG_INFINITY);
    for (i, texel) in mask.texels.iter().enumerate().filter(|(_, texel)| texel.coverage > 0.0) {
        // The texel's middle, right and up.
        let x = (i % size) as f64 * width + 0.5 * width - half;
        let y = half - 0.5 * width - (i / size) as f64 * width;
        (wide, low, high) = (wide.max(x.abs()), low.min(y), high.max(y));
        area += f64::from(texel.coverage) * width * width;
    }
    let (tall, middle) = (0.5 * (high - low), 0.5 * (high + low));
    let scale = (area / (std::f64::consts::PI * wide * tall)).sqrt();
    [(wide * scale) as f32, (tall * scale) as f32, middle as f32]
}

/// A texel as the shader reads it.
fn pack(texel: &MaskTexel, refractive_index: f32) -> [u32; WORDS] {
    // A covered texel keeps a trace of coverage, or its direction would not count.
    let coverage = if texel.coverage > 0.0 { texel.coverage.max(1.0 / 65535.0) } else { 0.0 };
    [
        packing_pack_snorm(packing_octahedral_encode(texel.direction)),
        packing_pack_snorm(packing_octahedral_encode(texel.reflected)),
        packing_pack_snorm(packing_octahedral_encode(texel.internal)),
        packing_pack_unorm([coverage, texel.transmittance]),
        packing_pack_unorm([texel.internal_transmittance, texel.reflectance(refractive_index)]),
    ]
}
