//! `cargo xtask scenes skies`: the maps of `assets/skies`, captures of the plain street (`assets/scenes/plain`) from its middle.
//!
//! A capture is six square pictures of the dry street by `downpour render --backend cpu`, resampled into an equirectangular map. For rays
//! that miss the scene under a clear sky, the map has the sun's disk as well. The CPU's pictures are the same bytes on every machine, and
//! so are the maps; they depend on the renderer, and are generated again when it changes.

use std::path::Path;

use downpour_math::ops::f64 as ops;
use exr::prelude::{FlatSamples, ReadChannels as _, ReadLayers as _, read};
use image::codecs::hdr::HdrEncoder;

use super::sky::{ClearSky, SUN_RADIUS};
use xtask::run;

/// Size of a map.
const SIZE: [usize; 2] = [1024, 512];
/// Edge of a picture of the street.
const EDGE: usize = 400;
/// The most bytes that a map may take.
const BUDGET: usize = 1_500_000;
/// Color of the light of a sun at 20 degrees through clear air, its luminance 1: that of a black body at about 4500 K.
const SUN_COLOR: [f64; 3] = [1.27, 0.955, 0.66];

/// A map.
struct Capture {
    name: &'static str,
    is_night: bool,
    /// Replaces the sky of the street's weather.
    sky: Option<ClearSky>,
    eye: [f64; 3],
}

fn captures() -> [Capture; 3] {
    let low_sun = ClearSky::new(3.0, 24.0, 101.0);
    [
        Capture { name: "street_low_sun", is_night: false, sky: Some(low_sun), eye: [-0.4, 1.6, -21.5] },
        Capture { name: "street_day", is_night: false, sky: None, eye: [0.3, 1.6, -6.0] },
        Capture { name: "street_night", is_night: true, sky: None, eye: [0.6, 1.6, -11.0] },
    ]
}

/// Writes the maps, or compares them. Options: `--check`, and `--command FILE`, a `downpour` that is built already.
pub(crate) fn run(options: &[&str]) -> Result<(), String> {
    let (is_check, command) = match options {
        [] => (false, None),
        ["--check"] => (true, None),
        ["--command", file] => (false, Some(*file)),
        ["--check", "--command", file] | ["--command", file, "--check"] => (true, Some(*file)),
        _ => return Err(format!("scenes skies {}; allowed: [--check] [--command FILE]", options.join(" "))),
    };
    let program = run::downpour(command.map(Path::new))?;
    let folder = run::root().join("assets/skies");
    let at = |error: std::io::Error| format!("{}: {error}", folder.display());
    std::fs::create_dir_all(&folder).map_err(at)?;
    let mut wrong = Vec::new();
    for capture in captures() {
        let bytes = capture.make(&program)?;
        if bytes.len() > BUDGET {
            return Err(format!("{} takes {} bytes, more than {BUDGET}", capture.name, bytes.len()));
        }
        let path = folder.join(format!("{}.hdr", capture.name));
        if is_check {
            match std::fs::read(&path) {
                Ok(kept) if kept == bytes => println!("{} is equal to the generated file", path.display()),
                Ok(_) => wrong.push(format!("{} differs", path.display())),
                Err(error) => wrong.push(format!("{}: {error}", path.display())),
            }
        } else {
            std::fs::write(&path, &bytes).map_err(at)?;
            println!("{:>9} bytes  {}", bytes.len(), path.display());
        }
    }
    if wrong.is_empty() {
        Ok(())
    } else {
        Err(format!("(cargo xtask scenes skies):\n  {}", wrong.join("\n  ")))
    }
}

/// A picture of 90 degrees, with the directions of its axes.
struct Face {
    right: [f64; 3],
    up: [f64; 3],
    forward: [f64; 3],
    /// Radiance and distance of each pixel.
    pixels: Vec<[f32; 4]>,
}

impl Capture {
    fn make(&self, program: &Path) -> Result<Vec<u8>, String> {
        let street = run::root().join("assets/scenes/plain");
        let made = run::root().join("target/skies");
        std::fs::create_dir_all(&made).map_err(|error| format!("{}: {error}", made.display()))?;
        if let Some(sky) = &self.sky {
            let bytes = equirectangular([512, 256], |d| sky.radiance([d[0], d[1].max(0.0), d[2]]))?;
            std::fs::write(made.join("clear.hdr"), bytes).map_err(|error| format!("clear.hdr: {error}"))?;
        }
        let mut faces = Vec::new();
        for (number, [yaw, pitch]) in
            [[0.0, 0.0], [90.0, 0.0], [180.0, 0.0], [270.0, 0.0], [0.0, 89.9], [0.0, -89.9]]
                .into_iter()
                .enumerate()
        {
            let weather = self.weather(&street, yaw, pitch)?;
            let (file, out) = (made.join("face.toml"), made.join(format!("{}_{number}.exr", self.name)));
            std::fs::write(&file, weather).map_err(|error| format!("{}: {error}", file.display()))?;
            render(program, &file, &out, &[&street, &made])?;
            faces.push(Face::read(&out, yaw, pitch)?);
        }
        let sun = self.sky.map(|sky| Disk::of(&sky));
        equirectangular(SIZE, |direction| {
            let (mut color, is_open) = look(&faces, direction);
            if let (Some(sun), true) = (&sun, is_open) {
                let more = sun.radiance(direction);
                color = std::array::from_fn(|k| color[k] + more[k]);
            }
            color
        })
    }

    /// The dry street from the camera.
    fn weather(&self, street: &Path, yaw: f64, pitch: f64) -> Result<String, String> {
        let [x, y, z] = self.eye;
        let camera =
            format!("position_m = [{x}, {y}, {z}]\nyaw_deg = {yaw}\npitch_deg = {pitch}\nfov_deg = 90\n");
        let sky = self.sky.map(|sky| {
            let [sx, sy, sz] = sky.sun();
            let (elevation, azimuth) = (ops::asin(sy).to_degrees(), ops::atan2(sz, sx).to_degrees());
            let most = SUN_COLOR[0];
            let color = SUN_COLOR.map(|c| c / most);
            let lux = sky.sun_lux() * most;
            format!(
                "\n[sky]\nfile = \"clear.hdr\"\n[sun]\nelevation_deg = {elevation}\nazimuth_deg = {azimuth}\n\
                 illuminance_lux = {lux}\ncolor = {color:?}\n"
            )
        });
        dry(&street.join(if self.is_night { "night.toml" } else { "day.toml" }), sky.as_deref(), &camera)
    }
}

/// The models and the sky of a weather file, without rain, with a camera and perhaps another sky.
fn dry(file: &Path, sky: Option<&str>, camera: &str) -> Result<String, String> {
    let text = std::fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
    let models = text.split("\n[rain]").next().unwrap_or_default();
    let own =
        text.split("\n[sky]").nth(1).and_then(|rest| rest.split("\n[camera]").next()).unwrap_or_default();
    let sky = sky.map_or_else(|| format!("\n[sky]{own}"), str::to_owned);
    let rain = "\n[rain]\nrate_mm_h = 0\nseed = 49\n";
    Ok(format!("{models}{rain}{sky}\n[camera]\n{camera}\n[output]\nsize = [{EDGE}, {EDGE}]\n"))
}

fn render(program: &Path, weather: &Path, out: &Path, roots: &[&Path]) -> Result<(), String> {
    let mut command = run::command(&program.display().to_string(), &["render"]);
    command.arg(weather).args(["--backend", "cpu", "--quiet", "--overwrite", "--layers", "--sky-rays", "4"]);
    for root in roots {
        command.arg("--asset-root").arg(root);
    }
    let status = command.arg("-o").arg(out).status();
    match status {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("downpour render {}: {status}", weather.display())),
        Err(error) => Err(format!("{} did not start: {error}", program.display())),
    }
}

impl Face {
    fn read(path: &Path, yaw_deg: f64, pitch_deg: f64) -> Result<Self, String> {
        let to_error = |error: exr::error::Error| format!("{}: {error}", path.display());
        let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
        let image = reader.all_attributes().from_file(path).map_err(to_error)?;
        let channel = |name: &str| -> Result<Vec<f32>, String> {
            let all = &image.layer_data.channel_data.list;
            let found = all.iter().find(|channel| channel.name.eq(name));
            match found.map(|channel| &channel.sample_data) {
                Some(FlatSamples::F32(values)) if values.len() == EDGE * EDGE => Ok(values.clone()),
                _ => Err(format!("{}: no channel {name} of {EDGE} x {EDGE} floats", path.display())),
            }
        };
        let [r, g, b, z] =
            [channel("clean.R")?, channel("clean.G")?, channel("clean.B")?, channel("depth.Z")?];
        let pixels = (0..EDGE * EDGE).map(|k| [r[k], g[k], b[k], z[k]]).collect();
        let (y, p) = (yaw_deg.to_radians(), pitch_deg.to_radians());
        // Yaw 0 looks along -Z, 90 along -X.
        let forward = [-ops::sin(y) * ops::cos(p), ops::sin(p), -ops::cos(y) * ops::cos(p)];
        let right = [ops::cos(y), 0.0, -ops::sin(y)];
        let up = [
            right[1] * forward[2] - right[2] * forward[1],
            right[2] * forward[0] - right[0] * forward[2],
            right[0] * forward[1] - right[1] * forward[0],
        ];
        Ok(Self { right, up, forward, pixels })
    }
}

impl Face {
    /// The pixel in a direction, if the picture shows it.
    fn at(&self, direction: [f64; 3]) -> Option<[f32; 4]> {
        let along = |axis: [f64; 3]| -> f64 { axis.iter().zip(direction).map(|(a, b)| a * b).sum() };
        let depth = along(self.forward);
        let (x, y) = (along(self.right) / depth, along(self.up) / depth);
        if depth <= 0.0 || x.abs() > 1.0 || y.abs() > 1.0 {
            return None;
        }
        let texel = |t: f64| (((t + 1.0) * 0.5 * EDGE as f64) as usize).min(EDGE - 1);
        self.pixels.get(texel(-y) * EDGE + texel(x)).copied()
    }
}

/// Radiance in a direction, and true if it is the sky.
fn look(faces: &[Face], direction: [f64; 3]) -> ([f64; 3], bool) {
    // Seams between pictures are a fraction of a pixel wide: the nearest picture then.
    let seen = faces.iter().find_map(|face| face.at(direction));
    let [r, g, b, distance] = seen.unwrap_or([0.0; 4]);
    ([r, g, b].map(f64::from), distance > 1.0e20)
}

/// The sun's disk.
struct Disk {
    towards: [f64; 3],
    radiance: [f64; 3],
}

impl Disk {
    fn of(sky: &ClearSky) -> Self {
        let solid_angle = std::f64::consts::PI * SUN_RADIUS * SUN_RADIUS;
        Self { towards: sky.sun(), radiance: SUN_COLOR.map(|c| c * sky.sun_lux() / solid_angle) }
    }

    /// Radiance of the disk in a direction: its edge is spread over a pixel of the map.
    fn radiance(&self, direction: [f64; 3]) -> [f64; 3] {
        let cosine: f64 = direction.iter().zip(self.towards).map(|(a, b)| a * b).sum();
        let angle = ops::acos(cosine.clamp(-1.0, 1.0));
        if angle < SUN_RADIUS { self.radiance } else { [0.0; 3] }
    }
}

/// A map as a Radiance file: means of 4 x 4 rays in each pixel.
fn equirectangular(size: [usize; 2], radiance: impl Fn([f64; 3]) -> [f64; 3]) -> Result<Vec<u8>, String> {
    const RAYS: usize = 4;
    let [width, height] = size;
    let direction = |column: f64, row: f64| {
        let (phi, theta) = (
            (column / width as f64 - 0.5) * std::f64::consts::TAU,
            row / height as f64 * std::f64::consts::PI,
        );
        let flat = ops::sin(theta);
        [flat * ops::cos(phi), ops::cos(theta), flat * ops::sin(phi)]
    };
    let mut pixels = Vec::with_capacity(width * height);
    for row in 0..height {
        for column in 0..width {
            let mut sum = [0.0; 3];
            for ray in 0..RAYS * RAYS {
                let (i, j) = (ray % RAYS, ray / RAYS);
                let coordinate = |k: usize, n: usize| k as f64 + (n as f64 + 0.5) / RAYS as f64;
                let found = radiance(direction(coordinate(column, i), coordinate(row, j)));
                sum = std::array::from_fn(|k| sum[k] + found[k] / (RAYS * RAYS) as f64);
            }
            pixels.push(image::Rgb(sum.map(|c| c as f32)));
        }
    }
    let mut bytes = Vec::new();
    HdrEncoder::new(&mut bytes).encode(&pixels, width, height).map_err(|error| error.to_string())?;
    Ok(bytes)
}
