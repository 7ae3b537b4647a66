//! Errors that name the line, the column and the key.

use super::quantity::ALLOWED;
use super::words::nearest;
use super::{MAX_DEPTH, MAX_FILE};
use downpour_scene::error::{SceneError, escaped, quoted};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

const VALID: &str = "TOML 1.1 with the keys of a weather file";

/// A text with the places of its keys.
pub(super) struct Places<'a> {
    text: &'a str,
    root: DeTable<'a>,
}

/// A step on the way from the root to a value.
#[derive(Clone, Copy)]
enum Step<'a> {
    Key(&'a str),
    Index(usize),
}

/// What is done at each key and each value: with the way there, and where it stands in the text.
type Visit<'v> = dyn FnMut(&[Step<'_>], Range<usize>) -> Result<(), SceneError> + 'v;

impl<'a> Places<'a> {
    /// Finds the places of all keys; refuses what is too long, too deep or no TOML.
    pub(super) fn find(text: &'a str) -> Result<Self, SceneError> {
        if text.len() as u64 > MAX_FILE {
            let found = format!("a text of {} bytes", text.len());
            return Err(SceneError::limit("", found, format!("at most {MAX_FILE} bytes")));
        }
        let root = DeTable::parse(text).map_err(|error| {
            let place = error.span().map_or_else(String::new, |span| position(text, span.start));
            let what = error.message().lines().collect::<Vec<_>>().join(", ");
            SceneError::bad(place, escaped(&what), VALID)
        })?;
        let places = Self { text, root: root.into_inner() };
        // The parser stops at a depth of its own, so this walk ends.
        places.walk(&mut |way, span| {
            if way.len() > MAX_DEPTH as usize {
                let found = format!("nested {} deep", way.len());
                let place = places.place(&path(way), span.start);
                return Err(SceneError::bad(place, found, format!("at most {MAX_DEPTH} deep")));
            }
            Ok(())
        })?;
        Ok(places)
    }

    /// What serde found wrong.
    pub(super) fn refused(&self, error: &toml::de::Error) -> SceneError {
        let place = error.span().map_or_else(String::new, |span| {
            let mut best: Option<(usize, String)> = None;
            let walked = self.walk(&mut |way, spot| {
                let within = spot.contains(&span.start) || spot.start == span.start;
                if within && best.as_ref().is_none_or(|(length, _)| spot.len() <= *length) {
                    best = Some((spot.len(), path(way)));
                }
                Ok(())
            });
            debug_assert!(walked.is_ok(), "the walk refuses nothing");
            match best {
                Some((_, path)) => self.place(&path, span.start),
                None => position(self.text, span.start),
            }
        });
        let (found, allowed) = in_our_words(error.message());
        SceneError::bad(place, found, allowed)
    }

    /// What is wrong with a key that serde took, or with several together; `path` is the key's.
    pub(super) fn bad(&self, path: &str, found: impl Into<String>, allowed: impl Into<String>) -> SceneError {
        SceneError::bad(self.of(path), found, allowed)
    }

    /// What is too much.
    pub(super) fn limit(
        &self,
        path: &str,
        found: impl Into<String>,
        allowed: impl Into<String>,
    ) -> SceneError {
        SceneError::limit(self.of(path), found, allowed)
    }

    /// The place of a key, for a message.
    fn of(&self, wanted: &str) -> String {
        let mut start = None;
        // Serde took the file, so all its keys are known, and short.
        let walked = self.walk(&mut |way, span| {
            if start.is_none() && path(way) == wanted {
                start = Some(span.start);
            }
            Ok(())
        });
        debug_assert!(walked.is_ok(), "the walk refuses nothing");
        start.map_or_else(|| wanted.to_owned(), |start| self.place(wanted, start))
    }

    fn place(&self, path: &str, start: usize) -> String {
        format!("{}: {}", position(self.text, start), escaped(path))
    }

    /// Visits all keys and values.
    fn walk(&self, visit: &mut Visit<'_>) -> Result<(), SceneError> {
        table(&mut Vec::new(), &self.root, visit)
    }
}

fn table<'t>(
    way: &mut Vec<Step<'t>>,
    entries: &'t DeTable<'_>,
    visit: &mut Visit<'_>,
) -> Result<(), SceneError> {
    for (key, inner) in entries {
        way.push(Step::Key(key.get_ref()));
        visit(way, key.span())?;
        value(way, inner, visit)?;
        way.pop();
    }
    Ok(())
}

fn value<'t>(
    way: &mut Vec<Step<'t>>,
    at: &'t Spanned<DeValue<'_>>,
    visit: &mut Visit<'_>,
) -> Result<(), SceneError> {
    visit(way, at.span())?;
    match at.get_ref() {
        DeValue::Table(entries) => table(way, entries, visit),
        DeValue::Array(elements) => {
            for (i, element) in elements.iter().enumerate() {
                way.push(Step::Index(i));
                value(way, element, visit)?;
                way.pop();
            }
            Ok(())
        }
        _ => Ok(()),
    }
}

/// The name of a place, as `light[0].point.color`.
fn path(way: &[Step<'_>]) -> String {
    let mut path = String::new();
    for step in way {
        match step {
            Step::Key(key) => {
                if !path.is_empty() {
                    path.push('.');
                }
                path.push_str(key);
            }
            Step::Index(i) => path.push_str(&format!("[{i}]")),
        }
    }
    path
}

/// Line and column, both from 1.
fn position(text: &str, at: usize) -> String {
    let before = text.get(..at).unwrap_or(text);
    let line = before.matches('\n').count().saturating_add(1);
    let column = before.rsplit('\n').next().unwrap_or_default().chars().count().saturating_add(1);
    format!("line {line}, column {column}")
}

/// What was found and what is allowed, from the words of serde.
fn in_our_words(message: &str) -> (String, String) {
    if let Some((found, allowed)) = message.split_once(ALLOWED) {
        return (escaped(found), allowed.to_owned());
    }
    for (start, what) in [("unknown field `", "key"), ("unknown variant `", "word")] {
        if let Some((wrong, rest)) = message.strip_prefix(start).and_then(|rest| rest.split_once("`, ")) {
            let known: Vec<&str> = rest.split('`').skip(1).step_by(2).collect();
            let hint = nearest(wrong, &known).map_or_else(String::new, |word| format!(", perhaps {word}"));
            return (format!("unknown {what} {}{hint}", quoted(wrong)), known.join(", "));
        }
    }
    if let Some(name) = message.strip_prefix("missing field `").and_then(|rest| rest.strip_suffix('`')) {
        return (format!("no {name}"), format!("{name} is needed"));
    }
    if let Some((found, allowed)) = message.rsplit_once(", expected ") {
        return (escaped(found), escaped(allowed));
    }
    (escaped(message), VALID.to_owned())
}
