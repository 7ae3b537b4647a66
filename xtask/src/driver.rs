//! Vulkan driver for the tests: found, or installed if that is possible without a prompt.

use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::Duration;

use xtask::run::{command, root};

/// Debian's packages with a loader and a software driver.
const PACKAGES: [&str; 2] = ["libvulkan1", "mesa-vulkan-drivers"];
/// Command for the user if we may not install.
const BY_HAND: &str = "sudo apt-get update && sudo apt-get install -y libvulkan1 mesa-vulkan-drivers";

/// Ensures that there is a Vulkan driver. Without one and with apt available as root, installs Debian's software
/// driver; otherwise prints the command that does. Systems with a different GPU interface need none.
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

/// True if a loader and a driver manifest exist.
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

/// Maximum time to wait for another run of the package manager.
const PATIENCE: Duration = Duration::from_secs(600);
const PAUSE: Duration = Duration::from_secs(3);

/// Runs apt-get; waits while another process holds its lock.
fn apt(arguments: &[&str]) -> Result<(), String> {
    // The option covers the lock of the installed packages; the one of the lists is waited for here.
    let timeout = format!("DPkg::Lock::Timeout={}", PATIENCE.as_secs());
    let arguments = [&["-o", &timeout], arguments].concat();
    let attempt = || {
        let out = command("apt-get", &arguments)
            .env("DEBIAN_FRONTEND", "noninteractive")
            .env("LC_ALL", "C")
            .stdin(Stdio::null())
            .output()
            .map_err(|error| format!("apt-get did not start: {error}"))?;
        let said = String::from_utf8_lossy(&out.stderr).into_owned();
        Ok(if out.status.success() { Ok(()) } else { Err(said) })
    };
    let pauses = PATIENCE.as_secs() / PAUSE.as_secs();
    match patiently(pauses, attempt, || std::thread::sleep(PAUSE))? {
        Ok(()) => Ok(()),
        Err(said) => {
            eprint!("{said}");
            Err(format!("apt-get {} failed; by hand:\n  {BY_HAND}", arguments.join(" ")))
        }
    }
}

/// Result of the first attempt without a lock, or of the last one after all pauses.
fn patiently(
    pauses: u64,
    mut attempt: impl FnMut() -> Result<Result<(), String>, String>,
    mut pause: impl FnMut(),
) -> Result<Result<(), String>, String> {
    for count in 0..pauses {
        match attempt()? {
            Err(said) if is_locked(&said) => {
                if count == 0 {
                    println!("another run of the package manager holds its lock; waiting");
                }
                pause();
            }
            ended => return Ok(ended),
        }
    }
    attempt()
}

/// True if apt-get ended because another process holds a lock.
fn is_locked(said: &str) -> bool {
    [
        "Could not get lock",
        "Unable to lock",
        "Unable to acquire the dpkg frontend lock",
        "is another process using it",
    ]
    .iter()
    .any(|words| said.contains(words))
}

/// A run-time folder, without which Mesa complains; it needs none of the user's.
pub(crate) fn runtime() -> Result<String, String> {
    let folder = root().join("target/runtime");
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    Ok(folder.display().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOCKED: &str = "E: Could not get lock /var/lib/apt/lists/lock. It is held by process 7 (apt-get)\n\
        E: Unable to lock directory /var/lib/apt/lists/\n";

    /// Ends as in the list, one after the other: attempts, pauses, and the result.
    fn run(ends: &[Result<(), &str>], pauses: u64) -> (usize, usize, Result<(), String>) {
        let (mut attempts, mut waited) = (0, 0);
        let ended = patiently(
            pauses,
            || {
                attempts += 1;
                Ok(ends[attempts - 1].map_err(str::to_owned))
            },
            || waited += 1,
        );
        (attempts, waited, ended.expect("it starts"))
    }

    #[test]
    fn a_lock_of_the_package_manager_is_waited_for() {
        assert_eq!(run(&[Ok(())], 9), (1, 0, Ok(())));
        assert_eq!(run(&[Err(LOCKED), Err(LOCKED), Ok(())], 9), (3, 2, Ok(())));
        // Other errors end at once, and patience ends.
        assert_eq!(run(&[Err("E: no network"), Ok(())], 9), (1, 0, Err("E: no network".to_owned())));
        assert_eq!(run(&[Err(LOCKED); 4], 3), (4, 3, Err(LOCKED.to_owned())));
    }
}
