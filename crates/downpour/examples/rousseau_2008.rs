//! Speed of the animation of drops on a GPU: the step against a copy of the same memory, and table 1 of Rousseau 2008.
//!
//! ```sh
//! cargo run --release -p downpour --features wgpu --example rousseau_2008
//! ```
//!
//! `bare` has neither wind field nor map; `wind` has the field; `full` has both, with wrap, bounces and events. Bytes of a step: 32 read and 32
//! written for each drop, as the copy does.

use std::error::Error;

use downpour::drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour::gpu::{AdapterChoice, ComputeKernel, Gpu, GpuOptions, LimitSet};
use downpour::sim::collision::{CollisionMap, CollisionOptions};
use downpour::sim::gpu::{CollisionMapOnGpu, GpuSimulation, GpuStepInput};
use downpour::sim::simulation::{SimVolume, SimulationOptions, StepInput};
use downpour::sim::view::View;
use downpour::wind::gpu::GpuWindField;
use downpour::wind::{
    WindCore, WindField, WindForm, WindGrid, WindMask, WindPrimitive, WindSingularity, WindUniform,
};
use glam::{DVec3, Vec3};

/// Reads and writes as much as a step.
const COPY: &str = "
@group(0) @binding(0) var<storage, read_write> places: array<vec4u>;
@group(0) @binding(1) var<storage, read_write> motions: array<vec4u>;
@compute @workgroup_size(256)
fn main_copy(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let slot = id.x + id.y * groups.x * 256u;
    if slot < arrayLength(&places) {
        places[slot] += vec4u(0u, 0u, 0u, 1u);
        motions[slot] += vec4u(0u, 0u, 0u, 1u);
    }
}
";

fn field() -> Result<WindField, Box<dyn Error>> {
    let grid = WindGrid::new(Vec3::splat(-50.0), Vec3::splat(50.0), [64; 3])?;
    let wind = [
        WindPrimitive::Uniform(WindUniform { speed: 4.0, direction: Vec3::X }),
        WindPrimitive::Vortex(WindSingularity {
            strength: 200.0,
            center: Vec3::ZERO,
            axis: Vec3::Y,
            core_radius: 5.0,
            form: WindForm::Line,
            core: WindCore::Rosenhead,
        }),
    ];
    Ok(WindField::new(&grid, &wind, &WindMask::open(&grid))?)
}

/// A floor of 100 m with a lattice of boxes on it.
fn map() -> Result<CollisionMap, Box<dyn Error>> {
    let mut corners = Vec::new();
    let mut level = |x: [f32; 2], z: [f32; 2], y: f32| {
        let at = |i: usize, j: usize| [x[i], y, z[j]];
        corners.push([at(0, 0), at(0, 1), at(1, 1)]);
        corners.push([at(0, 0), at(1, 1), at(1, 0)]);
    };
    level([-50.0, 50.0], [-50.0, 50.0], -10.0);
    for k in 0..100u8 {
        let (x, z) = (f32::from(k % 10) * 10.0 - 48.0, f32::from(k / 10) * 10.0 - 48.0);
        level([x, x + 4.0], [z, z + 4.0], f32::from(k % 7) - 4.0);
    }
    let low = Vec3::new(-50.0, -11.0, -50.0);
    let options =
        CollisionOptions::covering(low, Vec3::splat(50.0), Vec3::new(0.5, -1.0, 0.0), [1024, 1024])?;
    Ok(CollisionMap::new(&options, &downpour::bvh::Bvh::new(&corners))?)
}

/// The field of 64 primitives in 64^3 cells, on the CPU and on the GPU.
fn wind_speed(gpu: &Gpu) -> Result<(), Box<dyn Error>> {
    let grid = WindGrid::new(Vec3::splat(-50.0), Vec3::splat(50.0), [64; 3])?;
    let primitives: Vec<WindPrimitive> = (0..64u8)
        .map(|k| {
            let at = WindSingularity {
                strength: 20.0,
                center: Vec3::new(f32::from(k % 8), 1.0, f32::from(k / 8)) * 10.0 - 35.0,
                axis: Vec3::Y,
                core_radius: 4.0,
                form: WindForm::Line,
                core: WindCore::Rosenhead,
            };
            if k % 2 == 0 { WindPrimitive::Vortex(at) } else { WindPrimitive::Source(at) }
        })
        .collect();
    let open = WindMask::open(&grid);
    let start = std::time::Instant::now();
    let field = WindField::new(&grid, &primitives, &open)?;
    let cpu_ms = start.elapsed().as_secs_f64() * 1.0e3;
    let on_gpu = GpuWindField::new(gpu, &grid, field.matrices().len(), 0)?;
    let time = on_gpu.time(&primitives, &[], if gpu.adapter().is_software() { 3 } else { 100 })?;
    let gpu_ms = if gpu.adapter().is_software() { time.wall } else { time.device.unwrap_or(time.wall) };
    let threads = std::thread::available_parallelism()?;
    println!(
        "64^3 cells, 64 primitives: CPU ({threads} threads) {cpu_ms:.1} ms, GPU {:.3} ms",
        gpu_ms.as_secs_f64() * 1.0e3
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let options =
        GpuOptions { adapter: AdapterChoice::Auto, limits: LimitSet::Adapter, ..GpuOptions::default() };
    let gpu = Gpu::open_with(&options)?;
    println!("{}", gpu.adapter().name);
    let (field, map) = (field()?, map()?);
    let cells = gpu.storage_buffer("cells", field.cells())?;
    let on_gpu = CollisionMapOnGpu::upload(&gpu, &map)?;
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 100.0)?;
    // As fine as it takes for as many drops as are asked for.
    let view = View { eye: DVec3::new(0.0, 2.0, 0.0), least_pixels: 1.0e-3, ..View::default() };
    let eye = view.eye.as_vec3();
    let start = StepInput {
        field: Some(&field),
        map: Some(&map),
        ..StepInput::new(&view, DVec3::ZERO, field.sample(eye))
    };
    let bare = GpuStepInput::new(&view, DVec3::ZERO, field.sample(eye));
    let spread = field.spread(eye, view.far as f32);
    let windy = GpuStepInput { field: Some((field.uniform(), &cells)), spread, ..bare };
    let full = GpuStepInput { map: Some(&on_gpu), ..windy };
    let boxed = SimVolume::Box { size_m: [60.0; 3] };
    let software = gpu.adapter().is_software();
    println!(
        "drops | volume | copy ms | bare ms | wind ms | full ms | bare / copy | full / copy | bare GB/s"
    );
    for most in if software { [1 << 16, 1 << 18, 1 << 20] } else { [1 << 20, 1 << 22, 1 << 24] } {
        for (name, volume) in [("box", boxed), ("view", SimVolume::View)] {
            let options = SimulationOptions { volume, max_drops: most, ..SimulationOptions::default() };
            let mut simulation = GpuSimulation::new(&gpu, &rain, &options, &start)?;
            let count = simulation.count();
            let words = vec![[0u32; 4]; count.min(1 << 22) as usize];
            let copy = ComputeKernel::from_source(&gpu, "main_copy", COPY, &[])?;
            let pieces = (count as f64 / words.len() as f64).ceil() as usize;
            let buffers = (0..pieces)
                .map(|_| Ok((gpu.storage_buffer("a", &words)?, gpu.storage_buffer("b", &words)?)))
                .collect::<Result<Vec<_>, downpour::gpu::GpuError>>()?;
            let bound =
                buffers.iter().map(|(a, b)| copy.bind(&gpu, &[a, b])).collect::<Result<Vec<_>, _>>()?;
            let groups = (words.len() as u32).div_ceil(256);
            let copies: Vec<_> = bound
                .iter()
                .map(|b| copy.dispatch(b, [groups.min(4096), groups.div_ceil(4096), 1]))
                .collect();
            let copied = (pieces * words.len()) as f64;
            let repeats = if software { 3 } else { 50 };
            let ms = |time: downpour::gpu::timing::PassTime| {
                let best = if software { time.wall } else { time.device.unwrap_or(time.wall) };
                best.as_secs_f64() * 1.0e3
            };
            // Interleaved; the median of the rounds' ratios.
            let mut rounds = Vec::new();
            for _ in 0..7 {
                let copy_ms = ms(gpu.time(&copies, repeats)?) * count as f64 / copied;
                let bare_ms = ms(simulation.time(1.0 / 60.0, &bare, repeats)?);
                let wind_ms = ms(simulation.time(1.0 / 60.0, &windy, repeats)?);
                let full_ms = ms(simulation.time(1.0 / 60.0, &full, repeats)?);
                rounds.push([copy_ms, bare_ms, wind_ms, full_ms, copy_ms / bare_ms, copy_ms / full_ms]);
            }
            let median = |k: usize| {
                let mut all: Vec<f64> = rounds.iter().map(|round| round[k]).collect();
                all.sort_by(f64::total_cmp);
                all[all.len() / 2]
            };
            let [copy, bare, wind, full, share, whole] = std::array::from_fn(median);
            let rate = 64.0e-6 * count as f64 / bare;
            println!(
                "{count} | {name} | {copy:.3} | {bare:.3} | {wind:.3} | {full:.3} | {:.0} % | {:.0} % | {rate:.0}",
                100.0 * share,
                100.0 * whole
            );
        }
    }
    wind_speed(&gpu)?;
    println!("Rousseau 2008, table 1, first column: steps per second of a box, with wind and map");
    for most in [1, 5_000, 10_000, 20_000, 40_000, 100_000, 1_000_000] {
        let options = SimulationOptions { volume: boxed, max_drops: most, ..SimulationOptions::default() };
        let mut simulation = GpuSimulation::new(&gpu, &rain, &options, &start)?;
        let time = simulation.time(1.0 / 60.0, &full, if software { 3 } else { 100 })?;
        let ms = if software { time.wall } else { time.device.unwrap_or(time.wall) }.as_secs_f64() * 1.0e3;
        println!("{} drops: {ms:.3} ms, {:.0} per second", simulation.count(), 1.0e3 / ms);
    }
    Ok(())
}
