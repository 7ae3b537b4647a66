//! `wgsl/mask`: refraction masks. The Rust twins are in `downpour-mask`.

use crate::bvh::BVH;
use crate::drop::{optics, oscillation, shape};
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&MASK_CONSTANTS, &TEXEL, &TRACE, &SILHOUETTE, &DROP, &MODEL, &WOBBLE];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&DROP_KERNEL, &MODEL_KERNEL];

shared_constants! {
    /// Constants of the tracer.
    MASK_CONSTANTS at "mask/constants" {
        /// Newton steps to a point of the surface. From the spheroid's point, four steps bring every drop up to
        /// 9 mm to the precision of f32; the tests count them.
        MASK_TRACE_STEPS: u32 = 4;
        /// Total internal reflections that are followed before the light counts as lost. Seen from the side a drop
        /// up to 7 mm has none; in tilted views of large drops a tenth of the light is reflected five times.
        MASK_TRACE_REFLECTIONS: u32 = 8;
        /// Steps to the point of a line that is nearest to the surface.
        MASK_SILHOUETTE_STEPS: u32 = 4;
        /// Squared gauge of the spheroid below which a pixel is certainly inside.
        MASK_SILHOUETTE_INSIDE: f32 = 0.7;
        /// Squared gauge of the spheroid above which a pixel is certainly outside, margin for the bleed included (large
        /// pixels of small masks are handled by the width of the pixel).
        MASK_SILHOUETTE_OUTSIDE: f32 = 1.4;
        /// Pixels outside the silhouette that still hold directions, so that a filter at the edge mixes
        /// directions with directions.
        MASK_BLEED: f32 = 2.0;
        /// Depth below the outline, in pixels, above which no ray is traced.
        MASK_EDGE_DEPTH: f32 = 0.1;
        /// Nearest distance of the next surface, in equivalent radii: a ray must not meet the point that it left.
        MASK_MODEL_MIN_DISTANCE: f32 = 1.0e-4;
        /// Rays along an edge of a texel that the outline of a model cuts.
        MASK_MODEL_SUBSAMPLES: u32 = 8;
        /// Below this, a squared length has no direction.
        MASK_TINY: f32 = 1.0e-20;
        /// Newton steps to a point of the surface of a drop that oscillates.
        MASK_WOBBLE_STEPS: u32 = 6;
        /// Steps to the point of a line that is nearest to it, from a guess.
        MASK_WOBBLE_NEAREST_STEPS: u32 = 2;
        /// Interfaces inside that are followed, total reflections included.
        MASK_WOBBLE_BOUNCES: u32 = 12;
        /// Exits from inside that are distinguished.
        MASK_WOBBLE_EXITS: u32 = 3;
    }
}

/// A ray through a drop. Twin: `downpour_mask::trace`.
pub static TRACE: Module = Module {
    path: "mask/trace.wgsl",
    wgsl: include_str!("../wgsl/mask/trace.wgsl"),
    uses: &[&MASK_CONSTANTS, &shape::SHAPE, &optics::OPTICS],
};

/// A ray through a drop that oscillates. Twin: `downpour_mask::wobble`.
pub static WOBBLE: Module = Module {
    path: "mask/wobble.wgsl",
    wgsl: include_str!("../wgsl/mask/wobble.wgsl"),
    uses: &[&MASK_CONSTANTS, &TRACE, &shape::SHAPE, &optics::OPTICS, &oscillation::OSCILLATION],
};

/// The outline of a drop in a pixel. Twin: `downpour_mask::silhouette`.
pub static SILHOUETTE: Module = Module {
    path: "mask/silhouette.wgsl",
    wgsl: include_str!("../wgsl/mask/silhouette.wgsl"),
    uses: &[&MASK_CONSTANTS, &TRACE],
};

/// The mask of a drop of revolution. Twin: `downpour_mask::drop`.
pub static DROP: Module = Module {
    path: "mask/drop.wgsl",
    wgsl: include_str!("../wgsl/mask/drop.wgsl"),
    uses: &[&TEXEL, &TRACE, &SILHOUETTE],
};

/// One texel of a mask. Host type: `downpour_mask::MaskTexel`.
pub static TEXEL: Module =
    Module { path: "mask/texel.wgsl", wgsl: include_str!("../wgsl/mask/texel.wgsl"), uses: &[] };

/// The mask of a drop given as a mesh. Twin: `downpour_mask::model`.
pub static MODEL: Module = Module {
    path: "mask/model.wgsl",
    wgsl: include_str!("../wgsl/mask/model.wgsl"),
    uses: &[&MASK_CONSTANTS, &TEXEL, &TRACE, &BVH],
};

/// One invocation per texel of a mask.
pub static DROP_KERNEL: Kernel = Kernel { entry: "main_mask_drop", module: &DROP, workgroup: [8, 8, 1] };

/// One invocation per texel of a mask of a model.
pub static MODEL_KERNEL: Kernel = Kernel { entry: "main_mask_model", module: &MODEL, workgroup: [8, 8, 1] };
