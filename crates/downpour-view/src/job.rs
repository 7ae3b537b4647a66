//! Stills and clips that are rendered beside the window.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use downpour::scene::Budget;
use downpour::weather::{CameraPath, Roots, Weather, load};
use downpour::{ClipLight, Renderer, RendererError, RendererOptions};

use crate::engine::{DeviceChoice, Request, open_device};

/// Most frames of a clip.
const MAX_FRAMES: u32 = 100_000;

/// The picture or clip that is rendered.
#[derive(Clone, Debug, PartialEq)]
pub struct JobSettings {
    /// The file; of a clip its name gets the number of the frame.
    pub output: String,
    /// True for a clip.
    pub is_clip: bool,
    /// Times of the first and of the last frame, s.
    pub range_s: [f64; 2],
    /// Frames per second.
    pub fps: f64,
    /// Samples along an edge of a pixel.
    pub samples: u32,
    /// Frames of a clip over which the light of sky and surfaces is averaged.
    pub light_frames: u32,
}

/// Progress of a job.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JobProgress {
    /// Frames that are written.
    pub done: u32,
    /// Frames of the whole.
    pub all: u32,
    /// Its result, when it has ended.
    pub result: Option<Result<String, String>>,
}

/// A job on a thread of its own.
#[derive(Debug)]
pub struct Job {
    progress: Arc<Mutex<JobProgress>>,
    is_canceled: Arc<AtomicBool>,
}

impl JobSettings {
    fn frames(&self) -> u32 {
        if !self.is_clip {
            return 1;
        }
        let [begin, end] = self.range_s;
        (((end - begin) * self.fps).round().clamp(0.0, f64::from(MAX_FRAMES)) as u32 + 1).min(MAX_FRAMES)
    }

    fn time_s(&self, frame: u32) -> f64 {
        self.range_s[0] + f64::from(frame) / self.fps
    }

    fn file(&self, frame: u32) -> PathBuf {
        let path = Path::new(self.output.trim());
        if !self.is_clip {
            return path.to_owned();
        }
        let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
        path.with_file_name(format!("{}_{frame:04}.{}", part(path.file_stem()), part(path.extension())))
    }
}

impl Job {
    /// Starts a job; it renders the weather of a question, with its eye.
    ///
    /// # Errors
    /// A name that is no picture, a file that is there already, or the system has no thread left.
    pub fn start(settings: &JobSettings, request: Request, device: DeviceChoice) -> Result<Self, String> {
        let first = settings.file(0);
        let end = first.extension().map(|end| end.to_string_lossy().to_lowercase()).unwrap_or_default();
        if !["png", "exr"].contains(&end.as_str()) {
            return Err(format!("{}; allowed: .png or .exr", first.display()));
        }
        if first.exists() {
            return Err(format!("{}: is there already; allowed: a new name", first.display()));
        }
        let all = settings.frames();
        let progress = Arc::new(Mutex::new(JobProgress { all, ..JobProgress::default() }));
        let is_canceled = Arc::new(AtomicBool::new(false));
        let job = Self { progress: Arc::clone(&progress), is_canceled: Arc::clone(&is_canceled) };
        let settings = settings.clone();
        let work = move || {
            let done = |count: u32| progress.lock().unwrap_or_else(PoisonError::into_inner).done = count;
            let result = run(&settings, &request, &device, &is_canceled, &done);
            let text = match result {
                Ok(count) if is_canceled.load(Ordering::Relaxed) => {
                    Ok(format!("canceled after {count} frames"))
                }
                Ok(1) if !settings.is_clip => Ok(format!("wrote {}", settings.file(0).display())),
                Ok(count) => Ok(format!("wrote {count} frames, {} the first", settings.file(0).display())),
                Err(error) => Err(error.to_string()),
            };
            progress.lock().unwrap_or_else(PoisonError::into_inner).result = Some(text);
        };
        std::thread::Builder::new()
            .name("downpour-render".to_owned())
            .spawn(work)
            .map_err(|e| e.to_string())?;
        Ok(job)
    }

    /// Its progress.
    #[must_use]
    pub fn progress(&self) -> JobProgress {
        self.progress.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Ends it after the frame that is rendered.
    pub fn cancel(&self) {
        self.is_canceled.store(true, Ordering::Relaxed);
    }
}

impl Drop for Job {
    fn drop(&mut self) {
        self.cancel();
    }
}

fn run(
    settings: &JobSettings,
    request: &Request,
    device: &DeviceChoice,
    is_canceled: &AtomicBool,
    done: &dyn Fn(u32),
) -> Result<u32, RendererError> {
    let mut weather = Weather { size: request.size, ..(*request.weather).clone() };
    if let Some(eye) = request.eye.filter(|_| !settings.is_clip) {
        weather.camera.path = Some(CameraPath::from(eye));
    }
    let roots: Vec<&Path> = request.asset_roots.iter().map(PathBuf::as_path).collect();
    let loaded = load(&weather, &Roots::open(&request.place, &roots)?, &mut Budget::default())?;
    let light = ClipLight { frames: settings.light_frames, frames_per_s: settings.fps };
    let options = RendererOptions {
        samples: settings.samples,
        sky_rays: RendererOptions::sky_rays_for(settings.samples),
        first_s: settings.time_s(0),
        clip_light: settings.is_clip.then_some(light),
        ..RendererOptions::default()
    };
    let mut renderer = Renderer::new(weather, loaded, options, open_device(device)?)?;
    for frame in 0..settings.frames() {
        if is_canceled.load(Ordering::Relaxed) {
            return Ok(frame);
        }
        renderer.frame(settings.time_s(frame))?.save(settings.file(frame))?;
        done(frame + 1);
    }
    Ok(settings.frames())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clip_is_numbered_and_ends_at_its_range() {
        let settings = JobSettings {
            output: "out/a.png".to_owned(),
            is_clip: true,
            range_s: [1.0, 2.0],
            fps: 24.0,
            samples: 1,
            light_frames: 4,
        };
        assert_eq!(settings.frames(), 25);
        assert_eq!(settings.time_s(24), 2.0);
        assert_eq!(settings.file(7), Path::new("out/a_0007.png"));
    }

    #[test]
    fn a_still_is_written_and_not_over_another() {
        let folder = tempfile::tempdir().unwrap();
        let weather =
            Weather::parse("a.toml", "[output]\nsize = [32, 18]\n[camera]\nposition_m = [0, 2, 0]\n")
                .unwrap();
        let request = Request {
            size: weather.size,
            weather: Arc::new(weather),
            revision: 0,
            place: folder.path().join("a.toml"),
            asset_roots: Vec::new(),
            eye: None,
            time_s: 0.0,
            samples: 1,
            meters: false,
            lists_drops: false,
        };
        let output = folder.path().join("a.png").display().to_string();
        let (is_clip, range_s, fps) = (false, [0.0; 2], 24.0);
        let settings = JobSettings { output, is_clip, range_s, fps, samples: 1, light_frames: 1 };
        let device = DeviceChoice { backend: downpour::Backend::Cpu, adapter: None };
        let job = Job::start(&settings, request.clone(), device.clone()).unwrap();
        let result = loop {
            match job.progress().result {
                Some(result) => break result,
                None => std::thread::yield_now(),
            }
        };
        assert!(result.unwrap().contains("a.png"));
        assert!(folder.path().join("a.png").exists());
        assert!(
            Job::start(&settings, request.clone(), device.clone()).unwrap_err().contains("there already")
        );
        let bad = JobSettings { output: "a.jpg".to_owned(), ..settings };
        assert!(Job::start(&bad, request, device).unwrap_err().contains("allowed: .png or .exr"));
    }
}
