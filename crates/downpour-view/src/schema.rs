//! The keys of a weather file, from its JSON schema: what the panels are made of.

use downpour::weather::json_schema;
use serde_json::Value;

/// A key of a weather file.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Its name in the file.
    pub key: String,
    /// Its values.
    pub kind: Kind,
    /// Its text: unit, range, meaning.
    pub about: String,
    /// Its default as the text says it; empty where there is none.
    pub default: String,
    /// True if the value may be keyframes.
    pub is_keyed: bool,
}

/// Values of a key.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// A number in a range.
    Number {
        /// Least.
        min: f64,
        /// Largest.
        max: f64,
        /// True for whole numbers.
        is_whole: bool,
    },
    /// True or false.
    Bool,
    /// One of some words.
    Words(Vec<String>),
    /// Any text.
    Text,
    /// Some numbers.
    Vector {
        /// Their number.
        count: usize,
        /// Least of each.
        min: f64,
        /// Largest of each.
        max: f64,
    },
    /// A table of keys.
    Table(Vec<Field>),
    /// A list of tables.
    List(Vec<Field>),
    /// A list of tables with one key each, whose name says what the entry is.
    Variants(Vec<Field>),
    /// Anything else, which is edited as it is written.
    Raw,
}

impl Field {
    /// Unit of the value, by the end of the name.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        const UNITS: [(&str, &str); 18] = [
            ("_mm_h", "mm/h"),
            ("_m2_s", "m²/s"),
            ("_m3_s", "m³/s"),
            ("_m_s", "m/s"),
            ("_per_m", "/m"),
            ("per_second", "/s"),
            ("per_minute", "/min"),
            ("_um", "µm"),
            ("_mm", "mm"),
            ("_hpa", "hPa"),
            ("_deg", "°"),
            ("_lux", "lx"),
            ("_cd", "cd"),
            ("_ev", "EV"),
            ("_ms", "ms"),
            ("_c", "°C"),
            ("_m", "m"),
            ("_s", "s"),
        ];
        UNITS.iter().find(|(end, _)| self.key.ends_with(end)).map_or("", |(_, unit)| unit)
    }

    /// The name without its unit, in words.
    #[must_use]
    pub fn label(&self) -> String {
        const ENDS: [&str; 16] = [
            "_mm_h", "_m2_s", "_m3_s", "_m_s", "_per_m", "_um", "_mm", "_hpa", "_deg", "_lux", "_cd", "_ev",
            "_ms", "_c", "_m", "_s",
        ];
        let name = ENDS.iter().find_map(|end| self.key.strip_suffix(end)).unwrap_or(&self.key);
        name.replace('_', " ")
    }

    /// True for a color.
    #[must_use]
    pub fn is_color(&self) -> bool {
        matches!(self.kind, Kind::Vector { count: 3, .. }) && self.key.contains("color")
    }

    /// The default as a number, if it is one.
    #[must_use]
    pub fn default_number(&self) -> Option<f64> {
        let first = self.default.split([' ', ';', ',']).next()?.trim_matches('`');
        match first.split_once('/') {
            Some((a, b)) => Some(a.parse::<f64>().ok()? / b.parse::<f64>().ok()?),
            None => first.parse().ok(),
        }
    }

    /// The default as some numbers, if it is.
    #[must_use]
    pub fn default_vector(&self) -> Option<Vec<f64>> {
        let inner = self.default.strip_prefix('[')?.split(']').next()?;
        inner.split(',').map(|number| number.trim().parse().ok()).collect()
    }
}

/// All tables of a weather file.
#[must_use]
pub fn fields() -> Vec<Field> {
    table(&json_schema())
}

/// The field of a key.
#[must_use]
pub fn find<'a>(fields: &'a [Field], key: &str) -> Option<&'a Field> {
    fields.iter().find(|field| field.key == key)
}

fn table(schema: &Value) -> Vec<Field> {
    let Some(Value::Object(properties)) = schema.get("properties") else { return Vec::new() };
    properties.iter().map(|(key, value)| field(key, value)).collect()
}

fn field(key: &str, schema: &Value) -> Field {
    let text = schema.get("description").and_then(Value::as_str).unwrap_or_default();
    let text = text.trim_matches('|').trim();
    let (about, default) = match text.rsplit_once(" (default: ") {
        Some((about, default)) => (about, default.strip_suffix(')').unwrap_or(default)),
        None => (text, ""),
    };
    let mut is_keyed = false;
    let kind = kind(schema, &mut is_keyed);
    Field { key: key.to_owned(), kind, about: about.to_owned(), default: default.to_owned(), is_keyed }
}

fn kind(schema: &Value, is_keyed: &mut bool) -> Kind {
    let forms = ["anyOf", "oneOf"].iter().find_map(|name| schema.get(name)).and_then(Value::as_array);
    if let Some(forms) = forms {
        return one_of(forms, is_keyed);
    }
    if let Some(words) = schema.get("enum").and_then(Value::as_array) {
        return Kind::Words(words.iter().filter_map(Value::as_str).map(str::to_owned).collect());
    }
    match schema.get("const") {
        Some(Value::String(word)) => return Kind::Words(vec![word.clone()]),
        Some(Value::Number(number)) => {
            let number = number.as_f64().unwrap_or_default();
            return Kind::Number { min: number, max: number, is_whole: false };
        }
        _ => {}
    }
    let range = |schema: &Value| {
        let number = |name: &str, or: f64| schema.get(name).and_then(Value::as_f64).unwrap_or(or);
        (number("minimum", -1.0e9), number("maximum", 9.0e15))
    };
    match schema.get("type").and_then(Value::as_str) {
        Some("boolean") => Kind::Bool,
        Some("string") => Kind::Text,
        Some(name @ ("number" | "integer")) => {
            let (min, max) = range(schema);
            Kind::Number { min, max, is_whole: name == "integer" }
        }
        Some("object") => Kind::Table(table(schema)),
        Some("array") => {
            let Some(items) = schema.get("items") else { return Kind::Raw };
            let count = |name: &str| schema.get(name).and_then(Value::as_u64);
            let is_number = matches!(items.get("type").and_then(Value::as_str), Some("number" | "integer"));
            match count("minItems") {
                Some(least) if is_number && count("maxItems") == Some(least) => {
                    let (min, max) = range(items);
                    Kind::Vector { count: usize::try_from(least).unwrap_or(0), min, max }
                }
                _ => match kind(items, is_keyed) {
                    Kind::Table(fields) if items.get("oneOf").is_some() => Kind::Variants(fields),
                    Kind::Table(fields) => Kind::List(fields),
                    _ => Kind::Raw,
                },
            }
        }
        _ => Kind::Raw,
    }
}

/// A value of several forms: keyframes beside what they are of, words, a number that may be 0 too, entries of a list.
fn one_of(forms: &[Value], is_keyed: &mut bool) -> Kind {
    let is_keys = |form: &Value| form.get("items").is_some_and(|items| items.get("prefixItems").is_some());
    let mut left = Vec::new();
    for form in forms {
        if is_keys(form) {
            *is_keyed = true;
        } else {
            left.push(kind(form, is_keyed));
        }
    }
    let merged = left.iter().skip(1).try_fold(left.first().cloned().unwrap_or(Kind::Raw), |all, one| {
        Some(match (all, one) {
            (Kind::Words(mut words), Kind::Words(more)) => {
                words.extend(more.iter().cloned());
                Kind::Words(words)
            }
            (Kind::Number { min, max, is_whole }, Kind::Number { min: low, max: high, .. }) => {
                Kind::Number { min: min.min(*low), max: max.max(*high), is_whole }
            }
            (Kind::Table(mut fields), Kind::Table(more)) => {
                fields.extend(more.iter().cloned());
                Kind::Table(fields)
            }
            _ => return None,
        })
    });
    merged.unwrap_or(Kind::Raw)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of<'a>(fields: &'a [Field], path: &[&str]) -> &'a Field {
        let (first, rest) = path.split_first().unwrap();
        let field = find(fields, first).unwrap_or_else(|| panic!("no {first}"));
        if rest.is_empty() {
            return field;
        }
        match &field.kind {
            Kind::Table(inner) | Kind::List(inner) | Kind::Variants(inner) => of(inner, rest),
            other => panic!("{first}: {other:?}"),
        }
    }

    #[test]
    fn keys_have_their_kinds_units_and_defaults() {
        let fields = fields();
        let rate = of(&fields, &["rain", "rate_mm_h"]);
        assert_eq!(rate.kind, Kind::Number { min: 0.0, max: 500.0, is_whole: false });
        assert_eq!((rate.is_keyed, rate.unit(), rate.label().as_str()), (true, "mm/h", "rate"));
        assert_eq!(rate.default_number(), Some(10.0));
        assert_eq!(of(&fields, &["camera", "shutter_s"]).default_number(), Some(1.0 / 60.0));
        let vortex = of(&fields, &["wind", "vortex", "center_m"]);
        assert!(matches!(vortex.kind, Kind::Vector { count: 3, .. }) && vortex.is_keyed);
        assert_eq!(vortex.default_vector(), Some(vec![0.0; 3]));
        let Kind::Variants(winds) = &of(&fields, &["wind"]).kind else { panic!() };
        let names: Vec<&str> = winds.iter().map(|wind| wind.key.as_str()).collect();
        assert_eq!(names, ["uniform", "source", "sink", "vortex", "tornado"]);
        assert!(matches!(&of(&fields, &["preset"]).kind, Kind::Words(words) if words.len() == 5));
        assert!(matches!(of(&fields, &["puddle"]).kind, Kind::List(_)));
        assert!(matches!(of(&fields, &["glass", "wiper"]).kind, Kind::List(_)));
        assert!(of(&fields, &["light", "point", "color"]).is_color());
        assert_eq!(of(&fields, &["fog", "extinction_per_m"]).unit(), "/m");
        assert_eq!(of(&fields, &["camera", "observer"]).default, "`camera`");
    }

    /// Every key can be edited: by a widget of its kind, or as it is written.
    #[test]
    fn every_table_of_the_file_is_a_section() {
        let fields = fields();
        assert!(fields.len() >= 22, "{}", fields.len());
        for field in &fields {
            match &field.kind {
                Kind::Table(inner) | Kind::List(inner) | Kind::Variants(inner) => {
                    assert!(!inner.is_empty(), "{}", field.key);
                }
                Kind::Words(_) => assert_eq!(field.key, "preset"),
                other => panic!("{}: {other:?}", field.key),
            }
        }
    }
}
