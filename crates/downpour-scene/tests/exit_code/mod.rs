//! Kinds of errors as the numbers that the command ends with.

use downpour_scene::SceneError;

/// The kind of an error as a number.
pub(crate) trait ExitCode {
    /// 2: bad input; 3: over a limit; 5: a file that cannot be read.
    fn exit_code(&self) -> u8;
}

impl ExitCode for SceneError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::OverLimit(_) => 3,
            Self::Unreadable(_) => 5,
            _ => 2,
        }
    }
}
