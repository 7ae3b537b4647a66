//! Errors that name the line, the column and the key.

use super::presets;
use super::quantity::ALLOWED;
use super::words::nearest;
use super::{MAX_DEPTH, MAX_FILE};
use downpour_scene::error::{SceneError, escaped, quoted};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

const VALID: &str = "TOML 1.1 with the keys of a weather file";

/// A text with the positions of its keys.
pub(super) struct Positions<'a> {
    text: &'a str,
    root: DeTable<'a>,
}

/// A step on the path from the root to a value.
#[derive(Clone, Copy)]
enum Step<'a> {
    Key(&'a str),
    Index(usize),
}

/// Callback for each key and each value: with its path and its range in the text.
type Visit<'v> = dyn FnMut(&[Step<'_>], Range<usize>) -> Result<(), SceneError> + 'v;

impl<'a> Positions<'a> {
    /// Finds the positions of all keys; rejects text that is too long, too deep or not TOML.
    pub(super) fn find(text: &'a str) -> Result<Self, SceneError> {
        if text.len() as u64 > MAX_FILE {
            let found = format!("a text of {} bytes", text.len());
            return Err(SceneError::limit("", found, format!("at most {MAX_FILE} bytes")));
        }
        let root = DeTable::parse(text).map_err(|error| {
            let position = error.span().map_or_else(String::new, |span| position(text, span.start));
            let what = error.message().lines().collect::<Vec<_>>().join(", ");
            SceneError::bad(position, escaped(&what), VALID)
        })?;
        let positions = Self { text, root: root.into_inner() };
        // The parser has a depth limit, so this walk ends.
        positions.walk(&mut |path, span| {
            if path.len() > MAX_DEPTH as usize {
                let found = format!("nested {} deep", path.len());
                let position = positions.locate(&path_text(path), span.start);
                return Err(SceneError::bad(position, found, format!("at most {MAX_DEPTH} deep")));
            }
            Ok(())
        })?;
        Ok(positions)
    }

    /// The file's tables with those of a preset where it gives none.
    pub(super) fn with_preset(&self, preset: &'static str) -> Result<DeTable<'a>, SceneError> {
        let other = DeTable::parse(preset).map_err(|error| self.bad("preset", error.message(), VALID))?;
        let mut tables = self.root.clone();
        presets::merge(&mut tables, other.into_inner());
        Ok(tables)
    }

    /// Error of serde, with its position.
    pub(super) fn refused(&self, error: &toml::de::Error) -> SceneError {
        let position = error.span().map_or_else(String::new, |span| {
            let mut best: Option<(usize, String)> = None;
            let walked = self.walk(&mut |path, spot| {
                let within = spot.contains(&span.start) || spot.start == span.start;
                if within && best.as_ref().is_none_or(|(length, _)| spot.len() <= *length) {
                    best = Some((spot.len(), path_text(path)));
                }
                Ok(())
            });
            debug_assert!(walked.is_ok(), "the walk refuses nothing");
            match best {
                Some((_, path)) => self.locate(&path, span.start),
                None => position(self.text, span.start),
            }
        });
        let (found, allowed) = found_and_allowed(error.message());
        SceneError::bad(position, found, allowed)
    }

    /// Error of a key that serde accepted, or of several together; `path` is the path of the key.
    pub(super) fn bad(&self, path: &str, found: impl Into<String>, allowed: impl Into<String>) -> SceneError {
        SceneError::bad(self.of(path), found, allowed)
    }

    /// Error of a value that exceeds a limit.
    pub(super) fn limit(
        &self,
        path: &str,
        found: impl Into<String>,
        allowed: impl Into<String>,
    ) -> SceneError {
        SceneError::limit(self.of(path), found, allowed)
    }

    /// Position of a key, for a message.
    fn of(&self, wanted: &str) -> String {
        let mut start = None;
        // Serde accepted the file, so all its keys are known, and short.
        let walked = self.walk(&mut |path, span| {
            if start.is_none() && path_text(path) == wanted {
                start = Some(span.start);
            }
            Ok(())
        });
        debug_assert!(walked.is_ok(), "the walk refuses nothing");
        start.map_or_else(|| wanted.to_owned(), |start| self.locate(wanted, start))
    }

    fn locate(&self, path: &str, start: usize) -> String {
        format!("{}: {}", position(self.text, start), escaped(path))
    }

    /// Visits all keys and values.
    fn walk(&self, visit: &mut Visit<'_>) -> Result<(), SceneError> {
        table(&mut Vec::new(), &self.root, visit)
    }
}

fn table<'t>(
    path: &mut Vec<Step<'t>>,
    entries: &'t DeTable<'_>,
    visit: &mut Visit<'_>,
) -> Result<(), SceneError> {
    for (key, inner) in entries {
        path.push(Step::Key(key.get_ref()));
        visit(path, key.span())?;
        value(path, inner, visit)?;
        path.pop();
    }
    Ok(())
}

fn value<'t>(
    path: &mut Vec<Step<'t>>,
    at: &'t Spanned<DeValue<'_>>,
    visit: &mut Visit<'_>,
) -> Result<(), SceneError> {
    visit(path, at.span())?;
    match at.get_ref() {
        DeValue::Table(entries) => table(path, entries, visit),
        DeValue::Array(elements) => {
            for (i, element) in elements.iter().enumerate() {
                path.push(Step::Index(i));
                value(path, element, visit)?;
                path.pop();
            }
            Ok(())
        }
        _ => Ok(()),
    }
}

/// Path of a value, as `light[0].point.color`.
fn path_text(path: &[Step<'_>]) -> String {
    let mut text = String::new();
    for step in path {
        match step {
            Step::Key(key) => {
                if !text.is_empty() {
                    text.push('.');
                }
                text.push_str(key);
            }
            Step::Index(i) => text.push_str(&format!("[{i}]")),
        }
    }
    text
}

/// Line and column, both from 1.
fn position(text: &str, at: usize) -> String {
    let before = text.get(..at).unwrap_or(text);
    let line = before.matches('\n').count().saturating_add(1);
    let column = before.rsplit('\n').next().unwrap_or_default().chars().count().saturating_add(1);
    format!("line {line}, column {column}")
}

/// Value found and values allowed, from the message of serde.
fn found_and_allowed(message: &str) -> (String, String) {
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
