//! Tests, lints and benchmarks of the whole workspace.

use xtask::run;

use crate::{driver, mutants};

/// The library crates, and the features each has to build with, alone.
const ALONE: &[(&str, &[&str])] = &[
    ("downpour-shaders", &[""]),
    ("downpour-math", &[""]),
    ("downpour-gpu", &[""]),
    ("downpour-bvh", &[""]),
    ("downpour-drop", &[""]),
    ("downpour-lattice", &["", "wgpu"]),
    ("downpour-mask", &["", "wgpu"]),
    ("downpour-scene", &[""]),
    ("downpour-sim", &["", "wgpu"]),
    ("downpour-wind", &["", "wgpu"]),
    ("downpour-render", &["", "wgpu"]),
    ("downpour", &["", "wgpu"]),
    ("downpour-view", &[""]),
    ("downpour-cli", &["", "gpu", "video", "view"]),
];

/// Every test of the workspace, with documentation tests; `all`: and the sweeps that take minutes.
pub(crate) fn test(all: bool) -> Result<(), String> {
    driver::ensure()?;
    let runtime = crate::driver::runtime()?;
    run::cargo(&["test", "--workspace", "--all-features", "--locked"], &[("XDG_RUNTIME_DIR", &runtime)])?;
    mutants::try_sample()?;
    if all { sweep() } else { Ok(()) }
}

/// Spoiled files by the hundred thousand, lattices over a million steps, and water by height on many panes.
fn sweep() -> Result<(), String> {
    // Of the whole workspace, as above: the features are the same, and nothing is built again.
    let workspace = ["test", "--workspace", "--all-features", "--locked"];
    let mutations = ["--test", "mutations"];
    run::cargo(&[&workspace[..], &mutations].concat(), &[("DOWNPOUR_MUTATIONS", "300000")])?;
    let long = ["--test", "puddle", "--test", "glass_water", "--test", "glass_flow", "--test", "streets"];
    run::cargo(&[&workspace[..], &long, &["--", "--ignored"]].concat(), &[])
}

/// Formatting, lints, each crate separately, documentation.
pub(crate) fn lint() -> Result<(), String> {
    run::cargo(&["fmt", "--all", "--check"], &[])?;
    let deny = ["--", "-D", "warnings"];
    let clippy = ["clippy", "--workspace", "--all-targets", "--all-features", "--locked"];
    run::cargo(&[&clippy[..], &deny[..]].concat(), &[])?;
    for (name, features) in ALONE {
        for feature in *features {
            let check = ["check", "--locked", "-p", name, "--no-default-features", "--features", feature];
            run::cargo(&check, &[])?;
        }
    }
    let doc = ["doc", "--workspace", "--all-features", "--no-deps", "--locked"];
    run::cargo(&doc, &[("RUSTDOCFLAGS", "-D warnings")])
}

/// Every benchmark.
pub(crate) fn bench() -> Result<(), String> {
    driver::ensure()?;
    run::cargo(&["bench", "--workspace", "--all-features", "--locked"], &[])
}
