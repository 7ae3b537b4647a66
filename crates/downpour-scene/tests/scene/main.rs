//! Whole scenes: contents agree with the file, motion agrees with the formulas, and bad input has
//! its exit code and its message.

mod bad;
#[path = "../document/mod.rs"]
mod document;
#[path = "../exit_code/mod.rs"]
mod exit_code;
mod figure;
mod materials;
mod moving;
mod shapes;

use document::{check_message, data_uri};
use downpour_scene::gltf::read_scene_from_bytes;
use downpour_scene::sandbox::NoFiles;
use downpour_scene::scene::Scene;
use downpour_scene::{Budget, SceneError};
use serde_json::Value;

fn read(document: &Value) -> Result<Scene, SceneError> {
    let scene =
        read_scene_from_bytes("test", document.to_string().as_bytes(), &NoFiles, &mut Budget::default());
    match &scene {
        Ok(scene) => {
            document::check_scene(scene);
            scene.warnings.iter().for_each(|warning| check_message(&warning.to_string()));
        }
        Err(error) => check_message(&error.to_string()),
    }
    scene
}

fn good(document: &Value) -> Scene {
    read(document).unwrap_or_else(|error| panic!("{error}"))
}

fn warned(scene: &Scene, words: &str) {
    let said: Vec<String> = scene.warnings.iter().map(ToString::to_string).collect();
    assert!(said.iter().any(|line| line.contains(words)), "{words:?} is not in {said:?}");
}

/// A PNG of 2 x 1 pixels, red and green.
fn png() -> Vec<u8> {
    let mut bytes = Vec::new();
    let pixels = image::RgbaImage::from_raw(2, 1, vec![255, 0, 0, 255, 0, 255, 0, 128]).expect("two pixels");
    pixels.write_to(&mut std::io::Cursor::new(&mut bytes), image::ImageFormat::Png).expect("a PNG");
    bytes
}

fn png_uri() -> String {
    data_uri(&png()).replace("application/octet-stream", "image/png")
}
