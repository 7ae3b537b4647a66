//! Light of one return stroke over time, in closed form.

use downpour_math::ops::f64 as ops;

/// Time constants of the decay after which a stroke is dark: 0.03 % of its light is left out.
pub(super) const DARK_AFTER: f64 = 8.0;

/// Light of a stroke over time: it rises to its peak and decays, `peak (exp(-t / decay) - exp(-t / rise)) / p`, where `p` is the
/// maximum of the difference. It is 0 before the stroke and `DARK_AFTER` decays after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokePulse {
    /// Time at which it begins, s.
    pub begin_s: f64,
    /// Maximum, in lux on a surface that faces it.
    pub peak_lux: f64,
    /// Time constant of the rise, s; 0: the light begins with its peak.
    pub rise_s: f64,
    /// Time constant of the decay, s; above `rise_s`.
    pub decay_s: f64,
}

impl StrokePulse {
    /// Time at which it is dark, s.
    #[must_use]
    pub fn end_s(&self) -> f64 {
        self.begin_s + DARK_AFTER * self.decay_s
    }

    /// Illuminance at a time in s, lux.
    #[must_use]
    pub fn at(&self, time_s: f64) -> f64 {
        let age = time_s - self.begin_s;
        if age < 0.0 || age >= DARK_AFTER * self.decay_s {
            return 0.0;
        }
        let risen = if self.rise_s > 0.0 { ops::exp(-age / self.rise_s) } else { 0.0 };
        self.scale() * (ops::exp(-age / self.decay_s) - risen)
    }

    /// Integral of the illuminance from `open_s` to `close_s`, in lux s, and of the same times the time since `open_s`, in lux s^2.
    #[must_use]
    pub fn exposure(&self, open_s: f64, close_s: f64) -> [f64; 2] {
        let begin = open_s.max(self.begin_s);
        let end = close_s.min(self.end_s());
        if end <= begin {
            return [0.0; 2];
        }
        let ages = [begin - self.begin_s, end - self.begin_s];
        let [decay, decay_late] = exponential(self.decay_s, ages);
        let [rise, rise_late] = exponential(self.rise_s, ages);
        let whole = self.scale() * (decay - rise);
        // From the age to the time since the exposure began.
        [whole, self.scale() * (decay_late - rise_late) + whole * (self.begin_s - open_s)]
    }

    /// Factor from the difference of the two exponentials to the illuminance, lux.
    fn scale(&self) -> f64 {
        let (rise, decay) = (self.rise_s, self.decay_s);
        if rise <= 0.0 {
            return self.peak_lux;
        }
        let at = rise * decay / (decay - rise) * ops::ln(decay / rise);
        self.peak_lux / (ops::exp(-at / decay) - ops::exp(-at / rise))
    }
}

/// Integrals of `exp(-t / tau)` and of `t exp(-t / tau)` between two ages.
fn exponential(tau: f64, [from, to]: [f64; 2]) -> [f64; 2] {
    if tau <= 0.0 {
        return [0.0; 2];
    }
    let [first, last] = [from, to].map(|age| ops::exp(-age / tau));
    [tau * (first - last), tau * ((from + tau) * first - (to + tau) * last)]
}

#[cfg(test)]
mod tests {
    use super::*;

    const PULSE: StrokePulse = StrokePulse { begin_s: 2.0, peak_lux: 700.0, rise_s: 1.0e-3, decay_s: 0.02 };

    /// The closed form against sums of the light over small steps.
    #[test]
    fn the_closed_form_is_the_integral() {
        for rise_s in [0.0, 1.0e-4, 1.0e-3, 0.01] {
            let pulse = StrokePulse { rise_s, ..PULSE };
            for (open, close) in [(1.99, 2.0067), (2.003, 2.02), (1.0, 3.0), (2.05, 2.3), (0.0, 1.0)] {
                let (mut whole, mut late, n) = (0.0, 0.0, 400_000);
                let step = (close - open) / f64::from(n);
                for k in 0..n {
                    let after = (f64::from(k) + 0.5) * step;
                    whole += pulse.at(open + after) * step;
                    late += pulse.at(open + after) * after * step;
                }
                let [found, found_late] = pulse.exposure(open, close);
                assert!((found - whole).abs() < 2.0e-4 * whole + 1.0e-9, "{rise_s}: {found} {whole}");
                assert!((found_late - late).abs() < 2.0e-4 * late + 1.0e-9, "{rise_s}: {found_late} {late}");
            }
        }
    }

    #[test]
    fn the_peak_is_the_one_that_was_asked_for() {
        let most = (0..100_000).map(|k| PULSE.at(2.0 + f64::from(k) * 1.0e-6)).fold(0.0, f64::max);
        assert!((most / 700.0 - 1.0).abs() < 1.0e-6, "{most}");
        assert_eq!((PULSE.at(1.999), PULSE.at(PULSE.end_s())), (0.0, 0.0));
        assert_eq!(StrokePulse { rise_s: 0.0, ..PULSE }.at(2.0), 700.0);
    }

    /// Parts of an exposure have together the light of all of it.
    #[test]
    fn intervals_add_up() {
        let whole = PULSE.exposure(1.9, 2.5)[0];
        let parts: f64 =
            (0..60).map(|k| PULSE.exposure(1.9 + f64::from(k) * 0.01, 1.91 + f64::from(k) * 0.01)[0]).sum();
        assert!((parts / whole - 1.0).abs() < 1.0e-9);
    }
}
