//! Frames with rain in a host application: light that adds up, the same picture each time, either convention of depth, many obstacles.

#![cfg(feature = "wgpu")]

mod device;
mod host;

use std::hash::{DefaultHasher, Hash, Hasher};

use downpour::gpu::{Gpu, LimitSet, wgpu};
use downpour::math::packing::packing_pack_half;
use downpour::rain::{DepthRange, HostSky, Rain, RainSettings, RainView};
use downpour::render::camera::Viewpoint;
use downpour::render::light::LightSource;
use downpour::sim::simulation::Bounce;
use downpour::weather::Splashes;
use glam::Vec3;
use host::{Host, NEAR_M, ground, mean, settings, view};

const SIZE: [u32; 2] = [96, 54];

/// A device with WebGPU's default limits; `None` if tests on a GPU were declined.
fn device() -> Option<Gpu> {
    device::gpu(LimitSet::WebGpuDefault)
}

fn rain(gpu: &Gpu, settings: RainSettings) -> Rain {
    Rain::new(gpu.device(), gpu.queue(), settings).expect("it is possible")
}

fn float_host(gpu: &Gpu, size: [u32; 2]) -> Host {
    Host::new(gpu, size, wgpu::TextureFormat::Rgba16Float)
}

fn lamp() -> LightSource {
    LightSource::Point {
        radius: 0.0,
        position: Vec3::new(1.0, 3.0, -8.0),
        intensity: Vec3::splat(60.0),
        range: 0.0,
    }
}

/// Pixels of which a channel differs by more than `most`.
fn differ(a: &[[f32; 4]], b: &[[f32; 4]], most: f32) -> usize {
    a.iter().zip(b).filter(|(a, b)| (0..3).any(|k| (a[k] - b[k]).abs() > most)).count()
}

/// A sky map of one color.
fn even_sky(gpu: &Gpu, [r, g, b]: [f32; 3]) -> wgpu::TextureView {
    let size = wgpu::Extent3d { width: 4, height: 2, depth_or_array_layers: 1 };
    let map = gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let texel = [[r, g], [b, 1.0]].map(|pair| packing_pack_half(pair).to_le_bytes());
    gpu.queue().write_texture(
        map.as_image_copy(),
        &texel.as_flattened().repeat(8),
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(32), rows_per_image: None },
        size,
    );
    map.create_view(&wgpu::TextureViewDescriptor::default())
}

/// Light is let through, reflected and scattered, but neither made nor lost: before an even plate under an even sky nothing of the rain is
/// to be seen, neither drops and streaks nor splashes, droplets or the mist of small drops.
#[test]
fn in_even_light_the_rain_vanishes() {
    let Some(gpu) = device() else { return };
    // Half precision has these colors exactly. It rounds what is blended by up to 2^-10, and drops with their unresolved rest are even within
    // 2e-3 on the CPU (crates/downpour-trace/tests/unresolved.rs).
    let (color, most) = ([0.25f32, 0.5, 2.0], 3.0e-3);
    let host = Host { colors: [color.map(f64::from); 2], ..float_host(&gpu, SIZE) };
    let sky = even_sky(&gpu, color);
    let bounce = Bounce { fraction: 1.0, size: 1.0, ..Bounce::default() };
    let mut rain = rain(&gpu, RainSettings { bounce, ..settings() });
    // Close above the ground, so that crowns and droplets are large.
    let low = Viewpoint { eye: Vec3::new(0.5, 0.25, -2.0), ..view().camera };
    let view = RainView { camera: low, ..view() };
    let under = |radiance_scale| Some(HostSky { view: &sky, radiance_scale });
    for obstacles in [&[][..], &ground()] {
        rain.set_obstacles(obstacles).unwrap();
        for (wall_m, sky) in [(f32::INFINITY, under(1.0)), (6.0, under(1.0)), (f32::INFINITY, None)] {
            let made = host.rain_under(&mut rain, &view, wall_m, &[], sky).unwrap();
            let worst = made
                .iter()
                .flat_map(|pixel| (0..3).map(|k| (pixel[k] / color[k] - 1.0).abs()))
                .fold(0.0, f32::max);
            println!("{} obstacles, wall at {wall_m} m: {worst:e}", obstacles.len());
            assert!(worst < most, "{} obstacles, wall at {wall_m} m: {worst}", obstacles.len());
        }
    }
    // The control: under a black sky the same rain is dark where it shows what is beyond the picture.
    let dark = host.rain_under(&mut rain, &view, f32::INFINITY, &[], under(0.0)).unwrap();
    let seen = dark.iter().filter(|pixel| pixel[1] / color[1] < 0.98).count();
    assert!(seen > dark.len() / 50, "{seen} of {} pixels", dark.len());
}

/// Threads of a device list drops, count them into tiles and add up light in any order: none of that is to be seen.
#[test]
fn ten_rains_make_one_picture() {
    let Some(gpu) = device() else { return };
    let host = float_host(&gpu, [48, 27]);
    let low = Viewpoint { eye: Vec3::new(0.5, 0.25, -2.0), ..view().camera };
    // Two that are made anew, each with the picture five times and another one in between.
    let runs = |times_s: [f64; 6]| {
        let mut rain = rain(&gpu, settings());
        rain.set_obstacles(&ground()).unwrap();
        times_s.map(|time_s| {
            let view = RainView { camera: low, time_s, ..view() };
            let mut hasher = DefaultHasher::new();
            for pixel in host.rain(&mut rain, &view, 6.0, &[lamp()]).unwrap() {
                pixel.map(f32::to_bits).hash(&mut hasher);
            }
            hasher.finish()
        })
    };
    let (first, second) = (runs([3.0, 3.01, 3.0, 3.0, 3.0, 3.0]), runs([3.01, 3.0, 3.0, 3.0, 3.0, 3.0]));
    for picture in first[2..].iter().chain(&second[1..]) {
        assert_eq!(*picture, first[0]);
    }
    // The control.
    assert_ne!(first[1], first[0]);
}

/// Projections with the near plane at 0 or at 1, with a far plane or without, hide the same rain.
#[test]
fn depth_of_any_convention_hides_the_same_rain() {
    let Some(gpu) = device() else { return };
    let mut rain = rain(&gpu, settings());
    let wall_m = 6.0;
    let mut drawn = |range| {
        let host = Host { range, ..float_host(&gpu, SIZE) };
        host.rain(&mut rain, &view(), wall_m, &[lamp()]).unwrap()
    };
    let expected = drawn(DepthRange::reversed(NEAR_M));
    for range in [
        DepthRange::standard(NEAR_M, 200.0),
        DepthRange::standard(NEAR_M, f32::INFINITY),
        DepthRange { near_m: NEAR_M, far_m: 200.0, is_reversed: true },
    ] {
        let made = drawn(range);
        // A standard depth has the wall within 0.05 mm; a drop may be on either side of it.
        let off = differ(&made, &expected, 4.0e-3);
        assert!(off < made.len() / 200, "{range:?}: {off} of {} pixels differ", made.len());
        assert!((mean(&made) / mean(&expected) - 1.0).abs() < 1.0e-3, "{range:?}");
    }
    // The control: another plane is another distance.
    let host = float_host(&gpu, SIZE);
    let near = host.rain(&mut rain, &view(), 0.12, &[lamp()]).unwrap();
    let off = differ(&near, &expected, 4.0e-3);
    assert!(off > expected.len() / 50, "{off}");
}

/// Ground of 200 344 triangles stops the rain and the light that a plane of two does.
#[test]
fn ground_of_many_triangles_is_ground() {
    let Some(gpu) = device() else { return };
    // What splashes depends on the triangle.
    let splashes = Splashes { is_enabled: false, ..Splashes::default() };
    let bounce = Bounce { fraction: 0.0, ..Bounce::default() };
    let mut rain = rain(&gpu, RainSettings { splashes, bounce, ..settings() });
    let host = float_host(&gpu, SIZE);
    let (columns, rows) = (317u32, 316u32);
    let corner = |i: u32, j: u32| {
        let along = |k: u32, all: u32| -40.0 + 80.0 * (k as f32 / all as f32);
        [along(i, columns), 0.0, along(j, rows)]
    };
    let many: Vec<[[f32; 3]; 3]> = (0..columns * rows)
        .flat_map(|cell| {
            let (i, j) = (cell % columns, cell / columns);
            let [a, b, c, d] = [corner(i, j), corner(i, j + 1), corner(i + 1, j + 1), corner(i + 1, j)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    assert_eq!(many.len(), 200_344);
    let mut drawn = |obstacles: &[[[f32; 3]; 3]]| {
        rain.set_obstacles(obstacles).unwrap();
        host.rain(&mut rain, &view(), f32::INFINITY, &[lamp()]).unwrap()
    };
    let (made, expected) = (drawn(&many), drawn(&ground()));
    let off = differ(&made, &expected, 4.0e-3);
    assert!(off < made.len() / 200, "{off} of {} pixels differ", made.len());
    // The control: without ground it rains on below it.
    let open = drawn(&[]);
    let control = differ(&open, &expected, 4.0e-3);
    assert!(control > 5 * off && control > 40, "{control} {off}");
}
