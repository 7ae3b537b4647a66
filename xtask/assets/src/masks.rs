//! assets/masks: written by `cargo xtask masks` and compared by `--check`, byte for byte.

use std::path::PathBuf;

use downpour_drop::DropShape;
use downpour_mask::file::{exr, ktx2, png};
use downpour_mask::{Mask, MaskOptions, trace_drop};

use xtask::run;

use crate::files::{self, Asset};

/// Diameters of the texture array in millimeters: the range of natural rain, denser where shape changes fast.
const ARRAY_MM: [f64; 10] = [0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0];
/// Texels along an edge of the array's masks. A drop drawn with its mask is a hundred pixels wide at most.
const ARRAY_SIZE: u32 = 128;
/// Diameters of the single masks: undistorted radii 0.5, 1, 3 and 4.5 mm, of which Rousseau 2006 prints the shapes.
const SINGLE_MM: [f64; 4] = [1.0, 2.0, 6.0, 9.0];
/// Texels along an edge of the single masks, as in Rousseau 2006.
const SINGLE_SIZE: u32 = 512;
/// The most bytes that the folder may hold.
const BUDGET: usize = 8 << 20;

fn folder() -> PathBuf {
    run::root().join("assets/masks")
}

fn mask(diameter_mm: f64, size: u32) -> Result<Mask, String> {
    let shape = DropShape::new(diameter_mm * 1.0e-3).map_err(|error| error.to_string())?;
    trace_drop(&shape, &MaskOptions { size, ..MaskOptions::default() }).map_err(|error| error.to_string())
}

/// Every file of the folder that the code makes.
fn make() -> Result<Vec<Asset>, String> {
    let to_error = |error: downpour_mask::MaskError| error.to_string();
    let array = ARRAY_MM.iter().map(|&d| mask(d, ARRAY_SIZE)).collect::<Result<Vec<_>, _>>()?;
    let mut assets = vec![("drops.ktx2".to_owned(), ktx2::write_ktx2(&array).map_err(to_error)?)];
    for d in SINGLE_MM {
        let single = mask(d, SINGLE_SIZE)?;
        assets.push((
            format!("drop_{d}mm.exr"),
            exr::write_exr(&single, exr::Precision::Half).map_err(to_error)?,
        ));
        assets.push((format!("drop_{d}mm.png"), png::write_png(&single).map_err(to_error)?));
    }
    let bytes = files::total(&assets);
    if bytes > BUDGET {
        return Err(format!("the masks take {bytes} bytes, more than {BUDGET}"));
    }
    Ok(assets)
}

/// Writes the folder.
pub(crate) fn write() -> Result<(), String> {
    files::write(&folder(), &make()?)
}

/// Compares the folder with generated files.
pub(crate) fn check() -> Result<(), String> {
    files::verdict("assets/masks", "masks", &files::differences(&folder(), &make()?))
}
