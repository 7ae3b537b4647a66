//! Rainfall as layers of a texture, the form of Tatarchuk & Isidoro 2006, in whole pictures.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use downpour::scene::Budget;
use downpour::scene::sandbox::NoFiles;
use downpour::weather::{Weather, load};
use downpour::{Device, Frame, Renderer, RendererOptions};

/// A renderer before an even sky.
fn renderer(rest: &str, size: [u32; 2]) -> Renderer {
    let text = format!(
        "[rain]\nlayers = 'tatarchuk-2006'\n{rest}\n[sky]\ncolor = [0.5, 0.5, 0.5]\n[camera]\nposition_m = [0, 1.7, 0]\n\
         fov_deg = 40\n[glow]\nglare = 0\ndiffraction = false\n[output]\nsize = [{}, {}]\n",
        size[0], size[1]
    );
    let weather = Weather::parse("layers.toml", &text).unwrap();
    let loaded = load(&weather, &NoFiles, &mut Budget::default()).unwrap();
    let options = RendererOptions { samples: 1, sky_rays: 1, ..RendererOptions::default() };
    Renderer::new(weather, loaded, options, Device::cpu()).unwrap()
}

/// A picture of it at a time, s.
fn frame(rest: &str, size: [u32; 2], time_s: f64) -> Frame {
    renderer(rest, size).frame(time_s).unwrap()
}

fn transmittances(frame: &Frame) -> Vec<f32> {
    frame.picture.rain.iter().map(|pixel| pixel[3]).collect()
}

/// Rows by which a picture of 160 x 120 pixels is most like that of a moment before.
fn rows_fallen(first: &[f32], later: &[f32]) -> usize {
    let apart = |rows: usize| {
        let pairs = first.iter().zip(&later[rows * 160..]);
        pairs.map(|(a, b)| f64::from((a - b).abs())).sum::<f64>() / f64::from(120 - rows as u32)
    };
    (0..30).min_by(|&a, &b| apart(a).total_cmp(&apart(b))).unwrap()
}

/// Before an even sky layers cannot be seen: what they take out they show. Without drops there is nothing else.
#[test]
fn layers_vanish_in_even_light() {
    let frame = frame("rate_mm_h = 100", [160, 120], 0.3);
    assert_eq!(frame.picture.drawn.len(), 0);
    let (rain, clean) = (&frame.picture.rain, &frame.picture.clean);
    let deepest = transmittances(&frame).into_iter().fold(1.0f32, f32::min);
    assert!(deepest < 0.8, "{deepest}");
    for (rain, clean) in rain.iter().zip(clean) {
        let seen = rain[1] + rain[3] * clean[1];
        // Unresolved rain shows the mean of its table, which is within that.
        assert!((seen / clean[1] - 1.0).abs() < 5.0e-3, "{rain:?} before {clean:?}");
    }
}

/// Layers take out, in the mean, as much as the drops do between the nearest and the farthest, at any resolution.
#[test]
fn layers_take_out_what_the_drops_there_do() {
    for (rate, size) in [(25.0, [160, 120]), (25.0, [320, 240]), (100.0, [160, 120])] {
        let rate = format!("rate_mm_h = {rate}\n");
        // Unresolved rain is behind both; layers 10 cm deep take out next to nothing.
        let without = frame(&format!("{rate}[layers]\nparallax = 1.1"), size, 0.3);
        let behind = transmittances(&without);
        let mut renderer = renderer(&format!("{rate}[layers]\nparallax = 9"), size);
        // Some cells of a picture are a small sample of all.
        let mut found = 0.0;
        for k in 0..8u32 {
            let with = transmittances(&renderer.frame(f64::from(k) * 1.7).unwrap());
            let taken = with.iter().zip(&behind).map(|(with, behind)| f64::from(1.0 - with / behind));
            found += taken.sum::<f64>() / (8.0 * behind.len() as f64);
        }
        let expected = 1.0 - downpour::math::ops::f64::exp(-without.medium.extinction() * 7.9);
        println!("{rate:?} {size:?}: {found:.4} of {expected:.4}");
        assert!((found / expected - 1.0).abs() < 0.04, "{rate:?} {size:?}: {found}, not {expected}");
    }
}

/// A layer falls over the picture as fast as a drop at its distance would: a picture is like that of a moment before, moved down.
#[test]
fn layers_fall_with_the_rain() {
    // All layers are 1 to 1.1 m away; a pixel is 6 mm there.
    let at = |time_s| {
        let look = "rate_mm_h = 60\n[layers]\nparallax = 1.1\n[look]\nvisibility = 20\nstreak_length = 0.2";
        transmittances(&frame(look, [160, 120], time_s))
    };
    let (first, later) = (at(1.0), at(1.01));
    let best = rows_fallen(&first, &later);
    // 6 cm.
    println!("{best} rows");
    assert!((8..=10).contains(&best), "{best}");
    assert!(at(1.0) == first);
}

/// In gusts and in a rain whose rate changes, layers go on falling from picture to picture.
#[test]
fn layers_do_not_jump() {
    let rest = "rate_mm_h = [[40, 60], [41, 90]]\n[layers]\nparallax = 1.1\n[look]\nvisibility = 20\nstreak_length = 0.2\n\
                [[wind]]\nuniform = { speed_m_s = [[40, 0], [41, 0.2]], towards_deg = 90 }";
    let mut renderer = renderer(rest, [160, 120]);
    let [first, later] = [40.0, 40.01].map(|time_s| transmittances(&renderer.frame(time_s).unwrap()));
    let best = rows_fallen(&first, &later);
    println!("{best} rows");
    assert!((8..=10).contains(&best), "{best}");
}
