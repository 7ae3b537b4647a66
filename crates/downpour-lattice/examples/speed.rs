//! Speed of both lattices, on a GPU and on the CPU, as tables; the last one has the ratios.
//!
//! ```sh
//! cargo run --release -p downpour-lattice --features wgpu --example speed
//! cargo run --release -p downpour-lattice --features wgpu --example speed -- 256 1024 NAME_OF_ADAPTER
//! ```
//!
//! Numbers are the sizes of the puddles, by default 256, 1024 and 4096 cells; a word is part of an adapter's name.
//!
//! `naive` is the naive membrane: one invocation per cell, one step per dispatch. `copy` reads and writes the memory
//! of a puddle's state. Times are the device's if it has timestamps, else the host's; each is the shortest of three.

use std::error::Error;
use std::time::{Duration, Instant};

use downpour_gpu::timing::PassTime;
use downpour_gpu::{AdapterChoice, ComputeKernel, Gpu, wgpu};
use downpour_lattice::glass::{Glass, GlassOptions, GlassRain};
use downpour_lattice::gpu::glass::GpuGlass;
use downpour_lattice::gpu::puddle::GpuPuddle;
use downpour_lattice::puddle::{Puddle, PuddleForm, PuddleOptions, PuddleStorage};

/// Two copies of the heights, neighbors clamped at the border.
const NAIVE: &str = include_str!("../benches/naive.wgsl");

const COPY: &str = "
@group(0) @binding(0) var<storage, read> from_state: array<vec4u>;
@group(0) @binding(1) var<storage, read_write> to_state: array<vec4u>;

@compute @workgroup_size(256)
fn main_copy(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let at = id.x + id.y * groups.x * 256u;
    if at < arrayLength(&from_state) {
        to_state[at] = from_state[at];
    }
}
";

/// Approximate duration of a measurement.
const SPELL: Duration = Duration::from_millis(250);

/// Number of measurements, of which the shortest counts.
const TURNS: u32 = 3;

type Failed = Box<dyn Error>;

fn options(size: u32, membrane: bool) -> PuddleOptions {
    let form = if membrane { PuddleForm::Membrane { speed_m_s: 0.3 } } else { PuddleForm::GravityCapillary };
    PuddleOptions { size: [size, size], form, ..PuddleOptions::default() }
}

/// Shortest mean time of one of many repetitions; `once` takes the number of repetitions and returns the mean.
fn shortest(mut once: impl FnMut(u32) -> Result<Duration, Failed>) -> Result<f64, Failed> {
    let first = once(2)?.max(Duration::from_nanos(100));
    if first > SPELL {
        return Ok(first.as_secs_f64());
    }
    let repeats = (SPELL.as_secs_f64() / first.as_secs_f64()).clamp(2.0, 2000.0) as u32;
    let mut best = f64::INFINITY;
    for _ in 0..TURNS {
        best = best.min(once(repeats)?.as_secs_f64());
    }
    Ok(best)
}

/// Time by the device's clock; the timestamps of software drivers are meaningless.
fn of_device(gpu: &Gpu, time: PassTime) -> Duration {
    time.device.filter(|_| !gpu.adapter().is_software()).unwrap_or(time.wall)
}

fn pair(gpu: &Gpu, kernel: &ComputeKernel, bytes: u64, groups: [u32; 3]) -> Result<f64, Failed> {
    let state = || gpu.empty_buffer("state", bytes, wgpu::BufferUsages::STORAGE);
    let (a, b) = (state()?, state()?);
    let bindings = [kernel.bind(gpu, &[&a, &b])?, kernel.bind(gpu, &[&b, &a])?];
    let both = [kernel.dispatch(&bindings[0], groups), kernel.dispatch(&bindings[1], groups)];
    shortest(|repeats| Ok(of_device(gpu, gpu.time(&both, repeats.div_ceil(2))?) / 2))
}

fn naive(gpu: &Gpu, size: u32) -> Result<f64, Failed> {
    let kernel = ComputeKernel::from_source(gpu, "main_naive", NAIVE, &[("SIZE", f64::from(size))])?;
    pair(gpu, &kernel, 4 * u64::from(size).pow(2), [size.div_ceil(16), size.div_ceil(16), 1])
}

fn copy(gpu: &Gpu, size: u32, bytes_per_cell: u64) -> Result<f64, Failed> {
    let kernel = ComputeKernel::from_source(gpu, "main_copy", COPY, &[])?;
    let bytes = bytes_per_cell * u64::from(size).pow(2);
    let groups = (bytes / 16).div_ceil(256);
    let across = groups.min(4096);
    pair(gpu, &kernel, bytes, [across as u32, groups.div_ceil(across) as u32, 1])
}

/// Seconds of a dispatch with at most so many steps, and the number of steps.
fn tiles(gpu: &Gpu, options: &PuddleOptions, steps: u32) -> Result<(f64, u32), Failed> {
    let mut puddle = GpuPuddle::new(gpu, options)?;
    let steps = steps.min(puddle.steps_per_sweep());
    let time = shortest(|repeats| {
        Ok(of_device(gpu, puddle.time_sweep(1.0e-3, steps, repeats.next_multiple_of(2))?))
    })?;
    Ok((time, steps))
}

/// Seconds of a step.
fn on_cpu(options: &PuddleOptions) -> Result<f64, Failed> {
    let mut puddle = Puddle::new(options)?;
    let dt = 23.99 * puddle.max_step_s() as f32;
    let time = shortest(|repeats| {
        let begin = Instant::now();
        for _ in 0..repeats {
            puddle.step(dt)?;
        }
        Ok(begin.elapsed() / repeats)
    })?;
    Ok(time / 24.0)
}

fn line(name: &str, size: u32, steps: u32, seconds_of_step: f64) {
    let rate = f64::from(size) * f64::from(size) / seconds_of_step * 1.0e-9;
    println!("| {name} | {size} | {steps} | {:.2} | {rate:.3} |", seconds_of_step * 1.0e6);
}

fn puddles(gpu: &Gpu, sizes: &[u32], ratios: &mut Vec<(String, f64)>) -> Result<(), Failed> {
    println!("| puddle | cells across | steps per dispatch | us per step | 10^9 cell steps/s |");
    println!("|---|---|---|---|---|");
    for &size in sizes {
        let naive_s = naive(gpu, size)?;
        line("membrane, naive", size, 1, naive_s);
        let copied = copy(gpu, size, 8)?;
        line("copy of the state", size, 1, copied);
        for (name, membrane) in [("membrane", true), ("water", false)] {
            let options = options(size, membrane);
            let mut one = 0.0;
            for asked in [1, 2, 4, 8] {
                let (time, steps) = tiles(gpu, &options, asked)?;
                if steps < asked && asked > 4 {
                    continue;
                }
                let step = time / f64::from(steps);
                line(&format!("{name}, tiles"), size, steps, step);
                if asked == 1 {
                    one = step;
                    ratios
                        .push((format!("{name} {size}: bandwidth of a step, of the copy's"), copied / time));
                } else {
                    ratios.push((format!("{name} {size}: {steps} steps per dispatch, of one"), one / step));
                }
            }
            let cpu = on_cpu(&options)?;
            line(&format!("{name}, CPU"), size, 1, cpu);
            if membrane {
                ratios.push((format!("{name} {size}: CPU, of naive"), naive_s / cpu));
            }
        }
        let half = PuddleOptions { storage: PuddleStorage::Half, ..options(size, true) };
        let (time, steps) = tiles(gpu, &half, 8)?;
        line("membrane in 16 bits, tiles", size, steps, time / f64::from(steps));
        line("membrane in 16 bits, CPU", size, 1, on_cpu(&half)?);
    }
    Ok(())
}

fn panes(gpu: &Gpu) -> Result<(), Failed> {
    println!("\n| glass | cells across | us per tick | ticks/s |\n|---|---|---|---|");
    let tell = |name: &str, size: u32, seconds: f64| {
        println!("| {name} | {size} | {:.1} | {:.0} |", seconds * 1.0e6, 1.0 / seconds);
    };
    for size in [256, 1024] {
        let rain = GlassRain { rate_mm_h: 25.0, towards_m_s: 5.0, ..GlassRain::default() };
        let options = GlassOptions { size: [size; 2], rain, ..GlassOptions::default() };
        let mut glass = GpuGlass::new(gpu, &options)?;
        // Wet, as after some time.
        let tick = glass.tick_s();
        glass.step(10.0)?;
        gpu.wait()?;
        let time = shortest(|repeats| {
            let begin = Instant::now();
            glass.step(f64::from(repeats) * 16.0 * tick)?;
            gpu.wait()?;
            Ok(begin.elapsed() / repeats)
        })?;
        tell("GPU", size, time / 16.0);
        for threads in [1, 2, 16] {
            if threads > std::thread::available_parallelism()?.get() {
                continue;
            }
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
            let time: Result<f64, String> = pool.install(|| {
                let mut glass = Glass::new(&options).map_err(|error| error.to_string())?;
                glass.step(10.0).map_err(|error| error.to_string())?;
                shortest(|repeats| {
                    let begin = Instant::now();
                    glass.step(f64::from(repeats) * 4.0 * tick)?;
                    Ok(begin.elapsed() / repeats)
                })
                .map_err(|error| error.to_string())
            });
            tell(&format!("CPU, {threads} threads"), size, time? / 4.0);
        }
    }
    Ok(())
}

fn main() -> Result<(), Failed> {
    let mut sizes = Vec::new();
    let mut adapter = AdapterChoice::Auto;
    for argument in std::env::args().skip(1) {
        match argument.parse() {
            Ok(size) => sizes.push(size),
            Err(_) => adapter = AdapterChoice::Named(argument),
        }
    }
    if sizes.is_empty() {
        sizes = vec![256, 1024, 4096];
    }
    let gpu = Gpu::open(&adapter)?;
    println!("{}, {} threads\n", gpu.adapter().name, std::thread::available_parallelism()?);
    let mut ratios = Vec::new();
    puddles(&gpu, &sizes, &mut ratios)?;
    panes(&gpu)?;
    println!("\n| ratio | times |\n|---|---|");
    for (name, ratio) in ratios {
        println!("| {name} | {ratio:.2} |");
    }
    Ok(())
}
