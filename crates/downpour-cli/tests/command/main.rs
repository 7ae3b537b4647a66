//! The command as scripts see it: keys, numbers, exit codes, messages, files. Each run is a child process with limits
//! of memory and time.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod arguments;
mod broken;
mod check;
mod child;
mod clip;
mod clip_bad;
#[cfg(unix)]
mod clip_kill;
#[cfg(feature = "video")]
mod clip_video;
mod document;
mod drop;
mod gltf_file;
mod lattice;
#[cfg(target_os = "linux")]
mod little_memory;
mod mask;
mod models;
mod output;
mod papers;
mod puddle;
mod rain;
mod readme;
mod render;
mod render_bad;
mod scene_files;
mod scenes;
#[cfg(unix)]
mod signals;
mod specimen;
mod street;
#[cfg(unix)]
mod watch;
mod wind;
#[cfg(all(feature = "gpu", target_os = "linux"))]
mod without_gpu;
#[cfg(not(feature = "gpu"))]
mod without_support;
