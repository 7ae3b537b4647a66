//! The arguments of the task.

use std::path::PathBuf;

use clap::Args;

use crate::quantity::within;

/// Hold drops, streaks and scenes against Mitsuba 3 (needs python3 and the network).
#[derive(Args, Clone, Debug, PartialEq)]
pub(crate) struct Options {
    /// Two diameters and one view instead of four and three.
    #[arg(long)]
    pub(super) quick: bool,
    /// A case above the aim is no failure.
    #[arg(long = "no-check", action = clap::ArgAction::SetFalse)]
    pub(super) check: bool,
    /// No maps but those of --map.
    #[arg(long, requires = "maps")]
    pub(super) only: bool,
    /// Streaks only, before the maps and under lamps.
    #[arg(long)]
    pub(super) streaks: bool,
    /// Whole scenes instead of drops.
    #[arg(long)]
    scenes: bool,
    /// Keep Mitsuba's pictures of scenes that an earlier run has made.
    #[arg(long)]
    pub(super) keep: bool,
    /// Only scenes with this in their name.
    #[arg(long, value_name = "NAME")]
    pub(super) scene: Option<String>,
    /// These diameters (repeatable) instead of 1, 2, 3 and 5 mm (streaks: 2 and 4 mm).
    #[arg(long = "diameter", value_name = "MM", value_parser = within(0.01..=9.0))]
    diameters_mm: Vec<f64>,
    /// This sky map, too (repeatable).
    #[arg(long = "map", value_name = "FILE")]
    pub(super) maps: Vec<PathBuf>,
    /// A `downpour` that is built already.
    #[arg(long, value_name = "FILE")]
    pub(super) command: Option<PathBuf>,
    /// Edge of the pictures.
    #[arg(long, value_name = "PIXELS", default_value = "256", value_parser = within(32..=2048_u32))]
    pub(super) size: u32,
    /// Samples per pixel of the integrator that follows all branches.
    #[arg(long, value_name = "N", default_value = "64", value_parser = within(1..=4096_u32))]
    pub(super) samples: u32,
    /// Samples per pixel of Mitsuba's path tracer.
    #[arg(long, value_name = "N", default_value = "72", value_parser = within(16..=65_536_u32))]
    pub(super) path_samples: u32,
    /// Rays to the sky per sample of our pictures of scenes, instead of the command's default.
    #[arg(long, value_name = "N", value_parser = within(1..=64_u32))]
    pub(super) sky_rays: Option<u32>,
    /// Samples along each side of a pixel of our pictures of scenes, instead of the command's default.
    #[arg(long, value_name = "N", value_parser = within(1..=8_u32))]
    pub(super) scene_samples: Option<u32>,
    /// Fineness of the mesh, 20 * 4^N triangles.
    #[arg(long, value_name = "N", default_value = "7", value_parser = within(3..=8_u32))]
    pub(super) subdivisions: u32,
}

impl Options {
    /// True if scenes are compared.
    pub(super) fn scenes(&self) -> bool {
        self.scenes || self.scene.is_some()
    }

    /// The diameters that are compared, mm.
    pub(super) fn diameters_mm(&self) -> Vec<f64> {
        match (self.diameters_mm.as_slice(), self.streaks, self.quick) {
            ([], true, _) => vec![2.0, 4.0],
            ([], false, true) => vec![2.0, 5.0],
            ([], false, false) => vec![1.0, 2.0, 3.0, 5.0],
            (given, ..) => given.to_vec(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read;

    #[test]
    fn the_default_set_is_whole_and_the_quick_one_smaller() {
        let options = read::<Options>(&[]).expect("no arguments");
        assert_eq!(options.diameters_mm(), [1.0, 2.0, 3.0, 5.0]);
        assert!(options.check && !options.quick);
        assert_eq!(read::<Options>(&["--quick"]).expect("quick").diameters_mm(), [2.0, 5.0]);
        assert_eq!(read::<Options>(&["--streaks"]).expect("streaks").diameters_mm(), [2.0, 4.0]);
        assert!(read::<Options>(&["--scene", "shed"]).expect("a scene").scenes());
    }

    #[test]
    fn arguments_replace_what_they_name() {
        let read = read::<Options>(&[
            "--diameter",
            "4.5",
            "--map",
            "a.hdr",
            "--map",
            "b.exr",
            "--only",
            "--no-check",
        ]);
        let options = read.expect("right");
        assert_eq!((options.diameters_mm(), options.maps.len(), options.check), (vec![4.5], 2, false));
    }

    #[test]
    fn wrong_arguments_are_named() {
        for (arguments, words) in [
            (&["--size"][..], "--size <PIXELS>"),
            (&["--size", "1e9"], "allowed: 32 to 2048"),
            (&["--diameter", "NaN"], "allowed: 0.01 to 9"),
            (&["--only"], "--map"),
            (&["fast"], "fast"),
        ] {
            let message = read::<Options>(arguments).unwrap_err();
            assert!(message.contains(words), "{message}");
        }
    }
}
