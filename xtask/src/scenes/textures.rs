//! The textures of the street: every file of `assets/scenes/street/models/textures`.

mod facade;
mod ground;
mod leaves;
mod panes;
mod sign;

use super::raster::{Format, Raster};

pub(super) use facade::{BRICK_M, PLASTER_M, ROOF_M};
pub(super) use ground::{ASPHALT_M, COVER_M, CURB_M, SETTS_M, SLABS_M};
pub(super) use panes::VIEWS as PANE_VIEWS;

/// A picture to be written to a file.
pub(super) struct TextureFile {
    /// Name in the folder of textures.
    pub(super) name: &'static str,
    /// Bytes of the file.
    pub(super) bytes: Vec<u8>,
}

/// Makes all textures.
pub(super) fn make() -> Result<Vec<TextureFile>, String> {
    let file = |name: &'static str, raster: &Raster, format: Format| {
        let bytes = raster.encode(format).map_err(|error| format!("{name}: {error}"))?;
        Ok(TextureFile { name, bytes })
    };
    let asphalt = ground::asphalt();
    let slabs = ground::slabs();
    let setts = ground::setts();
    let brick = facade::brick(&facade::RED);
    let roof = facade::roof_tiles();
    let plaster = facade::plaster();
    let stone = facade::stone();
    let panes = panes::panes();
    [
        file("asphalt_color.jpg", &asphalt.color, Format::GrayColor),
        file("asphalt_normal.jpg", &asphalt.height.normals(ground::ASPHALT_M), Format::Data),
        file("asphalt_roughness.jpg", &asphalt.roughness, Format::GrayData),
        file("slabs_color.jpg", &slabs.color, Format::Color),
        file("slabs_normal.jpg", &slabs.height.normals(ground::SLABS_M), Format::Data),
        file("slabs_roughness.jpg", &slabs.roughness, Format::GrayData),
        file("setts_color.jpg", &setts.color, Format::Color),
        file("setts_normal.jpg", &setts.height.normals(ground::SETTS_M), Format::Data),
        file("kerb_color.jpg", &ground::curb(), Format::Color),
        file("cover_normal.jpg", &ground::cover().normals(ground::COVER_M), Format::Data),
        file("brick_color.jpg", &brick.color, Format::Color),
        file("brick_pale_color.jpg", &facade::brick(&facade::PALE).color, Format::Color),
        file("brick_normal.jpg", &brick.height.normals(facade::BRICK_M), Format::Data),
        file("plaster_color.jpg", &plaster.color, Format::GrayColor),
        file("plaster_normal.jpg", &plaster.height.normals(facade::PLASTER_M), Format::Data),
        file("stone_color.jpg", &stone, Format::GrayColor),
        file("roof_color.jpg", &roof.color, Format::GrayColor),
        file("roof_normal.jpg", &roof.height.normals(facade::ROOF_M), Format::Data),
        file("wood_color.jpg", &facade::wood(), Format::GrayColor),
        file("panes_color.jpg", &panes.by_day, Format::Color),
        file("panes_lit.jpg", &panes.lit, Format::Color),
        file("bark_color.jpg", &leaves::bark(), Format::GrayColor),
        file("leaves.png", &leaves::leaves(), Format::Cutout),
        file(
            "sign_books.jpg",
            &sign::sign("BOOKS", [0.78, 0.66, 0.36], [0.018, 0.045, 0.035]),
            Format::Color,
        ),
        file("sign_cafe.jpg", &sign::sign("CAFE", [0.80, 0.76, 0.66], [0.09, 0.022, 0.018]), Format::Color),
    ]
    .into_iter()
    .collect()
}

/// Depth of a puddle that is painted on the pavement, 1.3 x 4 m: a gray picture of 128 x 384.
pub(super) fn puddle_mask() -> Result<Vec<u8>, String> {
    ground::puddle().encode(Format::Mask)
}

/// A surface as a tile: its color, its height in meters, its roughness.
pub(super) struct Tile {
    pub(super) color: Raster,
    pub(super) height: Raster,
    pub(super) roughness: Raster,
}
