//! The tone curve that keeps hues.
//!
//! Brightness is compressed by the curve of [`tone_neutral`], all channels by one factor. Colors go toward white by their stops
//! over the shoulder, as on film, in linear light; their hue in Oklab (Ottosson 2020, <https://bottosson.github.io/posts/oklab>) is then
//! put back to what it was, and it is mixed with gray where the display has no such color. So bright red becomes light red, not orange or
//! pink. Neutral colors and all below the shoulder have the values of [`tone_neutral`].

use downpour_math::color::color_luminance;
use downpour_math::ops;
use downpour_shaders::render::tone::{TONE_HALF_WHITE_STOPS, TONE_MAX_CHANNEL, TONE_START};
use glam::{Mat3, Vec2, Vec3};

use super::{tone_compressed, tone_lifted, tone_neutral};

/// Linear BT.709 to the cone responses of Oklab.
const CONES: Mat3 = Mat3::from_cols_array(&[
    0.412_221_46,
    0.211_903_5,
    0.088_302_46,
    0.536_332_55,
    0.680_699_5,
    0.281_718_85,
    0.051_445_995,
    0.107_396_96,
    0.629_978_7,
]);
/// Cube roots of cone responses to lightness, green-red and blue-yellow.
const OPPONENT: Mat3 = Mat3::from_cols_array(&[
    0.210_454_26,
    1.977_998_5,
    0.025_904_037,
    0.793_617_8,
    -2.428_592_2,
    0.782_771_77,
    -0.004_072_047,
    0.450_593_7,
    -0.808_675_77,
]);
/// Lightness, green-red and blue-yellow to cube roots of cone responses.
const CONE_ROOTS: Mat3 = Mat3::from_cols_array(&[
    1.0,
    1.0,
    1.0,
    0.396_337_78,
    -0.105_561_346,
    -0.089_484_18,
    0.215_803_76,
    -0.063_854_17,
    -1.291_485_5,
]);
/// Cone responses to linear BT.709.
const PRIMARIES: Mat3 = Mat3::from_cols_array(&[
    4.076_741_7,
    -1.268_438,
    -0.004_196_086_3,
    -3.307_711_6,
    2.609_757_4,
    -0.703_418_6,
    0.230_969_93,
    -0.341_319_4,
    1.707_614_7,
]);

/// Oklab of a linear color: lightness, green-red, blue-yellow.
#[must_use]
pub fn tone_oklab(color: Vec3) -> Vec3 {
    let [l, m, s] = (CONES * color).to_array().map(ops::cbrt);
    OPPONENT * Vec3::new(l, m, s)
}

/// Linear color of an Oklab color.
#[must_use]
pub fn tone_linear(lab: Vec3) -> Vec3 {
    let roots = CONE_ROOTS * lab;
    PRIMARIES * (roots * roots * roots)
}

/// A color within the display: one that is not is mixed with gray of its luminance, as little as that takes. So there are no steps,
/// even where the display's colors of a hue have a dent.
#[must_use]
pub fn tone_within(color: Vec3) -> Vec3 {
    let gray = color_luminance(color.into()).clamp(0.0, 1.0);
    let (low, high) = (color.min_element(), color.max_element());
    let below = if low < 0.0 { gray / (gray - low) } else { 1.0 };
    let above = if high > 1.0 { (1.0 - gray) / (high - gray) } else { 1.0 };
    Vec3::splat(gray).lerp(color, below.min(above)).clamp(Vec3::ZERO, Vec3::ONE)
}

/// Fraction of white in a color whose largest channel is `peak`.
#[must_use]
pub fn tone_whiteness(peak: f32) -> f32 {
    let stops = ops::log2(peak / TONE_START) / TONE_HALF_WHITE_STOPS;
    let cube = stops * stops * stops;
    cube / (cube + 1.0)
}

/// A color of the lightness and chroma of `color` and the hue of `like`, both linear; paler where the display has none so strong.
#[must_use]
pub fn tone_with_hue(color: Vec3, like: Vec3) -> Vec3 {
    let (lab, wanted) = (tone_oklab(color), tone_oklab(like));
    let chroma = ops::hypot(lab.y, lab.z);
    let strength = ops::hypot(wanted.y, wanted.z);
    if strength < 1.0e-5 {
        return color;
    }
    let turned = Vec2::new(wanted.y, wanted.z) * (chroma / strength);
    tone_within(tone_linear(Vec3::new(lab.x, turned.x, turned.y)))
}

/// Applies the tone curve that keeps hues in Oklab; the result is in [0, 1]. Equal channels, and colors below the shoulder, become what
/// [`tone_neutral`] makes of them.
#[must_use]
pub fn tone_hue(color: Vec3) -> Vec3 {
    let color = color.max(Vec3::ZERO);
    if color.max_element() <= color.min_element() {
        return tone_neutral(color);
    }
    let lifted = tone_lifted(color.min(Vec3::splat(TONE_MAX_CHANNEL)));
    let peak = lifted.max_element();
    if peak < TONE_START {
        return lifted;
    }
    let most = tone_compressed(peak);
    let scaled = lifted * (most / peak);
    let toned = scaled.lerp(Vec3::splat(most), tone_whiteness(peak));
    tone_with_hue(toned, scaled)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oklab in f64 by the formula as published, a reference beside the code.
    fn reference(color: Vec3) -> [f64; 3] {
        let [r, g, b] = color.as_dvec3().to_array();
        let l = root(0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b);
        let m = root(0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b);
        let s = root(0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b);
        [
            0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
            1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
            0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
        ]
    }

    fn root(v: f64) -> f64 {
        downpour_math::ops::f64::cbrt(v)
    }

    fn hue_deg(color: Vec3) -> f64 {
        let [_, a, b] = reference(color);
        downpour_math::ops::f64::atan2(b, a).to_degrees()
    }

    fn chroma(color: Vec3) -> f64 {
        let [_, a, b] = reference(color);
        (a * a + b * b).sqrt()
    }

    /// Tail light, turn signal, traffic light, police light, a lamp of 2700 K, primaries and secondaries.
    const EMITTERS: [[f32; 3]; 11] = [
        [1.0, 0.03, 0.02],
        [1.0, 0.35, 0.02],
        [0.05, 1.0, 0.25],
        [0.05, 0.12, 1.0],
        [1.0, 0.62, 0.26],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.6],
        [0.0, 0.8, 1.0],
        [1.0, 0.9, 0.1],
    ];

    #[test]
    fn hues_stay_and_the_neutral_curve_turns_them() {
        let mut turned = 0;
        for emitter in EMITTERS.map(Vec3::from) {
            for stops in [0, 1, 2, 3, 4, 6] {
                let bright = emitter * downpour_math::ops::exp2(stops as f32);
                let off = |toned: Vec3| {
                    let off = (hue_deg(toned) - hue_deg(bright)).rem_euclid(360.0);
                    off.min(360.0 - off)
                };
                assert!(off(tone_hue(bright)) < 5.0, "{emitter} {stops}: {}", off(tone_hue(bright)));
                turned += usize::from(off(tone_neutral(bright)) > 10.0);
            }
        }
        assert!(turned > 5, "{turned}");
    }

    #[test]
    fn colors_whiten_with_brightness() {
        for emitter in EMITTERS.map(Vec3::from) {
            let at = |stops: f32| tone_hue(emitter * downpour_math::ops::exp2(stops));
            let mut last = chroma(at(1.0));
            for stops in 2..=20 {
                let now = chroma(at(stops as f32));
                assert!(now <= last + 1.0e-4, "{emitter}: {stops} stops have {now} after {last}");
                last = now;
            }
            // Four stops over there is color; at the top there is next to none.
            assert!(chroma(at(4.0)) > 0.4 * chroma(at(0.0)), "{emitter}");
            assert!(last < 0.02, "{emitter}: {last}");
        }
        let red = tone_hue(Vec3::new(64.0, 0.6, 0.5));
        assert!(
            red.x > 0.97 && (0.3..0.8).contains(&red.y) && red.z < red.y && red.y - red.z < 0.12,
            "{red}"
        );
    }

    #[test]
    fn neutral_and_dim_colors_are_those_of_the_neutral_curve() {
        for step in 0..4000u32 {
            let gray = Vec3::splat(downpour_math::ops::exp2(step as f32 / 100.0 - 20.0));
            assert_eq!(tone_hue(gray), tone_neutral(gray));
        }
        let dim = Vec3::new(0.7, 0.3, 0.01);
        assert_eq!(tone_hue(dim), tone_neutral(dim));
        for odd in
            [Vec3::ZERO, Vec3::splat(-1.0), Vec3::new(f32::NAN, 1.0, 2.0), Vec3::new(f32::INFINITY, 1.0, 0.0)]
        {
            let toned = tone_hue(odd);
            assert!(
                toned.is_finite() && toned.min_element() >= 0.0 && toned.max_element() <= 1.0,
                "{odd}: {toned}"
            );
        }
    }

    #[test]
    fn the_curve_has_no_steps() {
        // Along brightness and from gray to color, a thousandth of a stop or of a color changes a channel by less than a hundredth.
        for emitter in EMITTERS.map(Vec3::from) {
            let at = |stops: f32| tone_hue(emitter * downpour_math::ops::exp2(stops));
            for step in -4000..16_000 {
                let stops = step as f32 * 1.0e-3;
                let change = (at(stops + 1.0e-3) - at(stops)).abs().max_element();
                assert!(change < 0.01, "{emitter}: {stops} stops: {change}");
            }
            for step in 0..1000 {
                let mixed = |k: f32| tone_hue(Vec3::splat(3.0).lerp(emitter * 3.0, k * 1.0e-3));
                let change = (mixed(step as f32 + 1.0) - mixed(step as f32)).abs().max_element();
                assert!(change < 0.01, "{emitter}: {step}: {change}");
            }
        }
    }
}
