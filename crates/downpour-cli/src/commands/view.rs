//! `downpour view`: the live window.

use std::path::PathBuf;

use clap::Args;
use downpour::Backend as DrawBackend;
use downpour::gpu::{AdapterChoice, Gpu};
use downpour_view::app::AppOptions;
use downpour_view::document::{Document, DocumentError};
use downpour_view::engine::DeviceChoice;
use downpour_view::script::{self, ScriptOptions};
use downpour_view::window::{self, WindowError};

use crate::backend::{Backend, BackendArguments};
use crate::failure::{FILES, Failure, INPUT, OTHER};
use crate::{quantity, stream};

/// Exit code without a display or an adapter to draw on it.
const NO_WINDOW: u8 = 4;

/// Largest window of a script, in pixels along an edge.
const MAX_WINDOW: u32 = 8192;

/// Look at a scene in the rain, live, and design its weather by hand.
///
/// Changes go to the weather file when they are saved; what is not saved is kept beside it, as .NAME.recovery. F1 lists the shortcuts.
#[derive(Debug, Args)]
pub(crate) struct ViewArguments {
    /// A weather file (.toml), or a model (.glb, .gltf).
    #[arg(value_name = "INPUT", required_unless_present = "script")]
    input: Option<PathBuf>,
    /// Run the steps of a script without a display; its first step may be `open`.
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    /// Size of the window in pixels.
    #[arg(long, value_name = "WxH", default_value = "1440x900", value_parser = quantity::picture_size)]
    #[arg(allow_hyphen_values = true)]
    size: [u32; 2],
    /// Additional folder in which the files of a weather are searched; may be repeated.
    #[arg(long, value_name = "FOLDER")]
    asset_root: Vec<PathBuf>,
    /// Part of the size of the window at which a script draws its pictures, 0.05 to 1, or `auto`: what keeps a window fluid.
    #[arg(long, value_name = "PART", default_value = "1", requires = "script", value_parser = part)]
    scale: Part,
    #[command(flatten)]
    backend: BackendArguments,
}

/// Part of the size of the window; `None` is found by the time that pictures take.
#[derive(Clone, Copy, Debug)]
struct Part(Option<f64>);

fn part(text: &str) -> Result<Part, String> {
    let allowed = "0.05 to 1, or auto";
    if text == "auto" {
        return Ok(Part(None));
    }
    let part: f64 = text.parse().map_err(|_| format!("not a number; allowed: {allowed}"))?;
    if (0.05..=1.0).contains(&part) {
        Ok(Part(Some(part)))
    } else {
        Err(format!("out of range; allowed: {allowed}"))
    }
}

impl ViewArguments {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        self.backend.check()?;
        if self.size.iter().any(|&edge| !(320..=MAX_WINDOW).contains(&edge)) {
            let [width, height] = self.size;
            let message =
                format!("--size is {width}x{height}; allowed: 320 to {MAX_WINDOW} pixels along each edge");
            return Err(Failure::new(INPUT, message));
        }
        let device = self.device()?;
        let scale = self.script.as_ref().and(self.scale.0);
        let app = AppOptions { device, asset_roots: self.asset_root.clone(), scale };
        let document = match &self.input {
            Some(input) => Document::open(input).map_err(|error| document_failure(&error))?,
            None => Document::from_text("untitled.toml", "", std::path::Path::new(""))
                .map_err(|error| document_failure(&error))?,
        };
        let Some(path) = &self.script else {
            return window::run(document, self.size, app).map_err(|error| window_failure(&error));
        };
        let steps = script::read(path).map_err(|message| Failure::new(FILES, message))?;
        let options = ScriptOptions { size: self.size, app };
        let name = path.display().to_string();
        script::run(&name, &steps, document, &options, &mut |text| stream::message(text))
            .map_err(|error| Failure::new(INPUT, error.to_string()))
    }

    /// The device; one that was asked for by name must be there.
    fn device(&self) -> Result<DeviceChoice, Failure> {
        let choice = DeviceChoice {
            backend: match self.backend.backend {
                Backend::Auto => DrawBackend::Auto,
                Backend::Gpu => DrawBackend::Gpu,
                Backend::Cpu => DrawBackend::Cpu,
            },
            adapter: self.backend.adapter.clone(),
        };
        if choice.backend == DrawBackend::Gpu || choice.adapter.is_some() {
            Gpu::open(&choice.adapter.clone().map_or(AdapterChoice::Auto, AdapterChoice::Named))?;
        }
        Ok(choice)
    }
}

fn document_failure(error: &DocumentError) -> Failure {
    let code = if matches!(error, DocumentError::File { .. }) { FILES } else { INPUT };
    Failure::new(code, error.to_string())
}

fn window_failure(error: &WindowError) -> Failure {
    let code = match error {
        WindowError::NoDisplay { .. } | WindowError::NoAdapter { .. } => NO_WINDOW,
        _ => OTHER,
    };
    Failure::new(code, error.to_string())
}
