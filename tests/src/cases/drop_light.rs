//! `shaders/wgsl/render/{drop_glint,drop_light}.wgsl` against `downpour_render::rain::{glint, light}`.

use downpour_atlas::{StreakAtlas, StreakPick};
use downpour_gpu::{Gpu, GpuError};
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_render::camera::Viewpoint;
use downpour_render::gpu::DropLightPipeline;
use downpour_render::light::LightSource;
use downpour_render::rain::glint::{
    drop_glint_angle, drop_glint_before, drop_glint_image, drop_glint_level, drop_glint_pack,
    drop_glint_pixel, drop_glint_right, drop_glint_rousseau, drop_glint_side, drop_glint_sine,
    drop_glint_unpack,
};
use downpour_render::rain::light::{
    DropLightForm, DropLightOptions, DropLightTable, DropLights, drop_light_mean,
};
use downpour_shaders::render::drop_light::{DROP_GLINT, DROP_LIGHT, DROP_LIGHT_KERNEL};
use downpour_trace::builder::SceneBuilder;
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::gpu::ScenePipeline;
use downpour_trace::scene::SceneView;
use downpour_trace::sky_light::SkyLight;
use glam::{Vec2, Vec3};

use super::scene::scene;
use crate::Domain::{Fixed, Made, OneOf, Uniform, Unit3};
use crate::compare::{Cpu, Gpu as FromGpu};
use crate::function::Run;
use crate::kept::{digest, kept};
use crate::signature::WordKind;
use crate::words::{Args, IntoWords};
use crate::{FunctionCase, KernelCase, Tol};

fn vec3(args: &mut Args<'_>) -> Vec3 {
    Vec3::from(args.f32s())
}

/// A packed position and image.
fn packed(random: [u32; 4]) -> Vec<u32> {
    let position = Vec2::new(rng_unit(random[0]), rng_unit(random[1])) * 2.0 - 1.0;
    drop_glint_pack(position, rng_unit(random[2])).words()
}

/// Two directions that are no worse than a hundredth of a radian from each other's line.
fn apart(random: [u32; 4]) -> Vec<u32> {
    let unit = |a: u32, b: u32| {
        let v = Vec3::new(rng_unit(a) - 0.5, rng_unit(b) - 0.5, rng_unit(a ^ b.rotate_left(7)) - 0.4999);
        v.normalize()
    };
    let (light, towards) = (unit(random[0], random[1]), unit(random[2], random[3]));
    let towards = if light.cross(towards).length() < 0.01 { light.any_orthonormal_vector() } else { towards };
    [light.to_array(), towards.to_array()].words()
}

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    let case =
        |function, domains: &[_], tol, cpu| FunctionCase::new(function, &DROP_GLINT, domains, tol, cpu);
    let root = Tol::absolute(2.0e-6, "products of unit vectors, a square root and a division (2.5 ulp)");
    let [none, one] = [0.0, 1.0].map(Fixed);
    vec![
        case("drop_glint_right", &[Unit3], root, |a| drop_glint_right(vec3(a)).to_array().words()),
        // So close to plumb that the square is DROP_GLINT_AXIS, fused or not.
        case(
            "drop_glint_right",
            &[OneOf(&[0.0, 5.020_692e-7, 1.0e-3]), one, OneOf(&[0.0, 8.648_274e-7, 1.0e-3])],
            root,
            |a| drop_glint_right(vec3(a)).to_array().words(),
        ),
        case(
            "drop_glint_angle",
            &[Made(apart)],
            Tol::absolute(2.0e-6, "square roots, a division and a polynomial up to 1/8, times 4"),
            |a| drop_glint_angle(vec3(a), vec3(a)).words(),
        ),
        case(
            "drop_glint_side",
            &[Unit3, Unit3, Unit3],
            Tol::absolute(1.0e-4, "two dot products that may cancel to 1e-3, over their length")
                .with_outliers(2.0e-3),
            |a| drop_glint_side(vec3(a), vec3(a), vec3(a)).to_array().words(),
        ),
        // A lamp behind the drop or so close to there that the square is DROP_GLINT_AXIS, fused or not.
        case(
            "drop_glint_side",
            &[
                OneOf(&[0.0, 5.020_692e-7, 1.0e-3]),
                OneOf(&[0.0, 8.648_274e-7, 1.0e-3]),
                none, one, none, none, none, one, none,
            ],
            Tol::absolute(1.0e-6, "a root and a division (2.5 ulp each)"),
            |a| drop_glint_side(vec3(a), vec3(a), vec3(a)).to_array().words(),
        ),
        case(
            "drop_glint_pack",
            &[Uniform(-1.2, 1.2), Uniform(-1.2, 1.2), Uniform(-0.1, 1.1)],
            Tol::exact("whole numbers as bits; at a border a fused product or a square root (2.5 ulp) may give the next")
                .with_outliers(2.0e-3),
            |a| drop_glint_pack(Vec2::from(a.f32s()), a.f32()).words(),
        ),
        case(
            "drop_glint_unpack",
            &[Made(packed)],
            Tol::absolute(1.0e-6, "whole numbers, and a division (2.5 ulp) of numbers up to 1"),
            |a| drop_glint_unpack(a.f32()).to_array().words(),
        ),
        case(
            "drop_glint_image",
            &[Made(packed)],
            Tol::absolute(1.0e-6, "a whole number, a division (2.5 ulp) and a square"),
            |a| drop_glint_image(a.f32()).words(),
        ),
        case("drop_glint_sine", &[Unit3, Unit3], root, |a| drop_glint_sine(vec3(a), vec3(a)).words()),
        case(
            "drop_glint_before",
            &[Uniform(-1.2, 1.2)],
            Tol::absolute(2.0e-6, "a polynomial of numbers up to 1, whose products may be fused"),
            |a| drop_glint_before(a.f32()).words(),
        ),
        case(
            "drop_glint_pixel",
            &[Uniform(-3.0, 4.0), Uniform(-3.0, 4.0), Uniform(0.9, 4.0)],
            Tol::absolute(3.0e-6, "differences of polynomials of quotients (2.5 ulp)"),
            |a| drop_glint_pixel(Vec2::from(a.f32s()), a.f32()).words(),
        ),
        case("drop_glint_level", &[Unit3], root, |a| drop_glint_level(vec3(a)).to_array().words()),
        case(
            "drop_glint_rousseau",
            &[Unit3, Unit3, Unit3, Made(terms)],
            Tol::absolute(1.0e-5, "sums of products of unit vectors, one of them made level"),
            |a| drop_glint_rousseau(vec3(a), vec3(a), vec3(a), a.u32()).words(),
        ),
        FunctionCase::new(
            "drop_light_mean",
            &DROP_LIGHT,
            &[Unit3, Unit3, Made(terms)],
            Tol::absolute(2.0e-3, "sine and cosine (2^-11) of numbers up to 2 pi"),
            |a| drop_light_mean(vec3(a), vec3(a), a.u32()).words(),
        ),
    ]
}

/// Terms of the formula of Rousseau 2006: one, the other, or both.
fn terms(random: [u32; 4]) -> Vec<u32> {
    vec![1 + random[0] % 3]
}

/// Drops around what stands in the scene.
fn drops() -> Vec<[f32; 4]> {
    (0..600)
        .map(|k| {
            let [a, b, c, d] = rng_draw([8, 1], k, 0, 0).map(rng_unit);
            [8.0 * a - 4.0, 3.0 * b - 0.3, 8.0 * c - 4.0, 1.0e-4 + 3.0e-3 * d]
        })
        .collect()
}

/// More lamps than a dispatch takes, of all kinds.
fn many() -> SceneData {
    let mut builder = SceneBuilder::new();
    lamps(150).into_iter().for_each(|lamp| builder.add_light(lamp));
    builder.build(&SkyLight::new(64, 32, &vec![[0.5; 3]; 64 * 32]))
}

/// Lamps of all kinds: with a size, with an end, with cones up to more than half of all directions.
pub(super) fn lamps(count: u32) -> Vec<LightSource> {
    let lamp = |k: u32| {
        let [a, b, c, d] = rng_draw([8, 2], k, 0, 0).map(rng_unit);
        let position = Vec3::new(12.0 * a - 6.0, 1.0 + 3.0 * b, 12.0 * c - 6.0);
        let intensity = Vec3::new(1.0 + d, 2.0 - d, 0.5 + a) * 4.0;
        let direction = Vec3::new(b - 0.5, -1.0, d - 0.5).normalize();
        let radius = if k.is_multiple_of(3) { 0.3 * c } else { 0.0 };
        match k % 4 {
            0 => LightSource::Directional { direction, irradiance: intensity * 0.01 },
            1 => LightSource::Point { radius, position, intensity, range: 8.0 * c },
            2 => LightSource::Spot {
                radius,
                position,
                direction,
                intensity,
                range: 0.0,
                inner: 0.4 * c,
                outer: 0.6,
            },
            _ => {
                let (inner, outer) = (0.3 + 1.2 * c, 0.7 + 1.3 * c);
                LightSource::Spot {
                    radius,
                    position,
                    direction,
                    intensity,
                    range: 2.0 + 5.0 * a,
                    inner,
                    outer,
                }
            }
        }
    };
    (0..count).map(lamp).collect()
}

/// The project's streak atlas.
pub(super) fn atlas(pick: StreakPick) -> StreakAtlas {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/streaks");
    StreakAtlas::load(&folder).expect("the project's atlas").with_pick(pick).with_seed(0x9abc_def0_1234_5678)
}

/// Lamps on drops that fall aslant, by the streaks of an atlas.
fn atlas_case(gpu: &Gpu, scene: &SceneData, pick: StreakPick) -> Result<Run, GpuError> {
    let table = DropLightTable::water().expect("water").with_atlas(&atlas(pick));
    let axes = (0..drops().len() as u32).map(|k| {
        let [a, b, c, _] = rng_draw([8, 3], k, 0, 0).map(rng_unit);
        Vec3::new(a - 0.5, 0.4 + b, c - 0.5).normalize().extend(k as f32).to_array()
    });
    let rows: Vec<[f32; 4]> = drops().into_iter().chain(axes).collect();
    rows_case(gpu, scene, &table, DropLightOptions::ATLAS, &rows, false)
}

fn light_case(gpu: &Gpu, scene: &SceneData, form: DropLightForm, glints: u32) -> Result<Run, GpuError> {
    let table = DropLightTable::water().expect("water");
    rows_case(gpu, scene, &table, DropLightOptions { form, glints }, &drops(), false)
}

/// The lamps of drops as the profiles of streaks want them.
fn streaks_case(gpu: &Gpu, scene: &SceneData, form: DropLightForm) -> Result<Run, GpuError> {
    let table = DropLightTable::water().expect("water");
    rows_case(gpu, scene, &table, DropLightOptions { form, glints: 0 }, &drops(), true)
}

fn rows_case(
    gpu: &Gpu,
    scene: &SceneData,
    table: &DropLightTable,
    options: DropLightOptions,
    drops: &[[f32; 4]],
    of_streaks: bool,
) -> Result<Run, GpuError> {
    let view = Viewpoint { eye: Vec3::new(0.6, 1.4, 5.0), forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 0.9 };
    let frame = RenderFrame::new(scene, &view, [64, 64], 1, 0, 7).expect("a frame");
    let lighting = SceneView { data: scene, frame: &frame };
    let lit = if of_streaks { DropLights::of_streaks } else { DropLights::new };
    let lights = lit(&lighting, view.eye, table, options).expect("lights");
    let key = format!("drop light {options:?} {} {}", lights.stride(), digest(&(scene, drops, table)));
    let cpu = kept(&key, || lights.light(drops));
    let (scenes, pipeline) = (ScenePipeline::new(gpu)?, DropLightPipeline::new(gpu)?);
    let lighting = scenes.upload(scene)?.lighting(gpu, &frame)?;
    let pass = pipeline.prepare(gpu, &lighting, &pipeline.upload(table)?, &lights, drops)?;
    gpu.submit(&pass.dispatches())?;
    // Positions and images of glints are compared as such, other rows as they are.
    let glints = if options.form == DropLightForm::Traced { options.glints } else { 0 };
    let words = |rows: &[[f32; 4]]| -> Vec<u32> {
        let of_drop = |rows: &[[f32; 4]]| {
            if glints == 0 {
                return rows.iter().flat_map(IntoWords::words).collect();
            }
            let mut words = rows[0].words();
            for row in &rows[1..] {
                words.extend([row[0], row[1], row[2]].words());
                words.extend(drop_glint_unpack(row[3]).to_array().words());
                words.extend(drop_glint_image(row[3]).words());
            }
            words
        };
        rows.chunks_exact(lights.stride()).flat_map(of_drop).collect()
    };
    Ok(Run {
        arguments: drops[..cpu.len() / lights.stride()].iter().map(IntoWords::words).collect(),
        cpu: Cpu(words(&cpu)),
        gpu: FromGpu(words(&pass.read()?)),
        kinds: vec![WordKind::Float; if glints == 0 { 4 * lights.stride() } else { 4 + 6 * glints as usize }],
    })
}

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let case = |name, run| KernelCase {
        name,
        kernel: &DROP_LIGHT_KERNEL,
        with: &[],
        overrides: &[],
        text: None,
        tol: Tol::relative(
            2.0e-3,
            1.0e-4,
            "a table with steep bows at angles known to 1e-6; a ray at an edge may fall on either side",
        )
        .with_outliers(3.0e-3),
        run,
    };
    vec![
        case("main_drop_light: traced, with glints", |gpu| {
            light_case(gpu, &scene(), DropLightForm::Traced, 6)
        }),
        case("main_drop_light: traced, more lamps than a dispatch takes", |gpu| {
            light_case(gpu, &many(), DropLightForm::Traced, 3)
        }),
        case("main_drop_light: an atlas, by angle", |gpu| atlas_case(gpu, &scene(), StreakPick::ByAngle)),
        case("main_drop_light: an atlas, by chance, more lamps than a dispatch takes", |gpu| {
            atlas_case(gpu, &many(), StreakPick::Random)
        }),
        case("main_drop_light: Rousseau 2006", |gpu| {
            light_case(gpu, &scene(), DropLightForm::Rousseau2006, 0)
        }),
        case("main_drop_light: Rousseau 2006, external reflection", |gpu| {
            light_case(gpu, &scene(), DropLightForm::Rousseau2006External, 0)
        }),
        case("main_drop_light: Rousseau 2006, internal reflection", |gpu| {
            light_case(gpu, &scene(), DropLightForm::Rousseau2006Internal, 0)
        }),
        case("main_drop_light: Rousseau 2006, two of many lamps", |gpu| {
            light_case(gpu, &many(), DropLightForm::Rousseau2006, 4)
        }),
        case("main_drop_light: lamps of streaks, traced", |gpu| {
            streaks_case(gpu, &many(), DropLightForm::Traced)
        }),
        case("main_drop_light: lamps of streaks, Rousseau 2006", |gpu| {
            streaks_case(gpu, &many(), DropLightForm::Rousseau2006Internal)
        }),
        case("main_drop_light: Im & Sung 2022", |gpu| light_case(gpu, &many(), DropLightForm::ImSung2022, 0)),
    ]
}
