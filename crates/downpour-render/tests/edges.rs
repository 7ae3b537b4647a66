//! Edges of things far brighter than white, in pictures to look at.

use downpour_math::color::srgb_to_linear;
use downpour_math::ops;
use downpour_render::tone::{Tone, ToneCurve, ToneEdges, ToneLayers, tone_picture};

const SIZE: [u32; 2] = [48, 48];

fn shown(radiance: &[[f32; 3]], glow: &[[f32; 4]], curve: ToneCurve, edges: ToneEdges) -> Vec<[u8; 3]> {
    tone_picture(&ToneLayers { size: SIZE, radiance, glow }, &Tone { exposure: 1.0, curve, edges })
}

/// Pixels by their column and row.
fn picture<T>(of: impl Fn(f32, f32) -> T) -> Vec<T> {
    let [width, height] = SIZE;
    (0..width * height).map(|i| of((i % width) as f32, (i / width) as f32)).collect()
}

/// Fraction of `grid` x `grid` samples of a pixel that are inside.
fn coverage(x: f32, y: f32, grid: u32, inside: impl Fn(f32, f32) -> bool) -> f32 {
    let at = |k: u32| (k as f32 + 0.5) / grid as f32;
    let samples = (0..grid * grid).filter(|k| inside(x + at(k % grid), y + at(k / grid)));
    samples.count() as f32 / (grid * grid) as f32
}

/// Light of the display, 0 to 1, of a gray pixel.
fn light([_, green, _]: [u8; 3]) -> f32 {
    srgb_to_linear(f32::from(green) / 255.0)
}

/// A half-plane of 1000 times white at any slope: the light of the display is the coverage, within 0.05 in any pixel and 0.02 in the mean
/// of an edge's pixels, at 2 x 2 samples and at 8 x 8; the linear mean is white for any coverage.
#[test]
fn an_edge_shows_its_coverage() {
    let (mut worst, mut worst_mean) = (0.0f32, 0.0f32);
    for (grid, tenths) in [2, 4, 8].into_iter().flat_map(|grid| (0..=30).map(move |tenths| (grid, tenths))) {
        let slope = tenths as f32 * 0.1 - 1.5;
        let covered = picture(|x, y| coverage(x, y, grid, |x, y| y - 24.0 > slope * (x - 24.0) + 0.03));
        let radiance: Vec<[f32; 3]> = covered.iter().map(|c| [0.02 + c * 999.98; 3]).collect();
        let [linear, aware] = [ToneEdges::Linear, ToneEdges::ToneAware]
            .map(|edges| shown(&radiance, &[], ToneCurve::Hue, edges));
        let white = light(shown(&[[1000.0; 3]; 48 * 48], &[], ToneCurve::Hue, ToneEdges::Linear)[0]);
        let (mut sum, mut count) = (0.0, 0.0f32);
        for (i, &c) in covered.iter().enumerate() {
            let [x, y] = [i % 48, i / 48].map(|at| at as i32 - 24);
            if !(0.0 < c && c < 1.0) || x.abs() > 20 || y.abs() > 20 {
                continue;
            }
            assert!(light(linear[i]) > 0.95 * white, "{slope}: {c} clips");
            let off = (light(aware[i]) / white - c).abs();
            worst = worst.max(off);
            sum += off;
            count += 1.0;
        }
        worst_mean = worst_mean.max(sum / count.max(1.0));
        // Across the edge light only rises.
        for pair in (0..47 * 48).map(|i| [aware[i], aware[i + 48]]) {
            assert!(light(pair[1]) >= light(pair[0]), "{grid} {slope}: {pair:?}");
        }
    }
    println!("coverage off by {worst} at most, {worst_mean} in the mean of an edge");
    assert!(worst < 0.05 && worst_mean < 0.02, "{worst}, {worst_mean}");
}

/// Nothing is brighter than white: the bytes are those of the linear mean.
#[test]
fn dim_and_flat_pictures_stay() {
    let dim = picture(|x, y| [x / 48.0, y / 48.0, if (x as u32).is_multiple_of(3) { 1.0 } else { 0.01 }]);
    let flat = picture(|_, _| [1000.0, 30.0, 2.0]);
    for (radiance, curve) in
        [&dim, &flat].into_iter().flat_map(|p| [(p, ToneCurve::Hue), (p, ToneCurve::KhronosNeutral)])
    {
        assert_eq!(
            shown(radiance, &[], curve, ToneEdges::ToneAware),
            shown(radiance, &[], curve, ToneEdges::Linear)
        );
    }
}

/// A plateau beside something brighter, upright lines and points of a pixel before the dark, and the texture of what is dim stay.
#[test]
fn plateaus_lines_points_and_texture_stay() {
    let plateau = picture(|x, _| {
        [if x < 16.0 {
            0.02
        } else if x < 32.0 {
            3.0
        } else {
            1000.0
        }; 3]
    });
    let line = picture(|x, _| {
        let covered = if x == 20.0 {
            0.3
        } else if x == 21.0 {
            0.7
        } else {
            0.0
        };
        [0.02 + 500.0 * covered; 3]
    });
    let point = picture(|x, y| [if x == 20.0 && y == 20.0 { 1000.0 } else { 0.02 }; 3]);
    let texture =
        picture(|x, y| [if x > 24.0 { 1000.0 } else { 0.2 + 0.01 * ((3.0 * x + 7.0 * y) % 5.0) }; 3]);
    for (name, radiance) in [("plateau", plateau), ("line", line), ("point", point), ("texture", texture)] {
        let [linear, aware] = [ToneEdges::Linear, ToneEdges::ToneAware]
            .map(|edges| shown(&radiance, &[], ToneCurve::Hue, edges));
        let differ: Vec<usize> = (0..linear.len()).filter(|&i| linear[i] != aware[i]).collect();
        assert!(differ.is_empty(), "{name}: {differ:?}");
    }
}

/// A slanted line of a pixel keeps its core, and what is taken at the ends of its steps leaves no less than the line covers.
#[test]
fn a_slanted_line_keeps_its_core() {
    let covered = picture(|x, y| (1.0 - (y - 0.3 * x - 10.0).abs()).max(0.0));
    let radiance: Vec<[f32; 3]> = covered.iter().map(|c| [0.02 + 500.0 * c; 3]).collect();
    let [linear, aware] =
        [ToneEdges::Linear, ToneEdges::ToneAware].map(|edges| shown(&radiance, &[], ToneCurve::Hue, edges));
    for i in 0..linear.len() {
        assert!(covered[i] < 0.5 || linear[i] == aware[i], "{i}: {} {:?}", covered[i], aware[i]);
        assert!(light(aware[i]) > 0.97 * covered[i], "{i}: {} {:?}", covered[i], aware[i]);
    }
}

/// The slope of something soft, a quarter as bright from pixel to pixel, keeps most of its light.
#[test]
fn slopes_of_soft_lights_stay() {
    let soft = picture(|x, _| [0.02 + 500.0 * ops::exp2(-2.0 * (x - 24.0).abs()); 3]);
    let [linear, aware] =
        [ToneEdges::Linear, ToneEdges::ToneAware].map(|edges| shown(&soft, &[], ToneCurve::Hue, edges));
    let kept = linear.iter().zip(&aware).map(|(&linear, &aware)| light(aware) / light(linear));
    let least = kept.fold(1.0, f32::min);
    println!("{least} of a slope's light is kept");
    assert!(least > 0.7, "{least}");
}

/// A pixel is never darker than the darkest of its neighbors, nor brighter than its linear mean: no ring.
#[test]
fn no_ring_appears() {
    let disk = picture(|x, y| {
        let covered = coverage(x, y, 4, |x, y| ops::hypot(x - 24.3, y - 23.8) < 9.0);
        let frame = coverage(x, y, 4, |x, y| ops::hypot(x - 24.3, y - 23.8) < 11.5);
        [
            0.05 + 2.0 * (frame - covered) + 300.0 * covered,
            0.05 + 1.5 * (frame - covered) + 200.0 * covered,
            0.06 + 100.0 * covered,
        ]
    });
    for curve in [ToneCurve::Hue, ToneCurve::KhronosNeutral] {
        let [linear, aware] =
            [ToneEdges::Linear, ToneEdges::ToneAware].map(|edges| shown(&disk, &[], curve, edges));
        let around = |i: usize| {
            [-49i32, -48, -47, -1, 0, 1, 47, 48, 49].map(|step| linear[(i as i32 + step) as usize])
        };
        let sum = |[r, g, b]: [u8; 3]| u32::from(r) + u32::from(g) + u32::from(b);
        for i in (2 * 48..46 * 48).filter(|i| (2..46).contains(&(i % 48))) {
            let least = around(i).map(sum).into_iter().min().unwrap();
            assert!(sum(aware[i]) + 1 >= least && sum(aware[i]) <= sum(linear[i]) + 1, "{i}: {:?}", aware[i]);
        }
    }
}

/// Glow is even over a pixel: edges in it end at the glow that is beside them, and a point of light keeps its halo.
#[test]
fn glow_is_no_coverage() {
    let center = 23.5f32;
    let light_at =
        |x: f32, y: f32, radius: f32| coverage(x, y, 2, |x, y| ops::hypot(x - center, y - center) < radius);
    for radius in [0.4, 5.3] {
        let glow = picture(|x, y| {
            let distance = ops::hypot(x + 0.5 - center, y + 0.5 - center);
            let outside = 1.0 + (distance - radius).max(0.0);
            let fall = 4.0 / (outside * outside);
            [fall - 10.0 * light_at(x, y, radius); 4]
        });
        let radiance: Vec<[f32; 3]> = picture(|x, y| 0.02 + 1000.0 * light_at(x, y, radius))
            .into_iter()
            .zip(&glow)
            .map(|(seen, glow)| [seen + glow[0]; 3])
            .collect();
        let [linear, aware] = [ToneEdges::Linear, ToneEdges::ToneAware]
            .map(|edges| shown(&radiance, &glow, ToneCurve::Hue, edges));
        for i in 48..47 * 48 {
            let covered = light_at((i % 48) as f32, (i / 48) as f32, radius);
            if covered == 0.0 {
                assert_eq!(linear[i], aware[i], "the halo stays");
                continue;
            }
            let beside = [i - 48, i - 1, i + 1, i + 48].map(|i| linear[i][1]).into_iter().min().unwrap();
            assert!(aware[i][1] >= beside, "{i}: {:?} beside {beside}", aware[i]);
        }
    }
}
