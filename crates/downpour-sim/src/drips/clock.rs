//! Times at which drops leave a drip point, in closed form.

use downpour_math::ops::f64 as ops;

/// Speed of a film of water on a surface, m/s.
const FILM_M_S: f64 = 0.1;

/// Time constant with which a wet surface without length runs dry, s.
const DRAINING_S: f64 = 60.0;

/// Rain that runs off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DripRain {
    /// Rate, m/s of depth.
    pub rate_m_s: f64,
    /// Time at which it begins, s.
    pub begin_s: f64,
    /// Time at which it ends, s; infinite if it goes on.
    pub end_s: f64,
    /// Depth of water that surfaces store before it runs off, m.
    pub storage_m: f64,
}

/// Drops per second, as a whole number of units that a device can count in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct DripRate {
    /// Number of units of 2^-shift drops per second.
    pub(super) units: u32,
    /// From 1 to 31: as many units as 32 bits hold.
    pub(super) shift: u32,
}

impl DripRate {
    /// The rate nearest to so many drops per second, at most 2^31.
    fn new(per_s: f64) -> Self {
        let units = |shift: u32| (per_s.max(0.0) * f64::from(1u32 << shift)).round();
        let shift = (1..32).rev().find(|&shift| units(shift) <= f64::from(u32::MAX)).unwrap_or(1);
        Self { units: units(shift).min(f64::from(u32::MAX)) as u32, shift }
    }

    /// Drops per second.
    fn per_s(self) -> f64 {
        f64::from(self.units) / f64::from(1u32 << self.shift)
    }
}

/// Number of drops that have left a point, as a function of time: it rises with the rain, and after it by a part that decays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Clock {
    pub(super) rate: DripRate,
    per_s: f64,
    start_s: f64,
    stop_s: f64,
    drain_s: f64,
}

impl Clock {
    /// The clock of a point with a number of drops per second and the length of its flow, m; `None` where none drips.
    pub(super) fn new(rain: &DripRain, per_s: f64, flow_m: f64) -> Option<Self> {
        let lag_s = flow_m / FILM_M_S;
        let start_s = rain.begin_s + rain.storage_m / rain.rate_m_s + lag_s;
        let rate = DripRate::new(per_s);
        let drips = rate.units > 0 && start_s.is_finite() && rain.end_s > start_s;
        let drain_s = lag_s + DRAINING_S;
        drips.then_some(Self { rate, per_s: rate.per_s(), start_s, stop_s: rain.end_s, drain_s })
    }

    /// The clock of a point that has always dripped and always will.
    pub(super) fn steady(per_s: f64, start_s: f64) -> Self {
        let rate = DripRate::new(per_s);
        Self { rate, per_s: rate.per_s(), start_s, stop_s: f64::INFINITY, drain_s: DRAINING_S }
    }

    /// Drops per second while it rains.
    pub(super) fn per_s(&self) -> f64 {
        self.per_s
    }

    /// Number of drops that would have left at a time if the rain did not end.
    pub(super) fn count_in_rain(&self, time_s: f64) -> f64 {
        (time_s - self.start_s) * self.per_s
    }

    /// End of the rain, s, number of drops that have left then, and the time constant with which the point then runs dry, s; `None` if the
    /// rain goes on.
    #[cfg(feature = "wgpu")]
    pub(super) fn end(&self) -> Option<[f64; 3]> {
        self.stop_s.is_finite().then(|| [self.stop_s, self.count_in_rain(self.stop_s), self.drain_s])
    }

    /// Number of drops, with a fraction, that have left at a time; negative before the first.
    pub(super) fn count(&self, time_s: f64) -> f64 {
        let rained = self.count_in_rain(time_s.min(self.stop_s));
        let after = time_s - self.stop_s;
        if after <= 0.0 || !self.stop_s.is_finite() {
            return rained;
        }
        rained - ops::exp_m1(-after / self.drain_s) * self.drain_s * self.per_s
    }

    /// Time of a number of drops; infinite for more than there will be.
    pub(super) fn time(&self, count: f64) -> f64 {
        let steady = self.start_s + count / self.per_s;
        if steady <= self.stop_s {
            return steady;
        }
        let left = (count - (self.stop_s - self.start_s) * self.per_s) / (self.drain_s * self.per_s);
        if left >= 1.0 { f64::INFINITY } else { self.stop_s - self.drain_s * ops::ln_1p(-left) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RAIN: DripRain = DripRain { rate_m_s: 1.0e-5, begin_s: -100.0, end_s: 50.0, storage_m: 3.0e-4 };

    /// 0.3 mm at 36 mm/h fill in 30 s, and 2 m take 20 s.
    #[test]
    fn drops_begin_after_storage_and_way() {
        let clock = Clock::new(&RAIN, 2.0, 2.0).unwrap();
        assert!(clock.count(-50.0).abs() < 1.0e-9);
        assert!((clock.count(-40.0) - 20.0).abs() < 1.0e-9);
        // At the end 200; then 80 s of it again.
        assert!((clock.count(50.0) - 200.0).abs() < 1.0e-9);
        assert!((clock.count(1.0e5) - 360.0).abs() < 1.0e-6);
        assert!((clock.count(130.0) - (200.0 + 160.0 * (1.0 - ops::exp(-1.0)))).abs() < 1.0e-9);
    }

    #[test]
    fn times_are_the_inverse_of_counts() {
        let clock = Clock::new(&RAIN, 2.0, 2.0).unwrap();
        for count in [0.0, 10.5, 199.0, 201.0, 300.0, 359.0] {
            assert!((clock.count(clock.time(count)) - count).abs() < 1.0e-6, "{count}");
        }
        assert_eq!(clock.time(361.0), f64::INFINITY);
        let steady = Clock::steady(0.5, -1.0e6);
        assert!((steady.time(steady.count(12.3)) - 12.3).abs() < 1.0e-6);
    }

    #[test]
    fn short_rains_do_not_drip() {
        assert_eq!(Clock::new(&DripRain { end_s: -75.0, ..RAIN }, 2.0, 0.0), None);
        assert_eq!(Clock::new(&DripRain { rate_m_s: 0.0, ..RAIN }, 0.0, 0.0), None);
    }
}
