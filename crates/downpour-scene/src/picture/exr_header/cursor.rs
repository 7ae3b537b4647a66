//! Little-endian values in a row of bytes that may end at any position.

use crate::error::SceneError;
use std::borrow::Cow;

/// Bytes that are not read yet.
#[derive(Debug)]
pub(super) struct Bytes<'a> {
    all: &'a [u8],
    rest: &'a [u8],
}

impl<'a> Bytes<'a> {
    pub(super) fn new(all: &'a [u8]) -> Self {
        Self { all, rest: all }
    }

    /// Number of bytes read so far.
    pub(super) fn position(&self) -> usize {
        self.all.len().saturating_sub(self.rest.len())
    }

    pub(super) fn rest(&self) -> &'a [u8] {
        self.rest
    }

    pub(super) fn take(&mut self, count: usize) -> Result<&'a [u8], SceneError> {
        let (taken, rest) = self.rest.split_at_checked(count).ok_or_else(cut)?;
        self.rest = rest;
        Ok(taken)
    }

    pub(super) fn u8(&mut self) -> Result<u8, SceneError> {
        self.take(1)?.first().copied().ok_or_else(cut)
    }

    pub(super) fn u32(&mut self) -> Result<u32, SceneError> {
        let (&word, rest) = self.rest.split_first_chunk().ok_or_else(cut)?;
        self.rest = rest;
        Ok(u32::from_le_bytes(word))
    }

    pub(super) fn i32(&mut self) -> Result<i32, SceneError> {
        self.u32().map(u32::cast_signed)
    }

    /// A name up to a zero byte; invalid UTF-8 in it is replaced.
    pub(super) fn text(&mut self) -> Result<Cow<'a, str>, SceneError> {
        // The longest name of the format is 255 bytes; a little more shows that it is too long.
        let end = self.rest.iter().take(1024).position(|&byte| byte == 0).ok_or_else(cut)?;
        let text = self.take(end)?;
        self.take(1)?;
        Ok(String::from_utf8_lossy(text))
    }
}

fn cut() -> SceneError {
    SceneError::bad("header", "ends too early", "a whole header")
}
