//! Vulkan drivers found on the machine, for the message of a missing adapter.

use std::path::{Path, PathBuf};

/// Advice for a machine without a driver.
pub(crate) const REMEDY: &str = "On Debian or Ubuntu, `apt-get install mesa-vulkan-drivers` brings a software GPU; \
`--backend cpu` needs none";

/// One line on each possible location of a driver.
pub(crate) fn tried(backends: wgpu::Backends) -> String {
    let mut lines = Vec::new();
    if backends.contains(wgpu::Backends::VULKAN)
        && cfg!(not(any(target_vendor = "apple", target_family = "wasm")))
    {
        let manifests = vulkan_manifests();
        lines.push(if manifests.is_empty() {
            "Vulkan (no driver manifest in VK_DRIVER_FILES, VK_ICD_FILENAMES or vulkan/icd.d)".to_owned()
        } else {
            let names: Vec<String> = manifests.iter().map(|p| p.display().to_string()).collect();
            format!("Vulkan (drivers that gave no adapter: {})", names.join(", "))
        });
    }
    for (backend, name, here) in [
        (wgpu::Backends::METAL, "Metal", cfg!(target_vendor = "apple")),
        (wgpu::Backends::DX12, "Direct3D 12", cfg!(windows)),
        (wgpu::Backends::BROWSER_WEBGPU, "WebGPU", cfg!(target_family = "wasm")),
    ] {
        if backends.contains(backend) && here {
            lines.push(format!("{name} (no adapter)"));
        }
    }
    if lines.is_empty() { "no backend of this system".to_owned() } else { lines.join("; ") }
}

/// Manifests that a Vulkan loader would read.
fn vulkan_manifests() -> Vec<PathBuf> {
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        if let Some(list) = std::env::var_os(variable).filter(|v| !v.is_empty()) {
            return std::env::split_paths(&list).collect();
        }
    }
    let mut found: Vec<PathBuf> = ["/usr/share", "/usr/local/share", "/etc"]
        .iter()
        .filter_map(|root| std::fs::read_dir(Path::new(root).join("vulkan/icd.d")).ok())
        .flatten()
        .filter_map(|entry| entry.ok().map(|e| e.path()))
        .filter(|path| path.extension().is_some_and(|e| e == "json"))
        .collect();
    found.sort();
    found
}
