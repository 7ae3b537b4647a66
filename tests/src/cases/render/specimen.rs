//! `shaders/wgsl/render/specimen.wgsl` against `downpour_specimen`.

use downpour_drop::DropShape;
use downpour_gpu::{Gpu, GpuError};
use downpour_mask::trace::TracedDrop;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_math::vector::{add_scaled, cross, dot, normalize, scale};
use downpour_shaders::mask::MASK_TRACE_STEPS;
use downpour_shaders::render::specimen;
use downpour_specimen::gpu::{GpuSpecimenError, SpecimenRenderer};
use downpour_specimen::lamp::specimen_lamp;
use downpour_specimen::sky::{specimen_sky_position, specimen_turns};
use downpour_specimen::trace::{
    SpecimenCamera, SpecimenLight, SpecimenRay, specimen_bounce, specimen_enter, specimen_hits, specimen_ray,
    specimen_split_inside, specimen_split_outside, upright_drop,
};
use downpour_specimen::{Image, Sky, SpecimenLamp, SpecimenOptions, render_specimen, specimen_jitter};

use crate::Domain::{AnyWord, Made, OneOf, Or, Uniform, Unit3};
use crate::compare::{Cpu, Gpu as FromGpu};
use crate::function::Run;
use crate::kept::kept;
use crate::signature::WordKind;
use crate::words::{Args, IntoWords};
use crate::{FunctionCase, KernelCase, Tol};

/// An upright drop of 0.1 to 6 mm, as `MaskTracedDrop` holds it: two numbers that the specimen does not use, two of the spheroid, twelve
/// coefficients, axis, index.
fn drop_words(random: u32) -> Vec<u32> {
    let shape =
        DropShape::new(1.0e-4 + 5.9e-3 * f64::from(rng_unit(random))).expect("a diameter of the table");
    let drop = upright_drop(&shape, 1.333);
    let bits = |c: f64| (c as f32).to_bits();
    let mut words = vec![0, 0];
    words.extend([drop.inverse_wide, drop.inverse_tall].map(bits));
    words.extend(drop.coefficients.map(bits));
    words.push(0);
    words.extend(drop.up.map(bits));
    words.push(bits(drop.index));
    words
}

fn drop(args: &mut Args<'_>) -> TracedDrop {
    let _size = args.u32();
    let [_pixel, inverse_wide, inverse_tall] = args.f32s().map(f64::from);
    let coefficients = args.f32s::<12>();
    let up = args.f32s::<3>().map(f64::from);
    let index = args.f32().into();
    TracedDrop {
        coefficients: std::array::from_fn(|n| f64::from(coefficients[n])),
        up,
        index,
        inverse_wide,
        inverse_tall,
        steps: MASK_TRACE_STEPS,
    }
}

/// A ray whose foot is at most `farthest` from the origin, seen from 100 radii.
pub(super) fn ray_of(random: [u32; 4], farthest: f32) -> SpecimenRay<f32> {
    let unit = random.map(|w| 2.0 * rng_unit(w) - 1.0);
    let direction = normalize([unit[0], unit[1], unit[2] + 0.01]);
    let across = normalize(cross(direction, normalize([unit[3], 0.37, unit[0] - unit[1]])));
    let foot = scale(across, farthest * rng_unit(random[3]));
    // Perpendicular but for rounding.
    let foot = add_scaled(foot, direction, -dot(foot, direction));
    SpecimenRay { foot, reach: 100.0, direction }
}

fn drop_and_ray(random: [u32; 4], farthest: f32) -> Vec<u32> {
    let ray = ray_of(random, farthest);
    [drop_words(random[2] ^ random[1]), ((ray.foot, ray.reach), ray.direction).words()].concat()
}

fn drop_and_graze(random: [u32; 4]) -> Vec<u32> {
    let ray = ray_of(random, 1.0);
    let unit = |k: u32| rng_unit(random[0].rotate_left(k) ^ random[1]);
    let wanted = 0.8 + 0.3 * unit(5);
    let length = dot(ray.foot, ray.foot).sqrt().max(1.0e-3);
    let foot = add_scaled(scale(ray.foot, wanted / length), ray.direction, 2.0 * unit(9) - 1.0);
    let reach = if random[2] & 1 == 0 { 100.0 } else { 4.0 * unit(13) - 2.0 };
    [drop_words(random[2] ^ random[1]), ((foot, reach), ray.direction).words()].concat()
}

fn drop_and_light(random: [u32; 4]) -> Vec<u32> {
    let words = drop_words(random[2] ^ random[1]);
    let traced = drop(&mut Args::new(&words));
    let light = specimen_enter(&traced, &ray_of(random, 0.7));
    [words, light_words(&light)].concat()
}

pub(super) fn light_words(light: &SpecimenLight<f32>) -> Vec<u32> {
    ((((light.point, light.fraction), light.exit), light.rest), light.inside).words()
}

pub(super) fn ray(args: &mut Args<'_>) -> SpecimenRay<f32> {
    let foot = args.f32s();
    SpecimenRay { foot, reach: args.f32(), direction: args.f32s() }
}

pub(super) fn light(args: &mut Args<'_>) -> SpecimenLight<f32> {
    let point = args.f32s();
    let fraction = args.f32();
    let exit = args.f32s();
    SpecimenLight { point, fraction, exit, rest: args.f32(), inside: args.f32s() }
}

/// A normal, and a direction against it.
fn normal_and_ray(random: [u32; 4]) -> Vec<u32> {
    let unit = |a: u32, b: u32, c: u32| {
        let [x, y, z] = [a, b, c].map(|word| 2.0 * rng_unit(word) - 0.9999);
        normalize([x, y, z])
    };
    let normal = unit(random[0], random[1], random[2]);
    let direction = unit(random[3], random[0].rotate_left(11), random[1].rotate_left(17));
    let along = dot(direction, normal);
    // Not along the surface.
    let direction = if along < -0.02 { direction } else { scale(normal, -1.0) };
    (normal, direction).words()
}

/// Light inside a drop, and the point and normal that it meets.
fn light_and_normal(random: [u32; 4]) -> Vec<u32> {
    let [nx, ny, nz, dx, dy, dz] = Args::new(&normal_and_ray(random)).f32s::<6>();
    let light = SpecimenLight {
        point: [0.0; 3],
        fraction: 0.0,
        exit: [1.0, 0.0, 0.0],
        rest: rng_unit(random[2].rotate_left(5)),
        inside: [-dx, -dy, -dz],
    };
    [light_words(&light), ([0.5f32, -0.5, 0.25], [nx, ny, nz]).words()].concat()
}

/// A camera at 1.2 to 10^5 radii in which the drop fills most of a picture 400 samples high.
fn camera_words(random: [u32; 4]) -> Vec<u32> {
    let unit = random.map(|w| f64::from(rng_unit(w)));
    let shape = DropShape::sphere(2.0e-3).expect("a sphere");
    let options = SpecimenOptions {
        distance_m: 1.2e-3 * downpour_math::ops::f64::exp(11.0 * unit[0]),
        yaw: 7.0 * unit[1],
        pitch: 3.0 * unit[2] - 1.5,
        size: [400, 400],
        samples: 1,
        ..SpecimenOptions::default()
    };
    let camera = options.camera(&shape).expect("a camera");
    let single = |v: [f64; 3]| v.map(|c| c as f32);
    let (step, distance) = (camera.step as f32, camera.distance as f32);
    (((((single(camera.right), step), single(camera.up)), distance), single(camera.back)), 1u32).words()
}

fn camera(args: &mut Args<'_>) -> SpecimenCamera {
    let right = args.f32s().map(f64::from);
    let step = args.f32().into();
    let up = args.f32s().map(f64::from);
    let distance = args.f32().into();
    let back = args.f32s().map(f64::from);
    let _samples = args.u32();
    SpecimenCamera { right, up, back, step, distance }
}

/// A lamp of 0.05 to 30 degrees, as `SpecimenLamp`, and a direction up to twice its radius from its middle.
fn lamp_and_direction(random: [u32; 4]) -> Vec<u32> {
    let unit = random.map(|w| f64::from(rng_unit(w)));
    let radius = 8.7e-4 * downpour_math::ops::f64::exp(6.4 * unit[0]);
    let (yaw, pitch) = (6.0 * unit[1], unit[2] - 0.5);
    let lamp = SpecimenLamp::new(yaw, pitch, radius, [1.5, 0.25, 3.0]).expect("a lamp");
    let aside =
        SpecimenLamp::new(yaw, pitch + 4.0 * radius * (unit[3] - 0.5), radius, [0.0; 3]).expect("as good");
    let single = |v: [f64; 3]| v.map(|c| c as f32);
    let words = ((single(lamp.direction), lamp.reach as f32), lamp.radiance);
    (words, single(aside.direction)).words()
}

/// The cases.
#[must_use]
pub(super) fn functions() -> Vec<FunctionCase> {
    let module = &specimen::SPECIMEN;
    vec![
        FunctionCase::new(
            "specimen_ray",
            module,
            &[Made(camera_words), Uniform(-200.0, 200.0), Uniform(-200.0, 200.0)],
            Tol::relative(4.0e-6, 2.0e-6, "sums of products, a division (2.5 ulp) and a square root"),
            |a| {
                let ray = specimen_ray(&camera(a), a.f32(), a.f32());
                ((ray.foot, ray.reach), ray.direction).words()
            },
        ),
        FunctionCase::new(
            "specimen_hits",
            module,
            &[Made(|r| drop_and_ray(r, 1.3))],
            Tol::exact("a boolean: a ray that grazes the drop may fall on either side").with_outliers(1.0e-3),
            |a| specimen_hits(&drop(a), &ray(a)).words(),
        ),
        // Rays about the rim, whose feet are not where they come nearest, and cameras beside or behind the drop.
        FunctionCase::new(
            "specimen_hits",
            module,
            &[Made(drop_and_graze)],
            Tol::exact("a boolean: a ray that grazes the drop may fall on either side").with_outliers(1.0e-3),
            |a| specimen_hits(&drop(a), &ray(a)).words(),
        ),
        FunctionCase::new(
            "specimen_split_outside",
            module,
            &[Uniform(-1.0, 1.0), Uniform(-1.0, 1.0), Uniform(-1.0, 1.0), Made(normal_and_ray), Uniform(1.2, 1.5)],
            Tol::absolute(4.0e-6, "square roots and divisions (2.5 ulp) of products of unit vectors"),
            |a| {
                let (point, normal, direction) = (a.f32s(), a.f32s(), a.f32s());
                light_words(&specimen_split_outside(point, normal, direction, a.f32()))
            },
        ),
        FunctionCase::new(
            "specimen_split_inside",
            module,
            &[Made(light_and_normal), Uniform(1.2, 1.5), OneOf(&[1.0e-4, 2.0])],
            Tol::absolute(1.0e-4, "the same; refraction multiplies the errors close to the critical angle")
                .with_outliers(2.0e-3),
            |a| {
                let (light, point, normal) = (light(a), a.f32s(), a.f32s());
                light_words(&specimen_split_inside(&light, point, normal, a.f32(), a.f32()))
            },
        ),
        FunctionCase::new(
            "specimen_enter",
            module,
            &[Made(|r| drop_and_ray(r, 0.7))],
            Tol::absolute(2.0e-5, "Newton's steps to the surface, known to 1e-6; errors grow towards the rim"),
            |a| light_words(&specimen_enter(&drop(a), &ray(a))),
        ),
        FunctionCase::new(
            "specimen_bounce",
            module,
            &[Made(drop_and_light), OneOf(&[1.0e-4, 2.0])],
            Tol::absolute(
                1.0e-4,
                "the same for the next interface; refraction multiplies the errors close to the critical angle",
            )
            .with_outliers(1.0e-3),
            |a| light_words(&specimen_bounce(&drop(a), &light(a), a.f32())),
        ),
        FunctionCase::new(
            "specimen_turns",
            module,
            &[Or(&Uniform(-1.0, 1.0), &[0.0]), Uniform(-1.0, 1.0)],
            Tol::absolute(2.0e-7, "a division (2.5 ulp) and a polynomial that a GPU may fuse"),
            |a| specimen_turns(a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "specimen_lamp",
            module,
            &[Made(lamp_and_direction)],
            Tol::exact("the edge is drawn by a sum of squares that a GPU may fuse").with_outliers(1.0e-3),
            |a| {
                let direction = a.f32s().map(f64::from);
                let reach = a.f32().into();
                let lamp = SpecimenLamp { direction, reach, radiance: a.f32s() };
                specimen_lamp(&lamp, a.f32s::<3>()).words()
            },
        ),
        FunctionCase::new(
            "specimen_jitter",
            module,
            &[AnyWord],
            Tol::exact("a product of integers, and its upper bits as a number"),
            |a| specimen_jitter(a.u32()).words(),
        ),
        FunctionCase::new(
            "specimen_sky_position",
            module,
            &[Unit3],
            Tol::absolute(4.0e-7, "two angles of the polynomial, one of them doubled"),
            |a| specimen_sky_position(a.f32s()).words(),
        ),
    ]
}

/// A sky of 64 x 32 texels between 0.2 and 1.2, as rough as the world.
fn sky_texels() -> Vec<[f32; 3]> {
    (0..64 * 32)
        .map(|i| {
            let [r, g, b, _] = rng_draw([5, 6], i, 0, 0).map(|w| 0.2 + rng_unit(w));
            [r, g, b]
        })
        .collect()
}

fn told(error: GpuSpecimenError) -> GpuError {
    match error {
        GpuSpecimenError::Gpu(error) => error,
        other => GpuError::Refused { what: "a specimen".to_owned(), reason: other.to_string() },
    }
}

pub(super) fn picture(gpu: &Gpu, diameter: f64, options: &SpecimenOptions) -> Result<Run, GpuError> {
    lit_picture(gpu, diameter, options, &[])
}

/// As many lamps as there may be, of a few degrees and of colors of their own, the first behind the drop as seen from yaw 0.
pub(super) fn lamps() -> Vec<SpecimenLamp> {
    let two = [(2.8, 0.1, 0.1, [4.0, 3.0, 2.0]), (1.6, -0.2, 0.15, [0.5, 1.0, 2.5])];
    let around = (2..specimen::SPECIMEN_LAMPS).map(|k| {
        let k = f64::from(k);
        (0.8 * k, 0.7 - 0.2 * k, 0.12 + 0.01 * k, [0.5 + 0.3 * k, 3.0 - 0.3 * k, 1.0 + 0.1 * k * k])
    });
    two.into_iter()
        .chain(around)
        .map(|(yaw, pitch, radius, radiance)| {
            SpecimenLamp::new(yaw, pitch, radius, radiance.map(|x| x as f32)).expect("a lamp")
        })
        .collect()
}

pub(super) fn lit_picture(
    gpu: &Gpu,
    diameter: f64,
    options: &SpecimenOptions,
    lamps: &[SpecimenLamp],
) -> Result<Run, GpuError> {
    let shape = DropShape::new(diameter).expect("a diameter of the table");
    let texels = sky_texels();
    let sky = Sky::new(64, 32, &texels).expect("a sky").with_lamps(lamps).expect("few lamps");
    let key = format!("specimen {diameter} {options:?} {lamps:?}");
    let cpu = kept(&key, || render_specimen(&shape, options, sky).expect("a picture"));
    let gpu = SpecimenRenderer::new(gpu)?.render(&shape, options, sky).map_err(told)?;
    let words = |image: &Image| image.pixels.iter().flat_map(IntoWords::words).collect();
    let cell = |i: u32| [i % cpu.width, i / cpu.width].map(|c| (c as f32).to_bits()).to_vec();
    Ok(Run {
        arguments: (0..cpu.width * cpu.height).map(cell).collect(),
        cpu: Cpu(words(&cpu)),
        gpu: FromGpu(words(&gpu)),
        kinds: vec![WordKind::Float; 3],
    })
}

fn options(pitch: f64, yaw: f64) -> SpecimenOptions {
    SpecimenOptions { size: [90, 70], samples: 2, pitch, yaw, ..SpecimenOptions::default() }
}

const LEVEL: Tol = Tol::absolute(
    5.0e-4,
    "directions of f32 are 1e-6 turns apart, more at the rim, in a sky that changes by 60 per turn; \
     near the rim light goes round by up to 256 reflections, each of which multiplies them",
)
.with_outliers(5.0e-3);
const TILTED: Tol = Tol::absolute(
    2.0e-3,
    "total reflections multiply the errors before them; close to the critical angle a ray may take another way",
)
.with_outliers(5.0e-3);

const LAMPS: Tol =
    Tol::absolute(2.0e-3, "as without; a sample on the edge of a lamp may fall on either side")
        .with_outliers(1.0e-2);

/// The cases.
#[must_use]
pub(super) fn kernels() -> Vec<KernelCase> {
    let case = |name, tol, run| KernelCase {
        name,
        kernel: &specimen::SPECIMEN_KERNEL,
        with: &[],
        overrides: &[],
        text: None,
        tol,
        run,
    };
    vec![
        case("main_specimen: 1 mm, level", LEVEL, |gpu| picture(gpu, 1.0e-3, &options(0.0, 0.0))),
        case("main_specimen: 5 mm, level", LEVEL, |gpu| picture(gpu, 5.0e-3, &options(0.0, 2.0))),
        case("main_specimen: 3 mm from above, with dispersion", TILTED, |gpu| {
            let refractive_index = [1.3312, 1.3345, 1.3392];
            picture(gpu, 3.0e-3, &SpecimenOptions { refractive_index, ..options(0.6, -1.0) })
        }),
        case("main_specimen: 2 mm before lamps", LAMPS, |gpu| {
            lit_picture(gpu, 2.0e-3, &options(0.1, 0.0), &lamps())
        }),
        case("main_specimen: 6 mm from below", TILTED, |gpu| picture(gpu, 6.0e-3, &options(-0.5, 4.0))),
    ]
}
