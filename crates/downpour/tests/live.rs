//! A renderer whose weather is changed by hand, plates that stay, and frames for a display.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

#[cfg(feature = "wgpu")]
mod device;
mod model;

use downpour::scene::Budget;
use downpour::scene::sandbox::NoFiles;
use downpour::weather::{Roots, Weather, load};
use downpour::{Device, Frame, Renderer, RendererOptions};

/// Two lamps over a floor with a step.
const WEATHER: &str = "
[rain]
rate_mm_h = 120
seed = 7
[sky]
zenith_color = [0.2, 0.3, 0.4]
[[light]]
point = { position_m = [1, 2.5, -2], intensity_cd = 40 }
[camera]
position_m = [0, 1.2, 5]
look_at_m = [0, 0.6, 0]
fov_deg = 30
[[model]]
file = 'floor.gltf'
[output]
size = [48, 27]
";

/// A weather file with its model in a folder of its own.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let positions = [
        [-4.0, 0.0, -4.0],
        [4.0, 0.0, -4.0],
        [4.0, 0.0, 4.0],
        [-4.0, 0.0, 4.0],
        [-0.5, 0.0, 0.5],
        [0.5, 0.0, 0.5],
        [0.0, 0.0, -0.5],
        [0.0, 1.0, 0.0],
    ];
    model::write(folder.path(), &positions, &[0, 2, 1, 0, 3, 2, 4, 5, 7, 5, 6, 7, 6, 4, 7]).unwrap();
    folder
}

/// The weather with another part in place of some.
fn changed(parts: &[(&str, &str)]) -> Weather {
    let mut text = WEATHER.to_owned();
    for (from, to) in parts {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    Weather::parse("a.toml", &text).unwrap_or_else(|error| panic!("{error}"))
}

fn files(folder: &tempfile::TempDir) -> Roots {
    Roots::open(&folder.path().join("a.toml"), &[]).unwrap()
}

fn opened(
    folder: &tempfile::TempDir,
    weather: &Weather,
    options: &RendererOptions,
    device: Device,
) -> Renderer {
    let loaded = load(weather, &files(folder), &mut Budget::default()).unwrap();
    let renderer = Renderer::new(weather.clone(), loaded, options.clone(), device);
    renderer.unwrap_or_else(|error| panic!("{error}"))
}

fn fast() -> RendererOptions {
    RendererOptions { samples: 1, sky_rays: 1, ..RendererOptions::default() }
}

fn bits(frame: &Frame) -> Vec<[u32; 3]> {
    frame.radiance().iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

/// What is set by hand is what a renderer shows that was opened so: rain, camera, size, sky, lamps.
#[test]
fn a_weather_that_is_set_is_the_weather_that_is_opened() {
    let folder = folder();
    let first = changed(&[]);
    let mut live = opened(&folder, &first, &fast(), Device::cpu());
    let before = bits(&live.frame(0.5).unwrap());
    live.set_exposure(Some(1.0));
    let lamps = "[[light]]\npoint = { position_m = [-1, 2, -1], intensity_cd = 90 }\n\n[camera]";
    let changes = [
        ("rain", changed(&[("rate_mm_h = 120", "rate_mm_h = 300"), ("seed = 7", "seed = 3")])),
        ("camera and size", changed(&[("fov_deg = 30", "fov_deg = 50"), ("[48, 27]", "[30, 40]")])),
        ("another lamp, another sky", changed(&[("[camera]", lamps), ("[0.2, 0.3, 0.4]", "[2, 1, 0.5]")])),
        (
            "no lamp, and a sun",
            changed(&[(
                "[[light]]\npoint",
                "[sun]\nilluminance_lux = 9\nazimuth_deg = 20\nelevation_deg = 40\n#",
            )]),
        ),
    ];
    for (name, weather) in changes {
        live.set_weather(weather.clone(), &files(&folder)).unwrap_or_else(|error| panic!("{name}: {error}"));
        let mut own = opened(&folder, &weather, &fast(), Device::cpu());
        let found = bits(&live.frame(0.5).unwrap());
        assert!(found == bits(&own.frame(0.5).unwrap()), "{name}");
        assert!(found != before, "{name} shows");
    }
    live.set_weather(first, &files(&folder)).unwrap();
    assert!(bits(&live.frame(0.5).unwrap()) == before, "and back");
}

/// What is wrong with a weather is said, and the renderer goes on with the one that it had.
#[test]
fn a_weather_that_is_wrong_changes_nothing() {
    let folder = folder();
    let first = changed(&[]);
    let mut live = opened(&folder, &first, &fast(), Device::cpu());
    let before = bits(&live.frame(0.5).unwrap());
    let missing = changed(&[("floor.gltf", "nothing.glb")]);
    let error = live.set_weather(missing, &NoFiles).unwrap_err().to_string();
    assert!(error.contains("nothing.glb"), "{error}");
    let mut empty = first.clone();
    empty.size = [0, 9];
    let error = live.set_weather(empty, &files(&folder)).unwrap_err().to_string();
    assert!(error.contains('0'), "{error}");
    assert_eq!(live.weather(), &first);
    assert!(bits(&live.frame(0.5).unwrap()) == before);
}

/// Drops that fall step by step stay when the wind changes, and are blown elsewhere from then on.
#[test]
fn stepped_rain_goes_on_in_another_wind() {
    let folder = folder();
    let vortex = |strength: u32| {
        let wind =
            format!("[[wind]]\nvortex = {{ strength_m2_s = {strength}, center_m = [0, 1, 0] }}\n[camera]");
        let many = ("rate_mm_h = 120", "rate_mm_h = 500");
        changed(&[("[camera]", &wind), many, ("fov_deg = 30", "fov_deg = 60"), ("[48, 27]", "[160, 90]")])
    };
    let mut live = opened(&folder, &vortex(5), &fast(), Device::cpu());
    let positions = |frame: &Frame| -> std::collections::BTreeMap<u64, [f64; 3]> {
        frame.drops.drops.iter().map(|drop| (drop.id, drop.position.to_array())).collect()
    };
    let at = |renderer: &mut Renderer, time_s| positions(&renderer.frame(time_s).unwrap());
    let before = at(&mut live, 0.5);
    live.set_weather(vortex(60), &files(&folder)).unwrap();
    let same = at(&mut live, 0.5);
    assert_eq!(same, before, "the wind blows from the next step on");
    let blown = at(&mut live, 0.6);
    let mut calm = opened(&folder, &vortex(5), &fast(), Device::cpu());
    let calm = at(&mut calm, 0.6);
    let both: Vec<f64> = blown
        .iter()
        .filter_map(|(id, a)| calm.get(id).map(|b| (0..3).map(|k| (a[k] - b[k]).abs()).sum()))
        .collect();
    let moved = both.iter().filter(|apart| **apart > 1.0e-3).count();
    assert!(both.len() >= 20 && moved * 2 > both.len(), "{moved} of {} of {}", both.len(), calm.len());
}

fn mean_difference(a: &Frame, b: &[[f32; 4]]) -> f32 {
    let pixels = a.picture.clean.iter().zip(b);
    let apart = pixels.map(|(a, b)| (0..3).map(|k| (a[k] - b[k]).abs() / (a[k] + b[k] + 0.1)).sum::<f32>());
    apart.sum::<f32>() / b.len() as f32
}

/// A plate that stays comes nearer to what many samples show, frame by frame, then is the same to the bit, and is made anew for
/// another camera.
fn a_kept_plate_is_refined(device: &Device) {
    let folder = folder();
    let mut weather = changed(&[]);
    let options = RendererOptions { kept_frames: 12, ..fast() };
    let mut live = opened(&folder, &weather, &options, device.clone());
    let mut plain = opened(&folder, &weather, &fast(), device.clone());
    // The same scene with other rays.
    let mut other = opened(&folder, &changed(&[("seed = 7", "seed = 8")]), &options, device.clone());
    let others: Vec<Frame> = (0..12).map(|_| other.frame(0.5).unwrap()).collect();
    let frames: Vec<Frame> = (0..14).map(|_| live.frame(0.5).unwrap()).collect();
    assert!(
        frames[0].picture.clean == plain.frame(0.5).unwrap().picture.clean,
        "the first is a frame by itself"
    );
    // Noise of a mean of n frames is that of one over the root of n.
    let noise = [0, 3, 11].map(|k: usize| mean_difference(&frames[k], &others[k].picture.clean));
    assert!(noise[1] < 0.65 * noise[0] && noise[2] < 0.45 * noise[0], "{noise:?}");
    let traced = |frame: &Frame| frame.picture.passes.iter().any(|(name, _)| *name == "scene");
    assert!(traced(&frames[11]) && !traced(&frames[12]));
    // Rain falls on before it.
    let later = live.frame(0.6).unwrap();
    assert!(!traced(&later) && later.picture.rain != frames[13].picture.rain);
    weather.camera.fov = Some(0.4);
    live.set_weather(weather.clone(), &files(&folder)).unwrap();
    plain.set_weather(weather.clone(), &files(&folder)).unwrap();
    assert!(live.frame(0.5).unwrap().picture.clean == plain.frame(0.5).unwrap().picture.clean);
}

/// What is around an eye that moves is traced anew in parts, and is the whole of it a few frames after it stands still.
fn what_is_around_a_moving_eye_follows(device: &Device) {
    let folder = folder();
    let options = RendererOptions { kept_frames: 2, ..fast() };
    let weather = changed(&[]);
    let mut live = opened(&folder, &weather, &options, device.clone());
    let mut plain = opened(&folder, &weather, &fast(), device.clone());
    assert!(live.frame(0.5).unwrap().picture.environment == plain.frame(0.5).unwrap().picture.environment);
    let moved = changed(&[("position_m = [0, 1.2, 5]", "position_m = [0.05, 1.2, 4.98]")]);
    live.set_weather(moved.clone(), &files(&folder)).unwrap();
    plain.set_weather(moved, &files(&folder)).unwrap();
    let fresh = plain.frame(0.5).unwrap().picture;
    let mut apart = Vec::new();
    for frame in 0..4 {
        let picture = live.frame(0.5).unwrap().picture;
        assert!(frame > 0 || picture.clean == fresh.clean, "the picture follows at once");
        let texels = picture.environment.iter().zip(&fresh.environment);
        apart.push(texels.filter(|(a, b)| a != b).count());
    }
    assert!(apart[0] > 0 && apart.is_sorted_by(|a, b| a >= b) && apart[3] == 0, "{apart:?}");
}

#[test]
fn what_is_around_a_moving_eye_follows_on_a_cpu() {
    what_is_around_a_moving_eye_follows(&Device::cpu());
}

#[test]
fn a_kept_plate_is_refined_on_a_cpu() {
    a_kept_plate_is_refined(&Device::cpu());
}

/// A frame of a scene in which something moves is the same alone as after others, with which it shares what stands still: those of three
/// that are `alone`.
fn what_moves_is_where_it_would_be_alone(device: &Device, alone: &[usize]) {
    let folder = folder();
    let both = "[[model]]\nfile = 'floor.gltf'\n[[model]]\nfile = 'floor.gltf'\n\
                translation_m = [[0, [-2, 0.4, 0]], [1, [2, 0.4, 0]]]\n";
    let weather = changed(&[("[[model]]\nfile = 'floor.gltf'\n", both)]);
    let opened = || {
        let mut renderer = opened(&folder, &weather, &fast(), device.clone());
        renderer.set_exposure(Some(1.0));
        renderer
    };
    let mut renderer = opened();
    let frames = [0.2, 0.5, 0.4].map(|time_s| (time_s, bits(&renderer.frame(time_s).unwrap())));
    for (time_s, found) in alone.iter().map(|&k| &frames[k]) {
        assert!(*found == bits(&opened().frame(*time_s).unwrap()), "{time_s} s");
    }
    assert!(frames[0].1 != frames[1].1);
    // Another rain changes nothing of the scene.
    renderer
        .set_weather(changed(&[("file = 'floor.gltf'\n", &both[10..]), ("120", "1")]), &files(&folder))
        .unwrap();
    renderer.set_weather(weather.clone(), &files(&folder)).unwrap();
    assert!(bits(&renderer.frame(0.2).unwrap()) == frames[0].1);
}

#[test]
fn what_moves_is_where_it_would_be_alone_on_a_cpu() {
    what_moves_is_where_it_would_be_alone(&Device::cpu(), &[0, 1, 2]);
}

#[cfg(feature = "wgpu")]
#[test]
fn what_is_kept_follows_on_a_gpu() {
    let Some(gpu) = device::gpu(downpour::gpu::LimitSet::Adapter) else { return };
    let device = Device::gpu(gpu, false);
    a_kept_plate_is_refined(&device);
    what_is_around_a_moving_eye_follows(&device);
    // A software driver compiles the kernels of each renderer.
    what_moves_is_where_it_would_be_alone(&device, &[1]);
}

/// Pixels for a display are those of the frame of the time, in lightning as well.
#[test]
fn a_frame_for_a_display_is_the_frame() {
    let folder = folder();
    let parts =
        "[glow]\nglare = 0.05\n[lightning]\nper_minute = 30\nseed = 14\ndistance_m = [500, 1500]\n[camera]";
    let glow = changed(&[("[camera]", parts)]);
    let mut devices = vec![Device::cpu()];
    #[cfg(feature = "wgpu")]
    devices.extend(device::gpu(downpour::gpu::LimitSet::Adapter).map(|gpu| Device::gpu(gpu, false)));
    for device in devices {
        let mut display = opened(&folder, &glow, &fast(), device.clone());
        let mut frames = opened(&folder, &glow, &fast(), device);
        let flash = (60..6000).map(|k| 0.01 * f64::from(k)).find(|&time_s| frames.is_in_flash(time_s));
        for time_s in [0.5, 0.6, flash.unwrap()] {
            let (shown, frame) = (display.display(time_s).unwrap(), frames.frame(time_s).unwrap());
            assert_eq!((shown.size, shown.exposure.to_bits()), (frame.size(), frame.exposure.to_bits()));
            assert_eq!(shown.drops_drawn, frame.picture.drawn.len());
            assert_eq!(shown.drops_simulated, frame.drops.simulated);
            for ([r, g, b, a], pixel) in shown.pixels.iter().zip(frame.pixels()) {
                let apart = [*r, *g, *b].iter().zip(pixel).map(|(a, b)| a.abs_diff(b)).max();
                assert!(apart <= Some(1) && *a == 255, "{r} {g} {b} where {pixel:?} is");
            }
        }
    }
}

/// A device's threads may do their work in any order: ten renderers make one picture.
#[cfg(feature = "wgpu")]
#[test]
fn ten_renderers_make_one_picture() {
    use std::hash::{DefaultHasher, Hash, Hasher};

    let Some(gpu) = device::gpu(downpour::gpu::LimitSet::Adapter) else { return };
    let (folder, device) = (folder(), Device::gpu(gpu, false));
    // Two that are made anew, each with the picture five times and another one in between.
    let runs = |times_s: [f64; 6]| {
        let mut renderer = opened(&folder, &changed(&[]), &fast(), device.clone());
        renderer.set_exposure(Some(1.0));
        times_s.map(|time_s| {
            let frame = renderer.frame(time_s).unwrap();
            let mut hasher = DefaultHasher::new();
            bits(&frame).hash(&mut hasher);
            for pixel in &frame.picture.rain {
                pixel.map(f32::to_bits).hash(&mut hasher);
            }
            hasher.finish()
        })
    };
    let (first, second) = (runs([0.5, 0.51, 0.5, 0.5, 0.5, 0.5]), runs([0.51, 0.5, 0.5, 0.5, 0.5, 0.5]));
    for picture in first[2..].iter().chain(&second[1..]) {
        assert_eq!(*picture, first[0]);
    }
    // The control.
    assert_ne!(first[1], first[0]);
}

/// Drops and the rest of the rain take out as much of an even light as they show: before an even sky there is nothing to be seen on a
/// device either.
#[cfg(feature = "wgpu")]
#[test]
fn rain_vanishes_in_even_light_on_a_gpu() {
    let Some(gpu) = device::gpu(downpour::gpu::LimitSet::Adapter) else { return };
    let text = "[rain]\nrate_mm_h = 200\n[sky]\ncolor = [0.25, 0.5, 2.0]\n[camera]\nposition_m = [0, 1.7, 0]\nfov_deg = 45\n\
                [glow]\nglare = 0\ndiffraction = false\n[output]\nsize = [64, 48]\n";
    let weather = Weather::parse("even.toml", text).unwrap();
    let loaded = load(&weather, &NoFiles, &mut Budget::default()).unwrap();
    let mut renderer = Renderer::new(weather, loaded, fast(), Device::gpu(gpu, false)).unwrap();
    let picture = renderer.frame(3.0).unwrap().picture;
    let taken: f64 = picture.rain.iter().map(|pixel| f64::from(1.0 - pixel[3])).sum::<f64>() / (64.0 * 48.0);
    assert!(taken > 0.05 && picture.drawn.len() > 10, "{taken}, {} drops", picture.drawn.len());
    for (rain, clean) in picture.rain.iter().zip(&picture.clean) {
        for k in 0..3 {
            let seen = rain[k] + rain[3] * clean[k];
            // 2e-3 are those of the CPU (crates/downpour-trace/tests/unresolved.rs); sums of a device round in another order.
            assert!((seen / clean[k] - 1.0).abs() < 3.0e-3, "{rain:?} before {clean:?}");
        }
        // The light is even: the ratio of any two pixels is 1.
        assert!((clean[1] / picture.clean[0][1] - 1.0).abs() < 1.0e-3, "{clean:?}");
    }
}

/// Glass that rain wets by the name of its material stays wet from frame to frame of a scene that stands still, and when another weather
/// is set.
#[test]
fn wet_glass_stays_wet() {
    let folder = folder();
    let file = folder.path().join("floor.gltf");
    let model = std::fs::read_to_string(&file).unwrap();
    let named = model.replacen("\"indices\":1", "\"indices\":1,\"material\":0", 1).replacen(
        "{\"asset\"",
        "{\"materials\":[{\"name\":\"glass\"}],\"asset\"",
        1,
    );
    std::fs::write(&file, named).unwrap();
    let pane = "[[pane]]\nmaterial = 'glass'\nlargest_mm = 9\n[output]";
    // From so near that drops are larger than pixels.
    let near = [("[0, 1.2, 5]", "[0, 0.5, 0.8]"), ("[0, 0.6, 0]", "[0, 0.35, 0]"), ("[48, 27]", "[96, 54]")];
    let changed = |parts: &[(&str, &str)]| changed(&[&near[..], parts].concat());
    let wet = changed(&[("[output]", pane)]);
    let later = |mut renderer: Renderer| bits(&renderer.frame(2.0).unwrap());
    let exposed = |weather: &Weather, first_s: f64| {
        let options = RendererOptions { first_s, ..fast() };
        let mut renderer = opened(&folder, weather, &options, Device::cpu());
        renderer.set_exposure(Some(1.0));
        renderer
    };
    let mut clip = exposed(&wet, 0.0);
    clip.frame(0.0).unwrap();
    let own = later(exposed(&wet, 2.0));
    assert!(own != later(exposed(&changed(&[]), 2.0)), "drops show on the glass");
    assert!(bits(&clip.frame(2.0).unwrap()) == own);
    let other = changed(&[("[output]", pane), ("rate_mm_h = 120", "rate_mm_h = 60")]);
    clip.set_weather(other.clone(), &files(&folder)).unwrap();
    assert!(bits(&clip.frame(2.0).unwrap()) == later(exposed(&other, 2.0)));
}
