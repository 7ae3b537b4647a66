//! Pictures of lattices: heights as grey, normals as the usual colours, masses as brightness.

use std::path::Path;

use downpour::render::file::{write_exr, write_png};

use super::Common;
use crate::failure::{Failure, INPUT, shown};
use crate::interrupt::Interrupt;
use crate::output::Place;
use crate::stream;

/// Where a picture goes, and in which format.
pub(super) struct Target {
    place: Place,
    exr: bool,
}

/// Numbers of all cells, and how they become grey or colours.
pub(super) struct Field {
    pub(super) size: [u32; 2],
    /// What an .exr holds: metres, units of mass, or parts of a unit vector.
    pub(super) numbers: Vec<[f32; 3]>,
    /// 0 to 1 from a number.
    pub(super) shade: fn(f32, f32) -> f32,
    /// What the shade is relative to.
    pub(super) scale: f32,
}

impl Target {
    /// The place of the picture that was asked for, if one was.
    ///
    /// # Errors
    /// Exit code 2 for another format, 5 for a file that exists.
    pub(super) fn new(common: &Common) -> Result<Option<Self>, Failure> {
        let Some(path) = &common.output else { return Ok(None) };
        let exr = match path.extension().and_then(|end| end.to_str()).map(str::to_lowercase).as_deref() {
            Some("exr") => true,
            Some("png") => false,
            _ => return Err(Failure::new(INPUT, format!("output {}; allowed: .png or .exr", shown(path)))),
        };
        Ok(Some(Self { place: Place::new(path, common.overwrite)?, exr }))
    }

    /// Writes the picture.
    ///
    /// # Errors
    /// What the encoder or the file system says.
    pub(super) fn write(
        &self,
        field: &Field,
        path: &Path,
        quiet: bool,
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        let [width, height] = field.size;
        let bytes = if self.exr {
            write_exr(width, height, &field.numbers)?
        } else {
            let byte = |number| (255.0 * (field.shade)(number, field.scale)).clamp(0.0, 255.0) as u8;
            let pixels: Vec<[u8; 3]> = field.numbers.iter().map(|cell| cell.map(byte)).collect();
            write_png(width, height, &pixels)?
        };
        self.place.publish(&bytes, interrupt)?;
        if !quiet {
            stream::message(&format!("wrote {}: {width} x {height}", shown(path)));
        }
        Ok(())
    }
}
