//! The arguments of the task.

use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::str::FromStr;

/// What is compared, and how closely.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Options {
    pub(super) quick: bool,
    pub(super) check: bool,
    pub(super) only: bool,
    pub(super) streaks: bool,
    pub(super) scenes: bool,
    pub(super) keep: bool,
    pub(super) scene: Option<String>,
    pub(super) diameters_mm: Vec<f64>,
    pub(super) maps: Vec<PathBuf>,
    pub(super) command: Option<PathBuf>,
    pub(super) size: u32,
    pub(super) samples: u32,
    pub(super) path_samples: u32,
    pub(super) subdivisions: u32,
}

impl Options {
    /// Reads the arguments after `truth`.
    pub(super) fn read(arguments: &[&str]) -> Result<Self, String> {
        let mut options = Self {
            quick: false,
            check: true,
            only: false,
            streaks: false,
            scenes: false,
            keep: false,
            scene: None,
            diameters_mm: Vec::new(),
            maps: Vec::new(),
            command: None,
            size: 256,
            samples: 64,
            path_samples: 72,
            subdivisions: 7,
        };
        let mut rest = arguments.iter().copied();
        while let Some(name) = rest.next() {
            let mut value = || rest.next().ok_or_else(|| format!("{name} needs a value"));
            match name {
                "--quick" => options.quick = true,
                "--no-check" => options.check = false,
                "--streaks" => options.streaks = true,
                "--scenes" => options.scenes = true,
                "--keep" => options.keep = true,
                "--scene" => {
                    options.scenes = true;
                    options.scene = Some(value()?.to_owned());
                }
                "--only" => options.only = true,
                "--map" => options.maps.push(value()?.into()),
                "--command" => options.command = Some(value()?.into()),
                "--diameter" => options.diameters_mm.push(number(name, value()?, &(0.01..=9.0))?),
                "--size" => options.size = number(name, value()?, &(32..=2048))?,
                "--samples" => options.samples = number(name, value()?, &(1..=4096))?,
                "--path-samples" => options.path_samples = number(name, value()?, &(16..=65_536))?,
                "--subdivisions" => options.subdivisions = number(name, value()?, &(3..=8))?,
                _ => return Err(format!("{name} is no argument of this task")),
            }
        }
        if options.only && options.maps.is_empty() {
            return Err("--only without a --map leaves nothing to compare".to_owned());
        }
        if options.diameters_mm.is_empty() {
            options.diameters_mm = match (options.streaks, options.quick) {
                (true, _) => vec![2.0, 4.0],
                (false, true) => vec![2.0, 5.0],
                (false, false) => vec![1.0, 2.0, 3.0, 5.0],
            };
        }
        Ok(options)
    }
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
    fn the_default_set_is_whole_and_the_quick_one_smaller() {
        let options = Options::read(&[]).expect("no arguments");
        assert_eq!(options.diameters_mm, [1.0, 2.0, 3.0, 5.0]);
        assert!(options.check && !options.quick);
        assert_eq!(Options::read(&["--quick"]).expect("quick").diameters_mm, [2.0, 5.0]);
        assert_eq!(Options::read(&["--streaks"]).expect("streaks").diameters_mm, [2.0, 4.0]);
    }

    #[test]
    fn arguments_replace_what_they_name() {
        let read =
            Options::read(&["--diameter", "4.5", "--map", "a.hdr", "--map", "b.exr", "--only", "--no-check"]);
        let options = read.expect("right");
        assert_eq!((options.diameters_mm, options.maps.len(), options.check), (vec![4.5], 2, false));
    }

    #[test]
    fn wrong_arguments_are_named() {
        for (arguments, words) in [
            (&["--size"][..], "--size needs a value"),
            (&["--size", "1e9"], "--size is \"1e9\"; allowed: 32 to 2048"),
            (&["--diameter", "NaN"], "--diameter is \"NaN\"; allowed: 0.01 to 9"),
            (&["--only"], "--only without a --map leaves nothing to compare"),
            (&["fast"], "fast is no argument of this task"),
        ] {
            assert_eq!(Options::read(arguments), Err(words.to_owned()));
        }
    }
}
