//! Pictures of lattices: heights in gray, normals in the usual colors, masses as brightness.

use downpour::render::file::{write_exr, write_png};

use super::Common;
use crate::commands::pattern::Pattern;
use crate::failure::{Failure, INPUT, shown};
use crate::interrupt::Interrupt;
use crate::output::{OutputFile, remove_leftovers};
use crate::stream;

/// The most pictures of a clip.
const MAX_PICTURES: u64 = 1_000_000;

/// Paths of the pictures, their format, and their steps.
pub(super) struct Target {
    names: Names,
    shown: String,
    exr: bool,
    quiet: bool,
    steps: u64,
    /// The largest scale so far: a clip must not flicker.
    scale: f32,
}

/// One picture after the last step, or one every few steps.
enum Names {
    One(OutputFile),
    Numbered { pattern: Pattern, every: u64, overwrite: bool },
}

/// Values of all cells, and their mapping to gray or colors.
pub(super) struct Field {
    pub(super) size: [u32; 2],
    /// Values in an .exr: meters, units of mass, or components of a unit vector.
    pub(super) numbers: Vec<[f32; 3]>,
    /// 0 to 1 from a number.
    pub(super) shade: fn(f32, f32) -> f32,
    /// Reference value of the shade.
    pub(super) scale: f32,
}

impl Target {
    /// Paths of the requested pictures, if any.
    ///
    /// # Errors
    /// Exit code 2 for another format, a name without a number for many, or too many; 5 for a file that exists.
    pub(super) fn new(common: &Common, steps: u64) -> Result<Option<Self>, Failure> {
        let Some(path) = &common.output else { return Ok(None) };
        let exr = match path.extension().and_then(|end| end.to_str()).map(str::to_lowercase).as_deref() {
            Some("exr") => true,
            Some("png") => false,
            _ => return Err(Failure::new(INPUT, format!("output {}; allowed: .png or .exr", shown(path)))),
        };
        let overwrite = common.overwrite;
        let names = match common.every {
            Some(every) => {
                let pattern = Pattern::parse(path)?;
                let last = steps / every;
                if last >= MAX_PICTURES {
                    let found = format!("--every {every} of {steps} steps: {} pictures", last + 1);
                    return Err(Failure::new(INPUT, format!("{found}; allowed: at most {MAX_PICTURES}")));
                }
                for number in 0..=last as u32 {
                    OutputFile::new(&pattern.path(number), overwrite)?;
                }
                remove_leftovers(pattern.folder());
                Names::Numbered { pattern, every, overwrite }
            }
            None => Names::One(OutputFile::new(path, overwrite)?),
        };
        Ok(Some(Self { names, shown: shown(path), exr, quiet: common.quiet, steps, scale: 0.0 }))
    }

    /// True if there is a picture after `done` steps.
    pub(super) fn is_due(&self, done: u64) -> bool {
        match &self.names {
            Names::One(_) => done == self.steps,
            Names::Numbered { every, .. } => done.is_multiple_of(*every),
        }
    }

    /// Number of steps to the next picture: at least 1.
    pub(super) fn steps_to_next(&self, done: u64) -> u64 {
        match &self.names {
            Names::One(_) => self.steps.saturating_sub(done).max(1),
            Names::Numbered { every, .. } => every - done % every,
        }
    }

    /// Writes the picture after `done` steps.
    ///
    /// # Errors
    /// Error of the encoder or the file system.
    pub(super) fn write(&mut self, field: &Field, done: u64, interrupt: &Interrupt) -> Result<(), Failure> {
        let [width, height] = field.size;
        self.scale = self.scale.max(field.scale);
        let bytes = if self.exr {
            write_exr(width, height, &field.numbers)?
        } else {
            let byte = |number| (255.0 * (field.shade)(number, self.scale)).clamp(0.0, 255.0) as u8;
            let pixels: Vec<[u8; 3]> = field.numbers.iter().map(|cell| cell.map(byte)).collect();
            write_png(width, height, &pixels)?
        };
        let pictures = match &self.names {
            Names::One(file) => {
                file.publish(&bytes, interrupt)?;
                String::new()
            }
            Names::Numbered { pattern, every, overwrite } => {
                let number = (done / every) as u32;
                OutputFile::new(&pattern.path(number), *overwrite)?.publish_among_many(&bytes, interrupt)?;
                format!(", {} pictures", number + 1)
            }
        };
        // Of a clip only the end is printed.
        if !self.quiet && done + self.steps_to_next(done) > self.steps {
            stream::message(&format!("wrote {}: {width} x {height}{pictures}", self.shown));
        }
        Ok(())
    }
}
