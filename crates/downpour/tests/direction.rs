//! Keyframes of a weather file in frames: a frame is that of a weather with the values of its time.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use downpour::scene::Budget;
use downpour::{Backend, Frame, Renderer, RendererOptions, Source};

/// A sky that darkens, a lamp that lights up and moves, a zoom.
fn text(sky: &str, lux: &str, lamp: &str, fov: &str, ev: &str) -> String {
    format!(
        "
[rain]
rate_mm_h = 60
[sky]
zenith_color = [0.4, 0.45, 0.5]
intensity = {sky}
[sun]
azimuth_deg = 250
elevation_deg = 30
illuminance_lux = {lux}
[[light]]
point = {{ position_m = [0.5, 1.6, -4], intensity_cd = {lamp} }}
[camera]
position_m = [0, 1.6, 0]
fov_deg = {fov}
exposure_ev = {ev}
[output]
size = [48, 32]
"
    )
}

fn keyed() -> String {
    text(
        "[[0, 1], [4, 0.5]]",
        "[[0, 3], [4, 1]]",
        "[[0, 1], [4, 9]]",
        "[[0, 30], [4, 50]]",
        "[[0, 0], [4, 2]]",
    )
}

/// The same with the values at 2 s.
fn plain() -> String {
    text("0.75", "2", "5", "40", "0")
}

fn renderer(text: &str, first_s: f64) -> Renderer {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    std::fs::write(&path, text).unwrap();
    let source = Source::read(&path, &[], &mut Budget::default()).unwrap();
    let options = RendererOptions { first_s, ..RendererOptions::default() };
    Renderer::new(source.weather, source.loaded, options, Backend::Cpu.device().unwrap()).unwrap()
}

fn bits(frame: &Frame) -> Vec<[u32; 3]> {
    frame.radiance().iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

#[test]
fn a_frame_alone_is_the_frame_of_a_clip_and_that_of_its_values() {
    let mut clip = renderer(&keyed(), 0.0);
    let frames: Vec<Frame> = [0.0, 1.0, 2.0].map(|time| clip.frame(time).unwrap()).into();
    let exposure = clip.exposure();
    let mut alone = renderer(&keyed(), 2.0);
    alone.set_exposure(exposure);
    let alone = alone.frame(2.0).unwrap();
    assert_eq!(bits(&alone), bits(&frames[2]));
    assert_eq!(alone.png().unwrap(), frames[2].png().unwrap());
    // The same weather without keys: exact but for the exposure, which is one stop more than at time 0.
    let mut values = renderer(&plain(), 2.0);
    values.set_exposure(exposure);
    let values = values.frame(2.0).unwrap();
    assert_eq!(bits(&values), bits(&alone));
    assert!((alone.exposure / values.exposure - 2.0).abs() < 1.0e-6);
    assert_ne!(bits(&frames[0]), bits(&alone));
    // Earlier frames after later ones.
    assert_eq!(bits(&clip.frame(1.0).unwrap()), bits(&frames[1]));
}
