//! Integrals over diameters, and their inverses.
//!
//! The range is split into panels that are narrow at small diameters and never cross a kink of the fall speed; each
//! panel is integrated by a Gauss-Legendre rule.

use downpour_math::quadrature::GaussLegendre;

/// Maximum width of a panel, in meters.
const MAX_PANEL_M: f64 = 1.0e-3 / 32.0;

/// Width in meters from which panels grow.
const MIN_PANEL_M: f64 = 1.0e-6;

/// Maximum width of a panel relative to its diameter.
const GROWTH: f64 = 0.25;

#[derive(Clone, Debug)]
pub(super) struct Grid {
    edges: Vec<f64>,
    rule: GaussLegendre,
}

impl Grid {
    /// Creates panels from `smallest` to `largest`; `kinks` are in ascending order.
    pub(super) fn new(smallest: f64, largest: f64, kinks: &[f64]) -> Self {
        let mut edges = vec![smallest];
        let mut at = smallest;
        while at < largest {
            let stop = kinks.iter().copied().find(|&k| k > at).map_or(largest, |k| k.min(largest));
            let width = (GROWTH * at).clamp(MIN_PANEL_M, MAX_PANEL_M);
            // The last panel before a stop takes the remainder, so that no panel is too narrow.
            at = if at + 1.5 * width < stop { at + width } else { stop };
            edges.push(at);
        }
        Self { edges, rule: GaussLegendre::new(8) }
    }

    pub(super) fn integrate(&self, mut f: impl FnMut(f64) -> f64) -> f64 {
        self.edges.windows(2).map(|e| self.rule.integrate(e[0], e[1], &mut f)).sum()
    }

    /// Integrals from both ends up to every edge.
    pub(super) fn cumulate<F: Fn(f64) -> f64>(&self, f: F) -> Cumulative<'_, F> {
        let mut below = Vec::with_capacity(self.edges.len());
        let mut sum = 0.0;
        below.push(sum);
        let panels: Vec<f64> = self.edges.windows(2).map(|e| self.rule.integrate(e[0], e[1], &f)).collect();
        for panel in &panels {
            sum += panel;
            below.push(sum);
        }
        // Summed from the other end: as a difference to the total, the tail would have no digits left.
        let mut above = vec![0.0; self.edges.len()];
        for i in (0..panels.len()).rev() {
            above[i] = above[i + 1] + panels[i];
        }
        Cumulative { grid: self, f, below, above }
    }
}

/// Density with its integrals from both ends.
#[derive(Debug)]
pub(super) struct Cumulative<'a, F> {
    grid: &'a Grid,
    f: F,
    below: Vec<f64>,
    above: Vec<f64>,
}

impl<F: Fn(f64) -> f64> Cumulative<'_, F> {
    /// Diameter below which a `fraction` of the integral lies.
    pub(super) fn at_fraction_below(&self, fraction: f64) -> f64 {
        let panels = self.grid.edges.len() - 1;
        let target = fraction * self.below[panels];
        let panel = self.below.partition_point(|&b| b <= target).clamp(1, panels) - 1;
        let (a, b) = (self.grid.edges[panel], self.grid.edges[panel + 1]);
        self.solve(a, b, target - self.below[panel], |x| self.grid.rule.integrate(a, x, &self.f))
    }

    /// Diameter above which a `fraction` of the integral lies.
    pub(super) fn at_fraction_above(&self, fraction: f64) -> f64 {
        let panels = self.grid.edges.len() - 1;
        let target = fraction * self.above[0];
        let panel = self.above.partition_point(|&b| b > target).clamp(1, panels) - 1;
        let (a, b) = (self.grid.edges[panel], self.grid.edges[panel + 1]);
        let within = self.above[panel] - self.above[panel + 1];
        let missing = within - (target - self.above[panel + 1]);
        self.solve(a, b, missing, |x| within - self.grid.rule.integrate(x, b, &self.f))
    }

    /// Solves `mass(x) = target`, where `mass` rises from a to b with the slope f: Newton within a shrinking bracket.
    fn solve(&self, a: f64, b: f64, target: f64, mass: impl Fn(f64) -> f64) -> f64 {
        let (mut lo, mut hi) = (a, b);
        let mut x = 0.5 * (a + b);
        for _ in 0..60 {
            let excess = mass(x) - target;
            if excess > 0.0 {
                hi = x;
            } else {
                lo = x;
            }
            let slope = (self.f)(x);
            let newton = x - excess / slope;
            // Outside the bracket, or NaN where the density is 0: bisect.
            let next = if newton > lo && newton < hi { newton } else { 0.5 * (lo + hi) };
            if (next - x).abs() <= 1.0e-11 * b {
                return next;
            }
            x = next;
        }
        x
    }
}
