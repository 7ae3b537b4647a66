//! The renderer of the window: what a question needs is made anew only where it changed.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use downpour::gpu::{AdapterChoice, Gpu, GpuError};
use downpour::scene::Budget;
use downpour::weather::{CameraPath, Roots, Weather, load};
use downpour::{Backend, Device, Renderer, RendererError, RendererOptions};
use glam::DVec3;

use super::drawn::{Drawn, Histogram, PictureView};
use super::{Answer, DeviceChoice, Fault, Request};

/// Pictures over which the scene without its rain is refined: each costs the scene, so that there are few.
pub(super) const KEPT_FRAMES: u32 = 4;

/// Pixels between those whose rays look for light while the camera moves: rays are most of a frame then.
const RAY_SPACING: u32 = 2;

/// A renderer with the weather that it has.
#[derive(Debug)]
pub struct Machine {
    choice: DeviceChoice,
    device: Option<Device>,
    renderer: Option<Ready>,
}

#[derive(Debug)]
struct Ready {
    renderer: Renderer,
    samples: u32,
    place: std::path::PathBuf,
}

impl Machine {
    /// A machine that has drawn nothing yet.
    #[must_use]
    pub fn new(choice: DeviceChoice) -> Self {
        Self { choice, device: None, renderer: None }
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
    pub fn draw(&mut self, number: u64, request: &Request) -> Answer {
        let begin = Instant::now();
        let mut drawn = self.try_draw(number, request, begin);
        let was_lost = drawn.as_ref().is_err_and(is_lost);
        if was_lost {
            self.forget();
            drawn = self.try_draw(number, request, begin);
        }
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
    }

    /// Draws with a device that is open.
    #[cfg(test)]
    pub(super) fn set_device(&mut self, device: Device) {
        self.device = Some(device);
    }

    fn try_draw(&mut self, number: u64, request: &Request, begin: Instant) -> Result<Drawn, RendererError> {
        let weather = self.prepare(request)?;
        let Some(Ready { renderer, samples, .. }) = &mut self.renderer else {
            return Err(RendererError::NoGpuSupport);
        };
        if request.meters {
            renderer.set_exposure(None);
        }
        let mut drops = None;
        let (size, pixels, drops_drawn, passes) = if request.lists_drops {
            let frame = renderer.frame(request.time_s)?;
            let pixels = frame.pixels().into_iter().map(|[r, g, b]| [r, g, b, 255]).collect();
            let in_picture = frame.picture.drawn;
            let count = in_picture.len();
            let parts = (frame.picture.size, pixels, count, frame.picture.passes);
            drops = Some((frame.drops, in_picture));
            parts
        } else {
            let frame = renderer.display(request.time_s)?;
            (frame.size, frame.pixels, frame.drops_drawn, frame.passes)
        };
        let frame_scene = Arc::new(renderer.first_scene().clone());
        Ok(Drawn {
            number,
            revision: request.revision,
            time_s: request.time_s,
            size,
            samples: *samples,
            view: view(&weather, &frame_scene, request.time_s),
            histogram: Histogram::of(&pixels),
            pixels,
            frame_scene,
            drops_drawn,
            drops,
            passes,
            is_in_flash: renderer.is_in_flash(request.time_s),
            frame_ms: begin.elapsed().as_secs_f64() * 1.0e3,
            adapter: renderer.computer().adapter.clone(),
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
fn view(
    weather: &Weather,
    frame_scene: &downpour::trace::frame_scene::FrameScene,
    time_s: f64,
) -> PictureView {
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
