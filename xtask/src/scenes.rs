//! `cargo xtask scenes`: the street of `assets/scenes/street`, made by code, byte for byte the same each time.

mod car;
mod furniture;
mod gltf;
mod ground;
mod house;
mod material;
mod mesh;
mod model;
mod noise;
mod raster;
mod skies;
mod sky;
mod street;
mod textures;
mod weather;

use std::path::{Path, PathBuf};

use crate::run;
use model::Model;

/// The most bytes that the street may take.
const BUDGET: usize = 4_000_000;

type Asset = (String, Vec<u8>);

fn folder() -> PathBuf {
    run::root().join("assets/scenes/street")
}

fn models() -> Vec<Model> {
    vec![
        street::street(),
        car::car(),
        furniture::lamp(),
        furniture::tree(),
        furniture::bench(),
        furniture::bollard(),
        furniture::bin_and_sign(),
        furniture::window_frame(),
    ]
}

/// Every file of the folder.
fn make() -> Result<Vec<Asset>, String> {
    let mut assets = Vec::new();
    for model in models() {
        assets.extend(
            gltf::files(&model).into_iter().map(|file| (format!("models/{}", file.name), file.bytes)),
        );
    }
    for file in textures::make()? {
        assets.push((format!("models/textures/{}", file.name), file.bytes));
    }
    assets.push(("pavement_puddle.png".to_owned(), textures::puddle_mask()?));
    assets.extend(weather::make().into_iter().map(|file| (file.name.to_owned(), file.text.into_bytes())));
    let bytes: usize = assets.iter().map(|(_, bytes)| bytes.len()).sum();
    if bytes > BUDGET {
        return Err(format!("the street takes {bytes} bytes, more than {BUDGET}"));
    }
    Ok(assets)
}

/// Writes `assets/skies` with pictures of the street, or compares them.
pub(crate) use skies::run as skies;

/// Writes the folder.
pub(crate) fn write() -> Result<(), String> {
    for model in models() {
        println!("{:>9} triangles  {}", model.triangle_count(), model.name);
    }
    let (folder, assets) = (folder(), make()?);
    for (name, bytes) in &assets {
        let path = folder.join(name);
        save(&path, bytes).map_err(|error| format!("{}: {error}", path.display()))?;
        println!("{:>9} bytes  {}", bytes.len(), path.display());
    }
    let bytes: usize = assets.iter().map(|(_, bytes)| bytes.len()).sum();
    println!("{bytes:>9} bytes in {} files", assets.len());
    match strangers(&folder, &assets)?.as_slice() {
        [] => Ok(()),
        more => {
            Err(format!("{} holds files that the code does not make: {}", folder.display(), more.join(", ")))
        }
    }
}

fn save(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    if let Some(parent) = path.parent() {
        std::fs::create_dir_all(parent)?;
    }
    let part = path.with_extension("part");
    std::fs::write(&part, bytes)?;
    std::fs::rename(&part, path)
}

/// Compares the folder with generated files.
pub(crate) fn check() -> Result<(), String> {
    let (folder, assets) = (folder(), make()?);
    let mut wrong = Vec::new();
    for (name, bytes) in &assets {
        match std::fs::read(folder.join(name)) {
            Ok(kept) if kept == *bytes => {}
            Ok(kept) => {
                wrong.push(format!("{name}: differs ({} bytes kept, {} made)", kept.len(), bytes.len()));
            }
            Err(error) => wrong.push(format!("{name}: {error}")),
        }
    }
    wrong
        .extend(strangers(&folder, &assets)?.iter().map(|name| format!("{name}: the code does not make it")));
    if wrong.is_empty() {
        println!("assets/scenes/street is equal to the generated files, byte for byte");
        Ok(())
    } else {
        Err(format!(
            "assets/scenes/street differs from the generated files (cargo xtask scenes):\n  {}",
            wrong.join("\n  ")
        ))
    }
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
