//! Step on the CPU: bare, with wind and with a map; a view compared with a box.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use downpour_bvh::Bvh;
use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_sim::collision::{CollisionMap, CollisionOptions};
use downpour_sim::simulation::{SimVolume, Simulation, SimulationOptions, StepInput};
use downpour_sim::view::View;
use downpour_wind::{WindField, WindGrid, WindMask, WindPrimitive, WindUniform};
use glam::{DVec3, Vec3};

fn rain() -> DropSizeDistribution {
    DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 25.0).expect("a rain")
}

fn floor() -> CollisionMap {
    let [a, b, c, d] = [[-30.0, 0.0, -30.0], [-30.0, 0.0, 30.0], [30.0, 0.0, 30.0], [30.0, 0.0, -30.0]];
    let options = CollisionOptions::default();
    CollisionMap::new(&options, &Bvh::new(&[[a, b, c], [a, c, d]])).expect("a map")
}

fn field() -> WindField {
    let grid = WindGrid::new(Vec3::splat(-25.0), Vec3::splat(25.0), [64; 3]).expect("a grid");
    let wind = WindPrimitive::Uniform(WindUniform { speed: 4.0, direction: Vec3::X });
    WindField::new(&grid, &[wind], &WindMask::open(&grid)).expect("a field")
}

fn step(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step");
    let (map, field) = (floor(), field());
    let view = View { eye: DVec3::new(0.0, 2.0, 0.0), ..View::default() };
    let boxed = SimVolume::Box { size_m: [20.0; 3] };
    for (name, volume, windy, walls) in [
        ("bare box", boxed, false, false),
        ("bare view", SimVolume::View, false, false),
        ("box in wind", boxed, true, false),
        ("box in wind with map", boxed, true, true),
        ("view in wind with map", SimVolume::View, true, true),
    ] {
        let input = StepInput {
            field: windy.then_some(&field),
            map: walls.then_some(&map),
            ..StepInput::new(&view, DVec3::ZERO, Vec3::X)
        };
        let options = SimulationOptions { volume, max_drops: 200_000, ..SimulationOptions::default() };
        let mut simulation = Simulation::new(&rain(), &options, &input).expect("a simulation");
        let count = simulation.drops().len() as u64;
        group.throughput(Throughput::Elements(count));
        group.bench_function(BenchmarkId::new(name, count), |bencher| {
            bencher.iter(|| simulation.advance(1.0 / 60.0, &input).expect("a step"));
        });
    }
    group.finish();
}

criterion_group!(benches, step);
criterion_main!(benches);
