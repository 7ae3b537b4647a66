//! Cell steps per second: the CPU's sweep, the GPU's tiles with one and with many steps per dispatch, and a naive
//! shader with one invocation per cell and one step per dispatch.

use std::time::Duration;

use criterion::{
    BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main, measurement::WallTime,
};
use downpour_gpu::timing::PassTime;
use downpour_gpu::{AdapterChoice, ComputeKernel, Gpu, wgpu};
use downpour_lattice::gpu::puddle::GpuPuddle;
use downpour_lattice::puddle::{Puddle, PuddleForm, PuddleOptions, PuddleStorage};

/// Naive membrane: two copies of the heights, neighbors clamped at the border.
const NAIVE: &str = include_str!("naive.wgsl");

fn options(size: u32, membrane: bool) -> PuddleOptions {
    let form = if membrane { PuddleForm::Membrane { speed_m_s: 0.3 } } else { PuddleForm::GravityCapillary };
    PuddleOptions { size: [size, size], form, ..PuddleOptions::default() }
}

fn duration(time: PassTime, software: bool, iterations: u64) -> Duration {
    // The timestamps of software drivers are meaningless.
    let one = time.device.filter(|_| !software).unwrap_or(time.wall);
    Duration::from_secs_f64(one.as_secs_f64() * iterations as f64)
}

fn naive(group: &mut BenchmarkGroup<'_, WallTime>, gpu: &Gpu, size: u32) {
    let cells = u64::from(size) * u64::from(size);
    let kernel =
        ComputeKernel::from_source(gpu, "main_naive", NAIVE, &[("SIZE", f64::from(size))]).expect("a kernel");
    let state = || gpu.empty_buffer("heights", 4 * cells, wgpu::BufferUsages::STORAGE).expect("a buffer");
    let (a, b) = (state(), state());
    let bindings = [&[&a, &b], &[&b, &a]].map(|buffers| kernel.bind(gpu, buffers).expect("bindings"));
    let groups = [size.div_ceil(16), size.div_ceil(16), 1];
    let pair = [kernel.dispatch(&bindings[0], groups), kernel.dispatch(&bindings[1], groups)];
    group.throughput(Throughput::Elements(cells));
    group.bench_function(format!("membrane {size}, naive WGSL, one step"), |b| {
        b.iter_custom(|iterations| {
            let repeats = u32::try_from(iterations.clamp(1, 400)).unwrap_or(400);
            let time = gpu.time(&pair, repeats).expect("a timed pass");
            let half = PassTime { device: time.device.map(|t| t / 2), wall: time.wall / 2 };
            duration(half, gpu.adapter().is_software(), iterations)
        });
    });
}

fn tiles(
    group: &mut BenchmarkGroup<'_, WallTime>,
    gpu: &Gpu,
    options: &PuddleOptions,
    name: &str,
    steps: u32,
) {
    let mut puddle = GpuPuddle::new(gpu, options).expect("a puddle");
    let cells = u64::from(options.size[0]) * u64::from(options.size[1]);
    group.throughput(Throughput::Elements(cells * u64::from(steps)));
    group.bench_function(format!("{name} {}, tiles, {steps} steps", options.size[0]), |b| {
        b.iter_custom(|iterations| {
            let repeats = u32::try_from(iterations.clamp(2, 400)).unwrap_or(400);
            let time = puddle.time_sweep(1.0e-3, steps, repeats).expect("a timed pass");
            duration(time, gpu.adapter().is_software(), iterations)
        });
    });
}

fn cpu(group: &mut BenchmarkGroup<'_, WallTime>, options: &PuddleOptions, name: &str) {
    let mut puddle = Puddle::new(options).expect("a puddle");
    let dt = 7.99 * puddle.max_step_s() as f32;
    let cells = u64::from(options.size[0]) * u64::from(options.size[1]);
    group.throughput(Throughput::Elements(cells * 8));
    group.bench_function(format!("{name} {}, CPU, 8 steps", options.size[0]), |b| {
        b.iter(|| puddle.step(dt).expect("a step"));
    });
}

fn puddles(c: &mut Criterion) {
    let gpu = Gpu::open(&AdapterChoice::Auto).expect("an adapter");
    let mut group = c.benchmark_group(format!("puddle, {}", gpu.adapter().name));
    group.sample_size(10);
    for size in [256, 1024, 4096] {
        let (membrane, water) = (options(size, true), options(size, false));
        naive(&mut group, &gpu, size);
        tiles(&mut group, &gpu, &membrane, "membrane", 1);
        tiles(&mut group, &gpu, &membrane, "membrane", 8);
        cpu(&mut group, &membrane, "membrane");
        tiles(&mut group, &gpu, &water, "water", 1);
        tiles(&mut group, &gpu, &water, "water", 2);
        cpu(&mut group, &water, "water");
        let half = PuddleOptions { storage: PuddleStorage::Half, ..membrane };
        tiles(&mut group, &gpu, &half, "membrane in 16 bits", 8);
        cpu(&mut group, &half, "membrane in 16 bits");
    }
    group.finish();
}

criterion_group!(benches, puddles);
criterion_main!(benches);
