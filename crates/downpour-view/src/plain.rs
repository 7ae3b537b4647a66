//! Values of a weather file without its formatting.

use toml_edit::{Array, InlineTable, Item, TableLike, Value};

/// A value of a weather file.
#[derive(Clone, Debug, PartialEq)]
pub enum Plain {
    /// True or false.
    Bool(bool),
    /// A number, with or without a decimal point.
    Number(f64),
    /// Text.
    Text(String),
    /// An array: a vector, keyframes, or entries of a list.
    List(Vec<Plain>),
    /// A table, in the order of the file.
    Table(Vec<(String, Plain)>),
}

impl Plain {
    /// A value as a weather file writes it.
    ///
    /// # Errors
    /// What is wrong with the text.
    pub fn parse(text: &str) -> Result<Self, String> {
        let value: Value = text.trim().parse().map_err(|error: toml_edit::TomlError| {
            format!("{}; allowed: a value of TOML, such as 2.5, \"text\" or [1, 2, 3]", error.message())
        })?;
        Ok(Self::of_value(&value))
    }

    /// The number, if it is one.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        if let Self::Number(number) = self { Some(*number) } else { None }
    }

    /// The text, if it is one.
    #[must_use]
    pub fn text(&self) -> Option<&str> {
        if let Self::Text(text) = self { Some(text) } else { None }
    }

    /// Elements of an array; none for other values.
    #[must_use]
    pub fn list(&self) -> &[Plain] {
        if let Self::List(list) = self { list } else { &[] }
    }

    /// Entries of a table; none for other values.
    #[must_use]
    pub fn entries(&self) -> &[(String, Plain)] {
        if let Self::Table(entries) = self { entries } else { &[] }
    }

    /// Value of a key of a table.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<&Plain> {
        self.entries().iter().find(|(name, _)| name == key).map(|(_, value)| value)
    }

    /// Numbers of an array of numbers.
    #[must_use]
    pub fn numbers(&self) -> Option<Vec<f64>> {
        if let Self::List(list) = self { list.iter().map(Plain::number).collect() } else { None }
    }

    /// Three numbers.
    #[must_use]
    pub fn vector(&self) -> Option<[f64; 3]> {
        self.numbers()?.try_into().ok()
    }

    /// An array of numbers.
    #[must_use]
    pub fn of_numbers(numbers: &[f64]) -> Self {
        Self::List(numbers.iter().map(|&number| Self::Number(number)).collect())
    }

    /// Keyframes `[[time, value], ...]`, times in s, if the value is such an array.
    #[must_use]
    pub fn keys(&self) -> Option<Vec<(f64, Plain)>> {
        let Self::List(list) = self else { return None };
        let keys: Option<Vec<_>> = list
            .iter()
            .map(|key| match key {
                Self::List(pair) => match &pair[..] {
                    [Self::Number(time), value @ (Self::Number(_) | Self::List(_))] => {
                        Some((*time, value.clone()))
                    }
                    _ => None,
                },
                _ => None,
            })
            .collect();
        keys.filter(|keys| !keys.is_empty())
    }

    /// Keyframes as an array.
    #[must_use]
    pub fn of_keys(keys: &[(f64, Plain)]) -> Self {
        let pair = |(time, value): &(f64, Plain)| Self::List(vec![Self::Number(*time), value.clone()]);
        Self::List(keys.iter().map(pair).collect())
    }

    /// The value at a time in s: linear between keyframes, as the parser reads them.
    #[must_use]
    pub fn at(&self, time_s: f64) -> Self {
        let Some(keys) = self.keys() else { return self.clone() };
        let after = keys.iter().position(|&(time, _)| time > time_s).unwrap_or(keys.len());
        let (Some(before), Some(next)) = (after.checked_sub(1).and_then(|i| keys.get(i)), keys.get(after))
        else {
            let end = if after == 0 { keys.first() } else { keys.last() };
            return end.map_or_else(|| self.clone(), |(_, value)| value.clone());
        };
        let part = (time_s - before.0) / (next.0 - before.0);
        mixed(&before.1, &next.1, part)
    }

    /// The value of an item.
    pub(crate) fn of_item(item: &Item) -> Option<Self> {
        Some(match item {
            Item::None => return None,
            Item::Value(value) => Self::of_value(value),
            Item::Table(table) => Self::of_table(table),
            Item::ArrayOfTables(tables) => Self::List(tables.iter().map(|t| Self::of_table(t)).collect()),
        })
    }

    /// The entries of a table.
    pub(crate) fn of_table(table: &dyn TableLike) -> Self {
        let entries = table.iter().filter_map(|(key, item)| Some((key.to_owned(), Self::of_item(item)?)));
        Self::Table(entries.collect())
    }

    fn of_value(value: &Value) -> Self {
        match value {
            Value::String(text) => Self::Text(text.value().clone()),
            Value::Integer(number) => Self::Number(*number.value() as f64),
            Value::Float(number) => Self::Number(*number.value()),
            Value::Boolean(truth) => Self::Bool(*truth.value()),
            Value::Datetime(date) => Self::Text(date.value().to_string()),
            Value::Array(array) => Self::List(array.iter().map(Self::of_value).collect()),
            Value::InlineTable(table) => Self::of_table(table),
        }
    }

    /// The value as a weather file writes it: whole numbers without a decimal point.
    pub(crate) fn to_value(&self) -> Value {
        match self {
            Self::Bool(truth) => Value::from(*truth),
            Self::Number(number) => number_value(*number),
            Self::Text(text) => Value::from(text.as_str()),
            Self::List(list) => Value::Array(list.iter().map(Self::to_value).collect::<Array>()),
            Self::Table(entries) => {
                let mut table = InlineTable::new();
                for (key, value) in entries {
                    table.insert(key, value.to_value());
                }
                Value::InlineTable(table)
            }
        }
    }
}

/// Values between two of the same form.
fn mixed(a: &Plain, b: &Plain, part: f64) -> Plain {
    match (a, b) {
        (Plain::Number(a), Plain::Number(b)) => Plain::Number(a + (b - a) * part),
        (Plain::List(a), Plain::List(b)) if a.len() == b.len() => {
            Plain::List(a.iter().zip(b).map(|(a, b)| mixed(a, b, part)).collect())
        }
        _ => a.clone(),
    }
}

/// Largest whole number that is written without a decimal point.
const MAX_WHOLE: f64 = 9.0e15;

fn number_value(number: f64) -> Value {
    if number.fract() == 0.0 && number.abs() < MAX_WHOLE && !(number == 0.0 && number.is_sign_negative()) {
        Value::from(number as i64)
    } else if number == 0.0 {
        Value::from(0)
    } else {
        Value::from(number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_linear_between_and_constant_outside() {
        let keys = Plain::of_keys(&[(1.0, Plain::Number(10.0)), (3.0, Plain::Number(20.0))]);
        let at = |time| keys.at(time).number();
        assert_eq!([0.0, 1.0, 2.0, 3.0, 9.0].map(at), [10.0, 10.0, 15.0, 20.0, 20.0].map(Some));
        assert_eq!(Plain::Number(4.0).at(7.0), Plain::Number(4.0));
        let moving = Plain::of_keys(&[
            (0.0, Plain::of_numbers(&[0.0, 0.0, 0.0])),
            (2.0, Plain::of_numbers(&[2.0, 4.0, 6.0])),
        ]);
        assert_eq!(moving.at(0.5).vector(), Some([0.5, 1.0, 1.5]));
    }

    #[test]
    fn a_vector_is_not_keys() {
        assert_eq!(Plain::of_numbers(&[1.0, 2.0, 3.0]).keys(), None);
        assert_eq!(Plain::of_numbers(&[1.0, 2.0]).keys(), None);
        assert_eq!(Plain::List(Vec::new()).keys(), None);
    }

    #[test]
    fn numbers_are_written_as_files_write_them() {
        let written = |number| Plain::Number(number).to_value().to_string();
        assert_eq!(
            [10.0, -0.0, 0.25, 1.0e-4, 1.0e9].map(written),
            ["10", "0", "0.25", "0.0001", "1000000000"]
        );
    }
}
