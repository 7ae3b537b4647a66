//! Ticks per second of a pane in heavy rain, on the CPU and on a GPU.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use downpour_lattice::glass::{Glass, GlassOptions, GlassRain};

fn options(size: u32) -> GlassOptions {
    let rain = GlassRain { rate_mm_h: 25.0, towards_m_s: 5.0, ..GlassRain::default() };
    GlassOptions { size: [size; 2], rain, ..GlassOptions::default() }
}

fn cpu(c: &mut Criterion) {
    let mut group = c.benchmark_group("glass, ticks on the CPU");
    group.sample_size(10);
    for size in [256, 1024] {
        let mut glass = Glass::new(&options(size)).expect("a pane");
        // A pane that is wet, as after some time.
        for _ in 0..10 {
            glass.step(1.0).expect("a second");
        }
        let tick = glass.tick_s();
        group.throughput(Throughput::Elements(64));
        group.bench_function(BenchmarkId::from_parameter(size), |b| b.iter(|| glass.step(64.0 * tick)));
    }
    group.finish();
}

#[cfg(feature = "wgpu")]
fn gpu(c: &mut Criterion) {
    use downpour_gpu::{AdapterChoice, Gpu};
    use downpour_lattice::gpu::glass::GpuGlass;
    let gpu = Gpu::open(&AdapterChoice::Auto).expect("an adapter");
    let mut group = c.benchmark_group(format!("glass, ticks on {}", gpu.adapter().name));
    group.sample_size(10);
    for size in [256, 1024] {
        let mut glass = GpuGlass::new(&gpu, &options(size)).expect("a pane");
        for _ in 0..10 {
            glass.step(1.0).expect("a second");
        }
        let tick = glass.tick_s();
        group.throughput(Throughput::Elements(64));
        group.bench_function(BenchmarkId::from_parameter(size), |b| {
            b.iter(|| {
                glass.step(64.0 * tick).expect("a step");
                gpu.wait().expect("a device that answers");
            });
        });
    }
    group.finish();
}

#[cfg(not(feature = "wgpu"))]
fn gpu(_: &mut Criterion) {}

criterion_group!(benches, cpu, gpu);
criterion_main!(benches);
