//! Values between keyframes: glTF 2.0, appendix C.
//!
//! With `t` from 0 to 1 between two keys and `d` the time between them in seconds:
//! - linear: `(1 - t) a + t b`;
//! - spherical (rotations): `(sin((1 - t) w) a + s sin(t w) b) / sin w` with `cos w = |a . b|` and `s` the sign of
//!   `a . b`, so that the rotation is the shorter one;
//! - cubic spline: `(2t^3 - 3t^2 + 1) a + d (t^3 - 2t^2 + t) m + (3t^2 - 2t^3) b + d (t^3 - t^2) n`, where `m` is
//!   the tangent out of `a` and `n` that into `b`, in units per second.

use downpour_math::ops::f64::{acos, sin};

/// `1 - cos w` below which a chord is as good as the arc: the error is of the order of `w^3`, below 1e-13.
const NEAR: f64 = 1e-9;

/// A straight line from `a` to `b`.
pub(super) fn linear(a: f64, b: f64, t: f64) -> f64 {
    (1.0 - t) * a + t * b
}

/// A cubic spline of Hermite's form. `d` is the time between the keys in seconds.
pub(super) fn cubic(a: f64, out_of_a: f64, b: f64, into_b: f64, t: f64, d: f64) -> f64 {
    let (t2, t3) = (t * t, t * t * t);
    (2.0 * t3 - 3.0 * t2 + 1.0) * a
        + d * (t3 - 2.0 * t2 + t) * out_of_a
        + (3.0 * t2 - 2.0 * t3) * b
        + d * (t3 - t2) * into_b
}

/// The arc from the unit quaternion `a` to `b`.
pub(super) fn spherical(a: [f64; 4], b: [f64; 4], t: f64) -> [f64; 4] {
    let dot: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
    let (cosine, sign) = (dot.abs().min(1.0), if dot < 0.0 { -1.0 } else { 1.0 });
    let (from, to) = if 1.0 - cosine < NEAR {
        (1.0 - t, t)
    } else {
        let angle = acos(cosine);
        (sin((1.0 - t) * angle) / sin(angle), sin(t * angle) / sin(angle))
    };
    let mut arc = a;
    for (part, b) in arc.iter_mut().zip(b) {
        *part = from * *part + sign * to * b;
    }
    unit(arc).unwrap_or(a)
}

/// The quaternion with length 1; `None` when it has no length.
pub(super) fn unit(q: [f64; 4]) -> Option<[f64; 4]> {
    let length = q.iter().map(|part| part * part).sum::<f64>().sqrt();
    (length > 0.0 && length.is_finite()).then(|| q.map(|part| part / length))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn about_z(angle: f64) -> [f64; 4] {
        [0.0, 0.0, sin(angle / 2.0), downpour_math::ops::f64::cos(angle / 2.0)]
    }

    fn near(a: [f64; 4], b: [f64; 4]) -> bool {
        a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-12)
    }

    /// Turns about one axis add up, however near or far the ends are.
    #[test]
    fn arcs_have_constant_speed() {
        for angle in [0.0, 1e-9, 1e-6, 5e-5, 1e-3, 0.7, 2.0, 3.0] {
            for t in [0.0, 0.1, 0.5, 0.75, 1.0] {
                let turned = spherical(about_z(0.3), about_z(0.3 + angle), t);
                assert!(near(turned, about_z(0.3 + t * angle)), "{angle} {t}: {turned:?}");
                // The same end with the other sign is the same rotation, and the shorter path is the same.
                let opposite = about_z(0.3 + angle).map(|part| -part);
                assert!(near(spherical(about_z(0.3), opposite, t), turned));
            }
        }
    }

    /// A spline is exact for cubic polynomials.
    #[test]
    fn splines_follow_cubics() {
        let value = |x: f64| 2.0 - x + 3.0 * x * x - 0.5 * x * x * x;
        let slope = |x: f64| -1.0 + 6.0 * x - 1.5 * x * x;
        let (from, to) = (0.5, 3.0);
        for i in 0..=10 {
            let t = f64::from(i) / 10.0;
            let x = linear(from, to, t);
            let spline = cubic(value(from), slope(from), value(to), slope(to), t, to - from);
            assert!((spline - value(x)).abs() < 1e-12, "{x}");
        }
    }
}
