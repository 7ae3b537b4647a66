//! Spray of a weather: its keys, and from frame to frame.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod model;

use downpour::scene::Budget;
use downpour::{Device, Frame, Renderer, RendererOptions, Source};

/// A slab of 2 m x 2 m in front of the eye, whose top is at its height, in heavy rain.
const SLAB: &str = "
[sky]
zenith_color = [0.5, 0.5, 0.5]
[camera]
position_m = [0, 1.02, 6]
look_at_m = [0, 1.02, 0]
fov_deg = 8
[glow]
glare = 0
diffraction = false
[output]
size = [48, 36]
";

fn renderer(rain: &str, model: &str) -> Renderer {
    renderer_of(rain, model, SLAB)
}

fn renderer_of(rain: &str, model: &str, rest: &str) -> Renderer {
    let folder = tempfile::tempdir().unwrap();
    let positions = [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]];
    model::write(folder.path(), &positions, &[0, 2, 1, 0, 3, 2]).unwrap();
    let text = format!("model = [{{ file = 'floor.gltf', {model} }}]\n[rain]\nseed = 7\n{rain}\n{rest}");
    std::fs::write(folder.path().join("a.toml"), text).unwrap();
    let source = Source::read(&folder.path().join("a.toml"), &[], &mut Budget::default()).unwrap();
    let options = RendererOptions { samples: 1, sky_rays: 1, ..RendererOptions::default() };
    Renderer::new(source.weather, source.loaded, options, Device::cpu()).unwrap()
}

const STANDS: &str = "translation_m = [0, 1, 0]";

/// Mean optical depth that one frame has and another has not.
fn more(with: &Frame, without: &Frame) -> f64 {
    let depth = |pixel: &[f32; 4]| -downpour::math::ops::f64::ln(f64::from(pixel[3].max(1.0e-3)));
    let pairs = with.picture.rain.iter().zip(&without.picture.rain);
    pairs.map(|(with, without)| depth(with) - depth(without)).sum::<f64>() / with.picture.rain.len() as f64
}

fn frame(rain: &str, time_s: f64) -> Frame {
    renderer(rain, STANDS).frame(time_s).unwrap()
}

/// Both multipliers are factors of the spray, with keys, and a rate that changes is that of the time.
#[test]
fn spray_is_as_dense_as_rain_and_look_say() {
    let rain = "rate_mm_h = 60\nunresolved = 'even'\n[spray]\nenabled = true\n";
    let (plain, none) = (frame(rain, 0.5), frame("rate_mm_h = 60\nunresolved = 'even'\n", 0.5));
    let depth = more(&plain, &none);
    // The ray along the slab is 2 m long.
    assert!((0.01..0.2).contains(&depth), "{depth}");
    let twice = frame(&format!("{rain}[look]\nspray = [[0, 1], [1, 3]]\n"), 0.5);
    assert!((more(&twice, &none) / depth - 2.0).abs() < 0.01, "{} and {depth}", more(&twice, &none));
    let hidden = frame(&format!("{rain}[look]\nspray = 0\n"), 0.5);
    assert!(hidden.picture.rain == none.picture.rain);
    // At 0.5 s the rate is as before; without drops there is the spray of it alone.
    let keyed = |spray: &str| {
        let rain = format!("rate_mm_h = [[0, 30], [1, 90]]\nunresolved = 'even'\n{spray}");
        renderer(&rain, STANDS).frame(0.5).unwrap()
    };
    let changing = more(&keyed("[spray]\nenabled = true\n"), &keyed(""));
    assert!((changing / depth - 1.0).abs() < 0.02, "{changing} and {depth}");
}

/// A frame by itself is that of a clip, before an eye that moves over cells of the map.
#[test]
fn a_frame_by_itself_is_that_of_a_clip() {
    let rain = "rate_mm_h = 60\n[spray]\nenabled = true\n";
    let path =
        SLAB.replace("position_m = [0, 1.02, 6]", "position_m = [[0, [0, 1.02, 6]], [1, [0.7, 1.3, 5]]]");
    assert!(path != SLAB);
    let mut clip = renderer_of(rain, STANDS, &path);
    let frames: Vec<Frame> = [0.25, 0.5, 1.0].map(|time_s| clip.frame(time_s).unwrap()).into();
    let alone = renderer_of(rain, STANDS, &path).frame(1.0).unwrap();
    assert!(alone.picture.rain == frames[2].picture.rain && alone.picture.clean == frames[2].picture.clean);
    let none = renderer_of("rate_mm_h = 60\n", STANDS, &path).frame(1.0).unwrap();
    assert!(more(&alone, &none) > 1.0e-3, "{}", more(&alone, &none));
}
