//! Arrows that say which way along a streak the wind blows.

use super::Flow;
use super::canvas::Canvas;

/// From one arrow to the next, in pixels of a letter's dot.
const SPACING: f32 = 44.0;

/// Draws arrows on a lattice whose rows are shifted; their length goes with the root of the speed in the slice.
pub(super) fn draw(canvas: &mut Canvas, flow: &Flow, dot: f32) {
    let spacing = SPACING * dot;
    let (mut y, mut odd) = (0.5 * spacing, false);
    while y < flow.rows as f32 {
        let mut x = if odd { spacing } else { 0.5 * spacing };
        while x < flow.columns as f32 {
            if let Some([u, v]) = flow.at(x, y) {
                let speed = (u * u + v * v).sqrt();
                let fraction = (speed / flow.scale).min(1.0);
                if fraction > 0.005 {
                    let long = (0.18 + 0.62 * fraction.sqrt()) * spacing;
                    arrow(canvas, flow, [x, y], [u / speed, v / speed], long, dot);
                }
            }
            x += spacing;
        }
        y += spacing;
        odd = !odd;
    }
}

/// An arrow about a position: a dark one, and a white one within.
fn arrow(canvas: &mut Canvas, flow: &Flow, [x, y]: [f32; 2], [u, v]: [f32; 2], long: f32, dot: f32) {
    let half = 0.5 * long;
    let tip = [x + half * u, y + half * v];
    let tail = [x - half * u, y - half * v];
    let head = (0.35 * long).min(7.0 * dot);
    let barb = |side: f32| {
        let (back, aside) = (0.87 * head, 0.5 * head * side);
        [tip[0] - back * u - aside * v, tip[1] - back * v + aside * u]
    };
    let lines = [[tail, tip], [barb(1.0), tip], [barb(-1.0), tip]];
    let reach = half + 2.0 * dot + 1.0;
    let range = |middle: f32, end: usize| {
        let low = (middle - reach).max(0.0) as usize;
        low..((middle + reach).max(0.0) as usize + 1).min(end)
    };
    for row in range(y, flow.rows) {
        for column in range(x, flow.columns) {
            let at = [column as f32 + 0.5, row as f32 + 0.5];
            let away = lines.iter().map(|line| distance(at, *line)).fold(f32::INFINITY, f32::min);
            let cover = |width: f32| (0.5 + width - away).clamp(0.0, 1.0);
            canvas.blend(column, row, [0.0; 3], 0.8 * cover(1.4 * dot));
            canvas.blend(column, row, [1.0; 3], cover(0.55 * dot));
        }
    }
}

/// Distance of a point from the segment between two others.
fn distance([x, y]: [f32; 2], [[ax, ay], [bx, by]]: [[f32; 2]; 2]) -> f32 {
    let (dx, dy) = (bx - ax, by - ay);
    let squared = (dx * dx + dy * dy).max(1.0e-12);
    let fraction = (((x - ax) * dx + (y - ay) * dy) / squared).clamp(0.0, 1.0);
    let (ex, ey) = (x - ax - fraction * dx, y - ay - fraction * dy);
    (ex * ex + ey * ey).sqrt()
}
