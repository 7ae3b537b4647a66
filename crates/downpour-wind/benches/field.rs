//! Time of a CPU for the field of 64 x 64 x 64 cells with 64 primitives, and for drops in a gusty wind.

use criterion::{Criterion, criterion_group, criterion_main};
use downpour_wind::{
    Gusts, Turbulence, Wind, WindCore, WindField, WindForm, WindGrid, WindMask, WindPart, WindPrimitive,
    WindSingularity, WindUniform,
};
use glam::Vec3;

fn grid() -> WindGrid {
    WindGrid::new(Vec3::splat(-50.0), Vec3::splat(50.0), [64; 3]).expect("a grid")
}

/// Vortices distributed over the box.
fn primitives() -> Vec<WindPrimitive> {
    (0..64u8)
        .map(|k| {
            let at = [k % 4, k / 4 % 4, k / 16].map(|n| 25.0 * f32::from(n) - 37.5);
            WindPrimitive::Vortex(WindSingularity {
                form: WindForm::Line,
                strength: 50.0,
                center: Vec3::from(at),
                axis: Vec3::new(0.1, 1.0, 0.2),
                core_radius: 4.0,
                core: WindCore::Rosenhead,
            })
        })
        .collect()
}

fn field(c: &mut Criterion) {
    let (grid, primitives) = (grid(), primitives());
    let mask = WindMask::open(&grid);
    let mut group = c.benchmark_group("field of 64^3 cells");
    group.sample_size(10);
    group.bench_function("64 vortices", |b| b.iter(|| WindField::new(&grid, &primitives, &mask)));
    let modes = Turbulence::default().modes(&grid, glam::DVec3::ZERO);
    let name = format!("{} waves of turbulence", modes.len());
    group.bench_function(name, |b| b.iter(|| WindField::with_turbulence(&grid, &[], &modes, &mask)));
    group.finish();
}

fn drops(c: &mut Criterion) {
    let mean = WindPrimitive::Uniform(WindUniform { speed: 8.0, direction: Vec3::X });
    let wind = Wind::new(vec![WindPart::from(mean)], Some(Gusts::default()), None).expect("a wind");
    let air = wind.uniform().expect("the same everywhere");
    let mut group = c.benchmark_group("a gusty wind");
    group.bench_function("one time", |b| b.iter(|| air.prepared(12.5)));
    let at = air.prepared(12.5);
    group.bench_function("1000 drops", |b| {
        b.iter(|| (0..1000).map(|k| at.followed(f64::from(k) * 1.0e-3).displacement.x).sum::<f64>());
    });
    group.finish();
}

criterion_group!(benches, field, drops);
criterion_main!(benches);
