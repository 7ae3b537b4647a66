//! Sources of frames: a weather file with all that it names, or a bare model in a shower.

use std::cell::RefCell;
use std::fs;
use std::path::{Path, PathBuf};

use downpour_scene::gltf::read_scene;
use downpour_scene::sandbox::{Files, NoFiles, OpenFile, RelativePath};
use downpour_scene::{Budget, SceneError};
use downpour_weather::{Loaded, Roots, Weather, load};

use super::{RendererError, shower_of_model};

/// A weather with everything that it names.
#[derive(Debug)]
#[non_exhaustive]
pub struct Source {
    /// The weather.
    pub weather: Weather,
    /// Its files.
    pub loaded: Loaded,
    /// Every file that was opened.
    pub files: Vec<PathBuf>,
}

/// Kind of a file by the end of its name.
enum Kind {
    Weather,
    Model,
}

impl Source {
    /// Reads a weather file (.toml), whose files lie beside it or in one of `asset_roots`; or a model (.glb, .gltf), which
    /// stands in a shower of 50 mm/h with the sun behind it, its first movement playing.
    ///
    /// # Errors
    /// As [`Source::check`], and what the readers say.
    pub fn read(path: &Path, asset_roots: &[&Path], budget: &mut Budget) -> Result<Self, RendererError> {
        Self::check(path, asset_roots)?;
        let mut source = match kind(path)? {
            Kind::Weather => Self::of_weather(path, asset_roots, budget)?,
            Kind::Model => Self::of_model(path, budget)?,
        };
        source.files.push(path.to_owned());
        Ok(source)
    }

    /// Checks that a file can be read by its name.
    ///
    /// # Errors
    /// [`RendererError::Name`] for another ending, or for folders of files with a model.
    pub fn check(path: &Path, asset_roots: &[&Path]) -> Result<(), RendererError> {
        if matches!(kind(path)?, Kind::Model) && !asset_roots.is_empty() {
            let allowed = "with a .toml";
            return Err(RendererError::Name {
                path: "--asset-root is for weather files".to_owned(),
                allowed,
            });
        }
        Ok(())
    }

    fn of_weather(path: &Path, others: &[&Path], budget: &mut Budget) -> Result<Self, RendererError> {
        let weather = Weather::read(path, budget)?;
        let own = path.parent().unwrap_or(Path::new(""));
        let folders: Vec<&Path> = [own].into_iter().chain(others.iter().copied()).collect();
        let files =
            Noted { files: &Roots::open(path, others)?, folders: &folders, opened: RefCell::new(Vec::new()) };
        let loaded = load(&weather, &files, budget)?;
        Ok(Self { weather, loaded, files: files.opened.into_inner() })
    }

    fn of_model(path: &Path, budget: &mut Budget) -> Result<Self, RendererError> {
        let mut weather = shower_of_model::shower(path.display().to_string());
        let mut loaded = load(&weather, &NoFiles, budget)?;
        loaded.scene = read_scene(path, budget)?;
        weather.sun = shower_of_model::sun(&weather, &loaded)?;
        loaded.sun = load(&weather, &NoFiles, budget)?.sun;
        loaded.animations = vec![(!loaded.scene.animations.is_empty()).then_some(0)];
        loaded.warnings.extend(loaded.scene.warnings.iter().cloned());
        Ok(Self { weather, loaded, files: Vec::new() })
    }
}

fn kind(path: &Path) -> Result<Kind, RendererError> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("toml") => Ok(Kind::Weather),
        Some("glb" | "gltf") => Ok(Kind::Model),
        _ => Err(RendererError::Name {
            path: format!("input {}", path.display()),
            allowed: "a weather file (.toml) or a model (.glb, .gltf)",
        }),
    }
}

/// Files, with a note of each that was opened.
struct Noted<'a> {
    files: &'a dyn Files,
    folders: &'a [&'a Path],
    opened: RefCell<Vec<PathBuf>>,
}

impl Files for Noted<'_> {
    fn open(&self, path: &RelativePath) -> Result<OpenFile, SceneError> {
        let opened = self.files.open(path)?;
        // Which of the folders had it does not matter to who must not overwrite it.
        let places = self.folders.iter().map(|folder| folder.join(path.as_str()));
        self.opened.borrow_mut().extend(places.filter(|place| fs::symlink_metadata(place).is_ok()));
        Ok(opened)
    }
}
