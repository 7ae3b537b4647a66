//! Artistic multipliers: rain that is more or less visible than it is, and streaks that are longer, in pictures of the whole.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use downpour::scene::Budget;
use downpour::scene::sandbox::NoFiles;
use downpour::weather::{Weather, load};
use downpour::{Device, Frame, Renderer, RendererOptions};

/// A picture at a time of a shower before an open sky.
fn frame(rain: &str, look: &str, time_s: f64) -> Frame {
    let text = format!(
        "[rain]\nrate_mm_h = 20\n{rain}\n[look]\n{look}\n[sky]\nzenith_color = [0.5, 0.5, 0.5]\n[camera]\nposition_m = [0, 1.7, 0]\n\
         fov_deg = 40\n[glow]\nglare = 0\ndiffraction = false\n[output]\nsize = [160, 120]\n"
    );
    let weather = Weather::parse("look.toml", &text).unwrap();
    let loaded = load(&weather, &NoFiles, &mut Budget::default()).unwrap();
    let options = RendererOptions { samples: 1, sky_rays: 1, ..RendererOptions::default() };
    Renderer::new(weather, loaded, options, Device::cpu()).unwrap().frame(time_s).unwrap()
}

/// Mean optical depth of the rain.
fn taken(frame: &Frame) -> f64 {
    let layer = &frame.picture.rain;
    layer.iter().map(|pixel| -downpour::math::ops::f64::ln(f64::from(pixel[3].max(0.01)))).sum::<f64>()
        / layer.len() as f64
}

/// Mean of the rain's own light.
fn given(frame: &Frame) -> f64 {
    let layer = &frame.picture.rain;
    layer.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>() / layer.len() as f64
}

/// Share of the pixels in which a drop is seen before the mean of what is not drawn.
fn touched(frame: &Frame) -> f64 {
    let layer = &frame.picture.rain;
    let clearest = layer.iter().fold(0.0f32, |most, pixel| most.max(pixel[3]));
    let touched = layer.iter().filter(|pixel| pixel[3] < clearest - 1.0e-3).count();
    touched as f64 / layer.len() as f64
}

/// Rain takes out and gives the multiple that is asked, drawn and not drawn alike; that of 0 cannot be seen.
#[test]
fn visibility_is_a_multiple_of_the_light() {
    for drawn in ["unresolved = 'even'", "unresolved = 'even'\nmax_drops = 40"] {
        let physical = frame(drawn, "", 0.5);
        for factor in [0.5, 2.0] {
            let shown = frame(drawn, &format!("visibility = {factor}"), 0.5);
            // Rain that takes out more hides a little of the rain behind it.
            for (name, of, tolerance) in [("taken", taken as fn(&Frame) -> f64, 0.01), ("given", given, 0.03)]
            {
                let ratio = of(&shown) / (factor * of(&physical));
                println!("{drawn:?}, {factor}: {name} {ratio:.4}");
                assert!((ratio - 1.0).abs() < tolerance, "{drawn:?}, {factor}: {name} {ratio}");
            }
            assert_eq!(shown.picture.drawn.len(), physical.picture.drawn.len());
            assert!(shown.picture.clean == physical.picture.clean);
        }
        let none = frame(drawn, "visibility = 0", 0.5);
        assert!(none.picture.rain.iter().all(|pixel| *pixel == [0.0, 0.0, 0.0, 1.0]), "{drawn:?}");
    }
    // Whatever the picture draws one by one, of what is twice as visible.
    let [all, few] = ["", "max_drops = 40"].map(|drawn| frame(drawn, "visibility = 2", 0.5));
    let ratio = taken(&few) / taken(&all);
    assert!((ratio - 1.0).abs() < 0.08, "{ratio}");
}

/// Streaks of three times the length touch more pixels and take out as much light in all, step by step too.
#[test]
fn streaks_are_longer() {
    for volume in ["closed-form", "view"] {
        let rain = format!("volume = '{volume}'\nunresolved = 'even'");
        let [short, long] = ["", "streak_length = 3"].map(|look| frame(&rain, look, 0.5));
        let (ratio, wider) = (taken(&long) / taken(&short), touched(&long) / touched(&short));
        println!("{volume}: light {ratio:.3}, pixels {wider:.2}");
        assert!((ratio - 1.0).abs() < 0.06, "{volume}: {ratio}");
        assert!(wider > 1.3, "{volume}: {wider}");
    }
}

/// Multipliers follow their keys.
#[test]
fn multipliers_have_keys() {
    let keyed = "visibility = [[0, 0], [1, 2]]\nstreak_length = [[0, 0], [1, 6]]";
    let plain = "visibility = 1\nstreak_length = 3";
    assert!(frame("", keyed, 0.5).picture.rain == frame("", plain, 0.5).picture.rain);
    // Step by step the drops are those of the longest exposure.
    let ratio = taken(&frame("volume = 'view'", keyed, 0.5)) / taken(&frame("volume = 'view'", plain, 0.5));
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
}
