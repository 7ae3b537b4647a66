//! Time of an exact mask: the fast path beside the plain loop, in one run.

use criterion::{Criterion, criterion_group, criterion_main};
use downpour_drop::DropShape;
use downpour_mask::{MaskOptions, View, trace_drop, trace_drop_f64, trace_drop_scalar};

fn mask_512(c: &mut Criterion) {
    let mut group = c.benchmark_group("mask 512");
    group.sample_size(20);
    let shape = DropShape::new(2.0e-3).expect("2 mm is a drop");
    let options = MaskOptions::default();
    group.bench_function("fast", |b| b.iter(|| trace_drop(&shape, &options)));
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool of one thread");
    group.bench_function("fast, one thread", |b| b.iter(|| one.install(|| trace_drop(&shape, &options))));
    group.bench_function("plain scalar loop", |b| b.iter(|| trace_drop_scalar(&shape, &options)));
    group.bench_function("f64 reference", |b| b.iter(|| trace_drop_f64(&shape, &options)));
    group.finish();
}

fn tilted(c: &mut Criterion) {
    let mut group = c.benchmark_group("mask 512, 5 mm seen from 20 degrees above");
    group.sample_size(20);
    let shape = DropShape::new(5.0e-3).expect("5 mm is a drop");
    let view = View::from_elevation(20.0f64.to_radians()).expect("20 degrees is an elevation");
    let options = MaskOptions { view, ..MaskOptions::default() };
    group.bench_function("fast", |b| b.iter(|| trace_drop(&shape, &options)));
    group.bench_function("plain scalar loop", |b| b.iter(|| trace_drop_scalar(&shape, &options)));
    group.finish();
}

criterion_group!(benches, mask_512, tilted);
criterion_main!(benches);
