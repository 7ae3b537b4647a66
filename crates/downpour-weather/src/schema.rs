//! The JSON schema of a weather file, for editors: made from the types that read it, with the texts of its table of keys.

use super::presets::PRESETS;
use super::puddle::FillKey;
use super::quantity::{Exactly, In, Range, ScaleXyz, Whole};
use super::streaks::{MAX_SAMPLES, Samples};
use super::wind::keys::{NumberKeys, VectorKeys};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Value, json};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The table of keys that the documentation shows.
const KEYS: &str = include_str!("KEYS.md");

/// The JSON schema (draft 2020-12) of a weather file.
///
/// It has the keys, their types, words and ranges. What a file says that depends on more than one value (keys that exclude each other,
/// keyframes in order of time, files that must be there) is checked only when it is read.
///
/// ```
/// let schema = downpour_weather::json_schema();
/// assert_eq!(schema["properties"]["camera"]["properties"]["near_m"]["minimum"], 1e-4);
/// ```
#[must_use]
pub fn json_schema() -> Value {
    let settings = SchemaSettings::draft2020_12().with(|settings| settings.inline_subschemas = true);
    let mut schema = settings.into_generator().into_root_schema_for::<super::file::Tables>().to_value();
    without_null(&mut schema);
    describe(&mut schema, "", &texts());
    if let Value::Object(schema) = &mut schema {
        schema.insert("title".to_owned(), json!("Downpour weather file"));
        schema.insert("description".to_owned(), json!("Rain, sky, lights, camera and models of a scene."));
        if let Some(Value::Object(preset)) =
            schema.get_mut("properties").and_then(|all| all.get_mut("preset"))
        {
            preset.insert("enum".to_owned(), json!(PRESETS.map(|(name, _)| name)));
        }
    }
    schema
}

/// Removes `null`, which TOML has not: a key that is not given has no value.
fn without_null(schema: &mut Value) {
    match schema {
        Value::Array(all) => all.iter_mut().for_each(without_null),
        Value::Object(map) => {
            map.remove("default");
            if let Some(Value::Array(types)) = map.get_mut("type") {
                types.retain(|name| name != "null");
                if let [only] = &types[..] {
                    let only = only.clone();
                    map.insert("type".to_owned(), only);
                }
            }
            if let Some(Value::Array(words)) = map.get_mut("enum") {
                words.retain(|word| !word.is_null());
            }
            for key in ["anyOf", "oneOf"] {
                let Some(Value::Array(forms)) = map.get_mut(key) else { continue };
                forms.retain(|form| form.get("type") != Some(&json!("null")));
                if let [Value::Object(only)] = &forms[..] {
                    let only = only.clone();
                    map.remove(key);
                    map.extend(only);
                }
            }
            map.values_mut().for_each(without_null);
        }
        _ => {}
    }
}

/// Texts of the keys by table, and of the tables by "".
fn texts() -> BTreeMap<String, BTreeMap<String, String>> {
    let mut texts: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
    let mut table = String::new();
    for row in KEYS.lines().filter(|line| line.starts_with("| `") || line.starts_with("| **")) {
        let cells: Vec<&str> = row.trim().trim_matches('|').split('|').map(str::trim).collect();
        let [names, range, default, meaning] =
            [0, 1, 2, 3].map(|k| cells.get(k).copied().unwrap_or_default());
        let about = [range, meaning].map(str::trim).into_iter().filter(|text| !text.is_empty());
        let mut about = about.collect::<Vec<_>>().join(": ");
        if !default.is_empty() {
            about.push_str(&format!(" (default: {default})"));
        }
        let quoted = names.split('`').skip(1).step_by(2);
        if names.starts_with("**") {
            table = names.trim_matches(|c| "*`[]".contains(c)).to_owned();
            let (of, name) = table.rsplit_once('.').unwrap_or(("", &table));
            texts.entry(of.to_owned()).or_default().insert(name.to_owned(), about);
        } else {
            for name in quoted {
                let of = texts.entry(table.clone()).or_default();
                of.entry(name.to_owned())
                    .and_modify(|text| *text = format!("{text}; {about}"))
                    .or_insert(about.clone());
            }
        }
    }
    texts
}

/// Adds the texts to the keys of a table, and to those in it.
fn describe(schema: &mut Value, table: &str, texts: &BTreeMap<String, BTreeMap<String, String>>) {
    match schema {
        Value::Array(all) => all.iter_mut().for_each(|form| describe(form, table, texts)),
        Value::Object(map) => {
            // Rust's own comments are for readers of the code.
            map.remove("description");
            map.remove("format");
            for (name, value) in map.iter_mut().filter(|(name, _)| *name != "properties") {
                if matches!(name.as_str(), "anyOf" | "oneOf" | "items") {
                    describe(value, table, texts);
                }
            }
            let Some(Value::Object(keys)) = map.get_mut("properties") else { return };
            for (key, value) in keys {
                let inner = if table.is_empty() { key.clone() } else { format!("{table}.{key}") };
                describe(value, if texts.contains_key(&inner) { &inner } else { table }, texts);
                let text = texts.get(table).and_then(|texts| texts.get(key));
                if let (Some(text), Value::Object(value)) = (text, value) {
                    value.insert("description".to_owned(), json!(text));
                }
            }
        }
        _ => {}
    }
}

/// A number in a range.
fn number<R: Range>() -> Schema {
    let range = json!({ "type": "number", "minimum": R::LOW, "maximum": R::HIGH });
    let form = if R::OR_ZERO { json!({ "anyOf": [{ "type": "number", "const": 0 }, range] }) } else { range };
    form.try_into().unwrap_or_default()
}

/// A value, or keyframes of it.
fn or_keys(value: &Schema) -> Schema {
    json_schema!({
        "anyOf": [
            value,
            {
                "type": "array",
                "minItems": 1,
                "maxItems": downpour_wind::timeline::WIND_KEYS,
                "items": {
                    "type": "array",
                    "prefixItems": [number::<super::quantity::KeyTimeS>(), value],
                    "minItems": 2,
                    "maxItems": 2,
                },
            },
        ],
    })
}

/// `count` values.
fn row(value: &Schema, count: usize) -> Schema {
    json_schema!({ "type": "array", "items": value, "minItems": count, "maxItems": count })
}

macro_rules! written_as {
    ($([$($generic:tt)*] $type:ty, $form:expr;)*) => {$(
        impl<$($generic)*> JsonSchema for $type {
            fn inline_schema() -> bool {
                true
            }

            fn schema_name() -> Cow<'static, str> {
                stringify!($type).into()
            }

            fn json_schema(generator: &mut SchemaGenerator) -> Schema {
                let form: fn(&mut SchemaGenerator) -> Schema = $form;
                form(generator)
            }
        }
    )*};
}

written_as! {
    [R: Range] In<R>, |_| number::<R>();
    [R: Range] NumberKeys<R>, |_| or_keys(&number::<R>());
    [R: Range] VectorKeys<R>, |_| or_keys(&row(&number::<R>(), 3));
    [T: JsonSchema, const N: usize] Exactly<T, N>, |generator| row(&T::json_schema(generator), N);
    [const LOW: u32, const HIGH: u32] Whole<LOW, HIGH>,
        |_| json_schema!({ "type": "integer", "minimum": LOW, "maximum": HIGH });
    [] ScaleXyz, |_| {
        let number = number::<super::quantity::Scale>();
        json_schema!({ "anyOf": [number, row(&number, 3)] })
    };
    [] FillKey, |generator| {
        let part = <NumberKeys<super::quantity::Fill>>::json_schema(generator);
        json_schema!({ "anyOf": [{ "const": "rain" }, part] })
    };
    [] Samples, |_| json_schema!({
        "anyOf": [{ "const": "table" }, { "type": "integer", "minimum": 1, "maximum": MAX_SAMPLES }],
    });
}
