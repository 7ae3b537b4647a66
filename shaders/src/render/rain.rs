//! `wgsl/render/{reduce,drops*,streak*}.wgsl`: drops before a scene. Twins: `downpour_render::rain`.

use super::camera::CAMERA;
use super::drop_light::{DROP_GLINT, DROP_LIGHT_CONSTANTS};
use super::medium::{MEDIUM, MEDIUM_STREAKS};
use crate::atlas::ATLAS;
use crate::common::{INVOCATION, OPS, PACKING};
use crate::drop::oscillation::OSCILLATION;
use crate::drop::shape::SHAPE;
use crate::mask::WOBBLE;
use crate::sim::field::EYE_DROP;
use crate::sim::splash::SPLASH_CONSTANTS;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[
    &RAIN_CONSTANTS,
    &COMPOSE,
    &DROPS_FRAME,
    &DROPS_CAPTURE,
    &DROPS_MASK,
    &DROPS_SHADE,
    &STREAK,
    &STREAK_CELL,
    &STREAK_SPAN,
    &STREAK_PATH,
    &STREAK_RAY,
    &STREAK_RAYS_MODULE,
    &STREAK_LIGHT,
    &STREAK_LOOKUP,
    &STREAK_TABLE,
    &PROJECT_TABLES,
    &PROJECT,
    &PROFILES_TABLES,
    &PROFILES,
    &TILES,
    &DROPS_ATLAS,
    &DROPS_GLINT,
    &DROPS_MEDIUM,
    &DROPS,
    &DROPS_SUM,
];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[
    &COMPOSE_KERNEL,
    &COMPOSE_LIT_KERNEL,
    &STREAK_TABLE_KERNEL,
    &STREAK_RAYS_KERNEL,
    &STREAK_LIGHT_KERNEL,
    &PROJECT_KERNEL,
    &PROFILES_CLEAR_KERNEL,
    &PROFILES_MEASURE_KERNEL,
    &PROFILES_PLACE_KERNEL,
    &PROFILES_FINISH_KERNEL,
    &TILES_CLEAR_KERNEL,
    &TILES_MEASURE_KERNEL,
    &TILES_COUNT_KERNEL,
    &TILES_SCAN_KERNEL,
    &TILES_PLACE_KERNEL,
    &TILES_SORT_KERNEL,
    &TILES_SEEN_KERNEL,
    &DROPS_UNLISTED_KERNEL,
    &DROPS_KERNEL,
    &DROPS_SUM_CLEAR_KERNEL,
    &DROPS_SUM_SCALE_KERNEL,
    &DROPS_SUM_THIN_KERNEL,
    &DROPS_SUM_WIDE_KERNEL,
    &DROPS_SUM_FINISH_KERNEL,
];

shared_constants! {
    /// Numbers of the masks in a buffer.
    RAIN_CONSTANTS at "render/rain constants" {
        /// Words of a texel of a mask: three directions, and four fractions.
        DROPS_TEXEL_WORDS: u32 = 5;
        /// Masks of a diameter, from below (-90 degrees) to above (90 degrees).
        DROPS_ELEVATIONS: u32 = 7;
        /// Smallest edge of a tile of the picture, pixels.
        DROPS_TILE: u32 = 8;
        /// Edges of tiles, each twice the one before: the largest is a picture.
        TILES_EDGES: u32 = 12;
        /// Words before the numbers of drops of the tiles.
        TILES_HEAD: u32 = 16;
        /// Invocations that sum up the numbers of drops.
        TILES_SCAN: u32 = 256;
        /// Drops of a tile that are sorted in workgroup memory.
        TILES_SORTED: u32 = 1024;
        /// Drops of a workgroup that lists drops.
        TILES_GROUP: u32 = 64;
        /// Columns and rows of tiles of a drop that the invocations of a workgroup deal with at once: their squares are a workgroup.
        TILES_LANES: u32 = 8;
        /// Tiles that one invocation deals with.
        TILES_FEW: u32 = 64;
        /// Diameters of the masks.
        PROJECT_DIAMETERS: u32 = 18;
        /// Meters between them; the first is one step.
        PROJECT_DIAMETER_STEP: f32 = 0.5e-3;
        /// Stages of a splash that have masks, behind those of the drops.
        PROJECT_SPLASHES: u32 = 8;
        /// The stage of them at which it is highest.
        PROJECT_SPLASH_TOP: f32 = 3.0;
        /// Rows of the masks: of the diameters and of the splashes.
        PROJECT_ROWS: u32 = 26;
        /// Drops whose path is shorter than this fraction of their radius stand still.
        PROJECT_STILL: f32 = 0.05;
        /// Still drops of a smaller diameter on the picture, in pixels, are spread over the pixels around them.
        PROJECT_SMALL: f32 = 1.0;
        /// So are the streaks of drops below this diameter.
        PROJECT_THIN: f32 = 1.5;
        /// Streaks below this diameter on the picture, in pixels, have more samples.
        PROJECT_NARROW: f32 = 4.0;
        /// Samples of a pixel of a narrow streak, no multiple of `STREAK_LATTICE`.
        PROJECT_NARROW_SAMPLES: u32 = 8;
        /// Samples of a pixel of a wide streak, no multiple of `STREAK_LATTICE`.
        PROJECT_WIDE_SAMPLES: u32 = 5;
        /// Smallest diameter, m, of a drop that oscillates.
        PROJECT_OSCILLATES_MIN: f32 = 0.05e-3;
        /// Largest diameter, m, of a drop that oscillates.
        PROJECT_OSCILLATES_MAX: f32 = 9.0e-3;
        /// Bits of the first diameter of the frequencies, 2^-15 m; entries are 2^16 bits apart, 128 for each octave.
        PROJECT_FIRST_BITS: u32 = 0x38000000;
        /// Bits of the last diameter of the frequencies: just below 2^-6 m.
        PROJECT_LAST_BITS: u32 = 0x3c7fffff;
        /// Classes of drops that have a mean in the streak radiance table.
        PROJECT_CLASSES: u32 = 8;
        /// No class.
        PROJECT_NO_CLASS: u32 = 0xffffffff;
        /// Kinds of profiles, by the width of the streak.
        PROFILES_KINDS: u32 = 4;
        /// Times that profiles are made coarser, at most, and one.
        PROFILES_LEVELS: u32 = 7;
        /// Sums over all profiles: rays and entries for each level.
        PROFILES_TOTALS: u32 = 14;
        /// Word of the classes that are wanted, behind the sums.
        PROFILES_CLASSES: u32 = 28;
        /// Word of the number of paths.
        PROFILES_PATHS: u32 = 29;
        /// Word of the number of rays.
        PROFILES_RAYS: u32 = 30;
        /// Word of the number of entries.
        PROFILES_ENTRIES: u32 = 31;
        /// Word of the number of rows of rays.
        PROFILES_RAY_JOBS: u32 = 32;
        /// Word of the number of parts of profiles.
        PROFILES_LIGHT_JOBS: u32 = 33;
        /// Number of these words.
        PROFILES_STATE: u32 = 34;
        /// Radians of the picture that a row of rays stands for: the directions in which a drop is seen differ by that.
        PROFILES_TURNED: f32 = 0.025;
        /// Profiles have half as many rows again as rays have.
        PROFILES_ROWS_FOR_TWO: u32 = 3;
        /// Shapes for the rays of streaks.
        PROFILES_SHAPES: u32 = 90;
        /// Meters between them; the first is one step.
        PROFILES_SHAPE_STEP: f32 = 0.1e-3;
        /// Numbers of a shape.
        PROFILES_SHAPE_WORDS: u32 = 20;
        /// First of them: behind 26 half extents, 182 areas and 182 ovals of three numbers.
        PROFILES_SHAPES_BEGIN: u32 = 754;
        /// Workgroups along a row: fewer than every device allows.
        PROFILES_ALONG: u32 = 32768;
        /// Samples along an edge of the mask of a drop below a pixel.
        DROPS_SMALL_GRID: u32 = 3;
        /// Inverse of the mean over a sphere's outline of the squared sine by which it bends light.
        DROPS_BENT: f32 = 3.8;
        /// No part of a splash shows more of a lamp's light than so many times the mean.
        DROPS_MAX_BENT: f32 = 4.0;
        /// Form of refraction: the direction of the refracted light is looked up.
        DROPS_DIRECTION: u32 = 0;
        /// Form of refraction: the position in the captured picture is shifted (Rousseau 2006).
        DROPS_SHIFT: u32 = 1;
        /// No streak that is summed up counts as farther away, m.
        DROPS_FAR: f32 = 1000.0;
        /// Workgroups along a row, of blocks in which drops are listed: fewer than every device allows.
        DROPS_ALONG: u32 = 32768;
        /// Below this transmittance the rest of the drops is not seen.
        DROPS_OPAQUE: f32 = 1.0e-3;
        /// Twice the inverse of water's refractive index: the middle of a sphere bends by 2 - 2 / n per radius.
        DROPS_STRAIGHT: f32 = 1.5;
        /// A drop that does not move on the picture.
        DROPS_STILL: u32 = 0;
        /// A streak whose light is looked up.
        DROPS_TABLE: u32 = 1;
        /// A streak whose light is averaged by a loop.
        DROPS_LOOP: u32 = 2;
        /// Streaks show what drops refract and reflect.
        STREAK_REFRACTED: u32 = 0;
        /// Streaks have one color, the mean of the environment.
        STREAK_WHITE: u32 = 1;
        /// Rays of the means of the streak radiance table along an edge of the picture.
        STREAK_RAYS: u32 = 17;
        /// Points of a mean, a multiple of those of its group; about half of them meet the drop.
        STREAK_MEAN_POINTS: u32 = 128;
        /// Invocations that share the points of a mean.
        STREAK_MEAN_GROUP: u32 = 64;
        /// Steps of the lattice of points of a mean: powers of 0.8566749, the fourth dimension's golden ratio.
        STREAK_MEAN_FIRST: f32 = 0.8566749;
        /// See `STREAK_MEAN_FIRST`.
        STREAK_MEAN_SECOND: f32 = 0.7338919;
        /// See `STREAK_MEAN_FIRST`.
        STREAK_MEAN_THIRD: f32 = 0.6287067;
        /// See `STREAK_MEAN_FIRST`.
        STREAK_MEAN_FOURTH: f32 = 0.5385973;
        /// Radius of the disk of points of a mean, over that of the spheroid that is meant by the mode (2,0).
        STREAK_MEAN_REACH: f32 = 1.25;
        /// Width of a point of a mean, in radii of its disk: the square root of pi over the points.
        STREAK_MEAN_WIDTH: f32 = 0.15666;
        /// Least squared cosine at the rim of the disk of points.
        STREAK_MEAN_RIM: f32 = 0.02;
        /// Chord samples across a drop as far apart as what they show is smoothed, for loops.
        STREAK_FINE: u32 = 36;
        /// Running sums along a chord.
        STREAK_SUMS: u32 = 4;
        /// Points of the outline of a drop.
        STREAK_OUTLINE: u32 = 64;
        /// Steps to a point of the outline.
        STREAK_OUTLINE_STEPS: u32 = 6;
        /// Least slope of the gauge along a radius, for a step.
        STREAK_OUTLINE_SLOPE: f32 = 0.2;
        /// No point of an outline is nearer to the middle, in radii.
        STREAK_OUTLINE_MIN: f32 = 0.3;
        /// No point of an outline is farther from the middle, in radii.
        STREAK_OUTLINE_MAX: f32 = 2.0;
        /// Exits of a ray from inside that are looked up, as the tracer tells them apart.
        STREAK_EXITS: u32 = 3;
        /// Lamps on a streak that are resolved one by one.
        STREAK_LAMPS: u32 = 8;
        /// Points of a ray's patch at which a lamp is looked for.
        STREAK_SPOTS: u32 = 64;
        /// Steps of the lattice of these points along a chord, and in time.
        STREAK_SPOT_ALONG: f32 = 0.7548777;
        /// See `STREAK_SPOT_ALONG`.
        STREAK_SPOT_LATER: f32 = 0.5698403;
        /// A lamp is looked for this fraction of a patch's size from its middle.
        STREAK_SPOT_REACH: f32 = 0.75;
        /// Patches below this size, radians, are flat enough to tell which of their points may see a lamp.
        STREAK_SPOT_FLAT: f32 = 1.0;
        /// Factor of the bounds of these points, for directions have the length 1.
        STREAK_SPOT_SLACK: f32 = 1.2;
        /// Radius of a round spot over whose points a patch's light is shared evenly enough, over their distance.
        STREAK_SPOT_WIDTH: f32 = 1.8;
        /// No edge of a disk is narrower, for the division.
        STREAK_SPOT_EDGE: f32 = 1.0e-6;
        /// A patch counts as no narrower than this fraction of its length, for its points.
        STREAK_SPOT_NARROW: f32 = 0.2;
        /// The same for the width over which the environment is averaged.
        STREAK_NARROWEST: f32 = 0.25;
        /// Steps from patch to patch of the shift of these points: powers of 0.8191725, the third dimension's golden ratio.
        STREAK_SPOT_FIRST: f32 = 0.8191725;
        /// See `STREAK_SPOT_FIRST`.
        STREAK_SPOT_SECOND: f32 = 0.6710436;
        /// See `STREAK_SPOT_FIRST`.
        STREAK_SPOT_THIRD: f32 = 0.5497005;
        /// Half a right angle's worth of columns: pi / 2.
        STREAK_QUARTER: f32 = 1.5707964;
        /// 2 pi.
        STREAK_TURN: f32 = 6.2831855;
        /// Fraction by which the depth of a drop changes at most, beyond the ends of its exposure, on the path of its profile.
        STREAK_SPAN_ROOM: f32 = 0.5;
        /// Exposures by which that path is longer at most, at either end.
        STREAK_SPAN_MAX: f32 = 32.0;
        /// Most that a streak with a profile covers of a pixel that is summed up.
        STREAK_SUM_COVER: f32 = 0.125;
        /// Most that one without a profile covers.
        STREAK_SUM_THIN: f32 = 0.75;
        /// It reaches no farther from its path, pixels.
        STREAK_SUM_REACH: f32 = 8.0;
        /// Invocations that share the path of a streak without a profile.
        DROPS_SUM_SHARED: u32 = 16;
        /// Invocations that share the path of one with a profile.
        DROPS_SUM_WIDE: u32 = 256;
        /// Drops of the list among which a workgroup looks for these.
        DROPS_SUM_LOOKED: u32 = 32;
        /// Coverages and optical depths below this are turned into each other by a series.
        DROPS_SUM_FEW: f32 = 0.1;
        /// Units of the scale: 2^32.
        DROPS_SUM_UNITS: f32 = 4294967296.0;
        /// From so many units on light is summed in large ones.
        DROPS_SUM_SMALL: f32 = 524288.0;
        /// A large unit.
        DROPS_SUM_LARGE: f32 = 4096.0;
        /// The most of these that a streak adds to a pixel.
        DROPS_SUM_MAX: f32 = 1073741824.0;
        /// Units of an optical depth of 1: 2^20.
        DROPS_SUM_DEPTHS: f32 = 1048576.0;
        /// Units of an optical depth of 1 at 1 m: 2^14.
        DROPS_SUM_WAYS: f32 = 16384.0;
        /// Bits of the least scale, 2^-60.
        DROPS_SUM_FAINTEST: u32 = 0x21800000;
        /// Bits of the largest scale, 2^60.
        DROPS_SUM_BRIGHTEST: u32 = 0x5d800000;
        /// Step of the lattice of a pixel's samples.
        STREAK_LATTICE: u32 = 3;
        /// Shift of these samples from line to line: the golden ratio's part of 2^16.
        STREAK_GOLDEN: u32 = 40503;
        /// Reach of a bump that is as wide as a disk, over the disk's radius: half the square root of 7, by their second moments.
        DROPS_GLINT_BUMP: f32 = 1.3228756;
        /// Width of a box that is as wide as a disk, over the disk's radius: the square root of 3, by their second moments.
        DROPS_GLINT_BOX: f32 = 1.7320508;
        /// Position of Gauss's two points: 1 / sqrt(3).
        STREAK_GAUSS: f32 = 0.57735026;
        /// Words before the texels of an atlas.
        DROPS_ATLAS_HEAD: u32 = 6;
        /// Samples of a streak's length in a pixel, where it has no width.
        DROPS_ATLAS_TAPS: u32 = 4;
    }
}

shared_tables! {
    /// Table of `project.wgsl`.
    PROJECT_TABLES at "render/project tables" {
        /// Rows of the masks' diameters of the classes: 0.5, 1, 1.5, 2, 3, 4, 5 and 6.5 mm.
        PROJECT_CLASS_ROWS: [f32; 8] = [0.0, 1.0, 2.0, 3.0, 5.0, 7.0, 9.0, 12.0];
    }
}

shared_tables! {
    /// Tables of `profiles.wgsl`: from thin streaks to wide ones.
    PROFILES_TABLES at "render/profiles tables" {
        /// Widths, pixels, up to which a streak is of a kind; the last has no limit.
        PROFILES_WIDTHS: [f32; 4] = [3.0, 6.0, 14.0, 3.0e38];
        /// Columns across the motion.
        PROFILES_COLUMNS: [f32; 4] = [12.0, 16.0, 24.0, 36.0];
        /// Rows for each turn of the mode (3,1).
        PROFILES_PER_TURN: [f32; 4] = [8.0, 12.0, 20.0, 24.0];
        /// The least of them, besides the first row.
        PROFILES_MIN: [f32; 4] = [3.0, 4.0, 6.0, 6.0];
        /// The most of them.
        PROFILES_MAX: [f32; 4] = [24.0, 48.0, 96.0, 128.0];
        /// Columns of the profile for each of the rays'.
        PROFILES_FINE: [f32; 4] = [1.0, 2.0, 2.0, 4.0];
    }
}

/// A plate through the rain before it. Twin: `downpour_render::picture`.
pub static COMPOSE: Module =
    Module { path: "render/compose.wgsl", wgsl: include_str!("../../wgsl/render/compose.wgsl"), uses: &[] };

/// The picture as the drops' kernels know it. Twin: `downpour_render::rain::drops_frame`.
pub static DROPS_FRAME: Module = Module {
    path: "render/drops_frame.wgsl",
    wgsl: include_str!("../../wgsl/render/drops_frame.wgsl"),
    uses: &[&RAIN_CONSTANTS, &CAMERA],
};

/// The capture between its texels. Twin: `downpour_render::rain::drops_capture`.
pub static DROPS_CAPTURE: Module = Module {
    path: "render/drops_capture.wgsl",
    wgsl: include_str!("../../wgsl/render/drops_capture.wgsl"),
    uses: &[&RAIN_CONSTANTS, &PACKING, &DROPS_FRAME, &DROP_GLINT],
};

/// The masks between their texels. Twin: `downpour_render::rain::drops_mask`.
pub static DROPS_MASK: Module = Module {
    path: "render/drops_mask.wgsl",
    wgsl: include_str!("../../wgsl/render/drops_mask.wgsl"),
    uses: &[&RAIN_CONSTANTS, &PACKING, &DROPS_FRAME],
};

/// Light that a ray sees through a drop. Twin: `downpour_render::rain::drops_shade`.
pub static DROPS_SHADE: Module = Module {
    path: "render/drops_shade.wgsl",
    wgsl: include_str!("../../wgsl/render/drops_shade.wgsl"),
    uses: &[&RAIN_CONSTANTS, &PACKING, &DROPS_FRAME, &DROPS_CAPTURE, &DROPS_MASK, &DROP_GLINT],
};

/// Part of the exposure in which a ray passes a drop that moves, and the position there. Twin:
/// `downpour_render::rain::streak`.
pub static STREAK: Module = Module {
    path: "render/streak.wgsl",
    wgsl: include_str!("../../wgsl/render/streak.wgsl"),
    uses: &[&RAIN_CONSTANTS, &OSCILLATION],
};

/// Positions across a drop. Twin: `downpour_render::rain::streak_cell`.
pub static STREAK_CELL: Module = Module {
    path: "render/streak_cell.wgsl",
    wgsl: include_str!("../../wgsl/render/streak_cell.wgsl"),
    uses: &[&RAIN_CONSTANTS],
};

/// Paths of the profiles of streaks. Twin: `downpour_render::rain::streak_span`.
pub static STREAK_SPAN: Module = Module {
    path: "render/streak_span.wgsl",
    wgsl: include_str!("../../wgsl/render/streak_span.wgsl"),
    uses: &[&RAIN_CONSTANTS, &STREAK],
};

/// A ray of a profile. Host type: `downpour_render::rain::StreakRay`.
pub static STREAK_RAY: Module = Module {
    path: "render/streak_ray.wgsl",
    wgsl: include_str!("../../wgsl/render/streak_ray.wgsl"),
    uses: &[],
};

/// A streak in time. Twin: `downpour_render::rain::streak_path`.
pub static STREAK_PATH: Module = Module {
    path: "render/streak_path.wgsl",
    wgsl: include_str!("../../wgsl/render/streak_path.wgsl"),
    uses: &[&RAIN_CONSTANTS, &OSCILLATION, &SHAPE, &WOBBLE, &STREAK, &STREAK_SPAN, &DROP_GLINT],
};

/// The rays of the profiles of streaks. Twin: `downpour_render::rain::streak_rays`.
pub static STREAK_RAYS_MODULE: Module = Module {
    path: "render/streak_rays.wgsl",
    wgsl: include_str!("../../wgsl/render/streak_rays.wgsl"),
    uses: &[
        &RAIN_CONSTANTS,
        &PACKING,
        &WOBBLE,
        &STREAK,
        &STREAK_CELL,
        &STREAK_PATH,
        &STREAK_RAY,
        &DROP_GLINT,
    ],
};

/// The light of the profiles of streaks. Twin: `downpour_render::rain::streak_light`.
pub static STREAK_LIGHT: Module = Module {
    path: "render/streak_light.wgsl",
    wgsl: include_str!("../../wgsl/render/streak_light.wgsl"),
    uses: &[
        &RAIN_CONSTANTS,
        &PACKING,
        &DROPS_FRAME,
        &DROPS_CAPTURE,
        &STREAK,
        &STREAK_CELL,
        &STREAK_PATH,
        &STREAK_RAY,
        &DROP_GLINT,
    ],
};

/// The streak radiance table. Twin: `downpour_render::rain::streak_lookup`.
pub static STREAK_LOOKUP: Module = Module {
    path: "render/streak_lookup.wgsl",
    wgsl: include_str!("../../wgsl/render/streak_lookup.wgsl"),
    uses: &[&RAIN_CONSTANTS, &STREAK, &STREAK_SPAN, &STREAK_CELL],
};

/// Computation of the means of the streak radiance table. Twin: `downpour_render::rain::streak_table`.
pub static STREAK_TABLE: Module = Module {
    path: "render/streak_table.wgsl",
    wgsl: include_str!("../../wgsl/render/streak_table.wgsl"),
    uses: &[&RAIN_CONSTANTS, &OSCILLATION, &WOBBLE, &DROPS_FRAME, &DROPS_CAPTURE, &STREAK_PATH, &DROP_GLINT],
};

/// The streaks of an atlas between their texels. Twin: `downpour_render::rain::drops_atlas`.
pub static DROPS_ATLAS: Module = Module {
    path: "render/drops_atlas.wgsl",
    wgsl: include_str!("../../wgsl/render/drops_atlas.wgsl"),
    uses: &[&RAIN_CONSTANTS, &DROPS_FRAME, &DROPS_MASK, &ATLAS],
};

/// Glints of lamps on a drop, pixel by pixel. Twin: `downpour_render::rain::drops_glint`.
pub static DROPS_GLINT: Module = Module {
    path: "render/drops_glint.wgsl",
    wgsl: include_str!("../../wgsl/render/drops_glint.wgsl"),
    uses: &[&RAIN_CONSTANTS, &CAMERA, &DROPS_FRAME, &STREAK, &DROP_LIGHT_CONSTANTS, &DROP_GLINT],
};

/// Mean radiance of unresolved drops. Twin: `downpour_render::rain::drops_medium`.
pub static DROPS_MEDIUM: Module = Module {
    path: "render/drops_medium.wgsl",
    wgsl: include_str!("../../wgsl/render/drops_medium.wgsl"),
    uses: &[&RAIN_CONSTANTS, &DROPS_FRAME, &DROPS_CAPTURE, &STREAK_LOOKUP, &MEDIUM],
};

/// Drops through their masks. Twin: `downpour_render::rain::drops`.
pub static DROPS: Module = Module {
    path: "render/drops.wgsl",
    wgsl: include_str!("../../wgsl/render/drops.wgsl"),
    uses: &[
        &RAIN_CONSTANTS,
        &PACKING,
        &DROPS_FRAME,
        &DROPS_CAPTURE,
        &DROPS_MASK,
        &DROPS_SHADE,
        &STREAK,
        &STREAK_LOOKUP,
        &DROPS_ATLAS,
        &DROP_LIGHT_CONSTANTS,
        &DROP_GLINT,
        &DROPS_GLINT,
        &DROPS_MEDIUM,
        &MEDIUM,
        &MEDIUM_STREAKS,
    ],
};

/// Falling drops on a picture. Twin: `downpour_render::rain::project`.
pub static PROJECT: Module = Module {
    path: "render/project.wgsl",
    wgsl: include_str!("../../wgsl/render/project.wgsl"),
    uses: &[
        &INVOCATION,
        &OPS,
        &EYE_DROP,
        &SPLASH_CONSTANTS,
        &RAIN_CONSTANTS,
        &PROJECT_TABLES,
        &CAMERA,
        &OSCILLATION,
        &STREAK,
        &DROP_GLINT,
    ],
};

/// Profiles of streaks in the streak radiance table. Twin: `downpour_render::rain::profiles`.
pub static PROFILES: Module = Module {
    path: "render/profiles.wgsl",
    wgsl: include_str!("../../wgsl/render/profiles.wgsl"),
    uses: &[
        &INVOCATION,
        &RAIN_CONSTANTS,
        &PROFILES_TABLES,
        &OSCILLATION,
        &SHAPE,
        &STREAK,
        &STREAK_SPAN,
        &STREAK_PATH,
    ],
};

/// Lists of drops for the tiles of a picture. Twin: `downpour_render::rain::tiles`.
pub static TILES: Module = Module {
    path: "render/tiles.wgsl",
    wgsl: include_str!("../../wgsl/render/tiles.wgsl"),
    uses: &[&INVOCATION, &RAIN_CONSTANTS, &OSCILLATION, &STREAK],
};

/// Streaks that are summed up. Twin: `downpour_render::rain::drops_sum`.
pub static DROPS_SUM: Module = Module {
    path: "render/drops_sum.wgsl",
    wgsl: include_str!("../../wgsl/render/drops_sum.wgsl"),
    uses: &[
        &INVOCATION,
        &RAIN_CONSTANTS,
        &CAMERA,
        &DROPS_FRAME,
        &DROPS_CAPTURE,
        &STREAK,
        &DROPS_GLINT,
        &DROPS,
    ],
};

/// One invocation per place in the list.
pub static PROJECT_KERNEL: Kernel = Kernel { entry: "main_project", module: &PROJECT, workgroup: [64, 1, 1] };

/// One invocation per word of the state and streak.
pub static PROFILES_CLEAR_KERNEL: Kernel =
    Kernel { entry: "main_profiles_clear", module: &PROFILES, workgroup: [64, 1, 1] };

/// One invocation per drop.
pub static PROFILES_MEASURE_KERNEL: Kernel =
    Kernel { entry: "main_profiles_measure", module: &PROFILES, workgroup: [64, 1, 1] };

/// One invocation per drop.
pub static PROFILES_PLACE_KERNEL: Kernel =
    Kernel { entry: "main_profiles_place", module: &PROFILES, workgroup: [64, 1, 1] };

/// One workgroup.
pub static PROFILES_FINISH_KERNEL: Kernel =
    Kernel { entry: "main_profiles_finish", module: &PROFILES, workgroup: [64, 1, 1] };

/// One invocation per word of the counts.
pub static TILES_CLEAR_KERNEL: Kernel =
    Kernel { entry: "main_tiles_clear", module: &TILES, workgroup: [64, 1, 1] };

/// One invocation per drop.
pub static TILES_MEASURE_KERNEL: Kernel =
    Kernel { entry: "main_tiles_measure", module: &TILES, workgroup: [64, 1, 1] };

/// One invocation per drop.
pub static TILES_COUNT_KERNEL: Kernel =
    Kernel { entry: "main_tiles_count", module: &TILES, workgroup: [64, 1, 1] };

/// One workgroup.
pub static TILES_SCAN_KERNEL: Kernel =
    Kernel { entry: "main_tiles_scan", module: &TILES, workgroup: [256, 1, 1] };

/// One invocation per drop.
pub static TILES_PLACE_KERNEL: Kernel =
    Kernel { entry: "main_tiles_place", module: &TILES, workgroup: [64, 1, 1] };

/// One invocation per drop.
pub static TILES_SEEN_KERNEL: Kernel =
    Kernel { entry: "main_tiles_seen", module: &TILES, workgroup: [64, 1, 1] };

/// One workgroup per tile of the smallest edge.
pub static TILES_SORT_KERNEL: Kernel =
    Kernel { entry: "main_tiles_sort", module: &TILES, workgroup: [64, 1, 1] };

/// One invocation per pixel.
pub static COMPOSE_KERNEL: Kernel = Kernel { entry: "main_compose", module: &COMPOSE, workgroup: [8, 8, 1] };

/// One invocation per pixel.
pub static COMPOSE_LIT_KERNEL: Kernel =
    Kernel { entry: "main_compose_lit", module: &COMPOSE, workgroup: [8, 8, 1] };

/// One workgroup per ray and class.
pub static STREAK_TABLE_KERNEL: Kernel =
    Kernel { entry: "main_streak_table", module: &STREAK_TABLE, workgroup: [64, 1, 1] };

/// One workgroup per streak and traced instant.
pub static STREAK_RAYS_KERNEL: Kernel =
    Kernel { entry: "main_streak_rays", module: &STREAK_RAYS_MODULE, workgroup: [64, 1, 1] };

/// One invocation per streak, row of its profile and column.
pub static STREAK_LIGHT_KERNEL: Kernel =
    Kernel { entry: "main_streak_light", module: &STREAK_LIGHT, workgroup: [64, 1, 1] };

/// One invocation per pixel.
pub static DROPS_UNLISTED_KERNEL: Kernel =
    Kernel { entry: "main_drops_unlisted", module: &DROPS, workgroup: [8, 8, 1] };

/// One workgroup per block in which drops are listed.
pub static DROPS_KERNEL: Kernel = Kernel { entry: "main_drops", module: &DROPS, workgroup: [8, 8, 1] };

/// One invocation per word of the sums.
pub static DROPS_SUM_CLEAR_KERNEL: Kernel =
    Kernel { entry: "main_drops_sum_clear", module: &DROPS_SUM, workgroup: [64, 1, 1] };

/// One invocation per drop.
pub static DROPS_SUM_SCALE_KERNEL: Kernel =
    Kernel { entry: "main_drops_sum_scale", module: &DROPS_SUM, workgroup: [64, 1, 1] };

/// `DROPS_SUM_SHARED` invocations per drop.
pub static DROPS_SUM_THIN_KERNEL: Kernel =
    Kernel { entry: "main_drops_sum_thin", module: &DROPS_SUM, workgroup: [64, 1, 1] };

/// One workgroup per `DROPS_SUM_LOOKED` drops.
pub static DROPS_SUM_WIDE_KERNEL: Kernel =
    Kernel { entry: "main_drops_sum_wide", module: &DROPS_SUM, workgroup: [256, 1, 1] };

/// One invocation per pixel.
pub static DROPS_SUM_FINISH_KERNEL: Kernel =
    Kernel { entry: "main_drops_sum_finish", module: &DROPS_SUM, workgroup: [64, 1, 1] };
