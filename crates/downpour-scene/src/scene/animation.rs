//! Movements over time: glTF 2.0, section 3.11.

use super::interpolation::{cubic, linear, spherical, unit};

/// Movements that belong together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Animation {
    /// Name in the file; may be empty.
    pub name: String,
    /// Channels: targets and their tracks.
    pub channels: Vec<Channel>,
}

/// The movement of one property of one node.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// The node.
    pub node: usize,
    /// Animated property of the node.
    pub property: Property,
    /// Its values over time.
    pub track: Track,
}

/// Animated property of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Property {
    /// Three numbers, in meters.
    Translation,
    /// The four parts x, y, z, w of a unit quaternion.
    Rotation,
    /// Three factors.
    Scale,
    /// One weight for each morph target.
    Weights,
}

/// Interpolation of values between keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Interpolation {
    /// The value of the last key.
    Step,
    /// A straight line, or an arc for rotations.
    #[default]
    Linear,
    /// A cubic spline. Each key has three values: the tangent into it, its value, the tangent out of it.
    CubicSpline,
}

/// Values over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Track {
    /// The times of the keys in seconds, from 0 on, rising.
    pub times: Vec<f32>,
    /// Values of all keys in order: `width` numbers for each, three times as many with tangents.
    pub values: Vec<f32>,
    /// Number of components of a value.
    pub width: usize,
    /// Interpolation of values between keys.
    pub interpolation: Interpolation,
    /// True if values are rotations.
    pub turns: bool,
}

impl Animation {
    /// The time of the last key, in seconds.
    #[must_use]
    pub fn length_s(&self) -> f32 {
        self.channels.iter().filter_map(|channel| channel.track.times.last()).fold(0.0, |all, &t| all.max(t))
    }

    /// Time within the animation: the remainder of `time_s` after whole loops.
    ///
    /// ```
    /// use downpour_scene::scene::{Animation, Channel, Property, Track};
    /// let track = Track { times: vec![0.0, 4.0], values: vec![0.0; 6], width: 3, ..Track::default() };
    /// let channels = vec![Channel { node: 0, property: Property::Translation, track }];
    /// let round = Animation { name: "round".into(), channels };
    /// assert_eq!((round.wrapped(9.0), round.wrapped(-1.0), round.wrapped(f32::NAN)), (1.0, 3.0, 0.0));
    /// ```
    #[must_use]
    pub fn wrapped(&self, time_s: f32) -> f32 {
        let length = self.length_s();
        if length > 0.0 && time_s.is_finite() { time_s.rem_euclid(length) } else { 0.0 }
    }
}

impl Track {
    /// Samples the value at a time in seconds into `value`; that of the first or last key outside of them. `value` is
    /// unchanged if the track is empty or has too few values.
    pub fn sample(&self, time_s: f32, value: &mut Vec<f64>) {
        value.clear();
        let after = self.times.partition_point(|&key| key <= time_s);
        let Some(before) = after.checked_sub(1) else { return self.key(0, 1, value) };
        let (Some(&from), Some(&to)) = (self.times.get(before), self.times.get(after)) else {
            return self.key(before, 1, value);
        };
        let span = f64::from(to) - f64::from(from);
        let t = (f64::from(time_s) - f64::from(from)) / span;
        match self.interpolation {
            Interpolation::Step => self.key(before, 1, value),
            Interpolation::Linear => match (self.quaternion(before), self.quaternion(after)) {
                (Some(a), Some(b)) if self.turns => value.extend(spherical(a, b, t)),
                _ => {
                    self.key(before, 1, value);
                    let ends = self.part(after, 1);
                    value.iter_mut().zip(ends).for_each(|(a, &b)| *a = linear(*a, f64::from(b), t));
                }
            },
            Interpolation::CubicSpline => {
                self.key(before, 1, value);
                let others = self.part(before, 2).iter().zip(self.part(after, 1)).zip(self.part(after, 0));
                for (a, ((out_of_a, b), into_b)) in value.iter_mut().zip(others) {
                    let [out_of_a, b, into_b] = [out_of_a, b, into_b].map(|&part| f64::from(part));
                    *a = cubic(*a, out_of_a, b, into_b, t, span);
                }
                self.settle(value);
            }
        }
    }

    /// Numbers of a key: 0 the tangent into it, 1 its value, 2 the tangent out of it.
    fn part(&self, key: usize, which: usize) -> &[f32] {
        let start = match self.interpolation {
            Interpolation::CubicSpline => {
                key.checked_mul(3).and_then(|key| key.checked_add(which)?.checked_mul(self.width))
            }
            _ => key.checked_mul(self.width),
        };
        start.and_then(|start| self.values.get(start..)?.get(..self.width)).unwrap_or_default()
    }

    fn key(&self, key: usize, which: usize, value: &mut Vec<f64>) {
        value.extend(self.part(key, which).iter().map(|&part| f64::from(part)));
        self.settle(value);
    }

    /// Rotations are unit quaternions.
    fn settle(&self, value: &mut [f64]) {
        if let (true, Some(turn)) = (self.turns, value.first_chunk_mut::<4>()) {
            *turn = unit(*turn).unwrap_or([0.0, 0.0, 0.0, 1.0]);
        }
    }

    fn quaternion(&self, key: usize) -> Option<[f64; 4]> {
        unit(self.part(key, 1).first_chunk::<4>()?.map(f64::from))
    }

    /// Size in memory, in bytes.
    pub fn bytes(&self) -> u64 {
        (self.times.len().saturating_add(self.values.len()) as u64).saturating_mul(4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track(interpolation: Interpolation, values: &[f32]) -> Track {
        Track { times: vec![1.0, 2.0, 4.0], values: values.to_vec(), width: 1, interpolation, turns: false }
    }

    fn at(track: &Track, time: f32) -> f64 {
        let mut value = Vec::new();
        track.sample(time, &mut value);
        value[0]
    }

    #[test]
    fn keys_are_met_and_ends_are_held() {
        let cubic = [9.0, 10.0, 0.0, 0.0, 20.0, 0.0, 0.0, 0.0, 9.0];
        let tracks = [
            (track(Interpolation::Step, &[10.0, 20.0, 0.0]), 10.0, 20.0),
            (track(Interpolation::Linear, &[10.0, 20.0, 0.0]), 15.0, 10.0),
            (track(Interpolation::CubicSpline, &cubic), 15.0, 10.0),
        ];
        for (track, first_half, second_half) in tracks {
            let times = [-5.0, 0.0, 1.0, 2.0, 4.0, 99.0];
            assert_eq!(times.map(|time| at(&track, time)), [10.0, 10.0, 10.0, 20.0, 0.0, 0.0]);
            assert_eq!(at(&track, 1.5), first_half, "{:?}", track.interpolation);
            assert_eq!(at(&track, 3.0), second_half, "{:?}", track.interpolation);
        }
    }

    /// Tangents are in units per second: over a longer time they do more.
    #[test]
    fn tangents_are_scaled_by_the_time_between_keys() {
        let track = track(Interpolation::CubicSpline, &[0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0]);
        // t^3 - 2 t^2 + t + t^3 - t^2 is 0 in the middle; at a quarter it is 0.09375.
        assert_eq!((at(&track, 1.25), at(&track, 1.5)), (0.09375, 0.0));
        assert_eq!((at(&track, 2.5), at(&track, 3.0)), (2.0 * 0.09375, 0.0));
    }

    #[test]
    fn tracks_without_sense_give_nothing() {
        let mut value = vec![1.0];
        for times in [vec![], vec![0.0], vec![0.0, 0.0], vec![f32::NAN, 1.0]] {
            let track = Track { times, width: 3, ..Track::default() };
            track.sample(0.5, &mut value);
            assert!(value.is_empty());
        }
    }
}
