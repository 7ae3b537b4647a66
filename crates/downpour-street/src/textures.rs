//! The textures of the street: tiles of ground and walls, rooms, leaves and signs.

mod facade;
mod ground;
mod leaves;
mod metal;
mod rooms;
mod sign;

use rayon::prelude::*;

use crate::error::StreetError;
use crate::raster::{Format, Raster};

pub(crate) use facade::{ASHLAR_M, BRICK_M, CLOTH_M, JOINERY_M, PLASTER_M, ROOF_M};
pub(crate) use ground::{ASPHALT_M, COVER_M, CURB_M, SETTS_M, SLABS_M};
pub(crate) use leaves::TWIGS;
pub(crate) use metal::{IRON_M, ZINC_M};
pub(crate) use rooms::{CURTAINS, VIEWS};
pub(crate) use sign::SIGNS;

/// A picture to be written to a file.
#[derive(Clone, Debug)]
pub struct TextureFile {
    /// Name of the file.
    pub name: &'static str,
    /// Bytes of the file.
    pub bytes: Vec<u8>,
    /// Number of texels.
    pub texel_count: usize,
}

/// A texture: name, format, and the function that draws it.
type Drawing = (&'static str, Format, fn() -> Raster);

const DRAWINGS: [Drawing; 46] = [
    ("asphalt_color.jpg", Format::GrayColor, || ground::asphalt().color),
    ("asphalt_normal.jpg", Format::Data, || ground::asphalt().height.normals(ASPHALT_M)),
    ("asphalt_roughness.jpg", Format::GrayData, || ground::asphalt().roughness),
    ("slabs_color.jpg", Format::Color, || ground::slabs().color),
    ("slabs_normal.jpg", Format::Data, || ground::slabs().height.normals(SLABS_M)),
    ("slabs_roughness.jpg", Format::GrayData, || ground::slabs().roughness),
    ("setts_color.jpg", Format::Color, || ground::setts().color),
    ("setts_normal.jpg", Format::Data, || ground::setts().height.normals(SETTS_M)),
    ("setts_roughness.jpg", Format::GrayData, || ground::setts().roughness),
    ("curb_color.jpg", Format::Color, || ground::curb().color),
    ("curb_normal.jpg", Format::Data, || ground::curb().height.normals(CURB_M)),
    ("cover_normal.jpg", Format::Data, || ground::cover().normals(COVER_M)),
    ("brick_color.jpg", Format::Color, || facade::brick(&facade::RED).color),
    ("brick_pale_color.jpg", Format::Color, || facade::brick(&facade::PALE).color),
    ("brick_normal.jpg", Format::Data, || facade::brick(&facade::RED).height.normals(BRICK_M)),
    ("brick_roughness.jpg", Format::GrayData, || facade::brick(&facade::RED).roughness),
    ("plaster_color.jpg", Format::Color, || facade::plaster().color),
    ("plaster_normal.jpg", Format::Data, || facade::plaster().height.normals(PLASTER_M)),
    ("plaster_roughness.jpg", Format::GrayData, || facade::plaster().roughness),
    ("ashlar_color.jpg", Format::Color, || facade::ashlar().color),
    ("ashlar_normal.jpg", Format::Data, || facade::ashlar().height.normals(ASHLAR_M)),
    ("ashlar_roughness.jpg", Format::GrayData, || facade::ashlar().roughness),
    ("stone_color.jpg", Format::GrayColor, || facade::stone().color),
    ("stone_normal.jpg", Format::Data, || facade::stone().height.normals(0.8)),
    ("stone_roughness.jpg", Format::GrayData, || facade::stone().roughness),
    ("roof_color.jpg", Format::GrayColor, || facade::roof_tiles().color),
    ("roof_normal.jpg", Format::Data, || facade::roof_tiles().height.normals(ROOF_M)),
    ("roof_roughness.jpg", Format::GrayData, || facade::roof_tiles().roughness),
    ("zinc_color.jpg", Format::GrayColor, || metal::zinc().color),
    ("zinc_normal.jpg", Format::Data, || metal::zinc().height.normals(ZINC_M)),
    ("zinc_roughness.jpg", Format::Data, || metal::zinc().roughness),
    ("iron_color.jpg", Format::Color, || metal::iron().color),
    ("iron_roughness.jpg", Format::GrayData, || metal::iron().roughness),
    ("joinery_color.jpg", Format::GrayColor, || facade::joinery().color),
    ("joinery_normal.jpg", Format::Data, || facade::joinery().height.normals(JOINERY_M)),
    ("joinery_roughness.jpg", Format::GrayData, || facade::joinery().roughness),
    ("wood_color.jpg", Format::GrayColor, || facade::wood().color),
    ("wood_roughness.jpg", Format::GrayData, || facade::wood().roughness),
    ("cloth_color.jpg", Format::GrayColor, || facade::cloth().color),
    ("cloth_normal.jpg", Format::Data, || facade::cloth().height.normals(CLOTH_M)),
    ("room_color.jpg", Format::Color, rooms::by_day),
    ("room_lit.jpg", Format::Color, rooms::lit),
    ("curtain_color.jpg", Format::Color, rooms::curtains),
    ("bark_color.jpg", Format::GrayColor, leaves::bark),
    ("leaves.png", Format::Cutout, leaves::leaves),
    ("signs_color.jpg", Format::Color, sign::signs),
];

/// Makes all textures, in a fixed order.
///
/// # Errors
/// [`StreetError::Texture`] if one cannot be encoded.
pub fn textures() -> Result<Vec<TextureFile>, StreetError> {
    DRAWINGS
        .par_iter()
        .map(|&(name, format, draw)| {
            let raster = draw();
            let bytes = raster
                .encode(format)
                .map_err(|problem| StreetError::Texture { name: name.to_owned(), problem })?;
            Ok(TextureFile { name, bytes, texel_count: raster.texel_count() })
        })
        .collect()
}

/// Depth of a puddle that is painted on the pavement, 1.3 x 4 m: a gray picture of 128 x 384.
///
/// # Errors
/// [`StreetError::Texture`] if it cannot be encoded.
pub fn puddle_mask() -> Result<Vec<u8>, StreetError> {
    let name = "pavement_puddle.png".to_owned();
    ground::puddle().encode(Format::Mask).map_err(|problem| StreetError::Texture { name, problem })
}

/// A surface as a tile: its color, its height in meters, its roughness.
pub(crate) struct Tile {
    pub(crate) color: Raster,
    pub(crate) height: Raster,
    pub(crate) roughness: Raster,
}

impl Tile {
    /// A tile whose roughness is that of its material alone.
    fn plain(color: Raster, height: Raster) -> Self {
        Self { color, height, roughness: Raster::gray(8, 8, |_, _| 1.0) }
    }

    /// A tile without relief.
    fn flat(color: Raster, roughness: Raster) -> Self {
        Self { color, height: Raster::gray(8, 8, |_, _| 0.0), roughness }
    }
}
