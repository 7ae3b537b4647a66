//! Scenes of the tests.

use downpour_math::ops::f64 as ops;
use downpour_math::rng::{rng_draw, rng_unit};
use glam::{Quat, Vec3};

pub(crate) type Triangle = [[f32; 3]; 3];

/// Two triangles: corners counter-clockwise as seen from the front.
pub(crate) fn quad(corners: [Vec3; 4]) -> Vec<Triangle> {
    let [a, b, c, d] = corners.map(|p| p.to_array());
    vec![[a, b, c], [a, c, d]]
}

/// A horizontal rectangle that faces up.
pub(crate) fn floor(low: [f32; 2], high: [f32; 2], y: f32) -> Vec<Triangle> {
    let at = |x: f32, z: f32| Vec3::new(x, y, z);
    quad([at(low[0], low[1]), at(low[0], high[1]), at(high[0], high[1]), at(high[0], low[1])])
}

/// A closed box, faces outwards.
pub(crate) fn cuboid(low: Vec3, high: Vec3) -> Vec<Triangle> {
    let at = |bits: u32| {
        let pick = |k: usize| if bits >> k & 1 == 1 { high[k] } else { low[k] };
        Vec3::new(pick(0), pick(1), pick(2))
    };
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]]
        .into_iter()
        .flat_map(|face| quad(face.map(at)))
        .collect()
}

/// A closed sphere of `n` rings, faces outwards.
pub(crate) fn sphere(center: Vec3, radius: f32, n: u32) -> Vec<Triangle> {
    let at = |i: u32, j: u32| {
        let theta = std::f64::consts::PI * f64::from(i) / f64::from(n);
        let phi = std::f64::consts::PI * f64::from(j % (2 * n)) / f64::from(n);
        let (s, c) = (ops::sin(theta), ops::cos(theta));
        let unit = [s * ops::sin(phi), c, s * ops::cos(phi)].map(|x| x as f32);
        center + radius * Vec3::from(unit)
    };
    (0..n)
        .flat_map(|i| (0..2 * n).map(move |j| [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]))
        .flat_map(|q| quad(q.map(|(i, j)| at(i, j))))
        .collect()
}

pub(crate) fn turned(triangles: &[Triangle], turn: Quat) -> Vec<Triangle> {
    triangles.iter().map(|t| t.map(|p| (turn * Vec3::from(p)).to_array())).collect()
}

/// A floor with overlapping and floating boxes on it, none aligned with another.
pub(crate) fn boxes(n: u32) -> Vec<Triangle> {
    let mut all = floor([-12.0, -12.0], [12.0, 12.0], 0.0);
    for i in 0..n {
        let [a, b, c, d] = rng_draw([11, 12], i, 0, 0).map(rng_unit);
        let [e, f, g, h] = rng_draw([11, 12], i, 1, 0).map(rng_unit);
        let half = Vec3::new(0.2 + 0.8 * a, 0.2 + 0.8 * b, 0.2 + 0.8 * c);
        let turn = Quat::from_rotation_y(6.0 * d);
        let position = Vec3::new(16.0 * e - 8.0, 3.0 * f, 16.0 * g - 8.0);
        // Some are tilted, most are upright.
        let turn = if h < 0.3 { Quat::from_rotation_x(h) * turn } else { turn };
        let solid = turned(&cuboid(-half, half), turn);
        all.extend(solid.iter().map(|t| t.map(|p| (Vec3::from(p) + position).to_array())));
    }
    all
}

/// A drop's random numbers.
pub(crate) fn units(i: u32, dimension: u32) -> [f32; 4] {
    rng_draw([21, 22], i, 0, dimension).map(rng_unit)
}
