//! The board over a shop: capital letters drawn as strokes.

use crate::noise::{fractal, mix, mix3, smooth};
use crate::raster::Raster;

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
        'D' => (
            0.64,
            &[&[
                [0.0, 0.0],
                [0.0, 1.0],
                [0.26, 1.0],
                [0.50, 0.88],
                [0.64, 0.62],
                [0.64, 0.38],
                [0.50, 0.12],
                [0.26, 0.0],
                [0.0, 0.0],
            ]],
        ),
        'E' => (0.48, &[&[[0.48, 0.0], [0.0, 0.0], [0.0, 1.0], [0.48, 1.0]], &[[0.0, 0.52], [0.40, 0.52]]]),
        'F' => (0.48, &[&[[0.0, 0.0], [0.0, 1.0], [0.48, 1.0]], &[[0.0, 0.52], [0.40, 0.52]]]),
        'G' => (0.68, &[ROUND_C, &[[0.40, 0.46], [0.66, 0.46], [0.66, 0.17]]]),
        'H' => {
            (0.62, &[&[[0.0, 0.0], [0.0, 1.0]], &[[0.62, 0.0], [0.62, 1.0]], &[[0.0, 0.52], [0.62, 0.52]]])
        }
        'I' => (0.0, &[&[[0.0, 0.0], [0.0, 1.0]]]),
        'K' => {
            (0.58, &[&[[0.0, 0.0], [0.0, 1.0]], &[[0.54, 1.0], [0.0, 0.40]], &[[0.17, 0.58], [0.58, 0.0]]])
        }
        'L' => (0.46, &[&[[0.0, 1.0], [0.0, 0.0], [0.46, 0.0]]]),
        'M' => (0.76, &[&[[0.0, 0.0], [0.06, 1.0], [0.38, 0.25], [0.70, 1.0], [0.76, 0.0]]]),
        'N' => (0.62, &[&[[0.0, 0.0], [0.0, 1.0], [0.62, 0.0], [0.62, 1.0]]]),
        'O' => (0.72, &[ROUND_O]),
        'P' => (
            0.52,
            &[&[
                [0.0, 0.0],
                [0.0, 1.0],
                [0.32, 1.0],
                [0.48, 0.92],
                [0.52, 0.76],
                [0.48, 0.58],
                [0.32, 0.50],
                [0.0, 0.50],
            ]],
        ),
        'Q' => (0.72, &[ROUND_O, &[[0.44, 0.24], [0.74, -0.06]]]),
        'R' => (
            0.56,
            &[
                &[
                    [0.0, 0.0],
                    [0.0, 1.0],
                    [0.32, 1.0],
                    [0.48, 0.92],
                    [0.52, 0.76],
                    [0.48, 0.60],
                    [0.32, 0.52],
                    [0.0, 0.52],
                ],
                &[[0.28, 0.52], [0.56, 0.0]],
            ],
        ),
        'S' => (0.54, &[ROUND_S]),
        'T' => (0.60, &[&[[0.0, 1.0], [0.60, 1.0]], &[[0.30, 1.0], [0.30, 0.0]]]),
        'U' => (
            0.60,
            &[&[[0.0, 1.0], [0.0, 0.30], [0.08, 0.10], [0.30, 0.0], [0.52, 0.10], [0.60, 0.30], [0.60, 1.0]]],
        ),
        'V' => (0.66, &[&[[0.0, 1.0], [0.33, 0.0], [0.66, 1.0]]]),
        'X' => (0.60, &[&[[0.0, 0.0], [0.60, 1.0]], &[[0.0, 1.0], [0.60, 0.0]]]),
        'Y' => (0.62, &[&[[0.0, 1.0], [0.31, 0.48], [0.62, 1.0]], &[[0.31, 0.48], [0.31, 0.0]]]),
        _ => (0.30, &[]),
    }
}

/// Distance of a point to a segment.
fn distance(p: [f32; 2], a: [f32; 2], b: [f32; 2]) -> f32 {
    let (e, q) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let t = ((q[0] * e[0] + q[1] * e[1]) / (e[0] * e[0] + e[1] * e[1])).clamp(0.0, 1.0);
    let d = [q[0] - e[0] * t, q[1] - e[1] * t];
    (d[0] * d[0] + d[1] * d[1]).sqrt()
}

/// A board: word, ink and ground.
type Board = (&'static str, [f32; 3], [f32; 3]);

const GOLD: [f32; 3] = [0.60, 0.46, 0.20];
const CREAM: [f32; 3] = [0.62, 0.57, 0.46];
const BLACK: [f32; 3] = [0.03, 0.03, 0.03];

/// Boards of shops.
const BOARDS: [Board; 16] = [
    ("BOULANGERIE", GOLD, [0.10, 0.055, 0.03]),
    ("CAFE DU PONT", CREAM, [0.13, 0.022, 0.02]),
    ("LIBRAIRIE", GOLD, [0.018, 0.045, 0.035]),
    ("FLEURS", [0.10, 0.15, 0.08], [0.50, 0.50, 0.43]),
    ("PHARMACIE", CREAM, [0.02, 0.09, 0.05]),
    ("TABAC", CREAM, [0.12, 0.025, 0.02]),
    ("FROMAGERIE", [0.12, 0.09, 0.05], [0.55, 0.48, 0.32]),
    ("CAVE A VINS", GOLD, [0.06, 0.015, 0.025]),
    ("COIFFEUR", BLACK, [0.48, 0.47, 0.44]),
    ("BISTROT", GOLD, [0.016, 0.02, 0.032]),
    ("EPICERIE", CREAM, [0.022, 0.05, 0.09]),
    ("ANTIQUITES", GOLD, [0.03, 0.03, 0.028]),
    ("HORLOGER", CREAM, [0.04, 0.055, 0.06]),
    ("PATISSERIE", [0.16, 0.06, 0.07], [0.52, 0.42, 0.38]),
    ("MERCERIE", CREAM, [0.05, 0.035, 0.07]),
    ("HOTEL", GOLD, [0.08, 0.02, 0.02]),
];

/// Number of boards, one above the other.
pub(crate) const SIGNS: u32 = BOARDS.len() as u32;

/// All boards, each of 8 : 1 with a word in its middle.
pub(super) fn signs() -> Raster {
    Raster::new(512, 64 * SIGNS, |u, v| {
        let y = v * SIGNS as f32;
        let k = (y.floor() as usize).min(BOARDS.len() - 1);
        board(&BOARDS[k], u, y - k as f32)
    })
}

fn board(&(word, ink, ground): &Board, u: f32, v: f32) -> [f32; 4] {
    const HEIGHT: f32 = 0.46;
    const GAP: f32 = 0.42;
    let width: f32 = word.chars().map(|c| letter(c).0 + GAP).sum::<f32>() - GAP;
    // In letter heights, from the lower left of the word; long words are set narrower.
    let narrow = (width * HEIGHT / 7.2).max(1.0);
    let x = (u - 0.5) * 8.0 / HEIGHT * narrow + width / 2.0;
    let y = (0.5 - v) / HEIGHT + 0.5;
    let mut nearest = f32::MAX;
    let mut start = 0.0;
    for c in word.chars() {
        let (wide, strokes) = letter(c);
        if (start - 0.3..start + wide + 0.3).contains(&x) {
            for stroke in strokes {
                for pair in stroke.windows(2) {
                    nearest = nearest.min(distance([x - start, y], pair[0], pair[1]));
                }
            }
        }
        start += wide + GAP;
    }
    let border = (u * 8.0).min((1.0 - u) * 8.0).min(v).min(1.0 - v);
    let line = smooth(0.05, 0.06, border) * smooth(0.10, 0.09, border);
    let inked = smooth(0.11, 0.07, nearest).max(line * 0.7);
    let worn = mix(0.8, 1.1, fractal(u, v, [64, 8], 3, 161)) * mix(0.85, 1.05, fractal(u, v, [6, 2], 3, 162));
    let [r, g, b] = mix3(ground, ink, inked).map(|c| c * worn);
    [r, g, b, 1.0]
}
