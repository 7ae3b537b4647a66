//! `render --watch`: the picture is made again when its weather file changes.

use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

use super::RenderArguments;
use super::job::digest;
use super::outputs::Outputs;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::stream;

/// Time between two looks at the file.
const INTERVAL: Duration = Duration::from_millis(250);

/// Makes the picture, and again at each change of the file, until a signal ends the process. A file that is broken prints its
/// error, and the last good picture stays.
///
/// # Errors
/// Exit codes 2 and 5 for output files that cannot be written at all.
pub(super) fn run(arguments: &RenderArguments, interrupt: &Interrupt) -> Result<(), Failure> {
    let (stats, drops) = (arguments.stats.as_deref(), arguments.dump_drops.as_deref());
    let outputs = Outputs::new(&arguments.output, stats, drops, arguments.overwrite)?;
    arguments.check_layers(outputs.format)?;
    let mut overwrite = arguments.overwrite;
    let mut last = None;
    loop {
        // The file may change while it is drawn: it has its new digest then.
        let now = digest_of(&arguments.input.input);
        if last.as_ref() != Some(&now) {
            last = Some(now);
            match arguments.picture(overwrite, interrupt) {
                // From now on the picture is this command's own.
                Ok(()) => overwrite = true,
                Err(failure) => stream::message(&format!("error: {failure}")),
            }
        }
        sleep(INTERVAL);
    }
}

/// Digest of a file; `None` where it cannot be read.
fn digest_of(path: &Path) -> Option<String> {
    fs::read(path).ok().map(|bytes| digest(&bytes))
}
