//! Photographs of skies: the sun of the park holds most of its light.

use crate::folder;
use downpour_scene::Budget;
use downpour_scene::sky::{SUN_THRESHOLD, read_sky};

pub(crate) fn photographs_of_skies() {
    for (file, sun_fraction) in [
        ("rooitou_park_1k.hdr", Some(0.5..0.8)),
        ("kiara_1_dawn_1k.hdr", None),
        ("potsdamer_platz_1k.hdr", None),
        ("dikhololo_night_1k.hdr", None),
    ] {
        let mut sky = read_sky(&folder("hdr").join(file), &mut Budget::default()).expect(file);
        assert_eq!((sky.width, sky.height), (1024, 512));
        let before = sky.mean_radiance();
        let sun = sky.extract_sun(SUN_THRESHOLD);
        let after = sky.mean_radiance();
        let fraction = 1.0 - after[1] / before[1];
        println!("{file}: mean {before:?}, {fraction:.3} of green in {sun:?}");
        if let Some(expected) = sun_fraction {
            assert!(expected.contains(&fraction), "{file}: {fraction}");
            let sun = sun.expect("a sun in the park");
            assert!(sun.direction[1] > 0.1 && sun.angular_radius < 0.03, "{sun:?}");
        }
        if let Some(sun) = sun {
            let whole = after[1] + f64::from(sun.irradiance_rgb[1]) / (4.0 * std::f64::consts::PI);
            assert!((whole / before[1] - 1.0).abs() < 1e-3, "{whole} {before:?}");
        }
    }
}
