//! `shaders/wgsl/sim/{motion,volume,step}.wgsl` against `downpour-sim`.

use std::cmp::Ordering;

use downpour_bvh::Bvh;
use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_drop::splash::{FILM_M, SplashLaw};
use downpour_gpu::{Gpu, GpuError};
use downpour_math::ops;
use downpour_math::packing::packing_octahedral_encode;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::Kernel;
use downpour_shaders::sim::enter::{ENTER, ENTER_KERNEL};
use downpour_shaders::sim::splash::SPLASH_LEVEL;
use downpour_shaders::sim::step::{MOTION, STEP, STEP_GONE, STEP_KERNEL, VOLUME, VOLUME_BALL};
use downpour_shaders::sim::step_list::{
    STEP_LIST, STEP_LIST_CLEAR_KERNEL, STEP_LIST_KERNEL, STEP_SPLASH, STEP_SPLASH_KERNEL,
};
use downpour_sim::collision::{CollisionMap, CollisionOptions};
use downpour_sim::enter::{EnterRegion, enter_chance, enter_code, enter_offset};
use downpour_sim::field::{DropKind, EyeDrop, FallingDrop};
use downpour_sim::gpu::{CollisionMapOnGpu, GpuSimError, GpuSimulation, GpuStepInput, StepPicture};
use downpour_sim::impacts::SplashOptions;
use downpour_sim::motion::{
    motion_average, motion_bounce, motion_diameter, motion_relax, motion_settled, motion_table_entry,
    motion_table_speed,
};
use downpour_sim::simulation::{
    Bounce, Drag, Gauge, SimVolume, Simulation, SimulationOptions, StepEvents, StepInput,
};
use downpour_sim::step::{
    StepDrop, StepEvent, step_column, step_count, step_image, step_kind, step_measure, step_pack, step_shown,
    step_splashes, step_word,
};
use downpour_sim::step_list::step_list_id;
use downpour_sim::step_splash::step_splash_drop;
use downpour_sim::view::View;
use downpour_sim::volume::{
    VolumeEye, VolumeFrustum, volume_images, volume_in_area, volume_in_sphere, volume_limit, volume_local,
    volume_offset, volume_on_disk, volume_range, volume_spread,
};
use downpour_wind::{
    Keyed, UniformWind, Wind, WindCore, WindField, WindForm, WindGrid, WindMask, WindPart, WindPrimitive,
    WindSingularity, WindUniform,
};
use glam::{DVec3, Vec2, Vec3};

use crate::Domain::{AnyWord, Below, Made, Or, Uniform, Unit3};
use crate::compare::{Cpu, Gpu as FromGpu};
use crate::function::Run;
use crate::signature::WordKind;
use crate::words::{Args, IntoWords as _};
use crate::{FunctionCase, KernelCase, Tol};

fn vec3(args: &mut Args<'_>) -> Vec3 {
    Vec3::from(args.f32s())
}

/// The words of a `VolumeEye` somewhere near, turned somehow.
fn eye_words(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, d] = random.map(rng_unit);
    let forward = Vec3::new(a - 0.5, 0.8 * b - 0.4, c - 1.2).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let mut words = [a * 4.0, b, c].words();
    words.push((0.3 + d).to_bits());
    words.extend(right.to_array().words());
    words.push((0.2 + 0.6 * d).to_bits());
    words.extend(up.to_array().words());
    words.push(0);
    words.extend(forward.to_array().words());
    words.push(0);
    words
}

/// The words of a wide camera, and of a position and a range: the position is close to the sphere, or exactly on an edge of the area.
fn edge_words(random: [u32; 4]) -> Vec<u32> {
    let mut words = eye_words(random);
    let [a, b, c, d] = rng_draw([random[0], random[1]], random[2], random[3], 7).map(rng_unit);
    let (half_width, half_height, range) = (4.0, 3.0, 2.0 + 7.0 * d);
    words[3] = f32::to_bits(half_width);
    words[7] = f32::to_bits(half_height);
    let radius = 0.5 * range;
    let local = match random[0] % 8 {
        0 => [0.05 * radius * half_width, 0.01 * a, 0.05 * radius],
        1 => [0.01 * a, -0.05 * radius * half_height, 0.05 * radius],
        2 => [0.0, 0.0, range],
        _ => {
            let (z, phi) = (1.2 * a - 0.4, std::f32::consts::TAU * b);
            let near = radius * (0.99 + 0.02 * c);
            let across = near * (1.0 - z * z).sqrt();
            [across * ops::cos(phi), across * ops::sin(phi), radius + near * z]
        }
    };
    words.extend([local[0], local[1], local[2], range].map(f32::to_bits));
    words
}

fn eye(args: &mut Args<'_>) -> VolumeEye {
    let position = args.f32s();
    let half_width = args.f32();
    let right = args.f32s();
    let half_height = args.f32();
    let up = args.f32s();
    let unused_1 = args.u32();
    let forward = args.f32s();
    VolumeEye { position, half_width, right, half_height, up, unused_1, forward, unused_2: args.u32() }
}

/// The words of a `VolumeFrustum` that looks somewhere, its eye at the origin.
fn frustum_words(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, d] = random.map(rng_unit);
    let forward = Vec3::new(a - 0.5, 0.8 * b - 0.4, c - 1.2).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let half = 0.3 + d;
    let normals =
        [right - forward * half, -right - forward * half, up - forward * 0.4, -up - forward * 0.4, -forward];
    let mut words = Vec::new();
    for normal in normals.map(Vec3::normalize) {
        words.extend(normal.extend(4.0 * b - 3.0 * normal.x).to_array().words());
    }
    // Eye, air, half horizon and wait, spread with slope and bound, range per diameter, farthest.
    words.extend(
        [0.0, 0.0, 0.0, 2.0 + a, 0.02 * c, 0.01 * d, 0.1, 0.5 * a, 1.5, 1500.0 + 500.0 * b, 6.0].words(),
    );
    words.push(0);
    words
}

fn frustum(args: &mut Args<'_>) -> VolumeFrustum {
    let planes = std::array::from_fn(|_| args.f32s());
    VolumeFrustum {
        planes,
        eye: args.f32s(),
        air: args.f32(),
        half_horizon: args.f32(),
        half_wait: args.f32(),
        spread: args.f32(),
        spread_slope: args.f32(),
        spread_max: args.f32(),
        range: args.f32(),
        farthest: args.f32(),
        unused: args.u32(),
    }
}

/// The words of an `EnterRegion`, of a plane or of the ball.
fn region_words(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, _] = random.map(rng_unit);
    let face = if random[3].is_multiple_of(3) { VOLUME_BALL } else { 1 };
    let mut words = vec![face, 3, 100, 20];
    words.extend([0.1 + a, 1.2 + a, -0.1 * b, 1.0 + b, 0.2 + 0.5 * c, 0.3 * a + 0.1, 0.2 - 0.1 * c].words());
    words.push(0);
    words
}

/// The words of a region before a plane, as wide as a twentieth of the way along the tangent.
fn wedge_words([a, b, c, d]: [u32; 4]) -> Vec<u32> {
    let mut words = region_words([a, b, c, d - d % 3 + 1]);
    words[6] = 0;
    words[8..10].copy_from_slice(&[0.05f32, 0.0].map(f32::to_bits));
    words
}

fn region(args: &mut Args<'_>) -> EnterRegion {
    let [face, bin, first, first_of_bin] = args.u32s();
    EnterRegion {
        face,
        bin,
        first,
        first_of_bin,
        low: args.f32(),
        high: args.f32(),
        begin: args.f32(),
        end: args.f32(),
        slope: args.f32(),
        width: args.f32(),
        middle: args.f32(),
        unused: args.u32(),
    }
}

/// The words of a `StepEvent`: half of them of drops that fell onto a surface, many of those nearly as steep as splashes allow.
fn event_words(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, d] = random.map(rng_unit);
    let level = SPLASH_LEVEL + 0.2 * (d - 0.5);
    let (across, phi) = ((1.0 - level * level).sqrt(), std::f32::consts::TAU * a);
    let normal = [across * ops::cos(phi), level, across * ops::sin(phi)];
    let mut words = [4.0 * a - 2.0, 4.0 * b - 2.0, 4.0 * c - 2.0, 1.0e-3 + 4.0e-3 * d].words();
    words.extend([3.0 * b - 1.0, -9.0 * c, 3.0 * d - 1.0].words());
    let kind = if random[1].is_multiple_of(2) { 0 } else { random[1] >> 30 };
    words.push((random[0] >> 2) | (kind << 30));
    words.extend(packing_octahedral_encode(normal).words());
    words.extend([(0.016 * b).to_bits(), random[2]]);
    words
}

fn event(args: &mut Args<'_>) -> StepEvent {
    StepEvent {
        position: args.f32s(),
        diameter: args.f32(),
        velocity: args.f32s(),
        drop: args.u32(),
        normal: args.f32s(),
        time: args.f32(),
        last: args.u32(),
    }
}

const MOTIONS: Tol =
    Tol::absolute(3.0e-5, "an exponential (3 ulp and more), products and sums of numbers up to 20");

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    let (velocity, wind) = (Uniform(-10.0, 10.0), Uniform(-10.0, 10.0));
    let diameter = Uniform(1.0e-4, 9.0e-3);
    let fraction = Uniform(0.0, 1.0);
    let near = Uniform(-6.0, 6.0);
    let step = [velocity, velocity, velocity, wind, wind, wind, Uniform(0.3, 9.5), Uniform(1.0e-3, 0.1)];
    let sphere = Tol::absolute(3.0e-3, "sine and cosine (2^-11), times radii up to 4");
    vec![
        FunctionCase::new(
            "motion_diameter",
            &MOTION,
            &[Below(65_536)],
            Tol::ulp(1, "one product, rounded once"),
            |a| motion_diameter(a.u32()).words(),
        ),
        FunctionCase::new(
            "motion_table_entry",
            &MOTION,
            &[Uniform(0.0, 0.02)],
            Tol::exact("a product and its whole part").with_outliers(1.0e-3),
            |a| motion_table_entry(a.f32()).words(),
        ),
        FunctionCase::new(
            "motion_table_speed",
            &MOTION,
            &[Uniform(0.0, 9.0), Uniform(0.0, 9.0), Or(&Uniform(1.0e-4, 9.0e-3), &[0.0])],
            Tol::absolute(3.0e-3, "the share is the difference of numbers up to 1000, times speeds up to 9"),
            |a| motion_table_speed(a.f32(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "motion_settled",
            &MOTION,
            &[wind, wind, wind, Uniform(0.0, 9.5)],
            Tol::ulp(1, "one difference, rounded once"),
            |a| motion_settled(vec3(a), a.f32()).to_array().words(),
        ),
        FunctionCase::new("motion_relax", &MOTION, &step, MOTIONS, |a| {
            let made = motion_relax(vec3(a), vec3(a), a.f32(), a.f32());
            (made.velocity.to_array(), made.displacement.to_array()).words()
        }),
        FunctionCase::new("motion_average", &MOTION, &step, MOTIONS, |a| {
            let made = motion_average(vec3(a), vec3(a), a.f32(), a.f32());
            (made.velocity.to_array(), made.displacement.to_array()).words()
        }),
        FunctionCase::new(
            "motion_bounce",
            &MOTION,
            &[velocity, velocity, velocity, Unit3, fraction, fraction],
            MOTIONS,
            |a| motion_bounce(vec3(a), vec3(a), a.f32(), a.f32()).to_array().words(),
        ),
        FunctionCase::new(
            "volume_images",
            &VOLUME,
            &[
                Uniform(-50.0, 50.0),
                Uniform(-50.0, 50.0),
                Uniform(-50.0, 50.0),
                near,
                near,
                near,
                Uniform(4.0, 9.0),
                Uniform(4.0, 9.0),
                Uniform(4.0, 9.0),
            ],
            Tol::exact("the whole part of a quotient; on a face it may go either way").with_outliers(1.0e-3),
            |a| volume_images(vec3(a), vec3(a), vec3(a)).to_array().words(),
        ),
        FunctionCase::new("volume_local", &VOLUME, &[Made(eye_words), near, near, near], MOTIONS, |a| {
            volume_local(&eye(a), vec3(a)).to_array().words()
        }),
        FunctionCase::new("volume_offset", &VOLUME, &[Made(eye_words), near, near, near], MOTIONS, |a| {
            volume_offset(&eye(a), vec3(a)).to_array().words()
        }),
        FunctionCase::new("volume_range", &VOLUME, &[Made(frustum_words), diameter], MOTIONS, |a| {
            volume_range(&frustum(a), a.f32()).words()
        }),
        FunctionCase::new("volume_spread", &VOLUME, &[Made(frustum_words), Uniform(0.0, 8.0)], MOTIONS, |a| {
            volume_spread(&frustum(a), a.f32()).words()
        }),
        FunctionCase::new(
            "volume_limit",
            &VOLUME,
            &[Made(frustum_words), near, near, near, diameter, Uniform(0.3, 9.5)],
            Tol::exact("a choice by comparisons of products that a GPU may fuse").with_outliers(1.0e-3),
            |a| volume_limit(&frustum(a), vec3(a), a.f32(), a.f32()).words(),
        ),
        // No plane, only the ball, for long waits.
        FunctionCase::new(
            "volume_limit",
            &VOLUME,
            &[
                Made(|r| {
                    let mut words = frustum_words(r);
                    words[..20].fill(0);
                    words[25] = 0.1f32.to_bits();
                    words
                }),
                near,
                near,
                near,
                diameter,
                Uniform(0.3, 9.5),
            ],
            Tol::exact("a choice by comparisons of products that a GPU may fuse").with_outliers(1.0e-3),
            |a| volume_limit(&frustum(a), vec3(a), a.f32(), a.f32()).words(),
        ),
        // On the edges of the area.
        FunctionCase::new(
            "volume_in_area",
            &VOLUME,
            &[Made(edge_words)],
            Tol::exact("a choice by comparisons of products that a GPU may fuse").with_outliers(1.0e-3),
            |a| volume_in_area(&eye(a), vec3(a), a.f32()).words(),
        ),
        FunctionCase::new(
            "volume_in_area",
            &VOLUME,
            &[Made(eye_words), near, near, near, Uniform(2.0, 9.0)],
            Tol::exact("a choice by comparisons of products that a GPU may fuse").with_outliers(1.0e-3),
            |a| volume_in_area(&eye(a), vec3(a), a.f32()).words(),
        ),
        FunctionCase::new(
            "volume_in_sphere",
            &VOLUME,
            &[fraction, fraction, fraction, Uniform(2.0, 8.0)],
            sphere,
            |a| volume_in_sphere(vec3(a), a.f32()).to_array().words(),
        ),
        FunctionCase::new("volume_on_disk", &VOLUME, &[fraction, fraction], sphere, |a| {
            volume_on_disk(Vec2::new(a.f32(), a.f32())).to_array().words()
        }),
        FunctionCase::new("step_kind", &STEP, &[AnyWord], Tol::exact("bits of a word"), |a| {
            step_kind(a.u32()).words()
        }),
        FunctionCase::new("step_count", &STEP, &[AnyWord], Tol::exact("bits of a word"), |a| {
            step_count(a.u32()).words()
        }),
        FunctionCase::new(
            "step_word",
            &STEP,
            &[Below(1 << 16), Below(4), Below(1 << 14)],
            Tol::exact("bits of a word"),
            |a| step_word(a.u32(), a.u32(), a.u32()).words(),
        ),
        FunctionCase::new("step_pack", &STEP, &[near, near, near], Tol::exact("whole parts and bits"), |a| {
            step_pack(vec3(a)).words()
        }),
        FunctionCase::new("step_image", &STEP, &[Below(1 << 14), Below(1 << 14)], Tol::exact("bits of a word"), |a| {
            step_image(a.u32(), a.u32()).words()
        }),
        FunctionCase::new(
            "step_list_id",
            &STEP_LIST,
            &[AnyWord, AnyWord],
            Tol::exact("integers are exact"),
            |a| step_list_id(a.u32(), a.u32()).words(),
        ),
        FunctionCase::new(
            "step_splashes",
            &STEP,
            &[Made(event_words)],
            Tol::exact("a comparison of a normal that a GPU may round otherwise").with_outliers(1.0e-3),
            |a| u32::from(step_splashes(&event(a))).words(),
        ),
        FunctionCase::new(
            "step_splash_drop",
            &STEP_SPLASH,
            &[Made(event_words), near, near, near, Uniform(0.0, 0.1)],
            Tol::absolute(3.0e-6, "sums of positions up to 12 m and a product"),
            |a| {
                let (event, span) = (event(a), a.f32s());
                let drop = step_splash_drop(&event, span);
                let mut words = (drop.offset, [drop.diameter]).words();
                words.extend((drop.velocity, drop.id).words());
                words.extend((drop.present, [drop.speed]).words());
                words.extend(drop.id_low.words());
                words
            },
        ),
        FunctionCase::new(
            "step_column",
            &STEP,
            &[AnyWord, AnyWord, AnyWord, AnyWord, near, near, near],
            Tol::ulp(1, "a product of a multiple of 2^-24, rounded once"),
            |a| step_column(a.u32s(), a.u32(), a.u32(), vec3(a)).to_array().words(),
        ),
        FunctionCase::new(
            "enter_code",
            &ENTER,
            &[Uniform(700.0, 60_000.0), Uniform(700.0, 60_000.0), fraction],
            Tol::exact("a product and sums, which a GPU may fuse, and their whole part").with_outliers(2.0e-2),
            |a| enter_code(a.f32(), a.f32(), a.f32()).words(),
        ),
        // So small that hardly any is beside a half.
        FunctionCase::new(
            "enter_code",
            &ENTER,
            &[Uniform(0.0, 1000.0), Uniform(0.0, 1000.0), fraction],
            Tol::exact("a product and sums, which a GPU may fuse, and their whole part").with_outliers(1.0e-3),
            |a| enter_code(a.f32(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "enter_chance",
            &ENTER,
            &[AnyWord, AnyWord, AnyWord, AnyWord],
            Tol::exact("a whole number of 24 bits times a power of two"),
            |a| enter_chance(a.u32s()).words(),
        ),
        FunctionCase::new(
            "enter_offset",
            &ENTER,
            &[Made(region_words), Unit3, Unit3, fraction, fraction, fraction, fraction],
            Tol::absolute(2.0e-5, "roots, a quotient and products of numbers up to 3; at the edge of the disk or by chance it may be none")
                .with_outliers(1.0e-3),
            |a| enter_offset(&region(a), vec3(a), vec3(a), vec3(a), a.f32()).to_array().words(),
        ),
        // Onto the ball only, whose disk has an edge.
        FunctionCase::new(
            "enter_offset",
            &ENTER,
            &[
                Made(|[a, b, c, d]| region_words([a, b, c, d - d % 3])),
                Unit3,
                Unit3,
                fraction,
                fraction,
                fraction,
                fraction,
            ],
            Tol::absolute(2.0e-5, "roots and products of numbers up to 3; at the edge of the disk or by chance it may be none")
                .with_outliers(1.0e-4),
            |a| enter_offset(&region(a), vec3(a), vec3(a), vec3(a), a.f32()).to_array().words(),
        ),
        // A wedge that begins at its point.
        FunctionCase::new(
            "enter_offset",
            &ENTER,
            &[Made(wedge_words), Unit3, Unit3, fraction, fraction, fraction, fraction],
            Tol::absolute(2.0e-5, "roots, a quotient and products of numbers up to 3"),
            |a| enter_offset(&region(a), vec3(a), vec3(a), vec3(a), a.f32()).to_array().words(),
        ),
        FunctionCase::new(
            "step_shown",
            &STEP,
            &[AnyWord, fraction],
            Tol::ulp(2, "two products, each rounded once"),
            |a| step_shown(a.u32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "step_measure",
            &STEP,
            &[diameter],
            Tol::exact("three products and a sum, which a GPU may fuse, and their whole part")
                .with_outliers(5.0e-2),
            |a| step_measure(a.f32()).words(),
        ),
        // So small that hardly any is beside a half.
        FunctionCase::new(
            "step_measure",
            &STEP,
            &[Uniform(1.0e-5, 5.0e-4)],
            Tol::exact("three products and a sum, which a GPU may fuse, and their whole part").with_outliers(1.0e-3),
            |a| step_measure(a.f32()).words(),
        ),
    ]
}

/// A wind that freshens.
fn gusts() -> UniformWind {
    let speed = Keyed::new(vec![(0.0, 1.0), (5.0, 11.0)]).expect("keys");
    let part = WindPart::uniform(&speed, &DVec3::X.into()).expect("a wind");
    Wind::new(vec![part], None, None).expect("a wind").air().clone()
}

fn vortex() -> WindField {
    let grid = WindGrid::new(Vec3::splat(-16.0), Vec3::splat(16.0), [16; 3]).expect("a grid");
    let wind = [
        WindPrimitive::Uniform(WindUniform { speed: 3.0, direction: Vec3::X }),
        WindPrimitive::Vortex(WindSingularity {
            form: WindForm::Line,
            strength: 90.0,
            center: Vec3::new(0.0, 0.0, -3.0),
            axis: Vec3::Y,
            core_radius: 3.0,
            core: WindCore::Rosenhead,
        }),
    ];
    WindField::new(&grid, &wind, &WindMask::open(&grid)).expect("a field")
}

/// A camera that turns and walks.
fn view(step: u32) -> View {
    let angle = 0.05 * f64::from(step);
    let (s, c) = (downpour_math::ops::f64::sin(angle), downpour_math::ops::f64::cos(angle));
    View {
        eye: DVec3::new(0.03 * f64::from(step), 2.0, 5.0),
        forward: DVec3::new(s, 0.0, -c),
        right: DVec3::new(c, 0.0, s),
        far: 7.0,
        ..View::default()
    }
}

/// A yard of 12 m, half of it below a roof with a slanted top and open sides.
fn yard() -> CollisionMap {
    let quad = |[a, b, c, d]: [[f32; 3]; 4]| [[a, b, c], [a, c, d]];
    let floor = quad([[-6.0, 0.0, -6.0], [-6.0, 0.0, 6.0], [6.0, 0.0, 6.0], [6.0, 0.0, -6.0]]);
    let top = quad([[-5.0, 3.0, -4.0], [-5.0, 2.5, 4.0], [0.5, 2.5, 4.0], [0.5, 3.0, -4.0]]);
    let below = quad([[-5.0, 2.2, -4.0], [0.5, 2.2, -4.0], [0.5, 2.2, 4.0], [-5.0, 2.2, 4.0]]);
    let corners = [floor, top, below].concat();
    let fall = Vec3::new(0.3, -1.0, -0.1).normalize();
    let (low, high) = (Vec3::new(-6.0, -1.0, -6.0), Vec3::new(6.0, 8.0, 6.0));
    let options = CollisionOptions::covering(low, high, fall, [128, 128]).expect("a map");
    CollisionMap::new(&options, &Bvh::new(&corners)).expect("a map")
}

/// Setup of a case.
#[derive(Clone, Copy)]
struct Scenario {
    volume: SimVolume,
    drag: Drag,
    windy: bool,
    walls: bool,
    /// The last step leads elsewhere.
    jumps: bool,
}

const TURNING: Scenario =
    Scenario { volume: SimVolume::View, drag: Drag::Relaxation, windy: true, walls: true, jumps: false };

/// Drops and events that a step leaves behind on both sides.
struct Both {
    drops: [Vec<StepDrop>; 2],
    happened: [StepEvents; 2],
}

/// Steps on the CPU, until drops have bounced and are hidden, then one step on both.
fn both(gpu: &Gpu, scenario: Scenario) -> Result<Both, GpuError> {
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 50.0).expect("a rain");
    let middle = view(0).eye;
    let options = SimulationOptions {
        volume: scenario.volume,
        seed: 11,
        max_drops: 6000,
        shutter_s: 1.0 / 48.0,
        wait_s: 1.0 / 60.0,
        drag: scenario.drag,
        bounce: Bounce { fraction: 0.5, ..Bounce::default() },
        gauge: Some(Gauge {
            height_m: 2.0,
            low_m: [middle.x - 2.0, middle.z - 4.0],
            high_m: [middle.x + 2.0, middle.z],
        }),
        ..SimulationOptions::default()
    };
    let field = scenario.windy.then(vortex);
    let map = scenario.walls.then(yard);
    let wind = Vec3::new(2.0, 0.0, -1.0);
    let first = view(0);
    let air = gusts();
    let air = air.prepared(3.0);
    let start = StepInput {
        field: field.as_ref(),
        map: map.as_ref(),
        air: Some(&air),
        ..StepInput::new(&first, DVec3::ZERO, wind)
    };
    let mut cpu = Simulation::new(&rain, &options, &start).expect("a simulation");
    for step in 1..=20 {
        cpu.advance(1.0 / 60.0, &StepInput { view: &view(step), ..start }).expect("a step");
    }
    let mut twin = GpuSimulation::from_cpu(gpu, &cpu)?;
    let last = if scenario.jumps { View { eye: view(21).eye + 9.0, ..view(21) } } else { view(21) };
    let happened = cpu.advance(1.0 / 60.0, &StepInput { view: &last, ..start }).expect("a step");
    let on_gpu = match &map {
        Some(map) => Some(CollisionMapOnGpu::upload(gpu, map)?),
        None => None,
    };
    let cells = match &field {
        Some(field) => Some((field, gpu.storage_buffer("cells", field.cells())?)),
        None => None,
    };
    let eye = last.eye.as_vec3();
    let moment = GpuStepInput {
        // Of a field: at the eye.
        wind: field.as_ref().map_or(wind, |field| field.sample(eye)),
        field: cells.as_ref().map(|(field, cells)| (field.uniform(), cells)),
        spread: field.as_ref().map_or([0.0; 2], |field| field.spread(eye, cpu.farthest_m(&last) as f32)),
        map: on_gpu.as_ref(),
        air: Some(&air),
        ..GpuStepInput::new(&last, DVec3::ZERO, wind)
    };
    twin.advance(1.0 / 60.0, &moment).map_err(of_gpu)?;
    let happened_there = twin.events().map_err(of_gpu)?;
    assert_eq!(happened_there.lost, 0);
    Ok(Both {
        drops: [cpu.drops().to_vec(), twin.drops().map_err(of_gpu)?],
        happened: [happened, happened_there],
    })
}

/// Setup of a list.
#[derive(Clone, Copy)]
struct Listed {
    volume: SimVolume,
    walls: bool,
    /// The eye is low above the floor, from which half of the drops rebound.
    low: bool,
    pane: Option<[f32; 4]>,
    /// Time from the state to the picture, s.
    after_s: f64,
    /// Drops splash; only their crowns are compared.
    splashes: bool,
    /// The last steps before the state are the device's.
    on_device: bool,
}

const IN_BOX: Listed = Listed {
    volume: BOX,
    walls: true,
    low: false,
    pane: None,
    after_s: 0.04,
    splashes: false,
    on_device: false,
};

/// The drops of a state that a picture shows, listed on both sides: some of them land or come in again while the shutter is open.
fn list_case(gpu: &Gpu, setup: Listed) -> Result<Run, GpuError> {
    let Listed { volume, walls, low, pane, after_s, splashes, on_device } = setup;
    let splashes =
        splashes.then(|| SplashOptions { law: SplashLaw::new(FILM_M, 20.0).expect("a law"), size: 1.5 });
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 50.0).expect("a rain");
    let shutter_s = 0.05;
    let options = SimulationOptions {
        volume,
        seed: 11,
        max_drops: 6000,
        shutter_s,
        wait_s: 1.0 / 60.0,
        bounce: Bounce { fraction: 0.5, size: if low { 0.8 } else { 0.3 }, ..Bounce::default() },
        ..SimulationOptions::default()
    };
    let map = walls.then(yard);
    let eye = |step: u32| {
        let mut view = view(step);
        if low {
            (view.eye.y, view.least_pixels) = (0.2, 0.1);
        }
        View { shutter_s, velocity: DVec3::new(1.8, 0.0, 0.0), turning: DVec3::new(0.0, -3.0, 0.0), ..view }
    };
    let first = eye(0);
    // That of the map.
    let origin = if walls { DVec3::ZERO } else { DVec3::new(0.5, 0.0, -1.0) };
    let wind = Vec3::new(4.0, 0.0, -1.0);
    // Several of the device's steps share a span of kept impacts.
    let step_s = if on_device { 1.0 / 240.0 } else { 1.0 / 60.0 };
    let start = StepInput { map: map.as_ref(), ..StepInput::new(&first, origin, wind) };
    let on_gpu = map.as_ref().map(|map| CollisionMapOnGpu::upload(gpu, map)).transpose()?;
    let mut cpu = Simulation::new(&rain, &options, &start).expect("a simulation");
    let advance = |cpu: &mut Simulation, step: u32| {
        cpu.advance(step_s, &StepInput { view: &eye(step), ..start }).expect("a step");
    };
    let same = if on_device { 8 } else { 20 };
    (1..=same).for_each(|step| advance(&mut cpu, step));
    let mut twin = GpuSimulation::from_cpu(gpu, &cpu)?;
    for step in same + 1..=20 {
        advance(&mut cpu, step);
        let shown = eye(step);
        let input = GpuStepInput { map: on_gpu.as_ref(), ..GpuStepInput::new(&shown, origin, wind) };
        twin.advance(step_s, &input).map_err(of_gpu)?;
    }
    let shown = eye(21);
    let listed = cpu.visible_after(after_s, &shown, map.as_ref(), splashes.as_ref());
    if !on_device {
        // The same state, listed by the host from what the device holds.
        let held = twin.visible_after(after_s, &shown, map.as_ref(), splashes.as_ref()).map_err(of_gpu)?;
        let crowns = |drops: &[FallingDrop]| {
            let crowns = drops.iter().filter(|drop| drop.kind == DropKind::Splash);
            crowns.map(|crown| (crown.id, crown.position)).collect::<Vec<_>>()
        };
        let [mut held, mut expected] = [&held.drops, &listed.drops].map(|drops| crowns(drops));
        held.sort_by_key(|crown| crown.0);
        expected.sort_by_key(|crown| crown.0);
        assert!(held == expected, "{} crowns of the device, {}", held.len(), expected.len());
    }
    let outside = |drop: &FallingDrop| match pane {
        Some([x, y, z, distance]) => drop.beyond(Vec3::new(x, y, z), distance, &shown),
        None => Some(*drop),
    };
    // On the CPU a list does not say how fast drops fall in still air.
    let with_speed = |drop: FallingDrop| {
        let seen = EyeDrop::new(&drop, shown.eye);
        EyeDrop { speed: if drop.kind == DropKind::Falling { 1.0 } else { seen.speed }, ..seen }
    };
    let expected: Vec<EyeDrop> = listed.drops.iter().filter_map(outside).map(with_speed).collect();
    let known = [EyeDrop { diameter: 3.0e-3, ..EyeDrop::default() }; 3];
    let (map, splashes) = (on_gpu.as_ref(), splashes.as_ref());
    let picture = StepPicture {
        view: &shown,
        after_s,
        map,
        pane,
        known: &known,
        drips: None,
        splashes,
        max_room: 1 << 20,
    };
    let pass = twin.list(gpu, &picture).map_err(of_gpu)?;
    let poison = vec![f32::from_bits(crate::compare::POISON); 12 * pass.list().room() as usize];
    let after_known = (known.len() * size_of::<EyeDrop>()) as u64;
    gpu.queue().write_buffer(pass.list().drops(), after_known, bytemuck::cast_slice(&poison));
    gpu.submit(&pass.stages().concat())?;
    let (mut made, [found, looked_at]) = pass.list().read(gpu)?;
    let is_whole = made.len() as u32 == found + 3 && u64::from(looked_at) == expected_looked_at(&cpu);
    assert!(is_whole && made.drain(..3).eq(known), "{found} found, {looked_at} looked at");
    let landing = expected.iter().filter(|drop| drop.present[1] < 1.0).count();
    let rebound = expected.iter().filter(|drop| drop.present[0] > -1.0).count();
    let has_enough =
        expected.len() > 200 && (!walls || landing > 10) && (!low || rebound * 16 > expected.len());
    assert!(has_enough, "{} drops, {landing} land, {rebound} rebound", expected.len());
    let mut expected = expected;
    if splashes.is_some() {
        for drops in [&mut expected, &mut made] {
            drops.retain(|drop| drop.speed < 0.0);
        }
        // Of earlier steps, and of the time since.
        let earlier = expected.iter().filter(|drop| f64::from(-drop.present[0]) > after_s).count();
        let enough = earlier > 20 && (after_s == 0.0 || expected.len() > earlier + 10);
        assert!(enough, "{} crowns, {earlier} earlier", expected.len());
    }
    let key = |drop: &EyeDrop| (drop.id ^ drop.id_low, drop.id_low, drop.present[0] > -1.0);
    let words = |drops: Vec<EyeDrop>| -> Vec<(_, [u32; 12])> {
        let mut rows: Vec<_> = drops
            .iter()
            .map(|drop| {
                let [x, y, z] = drop.offset.map(f32::to_bits);
                let [u, v, w] = drop.velocity.map(f32::to_bits);
                let [begin, end] = drop.present.map(f32::to_bits);
                // Falls, is a droplet, or a crown.
                let falls = (1.0 + drop.speed.clamp(-1.0, 1.0)) as u32;
                (
                    key(drop),
                    [x, y, z, drop.diameter.to_bits(), u, v, w, drop.id, begin, end, falls, drop.id_low],
                )
            })
            .collect();
        rows.sort_by_key(|row| row.0);
        rows
    };
    let [cpu, made] = beside(words(expected), words(made));
    let mut kinds = vec![WordKind::Float; 12];
    for integer in [7, 10, 11] {
        kinds[integer] = WordKind::Integer;
    }
    Ok(Run {
        arguments: (0..cpu.len() as u32 / 12).map(|k| vec![(k as f32).to_bits()]).collect(),
        cpu: Cpu(cpu),
        gpu: FromGpu(made),
        kinds,
    })
}

/// Drops of a state that are somewhere.
fn expected_looked_at(simulation: &Simulation) -> u64 {
    simulation.drops().iter().filter(|drop| drop.kind() != STEP_GONE).count() as u64
}

/// Rows of two sides, each beside that of its key: what one of them has not is nothing.
fn beside<K: Ord, const N: usize>(cpu: Vec<(K, [u32; N])>, gpu: Vec<(K, [u32; N])>) -> [Vec<u32>; 2] {
    let (mut left, mut right) = (Vec::new(), Vec::new());
    let (mut cpu, mut gpu) = (cpu.into_iter().peekable(), gpu.into_iter().peekable());
    loop {
        let order = match (cpu.peek(), gpu.peek()) {
            (Some(a), Some(b)) => a.0.cmp(&b.0),
            (Some(_), None) => Ordering::Less,
            (None, Some(_)) => Ordering::Greater,
            (None, None) => return [left, right],
        };
        left.extend(if order.is_le() { cpu.next().map_or([0; N], |row| row.1) } else { [0; N] });
        right.extend(if order.is_ge() { gpu.next().map_or([0; N], |row| row.1) } else { [0; N] });
    }
}

fn of_gpu(error: GpuSimError) -> GpuError {
    match error {
        GpuSimError::Gpu(error) => error,
        error => panic!("{error}"),
    }
}

fn row(drop: &StepDrop) -> [u32; 8] {
    let [x, y, z] = drop.position.map(f32::to_bits);
    let [u, v, w] = drop.velocity.map(f32::to_bits);
    [x, y, z, drop.word, u, v, w, drop.last]
}

fn words(drops: &[StepDrop]) -> Vec<u32> {
    drops.iter().flat_map(row).collect()
}

/// The drops of both, each beside itself: of a view the order is the device's own.
fn side_by_side(drops: [Vec<StepDrop>; 2]) -> [Vec<u32>; 2] {
    let [cpu, gpu] = drops.map(|drops| {
        let mut rows: Vec<_> = drops.iter().map(|drop| ((drop.last, drop.word), row(drop))).collect();
        rows.sort_by_key(|row| row.0);
        rows
    });
    beside(cpu, gpu)
}

fn step_case(gpu: &Gpu, scenario: Scenario) -> Result<Run, GpuError> {
    let both = both(gpu, scenario)?;
    let open = scenario.volume == SimVolume::View;
    let [cpu, made] = if open { side_by_side(both.drops) } else { both.drops.map(|drops| words(&drops)) };
    let mut kinds = vec![WordKind::Float; 8];
    kinds[3] = WordKind::Integer;
    if open {
        kinds[7] = WordKind::Integer;
    }
    Ok(Run {
        arguments: (0..cpu.len() as u32 / 8).map(|k| vec![(k as f32).to_bits()]).collect(),
        cpu: Cpu(cpu),
        gpu: FromGpu(made),
        kinds,
    })
}

/// Impacts, and the counts.
fn happened_case(gpu: &Gpu, scenario: Scenario) -> Result<Run, GpuError> {
    let both = both(gpu, scenario)?;
    let [cpu, made] = both.happened.map(|happened| {
        let mut words = vec![
            happened.events.len() as u32,
            happened.overflow as u32,
            happened.caught.drops as u32,
            happened.caught.volume as u32,
        ];
        for event in &happened.events {
            words.extend(event.position.map(|x| (x * 1.0e3).round() as i32 as u32));
            words.push(event.drop);
        }
        words
    });
    assert!(cpu.len() > 40, "{} words", cpu.len());
    Ok(Run {
        arguments: (0..cpu.len() as u32 / 4).map(|k| vec![(k as f32).to_bits()]).collect(),
        cpu: Cpu(cpu),
        gpu: FromGpu(made),
        kinds: vec![WordKind::Integer; 4],
    })
}

const BOX: SimVolume = SimVolume::Box { size_m: [6.0, 6.0, 6.0] };

const STEPPED: Tol = Tol::absolute(
    1.0e-4,
    "positions up to 10 m after an exponential, a lookup of wind and some products; a drop that grazes a face or a surface \
     may be on either side of it",
)
.with_outliers(3.0e-3);

/// The kernel that clears a list before it is filled.
const LIST_CLEARED: &[&Kernel] = &[&STEP_LIST_CLEAR_KERNEL];

/// The kernels before that of earlier splashes.
const LISTED_BEFORE: &[&Kernel] = &[&STEP_LIST_CLEAR_KERNEL, &STEP_LIST_KERNEL];

/// Those, and the steps.
const STEPPED_BEFORE: &[&Kernel] = &[&STEP_LIST_CLEAR_KERNEL, &STEP_LIST_KERNEL, &STEP_KERNEL];

const LISTED: Tol = Tol::absolute(
    2.0e-5,
    "positions up to 10 m after a product and sums, of those that rebound after an exponential; a drop that grazes an edge or a \
     surface may be on either side of it",
)
.with_outliers(5.0e-3);

/// Constants of the kernel where no field of wind, nothing that collides, or neither is there.
const STILL: &[(&str, f64)] = &[("STEP_FIELD", 0.0)];
const OPEN: &[(&str, f64)] = &[("STEP_COLLIDES", 0.0)];
const BARE: &[(&str, f64)] = &[("STEP_COLLIDES", 0.0), ("STEP_FIELD", 0.0)];

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let case =
        |name, overrides, tol, run| KernelCase { overrides, ..KernelCase::new(name, &STEP_KERNEL, tol, run) };
    let list = |name, overrides, run| KernelCase {
        overrides,
        with: LIST_CLEARED,
        ..KernelCase::new(name, &STEP_LIST_KERNEL, LISTED, run)
    };
    vec![
        case("main_step: a box in a vortex, with a roof", &[], STEPPED, |gpu| {
            step_case(
                gpu,
                Scenario { volume: BOX, drag: Drag::Relaxation, windy: true, walls: true, jumps: false },
            )
        }),
        case(
            "main_step: what happened",
            &[],
            Tol::exact("sorted by drop; positions to the millimeter").with_outliers(2.0e-2),
            |gpu| {
                happened_case(
                    gpu,
                    Scenario { volume: BOX, drag: Drag::Relaxation, windy: true, walls: true, jumps: false },
                )
            },
        ),
        case("main_step: a view that turns", STILL, STEPPED, |gpu| {
            step_case(
                gpu,
                Scenario {
                    volume: SimVolume::View,
                    drag: Drag::Relaxation,
                    windy: false,
                    walls: true,
                    jumps: false,
                },
            )
        }),
        KernelCase::new("main_enter: a view in a vortex, with a roof", &ENTER_KERNEL, STEPPED, |gpu| {
            step_case(
                gpu,
                Scenario {
                    volume: SimVolume::View,
                    drag: Drag::Relaxation,
                    windy: true,
                    walls: true,
                    jumps: false,
                },
            )
        }),
        case("main_step: the eye is elsewhere", &[], STEPPED, |gpu| {
            step_case(gpu, Scenario { jumps: true, volume: SimVolume::View, ..TURNING })
        }),
        case("main_step: the rain area of Im and Sung", BARE, STEPPED, |gpu| {
            let volume = SimVolume::ImSung;
            step_case(
                gpu,
                Scenario { volume, drag: Drag::Relaxation, windy: false, walls: false, jumps: false },
            )
        }),
        case("main_step: a box that drops fall into", OPEN, STEPPED, |gpu| {
            let volume = SimVolume::Tariq { size_m: [6.0; 3] };
            step_case(
                gpu,
                Scenario { volume, drag: Drag::Rousseau2008, windy: true, walls: false, jumps: false },
            )
        }),
        list("main_step_list: a view among walls, behind a pane", &[("STEP_FIELD", 0.0)], |gpu| {
            let pane = Some([0.6, 0.0, -0.8, 0.9]);
            list_case(gpu, Listed { volume: SimVolume::View, pane, ..IN_BOX })
        }),
        list("main_step_list: a box", BARE, |gpu| list_case(gpu, Listed { walls: false, ..IN_BOX })),
        list("main_step_list: a box with a roof", &[("STEP_FIELD", 0.0)], |gpu| list_case(gpu, IN_BOX)),
        list("main_step_list: a box that drops come into again", &[("STEP_FIELD", 0.0)], |gpu| {
            list_case(gpu, Listed { after_s: 0.45, ..IN_BOX })
        }),
        list("main_step_list: a view low above a floor", &[("STEP_FIELD", 0.0)], |gpu| {
            list_case(gpu, Listed { volume: SimVolume::View, low: true, ..IN_BOX })
        }),
        KernelCase {
            with: LISTED_BEFORE,
            ..KernelCase::new(
                "main_step_splash: a view low above a floor, behind a pane",
                &STEP_SPLASH_KERNEL,
                LISTED,
                |gpu| {
                    let pane = Some([0.6, 0.0, -0.8, 0.2]);
                    let volume = SimVolume::View;
                    let splashing = Listed { low: true, splashes: true, after_s: 0.01, pane, ..IN_BOX };
                    list_case(gpu, Listed { volume, ..splashing })
                },
            )
        },
        KernelCase {
            with: STEPPED_BEFORE,
            ..KernelCase::new(
                "main_step_splash: a box low above a floor, steps of the device",
                &STEP_SPLASH_KERNEL,
                LISTED,
                |gpu| {
                    let of_device =
                        Listed { low: true, splashes: true, on_device: true, after_s: 0.01, ..IN_BOX };
                    list_case(gpu, of_device)
                },
            )
        },
        list("main_step_list: a box low above a floor", &[("STEP_FIELD", 0.0)], |gpu| {
            list_case(gpu, Listed { low: true, ..IN_BOX })
        }),
        case("main_step: a cylinder", OPEN, STEPPED, |gpu| {
            let volume = SimVolume::Cylinder { base_m: [0.0, 0.0, 0.0], radius_m: 4.0, height_m: 6.0 };
            step_case(
                gpu,
                Scenario { volume, drag: Drag::Relaxation, windy: true, walls: false, jumps: false },
            )
        }),
    ]
}
