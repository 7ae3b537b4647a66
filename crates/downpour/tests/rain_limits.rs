//! Rain in a host application at its limits: lists that are full, views that do not fit, devices that are small or lost, buffers that
//! stay.

#![cfg(feature = "wgpu")]

mod device;
mod host;

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use downpour::gpu::{Gpu, GpuError, LimitSet, wgpu};
use downpour::rain::{PlateTextures, Rain, RainError, RainSettings, RainView};
use downpour::render::camera::{EyeMotion, Viewpoint};
use downpour::weather::Splashes;
use glam::{Quat, Vec3};
use host::{Host, NEAR_M, ground, settings, view};

const SIZE: [u32; 2] = [96, 54];

/// A device with WebGPU's default limits; `None` if tests on a GPU were declined.
fn device() -> Option<Gpu> {
    device::gpu(LimitSet::WebGpuDefault)
}

/// Rain without splashes, whose masks take time.
fn dull() -> RainSettings {
    RainSettings { splashes: Splashes { is_enabled: false, ..Splashes::default() }, ..settings() }
}

fn rain(gpu: &Gpu, settings: RainSettings) -> Rain {
    Rain::new(gpu.device(), gpu.queue(), settings).expect("it is possible")
}

fn float_host(gpu: &Gpu, size: [u32; 2]) -> Host {
    Host::new(gpu, size, wgpu::TextureFormat::Rgba16Float)
}

/// A host that does no more than submit its frames learns how many drops there were, and that all had room.
#[test]
fn numbers_of_drops_come_back_by_themselves() {
    let Some(gpu) = device() else { return };
    let (mut rain, host) = (rain(&gpu, dull()), float_host(&gpu, SIZE));
    let first = host.submit(&mut rain, &view(), 6.0, &[], None).unwrap();
    assert_eq!((first.frame, first.counts), (1, None));
    let (mut counts, mut last) = (None, first);
    for frame in 2..200 {
        // The device draws meanwhile. Nobody polls it.
        std::thread::sleep(Duration::from_millis(100));
        last = host.submit(&mut rain, &view(), 6.0, &[], None).unwrap();
        assert_eq!(last.frame, frame);
        counts = last.counts;
        if counts.is_some() {
            break;
        }
    }
    let counts = counts.expect("numbers that have arrived");
    assert!((1..last.frame).contains(&counts.frame), "{last:?}");
    // Nothing stops a drop, so that those that are found are those of the CPU, but for some at an edge of the picture.
    let visible = rain.drops(&view(), SIZE).unwrap();
    let (found, expected) = (counts.found, visible.drops.len() as u32);
    assert!(expected > 30 && found.abs_diff(expected) <= 2, "{found} of {expected}");
    assert!(counts.without_room == 0 && counts.looked_at >= counts.found, "{counts:?}");
    assert!(counts.found <= last.room && last.max_drops == 3000 && last.drops_asked == 3000, "{last:?}");
}

/// Many frames that are submitted before the device is done are drawn all the same, and numbers come back after them.
#[test]
fn frames_do_not_wait_for_their_numbers() {
    let Some(gpu) = device() else { return };
    let (mut rain, host) = (rain(&gpu, dull()), float_host(&gpu, SIZE));
    for frame in 1..=8 {
        assert_eq!(host.submit(&mut rain, &view(), 6.0, &[], None).unwrap().frame, frame);
    }
    // An encoder that is dropped keeps no room.
    for _ in 0..8 {
        let (mut encoder, [color, depth]) = (host.encoder(), host.views());
        rain.render(&mut encoder, &view(), &PlateTextures::new(&color, &depth, NEAR_M)).unwrap();
    }
    host.read();
    // Another submission after the wait, then the numbers of a frame before it.
    for _ in 0..2 {
        host.submit(&mut rain, &view(), 6.0, &[], None).unwrap();
        host.read();
    }
    let stats = host.submit(&mut rain, &view(), 6.0, &[], None).unwrap();
    assert_eq!(stats.frame, 19);
    assert!(stats.counts.is_some_and(|counts| counts.frame >= 17 && counts.without_room == 0), "{stats:?}");
}

/// Drops that have no room in the list are told of.
#[test]
fn a_full_list_is_not_silent() {
    let Some(gpu) = device() else { return };
    // A telescope of 0.01 degrees, before which a drop has 10 000 pixels from meters away: with an exposure of a second some dozen of them
    // fall through the picture, and the list has room for one.
    let size = [8, 4320];
    let camera = Viewpoint { fov_y: 2.0e-4, ..view().camera };
    let view = RainView { camera, shutter_s: 1.0, ..view() };
    let host = float_host(&gpu, size);
    let mut rain = rain(&gpu, dull()).with_max_room(1);
    let full = (0..3)
        .find_map(|_| {
            let stats = host.submit(&mut rain, &view, f32::INFINITY, &[], None).unwrap();
            host.read();
            stats.counts.map(|counts| (stats, counts))
        })
        .expect("numbers that have arrived");
    let (stats, counts) = full;
    assert_eq!(stats.room, 1);
    assert!(counts.found > 5, "{counts:?}");
    assert_eq!(counts.without_room, counts.found - 1);
    assert!(stats.is_reduced() && stats.least_pixels > stats.least_pixels_asked, "{stats:?}");
}

/// More drops than are allowed, or than the device has room for, are not drawn one by one, and the numbers of the frame say so.
#[test]
fn what_is_reduced_is_told() {
    let Some(gpu) = device() else { return };
    let host = float_host(&gpu, SIZE);
    let all = RainSettings { max_drops: 1 << 24, ..dull() };
    let mut rain = rain(&gpu, all.clone());
    let mut stats = |settings| {
        rain.set_settings(settings).unwrap();
        host.submit(&mut rain, &view(), 6.0, &[], None).unwrap()
    };
    let most = stats(all);
    assert_eq!(most.drops_asked, 1 << 24);
    // What a device of WebGPU binds, 128 MiB, holds the rows of some hundred thousand drops.
    assert!((1 << 18..1 << 22).contains(&most.max_drops), "{most:?}");
    assert!(!most.is_reduced(), "a small picture resolves fewer: {most:?}");
    let few = stats(RainSettings { max_drops: 20, ..dull() });
    assert_eq!((few.drops_asked, few.max_drops), (20, 20));
    assert!(few.is_reduced() && few.least_pixels > most.least_pixels, "{few:?}");
    assert_eq!(few.least_pixels_asked, most.least_pixels);
    let dry = stats(RainSettings { rate_mm_h: 0.0, ..dull() });
    assert!(!dry.is_reduced(), "{dry:?}");
}

/// Views that do not show what the textures say are errors of their own, and none of the host's encoder.
#[test]
fn views_that_do_not_fit_are_refused() {
    let Some(gpu) = device() else { return };
    let mut rain = rain(&gpu, dull());
    let texture = |format, levels, layers, usage, view_formats: &[_]| {
        gpu.device().create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: layers },
            mip_level_count: levels,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats,
        })
    };
    let [bound, both] = [
        wgpu::TextureUsages::TEXTURE_BINDING,
        wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
    ];
    let (srgb, plain) = (wgpu::TextureFormat::Rgba8UnormSrgb, wgpu::TextureFormat::Rgba8Unorm);
    let deep = wgpu::TextureFormat::Depth32Float;
    let view_of = |texture: &wgpu::Texture, format, level| {
        texture.create_view(&wgpu::TextureViewDescriptor {
            format,
            base_mip_level: level,
            mip_level_count: Some(1),
            ..wgpu::TextureViewDescriptor::default()
        })
    };
    let color = texture(srgb, 2, 1, both, &[plain]);
    let depth = texture(deep, 2, 1, both, &[]);
    let fits = [view_of(&color, None, 0), view_of(&depth, None, 0)];
    let mut render = |[color, depth]: [&wgpu::TextureView; 2]| {
        let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let made = rain.render(&mut encoder, &view(), &PlateTextures::new(color, depth, NEAR_M)).map(|_| ());
        // An encoder with an error would say so here.
        gpu.create("the host's commands", 0, |_| {
            gpu.queue().submit([encoder.finish()]);
        })
        .unwrap();
        made
    };
    let [shown, hidden] = &fits;
    render([shown, hidden]).unwrap();
    for (views, text) in [
        ([&view_of(&color, Some(plain), 0), hidden], "view of the color texture"),
        ([&view_of(&color, None, 1), hidden], "view of the color texture"),
        ([shown, &view_of(&depth, None, 1)], "view of the depth texture"),
    ] {
        for _ in 0..2 {
            let error = render(views).unwrap_err();
            assert!(matches!(error, RainError::View { .. }), "{error}");
            assert!(error.to_string().contains(text), "{error}");
        }
        // And the rain goes on.
        render([shown, hidden]).unwrap();
    }
    // All layers of an array cannot be drawn into.
    let array = texture(srgb, 1, 2, both, &[]);
    let layers = array.create_view(&wgpu::TextureViewDescriptor::default());
    assert!(matches!(render([&layers, hidden]), Err(RainError::View { .. })));
    // One of them can.
    let layer = array.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_array_layer: 1,
        array_layer_count: Some(1),
        ..wgpu::TextureViewDescriptor::default()
    });
    render([&layer, hidden]).unwrap();
    // A depth texture of one level need not be an attachment; of several it does.
    let read = texture(deep, 1, 1, bound | wgpu::TextureUsages::COPY_SRC, &[]);
    render([shown, &view_of(&read, None, 0)]).unwrap();
    let levels = texture(deep, 2, 1, bound, &[]);
    let error = render([shown, &view_of(&levels, None, 0)]).unwrap_err();
    assert!(matches!(error, RainError::Texture { what: "depth texture", .. }), "{error}");
}

/// A device that is lost between a frame and its submission, or before it is submitted at all, is an error of all that comes after, and
/// nothing reaches the host's error handler.
#[test]
fn a_device_that_is_lost_after_a_frame_is_an_error() {
    for is_submitted in [true, false] {
        let Some(gpu) = device() else { return };
        let errors = Arc::new(AtomicUsize::new(0));
        let counted = Arc::clone(&errors);
        gpu.device().on_uncaptured_error(Arc::new(move |_: wgpu::Error| {
            counted.fetch_add(1, Ordering::Relaxed);
        }));
        let (mut rain, host) = (rain(&gpu, dull()), float_host(&gpu, SIZE));
        host.submit(&mut rain, &view(), 6.0, &[], None).unwrap();
        host.read();
        let ([color, depth], mut encoder) = (host.views(), host.encoder());
        let textures = PlateTextures::new(&color, &depth, NEAR_M);
        rain.render(&mut encoder, &view(), &textures).unwrap();
        gpu.device().destroy();
        if is_submitted {
            gpu.queue().submit([encoder.finish()]);
        } else {
            drop(encoder);
        }
        // What the host itself asks of a lost device is not counted.
        let mut encoder = host.encoder();
        errors.store(0, Ordering::Relaxed);
        let is_lost = |made: Result<(), RainError>| {
            assert!(matches!(made, Err(RainError::Gpu(GpuError::Lost { .. }))), "{made:?}");
        };
        for _ in 0..4 {
            is_lost(rain.render(&mut encoder, &view(), &textures).map(|_| ()));
        }
        is_lost(rain.set_obstacles(&ground()));
        is_lost(rain.set_settings(dull()));
        is_lost(Rain::new(gpu.device(), gpu.queue(), dull()).map(|_| ()));
        assert_eq!(errors.load(Ordering::Relaxed), 0);
    }
}

#[test]
fn a_device_of_smaller_limits_is_refused() {
    for buffers in [0, 4] {
        let Some(gpu) = device::gpu(LimitSet::WebGpuWithBuffers(buffers)) else { return };
        let error = Rain::new(gpu.device(), gpu.queue(), dull()).map(|_| ()).unwrap_err();
        assert!(matches!(error, RainError::Gpu(_)), "{error}");
        gpu.check().unwrap();
    }
}

/// A camera that turns by 360 degrees per second makes buffers in its first frames alone; above obstacles, in its first turn.
#[test]
fn a_camera_that_turns_makes_no_buffers() {
    let Some(gpu) = device() else { return };
    let host = float_host(&gpu, [48, 27]);
    let mut rain = rain(&gpu, settings());
    let frames = 24u8;
    let turned = |rain: &mut Rain, number: u8| {
        let part = f32::from(number) / f32::from(frames);
        let motion =
            EyeMotion { turning: Vec3::new(0.0, std::f32::consts::TAU, 0.0), ..EyeMotion::default() };
        let forward = Quat::from_rotation_y(std::f32::consts::TAU * part) * Vec3::NEG_Z;
        let camera = Viewpoint { forward, ..view().camera };
        let time_s = 3.0 + f64::from(number) / f64::from(frames);
        let view = RainView { camera, motion, time_s, ..view() };
        let stats = host.submit(rain, &view, 6.0, &[], None).unwrap();
        // Frames in flight are not to pile up on a slow device.
        host.read();
        stats.buffers_made
    };
    let begun = [0, 1].map(|number| turned(&mut rain, number))[1];
    for number in 2..frames {
        assert_eq!(turned(&mut rain, number), begun, "frame {number}");
    }
    rain.set_obstacles(&ground()).unwrap();
    let made: Vec<u64> = (0..2 * frames).map(|number| turned(&mut rain, number)).collect();
    println!("{made:?}");
    let (first, second) = made.split_at(usize::from(frames));
    assert!(second.iter().all(|made| Some(made) == first.last()), "{made:?}");
}
