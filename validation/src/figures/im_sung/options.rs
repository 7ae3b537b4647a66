//! The arguments of the task.

use std::path::PathBuf;

use clap::Args;

use crate::quantity::{size, within};

/// Figures 6 to 11 of Im & Sung 2022: three methods to keep rain in front of a camera, and ours.
#[derive(Args, Clone, Debug, PartialEq)]
pub(crate) struct Options {
    /// A `downpour` that is built already.
    #[arg(long, value_name = "FILE")]
    pub(super) command: Option<PathBuf>,
    /// Size of the pictures.
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = size)]
    pub(super) size: [u32; 2],
    /// Frames per second of the path of 2 s.
    #[arg(long, value_name = "N", default_value = "12", value_parser = within(6..=120_u32))]
    pub(super) fps: u32,
    /// Backend: cpu, gpu or auto.
    #[arg(long, value_name = "NAME", default_value = "cpu")]
    pub(super) backend: String,
    /// Keep the frames that an earlier run with the same arguments has made.
    #[arg(long)]
    pub(super) go_on: bool,
    /// Without figures 7 and 11.
    #[arg(long)]
    pub(super) quick: bool,
    /// Drops of ours that are off screen are no failure.
    #[arg(long = "no-check", action = clap::ArgAction::SetFalse)]
    pub(super) check: bool,
}
