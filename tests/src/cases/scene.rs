//! `shaders/wgsl/render` (but the specimen) against `downpour-render`.

use downpour_gpu::{Gpu, GpuError};
use downpour_math::rng::rng_unit;
use downpour_render::camera::Viewpoint;
use downpour_render::light::LightSource;
use downpour_render::spacing::spacing_first;
use downpour_shaders::render::brdf::BRDF;
use downpour_shaders::render::path::{PATH, PATH_LATTICE};
use downpour_shaders::render::scatter::SCATTER;
use downpour_shaders::render::scene::{
    EMITTER, SCENE, SCENE_BLENDED, SCENE_DOUBLE_SIDED, SCENE_MASKED, SCENE_UNLIT, SKYLIGHT, SKYLIGHT_KERNEL,
    SPACING, SURFACE, TEXTURE, TRACE_KERNEL, TRACE_SAMPLE_KERNEL,
};
use downpour_trace::brdf::{
    brdf_direct, brdf_distribution, brdf_environment, brdf_fresnel, brdf_grazing, brdf_masking, brdf_rise,
    brdf_visibility, brdf_visible_density, brdf_visible_normal,
};
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::emitter::{emitter_color, emitter_weight};
use downpour_trace::gpu::{SampleDispatches, ScenePipeline};
use downpour_trace::material::{MaterialLook, TextureUse};
use downpour_trace::path::{path_lattice_numbers, path_water_rays};
use downpour_trace::scatter::{
    scatter_above, scatter_alpha, scatter_chance, scatter_gloss, scatter_hemisphere, scatter_tangent,
};
use downpour_trace::scene::{SceneView, scene_alpha, scene_disk, scene_softness};
use downpour_trace::sky_light::SkyLight;
use downpour_trace::skylight::{skylight_film, skylight_hat, skylight_lobe, skylight_radius};
use downpour_trace::surface::{surface_roughness, surface_turn};
use downpour_trace::texture::{texture_taps, texture_variance, texture_wrap};
use glam::{Affine3A, Vec2, Vec3, Vec4};

use crate::Domain::{AnyWord, Below, Fixed, Made, OneOf, Uniform, Unit3};
use crate::function::Run;
use crate::kept::{digest, kept};
use crate::words::{Args, IntoWords as _};
use crate::{FunctionCase, KernelCase, Tol};

fn vec3(args: &mut Args<'_>) -> Vec3 {
    Vec3::from(args.f32s())
}

const FORMULA: Tol =
    Tol::relative(2.0e-5, 1.0e-6, "products, square roots and quotients (2.5 ulp each) without cancellation");

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    let cosine = Uniform(0.02, 1.0);
    let fraction = Uniform(0.0, 1.0);
    let alpha = Uniform(0.05, 1.0);
    let color = [Uniform(0.0, 1.0); 3];
    let [r, g, b] = color;
    vec![
        FunctionCase::new(
            "brdf_distribution",
            &BRDF,
            &[alpha, cosine],
            Tol::relative(
                1.0e-3,
                1.0e-4,
                "the denominator cancels to alpha^2 at the peak, where f32 has 1e-7 / alpha^2",
            ),
            |a| brdf_distribution(a.f32(), a.f32()).words(),
        ),
        FunctionCase::new("brdf_visibility", &BRDF, &[alpha, cosine, cosine], FORMULA, |a| {
            brdf_visibility(a.f32(), a.f32(), a.f32()).words()
        }),
        FunctionCase::new("brdf_rise", &BRDF, &[Uniform(-0.5, 1.0), Uniform(-0.2, 1.2)], FORMULA, |a| {
            brdf_rise(a.f32(), a.f32()).words()
        }),
        FunctionCase::new(
            "brdf_grazing",
            &BRDF,
            &[Uniform(0.0, 2.0e-3), Uniform(0.0, 2.0e-3), b],
            FORMULA,
            |a| brdf_grazing(vec3(a)).to_array().words(),
        ),
        FunctionCase::new(
            "brdf_fresnel",
            &BRDF,
            &[r, g, b, Uniform(-0.5, 1.0), Uniform(-0.2, 1.2)],
            FORMULA,
            |a| brdf_fresnel(vec3(a), a.f32(), a.f32()).to_array().words(),
        ),
        FunctionCase::new(
            "brdf_direct",
            &BRDF,
            &[r, g, b, r, g, b, Uniform(-0.5, 1.0), Uniform(0.2, 1.0), Unit3, Unit3, Unit3],
            Tol::relative(
                1.0e-3,
                1.0e-4,
                "the distribution above, and a half vector that cancels for opposite directions",
            )
            .with_outliers(1.0e-3),
            |a| brdf_direct(vec3(a), vec3(a), a.f32(), a.f32(), vec3(a), vec3(a), vec3(a)).to_array().words(),
        ),
        FunctionCase::new(
            "brdf_environment",
            &BRDF,
            &[r, g, b, Uniform(0.0, 1.0), Uniform(0.0, 1.0)],
            Tol::absolute(1.0e-5, "an exp2 of numbers up to 10 (3 + 2|x| ulp) and sums of numbers up to 1"),
            |a| brdf_environment(vec3(a), a.f32(), a.f32()).to_array().words(),
        ),
        FunctionCase::new(
            "texture_wrap",
            &TEXTURE,
            &[
                Made(|r| vec![(r[0] % 20_001).wrapping_sub(10_000)]),
                Made(|r| vec![1 + r[0] % 300]),
                Below(2),
                Below(2),
            ],
            Tol::exact("integers are exact"),
            |a| {
                let (i, n) = (a.u32() as i32, a.u32() as i32);
                texture_wrap(i, n, a.u32() != 0, a.u32() != 0).map(|i| i as u32).words()
            },
        ),
        FunctionCase::new(
            "texture_taps",
            &TEXTURE,
            &[
                Uniform(-40.0, 40.0),
                Uniform(-40.0, 40.0),
                Uniform(-6.0, 6.0),
                Uniform(-6.0, 6.0),
                OneOf(&[0.0, 1.0, 2.0, 8.0]),
            ],
            Tol::relative(2.0e-5, 1.0e-5, "square roots and quotients (2.5 ulp each); 1 - x of near numbers")
                .with_outliers(2.0e-3),
            |a| {
                let found = texture_taps(Vec2::from(a.f32s()), Vec2::from(a.f32s()), a.f32());
                [found.line.x, found.line.y, found.taps, found.texel].words()
            },
        ),
        FunctionCase::new(
            "texture_variance",
            &TEXTURE,
            &[
                Uniform(-1.0, 1.0),
                Uniform(-1.0, 1.0),
                Uniform(0.0, 4.0),
                Uniform(-1.0, 1.0),
                Uniform(-2.0, 2.0),
                Uniform(-2.0, 2.0),
                Uniform(-2.0, 2.0),
                Uniform(-2.0, 2.0),
            ],
            Tol::absolute(1.0e-5, "differences and products of numbers up to 4"),
            |a| texture_variance(Vec4::from(a.f32s()), Vec2::from(a.f32s()), Vec2::from(a.f32s())).words(),
        ),
        FunctionCase::new(
            "surface_turn",
            &SURFACE,
            &[Uniform(0.0, 20.0), Uniform(0.0, 0.1), Uniform(-1.0, 1.0)],
            FORMULA,
            |a| surface_turn(a.f32(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new("surface_roughness", &SURFACE, &[fraction, Uniform(0.0, 2.0)], FORMULA, |a| {
            surface_roughness(a.f32(), a.f32()).words()
        }),
        FunctionCase::new("brdf_masking", &BRDF, &[alpha, cosine], FORMULA, |a| {
            brdf_masking(a.f32(), a.f32()).words()
        }),
        FunctionCase::new(
            "brdf_visible_normal",
            &BRDF,
            &[Unit3, alpha, fraction, fraction],
            Tol::absolute(3.0e-3, "sine and cosine (2^-11 within pi, and unspecified reduction beyond)")
                .with_outliers(1.0e-3),
            |a| {
                let view = vec3(a);
                brdf_visible_normal(view, a.f32(), a.f32(), a.f32()).to_array().words()
            },
        ),
        // A view along the normal, whose axes are the surface's own.
        FunctionCase::new(
            "brdf_visible_normal",
            &BRDF,
            &[Fixed(0.0), Fixed(0.0), Fixed(1.0), alpha, fraction, fraction],
            Tol::absolute(3.0e-3, "sine and cosine (2^-11 within pi, and unspecified reduction beyond)")
                .with_outliers(1.0e-3),
            |a| {
                let view = vec3(a);
                brdf_visible_normal(view, a.f32(), a.f32(), a.f32()).to_array().words()
            },
        ),
        FunctionCase::new(
            "brdf_visible_density",
            &BRDF,
            &[Uniform(0.2, 1.0), cosine, cosine],
            Tol::relative(1.0e-3, 1.0e-4, "the distribution above"),
            |a| brdf_visible_density(a.f32(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "emitter_weight",
            &EMITTER,
            &[
                Uniform(-5.0, 5.0),
                Uniform(-5.0, 5.0),
                Uniform(-5.0, 5.0),
                Uniform(0.0, 4.0),
                Uniform(0.0, 9.0),
                Unit3,
            ],
            Tol::relative(1.0e-4, 1.0e-4, "a height that cancels at the horizon").with_outliers(1.0e-3),
            |a| emitter_weight(vec3(a), a.f32(), a.f32(), vec3(a)).words(),
        ),
        // Points in the horizon, above it and below it, exactly.
        FunctionCase::new(
            "emitter_weight",
            &EMITTER,
            &[
                Uniform(-5.0, 5.0),
                OneOf(&[0.0, 1.0, -1.0]),
                Uniform(-5.0, 5.0),
                Fixed(0.0),
                Uniform(0.0, 9.0),
                Fixed(0.0),
                Fixed(1.0),
                Fixed(0.0),
            ],
            Tol::relative(1.0e-5, 1.0e-6, "roots and quotients (2.5 ulp)"),
            |a| emitter_weight(vec3(a), a.f32(), a.f32(), vec3(a)).words(),
        ),
        FunctionCase::new("emitter_color", &EMITTER, &[AnyWord], FORMULA, |a| {
            emitter_color(a.u32()).to_array().words()
        }),
        FunctionCase::new("scene_alpha", &SCENE, &[fraction, fraction, Uniform(-0.2, 1.0)], FORMULA, |a| {
            scene_alpha(a.f32(), a.f32(), a.f32()).words()
        }),
        FunctionCase::new(
            "scene_softness",
            &SCENE,
            &[Uniform(0.0, 30.0), Uniform(0.0, 0.1), Uniform(0.001, 0.1)],
            Tol::absolute(1.0e-5, "products and a quotient (2.5 ulp) of numbers up to 10"),
            |a| scene_softness(a.f32(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "scene_disk",
            &SCENE,
            &[fraction, fraction],
            Tol::absolute(2.0e-3, "sine and cosine (2^-11 within pi, and unspecified reduction beyond)")
                .with_outliers(1.0e-3),
            |a| scene_disk(a.f32s()).to_array().words(),
        ),
        FunctionCase::new("scatter_tangent", &SCATTER, &[Unit3], FORMULA.with_outliers(1.0e-3), |a| {
            scatter_tangent(vec3(a)).to_array().words()
        }),
        FunctionCase::new(
            "scatter_hemisphere",
            &SCATTER,
            &[Unit3, fraction, fraction],
            Tol::absolute(2.0e-3, "sine and cosine (2^-11 within pi, and unspecified reduction beyond)")
                .with_outliers(1.0e-3),
            |a| scatter_hemisphere(vec3(a), a.f32(), a.f32()).to_array().words(),
        ),
        FunctionCase::new("scatter_above", &SCATTER, &[Unit3, Unit3], FORMULA, |a| {
            scatter_above(vec3(a), vec3(a)).to_array().words()
        }),
        FunctionCase::new("scatter_alpha", &SCATTER, &[fraction], FORMULA, |a| {
            scatter_alpha(a.f32()).words()
        }),
        FunctionCase::new(
            "scatter_gloss",
            &SCATTER,
            &[r, g, b, fraction, fraction, Below(2)],
            Tol::absolute(1.0e-5, "an exp2 of numbers up to 10 (3 + 2|x| ulp) and sums of numbers up to 1"),
            |a| {
                let normal_reflectance = vec3(a);
                scatter_gloss(normal_reflectance, a.f32(), a.f32(), a.u32() != 0).to_array().words()
            },
        ),
        FunctionCase::new("scatter_chance", &SCATTER, &[r, g, b, r, g, b], FORMULA, |a| {
            scatter_chance(vec3(a), vec3(a)).words()
        }),
        FunctionCase::new(
            "path_lattice_numbers",
            &PATH_LATTICE,
            &[
                AnyWord,
                AnyWord,
                AnyWord,
                AnyWord,
                Below(64),
                Below(4),
                Below(16),
                Made(|r| vec![16 + r[0] % 4]),
            ],
            Tol::absolute(2.0e-6, "products and sums of numbers up to 17, of which the fraction is kept")
                .with_outliers(1.0e-3),
            |a| {
                let random = a.u32s();
                path_lattice_numbers(random, a.u32(), a.u32(), a.u32(), a.u32()).words()
            },
        ),
        FunctionCase::new(
            "skylight_lobe",
            &SKYLIGHT,
            &[Uniform(0.9, 1.0), Uniform(0.3, 1.0)],
            Tol::absolute(1.0e-4, "a difference of cosines near 1, over the fourth power of 0.3"),
            |a| skylight_lobe(a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "path_water_rays",
            &PATH,
            &[Below(8), Made(|r| vec![1 + r[0] % 4]), Below(2)],
            Tol::exact("whole numbers"),
            |a| path_water_rays(a.u32(), a.u32(), a.u32() != 0).words(),
        ),
        FunctionCase::new("skylight_film", &SKYLIGHT, &[fraction, fraction], FORMULA, |a| {
            skylight_film(a.f32(), a.f32()).words()
        }),
        FunctionCase::new(
            "spacing_first",
            &SPACING,
            &[
                Below(2000),
                Made(|r| {
                    let apart = 1 + r[0] % 4;
                    vec![apart, r[2] % 12, r[1] % apart]
                }),
            ],
            Tol::exact("whole numbers"),
            |a| spacing_first(a.u32(), a.u32(), a.u32(), a.u32()).words(),
        ),
        FunctionCase::new(
            "skylight_hat",
            &SKYLIGHT,
            &[Below(4), Below(4), Made(|r| vec![3 + r[0] % 2])],
            Tol::exact("small whole numbers"),
            |a| skylight_hat(a.u32(), a.u32(), a.u32()).words(),
        ),
        FunctionCase::new(
            "skylight_radius",
            &SKYLIGHT,
            &[Below(7), Made(|r| vec![1 + r[0] % 3])],
            Tol::exact("a choice of small whole numbers"),
            |a| skylight_radius(a.u32(), a.u32()).words(),
        ),
    ]
}

/// A floor, boxes of every kind of material, a masked and a see-through sheet, three kinds of lamps, a sky.
pub(super) fn scene() -> SceneData {
    scene_that(Looks::default(), &[])
}

/// The same with more lamps.
pub(super) fn lit_scene(lamps: &[LightSource]) -> SceneData {
    scene_that(Looks::default(), lamps)
}

/// The same with surfaces and the glass of a lamp that shine, and lamps with a size.
pub(super) fn shining_scene() -> SceneData {
    scene_that(Looks { shines: true, ..Looks::default() }, &[])
}

/// The same, with leaves that transmit light.
fn leafy_scene() -> SceneData {
    scene_that(Looks { shines: true, translucent: true }, &[])
}

/// What a scene has.
#[derive(Clone, Copy, Default)]
struct Looks {
    shines: bool,
    translucent: bool,
}

/// The same; if it `shines`, with a board whose colors shine, the glass of a lamp, and lamps with a size.
fn scene_that(Looks { shines, translucent }: Looks, lamps: &[LightSource]) -> SceneData {
    let sky: Vec<[f32; 3]> = (0..64 * 32)
        .map(|i| {
            let (x, y) = ((i % 64) as f32 / 64.0, (i / 64) as f32 / 32.0);
            [0.4 + 0.3 * x, 0.6, 1.2 - y]
        })
        .collect();
    let sky = SkyLight::new(64, 32, &sky);
    let mut builder = SceneBuilder::new();
    let noise: Vec<[u8; 4]> = (0..32 * 16)
        .map(|i| downpour_math::rng::rng_pcg4d([i, 1, 2, 3]).map(|w| (rng_unit(w) * 255.0) as u8))
        .collect();
    let mut color = builder.texture(32, 16, &noise, TextureUse::Color);
    color.matrix = [2.0, 0.5, -0.5, 2.0];
    let color = builder.add_slot(color);
    let data = builder.texture(32, 16, &noise, TextureUse::Data);
    let data = builder.add_slot(data);
    let slopes: Vec<[u8; 4]> = noise.iter().map(|&[r, g, b, a]| [r, g, 128 + b / 2, a]).collect();
    let relief = builder.texture(32, 16, &slopes, TextureUse::Normals);
    let relief = builder.add_slot(relief);
    let plain = MaterialLook::default();
    let looks = [
        MaterialLook {
            maps: [Some(color), None, None, None, None, None, None, None],
            roughness: 0.6,
            ..plain
        },
        MaterialLook { metallic: 1.0, roughness: 0.25, base_color: [0.9, 0.6, 0.3, 1.0], ..plain },
        MaterialLook {
            maps: [None, Some(data), Some(relief), None, Some(data), None, None, None],
            roughness: 0.8,
            ..plain
        },
        MaterialLook {
            flags: SCENE_MASKED | SCENE_DOUBLE_SIDED,
            diffuse_transmission: if translucent { 0.7 } else { 0.0 },
            diffuse_transmission_color: [0.9, 1.0, 0.4],
            maps: [Some(color), None, None, None, None, None, Some(data), Some(color)],
            ..plain
        },
        MaterialLook { flags: SCENE_BLENDED, base_color: [0.2, 0.9, 0.4, 0.4], ..plain },
        MaterialLook { flags: SCENE_UNLIT, base_color: [1.0, 0.2, 0.7, 1.0], ..plain },
        MaterialLook {
            transmission: 0.8,
            roughness: 0.1,
            emission: if shines { [0.1, 0.0, 0.2] } else { [0.0; 3] },
            ..plain
        },
    ];
    let materials = looks.map(|look| builder.add_material(look));
    let shining = [
        MaterialLook {
            maps: [None, None, None, Some(color), None, None, None, None],
            emission: [4.0, 3.0, 2.0],
            ..plain
        },
        MaterialLook { emission: [20.0; 3], ..plain },
    ];
    let shining = shining.map(|look| builder.add_material(look));
    let positions: Vec<[f32; 3]> = (0..24)
        .map(|i| {
            // Face i / 4 of a cube: two coordinates run, the third is at its end.
            let (axis, end) = (i / 4 % 3, if i < 12 { -0.5 } else { 0.5 });
            let (u, v) = ([-0.5, 0.5, 0.5, -0.5][i % 4], [-0.5, -0.5, 0.5, 0.5][i % 4]);
            let mut p = [0.0; 3];
            p[axis] = end;
            p[(axis + 1) % 3] = u;
            p[(axis + 2) % 3] = v;
            p
        })
        .collect();
    let uvs: Vec<[f32; 2]> =
        (0..24).map(|i| [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]][i % 4]).collect();
    let tangents: Vec<[f32; 4]> = (0..24)
        .map(|i| {
            let mut t = [0.0, 0.0, 0.0, 1.0];
            t[(i / 4 + 1) % 3] = 1.0;
            t
        })
        .collect();
    let indices: Vec<u32> = (0..6).flat_map(|f| [0, 1, 2, 0, 2, 3].map(|k| 4 * f + k)).collect();
    let mut add = |material: u32, at: Vec3, size: Vec3| {
        let part = MeshPart {
            tangents: Some(&tangents),
            uvs: [Some(&uvs), None],
            ..MeshPart::plain(&positions, &indices, material)
        };
        builder.add_mesh(&part, &(Affine3A::from_translation(at) * Affine3A::from_scale(size)));
    };
    add(materials[0], Vec3::new(0.0, -0.6, 0.0), Vec3::new(8.0, 0.2, 8.0));
    for (k, &material) in (0i16..).zip(&materials[1..]) {
        let x = f32::from(k) - 2.5;
        add(
            material,
            Vec3::new(x, 0.1 * f32::from(k % 3), -0.7 * f32::from(k % 2)),
            Vec3::new(0.7, 0.9, 0.7),
        );
    }
    let radius = if shines { 0.15 } else { 0.0 };
    if shines {
        add(shining[0], Vec3::new(-0.4, 0.9, -1.6), Vec3::new(2.0, 0.7, 0.05));
        // The glass of the spot.
        add(shining[1], Vec3::new(2.0, 2.55, 1.0), Vec3::splat(0.1));
    }
    builder.add_light(LightSource::Directional {
        direction: Vec3::new(0.4, -0.8, -0.45).normalize(),
        irradiance: Vec3::new(3.0, 2.8, 2.5),
    });
    builder.add_light(LightSource::Point {
        radius,
        position: Vec3::new(-1.0, 1.5, 1.5),
        intensity: Vec3::splat(2.0),
        range: 6.0,
    });
    builder.add_light(LightSource::Spot {
        radius: 0.0,
        position: Vec3::new(2.0, 2.5, 1.0),
        direction: Vec3::new(-0.4, -0.85, -0.35).normalize(),
        intensity: Vec3::new(6.0, 3.0, 1.0),
        range: 0.0,
        inner: 0.3,
        outer: 0.6,
    });
    for lamp in lamps {
        builder.add_light(*lamp);
    }
    let mut data = builder.build(&sky);
    if shines {
        data.set_light_radius(0, 0.03);
    }
    data
}

fn scene_case(gpu: &Gpu, eye: Vec3, sky_rays: u32) -> Result<Run, GpuError> {
    picture(gpu, &scene(), eye, sky_rays)
}

/// Of pictures of a scene: no multiple of a workgroup.
const SIZE: [u32; 2] = [93, 62];

/// A picture of a scene, from an eye that looks at its middle.
pub(super) fn picture(gpu: &Gpu, scene: &SceneData, eye: Vec3, sky_rays: u32) -> Result<Run, GpuError> {
    picture_by(PictureRays { sky_rays, ..PictureRays::default() }, gpu, scene, eye)
}

/// Rays of a picture.
#[derive(Clone, Copy)]
pub(super) struct PictureRays {
    pub(super) samples: SampleDispatches,
    pub(super) sky_rays: u32,
    pub(super) spacing: u32,
}

impl Default for PictureRays {
    fn default() -> Self {
        Self { samples: SampleDispatches::Together, sky_rays: 1, spacing: 1 }
    }
}

/// A picture of a scene by such rays.
pub(super) fn picture_by(
    rays: PictureRays,
    gpu: &Gpu,
    scene: &SceneData,
    eye: Vec3,
) -> Result<Run, GpuError> {
    let PictureRays { samples, sky_rays, spacing } = rays;
    let view = Viewpoint { eye, forward: -eye, up: Vec3::Y, fov_y: 0.9 };
    let frame = RenderFrame::new(scene, &view, SIZE, 2, sky_rays, 7).expect("a frame");
    let frame = frame.with_ray_spacing(spacing);
    let key = format!("picture {eye} {sky_rays} {spacing} {}", digest(scene));
    let cpu = kept(&key, || SceneView { data: scene, frame: &frame }.picture());
    let pipeline = ScenePipeline::with_samples(gpu, samples)?;
    let gpu = pipeline.picture(&pipeline.upload(scene)?, &frame)?;
    Ok(Run::of_pixels(SIZE[0], &cpu, &gpu))
}

/// Parts of a traced scene, each 1 if it has them, else 0: the overrides of the kernel.
#[derive(Clone, Copy)]
pub(super) struct Parts {
    pub(super) wet_panes: f64,
    pub(super) impostors: f64,
    pub(super) pane: f64,
    pub(super) shines: f64,
    pub(super) puddles: f64,
    pub(super) wet: f64,
    pub(super) translucent: f64,
}

impl Parts {
    pub(super) const NONE: Self = Self {
        wet_panes: 0.0,
        impostors: 0.0,
        pane: 0.0,
        shines: 0.0,
        puddles: 0.0,
        wet: 0.0,
        translucent: 0.0,
    };

    /// The overrides, sorted by name.
    pub(super) const fn overrides(self) -> [(&'static str, f64); 7] {
        [
            ("GLAZING_PANES", self.wet_panes),
            ("IMPOSTOR_REFLECTIONS", self.impostors),
            ("SCENE_PANE", self.pane),
            ("SCENE_SHINES", self.shines),
            ("SCENE_WET", self.puddles),
            ("SURFACE_TRANSLUCENT", self.translucent),
            ("WET_SURFACES", self.wet),
        ]
    }
}

/// A dry scene of which nothing shines.
pub(super) const DULL: &[(&str, f64)] = &Parts::NONE.overrides();

/// A dry scene of which something does.
const SHINING: &[(&str, f64)] = &Parts { shines: 1.0, ..Parts::NONE }.overrides();

/// A dry scene of which something shines, with leaves that transmit light.
const LEAFY: &[(&str, f64)] = &Parts { shines: 1.0, translucent: 1.0, ..Parts::NONE }.overrides();

const PICTURE: Tol = Tol::relative(
    2.0e-3,
    2.0e-3,
    "sums over rays; a ray at an edge, and the sky's atan2 (4096 ulp), may fall on either side",
)
.with_outliers(2.0e-3);

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let case =
        |name, overrides, run| KernelCase { overrides, ..KernelCase::new(name, &TRACE_KERNEL, PICTURE, run) };
    let filter = |name, run| KernelCase::new(name, &SKYLIGHT_KERNEL, PICTURE, run);
    vec![
        filter("main_skylight: from above", |gpu| scene_case(gpu, Vec3::new(1.6, 3.4, 2.0), 2)),
        filter("main_skylight: rays of one pixel in 16 that look for light", |gpu| {
            let rays = PictureRays { spacing: 4, ..PictureRays::default() };
            picture_by(rays, gpu, &shining_scene(), Vec3::new(0.6, 1.4, 3.0))
        }),
        case("main_trace: near, with rays to the sky", DULL, |gpu| {
            scene_case(gpu, Vec3::new(0.6, 1.4, 3.0), 4)
        }),
        case("main_trace: far, with the open sky", DULL, |gpu| {
            scene_case(gpu, Vec3::new(-9.0, 6.0, 12.0), 0)
        }),
        case("main_trace: surfaces that shine, and lamps with a size", SHINING, |gpu| {
            picture(gpu, &shining_scene(), Vec3::new(0.6, 1.4, 3.0), 2)
        }),
        case("main_trace: leaves that transmit light", LEAFY, |gpu| {
            picture(gpu, &leafy_scene(), Vec3::new(0.6, 1.4, 3.0), 2)
        }),
        case("main_trace: leaves that transmit light, without rays to the sky", LEAFY, |gpu| {
            picture(gpu, &leafy_scene(), Vec3::new(1.2, 0.4, -2.6), 0)
        }),
        case("main_trace: the sun over surfaces that shine", SHINING, |gpu| {
            // The sun stands behind the middle.
            picture(gpu, &shining_scene(), Vec3::new(1.6, -3.2, -1.8), 1)
        }),
        KernelCase {
            kernel: &TRACE_SAMPLE_KERNEL,
            ..case("main_trace_sample: surfaces that shine, and lamps with a size", SHINING, |gpu| {
                let eye = Vec3::new(0.6, 1.4, 3.0);
                let rays =
                    PictureRays { samples: SampleDispatches::Apart, sky_rays: 2, ..PictureRays::default() };
                picture_by(rays, gpu, &shining_scene(), eye)
            })
        },
        case("main_trace: rays of one pixel in 4 that look for light", SHINING, |gpu| {
            let rays = PictureRays { spacing: 2, ..PictureRays::default() };
            picture_by(rays, gpu, &shining_scene(), Vec3::new(0.6, 1.4, 3.0))
        }),
        KernelCase {
            kernel: &TRACE_SAMPLE_KERNEL,
            ..case("main_trace_sample: rays of one pixel in 16 that look for light", SHINING, |gpu| {
                let rays =
                    PictureRays { samples: SampleDispatches::Apart, spacing: 4, ..PictureRays::default() };
                picture_by(rays, gpu, &shining_scene(), Vec3::new(0.6, 1.4, 3.0))
            })
        },
    ]
}
