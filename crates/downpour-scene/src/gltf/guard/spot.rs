//! A JSON value together with its path, for messages.

use crate::error::{SceneError, escaped, quoted};
use serde_json::{Map, Value};
use std::fmt;

/// A path in the document. Formatted only when shown, as `accessors[3].sparse.count`.
#[derive(Clone, Copy)]
pub(crate) struct Trail<'a> {
    parent: Option<&'a Trail<'a>>,
    step: Step<'a>,
}

#[derive(Clone, Copy)]
enum Step<'a> {
    Document,
    Key(&'a str),
    Index(usize),
}

impl<'a> Trail<'a> {
    /// The document itself.
    pub(crate) const DOCUMENT: Self = Self { parent: None, step: Step::Document };

    /// A member of an object.
    pub(crate) fn key(&'a self, key: &'a str) -> Self {
        Self { parent: Some(self), step: Step::Key(key) }
    }

    /// An element of an array.
    pub(crate) fn index(&'a self, index: usize) -> Self {
        Self { parent: Some(self), step: Step::Index(index) }
    }
}

impl fmt::Display for Trail<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut first = true;
        if let Some(parent) = self.parent {
            parent.fmt(f)?;
            first = parent.parent.is_none();
        }
        match self.step {
            Step::Document => Ok(()),
            Step::Index(index) => write!(f, "[{index}]"),
            Step::Key(key)
                if key.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_') && key.len() < 64 =>
            {
                write!(f, "{}{key}", if first { "" } else { "." })
            }
            Step::Key(key) => write!(f, "[{}]", quoted(key)),
        }
    }
}

/// A value and its path.
#[derive(Clone, Copy)]
pub(in crate::gltf) struct Spot<'a> {
    pub(in crate::gltf) trail: Trail<'a>,
    pub(in crate::gltf) value: &'a Value,
}

impl<'a> Spot<'a> {
    pub(in crate::gltf) fn document(value: &'a Value) -> Self {
        Self { trail: Trail::DOCUMENT, value }
    }

    /// Error at this path.
    pub(in crate::gltf) fn wrong(&self, found: impl Into<String>, allowed: impl Into<String>) -> SceneError {
        SceneError::bad(self.trail, found, allowed)
    }

    /// Error that quotes the value at this path.
    pub(in crate::gltf) fn not(&self, allowed: impl Into<String>) -> SceneError {
        self.wrong(shown(self.value), allowed)
    }

    pub(in crate::gltf) fn object(&self) -> Result<&'a Map<String, Value>, SceneError> {
        self.value.as_object().ok_or_else(|| self.not("an object"))
    }

    /// A member that may be missing.
    pub(in crate::gltf) fn get<'s>(&'s self, key: &'s str) -> Result<Option<Spot<'s>>, SceneError> {
        Ok(self.object()?.get(key).map(|value| Spot { trail: self.trail.key(key), value }))
    }

    /// A member that must be there.
    pub(in crate::gltf) fn need<'s>(&'s self, key: &'s str) -> Result<Spot<'s>, SceneError> {
        self.get(key)?.ok_or_else(|| self.wrong(format!("no {key}"), format!("an object with {key}")))
    }

    /// The elements of an array.
    pub(in crate::gltf) fn items<'s>(&'s self) -> Result<impl Iterator<Item = Spot<'s>>, SceneError> {
        let array = self.value.as_array().ok_or_else(|| self.not("an array"))?;
        Ok(array.iter().enumerate().map(|(index, value)| Spot { trail: self.trail.index(index), value }))
    }

    /// An element of an array.
    pub(in crate::gltf) fn item<'s>(&'s self, index: usize) -> Option<Spot<'s>> {
        self.value.get(index).map(|value| Spot { trail: self.trail.index(index), value })
    }

    /// The members of an object.
    pub(in crate::gltf) fn members<'s>(
        &'s self,
    ) -> Result<impl Iterator<Item = (&'s str, Spot<'s>)>, SceneError> {
        let members = self.object()?.iter();
        Ok(members.map(|(key, value)| (key.as_str(), Spot { trail: self.trail.key(key), value })))
    }

    /// Each value that a pattern leads to: names, `[]` for each element, `*` for each member.
    pub(in crate::gltf) fn each(
        &self,
        pattern: &[&str],
        visit: &mut dyn FnMut(&Spot<'_>) -> Result<(), SceneError>,
    ) -> Result<(), SceneError> {
        match pattern.split_first() {
            None => visit(self),
            Some((&"[]", rest)) => self.items()?.try_for_each(|item| item.each(rest, visit)),
            Some((&"*", rest)) => self.members()?.try_for_each(|(_, member)| member.each(rest, visit)),
            Some((key, rest)) => self.get(key)?.map_or(Ok(()), |member| member.each(rest, visit)),
        }
    }

    /// An integer from 0 on.
    pub(in crate::gltf) fn whole(&self) -> Result<u64, SceneError> {
        self.value.as_u64().ok_or_else(|| self.not("a whole number from 0 on"))
    }

    /// An integer; 0 if missing.
    pub(in crate::gltf) fn whole_or_zero(&self, key: &str) -> Result<u64, SceneError> {
        self.get(key)?.map_or(Ok(0), |member| member.whole())
    }

    /// An integer from 1 on.
    pub(in crate::gltf) fn positive(&self) -> Result<u64, SceneError> {
        self.value.as_u64().filter(|&n| n > 0).ok_or_else(|| self.not("a whole number from 1 on"))
    }

    /// A number; an earlier check has verified the range of `f32`.
    pub(in crate::gltf) fn number(&self) -> Result<f64, SceneError> {
        self.value.as_f64().ok_or_else(|| self.not("a number"))
    }

    pub(in crate::gltf) fn text(&self) -> Result<&'a str, SceneError> {
        self.value.as_str().ok_or_else(|| self.not("text"))
    }

    /// An index into a list of that many objects.
    pub(in crate::gltf) fn index_into(&self, list: &str, count: usize) -> Result<usize, SceneError> {
        let index = self.value.as_u64().and_then(|index| usize::try_from(index).ok());
        index.filter(|&index| index < count).ok_or_else(|| {
            let allowed = match count {
                0 => format!("no index, as there are no {list}"),
                1 => format!("0, the only one of {list}"),
                _ => format!("0 to {}, as there are {count} {list}", count.saturating_sub(1)),
            };
            self.not(allowed)
        })
    }
}

/// A value for a message.
pub(in crate::gltf) fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => quoted(text),
        Value::Array(elements) => format!("an array of {}", elements.len()),
        Value::Object(_) => "an object".into(),
        _ => escaped(&value.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_read_like_code() {
        let value = serde_json::json!({"a": [{"b": {"c d\n": 1}}]});
        let document = Spot::document(&value);
        let mut seen = Vec::new();
        document
            .each(&["a", "[]", "b", "*"], &mut |spot| {
                seen.push(spot.trail.to_string());
                Ok(())
            })
            .unwrap();
        assert_eq!(seen, [r#"a[0].b["c d\n"]"#]);
        assert_eq!(Trail::DOCUMENT.to_string(), "");
    }
}
