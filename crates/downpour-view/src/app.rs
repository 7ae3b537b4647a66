//! The window's content: what it shows, and what its commands do. Windows, tests and scripts run the same code.

mod clock;
mod command;
mod dialogs;
mod handles;
mod icons;
mod inspector;
mod list;
mod overlay;
mod paint;
mod picker;
mod status;
mod timeline;
mod top;
mod viewport;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{TextureHandle, TextureOptions};

pub use clock::Clock;
pub use command::Command;
pub use dialogs::Dialog;
pub use handles::{Handle, HandleKind};
pub use picker::{Picker, Purpose};

use crate::brush::Brush;
use crate::document::{Document, DocumentError};
use crate::engine::{DeviceChoice, Drawn, Engine, Pace, Request, Rest};
use crate::job::Job;
use crate::key_path::KeyPath;
use crate::navigation::FreeEye;
use crate::objects::{Object, ObjectId, objects};
use crate::plain::Plain;
use crate::schema::{self, Field};

/// Seconds between two looks at the file on disk, and between two autosaves.
const WATCH_S: f64 = 2.0;

/// Time without a change after which pictures are refined, s.
const REST_S: f64 = 0.3;

/// Options of an application.
#[derive(Clone, Debug, Default)]
pub struct AppOptions {
    /// Device that draws.
    pub device: DeviceChoice,
    /// Other folders of files.
    pub asset_roots: Vec<PathBuf>,
    /// Scale of pictures in place of one that keeps the window fluid: for scripts.
    pub scale: Option<f64>,
}

/// Lines and labels over the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlay {
    /// Models of objects.
    pub has_objects: bool,
    /// The wind on a slice.
    pub has_slice: bool,
    /// Tracers in the wind.
    pub has_tracers: bool,
    /// Height of the slice, m.
    pub slice_m: f64,
    /// Path of the camera.
    pub has_path: bool,
    /// Handles move in steps of 0.5 m and 15 degrees.
    pub snaps: bool,
}

/// Wishes to the window around.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    /// It is to close.
    Close,
    /// It is to fill the screen, or no longer.
    FullScreen,
    /// It is to be saved as a picture, with its panels.
    Screenshot,
}

/// The picture that is asked for: a new one is due when it changes.
#[derive(Clone, Debug, PartialEq)]
struct Asked {
    revision: u64,
    eye: Option<FreeEye>,
    time_s: f64,
    size: [u32; 2],
}

/// The window's content.
pub struct App {
    options: AppOptions,
    document: Document,
    engine: Engine,
    schema: Arc<Vec<Field>>,
    drawn: Option<Arc<Drawn>>,
    texture: Option<TextureHandle>,
    eye: Option<FreeEye>,
    clock: Clock,
    selected: BTreeSet<ObjectId>,
    hidden: BTreeSet<ObjectId>,
    overlay: Overlay,
    handles: Vec<Handle>,
    drag: Option<handles::Drag>,
    brush: Brush,
    timeline: timeline::Timeline,
    filter: String,
    message: Option<(String, bool)>,
    dialog: Option<Dialog>,
    job: Option<Job>,
    wishes: Vec<Wish>,
    stroke: u64,
    pace: Pace,
    asked: Option<Asked>,
    asked_scale: f64,
    /// Pictures of the same state that were asked for.
    repeats: u32,
    meters: bool,
    lists_drops: bool,
    is_discarded: bool,
    changed_s: f64,
    watched_s: f64,
    window: [u32; 2],
    fluid_ms: Option<f64>,
    /// Time of the scene without rain at the size of the window, ms.
    plate_ms: f64,
    /// Rectangle of the picture, in points.
    picture: egui::Rect,
}

impl std::fmt::Debug for App {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("App").field("document", &self.document).finish_non_exhaustive()
    }
}

impl App {
    /// An application with a document.
    ///
    /// # Errors
    /// The system has no thread left.
    pub fn new(document: Document, options: AppOptions) -> std::io::Result<Self> {
        let engine = Engine::start(options.device.clone())?;
        let mut app = Self {
            options,
            document,
            engine,
            schema: Arc::new(schema::fields()),
            drawn: None,
            texture: None,
            eye: None,
            clock: Clock::default(),
            selected: BTreeSet::new(),
            hidden: BTreeSet::new(),
            overlay: Overlay {
                has_objects: true,
                has_slice: false,
                has_tracers: false,
                slice_m: 1.0,
                has_path: true,
                snaps: false,
            },
            handles: Vec::new(),
            drag: None,
            brush: Brush::default(),
            timeline: timeline::Timeline::default(),
            filter: String::new(),
            message: None,
            dialog: None,
            job: None,
            wishes: Vec::new(),
            stroke: 1,
            pace: Pace::default(),
            asked: None,
            asked_scale: 0.0,
            repeats: 0,
            meters: false,
            lists_drops: false,
            is_discarded: false,
            changed_s: 0.0,
            watched_s: 0.0,
            window: [0; 2],
            fluid_ms: None,
            plate_ms: 0.0,
            picture: egui::Rect::ZERO,
        };
        app.look_for_recovery();
        Ok(app)
    }

    /// The document.
    #[must_use]
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The newest picture.
    #[must_use]
    pub fn drawn(&self) -> Option<&Arc<Drawn>> {
        self.drawn.as_ref()
    }

    /// The thread that draws.
    #[must_use]
    pub fn engine(&self) -> &Engine {
        &self.engine
    }

    /// The clock.
    pub fn clock_mut(&mut self) -> &mut Clock {
        &mut self.clock
    }

    /// Lines and labels over the picture.
    pub fn overlay_mut(&mut self) -> &mut Overlay {
        &mut self.overlay
    }

    /// Handles of what is selected, as they were drawn last.
    #[must_use]
    pub fn handles(&self) -> &[Handle] {
        &self.handles
    }

    /// Size of the picture's part of the window, in pixels.
    #[must_use]
    pub fn window_size(&self) -> [u32; 2] {
        self.window
    }

    /// Rectangle of the picture, in points.
    #[must_use]
    pub fn picture_rect(&self) -> egui::Rect {
        self.picture
    }

    /// The last message, and whether it is an error.
    #[must_use]
    pub fn message(&self) -> Option<&(String, bool)> {
        self.message.as_ref()
    }

    /// Wishes to the window around, which are taken.
    pub fn take_wishes(&mut self) -> Vec<Wish> {
        std::mem::take(&mut self.wishes)
    }

    /// Selects objects; those that are not there are left out.
    pub fn select(&mut self, ids: impl IntoIterator<Item = ObjectId>) {
        let known = self.objects();
        self.selected = ids.into_iter().filter(|id| known.iter().any(|object| object.id == *id)).collect();
    }

    /// The objects at the time of the clock.
    fn objects(&self) -> Vec<Object> {
        objects(self.document.plain(), self.clock.time_s)
    }

    /// Name of an object to show.
    fn object_name(&self, object: &Object) -> String {
        let ObjectId { list, index } = object.id;
        self.document.entry_name(list, index).unwrap_or_else(|| format!("{} {}", object.kind, index + 1))
    }

    /// Says what happened.
    fn say(&mut self, text: impl Into<String>) {
        self.message = Some((text.into(), false));
    }

    /// Says what did not happen.
    fn complain(&mut self, text: impl std::fmt::Display) {
        self.message = Some((text.to_string(), true));
    }

    /// Notes the result of an edit.
    fn noted<T>(&mut self, result: Result<T, DocumentError>) -> Option<T> {
        match result {
            Ok(value) => {
                if self.message.as_ref().is_some_and(|(_, is_error)| *is_error) {
                    self.message = None;
                }
                Some(value)
            }
            Err(error) => {
                self.complain(error);
                None
            }
        }
    }

    /// Sets a key at the time of the clock: a keyframe where there are keyframes.
    ///
    /// # Errors
    /// As [`Document::set`].
    pub fn set(&mut self, path: &KeyPath, value: Plain) -> Result<(), DocumentError> {
        let value = crate::objects::set_at(self.document.get(path), self.clock.time_s, value);
        self.document.set(path, &value, Some(self.stroke))
    }

    /// The document, to be edited by a script.
    pub fn document_mut(&mut self) -> &mut Document {
        &mut self.document
    }

    /// True if changes that are not saved may be lost, as the user has said.
    #[must_use]
    pub fn is_discarded(&self) -> bool {
        self.is_discarded
    }

    /// A file beside the weather for the next picture of the window.
    #[must_use]
    pub fn screenshot_place(&self) -> PathBuf {
        crate::brush::free_picture(&self.document.place())
    }

    /// Writes the picture, without panels and handles, as a PNG.
    pub fn save_picture(&mut self, path: &Path) {
        match self.drawn.clone() {
            Some(drawn) => {
                let pixels: Vec<[u8; 3]> =
                    drawn.image.pixels.iter().map(|it| [it.r(), it.g(), it.b()]).collect();
                self.save_pixels(path, drawn.size, &pixels);
            }
            None => self.complain("there is no picture yet"),
        }
    }

    /// Writes pixels, rows from the top, as a PNG, and says so.
    pub fn save_pixels(&mut self, path: &Path, size: [u32; 2], pixels: &[[u8; 3]]) {
        match crate::document::write_picture(path, size, pixels) {
            Ok(()) => self.say(format!("wrote {}", path.display())),
            Err(error) => self.complain(error),
        }
    }

    /// Draws the present state once more.
    pub fn draw_again(&mut self) {
        self.asked = None;
    }

    /// Draws the present state with the list of its drops.
    pub fn list_drops(&mut self) {
        self.lists_drops = true;
        self.asked = None;
    }

    /// Shows another document.
    pub fn show(&mut self, document: Document) {
        self.document.discard_recovery();
        self.document = document;
        self.is_discarded = false;
        self.selected.clear();
        self.hidden.clear();
        self.eye = None;
        self.asked = None;
        self.dialog = None;
        self.look_for_recovery();
    }

    fn look_for_recovery(&mut self) {
        if let Some(recovery) = self.document.recovery() {
            self.dialog = Some(Dialog::Recover(recovery));
        }
    }

    /// Opens a file; unsaved changes are asked about first.
    pub fn open(&mut self, path: &Path) {
        if self.document.is_dirty() && self.document.undo_label().is_some() {
            self.dialog = Some(Dialog::Unsaved { then: Some(path.to_owned()) });
            return;
        }
        match Document::open(path) {
            Ok(document) => {
                self.show(document);
                self.say(format!("opened {}", self.document.title()));
            }
            Err(error) => self.complain(error),
        }
    }

    /// One pass of the whole window.
    pub fn frame(&mut self, ui: &mut egui::Ui) {
        let now_s = ui.input(|input| input.time);
        if !ui.input(|input| input.pointer.any_down()) {
            // What is edited from here on is another step of the history.
            self.stroke += 1;
        }
        self.take_answer(ui.ctx());
        self.clock.advance(f64::from(ui.input(|input| input.stable_dt)));
        self.take_drops(ui);
        self.shortcuts(ui);
        self.top(ui);
        self.status(ui);
        self.timeline(ui);
        self.list(ui);
        self.inspector(ui);
        self.viewport(ui);
        self.dialogs(ui);
        self.watch(now_s);
        self.ask(now_s);
        if self.clock.is_playing || self.job.is_some() {
            ui.ctx().request_repaint();
        } else if self.engine.is_busy() || self.overlay.has_tracers {
            ui.ctx().request_repaint_after(std::time::Duration::from_millis(30));
        } else {
            ui.ctx().request_repaint_after(std::time::Duration::from_millis(250));
        }
    }

    /// Takes the newest picture from the thread.
    fn take_answer(&mut self, context: &egui::Context) {
        match self.engine.take() {
            Some(Ok(drawn)) => {
                let image = Arc::clone(&drawn.image);
                match &mut self.texture {
                    Some(texture) => texture.set(image, TextureOptions::LINEAR),
                    None => {
                        self.texture = Some(context.load_texture("picture", image, TextureOptions::LINEAR));
                    }
                }
                // Where nothing moves, the scene without rain is made and refined once and then kept: it is no part of the pace.
                let is_still = self.drawn.as_ref().is_none_or(|before| before.view == drawn.view);
                let plate_ms = drawn.plate_ms();
                let fluid_ms = if is_still { drawn.rain_ms() } else { drawn.frame_ms };
                self.plate_ms = if plate_ms > 1.0 {
                    plate_ms / (self.asked_scale * self.asked_scale)
                } else {
                    self.plate_ms
                };
                let counts = self.drawn.is_some() && !drawn.is_in_flash;
                if self.asked_scale <= self.pace.scale() && counts {
                    let scale = self.pace.scale();
                    self.pace.note(fluid_ms, self.plate_ms * scale * scale);
                    self.fluid_ms = Some(fluid_ms);
                }
                self.drawn = Some(drawn);
            }
            Some(Err(fault)) => {
                if fault.is_fatal {
                    // The device is gone: what was made is kept.
                    let saved = self.document.autosave();
                    let place = self.document.recovery_path();
                    let kept = match saved {
                        Ok(()) if self.document.is_dirty() => format!("; changes are in {}", place.display()),
                        _ => String::new(),
                    };
                    self.complain(format!("{}{kept}", fault.message));
                } else {
                    self.complain(fault.message);
                }
            }
            None => {}
        }
    }

    /// Asks for a picture where one is due.
    fn ask(&mut self, now_s: f64) {
        let asked = Asked {
            revision: self.document.revision(),
            eye: self.eye,
            time_s: self.clock.time_s,
            size: self.window,
        };
        if asked.size.contains(&0) {
            return;
        }
        let is_new = self.asked.as_ref() != Some(&asked);
        let fixed = self.options.scale;
        let scale = if is_new {
            self.changed_s = now_s;
            self.repeats = 0;
            fixed.unwrap_or_else(|| self.pace.scale())
        } else {
            // At rest the picture is refined: a larger one, then one of more rays, one step at a time.
            let rest_s = now_s - self.changed_s;
            let Some(drawn) = self.drawn.as_ref().filter(|_| !self.engine.is_busy()) else { return };
            if fixed.is_some() || rest_s < REST_S {
                return;
            }
            let (scale, repeats, plate_ms) = (self.asked_scale, self.repeats, self.plate_ms);
            let rest = Rest { scale, repeats, rain_ms: drawn.rain_ms(), plate_ms };
            let Some(next) = rest.next(rest_s) else { return };
            self.repeats = next.repeats;
            next.scale
        };
        self.asked = Some(asked);
        self.asked_scale = scale;
        let request = self.request(self.pace.size(self.window, scale));
        self.engine.ask(request);
        (self.meters, self.lists_drops) = (false, false);
    }

    /// The question for a picture of the present state.
    fn request(&self, size: [u32; 2]) -> Request {
        Request {
            weather: Arc::clone(self.document.weather()),
            revision: self.document.revision(),
            place: self.document.place(),
            asset_roots: self.options.asset_roots.clone(),
            eye: self.eye.as_ref().map(FreeEye::pose),
            time_s: self.clock.time_s,
            size,
            samples: 1,
            meters: self.meters,
            lists_drops: self.lists_drops,
        }
    }

    /// Looks at the file on disk, and writes the recovery file, every few seconds.
    fn watch(&mut self, now_s: f64) {
        if now_s - self.watched_s < WATCH_S {
            return;
        }
        self.watched_s = now_s;
        if let Err(error) = self.document.autosave() {
            self.complain(format!("no autosave: {error}"));
        }
        if self.dialog.is_none() && self.document.is_changed_on_disk() {
            self.dialog = Some(Dialog::ChangedOnDisk);
        }
    }

    /// Takes files that are dropped on the window.
    fn take_drops(&mut self, ui: &egui::Ui) {
        let dropped = ui.input(|input| input.raw.dropped_files.clone());
        for file in dropped {
            let path = file.path().to_owned();
            self.drop_file(&path);
        }
    }

    /// Takes a file: a weather is opened, a model is added, a picture becomes the sky.
    pub fn drop_file(&mut self, path: &Path) {
        let end = path.extension().map(|end| end.to_string_lossy().to_lowercase()).unwrap_or_default();
        if end == "toml" {
            self.open(path);
            return;
        }
        let place = self.document.place();
        let own = std::fs::canonicalize(
            place.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")),
        );
        let inside = own.ok().zip(std::fs::canonicalize(path).ok());
        let inside = inside.and_then(|(own, file)| file.strip_prefix(own).map(Path::to_owned).ok());
        let Some(inside) = inside else {
            self.complain(format!("{}: allowed: files in the folder of the weather file", path.display()));
            return;
        };
        let name = Plain::Text(inside.to_string_lossy().replace('\\', "/"));
        let result = match end.as_str() {
            "glb" | "gltf" => {
                let entry = Plain::Table(vec![("file".to_owned(), name)]);
                self.document.add_entry(&KeyPath::of("model"), &entry).map(|_| ())
            }
            "hdr" | "exr" => self.document.replace_table("sky", vec![("file".to_owned(), name)]),
            _ => {
                self.complain(format!("{}: allowed: .toml, .glb, .gltf, .hdr, .exr", path.display()));
                return;
            }
        };
        self.noted(result);
    }
}
