//! Time of an exact mask on a GPU: the kernel alone by the device's clock (wall clock on software
//! drivers, whose timestamps mean nothing), and the whole call with its readback, beside the CPU's fast path.

use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use downpour_drop::DropShape;
use downpour_gpu::{AdapterChoice, Gpu};
use downpour_mask::gpu::GpuTracer;
use downpour_mask::{MaskOptions, trace_drop};

fn mask_512(c: &mut Criterion) {
    let gpu = Gpu::open(&AdapterChoice::Auto).expect("an adapter");
    let software = gpu.adapter().is_software();
    let tracer = GpuTracer::new(&gpu).expect("the kernels of the tracer");
    let shape = DropShape::new(2.0e-3).expect("2 mm is a drop");
    let options = MaskOptions::default();
    let mut group = c.benchmark_group(format!("mask 512 on {}", gpu.adapter().name));
    group.sample_size(20);
    group.bench_function("kernel", |b| {
        b.iter_custom(|iterations| {
            let repeats = u32::try_from(iterations.min(1000)).unwrap_or(1000);
            let time = tracer.time_drop(&shape, &options, repeats).expect("a timed mask");
            let one = time.device.filter(|_| !software).unwrap_or(time.wall);
            Duration::from_secs_f64(one.as_secs_f64() * iterations as f64)
        });
    });
    group.bench_function("whole call", |b| b.iter(|| tracer.trace_drop(&shape, &options)));
    group.bench_function("CPU, fast path", |b| b.iter(|| trace_drop(&shape, &options)));
    group.finish();
}

criterion_group!(benches, mask_512);
criterion_main!(benches);
