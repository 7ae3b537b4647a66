//! Hollows of the ground, filled by a part of their depth or by the rain that runs into them.
//!
//! Law: water stands no higher than the lowest way out lets it ([`Drainage`]). Each hollow has a catchment, and the rain on it less what
//! the ground keeps is the water in the hollow, up to where it spills. What spills runs on ([`running`](super::running)); it fills no
//! other hollow sooner than its own catchment does.

use rayon::prelude::*;

use super::drainage::{Drainage, neighbors};

/// Ground as a grid of cells, row by row.
#[derive(Clone, Copy, Debug)]
pub struct Hollows<'a> {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Height of each cell, m; a number that is not finite has no ground.
    pub ground: &'a [f32],
    /// Fraction of the rain that each cell gets.
    pub open: &'a [f32],
}

/// Water in the hollows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filling {
    /// Fraction of the depth: 0 nothing, 1 until they spill.
    Fraction(f32),
    /// Water of a rain, a time without it, and a rain after that.
    Rain {
        /// Depth of water that has run off level ground before, m.
        before_m: f32,
        /// Depth of water that has evaporated and seeped away since, m.
        lost_m: f32,
        /// Depth of water that has run off after that, m.
        since_m: f32,
    },
}

/// Limits of the water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FillLimits {
    /// Maximum depth of water, m: deeper hollows are filled less.
    pub deepest: f32,
    /// Minimum depth of water that stands, m.
    pub least: f32,
}

/// Cells that one water may cover.
#[derive(Clone, Debug, PartialEq)]
pub struct Basin {
    /// Cells, the lowest first.
    cells: Vec<u32>,
    /// Heights of the cells, m.
    heights: Vec<f32>,
    /// Height at which it spills, m.
    spill: f32,
    /// Number of cells whose rain runs into it, each by the fraction of the rain that it gets.
    catchment: f32,
}

/// The hollows of some ground, and whose water they get.
#[derive(Clone, Debug, PartialEq)]
pub struct Basins {
    /// The hollows.
    pub basins: Vec<Basin>,
    /// For each cell the hollow that its water comes to first, its own for the cells of a hollow; [`NO_BASIN`]: it runs off.
    pub(super) of_cell: Vec<u32>,
}

/// The water of a cell comes to no hollow.
pub(super) const NO_BASIN: u32 = u32::MAX;

impl Basin {
    /// Level, m, of the water that fills it.
    #[must_use]
    pub fn level(&self, filling: &Filling, limits: &FillLimits) -> f32 {
        let bottom = self.heights.first().copied().unwrap_or(self.spill);
        let most = self.spill.min(bottom + limits.deepest);
        match *filling {
            Filling::Fraction(fraction) => bottom + ((self.spill - bottom) * fraction).min(limits.deepest),
            Filling::Rain { before_m, lost_m, since_m } => {
                let first = self.level_of(f64::from(before_m * self.catchment)).min(most);
                let left = (first - lost_m).max(bottom);
                self.level_of(self.volume(left) + f64::from(since_m * self.catchment)).min(most)
            }
        }
    }

    /// Height at which it spills, m.
    pub(super) fn spill(&self) -> f32 {
        self.spill
    }

    /// Height of the way out over the lowest cell, m.
    pub(super) fn depth(&self) -> f32 {
        self.heights.first().map_or(0.0, |bottom| self.spill - bottom)
    }

    /// Its cells, the lowest first.
    pub(super) fn cells(&self) -> &[u32] {
        &self.cells
    }

    /// Volume of the water at a level, m, in cells times m.
    fn volume(&self, level: f32) -> f64 {
        self.heights
            .iter()
            .take_while(|&&height| height < level)
            .map(|&h| f64::from(level) - f64::from(h))
            .sum()
    }

    /// Level, m, of a volume, in cells times m.
    fn level_of(&self, volume: f64) -> f32 {
        // With k cells under water, its surface is the mean of their heights plus the volume over them.
        let (mut sum, mut level) = (0.0, f64::from(self.spill));
        for (count, &height) in (1u32..).zip(&self.heights) {
            sum += f64::from(height);
            level = (volume + sum) / f64::from(count);
            if self.heights.get(count as usize).is_none_or(|&next| f64::from(next) >= level) {
                break;
            }
        }
        level as f32
    }
}

/// The hollows of some ground.
#[must_use]
pub fn basins(hollows: &Hollows<'_>, drainage: &Drainage) -> Basins {
    let Drainage { spill, order, next } = drainage;
    let [columns, rows] = hollows.size;
    let mut basins: Vec<Basin> = Vec::new();
    let mut of_cell = vec![NO_BASIN; columns * rows];
    let mut ahead = Vec::new();
    for start in 0..columns * rows {
        let floods = |cell: usize| spill[cell] > hollows.ground[cell];
        if of_cell[start] != NO_BASIN || !floods(start) {
            continue;
        }
        // Cells that touch have one level: each is a way out for the other.
        let mut cells = Vec::new();
        ahead.push(start);
        of_cell[start] = basins.len() as u32;
        while let Some(cell) = ahead.pop() {
            cells.push(cell as u32);
            for beside in neighbors(hollows.size, cell) {
                if of_cell[beside] == NO_BASIN && floods(beside) {
                    of_cell[beside] = basins.len() as u32;
                    ahead.push(beside);
                }
            }
        }
        let height = |cell: u32| hollows.ground[cell as usize];
        cells.sort_unstable_by(|&a, &b| height(a).total_cmp(&height(b)).then(a.cmp(&b)));
        let heights = cells.iter().map(|&cell| height(cell)).collect();
        basins.push(Basin { cells, heights, spill: spill[start], catchment: 0.0 });
    }
    // A cell's water goes where that of the cell goes that it runs to: those are found before it.
    for &cell in order {
        if of_cell[cell] == NO_BASIN {
            of_cell[cell] = next[cell].map_or(NO_BASIN, |next| of_cell[next]);
        }
        if let Some(basin) = basins.get_mut(of_cell[cell] as usize) {
            basin.catchment += hollows.open[cell];
        }
    }
    Basins { basins, of_cell }
}

/// The level, m, of the water in each hollow; `None` where it is too shallow to stand.
#[must_use]
pub fn levels(basins: &[Basin], filling: &Filling, limits: &FillLimits) -> Vec<Option<f32>> {
    let of_basin = |basin: &Basin| {
        let level = basin.level(filling, limits);
        let bottom = basin.heights.first().copied().unwrap_or(level);
        (level - bottom >= limits.least).then_some(level)
    };
    basins.par_iter().map(of_basin).collect()
}

/// The level of the water over each cell, m, with hollows filled to some [`levels`]; `None` on land.
#[must_use]
pub fn fill(count: usize, basins: &[Basin], filled: &[Option<f32>]) -> Vec<Option<f32>> {
    let mut levels = vec![None; count];
    for (basin, level) in basins.iter().zip(filled) {
        let Some(level) = *level else { continue };
        for (&cell, _) in basin.cells.iter().zip(&basin.heights).take_while(|&(_, &height)| height < level) {
            levels[cell as usize] = Some(level);
        }
    }
    levels
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;

    fn found(hollows: &Hollows<'_>) -> Vec<Basin> {
        basins(hollows, &Drainage::new(hollows)).basins
    }

    fn filled(size: [usize; 2], fraction: f32, ground: impl Fn(f32, f32) -> f32) -> Vec<Option<f32>> {
        let ground: Vec<f32> =
            (0..size[0] * size[1]).map(|i| ground((i % size[0]) as f32, (i / size[0]) as f32)).collect();
        let open = vec![1.0; ground.len()];
        let basins = found(&Hollows { size, ground: &ground, open: &open });
        let limits = FillLimits { deepest: 10.0, least: 1.0e-3 };
        fill(ground.len(), &basins, &levels(&basins, &Filling::Fraction(fraction), &limits))
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
            let basins = found(&Hollows { size: [20, 20], ground: &ground, open: &[1.0; 400] });
            let limits = FillLimits { deepest, least };
            fill(400, &basins, &levels(&basins, &Filling::Fraction(1.0), &limits))[9 * 20 + 6]
        };
        assert_eq!(levels(10.0, 0.1), Some(0.0));
        assert_eq!(levels(0.5, 0.1), Some(-1.5));
        assert_eq!(levels(10.0, 2.5), None);
    }

    /// A box of 5 x 4 cells, 0.1 m deep, in the middle of a funnel that is 13 x 12 cells wide up to its ridge, in ground that slopes
    /// away.
    fn funnel() -> Vec<f32> {
        (0..40u16 * 30)
            .map(|i| {
                let (x, y) = (f32::from(i % 40), f32::from(i / 40));
                let (dx, dy) = ((x - 19.0).abs() - 2.0, (y - 14.5).abs() - 1.5);
                let outside = dx.max(dy);
                let rim = 5.0;
                if outside <= 0.0 {
                    -0.1
                } else if outside <= rim {
                    0.001 * outside
                } else {
                    0.001 * rim - 0.002 * (outside - rim)
                }
            })
            .collect()
    }

    #[test]
    fn rain_fills_a_hollow_from_its_catchment() {
        let ground = funnel();
        let basins = found(&Hollows { size: [40, 30], ground: &ground, open: &[1.0; 1200] });
        assert_eq!(basins.len(), 1);
        let catchment = 13.0 * 12.0;
        assert!((basins[0].catchment - catchment).abs() < 1.0, "{}", basins[0].catchment);
        let limits = FillLimits { deepest: 10.0, least: 1.0e-4 };
        let level = |before_m, lost_m, since_m| {
            basins[0].level(&Filling::Rain { before_m, lost_m, since_m }, &limits)
        };
        // 4 mm on 156 cells in 20 cells.
        let deep = 0.004 * catchment / 20.0;
        assert!((level(0.004, 0.0, 0.0) - (deep - 0.1)).abs() < 1.0e-5);
        assert!((level(0.004, 0.01, 0.0) - (deep - 0.11)).abs() < 1.0e-5);
        assert!((level(0.004, 0.01, 0.001) - (deep - 0.11 + 0.001 * catchment / 20.0)).abs() < 1.0e-5);
        // No water below the ground, none above the rim; water is not lost or made.
        assert_eq!(level(0.004, 1.0, 0.0), -0.1);
        assert!((level(9.0, 0.0, 0.0) - 0.005).abs() < 1.0e-6);
        let mut last = -1.0;
        for k in 0..40u8 {
            let volume = 0.004 * catchment * f32::from(k) / 20.0;
            let found = basins[0].level_of(f64::from(volume));
            assert!(found >= last && (basins[0].volume(found) - f64::from(volume)).abs() < 1.0e-5);
            last = found;
        }
    }

    #[test]
    fn under_a_roof_no_rain_is_caught() {
        let ground = funnel();
        let open: Vec<f32> = (0..1200u16).map(|i| if i % 40 < 20 { 1.0 } else { 0.0 }).collect();
        let basins = found(&Hollows { size: [40, 30], ground: &ground, open: &open });
        assert!((basins[0].catchment - 7.0 * 12.0).abs() < 1.0, "{}", basins[0].catchment);
    }
}
