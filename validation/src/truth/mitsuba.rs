//! Mitsuba 3 in a virtual environment, and the script that renders and compares.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use downpour_drop::optics::WATER_INDEX;

use super::cases::Case;
use super::mesh::UNITS_PER_METER;
use super::{Options, create, run, write};

/// Versions of the packages.
const REQUIREMENTS: &str = include_str!("requirements.txt");
/// Debian's LLVM, with which Mitsuba compiles its kernels. LLVM 15 ends the process at the arc cosine.
const LLVM_PACKAGE: &str = "libllvm19";
const OLDEST_LLVM: u32 = 16;
/// The vectorised variant, and the one that needs no LLVM.
const FAST: &str = "llvm_ad_rgb";
const SLOW: &str = "scalar_rgb";
/// Ratio of the samples of the path tracer if it is the only integrator.
const ALONE: u32 = 8;

/// A Mitsuba that is ready to render.
#[derive(Debug)]
pub(super) struct Mitsuba {
    python: PathBuf,
    llvm: Option<PathBuf>,
}

/// Inputs and outputs of a comparison.
#[derive(Debug)]
pub(super) struct Job<'a> {
    pub(super) case: &'a Case<'a>,
    pub(super) ours: &'a Path,
    pub(super) mesh: &'a Path,
    pub(super) reference: &'a Path,
    pub(super) beside: &'a Path,
    pub(super) options: &'a Options,
}

impl Mitsuba {
    /// Installs missing packages.
    pub(super) fn ready(folder: &Path) -> Result<Self, String> {
        let mut ready = Self { python: environment(&folder.join("venv"))?, llvm: None };
        ready.llvm = ready.working_llvm();
        if ready.llvm.is_none() && install_llvm() {
            ready.llvm = ready.working_llvm();
        }
        if ready.llvm.is_none() {
            eprintln!(
                "no LLVM of version {OLDEST_LLVM} or later works with Mitsuba (Debian: apt-get install {LLVM_PACKAGE}); \
                 its scalar variant takes many times as long and has only the path tracer"
            );
        }
        Ok(ready)
    }

    /// The variant in use.
    pub(super) fn variant(&self) -> &'static str {
        if self.llvm.is_some() { FAST } else { SLOW }
    }

    /// Samples per pixel of the integrator that follows all branches; only the vectorized variant has it.
    pub(super) fn branch_samples(&self, options: &Options) -> Option<u32> {
        self.llvm.is_some().then_some(options.samples)
    }

    /// Samples per pixel of the path tracer. If it is the only one, its noise must stay below the aim.
    pub(super) fn path_samples(&self, options: &Options) -> u32 {
        if self.llvm.is_some() { options.path_samples } else { ALONE * options.path_samples }
    }

    /// Renders a case and compares it with ours: names and values.
    pub(super) fn compare(&self, job: &Job<'_>) -> Result<BTreeMap<String, f64>, String> {
        let (case, view) = (job.case, job.case.view);
        let mut command = self.script(self.llvm.as_deref());
        for (name, file) in [
            ("--ours", job.ours),
            ("--mesh", job.mesh),
            ("--sky", &case.map.file),
            ("--reference", job.reference),
            ("--beside", job.beside),
        ] {
            command.arg(name).arg(file);
        }
        for (name, value) in [
            ("--index", WATER_INDEX),
            ("--distance", view.distance_m * UNITS_PER_METER),
            ("--yaw", view.yaw_deg),
            ("--pitch", view.pitch_deg),
            ("--fov", case.fov_deg),
            ("--size", job.options.size.into()),
            ("--samples", job.options.samples.into()),
            ("--path-samples", self.path_samples(job.options).into()),
        ] {
            // With "=", a negative number is not taken for an option.
            command.arg(format!("{name}={value}"));
        }
        command.args(["--variant", self.variant()]);
        Ok(read(&output_of(&format!("Mitsuba on {}", case.name()), command.output())?))
    }

    /// Runs another script with files and numbers as its arguments: the names and values that it prints.
    pub(super) fn values(
        &self,
        what: &str,
        script: &str,
        files: &[(&str, PathBuf)],
        numbers: &[(&str, f64)],
    ) -> Result<BTreeMap<String, f64>, String> {
        let mut command = self.named_script(script, self.llvm.as_deref());
        for (name, file) in files {
            command.arg(format!("--{name}")).arg(file);
        }
        for (name, value) in numbers {
            command.arg(format!("--{name}={value}"));
        }
        Ok(read(&output_of(&format!("Mitsuba on {what}"), command.output())?))
    }

    fn script(&self, llvm: Option<&Path>) -> Command {
        self.named_script("case.py", llvm)
    }

    fn named_script(&self, name: &str, llvm: Option<&Path>) -> Command {
        let mut command = run::command(&self.python.display().to_string(), &[]);
        command.arg(run::root().join("validation/src/truth").join(name)).env("PYTHONDONTWRITEBYTECODE", "1");
        if let Some(llvm) = llvm {
            command.env("DRJIT_LIBLLVM_PATH", llvm);
        }
        command
    }

    /// First library with which a kernel compiles; an old one ends the process, so each is tried in a separate process.
    fn working_llvm(&self) -> Option<PathBuf> {
        let works = |file: &PathBuf| {
            let output = self.script(Some(file)).args(["probe", FAST]).output();
            output.is_ok_and(|output| output.status.success())
        };
        llvm_libraries().into_iter().find(works)
    }
}

/// The lines `name value` of a script.
fn read(text: &str) -> BTreeMap<String, f64> {
    text.lines()
        .filter_map(|line| line.split_once(' '))
        .filter_map(|(name, value)| Some((name.to_owned(), value.trim().parse().ok()?)))
        .collect()
}

/// The Python of a virtual environment with the packages, made if it is not there or holds others.
fn environment(folder: &Path) -> Result<PathBuf, String> {
    let python = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let stamp = folder.join("requirements.txt");
    if python.exists() && std::fs::read_to_string(&stamp).is_ok_and(|kept| kept == REQUIREMENTS) {
        return Ok(python);
    }
    if folder.exists() {
        std::fs::remove_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    create(folder)?;
    let folder_text = folder.display().to_string();
    println!("$ python3 -m venv {folder_text}");
    output_of(
        "python3 -m venv (Debian: apt-get install python3 python3-venv)",
        run::command("python3", &["-m", "venv", &folder_text]).output(),
    )?;
    let list = folder.join("wanted.txt");
    write(&list, REQUIREMENTS.as_bytes())?;
    println!("$ pip install {}", REQUIREMENTS.split_whitespace().collect::<Vec<_>>().join(" "));
    let mut pip = run::command(&python.display().to_string(), &["-m", "pip", "install", "--quiet"]);
    pip.args(["--disable-pip-version-check", "--no-input", "--only-binary", ":all:", "-r"]).arg(&list);
    output_of(
        "pip install (it needs the network, and a Python that these versions have wheels for)",
        pip.output(),
    )?;
    write(&stamp, REQUIREMENTS.as_bytes())?;
    Ok(python)
}

/// Shared libraries of LLVM, the newest known to work first.
fn llvm_libraries() -> Vec<PathBuf> {
    if let Some(set) = std::env::var_os("DRJIT_LIBLLVM_PATH") {
        return vec![set.into()];
    }
    let inside = |folder: &Path| -> Vec<PathBuf> {
        std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect()
    };
    let mut folders: Vec<PathBuf> = ["/usr/lib", "/usr/lib64", "/usr/local/lib"].map(PathBuf::from).into();
    for path in inside(Path::new("/usr/lib")) {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        if name.contains("-linux-gnu") {
            folders.push(path);
        } else if name.starts_with("llvm-") {
            folders.push(path.join("lib"));
        }
    }
    let mut found: Vec<(u32, PathBuf)> = folders
        .iter()
        .flat_map(|folder| inside(folder))
        .filter_map(|path| Some((llvm_version(&path.file_name()?.to_string_lossy())?, path)))
        .filter(|(version, _)| *version >= OLDEST_LLVM)
        .collect();
    found.sort_by(|a, b| b.cmp(a));
    found.dedup_by_key(|(version, _)| *version);
    found.into_iter().map(|(_, path)| path).collect()
}

/// The version in a name such as `libLLVM-19.so`, `libLLVM-19.so.1` or `libLLVM.so.19.1`.
fn llvm_version(name: &str) -> Option<u32> {
    let rest = name.strip_prefix("libLLVM")?;
    let digits =
        rest.strip_prefix(".so.").or_else(|| rest.strip_prefix('-').filter(|r| r.contains(".so")))?;
    digits.split('.').next()?.parse().ok()
}

/// Installs Debian's package if that is possible without a prompt; true on success.
fn install_llvm() -> bool {
    let root = run::command("id", &["-u"]).output();
    let root = root.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).trim() == "0");
    if !(cfg!(target_os = "linux") && root && Path::new("/usr/bin/apt-get").exists()) {
        return false;
    }
    println!("no LLVM for Mitsuba found; installing {LLVM_PACKAGE}");
    let apt = |arguments: &[&str]| {
        let status = run::command("apt-get", arguments).env("DEBIAN_FRONTEND", "noninteractive").status();
        status.is_ok_and(|status| status.success())
    };
    let install = ["install", "-y", "-qq", "--no-install-recommends", LLVM_PACKAGE];
    apt(&install) || (apt(&["update", "-qq"]) && apt(&install))
}

/// Standard output of a child; if it failed, an error with its standard error.
fn output_of(what: &str, output: std::io::Result<Output>) -> Result<String, String> {
    let output = output.map_err(|error| format!("{what} did not start: {error}"))?;
    let out = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.success() {
        return Ok(out);
    }
    let err = String::from_utf8_lossy(&output.stderr);
    let both = [out.trim(), err.trim()].into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>();
    Err(format!("{what} failed ({}):\n{}", output.status, both.join("\n")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_llvm_are_read() {
        for (name, version) in [
            ("libLLVM-19.so", Some(19)),
            ("libLLVM-15.so.1", Some(15)),
            ("libLLVM-14.0.6.so.1", Some(14)),
            ("libLLVM.so.19.1", Some(19)),
            ("libLLVM.so", None),
            ("libLLVMCore.a", None),
            ("libLLVM-22-rust", None),
        ] {
            assert_eq!(llvm_version(name), version, "{name}");
        }
    }

    #[test]
    fn failures_say_what_failed() {
        let error = output_of("nothing", Err(std::io::Error::other("not there"))).expect_err("did not start");
        assert_eq!(error, "nothing did not start: not there");
        let error =
            output_of("cargo", run::command("cargo", &["no-such-command"]).output()).expect_err("fails");
        assert!(error.starts_with("cargo failed (") && error.contains("no-such-command"), "{error}");
    }
}
