//! Operator of a lattice that approximates omega^2: a polynomial of the lattice's Laplacian.
//!
//! On a lattice, the (negative) Laplacian L of a plane wave is a number lambda between 0 and a maximum. The dispersion
//! law needs omega^2 instead, which is not a polynomial of lambda: tanh and odd powers of k are not local. Over the
//! wavelengths that a lattice resolves it is close to one, though. Fewer octaves and shallower water need a lower
//! degree:
//!
//! > omega^2 ~ p(lambda) = x (c_0 + c_1 T_1(2 x - 1) + ... ),   x = lambda / largest lambda
//!
//! with Chebyshev's `T_j`; c is found by weighted least squares of p / omega^2 - 1 over wavelengths and directions. The
//! advantage of a polynomial of L over a freely fitted convolution: L couples neighbors with positive weights, and
//! stays symmetric and positive without the links to land. So p(L), with p > 0, conserves volume and energy, keeps
//! level water level, lets nothing through a wall, and is stable below one known time step, around any obstacle. It
//! costs one pass over the neighbors per degree.
//!
//! Leapfrog turns omega^2 into 4 sin^2(omega dt / 2) / dt^2. The fit includes this, so that the coefficients
//! compensate the error of the time step.

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

use downpour_math::ops::f64 as ops;

use super::dispersion::{Dispersion, PuddleForm};

/// Maximum degree, the number of passes over the neighbors per step.
pub const MAX_DEGREE: u32 = 12;

/// Maximum Courant number of a step; leapfrog is stable below 1 / sqrt(2).
pub const MAX_COURANT: f64 = 0.70;

/// Minimum number of cells per wavelength for which the law is fitted.
pub(crate) const MIN_WAVE_CELLS: f64 = 4.0;

/// Stencil of the Laplacian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stencil {
    /// Weights of the cell, of its four straight and of its four diagonal neighbors.
    pub(crate) weights: [f32; 3],
    /// Divisor of the weights for a cell of 1 m.
    pub(crate) unit: f64,
    /// Largest value of the weighted sum for a wave of amplitude 1.
    pub(crate) largest: f64,
}

impl Stencil {
    /// Stencil of a form: four neighbors, as the paper's membrane; nine cells, isotropic to fourth order, for real
    /// water.
    pub(crate) fn of(form: PuddleForm) -> Self {
        match form {
            PuddleForm::Membrane { .. } => Self { weights: [4.0, 1.0, 0.0], unit: 1.0, largest: 8.0 },
            PuddleForm::GravityCapillary => Self { weights: [20.0, 4.0, 1.0], unit: 6.0, largest: 32.0 },
        }
    }

    /// lambda of a plane wave with these phase differences per cell, as a fraction of the maximum.
    pub(crate) fn fraction(&self, turn: [f64; 2]) -> f64 {
        let [x, y] = turn.map(ops::cos);
        let [center, straight, diagonal] = self.weights.map(f64::from);
        (center - 2.0 * straight * (x + y) - 4.0 * diagonal * x * y) / self.largest
    }
}

/// The fitted polynomial.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Symbol {
    pub(crate) stencil: Stencil,
    /// `c_0`, `c_1`, ..., in 1/s^2.
    pub(crate) coefficients: Vec<f64>,
}

impl Symbol {
    /// Fits the polynomial of a degree for a time step (0: for continuous time), and wavelengths from 4 cells to
    /// `longest`.
    pub(crate) fn fit(law: &Dispersion, cell: f64, degree: u32, longest: f64, dt: f64) -> Self {
        let stencil = Stencil::of(law.form);
        if let PuddleForm::Membrane { speed_m_s } = law.form {
            let speed = f64::from(speed_m_s);
            let largest = speed * speed / (cell * cell) * stencil.largest / stencil.unit;
            return Self { stencil, coefficients: vec![largest] };
        }
        // Short waves have a low weight, which rises until the polynomial is positive for all of them.
        let mut weight = 0.01;
        loop {
            let fitted = Self::least_squares(law, cell, degree, longest, dt, weight);
            if fitted.is_positive(law, cell) || weight > 1.0e4 {
                return fitted;
            }
            weight *= 2.0;
        }
    }

    fn least_squares(law: &Dispersion, cell: f64, degree: u32, longest: f64, dt: f64, short: f64) -> Self {
        const WAVES: u32 = 96;
        const SHORT: u32 = 32;
        let stencil = Stencil::of(law.form);
        let n = degree as usize;
        let mut system = vec![vec![0.0; n + 1]; n];
        let mut add = |fraction: f64, wanted: f64, weight: f64| {
            let basis = basis(fraction, n);
            for i in 0..n {
                for j in 0..n {
                    system[i][j] += weight * basis[i] * basis[j] / (wanted * wanted);
                }
                system[i][n] += weight * basis[i] / wanted;
            }
        };
        let shortest_turn = TAU / MIN_WAVE_CELLS;
        let longest_turn = TAU * cell / longest;
        for wave in 0..WAVES {
            let position = (f64::from(wave) + 0.5) / f64::from(WAVES);
            let turn = longest_turn * ops::pow(shortest_turn / longest_turn, position);
            let wanted = in_steps(law.squared_frequency(turn / cell), dt);
            for direction in [0.0, PI / 8.0, PI / 4.0] {
                let turns = [turn * ops::cos(direction), turn * ops::sin(direction)];
                add(stencil.fraction(turns), wanted, 1.0 / f64::from(3 * WAVES));
            }
        }
        let first = stencil.fraction([shortest_turn, 0.0]);
        for wave in 0..SHORT {
            let fraction = first + (1.0 - first) * (f64::from(wave) + 1.0) / f64::from(SHORT);
            add(
                fraction,
                in_steps(law.squared_frequency(short_wave(fraction, first, cell)), dt),
                short / f64::from(SHORT),
            );
        }
        Self { stencil, coefficients: solve(system) }
    }

    /// True if every fitted wave has at least a twentieth of its omega^2, and every shorter one of that of 4 cells.
    fn is_positive(&self, law: &Dispersion, cell: f64) -> bool {
        let first = self.stencil.fraction([TAU / MIN_WAVE_CELLS, 0.0]);
        (1..=400u32).all(|i| {
            let fraction = f64::from(i) / 400.0;
            let wanted = law.squared_frequency(short_wave(fraction, first, cell));
            self.at(fraction).is_finite() && self.at(fraction) > 0.05 * wanted
        })
    }

    /// p, in 1/s^2, for lambda as a fraction of the maximum.
    pub(crate) fn at(&self, fraction: f64) -> f64 {
        basis(fraction, self.coefficients.len()).iter().zip(&self.coefficients).map(|(b, c)| b * c).sum()
    }

    /// omega, in 1/s, of a plane wave with these phase differences per cell, on a lattice with time step `dt`.
    pub(crate) fn frequency(&self, turn: [f64; 2], dt: f64) -> f64 {
        let squared = self.at(self.stencil.fraction(turn)).max(0.0);
        if dt > 0.0 { 2.0 / dt * ops::asin((0.5 * dt * squared.sqrt()).min(1.0)) } else { squared.sqrt() }
    }

    /// Courant number of a time step: leapfrog becomes unstable at 1 / sqrt(2). For a membrane without
    /// viscosity it is c dt / cell.
    pub(crate) fn courant(&self, dt: f64, viscosity: f64, cell: f64) -> f64 {
        let damping = 4.0 * viscosity / (cell * cell) * self.stencil.largest / self.stencil.unit;
        let worst = (0..=400u32)
            .map(|i| f64::from(i) / 400.0)
            .map(|fraction| dt * dt * self.at(fraction) + 2.0 * dt * damping * fraction)
            .fold(0.0, f64::max);
        0.5 * FRAC_1_SQRT_2 * worst.sqrt()
    }

    /// Largest relative error of the phase speed over the fitted wavelengths.
    pub(crate) fn worst_error(&self, law: &Dispersion, cell: f64, longest: f64) -> f64 {
        let (a, b) = (TAU / MIN_WAVE_CELLS, TAU * cell / longest);
        let mut worst: f64 = 0.0;
        for wave in 0..=64 {
            let turn = b * ops::pow(a / b, f64::from(wave) / 64.0);
            for direction in [0.0, PI / 8.0, PI / 4.0] {
                let turns = [turn * ops::cos(direction), turn * ops::sin(direction)];
                let ratio = self.frequency(turns, 0.0) / law.squared_frequency(turn / cell).sqrt();
                worst = worst.max((ratio - 1.0).abs());
            }
        }
        worst
    }
}

/// omega^2 that a leapfrog of time step `dt` needs to give omega, constant beyond the shortest period.
fn in_steps(squared: f64, dt: f64) -> f64 {
    if dt <= 0.0 {
        return squared;
    }
    // Waves of periods close to two time steps are damped numerically at best: the law ends at 0.7 of that.
    let half_turn = (0.5 * dt * squared.sqrt()).min(0.35 * PI);
    let s = 2.0 / dt * ops::sin(half_turn);
    s * s
}

/// Wave number in 1/m for a fraction of the maximum lambda, where a lattice no longer resolves directions: as
/// sqrt(lambda), and continuous at 4 cells along an axis.
fn short_wave(fraction: f64, first: f64, cell: f64) -> f64 {
    TAU / MIN_WAVE_CELLS / cell * (fraction / first).sqrt()
}

/// `x T_j(2 x - 1)` for j below n.
fn basis(x: f64, n: usize) -> Vec<f64> {
    let y = 2.0 * x - 1.0;
    let (mut before, mut now) = (y, 1.0);
    (0..n)
        .map(|_| {
            let value = x * now;
            (before, now) = (now, 2.0 * y * now - before);
            value
        })
        .collect()
}

/// Gaussian elimination with pivots; the last column is the right side.
fn solve(mut system: Vec<Vec<f64>>) -> Vec<f64> {
    let n = system.len();
    for i in 0..n {
        let pivot = (i..n).max_by(|&a, &b| system[a][i].abs().total_cmp(&system[b][i].abs())).unwrap_or(i);
        system.swap(i, pivot);
        let row = system[i].clone();
        for below in system.iter_mut().skip(i + 1) {
            let factor = below[i] / row[i];
            for (a, b) in below.iter_mut().zip(&row) {
                *a -= factor * b;
            }
        }
    }
    let mut out = vec![0.0; n];
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| system[i][j] * out[j]).sum();
        out[i] = (system[i][n] - known) / system[i][i];
    }
    out
}

/// Lowest degree with errors of the phase speed below 2.5 % over the wavelengths of the fit, else the maximum degree.
pub(crate) fn degree_for(law: &Dispersion, cell: f64, longest: f64) -> u32 {
    if matches!(law.form, PuddleForm::Membrane { .. }) {
        return 1;
    }
    [2, 3, 4, 5, 6, 8, 10]
        .into_iter()
        .find(|&degree| {
            let symbol = Symbol::fit(law, cell, degree, longest, 0.0);
            symbol.worst_error(law, cell, longest) < 0.025
        })
        .unwrap_or(MAX_DEGREE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::puddle::PuddleWater;

    fn law(depth: f64) -> Dispersion {
        Dispersion { form: PuddleForm::GravityCapillary, water: PuddleWater::default(), depth }
    }

    #[test]
    fn every_operator_is_positive_and_right_where_it_is_fitted() {
        for cell in [0.5e-3, 1.0e-3, 2.0e-3, 4.0e-3] {
            for depth in [0.5e-3, 1.0e-3, 2.0e-3, 5.0e-3, 1.0e-2, 2.0e-2, 1.0] {
                let (law, longest) = (law(depth), 40.0 * cell);
                let degree = degree_for(&law, cell, longest);
                let symbol = Symbol::fit(&law, cell, degree, longest, 0.0);
                assert!(symbol.is_positive(&law, cell), "{cell} {depth}");
                let worst = symbol.worst_error(&law, cell, longest);
                let allowed = if depth > 4.0 * cell { 0.13 } else { 0.025 };
                assert!(worst < allowed, "cells of {cell} m, {depth} m deep, degree {degree}: {worst}");
            }
        }
    }

    #[test]
    fn time_steps_do_not_add_to_the_error() {
        let (law, cell) = (law(5.0e-3), 2.0e-3);
        for dt in [1.0e-3, 3.0e-3, 5.0e-3] {
            let symbol = Symbol::fit(&law, cell, 4, 0.08, dt);
            assert!(symbol.courant(dt, 0.0, cell) <= MAX_COURANT);
            for cells in [5.0, 8.0, 20.0, 40.0] {
                let turn = TAU / cells;
                let wanted = law.squared_frequency(turn / cell).sqrt();
                let found = symbol.frequency([turn, 0.0], dt);
                assert!((found / wanted - 1.0).abs() < 0.012, "{dt} {cells}: {found} for {wanted}");
            }
        }
    }

    #[test]
    fn the_courant_number_of_a_membrane_is_the_textbook_one() {
        let form = PuddleForm::Membrane { speed_m_s: 0.5 };
        let law = Dispersion { form, ..law(1.0) };
        let symbol = Symbol::fit(&law, 0.01, 1, 0.4, 0.0);
        assert!((symbol.courant(0.014, 0.0, 0.01) - 0.70).abs() < 1.0e-12);
    }
}
