//! Limits of the list of drops for a picture. All other drops are unresolved: a picture includes them by their
//! extinction and in-scattering.

use glam::DVec3;

use crate::view::View;

/// Region of space outside which no drop is listed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Region {
    /// All space.
    #[default]
    Everywhere,
    /// A box along the world's axes.
    Box {
        /// Center, m.
        center: DVec3,
        /// Edges, m.
        size: DVec3,
    },
    /// A sphere.
    Sphere {
        /// Center, m.
        center: DVec3,
        /// Radius, m.
        radius: f64,
    },
    /// An upright cylinder.
    Cylinder {
        /// Center of the base, m.
        base: DVec3,
        /// Radius, m.
        radius: f64,
        /// Height, m.
        height: f64,
    },
}

/// Limits of a list of drops for a picture: a drop of the rain is listed if it is in the picture, between
/// [`Resolved::near`] and [`Resolved::range`] of its diameter from the eye, and in [`Resolved::region`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolved {
    /// Minimum distance from the eye, m.
    pub near: f64,
    /// Maximum distance from the eye, m.
    pub far: f64,
    /// Width of a pixel at distance 1.
    pub pixel_angle: f64,
    /// Minimum diameter on the picture, pixels.
    pub least_pixels: f64,
    /// Minimum diameter, m.
    pub min_diameter: f64,
    /// Region in which drops are listed.
    pub region: Region,
}

impl Resolved {
    /// Limits of the list of a view, with another minimum diameter on the picture.
    pub(crate) fn of(view: &View, least_pixels: f64) -> Self {
        Self {
            near: view.near,
            far: view.far,
            pixel_angle: view.pixel_angle,
            least_pixels,
            min_diameter: 0.0,
            region: Region::Everywhere,
        }
    }

    /// Maximum distance from the eye, m, at which a drop of a diameter in m is listed; 0 if none of that size is.
    #[must_use]
    pub fn range(&self, diameter: f64) -> f64 {
        if diameter < self.min_diameter {
            return 0.0;
        }
        let range = (diameter / (self.pixel_angle * self.least_pixels).max(1.0e-12)).min(self.far);
        if range < self.near { 0.0 } else { range }
    }
}

impl Region {
    /// Part of a ray within the region: first and last distance, m, for a unit direction; `None` if the ray misses it.
    /// All these regions are convex.
    #[must_use]
    pub fn along(&self, origin: DVec3, direction: DVec3) -> Option<[f64; 2]> {
        let part = match *self {
            Self::Everywhere => [0.0, f64::INFINITY],
            Self::Box { center, size } => {
                let (low, high) = (center - 0.5 * size - origin, center + 0.5 * size - origin);
                [0, 1, 2].into_iter().fold([0.0, f64::INFINITY], |part, axis| {
                    meet(part, slab(low[axis], high[axis], direction[axis]))
                })
            }
            Self::Sphere { center, radius } => {
                let offset = origin - center;
                meet(
                    [0.0, f64::INFINITY],
                    quadratic(1.0, offset.dot(direction), offset.length_squared() - radius * radius),
                )
            }
            Self::Cylinder { base, radius, height } => {
                let offset = origin - base;
                let across = direction.x * direction.x + direction.z * direction.z;
                let along = offset.x * direction.x + offset.z * direction.z;
                let outside = offset.x * offset.x + offset.z * offset.z - radius * radius;
                let side = if across > 1.0e-12 {
                    quadratic(across, along, outside)
                } else if outside <= 0.0 {
                    [f64::NEG_INFINITY, f64::INFINITY]
                } else {
                    EMPTY
                };
                meet(meet([0.0, f64::INFINITY], side), slab(-offset.y, height - offset.y, direction.y))
            }
        };
        (part[0] < part[1]).then_some(part)
    }
}

/// An empty part of a ray.
const EMPTY: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

fn meet(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].max(b[0]), a[1].min(b[1])]
}

/// Distances at which a coordinate with slope `rate` is between two values.
fn slab(low: f64, high: f64, rate: f64) -> [f64; 2] {
    if rate.abs() < 1.0e-12 {
        return if low <= 0.0 && high >= 0.0 { [f64::NEG_INFINITY, f64::INFINITY] } else { EMPTY };
    }
    let (a, b) = (low / rate, high / rate);
    [a.min(b), a.max(b)]
}

/// Distances between the roots of `a t^2 + 2 b t + c`.
fn quadratic(a: f64, b: f64, c: f64) -> [f64; 2] {
    let root = b * b - a * c;
    if root <= 0.0 {
        return EMPTY;
    }
    let root = root.sqrt();
    [(-b - root) / a, (-b + root) / a]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_is_within_a_region_as_far_as_geometry_says() {
        let from = DVec3::new(0.0, 1.0, 0.0);
        let size = DVec3::new(10.0, 4.0, 20.0);
        let of_box = Region::Box { center: DVec3::new(1.0, 1.0, 0.0), size };
        assert_eq!(of_box.along(from, DVec3::X), Some([0.0, 6.0]));
        assert_eq!(of_box.along(from, DVec3::NEG_X), Some([0.0, 4.0]));
        assert_eq!(of_box.along(from + DVec3::Y * 5.0, DVec3::X), None);
        assert_eq!(of_box.along(from - DVec3::X * 14.0, DVec3::X), Some([10.0, 20.0]));
        let sphere = Region::Sphere { center: DVec3::new(0.0, 1.0, -5.0), radius: 5.0 };
        assert_eq!(sphere.along(from, DVec3::NEG_Z), Some([0.0, 10.0]));
        assert_eq!(sphere.along(from, DVec3::Z), None);
        let cylinder = Region::Cylinder { base: DVec3::new(3.0, 0.0, 0.0), radius: 1.0, height: 2.0 };
        assert_eq!(cylinder.along(from, DVec3::X), Some([2.0, 4.0]));
        assert_eq!(cylinder.along(DVec3::new(3.0, 5.0, 0.0), DVec3::NEG_Y), Some([3.0, 5.0]));
        assert_eq!(cylinder.along(from, DVec3::Y), None);
        assert_eq!(Region::Everywhere.along(from, DVec3::X), Some([0.0, f64::INFINITY]));
    }

    #[test]
    fn a_size_that_is_never_large_enough_has_no_range() {
        let resolved = Resolved::of(&View::default(), 0.4);
        assert_eq!(resolved.range(1.0e-9), 0.0);
        assert_eq!(resolved.range(1.0), 50.0);
        let largest = Resolved { min_diameter: 2.0e-3, ..resolved };
        assert_eq!(largest.range(1.9e-3), 0.0);
        assert!((largest.range(2.1e-3) - 2.1e-3 / (0.4 * resolved.pixel_angle)).abs() < 1.0e-9);
    }
}
