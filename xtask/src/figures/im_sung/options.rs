//! The arguments of the task.

use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::str::FromStr;

/// Edges of a picture.
const EDGES: RangeInclusive<u32> = 64..=4096;

/// How the figures are made.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Options {
    pub(super) command: Option<PathBuf>,
    pub(super) size: [u32; 2],
    pub(super) fps: u32,
    pub(super) backend: String,
    pub(super) go_on: bool,
    pub(super) quick: bool,
    pub(super) check: bool,
}

impl Options {
    /// Reads the arguments after `figures im-sung`.
    pub(super) fn read(arguments: &[&str]) -> Result<Self, String> {
        let mut options = Self {
            command: None,
            size: [640, 360],
            fps: 12,
            backend: "cpu".to_owned(),
            go_on: false,
            quick: false,
            check: true,
        };
        let mut rest = arguments.iter().copied();
        while let Some(name) = rest.next() {
            let mut value = || rest.next().ok_or_else(|| format!("{name} needs a value"));
            match name {
                "--command" => options.command = Some(value()?.into()),
                "--size" => options.size = size(value()?)?,
                "--fps" => options.fps = number(name, value()?, &(6..=120))?,
                "--backend" => options.backend = value()?.to_owned(),
                "--quick" => options.quick = true,
                "--go-on" => options.go_on = true,
                "--no-check" => options.check = false,
                _ => return Err(format!("{name} is no argument of this task")),
            }
        }
        Ok(options)
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let (columns, rows) =
        text.split_once('x').ok_or_else(|| format!("--size is \"{text}\"; allowed: WxH"))?;
    Ok([number("--size", columns, &EDGES)?, number("--size", rows, &EDGES)?])
}

fn number<T>(name: &str, text: &str, allowed: &RangeInclusive<T>) -> Result<T, String>
where
    T: FromStr + PartialOrd + std::fmt::Display,
{
    text.parse()
        .ok()
        .filter(|value| allowed.contains(value))
        .ok_or_else(|| format!("{name} is \"{text}\"; allowed: {} to {}", allowed.start(), allowed.end()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_replace_what_they_name() {
        let read = Options::read(&["--size", "320x180", "--fps", "24", "--go-on", "--command", "a/b"]);
        let options = read.expect("right");
        assert_eq!((options.size, options.fps, options.go_on, options.check), ([320, 180], 24, true, true));
        assert_eq!(options.command, Some("a/b".into()));
    }

    #[test]
    fn wrong_arguments_are_named() {
        for (arguments, words) in [
            (&["--fps"][..], "--fps needs a value"),
            (&["--fps", "0"], "--fps is \"0\"; allowed: 6 to 120"),
            (&["--size", "640"], "--size is \"640\"; allowed: WxH"),
            (&["--size", "640x1"], "--size is \"1\"; allowed: 64 to 4096"),
            (&["fast"], "fast is no argument of this task"),
        ] {
            assert_eq!(Options::read(arguments), Err(words.to_owned()));
        }
    }
}
