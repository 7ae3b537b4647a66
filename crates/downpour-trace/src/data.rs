//! A scene and a frame as the buffers that the shaders read: the CPU reference reads the same arrays.
//!
//! Host types of `shaders/wgsl/render/data.wgsl`. Triangles are in world space and in the order of the hierarchy's
//! leaves, so that a hit's triangle is an index into all of it.

use std::sync::Arc;

use downpour_bvh::{BvhNode, BvhTriangle, bvh_bounds};
use downpour_math::rng::rng_draw;
use downpour_render::RenderError;
use downpour_render::camera::{Camera, Viewpoint};
use downpour_render::light::{Light, LightSource};
use downpour_render::spacing::RaySpacing;
use downpour_shaders::render::scene::{
    SCENE_LIGHT_BODY, SCENE_LIGHT_DIRECTIONAL, SCENE_LIGHT_ROWS, SCENE_PICTURE, SCENE_SKY_LEVELS,
};
use glam::Vec3;

use crate::billboards::Impostors;
use crate::shared_rows::SharedRows;
use crate::skylight::skylight_radius;
use crate::still_part::StillPart;

/// Part of the rays over which the filter takes means that one ray is.
fn window_fraction(rays: u32, spacing: u32) -> f32 {
    let edge = 2 * skylight_radius(rays, spacing) + 1;
    1.0 / (edge * edge * rays.max(1)) as f32
}

/// Largest distance in pixels between those whose rays look for the light of sky and surfaces: [`RenderFrame::ray_spacing`].
pub const MAX_RAY_SPACING: u32 = 4;

/// Dimension of the random number of the pixel in each cell that looks for light.
const SPACING_DIMENSION: u32 = 4133;

/// A corner of a triangle. The same layout as `RenderCorner` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct RenderCorner {
    /// Normal for shading.
    pub normal: [f32; 3],
    /// Index of the material.
    pub material: u32,
    /// Unit tangent and handedness.
    pub tangent: [f32; 4],
    /// Two sets of texture coordinates.
    pub uv: [f32; 4],
    /// Vertex color, linear.
    pub color: [f32; 4],
}

/// Values that change from frame to frame. The same layout as `RenderFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct RenderFrame {
    /// Width, height and first texel of each level of the sky.
    pub sky_levels: [[u32; 4]; SCENE_SKY_LEVELS as usize],
    /// The camera.
    pub camera: Camera,
    /// Samples along an edge of a pixel.
    pub grid: u32,
    /// Row of the table where texture slots begin.
    pub slots: u32,
    /// Row of the table where lights begin.
    pub lights: u32,
    /// Number of lights.
    pub light_count: u32,
    /// Rays per sample that look for the light of sky and surfaces.
    pub sky_rays: u32,
    /// First row of pixels of a dispatch.
    pub first_row: u32,
    /// Minimum distance of the next surface along a ray, meters.
    pub nearest: f32,
    /// Inverse of the number of rays that sample the light of a surface.
    pub ray_fraction: f32,
    /// Kind of image that is traced: the picture, or a capture.
    pub projection: u32,
    /// 1: the capture leaves parallel light and lamps out, since drops are lit by them on their own
    /// ([`downpour_render::rain::light`]). `SCENE_ALL_OUT`: all that shines by itself.
    pub suns_out: u32,
    /// Row of the table where puddles begin.
    pub puddles: u32,
    /// Number of puddles.
    pub puddle_count: u32,
    /// Row of the table where the pane that casts shadows begins; 0: no pane.
    pub pane: u32,
    /// Turn of a dispatch: pass of the means over neighboring pixels, or sample of `main_trace_sample`.
    pub turn: u32,
    /// Row of the table where the wetness of surfaces begins; 0: all is dry.
    pub wetness: u32,
    /// Word of the texels where the tree of surfaces that shine begins; 0: none shine.
    pub emitters: u32,
    /// In the picture, distance in pixels between those whose rays look for the light of sky and surfaces: 1 to [`MAX_RAY_SPACING`];
    /// 1: all do.
    pub ray_spacing: u32,
    /// Column of such a pixel in each cell of `ray_spacing` times `ray_spacing` pixels.
    pub ray_column: u32,
    /// Its row.
    pub ray_row: u32,
    /// Row of the table where rain on panes of the scene begins; 0: they are dry.
    pub glazing: u32,
    /// Number of billboards in the reflection buffer, plus 1 ([`impostor`](crate::impostor)); 0: reflections on wet surfaces are found by
    /// rays.
    pub impostors: u32,
    /// Edge coefficient of reflections from that buffer: the paper's f0.
    pub impostor_edge: f32,
    /// 1 if materials transmit light diffusely, else 0.
    pub translucent: u32,
    /// Not used.
    pub unused: u32,
    /// Irradiance of the sky over pi as spherical harmonics of degree 2.
    pub sky_irradiance: [[f32; 4]; 9],
}

/// A scene as buffers. What does not change after it was built is shared by all copies: a copy costs its table.
#[derive(Clone, Debug)]
pub struct SceneData {
    /// Nodes of the hierarchy.
    pub nodes: Arc<Vec<BvhNode>>,
    /// Triangles in the order of the leaves; `index` is the index in this list.
    pub triangles: Arc<Vec<BvhTriangle>>,
    /// Three corners per triangle.
    pub corners: Arc<Vec<RenderCorner>>,
    /// Materials, texture slots, lights, wetness, rain on panes of the scene, puddles and a pane before the camera, as rows.
    pub table: Vec<[u32; 4]>,
    /// Maps of the puddles, and before them the slopes of rings on them: rows behind those of the table.
    pub shared: Vec<SharedRows>,
    /// Texels of all levels of all textures, and behind them the tree of surfaces that shine ([`emitter`](crate::emitter)).
    pub texels: Arc<Vec<u32>>,
    /// Row where slots begin.
    pub slots: u32,
    /// Row where lights begin.
    pub lights: u32,
    /// Number of lights.
    pub light_count: u32,
    /// Row where puddles begin.
    pub puddles: u32,
    /// Number of puddles.
    pub puddle_count: u32,
    /// Row where the pane that casts shadows begins; 0: no pane.
    pub pane: u32,
    /// Row where the wetness of surfaces begins; 0: all is dry.
    pub wetness: u32,
    /// Row where rain on panes of the scene begins; 0: they are dry.
    pub glazing: u32,
    /// Word of the texels where the tree of surfaces that shine begins; 0: none shine.
    pub emitters: u32,
    /// True if materials transmit light diffusely ([`translucent`](crate::translucent)).
    pub is_translucent: bool,
    /// Texels of all levels of the sky.
    pub sky: Arc<Vec<[f32; 4]>>,
    /// Width, height and first texel of each level of the sky.
    pub sky_levels: [[u32; 4]; SCENE_SKY_LEVELS as usize],
    /// Irradiance of the sky over pi.
    pub sky_irradiance: [[f32; 4]; 9],
    /// Impostors for reflections on wet surfaces; `None`: reflections are found by rays.
    pub impostors: Option<Arc<Impostors>>,
    /// The reflection buffer of a frame on the CPU: [`SceneView::mirrored_picture`](crate::scene::SceneView::mirrored_picture).
    pub impostor_picture: Arc<Vec<[u32; 2]>>,
    /// What stands still in a scene that moves; `None` for one that does not.
    pub still: Option<Arc<StillPart>>,
    /// Ripples that a device holds: the table shows level water in their place.
    #[cfg(feature = "wgpu")]
    pub ripples: Option<crate::gpu::RipplesOnGpu>,
}

impl SceneData {
    /// Lower and upper corner of the bounding box, meters.
    #[must_use]
    pub fn bounds(&self) -> (Vec3, Vec3) {
        self.bounding_box().map_or((Vec3::ZERO, Vec3::ZERO), |[low, high]| (low, high))
    }

    /// Corners of the bounding box, the lower first, meters; `None` without triangles.
    #[must_use]
    pub fn bounding_box(&self) -> Option<[Vec3; 2]> {
        bvh_bounds(&self.nodes).map(|corners| corners.map(Vec3::from))
    }

    /// Reads light `index`.
    #[must_use]
    pub fn light_load(&self, index: u32) -> Light {
        let first = (self.lights + index * SCENE_LIGHT_ROWS) as usize;
        let rows = std::array::from_fn(|k| self.table[first + k]);
        Light::light_load(&rows)
    }

    /// Sets the lights, in place of those that are there; wetness, puddles and a pane, which come after them in the table, are
    /// removed.
    pub fn set_lights(&mut self, lights: &[LightSource]) {
        self.set_lights_from(0, lights);
    }

    /// Sets the lights behind the first `kept`, as [`SceneData::set_lights`] does all of them.
    pub(crate) fn set_lights_from(&mut self, kept: u32, lights: &[LightSource]) {
        let kept = kept.min(self.light_count);
        self.cut_table((self.lights + kept * SCENE_LIGHT_ROWS) as usize);
        for light in lights {
            self.table.extend(light.rows());
        }
        self.light_count = kept + lights.len() as u32;
        #[cfg(feature = "wgpu")]
        {
            self.ripples = None;
        }
    }

    /// Removes the rows of the table from `first` on, with what begins there of wetness, rain on panes, puddles and the pane before the
    /// camera.
    pub(crate) fn cut_table(&mut self, first: usize) {
        self.table.truncate(first);
        for row in [&mut self.wetness, &mut self.glazing, &mut self.puddles, &mut self.pane] {
            if *row as usize >= first {
                *row = 0;
            }
        }
        if self.puddles == 0 {
            self.puddle_count = 0;
            self.shared.clear();
        }
    }

    /// Replaces light `index` by another of the same kind; the glass of a lamp keeps its radius.
    pub(crate) fn replace_light(&mut self, index: u32, light: &LightSource) {
        let first = (self.lights + index * SCENE_LIGHT_ROWS) as usize;
        let Some(rows) = self.table.get_mut(first..first + SCENE_LIGHT_ROWS as usize) else { return };
        let (kind, radius) = (rows[0][3], rows[3][2]);
        for (row, new) in rows.iter_mut().zip(light.rows()) {
            *row = new;
        }
        (rows[0][3], rows[3][2]) = (kind, radius);
    }

    /// Rows of lights, each with its four.
    pub(crate) fn light_rows(
        &self,
        lights: std::ops::Range<u32>,
    ) -> Vec<[[u32; 4]; SCENE_LIGHT_ROWS as usize]> {
        let row = |light: u32| (self.lights + light * SCENE_LIGHT_ROWS) as usize;
        let rows = self.table.get(row(lights.start)..row(lights.end)).unwrap_or_default();
        rows.as_chunks().0.to_vec()
    }

    /// Gives lamp `index` the glass in the model of the lamp that had these rows before, if it had some; a radius of its own stays.
    pub(crate) fn keep_lamp_glass(&mut self, index: u32, before: &[[u32; 4]; SCENE_LIGHT_ROWS as usize]) {
        let first = (self.lights + index * SCENE_LIGHT_ROWS) as usize;
        let Some(rows) = self.table.get_mut(first..first + SCENE_LIGHT_ROWS as usize) else { return };
        if before[0][3] == SCENE_LIGHT_BODY && rows[0][3] != SCENE_LIGHT_DIRECTIONAL {
            rows[0][3] = SCENE_LIGHT_BODY;
        }
        if rows[3][2] == 0 && before[0][3] != SCENE_LIGHT_DIRECTIONAL {
            rows[3][2] = before[3][2];
        }
    }

    /// Says how large the glass of lamp `index` is, in meters, which is in the model and shines. That of a spot shines elsewhere, too.
    pub(crate) fn set_lamp_glass(&mut self, index: u32, radius: Option<f32>, is_spot: bool) {
        let row = (self.lights + index * SCENE_LIGHT_ROWS) as usize;
        if !is_spot {
            self.table[row][3] = SCENE_LIGHT_BODY;
        }
        if let Some(radius) = radius {
            self.table[row + 3][2] = radius.to_bits();
        }
    }

    /// Gives light `index` an angular radius, in radians: that of the disk that drops show of it. Without one it is the sun's.
    pub fn set_light_radius(&mut self, index: u32, radius: f32) {
        let row = (self.lights + index * SCENE_LIGHT_ROWS + 1) as usize;
        // The chord from the middle to the edge.
        self.table[row][3] = (2.0 * downpour_math::ops::sin(0.5 * radius)).to_bits();
    }
}

impl RenderFrame {
    /// The frame of a picture of a scene. `grid` samples along an edge of a pixel, `sky_rays` rays to the sky per
    /// sample (0: nothing hides the sky).
    ///
    /// # Errors
    /// [`RenderError::Size`] outside [`PIXELS`](downpour_render::camera::PIXELS), or as [`Viewpoint::axes`].
    pub fn new(
        scene: &SceneData,
        viewpoint: &Viewpoint,
        size: [u32; 2],
        grid: u32,
        sky_rays: u32,
        seed: u64,
    ) -> Result<Self, RenderError> {
        let camera = viewpoint.camera(size, (seed ^ (seed >> 32)) as u32)?;
        let (low, high) = scene.bounds();
        let extent = (high - low).length().clamp(1.0e-3, 1.0e5);
        // Rays from a position far from the origin start where f32 still resolves the distance to the surface.
        let far = camera.eye.abs().max_element().max(low.abs().max_element()).max(high.abs().max_element());
        Ok(Self {
            camera,
            grid: grid.clamp(1, 16),
            slots: scene.slots,
            lights: scene.lights,
            light_count: scene.light_count,
            sky_rays,
            first_row: 0,
            nearest: (extent * 1.0e-5).max(far.min(1.0e5) * 1.0e-6).max(1.0e-6),
            ray_fraction: window_fraction(sky_rays, 1),
            projection: SCENE_PICTURE,
            suns_out: 0,
            puddles: scene.puddles,
            puddle_count: scene.puddle_count,
            pane: scene.pane,
            turn: 0,
            wetness: scene.wetness,
            emitters: scene.emitters,
            ray_spacing: 1,
            ray_column: 0,
            ray_row: 0,
            glazing: scene.glazing,
            impostors: scene.impostors.as_ref().map_or(0, |list| list.billboards.len() as u32 + 1),
            impostor_edge: scene.impostors.as_ref().map_or(0.0, |list| list.edge),
            translucent: u32::from(scene.is_translucent),
            unused: 0,
            sky_levels: scene.sky_levels,
            sky_irradiance: scene.sky_irradiance,
        })
    }

    /// The frame in which rays of one pixel in each cell of `spacing` times `spacing` pixels look for the light of sky and surfaces, for all
    /// of them. Which pixel it is changes with the frame's seed. `spacing` is limited to 1 to [`MAX_RAY_SPACING`].
    #[must_use]
    pub fn with_ray_spacing(self, spacing: u32) -> Self {
        let spacing = spacing.clamp(1, MAX_RAY_SPACING);
        let place = rng_draw([self.camera.seed, 0], 0, 0, SPACING_DIMENSION)[0] % (spacing * spacing);
        // A ray stands for all of its cell.
        let alone = 1.0 / self.sky_rays.max(1) as f32;
        let ray_fraction = (window_fraction(self.sky_rays, spacing) * (spacing * spacing) as f32).min(alone);
        Self {
            ray_spacing: spacing,
            ray_column: place % spacing,
            ray_row: place / spacing,
            ray_fraction,
            ..self
        }
    }

    /// The frame of other rays.
    #[must_use]
    pub(crate) fn with_seed(self, seed: u32) -> Self {
        let camera = Camera { seed, ..self.camera };
        // The pixels that look for light go with the seed.
        Self { camera, ..self }.with_ray_spacing(self.ray_spacing)
    }

    /// Those pixels.
    #[must_use]
    pub fn pixels_that_look(&self) -> RaySpacing {
        RaySpacing::new(self.ray_spacing, self.ray_column, self.ray_row)
    }
}
