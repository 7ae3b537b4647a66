//! The board over a shop: capital letters drawn as strokes.

use crate::scenes::noise::{fractal, mix, mix3, smooth};
use crate::scenes::raster::Raster;

/// A stroke: points of a polyline in a box 1 high, from the lower left.
type Stroke = &'static [[f32; 2]];

/// Strokes and width of a letter.
fn letter(sign: char) -> (f32, &'static [Stroke]) {
    const ROUND_O: Stroke = &[
        [0.36, 0.0],
        [0.16, 0.07],
        [0.03, 0.27],
        [0.0, 0.5],
        [0.03, 0.73],
        [0.16, 0.93],
        [0.36, 1.0],
        [0.56, 0.93],
        [0.69, 0.73],
        [0.72, 0.5],
        [0.69, 0.27],
        [0.56, 0.07],
        [0.36, 0.0],
    ];
    const ROUND_C: Stroke = &[
        [0.66, 0.17],
        [0.53, 0.04],
        [0.36, 0.0],
        [0.16, 0.07],
        [0.03, 0.27],
        [0.0, 0.5],
        [0.03, 0.73],
        [0.16, 0.93],
        [0.36, 1.0],
        [0.53, 0.96],
        [0.66, 0.83],
    ];
    const ROUND_S: Stroke = &[
        [0.0, 0.14],
        [0.12, 0.03],
        [0.27, 0.0],
        [0.42, 0.04],
        [0.52, 0.16],
        [0.52, 0.31],
        [0.42, 0.43],
        [0.13, 0.57],
        [0.03, 0.69],
        [0.03, 0.84],
        [0.12, 0.96],
        [0.27, 1.0],
        [0.41, 0.97],
        [0.50, 0.87],
    ];
    match sign {
        'A' => (0.70, &[&[[0.0, 0.0], [0.35, 1.0], [0.70, 0.0]], &[[0.12, 0.34], [0.58, 0.34]]]),
        'B' => (
            0.56,
            &[
                &[
                    [0.0, 0.0],
                    [0.0, 1.0],
                    [0.30, 1.0],
                    [0.45, 0.92],
                    [0.50, 0.77],
                    [0.45, 0.62],
                    [0.30, 0.54],
                    [0.0, 0.54],
                ],
                &[[0.30, 0.54], [0.48, 0.46], [0.56, 0.28], [0.49, 0.08], [0.32, 0.0], [0.0, 0.0]],
            ],
        ),
        'C' => (0.66, &[ROUND_C]),
        'E' => (0.48, &[&[[0.48, 0.0], [0.0, 0.0], [0.0, 1.0], [0.48, 1.0]], &[[0.0, 0.52], [0.40, 0.52]]]),
        'F' => (0.48, &[&[[0.0, 0.0], [0.0, 1.0], [0.48, 1.0]], &[[0.0, 0.52], [0.40, 0.52]]]),
        'K' => {
            (0.58, &[&[[0.0, 0.0], [0.0, 1.0]], &[[0.54, 1.0], [0.0, 0.40]], &[[0.17, 0.58], [0.58, 0.0]]])
        }
        'O' => (0.72, &[ROUND_O]),
        'S' => (0.54, &[ROUND_S]),
        _ => (0.40, &[]),
    }
}

/// Distance of a point to a segment.
fn distance(p: [f32; 2], a: [f32; 2], b: [f32; 2]) -> f32 {
    let (e, q) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let t = ((q[0] * e[0] + q[1] * e[1]) / (e[0] * e[0] + e[1] * e[1])).clamp(0.0, 1.0);
    let d = [q[0] - e[0] * t, q[1] - e[1] * t];
    (d[0] * d[0] + d[1] * d[1]).sqrt()
}

/// A board of 8 : 1 with a word in its middle.
pub(super) fn sign(word: &str, ink: [f32; 3], ground: [f32; 3]) -> Raster {
    const HEIGHT: f32 = 0.52;
    const GAP: f32 = 0.42;
    let width: f32 = word.chars().map(|c| letter(c).0 + GAP).sum::<f32>() - GAP;
    Raster::new(512, 64, |u, v| {
        // In letter heights, from the lower left of the word.
        let x = (u - 0.5) * 8.0 / HEIGHT + width / 2.0;
        let y = (0.5 - v) / HEIGHT + 0.5;
        let mut nearest = f32::MAX;
        let mut start = 0.0;
        for c in word.chars() {
            let (wide, strokes) = letter(c);
            for stroke in strokes {
                for pair in stroke.windows(2) {
                    nearest = nearest.min(distance([x - start, y], pair[0], pair[1]));
                }
            }
            start += wide + GAP;
        }
        let border = (u * 8.0).min((1.0 - u) * 8.0).min(v).min(1.0 - v);
        let line = smooth(0.05, 0.06, border) * smooth(0.10, 0.09, border);
        let inked = smooth(0.10, 0.07, nearest).max(line * 0.7);
        let worn = mix(0.8, 1.1, fractal(u, v, [64, 8], 3, 161));
        let [r, g, b] = mix3(ground, ink, inked).map(|c| c * worn);
        [r, g, b, 1.0]
    })
}
