//! Ripples of puddles that stay on the device that draws them.

#![cfg(feature = "wgpu")]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod device;
mod model;

use std::time::Duration;

use downpour::gpu::{Gpu, LimitSet, wgpu};
use downpour::scene::Budget;
use downpour::{Device, Frame, Renderer, RendererOptions, Source};

/// A hollow in a floor, under water and a short rain that begins at time 0: few steps of ripples.
const WEATHER: &str = "
[rain]
rate_mm_h = [[0, 0], [0.01, 60], [0.2, 60], [0.21, 0]]
bounce = { fraction = 0 }
seed = 7
[sky]
zenith_color = [0.2, 0.3, 0.4]
[camera]
position_m = [0, 0.5, 1.6]
look_at_m = [0, 0, 0.2]
fov_deg = 30
[[model]]
file = 'floor.gltf'
[output]
size = [64, 36]
[[puddle]]
position_m = [0, 0, 0]
size_m = [2, 2]
cell_mm = 50
fill = 1
relief_mm = 0
";

/// Two times, s, between which ripples move.
const TIMES: [f64; 2] = [0.08, 0.12];

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let rim = |x: f32, z: f32| [x, 0.0, z];
    let floor = |x: f32, z: f32| [x, -0.05, z];
    let positions = [
        rim(-4.0, -4.0),
        rim(4.0, -4.0),
        rim(4.0, 4.0),
        rim(-4.0, 4.0),
        floor(-0.8, -0.8),
        floor(0.8, -0.8),
        floor(0.8, 0.8),
        floor(-0.8, 0.8),
    ];
    let mut indices = vec![4, 6, 5, 4, 7, 6];
    for k in 0..4u32 {
        let next = (k + 1) % 4;
        indices.extend([k, 4 + k, next, next, 4 + k, 4 + next]);
    }
    model::write(folder.path(), &positions, &indices).unwrap();
    std::fs::write(folder.path().join("a.toml"), WEATHER).unwrap();
    folder
}

fn opened(folder: &tempfile::TempDir, device: Device, kept_frames: u32) -> Renderer {
    let source = Source::read(&folder.path().join("a.toml"), &[], &mut Budget::default()).unwrap();
    let options = RendererOptions {
        samples: 1,
        sky_rays: 1,
        kept_frames,
        running_frames: 8,
        ..RendererOptions::default()
    };
    Renderer::new(source.weather, source.loaded, options, device).unwrap_or_else(|error| panic!("{error}"))
}

fn plate(frame: &Frame) -> &[[f32; 4]] {
    &frame.picture.clean
}

/// Mean difference of two plates, relative to their radiance.
fn apart(a: &Frame, b: &Frame) -> f32 {
    let pixels = plate(a).iter().zip(plate(b));
    let apart = pixels.map(|(a, b)| (0..3).map(|k| (a[k] - b[k]).abs() / (a[k] + b[k] + 0.01)).sum::<f32>());
    apart.sum::<f32>() / plate(a).len() as f32
}

/// Puddles of a device show what those of the CPU show, in any order of times, and cost a frame no upload of the lattice.
#[test]
fn ripples_on_a_device_are_those_of_the_cpu() {
    let Some(gpu) = device::gpu(LimitSet::WebGpuDefault) else { return };
    let folder = folder();
    let device = || Device::gpu(gpu.clone(), false).with_ripples_on_software_driver();
    let mut cpu = opened(&folder, Device::cpu(), 0);
    let of_cpu = TIMES.map(|time_s| cpu.frame(time_s).unwrap());
    let mut forward = opened(&folder, device(), 0);
    let of_device = TIMES.map(|time_s| forward.frame(time_s).unwrap());
    let moved = apart(&of_cpu[0], &of_cpu[1]);
    for (k, time_s) in TIMES.into_iter().enumerate() {
        let (on_cpu, there) = (&of_cpu[k], &of_device[k]);
        let found = apart(on_cpu, there);
        assert!(found < 0.05 * moved, "{time_s} s: {found}, and {moved} between the times");
    }
    // The later time first, and the earlier one after a part of the time without a frame.
    let mut backward = opened(&folder, device(), 0);
    assert!(plate(&backward.frame(TIMES[1]).unwrap()) == plate(&of_device[1]));
    backward.pass(0.03).unwrap();
    assert!(plate(&backward.frame(TIMES[0]).unwrap()) == plate(&of_device[0]));
    for step in 1..4 {
        let shown = backward.display(TIMES[0] + 0.015 * f64::from(step)).unwrap();
        let bytes = shown.device.unwrap().bytes_uploaded;
        assert!(bytes < 64 << 10, "{bytes} bytes");
        assert!(shown.passes.iter().any(|(name, _)| *name == "ripples"), "{:?}", shown.passes);
    }
    // Long after the rain the water is level.
    let (on_cpu, there) = (cpu.frame(20.0).unwrap(), forward.frame(20.0).unwrap());
    let found = apart(&on_cpu, &there);
    assert!(found < 0.05 * moved, "{found}, and {moved} between the times");
    assert!(there.picture.passes.iter().all(|(name, _)| *name != "ripples"));
}

/// The paper's waves, which have one speed, are others than those of water, on a device as on the CPU.
#[test]
fn a_membrane_has_its_own_waves() {
    let Some(gpu) = device::gpu(LimitSet::WebGpuDefault) else { return };
    let folder = folder();
    let mut of_water = opened(&folder, Device::cpu(), 0);
    let text = format!("{WEATHER}[ripples]\nwaves = 'membrane'\nspeed_m_s = 0.4\n");
    std::fs::write(folder.path().join("a.toml"), text).unwrap();
    let mut of_cpu = opened(&folder, Device::cpu(), 0);
    let mut of_device = opened(&folder, Device::gpu(gpu, false).with_ripples_on_software_driver(), 0);
    let time_s = TIMES[1];
    let [water, cpu, there] =
        [&mut of_water, &mut of_cpu, &mut of_device].map(|renderer| renderer.frame(time_s).unwrap());
    let (other, found) = (apart(&water, &cpu), apart(&cpu, &there));
    assert!(found < 0.05 * other, "{found}, and {other} from waves on water");
}

/// A plate that stays is made anew when the water has moved, and refined while it has not. Neither that nor what is around the eye, which goes on
/// whatever the waves do, makes a buffer after the first frames.
#[test]
fn a_plate_is_not_kept_over_water_that_moves() {
    let Some(gpu) = device::gpu(LimitSet::Adapter) else { return };
    let folder = folder();
    let mut live = opened(&folder, Device::gpu(gpu.clone(), false).with_ripples_on_software_driver(), 2);
    let traced = |frame: &Frame| frame.picture.passes.iter().any(|(name, _)| *name == "scene");
    let frames = [0.04, 0.04, 0.04, 0.06].map(|time_s| live.frame(time_s).unwrap());
    assert_eq!(frames.each_ref().map(traced), [true, true, false, true]);
    assert!(plate(&frames[1]) == plate(&frames[2]) && plate(&frames[2]) != plate(&frames[3]));
    let made = [0.07, 0.08, 0.09, 0.1, 0.11].map(|time_s| {
        let before = gpu.buffers_made();
        live.display(time_s).unwrap();
        gpu.buffers_made() - before
    });
    assert!(made[0] > 0 && made[2..] == [0; 3], "{made:?}");
    let captured = |passes: &[(&str, f64)]| passes.iter().any(|(name, _)| *name == "capture");
    assert!(captured(&frames[0].picture.passes) && !captured(&frames[3].picture.passes));
    // The light goes on from the last plate.
    assert!(frames[3].picture.passes.iter().any(|(name, _)| *name == "temporal filter"));
}

/// Drops that go step by step make rings as those in closed form do: in a uniform wind the same rings.
#[test]
fn rain_step_by_step_has_rings() {
    let folder = folder();
    let weather = |volume: &str| {
        let rate = WEATHER.lines().find(|line| line.starts_with("rate_mm_h")).unwrap();
        let steady = WEATHER.replace(rate, &format!("rate_mm_h = 60\nvolume = '{volume}'"));
        // Pixels finer than the waves.
        let steady = steady.replace("fov_deg = 30", "fov_deg = 6");
        format!("{steady}[[wind]]\nuniform = {{ speed_m_s = 2, towards_deg = 80 }}\n")
    };
    let [closed, stepped] = ["closed-form", "view"].map(|volume| {
        std::fs::write(folder.path().join("a.toml"), weather(volume)).unwrap();
        opened(&folder, Device::cpu(), 0).frame(0.2).unwrap()
    });
    assert!(plate(&closed) == plate(&stepped));
}

/// A device of the adapter of another one, whose storage buffers hold so many bytes.
fn with_room(gpu: &Gpu, bytes: u64) -> Gpu {
    let instance = wgpu::Instance::default();
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    let name = &gpu.adapter().name;
    let adapter = adapters.into_iter().find(|adapter| adapter.get_info().name == *name).unwrap();
    let required_limits = wgpu::Limits { max_storage_buffer_binding_size: bytes, ..wgpu::Limits::default() };
    let descriptor = wgpu::DeviceDescriptor { required_limits, ..Default::default() };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).unwrap();
    Gpu::on_device(device, queue).with_timeout(Duration::from_secs(600))
}

/// Where a device has no room for the lattice, or for the table with its levels, the CPU draws what it draws by itself.
#[test]
fn a_device_without_room_leaves_puddles_to_the_cpu() {
    let Some(gpu) = device::gpu(LimitSet::Adapter) else { return };
    let folder = folder();
    let mut cpu = opened(&folder, Device::cpu(), 0);
    let of_cpu = cpu.frame(0.05).unwrap();
    // State: 2 MiB. Levels: 5.3 MiB.
    for bytes in [1 << 20, 4 << 20] {
        let device =
            |falls_back| Device::gpu(with_room(&gpu, bytes), falls_back).with_ripples_on_software_driver();
        let mut falls = opened(&folder, device(true), 0);
        let frame = falls.frame(0.05).unwrap();
        assert_eq!(falls.computer().backend, "cpu", "{bytes} bytes");
        assert!(plate(&frame) == plate(&of_cpu), "{bytes} bytes");
        let error = opened(&folder, device(false), 0).frame(0.05).map(|_| ()).unwrap_err();
        assert!(error.is_too_much_for_gpu(), "{error}");
    }
}
