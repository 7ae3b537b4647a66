//! Drops that a device finds for a frame, against those that the CPU finds.
#![cfg(feature = "wgpu")]

mod device;

use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::path::Path;

use downpour::gpu::LimitSet;
use downpour::scene::Budget;
use downpour::sim::field::{DropKind, FallingDrop};
use downpour::weather::{CameraPose, DripPoint};
use downpour::wind::{Gusts, Keyed, Wind, WindPart};
use downpour::{Device, Frame, Renderer, RendererOptions, Source};
use glam::DVec3;

/// A street with trees whose leaves have holes.
const STREET: &str = "assets/scenes/plain/day.toml";

/// The same through a window.
const WINDOW: &str = "assets/scenes/plain/window.toml";

/// Gusts that carry drops past the houses.
fn gusts() -> Result<Wind, Box<dyn Error>> {
    let mean = WindPart::uniform(&Keyed::from(7.0), &DVec3::new(0.3, 0.0, -1.0).into())?;
    Ok(Wind::new(vec![mean], Some(Gusts::default()), None)?)
}

/// The frame of a time in seconds of a weather file of the project, small.
fn frame(file: &str, wind: Option<Wind>, device: Device, time_s: f64) -> Result<Frame, Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(file);
    let mut source = Source::read(&path, &[], &mut Budget::default())?;
    source.weather.size = [320, 180];
    source.weather.wind = wind.unwrap_or(source.weather.wind);
    source.weather.rain.rate_mm_h = 500.0;
    let before_the_eye = (0..60).map(|k| {
        let [along, across] = [f64::from(k / 8), f64::from(k % 8)];
        let position = DVec3::new(0.9 + 0.3 * (across - 3.5), 0.4 + 0.1 * along, 8.0 - 0.4 * along);
        DripPoint { position, per_s: 2.0 + along, diameter_m: None }
    });
    source.weather.drips.points = before_the_eye.collect();
    // Droplets as large as drops, so that some are near enough.
    (source.weather.rain.bounce.fraction, source.weather.rain.bounce.size) = (0.5, 1.0);
    if let Some(glass) = &mut source.weather.glass {
        // Its water does not matter here.
        (glass.before, glass.cell) = (0.0, 5.0e-3);
    }
    let options = RendererOptions { samples: 1, sky_rays: 0, first_s: time_s, ..RendererOptions::default() };
    let mut renderer = Renderer::new(source.weather, source.loaded, options, device)?;
    if file == STREET {
        // Low, so that droplets are near.
        let position = DVec3::new(0.9, 0.35, 9.0);
        renderer.set_camera(CameraPose { position, forward: DVec3::NEG_Z })?;
    }
    Ok(renderer.frame(time_s)?)
}

/// The drops by their ids and, where one hangs before it falls, in order of time.
fn by_id(frame: &Frame) -> BTreeMap<(u64, u32), FallingDrop> {
    let mut drops = frame.drops.drops.clone();
    drops.sort_by(|a, b| a.present_s[0].total_cmp(&b.present_s[0]));
    let mut numbers: BTreeMap<u64, u32> = BTreeMap::new();
    let mut next = |id: u64| {
        let number = numbers.entry(id).or_default();
        *number += 1;
        (id, *number)
    };
    drops.into_iter().map(|drop| (next(drop.id), drop)).collect()
}

/// Of a thousand drops all but a few, at the edge of the picture or of a leaf, are found by both, where and as they are.
#[test]
fn a_device_finds_the_drops_of_the_cpu() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = device::gpu(LimitSet::Adapter) else { return Ok(()) };
    for (file, wind, time_s) in [(STREET, None, 3.75), (STREET, Some(gusts()?), 2.4), (WINDOW, None, 1.25)] {
        let on_cpu = frame(file, wind.clone(), Device::cpu(), time_s)?;
        let on_gpu = frame(file, wind.clone(), Device::gpu(gpu.clone(), false), time_s)?;
        assert_eq!(on_gpu.drops.resolved, on_cpu.drops.resolved);
        let (cpu, device) = (by_id(&on_cpu), by_id(&on_gpu));
        assert!(cpu.len() > 500, "{file}: {} drops", cpu.len());
        let missing = cpu.keys().filter(|id| !device.contains_key(id)).count();
        let added = device.keys().filter(|id| !cpu.contains_key(id)).count();
        assert!(
            missing + added <= cpu.len() / 300,
            "{file}: of {} {missing} missing, {added} more",
            cpu.len()
        );
        // All droplets of both, but for one at an edge.
        let ids = |drops: &BTreeMap<(u64, u32), FallingDrop>, kind: DropKind| -> BTreeSet<(u64, u32)> {
            drops.iter().filter(|(_, drop)| drop.kind == kind).map(|(id, _)| *id).collect()
        };
        for kind in [DropKind::Bounced, DropKind::Dripped] {
            let (of_cpu, of_device) = (ids(&cpu, kind), ids(&device, kind));
            println!("{file}: {} and {} {kind:?}", of_cpu.len(), of_device.len());
            assert!(file != STREET || of_cpu.len() > 20, "{file}: {} {kind:?}", of_cpu.len());
            assert!(of_cpu.symmetric_difference(&of_device).count() <= of_cpu.len() / 100 + 1, "{file}");
        }
        for (id, drop) in &cpu {
            let Some(other) = device.get(id) else { continue };
            let apart = (drop.position - other.position).length();
            // Sizes of drops are decided in integers, those of crowns and droplets computed; in gusts their drops hit along other
            // chords.
            let (most, ulps) = match drop.kind {
                DropKind::Splash if wind.is_some() => (2.0e-3, u32::MAX),
                DropKind::Splash => (2.0e-3, 4),
                DropKind::Bounced if wind.is_some() => (8.0e-3, 1),
                DropKind::Bounced => (2.0e-4, 1),
                // Cube roots.
                DropKind::Dripped => (2.0e-4, 64),
                _ => (2.0e-4, 0),
            };
            assert!(apart < most, "{file}: drop {id:?} is {apart} m off");
            let differ = drop.diameter.to_bits().abs_diff(other.diameter.to_bits());
            assert!(drop.kind == other.kind && differ <= ulps, "{file}: {drop:?} {other:?}");
            // A crown is as large as the speed toward a surface makes it, whose normal differs along other chords.
            assert!((drop.diameter - other.diameter).abs() < 2.0e-5, "{file}: {drop:?} {other:?}");
            let part = |drop: &FallingDrop| drop.present_s.map(f32::is_finite);
            assert_eq!(part(drop), part(other), "{file}: drop {id:?}");
            let times = drop.present_s.iter().zip(&other.present_s).filter(|(time, _)| time.is_finite());
            for (time, of_device) in times {
                assert!((time - of_device).abs() < 1.0e-3, "{file}: {drop:?} {other:?}");
            }
        }
        // The drops that are drawn, by their places in the list, nearest first.
        let count = on_gpu.drops.drops.len();
        assert!(on_gpu.picture.drawn.iter().all(|&place| (place as usize) < count));
        let ids = |frame: &Frame| -> Vec<u64> {
            frame.picture.drawn.iter().map(|&place| frame.drops.drops[place as usize].id).collect()
        };
        let (drawn, expected) = (ids(&on_gpu), ids(&on_cpu));
        let both = drawn.iter().filter(|id| expected.contains(id)).count();
        assert!(
            both * 300 >= expected.len() * 299 && drawn.len().abs_diff(expected.len()) * 300 <= drawn.len()
        );
    }
    Ok(())
}

/// The device lists drops in any order: nothing of a frame depends on it.
#[test]
fn a_frame_has_the_same_bits_each_time() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = device::gpu(LimitSet::Adapter) else { return Ok(()) };
    let first = frame(STREET, None, Device::gpu(gpu.clone(), false), 3.75)?;
    for _ in 0..3 {
        let again = frame(STREET, None, Device::gpu(gpu.clone(), false), 3.75)?;
        assert!(again.picture.rain == first.picture.rain && again.picture.clean == first.picture.clean);
        assert!(again.drops == first.drops && again.picture.drawn == first.picture.drawn);
    }
    Ok(())
}

/// A weather of a tornado and turbulence, whose rain goes step by step.
const TORNADO: &str = "tests/goldens/weather/tornado.toml";

/// A renderer of the tornado, with so much rain, before an eye low above the road.
fn tornado(device: Device, first_s: f64) -> Result<Renderer, Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let models = root.join("assets/scenes/plain");
    let mut source = Source::read(&root.join(TORNADO), &[&models], &mut Budget::default())?;
    source.weather.size = [192, 108];
    source.weather.wind_box.size = [16; 3];
    source.weather.camera.fov = Some(40.0f64.to_radians());
    source.weather.rain.rate_mm_h = 500.0;
    (source.weather.rain.bounce.fraction, source.weather.rain.bounce.size) = (0.5, 1.0);
    let options = RendererOptions { samples: 1, sky_rays: 0, first_s, ..RendererOptions::default() };
    let mut renderer = Renderer::new(source.weather, source.loaded, options, device)?;
    let position = DVec3::new(0.9, 0.3, 4.2);
    renderer.set_camera(CameraPose { position, forward: DVec3::new(0.1, 0.02, -1.0).normalize() })?;
    Ok(renderer)
}

/// Drops that a device has carried through a tornado for some hundred steps are those of the CPU, but for those that a last bit sent
/// another way at an edge.
#[test]
fn a_device_steps_the_drops_of_the_cpu() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = device::gpu(LimitSet::Adapter) else { return Ok(()) };
    let time_s = 0.4;
    let on_cpu = tornado(Device::cpu(), time_s)?.frame(time_s)?;
    let mut renderer = tornado(Device::gpu(gpu.clone(), false), time_s)?;
    let on_gpu = renderer.frame(time_s)?;
    assert_eq!(on_gpu.drops.resolved, on_cpu.drops.resolved);
    let (cpu, device) = (by_id(&on_cpu), by_id(&on_gpu));
    let bounced = cpu.values().filter(|drop| drop.kind == DropKind::Bounced).count();
    println!("{} drops of {}, {bounced} droplets", cpu.len(), on_cpu.drops.simulated);
    assert!(cpu.len() > 500 && bounced > 5, "{} drops, {bounced} droplets", cpu.len());
    let both: Vec<_> = cpu.iter().filter_map(|(id, drop)| Some((drop, device.get(id)?))).collect();
    let most = cpu.len() / 100;
    assert!(cpu.len() - both.len() <= most && device.len() - both.len() <= most, "{} of both", both.len());
    let off = |(a, b): &&(&FallingDrop, &FallingDrop)| {
        (a.position - b.position).length() > 1.0e-3 || a.kind != b.kind || a.diameter != b.diameter
    };
    assert!(both.iter().filter(off).count() <= most);
    // A picture of a time is the same whatever was made before, and the way there moves few bytes.
    let later = renderer.frame(0.5)?;
    let alone = tornado(Device::gpu(gpu, false), 0.5)?.frame(0.5)?;
    assert!(later.drops == alone.drops);
    renderer.display(0.52)?;
    let device = renderer.display(0.54)?.device.ok_or("a device")?;
    println!("{device:?}");
    assert!(device.buffers_made == 0 && device.bytes_uploaded < 64 << 10, "{device:?}");
    Ok(())
}
