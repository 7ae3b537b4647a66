//! Colors whose lightness says how much.

use downpour_math::ops;

/// Linear light for a fraction of the scale, 0 to 1: from a dark blue over green to a light yellow.
pub(super) fn of_speed(fraction: f32) -> [f32; 3] {
    let fraction = if fraction > 0.0 { fraction.min(1.0) } else { 0.0 };
    let lightness = 0.24 + 0.65 * fraction;
    let hue = (282.0 - 180.0 * fraction).to_radians();
    let (a, b) = (ops::cos(hue), ops::sin(hue));
    let within = |chroma: f32| {
        let color = from_oklab(lightness, chroma * a, chroma * b);
        color.iter().all(|c| (0.0..=1.0).contains(c)).then_some(color)
    };
    // Less colorful until it is a color that a screen has. By halves: steps would show as lines.
    let (mut inside, mut outside) = (0.0, 0.115 + 0.03 * fraction);
    if let Some(color) = within(outside) {
        return color;
    }
    for _ in 0..14 {
        let middle = 0.5 * (inside + outside);
        if within(middle).is_some() { inside = middle } else { outside = middle }
    }
    within(inside).unwrap_or([fraction; 3])
}

/// Linear sRGB of a color in Oklab (B. Ottosson, "A perceptual color space for image processing", 2020).
fn from_oklab(lightness: f32, a: f32, b: f32) -> [f32; 3] {
    let cube = |x: f32| x * x * x;
    let l = cube(lightness + 0.396_337_78 * a + 0.215_803_76 * b);
    let m = cube(lightness - 0.105_561_346 * a - 0.063_854_17 * b);
    let s = cube(lightness - 0.089_484_18 * a - 1.291_485_5 * b);
    [
        4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_94 * s,
        -1.268_438 * l + 2.609_757_4 * m - 0.341_319_4 * s,
        -0.004_196_086_3 * l - 0.703_418_6 * m + 1.707_614_7 * s,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// More wind is lighter, evenly in L* of CIE 1976 as well, and every color is one of the screen.
    #[test]
    fn lightness_rises_with_the_speed() {
        let lightness = |fraction: f32| {
            let [r, g, b] = of_speed(fraction);
            116.0 * ops::cbrt(0.2126 * r + 0.7152 * g + 0.0722 * b) - 16.0
        };
        let steps: Vec<f32> =
            (0u8..50).map(|k| lightness(f32::from(k + 1) / 50.0) - lightness(f32::from(k) / 50.0)).collect();
        assert!(steps.iter().all(|step| (0.8..2.4).contains(step)), "{steps:?}");
        for bad in [f32::NAN, -1.0] {
            assert_eq!(of_speed(bad), of_speed(0.0));
        }
        assert_eq!(of_speed(f32::INFINITY), of_speed(1.0));
        assert!(lightness(0.0) < 20.0 && lightness(1.0) > 80.0);
    }
}
