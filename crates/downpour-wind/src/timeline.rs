//! Values over time: keys with linear interpolation.

use downpour_math::{OutOfRange, in_range};
use glam::DVec3;

use crate::error::WindError;

/// Maximum number of keys of one parameter.
pub const WIND_KEYS: usize = 4096;

/// Range of times of keys, s.
pub const WIND_KEY_TIMES: std::ops::RangeInclusive<f64> = -1.0e6..=1.0e6;

/// Resolution of the times of keys, to which they are rounded; they must differ by a tick.
const TICKS_PER_SECOND: f64 = 1.0e6;

mod sealed {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for glam::DVec3 {}
}

/// A type that can be keyed: a number, or a vector.
pub trait Blend: Copy + PartialEq + sealed::Sealed {
    /// Linear interpolation from `self` to `other` by `fraction`, 0 to 1.
    #[must_use]
    fn blend(self, other: Self, fraction: f64) -> Self;

    /// First component that is not finite.
    fn not_finite(self) -> Option<f64>;
}

impl Blend for f64 {
    fn blend(self, other: Self, fraction: f64) -> Self {
        self + (other - self) * fraction
    }

    fn not_finite(self) -> Option<f64> {
        (!self.is_finite()).then_some(self)
    }
}

impl Blend for DVec3 {
    fn blend(self, other: Self, fraction: f64) -> Self {
        self + (other - self) * fraction
    }

    fn not_finite(self) -> Option<f64> {
        self.to_array().into_iter().find_map(f64::not_finite)
    }
}

/// A value over time: linear between its keys, constant before the first and after the last.
///
/// ```
/// use downpour_wind::Keyed;
/// let rising = Keyed::new(vec![(0.0, 3.0), (10.0, 12.0)])?;
/// assert_eq!([-5.0, 0.0, 5.0, 99.0].map(|time| rising.at(time)), [3.0, 3.0, 7.5, 12.0]);
/// assert_eq!(Keyed::from(4.0).at(2.0), 4.0);
/// assert!(Keyed::new(vec![(10.0, 3.0), (0.0, 12.0)]).is_err());
/// # Ok::<(), downpour_wind::WindError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Keyed<T> {
    /// Never empty; times increase.
    keys: Vec<(f64, T)>,
}

impl<T: Blend> From<T> for Keyed<T> {
    /// Creates a constant value.
    fn from(value: T) -> Self {
        Self { keys: vec![(0.0, value)] }
    }
}

impl<T: Blend> Keyed<T> {
    /// Creates a value from keys of time, s, and value. Times are rounded to a microsecond.
    ///
    /// # Errors
    /// [`WindError::KeyCount`] for no keys or more than [`WIND_KEYS`]; [`WindError::KeyTime`] for times that do not increase
    /// by at least a microsecond; [`WindError::OutOfRange`] for times outside [`WIND_KEY_TIMES`] and values that are
    /// not finite.
    pub fn new(mut keys: Vec<(f64, T)>) -> Result<Self, WindError> {
        if !(1..=WIND_KEYS).contains(&keys.len()) {
            return Err(WindError::KeyCount { found: keys.len(), allowed: WIND_KEYS });
        }
        let mut before = f64::NEG_INFINITY;
        for (index, (time, value)) in keys.iter_mut().enumerate() {
            in_range("time of a key", *time, "s", &WIND_KEY_TIMES, 1.0, "-1e6 to 1e6")?;
            if let Some(found) = value.not_finite() {
                let (quantity, unit, allowed) = ("value of a key", "(a component)", "finite numbers".into());
                return Err(OutOfRange { quantity, found, unit, allowed }.into());
            }
            *time = (*time * TICKS_PER_SECOND).round() / TICKS_PER_SECOND;
            if *time <= before {
                return Err(WindError::KeyTime { index, found: *time, before });
            }
            before = *time;
        }
        Ok(Self { keys })
    }

    /// Value at a time, s.
    #[must_use]
    pub fn at(&self, time_s: f64) -> T {
        let next = self.keys.partition_point(|&(time, _)| time <= time_s);
        match (next.checked_sub(1).and_then(|last| self.keys.get(last)), self.keys.get(next)) {
            (Some(&(start, from)), Some(&(end, to))) => from.blend(to, (time_s - start) / (end - start)),
            (Some(&(_, value)), None) | (None, Some(&(_, value))) => value,
            (None, None) => unreachable!("a value has one key at least"),
        }
    }

    /// Keys: time in s, and value.
    #[must_use]
    pub fn keys(&self) -> &[(f64, T)] {
        &self.keys
    }

    /// Maps the value of each key.
    #[must_use]
    pub fn map<U: Blend>(&self, change: impl Fn(T) -> U) -> Keyed<U> {
        Keyed { keys: self.keys.iter().map(|&(time, value)| (time, change(value))).collect() }
    }

    /// Combines two values at the keys of either; linear between those.
    #[must_use]
    pub fn with<U: Blend, V: Blend>(&self, other: &Keyed<U>, make: impl Fn(T, U) -> V) -> Keyed<V> {
        let mut times = Vec::new();
        self.times(&mut times);
        other.times(&mut times);
        // Both are constant.
        if times.is_empty() {
            times.push(0.0);
        }
        sort_times(&mut times);
        Keyed { keys: times.into_iter().map(|time| (time, make(self.at(time), other.at(time)))).collect() }
    }

    /// Adds the times of the keys, if there are several.
    pub(crate) fn times(&self, times: &mut Vec<f64>) {
        if self.keys.len() > 1 {
            times.extend(self.keys.iter().map(|&(time, _)| time));
        }
    }
}

/// Sorts the times and removes duplicates.
pub(crate) fn sort_times(times: &mut Vec<f64>) {
    times.sort_by(f64::total_cmp);
    times.dedup();
}

impl Keyed<DVec3> {
    /// Normalizes the directions at the keys.
    ///
    /// # Errors
    /// [`WindError::ZeroAxis`] for a key without direction, [`WindError::AxisReverses`] if the line from one key to the next
    /// leads through (or within 0.01 of) the zero vector: then the sense of rotation is undefined.
    pub fn directions(&self, quantity: &'static str) -> Result<Self, WindError> {
        let mut keys = Vec::with_capacity(self.keys.len());
        for &(time, vector) in &self.keys {
            let found = vector.as_vec3();
            let length = vector.length();
            if !(1.0e-3..=1.0e9).contains(&length) {
                return Err(WindError::ZeroAxis { quantity, found: found.to_array() });
            }
            keys.push((time, vector / length));
        }
        for pair in keys.windows(2) {
            let [(_, from), (time, to)] = *pair else { continue };
            if (from + to).length() < 0.02 {
                return Err(WindError::AxisReverses { quantity, time });
            }
        }
        Ok(Self { keys })
    }
}
