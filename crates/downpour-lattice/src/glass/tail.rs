//! Tails of running drops: the water that a track still holds for a moment after a drop has passed.
//!
//! The film that a drop leaves drains as `h = sqrt(nu l / (g t))` (Jeffreys 1930, Proc. Cambridge Phil. Soc. 26, 204), `l` the length of
//! the track above, `g` along the pane. On glass that is not wetted wholly its two contact lines draw back at
//! `theta^3 sigma / (6 mu l_n)`, theta the receding angle (de Gennes 1986, C. R. Acad. Sci. 303, 1275): the tail narrows to a point, in
//! some 0.1 s on ordinary glass, and leaves the beads of the track. Where the next drop comes sooner the track is one rivulet. Its edges
//! stand at the receding angle.
//!
//! Tails are for pictures: their water is that of the drops, which keep it.

use downpour_drop::air::STANDARD_GRAVITY;
use downpour_math::ops::f64 as ops;

use super::error::GlassError;
use super::options::GlassOptions;
use super::plan::water_at;
use super::state::GlassState;

/// Length of the track above from which a tail drains, m: about the distance of drops that follow each other.
const TRACK_M: f64 = 0.03;

/// Most steps from the edge of a track that are told apart, cells.
const MAX_EDGE: u16 = 24;

/// Shape of the tails on a pane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TailLaw {
    /// Thickness of the film after a second, m.
    second_m: f64,
    /// Speed with which its edges draw back, m/s.
    retreat_m_s: f64,
    /// Slope of its edges.
    slope: f64,
    cell_m: f64,
    clock_hz: f64,
}

impl TailLaw {
    /// Tails of the water of a pane, whose times are in units of 1 / `clock_hz` s.
    pub(crate) fn new(options: &GlassOptions, clock_hz: f64) -> Result<Self, GlassError> {
        let (density, sigma, mu) = water_at(options.temperature_c)?;
        let along = (STANDARD_GRAVITY * ops::sin(options.tilt_rad)).max(0.1);
        let theta = options.contact.receding_rad;
        Ok(Self {
            second_m: (mu / density * TRACK_M / along).sqrt(),
            retreat_m_s: theta * theta * theta * sigma / (6.0 * mu * options.contact.line_drag),
            slope: ops::tan(theta),
            cell_m: options.cell_m,
            clock_hz,
        })
    }

    /// Thickness of the film, m, a time in s after the drop, in the middle of a track.
    fn film_m(&self, after_s: f64) -> f64 {
        self.second_m / after_s.max(1.0e-3).sqrt()
    }

    /// Thickness in units, a time in s after the drop, so many meters from the edge that the track had.
    fn units(&self, after_s: f64, edge_m: f64) -> u16 {
        let edge = edge_m - self.retreat_m_s * after_s;
        let height = self.film_m(after_s).min(edge * self.slope).max(0.0);
        (height * GlassState::TAIL_UNITS_PER_M).min(f64::from(u16::MAX)) as u16
    }

    /// Thickness of the tails in units of 10 nm, cell by cell: `clocks` are the times when water last moved over the cells, 0 for never,
    /// and `now` is the time.
    pub(crate) fn tails(&self, width: usize, clocks: &[u32], now: u32) -> Vec<u16> {
        let mut tails = vec![0; clocks.len()];
        // The widest track is dry after this time; a film that does not draw back is as thin as any after a second.
        let widest_m = f64::from(MAX_EDGE) * self.cell_m;
        let life = (widest_m / self.retreat_m_s).min(1.0) * self.clock_hz;
        let is_fresh = |clock: u32| clock != 0 && f64::from(now.saturating_sub(clock)) < life;
        let fresh: Vec<usize> = (0..clocks.len()).filter(|&index| is_fresh(clocks[index])).collect();
        // Steps from the edge of what is fresh, by the neighbors' steps.
        let mut steps = vec![0u16; clocks.len()];
        for &index in &fresh {
            steps[index] = 1;
        }
        let mut inner = fresh.clone();
        for step in 1..MAX_EDGE {
            let around = |index: usize| {
                let column = index % width;
                let beside = [
                    (column > 0).then(|| index - 1),
                    (column + 1 < width).then(|| index + 1),
                    index.checked_sub(width),
                    Some(index + width).filter(|&below| below < clocks.len()),
                ];
                // Beyond the pane the track goes on.
                beside.into_iter().flatten().all(|near| steps[near] >= step)
            };
            let next: Vec<usize> = inner.iter().copied().filter(|&index| around(index)).collect();
            for &index in &next {
                steps[index] = step + 1;
            }
            inner = next;
        }
        for &index in &fresh {
            let after_s = f64::from(now.saturating_sub(clocks[index])) / self.clock_hz;
            let edge_m = (f64::from(steps[index]) - 0.5) * self.cell_m;
            tails[index] = self.units(after_s, edge_m);
        }
        smooth(width, &fresh, &tails)
    }
}

/// Binomial mean of three by three cells, for all that have water among them: steps from the edge are whole cells.
fn smooth(width: usize, fresh: &[usize], tails: &[u16]) -> Vec<u16> {
    let mut sums = vec![0u32; tails.len()];
    for &index in fresh.iter().filter(|&&index| tails[index] > 0) {
        let column = index % width;
        for (row, down) in [(-1, 1u32), (0, 2), (1, 1)] {
            for (aside, across) in [(-1, 1u32), (0, 2), (1, 1)] {
                let Some(to) = index.checked_add_signed(row * width as isize + aside) else { continue };
                let is_beside = column.checked_add_signed(aside).is_some_and(|column| column < width);
                if let Some(sum) = sums.get_mut(to).filter(|_| is_beside) {
                    *sum += u32::from(tails[index]) * down * across;
                }
            }
        }
    }
    sums.into_iter().map(|sum| (sum / 16) as u16).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law() -> TailLaw {
        TailLaw::new(&GlassOptions::default(), 1000.0).unwrap()
    }

    /// By hand, at 20 degrees: sqrt(1.004e-6 m^2/s * 0.03 m / 9.81 m/s^2) = 55 um after a second, 175 um after a tenth; the lines draw
    /// back at 0.349^3 * 0.0728 / (6 * 1.002e-3 * 20) = 2.57 cm/s.
    #[test]
    fn films_drain_as_jeffreys_found() {
        let law = law();
        assert!((law.film_m(1.0) - 55.4e-6).abs() < 0.5e-6, "{}", law.film_m(1.0));
        assert!((law.film_m(0.1) - 175.2e-6).abs() < 2.0e-6, "{}", law.film_m(0.1));
        assert!((law.retreat_m_s - 0.0257).abs() < 2.0e-4, "{}", law.retreat_m_s);
    }

    /// A track of 5 mm that a drop has run down at 10 cm/s: it narrows to a point 1 cm behind the drop, and no slope of it is steeper than
    /// the receding angle.
    #[test]
    fn a_tail_ends_in_a_point() {
        let (law, width, height) = (law(), 40usize, 100usize);
        let half_cells = 4i32;
        // The drop is in the last row; a row is 0.6 mm, 6 ms.
        let now = 10_000;
        let clock = |index: usize| {
            let (x, y) = ((index % width) as i32, index / width);
            if (x - 20).abs() > half_cells { 0 } else { now - 6 * (height - 1 - y) as u32 }
        };
        let clocks: Vec<u32> = (0..width * height).map(clock).collect();
        let tails = law.tails(width, &clocks, now);
        let wide = |y: usize| tails[y * width..][..width].iter().filter(|&&tail| tail > 0).count();
        // Smoothing adds a cell on either side.
        assert_eq!((wide(height - 1), wide(height - 40)), (11, 0));
        let widths: Vec<usize> = (0..height).map(wide).collect();
        assert!(widths.is_sorted(), "{widths:?}");
        // 2.7 mm at 2.57 cm/s: 105 ms, 17.5 rows.
        let rows = widths.iter().filter(|&&wide| wide > 0).count();
        assert!((17..=20).contains(&rows), "{rows}");
        let most = 0.6e-3 * law.slope * GlassState::TAIL_UNITS_PER_M + 1.0;
        for row in tails.chunks(width) {
            for pair in row.windows(2) {
                assert!(f64::from(pair[0].abs_diff(pair[1])) <= most, "{row:?}");
            }
        }
    }

    #[test]
    fn dry_glass_has_none() {
        assert!(law().tails(8, &[0; 64], 5000).iter().all(|&tail| tail == 0));
        assert!(law().tails(8, &[1; 64], 500_000).iter().all(|&tail| tail == 0));
    }
}
