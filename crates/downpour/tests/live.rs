//! A renderer whose weather is changed by hand, plates that stay, and frames for a display.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use downpour::scene::Budget;
use downpour::scene::sandbox::NoFiles;
use downpour::weather::{Roots, Weather};
use downpour::{Backend, Device, Frame, Renderer, RendererOptions, Source};

/// A street of boxes with lamps that the project ships.
const STREET: &str = "assets/scenes/plain/night.toml";

fn path() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(STREET)
}

/// The text of the street's weather with another part in place of some.
fn changed(parts: &[(&str, &str)]) -> Weather {
    let mut text = std::fs::read_to_string(path()).unwrap();
    for (from, to) in parts {
        assert!(text.contains(from), "{from} is not in {STREET}");
        text = text.replacen(from, to, 1);
    }
    let mut weather = Weather::parse(STREET, &text).unwrap_or_else(|error| panic!("{error}"));
    weather.size = [48, 27];
    weather
}

fn opened(weather: &Weather, options: &RendererOptions, device: Device) -> Renderer {
    let loaded = Source::read(&path(), &[], &mut Budget::default()).unwrap().loaded;
    let (loaded, _) = loaded
        .reload(&changed(&[]), weather, &Roots::open(&path(), &[]).unwrap(), &mut Budget::default())
        .unwrap();
    let (weather, options) = (weather.clone(), options.clone());
    Renderer::new(weather, loaded, options, device).unwrap_or_else(|error| panic!("{error}"))
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
    let first = changed(&[]);
    let mut live = opened(&first, &fast(), Backend::Cpu.device().unwrap());
    let before = bits(&live.frame(0.5).unwrap());
    let files = Roots::open(&path(), &[]).unwrap();
    let lamp = "[[light]]\npoint = { position_m = [0, 3, -8], intensity_cd = 4000 }\n\n[camera]";
    let changes: [(&str, Weather); 5] = [
        ("rain", Weather { rain: changed(&[]).rain, ..changed(&[]) }),
        ("camera", changed(&[])),
        ("size", changed(&[])),
        ("lamp", changed(&[("[camera]", lamp)])),
        ("sky", changed(&[])),
    ];
    let changes = changes.map(|(name, mut weather)| {
        match name {
            "rain" => (weather.rain.rate_mm_h, weather.rain.seed) = (200.0, 3),
            "camera" => weather.camera.fov = Some(0.5),
            "size" => weather.size = [30, 40],
            "sky" => weather.sky.scale *= 30.0,
            _ => {}
        }
        (name, weather)
    });
    for (name, weather) in changes {
        live.set_weather(weather.clone(), &files).unwrap_or_else(|error| panic!("{name}: {error}"));
        let mut own = opened(&weather, &fast(), Backend::Cpu.device().unwrap());
        let found = bits(&live.frame(0.5).unwrap());
        assert!(found == bits(&own.frame(0.5).unwrap()), "{name}");
        assert!(found != before, "{name} shows");
    }
    live.set_weather(first, &files).unwrap();
    assert!(bits(&live.frame(0.5).unwrap()) == before, "and back");
}

/// What is wrong with a weather is said, and the renderer goes on with the one that it had.
#[test]
fn a_weather_that_is_wrong_changes_nothing() {
    let first = changed(&[]);
    let mut live = opened(&first, &fast(), Backend::Cpu.device().unwrap());
    let before = bits(&live.frame(0.5).unwrap());
    let missing = Weather::parse("w.toml", "[[model]]\nfile = \"nothing.glb\"").unwrap();
    let error = live.set_weather(missing, &NoFiles).unwrap_err().to_string();
    assert!(error.contains("nothing.glb"), "{error}");
    let mut empty = first.clone();
    empty.size = [0, 9];
    let error = live.set_weather(empty, &Roots::open(&path(), &[]).unwrap()).unwrap_err().to_string();
    assert!(error.contains('0'), "{error}");
    assert_eq!(live.weather(), &first);
    assert!(bits(&live.frame(0.5).unwrap()) == before);
}

fn mean_difference(a: &Frame, b: &[[f32; 4]]) -> f32 {
    let pixels = a.picture.clean.iter().zip(b);
    let apart = pixels.map(|(a, b)| (0..3).map(|k| (a[k] - b[k]).abs() / (a[k] + b[k] + 0.1)).sum::<f32>());
    apart.sum::<f32>() / b.len() as f32
}

/// A plate that stays comes nearer to what many samples show, frame by frame, then is the same to the bit, and is made anew for
/// another camera.
fn a_kept_plate_is_refined(device: &dyn Fn() -> Device) {
    let mut weather = changed(&[]);
    let options = RendererOptions { kept_frames: 12, ..fast() };
    let mut live = opened(&weather, &options, device());
    let mut plain = opened(&weather, &fast(), device());
    let many = RendererOptions { samples: 4, sky_rays: 4, ..fast() };
    let reference = opened(&weather, &many, Backend::Cpu.device().unwrap()).frame(0.5).unwrap().picture.clean;
    let frames: Vec<Frame> = (0..14).map(|_| live.frame(0.5).unwrap()).collect();
    assert!(
        frames[0].picture.clean == plain.frame(0.5).unwrap().picture.clean,
        "the first is a frame by itself"
    );
    let off = [0, 3, 13].map(|k: usize| mean_difference(&frames[k], &reference));
    assert!(off[1] < 0.8 * off[0] && off[2] < 0.55 * off[0], "{off:?}");
    assert!(frames[12].picture.clean == frames[13].picture.clean);
    let traced = |frame: &Frame| frame.picture.passes.iter().any(|(name, _)| *name == "scene");
    assert!(traced(&frames[11]) && !traced(&frames[12]));
    // Rain falls on before it.
    let later = live.frame(0.6).unwrap();
    assert!(!traced(&later) && later.picture.rain != frames[13].picture.rain);
    weather.camera.fov = Some(0.4);
    live.set_weather(weather.clone(), &Roots::open(&path(), &[]).unwrap()).unwrap();
    let moved = live.frame(0.5).unwrap();
    let mut own = opened(&weather, &fast(), device());
    assert!(moved.picture.clean == own.frame(0.5).unwrap().picture.clean);
}

#[test]
fn a_kept_plate_is_refined_on_a_cpu() {
    a_kept_plate_is_refined(&Device::cpu);
}

#[cfg(feature = "wgpu")]
#[test]
fn a_kept_plate_is_refined_on_a_gpu() {
    use downpour::gpu::{AdapterChoice, Gpu};
    let gpu = Gpu::open(&AdapterChoice::Auto).unwrap();
    a_kept_plate_is_refined(&|| Device::gpu(gpu.clone(), false));
}

/// Pixels for a display are those of the frame of the time.
#[test]
fn a_frame_for_a_display_is_the_frame() {
    let weather = changed(&[]);
    for device in [Backend::Cpu.device(), Backend::Auto.device()] {
        let device = device.unwrap();
        let mut display = opened(&weather, &fast(), device.clone());
        let mut frames = opened(&weather, &fast(), device);
        for time_s in [0.5, 0.6] {
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
