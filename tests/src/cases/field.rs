//! `shaders/wgsl/sim/{field,shelter,shelter_hit,splash}.wgsl` against `downpour_sim::field`, `shelter` and `impacts`.

use std::collections::{BTreeMap, BTreeSet};

use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_drop::splash::{FILM_M, SplashLaw};
use downpour_gpu::{BufferPool, Gpu, GpuError};
use downpour_math::rng::rng_pcg4d;
use downpour_render::camera::Viewpoint;
use downpour_render::gpu::LightingOnGpu;
use downpour_shaders::Kernel;
use downpour_shaders::render::scene::{SCENE_DOUBLE_SIDED, SCENE_MASKED};
use downpour_shaders::sim::field::{
    DRIFT, EYE_DROP, FIELD, FIELD_CLEAR_KERNEL, FIELD_FIND_KERNEL, FIELD_NORMAL_STEPS, FIELD_SPLASH,
    SHELTER_AMONG_HOLES_KERNEL, SHELTER_KERNEL,
};
use downpour_shaders::sim::splash::{SPLASH, SPLASH_FIND_KERNEL};
use downpour_sim::field::chain::{
    FieldTime, field_between, field_difference, field_fallen, field_fraction, field_moved, field_part,
};
use downpour_sim::field::thinning::{field_interval, field_is_below, field_less};
use downpour_sim::field::{
    EyeDrop, FallingDrop, RainField, drift_position, eye_drop_normal, eye_drop_outside, eye_drop_standing,
    eye_drop_turned,
};
use downpour_sim::gpu::{FieldPipeline, FieldSearch, GpuSimError, HolesOnGpu, ObstaclesOnGpu};
use downpour_sim::impacts::SplashOptions;
use downpour_sim::impacts::splash_frame::{splash_middle, splash_parameter, splash_surplus};
use downpour_sim::shelter::{Holes, Obstacles};
use downpour_sim::view::View;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::gpu::ScenePipeline;
use downpour_trace::material::{MaterialLook, TextureUse};
use downpour_trace::sky_light::SkyLight;
use downpour_wind::{Gusts, Keyed, UniformWind, Wind, WindPart};
use glam::{Affine3A, DVec3, Vec3};

use crate::Domain::{AnyWord, Below, Made, Or, Uniform, Unit3};
use crate::compare::{Cpu, Gpu as FromGpu};
use crate::function::Run;
use crate::signature::WordKind;
use crate::words::IntoWords as _;
use crate::{FunctionCase, KernelCase, Tol};

/// A number below 2^30.
fn number(random: [u32; 4]) -> Vec<u32> {
    vec![random[0] >> (2 + random[1] % 24)]
}

/// A time up to a million seconds.
fn time(random: [u32; 4]) -> Vec<u32> {
    vec![random[0] % 1_000_001, random[1], random[2] % 2]
}

/// A number of three words near 0.
fn three(random: [u32; 4]) -> Vec<u32> {
    [random[0], random[1], random[2]].map(|word| (word % 5).wrapping_sub(2)).to_vec()
}

/// Bits by which a rate is shifted.
fn shift(random: [u32; 4]) -> Vec<u32> {
    vec![1 + random[0] % 31]
}

/// A number of two words near 0.
fn near(random: [u32; 4]) -> Vec<u32> {
    vec![(random[0] % 5).wrapping_sub(2), random[1] % 3]
}

/// A normal of a splash as its speed; some are none.
fn standing(random: [u32; 4]) -> Vec<u32> {
    let width = 2 * FIELD_NORMAL_STEPS + 1;
    let speed =
        if random[1].is_multiple_of(16) { 3.0 } else { FIELD_SPLASH - (random[0] % (width * width)) as f32 };
    vec![speed.to_bits()]
}

/// The cases.
#[must_use]
pub(super) fn functions() -> Vec<FunctionCase> {
    let exact = Tol::exact("integers throughout");
    let axis = [Uniform(-2.0, 2.0), Uniform(-2.0, 2.0), Uniform(-2.0, 2.0)];
    vec![
        FunctionCase::new(
            "eye_drop_turned",
            &EYE_DROP,
            &[Unit3, axis[0], axis[1], axis[2]],
            Tol::absolute(4.0e-3, "sines and cosines (2^-11) of up to 3.5 radians, three terms"),
            |a| eye_drop_turned(Vec3::from(a.f32s()), Vec3::from(a.f32s())).to_array().words(),
        ),
        FunctionCase::new(
            "eye_drop_standing",
            &EYE_DROP,
            &[Unit3],
            Tol::exact("whole numbers, of quotients (2.5 ulp) at whose half another one begins")
                .with_outliers(4.0e-3),
            |a| eye_drop_standing(Vec3::from(a.f32s())).words(),
        ),
        FunctionCase::new(
            "eye_drop_normal",
            &EYE_DROP,
            &[Made(standing)],
            Tol::absolute(2.0e-6, "quotients (2.5 ulp) of at most 1, sums of two and a root of three"),
            |a| eye_drop_normal(a.f32()).to_array().words(),
        ),
        FunctionCase::new(
            "drift_position",
            &DRIFT,
            &[Uniform(-1.0, 14.0)],
            Tol::absolute(
                2.0e-5,
                "products with an entry's distance, up to 64, of which the CPU has more digits",
            )
            .with_outliers(1.0e-4),
            |a| {
                let (lower, fraction) = drift_position(a.f32().into());
                [lower as f32, fraction as f32].words()
            },
        ),
        FunctionCase::new(
            "eye_drop_outside",
            &EYE_DROP,
            &[Or(&Uniform(-1.0, 1.0), &[0.0]), Or(&Uniform(-1.0, 1.0), &[0.0]), Uniform(0.0, 0.05)],
            Tol::absolute(
                1.0e-6,
                "a quotient of at most 1, of which a GPU has 2.5 units in the last place, times 0.05 s",
            ),
            |a| {
                let [begin, end, half_time] = a.f32s();
                eye_drop_outside(begin, end, half_time).words()
            },
        ),
        FunctionCase::new("field_part", &FIELD, &[AnyWord, Below(1 << 16)], exact, |a| {
            field_part(a.u32(), a.u32()).words()
        }),
        FunctionCase::new(
            "field_between",
            &FIELD,
            &[Made(number), Made(number), Below(1 << 16)],
            exact,
            |a| field_between(a.u32(), a.u32(), a.u32()).words(),
        ),
        FunctionCase::new("field_fraction", &FIELD, &[AnyWord], exact, |a| field_fraction(a.u32()).words()),
        FunctionCase::new("field_fallen", &FIELD, &[AnyWord, Made(time)], exact, |a| {
            let rate = a.u32();
            let [seconds, fraction, is_before] = a.u32s();
            field_fallen(rate, FieldTime { seconds, fraction, is_before }).words()
        }),
        FunctionCase::new("field_moved", &FIELD, &[AnyWord, Made(shift), Made(time)], exact, |a| {
            let (rate, shift) = (a.u32(), a.u32());
            let [seconds, fraction, is_before] = a.u32s();
            field_moved(rate, shift, FieldTime { seconds, fraction, is_before }).words()
        }),
        FunctionCase::new("field_difference", &FIELD, &[Made(three), Made(three)], exact, |a| {
            field_difference(a.u32s(), a.u32s()).words()
        }),
        FunctionCase::new("field_product", &FIELD, &[AnyWord, AnyWord], exact, |a| {
            let product = u64::from(a.u32()) * u64::from(a.u32());
            [product as u32, (product >> 32) as u32].words()
        }),
        FunctionCase::new("field_less", &FIELD, &[AnyWord, AnyWord, AnyWord, AnyWord], exact, |a| {
            field_less(a.u32s(), a.u32s()).words()
        }),
        FunctionCase::new("field_is_below", &FIELD, &[Made(near), Made(near)], exact, |a| {
            u32::from(field_is_below(a.u32s(), a.u32s())).words()
        }),
        FunctionCase::new(
            "splash_parameter",
            &SPLASH,
            &[Uniform(1.0e5, 1.0e7), Uniform(1.0e-4, 6.0e-3), Uniform(0.1, 12.0)],
            Tol::relative(4.0e-6, 0.0, "four square roots and three products"),
            |a| splash_parameter(a.f32(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "splash_surplus",
            &SPLASH,
            &[Uniform(0.0, 90.0)],
            Tol::absolute(1.0e-6, "a quotient and its square below 1"),
            |a| splash_surplus(a.f32()).words(),
        ),
        FunctionCase::new(
            "splash_middle",
            &SPLASH,
            &[Uniform(0.0, 1.2)],
            Tol::absolute(1.0e-6, "a few products below 1"),
            |a| splash_middle(a.f32()).words(),
        ),
        FunctionCase::new("field_interval", &FIELD, &[Made(number), Made(number)], exact, |a| {
            field_interval(a.u32(), a.u32()).words()
        }),
    ]
}

fn uniform(speed: &Keyed<f64>, gusts: Option<Gusts>) -> UniformWind {
    let part = WindPart::uniform(speed, &DVec3::new(1.0, 0.1, 0.4).into()).expect("in range");
    Wind::new(vec![part], gusts, None).expect("in range").uniform().expect("in range")
}

/// A roof, and a step that drops meet while the shutter is open; with holes in the roof if they are wanted.
fn obstacles(has_holes: bool) -> SceneData {
    let mut builder = SceneBuilder::new();
    // Holes of half a meter, one texel each.
    let alpha = |k: u32| if rng_pcg4d([k, 3, 5, 7])[0] & 1 == 0 { 255 } else { 0 };
    let texels: Vec<[u8; 4]> = (0..64).map(|k| [255, 255, 255, alpha(k)]).collect();
    let leaves = builder.texture(8, 8, &texels, TextureUse::Color);
    let leaves = builder.add_slot(leaves);
    let looks = [
        MaterialLook::default(),
        MaterialLook {
            flags: SCENE_MASKED | SCENE_DOUBLE_SIDED,
            maps: [Some(leaves), None, None, None, None, None, None, None],
            ..MaterialLook::default()
        },
    ];
    let [solid, leaves] = looks.map(|look| builder.add_material(look));
    let mut quad = |height: f32, [left, right]: [f32; 2], [far, near]: [f32; 2], material: u32| {
        let corner = |x, z| [x, height, z];
        let positions = [corner(left, far), corner(right, far), corner(right, near), corner(left, near)];
        let part = MeshPart {
            uvs: [Some(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), None],
            ..MeshPart::plain(&positions, &[0, 1, 2, 0, 2, 3], material)
        };
        builder.add_mesh(&part, &Affine3A::IDENTITY);
    };
    let roof = if has_holes { leaves } else { solid };
    quad(3.0, [-2.0, 2.0], [-6.0, -2.0], roof);
    if has_holes {
        // Two on a path.
        quad(2.6, [-2.5, 1.5], [-5.5, -1.5], leaves);
    }
    quad(0.9, [-6.0, 6.0], [-9.0, 0.0], solid);
    builder.build(&SkyLight::uniform([1.0; 3]))
}

/// A pane half a meter before the eye.
const PANE: [f32; 4] = [0.0, 0.6, -0.8, 0.5];

/// Drops that are known before the search.
fn known() -> [EyeDrop; 3] {
    [1, 2, 3].map(|id| EyeDrop { diameter: 1.0e-3, id, offset: [0.0, 0.0, -2.0], ..EyeDrop::default() })
}

/// What is special about a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kind {
    pub(super) wind: fn() -> UniformWind,
    pub(super) time_s: f64,
    pub(super) shutter_s: f64,
    pub(super) far: bool,
    pub(super) has_holes: bool,
    pub(super) pane: Option<[f32; 4]>,
    /// The rate changes.
    pub(super) changes: bool,
}

pub(super) fn kind(wind: fn() -> UniformWind, time_s: f64, shutter_s: f64) -> Kind {
    Kind { wind, time_s, shutter_s, far: false, has_holes: false, pane: None, changes: false }
}

/// Drops of a picture, as the CPU and the device find them.
struct Found {
    /// On the CPU, those that obstacles have stopped as well, and whether they are open.
    all: Vec<(EyeDrop, bool)>,
    /// On the CPU, those that are open.
    open: Vec<EyeDrop>,
    /// On the device, by id and diameter: ids of 32 bits are those of several drops now and then.
    gpu: BTreeMap<(u32, u32), EyeDrop>,
}

fn key(drop: &EyeDrop) -> (u32, u32) {
    (drop.id, drop.diameter.to_bits())
}

/// A rain before a scene.
pub(super) struct Setting {
    pub(super) field: RainField,
    pub(super) view: View,
    pub(super) scene: SceneData,
    pub(super) origin: DVec3,
}

pub(super) fn setting(kind: Kind) -> Setting {
    let sizes = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 60.0).expect("a rain");
    let field = if kind.changes {
        let rates = Keyed::new(vec![(-4.0, 60.0), (7.0, 60.0), (8.0, 0.0), (9.0, 25.0), (1.0e6, 60.0)]);
        RainField::changing(&sizes, &rates.expect("in range"), 2.0, 12)
    } else {
        RainField::new(&sizes, 12)
    };
    let field = field.expect("a field").with_wind((kind.wind)());
    let origin = if kind.far { DVec3::new(51_234.5, 20.0, -987_654.25) } else { DVec3::ZERO };
    let view = View {
        eye: origin + DVec3::new(0.3, 1.5, 3.0),
        far: 14.0,
        shutter_s: kind.shutter_s,
        velocity: DVec3::new(0.4, 0.0, -3.0),
        turning: DVec3::new(0.1, 0.8, 0.0),
        ..View::default()
    };
    let scene = obstacles(kind.has_holes);
    Setting { field, view, scene, origin }
}

/// A scene on the device.
pub(super) fn uploaded(gpu: &Gpu, scene: &SceneData) -> Result<LightingOnGpu, GpuError> {
    let viewpoint = Viewpoint { eye: Vec3::ZERO, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 0.9 };
    let frame = RenderFrame::new(scene, &viewpoint, [8, 8], 1, 0, 0).expect("a frame");
    ScenePipeline::new(gpu)?.upload(scene)?.lighting(gpu, &frame)
}

/// What stops drops in it.
pub(super) fn obstacles_on<'a>(
    lighting: &'a LightingOnGpu,
    scene: &SceneData,
    has_holes: bool,
    origin: DVec3,
) -> ObstaclesOnGpu<'a> {
    let [_, nodes, triangles, corners, table, texels] = &lighting.buffers;
    let bounds = scene.bounding_box();
    let holes = has_holes.then_some(HolesOnGpu { corners, table, texels });
    ObstaclesOnGpu { nodes, triangles, holes, bounds, origin }
}

fn found(gpu: &Gpu, kind: Kind) -> Result<Found, GpuError> {
    let Setting { field, view, scene, origin } = setting(kind);
    let holes = kind.has_holes.then_some(&scene as &dyn Holes);
    let on_cpu = Obstacles { nodes: &scene.nodes, triangles: &scene.triangles, holes, origin };
    let outside = |drop: &FallingDrop| match kind.pane {
        Some([x, y, z, distance]) => drop.beyond(Vec3::new(x, y, z), distance, &view),
        None => Some(*drop),
    };
    let listed = |drops: Vec<FallingDrop>| -> Vec<EyeDrop> {
        drops.iter().filter_map(outside).map(|drop| EyeDrop::new(&drop, view.eye)).collect()
    };
    let all = listed(field.visible(&view, kind.time_s).expect("in range").drops);
    let open = listed(field.visible_among(&on_cpu, &view, kind.time_s).expect("in range").drops);
    let ids: BTreeSet<(u32, u32)> = open.iter().map(key).collect();
    let lighting = uploaded(gpu, &scene)?;
    let obstacles = obstacles_on(&lighting, &scene, kind.has_holes, origin);
    let pipeline = FieldPipeline::new(gpu)?;
    let mut on_gpu = pipeline.upload(&field)?;
    let of_gpu = |error| match error {
        GpuSimError::Gpu(error) => error,
        other => panic!("{other}"),
    };
    // What a picture with more drops leaves in the same buffers must not show.
    let (pool, most) = (BufferPool::new(gpu), 1 << 20);
    let more = View { far: 16.0, velocity: DVec3::ZERO, ..view };
    let search = FieldSearch {
        view: &more,
        time_s: kind.time_s + 0.3,
        max_room: most,
        pane: None,
        known: &[],
        drips: None,
        splashes: None,
        bounce: None,
    };
    let before = pipeline.prepare(&pool, (&field, &mut on_gpu), &obstacles, &search).map_err(of_gpu)?;
    gpu.submit(&before.dispatches())?;
    pool.begin_frame();
    let known = known();
    let search = FieldSearch {
        view: &view,
        time_s: kind.time_s,
        max_room: most,
        pane: kind.pane,
        known: &known,
        drips: None,
        splashes: None,
        bounce: None,
    };
    let pass = pipeline.prepare(&pool, (&field, &mut on_gpu), &obstacles, &search).map_err(of_gpu)?;
    gpu.submit(&pass.dispatches())?;
    let (mut drops, [found, tried]) = pass.read()?;
    assert_eq!(drops[..3], known, "known drops stay where they are");
    drops.drain(..3);
    assert!(
        found >= drops.len() as u32
            && found <= pass.list().room()
            && pass.list().places() == pass.list().room() + 3
            && tried > found,
        "{found} of {tried}"
    );
    assert!(open.len() > 3000 && drops.len() > 3000, "{} drops", drops.len());
    Ok(Found {
        all: all.into_iter().map(|drop| (drop, ids.contains(&key(&drop)))).collect(),
        open,
        gpu: drops.iter().map(|drop| (key(drop), *drop)).collect(),
    })
}

pub(super) fn run(words: usize, cpu: Vec<u32>, gpu: Vec<u32>) -> Run {
    Run {
        arguments: (0..(cpu.len() / words) as u32).map(|k| vec![k]).collect(),
        cpu: Cpu(cpu),
        gpu: FromGpu(gpu),
        kinds: vec![WordKind::Float],
    }
}

/// The open drops of both sides.
fn case(gpu: &Gpu, kind: Kind) -> Result<Run, GpuError> {
    let Found { open, gpu: mut others, .. } = found(gpu, kind)?;
    let words = |drop: &EyeDrop| {
        let [x, y, z] = drop.offset;
        let [u, v, w] = drop.velocity;
        [1.0, x, y, z, u, v, w, drop.diameter * 1.0e3].map(f32::to_bits)
    };
    let nothing = [0.0f32; 8].map(f32::to_bits);
    let (mut cpu, mut gpu_words) = (Vec::new(), Vec::new());
    for drop in &open {
        cpu.extend(words(drop));
        gpu_words.extend(others.remove(&key(drop)).as_ref().map_or(nothing, words));
    }
    // What only the device has.
    for drop in others.values() {
        cpu.extend(nothing);
        gpu_words.extend(words(drop));
    }
    Ok(run(8, cpu, gpu_words))
}

/// Whether drops that the CPU finds stopped are stopped, and an equal number of others that are not.
fn stopped_case(gpu: &Gpu, kind: Kind) -> Result<Run, GpuError> {
    let Found { all, gpu, .. } = found(gpu, kind)?;
    let stopped: Vec<&EyeDrop> = all.iter().filter(|(_, open)| !open).map(|(drop, _)| drop).collect();
    assert!(stopped.len() > 1000, "{} drops are stopped", stopped.len());
    // Below the roofs' height, where there is something to be decided.
    let low = all.iter().filter(|(drop, open)| *open && drop.offset[1] < 1.5).map(|(drop, _)| drop);
    let chosen: Vec<&EyeDrop> = stopped.iter().copied().zip(low).flat_map(|(a, b)| [a, b]).collect();
    assert!(chosen.len() > 2000, "{} drops", chosen.len());
    let open: BTreeSet<(u32, u32)> =
        all.iter().filter(|(_, open)| *open).map(|(drop, _)| key(drop)).collect();
    let flag = |is: bool| f32::from(u8::from(is)).to_bits();
    let cpu = chosen.iter().map(|drop| flag(open.contains(&key(drop)))).collect();
    let found = chosen.iter().map(|drop| flag(gpu.contains_key(&key(drop)))).collect();
    Ok(run(1, cpu, found))
}

/// When drops are stopped while the shutter is open, ms.
fn landing_case(gpu: &Gpu, kind: Kind) -> Result<Run, GpuError> {
    let Found { open, gpu, .. } = found(gpu, kind)?;
    let time = |drop: &EyeDrop| if drop.present[1] > 1.0e3 { 1.0e3 } else { 1.0e3 * drop.present[1] };
    let both = |drop: &EyeDrop| gpu.get(&key(drop)).map(|other| [time(drop), time(other)]);
    let lands = |times: &[f32; 2]| times.iter().any(|&at| at < 1.0e3);
    let times: Vec<[f32; 2]> = open.iter().filter_map(both).filter(lands).collect();
    assert!(times.len() > 30, "{} drops land", times.len());
    let side = |k: usize| times.iter().map(|pair| pair[k].to_bits()).collect();
    Ok(run(1, side(0), side(1)))
}

/// Crowns of splashes on the floor and on the roof, as both sides list them.
fn crowns_case(gpu: &Gpu, kind: Kind) -> Result<Run, GpuError> {
    let Setting { field, view, scene, origin } = setting(kind);
    // A crown of three pixels is as far away as the picture shows.
    let view = View { pixel_angle: 4.0e-4, ..view };
    let options = SplashOptions { law: SplashLaw::new(FILM_M, 20.0).expect("a law"), size: 1.5 };
    let holes = kind.has_holes.then_some(&scene as &dyn Holes);
    let on_cpu = Obstacles { nodes: &scene.nodes, triangles: &scene.triangles, holes, origin };
    let [x, y, z, distance] = kind.pane.unwrap_or_default();
    let is_outside = |drop: &EyeDrop| Vec3::new(x, y, z).dot(drop.offset.into()) >= distance;
    let crowns = field.splashes(&on_cpu, &view, kind.time_s, &options).expect("in range");
    let expected: Vec<EyeDrop> =
        crowns.iter().map(|drop| EyeDrop::new(drop, view.eye)).filter(is_outside).collect();
    assert!(expected.len() > 300, "{} crowns", expected.len());
    let search = FieldSearch {
        view: &view,
        time_s: kind.time_s,
        max_room: 1 << 20,
        pane: kind.pane,
        known: &[],
        drips: None,
        splashes: Some(&options),
        bounce: None,
    };
    let (mut drops, _) = listed_by(gpu, &field, (&scene, kind.has_holes, origin), &search)?;
    drops.retain(|drop| drop.speed <= FIELD_SPLASH);
    Ok(paired(&expected, &drops, crown_words))
}

/// Words of a crown, for a comparison in meters and seconds.
pub(super) fn crown_words(drop: &EyeDrop) -> [u32; 7] {
    let [x, y, z] = drop.offset;
    let [begin, end] = drop.present;
    [1.0, x, y, z, drop.diameter * 10.0, begin, end].map(f32::to_bits)
}

/// The drops that the device lists for a search, and the least size in pixels that is listed.
pub(super) fn listed_by(
    gpu: &Gpu,
    field: &RainField,
    (scene, has_holes, origin): (&SceneData, bool, DVec3),
    search: &FieldSearch<'_>,
) -> Result<(Vec<EyeDrop>, f64), GpuError> {
    let lighting = uploaded(gpu, scene)?;
    let obstacles = obstacles_on(&lighting, scene, has_holes, origin);
    let pipeline = FieldPipeline::new(gpu)?;
    let mut on_gpu = pipeline.upload(field)?;
    let pool = BufferPool::new(gpu);
    let pass = pipeline.prepare(&pool, (field, &mut on_gpu), &obstacles, search);
    let pass = pass.map_err(|error| match error {
        GpuSimError::Gpu(error) => error,
        other => panic!("{other}"),
    })?;
    gpu.submit(&pass.dispatches())?;
    let (drops, [found, _]) = pass.read()?;
    assert!(found <= pass.list().room(), "{found} have no room");
    Ok((drops, pass.resolved().least_pixels))
}

/// Words of a drop that moves, for a comparison in meters and seconds, with the times of its presence as `finite` has them.
pub(super) fn moving_words(drop: &EyeDrop, finite: impl Fn(f32) -> f32) -> [u32; 10] {
    let [x, y, z] = drop.offset;
    // In 20 m/s: what it is off matters while the shutter is open.
    let [u, v, w] = drop.velocity.map(|speed| speed * 0.05);
    let [begin, end] = drop.present.map(finite);
    [1.0, x, y, z, u, v, w, drop.diameter * 10.0, begin, end].map(f32::to_bits)
}

/// Drops by their ids, and in order of time where several have one: a drop that hangs and then falls.
fn numbered(drops: &[EyeDrop]) -> BTreeMap<(u32, u32, u32), EyeDrop> {
    let mut sorted: Vec<&EyeDrop> = drops.iter().collect();
    sorted.sort_by(|a, b| a.present[0].total_cmp(&b.present[0]));
    let mut numbers: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    let mut next = |drop: &EyeDrop| {
        let number = numbers.entry((drop.id, drop.id_low)).or_default();
        *number += 1;
        (drop.id, drop.id_low, *number)
    };
    sorted.into_iter().map(|drop| (next(drop), *drop)).collect()
}

/// Drops of both sides by their ids, as words; 0 where one side has none.
pub(super) fn paired<const N: usize>(
    expected: &[EyeDrop],
    found: &[EyeDrop],
    words: impl Fn(&EyeDrop) -> [u32; N],
) -> Run {
    let mut others = numbered(found);
    let (mut cpu, mut gpu) = (Vec::new(), Vec::new());
    for (key, drop) in numbered(expected) {
        cpu.extend(words(&drop));
        gpu.extend(others.remove(&key).as_ref().map_or([0; N], &words));
    }
    // What only the device has.
    for drop in others.values() {
        cpu.extend([0; N]);
        gpu.extend(words(drop));
    }
    run(N, cpu, gpu)
}

pub(super) fn steady() -> UniformWind {
    uniform(&Keyed::from(6.0), None)
}

pub(super) fn gusty() -> UniformWind {
    let speed = Keyed::new(vec![(0.0, 3.0), (4.0, 9.0), (20.0, 6.0)]).expect("in range");
    uniform(&speed, Some(Gusts::default()))
}

pub(super) fn still() -> UniformWind {
    uniform(&Keyed::from(0.0), None)
}

/// The cases.
#[must_use]
pub(super) fn kernels() -> Vec<KernelCase> {
    const OTHERS: &[&Kernel] = &[&FIELD_CLEAR_KERNEL, &SHELTER_KERNEL];
    const OF_CROWNS: &[&Kernel] = &[&FIELD_CLEAR_KERNEL, &FIELD_FIND_KERNEL, &SHELTER_KERNEL];
    let of = |name, run| KernelCase {
        name,
        kernel: &FIELD_FIND_KERNEL,
        with: OTHERS,
        overrides: &[],
        text: None,
        // The same drops, but for those at the edge of the picture, of what is resolved, or of an obstacle.
        tol: Tol::absolute(6.0e-5, "meters: f32 up to 14 m, and a drift up to 100 m; drops at an edge")
            .with_outliers(1.0e-4),
        run,
    };
    let among = |kernel, name, run| {
        let tol =
            Tol::absolute(0.02, "flags, and ms of drops that meet a plane; paths at an edge may differ");
        KernelCase::new(name, kernel, tol.with_outliers(4.0e-3), run)
    };
    let crowns = |name, wander: f64, run: fn(&Gpu) -> Result<Run, GpuError>| {
        let tol = Tol::absolute(wander, "meters and seconds; crowns at an edge, and at the ends of slices");
        KernelCase {
            with: OF_CROWNS,
            ..KernelCase::new(name, &SPLASH_FIND_KERNEL, tol.with_outliers(6.0e-3), run)
        }
    };
    let shelter = |name, run| among(&SHELTER_KERNEL, name, run);
    let leaves = |name, run| among(&SHELTER_AMONG_HOLES_KERNEL, name, run);
    vec![
        of("main_field_find: steady wind", |gpu| case(gpu, kind(steady, 7.125, 1.0 / 60.0))),
        of("main_field_find: gusts", |gpu| case(gpu, kind(gusty, 11.3, 1.0 / 60.0))),
        of("main_field_find: frozen, far away and late", |gpu| {
            case(gpu, Kind { far: true, ..kind(still, 987_654.321, 0.0) })
        }),
        of("main_field_find: a rate that falls to none and rises", |gpu| {
            case(gpu, Kind { changes: true, ..kind(steady, 7.6, 1.0 / 60.0) })
        }),
        of("main_field_find: before time 0", |gpu| case(gpu, Kind { far: true, ..kind(steady, -3.4, 0.02) })),
        shelter("main_shelter: steady wind", |gpu| {
            stopped_case(gpu, Kind { far: true, ..kind(steady, 7.125, 1.0 / 60.0) })
        }),
        shelter("main_shelter: gusts", |gpu| stopped_case(gpu, kind(gusty, 11.3, 1.0 / 60.0))),
        shelter("main_shelter: landing", |gpu| landing_case(gpu, kind(gusty, 11.3, 0.1))),
        of("main_field_find: behind a pane", |gpu| {
            case(gpu, Kind { pane: Some(PANE), ..kind(gusty, 11.3, 1.0 / 60.0) })
        }),
        leaves("main_shelter: holes, steady wind", |gpu| {
            stopped_case(gpu, Kind { far: true, has_holes: true, ..kind(steady, 7.125, 1.0 / 60.0) })
        }),
        leaves("main_shelter: holes, gusts", |gpu| {
            stopped_case(gpu, Kind { has_holes: true, ..kind(gusty, 11.3, 1.0 / 60.0) })
        }),
        leaves("main_shelter: holes, landing", |gpu| {
            landing_case(gpu, Kind { has_holes: true, ..kind(gusty, 11.3, 0.1) })
        }),
        crowns("main_splash_find: steady wind", 1.0e-4, |gpu| {
            crowns_case(gpu, Kind { far: true, ..kind(steady, 7.125, 1.0 / 60.0) })
        }),
        // Paths are straight in other spans of time.
        crowns("main_splash_find: gusts", 4.0e-3, |gpu| crowns_case(gpu, kind(gusty, 11.3, 1.0 / 60.0))),
        crowns("main_splash_find: holes, behind a pane", 1.0e-4, |gpu| {
            let pane = Some([0.0, 0.6, -0.8, 0.5]);
            crowns_case(gpu, Kind { has_holes: true, pane, ..kind(steady, 3.3, 1.0 / 60.0) })
        }),
    ]
}
