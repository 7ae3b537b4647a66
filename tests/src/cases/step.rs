//! `shaders/wgsl/sim/{motion,volume,step}.wgsl` against `downpour-sim`.

use downpour_bvh::Bvh;
use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_gpu::{Gpu, GpuError};
use downpour_math::rng::rng_unit;
use downpour_shaders::sim::step::{MOTION, STEP, STEP_KERNEL, VOLUME};
use downpour_sim::collision::{CollisionMap, CollisionOptions};
use downpour_sim::gpu::{GpuCollisionMap, GpuMoment, GpuSimError, GpuSimulation};
use downpour_sim::motion::{
    motion_average, motion_bounce, motion_diameter, motion_relax, motion_settled, motion_table_entry,
    motion_table_speed,
};
use downpour_sim::simulation::{
    Bounce, Drag, Gauge, Happened, Moment, SimVolume, Simulation, SimulationOptions,
};
use downpour_sim::step::{StepDrop, step_measure, step_shown};
use downpour_sim::view::View;
use downpour_sim::volume::{
    VolumeBack, VolumeEye, volume_back, volume_in_area, volume_in_sphere, volume_in_view, volume_local,
    volume_offset, volume_on_disc, volume_wrap,
};
use downpour_wind::{
    WindCore, WindField, WindForm, WindGrid, WindMask, WindPrimitive, WindSingularity, WindUniform,
};
use glam::{DVec3, Vec2, Vec3};

use crate::Domain::{Below, Made, Uniform, Unit3};
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

fn eye(args: &mut Args<'_>) -> VolumeEye {
    let place = args.f32s();
    let half_width = args.f32();
    let right = args.f32s();
    let half_height = args.f32();
    let up = args.f32s();
    let unused_1 = args.u32();
    let forward = args.f32s();
    VolumeEye { place, half_width, right, half_height, up, unused_1, forward, unused_2: args.u32() }
}

/// The words of a `VolumeBack`: a turn of up to half a radian, and a sum.
fn back_words(random: [u32; 4]) -> Vec<u32> {
    let angle = rng_unit(random[0]) - 0.5;
    let (s, c) = (downpour_math::ops::sin(angle), downpour_math::ops::cos(angle));
    let turn = [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]];
    let sum = turn.map(|column| column.map(|x| x * 7.0));
    (turn, sum).words()
}

fn back(args: &mut Args<'_>) -> VolumeBack {
    let mut columns = || {
        std::array::from_fn(|_| {
            let [x, y, z] = args.f32s();
            [x, y, z, 0.0]
        })
    };
    VolumeBack { turn: columns(), sum: columns() }
}

const MOTIONS: Tol =
    Tol::absolute(3.0e-5, "an exponential (3 ulp and more), products and sums of numbers up to 20");

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    let (velocity, wind) = (Uniform(-10.0, 10.0), Uniform(-10.0, 10.0));
    let diameter = Uniform(1.0e-4, 9.0e-3);
    let share = Uniform(0.0, 1.0);
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
            &[Uniform(0.0, 9.0), Uniform(0.0, 9.0), diameter],
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
            &[velocity, velocity, velocity, Unit3, share, share],
            MOTIONS,
            |a| motion_bounce(vec3(a), vec3(a), a.f32(), a.f32()).to_array().words(),
        ),
        FunctionCase::new(
            "volume_wrap",
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
            Tol::absolute(
                3.0e-5,
                "a quotient, its whole part and a product up to 60; on a face it may go either way",
            )
            .with_outliers(1.0e-3),
            |a| volume_wrap(vec3(a), vec3(a), vec3(a)).to_array().words(),
        ),
        FunctionCase::new("volume_local", &VOLUME, &[Made(eye_words), near, near, near], MOTIONS, |a| {
            volume_local(&eye(a), vec3(a)).to_array().words()
        }),
        FunctionCase::new("volume_offset", &VOLUME, &[Made(eye_words), near, near, near], MOTIONS, |a| {
            volume_offset(&eye(a), vec3(a)).to_array().words()
        }),
        FunctionCase::new(
            "volume_in_view",
            &VOLUME,
            &[Made(eye_words), near, near, near, Uniform(2.0, 9.0)],
            Tol::exact("a choice by comparisons of products that a GPU may fuse").with_outliers(1.0e-3),
            |a| volume_in_view(&eye(a), vec3(a), a.f32()).words(),
        ),
        FunctionCase::new(
            "volume_in_area",
            &VOLUME,
            &[Made(eye_words), near, near, near, Uniform(2.0, 9.0)],
            Tol::exact("a choice by comparisons of products that a GPU may fuse").with_outliers(1.0e-3),
            |a| volume_in_area(&eye(a), vec3(a), a.f32()).words(),
        ),
        FunctionCase::new(
            "volume_back",
            &VOLUME,
            &[Made(back_words), near, near, near, share, share, share],
            MOTIONS,
            |a| volume_back(&back(a), vec3(a), vec3(a)).to_array().words(),
        ),
        FunctionCase::new(
            "volume_in_sphere",
            &VOLUME,
            &[share, share, share, Uniform(2.0, 8.0)],
            sphere,
            |a| volume_in_sphere(vec3(a), a.f32()).to_array().words(),
        ),
        FunctionCase::new("volume_on_disc", &VOLUME, &[share, share], sphere, |a| {
            volume_on_disc(Vec2::new(a.f32(), a.f32())).to_array().words()
        }),
        FunctionCase::new(
            "step_shown",
            &STEP,
            &[Below(3 << 16), share],
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
    ]
}

fn vortex() -> WindField {
    let grid = WindGrid::new(Vec3::splat(-16.0), Vec3::splat(16.0), [16; 3]).expect("a grid");
    let wind = [
        WindPrimitive::Uniform(WindUniform { speed: 3.0, direction: Vec3::X }),
        WindPrimitive::Vortex(WindSingularity {
            form: WindForm::Line,
            strength: 90.0,
            centre: Vec3::new(0.0, 0.0, -3.0),
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

/// What a case runs.
#[derive(Clone, Copy)]
struct Scenario {
    volume: SimVolume,
    drag: Drag,
    windy: bool,
    walls: bool,
}

/// What a step leaves behind on both sides.
struct Both {
    drops: [Vec<StepDrop>; 2],
    happened: [Happened; 2],
}

/// Steps on the CPU, until drops have bounced and are hidden, then one step on both.
fn both(gpu: &Gpu, scenario: Scenario) -> Result<Both, GpuError> {
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 50.0).expect("a rain");
    let middle = view(0).eye;
    let options = SimulationOptions {
        volume: scenario.volume,
        seed: 11,
        most_drops: 6000,
        drag: scenario.drag,
        bounce: Bounce { share: 0.5, ..Bounce::default() },
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
    let start = Moment { view: &first, origin: DVec3::ZERO, wind, field: field.as_ref(), map: map.as_ref() };
    let mut cpu = Simulation::new(&rain, &options, &start).expect("a simulation");
    for step in 1..=20 {
        cpu.advance(1.0 / 60.0, &Moment { view: &view(step), ..start }).expect("a step");
    }
    let mut twin = GpuSimulation::from_cpu(gpu, &cpu)?;
    let last = view(21);
    let happened = cpu.advance(1.0 / 60.0, &Moment { view: &last, ..start }).expect("a step");
    let on_gpu = match &map {
        Some(map) => Some(GpuCollisionMap::from_cpu(gpu, map)?),
        None => None,
    };
    let cells = match &field {
        Some(field) => Some((field, gpu.storage_buffer("cells", field.cells())?)),
        None => None,
    };
    let moment = GpuMoment {
        view: &last,
        origin: DVec3::ZERO,
        wind,
        field: cells.as_ref().map(|(field, cells)| (field.uniform(), cells)),
        map: on_gpu.as_ref(),
    };
    twin.advance(1.0 / 60.0, &moment).map_err(of_gpu)?;
    Ok(Both {
        drops: [cpu.drops().to_vec(), twin.drops().map_err(of_gpu)?],
        happened: [happened, twin.happened().map_err(of_gpu)?],
    })
}

fn of_gpu(error: GpuSimError) -> GpuError {
    match error {
        GpuSimError::Gpu(error) => error,
        error => panic!("{error}"),
    }
}

fn words(drops: &[StepDrop]) -> Vec<u32> {
    drops
        .iter()
        .flat_map(|d| {
            let [x, y, z] = d.place.map(f32::to_bits);
            let [u, v, w] = d.velocity.map(f32::to_bits);
            [x, y, z, d.word, u, v, w, d.seconds.to_bits()]
        })
        .collect()
}

fn step_case(gpu: &Gpu, scenario: Scenario) -> Result<Run, GpuError> {
    let both = both(gpu, scenario)?;
    let [cpu, made] = both.drops.map(|drops| words(&drops));
    let mut kinds = vec![WordKind::Float; 8];
    kinds[3] = WordKind::Integer;
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
            words.extend(event.place.map(|x| (x * 1.0e3).round() as i32 as u32));
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
    "places up to 10 m after an exponential, a lookup of wind and some products; a drop that grazes a face or a surface \
     may be on either side of it",
)
.with_outliers(3.0e-3);

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let case = |name, covers, tol, run| KernelCase { name, kernel: &STEP_KERNEL, covers, tol, run };
    vec![
        case(
            "main_step: a box in a vortex, with a roof",
            &["step_speed", "step_wind", "step_relocate", "collision_find", "collision_open"],
            STEPPED,
            |gpu| step_case(gpu, Scenario { volume: BOX, drag: Drag::Relaxation, windy: true, walls: true }),
        ),
        case(
            "main_step: what happened",
            &["step_note", "step_catch", "step_through"],
            Tol::exact("sorted by drop; places to the millimetre").with_outliers(2.0e-2),
            |gpu| {
                happened_case(gpu, Scenario { volume: BOX, drag: Drag::Relaxation, windy: true, walls: true })
            },
        ),
        case("main_step: a view that turns", &["step_entry"], STEPPED, |gpu| {
            step_case(
                gpu,
                Scenario { volume: SimVolume::View, drag: Drag::Relaxation, windy: false, walls: true },
            )
        }),
        case("main_step: the rain area of Im and Sung", &["step_area"], STEPPED, |gpu| {
            let volume = SimVolume::ImSung;
            step_case(gpu, Scenario { volume, drag: Drag::Relaxation, windy: false, walls: false })
        }),
        case("main_step: a box that drops fall into", &[], STEPPED, |gpu| {
            let volume = SimVolume::Tariq { size_m: [6.0; 3] };
            step_case(gpu, Scenario { volume, drag: Drag::Rousseau2008, windy: true, walls: false })
        }),
        case("main_step: a cylinder", &[], STEPPED, |gpu| {
            let volume = SimVolume::Cylinder { base_m: [0.0, 0.0, 0.0], radius_m: 4.0, height_m: 6.0 };
            step_case(gpu, Scenario { volume, drag: Drag::Relaxation, windy: true, walls: false })
        }),
    ]
}
