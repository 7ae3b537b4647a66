//! Things of a weather file that have a place in the scene: wind, lamps, puddles, points that drip.

use glam::DVec3;

use crate::key_path::KeyPath;
use crate::plain::Plain;

/// An entry of a list of the file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ObjectId {
    /// The list: `wind`, `light`, `puddle`, `drip`.
    pub list: &'static str,
    /// Index of the entry.
    pub index: usize,
}

/// Lists whose entries are objects.
pub const LISTS: [&str; 4] = ["wind", "light", "puddle", "drip"];

/// A thing in the scene at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Its entry.
    pub id: ObjectId,
    /// Its kind: `vortex`, `spot`, `puddle`.
    pub kind: String,
    /// Path of its table.
    pub table: KeyPath,
    /// Its place; `None` for a uniform wind and for parallel light.
    pub position: Option<(KeyPath, DVec3)>,
    /// Unit direction: axis of a vortex, direction of a wind or of light.
    pub direction: Option<(DirectionKey, DVec3)>,
    /// Radius, m.
    pub radius: Option<(KeyPath, f64)>,
    /// Strength in the unit of its key.
    pub strength: Option<(KeyPath, f64)>,
    /// Height along the axis, m: of a tornado.
    pub height: Option<f64>,
    /// Half angle of a cone, radians.
    pub cone: Option<f64>,
    /// Width and length of a rectangle, m, with their key, and its turn in radians.
    pub rectangle: Option<(KeyPath, [f64; 2], f64)>,
}

/// Key of a direction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DirectionKey {
    /// Three numbers.
    Vector(KeyPath),
    /// Degrees about the vertical, from +X toward +Z.
    Degrees(KeyPath),
}

/// All objects of a file at a time in s.
#[must_use]
pub fn objects(file: &Plain, time_s: f64) -> Vec<Object> {
    let mut found = Vec::new();
    for list in LISTS {
        let entries = file.get(list).map(Plain::list).unwrap_or_default();
        for (index, entry) in entries.iter().enumerate() {
            found.extend(object(ObjectId { list, index }, entry, time_s));
        }
    }
    found
}

fn object(id: ObjectId, entry: &Plain, time_s: f64) -> Option<Object> {
    let path = KeyPath::of(id.list).entry(id.index);
    let (kind, table, path) = match id.list {
        "wind" | "light" => {
            let (kind, table) = entry.entries().first()?;
            (kind.clone(), table, path.key(kind))
        }
        list => (list.to_owned(), entry, path),
    };
    let number = |key: &str| table.get(key).and_then(|value| value.at(time_s).number());
    let vector = |key: &str| table.get(key).and_then(|value| value.at(time_s).vector()).map(DVec3::from);
    let unit = |key: &str| vector(key).and_then(DVec3::try_normalize);
    let mut object = Object {
        id,
        kind,
        position: None,
        direction: None,
        radius: None,
        strength: None,
        height: None,
        cone: None,
        rectangle: None,
        table: path.clone(),
    };
    let along = |key: &str, or: DVec3| {
        let at = DirectionKey::Vector(path.key(key));
        Some((at, unit(key).unwrap_or(or)))
    };
    match object.kind.as_str() {
        "uniform" => {
            object.direction = match number("towards_deg") {
                Some(degrees) => {
                    Some((DirectionKey::Degrees(path.key("towards_deg")), level(degrees).into()))
                }
                None => along("direction", DVec3::X),
            };
            object.strength = Some((path.key("speed_m_s"), number("speed_m_s")?));
        }
        "source" | "sink" | "vortex" => {
            object.position = Some((path.key("center_m"), vector("center_m").unwrap_or(DVec3::ZERO)));
            object.direction = along("axis", DVec3::Y);
            object.radius = Some((path.key("core_m"), number("core_m").unwrap_or(5.0)));
            let key = if table.get("strength_m3_s").is_some() { "strength_m3_s" } else { "strength_m2_s" };
            object.strength = Some((path.key(key), number(key)?));
        }
        "tornado" => {
            object.position = Some((path.key("base_m"), vector("base_m").unwrap_or(DVec3::ZERO)));
            object.direction = along("axis", DVec3::Y);
            object.radius = Some((path.key("core_m"), number("core_m").unwrap_or(5.0)));
            object.strength = Some((path.key("circulation_m2_s"), number("circulation_m2_s")?));
            object.height = number("height_m");
        }
        "point" | "spot" => {
            object.position = Some((path.key("position_m"), vector("position_m")?));
            object.strength = Some((path.key("intensity_cd"), number("intensity_cd").unwrap_or(100.0)));
            if object.kind == "spot" {
                object.direction = along("direction", DVec3::NEG_Y);
                object.cone = Some(number("outer_deg").unwrap_or(30.0).to_radians());
            }
        }
        "directional" => {
            object.direction = along("direction", DVec3::NEG_Y);
            object.strength =
                Some((path.key("illuminance_lux"), number("illuminance_lux").unwrap_or(1000.0)));
        }
        "puddle" => {
            object.position = Some((path.key("position_m"), vector("position_m")?));
            let size: [f64; 2] = table.get("size_m")?.numbers()?.try_into().ok()?;
            let degrees = number("turn_deg").unwrap_or(0.0);
            object.rectangle = Some((path.key("size_m"), size, degrees.to_radians()));
            object.direction = Some((DirectionKey::Degrees(path.key("turn_deg")), level(degrees).into()));
        }
        _ => object.position = Some((path.key("position_m"), vector("position_m")?)),
    }
    Some(object)
}

/// Direction of an angle in degrees about the vertical: 0 is +X, 90 is +Z.
fn level(degrees: f64) -> [f64; 3] {
    use downpour::math::ops::f64 as ops;
    let angle = degrees.to_radians();
    [ops::cos(angle), 0.0, ops::sin(angle)]
}

/// A value set at a time: a key of it where there are keyframes, else the value.
#[must_use]
pub fn set_at(old: Option<&Plain>, time_s: f64, value: Plain) -> Plain {
    match old.and_then(Plain::keys) {
        Some(keys) => with_key(&keys, time_s, value),
        None => value,
    }
}

/// Keyframes with one more, or with another value of one that is there.
#[must_use]
pub fn with_key(keys: &[(f64, Plain)], time_s: f64, value: Plain) -> Plain {
    let mut keys = keys.to_vec();
    match keys.iter_mut().find(|(time, _)| (*time - time_s).abs() < SAME_TIME_S) {
        Some((_, old)) => *old = value,
        None => {
            let at = keys.iter().position(|&(time, _)| time > time_s).unwrap_or(keys.len());
            keys.insert(at, (time_s, value));
        }
    }
    Plain::of_keys(&keys)
}

/// Keyframes nearer than this in time are the same, s.
pub const SAME_TIME_S: f64 = 1.0e-3;

/// A new entry of a kind at a place.
#[must_use]
pub fn new_entry(kind: &str, at: DVec3) -> Option<(&'static str, Plain)> {
    let place = Plain::of_numbers(&at.to_array().map(rounded));
    let number = Plain::Number;
    let table = |entries: Vec<(&str, Plain)>| {
        Plain::Table(entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
    };
    let one = |entries: Vec<(&str, Plain)>| table(vec![(kind, table(entries))]);
    Some(match kind {
        "uniform" => ("wind", one(vec![("speed_m_s", number(5.0)), ("towards_deg", number(0.0))])),
        "source" | "sink" | "vortex" => {
            ("wind", one(vec![("strength_m2_s", number(40.0)), ("center_m", place), ("core_m", number(2.0))]))
        }
        "tornado" => (
            "wind",
            one(vec![
                ("circulation_m2_s", number(60.0)),
                ("base_m", place),
                ("height_m", number(20.0)),
                ("core_m", number(2.0)),
            ]),
        ),
        "point" => ("light", one(vec![("position_m", place), ("intensity_cd", number(500.0))])),
        "spot" => (
            "light",
            one(vec![
                ("position_m", place),
                ("direction", Plain::of_numbers(&[0.0, -1.0, 0.0])),
                ("intensity_cd", number(1000.0)),
            ]),
        ),
        "directional" => (
            "light",
            one(vec![
                ("direction", Plain::of_numbers(&[0.3, -1.0, 0.2])),
                ("illuminance_lux", number(1000.0)),
            ]),
        ),
        "puddle" => {
            ("puddle", table(vec![("position_m", place), ("size_m", Plain::of_numbers(&[4.0, 4.0]))]))
        }
        "drip" => ("drip", table(vec![("position_m", place), ("per_second", number(2.0))])),
        _ => return None,
    })
}

/// Kinds of [`new_entry`].
pub const NEW_KINDS: [&str; 10] =
    ["uniform", "source", "sink", "vortex", "tornado", "point", "spot", "directional", "puddle", "drip"];

/// A length in m to the millimeter, as people write it.
#[must_use]
pub fn rounded(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

/// A number to four significant digits.
#[must_use]
pub fn significant(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let digits = 3 - downpour::math::ops::f64::log10(value.abs()).floor() as i32;
    format!("{value:.*}", digits.max(0) as usize).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Document;
    use std::path::Path;

    #[test]
    fn every_new_entry_is_one_that_the_parser_takes() {
        let mut document = Document::from_text("a.toml", "[rain]\nrate_mm_h = 3\n", Path::new("")).unwrap();
        for kind in NEW_KINDS {
            let (list, entry) = new_entry(kind, DVec3::new(1.0, 2.0, 3.00049)).unwrap();
            document.add_entry(&KeyPath::of(list), &entry).unwrap_or_else(|e| panic!("{kind}: {e}"));
        }
        let all = objects(document.plain(), 0.0);
        assert_eq!(all.iter().map(|o| o.kind.as_str()).collect::<Vec<_>>(), NEW_KINDS);
        assert_eq!(all[4].position.as_ref().unwrap().1, DVec3::new(1.0, 2.0, 3.0));
        assert!(new_entry("hail", DVec3::ZERO).is_none());
        // All keys that a handle writes are keys of the file.
        for object in &all {
            for (path, value) in object.strength.iter().chain(&object.radius) {
                document.set(path, &Plain::Number(*value), None).unwrap();
            }
        }
    }

    #[test]
    fn directions_are_those_of_the_file() {
        let text = "[[wind]]\nuniform = { speed_m_s = 3, towards_deg = [[0, 0], [10, 90]] }\n";
        let document = Document::from_text("a.toml", text, Path::new("")).unwrap();
        let towards = |time| objects(document.plain(), time)[0].direction.clone().unwrap().1;
        assert!((towards(0.0) - DVec3::X).length() < 1.0e-12);
        assert!((towards(10.0) - DVec3::Z).length() < 1.0e-12);
        // As the parser reads it.
        let downpour::wind::WindPrimitive::Uniform(wind) = document.weather().wind.parts()[0].at(5.0) else {
            panic!()
        };
        assert!((towards(5.0).as_vec3() - wind.direction).length() < 1.0e-3);
    }

    #[test]
    fn keys_are_set_in_order_of_time() {
        let number = Plain::Number;
        let keys = Plain::of_keys(&[(0.0, number(1.0)), (4.0, number(5.0))]);
        let more = set_at(Some(&keys), 2.0, number(9.0));
        assert_eq!(more, Plain::of_keys(&[(0.0, number(1.0)), (2.0, number(9.0)), (4.0, number(5.0))]));
        assert_eq!(set_at(Some(&more), 2.0004, number(8.0)).keys().unwrap()[1], (2.0, number(8.0)));
        assert_eq!(set_at(Some(&number(3.0)), 2.0, number(9.0)), number(9.0));
        assert_eq!(set_at(None, 2.0, number(9.0)), number(9.0));
    }

    #[test]
    fn numbers_are_rounded_to_what_people_write() {
        assert_eq!(
            [0.123_456, 12.345_6, 123_456.0, -0.000_123_46].map(significant),
            [0.1235, 12.35, 123_456.0, -0.000_123_5]
        );
        assert_eq!(rounded(1.000_49), 1.0);
    }
}
