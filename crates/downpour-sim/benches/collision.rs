//! Time of the CPU to make a collision map, and to query it for a drop.

use criterion::{Criterion, criterion_group, criterion_main};
use downpour_bvh::Bvh;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_sim::collision::{CollisionMap, CollisionOptions};
use glam::Vec3;

/// A hilly ground of 40 x 40 m and 4000 boxes on it: 51 200 triangles.
fn town() -> Bvh {
    let n = 40u32;
    let height = |i: u32, j: u32| rng_unit(rng_draw([1, 2], i, j, 0)[0]);
    let at = |i: u32, j: u32| [i as f32 - 20.0, height(i, j), j as f32 - 20.0];
    let mut all: Vec<[[f32; 3]; 3]> = (0..n * n)
        .flat_map(|k| {
            let (i, j) = (k % n, k / n);
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    for i in 0..4000 {
        let [a, b, c, d] = rng_draw([3, 4], i, 0, 0).map(rng_unit);
        let low = Vec3::new(40.0 * a - 20.0, 0.0, 40.0 * b - 20.0);
        let high = low + Vec3::new(0.2 + 0.5 * c, 1.0 + 4.0 * d, 0.2 + 0.5 * d);
        let corner = |bits: u32| {
            let pick = |k: usize| if bits >> k & 1 == 1 { high[k] } else { low[k] };
            [pick(0), pick(1), pick(2)]
        };
        for face in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]] {
            let [p, q, r, s] = face.map(corner);
            all.extend([[p, q, r], [p, r, s]]);
        }
    }
    Bvh::new(&all)
}

fn maps(c: &mut Criterion) {
    let scene = town();
    let mut group = c.benchmark_group(format!("collision map of {} triangles", scene.triangles.len()));
    group.sample_size(10);
    let with =
        |n: u32, fall: Vec3| CollisionOptions { fall, size: [40.0; 2], texels: [n; 2], ..Default::default() };
    for n in [512, 1024] {
        let options = with(n, Vec3::NEG_Y);
        group.bench_function(format!("{n} x {n}"), |b| b.iter(|| CollisionMap::new(&options, &scene)));
    }
    let options = with(512, Vec3::new(0.5, -1.0, 0.2));
    group.bench_function("512 x 512, slanted", |b| b.iter(|| CollisionMap::new(&options, &scene)));
    group.finish();
}

fn ways(c: &mut Criterion) {
    let options = CollisionOptions { size: [40.0; 2], ..CollisionOptions::default() };
    let map = CollisionMap::new(&options, &town()).expect("a map");
    let ways: Vec<[Vec3; 2]> = (0..10_000)
        .map(|i| {
            let [a, b, c, d] = rng_draw([5, 6], i, 0, 0).map(rng_unit);
            let start = Vec3::new(36.0 * a - 18.0, 6.0 * b, 36.0 * c - 18.0);
            [start, start + Vec3::new(0.05 * d, -0.15, 0.02)]
        })
        .collect();
    c.bench_function("10 000 ways of drops", |b| {
        b.iter(|| ways.iter().filter(|[start, end]| map.find(*start, *end).is_some()).count());
    });
}

criterion_group!(benches, maps, ways);
criterion_main!(benches);
