//! Printed coefficients, their corrections, and interpolation between their rows.

use super::{COEFFICIENTS, check_shape_diameter};
use crate::DropError;

/// One row of a table: coefficients of one drop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeRow {
    /// Diameter of the sphere of equal volume, in meters.
    pub diameter_m: f64,
    /// `c_0` to `c_10` in units of 1e-4, as tables print them.
    pub printed: [i16; COEFFICIENTS],
}

impl ShapeRow {
    /// `c_0` to `c_10`, not normalized: the volume is that of the sphere within 0.05 % (0.12 % in the last
    /// row of Rousseau 2006).
    #[must_use]
    pub fn coefficients(&self) -> [f64; COEFFICIENTS] {
        self.printed.map(|c| f64::from(c) * 1.0e-4)
    }
}

/// Correction of an entry that differs from a printed or copied one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correction {
    /// Diameter of the row, in meters.
    pub diameter_m: f64,
    /// Index of the coefficient.
    pub n: usize,
    /// Value in print or in published code, in units of 1e-4.
    pub found: i16,
    /// Value that [`ShapeTable::ChuangBeard1990`] uses, in units of 1e-4.
    pub used: i16,
    /// Source of the found value, and the reason against it.
    pub reason: &'static str,
}

/// Table of shape coefficients.
///
/// ```
/// use downpour_drop::shape::ShapeTable;
/// let raw = ShapeTable::ChuangBeard1990.coefficients(2.0e-3)?;
/// assert!((raw[2] - -0.0385).abs() < 1e-15);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ShapeTable {
    /// Chuang & Beard 1990, table 1, with the entries of [`ShapeTable::CORRECTIONS`].
    #[default]
    ChuangBeard1990,
    /// The four rows of Rousseau et al. 2006, table 1, as printed there (their radii of 0.5, 1, 3 and 4.5 mm
    /// are diameters of 1, 2, 6 and 9 mm): the paper's form, kept with its misprint in the last row. Between
    /// 2 and 6 mm the interpolated shape only resembles that of the full table.
    Rousseau2006,
}

const fn row(diameter_m: f64, printed: [i16; COEFFICIENTS]) -> ShapeRow {
    ShapeRow { diameter_m, printed }
}

static CHUANG_BEARD_1990: [ShapeRow; 15] = [
    row(1.0e-3, [-28, -30, -83, -22, -3, 2, 1, 0, 0, 0, 0]),
    row(1.5e-3, [-72, -70, -210, -57, -6, 7, 3, 0, -1, 0, 1]),
    row(2.0e-3, [-134, -118, -385, -100, -5, 17, 6, -1, -3, -1, 1]),
    row(2.5e-3, [-211, -180, -592, -147, 4, 32, 10, -3, -5, -1, 2]),
    row(3.0e-3, [-297, -247, -816, -188, 24, 52, 13, -8, -8, -1, 4]),
    row(3.5e-3, [-388, -309, -1042, -221, 53, 75, 15, -15, -12, 0, 7]),
    row(4.0e-3, [-481, -359, -1263, -244, 91, 99, 15, -25, -16, 2, 10]),
    row(4.5e-3, [-573, -401, -1474, -255, 137, 121, 11, -36, -19, 6, 13]),
    row(5.0e-3, [-665, -435, -1674, -258, 187, 141, 4, -48, -21, 11, 17]),
    row(5.5e-3, [-755, -456, -1863, -251, 242, 157, -7, -61, -21, 17, 21]),
    row(6.0e-3, [-843, -472, -2040, -240, 299, 168, -21, -73, -20, 25, 24]),
    row(6.5e-3, [-930, -487, -2207, -222, 358, 175, -37, -84, -16, 34, 27]),
    row(7.0e-3, [-1014, -492, -2364, -199, 419, 178, -56, -93, -12, 43, 30]),
    row(8.0e-3, [-1177, -482, -2650, -148, 543, 171, -100, -107, 2, 64, 32]),
    row(9.0e-3, [-1328, -403, -2899, -106, 662, 153, -146, -111, 18, 81, 31]),
];

static ROUSSEAU_2006: [ShapeRow; 4] = [
    row(1.0e-3, [-28, -30, -83, -22, -3, 2, 1, 0, 0, 0, 0]),
    row(2.0e-3, [-134, -118, -385, -100, -5, 17, 6, -1, -3, -1, 1]),
    row(6.0e-3, [-843, -472, -2040, -240, 299, 168, -21, -73, -20, 25, 24]),
    row(9.0e-3, [-1328, -403, -2889, -106, 662, 153, -146, -111, 18, 81, 31]),
];

impl ShapeTable {
    /// Entries of [`ShapeTable::ChuangBeard1990`] that differ from those of some source.
    pub const CORRECTIONS: [Correction; 3] = [
        Correction {
            diameter_m: 5.5e-3,
            n: 1,
            found: -465,
            used: -456,
            reason: "copies of the table have -465; the neighboring rows predict -456.7, and no other entry \
                     of the column leaves the smooth curve: two digits were exchanged",
        },
        Correction {
            diameter_m: 8.0e-3,
            n: 0,
            found: -1187,
            used: -1177,
            reason: "copies of the table have -1187, which loses 0.25 % of the volume, where every other row \
                     closes to 0.05 %; with -1177 the row closes and the column is smooth",
        },
        Correction {
            diameter_m: 9.0e-3,
            n: 2,
            found: -2889,
            used: -2899,
            reason: "Rousseau 2006 prints -2889, which loses 0.12 % of the volume; copies of the table have \
                     -2899, which closes to 0.04 %",
        },
    ];

    /// Rows, by ascending diameter.
    #[must_use]
    pub fn rows(self) -> &'static [ShapeRow] {
        match self {
            Self::ChuangBeard1990 => &CHUANG_BEARD_1990,
            Self::Rousseau2006 => &ROUSSEAU_2006,
        }
    }

    /// Coefficients of a drop, not normalized: exactly the row's at a row, a cubic between rows.
    ///
    /// Each coefficient is C1 in the diameter: a cubic Hermite curve whose slope at a row is that of the
    /// parabola through the row and its neighbors. Below 1 mm all coefficients are proportional to d^2, as
    /// the Bond number `rho g d^2 / sigma` is, and the curve starts with that slope at 1 mm.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] if the diameter is not 1 um to 9 mm.
    pub fn coefficients(self, diameter_m: f64) -> Result<[f64; COEFFICIENTS], DropError> {
        check_shape_diameter(diameter_m)?;
        Ok(interpolate(self.rows(), diameter_m))
    }
}

fn interpolate(rows: &[ShapeRow], diameter_m: f64) -> [f64; COEFFICIENTS] {
    let first = &rows[0];
    if diameter_m <= first.diameter_m {
        let u = diameter_m / first.diameter_m;
        return first.coefficients().map(|c| c * (u * u));
    }
    // The last row also ends its interval.
    let i = rows.partition_point(|row| row.diameter_m <= diameter_m).min(rows.len() - 1) - 1;
    let (before, after) = (&rows[i], &rows[i + 1]);
    let h = after.diameter_m - before.diameter_m;
    let u = (diameter_m - before.diameter_m) / h;
    let (c0, c1) = (before.coefficients(), after.coefficients());
    let (m0, m1) = (slopes(rows, i), slopes(rows, i + 1));
    let rise = u * u * (3.0 - 2.0 * u);
    let (start, end) = (h * u * (1.0 - u) * (1.0 - u), h * u * u * (u - 1.0));
    std::array::from_fn(|n| c0[n] * (1.0 - rise) + c1[n] * rise + m0[n] * start + m1[n] * end)
}

/// `d c_n / d d` at row `i`, per meter.
fn slopes(rows: &[ShapeRow], i: usize) -> [f64; COEFFICIENTS] {
    let secant = |i: usize| -> [f64; COEFFICIENTS] {
        let (c0, c1) = (rows[i].coefficients(), rows[i + 1].coefficients());
        std::array::from_fn(|n| (c1[n] - c0[n]) / (rows[i + 1].diameter_m - rows[i].diameter_m))
    };
    if i == 0 {
        // Slope of c d^2.
        return rows[0].coefficients().map(|c| 2.0 * c / rows[0].diameter_m);
    }
    // The parabola through three rows; at the last row, the parabola of the last three.
    let middle = i.min(rows.len() - 2);
    let before = rows[middle].diameter_m - rows[middle - 1].diameter_m;
    let after = rows[middle + 1].diameter_m - rows[middle].diameter_m;
    let (left, right) = (secant(middle - 1), secant(middle));
    std::array::from_fn(|n| {
        let curvature = (right[n] - left[n]) / (before + after);
        let slope = left[n] + curvature * before;
        if i == middle { slope } else { slope + 2.0 * curvature * after }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row that is left out is recovered from the others: within 5 units of 1e-4, except for `c_1` at 8 mm,
    /// where leaving it out opens a gap of 2 mm at an inflection of the curve.
    #[test]
    fn rows_left_out_are_predicted() {
        let mut worst = (0.0, 0, 0.0);
        for i in 1..CHUANG_BEARD_1990.len() - 1 {
            let mut rows = CHUANG_BEARD_1990.to_vec();
            let left_out = rows.remove(i);
            let predicted = interpolate(&rows, left_out.diameter_m);
            for (n, (predicted, printed)) in predicted.iter().zip(left_out.coefficients()).enumerate() {
                if n == 1 && i == 13 {
                    continue;
                }
                let error = (predicted - printed).abs();
                if error > worst.0 {
                    worst = (error, n, left_out.diameter_m);
                }
            }
        }
        assert!(worst.0 < 5.0e-4, "(error, n, d) = {worst:?}");
    }

    /// The corrected entries fit their columns, the printed ones do not.
    #[test]
    fn corrections_are_smoother() {
        for correction in &ShapeTable::CORRECTIONS[..2] {
            let mut rows = CHUANG_BEARD_1990.to_vec();
            let i = rows.iter().position(|row| row.diameter_m == correction.diameter_m).expect("a row");
            assert_eq!(rows.remove(i).printed[correction.n], correction.used);
            let predicted = interpolate(&rows, correction.diameter_m)[correction.n] * 1.0e4;
            let (used, found) = (f64::from(correction.used), f64::from(correction.found));
            assert!(
                (predicted - used).abs() < 0.4 * (predicted - found).abs(),
                "{predicted}: {correction:?}"
            );
        }
    }
}
