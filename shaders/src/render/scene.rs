//! `wgsl/render/{data,texture,sky,surface,scene,capture,trace,skylight,temporal,running_light}.wgsl`: a scene of triangles under a sky, traced by rays. Twins:
//! `downpour_trace::{texture, sky, surface, scene, capture, trace, skylight, temporal, running_light}`. The rays of the camera are in
//! [`path`](super::path).

use super::brdf::BRDF;
use super::camera::CAMERA;
use super::pane_shadow::PANE_SHADOW;
use super::path::PATH;
use super::puddle_water::PUDDLE_WATER;
use super::scatter::SCATTER;
use super::table::{LIGHT, MATERIAL};
use super::translucent::TRANSLUCENT;
use super::wet::WET;
use crate::bvh::BVH;
use crate::common::{COLOR, EQUIRECT, PACKING};
use crate::drop::optics::OPTICS;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[
    &SCENE_CONSTANTS,
    &DATA,
    &TEXTURE,
    &SKY,
    &SURFACE,
    &EMITTER,
    &SCENE,
    &CAPTURE,
    &SPACING,
    &TRACE,
    &SKYLIGHT,
    &TEMPORAL,
    &RUNNING_LIGHT,
];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[
    &TRACE_KERNEL,
    &TRACE_SAMPLE_KERNEL,
    &TRACE_SEEN_KERNEL,
    &SKYLIGHT_KERNEL,
    &TEMPORAL_KERNEL,
    &RUNNING_LIGHT_KERNEL,
];

shared_constants! {
    /// Numbers of the scene's tables and rays.
    SCENE_CONSTANTS at "render/scene constants" {
        /// Rows of a material in the table.
        SCENE_MATERIAL_ROWS: u32 = 7;
        /// Rows of a texture slot.
        SCENE_SLOT_ROWS: u32 = 3;
        /// Rows of a light.
        SCENE_LIGHT_ROWS: u32 = 4;
        /// Says that a material has no such texture.
        SCENE_NONE: u32 = 4294967295;
        /// Material flag: holes where alpha is below the cutoff.
        SCENE_MASKED: u32 = 1;
        /// Material flag: alpha mixes with what is behind.
        SCENE_BLENDED: u32 = 2;
        /// Material flag: both sides are seen.
        SCENE_DOUBLE_SIDED: u32 = 4;
        /// Alpha below which a blended material is a hole.
        SURFACE_OPEN: f32 = 0.002;
        /// Least squared sine of the angle between a ray and a normal at which the ray has a direction along the surface.
        SURFACE_OBLIQUE: f32 = 1.0e-6;
        /// Minimum cosine between a ray and a normal for the length of a pixel's image on the surface.
        SURFACE_GRAZING: f32 = 0.05;
        /// Minimum cosine between a ray and a bent surface for how much of it the ray's footprint has.
        SURFACE_BENT: f32 = 0.2;
        /// Material flag: the base color is what is seen, without light.
        SCENE_UNLIT: u32 = 8;
        /// Material flag: shining glass for which a lamp stands that shines in all directions.
        SCENE_LAMP_GLASS: u32 = 16;
        /// Material flag: shining glass of a spot. It is seen from where the spot does not shine, too.
        SCENE_SPOT_GLASS: u32 = 32;
        /// Roughness up to which a surface has no pores.
        SURFACE_DENSE: f32 = 0.45;
        /// Roughness from which a surface is porous all over.
        SURFACE_POROUS: f32 = 0.8;
        /// Samples of a texture along the longer side of a pixel's image on a surface, at most: surfaces seen at a grazing angle are blurred
        /// from 7 degrees on.
        TEXTURE_TAPS: f32 = 8.0;
        /// Width in texels of a box of the variance of a bilinear lookup: 1/12 of a texel's own box, and 1/6 of the tent between them.
        TEXTURE_TENT: f32 = 1.7320508;
        /// Largest distance of neighboring samples of a texture, in texels that each interpolates.
        TEXTURE_SPACE: f32 = 1.5;
        /// Texture flag: texels are square roots of linear colors.
        SCENE_ROOTED: u32 = 1;
        /// Texture flag: texels are slopes of a relief.
        SCENE_RELIEF: u32 = 32;
        /// First of eight bits of a relief's flags that say which part of its slopes' variance is the square of its lobe's alpha.
        TEXTURE_SHARE_SHIFT: u32 = 8;
        /// Steps of a slope to each side of 0, and of the root of a variance.
        TEXTURE_SLOPE_STEPS: f32 = 1023.0;
        /// Largest slope of a relief, and largest root of a variance.
        TEXTURE_STEEPEST: f32 = 4.0;
        /// Texture flag: repeats in u.
        SCENE_REPEAT_U: u32 = 2;
        /// Texture flag: mirrored repeat in u.
        SCENE_MIRROR_U: u32 = 4;
        /// Texture flag: repeats in v.
        SCENE_REPEAT_V: u32 = 8;
        /// Texture flag: mirrored repeat in v.
        SCENE_MIRROR_V: u32 = 16;
        /// Light kind: parallel light.
        SCENE_LIGHT_DIRECTIONAL: u32 = 0;
        /// Light kind: from a point, in a cone (a point light's cone is everything).
        SCENE_LIGHT_POINT: u32 = 1;
        /// Light kind: such a lamp whose glass is in the model, and shines.
        SCENE_LIGHT_BODY: u32 = 2;
        /// Light kind: from a place of a surface that shines; never in the table.
        SCENE_LIGHT_AREA: u32 = 3;
        /// Largest half angle of a lamp's disk, radians: from within its sphere.
        LIGHT_MAX_SPREAD: f32 = 1.5;
        /// Factors by which further digits of a random number become numbers of their own.
        SCENE_DIGIT: f32 = 61.0;
        /// See `SCENE_DIGIT`.
        SCENE_OTHER_DIGIT: f32 = 3571.0;
        /// Steps of the plane's lattice of least gaps: powers of 0.7548777, the inverse of the plastic number.
        SCENE_LATTICE: f32 = 0.7548777;
        /// See `SCENE_LATTICE`.
        SCENE_OTHER_LATTICE: f32 = 0.5698403;
        /// Part of what all lamps would give from which one has a ray to its middle and one to a place on its disk; others have one.
        SCENE_LARGE_LAMP: f32 = 0.25;
        /// Part of the way to a lamp where things are taken to stand that throw its shadows.
        SCENE_SHADOW_PART: f32 = 0.25;
        /// Maximum distance of these, m.
        SCENE_SHADOW_M: f32 = 5.0;
        /// Width of a shadow's edge up to which it is sharp, in pixels; from twice that on, means over neighbors are taken of it.
        SCENE_SHARP_PIXELS: f32 = 2.0;
        /// Minimum cosine of the angle of view for the image of a lamp.
        SCENE_MIN_COSINE: f32 = 0.05;
        /// Difference of what two rays toward a lamp let through up to which all do the same.
        SCENE_SAME_SHADOW: f32 = 0.01;
        /// Roughness below which a gloss shows the glass of a lamp; from it on, the lamp's lobe.
        SCENE_SEEN_BODY: f32 = 0.2;
        /// The same of surfaces that shine and are no lamp's glass. No number that materials have by hand, so that rounding does not
        /// decide.
        SCENE_SEEN_AREA: f32 = 0.59;
        /// Roughness from which means over neighbors are taken of what a gloss shows of lamps whose shadows are wide.
        SCENE_SHEEN: f32 = 0.35;
        /// Variance of slopes within a pixel from which they are not: neighbors of it may shine where it does not.
        SCENE_SHEEN_VARIANCE: f32 = 0.01;
        /// Words of a node of the tree of surfaces that shine.
        EMITTER_WORDS: u32 = 8;
        /// Nodes from the tree's root to a triangle, at most.
        EMITTER_DEPTH: u32 = 32;
        /// Minimum cosine at the surface for which the weight of such surfaces allows.
        EMITTER_GRAZING: f32 = 0.03;
        /// Square of the distance below which that weight does not grow, m^2.
        EMITTER_NEAREST: f32 = 1.0e-4;
        /// Square of the distance from a place within which its light does not grow, per area that it stands for.
        EMITTER_NEAR: f32 = 0.015625;
        /// See-through surfaces that a ray passes before it ends.
        SCENE_LAYERS: u32 = 12;
        /// Levels of the sky: the map itself, and means of it down to 4 rows from 16384.
        SCENE_SKY_LEVELS: u32 = 13;
        /// Texels of a map of one row, over pi, across a ray of width 1: a texel between its neighbors is wider than one.
        SKY_CONE_TEXELS: f32 = 0.2;
        /// Least roughness of the light of points and of the sun: a mirror would need their size.
        SCENE_MIN_ROUGHNESS: f32 = 0.06;
        /// Lamps that give less than this part of what all would give cast no ray.
        SCENE_MIN_LAMP: f32 = 0.001;
        /// Pixels to each side over which the sky's light is averaged, if one ray of each looks for it.
        SKYLIGHT_RADIUS: u32 = 3;
        /// Rays of a pixel from which a window of one pixel to each side holds enough of them.
        SKYLIGHT_MANY: u32 = 4;
        /// Distance from the plane of a pixel's surface at which a neighbor no longer counts, per distance from the eye.
        SKYLIGHT_SLACK: f32 = 0.002;
        /// Half the square of the angle, in alphas, at which a neighbor's gloss no longer counts.
        SKYLIGHT_LOBE: f32 = 2.0;
        /// Difference of two roughnesses, over the larger, from which glosses are not the same in a wet scene.
        SKYLIGHT_FILM: f32 = 0.6;
        /// Part of that difference over which they cease to be.
        SKYLIGHT_FILM_EDGE: f32 = 0.2;
        /// Wider means, each of twice the step.
        SKYLIGHT_PASSES: u32 = 3;
        /// Square of the difference of two means, in the sum of their variances, from which they are not the same.
        SKYLIGHT_NOISE: f32 = 25.0;
        /// Cosine of the angle between normals up to which samples of a pixel are of one surface.
        TRACE_SAME_NORMAL: f32 = 0.9;
        /// Weight of light that no ray has looked for, beside that of pixels whose rays did.
        SKYLIGHT_GUESSED: f32 = 0.00000001;
        /// Weight of what rays have found on the second surface of a pixel, beside the mean of a pixel that shows that surface first.
        SKYLIGHT_OWN: f32 = 0.0625;
        /// Weight of what is found on another surface, for a pixel whose rays have not looked.
        SKYLIGHT_LOOSE: f32 = 0.001;
        /// Roughness of a lobe within which that counts most.
        SKYLIGHT_LOOSE_ROUGHNESS: f32 = 0.45;
        /// Part of the width of a lobe through which what a gloss mirrors may turn while frames are averaged.
        RUNNING_LOBE: f32 = 0.5;
        /// Frames before a frame that tell with it whether light has changed.
        RUNNING_RECENT: f32 = 4.0;
        /// Factor of the variance of a frame alone, which is not known well.
        RUNNING_DOUBT: f32 = 3.0;
        /// Invocations along an edge of a workgroup.
        SPACING_GROUP: u32 = 8;
        /// Value of `suns_out` of a capture that leaves out all that shines by itself.
        SCENE_ALL_OUT: u32 = 2;
        /// Projection of a trace: the picture.
        SCENE_PICTURE: u32 = 0;
        /// Samples of the sky along an edge of a texel of the capture that shows nothing else.
        CAPTURE_SKY: u32 = 4;
        /// Four over pi: the area of the octahedral map's square, for an irradiance over pi.
        CAPTURE_AREA_OVER_PI: f32 = 1.2732395;
        /// A capture on an octahedral map.
        SCENE_OCTAHEDRAL: u32 = 1;
        /// A capture as a perspective picture.
        SCENE_PERSPECTIVE: u32 = 2;
        /// Beyond every distance.
        SCENE_FAR: f32 = 1.0e30;
    }
}

/// The buffers of a scene and of a frame.
pub static DATA: Module = Module {
    path: "render/data.wgsl",
    wgsl: include_str!("../../wgsl/render/data.wgsl"),
    uses: &[&SCENE_CONSTANTS, &CAMERA],
};

/// Textures in a buffer. Twin: `downpour_trace::texture`.
pub static TEXTURE: Module = Module {
    path: "render/texture.wgsl",
    wgsl: include_str!("../../wgsl/render/texture.wgsl"),
    uses: &[&DATA, &MATERIAL],
};

/// The light of the sky. Twin: `downpour_trace::sky`.
pub static SKY: Module = Module {
    path: "render/sky.wgsl",
    wgsl: include_str!("../../wgsl/render/sky.wgsl"),
    uses: &[&DATA, &EQUIRECT],
};

/// Surface that a ray finds. Twin: `downpour_trace::surface`.
pub static SURFACE: Module = Module {
    path: "render/surface.wgsl",
    wgsl: include_str!("../../wgsl/render/surface.wgsl"),
    uses: &[&DATA, &MATERIAL, &TEXTURE, &BVH],
};

/// Surfaces that shine, as lights. Twin: `downpour_trace::emitter`.
pub static EMITTER: Module = Module {
    path: "render/emitter.wgsl",
    wgsl: include_str!("../../wgsl/render/emitter.wgsl"),
    uses: &[&DATA, &LIGHT, &BVH],
};

/// The light of lamps in a scene. Twin: `downpour_trace::scene`.
pub static SCENE: Module = Module {
    path: "render/scene.wgsl",
    wgsl: include_str!("../../wgsl/render/scene.wgsl"),
    uses: &[
        &DATA,
        &LIGHT,
        &MATERIAL,
        &SURFACE,
        &EMITTER,
        &BRDF,
        &OPTICS,
        &PANE_SHADOW,
        &PUDDLE_WATER,
        &SCATTER,
        &TRANSLUCENT,
        &WET,
    ],
};

/// Pixels of the picture and of the capture. Twin: `downpour_trace::trace`.
pub static TRACE: Module = Module {
    path: "render/trace.wgsl",
    wgsl: include_str!("../../wgsl/render/trace.wgsl"),
    uses: &[&SCENE, &PATH, &CAPTURE, &SPACING, &PACKING],
};

/// Pixels whose rays look for light. Twin: `downpour_render::spacing`.
pub static SPACING: Module = Module {
    path: "render/spacing.wgsl",
    wgsl: include_str!("../../wgsl/render/spacing.wgsl"),
    uses: &[&SCENE_CONSTANTS, &DATA],
};

/// The environment capture around the eye. Twin: `downpour_trace::capture`.
pub static CAPTURE: Module = Module {
    path: "render/capture.wgsl",
    wgsl: include_str!("../../wgsl/render/capture.wgsl"),
    uses: &[&SCENE, &LIGHT, &SKY, &PACKING],
};

/// All samples of the pixels; one invocation per pixel.
pub static TRACE_KERNEL: Kernel = Kernel { entry: "main_trace", module: &TRACE, workgroup: [8, 8, 1] };

/// One sample of the pixels; one invocation per pixel.
pub static TRACE_SAMPLE_KERNEL: Kernel =
    Kernel { entry: "main_trace_sample", module: &TRACE, workgroup: [8, 8, 1] };

/// The pixels of all their samples; one invocation per pixel.
pub static TRACE_SEEN_KERNEL: Kernel =
    Kernel { entry: "main_trace_seen", module: &TRACE, workgroup: [8, 8, 1] };

/// Storage buffers of `main_trace`: two more than WebGPU's default limit. A device with fewer takes the samples one by one.
pub const TRACE_STORAGE_BUFFERS: u32 = 10;

/// Bytes of a pixel that `main_trace_sample` keeps from sample to sample (`TraceState`).
pub const TRACE_STATE_BYTES: u64 = 560;

/// The sky's light over neighboring pixels. Twin: `downpour_trace::skylight`.
pub static SKYLIGHT: Module = Module {
    path: "render/skylight.wgsl",
    wgsl: include_str!("../../wgsl/render/skylight.wgsl"),
    uses: &[&TRACE, &COLOR, &PACKING],
};

/// One invocation per pixel.
pub static SKYLIGHT_KERNEL: Kernel =
    Kernel { entry: "main_skylight", module: &SKYLIGHT, workgroup: [8, 8, 1] };

/// That light over the frames of a clip. Twin: `downpour_trace::temporal`.
pub static TEMPORAL: Module = Module {
    path: "render/temporal.wgsl",
    wgsl: include_str!("../../wgsl/render/temporal.wgsl"),
    uses: &[&SKYLIGHT, &TRACE, &CAMERA],
};

/// One invocation per pixel.
pub static TEMPORAL_KERNEL: Kernel =
    Kernel { entry: "main_temporal", module: &TEMPORAL, workgroup: [8, 8, 1] };

/// That light in live frames. Twin: `downpour_trace::running_light`.
pub static RUNNING_LIGHT: Module = Module {
    path: "render/running_light.wgsl",
    wgsl: include_str!("../../wgsl/render/running_light.wgsl"),
    uses: &[&TEMPORAL, &SKYLIGHT, &TRACE, &CAMERA],
};

/// One invocation per pixel.
pub static RUNNING_LIGHT_KERNEL: Kernel =
    Kernel { entry: "main_running_light", module: &RUNNING_LIGHT, workgroup: [8, 8, 1] };
