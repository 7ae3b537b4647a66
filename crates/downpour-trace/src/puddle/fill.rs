//! Hollows of the ground, filled up to where they spill.
//!
//! Law: water stands as high as the lowest way out lets it. The heights of all ways out are found from the border inwards,
//! lowest first (R. Barnes et al., Priority-Flood, Computers & Geosciences 62, 2014). Cells of the border and cells without
//! ground let water out.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Ground as a grid of cells, row by row, and the degree of filling.
#[derive(Clone, Copy, Debug)]
pub struct Hollows<'a> {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Height of each cell, m; a number that is not finite has no ground.
    pub ground: &'a [f32],
    /// Fraction of the depth to which hollows are filled: 0 nothing, 1 until they spill.
    pub fraction: f32,
    /// Maximum depth of water, m: deeper hollows are filled less.
    pub deepest: f32,
    /// Minimum depth of a hollow that holds water, m.
    pub least: f32,
}

/// The level of the water over each cell, m; `None` on land.
#[must_use]
pub fn fill(hollows: &Hollows<'_>) -> Vec<Option<f32>> {
    let spill = spill_levels(hollows);
    let [columns, rows] = hollows.size;
    let mut levels = vec![None; columns * rows];
    let mut known = vec![false; columns * rows];
    let (mut basin, mut ahead) = (Vec::new(), Vec::new());
    for start in 0..columns * rows {
        let floods = |cell: usize| spill[cell] > hollows.ground[cell];
        if known[start] || !floods(start) {
            continue;
        }
        // Cells that touch have one level: each is a way out for the other.
        basin.clear();
        ahead.push(start);
        known[start] = true;
        while let Some(cell) = ahead.pop() {
            basin.push(cell);
            for next in neighbors(hollows.size, cell) {
                if !known[next] && floods(next) {
                    known[next] = true;
                    ahead.push(next);
                }
            }
        }
        let bottom = basin.iter().map(|&cell| hollows.ground[cell]).fold(f32::INFINITY, f32::min);
        let deep = ((spill[start] - bottom) * hollows.fraction).min(hollows.deepest);
        if deep < hollows.least {
            continue;
        }
        let level = bottom + deep;
        for &cell in &basin {
            if hollows.ground[cell] < level {
                levels[cell] = Some(level);
            }
        }
    }
    levels
}

/// The height that water reaches over each cell before it runs out: the ground itself where it runs off at once.
fn spill_levels(hollows: &Hollows<'_>) -> Vec<f32> {
    let [columns, rows] = hollows.size;
    let ground = |cell: usize| hollows.ground.get(cell).copied().filter(|h| h.is_finite());
    let mut levels = vec![f32::INFINITY; columns * rows];
    let mut open = BinaryHeap::new();
    let mut let_out = |cell: usize, level: f32, levels: &mut Vec<f32>| {
        levels[cell] = level;
        // Ties by number: the same order everywhere.
        open.push(Reverse((ordered(level), cell)));
    };
    for cell in 0..columns * rows {
        let (x, y) = (cell % columns, cell / columns);
        let border = x == 0 || y == 0 || x + 1 == columns || y + 1 == rows;
        match ground(cell) {
            None => let_out(cell, f32::NEG_INFINITY, &mut levels),
            Some(height) if border => let_out(cell, height, &mut levels),
            Some(_) => {}
        }
    }
    while let Some(Reverse((_, cell))) = open.pop() {
        for next in neighbors(hollows.size, cell) {
            if levels[next] == f32::INFINITY {
                let own = ground(next).unwrap_or(f32::NEG_INFINITY);
                levels[next] = own.max(levels[cell]);
                open.push(Reverse((ordered(levels[next]), next)));
            }
        }
    }
    levels
}

/// A whole number that is in the same order as the numbers.
fn ordered(level: f32) -> u32 {
    let bits = level.to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

/// The four cells beside a cell.
fn neighbors([columns, rows]: [usize; 2], cell: usize) -> impl Iterator<Item = usize> {
    let (x, y) = (cell % columns, cell / columns);
    let beside = [
        (x > 0).then(|| cell - 1),
        (x + 1 < columns).then_some(cell + 1),
        (y > 0).then(|| cell - columns),
        (y + 1 < rows).then_some(cell + columns),
    ];
    beside.into_iter().flatten()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;

    fn filled(size: [usize; 2], fraction: f32, ground: impl Fn(f32, f32) -> f32) -> Vec<Option<f32>> {
        let ground: Vec<f32> =
            (0..size[0] * size[1]).map(|i| ground((i % size[0]) as f32, (i / size[0]) as f32)).collect();
        fill(&Hollows { size, ground: &ground, fraction, deepest: 10.0, least: 1.0e-3 })
    }

    /// Two bowls whose rims are at 1 and at 2, the second with a notch at 1.5.
    #[test]
    fn a_bowl_fills_up_to_the_lowest_part_of_its_rim() {
        let ground = |x: f32, y: f32| {
            let bowl = |cx: f32, rim: f32| rim * (Vec2::new(x - cx, y - 10.0).length() / 6.0).min(1.0);
            if x < 15.0 {
                bowl(8.0, 1.0)
            } else if y == 10.0 && x > 22.0 {
                bowl(22.0, 2.0).min(1.5)
            } else {
                bowl(22.0, 2.0)
            }
        };
        let levels = filled([30, 20], 1.0, ground);
        assert!((levels[10 * 30 + 8].expect("water") - 1.0).abs() < 1.0e-6);
        assert!((levels[10 * 30 + 22].expect("water") - 1.5).abs() < 1.0e-6);
        assert_eq!(levels[0], None);
        // No water above its ground's level, and none that could run off.
        let half = filled([30, 20], 0.5, ground);
        assert!((half[10 * 30 + 8].expect("water") - 0.5).abs() < 1.0e-6);
        assert!(half.iter().flatten().count() < levels.iter().flatten().count());
    }

    #[test]
    fn a_slope_and_a_hollow_with_a_hole_hold_nothing() {
        assert!(filled([20, 20], 1.0, |x, y| 0.01 * x + 0.02 * y).iter().all(Option::is_none));
        let holed = |x: f32, y: f32| {
            if (x, y) == (10.0, 10.0) { f32::NAN } else { 0.1 * Vec2::new(x - 10.0, y - 10.0).length() }
        };
        assert!(filled([21, 21], 1.0, holed).iter().all(Option::is_none));
    }

    #[test]
    fn shallow_hollows_stay_dry_and_deep_ones_have_an_end() {
        let ground: Vec<f32> =
            (0..400u16).map(|i| if (5..8).contains(&(i % 20)) && i / 20 == 9 { -2.0 } else { 0.0 }).collect();
        let levels = |deepest, least| {
            fill(&Hollows { size: [20, 20], ground: &ground, fraction: 1.0, deepest, least })[9 * 20 + 6]
        };
        assert_eq!(levels(10.0, 0.1), Some(0.0));
        assert_eq!(levels(0.5, 0.1), Some(-1.5));
        assert_eq!(levels(10.0, 2.5), None);
    }
}
