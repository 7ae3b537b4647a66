//! Water that runs on the ground: how much comes by, how deep it is and how fast.
//!
//! Law: the discharge at a place is the runoff of all ground whose water comes by (the rational method: U.S. Federal Highway
//! Administration, Hydraulic Engineering Circular 22, 2009, section 3.2.2), where hollows on the way are full. Its depth is the normal
//! depth of the cross section there: Manning's formula for each of its strips, `q = d^(5/3) S^(1/2) / n`, which over a gutter of triangular
//! section is the circular's equation 4-2. Water before a hollow's way out is as high as there, and no water is lower than what
//! it runs to.
//!
//! In a street whose rain has been the same for longer than water takes to its gullies this is the whole state; of a rain that changes it
//! takes the mean over [`Weather::runoff_rate`](downpour_weather::Weather::runoff_rate)'s time.

use std::collections::BTreeSet;

use downpour_math::ops;
use glam::Vec2;

use super::drainage::{Drainage, neighbors};
use super::fill::{Basin, Basins, FillLimits, Hollows, NO_BASIN};

/// Manning's coefficient of rough asphalt and of brick, s/m^(1/3): Hydraulic Engineering Circular 22, table 4-3.
pub const MANNING_N: f32 = 0.016;

/// Minimum discharge of what is looked at, m^3/s: a hundredth of a liter per second.
const MIN_DISCHARGE: f32 = 1.0e-5;

/// Distance up and down the way of the water over which its direction and fall are taken, m.
const BASELINE_M: f32 = 0.35;

/// Minimum fall of the water, m per m: level water does not run.
const MIN_FALL: f32 = 2.0e-4;

/// Maximum depth, m, and maximum half width of running water, m.
const MAX_DEPTH_M: f32 = 0.3;
const MAX_HALF_WIDTH_M: f32 = 3.0;

/// Depth of the water beside its way over that on it: the way goes from cell to cell, and is not everywhere where it is deepest.
const MAX_DEEPER: f32 = 1.25;
const MAX_UNEVEN_M: f32 = 1.0e-3;

/// Maximum speed, m/s.
const MAX_SPEED: f32 = 3.0;

/// Cells that a stream is wide, at least: the map does not show narrower ones.
const MIN_STRIPS: usize = 3;

/// Times that levels become means of those around them.
const SMOOTHINGS: u32 = 3;

/// Halvings in which a depth is found: 0.3 m to 0.02 mm.
const HALVINGS: u32 = 14;

/// Some ground, its ways of water and its hollows.
#[derive(Clone, Copy, Debug)]
pub struct Catchments<'a> {
    /// The ground.
    pub hollows: Hollows<'a>,
    /// Ways of the water.
    pub drainage: &'a Drainage,
    /// The hollows.
    pub basins: &'a Basins,
    /// Edges of a cell, m.
    pub cell_m: Vec2,
}

/// Running water, for each cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Running {
    /// Level of the water, m; `None` where none runs, nor stands in a hollow that it runs through.
    pub levels: Vec<Option<f32>>,
    /// Mean velocity of the cross section along columns and rows, m/s.
    pub velocities: Vec<Vec2>,
    /// Discharge, m^3/s.
    pub discharges: Vec<f32>,
}

/// Where a cross section is.
#[derive(Clone, Copy, Debug)]
struct Cut {
    /// A cell of it.
    cell: usize,
    /// Direction of the water: it is at right angles to that.
    along: Vec2,
    /// Level of the water, m.
    level: f32,
    /// The full hollow that it is in, whose rim holds the water.
    pool: Option<usize>,
}

/// A cross section with water up to a level.
#[derive(Clone, Debug, Default)]
struct Section {
    /// Integral of depth^(5/3) over the width, m^(8/3).
    conveyance: f32,
    /// m^2.
    area: f32,
    /// What comes through it, m^3/s.
    discharge: f32,
    /// Largest depth, m.
    deepest: f32,
}

/// What a hollow does to the water that comes to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Hollow {
    /// It is too shallow to be one: water runs over it.
    Shallow,
    /// It keeps the water.
    Filling,
    /// Water stands up to its way out, and what comes runs on.
    Full,
}

impl Hollow {
    /// Of a hollow with water up to a level, m.
    fn new(basin: &Basin, level: Option<f32>, limits: &FillLimits) -> Self {
        if basin.depth() < limits.least {
            Self::Shallow
        } else if level.is_some_and(|level| level >= basin.spill()) {
            Self::Full
        } else {
            Self::Filling
        }
    }
}

/// What runs at a place: sums over all cross sections that it is in.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    level: f32,
    velocity: Vec2,
    count: f32,
}

impl std::ops::Add for Sum {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            level: self.level + other.level,
            velocity: self.velocity + other.velocity,
            count: self.count + other.count,
        }
    }
}

impl Catchments<'_> {
    /// The water that runs with a runoff in m/s, where hollows have filled to some [`levels`](super::fill::levels). `None` if none does
    /// that is as deep as the limits ask.
    #[must_use]
    pub fn running(&self, filled: &[Option<f32>], runoff_m_s: f32, limits: &FillLimits) -> Option<Running> {
        if runoff_m_s <= 0.0 {
            return None;
        }
        let states: Vec<Hollow> = (0..self.basins.basins.len())
            .map(|basin| {
                Hollow::new(&self.basins.basins[basin], filled.get(basin).copied().flatten(), limits)
            })
            .collect();
        let (discharges, before) = self.discharges(&states, runoff_m_s);
        let count = discharges.len();
        // Levels of the ways, the lowest end first, and of the hollows on them.
        let mut way = vec![f32::NEG_INFINITY; count];
        let mut heads = vec![f32::NEG_INFINITY; states.len()];
        let mut sums = vec![Sum::default(); count];
        let mut wet = Vec::new();
        let mut runs = false;
        for &cell in &self.drainage.order {
            let discharge = discharges[cell];
            if discharge < MIN_DISCHARGE || !self.hollows.ground[cell].is_finite() {
                continue;
            }
            let below = self.drainage.next[cell].map_or(f32::NEG_INFINITY, |next| way[next]);
            let basin = self.basin(cell);
            let Some((along, fall)) = self.direction(cell, &before) else {
                way[cell] = below;
                continue;
            };
            let cut = match basin {
                Some(basin) if states[basin] == Hollow::Full => {
                    if heads[basin] == f32::NEG_INFINITY {
                        heads[basin] = below.max(self.drainage.spill[cell]);
                    }
                    Cut { cell, along, level: heads[basin], pool: Some(basin) }
                }
                _ => {
                    let level = self.normal_level(cell, along, fall, &discharges).max(below);
                    Cut { cell, along, level, pool: None }
                }
            };
            let level = cut.level;
            way[cell] = level;
            let section = self.section(&cut, &discharges, &mut wet);
            if section.deepest < limits.least || wet.len() < MIN_STRIPS {
                continue;
            }
            runs = true;
            let velocity = along * (section.discharge / section.area).min(MAX_SPEED);
            for &at in &wet {
                sums[at] = sums[at] + Sum { level, velocity, count: 1.0 };
            }
        }
        if !runs {
            return None;
        }
        self.close(&mut sums);
        let mean = |sum: &Sum| match sum.count {
            0.0 => (None, Vec2::ZERO),
            count => (Some(sum.level / count), sum.velocity / count),
        };
        let (mut levels, velocities): (Vec<Option<f32>>, Vec<Vec2>) = sums.iter().map(mean).unzip();
        self.raise(&heads, &mut levels);
        for _ in 0..SMOOTHINGS {
            levels = self.smoothed(&levels);
        }
        Some(Running { levels, velocities, discharges })
    }

    /// Closes gaps between cross sections, which oblique ones leave, and leaves out what has no breadth.
    fn close(&self, sums: &mut [Sum]) {
        let before = sums.to_vec();
        for cell in (0..sums.len()).filter(|&cell| before[cell].count == 0.0) {
            let (all, count) = self.around(cell, &before);
            if count >= 4 && self.hollows.ground[cell] < all.level / all.count {
                sums[cell] = all;
            }
        }
        let before = sums.to_vec();
        for (cell, sum) in sums.iter_mut().enumerate() {
            if self.around(cell, &before).1 < 3 {
                *sum = Sum::default();
            }
        }
    }

    /// What runs in the eight cells around one, and in how many of them.
    fn around(&self, cell: usize, sums: &[Sum]) -> (Sum, u32) {
        let [columns, rows] = self.hollows.size;
        let (x, y) = (cell % columns, cell / columns);
        let (left, right) = (x.saturating_sub(1), (x + 1).min(columns - 1));
        let (above, below) = (y.saturating_sub(1), (y + 1).min(rows - 1));
        let around = (above..=below).flat_map(|y| (left..=right).map(move |x| y * columns + x));
        let wet = around.filter(|&at| at != cell && sums[at].count > 0.0);
        wet.fold((Sum::default(), 0), |(all, count), at| (all + sums[at], count + 1))
    }

    /// The hollow that a cell is in.
    fn basin(&self, cell: usize) -> Option<usize> {
        let floods = self.drainage.spill[cell] > self.hollows.ground[cell];
        let basin = self.basins.of_cell[cell];
        (floods && basin != NO_BASIN).then_some(basin as usize)
    }

    /// Discharge through each cell, m^3/s, and the cell above it from which most of it comes.
    fn discharges(&self, states: &[Hollow], runoff_m_s: f32) -> (Vec<f32>, Vec<Option<usize>>) {
        let own = runoff_m_s * self.cell_m.x * self.cell_m.y;
        let mut discharges: Vec<f32> = self.hollows.open.iter().map(|open| open * own).collect();
        let mut before: Vec<(Option<usize>, f32)> = vec![(None, 0.0); discharges.len()];
        for &cell in self.drainage.order.iter().rev() {
            // A hollow keeps all until it is full.
            if self.basin(cell).is_some_and(|basin| states[basin] == Hollow::Filling) {
                discharges[cell] = 0.0;
            }
            let Some(next) = self.drainage.next[cell] else { continue };
            discharges[next] += discharges[cell];
            if discharges[cell] > before[next].1 {
                before[next] = (Some(cell), discharges[cell]);
            }
        }
        (discharges, before.into_iter().map(|(cell, _)| cell).collect())
    }

    /// Direction of the water, along columns and rows, and its fall; `None` where it has no way.
    fn direction(&self, cell: usize, before: &[Option<usize>]) -> Option<(Vec2, f32)> {
        let steps = (BASELINE_M / self.cell_m.min_element()).ceil().clamp(1.0, 64.0) as u32;
        let follow = |next: &dyn Fn(usize) -> Option<usize>| {
            let mut at = cell;
            for _ in 0..steps {
                match next(at).filter(|&next| self.hollows.ground[next].is_finite()) {
                    Some(next) => at = next,
                    None => break,
                }
            }
            at
        };
        let (up, down) = (follow(&|at| before[at]), follow(&|at| self.drainage.next[at]));
        let way = self.place(down) - self.place(up);
        let length = way.length();
        let fall = (self.drainage.spill[up] - self.drainage.spill[down]) / length;
        (length > 0.0).then(|| (way / length, fall.max(MIN_FALL)))
    }

    /// Middle of a cell, m along columns and rows.
    fn place(&self, cell: usize) -> Vec2 {
        let columns = self.hollows.size[0];
        Vec2::new((cell % columns) as f32 + 0.5, (cell / columns) as f32 + 0.5) * self.cell_m
    }

    /// Level of the water through a cell that has a direction and a fall.
    fn normal_level(&self, cell: usize, along: Vec2, fall: f32, discharges: &[f32]) -> f32 {
        let ground = self.hollows.ground[cell];
        let (mut low, mut high) = (0.0, MAX_DEPTH_M);
        let mut wet = Vec::new();
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let cut = Cut { cell, along, level: ground + middle, pool: None };
            let section = self.section(&cut, discharges, &mut wet);
            if section.conveyance * fall.sqrt() / MANNING_N < section.discharge {
                low = middle;
            } else {
                high = middle;
            }
        }
        ground + high
    }

    /// The cross section of some water; `wet` becomes the cells under it.
    fn section(&self, cut: &Cut, discharges: &[f32], wet: &mut Vec<usize>) -> Section {
        wet.clear();
        let Cut { cell, along, level, .. } = *cut;
        let step = self.cell_m.min_element();
        // Ways go from cell to cell: an oblique one has more cells.
        let part = 1.0 / (along.x.abs() + along.y.abs());
        let mut section = Section::default();
        let mut strip = |at: usize| {
            let depth = (level - self.hollows.ground[at]).max(0.0);
            section.conveyance += step * ops::pow(depth, 5.0 / 3.0);
            section.area += step * depth;
            section.discharge += discharges[at] * part;
            section.deepest = section.deepest.max(depth);
            wet.push(at);
        };
        strip(cell);
        for side in [-step, step] {
            let across = along.perp() * side;
            let cells = (1..=self.wet_on_a_side(cut, across, discharges))
                .filter_map(|k| self.beside(cell, across, k));
            cells.for_each(&mut strip);
        }
        section
    }

    /// Cell so many steps beside another; `None` beyond the map.
    fn beside(&self, cell: usize, across: Vec2, steps: u32) -> Option<usize> {
        let [columns, rows] = self.hollows.size;
        let at = (self.place(cell) + across * steps as f32) / self.cell_m;
        let inside = at.min_element() >= 0.0 && at.x < columns as f32 && at.y < rows as f32;
        inside.then(|| at.y as usize * columns + at.x as usize)
    }

    /// Steps to one side of a cross section that are under its water.
    fn wet_on_a_side(&self, cut: &Cut, across: Vec2, discharges: &[f32]) -> u32 {
        let own = cut.level - self.hollows.ground[cut.cell];
        // Ground that falls away beside the way of the water does not hold it.
        let most = if cut.pool.is_some() { f32::INFINITY } else { own * MAX_DEEPER + MAX_UNEVEN_M };
        let is_outside = |at: usize| cut.pool.is_some_and(|pool| self.basins.of_cell[at] as usize != pool);
        // Steps up to where no water runs.
        let mut runs = None;
        let furthest = (MAX_HALF_WIDTH_M / across.length()) as u32;
        for k in 1..=furthest {
            let Some(at) = self.beside(cut.cell, across, k) else { return runs.unwrap_or(k - 1) };
            let depth = cut.level - self.hollows.ground[at];
            if depth <= 0.0 || is_outside(at) {
                return k - 1;
            }
            // No number where there is no ground.
            if depth.is_nan() || depth > most {
                return runs.unwrap_or(k - 1);
            }
            if discharges[at] <= 0.0 {
                runs = runs.or(Some(k - 1));
            }
        }
        // No bank holds it.
        runs.unwrap_or(furthest)
    }

    /// Raises the water in hollows to the level of what runs out of them, up to their new shores.
    fn raise(&self, heads: &[f32], levels: &mut [Option<f32>]) {
        for (basin, &head) in (0u32..).zip(heads).filter(|(_, head)| head.is_finite()) {
            let mut ahead: Vec<usize> =
                self.basins.basins[basin as usize].cells().iter().map(|&cell| cell as usize).collect();
            let mut known: BTreeSet<usize> = ahead.iter().copied().collect();
            while let Some(cell) = ahead.pop() {
                levels[cell] = levels[cell].map(|level| level.max(head)).or(Some(head));
                let is_shore =
                    |&at: &usize| self.basins.of_cell[at] == basin && self.hollows.ground[at] < head;
                let shore = neighbors(self.hollows.size, cell).filter(is_shore);
                ahead.extend(shore.filter(|&at| known.insert(at)));
            }
        }
    }

    /// Levels without the steps between one cross section and the next.
    fn smoothed(&self, levels: &[Option<f32>]) -> Vec<Option<f32>> {
        let smooth = |cell: usize| {
            let own = levels[cell]?;
            let (sum, count) = neighbors(self.hollows.size, cell)
                .filter_map(|beside| levels[beside])
                .fold((own, 1.0), |(sum, count), level| (sum + level, count + 1.0));
            Some(sum / count)
        };
        (0..levels.len()).map(smooth).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::puddle::fill::{Filling, basins, levels};

    const LIMITS: FillLimits = FillLimits { deepest: 1.0, least: 1.0e-3 };

    /// Ground of cells of 2 cm, and the rain that falls on it.
    struct Bed {
        size: [usize; 2],
        ground: Vec<f32>,
        open: Vec<f32>,
    }

    const CELL_M: f32 = 0.02;

    impl Bed {
        /// Heights and openness of places, m along columns and rows.
        fn new(size: [usize; 2], at: impl Fn(f32, f32) -> (f32, f32)) -> Self {
            let cell =
                |i: usize| at(((i % size[0]) as f32 + 0.5) * CELL_M, ((i / size[0]) as f32 + 0.5) * CELL_M);
            let (ground, open) = (0..size[0] * size[1]).map(cell).unzip();
            Self { size, ground, open }
        }

        fn running(&self, filling: &Filling, runoff_m_s: f32) -> Option<Running> {
            let hollows = Hollows { size: self.size, ground: &self.ground, open: &self.open };
            let drainage = Drainage::new(&hollows);
            let basins = basins(&hollows, &drainage);
            let filled = levels(&basins.basins, filling, &LIMITS);
            let catchments =
                Catchments { hollows, drainage: &drainage, basins: &basins, cell_m: Vec2::splat(CELL_M) };
            catchments.running(&filled, runoff_m_s, &LIMITS)
        }

        /// Largest depth, m, and width, m, of the water in a row.
        fn row(&self, running: &Running, row: usize) -> (f32, f32) {
            let cells = row * self.size[0]..(row + 1) * self.size[0];
            let depths = cells.filter_map(|cell| Some(running.levels[cell]? - self.ground[cell]));
            depths
                .filter(|&depth| depth > 0.0)
                .fold((0.0, 0.0), |(deepest, width), depth| (deepest.max(depth), width + CELL_M))
        }
    }

    const FULL: Filling = Filling::Fraction(1.0);

    /// A gutter of triangular section with a fall: all of its water comes from its upper end.
    fn gutter(cross: f32, fall: f32) -> Bed {
        // The curb is at x = 0.1; rows go down the fall; rain falls on the gutter's upper end.
        Bed::new([75, 300], |x, y| {
            let height = if x < 0.1 { 1.0 } else { cross * (x - 0.1) };
            (height - fall * y, if (0.1..1.0).contains(&y) && (0.1..0.3).contains(&x) { 1.0 } else { 0.0 })
        })
    }

    /// Hydraulic Engineering Circular 22, equation 4-2: Q = 0.376 / n Sx^1.67 SL^0.5 T^2.67, in meters and seconds.
    #[test]
    fn a_gutter_is_as_wide_as_the_circular_says() {
        for (cross, fall, liters) in [(0.04, 0.01, 1.0), (0.03, 0.005, 1.0), (0.06, 0.02, 4.0)] {
            let bed = gutter(cross, fall);
            let area: f32 = bed.open.iter().sum::<f32>() * CELL_M * CELL_M;
            let discharge = liters * 1.0e-3;
            let running = bed.running(&FULL, discharge / area).expect("water");
            let wanted_width = ops::pow(
                discharge * 0.016 / (0.376 * ops::pow(cross, 1.67) * ops::pow(fall, 0.5)),
                1.0 / 2.67,
            );
            for row in [120, 180, 240] {
                let (depth, width) = bed.row(&running, row);
                let wanted_depth = wanted_width * cross;
                assert!(
                    (width - wanted_width).abs() < 0.05 * wanted_width + CELL_M,
                    "{width} {wanted_width}"
                );
                assert!((depth - wanted_depth).abs() < 0.05 * wanted_depth + 0.5 * CELL_M * cross, "{depth}");
                // Q = v A.
                let cell = row * 75 + 6;
                let speed = running.velocities[cell].y;
                let wanted = discharge / (0.5 * wanted_width * wanted_depth);
                assert!((speed / wanted - 1.0).abs() < 0.15, "{speed} {wanted}");
                assert!(running.velocities[cell].x.abs() < 0.02 * speed);
            }
        }
    }

    /// In a wide trough, q = d^(5/3) S^(1/2) / n.
    #[test]
    fn a_trough_is_as_deep_as_manning_says() {
        let bed = Bed::new([60, 300], |x, y| {
            let wall = if !(0.1..1.1).contains(&x) { 1.0 } else { 0.0 };
            // The middle is a little lower, so that all water knows where to go.
            let floor = 1.0e-4 * (x - 0.6).abs();
            (wall + floor - 0.01 * y, if (0.1..1.1).contains(&y) && wall == 0.0 { 1.0 } else { 0.0 })
        });
        let running = bed.running(&FULL, 4.0e-3).expect("water");
        let wanted = ops::pow(4.0e-3 * 0.016 / 0.1, 0.6);
        for row in [150, 240] {
            let (depth, width) = bed.row(&running, row);
            assert!((depth / wanted - 1.0).abs() < 0.05, "{depth} {wanted}");
            assert!((width - 1.0).abs() < 2.5 * CELL_M);
        }
    }

    /// What comes out is what falls, and a roof keeps its part off.
    #[test]
    fn no_water_is_lost_on_the_way() {
        let bed = gutter(0.04, 0.01);
        let running = bed.running(&FULL, 1.0e-3).expect("water");
        let caught: f32 = bed.open.iter().sum::<f32>() * CELL_M * CELL_M * 1.0e-3;
        let across: f32 = (0..75).map(|x| running.discharges[200 * 75 + x]).sum();
        assert!((across / caught - 1.0).abs() < 1.0e-3, "{across} {caught}");
    }

    /// A pit across the way keeps all water until it is full; then it goes on, and the pit is as high as its way out.
    #[test]
    fn a_hollow_on_the_way_keeps_the_water_until_it_is_full() {
        let bed = {
            let mut bed = gutter(0.04, 0.01);
            for row in 140..160 {
                for column in 5..75 {
                    bed.ground[row * 75 + column] -= 0.03;
                }
            }
            bed
        };
        let below = |filling: &Filling| {
            let running = bed.running(filling, 1.0e-3)?;
            Some(bed.row(&running, 230).0)
        };
        assert_eq!(below(&Filling::Fraction(0.9)).unwrap_or(0.0), 0.0);
        assert!(below(&FULL).expect("water") > 5.0e-3);
        let running = bed.running(&FULL, 1.0e-3).expect("water");
        let pool = running.levels[150 * 75 + 8].expect("water");
        let out = running.levels[163 * 75 + 5].expect("water");
        assert!(pool >= out && pool - out < 0.01, "{pool} {out}");
        // Still water is slow.
        let speed = |row: usize| running.velocities[row * 75 + 6].length();
        assert!(speed(152) < 0.6 * speed(230), "{} {}", speed(152), speed(230));
    }

    #[test]
    fn no_rain_and_little_rain_run_nowhere() {
        let bed = gutter(0.04, 0.01);
        assert_eq!(bed.running(&FULL, 0.0), None);
        assert_eq!(bed.running(&FULL, 1.0e-6), None);
    }

    /// A hole in the ground takes the water away.
    #[test]
    fn a_gully_takes_the_water_away() {
        let mut bed = gutter(0.04, 0.01);
        for row in 150..175 {
            for column in 5..25 {
                bed.ground[row * 75 + column] = f32::NAN;
            }
        }
        let running = bed.running(&FULL, 1.0e-3).expect("water");
        assert!(bed.row(&running, 120).0 > 5.0e-3);
        assert_eq!(bed.row(&running, 230).0, 0.0);
    }
}
