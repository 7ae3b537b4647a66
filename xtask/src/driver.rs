//! A Vulkan driver for the tests: found, or installed where that can be done without asking.

use std::path::{Path, PathBuf};

use crate::run::command;

/// Debian's packages with a loader and a software driver.
const PACKAGES: [&str; 2] = ["libvulkan1", "mesa-vulkan-drivers"];
/// What a person types where we may not.
const BY_HAND: &str = "sudo apt-get update && sudo apt-get install -y libvulkan1 mesa-vulkan-drivers";

/// Makes sure that there is a Vulkan driver. Without one and with apt at hand as root, installs Debian's software
/// driver; otherwise says the one command that does. Systems with a GPU interface of their own need none.
pub(crate) fn ensure() -> Result<(), String> {
    if !cfg!(target_os = "linux") || std::env::var("DOWNPOUR_GPU_TESTS").is_ok_and(|v| v == "no") || found() {
        return Ok(());
    }
    if !(is_root() && Path::new("/usr/bin/apt-get").exists()) {
        return Err(format!(
            "no Vulkan driver found. Install one, for example Debian's software driver:\n  {BY_HAND}\nor run the \
             tests without a GPU: DOWNPOUR_GPU_TESTS=no cargo xtask test"
        ));
    }
    println!("no Vulkan driver found; installing {}", PACKAGES.join(" and "));
    apt(&["update", "-qq"])?;
    apt(&[&["install", "-y", "-qq", "--no-install-recommends"], &PACKAGES[..]].concat())?;
    if found() { Ok(()) } else { Err("the driver was installed but is not found".to_owned()) }
}

/// Whether a loader and a driver manifest are there.
fn found() -> bool {
    let libraries = ["/usr/lib", "/usr/lib64", "/lib", "/usr/local/lib"];
    let loader = libraries.iter().any(|folder| has_loader(Path::new(folder)));
    loader
        && (named_manifest()
            || ["/usr/share", "/usr/local/share", "/etc"].iter().any(|root| has_manifest(root)))
}

/// A loader in the folder or in one of its folders for an architecture.
fn has_loader(folder: &Path) -> bool {
    let holds = |folder: &Path| folder.join("libvulkan.so.1").exists();
    let inner = |folder: &Path| -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        entries.map(|e| e.path()).filter(|p| p.to_string_lossy().contains("-linux-")).collect()
    };
    holds(folder) || inner(folder).iter().any(|p| holds(p))
}

fn named_manifest() -> bool {
    ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"].iter().any(|name| {
        std::env::var_os(name).is_some_and(|list| std::env::split_paths(&list).any(|path| path.exists()))
    })
}

fn has_manifest(root: &str) -> bool {
    let entries = std::fs::read_dir(Path::new(root).join("vulkan/icd.d")).into_iter().flatten().flatten();
    entries.map(|e| e.path()).any(|path| path.extension().is_some_and(|e| e == "json"))
}

fn is_root() -> bool {
    let uid = command("id", &["-u"]).output();
    uid.is_ok_and(|out| String::from_utf8_lossy(&out.stdout).trim() == "0")
}

fn apt(arguments: &[&str]) -> Result<(), String> {
    let status = command("apt-get", arguments)
        .env("DEBIAN_FRONTEND", "noninteractive")
        .status()
        .map_err(|error| format!("apt-get did not start: {error}"))?;
    if status.success() {
        Ok(())
    } else {
        Err(format!("apt-get {} failed; by hand:\n  {BY_HAND}", arguments.join(" ")))
    }
}
