//! Scenes of glTF 2.0 files, and their triangles alone in world space.
//!
//! Source: Khronos Group, "glTF 2.0 Specification", version 2.0.1 (ISO/IEC 12113:2022). Axes are glTF's:
//! right-handed, +Y up, meters; front faces are counter-clockwise.
//!
//! The order is check, then parse (the module `guard`): the JSON is read as plain values, the whole document is checked
//! on them, and only then are the typed objects created and the buffers opened. Supported are accessors of any component
//! type (normalized and quantized integers too), sparse substitution, triangle lists, strips and fans, and node
//! transforms in double precision. Points and lines are skipped, with a warning.
//!
//! [`read_scene`] reads all of it: materials with their textures, skins, morph targets, animations, lights and
//! cameras. [`read_triangles`] reads only the triangles at rest, unposed and without morph targets, and opens no
//! images.

mod accessor;
mod assembly;
mod buffers;
mod container;
mod document;
mod growth;
mod guard;
mod instances;
mod json;
mod model;
mod normals;
mod plan;
mod posed;
mod scenes;
mod triangles;

use crate::error::{SceneError, shown_path, size};
use crate::sandbox::{Files, Folder, open_named};
use crate::scene::Scene;
use crate::warning::{WarningKind, Warnings};
use crate::{Budget, magic};
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

pub use crate::scene::REACH;
pub use model::TriangleModel;

/// The largest file that is looked at, in bytes: 256 MiB, buffers beside it not counted.
pub const MAX_FILE: u64 = 256 << 20;

/// The largest number of elements of one accessor.
pub const MAX_ELEMENTS: u64 = 50_000_000;

/// Maximum nesting depth of nodes.
pub const MAX_DEPTH: u32 = 256;

/// Reads the triangles of a `.gltf` or `.glb` file; buffers are opened in its folder only.
///
/// The budget is lowered by the size of the model. A file without triangles is not an error: the model is
/// empty and has a warning of the kind [`WarningKind::Empty`].
///
/// # Errors
/// [`SceneError`]: the file cannot be read, is not a glTF 2.0 file that Downpour can read, or is too large.
///
/// ```no_run
/// use downpour_scene::{Budget, gltf::read_triangles};
/// let mut budget = Budget::default();
/// let model = read_triangles("street/lamp.gltf".as_ref(), &mut budget)?.strict()?;
/// assert!(model.indices.iter().flatten().all(|&i| (i as usize) < model.positions.len()));
/// # Ok::<(), downpour_scene::SceneError>(())
/// ```
pub fn read_triangles(path: &Path, budget: &mut Budget) -> Result<TriangleModel, SceneError> {
    with_file(path, budget, read_triangles_from_bytes)
}

/// Reads the triangles of a glTF file in memory; `files` opens the buffers that it names.
///
/// `name` is the name of the file in messages.
///
/// # Errors
/// As [`read_triangles`].
///
/// ```
/// use downpour_scene::{Budget, WarningKind, sandbox::NoFiles, gltf::read_triangles_from_bytes};
/// let json = br#"{"asset": {"version": "2.0"}}"#;
/// let model = read_triangles_from_bytes("empty.gltf", json, &NoFiles, &mut Budget::default())?;
/// assert!(model.is_empty() && model.warnings[0].kind == WarningKind::Empty);
/// # Ok::<(), downpour_scene::SceneError>(())
/// ```
pub fn read_triangles_from_bytes(
    name: &str,
    bytes: &[u8],
    files: &dyn Files,
    budget: &mut Budget,
) -> Result<TriangleModel, SceneError> {
    let read = |remaining: &mut Budget| {
        let mut warnings = Warnings::default();
        let (mut checked, binary) = open(bytes, remaining, &mut warnings)?;
        let root = document::typed(&mut checked)?;
        let buffers = buffers::load(&root, binary, files, remaining)?;
        let source = (bytes.len() as u64).saturating_add(buffers.from_files);
        triangles::gather(&root, &buffers, source, remaining, warnings)
    };
    // Temporary memory of the reader is returned: the caller pays for the model alone.
    let mut remaining = *budget;
    let mut model = read(&mut remaining).map_err(|error| error.in_file(name))?;
    budget.bytes = budget.bytes.saturating_sub(model.bytes());
    budget.vertices = budget.vertices.saturating_sub(model.positions.len() as u64);
    budget.nodes = remaining.nodes;
    name.clone_into(&mut model.name);
    Ok(model)
}

/// Reads a whole scene from a `.gltf` or `.glb` file; buffers and images are opened in its folder only.
///
/// The budget is lowered by the size of the scene. A file without triangles is not an error.
///
/// # Errors
/// [`SceneError`]: the file, or one that it names, cannot be read, is not supported, or is too large.
///
/// ```no_run
/// use downpour_scene::{Budget, gltf::read_scene};
/// let scene = read_scene("street/lamp.gltf".as_ref(), &mut Budget::default())?;
/// let pose = scene.pose(None, 0.0);
/// println!("{} meshes, {} lights", pose.instances.len(), pose.lights.len());
/// # Ok::<(), downpour_scene::SceneError>(())
/// ```
pub fn read_scene(path: &Path, budget: &mut Budget) -> Result<Scene, SceneError> {
    with_file(path, budget, read_scene_from_bytes)
}

/// Reads a whole scene from a glTF file in memory; `files` opens the buffers and images that it names.
///
/// `name` is the name of the file in messages.
///
/// # Errors
/// As [`read_scene`].
///
/// ```
/// use downpour_scene::{Budget, sandbox::NoFiles, gltf::read_scene_from_bytes, scene::LightKind};
/// let json = br#"{
///     "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
///     "scenes": [{"nodes": [0]}],
///     "nodes": [{"translation": [0, 6, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
///     "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 800}]}}
/// }"#;
/// let scene = read_scene_from_bytes("lamp.gltf", json, &NoFiles, &mut Budget::default())?;
/// assert_eq!((scene.lights[0].intensity, scene.lights[0].kind), (800.0, LightKind::Point));
/// # Ok::<(), downpour_scene::SceneError>(())
/// ```
pub fn read_scene_from_bytes(
    name: &str,
    bytes: &[u8],
    files: &dyn Files,
    budget: &mut Budget,
) -> Result<Scene, SceneError> {
    let read = |remaining: &mut Budget| {
        let mut warnings = Warnings::default();
        let (checked, binary) = open(bytes, remaining, &mut warnings)?;
        scenes::read(checked, binary, bytes.len() as u64, files, remaining, warnings)
    };
    // Temporary memory of the reader is returned: the caller pays for the scene alone.
    let mut remaining = *budget;
    let mut scene = read(&mut remaining).map_err(|error| error.in_file(name))?;
    let mut pictures: Vec<_> = scene.textures.iter().map(|texture| &texture.picture).collect();
    pictures.sort_by_key(|picture| Arc::as_ptr(picture));
    pictures.dedup_by(|a, b| Arc::ptr_eq(a, b));
    let pictures =
        pictures.iter().map(|picture| picture.pixels.bytes()).fold(scene.bytes(), u64::saturating_add);
    *budget = Budget { bytes: budget.bytes.saturating_sub(pictures), ..remaining };
    name.clone_into(&mut scene.name);
    Ok(scene)
}

/// Reads with the bytes of a file that the user has named, and with its folder.
fn with_file<T>(
    path: &Path,
    budget: &mut Budget,
    read: impl FnOnce(&str, &[u8], &dyn Files, &mut Budget) -> Result<T, SceneError>,
) -> Result<T, SceneError> {
    let name = shown_path(path);
    let with = || {
        let bytes = whole_file(path, budget.bytes)?;
        let folder = Folder::open(path.parent().unwrap_or(Path::new("")))?;
        read(&name, &bytes, &folder, budget)
    };
    with().map_err(|error| error.in_file(&name))
}

/// Checks a document. Returns it with the binary chunk of a GLB.
fn open<'a>(
    bytes: &'a [u8],
    remaining: &mut Budget,
    warnings: &mut Warnings,
) -> Result<(guard::Checked, Option<&'a [u8]>), SceneError> {
    let length = bytes.len() as u64;
    if length > MAX_FILE {
        return Err(too_long(length, MAX_FILE));
    }
    remaining.take_bytes(length, "")?;
    let container = container::open(bytes, warnings)?;
    let value = json::parse(container.json, remaining, warnings)?;
    Ok((guard::check(value, container.binary, remaining, warnings)?, container.binary))
}

/// The bytes of a file that the user has named.
fn whole_file(path: &Path, left: u64) -> Result<Vec<u8>, SceneError> {
    let file = open_named(path)?;
    let most = MAX_FILE.min(left);
    if file.size > most {
        return Err(too_long(file.size, most));
    }
    let mut bytes = Budget::vec_with_capacity(usize::try_from(file.size).unwrap_or(usize::MAX), "")?;
    file.bytes.take(file.size).read_to_end(&mut bytes).map_err(|error| SceneError::io("", "", &error))?;
    if bytes.is_empty() {
        return Err(SceneError::bad("", magic::found(&bytes), container::GLTF));
    }
    Ok(bytes)
}

fn too_long(length: u64, most: u64) -> SceneError {
    let allowed = format!("at most {most} bytes ({})", size(most));
    SceneError::limit("", format!("a file of {length} bytes"), allowed)
}

/// A warning of the common kind: the meaning is clear, the form is not quite the specification's.
fn irregular(warnings: &mut Warnings, location: impl std::fmt::Display, what: impl FnOnce() -> String) {
    warnings.add(WarningKind::Irregular, location, what);
}
