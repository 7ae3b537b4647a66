//! A rain whose rate changes: the drops of the heaviest rain, less those that a lighter rain does not have.
//!
//! The rate over time is what a gauge at one height catches. A drop passes that height at one time, before or after that of a picture;
//! it falls if its random word is below the ratio of the number of drops of its size in the rain of that time to that in the heaviest
//! one. So each drop is there for all of its fall or never, a front of rain falls, large drops ahead of small ones, and any time can be
//! asked for. As in `chain`, all is decided in integers. Twin of the functions of these names in `shaders/wgsl/sim/field.wgsl`.

use downpour_drop::distribution::DropSizeDistribution;
use downpour_math::in_range;
use downpour_shaders::sim::field::{FIELD_DIAMETER_STEP, FIELD_KEPT_INTERVALS};
use downpour_wind::Keyed;
use rayon::prelude::*;

use super::chain::{FieldTime, field_between, field_fallen};
use crate::SimError;

/// Rows of the table for a change from one key to the next, where these are few.
const ROWS_OF_CHANGE: usize = 64;

/// Rows of the table, if no more keys ask for them.
const ROWS: usize = 1024;

/// Nodes of a class.
const NODES: usize = FIELD_KEPT_INTERVALS as usize + 1;

/// Largest height of a gauge, m, either way.
const HIGHEST_M: f64 = 1.0e5;

/// Which drops of the heaviest rain fall at a time.
#[derive(Clone, Debug)]
pub struct Thinning {
    /// Height at which the rate over time holds, m.
    height: f64,
    /// Times at which all rows but the first begin.
    pub(crate) begins: Vec<FieldTime>,
    /// Row by row, class by class, at each node: part of the drops that fall, in units of 2^-32; the largest number stands for all.
    pub(crate) kept: Vec<u32>,
    /// Sizes of each class.
    pub(crate) classes: Vec<ThinnedClass>,
}

/// Sizes of a class in the table, and where the rate holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ThinnedClass {
    /// Least diameter, in units.
    pub low: u32,
    /// Intervals of the table per unit of diameter, in units of 2^-32.
    pub inverse: u32,
    /// Height at which the rate holds, in periods: whole ones, and a fraction in units of 2^-32.
    pub height: [u32; 2],
}

impl Thinning {
    /// The drops of `heaviest` of rates in mm/h over time at a height in m; also how many times as many drops each class needs. `sizes`
    /// has the least and the largest diameter of each class, m.
    pub(crate) fn new(
        heaviest: &DropSizeDistribution,
        rates: &Keyed<f64>,
        height: f64,
        sizes: &[[f64; 2]],
    ) -> Result<(Self, Vec<f64>), SimError> {
        in_range("height of the rate", height, "m", &(-HIGHEST_M..=HIGHEST_M), 1.0, "-1e5 to 1e5")?;
        let (begins, rates) = rows(rates);
        let node = |[low, high]: [f64; 2], node: usize| {
            // Within the class also where a sum is rounded.
            (low + (high - low) * node as f64 / (NODES - 1) as f64).clamp(low, high)
        };
        let most: Vec<f64> = sizes
            .iter()
            .flat_map(|&size| (0..NODES).map(move |k| node(size, k)))
            .map(|diameter| heaviest.concentration(diameter))
            .collect();
        let ratios: Vec<Vec<f64>> = rates
            .par_iter()
            .map(|&rate| {
                if rate <= 0.0 {
                    return Ok(vec![0.0; most.len()]);
                }
                let rain = DropSizeDistribution::with_options(heaviest.law(), rate, heaviest.options())?;
                let diameters = sizes.iter().flat_map(|&size| (0..NODES).map(move |k| node(size, k)));
                let ratio = |(diameter, &most): (f64, &f64)| {
                    let ratio = rain.concentration(diameter) / most;
                    if ratio.is_finite() { ratio } else { 0.0 }
                };
                Ok(diameters.zip(&most).map(ratio).collect())
            })
            .collect::<Result<_, SimError>>()?;
        let needed: Vec<f64> = (0..sizes.len())
            .map(|class| {
                let of_class = |row: &Vec<f64>| {
                    row[class * NODES..(class + 1) * NODES].iter().copied().fold(0.0, f64::max)
                };
                ratios.iter().map(of_class).fold(0.0, f64::max)
            })
            .collect();
        let part = |(k, ratio): (usize, &f64)| {
            let needed = needed[k / NODES];
            // A cast of what is too large gives the largest number.
            if needed > 0.0 { (ratio / needed * 4_294_967_296.0) as u32 } else { 0 }
        };
        let kept = ratios.iter().flat_map(|row| row.iter().enumerate().map(part)).collect();
        Ok((Self { height, begins, kept, classes: Vec::new() }, needed))
    }

    /// Adds a class with a period in m.
    pub(crate) fn push(&mut self, [low, high]: [f64; 2], period: f64) {
        let units = |diameter: f64| diameter / f64::from(FIELD_DIAMETER_STEP);
        let low = units(low).floor();
        let span = (units(high) - low).max(1.0);
        let height = (self.height / period * 4_294_967_296.0).round() as i64 as u64;
        self.classes.push(ThinnedClass {
            low: low as u32,
            inverse: (f64::from(FIELD_KEPT_INTERVALS) / span * 4_294_967_296.0) as u32,
            height: [(height >> 32) as u32, height as u32],
        });
    }

    /// First node of a class in a row of the table.
    pub(crate) fn first_of(class: usize) -> usize {
        class * NODES
    }

    /// Entries of a row of the table.
    pub(crate) fn row_len(&self) -> usize {
        Self::first_of(self.classes.len())
    }

    /// True if a drop falls: drop `place` (whole periods, and the phase) of a chain of a class, of a diameter and a rate of fall, with a
    /// random word.
    pub(crate) fn field_falls(
        &self,
        class: usize,
        [units, rate]: [u32; 2],
        place: [u32; 2],
        word: u32,
    ) -> bool {
        let kind = self.classes[class];
        let row = field_row(&self.begins, rate, field_less(place, kind.height)) as usize;
        let [interval, part] = field_interval(units.saturating_sub(kind.low), kind.inverse);
        let first = row * self.row_len() + Self::first_of(class) + interval as usize;
        let limit = field_between(self.kept[first], self.kept[first + 1], part);
        word < limit || limit == u32::MAX
    }
}

/// Difference of two numbers of two words, the high one first.
#[must_use]
pub fn field_less(a: [u32; 2], b: [u32; 2]) -> [u32; 2] {
    let word = |[high, low]: [u32; 2]| u64::from(high) << 32 | u64::from(low);
    let difference = word(a).wrapping_sub(word(b));
    [(difference >> 32) as u32, difference as u32]
}

/// Number of times by which a chain of a rate of fall has fallen no farther than a drop is above the height of the rate: the row of the
/// time at which the drop passes that height.
#[must_use]
pub fn field_row(begins: &[FieldTime], rate: u32, above: [u32; 2]) -> u32 {
    begins.partition_point(|&begin| !field_is_below(above, field_fallen(rate, begin))) as u32
}

/// True if a number of two words, the high one first and with a sign, is below another.
#[must_use]
pub fn field_is_below(a: [u32; 2], b: [u32; 2]) -> bool {
    let [high, other] = [a[0] as i32, b[0] as i32];
    high < other || (high == other && a[1] < b[1])
}

/// Interval of a class in the table, and fraction of the interval in units of 2^-16, for a number of units of diameter above its least.
#[must_use]
pub fn field_interval(units: u32, inverse: u32) -> [u32; 2] {
    let product = u64::from(units) * u64::from(inverse);
    let whole = (product >> 32) as u32;
    if whole >= FIELD_KEPT_INTERVALS {
        return [FIELD_KEPT_INTERVALS - 1, 0xffff];
    }
    [whole, (product >> 16) as u32 & 0xffff]
}

/// Rows of rates over time: when all but the first begin, and the rate of each.
fn rows(rates: &Keyed<f64>) -> (Vec<FieldTime>, Vec<f64>) {
    let keys = rates.keys();
    let changes = keys.windows(2).filter(|pair| pair[0].1.to_bits() != pair[1].1.to_bits()).count();
    let each = (ROWS / changes.max(1)).clamp(1, ROWS_OF_CHANGE);
    let mut begins = Vec::new();
    let mut found = vec![keys[0].1];
    for pair in keys.windows(2) {
        let [(begin, from), (end, to)] = [pair[0], pair[1]];
        let parts = if from.to_bits() == to.to_bits() { 1 } else { each };
        for part in 0..parts {
            let at = |part: f64| (part / parts as f64, 1.0 - part / parts as f64);
            let (there, here) = at(part as f64);
            begins.push(FieldTime::new(begin * here + end * there));
            let (there, here) = at(part as f64 + 0.5);
            found.push(from * here + to * there);
        }
    }
    if let Some(&(end, last)) = keys.last().filter(|_| keys.len() > 1) {
        begins.push(FieldTime::new(end));
        found.push(last);
    }
    (begins, found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_drop::distribution::DropSizeLaw;
    use downpour_math::ops::f64 as ops;

    const SIZES: [[f64; 2]; 2] = [[0.5e-3, 1.0e-3], [2.0e-3, 2.4e-3]];

    fn thinning(keys: &[(f64, f64)]) -> (Thinning, Vec<f64>) {
        let most = keys.iter().map(|key| key.1).fold(0.0, f64::max);
        let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, most).unwrap();
        let rates = Keyed::new(keys.to_vec()).unwrap();
        let (mut thinning, needed) = Thinning::new(&rain, &rates, 0.0, &SIZES).unwrap();
        for size in SIZES {
            thinning.push(size, 8.0);
        }
        (thinning, needed)
    }

    /// Marshall & Palmer's law as printed: `8000 exp(-4.1 R^-0.21 D)` per m^3 and mm, but for its scale to the rate.
    #[test]
    fn parts_are_ratios_of_the_law() {
        let (thinning, needed) = thinning(&[(0.0, 5.0), (1.0e-3, 40.0)]);
        let slope = |rate: f64| 4.1 * ops::pow(rate, -0.21);
        let part = |class: usize, node: usize| {
            let kept = thinning.kept[class * NODES + node];
            f64::from(kept) / 4_294_967_296.0 * needed[class]
        };
        let of = |mm: f64| ops::exp(-(slope(5.0) - slope(40.0)) * mm);
        // The scale is the same for all sizes.
        let scale = part(0, 0) / of(0.5);
        assert!((scale - 1.0).abs() < 0.2, "{scale}");
        for (class, node, mm) in [(0, 4, 0.75), (0, 8, 1.0), (1, 0, 2.0), (1, 8, 2.4)] {
            assert!((part(class, node) / of(mm) / scale - 1.0).abs() < 1.0e-6, "{mm} mm");
        }
    }

    #[test]
    fn rows_follow_the_keys() {
        let keys = Keyed::new(vec![(-2.0, 4.0), (0.0, 4.0), (6.4, 10.4), (10.0, 0.0)]).unwrap();
        let (begins, rates) = rows(&keys);
        assert_eq!((begins.len(), rates.len()), (1 + 64 + 64 + 1, 1 + 1 + 64 + 64 + 1));
        assert_eq!(rates[..2], [4.0; 2]);
        // A tenth of a second has a tenth of a millimeter per hour.
        assert!((rates[2] - 4.05).abs() < 1.0e-12 && (rates[3] - 4.15).abs() < 1.0e-12);
        assert_eq!(begins[3], FieldTime::new(0.2));
        assert_eq!(rates.last(), Some(&0.0));
    }

    /// A chain that falls two periods in a second passes the gauge at the time that its place says.
    #[test]
    fn drops_pass_the_gauge_in_the_row_of_that_time() {
        let begins = [-3.0, -1.0, 0.0, 2.0].map(FieldTime::new);
        let rate = 1 << 30;
        for (periods, row) in
            [(-6.5, 0), (-6.0, 1), (-2.1, 1), (-2.0, 2), (-0.1, 2), (0.0, 3), (3.9, 3), (4.0, 4)]
        {
            let place = (periods * 4_294_967_296.0) as i64 as u64;
            let above = [(place >> 32) as u32, place as u32];
            assert_eq!(field_row(&begins, rate, above), row, "{periods}");
        }
    }

    /// 256 units are one interval.
    #[test]
    fn sizes_are_between_the_nodes() {
        for (units, expected) in [(0, [0, 0]), (256, [1, 0]), (384, [1, 0x8000]), (2047, [7, 0xff00])] {
            assert_eq!(field_interval(units, 1 << 24), expected, "{units}");
        }
        for beyond in [2048, 5000, u32::MAX] {
            assert_eq!(field_interval(beyond, 1 << 24), [7, 0xffff], "{beyond}");
        }
    }

    #[test]
    fn a_dry_rain_keeps_no_drop_and_the_heaviest_all_of_the_sizes_of_which_it_has_most() {
        let (thinning, _) = thinning(&[(0.0, 0.0), (1.0, 60.0)]);
        let rate = 1 << 28;
        let fallen = |time_s: f64| field_fallen(rate, FieldTime::new(time_s));
        let units = (2.1e-3 / f64::from(FIELD_DIAMETER_STEP)) as u32;
        for word in [0, 1, u32::MAX] {
            assert!(!thinning.field_falls(1, [units, rate], fallen(-5.0), word));
            assert!(thinning.field_falls(1, [units, rate], fallen(5.0), word));
        }
    }
}
