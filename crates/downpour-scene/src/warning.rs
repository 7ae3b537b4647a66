//! Warnings: parts that a reader dropped or repaired.

use std::fmt;

/// Maximum number of warnings with their text; the others are only counted.
const KEPT: usize = 64;

/// A part that a reader dropped or repaired.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Kind of the warning.
    pub kind: WarningKind,
    /// Path inside the file, as `meshes[0].primitives[2]`.
    pub location: String,
    /// Defect and its treatment, on one line.
    pub what: String,
}

/// Kind of a [`Warning`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum WarningKind {
    /// Geometry was dropped because its numbers are unusable: not finite, or a transform without an inverse.
    Dropped,
    /// A part of the file is not read: points, lines, a skin, an optional extension.
    Ignored,
    /// The file is not quite glTF 2.0, but its meaning is clear.
    Irregular,
    /// The file holds no triangles, or none were left.
    Empty,
    /// Further warnings, counted only.
    More,
}

impl WarningKind {
    /// True if a caller that wants the complete file should reject it.
    ///
    /// ```
    /// use downpour_scene::WarningKind;
    /// assert!(WarningKind::Dropped.is_loss() && !WarningKind::Irregular.is_loss());
    /// ```
    #[must_use]
    pub fn is_loss(self) -> bool {
        matches!(self, Self::Dropped | Self::Empty)
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.location.is_empty() {
            write!(f, "{}: ", self.location)?;
        }
        f.write_str(&self.what)
    }
}

/// Warnings as they are gathered: a file with a million faults must not make a million lines.
#[derive(Debug, Default)]
pub struct Warnings {
    kept: Vec<Warning>,
    more: u64,
    loss: bool,
}

impl Warnings {
    /// Adds one. The words are made only when they will be kept.
    pub fn add(&mut self, kind: WarningKind, location: impl fmt::Display, what: impl FnOnce() -> String) {
        // A loss must be seen however many small things came before it.
        if self.kept.len() < KEPT || (kind.is_loss() && !self.loss) {
            self.kept.push(Warning { kind, location: location.to_string(), what: what() });
        } else {
            self.more = self.more.saturating_add(1);
        }
        self.loss |= kind.is_loss();
    }

    /// All of them, with a last line for those that were only counted.
    #[must_use]
    pub fn finish(mut self) -> Vec<Warning> {
        if self.more > 0 {
            let what = format!("and {} more", self.more);
            self.kept.push(Warning { kind: WarningKind::More, location: String::new(), what });
        }
        self.kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_is_counted_and_a_loss_still_seen() {
        let mut warnings = Warnings::default();
        for _ in 0..1000 {
            warnings.add(WarningKind::Ignored, "here", || "a point".into());
        }
        warnings.add(WarningKind::Dropped, "there", || "a mesh".into());
        let all = warnings.finish();
        assert_eq!(all.len(), KEPT + 2);
        assert_eq!(all[KEPT].to_string(), "there: a mesh");
        assert_eq!(all[KEPT + 1].to_string(), "and 936 more");
    }
}
