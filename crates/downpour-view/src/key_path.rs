//! Paths of keys in a weather file: `rain.rate_mm_h`, `wind[0].vortex.core_m`.

use std::fmt;

/// A step of a path.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Step {
    /// Key of a table.
    Key(String),
    /// Entry of a list.
    Entry(usize),
}

/// Path of a value in a weather file.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct KeyPath(Vec<Step>);

/// Text that is no path of a key.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "key path \"{0}\"; allowed: names of letters, digits and _, with [index] after a list, such as wind[0].vortex.core_m"
)]
pub struct BadKeyPath(pub String);

impl KeyPath {
    /// Path of a text.
    ///
    /// # Errors
    /// [`BadKeyPath`].
    pub fn parse(text: &str) -> Result<Self, BadKeyPath> {
        let bad = || BadKeyPath(text.chars().take(80).collect());
        let mut steps = Vec::new();
        for part in text.split('.') {
            let (name, mut indices) = match part.find('[') {
                Some(at) => part.split_at(at),
                None => (part, ""),
            };
            if name.is_empty() || !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-') {
                return Err(bad());
            }
            steps.push(Step::Key(name.to_owned()));
            while let Some(rest) = indices.strip_prefix('[') {
                let (index, after) = rest.split_once(']').ok_or_else(bad)?;
                steps.push(Step::Entry(index.parse().map_err(|_| bad())?));
                indices = after;
            }
            if !indices.is_empty() {
                return Err(bad());
            }
        }
        Ok(Self(steps))
    }

    /// Path of one key of the root.
    #[must_use]
    pub fn of(key: &str) -> Self {
        Self(vec![Step::Key(key.to_owned())])
    }

    /// Path of a key in this table.
    #[must_use]
    pub fn key(&self, key: &str) -> Self {
        self.with(Step::Key(key.to_owned()))
    }

    /// Path of an entry of this list.
    #[must_use]
    pub fn entry(&self, index: usize) -> Self {
        self.with(Step::Entry(index))
    }

    fn with(&self, step: Step) -> Self {
        let mut steps = self.0.clone();
        steps.push(step);
        Self(steps)
    }

    /// Steps from the root.
    #[must_use]
    pub fn steps(&self) -> &[Step] {
        &self.0
    }

    /// Name of the last key.
    #[must_use]
    pub fn name(&self) -> &str {
        let names = self.0.iter().rev().filter_map(|step| match step {
            Step::Key(name) => Some(name.as_str()),
            Step::Entry(_) => None,
        });
        names.into_iter().next().unwrap_or_default()
    }

    /// True if this is another path or in it.
    #[must_use]
    pub fn begins_with(&self, other: &Self) -> bool {
        self.0.starts_with(&other.0)
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, step) in self.0.iter().enumerate() {
            match step {
                Step::Key(name) if i == 0 => write!(f, "{name}")?,
                Step::Key(name) => write!(f, ".{name}")?,
                Step::Entry(index) => write!(f, "[{index}]")?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_read_and_written() {
        for text in ["rain.rate_mm_h", "wind[0].vortex.core_m", "preset", "glass.wiper[2].pivot_m[1]"] {
            assert_eq!(KeyPath::parse(text).unwrap().to_string(), text);
        }
        for text in ["", "a..b", "a[", "a[x]", "a]", "[0]", "a[0]b", "a b", "a[-1]"] {
            assert!(KeyPath::parse(text).is_err(), "{text}");
        }
    }
}
