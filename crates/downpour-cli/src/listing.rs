//! A list of quantities, as text for people or as JSON for scripts.

use std::fmt::Write as _;

use serde_json::{Map, Number, Value};

use crate::stream::one_line;

/// Significant digits of numbers in JSON: more than the physics justifies, fewer than rounding affects.
const JSON_DIGITS: usize = 10;

/// A value of a list.
#[derive(Clone, Debug)]
pub(crate) enum Datum {
    /// A number as it was given.
    Given(f64),
    /// A computed number, and the number of digits in text.
    Computed(f64, usize),
    /// A number that has no bound: `null` in JSON.
    Unbounded(&'static str),
    /// A word.
    Word(String),
    /// A count.
    Count(u64),
    /// Three computed numbers, as a position or a color.
    Triple([f64; 3], usize),
    /// Names.
    Words(Vec<String>),
}

impl Datum {
    /// A computed number, or a word if it is infinite.
    pub(crate) fn bounded(value: f64, digits: usize, otherwise: &'static str) -> Self {
        if value.is_finite() { Self::Computed(value, digits) } else { Self::Unbounded(otherwise) }
    }

    pub(crate) fn words(words: &[&str]) -> Self {
        Self::Words(words.iter().map(|&word| word.to_owned()).collect())
    }

    fn text(&self) -> String {
        match self {
            Self::Given(value) => rounded(*value, JSON_DIGITS).to_string(),
            Self::Computed(value, digits) => significant(*value, *digits),
            Self::Unbounded(word) => (*word).to_owned(),
            Self::Word(word) => word.clone(),
            Self::Count(count) => count.to_string(),
            Self::Triple(values, digits) => values.map(|value| significant(value, *digits)).join(" "),
            Self::Words(words) if words.is_empty() => "none".to_owned(),
            Self::Words(words) => words.join(", "),
        }
    }

    fn json(&self) -> Value {
        match self {
            Self::Given(value) | Self::Computed(value, _) => number(*value),
            Self::Unbounded(_) => Value::Null,
            Self::Word(word) => Value::String(word.clone()),
            Self::Count(count) => Value::from(*count),
            Self::Triple(values, _) => values.map(number).to_vec().into(),
            Self::Words(words) => words.clone().into(),
        }
    }
}

/// One line of a list.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    /// Key in JSON; it carries the unit.
    pub(crate) key: &'static str,
    /// Label in text.
    pub(crate) label: &'static str,
    pub(crate) datum: Datum,
    /// Unit in text; empty for a number without.
    pub(crate) unit: &'static str,
}

impl Entry {
    pub(crate) fn new(key: &'static str, label: &'static str, datum: Datum, unit: &'static str) -> Self {
        Self { key, label, datum, unit }
    }
}

/// The list as one object.
pub(crate) fn json(entries: &[Entry]) -> String {
    let object: Map<String, Value> =
        entries.iter().map(|entry| (entry.key.to_owned(), entry.datum.json())).collect();
    format!("{:#}\n", Value::Object(object))
}

/// The list in columns.
pub(crate) fn text(entries: &[Entry]) -> String {
    // Names come from files.
    let values: Vec<String> = entries.iter().map(|entry| one_line(&entry.datum.text())).collect();
    let label_width = entries.iter().map(|entry| entry.label.chars().count()).max().unwrap_or(0);
    let value_width = values.iter().map(|value| value.chars().count()).max().unwrap_or(0);
    let mut out = String::new();
    for (entry, value) in entries.iter().zip(&values) {
        let unit = if matches!(entry.datum, Datum::Unbounded(_)) { "" } else { entry.unit };
        let line = format!("{:label_width$}  {value:>value_width$} {unit}", entry.label);
        let _ = writeln!(out, "{}", line.trim_end());
    }
    out
}

/// A number for JSON, without rounding noise and without a sign of 0; `null` if it is not finite.
pub(crate) fn number(value: f64) -> Value {
    Number::from_f64(rounded(value, JSON_DIGITS)).map_or(Value::Null, Value::Number)
}

/// A number with `digits` significant digits.
fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse::<f64>().unwrap_or(value) + 0.0
}

/// A number with `digits` significant digits, in the shortest notation.
fn significant(value: f64, digits: usize) -> String {
    let value = rounded(value, digits);
    if value == 0.0 {
        return "0".to_owned();
    }
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let exponent: i32 = scientific.split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    if !(-4..=6).contains(&exponent) {
        return scientific;
    }
    let digits = i32::try_from(digits).unwrap_or(i32::MAX);
    let decimals = digits.saturating_sub(1).saturating_sub(exponent).max(0);
    format!("{value:.*}", usize::try_from(decimals).unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_see_the_digits_that_count() {
        for (value, digits, text) in [
            (6.506_123, 4, "6.506"),
            (0.092_56, 3, "0.0926"),
            (121.46, 4, "121.5"),
            (9.999_96, 4, "10.00"),
            (12_345.6, 3, "12300"),
            (5.236e-10, 3, "5.24e-10"),
            (-0.005_04, 2, "-0.0050"),
            (-0.0, 4, "0"),
        ] {
            assert_eq!(significant(value, digits), text, "{value}");
        }
    }

    #[test]
    fn json_has_no_noise_no_infinity_and_no_negative_zero() {
        assert_eq!(number(10.000_000_000_000_002).to_string(), "10.0");
        assert_eq!(number(-0.0).to_string(), "0.0");
        assert_eq!(number(f64::NAN), Value::Null);
        let entries = [
            Entry::new("rate_mm_h", "rain rate", Datum::Given(0.0), "mm/h"),
            Entry::new("visibility_km", "visibility", Datum::bounded(f64::INFINITY, 3, "unlimited"), "km"),
        ];
        assert_eq!(json(&entries), "{\n  \"rate_mm_h\": 0.0,\n  \"visibility_km\": null\n}\n");
        assert_eq!(text(&entries), "rain rate           0 mm/h\nvisibility  unlimited\n");
    }

    #[test]
    fn counts_places_and_names_are_what_they_are() {
        let entries = [
            Entry::new("seed", "seed", Datum::Count(u64::MAX), ""),
            Entry::new("position_m", "position", Datum::Triple([0.0, -1.5, 0.125], 2), "m"),
            Entry::new("names", "names", Datum::words(&["a", "b\u{1b}"]), ""),
            Entry::new("others", "others", Datum::words(&[]), ""),
        ];
        let value: Value = serde_json::from_str(&json(&entries)).unwrap();
        assert_eq!(value["seed"].as_u64(), Some(u64::MAX));
        assert_eq!(value["position_m"], serde_json::json!([0.0, -1.5, 0.125]));
        assert_eq!(
            (value["names"].to_string(), value["others"].to_string()),
            (r#"["a","b\u001b"]"#.into(), "[]".into())
        );
        assert!(
            text(&entries).contains("0 -1.5 0.12 m\n") && text(&entries).contains("a, b\\u{1b}\n"),
            "{}",
            text(&entries)
        );
    }
}
