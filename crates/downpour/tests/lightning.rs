//! Lightning in frames: light that adds up, exposure, streaks, order of frames, and the limit, measured on pixels.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fmt::Write as _;

use downpour::math::ops::f64::tan;
use downpour::render::flashing::FlashMeter;
use downpour::scene::Budget;
use downpour::{Backend, Frame, Renderer, RendererOptions, Source};
use glam::DVec3;

const DARK: &str = "[sky]\ncolor = [0, 0, 0]\n";

const DUSK: &str =
    "[sky]\nzenith_color = [4, 5, 6]\n[[light]]\npoint = { position_m = [1, 3, -6], intensity_cd = 300 }\n";

const CAMERA: &str =
    "[camera]\nposition_m = [0, 1.6, 0]\nfov_deg = 40\nshutter_s = 0.02\n[output]\nsize = [40, 30]\n";

/// A flash that shines for all of the shutter, almost evenly.
const LONG: &str = "[[flash]]\ntime_s = -0.2\nazimuth_deg = -70\nelevation_deg = 25\nilluminance_lux = 900\nrise_ms = 0\n\
                    decay_ms = 1000\ncolor = [0.5, 0.75, 1]\n";

fn renderer(text: &str) -> Renderer {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    std::fs::write(&path, text).unwrap();
    let source = Source::read(&path, &[], &mut Budget::default()).unwrap();
    let options = RendererOptions { samples: 1, ..RendererOptions::default() };
    Renderer::new(source.weather, source.loaded, options, Backend::Cpu.device().unwrap()).unwrap()
}

fn frame(text: &str, time_s: f64) -> Frame {
    renderer(text).frame(time_s).unwrap()
}

/// Largest difference of two pictures over the largest value of the second.
fn apart(a: &[[f32; 3]], b: &[[f32; 3]]) -> f32 {
    let most = b.as_flattened().iter().fold(0.0f32, |most, v| most.max(v.abs()));
    let difference = a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| (a - b).abs());
    difference.fold(0.0, f32::max) / most
}

/// A frame with a flash less the frame without it is the flash alone, in clean layer and picture; and in an eye as in a camera.
#[test]
fn a_flash_adds_its_light() {
    let rain = "[rain]\nrate_mm_h = 60\n";
    let eye = CAMERA.replace("shutter_s = 0.02", "observer = \"eye\"");
    let short = LONG.replace("1000", "4").replace("-0.2", "-0.003");
    for (camera, flash) in [(CAMERA, LONG), (&eye, &short)] {
        let with = frame(&format!("{rain}{DUSK}{camera}{flash}"), 0.0).radiance();
        let without = frame(&format!("{rain}{DUSK}{camera}"), 0.0).radiance();
        let alone = frame(&format!("{rain}{DARK}{camera}{flash}"), 0.0).radiance();
        let difference: Vec<[f32; 3]> =
            with.iter().zip(&without).map(|(a, b)| std::array::from_fn(|k| a[k] - b[k])).collect();
        assert!(apart(&difference, &alone) < 1.0e-4, "{}", apart(&difference, &alone));
        assert!(apart(&with, &without) > 0.1, "a control");
    }
}

/// A flash of even light without clouds is a lamp of parallel light, rain and all; four times the lux are four times the radiance.
#[test]
fn a_flash_is_parallel_light() {
    // 900 exp(-0.2), by the mean over 20 ms.
    let lux = 900.0 * 0.818_730_753 * 1.000_016_7;
    let down = [-0.309_975_519, -0.422_618_262, 0.851_650_740];
    let flash = format!("{LONG}clouds = 0\n");
    let lamp = format!(
        "[[light]]\ndirectional = {{ direction = [{}, {}, {}], illuminance_lux = {lux}, color = [0.5, 0.75, 1] }}\n",
        down[0], down[1], down[2]
    );
    for rain in ["[rain]\nrate_mm_h = 0\n", "[rain]\nrate_mm_h = 60\n"] {
        let of_flash = frame(&format!("{rain}{DARK}{CAMERA}{flash}"), 0.0).radiance();
        let of_lamp = frame(&format!("{rain}{DARK}{CAMERA}{lamp}"), 0.0).radiance();
        if rain.contains("60") {
            assert!(apart(&of_flash, &of_lamp) < 0.02, "{}", apart(&of_flash, &of_lamp));
            let mean = |picture: &[[f32; 3]]| picture.as_flattened().iter().sum::<f32>();
            assert!((mean(&of_flash) / mean(&of_lamp) - 1.0).abs() < 1.0e-3);
        } else {
            assert!(of_flash.as_flattened().iter().all(|v| *v == 0.0), "nothing is there to be lit");
        }
    }
    let brighter = flash.replace("900", "3600");
    let [one, four] = [flash, brighter]
        .map(|flash| frame(&format!("[rain]\nrate_mm_h = 60\n{DARK}{CAMERA}{flash}"), 0.0).radiance());
    let scaled: Vec<[f32; 3]> = one.iter().map(|pixel| pixel.map(|v| 4.0 * v)).collect();
    assert!(apart(&four, &scaled) < 1.0e-5);
}

/// A clip that begins in a flash is exposed as one that does not; frame k alone is frame k of the clip, after the flash too.
#[test]
fn a_flash_leaves_no_trace() {
    let text =
        format!("[rain]\nrate_mm_h = 30\n{DUSK}{CAMERA}{}", LONG.replace("1000", "4").replace("-0.2", "0.0"));
    let mut clip = renderer(&text);
    let times = [0.0, 0.04, 0.08, 0.004];
    let frames: Vec<Frame> = times.iter().map(|time_s| clip.frame(*time_s).unwrap()).collect();
    let dark = frame(&text.replace("900", "0"), 0.0);
    assert_eq!((frames[0].exposure, frames[1].exposure), (dark.exposure, dark.exposure));
    assert!(apart(&frames[0].radiance(), &dark.radiance()) > 0.1);
    for (time_s, made) in times.iter().zip(&frames) {
        assert_eq!(frame(&text, *time_s).radiance(), made.radiance(), "{time_s}");
    }
    assert_eq!(frames[2].radiance(), frame(&text.replace("900", "0"), 0.08).radiance());
}

/// Streaks in a flash are as long as the drop falls while it shines, at the part of its path where it is then.
#[test]
fn a_flash_lights_a_part_of_a_streak() {
    let camera =
        "[camera]\nposition_m = [0, 1.6, 0]\nfov_deg = 12\nshutter_s = 0.05\n[output]\nsize = [480, 640]\n";
    // Only drops that are drawn are listed.
    let rain = "[rain]\nrate_mm_h = 6\nunresolved = 'even'\n";
    // 2 ms of light from 10 ms before the middle of the exposure on; and a control that shines all the time.
    let flash = "[[flash]]\ntime_s = 2.99\nazimuth_deg = -60\nelevation_deg = 25\nilluminance_lux = 9000\nrise_ms = 0\n\
                 decay_ms = 1\nclouds = 0\n";
    let long = flash.replace("decay_ms = 1", "decay_ms = 1000").replace("2.99", "2.9");
    let short = frame(&format!("{rain}{DARK}{camera}{flash}"), 3.0);
    let even = frame(&format!("{rain}{DARK}{camera}{long}"), 3.0);
    let whole = light_near(&short, [-0.01, -0.008]);
    assert!(whole > 0.98, "{whole}");
    // Streaks are not shorter either.
    let half = light_near(&short, [-0.01, -0.009]).max(light_near(&short, [-0.009, -0.008]));
    assert!(half < 0.9, "{half}");
    let control = light_near(&even, [-0.01, -0.008]);
    assert!(control < 0.5, "{control}");
}

/// Fraction of the light of a picture from 1.6 m height along -Z with 12 degrees of height that is near drops, between two times
/// relative to its own.
fn light_near(frame: &Frame, [from_s, to_s]: [f64; 2]) -> f64 {
    let [width, height] = frame.size().map(|edge| edge as usize);
    let middle = [width, height].map(|edge| 0.5 * edge as f64);
    let focal = middle[1] / tan(6.0f64.to_radians());
    let lit: Vec<f32> = frame.radiance().iter().map(|[_, g, _]| *g).collect();
    let mut near = vec![false; lit.len()];
    for drop in &frame.drops.drops {
        for step in 0..=40 {
            let time = from_s + (to_s - from_s) * f64::from(step) / 40.0 - f64::from(drop.seen_s());
            let velocity = DVec3::from(drop.velocity.map(f64::from));
            let seen = drop.position + velocity * time - DVec3::new(0.0, 1.6, 0.0);
            if seen.z > -0.3 {
                continue;
            }
            let at = [middle[0] + focal * seen.x / -seen.z, middle[1] - focal * seen.y / -seen.z];
            let radius = 0.6 * f64::from(drop.diameter) * focal / -seen.z + 1.5;
            let first = at.map(|v| (v - radius).floor().max(0.0) as usize);
            let last = at.map(|v| (v + radius).ceil().max(0.0) as usize);
            for y in first[1]..last[1].min(height) {
                for x in first[0]..last[0].min(width) {
                    near[y * width + x] = true;
                }
            }
        }
    }
    // The haze of drops that are not drawn one by one is even.
    let floor = median(&lit) + 0.02 * lit.iter().copied().fold(0.0, f32::max);
    let (mut inside, mut all) = (0.0, 0.0);
    for (value, is_near) in lit.iter().zip(near) {
        let light = f64::from((value - floor).max(0.0));
        all += light;
        inside += if is_near { light } else { 0.0 };
    }
    inside / all
}

fn median(values: &[f32]) -> f32 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f32::total_cmp);
    sorted[sorted.len() / 2]
}

/// Eight strong strokes in a second: no second of the frames has more than three general flashes, and without the limit it has.
#[test]
fn the_limit_is_kept_by_the_pixels() {
    let mut flashes = String::new();
    for k in 0..12 {
        writeln!(
            flashes,
            "[[flash]]\ntime_s = {}\nazimuth_deg = -90\nelevation_deg = 20\nilluminance_lux = 2000\ndecay_ms = 12\nclouds = 2",
            0.05 + 0.125 * f64::from(k)
        )
        .unwrap();
    }
    let text = format!("[rain]\nrate_mm_h = 0\n{DUSK}{}", CAMERA.replace("[40, 30]", "[24, 18]"));
    let worst = |limit: bool| {
        let mut clip = renderer(&format!("[lightning]\nlimit = {limit}\n{text}{flashes}"));
        let mut meter = FlashMeter::new(30.0);
        for k in 0..50 {
            let frame = clip.frame(f64::from(k) / 30.0).unwrap();
            meter.add_frame(frame.size(), &frame.pixels());
        }
        meter.worst_second()
    };
    assert!((1..=3).contains(&worst(true)), "{}", worst(true));
    assert!(worst(false) > 3, "a control: {}", worst(false));
}
