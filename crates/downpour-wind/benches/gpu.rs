//! Time of a GPU for the field of 64 x 64 x 64 cells with 64 primitives: by the device's clock (wall clock on software
//! drivers, whose timestamps are meaningless).

use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use downpour_gpu::{AdapterChoice, Gpu};
use downpour_wind::gpu::GpuWindField;
use downpour_wind::{
    Turbulence, WindCore, WindForm, WindGrid, WindPrimitive, WindSingularity, WindTurbulenceMode,
};
use glam::{DVec3, Vec3};

fn field(c: &mut Criterion) {
    let gpu = Gpu::open(&AdapterChoice::Auto).expect("an adapter");
    let software = gpu.adapter().is_software();
    let grid = WindGrid::new(Vec3::splat(-50.0), Vec3::splat(50.0), [64; 3]).expect("a grid");
    let vortex = WindPrimitive::Vortex(WindSingularity {
        form: WindForm::Line,
        strength: 50.0,
        center: Vec3::ZERO,
        axis: Vec3::new(0.1, 1.0, 0.2),
        core_radius: 4.0,
        core: WindCore::Rosenhead,
    });
    let waves = Turbulence::default().modes(&grid, DVec3::ZERO);
    let field = GpuWindField::new(&gpu, &grid, 64, waves.len()).expect("a field");
    let mut group = c.benchmark_group(format!("field of 64^3 cells on {}", gpu.adapter().name));
    group.sample_size(10);
    let cases: [(&str, usize, &[WindTurbulenceMode]); 2] =
        [("64 vortices", 64, &[]), ("turbulence", 0, &waves)];
    for (name, count, modes) in cases {
        let primitives = vec![vortex; count];
        group.bench_function(name, |b| {
            b.iter_custom(|iterations| {
                let repeats = u32::try_from(iterations.min(1000)).unwrap_or(1000);
                let time = field.time(&primitives, modes, repeats).expect("a timed field");
                let one = time.device.filter(|_| !software).unwrap_or(time.wall);
                Duration::from_secs_f64(one.as_secs_f64() * iterations as f64)
            });
        });
    }
    group.finish();
}

criterion_group!(benches, field);
criterion_main!(benches);
