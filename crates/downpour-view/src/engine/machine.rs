//! The renderer of the window: what a question needs is made anew only where it changed.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use downpour::gpu::{AdapterChoice, Gpu, GpuError};
use downpour::scene::Budget;
use downpour::trace::frame_scene::FrameScene;
use downpour::weather::{CameraPath, Roots, Weather, load};
use downpour::{Backend, Device, PendingDisplay, PendingFrame, Renderer, RendererError, RendererOptions};
use egui::ColorImage;
use glam::DVec3;

use super::drawn::{Drawn, Histogram, PictureView};
use super::{Answer, DeviceChoice, Fault, Request};

/// Pictures over which the scene without its rain is refined: each costs the scene, so that there are few.
pub(super) const KEPT_FRAMES: u32 = 4;

/// Pixels between those whose rays look for light while the camera moves: rays are most of a frame then.
const RAY_SPACING: u32 = 2;

/// Pictures over which the light of sky and surfaces goes on while the camera or the scene moves: a quarter of a second of a fluid
/// window.
const RUNNING_FRAMES: u32 = 16;

/// A renderer with the weather that it has.
#[derive(Debug)]
pub struct Machine {
    choice: DeviceChoice,
    device: Option<Device>,
    renderer: Option<Ready>,
    /// Devices that were forgotten.
    lost: u32,
    /// Time at which the last picture was at hand.
    last_done: Option<Instant>,
}

#[derive(Debug)]
struct Ready {
    renderer: Renderer,
    samples: u32,
    place: std::path::PathBuf,
}

/// A question whose picture is under way.
#[derive(Debug)]
pub struct Begun {
    number: u64,
    request: Request,
    begin: Instant,
    /// Time until it was on its way, ms.
    begin_ms: f64,
    /// Devices that had been forgotten before.
    lost: u32,
    picture: Result<Pending, RendererError>,
}

/// A picture under way.
#[derive(Debug)]
struct Pending {
    pixels: PendingPixels,
    view: PictureView,
    frame_scene: Arc<FrameScene>,
    is_in_flash: bool,
    adapter: String,
}

#[derive(Debug)]
enum PendingPixels {
    Display(PendingDisplay),
    /// With the list of its drops.
    Listed(Box<PendingFrame>),
}

impl Begun {
    /// The question.
    #[must_use]
    pub fn request(&self) -> &Request {
        &self.request
    }

    /// The number of the question.
    #[must_use]
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Time until it was on its way, ms.
    #[must_use]
    pub fn begin_ms(&self) -> f64 {
        self.begin_ms
    }
}

impl Machine {
    /// A machine that has drawn nothing yet.
    #[must_use]
    pub fn new(choice: DeviceChoice) -> Self {
        Self { choice, device: None, renderer: None, lost: 0, last_done: None }
    }

    /// Choice of its device.
    #[must_use]
    pub fn choice(&self) -> &DeviceChoice {
        &self.choice
    }

    /// Draws the answer to a question. A device that was lost is opened again once.
    ///
    /// # Errors
    /// [`Fault`].
    pub fn draw(&mut self, number: u64, request: Request) -> Answer {
        let begun = self.begin(number, request);
        self.finish(begun)
    }

    /// Begins the picture of a question; others may be under way. What goes wrong is told by [`Machine::finish`].
    #[must_use]
    pub fn begin(&mut self, number: u64, request: Request) -> Begun {
        let (begin, lost) = (Instant::now(), self.lost);
        let picture = self.try_begin(&request);
        Begun { number, request, begin, begin_ms: begin.elapsed().as_secs_f64() * 1.0e3, lost, picture }
    }

    /// Waits for the picture of a question. A device that was lost is opened again once.
    ///
    /// # Errors
    /// [`Fault`].
    pub fn finish(&mut self, begun: Begun) -> Answer {
        let Begun { number, request, begin, begin_ms, lost, picture } = begun;
        let times = (begin, begin_ms);
        let mut drawn = picture.and_then(|picture| self.try_finish(number, &request, times, picture));
        let was_lost = drawn.as_ref().is_err_and(is_lost);
        if was_lost {
            // Pictures that were under way together lose one device together.
            if lost == self.lost {
                self.forget();
            }
            let again = self.try_begin(&request);
            drawn = again.and_then(|picture| self.try_finish(number, &request, times, picture));
        }
        self.last_done = Some(Instant::now());
        drawn.map(Arc::new).map_err(|error| {
            // A weather that is refused leaves the renderer as it was; a device that is gone does not.
            if is_lost(&error) {
                self.forget();
            }
            Fault { number, message: error.to_string(), is_fatal: was_lost }
        })
    }

    /// Forgets the device and what is on it: the next picture opens one.
    fn forget(&mut self) {
        self.renderer = None;
        self.device = None;
        self.lost += 1;
    }

    /// Devices that were lost.
    #[cfg(test)]
    pub(super) fn losses(&self) -> u32 {
        self.lost
    }

    /// Draws with a device that is open.
    #[cfg(test)]
    pub(super) fn set_device(&mut self, device: Device) {
        self.device = Some(device);
    }

    fn try_begin(&mut self, request: &Request) -> Result<Pending, RendererError> {
        let weather = self.prepare(request)?;
        let Some(Ready { renderer, .. }) = &mut self.renderer else {
            return Err(RendererError::NoGpuSupport);
        };
        if request.meters {
            renderer.set_exposure(None);
        }
        let pixels = if request.lists_drops {
            PendingPixels::Listed(Box::new(renderer.begin_frame(request.time_s)?))
        } else {
            PendingPixels::Display(renderer.begin_display(request.time_s)?)
        };
        let frame_scene = Arc::new(renderer.first_scene().clone());
        Ok(Pending {
            pixels,
            view: view(&weather, &frame_scene, request.time_s),
            frame_scene,
            is_in_flash: renderer.is_in_flash(request.time_s),
            adapter: renderer.computer().adapter.clone(),
        })
    }

    fn try_finish(
        &self,
        number: u64,
        request: &Request,
        (begin, begin_ms): (Instant, f64),
        pending: Pending,
    ) -> Result<Drawn, RendererError> {
        let mut drops = None;
        let (size, pixels, drops_drawn, passes) = match pending.pixels {
            PendingPixels::Listed(frame) => {
                let frame = frame.finish()?;
                let pixels = frame.pixels().into_iter().map(|[r, g, b]| [r, g, b, 255]).collect();
                let in_picture = frame.picture.drawn;
                let count = in_picture.len();
                drops = Some((frame.drops, in_picture));
                (frame.picture.size, pixels, count, frame.picture.passes)
            }
            PendingPixels::Display(frame) => {
                let frame = frame.finish()?;
                (frame.size, frame.pixels, frame.drops_drawn, frame.passes)
            }
        };
        let histogram = Histogram::of(&pixels);
        let [width, height] = size.map(|edge| edge as usize);
        let image = ColorImage::from_rgba_premultiplied([width, height], pixels.as_flattened());
        let free = self.last_done.map_or(begin, |done| done.max(begin));
        Ok(Drawn {
            number,
            revision: request.revision,
            time_s: request.time_s,
            size,
            samples: request.samples,
            view: pending.view,
            histogram,
            image: Arc::new(image),
            frame_scene: pending.frame_scene,
            drops_drawn,
            drops,
            passes,
            is_in_flash: pending.is_in_flash,
            begin_ms,
            frame_ms: free.elapsed().as_secs_f64() * 1.0e3,
            adapter: pending.adapter,
        })
    }

    /// Makes the renderer one of the question's weather, with the size and the eye of the question; returns that.
    fn prepare(&mut self, request: &Request) -> Result<Weather, RendererError> {
        let mut weather = Weather { size: request.size, ..(*request.weather).clone() };
        if let Some(eye) = request.eye {
            weather.camera.path = Some(CameraPath::from(eye));
        }
        let roots: Vec<&Path> = request.asset_roots.iter().map(std::path::PathBuf::as_path).collect();
        let known = self.renderer.as_mut();
        if let Some(ready) = known.filter(|it| it.samples == request.samples && it.place == request.place) {
            if *ready.renderer.weather() != weather {
                ready.renderer.set_weather(weather.clone(), &Roots::open(&request.place, &roots)?)?;
            }
            return Ok(weather);
        }
        let device = match &self.device {
            Some(device) => device.clone(),
            None => self.device.insert(open(&self.choice)?).clone(),
        };
        self.renderer = None;
        let loaded = load(&weather, &Roots::open(&request.place, &roots)?, &mut Budget::default())?;
        let options = RendererOptions {
            samples: request.samples,
            first_s: request.time_s,
            kept_frames: KEPT_FRAMES,
            running_frames: RUNNING_FRAMES,
            ray_spacing: RAY_SPACING,
            ..RendererOptions::default()
        };
        let renderer = Renderer::new(weather.clone(), loaded, options, device)?;
        self.renderer = Some(Ready { renderer, samples: request.samples, place: request.place.clone() });
        Ok(weather)
    }
}

/// Opens a device.
pub(crate) fn open(choice: &DeviceChoice) -> Result<Device, RendererError> {
    match (&choice.adapter, choice.backend) {
        (Some(name), Backend::Auto | Backend::Gpu) => {
            Ok(Device::gpu(Gpu::open(&AdapterChoice::Named(name.clone()))?, choice.backend == Backend::Auto))
        }
        (_, backend) => backend.device(),
    }
}

fn is_lost(error: &RendererError) -> bool {
    matches!(error.gpu(), Some(GpuError::Lost { .. } | GpuError::Hung { .. }))
}

/// The camera of a picture.
fn view(weather: &Weather, frame_scene: &FrameScene, time_s: f64) -> PictureView {
    let [width, height] = frame_scene.size.map(f64::from);
    let now = weather.at(time_s);
    let first = &frame_scene.viewpoint;
    let fov = now.camera.fov.unwrap_or(f64::from(first.fov_y));
    let (eye, forward) = match &now.camera.path {
        Some(path) => {
            let pose = path.at(time_s);
            (pose.position, pose.forward)
        }
        None => (first.eye.as_dvec3() + frame_scene.origin, first.forward.as_dvec3()),
    };
    let mut view = PictureView::new(eye, forward, fov, width / height);
    if now.camera.path.is_none() {
        // The camera of a model may be tilted.
        let up: DVec3 = first.up.as_dvec3();
        if let Some(right) = view.forward.cross(up).try_normalize() {
            (view.right, view.up) = (right, right.cross(view.forward));
        }
    }
    view
}
