//! Rays among the triangles of a street: the build of its hierarchy, and rays of the camera, shadow rays to the sun and shadow rays in
//! all directions, on the CPU's cores and on a GPU. The elements of the throughput are rays, or triangles of the build.
//!
//! `DOWNPOUR_BENCH_MODEL` names another glTF, with the camera at its center.

use std::path::Path;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use downpour_bvh::{Bvh, bvh_blocker, bvh_hit};
use downpour_gpu::{AdapterChoice, ComputeKernel, Gpu, wgpu, workgroups_for};
use downpour_math::ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_scene::budget::Budget;
use downpour_scene::gltf::read_triangles;
use downpour_shaders::bvh::{BVH, BVH_CONSTANTS, BVH_FAR};
use glam::Vec3;
use rayon::prelude::*;

/// The kernel: `any` is for shadows.
const KERNEL: &str = "
struct Ray { origin: vec3f, nearest: f32, direction: vec3f, farthest: f32 }
@group(0) @binding(0) var<storage, read> rays: array<Ray>;
@group(0) @binding(3) var<storage, read_write> found: array<f32>;
override any: bool;
@compute @workgroup_size(64) fn main_rays(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let k = id.x + 64u * groups.x * id.y;
    if k < arrayLength(&rays) {
        let ray = rays[k];
        found[k] = bvh_walk(ray.origin, ray.direction, ray.nearest, ray.farthest, any).distance;
    }
}
";

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Ray {
    origin: [f32; 3],
    nearest: f32,
    direction: [f32; 3],
    farthest: f32,
}

/// Triangles of the model, and the eye and the target of a camera.
fn model() -> (Vec<[[f32; 3]; 3]>, Vec3, Vec3) {
    let own = std::env::var("DOWNPOUR_BENCH_MODEL");
    let street = "assets/scenes/street/models/street.gltf";
    let in_sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(street);
    // Where the program was carried without the sources, from the project's folder.
    let street = if in_sources.exists() { in_sources } else { street.into() };
    let path = own.as_ref().map_or(street, Into::into);
    let model = read_triangles(&path, &mut Budget::default()).expect("a model");
    let (eye, target) = if own.is_ok() {
        let (low, high) = model.bounds().expect("triangles");
        let eye = 0.5 * (Vec3::from(low) + Vec3::from(high));
        (eye, eye + Vec3::new(0.1, -0.1, 1.0))
    } else {
        (Vec3::new(-1.2, 1.6, -6.0), Vec3::new(0.6, 2.5, -30.0))
    };
    (model.indices.iter().map(|t| t.map(|k| model.positions[k as usize])).collect(), eye, target)
}

/// Rays of a camera of 1920 x 1080 pixels divided by `part`, in tiles of 8 x 8; and from where they end toward the sun, and each in a
/// direction of its own that is drawn with the cosine law.
fn rays(bvh: &Bvh, eye: Vec3, target: Vec3, part: u32) -> [Vec<Ray>; 3] {
    let (width, height) = (1920 / part / 8 * 8, 1080 / part / 8 * 8);
    let forward = (target - eye).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let primary = (0..width * height).map(|k| {
        let (tile, inside) = (k / 64, k % 64);
        let (x, y) = (tile % (width / 8) * 8 + inside % 8, tile / (width / 8) * 8 + inside / 8);
        let across = (x as f32 + 0.5) / width as f32 - 0.5;
        let down = (y as f32 + 0.5) / width as f32 - 0.5 * height as f32 / width as f32;
        let direction = (forward + right * across - up * down).normalize();
        Ray { origin: eye.into(), nearest: 1.0e-4, direction: direction.into(), farthest: BVH_FAR }
    });
    let primary: Vec<Ray> = primary.collect();
    let from = |k: u32, ray: &Ray| {
        let along = Vec3::from(ray.direction);
        let hit = bvh.hit(ray.origin, ray.direction, ray.nearest)?;
        let triangle = bvh.triangles[hit.triangle as usize];
        let normal = Vec3::from(triangle.edge_1).cross(triangle.edge_2.into()).normalize_or_zero();
        let normal = if normal.dot(along) > 0.0 { -normal } else { normal };
        let [u, v, ..] = rng_draw([1, 2], k, 0, 0).map(rng_unit);
        let (sin, cos) = (ops::sin(std::f32::consts::TAU * v), ops::cos(std::f32::consts::TAU * v));
        let z = 1.0 - 2.0 * u;
        let drawn = normal + Vec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + Vec3::Z * z;
        let origin = Vec3::from(ray.origin) + along * hit.distance + normal * 1.0e-3;
        let toward = |direction: Vec3| Ray {
            origin: origin.into(),
            direction: direction.normalize_or(normal).into(),
            ..*ray
        };
        Some([toward(Vec3::new(0.4, 0.7, 0.3)), toward(drawn)])
    };
    let seconds: Vec<[Ray; 2]> = (0u32..)
        .zip(&primary)
        .collect::<Vec<_>>()
        .into_par_iter()
        .filter_map(|(k, ray)| from(k, ray))
        .collect();
    let of = |n: usize| seconds.iter().map(|pair| pair[n]).collect();
    let (sun, drawn) = (of(0), of(1));
    [primary, sun, drawn]
}

fn bench(c: &mut Criterion) {
    let (corners, eye, target) = model();
    let mut bvh = Bvh::new(&corners);
    let gpu = Gpu::open(&AdapterChoice::Auto).expect("a GPU or its software driver");
    let software = gpu.adapter().is_software();
    let mut group = c.benchmark_group("rays");
    group.sample_size(10);
    group.throughput(Throughput::Elements(corners.len() as u64));
    group.bench_function("build", |b| b.iter(|| Bvh::new(&corners)));
    // A hit tells its place in the list.
    for (index, triangle) in (0..).zip(&mut bvh.triangles) {
        triangle.index = index;
    }
    let rays = rays(&bvh, eye, target, if software { 8 } else { 1 });
    let source = [BVH_CONSTANTS.wgsl, BVH.wgsl, KERNEL].concat();
    let kernel =
        |any| ComputeKernel::from_source(&gpu, "main_rays", &source, &[("any", any)]).expect("a kernel");
    let kernels = [0.0, 1.0].map(kernel);
    let nodes = gpu.storage_buffer("nodes", &bvh.nodes).expect("a buffer");
    let triangles = gpu.storage_buffer("triangles", &bvh.triangles).expect("a buffer");
    for (name, rays, any) in [("camera", &rays[0], 0), ("sun", &rays[1], 1), ("all directions", &rays[2], 1)]
    {
        group.throughput(Throughput::Elements(rays.len() as u64));
        let walk = if any == 1 { bvh_blocker } else { bvh_hit };
        let hits = |ray: &&Ray| {
            walk(&bvh.nodes, &bvh.triangles, ray.origin, ray.direction, ray.nearest, ray.farthest).is_some()
        };
        group.bench_function(format!("{name}, CPU"), |b| b.iter(|| rays.par_iter().filter(hits).count()));
        let buffer = gpu.storage_buffer("rays", rays).expect("a buffer");
        let usage = wgpu::BufferUsages::STORAGE;
        let found = gpu.empty_buffer("found", 4 * rays.len() as u64, usage).expect("a buffer");
        let kernel = &kernels[any];
        let bindings = kernel.bind(&gpu, &[&buffer, &nodes, &triangles, &found]).expect("bindings");
        let dispatch = [kernel.dispatch(&bindings, workgroups_for(rays.len() as u32))];
        group.bench_function(format!("{name}, {}", gpu.adapter().name), |b| {
            b.iter_custom(|iterations| {
                let time = gpu.time(&dispatch, iterations.min(1000) as u32).expect("a timed pass");
                let one = time.device.filter(|_| !software).unwrap_or(time.wall);
                Duration::from_secs_f64(one.as_secs_f64() * iterations as f64)
            });
        });
    }
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
