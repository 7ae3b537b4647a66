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
    /// The weather of the renderer, with the size and the eye of the question.
    weather: Weather,
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
        if drawn.as_ref().is_err_and(is_lost) {
            self.renderer = None;
            self.device = None;
            drawn = self.try_draw(number, request, begin);
        }
        drawn.map(Arc::new).map_err(|error| {
            // Whatever it was, the next question begins from nothing.
            self.renderer = None;
            let is_fatal = is_lost(&error);
            if is_fatal {
                self.device = None;
            }
            Fault { number, message: error.to_string(), is_fatal }
        })
    }

    fn try_draw(&mut self, number: u64, request: &Request, begin: Instant) -> Result<Drawn, RendererError> {
        self.prepare(request)?;
        let Some(Ready { renderer, weather, samples, .. }) = &mut self.renderer else {
            return Err(RendererError::NoGpuSupport);
        };
        let frame = renderer.frame(request.time_s)?;
        let stage = Arc::new(renderer.first_stage().clone());
        let pixels = frame.pixels();
        Ok(Drawn {
            number,
            revision: request.revision,
            time_s: request.time_s,
            size: frame.size(),
            samples: *samples,
            view: view(weather, &stage, request.time_s),
            histogram: Histogram::of(&pixels),
            pixels,
            stage,
            in_picture: frame.picture.drawn.clone(),
            drops: frame.drops,
            passes: frame.picture.passes,
            frame_ms: begin.elapsed().as_secs_f64() * 1.0e3,
            adapter: renderer.computer().adapter.clone(),
        })
    }

    /// Makes the renderer one of the question's weather.
    fn prepare(&mut self, request: &Request) -> Result<(), RendererError> {
        let mut weather = Weather { size: request.size, ..(*request.weather).clone() };
        if let Some(eye) = request.eye {
            weather.camera.path = Some(CameraPath::from(eye));
        }
        if let Some(ready) = &mut self.renderer
            && ready.samples == request.samples
            && ready.place == request.place
        {
            if ready.weather == weather {
                return Ok(());
            }
            // Another camera alone is the commonest change.
            let mut other = ready.weather.clone();
            other.camera.path.clone_from(&weather.camera.path);
            if other == weather
                && let Some(path) = weather.camera.path.clone()
                && ready.renderer.set_camera(path).is_ok()
            {
                ready.weather = weather;
                return Ok(());
            }
        }
        let device = match &self.device {
            Some(device) => device.clone(),
            None => self.device.insert(open(&self.choice)?).clone(),
        };
        self.renderer = None;
        let roots: Vec<&Path> = request.asset_roots.iter().map(std::path::PathBuf::as_path).collect();
        let loaded = load(&weather, &Roots::open(&request.place, &roots)?, &mut Budget::default())?;
        let options = RendererOptions {
            samples: request.samples,
            first_s: request.time_s,
            ..RendererOptions::default()
        };
        let renderer = Renderer::new(weather.clone(), loaded, options, device)?;
        let (samples, place) = (request.samples, request.place.clone());
        self.renderer = Some(Ready { renderer, weather, samples, place });
        Ok(())
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
fn view(weather: &Weather, stage: &downpour::trace::stage::Stage, time_s: f64) -> PictureView {
    let [width, height] = stage.size.map(f64::from);
    let now = weather.at(time_s);
    let first = &stage.viewpoint;
    let fov = now.camera.fov.unwrap_or(f64::from(first.fov_y));
    let (eye, forward) = match &now.camera.path {
        Some(path) => {
            let pose = path.at(time_s);
            (pose.position, pose.forward)
        }
        None => (first.eye.as_dvec3() + stage.origin, first.forward.as_dvec3()),
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
