//! Why the command did not do what was asked, and the exit code that says so.

use std::fmt;
use std::io;
use std::path::Path;

use downpour::RendererError;
use downpour::atlas::AtlasError;
use downpour::drop::DropError;
use downpour::lattice::LatticeError;
use downpour::lattice::glass::GlassError;
use downpour::mask::MaskError;
use downpour::render::RenderError;
use downpour::render::glass::PaneError;
use downpour::scene::SceneError;
use downpour::shower::ShowerError;
use downpour::sim::SimError;
use downpour::specimen::SpecimenError;
use downpour::trace::puddle::PuddleError;
use downpour::trace::stage::StageError;
use downpour::wind::WindError;

/// Anything that has no code of its own, as a defect of ours.
pub(crate) const OTHER: u8 = 1;
/// Bad arguments or input.
pub(crate) const INPUT: u8 = 2;
/// Over a limit.
pub(crate) const LIMIT: u8 = 3;
/// No GPU, or a GPU that was lost, hangs or has no memory left. Where there are GPUs, their errors know it themselves.
#[cfg(not(feature = "gpu"))]
pub(crate) const GPU: u8 = 4;
/// A file that cannot be read or written.
pub(crate) const FILES: u8 = 5;
/// Cancelled by a signal.
#[cfg(unix)]
pub(crate) const CANCELLED: u8 = 6;

/// A message of one line, and an exit code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Failure {
    pub(crate) code: u8,
    message: String,
}

impl Failure {
    pub(crate) fn new(code: u8, message: impl Into<String>) -> Self {
        Self { code, message: message.into() }
    }

    /// A file that the system does not let us write.
    pub(crate) fn file(path: &Path, error: &io::Error) -> Self {
        // The innermost error is the system's own; what is around it names the temporary file.
        let mut inner: &dyn std::error::Error = error;
        while let Some(source) = inner.source() {
            inner = source;
        }
        Self::new(FILES, format!("{}: {inner}", shown(path)))
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl From<DropError> for Failure {
    fn from(error: DropError) -> Self {
        Self::new(INPUT, error.to_string())
    }
}

impl From<GlassError> for Failure {
    fn from(error: GlassError) -> Self {
        Self::new(error.exit_code(), error.to_string())
    }
}

impl From<PaneError> for Failure {
    fn from(error: PaneError) -> Self {
        Self::new(error.exit_code(), error.to_string())
    }
}

impl From<PuddleError> for Failure {
    fn from(error: PuddleError) -> Self {
        match error {
            PuddleError::Lattice(error) => error.into(),
            PuddleError::Rain(error) => error.into(),
            error => Self::new(INPUT, error.to_string()),
        }
    }
}

impl From<LatticeError> for Failure {
    fn from(error: LatticeError) -> Self {
        Self::new(error.exit_code(), error.to_string())
    }
}

impl From<AtlasError> for Failure {
    fn from(error: AtlasError) -> Self {
        Self::new(error.exit_code(), error.to_string())
    }
}

impl From<MaskError> for Failure {
    fn from(error: MaskError) -> Self {
        Self::new(error.exit_code(), error.to_string())
    }
}

impl From<SpecimenError> for Failure {
    fn from(error: SpecimenError) -> Self {
        Self::new(error.exit_code(), error.to_string())
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        Self::new(error.exit_code(), error.to_string())
    }
}

impl From<ShowerError> for Failure {
    fn from(error: ShowerError) -> Self {
        Self::new(error.exit_code(), error.to_string())
    }
}

impl From<StageError> for Failure {
    fn from(error: StageError) -> Self {
        Self::new(error.exit_code(), error.to_string())
    }
}

impl From<RendererError> for Failure {
    fn from(error: RendererError) -> Self {
        let code = error.exit_code();
        match error {
            // A library has no option of this name.
            RendererError::NoAtlas => no_atlas(),
            error => Self::new(code, error.to_string()),
        }
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        Self::new(error.exit_code(), error.to_string())
    }
}

impl From<SimError> for Failure {
    fn from(error: SimError) -> Self {
        Self::new(error.exit_code(), error.to_string())
    }
}

impl From<WindError> for Failure {
    fn from(error: WindError) -> Self {
        Self::new(error.exit_code(), error.to_string())
    }
}

/// What `render` does where it is not said where the atlas is: it ends with exit code 2.
pub(crate) fn no_atlas() -> Failure {
    let found = "streaks.colour is \"atlas\" or \"atlas-random\", and no --streaks";
    let allowed = "with --streaks FOLDER, where the streak atlas is";
    Failure::new(INPUT, format!("{found}; allowed: {allowed}"))
}

impl From<&clap::Error> for Failure {
    /// clap writes paragraphs: what is wrong, tips, the usage. The first ones are kept, as one line.
    fn from(error: &clap::Error) -> Self {
        use clap::error::ErrorKind;
        let text = error.to_string();
        if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
            return Self::new(INPUT, "no subcommand; `downpour --help` lists them");
        }
        let end = ["\n\nUsage:", "\n\nFor more information"].iter().filter_map(|mark| text.find(mark)).min();
        let kept = &text[..end.unwrap_or(text.len())];
        let kept = kept.strip_prefix("error: ").unwrap_or(kept);
        let paragraphs = kept.split("\n\n").map(|part| part.split_whitespace().collect::<Vec<_>>().join(" "));
        Self::new(INPUT, paragraphs.collect::<Vec<_>>().join("; "))
    }
}

/// A path in a message. A very long one is shown by its ends.
pub(crate) fn shown(path: &Path) -> String {
    const END: usize = 100;
    let text: Vec<char> = path.to_string_lossy().chars().collect();
    if text.len() <= 2 * END {
        return text.into_iter().collect();
    }
    let (head, tail) = (&text[..END], &text[text.len() - END..]);
    format!("{}...{}", head.iter().collect::<String>(), tail.iter().collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_paths_are_shown_by_their_ends() {
        assert_eq!(shown(Path::new("a/b.exr")), "a/b.exr");
        let long = format!("begin/{}/end.exr", "x".repeat(70_000));
        let short = shown(Path::new(&long));
        assert_eq!(short.chars().count(), 203);
        assert!(short.starts_with("begin/xx") && short.ends_with("x/end.exr"), "{short}");
    }
}
