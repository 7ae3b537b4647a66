//! `shaders/wgsl/render/glass_picture*.wgsl` against `downpour_render::glass`.

use downpour_gpu::{Gpu, GpuError};
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_render::glass::blade::{glass_picture_blade_at, glass_picture_blade_part};
use downpour_render::glass::light::{glass_picture_light_lobe, glass_picture_light_seen};
use downpour_render::glass::water::{
    glass_picture_water_away, glass_picture_water_cap, glass_picture_water_leave, glass_picture_water_normal,
    glass_picture_water_top,
};
use downpour_render::glass::{
    GlassPicture, GlassPictureBlade, GlassPictureDrop, GlassPictureLight, WetPane, glass_picture_spline,
};
use downpour_render::gpu::{BehindGlass, EnvironmentMap, GlassRenderer};
use downpour_render::picture::compose_pixel;
use downpour_scene::scene::Scene;
use downpour_scene::sky::{SkyMap, Sun};
use downpour_shaders::Kernel;
use downpour_shaders::common::PYRAMID_KERNEL;
use downpour_shaders::render::glass::{
    BLADE, GLASS_PICTURE, GLASS_PICTURE_ARM, GLASS_PICTURE_HOLDER, GLASS_PICTURE_KERNEL, GLASS_PICTURE_LIP,
    LIGHT, WATER,
};
use downpour_shaders::render::rain::COMPOSE_KERNEL;
use downpour_trace::data::RenderFrame;
use downpour_trace::frame_scene::FrameScene;
use downpour_trace::scene::SceneView;
use downpour_weather::{Loaded, Weather};
use glam::{Vec2, Vec3};

use crate::Domain::{Fixed, Made, OneOf, Uniform};
use crate::compare::{Cpu, Gpu as FromGpu};
use crate::function::Run;
use crate::kept::kept;
use crate::signature::WordKind;
use crate::words::{Args, IntoWords as _};
use crate::{FunctionCase, KernelCase, Tol};

/// No multiple of a workgroup.
const SIZE: [u32; 2] = [93, 62];
const CAPTURE: u32 = 64;

/// A drop of 0.4 to 4 mm with all that it may have, as words.
fn drop(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, d] = random.map(rng_unit);
    let [e, f, g, h] = rng_draw([random[0], random[1]], 0, 0, 0).map(rng_unit);
    let radius = 0.2e-3 + 1.8e-3 * a;
    let (x, y) = (e - 0.5, f - 0.5 + 1.0e-3);
    let length = (x * x + y * y).sqrt();
    let along = [x / length, y / length];
    // Every other one is a piece of a ridge, which has no tail.
    let is_piece = random[3] & 1 == 1;
    let axis = if is_piece { along.map(|c| 0.9e-3 * c) } else { [0.0; 2] };
    let behind = if is_piece { 1.0 } else { 0.4 + 0.6 * c };
    let lobe = |u: f32| 0.3 * u - 0.15;
    [
        0.01,
        0.02,
        radius,
        radius * (1.05 + b),
        along[0],
        along[1],
        behind,
        0.6 * d,
        -along[1],
        along[0],
        axis[0],
        axis[1],
        lobe(g),
        lobe(h),
        lobe(c),
        lobe(e),
    ]
    .map(f32::to_bits)
    .to_vec()
}

/// A lamp 5 to 40 m ahead, as words.
fn lamp(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, d] = random.map(rng_unit);
    let distance = 5.0 + 35.0 * a;
    let position = [distance * (0.4 * b - 0.2), distance * (0.4 * c - 0.2), -distance];
    [position[0], position[1], position[2], 0.01 * d, 1.0 + b, 1.0, 0.5 + c, distance]
        .map(f32::to_bits)
        .to_vec()
}

/// A direction of length 1, about forward, as words.
fn towards(random: [u32; 4]) -> Vec<u32> {
    let [a, b, ..] = random.map(rng_unit);
    let direction = Vec3::new(0.6 * a - 0.3, 0.6 * b - 0.3, -1.0).normalize();
    direction.to_array().map(f32::to_bits).to_vec()
}

/// A wiper of 0.3 m that turns while the shutter is open, as words.
fn wiper(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, d] = random.map(rng_unit);
    let mut words = vec![0.2 + 0.02 * a, 0.4 + 0.02 * b, 0.05, 0.3];
    for k in 0u8..10 {
        let angle = 6.0 * c + 0.1 * d * f32::from(k);
        words.extend([downpour_math::ops::cos(angle), -downpour_math::ops::sin(angle)]);
    }
    words.into_iter().map(f32::to_bits).collect()
}

/// A wiper in a direction, and a position within some millimeters of an end of its blade or its arm, as words.
fn near_end(random: [u32; 4]) -> Vec<u32> {
    let mut words = wiper(random);
    let [pivot_x, pivot_y] = [words[0], words[1]].map(f32::from_bits);
    let [a, b, c, ..] = rng_draw([random[0], random[1]], 1, 0, 0);
    let end = [0.0, 0.05, 0.175, 0.3][(a % 4) as usize];
    let (along, aside) = (end + 0.012 * (rng_unit(b) - 0.5), 0.018 * (rng_unit(c) - 0.5));
    let direction = [0.6, -0.8];
    let position = [
        pivot_x + along * direction[0] - aside * direction[1],
        pivot_y + along * direction[1] + aside * direction[0],
    ];
    words.extend([direction, position].concat().into_iter().map(f32::to_bits));
    words
}

fn part(a: &mut Args<'_>) -> Vec<u32> {
    let blade = bytemuck::cast::<[f32; 24], GlassPictureBlade>(a.f32s());
    let (direction, position) = (Vec2::from(a.f32s()), Vec2::from(a.f32s()));
    glass_picture_blade_part(&blade, direction, position).to_array().words()
}

/// A drop at the origin that moves along +x, as words.
fn drop_along_x(random: [u32; 4]) -> Vec<u32> {
    let mut words = drop(random);
    words[..2].copy_from_slice(&[0; 2]);
    words[4..6].copy_from_slice(&[1.0f32, 0.0].map(f32::to_bits));
    words[8..10].copy_from_slice(&[0.0f32, 1.0].map(f32::to_bits));
    words[10..12].copy_from_slice(&[0; 2]);
    words
}

fn read(a: &mut Args<'_>) -> GlassPictureDrop {
    bytemuck::cast::<[f32; 16], GlassPictureDrop>(a.f32s())
}

const PART: Tol =
    Tol::relative(1.0e-4, 1.0e-5, "quotients (2.5 ulp) of differences of lengths of a meter by millimeters");

const CAP: Tol = Tol::relative(
    2.0e-5,
    2.0e-6,
    "two roots (2.5 ulp) whose difference is a height of a tenth of a millimeter, in meters; slopes of about 1",
);

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    let position = [Uniform(0.0085, 0.0115), Uniform(0.0185, 0.0215)];
    vec![
        FunctionCase::new(
            "glass_picture_water_cap",
            &WATER,
            &[Made(drop), position[0], position[1]],
            CAP.with_outliers(2.0e-3),
            |a| glass_picture_water_cap(&read(a), Vec2::from(a.f32s())).to_array().words(),
        ),
        // Straight aside of its middle, where the tail begins.
        FunctionCase::new(
            "glass_picture_water_cap",
            &WATER,
            &[Made(drop_along_x), Fixed(0.0), Uniform(-1.5e-3, 1.5e-3)],
            CAP.with_outliers(2.0e-3),
            |a| glass_picture_water_cap(&read(a), Vec2::from(a.f32s())).to_array().words(),
        ),
        FunctionCase::new(
            "glass_picture_water_away",
            &WATER,
            &[Made(drop), position[0], position[1]],
            Tol::relative(1.0e-5, 1.0e-8, "a quotient (2.5 ulp) of sums of products of differences"),
            |a| glass_picture_water_away(&read(a), Vec2::from(a.f32s())).to_array().words(),
        ),
        FunctionCase::new(
            "glass_picture_water_top",
            &WATER,
            &[Made(drop)],
            Tol::relative(1.0e-5, 1.0e-8, "a root (2.5 ulp) taken off a number of the same size"),
            |a| glass_picture_water_top(&read(a)).words(),
        ),
        FunctionCase::new(
            "glass_picture_water_leave",
            &WATER,
            &[Made(drop), position[0], position[1], Uniform(-0.8, 0.8), Uniform(-0.8, 0.8)],
            Tol::relative(1.0e-3, 2.0e-6, "five turns of regula falsi; a turn may take the other side")
                .with_outliers(1.0e-2),
            |a| {
                let drop = read(a);
                glass_picture_water_leave(&drop, Vec2::from(a.f32s()), Vec2::from(a.f32s())).words()
            },
        ),
        FunctionCase::new(
            "glass_picture_water_normal",
            &WATER,
            &[Uniform(-4.0, 4.0), Uniform(-4.0, 4.0)],
            Tol::relative(1.0e-6, 1.0e-7, "a root and a division (2.5 ulp each)"),
            |a| glass_picture_water_normal(Vec2::from(a.f32s())).to_array().words(),
        ),
        FunctionCase::new(
            "glass_picture_blade_at",
            &BLADE,
            &[Made(wiper), Uniform(-0.2, 1.2)],
            Tol::relative(1.0e-5, 1.0e-6, "a root and a division (2.5 ulp each) of sums of length about 1"),
            |a| {
                let blade = bytemuck::cast::<[f32; 24], GlassPictureBlade>(a.f32s());
                glass_picture_blade_at(&blade, a.f32()).to_array().words()
            },
        ),
        // Close to the ends of the blade and of the arm.
        FunctionCase::new("glass_picture_blade_part", &BLADE, &[Made(near_end)], PART, part),
        // The very outlines of a blade along +x, of which all numbers are exact.
        FunctionCase::new(
            "glass_picture_blade_part",
            &BLADE,
            &[
                [Fixed(0.0); 2].as_slice(),
                &[Fixed(0.25), Fixed(0.5)],
                &[Fixed(0.0); 20],
                &[Fixed(1.0), Fixed(0.0)],
                &[
                    OneOf(&[-0.001, 0.0, 0.1, 0.25, 0.2505, 0.375, 0.5, 0.503]),
                    OneOf(&[
                        0.0,
                        0.001,
                        GLASS_PICTURE_LIP,
                        0.005,
                        GLASS_PICTURE_HOLDER,
                        -GLASS_PICTURE_ARM,
                        0.02,
                    ]),
                ],
            ]
            .concat(),
            PART,
            part,
        ),
        FunctionCase::new(
            "glass_picture_blade_part",
            &BLADE,
            &[Made(wiper), Fixed(0.6), Fixed(-0.8), Uniform(0.2, 0.4), Uniform(0.1, 0.4)],
            PART.with_outliers(2.0e-3),
            part,
        ),
        FunctionCase::new(
            "glass_picture_light_lobe",
            &LIGHT,
            &[Uniform(0.0, 0.02), Uniform(0.02, 0.2)],
            Tol::relative(1.0e-5, 2.0e-4, "quotients (2.5 ulp) taken off 1, then up to 1600 of them"),
            |a| glass_picture_light_lobe(a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "glass_picture_light_seen",
            &LIGHT,
            &[
                Made(lamp),
                Uniform(-0.3, 0.3),
                Uniform(-0.3, 0.3),
                Uniform(-0.6, -0.4),
                Made(towards),
                Uniform(0.02, 0.2),
            ],
            Tol::relative(
                1.0e-4,
                2.0e-3,
                "a root and quotients (2.5 ulp); the squared distance is a difference",
            ),
            |a| {
                let light = bytemuck::cast::<[f32; 8], GlassPictureLight>(a.f32s());
                let (from_eye, direction) = (Vec3::from(a.f32s()), Vec3::from(a.f32s()));
                glass_picture_light_seen(&light, from_eye, direction, a.f32()).to_array().words()
            },
        ),
        FunctionCase::new(
            "glass_picture_spline",
            &GLASS_PICTURE,
            &[Uniform(-0.5, 0.5), Made(|random| vec![random[0] % 3])],
            Tol::relative(1.0e-6, 1.0e-7, "products that may be fused with sums"),
            |a| {
                let t = a.f32();
                glass_picture_spline(t, a.u32() as i32).to_array().words()
            },
        ),
    ]
}

/// A pane after some seconds of rain.
fn pane(keys: &str) -> GlassPicture {
    let text = format!(
        "[rain]\nrate_mm_h = 200\n[camera]\nposition_m = [0, 1.5, 0]\nfov_deg = 12\n[output]\nsize = [93, 62]\n[glass]\n{keys}"
    );
    let weather = Weather::parse("w.toml", &text).expect("a weather");
    let sky = SkyMap::uniform([1.0; 3]);
    // Straight ahead, a little above: drops show it.
    let sun =
        Some(Sun { direction: [0.0, 0.1, -0.995], irradiance_rgb: [3.0, 2.0, 1.0], angular_radius: 4.65e-3 });
    let loaded = Loaded {
        scene: Scene::default(),
        animations: Vec::new(),
        moving: Vec::new(),
        sky,
        sun,
        unscaled: None,
        masks: Vec::new(),
        drop_model: None,
        warnings: Vec::new(),
    };
    let frame_scene = FrameScene::new(&weather, &loaded, 0.0).expect("a frame's scene");
    let mut pane = WetPane::new(&weather, &frame_scene.viewpoint, 0.0).expect("a lattice").expect("a pane");
    pane.advance(0.0).expect("time");
    let frame = RenderFrame::new(&frame_scene.data, &frame_scene.viewpoint, SIZE, 1, 0, 0).expect("a frame");
    let texels = (4 * CAPTURE * CAPTURE - 1) / 3;
    let lighting = SceneView { data: &frame_scene.data, frame: &frame };
    pane.picture(&frame_scene.viewpoint, &frame.camera, frame.grid, &lighting, texels as usize, 0.1)
        .expect("a picture")
}

/// Smooth light of some colors, at distances of 1 to 30 m.
fn light(k: u32, width: u32) -> [f32; 4] {
    let (x, y) = ((k % width) as f32 / width as f32, (k / width) as f32 / width as f32);
    [1.0 + x, 1.0 + y * y, 2.0 - x * y, 1.0 + 29.0 * x]
}

fn case(gpu: &Gpu, keys: &str) -> Result<Run, GpuError> {
    let glass = kept(keys, || pane(keys));
    assert!(glass.drops.len() > 30, "{} drops", glass.drops.len());
    assert_eq!(glass.frame.lights, 1);
    let plate: Vec<_> = (0..SIZE[0] * SIZE[1]).map(|k| light(k, SIZE[0])).collect();
    // Rain as dense as drops and streaks are in places.
    let rain: Vec<_> = (0..SIZE[0] * SIZE[1])
        .map(|k| rng_draw([3, 4], k, 0, 0).map(rng_unit))
        .map(|[a, b, c, d]| [0.4 * a, 0.4 * b, 0.4 * c, 0.6 + 0.4 * d])
        .collect();
    let behind: Vec<_> = plate.iter().zip(&rain).map(|(&plate, &rain)| compose_pixel(plate, rain)).collect();
    let mut capture = Vec::new();
    let mut size = CAPTURE;
    while size > 0 {
        capture.extend((0..size * size).map(|k| light(k, size)));
        size /= 2;
    }
    let words = |pixels: Vec<[f32; 3]>| pixels.into_iter().flatten().map(f32::to_bits).collect();
    let cpu = kept(&format!("{keys} through"), || glass.through(&behind, &capture));
    let [plate, rain] = [gpu.storage_buffer("plate", &plate)?, gpu.storage_buffer("rain", &rain)?];
    let environment = gpu.storage_buffer("environment map", &capture)?;
    let seen =
        BehindGlass { plate: &plate, rain: &rain, environment: EnvironmentMap::OnDevice(&environment) };
    let renderer = GlassRenderer::new(gpu)?;
    let first = renderer.through(&glass, &seen)?;
    let buffers = renderer.buffers_made();
    let made = renderer.through(&glass, &seen)?;
    assert!(
        made == first && renderer.buffers_made() == buffers,
        "a like picture takes the buffers of the one before"
    );
    Ok(Run {
        arguments: (0..SIZE[0] * SIZE[1])
            .map(|i| [i % SIZE[0], i / SIZE[0]].map(|c| (c as f32).to_bits()).to_vec())
            .collect(),
        cpu: Cpu(words(cpu.to_vec())),
        gpu: FromGpu(words(made)),
        kinds: vec![WordKind::Float; 3],
    })
}

/// Kernels that make what stands behind the pane.
static BEFORE: &[&Kernel] = &[&COMPOSE_KERNEL, &PYRAMID_KERNEL];

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let case = |name, run| {
        KernelCase {
        name,
        kernel: &GLASS_PICTURE_KERNEL,
        with: BEFORE,
        overrides: &[],
        text: None,
        tol: Tol::relative(
            2.0e-3,
            2.0e-3,
            "sums over samples; one at a drop's outline or at the rim of total reflection may fall on either side",
        )
        .with_outliers(1.0e-2),
        run,
    }
    };
    vec![
        case("main_glass_picture: a window, the scene in focus", |gpu| {
            self::case(
                gpu,
                "before_s = 8\naperture_mm = 2\ninterior_ambient = 0.3\nfilm_um = 30\nspeed_m_s = 6",
            )
        }),
        case("main_glass_picture: a windshield, the glass in focus", |gpu| {
            self::case(
                gpu,
                "before_s = 6\nfocus = 'glass'\ntilt_deg = 35\nspeed_m_s = 12\nadvancing_deg = 100\nfresnel = \
                 'tatarchuk-2006'\nsize_m = [0.2, 0.15]\n[[glass.wiper]]\npivot_m = [0.1, 0.16]\nlength_m = \
                 0.14\nfrom_deg = 20\nto_deg = 160\nperiod_s = 1.3",
            )
        }),
    ]
}
