//! All files of a weather, as one scene, one sky and one sun.

use super::material_names::MaterialNames;
use super::materials;
use super::pane_map::read_pane_maps;
use super::puddle::{MAX_ALL_PUDDLE_CELLS, MAX_PUDDLE_CELLS, PuddleShape};
use super::{Lamp, Model, Puddle, SkySource, SunSource, Weather};
use downpour_math::ops::f64 as ops;
use downpour_scene::Budget;
use downpour_scene::error::SceneError;
use downpour_scene::gltf::{TriangleModel, read_scene_from_bytes, read_triangles_from_bytes};
use downpour_scene::picture::{self, Picture};
use downpour_scene::sandbox::{Files, Folder, OpenFile};
use downpour_scene::scene::{Animation, Light, LightKind, Local, Node, Scene};
use downpour_scene::sky::{self, SUN_THRESHOLD, SkyMap, Sun};
use downpour_scene::uri::{Address, RelativePath, check};
use downpour_scene::warning::{Warning, WarningKind, Warnings};
use glam::{Affine3A, DAffine3, DQuat, DVec3};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

/// Reflectance of the ground below the horizon of an overcast sky: typical of open land.
const GROUND_ALBEDO: f64 = 0.2;

/// A weather with its files.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// All models with their copies, and the lamps of the file.
    pub scene: Scene,
    /// Animation of `scene` that plays, for each model.
    pub animations: Vec<Option<usize>>,
    /// Models whose place has keys: for each, its index and the nodes of `scene` above its copies, in their order.
    pub moving: Vec<(usize, Vec<usize>)>,
    /// Sky, rotated and scaled; without the sun, if that was extracted.
    pub sky: SkyMap,
    /// The sun, if there is one.
    pub sun: Option<Sun>,
    /// Map of a file and its sun, without exposure and intensity; `None` unless these change over time.
    pub unscaled: Option<Box<(SkyMap, Option<Sun>)>>,
    /// Picture of the depth of each puddle that is painted.
    pub masks: Vec<Option<Picture>>,
    /// Model that drops are drawn as, if any.
    pub drop_model: Option<TriangleModel>,
    /// Parts that were dropped or repaired, in all files.
    pub warnings: Vec<Warning>,
}

impl Loaded {
    /// Sky and sun of a weather at a time in seconds; `None` if they do not change. There is a sun at all times or at none.
    #[must_use]
    pub fn sky_at(&self, weather: &Weather, time_s: f64) -> Option<(SkyMap, Option<Sun>)> {
        if !weather.keys.has_sky() {
            return None;
        }
        let now = weather.at(time_s);
        Some(match self.unscaled.as_deref() {
            Some((map, sun)) => scaled_sky(&now, map, sun.as_ref()),
            None => (formula(&now).unwrap_or_else(|| self.sky.clone()), directional(&now.sun)),
        })
    }

    /// The files of another weather, where these are those of `before`: what both name in the same way is taken over, all else is read.
    ///
    /// # Errors
    /// As [`load`].
    pub fn reload(
        &self,
        before: &Weather,
        weather: &Weather,
        files: &dyn Files,
        budget: &mut Budget,
    ) -> Result<(Self, Reloaded), SceneError> {
        let reloaded = Reloaded::between(before, weather, self.is_animated());
        if reloaded.models {
            return Ok((load(weather, files, budget)?, reloaded));
        }
        check_panes(weather, &self.scene)?;
        let mut remaining = *budget;
        let mut loaded = Self { masks: masks(weather, files, &mut remaining)?, ..self.clone() };
        read_pane_maps(weather, files, &mut remaining)?;
        if reloaded.sky {
            let mut warnings = Warnings::default();
            loaded.unscaled = None;
            (loaded.sky, loaded.sun) =
                lights_of_the_sky(weather, files, &mut remaining, &mut warnings, &mut loaded.unscaled)?;
            loaded.warnings.extend(std::mem::take(&mut loaded.sky.warnings));
            loaded.warnings.extend(warnings.finish());
        }
        if before.drop_model != weather.drop_model {
            loaded.drop_model = drop_model(weather, files, &mut remaining)?;
        }
        *budget = remaining;
        Ok((loaded, reloaded))
    }
}

/// Parts of a weather's files that are not those of another one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reloaded {
    /// The models or their materials, and with them all else.
    pub models: bool,
    /// Sky and sun.
    pub sky: bool,
}

impl Reloaded {
    /// The parts in which two weathers differ.
    fn between(before: &Weather, weather: &Weather, is_animated: bool) -> Self {
        // Lamps are nodes of a scene that moves.
        let models = before.models != weather.models
            // What a material was without its override is in its file only.
            || before.materials != weather.materials
            || !before.keys.has_models_of(&weather.keys)
            || (is_animated && before.lights != weather.lights);
        let scales = before.keys.has_sky() || weather.keys.has_sky();
        let sky = models || scales || before.sky != weather.sky || before.sun != weather.sun;
        Self { models, sky }
    }
}

/// Folders in which the files of a weather are searched, in this order: its folder, then asset roots.
#[derive(Debug)]
pub struct Roots(Vec<Folder>);

impl Roots {
    /// Opens the folder of a weather file, and asset roots that the user has named.
    ///
    /// # Errors
    /// One of them is not a folder, or cannot be opened.
    pub fn open(weather: &Path, asset_roots: &[&Path]) -> Result<Self, SceneError> {
        let own = weather.parent().unwrap_or(Path::new(""));
        [own].iter().chain(asset_roots).map(|folder| Folder::open(folder)).collect::<Result<_, _>>().map(Self)
    }
}

impl Files for Roots {
    fn open(&self, path: &RelativePath) -> Result<OpenFile, SceneError> {
        let mut first = None;
        for folder in &self.0 {
            match folder.open(path) {
                // Not found: try the next folder. Any other result is final.
                Err(error @ SceneError::Unreadable(_)) => {
                    first.get_or_insert(error);
                }
                other => return other,
            }
        }
        Err(first.unwrap_or_else(|| SceneError::bad("", "no folder to look in", "a folder")))
    }
}

/// Files inside the folder of another file.
struct Beside<'a> {
    files: &'a dyn Files,
    folder: &'a str,
}

impl Files for Beside<'_> {
    fn open(&self, path: &RelativePath) -> Result<OpenFile, SceneError> {
        let joined = format!("{}{}", self.folder, path.as_str());
        match check(&joined.replace('%', "%25")) {
            Ok(Address::File(path)) => self.files.open(&path),
            _ => Err(SceneError::bad("", "a path that does not stay in its folder", "a relative path")),
        }
    }
}

/// Reads all files of a weather, through `files`: see [`Roots`].
///
/// The budget is lowered by their size; a copy of a model, by `repeat` or by another `[[model]]` of the
/// same file, costs its nodes and animations only.
///
/// # Errors
/// [`SceneError`] with the name of the file: it cannot be read, is not supported, or is too large; or a
/// model has no animation of the name in the weather, or no model a material of a name in it.
///
/// ```no_run
/// use downpour_scene::Budget;
/// use downpour_weather::{Roots, Weather, load};
/// let (path, mut budget) = ("street/storm.toml".as_ref(), Budget::default());
/// let weather = Weather::read(path, &mut budget)?;
/// let loaded = load(&weather, &Roots::open(path, &[])?, &mut budget)?;
/// println!("{} nodes, sun: {}", loaded.scene.nodes.len(), loaded.sun.is_some());
/// # Ok::<(), downpour_scene::SceneError>(())
/// ```
pub fn load(weather: &Weather, files: &dyn Files, budget: &mut Budget) -> Result<Loaded, SceneError> {
    let mut remaining = *budget;
    let mut warnings = Warnings::default();
    let mut unscaled = None;
    let (mut sky, sun) = lights_of_the_sky(weather, files, &mut remaining, &mut warnings, &mut unscaled)?;
    let mut scene = Scene { name: weather.name.clone(), ..Scene::default() };
    let mut animations = Vec::new();
    let (mut known, mut roots) = (BTreeMap::new(), Vec::new());
    for model in &weather.models {
        let first = scene.roots.len();
        animations.push(add(&mut scene, model, &mut known, files, &mut remaining)?);
        roots.push(first..scene.roots.len());
    }
    let roots_of = |model: usize| scene.roots.get(roots.get(model)?.clone()).map(<[usize]>::to_vec);
    let moving = weather.keys.models().filter_map(|model| Some((model, roots_of(model)?))).collect();
    materials::apply(&weather.materials, &mut scene).map_err(|error| error.in_file(&weather.name))?;
    check_panes(weather, &scene)?;
    for lamp in &weather.lights {
        remaining.take_nodes(1, "light").map_err(|error| error.in_file(&weather.name))?;
        add_lamp(&mut scene, lamp);
    }
    let masks = masks(weather, files, &mut remaining)?;
    read_pane_maps(weather, files, &mut remaining)?;
    let drop_model = drop_model(weather, files, &mut remaining)?;
    *budget = remaining;
    let of_drops = drop_model.iter().flat_map(|model| model.warnings.clone()).collect();
    let warnings =
        [std::mem::take(&mut sky.warnings), scene.warnings.clone(), of_drops, warnings.finish()].concat();
    Ok(Loaded { scene, animations, moving, sky, sun, unscaled, masks, drop_model, warnings })
}

/// Checks that the models have the materials that panes are of.
fn check_panes(weather: &Weather, scene: &Scene) -> Result<(), SceneError> {
    if weather.panes.is_empty() {
        return Ok(());
    }
    let names = MaterialNames::of(scene);
    for (index, pane) in weather.panes.iter().enumerate() {
        pane.check_material(index, &names).map_err(|error| error.in_file(&weather.name))?;
    }
    Ok(())
}

/// Triangles that drops are drawn as: all of them, or an error.
fn drop_model(
    weather: &Weather,
    files: &dyn Files,
    budget: &mut Budget,
) -> Result<Option<TriangleModel>, SceneError> {
    let Some(file) = &weather.drop_model else { return Ok(None) };
    let name = file.as_str();
    let folder = name.rfind('/').and_then(|end| name.get(..=end)).unwrap_or_default();
    let bytes = files.open(file).and_then(|opened| opened.read_all(budget));
    let bytes = bytes.map_err(|error| error.in_file(name))?;
    let model = read_triangles_from_bytes(name, &bytes, &Beside { files, folder }, budget)?.strict()?;
    Ok(Some(model))
}

/// Pictures of the depths of painted puddles.
fn masks(
    weather: &Weather,
    files: &dyn Files,
    budget: &mut Budget,
) -> Result<Vec<Option<Picture>>, SceneError> {
    let mut cells = 0;
    let read = |puddle: &Puddle| {
        let PuddleShape::Painted(file) = &puddle.shape else { return Ok(None) };
        let name = file.as_str();
        let mut read = || {
            let bytes = files.open(file)?.read_all(budget)?;
            let mask = picture::decode(name, &bytes, budget)?;
            let found = format!("a mask of {} x {} pixels", mask.width, mask.height);
            if mask.width.max(mask.height) > MAX_PUDDLE_CELLS || mask.width.min(mask.height) < 2 {
                let allowed = format!("2 to {MAX_PUDDLE_CELLS} pixels along each edge");
                return Err(SceneError::limit("", found, allowed));
            }
            cells = u64::saturating_add(cells, u64::from(mask.width).saturating_mul(u64::from(mask.height)));
            if cells > MAX_ALL_PUDDLE_CELLS {
                let found = format!("{cells} pixels in all masks so far");
                return Err(SceneError::limit("", found, format!("at most {MAX_ALL_PUDDLE_CELLS}")));
            }
            Ok(mask)
        };
        read().map(Some).map_err(|error| error.in_file(name))
    };
    weather.puddles.iter().map(read).collect()
}

/// Sky and sun, rotated and scaled.
fn lights_of_the_sky(
    weather: &Weather,
    files: &dyn Files,
    budget: &mut Budget,
    warnings: &mut Warnings,
    unscaled: &mut Option<Box<(SkyMap, Option<Sun>)>>,
) -> Result<(SkyMap, Option<Sun>), SceneError> {
    // A sky that changes is scaled from its map for each picture.
    let is_keyed = weather.keys.has_sky();
    let scale = if is_keyed { 1.0 } else { weather.sky.scale };
    let (mut sky, yaw) = match &weather.sky.source {
        SkySource::Uniform(_) | SkySource::Overcast(_) => {
            (formula(weather).unwrap_or_else(|| SkyMap::uniform([0.0; 3])), 0.0)
        }
        SkySource::File { file, yaw } => {
            let name = file.as_str();
            let read = |budget: &mut Budget| {
                let bytes = files.open(file)?.read_all(budget)?;
                sky::read_sky_from_bytes(name, &bytes, budget)
            };
            let mut sky = read(budget).map_err(|error| error.in_file(name))?;
            for pixel in &mut sky.radiance {
                *pixel = pixel.map(|value| narrowed(f64::from(value) * scale).min(sky::MAX_RADIANCE));
            }
            (sky, *yaw)
        }
    };
    let mut sun = match weather.sun {
        SunSource::None => None,
        SunSource::FromSky | SunSource::FromSkyIfAny => sky.extract_sun(SUN_THRESHOLD),
        SunSource::Directional { .. } => directional(&weather.sun),
    };
    if let SunSource::Directional { .. } = weather.sun {
        return Ok(keep(weather, turned(sky, yaw), sun, unscaled));
    }
    if let Some(sun) = &mut sun {
        let [x, y, z] = sun.direction.map(f64::from);
        let (s, c) = (ops::sin(yaw), ops::cos(yaw));
        sun.direction = [c * x + s * z, y, c * z - s * x].map(narrowed);
    } else if weather.sun == SunSource::FromSky {
        warnings.add(WarningKind::Ignored, "sun", || "the sky map has no compact bright source".into());
    }
    Ok(keep(weather, turned(sky, yaw), sun, unscaled))
}

/// Keeps a map whose scale changes, and returns what it is at time 0.
fn keep(
    weather: &Weather,
    sky: SkyMap,
    sun: Option<Sun>,
    unscaled: &mut Option<Box<(SkyMap, Option<Sun>)>>,
) -> (SkyMap, Option<Sun>) {
    if !weather.keys.has_sky() || !matches!(weather.sky.source, SkySource::File { .. }) {
        return (sky, sun);
    }
    let (map, sun) = &**unscaled.insert(Box::new((sky, sun)));
    scaled_sky(weather, map, sun.as_ref())
}

/// A map of a file and its sun, by the scale of a weather.
fn scaled_sky(weather: &Weather, map: &SkyMap, sun: Option<&Sun>) -> (SkyMap, Option<Sun>) {
    let scale = weather.sky.scale;
    let scaled = |value: f32| narrowed(f64::from(value) * scale);
    let mut sky = map.clone();
    for pixel in &mut sky.radiance {
        *pixel = pixel.map(|value| scaled(value).min(sky::MAX_RADIANCE));
    }
    let of_map = || sun.map(|sun| Sun { irradiance_rgb: sun.irradiance_rgb.map(scaled), ..*sun });
    (sky, directional(&weather.sun).or_else(of_map))
}

/// Sky by a formula; `None` for a map.
fn formula(weather: &Weather) -> Option<SkyMap> {
    let scaled = |color: [f64; 3]| color.map(|value| narrowed(value * weather.sky.scale));
    match weather.sky.source {
        SkySource::Uniform(color) => Some(SkyMap::uniform(scaled(color))),
        SkySource::Overcast(zenith) => Some(SkyMap::overcast(scaled(zenith)).with_ground(GROUND_ALBEDO)),
        SkySource::File { .. } => None,
    }
}

/// A sun apart from the sky map.
fn directional(sun: &SunSource) -> Option<Sun> {
    let SunSource::Directional { towards, illuminance_lux, color, angular_radius } = *sun else {
        return None;
    };
    Some(Sun {
        direction: towards.map(narrowed),
        irradiance_rgb: color.map(|part| narrowed(part * illuminance_lux)),
        angular_radius: narrowed(angular_radius),
    })
}

fn turned(sky: SkyMap, yaw: f64) -> SkyMap {
    if yaw == 0.0 { sky } else { sky.rotated(yaw) }
}

/// Index ranges in the scene of the first copy of a file.
struct Source {
    nodes: Range<usize>,
    animations: Range<usize>,
}

/// Adds a model with its copies. Returns the animation that plays.
fn add<'a>(
    scene: &mut Scene,
    model: &'a Model,
    known: &mut BTreeMap<&'a str, Source>,
    files: &dyn Files,
    budget: &mut Budget,
) -> Result<Option<usize>, SceneError> {
    let name = model.file.as_str();
    let mut positions = model.transforms().map(|transform| single(&transform));
    let first = positions.next().unwrap_or(Affine3A::IDENTITY);
    let part = match known.get(name) {
        Some(source) => again(scene, source, first, budget).map_err(|error| error.in_file(name))?,
        None => {
            let part = append(scene, model, first, files, budget).map_err(|error| error.in_file(name))?;
            let source = Source { nodes: part.nodes.clone(), animations: part.animations.clone() };
            known.insert(name, source);
            part
        }
    };
    let own = scene.animations.get(part.animations.clone()).unwrap_or_default();
    let chosen = match &model.animation {
        None => (!own.is_empty()).then_some(0),
        Some(wanted) => Some(own.iter().position(|one| one.name == *wanted).ok_or_else(|| {
            let names: Vec<&str> = own.iter().map(|one| one.name.as_str()).collect();
            let found = format!("no animation {}", downpour_scene::error::quoted(wanted));
            SceneError::bad("animations", found, downpour_scene::error::quoted(&names.join(", ")))
                .in_file(name)
        })?),
    };
    let chosen = chosen.map(|index| index.saturating_add(part.animations.start));
    let each = copy_bytes(scene, &part);
    for transform in positions {
        let mut take = || {
            budget.take_bytes(each, "nodes")?;
            budget.take_nodes(part.nodes.len() as u64, "nodes")
        };
        take().map_err(|error| error.in_file(name))?;
        copy(scene, part.nodes.clone(), part.animations.clone(), transform);
    }
    Ok(chosen)
}

/// Reads the file of a model and adds it with a transform.
fn append(
    scene: &mut Scene,
    model: &Model,
    transform: Affine3A,
    files: &dyn Files,
    budget: &mut Budget,
) -> Result<Source, SceneError> {
    let name = model.file.as_str();
    let folder = name.rfind('/').and_then(|end| name.get(..=end)).unwrap_or_default();
    let bytes = files.open(&model.file)?.read_all(budget)?;
    let other = read_scene_from_bytes(name, &bytes, &Beside { files, folder }, budget)?;
    budget.take_nodes(1, "nodes")?;
    let (nodes, animations) = (scene.nodes.len(), scene.animations.len());
    scene.append(other, transform);
    Ok(Source { nodes: nodes..scene.nodes.len(), animations: animations..scene.animations.len() })
}

/// Adds a file that was read before with another transform: its nodes, with separate animations.
fn again(
    scene: &mut Scene,
    source: &Source,
    transform: Affine3A,
    budget: &mut Budget,
) -> Result<Source, SceneError> {
    budget.take_bytes(copy_bytes(scene, source), "nodes")?;
    budget.take_nodes(source.nodes.len() as u64, "nodes")?;
    let (nodes, animations) = (scene.nodes.len(), scene.animations.len());
    // Those of the first copy alone: its repetitions were added to the same animations.
    let moved: Vec<Animation> = scene
        .animations
        .get(source.animations.clone())
        .unwrap_or_default()
        .iter()
        .map(|animation| {
            let own = animation.channels.iter().filter(|channel| source.nodes.contains(&channel.node));
            Animation { name: animation.name.clone(), channels: own.cloned().collect() }
        })
        .collect();
    copy(scene, source.nodes.clone(), 0..0, transform);
    let by = nodes.saturating_sub(source.nodes.start);
    scene.animations.extend(moved.into_iter().map(|mut animation| {
        for channel in &mut animation.channels {
            channel.node = channel.node.saturating_add(by);
        }
        animation
    }));
    Ok(Source { nodes: nodes..scene.nodes.len(), animations: animations..scene.animations.len() })
}

/// Size of a copy, in bytes.
fn copy_bytes(scene: &Scene, source: &Source) -> u64 {
    let of = |count: usize, size: usize| (count as u64).saturating_mul(size as u64);
    let nodes = scene.nodes.get(source.nodes.clone()).unwrap_or_default().iter();
    let nodes = nodes.map(|node| {
        let skin = node.skin.and_then(|skin| scene.skins.get(skin));
        let skin = skin.map_or(0, |skin| of(skin.joints.len(), size_of::<(usize, Affine3A)>()));
        let lists = of(node.name.len(), 1).saturating_add(of(node.weights.len(), 4)).saturating_add(skin);
        lists
            .saturating_add(of(node.children.len(), size_of::<usize>()))
            .saturating_add(of(1, size_of::<Node>()))
    });
    let animations = scene.animations.get(source.animations.clone()).unwrap_or_default();
    let channels = animations.iter().flat_map(|animation| &animation.channels);
    let channels = channels.filter(|channel| source.nodes.contains(&channel.node));
    nodes.chain(channels.map(|channel| channel.track.bytes())).fold(0, u64::saturating_add)
}

/// Copies the nodes of a model, with their skins and animations; the meshes are shared. The last
/// node of the part is the parent of all others.
fn copy(scene: &mut Scene, part: Range<usize>, animations: Range<usize>, transform: Affine3A) {
    let by = scene.nodes.len().saturating_sub(part.start);
    let mut nodes = scene.nodes.get(part.clone()).unwrap_or_default().to_vec();
    for node in &mut nodes {
        node.children.iter_mut().for_each(|child| *child = child.saturating_add(by));
        if let Some(mut skin) = node.skin.and_then(|skin| scene.skins.get(skin)).cloned() {
            skin.joints.iter_mut().for_each(|joint| *joint = joint.saturating_add(by));
            node.skin = Some(scene.skins.len());
            scene.skins.push(skin);
        }
    }
    if let Some(root) = nodes.last_mut() {
        root.local = Local::Matrix(transform);
    }
    scene.nodes.extend(nodes);
    scene.roots.push(scene.nodes.len().saturating_sub(1));
    for animation in scene.animations.get_mut(animations).unwrap_or_default() {
        let moved: Vec<_> =
            animation.channels.iter().filter(|channel| part.contains(&channel.node)).cloned().collect();
        animation.channels.extend(moved.into_iter().map(|mut channel| {
            channel.node = channel.node.saturating_add(by);
            channel
        }));
    }
}

/// The lamps of a weather file at a time in seconds, in their order, as a scene of nothing else.
#[must_use]
pub fn lamps_at(weather: &Weather, time_s: f64) -> Scene {
    let mut scene = Scene::default();
    for lamp in &weather.at(time_s).lights {
        add_lamp(&mut scene, lamp);
    }
    scene
}

/// Adds a lamp to the scene.
fn add_lamp(scene: &mut Scene, lamp: &Lamp) {
    let (position, direction, color, intensity, [range, radius], kind) = match *lamp {
        Lamp::Point { position, radius, color, intensity_cd, range } => {
            (position, DVec3::NEG_Z, color, intensity_cd, [range, radius], LightKind::Point)
        }
        Lamp::Spot { position, radius, direction, color, intensity_cd, inner, outer, range } => {
            let kind = LightKind::Spot { inner: narrowed(inner), outer: narrowed(outer) };
            (position, direction, color, intensity_cd, [range, radius], kind)
        }
        Lamp::Directional { direction, color, illuminance_lux } => {
            (DVec3::ZERO, direction, color, illuminance_lux, [None; 2], LightKind::Directional)
        }
    };
    let light = scene.lights.len();
    let intensity = narrowed(intensity);
    let [range, radius] = [range, radius].map(|meters| meters.map(narrowed));
    let color = color.as_vec3();
    scene.lights.push(Light { name: String::new(), color, intensity, range, radius, kind });
    // Lights shine along -Z of their node.
    let rotation = DQuat::from_rotation_arc(DVec3::NEG_Z, direction);
    let local = Local::Matrix(single(&DAffine3::from_rotation_translation(rotation, position)));
    scene.roots.push(scene.nodes.len());
    scene.nodes.push(Node { light: Some(light), local, ..Node::default() });
}

/// Transform in single precision.
fn single(transform: &DAffine3) -> Affine3A {
    let [x, y, z] =
        [transform.matrix3.x_axis, transform.matrix3.y_axis, transform.matrix3.z_axis].map(DVec3::as_vec3a);
    Affine3A { matrix3: glam::Mat3A::from_cols(x, y, z), translation: transform.translation.as_vec3a() }
}

/// Nearest `f32`, within its range.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding is meant, and what is beyond the range is at its end"
)]
pub(super) fn narrowed(value: f64) -> f32 {
    value.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32
}
