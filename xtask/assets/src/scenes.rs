//! `cargo xtask scenes`: the street of `assets/scenes/street`, made by code, byte for byte the same each time.

mod skies;
mod sky;
mod water;
mod weather;

use std::path::{Path, PathBuf};

use downpour_street::{Car, Street, StreetSettings, puddle_mask, textures};

use xtask::run;

use crate::files::{self, Asset};

/// The most bytes that the street may take, and the car that drives through it.
const BUDGET: usize = 15_000_000;
const CAR_BUDGET: usize = 200_000;
/// The most triangles of the street, with all copies.
const MAX_TRIANGLES: usize = 400_000;
/// Paint of the car that drives: red.
const PAINT: usize = 2;
/// The most texels of all textures, of four bytes each.
const MAX_TEXELS: usize = 25 << 20;

fn folder() -> PathBuf {
    run::root().join("assets/scenes/street")
}

/// The street that is shipped.
fn street() -> Result<Street, String> {
    Street::generate(&StreetSettings::default()).map_err(|error| error.to_string())
}

/// Every file of the folder.
fn make() -> Result<Vec<Asset>, String> {
    let street = street()?;
    if street.triangle_count() > MAX_TRIANGLES {
        return Err(format!(
            "the street has {} triangles, more than {MAX_TRIANGLES}",
            street.triangle_count()
        ));
    }
    let mut assets = Vec::new();
    let car = Car::new(PAINT).map_err(|error| error.to_string())?;
    let models = [street.to_gltf("street"), Street::window_opening().to_gltf("window"), car.to_gltf("car")];
    for file in models.into_iter().flatten() {
        assets.push((format!("models/{}", file.name), file.bytes));
    }
    let mut texels = 0;
    for file in textures().map_err(|error| error.to_string())? {
        texels += file.texel_count;
        assets.push((format!("models/textures/{}", file.name), file.bytes));
    }
    if texels > MAX_TEXELS {
        return Err(format!("textures have {texels} texels, more than {MAX_TEXELS}"));
    }
    let mask = puddle_mask().map_err(|error| error.to_string())?;
    assets.push(("pavement_puddle.png".to_owned(), mask));
    assets.extend(
        weather::make(&street).into_iter().map(|file| (file.name.to_owned(), file.text.into_bytes())),
    );
    for (what, is_car, most) in [("street", false, BUDGET), ("car", true, CAR_BUDGET)] {
        let own = assets.iter().filter(|(name, _)| name.starts_with("models/car") == is_car);
        let bytes = files::total(own);
        if bytes > most {
            return Err(format!("the {what} takes {bytes} bytes, more than {most}"));
        }
    }
    Ok(assets)
}

/// Writes `assets/skies` with pictures of the street, or compares them.
pub(crate) use skies::run as skies;

/// Writes the folder.
pub(crate) fn write() -> Result<(), String> {
    let street = street()?;
    let mut sorts: std::collections::BTreeMap<String, [usize; 2]> = std::collections::BTreeMap::new();
    for piece in street.pieces() {
        let sort = piece.name.split([' ', '{']).next().unwrap_or_default();
        let count = sorts.entry(sort.to_owned()).or_default();
        *count = [count[0] + piece.triangle_count(), count[1] + piece.copies.len()];
    }
    for (sort, [triangles, copies]) in sorts {
        println!("{triangles:>9} triangles  {copies:>4} x {sort}");
    }
    println!("{:>9} triangles", street.triangle_count());
    let (folder, assets) = (folder(), make()?);
    files::write(&folder, &assets)?;
    println!("{:>9} bytes in {} files", files::total(&assets), assets.len());
    match strangers(&folder, &assets)?.as_slice() {
        [] => Ok(()),
        more => {
            Err(format!("{} holds files that the code does not make: {}", folder.display(), more.join(", ")))
        }
    }
}

/// Compares the folder with generated files.
pub(crate) fn check() -> Result<(), String> {
    let (folder, assets) = (folder(), make()?);
    let mut wrong = files::differences(&folder, &assets);
    wrong
        .extend(strangers(&folder, &assets)?.iter().map(|name| format!("{name}: the code does not make it")));
    files::verdict("assets/scenes/street", "scenes", &wrong)
}

/// Files inside the folder that are not assets.
fn strangers(folder: &Path, assets: &[Asset]) -> Result<Vec<String>, String> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        let entries = std::fs::read_dir(&next).map_err(|error| format!("{}: {error}", next.display()))?;
        for path in entries.flatten().map(|entry| entry.path()) {
            if path.is_dir() {
                open.push(path);
                continue;
            }
            let name = path.strip_prefix(folder).map_err(|error| error.to_string())?;
            let name = name.to_string_lossy().replace('\\', "/");
            if !assets.iter().any(|(asset, _)| *asset == name) {
                found.push(name);
            }
        }
    }
    found.sort();
    Ok(found)
}
