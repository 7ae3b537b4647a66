//! Models of objects as lines in the scene.

use downpour::math::ops::f64 as ops;
use glam::DVec3;
use std::f64::consts::TAU;

use crate::objects::Object;

/// A line through the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Wire {
    /// Its points, m.
    pub points: Vec<DVec3>,
    /// True for an arrow at its end.
    pub is_arrow: bool,
}

/// Points of a circle.
const CIRCLE: usize = 40;

/// Half the length that a line without an end is drawn with, in core radii.
const LINE_RADII: f64 = 2.0;

/// The lines of an object. `anchor` is the place for what has none, such as a uniform wind.
#[must_use]
pub fn model(object: &Object, anchor: DVec3) -> Vec<Wire> {
    let at = object.position.as_ref().map_or(anchor, |(_, position)| *position);
    let along = object.direction.as_ref().map_or(DVec3::Y, |(_, direction)| *direction);
    let radius = object.radius.as_ref().map_or(1.0, |(_, radius)| *radius);
    let strength = object.strength.as_ref().map_or(0.0, |(_, strength)| *strength);
    match object.kind.as_str() {
        "uniform" => parallel(at, along, strength),
        "source" => radial(at, along, radius, true),
        "sink" => radial(at, along, radius, false),
        "vortex" => vortex(at, along, radius, strength),
        "tornado" => tornado(at, along, radius, object.height.unwrap_or(10.0 * radius), strength),
        "spot" => spot(at, along, object.cone.unwrap_or(0.5)),
        "directional" => parallel(at, along, 3.0),
        "point" => bulb(at),
        "puddle" => {
            object.rectangle.as_ref().map(|(_, size, turn)| rectangle(at, *size, *turn)).unwrap_or_default()
        }
        _ => vec![line(vec![at + DVec3::Y * 0.15, at - DVec3::Y * 0.35], true)],
    }
}

fn line(points: Vec<DVec3>, is_arrow: bool) -> Wire {
    Wire { points, is_arrow }
}

/// Two unit vectors across an axis, right-handed with it.
#[must_use]
pub fn across(axis: DVec3) -> (DVec3, DVec3) {
    let a = axis.any_orthonormal_vector();
    (a, axis.cross(a))
}

/// Points of a circle about an axis.
#[must_use]
pub fn circle(center: DVec3, axis: DVec3, radius: f64) -> Vec<DVec3> {
    let (a, b) = across(axis);
    let point = |k: usize| {
        let angle = TAU * k as f64 / CIRCLE as f64;
        center + (a * ops::cos(angle) + b * ops::sin(angle)) * radius
    };
    (0..=CIRCLE).map(point).collect()
}

/// Parallel arrows whose length goes with the speed.
fn parallel(at: DVec3, along: DVec3, speed: f64) -> Vec<Wire> {
    let (a, b) = across(along);
    let length = 0.4 + 0.25 * speed.min(40.0);
    let places = [(0.0, 0.0), (0.7, 0.0), (-0.7, 0.0), (0.0, 0.7), (0.0, -0.7)];
    places
        .iter()
        .map(|&(x, y)| {
            let begin = at + a * x + b * y;
            line(vec![begin - along * (0.5 * length), begin + along * (0.5 * length)], true)
        })
        .collect()
}

/// Arrows from an axis or toward it, at three heights.
fn radial(at: DVec3, axis: DVec3, core: f64, is_out: bool) -> Vec<Wire> {
    let (a, b) = across(axis);
    let mut wires = vec![line(vec![at - axis * (LINE_RADII * core), at + axis * (LINE_RADII * core)], false)];
    for height in [-1.0, 0.0, 1.0] {
        let center = at + axis * (height * core);
        for k in 0..8 {
            let angle = TAU * f64::from(k) / 8.0;
            let away = a * ops::cos(angle) + b * ops::sin(angle);
            let ends = [center + away * (0.35 * core), center + away * (1.2 * core)];
            wires.push(line(if is_out { ends.to_vec() } else { vec![ends[1], ends[0]] }, true));
        }
    }
    wires.push(line(circle(at, axis, core), false));
    wires
}

/// A helix round the axis, right-handed for a positive strength.
fn vortex(at: DVec3, axis: DVec3, core: f64, strength: f64) -> Vec<Wire> {
    let (a, b) = across(axis);
    let sense = if strength < 0.0 { -1.0 } else { 1.0 };
    let (turns, steps) = (3.0, 96);
    let point = |k: i32| {
        let part = f64::from(k) / f64::from(steps);
        let angle = sense * TAU * turns * part;
        let height = (2.0 * part - 1.0) * LINE_RADII * core;
        at + axis * height + (a * ops::cos(angle) + b * ops::sin(angle)) * core
    };
    vec![
        line((0..=steps).map(point).collect(), true),
        line(vec![at - axis * (1.1 * LINE_RADII * core), at + axis * (1.1 * LINE_RADII * core)], false),
    ]
}

/// A funnel: rings that widen upward, and a spiral on them.
fn tornado(base: DVec3, axis: DVec3, core: f64, height: f64, circulation: f64) -> Vec<Wire> {
    let (a, b) = across(axis);
    let radius = |part: f64| core * (0.35 + 0.9 * part * part + 0.35 * part);
    let sense = if circulation < 0.0 { -1.0 } else { 1.0 };
    let mut wires: Vec<Wire> = (0..=5)
        .map(|k| {
            let part = f64::from(k) / 5.0;
            line(circle(base + axis * (height * part), axis, radius(part)), false)
        })
        .collect();
    let steps = 160;
    let point = |k: i32| {
        let part = f64::from(k) / f64::from(steps);
        let angle = sense * TAU * 5.0 * part;
        base + axis * (height * part) + (a * ops::cos(angle) + b * ops::sin(angle)) * radius(part)
    };
    wires.push(line((0..=steps).map(point).collect(), true));
    wires
}

fn bulb(at: DVec3) -> Vec<Wire> {
    [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| line(circle(at, axis, 0.18), false)).to_vec()
}

fn spot(at: DVec3, along: DVec3, half_angle: f64) -> Vec<Wire> {
    let length = 2.0;
    let center = at + along * length;
    let radius = length * ops::tan(half_angle.min(1.4));
    let rim = circle(center, along, radius);
    let mut wires = bulb(at);
    wires.extend((0..4).filter_map(|k| Some(line(vec![at, *rim.get(k * CIRCLE / 4)?], false))));
    wires.push(line(rim, false));
    wires
}

/// Directions along which a level rectangle has its width and its length. `turn`: radians about the vertical, from +X toward +Z.
pub fn rectangle_axes(turn: f64) -> [DVec3; 2] {
    let (x, z) = (ops::cos(turn), ops::sin(turn));
    [DVec3::new(x, 0.0, z), DVec3::new(-z, 0.0, x)]
}

fn rectangle(at: DVec3, size: [f64; 2], turn: f64) -> Vec<Wire> {
    let [along, beside] = rectangle_axes(turn);
    let (along, beside) = (along * (0.5 * size[0]), beside * (0.5 * size[1]));
    let corners = [-along - beside, along - beside, along + beside, -along + beside, -along - beside];
    vec![line(corners.map(|corner| at + corner + DVec3::Y * 0.01).to_vec(), false)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::objects::ObjectId;

    fn object(kind: &str, strength: f64) -> Object {
        Object {
            id: ObjectId { list: "wind", index: 0 },
            kind: kind.to_owned(),
            table: crate::key_path::KeyPath::default(),
            position: None,
            direction: None,
            radius: None,
            strength: Some((crate::key_path::KeyPath::default(), strength)),
            height: None,
            cone: None,
            rectangle: None,
        }
    }

    /// The helix of a vortex goes round as its air does: along axis x offset, which is right-handed for a positive strength.
    #[test]
    fn a_vortex_turns_as_its_air_does() {
        for strength in [5.0, -5.0] {
            let wires = model(&object("vortex", strength), DVec3::ZERO);
            let [first, second] = [wires[0].points[40], wires[0].points[41]];
            let air = DVec3::Y.cross(first) * strength;
            assert!((second - first).dot(air) > 0.0);
        }
    }

    #[test]
    fn sources_point_outward_and_sinks_inward() {
        for (kind, sign) in [("source", 1.0), ("sink", -1.0)] {
            let wires = model(&object(kind, 5.0), DVec3::ZERO);
            for arrow in wires.iter().filter(|wire| wire.is_arrow) {
                let [begin, end] =
                    [arrow.points[0], arrow.points[1]].map(|p| DVec3::new(p.x, 0.0, p.z).length());
                assert!((end - begin) * sign > 0.0);
            }
        }
    }
}
